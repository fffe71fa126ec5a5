"""From failed checks to another choice: infer, simulate, feed back, choose again (design section 5)."""

from kinematify.refinement.loop import Refinement, refine

__all__ = ["Refinement", "refine"]
