"""What was heard of joints, as people read it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.vision.votes import Heard

_NAMED = 5


def describe_votes(heard: Sequence[Heard]) -> str:
    """Say how many questions were answered, what changed, and why there were no answers."""
    answered = [item for item in heard if not item.votes.note]
    changed = [item.child for item in heard if item.changed]
    lines = [f"The vision model answered {len(answered)} of {len(heard)} questions and changed {len(changed)} joints."]
    if changed:
        lines.append(f"Changed: {', '.join(changed[:_NAMED])}{', ...' if len(changed) > _NAMED else ''}.")
    reasons = sorted({item.votes.note for item in heard if item.votes.note})
    lines += [f"No answer: {reason}" for reason in reasons[:_NAMED]]
    return "\n".join(lines)
