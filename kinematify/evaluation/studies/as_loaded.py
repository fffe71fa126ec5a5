"""Do the files that are written work in engines as they are?

Objects of the benchmark are inferred from their parts alone and written; generated ones are written with the joints
that they were built with. Each file is loaded with the engine's own defaults: `MjModel.from_xml_path`, and `loadURDF`
with a fixed base, with and without self-collision. It is left alone under gravity for 4 s, in which no joint may leave
its range, and then each joint is pushed by a hand (60 N or 15 N m; machines by the effort that their file declares),
the others held: it must move over 95 % of its range, which ends where exact geometry blocks it. `blocked` counts the
joints of which that is less than what is declared; `still` are models in which nothing moves by itself.
"""

from __future__ import annotations

import math
import tempfile
import time
from dataclasses import asdict, dataclass
from functools import partial
from operator import itemgetter
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Annotated, Literal

import pybullet as bullet
from pydantic import Field

from kinematify.config import load_config
from kinematify.evaluation.datasets import CONDITIONS, find_objects
from kinematify.evaluation.job import erased_item, shown_parts
from kinematify.evaluation.record import grouped, table
from kinematify.evaluation.study import Options, Study, among, explained
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.model.dynamics import moved_by_hand
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model
from kinematify.pipeline import infer
from kinematify.pipeline.generate import true_model
from kinematify.simulation.as_loaded import PLAIN_WORLDS, as_loaded

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from kinematify.config import Config
    from kinematify.evaluation.datasets import BenchObject
    from kinematify.evaluation.record import Report
    from kinematify.evaluation.study import Measured, Record, Work
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.model.simulable import SimulableModel
    from kinematify.robot.robot import Joint, Robot
    from kinematify.simulation.as_loaded import AsLoaded

_DEEP = 0.005
"""Overlap at rest that is counted [m]."""


class AsLoadedOptions(Options):
    """Which objects, and which collision geometry."""

    data: tuple[str, ...] = Field(("everyday",), description="Sets or folders of objects, separated by commas.")
    seeds: int = Field(1, ge=0, description="Objects per family of the generator.")
    families: Annotated[tuple[str, ...], among(FAMILIES)] = Field(
        (), description="Only these families, separated by commas."
    )
    collision: Literal["auto", "mesh"] = Field("auto", description="Collision geometry that is written.")


@dataclass(frozen=True, kw_only=True)
class Case:
    """One object, and how it is written."""

    item: BenchObject | None
    """To be inferred; None for a generated one."""
    family: str
    seed: int
    collision: str


def measure(options: AsLoadedOptions, work: Work) -> Measured:
    """Write every object and try it in every engine."""
    found = {item.name: item for data in options.data for item in find_objects(data)}
    cases = {name: Case(item=item, family="", seed=0, collision=options.collision) for name, item in found.items()}
    for seed in range(options.seeds):
        for family in options.families or FAMILIES:
            case = Case(item=None, family=family, seed=seed, collision=options.collision)
            cases[f"{family} {seed}"] = case
    return list(work.each(tried_as_loaded, cases, timeout=900.0).values()), {}


def tried_as_loaded(case: Case) -> Record:
    """Infer or build an object, write it and try it."""
    config = load_config()
    config = config.model_copy(update={"collision": config.collision.model_copy(update={"mode": case.collision})})
    if case.item is not None:
        model = infer(shown_parts(erased_item(case.item, CONDITIONS[0])), config=config).model
        return {"set": case.item.urdf.parents[1].name, "object": case.item.name, **_tried(model, config)}
    blueprint = build(FAMILIES[case.family], {}, seed=case.seed, name=f"{case.family}_{case.seed}")
    model = true_model(blueprint, config)
    return {"set": "generated", "object": f"{case.family} {case.seed}", **_tried(model, config)}


