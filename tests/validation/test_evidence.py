"""Each fault of a joint is reported from the geometry alone, and a good joint is left in peace."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from kinematify.robot.joint_type import JointType
from kinematify.validation.checks import checks_of
from kinematify.validation.finding import Cause, CheckResult, JointSummary, Severity, Status
from kinematify.validation.run import validate
from tests.household import (
    barrel_hinge_door,
    button,
    drawer,
    edge_door,
    hinge_pin,
    knob,
    lever,
    nested_drawer,
)
from tests.known import KnownObject
from tests.validation.planted import (
    findings,
    joint_of,
    judged,
    shifted,
    swapped,
    turned,
    with_joint,
    write,
)

Build = Callable[[], KnownObject]
GOOD: tuple[Build, ...] = (barrel_hinge_door, button, drawer, edge_door, hinge_pin, knob, nested_drawer)


def found(known: KnownObject, folder: Path) -> set[str]:
    """Ids of the checks that found something in the only joint that was changed."""
    return {finding.check for finding in findings(judged(known, folder))}


@pytest.mark.parametrize("build", GOOD)
def test_good_joints_have_no_finding(build: Build, tmp_path: Path) -> None:
    results = judged(build(), tmp_path)
    assert [finding.message for finding in findings(results)] == []
    reported = [result for result in results if isinstance(result, CheckResult)]
    assert {result.check for result in reported} == {check.id for check in checks_of("KV34")}
    assert all(result.status is Status.PASS for result in reported)


@pytest.mark.parametrize(
    ("build", "child", "about"),
    [
        (edge_door, "door", (1.0, 1.0, 0.0)),
        (drawer, "drawer", (0.2, 0.0, 1.0)),
        (knob, "knob", (1.0, 0.0, 0.4)),
    ],
)
def test_an_axis_turned_by_20_deg_is_off_every_direction(
    build: Build, child: str, about: tuple[float, float, float], tmp_path: Path
) -> None:
    finding, *facts = findings(judged(turned(build(), child, 20.0, about), tmp_path))
    assert {fact.check for fact in facts} <= {"KV349"}
    assert (finding.joint, finding.cause) == (f"{child}_joint", Cause.KINEMATICS)
    if finding.check != "KV349":
        assert (finding.check, finding.severity) == ("KV344", Severity.NOTE)
        assert re.search("(19|20)[.].* deg off", finding.message)  # lines of two barrels are measured from drawn points


@pytest.mark.parametrize(
    ("build", "child", "about"),
    [
        (edge_door, "door", (0, 1, 0)),
        (drawer, "drawer", (1, 0, 0)),
        (lever, "lever", (0, 0, 1)),
    ],
)
def test_an_axis_turned_by_90_deg_has_a_better_alternative(
    build: Build, child: str, about: tuple[float, float, float], tmp_path: Path
) -> None:
    good = build()
    results = judged(turned(good, child, 90.0, about), tmp_path)
    assert {finding.joint for finding in findings(results)} == {f"{child}_joint"}
    (summary,) = [result for result in results if isinstance(result, JointSummary)]
    assert summary.best_alternative is not None
    # A better joint is one of the object as it is, whatever was written.
    assert abs(np.dot(summary.best_alternative["axis"], joint_of(good, child).axis)) > np.cos(np.radians(1.0))


@pytest.mark.parametrize(
    ("bad", "opens"),
    [
        (lambda: turned(edge_door(), "door", 20.0, (1.0, 1.0, 0.0)), 0.025),
        (lambda: shifted(hinge_pin(), "bored_leaf", (1, 1, 0)), 0.01),
    ],
)
def test_a_contact_that_opens_about_a_wrong_line_is_a_fact(bad: Build, opens: float, tmp_path: Path) -> None:
    known = bad()
    report = validate(write(known, tmp_path), selected={check.id for check in checks_of("KV34")}, engines=())
    (finding,) = [finding for finding in report.findings if finding.check.startswith("KV34")]
    assert (finding.check, finding.severity, finding.cause) == ("KV349", Severity.WARNING, Cause.KINEMATICS)
    (child,) = [part for part in known.parts if finding.joint == f"{part.name}_joint"]
    assert finding.value is not None
    assert finding.limit is not None
    assert finding.value > finding.limit + opens * child.diagonal


@pytest.mark.parametrize(
    "bad",
    [
        lambda: shifted(barrel_hinge_door(), "door", (1, 0, 0)),
        lambda: shifted(edge_door(), "door", (0, -1, 0)),
        lambda: swapped(drawer(), "drawer", (0.0, 1.0)),
        lambda: swapped(barrel_hinge_door(), "door", (0.0, 0.4)),
    ],
)
def test_a_moved_pivot_and_a_swapped_type_are_reported(bad: Build, tmp_path: Path) -> None:
    assert found(bad(), tmp_path) & {"KV344", "KV349"}


def test_a_range_that_is_unusual_for_the_part_is_reported(tmp_path: Path) -> None:
    good = edge_door()
    assert found(with_joint(good, "door", upper=2.0 * joint_of(good, "door").upper), tmp_path) == {"KV348"}


@pytest.mark.parametrize(("limits", "reported_of"), [((0.0, 6.28), True), ((-6.28, 6.28), False), ((0.0, 6.0), False)])
def test_a_limited_whole_turn_to_one_side_is_reported(
    limits: tuple[float, float], reported_of: bool, tmp_path: Path
) -> None:
    wide = with_joint(knob(), "knob", kind=JointType.REVOLUTE, lower=limits[0], upper=limits[1])
    assert (found(wide, tmp_path) == {"KV348"}) is reported_of


def test_notes_reach_the_report(tmp_path: Path) -> None:
    urdf = write(with_joint(nested_drawer(), "tray", parent="carcass"), tmp_path)
    report = validate(urdf, selected={check.id for check in checks_of("KV34")}, engines=())
    assert [(item.check, item.joint, item.severity) for item in report.findings if item.check.startswith("KV34")] == [
        ("KV344", "tray_joint", Severity.NOTE)
    ]
    (summary,) = [joint for joint in report.joints if joint.joint == "tray_joint"]
    assert summary.kind == "prismatic"


def test_a_remedy_names_the_axis_in_the_frame_of_its_joint(tmp_path: Path) -> None:
    finding = findings(judged(turned(drawer(), "drawer", 20.0, (0.2, 0.0, 1.0)), tmp_path))[0]
    written = re.search(r'<axis xyz="([^"]+)"/> in the joint drawer_joint', finding.remedy)
    assert written is not None
    axis = np.array(written[1].split(), dtype=float)
    assert abs(axis @ joint_of(drawer(), "drawer").axis) > np.cos(np.radians(2.0))
