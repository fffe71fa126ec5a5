"""Which faults are planted in which models, and what of each a report has found."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.faults.fault import write_model
from benchmarks.faults.file_defects import FILE_DEFECTS, moving_links
from benchmarks.faults.kinematic import KINEMATIC_FAULTS, movable_joints
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from lxml.etree import _Element

    from benchmarks.faults.fault import BaseModel, Fault, PlantedFault
    from kinematify.robot.robot import Joint, Link, Robot
    from kinematify.validation.finding import Finding
    from kinematify.validation.run.report import ValidationReport

FAULTS: tuple[Fault, ...] = KINEMATIC_FAULTS + FILE_DEFECTS
_OPINION = "KV344"
"""Its notes hold something against a joint."""


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """One faulty model on disk."""

    model: str
    fault: str
    planted: PlantedFault
    urdf: str

    @property
    def name(self) -> str:
        """Unique and the same in every run."""
        return f"{self.model}: {self.fault} at {self.planted.joint or self.planted.links}: {self.planted.how}"


def write_mutants(bases: Sequence[BaseModel], count: int, seed: int, faults: Sequence[Fault] = FAULTS) -> list[Mutant]:
    """Plant `count` faults, rounded up to the same number of each kind, and write a model for each.

    A kind that has fewer places gets those. Within a kind the objects take turns, in an order drawn from the seed, and
    within an object its joints or links do, so that no object and no joint has its second fault of a kind before all
    have their first.
    """
    each = -(-count // len(faults))
    mutants: list[Mutant] = []
    for fault in faults:
        mutants += _of_kind(fault, bases, each, seed)
    return mutants


def _of_kind(fault: Fault, bases: Sequence[BaseModel], count: int, seed: int) -> list[Mutant]:
    random = np.random.default_rng([seed, zlib.crc32(fault.name.encode())])
    turns = [_chances(fault, bases[index], random, seed) for index in random.permutation(len(bases))]
    found: list[Mutant] = []
    while turns and len(found) < count:
        for chance in list(turns):
            mutant = next(chance, None)
            if mutant is None:
                turns.remove(chance)
            else:
                found.append(mutant)
            if len(found) == count:
                break
    return found


def _chances(fault: Fault, base: BaseModel, random: np.random.Generator, seed: int) -> Iterator[Mutant]:
    """Faults of one kind in one object: every place once."""
    model = base.robot()
    places = movable_joints(model) if fault.plant_joint else moving_links(model)
    for number, index in enumerate(random.permutation(len(places))):
        robot = base.tree()
        planted = _plant(fault, robot, places[index], model, random)
        if planted is None:
            continue
        urdf = base.folder / f"{fault.name.replace(' ', '_').replace('%', 'percent')}-{seed}-{number}.urdf"
        write_model(robot, urdf)
        yield Mutant(model=base.name, fault=fault.name, planted=planted, urdf=str(urdf))


def _plant(
    fault: Fault,
    robot: _Element,
    place: Joint | Link,
    model: Robot,
    random: np.random.Generator,
) -> PlantedFault | None:
    planter = fault.plant_joint or fault.plant_link
    if planter is None:
        raise ValueError(f"The fault {fault.name} has no way of being planted.")
    return planter(robot, place, model, random)  # type: ignore[arg-type]


Fact = dict[str, Any]
"""What is kept of a finding: check, severity, cause, joint, link, pair."""


class Verdict(StrEnum):
    """What became of a planted fault."""

    FOUND = "found"
    """A new warning or error names the joint or link and the right cause."""
    NOTED = "only as a note"
    """A new note does: the shapes suggest otherwise, and no fact agrees."""
    ELSEWHERE = "elsewhere"
    """There are new warnings or errors, but they name something else or another cause."""
    MISSED = "missed"
    """Nothing new was found."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """A mutant and what was said of it."""

    verdict: Verdict
    right: tuple[Fact, ...]
    other: tuple[Fact, ...]


def facts(report: ValidationReport) -> list[Fact]:
    """Warnings and errors of a report, and the notes that hold something against a joint, short."""
    return [
        _fact(finding)
        for finding in report.findings
        if finding.severity is not Severity.NOTE or finding.check == _OPINION
    ]


def _fact(finding: Finding) -> Fact:
    return {
        "check": finding.check,
        "severity": finding.severity.value,
        "cause": finding.cause.value,
        "joint": finding.joint,
        "link": finding.link,
        "pair": list(finding.pair) if finding.pair else None,
    }


def judge(fault: Fault, planted: PlantedFault, found: Sequence[Fact], untouched: Sequence[Fact]) -> Outcome:
    """Compare the findings of a mutant with those of the model that it was made from."""
    known = {_key(fact) for fact in untouched}
    new = [fact for fact in found if _key(fact) not in known]
    right = [fact for fact in new if _names(fact, planted) and fact["cause"] in fault.causes]
    other = tuple(fact for fact in new if fact not in right)
    if any(_counts(fact) for fact in right):
        verdict = Verdict.FOUND
    elif right:
        verdict = Verdict.NOTED
    else:
        verdict = Verdict.ELSEWHERE if any(map(_counts, other)) else Verdict.MISSED
    return Outcome(verdict=verdict, right=tuple(right), other=other)


def _counts(fact: Fact) -> bool:
    return bool(fact["severity"] != Severity.NOTE)


def _key(fact: Fact) -> tuple[Any, ...]:
    return fact["check"], _counts(fact), fact["joint"], fact["link"], tuple(fact["pair"] or ())


def _names(fact: Fact, planted: PlantedFault) -> bool:
    """The joint itself, or without a joint one of the links; any place where the whole model is wrong."""
    if not planted.links:
        return True
    if fact["joint"] is not None and planted.joint is not None:
        return bool(fact["joint"] == planted.joint)
    named: Collection[str] = [name for name in (fact["link"], *(fact["pair"] or ())) if name]
    return any(link in named for link in planted.links)