def _tried(model: KinematicModel, config: Config) -> Record:
    start = time.process_time()
    made = simulable_model(model, config)
    seconds = time.process_time() - start
    free = _free(made)
    forces = {joint.name: _force(made.robot, joint, config) for joint in made.robot.leaders}
    with tempfile.TemporaryDirectory() as folder:
        urdf = write_model(made.robot, Path(folder))
        worlds = {world: _plain(partial(as_loaded, urdf, made.robot, world, forces, free)) for world in PLAIN_WORLDS}
    return {
        "joints": len(forces),
        "blocked": len(free),
        "pieces": [len(link.collisions) for link in made.robot.links],
        "seconds": seconds,
        "worlds": worlds,
    }


def _force(robot: Robot, joint: Joint, config: Config) -> float:
    """What a joint is pushed with [N m or N]."""
    hand = config.dynamics.hand_torque if joint.kind.turns else config.dynamics.hand_force
    return hand if moved_by_hand(robot, joint) else max(hand, joint.effort or 0.0)


def _free(made: SimulableModel) -> dict[str, tuple[float, float]]:
    """Where exact geometry leaves joints free, for those that it blocks within their range."""
    found: dict[str, tuple[float, float]] = {}
    for item in made.collision.blocked if made.collision is not None else ():
        low, high = found.get(item.joint, (-math.inf, math.inf))
        found[item.joint] = (max(low, item.at), high) if item.at < 0.0 else (low, min(high, item.at))
    return found


def _plain(tried: Callable[[], AsLoaded]) -> Record:
    """What came of one engine as JSON values; the words of an engine that does not load the file."""
    try:
        found = tried()
    except (ValueError, bullet.error) as error:
        return {"refused": str(error), "joints": {}, "depth": 0.0}
    return {
        "joints": {joint.joint: {**asdict(joint), "works": joint.works} for joint in found.joints},
        "depth": found.depth,
    }


def report(found: Report[Record]) -> list[str]:
    """Models and joints that work, by set and engine, and every joint that does not."""
    groups = grouped(found.records, by=itemgetter("set"))
    rows = [_row(name, group, world) for name, group in groups.items() for world in PLAIN_WORLDS]
    pieces = [count for record in found.records for count in record["pieces"]]
    seconds = [record["seconds"] for record in found.records]
    facts = (
        f"Collision pieces of a link: median {median(pieces):.0f}, most {max(pieces)}. Time of a processor to fit "
        f"them: median {median(seconds):.1f} s, most {max(seconds):.1f} s an object."
    )
    return [
        explained(__doc__),
        table(("set", "engine", "models that work", "joints that work", "blocked", "still", "deeper than 5 mm"), rows),
        facts,
        "## What does not work",
        "\n".join(_failing(found.records)) or "Nothing.",
    ]


def _row(name: str, records: Sequence[Record], world: str) -> tuple[str, ...]:
    tried = [record["worlds"][world] for record in records]
    joints = [joint for one in tried for joint in one["joints"].values()]
    return (
        name,
        world,
        f"{sum(_works(one) for one in tried)} of {len(tried)}",
        f"{sum(joint['works'] for joint in joints)} of {sum(record['joints'] for record in records)}",
        str(sum(record["blocked"] for record in records)),
        str(sum(all(joint["still"] for joint in one["joints"].values()) for one in tried)),
        str(sum(one["depth"] > _DEEP for one in tried)),
    )


def _works(tried: Record) -> bool:
    return "refused" not in tried and all(joint["works"] for joint in tried["joints"].values())


def _failing(records: Sequence[Record]) -> Iterator[str]:
    for record in records:
        for world, tried in record["worlds"].items():
            if "refused" in tried:
                yield f"- {record['set']}, {record['object']}, {world}: refused, {tried['refused']}"
            for joint in tried["joints"].values():
                if not joint["works"]:
                    yield (
                        f"- {record['set']}, {record['object']}, {world}, {joint['joint']}: moves over "
                        f"{joint['reached']:.0%} of its range, leaves it by {joint['beyond']:.3f} rad or m."
                    )


STUDY = Study(title="The files as they are loaded", options=AsLoadedOptions, measure=measure, report=report)
