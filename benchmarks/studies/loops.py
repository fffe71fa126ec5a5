"""Are closed chains found, exported, and closed while they move?

Linkages are drawn, cut into their parts, and inferred from these alone. *Found*: the model has as many loop joints as
the linkage has independent loops, and the chain moves as freely as the true one. *Exported*: the MJCF holds all of
them. *Closed*: in MuJoCo, the joint that drives the chain is moved from rest to both ends by its own motor, gravity and
contacts on, weight and friction of the whole chain made up for, and neither end of a pin is ever farther from the other
than 0.1 % of the diagonal; the way must be made to 90 %.

The linkages are ours: they were drawn for this study, with modelled pins and holes, and seen while the code was
written: in-sample.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import Field

from benchmarks.linkages import KINDS, linkage
from benchmarks.study import Options, Study, explained
from kinematify.config import load_config
from kinematify.evaluation.result_record import table
from kinematify.formats.export_model import export
from kinematify.model.output import MODEL_FILE
from kinematify.pipeline.blueprint_files import true_model
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.record import write_inference
from kinematify.robot.joint_type import JointType
from kinematify.robot.linkage import linkages
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.read import read_robot
from kinematify.robot.robot import joint_ends, rest_configuration

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot

_CLOSED = 1.0e-3
"""Largest gap of a pin, in diagonals."""
_REACHED = 0.9
"""Least share of its way that the driver makes."""
_SECONDS = 3.0
"""From rest to an end."""
_PACE = 2.0 * np.pi * 10.0
"""Of the servo [rad/s]."""


class LoopOptions(Options):
    """Which linkages."""

    seeds: int = Field(3, ge=1, description="Draws of each kind.")
    kinds: tuple[str, ...] = Field(tuple(KINDS), description="Kinds of linkages.")


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """One linkage to be inferred."""

    kind: str
    seed: int
    folder: str


def measure(options: LoopOptions, work: Work) -> Measured:
    """Infer and move every linkage."""
    asked = {
        f"{kind} {seed}": Drawn(kind=kind, seed=seed, folder=str(work.folder))
        for kind in options.kinds
        for seed in range(options.seeds)
    }
    records = list(work.each(measured, asked, timeout=900.0).values())
    return records, {}


def measured(asked: Drawn) -> Record:
    """Infer one linkage from its parts, write it, and move it."""
    start = time.perf_counter()
    blueprint = linkage(asked.kind, asked.seed)
    true = true_model(blueprint, load_config())
    inference = infer(blueprint.assembly)
    folder = Path(asked.folder, f"{asked.kind}_{asked.seed}")
    write_inference(inference, folder, overwrite=True, preview=False)
    urdf = folder / MODEL_FILE
    robot = read_robot(urdf, geometry="none")
    exported = folder / "model.xml"
    export(urdf, "mjcf", exported)
    found = len(robot.loops) >= len(true.loops) and _freedom(robot) == _freedom(true.robot)
    record = {
        "kind": asked.kind,
        "seed": asked.seed,
        "loops": len(true.loops),
        "written": len(robot.loops),
        "refused": sum(chain.closing.loop is None for chain in inference.closed_chains),
        "freedom": _freedom(robot),
        "true_freedom": _freedom(true.robot),
        "mimic": sum(joint.mimic is not None for joint in robot.joints),
        "found": found,
    }
    diagonal = inference.assembly.diagonal
    ways = list(_in_mujoco(exported, robot))
    record["mujoco"] = {
        "pins": max((way.pins for way in ways), default=0),
        "gap": max((way.gap for way in ways), default=float("nan")) / diagonal,
        "reached": min((way.reached for way in ways), default=0.0),
    }
    return {**record, "seconds": round(time.perf_counter() - start, 1)}


def _freedom(robot: Robot) -> int:
    """Motions of the joints that loops hold, all loops together."""
    free = tuple(
        replace(joint, kind=JointType.CONTINUOUS, lower=-np.inf, upper=np.inf, mimic=None)
        if joint.kind.turns
        else replace(joint, mimic=None)
        for joint in robot.joints
    )
    return sum(found.mobility for found in linkages(replace(robot, joints=free)))


@dataclass(frozen=True, kw_only=True)
class Way:
    """One driver on its way to one end."""

    pins: int
    gap: float
    """Largest of a pin [m]."""
    reached: float
    """Share of the way."""


def _ways(robot: Robot) -> Iterator[tuple[str, float, float]]:
    """Drivers of loops with rest and end."""
    driving = {found.driver for found in linkages(robot)} | {
        joint.mimic.joint for joint in robot.joints if joint.mimic is not None
    }
    rest = rest_configuration(robot)
    leaders = [joint for joint in robot.leaders if joint.name in driving]
    for joint, *ends in zip(leaders, *joint_ends(leaders), strict=True):
        for end in map(float, ends):
            if abs(end - rest[joint.name]) > 1e-3:  # 0.06 deg, or 1 mm
                yield joint.name, rest[joint.name], end


def _in_mujoco(xml: Path, robot: Robot) -> Iterator[Way]:
    import mujoco  # noqa: PLC0415 - only the processes of the records need it

    model = mujoco.MjModel.from_xml_path(str(xml))
    pins = [k for k in range(model.neq) if model.eq_type[k] == mujoco.mjtEq.mjEQ_CONNECT]

    def gap(data: Any) -> float:
        worst = 0.0
        for pin in pins:
            ends = [
                data.xpos[body] + data.xmat[body].reshape(3, 3) @ model.eq_data[pin, 3 * k : 3 * k + 3]
                for k, body in enumerate((model.eq_obj1id[pin], model.eq_obj2id[pin]))
            ]
            worst = max(worst, float(np.linalg.norm(ends[0] - ends[1])))
        return worst

    chain = _Chain(robot)
    joints = [model.joint(name) for name in chain.mechanism.joints]
    qpos, dof = (np.array([int(adr[0]) for adr in adrs]) for adrs in
                 ([joint.qposadr for joint in joints], [joint.dofadr for joint in joints]))  # fmt: skip
    motors = [model.actuator(name).id for name in chain.leaders]
    friction = model.dof_frictionloss[dof]
    for driver, rest, end in _ways(robot):
        data, inertia = mujoco.MjData(model), np.zeros((model.nv, model.nv))
        worst, steps = 0.0, round(_SECONDS / model.opt.timestep)
        data.qpos[qpos] = chain.start
        for step in range(steps):
            mujoco.mj_step1(model, data)
            mujoco.mj_fullM(model, data, inertia)
            aim, speed = chain.aims(driver, rest, end, step / steps)
            leads = chain.mechanism.leads_at(data.qpos[qpos][chain.columns])
            stiffness, damping = _gains(np.diag(leads.T @ inertia[np.ix_(dof, dof)] @ leads))
            push = stiffness * (aim - data.qpos[qpos][chain.columns]) + damping * (
                speed - data.qvel[dof][chain.columns]
            )
            ahead = leads.T @ data.qfrc_bias[dof] + (np.abs(leads).T @ friction) * np.sign(speed)
            data.ctrl[motors] = push + ahead
            mujoco.mj_step2(model, data)
            worst = max(worst, gap(data))
        made = (float(data.qpos[model.joint(driver).qposadr[0]]) - rest) / (end - rest)
        yield Way(pins=len(pins), gap=worst, reached=made)


class _Chain:
    """What servos of the joints that lead have to move: a driver moves its whole chain."""

    def __init__(self, robot: Robot) -> None:
        self.mechanism = LeaderMechanism(robot=robot)
        self.leaders = [travel.joint for travel in self.mechanism.travels]
        self.columns = [self.mechanism.joints.index(name) for name in self.leaders]
        self.start = self.mechanism.values_at_rest

    def aims(self, driver: str, rest: float, end: float, share: float) -> tuple[FloatArray, FloatArray]:
        """Where the leaders are to be, and how fast; all but the driver are held."""
        aim, speed, leader = self.mechanism.rest.copy(), np.zeros(len(self.leaders)), self.leaders.index(driver)
        aim[leader], speed[leader] = _aim(rest, end, share)
        return aim, speed


def _gains(inertia: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Stiffness and damping of servos of the frequency `_PACE` that move an inertia [kg or kg m^2]."""
    return inertia * _PACE**2, 2.0 * inertia * _PACE


