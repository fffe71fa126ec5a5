"""Collision by exact geometry: each check tells the fault that it is for, with where, how deep and with which cause."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kinematify.config.validation import load_settings
from kinematify.validation.checks import CHECKS, checks_of
from kinematify.validation.finding import Cause, CheckResult, Finding, JointSummary, Severity, Status
from kinematify.validation.run.needs import Recorder, geometry
from kinematify.validation.stage import StageRequest
from tests.validation.engine_models import Box, Model, Part, cabinet, tell

SELECTED = frozenset(CHECKS)


def request_for(model: Model, folder: Path, *, seconds: float = 100.0) -> StageRequest:
    return StageRequest(
        urdf=model.write(folder),
        package_dirs=(),
        work=folder,
        settings=load_settings(),
        selected=SELECTED,
        deadline=time.process_time() + seconds,
    )


def found(model: Model, folder: Path) -> dict[str, list[Finding]]:
    """Warnings and errors by check."""
    results = tell(geometry, request_for(model, folder)).results
    assert set(results) == {check.id for check in checks_of("KV30", "KV31", "KV32", "KV33")}
    serious = {
        check: [finding for finding in result.findings if finding.severity is not Severity.NOTE]
        for check, result in results.items()
    }
    return {check: findings for check, findings in serious.items() if findings}


def notes(model: Model, folder: Path, check: str) -> list[Finding]:
    return list(tell(geometry, request_for(model, folder)).results[check].findings)


def only(findings: dict[str, list[Finding]], check: str) -> Finding:
    assert set(findings) == {check}
    (finding,) = findings[check]
    return finding


def test_a_good_cabinet_has_no_warning(tmp_path: Path) -> None:
    assert found(cabinet(), tmp_path) == {}


def test_free_travel_is_measured_beyond_the_declared_range(tmp_path: Path) -> None:
    reported: list[CheckResult | JointSummary] = []
    request = request_for(cabinet().with_part("drawer", limits=(0.0, 0.1)), tmp_path)
    geometry(request, Recorder(reported.append, request))
    drawer = next(item for item in reported if isinstance(item, JointSummary) and item.joint == "drawer_joint")
    assert drawer.declared_limits == (0.0, 0.1)
    low, high = drawer.free_travel or (0.0, 0.0)
    assert low == pytest.approx(-0.005, abs=1e-3)  # the back of the drawer has 5 mm to the back of the cabinet
    assert high == pytest.approx(0.2)  # one more range, and nothing was in the way


def beam(*parts: Part) -> Model:
    """A beam of 1 m along x with what hangs on it."""
    return Model(parts=(Part(name="beam", boxes=(Box(size=(1.0, 0.1, 0.1)),)), *parts))


def block(name: str, x: float, *, size: float = 0.1, z: float = 0.1, **changes: object) -> Part:
    """A block that slides along y on top of the beam."""
    values = {"parent": "beam", "kind": "prismatic", "axis": (0.0, 1.0, 0.0), "limits": (0.0, 0.04)} | changes
    return Part(name=name, boxes=(Box(size=(size, size, size)),), at=(x, 0.0, z), **values)  # type: ignore[arg-type]


def test_bodies_in_one_another_at_rest_are_an_error(tmp_path: Path) -> None:
    finding = only(found(beam(block("left", 0.0), block("right", 0.05)), tmp_path), "KV301")
    assert (finding.pair, finding.severity, finding.cause) == (("left", "right"), Severity.ERROR, Cause.ASSET)
    assert finding.value == pytest.approx(0.05, rel=0.1)


def test_a_body_inside_another_one_counts_as_overlap(tmp_path: Path) -> None:
    model = beam(block("shell", 0.0, size=0.3, z=0.2), block("core", 0.0, size=0.1, z=0.2))
    finding = found(model, tmp_path)["KV301"][0]
    assert finding.pair == ("shell", "core")
    assert "is inside the other" in finding.message


def test_overlap_of_the_collision_geometry_alone_points_to_it(tmp_path: Path) -> None:
    fat = (Box(size=(0.25, 0.1, 0.1)),)
    finding = only(found(beam(block("left", 0.0, collision=fat), block("right", 0.15)), tmp_path), "KV301")
    assert (finding.severity, finding.cause) == (Severity.WARNING, Cause.PHYSICS)
    assert "visible surfaces stay clear" in finding.message


def test_a_part_buried_in_its_parent_is_reported(tmp_path: Path) -> None:
    finding = only(found(beam(block("block", 0.0, size=0.02, z=0.0, limits=(0.0, 0.02))), tmp_path), "KV302")
    assert (finding.joint, finding.pair) == ("block_joint", ("beam", "block"))


def test_a_part_in_the_air_is_reported_with_its_gap(tmp_path: Path) -> None:
    finding = only(found(beam(block("block", 0.0, z=0.2)), tmp_path), "KV303")
    assert finding.joint == "block_joint"
    assert finding.value == pytest.approx(0.1)


@pytest.mark.parametrize(("kind", "across", "is_reported"), [
    ("continuous", 0.0, False),  # its axle is not drawn
    ("continuous", 0.3, True),  # and would not reach the beam
    ("revolute", 0.0, True),
])  # fmt: skip
def test_a_wheel_beside_what_carries_it_is_fine(tmp_path: Path, kind: str, across: float, is_reported: bool) -> None:
    wheel = Part(name="wheel", parent="beam", kind=kind, boxes=(Box(size=(0.2, 0.05, 0.2)),),
                 at=(0.3, 0.1, across), axis=(0.0, 1.0, 0.0))  # fmt: skip
    assert ("KV303" in found(beam(wheel), tmp_path)) is is_reported


def test_a_drawer_turned_sideways_is_blocked_to_both_sides(tmp_path: Path) -> None:
    model = cabinet().with_part("drawer", axis=(0.0, 1.0, 0.0), limits=(-0.3, 0.3))
    findings = found(model, tmp_path)["KV310"]
    assert [finding.joint for finding in findings] == ["drawer_joint"]
    assert findings[0].severity is Severity.ERROR
    assert findings[0].cause is Cause.KINEMATICS


def test_a_drawer_that_opens_inwards_has_the_wrong_direction(tmp_path: Path) -> None:
    (finding,) = found(cabinet().with_part("drawer", axis=(-1.0, 0.0, 0.0)), tmp_path)["KV310"]
    assert "the joint moves into its parent" in finding.message
    assert "Reverse" in finding.remedy


def test_what_is_in_its_parent_at_rest_cannot_be_judged_for_certain(tmp_path: Path) -> None:
    """Cylinders and boxes that stand for a hip overlap where they are joined, and more when it turns."""
    hip = Part(name="hip", parent="beam", kind="revolute", boxes=(Box(size=(0.1, 0.3, 0.04), at=(0.03, 0.0, 0.0)),),
               at=(0.5, 0.0, 0.0), axis=(0.0, 0.0, 1.0), limits=(-1.2, 1.2))  # fmt: skip
    findings = found(beam(hip), tmp_path)
    assert {finding.severity for check in ("KV310", "KV312") for finding in findings.get(check, [])} == {
        Severity.WARNING
    }


def test_a_part_driven_into_a_stranger_is_reported(tmp_path: Path) -> None:
    slider = block("slider", -0.3, axis=(1.0, 0.0, 0.0), limits=(0.0, 0.3))
    post = Part(name="post", boxes=(Box(size=(0.1, 0.1, 0.3)),), parent="beam", kind="revolute",
                at=(0.0, 0.0, 0.2), axis=(0.0, 0.0, 1.0), limits=(-0.1, 0.1))  # fmt: skip
    finding = only(found(beam(slider, post), tmp_path), "KV311")
    assert (finding.joint, finding.pair) == ("slider_joint", ("slider", "post"))
    assert "from 0.2 m on" in finding.message


def with_back(model: Model) -> Model:
    """A cabinet whose back is a link of its own, fixed to the body."""
    body = model.parts[0]
    back = Part(name="back", parent="body", boxes=body.boxes[-1:])
    return Model(parts=(replace(body, boxes=body.boxes[:-1]), back, *model.parts[1:]))


def test_of_links_that_are_fixed_together_the_one_at_the_place_is_named(tmp_path: Path) -> None:
    inwards = with_back(cabinet()).with_part("drawer", axis=(-1.0, 0.0, 0.0))
    (finding,) = found(inwards, tmp_path)["KV310"]
    assert finding.pair == ("back", "drawer")
    assert "back and drawer" in finding.message
    off = with_back(cabinet()).with_part("door", at=(0.4, 0.32, 0.0))
    assert only(found(off, tmp_path), "KV303").pair == ("body", "door")


def test_what_another_joint_can_clear_is_a_note(tmp_path: Path) -> None:
    slider = block("slider", -0.3, axis=(1.0, 0.0, 0.0), limits=(0.0, 0.3))
    gate = block("gate", 0.0, limits=(0.0, 0.2))
    assert "KV311" not in found(beam(slider, gate), tmp_path)
    (note,) = notes(beam(slider, gate), tmp_path, "KV311")
    assert "unless another joint has moved out of the way" in note.message


def arm(limits: tuple[float, float]) -> Model:
    """Two thin arms on a block: the upper one turns on top of it, the fore one folds down over the edge."""
    boxes, up, across = (Box(size=(0.4, 0.05, 0.02), at=(0.22, 0.0, 0.01)),), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)
    return Model(
        parts=(
            Part(name="base", boxes=(Box(size=(0.2, 0.2, 0.24)),)),
            Part(name="upper", parent="base", kind="continuous", at=(0.0, 0.0, 0.12), axis=up, boxes=boxes),
            Part(
                name="fore",
                parent="upper",
                kind="revolute",
                at=(0.42, 0.0, 0.0),
                axis=across,
                limits=limits,
                boxes=boxes,
            ),
        )
    )


def test_a_chain_that_folds_onto_itself_is_a_note(tmp_path: Path) -> None:
    assert "KV311" not in found(arm((0.0, 2.7)), tmp_path)
    (note,) = notes(arm((0.0, 2.7)), tmp_path, "KV311")
    assert (note.joint, note.pair) == ("fore_joint", ("base", "fore"))
    assert "the chain of joints between them reaches itself" in note.message


def test_a_range_beyond_the_free_travel_gets_the_measured_end(tmp_path: Path) -> None:
    finding = only(found(cabinet().with_part("door", limits=(0.0, 5.2)), tmp_path), "KV312")
    assert (finding.joint, finding.severity, finding.cause) == ("door_joint", Severity.ERROR, Cause.KINEMATICS)
    measured = float(finding.remedy.split('upper="')[1].split('"')[0])
    assert measured == pytest.approx(np.pi, abs=0.06)  # its thickness turns into the wall


@pytest.mark.parametrize(("width", "severity"), [(0.06, Severity.ERROR), (0.053, Severity.WARNING)])
def test_a_joint_that_cannot_leave_most_of_its_range_is_an_error(
    tmp_path: Path, width: float, severity: Severity
) -> None:
    sides = [Box(size=(0.5, 0.03, 0.1), at=(0.0, y, 0.0)) for y in (-0.0455, 0.0455)]
    frame = Part(name="frame", boxes=(*sides, Box(size=(0.03, 0.06, 0.1), at=(-0.235, 0.0, 0.0))))
    bar = Part(name="bar", parent="frame", kind="revolute", boxes=(Box(size=(width, width, 0.1)),),
               axis=(0.0, 0.0, 1.0), limits=(-1.57, 1.57))  # fmt: skip
    finding = only(found(Model(parts=(frame, bar)), tmp_path), "KV310")
    assert (finding.joint, finding.severity) == ("bar_joint", severity)


def test_a_joint_that_only_fat_collision_geometry_blocks_is_not_the_cause(tmp_path: Path) -> None:
    fat = (Box(size=(0.15, 0.3, 0.4), at=(-0.05, -0.15, 0.0)),)
    model = cabinet().with_part("door", limits=(0.0, 2.9), collision=fat)
    findings = [finding for findings in found(model, tmp_path).values() for finding in findings]
    blocked = [finding for finding in findings if finding.check in ("KV301", "KV302", "KV310", "KV312")]
    assert blocked
    assert {finding.cause for finding in blocked} == {Cause.PHYSICS}
    assert all(finding.severity is Severity.WARNING for finding in findings)


def test_a_rotor_that_only_collides_is_not_seen(tmp_path: Path) -> None:
    leg = Part(name="leg", parent="beam", kind="revolute", boxes=(Box(size=(0.3, 0.1, 0.01), at=(0.15, 0.0, 0.0)),),
               at=(0.508, 0.0, 0.0), axis=(0.0, 1.0, 0.0), limits=(-1.5, 1.5))  # fmt: skip
    rotor = Part(name="rotor", parent="leg", boxes=(), collision=(Box(size=(0.05, 0.05, 0.05)),), at=(0.0, 0.0, 0.12))
    finding = only(found(beam(leg, rotor), tmp_path), "KV312")
    assert (finding.pair, finding.severity, finding.cause) == (("beam", "rotor"), Severity.WARNING, Cause.PHYSICS)
    fin = Part(name="fin", parent="leg", boxes=(Box(size=(0.05, 0.05, 0.05)),), collision=(), at=(0.0, 0.0, -0.12))
    causes = {finding.pair: finding.cause for finding in found(beam(leg, rotor, fin), tmp_path)["KV312"]}
    assert causes == {("beam", "rotor"): Cause.PHYSICS}, "what is seen replaces no collision geometry"


def test_a_door_about_a_far_line_leaves_its_frame(tmp_path: Path) -> None:
    model = cabinet().with_part(
        "door", at=(0.205, 1.0, 0.0), boxes=(Box(size=(0.02, 0.3, 0.4), at=(0.01, -0.83, 0.0)),), axis=(0.0, 0.0, 1.0)
    )
    (finding,) = found(model, tmp_path)["KV320"]
    assert (finding.joint, finding.severity) == ("door_joint", Severity.ERROR)
    assert "turns away from its hinge" in finding.message
    apart = model.with_part("door", boxes=(Box(size=(0.02, 0.3, 0.4), at=(0.31, -0.83, 0.0)),))
    (finding,) = found(apart, tmp_path)["KV320"]
    assert finding.severity is Severity.WARNING, "what touches nothing at rest has no hinge to leave"


def test_a_drawer_longer_out_than_it_is_long_has_left_its_guide(tmp_path: Path) -> None:
    (finding,) = found(cabinet().with_part("drawer", limits=(0.0, 0.45)), tmp_path)["KV321"]
    assert finding.joint == "drawer_joint"
    assert finding.value == pytest.approx(0.45)


def doors(
    left: tuple[float, float], right: tuple[float, float], *, right_hinge: float = 0.2, right_tilt: float = 0.0
) -> Model:
    """Two doors of one size above a beam, hinged at its ends, or the right one elsewhere or about a tilted axis."""
    hinged = {"parent": "beam", "kind": "revolute"}
    panels = [Box(size=(0.2, 0.01, 0.3), at=(x, -0.06, 0.0)) for x in (0.1, 0.1 - right_hinge)]
    return beam(
        Part(name="left", boxes=(panels[0],), at=(-0.2, 0.0, 0.21), limits=left, axis=(0.0, 0.0, 1.0), **hinged),  # type: ignore[arg-type]
        Part(
            name="right",
            boxes=(panels[1],),
            at=(right_hinge, 0.0, 0.21),
            limits=right,
            axis=(right_tilt, 0.0, 1.0 - right_tilt),
            **hinged,  # type: ignore[arg-type]
        ),
    )


@pytest.mark.parametrize(
    ("right", "hinge", "tilt", "says"),
    [
        ((0.0, 1.5), 0.2, 0.0, None),  # mirrored, as double doors are
        ((-1.5, 0.0), 0.0, 0.0, None),  # repeated, as wardrobes in a row are
        ((-1.5, 0.0), 0.2, 0.0, "the other way round"),
        ((0.0, 3.0), 0.2, 0.0, "twice as wide"),
        ((0.0, 3.0), 0.15, 0.0, None),  # no twins: the line of one is elsewhere in it
    ],
)
def test_twins_whose_joints_differ_are_named(
    tmp_path: Path, right: tuple[float, float], hinge: float, tilt: float, says: str | None
) -> None:
    reported = found(doors((-1.5, 0.0), right, right_hinge=hinge, right_tilt=tilt), tmp_path).get("KV333", [])
    assert [finding.pair for finding in reported] == ([] if says is None else [("left", "right")])
    assert all(says in finding.message for finding in reported if says)


def test_time_that_ran_out_is_said(tmp_path: Path) -> None:
    results = tell(geometry, request_for(cabinet(), tmp_path, seconds=-1.0)).results
    assert results["KV310"].status is Status.SKIPPED
    assert "time ran out before 2 joints: drawer_joint, door_joint" in (results["KV310"].reason or "")


def test_one_body_has_nothing_to_meet(tmp_path: Path) -> None:
    results = tell(geometry, request_for(beam(), tmp_path)).results
    assert {result.status for result in results.values()} == {Status.SKIPPED}


def test_a_rail_may_go_through_a_solid_carriage(tmp_path: Path) -> None:
    rail = Part(name="rail", boxes=(Box(size=(4.0, 0.05, 0.05)),))
    cart = Part(name="cart", boxes=(Box(size=(0.5, 0.4, 0.2)),), parent="rail", kind="prismatic", limits=(-1.7, 1.7))
    assert found(Model(parts=(rail, cart)), tmp_path) == {}
    stop = replace(rail, boxes=(*rail.boxes, Box(size=(0.1, 0.4, 0.2), at=(1.0, 0.0, 0.0))))
    assert only(found(Model(parts=(stop, cart)), tmp_path), "KV312").joint == "cart_joint"


def test_a_joint_without_limits_is_warned_of_where_it_meets_its_parent(tmp_path: Path) -> None:
    model = cabinet().with_part("door", kind="continuous")
    severities = {finding.severity for findings in found(model, tmp_path).values() for finding in findings}
    assert severities == {Severity.WARNING}


@pytest.mark.parametrize(("limits", "is_reported"), [((-3.14, 3.14), False), ((-3.1, 3.1), True)])
def test_a_leg_that_reaches_the_body_after_half_a_turn_needs_no_limits(
    tmp_path: Path, limits: tuple[float, float], is_reported: bool
) -> None:
    """Half a turn to both sides is how files say that software limits a joint."""
    leg = Part(name="leg", parent="beam", kind="revolute", boxes=(Box(size=(0.3, 0.1, 0.05), at=(0.15, 0.0, 0.0)),),
               at=(0.55, 0.0, 0.0), axis=(0.0, 1.0, 0.0), limits=limits)  # fmt: skip
    assert ("KV312" in found(beam(leg), tmp_path)) is is_reported
    assert any(note.check == "KV312" for note in notes(beam(leg), tmp_path, "KV312")), "it is said all the same"
