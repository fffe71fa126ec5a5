"""Twenty named tasks with objects and seeds for training, and others for tests.

``gymnasium.make("kinematify.envs:kinematify/lift-toilet-lid-v0", object_seed=3)`` makes one. An object seed draws sizes
and what is on the object; the seed of `reset` draws its place, masses, friction, damping and colours.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import gymnasium


EPISODE_STEPS = {"open_part": 100, "drawer_pull": 240}
"""Actions after which episodes are truncated: 5 s is three times what a person needs for a drawer; in 12 s a robot
reaches, grips and pulls with half of its speed."""


@dataclass(frozen=True, kw_only=True)
class Split:
    """Objects and seeds that episodes are drawn from."""

    objects: range
    """Object seeds."""
    seeds: range
    """Of episodes."""


TRAIN = Split(objects=range(8), seeds=range(100_000))
TEST = Split(objects=range(1000, 1004), seeds=range(1_000_000, 1_000_100))
"""Nothing of it is in `TRAIN`."""

TASKS = {
    "open-drawer": ("cabinet", "drawer_1_joint"),
    "open-desk-drawer": ("table", "drawer_1_joint"),
    "open-fridge": ("fridge", "door_1_joint"),
    "open-oven": ("oven", "door_joint"),
    "open-microwave": ("microwave", "door_joint"),
    "open-dishwasher": ("dishwasher", "door_joint"),
    "open-washing-machine": ("washing_machine", "door_joint"),
    "open-detergent-drawer": ("washing_machine", "drawer_joint"),
    "open-safe": ("safe", "door_joint"),
    "open-window": ("window", "sash_1_joint"),
    "open-door": ("door", "leaf_1_joint"),
    "open-suitcase": ("suitcase", "front_joint"),
    "close-drawer": ("cabinet", "drawer_1_joint"),
    "close-microwave": ("microwave", "door_joint"),
    "lift-coffee-lid": ("coffee_machine", "lid_joint"),
    "lift-toilet-lid": ("toilet", "lid_joint"),
    "lift-laptop-screen": ("laptop", "screen_joint"),
    "turn-oven-knob": ("oven", "knob_1_joint"),
    "press-microwave-button": ("microwave", "button_1_joint"),
    "push-toaster-lever": ("toaster", "lever_1_joint"),
}
"""Family of `kinematify generate --list` and its joint; keyed by name, ``kinematify/NAME-v0`` is the id of the
environment. What begins with ``close`` goes from open to closed, all others the other way."""


def make_task(task: str, object_seed: int = TRAIN.objects[0], **keywords: Any) -> gymnasium.Env[Any, Any]:
    """Make the environment of a task: `OpenPartEnv` with `randomize=True`, whose keywords may be given too.

    Args:
        task: Key of `TASKS`.
        object_seed: Which object of the family; `TRAIN` and `TEST` have those to use.
        keywords: Of `OpenPartEnv`, `observation` and `pixel_size`.
    """
    from kinematify.envs.open_part import make_open_part  # noqa: PLC0415  # ids are registered without an engine

    family, joint = TASKS[task]
    model, closing = f"procedural:{family}:{object_seed}", task.startswith("close")
    return make_open_part(model=model, joint=joint, closing=closing, **{"randomize": True, **keywords})
