"""Each kind of failure, on an object made to fail in just that way, points to the right decision alone."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Joint
from kinematify.validation.checks import CHECKS
from kinematify.validation.failure_rates import CLASSES, LINE, PARENT, TYPE, FailureRates, shipped_rates
from kinematify.validation.finding import Cause, CheckResult, Finding, JointSummary, Severity
from kinematify.validation.run.feedback import Feedback, feedback_from
from kinematify.validation.run.needs import Recorder, geometry
from tests.validation.engine_models import Box, Model, Part, cabinet
from tests.validation.test_geometry import beam, block, request_for

if TYPE_CHECKING:
    from pathlib import Path

RATES = FailureRates(
    joints={"right": 1000} | dict.fromkeys(CLASSES[1:], 100),
    failures={
        check: {
            "error": {"right": 50, "line": 60, "type": 40, "parent": 30, "range": 30},
            "warning": {"right": 100, "line": 60, "type": 40, "parent": 30, "range": 30},
        }
        for check in CHECKS
    },
    provenance={},
)


def declared(model: Model) -> dict[str, Joint]:
    """The joints of a model as the mapping knows them."""
    return {
        f"{part.name}_joint": Joint(
            name=f"{part.name}_joint",
            kind=JointType(part.kind),
            parent=part.parent,
            child=part.name,
            T_parent_child=np.eye(4),
            lower=part.limits[0],
            upper=part.limits[1],
        )
        for part in model.parts
        if part.parent is not None
    }


def fed_back(model: Model, folder: Path, *more: Finding) -> Feedback:
    """What the checks by geometry say of a model, and some findings of engines, as feedback."""
    reported: list[CheckResult | JointSummary] = []
    request = request_for(model, folder)
    geometry(request, Recorder(reported.append, request))
    findings = [finding for item in reported if isinstance(item, CheckResult) for finding in item.findings]
    summaries = [item for item in reported if isinstance(item, JointSummary)]
    return feedback_from([*findings, *more], summaries, declared(model), rates=RATES)


def engine(check: str, joint: str = "drawer_joint", **changes: object) -> Finding:
    """A finding of an engine or a task about the drawer of the cabinet."""
    known = Finding(
        check=check, severity=Severity.ERROR, cause=Cause.KINEMATICS, message="m", remedy="r", joint=joint,
        engine="mujoco",
    )  # fmt: skip
    return replace(known, **changes)


def test_a_good_model_has_nothing_to_feed_back(tmp_path: Path) -> None:
    assert not fed_back(cabinet(), tmp_path)


def test_blocked_to_both_sides_points_to_line_and_type_and_no_range(tmp_path: Path) -> None:
    model = cabinet().with_part("drawer", axis=(0.0, 1.0, 0.0), limits=(-0.3, 0.3))
    feedback = fed_back(model, tmp_path)
    assert {signal.child for signal in feedback.lines} == {"drawer"}
    assert {signal.child for signal in feedback.types} == {"drawer"}
    assert feedback.ranges == ()
    assert feedback.against("drawer") == pytest.approx(RATES.weight("KV310", Severity.ERROR, LINE))


def test_blocked_to_one_side_turns_the_joint_round_and_points_to_no_line(tmp_path: Path) -> None:
    feedback = fed_back(cabinet().with_part("drawer", axis=(-1.0, 0.0, 0.0)), tmp_path)
    assert feedback.lines == feedback.types == ()
    (signal,) = feedback.ranges
    assert (signal.child, signal.check) == ("drawer", "KV310")
    assert signal.lower is not None
    assert signal.lower <= -0.19
    assert signal.upper is not None
    assert signal.upper < 0.01


def test_a_range_beyond_the_free_travel_ends_there(tmp_path: Path) -> None:
    feedback = fed_back(cabinet().with_part("door", limits=(0.0, 5.2)), tmp_path)
    assert feedback.lines == feedback.types == ()
    (signal,) = feedback.ranges
    assert signal.lower is None
    assert signal.upper == pytest.approx(3.14, abs=0.06)
    assert not signal.lost


def test_what_runs_into_a_stranger_points_to_its_parent_for_that_stranger(tmp_path: Path) -> None:
    slider = block("slider", -0.3, axis=(1.0, 0.0, 0.0), limits=(0.0, 0.3))
    post = Part(name="post", boxes=(Box(size=(0.1, 0.1, 0.3)),), parent="beam", kind="revolute",
                at=(0.0, 0.0, 0.2), axis=(0.0, 0.0, 1.0), limits=(-0.1, 0.1))  # fmt: skip
    feedback = fed_back(beam(slider, post), tmp_path)
    (signal,) = feedback.edges
    assert (signal.parent, signal.child) == ("beam", "slider")
    assert signal.weight == pytest.approx(RATES.weight("KV311", Severity.WARNING, PARENT))
    assert feedback.lines == ()


def test_what_leaves_its_parent_points_to_line_and_type(tmp_path: Path) -> None:
    model = cabinet().with_part(
        "door", at=(0.205, 1.0, 0.0), boxes=(Box(size=(0.02, 0.3, 0.4), at=(0.01, -0.83, 0.0)),), axis=(0.0, 0.0, 1.0)
    )
    feedback = fed_back(model, tmp_path)
    assert [(signal.child, signal.check) for signal in feedback.lines] == [("door", "KV320")]
    assert [signal.child for signal in feedback.types] == ["door"]


def test_what_hangs_in_the_air_points_to_its_parent(tmp_path: Path) -> None:
    feedback = fed_back(beam(block("block", 0.0, z=0.2)), tmp_path)
    assert [(signal.parent, signal.child, signal.check) for signal in feedback.edges] == [("beam", "block", "KV303")]


def test_overlap_at_rest_points_to_no_axis(tmp_path: Path) -> None:
    assert not fed_back(beam(block("left", 0.0), block("right", 0.05)), tmp_path)


@pytest.mark.parametrize("check", ["KV801", "KV803", "KV806", "KV204"])
def test_disagreeing_engines_and_files_are_not_acted_on(tmp_path: Path, check: str) -> None:
    assert not fed_back(cabinet(), tmp_path, engine(check, cause=Cause.ENGINE))


def test_what_its_carrier_moves_into_another_body_blames_that_carrier(tmp_path: Path) -> None:
    meets = engine("KV311", joint="door_joint", pair=("drawer", "cabinet"), engine=None)
    hung = cabinet().with_part("drawer", parent="door")
    signals = [item for item in fed_back(hung, tmp_path, meets).edges if item.check == "KV311"]
    assert [(item.parent, item.child) for item in signals] == [("door", "drawer")]


def test_a_failure_weighs_what_is_sure_of_the_ratio_of_its_rates_and_chance_weighs_nothing() -> None:
    def rates(times: int) -> FailureRates:
        return FailureRates(
            joints={"right": 30 * times, "line": 30 * times, "parent": 2},
            failures={
                "KV310": {"error": {"right": times, "line": 24 * times}, "warning": {"right": 3 * times, "line": 6}},
                "KV312": {"error": {"right": 3 * times, "line": 3 * times}},
                "KV321": {"error": {"line": 2}},
            },
            provenance={},
        )

    few, many = rates(1), rates(1000)
    assert many.weight("KV310", Severity.ERROR, LINE) == pytest.approx(np.log(24), abs=0.1)
    assert 0.5 < few.weight("KV310", Severity.ERROR, LINE) < np.log(24) - 1.0, "one in thirty may be chance"
    assert many.weight("KV310", Severity.WARNING, LINE) == 0.0, "right joints warn as often"
    assert many.weight("KV312", Severity.ERROR, LINE) == 0.0
    assert few.weight("KV321", Severity.ERROR, LINE) == 0.0, "seen twice, it proves nothing"
    assert few.weight("KV320", Severity.ERROR, LINE) == 0.0, "never seen on any joint"
    assert few.weight("KV312", Severity.ERROR, PARENT) == 0.0, "two joints say little"


def test_the_shipped_rates_are_of_known_checks_and_no_failure_is_counted_twice() -> None:
    shipped = shipped_rates()
    assert shipped.joints["right"] > 0
    for check, by_severity in shipped.failures.items():
        assert check in CHECKS
        assert set(by_severity) <= {Severity.ERROR, Severity.WARNING}
        failed = sum((Counter(counts) for counts in by_severity.values()), Counter())
        assert set(failed) <= set(CLASSES)
        assert all(failed[what] <= shipped.joints[what] for what in failed), check
    assert min(shipped.weight("KV310", Severity.ERROR, wrong) for wrong in (LINE, TYPE)) > 0.0
