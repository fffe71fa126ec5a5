"""Which faults are planted where: evenly over kinds and objects, the same for the same seed."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.faults.base import write_model
from benchmarks.faults.file_defects import FILE_DEFECTS, moving_links
from benchmarks.faults.kinematic import KINEMATIC_FAULTS, movable_joints

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from lxml.etree import _Element

    from benchmarks.faults.base import BaseModel
    from benchmarks.faults.fault import Fault, Planted
    from kinematify.robot.robot import Joint, Link, Robot

FAULTS: tuple[Fault, ...] = KINEMATIC_FAULTS + FILE_DEFECTS


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """One faulty model on disk."""

    model: str
    fault: str
    planted: Planted
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
) -> Planted | None:
    planter = fault.plant_joint or fault.plant_link
    if planter is None:
        raise ValueError(f"The fault {fault.name} has no way of being planted.")
    return planter(robot, place, model, random)  # type: ignore[arg-type]
