"""Every object with known joints, by name: ``BUILDERS["drawer"](seed=3)`` gives a `KnownObject`.

A builder takes keyword arguments only: its sizes [m], `clearance` [m] where parts face each other, and `seed`,
which varies the sizes at random. The sweeps of ``test_objects.py`` hold for every one of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import trimesh

from tests import household, robots
from tests.known import KnownJoint, KnownObject, moved, posed, shuffled, with_yaw

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

__all__ = ["BUILDERS", "KnownJoint", "KnownObject", "moved", "posed", "shuffled", "with_yaw", "write_parts"]

BUILDERS: Mapping[str, Callable[..., KnownObject]] = {
    builder.__name__: builder
    for builder in (
        household.hinge_pin,
        household.barrel_hinge_door,
        household.edge_door,
        household.drawer,
        household.nested_drawer,
        household.knob,
        household.sliding_lid,
        household.toilet,
        household.button,
        household.lever,
        robots.wheel,
        robots.square_lift,
        robots.universal_joint,
        robots.parallel_gripper,
        robots.serial_arm,
        robots.torso,
    )
}


def write_parts(name: str, folder: Path, *, scale: float = 1.0) -> Path:
    """Write the parts of an object as a folder of STL files; `scale` is units per metre."""
    folder.mkdir()
    for part in BUILDERS[name]().parts:
        trimesh.Trimesh(scale * part.vertices, part.faces, process=False).export(folder / f"{part.name}.stl")
    return folder
