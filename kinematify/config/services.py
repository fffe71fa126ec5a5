"""Programs and web services that are asked: generators of parts, and a model that looks at joints."""

from __future__ import annotations

from kinematify.config.base import StageConfig, section


class ServiceConfig(StageConfig):
    """Patience with a service."""

    first_pause: float = 2.0
    """Before a request is repeated for the first time [s]."""
    longest_pause: float = 20.0
    """Pauses double up to this [s]."""
    tries: int = 4
    """Attempts of a request before the network or the service counts as down."""
    answer_seconds: float = 90.0
    """The service has so long to answer a request [s]."""
    most_bytes: int = 10000000
    """Larger files are not fetched [bytes]."""


class RodinConfig(ServiceConfig):
    """Hyper3D Rodin and its splitting into parts (BANG), the generator of the paper (section III-A)."""

    longest_pause: float = 15.0  # a job takes about five minutes
    tries: int = 6
    answer_seconds: float = 60.0
    most_bytes: int = 500000000
    url: str = "https://api.hyper3d.com/api/v2"
    """Beginning of every address; the variable RODIN_API_URL wins."""
    tier: str = "Gen-2"
    """Model that makes the shape."""
    mesh_mode: str = "Raw"  # quads are of no use to the inference
    """``Raw`` triangles or ``Quad``."""
    material: str = "None"  # neither are textures
    """``PBR``, ``Shaded``, ``All`` or ``None``."""
    strength: int = 5  # the service's own choice
    """How finely the shape is split, 2 to 12."""
    shape_credits: float = 0.5
    """What a shape is expected to cost."""
    parts_credits: float = 0.5
    """What the splitting is expected to cost."""
    job_seconds: float = 1800.0
    """A job has so long to be done [s]."""


class LanguageModelConfig(ServiceConfig):
    """A language model that writes blueprints."""

    answer_seconds: float = 3600.0  # a long answer of a model of 7e9 parameters on two cores
    model: str = "default"  # local servers serve one model and take any name
    """Name of the model at the service; the variable KINEMATIFY_LLM_MODEL wins."""
    rounds: int = 4  # what is not mended in three answers is not mended
    """Answers at most: the first one, and those that mend it."""
    answer_tokens: int = 16000  # a blueprint of 100 parts
    """Of one answer at most."""


class SourcesConfig(StageConfig):
    """Where parts come from."""

    rodin: RodinConfig = section()
    language_model: LanguageModelConfig = section()
    command_seconds: float = 1800.0  # local generators take minutes, the first time more for their weights
    """A program of the user's has so long [s]."""


class VisionConfig(ServiceConfig):
    """A vision-language model that is asked about joints."""

    first_pause: float = 1.0
    model: str = "default"  # local servers serve one model and take any name
    """Name of the model at the service; the variable KINEMATIFY_VLM_MODEL wins."""
    budget: int = 40  # twice the joints of a humanoid
    """Questions of one inference at most, the least sure joints first."""
    concurrency: int = 4
    """Questions at a time."""
    view_pixels: int = 320  # services scale pictures to some 700 pixels, and four views are shown at once
    """Side of each of the four views of a question."""
    field_of_view: float = 6.0  # sides of a box look parallel
    """Of the views [deg]; small angles are nearly orthographic."""
    least_confidence: float = 0.5
    """Answers that are less sure count as abstentions."""
    reliability: float = 0.9  # models say 0.99 too easily, and none was measured here
    """Share of a model's answers that is taken to be right, however sure it says it is; less sure ones count less."""
    # log 9: the geometry is right on nine directions of ten (everyday.md: 87 % on unseen kinds)
    chosen_lead: float = 2.2
    """Lead of what the geometry chose over candidates of equal score [log odds]: how often it is right."""
    cluster_weight: float = 0.5  # twins look the same: their pictures are misread together
    """Of the votes on congruent parts, all together, relative to the part's own."""
    most: float = 6.0  # two votes of 2.9: three answers to one picture are not three witnesses
    """All votes on one joint together weigh no more [log odds]: what leads by more is not overruled."""
    oblique_deg: float = 30.0
    """Axes that are farther from every view axis have no direction that a view can name."""
    off_center: float = 0.2
    """A hinge that is nearer to the middle of its part than this share of the part's extent has no side."""