def _aim(rest: float, end: float, share: float) -> tuple[float, float]:
    """Where the driver is to be, and how fast: it arrives after four fifths of the time."""
    phase = np.pi * min(share / 0.8, 1.0)
    speed = 0.5 * (end - rest) * np.sin(phase) * np.pi / (0.8 * _SECONDS)
    return rest + 0.5 * (end - rest) * (1.0 - float(np.cos(phase))), float(speed)


def report(found: Report[Record]) -> list[str]:
    """One row a kind, and what failed."""
    records = found.records
    kinds = dict.fromkeys(record["kind"] for record in records)
    rows = [_row(kind, [record for record in records if record["kind"] == kind]) for kind in kinds]
    rows.append(_row("**all**", records))
    return [
        explained(__doc__),
        table(("linkage", "drawn", "loops found", "exported", "closed in MuJoCo"), rows),
        "## What failed",
        "\n".join(_failures(records)) or "Nothing.",
    ]


def _row(name: str, records: Sequence[Record]) -> tuple[str, ...]:
    counts = [
        sum(record["found"] for record in records),
        sum(_exported(record) for record in records),
        sum(_holds(record) for record in records),
    ]
    return name, str(len(records)), *(f"{count} ({count / len(records):.0%})" for count in counts)


def _exported(record: Record) -> bool:
    return bool(record["found"] and record["mujoco"]["pins"] >= record["loops"])


def _holds(record: Record) -> bool:
    run = record["mujoco"]
    return bool(_exported(record) and run["gap"] <= _CLOSED and run["reached"] >= _REACHED)


def _failures(records: Sequence[Record]) -> Iterator[str]:
    for record in records:
        what = f"- {record['kind']} {record['seed']}: "
        if not record["found"]:
            yield (
                f"{what}{record['written']} of {record['loops']} loops written, {record['refused']} refused; "
                f"{record['freedom']} motions instead of {record['true_freedom']}."
            )
            continue
        if not _holds(record):
            run = record["mujoco"]
            yield f"{what}largest gap {run['gap']:.2%} of the diagonal, {run['reached']:.0%} of the way."


STUDY = Study(title="Closed chains", options=LoopOptions, measure=measure, report=report)
