"""Unit, heading, order and names of the input do not matter."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from benchmarks.studies.invariance import Change, differing
from kinematify.assembly.load import load_assembly
from kinematify.generate.procedural.solids import cylinder
from kinematify.pipeline.heading import principal_heading, rotated
from kinematify.pipeline.infer_assembly import infer
from tests.known import known_object, turning
from tests.objects import BUILDERS, write_parts

if TYPE_CHECKING:
    from pathlib import Path


def test_what_is_read_from_files_is_the_same_in_any_unit(tmp_path: Path) -> None:
    found = {
        scale: infer(load_assembly(write_parts("drawer", tmp_path / str(scale), scale=scale)))
        for scale in (1.0, 1e-3, 1e3)
    }
    assert not differing(found[1.0], found[1e-3], Change(scale=1e-3))
    assert not differing(found[1.0], found[1e3], Change(scale=1.0)), "longer than 20 units: read as millimetres"


@pytest.mark.parametrize("degrees", [0.0, 10.0, -37.0, 44.9])
def test_the_heading_is_that_of_the_walls(degrees: float) -> None:
    assembly = BUILDERS["edge_door"]().assembly
    given = rotated(assembly, np.radians(degrees))
    assert principal_heading(given) == pytest.approx(np.radians(degrees), abs=1e-7)
    assert principal_heading(rotated(given, -principal_heading(given))) == 0.0


def test_seven_walls_of_which_none_is_the_first_after_every_turn_are_inferred() -> None:
    """Square to one of equal walls, an object may have another heading: it is turned once, not for ever."""
    body, lid = (cylinder(0.03, (0, 0, low), (0, 0, low + 0.05), segments=7) for low in (0.0, 0.05))
    mill = known_object("mill", {"body": body, "lid": lid}, turning("body", "lid", (0, 0, 1), (0, 0, 0), (-3, 3)))
    assert principal_heading(rotated(mill.assembly, -principal_heading(mill.assembly))) != 0.0
    assert [joint.child for joint in infer(mill.assembly).joints] == [1]
