"""The faults of the detection benchmark are what they are said to be, and nothing else."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from lxml import etree

from benchmarks.faults.fault import BaseModel, PlantedFault, write_base
from benchmarks.faults.plan import FAULTS, Mutant, Verdict, judge, write_mutants
from kinematify.assembly.erasure import ErasedModel, erase
from kinematify.evaluation.datasets import BenchObject
from kinematify.robot.read import read_robot
from tests.household import barrel_hinge_door, nested_drawer
from tests.known import KnownObject
from tests.validation.planted import write


def base_of(known: KnownObject, folder: Path) -> BaseModel:
    """A known object as a clean model of the benchmark."""
    urdf = write(known, folder / known.name)
    return write_base(BenchObject(name=known.name, urdf=urdf, kind="other", category="other"), folder / "work")


@pytest.fixture(scope="module")
def bases(tmp_path_factory: pytest.TempPathFactory) -> list[BaseModel]:
    folder = tmp_path_factory.mktemp("mutants")
    return [base_of(known, folder) for known in (nested_drawer(), barrel_hinge_door())]


@pytest.fixture(scope="module")
def mutants(bases: list[BaseModel]) -> list[Mutant]:
    return write_mutants(bases, 2 * len(FAULTS), seed=3)


@cache
def at_rest(urdf: str | Path) -> ErasedModel:
    return erase(read_robot(Path(urdf), geometry="shown"), shuffle=False)


def of(mutants: list[Mutant], fault: str) -> list[Mutant]:
    return [mutant for mutant in mutants if mutant.fault == fault]


def test_kinematic_faults_leave_the_object_at_rest_as_it_was(bases: list[BaseModel], mutants: list[Mutant]) -> None:
    good = {base.name: at_rest(base.urdf) for base in bases}
    faults = {fault.name for fault in FAULTS if fault.kinematic}
    for mutant in mutants:
        if mutant.fault not in faults:
            continue
        parts = {tuple(links): part for links, part in _bodies(at_rest(mutant.urdf))}
        for links, part in _bodies(good[mutant.model]):
            np.testing.assert_allclose(parts[tuple(links)].vertices, part.vertices, atol=1e-9, err_msg=mutant.name)


def _bodies(erased: ErasedModel) -> list:
    return list(zip(erased.truth.part_links, erased.parts, strict=True))


def test_faults_are_as_large_as_they_are_said_to_be(bases: list[BaseModel], mutants: list[Mutant]) -> None:
    good = {base.name: {joint.source: joint for joint in at_rest(base.urdf).truth.joints} for base in bases}
    sizes = {base.name: {links[0]: part.diagonal for links, part in _bodies(at_rest(base.urdf))} for base in bases}
    for mutant in mutants:
        if mutant.planted.joint is None or not any(f.name == mutant.fault and f.kinematic for f in FAULTS):
            continue
        before = good[mutant.model][mutant.planted.joint]
        erased = at_rest(mutant.urdf)
        (after,) = [joint for joint in erased.truth.joints if joint.source == mutant.planted.joint]
        angle = np.degrees(np.arccos(np.clip(before.axis @ after.axis, -1, 1)))
        expected = {"axis turned by 20 deg": 20.0, "axis turned by 90 deg": 90.0, "direction flipped": 180.0}
        assert angle == pytest.approx(expected.get(mutant.fault, 0.0), abs=1e-4), mutant.name
        apart = np.linalg.norm(np.cross(after.pivot - before.pivot, before.axis))
        moved = 0.2 * sizes[mutant.model][mutant.planted.links[0]] if mutant.fault.startswith("pivot") else 0.0
        if before.kind.turns:
            assert apart == pytest.approx(moved, abs=1e-9), mutant.name
        if mutant.fault == "range doubled":
            assert after.upper - after.lower == pytest.approx(2 * (before.upper - before.lower))
        if mutant.fault == "type swapped":
            assert after.kind.turns != before.kind.turns
        if mutant.fault == "wrong parent":
            assert erased.truth.part_links[after.parent] != ("drawer",)


def test_what_changes_nothing_is_not_planted(tmp_path: Path) -> None:
    base = base_of(barrel_hinge_door(), tmp_path)
    robot = etree.parse(base.urdf).getroot()
    limit = robot.find("joint/limit")
    limit.set("lower", "-1.0")
    limit.set("upper", "1.0")
    etree.ElementTree(robot).write(base.urdf)
    planted = {mutant.fault for mutant in write_mutants([base], len(FAULTS), seed=0)}
    assert "direction flipped" not in planted
    assert "wrong parent" not in planted


FACT = {"check": "KV349", "severity": "error", "cause": "kinematics", "joint": "hinge", "link": None, "pair": None}
NOTE = {**FACT, "severity": "note"}
PLANTED = PlantedFault(how="turned", joint="hinge", links=("door",))


@pytest.mark.parametrize(
    ("found", "untouched", "verdict"),
    [
        ([FACT], [], Verdict.FOUND),
        ([FACT], [FACT], Verdict.MISSED),
        ([NOTE], [], Verdict.NOTED),
        ([NOTE], [NOTE], Verdict.MISSED),
        ([FACT], [NOTE], Verdict.FOUND),
        ([{**NOTE, "joint": "other"}], [], Verdict.MISSED),
        ([{**FACT, "joint": "other"}], [], Verdict.ELSEWHERE),
        ([{**FACT, "cause": "physics"}], [], Verdict.ELSEWHERE),
        ([{**FACT, "joint": None, "link": "door"}], [], Verdict.FOUND),
        ([{**FACT, "joint": None, "pair": ["frame", "door"]}], [], Verdict.FOUND),
        ([{**FACT, "joint": None, "link": "frame"}], [], Verdict.ELSEWHERE),
        ([], [], Verdict.MISSED),
    ],
)
def test_only_a_new_finding_with_name_and_cause_counts(found: list, untouched: list, verdict: Verdict) -> None:
    assert judge(FAULTS[0], PLANTED, found, untouched).verdict is verdict
