"""The whole inference, and the folder that it writes."""

from kinematify.pipeline.infer import infer
from kinematify.pipeline.inference import Inference
from kinematify.pipeline.record import write_inference

__all__ = ["Inference", "infer", "write_inference"]
