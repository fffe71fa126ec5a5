"""Web services that are asked."""

from __future__ import annotations

from kinematify.config.base import StageConfig


class ServiceConfig(StageConfig):
    """Patience with a service."""

    first_pause: float
    """Before a request is repeated for the first time [s]."""
    longest_pause: float
    """Pauses double up to this [s]."""
    tries: int
    """Attempts of a request before the network or the service counts as down."""
    answer_seconds: float
    """The service has so long to answer a request [s]."""
    most_bytes: int
    """Larger files are not fetched [bytes]."""


class VisionConfig(ServiceConfig):
    """A vision-language model that is asked about joints."""

    model: str
    """Name of the model at the service; the variable KINEMATIFY_VLM_MODEL wins."""
    budget: int
    """Questions of one inference at most, the least sure joints first."""
    concurrency: int
    """Questions at a time."""
    view_pixels: int
    """Side of each of the four views of a question."""
    field_of_view: float
    """Of the views [deg]; small angles are nearly orthographic."""
    least_confidence: float
    """Answers that are less sure count as abstentions."""
    reliability: float
    """Share of a model's answers that is taken to be right, however sure it says it is; less sure ones count less."""
    chosen_lead: float
    """Lead of what the geometry chose over candidates of equal score [log odds]: how often it is right."""
    cluster_weight: float
    """Of the votes on congruent parts, all together, relative to the part's own."""
    most: float
    """All votes on one joint together weigh no more [log odds]: what leads by more is not overruled."""
    oblique_deg: float
    """Axes that are farther from every view axis have no direction that a view can name."""
    off_center: float
    """A hinge that is nearer to the middle of its part than this share of the part's extent has no side."""
