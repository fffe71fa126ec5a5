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
class Task:
    """One joint of a family of objects, and what is to be done with it."""

    family: str
    """Of `kinematify generate --list`."""
    joint: str
    closing: bool = False
    """From open to closed, in place of the other way."""


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

TASKS: dict[str, Task] = {
    "open-drawer": Task(family="cabinet", joint="drawer_1_joint"),
    "open-desk-drawer": Task(family="table", joint="drawer_1_joint"),
    "open-fridge": Task(family="fridge", joint="door_1_joint"),
    "open-oven": Task(family="oven", joint="door_joint"),
    "open-microwave": Task(family="microwave", joint="door_joint"),
    "open-dishwasher": Task(family="dishwasher", joint="door_joint"),
    "open-washing-machine": Task(family="washing_machine", joint="door_joint"),
    "open-detergent-drawer": Task(family="washing_machine", joint="drawer_joint"),
    "open-safe": Task(family="safe", joint="door_joint"),
    "open-window": Task(family="window", joint="sash_1_joint"),
    "open-door": Task(family="door", joint="leaf_1_joint"),
    "open-suitcase": Task(family="suitcase", joint="front_joint"),
    "close-drawer": Task(family="cabinet", joint="drawer_1_joint", closing=True),
    "close-microwave": Task(family="microwave", joint="door_joint", closing=True),
    "lift-coffee-lid": Task(family="coffee_machine", joint="lid_joint"),
    "lift-toilet-lid": Task(family="toilet", joint="lid_joint"),
    "lift-laptop-screen": Task(family="laptop", joint="screen_joint"),
    "turn-oven-knob": Task(family="oven", joint="knob_1_joint"),
    "press-microwave-button": Task(family="microwave", joint="button_1_joint"),
    "push-toaster-lever": Task(family="toaster", joint="lever_1_joint"),
}
"""Keyed by name; ``kinematify/NAME-v0`` is the id of the environment."""


def make_task(task: str, object_seed: int = TRAIN.objects[0], **keywords: Any) -> gymnasium.Env[Any, Any]:
    """Make the environment of a task: `OpenPartEnv` with `randomize=True`, whose keywords may be given too.

    Args:
        task: Key of `TASKS`.
        object_seed: Which object of the family; `TRAIN` and `TEST` have those to use.
        keywords: Of `OpenPartEnv`, `observation` and `pixel_size`.
    """
    from kinematify.envs.open_part import make_open_part  # noqa: PLC0415  # ids are registered without an engine

    asked = TASKS[task]
    model = f"procedural:{asked.family}:{object_seed}"
    return make_open_part(model=model, joint=asked.joint, closing=asked.closing, **{"randomize": True, **keywords})
