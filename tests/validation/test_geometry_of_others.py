"""What geometry says of models whose makers would not agree: each test is named after a defect of an earlier round."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from kinematify.validation.finding import Severity
from kinematify.validation.run.needs import geometry
from tests.validation.engine_models import Box, Model, Part, tell
from tests.validation.test_geometry import beam, block, found, request_for

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.validation.finding import Finding


def one(findings: dict[str, list[Finding]], check: str) -> Finding:
    """The one finding of a check, whatever others say."""
    (finding,) = findings[check]
    return finding


def test_what_is_seen_never_stands_in_for_missing_collision_geometry(tmp_path: Path) -> None:
    left, right = block("left", 0.0), block("right", 0.05)
    assert "KV301" in found(beam(left, right), tmp_path)
    assert found(beam(replace(left, collision=()), right), tmp_path) == {}
    in_the_beam = replace(block("block", 0.0, z=0.02), collision=())
    assert found(beam(in_the_beam), tmp_path) == {}


def test_visible_surfaces_that_cross_are_not_said_to_stay_clear(tmp_path: Path) -> None:
    swollen = (Box(size=(0.1, 0.1, 0.1)),)

    def message(size: float) -> str:
        left = replace(block("left", 0.0, size=size), collision=swollen)
        return one(
            found(beam(left, replace(block("right", 0.05, size=size), collision=swollen)), tmp_path), "KV301"
        ).message

    assert "the visible surfaces stay clear" in message(0.04)
    assert "the visible surfaces stay clear" not in message(0.052)


def test_a_depth_is_never_more_than_the_thickness_of_the_thinner_body(tmp_path: Path) -> None:
    sheet = Part(name="sheet", parent="beam", kind="prismatic", boxes=(Box(size=(0.3, 0.3, 0.004)),),
                 at=(0.0, 0.4, 0.3), axis=(0.0, 1.0, 0.0), limits=(0.0, 0.01))  # fmt: skip
    tower = Part(name="tower", parent="beam", kind="prismatic", boxes=(Box(size=(0.4, 0.4, 0.6)),),
                 at=(0.0, 0.45, 0.36), axis=(0.0, 0.0, 1.0), limits=(0.0, 0.01))  # fmt: skip
    finding = one(found(beam(sheet, tower), tmp_path), "KV301")
    assert finding.value == pytest.approx(0.004)
    wall = Part(name="wall", parent="beam", boxes=(Box(size=(0.02, 0.5, 0.5)),), at=(0.2, 0.0, 0.3))
    through = one(
        found(beam(wall, block("block", 0.0, z=0.2, axis=(1.0, 0.0, 0.0), limits=(0.0, 0.4))), tmp_path), "KV312"
    )
    assert through.value is not None
    assert through.value <= 0.1


def test_a_contact_that_is_alike_all_along_is_no_stop(tmp_path: Path) -> None:
    carriage = replace(block("carriage", -0.4, z=0.11, axis=(1.0, 0.0, 0.0), limits=(0.0, 0.8), size=0.06))
    raised = Box(size=(0.9, 0.1, 0.04), at=(0.1, 0.0, 0.08))
    rail = Part(name="beam", boxes=(Box(size=(1.0, 0.1, 0.1)), raised))
    assert set(found(Model(parts=(rail, carriage)), tmp_path)) == {"KV303"}
    post = Box(size=(0.04, 0.1, 0.04), at=(0.1, 0.0, 0.08))
    stopped = Model(parts=(replace(rail, boxes=(rail.boxes[0], post)), carriage))
    assert one(found(stopped, tmp_path), "KV312").joint == "carriage_joint"


@pytest.mark.parametrize(("upper", "limit"), [(0.12, True), (0.4, False)])
def test_no_remedy_leaves_a_joint_less_than_half_of_its_range(tmp_path: Path, upper: float, *, limit: bool) -> None:
    wall = Part(name="wall", parent="beam", boxes=(Box(size=(0.06, 0.5, 0.5)),), at=(0.18, 0.0, 0.3))
    slide = block("block", 0.0, z=0.2, axis=(1.0, 0.0, 0.0), limits=(0.0, upper))
    finding = one(found(beam(wall, slide), tmp_path), "KV312")
    assert ('<limit lower="0" upper="0.1' in finding.remedy) is limit
    assert ("<limit" in finding.remedy) is limit


def test_swollen_collision_shapes_of_neighbours_that_engines_let_pass_are_a_note(tmp_path: Path) -> None:
    """A thigh and a shank whose collision boxes meet at the knee: by default no engine collides the two."""
    swollen = (Box(size=(0.12, 0.12, 0.29), at=(0.0, 0.0, -0.15)),)
    turning = {"kind": "revolute", "axis": (0.0, 1.0, 0.0), "collision": swollen}
    above, below = (Box(size=(0.03, 0.03, 0.24), at=(0.0, 0.0, z)) for z in (-0.12, -0.18))
    thigh = Part(name="thigh", parent="beam", at=(0.0, 0.0, -0.2), limits=(-0.1, 0.1), boxes=(above,), **turning)
    shank = Part(name="shank", parent="thigh", at=(0.0, 0.0, -0.3), limits=(-1.2, 1.2), boxes=(below,), **turning)
    results = tell(geometry, request_for(beam(thigh, shank), tmp_path)).results
    reported = [item for check in ("KV310", "KV312") for item in results[check].findings if item.joint == "shank_joint"]
    assert reported
    assert {item.severity for item in reported} == {Severity.NOTE}
