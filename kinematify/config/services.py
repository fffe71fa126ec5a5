"""Programs and web services that are asked: generators of parts, and a model that looks at joints."""

from __future__ import annotations

from kinematify.config.base import StageConfig, section

ADDRESS = "KINEMATIFY_LLM_URL"
"""Variable with the address of the language model."""


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


class LanguageModelConfig(ServiceConfig):
    """A language model that fills requests and draws blueprints."""

    answer_seconds: float = 3600.0  # a long answer of a model of 7e9 parameters on two cores
    model: str = "default"  # local servers serve one model and take any name
    """Name of the model at the service; the variable KINEMATIFY_LLM_MODEL wins."""
    rounds: int = 3  # what is not fixed in three answers is not fixed
    """Answers at most: the first one, and those that fix it."""
    answer_tokens: int = 16000  # a blueprint of 100 parts
    """Of one answer at most."""


class SourcesConfig(StageConfig):
    """Where parts come from."""

    language_model: LanguageModelConfig = section()
    command_seconds: float = 1800.0  # local generators take minutes, the first time more for their weights
    """A program of the user's has so long [s]."""


class VisionConfig(ServiceConfig):
    """A vision-language model that is asked which parts move, and how."""

    first_pause: float = 1.0
    tries: int = 2  # a local model that is slow once is slow again
    answer_seconds: float = 600.0  # a local model on a processor takes minutes for a picture
    model: str = "default"  # local servers serve one model and take any name
    """Name of the model at the service; the variable KINEMATIFY_VLM_MODEL wins."""
    ask_below: float = 0.9  # above, 96 % are right, and an answer can only do harm (results/choice.md)
    """Parts that were given are asked about where a joint has less confidence; a mesh of pieces always is."""
    tokens: int = 60000  # twenty questions
    """No further question is asked after so many, pictures included."""
    concurrency: int = 2
    """Questions at a time."""
    answer_tokens: int = 4000  # forty parts
    """Of one answer at most: models that think aloud need room."""
    reliability: float = 0.9
    """No voter counts as right more often than this, whatever its record says."""
    caution: float = 0.1  # ten answers of ten count as 81 %, three of ten as 17 %
    """A voter counts as right as often as its record shows with all but this probability."""
