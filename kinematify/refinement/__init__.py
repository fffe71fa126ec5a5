"""From failed checks to another choice: infer, simulate, feed back, choose again."""

from kinematify.refinement.loop import Refinement, refine, repaired

__all__ = ["Refinement", "refine", "repaired"]
