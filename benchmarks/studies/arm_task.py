"""How many doors, lids and drawers does the built-in arm open, and does it notice wrong copies of them?

For each joint: how much of it opens, what stops it and how long the plan took; with --execute also what MuJoCo and
PyBullet make of the plan, and with --wrong how often a wrong axis, type or direction is noticed: the plan fails or the
joint is blamed.
"""

from __future__ import annotations

import tempfile
import time
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field

from benchmarks.study import Options, Study
from kinematify.config.validation import load_settings
from kinematify.evaluation.datasets import BenchObject, find_objects
from kinematify.evaluation.record import table
from kinematify.geometry.scene import read_scene
from kinematify.manipulation.execute import execute, load
from kinematify.manipulation.kinematics import Arm
from kinematify.manipulation.place import object_box
from kinematify.manipulation.planning import PullPlan, depend, motion_of, plan_pull
from kinematify.manipulation.request import PULL, Failure, Hold, TaskRequest
from kinematify.manipulation.robot import builtin_robot
from kinematify.manipulation.sizes import sizing, write_scaled
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.transforms import rotation_about
from kinematify.robot.write import write_robot
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from benchmarks.study import Measured, Record, Work
    from kinematify.config.validation import ValidationSettings
    from kinematify.evaluation.record import Report
    from kinematify.geometry.scene import Scene
    from kinematify.robot.robot import Joint

_WAY = 0.12  # a door or drawer moves its outermost point by more [m]; buttons, knobs and levers move less
_ENDLESS = "endless"  # wheels and dials have no range to be opened
_FAULTS = ("axis turned by 90 deg", "axis turned by 20 deg", "type swapped")


class ArmTaskOptions(Options):
    """Which joints, and what is done with them."""

    data: str = Field("everyday", description="Folder or set of objects.")
    only: tuple[str, ...] = Field((), description="Parts of names of objects, separated by commas.")
    most: int | None = Field(None, ge=1, description="So many objects.")
    execute: bool = Field(False, description="Run the plans in MuJoCo and PyBullet.")
    wrong: int = Field(0, ge=0, description="So many wrong copies of joints that open.")


@dataclass(frozen=True, kw_only=True)
class OpeningTask:
    """One object whose joints are to be opened."""

    item: BenchObject
    execute: bool


@dataclass(frozen=True, kw_only=True)
class WrongCopy:
    """One object with a fault in one joint."""

    urdf: Path
    model: str
    joint: str
    fault: str


def measure(options: ArmTaskOptions, work: Work) -> Measured:
    """Open every joint, then wrong copies of joints that opened, spread over the objects."""
    objects = [
        item
        for item in find_objects(options.data)
        if not options.only or any(word in item.name for word in options.only)
    ]
    urdfs = {item.name: item.urdf for item in objects}
    asked = {item.name: OpeningTask(item=item, execute=options.execute) for item in objects[: options.most]}
    opened = [joint for record in work.each(opened_joints, asked).values() for joint in record["joints"]]
    good = [joint for joint in opened if _counts(joint) and joint["failure"] is None]
    cases = [(joint, fault) for fault in _FAULTS for joint in good]
    chosen = [cases[round(k)] for k in np.linspace(0, len(cases) - 1, min(options.wrong, len(cases)))]
    copies = {
        f"{joint['model']} {joint['joint']} {fault}": WrongCopy(
            urdf=urdfs[joint["model"]], model=joint["model"], joint=joint["joint"], fault=fault
        )
        for joint, fault in chosen
    }
    return opened, {"wrong": list(work.each(noticed, copies).values())}


def opened_joints(asked: OpeningTask) -> Record:
    """Plan, and if asked execute, the opening of every joint of one object."""
    settings = load_settings()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        arm = Arm(builtin_robot(), settings.task.plan, seed=settings.seed)
        scene = _sized(asked.item.urdf, folder, settings)
        plans = [plan_pull(arm, scene, travel.joint, settings.task, seed=settings.seed) for travel in scene.travels]
        joints = []
        for travel, plan in zip(scene.travels, depend(plans), strict=True):
            start = time.perf_counter()
            executed = _executed(plan, arm, folder, settings) if asked.execute else {}
            joints.append({
                "model": asked.item.name,
                "joint": travel.joint,
                "kind": ("hinge" if travel.turns else "slide") if travel.limited else _ENDLESS,
                "way": plan.way,
                "fraction": plan.fraction,
                "failure": None if plan.failure is None else plan.failure.value,
                "words": plan.words,
                "first": list(plan.first),
                "holds": 0 if plan.grasps is None else len(plan.grasps.grasps),
                "tried": plan.tried,
                "seconds": plan.seconds,
                "executed": executed,
                "executed_seconds": time.perf_counter() - start if executed else 0.0,
            })  # fmt: skip
    return {"joints": joints}


def _sized(urdf: Path, folder: Path, settings: ValidationSettings) -> Scene:
    scene = read_scene(read_robot(urdf), settings.geometry)
    sized = sizing(urdf, scene.model.name, object_box(scene))
    write_scaled(urdf, sized.factor, folder / "object.urdf")
    return read_scene(read_robot(folder / "object.urdf"), settings.geometry)


def _executed(plan: PullPlan, arm: Arm, folder: Path, settings: ValidationSettings) -> dict[str, str]:
    motion = motion_of(plan, arm.robot, folder / "object.urdf")
    if motion is None or plan.failure is not None:
        return {}
    loaded = load(motion, folder, settings.prepare)
    ways = [*(("mujoco", hold) for hold in Hold), ("pybullet", Hold.WELD)]
    runs = [execute(loaded, settings.task.execution, engine=engine, hold=hold) for engine, hold in ways]
    return {f"{run.engine} {run.hold.value}": run.reason or f"{run.share:.2f}" for run in runs}


def noticed(asked: WrongCopy) -> Record:
    """Whether the plan for a wrong joint succeeds, and whether a finding blames the kinematics of the joint."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / asked.urdf.parent.name / "model.urdf"
        path.parent.mkdir()
        _write_wrong(asked.urdf, path, asked.joint, asked.fault)
        selected = {f"KV70{k}" for k in range(1, 7)}
        findings = validate(path, selected=selected, engines=(), task=TaskRequest(kind=PULL), workers=1).findings
    own = [finding for finding in findings if finding.joint == asked.joint]
    return {
        "model": asked.model,
        "joint": asked.joint,
        "fault": asked.fault,
        "opened": any(finding.check == "KV705" and finding.severity.value == "note" for finding in own),
        "blamed": any(finding.blame.value == "kinematics" for finding in own),
    }


def _write_wrong(urdf: Path, path: Path, name: str, fault: str) -> None:
    """A copy with one wrong joint."""
    robot = read_robot(urdf)
    joint = robot.joint_by_name[name]
    if fault == "type swapped":
        wrong = _swapped(joint)
    else:
        across = np.cross(joint.axis, np.eye(3)[int(np.argmin(np.abs(joint.axis)))])
        turn = rotation_about(across / np.linalg.norm(across), np.radians(90.0 if "90" in fault else 20.0))
        wrong = replace(joint, axis=turn @ joint.axis)
    write_robot(replace(robot, joints=tuple(wrong if item is joint else item for item in robot.joints)), path)


def _swapped(joint: Joint) -> Joint:
    """A hinge slides by as many metres as fit, a slide turns by a quarter."""
    slides = joint.kind is JointType.PRISMATIC
    far = (1.0 if abs(joint.upper) >= abs(joint.lower) else -1.0) * (0.5 * np.pi if slides else 0.4)
    kind = JointType.REVOLUTE if slides else JointType.PRISMATIC
    return replace(joint, kind=kind, lower=min(0.0, far), upper=max(0.0, far))


def _counts(joint: Record) -> bool:
    """A door, lid or drawer with a hold outside."""
    return (
        joint["kind"] != _ENDLESS and joint["way"] > _WAY and joint["failure"] not in (Failure.NO_WAY, Failure.NO_GRASP)
    )


def report(found: Report[Record]) -> list[str]:
    """What opened, joint by joint; what engines made of it; which wrong copies were noticed."""
    opened, wrong = found.records, found.summary["wrong"]
    tried = [joint for joint in opened if joint["failure"] != Failure.NO_WAY]
    rows = [
        (
            j["model"], j["joint"], j["kind"], ", ".join(j["first"]), f"{j['fraction']:.0%}", j["failure"] or "",
            j["words"], f"{j['seconds']:.1f}",
        )
        for j in tried
    ]  # fmt: skip
    executed = Counter(
        (way, result.replace(".", "").isdigit()) for joint in opened for way, result in joint["executed"].items()
    )
    seconds = [joint["executed_seconds"] / len(joint["executed"]) for joint in opened if joint["executed"]]
    blocks = [
        _summary(opened, tried),
        table(("model", "joint", "kind", "after", "opened", "failure", "cause", "s"), rows),
        *(
            f"{way}: {executed[way, True]} of {executed[way, True] + executed[way, False]} plans succeed."
            for way in sorted({way for way, _ in executed})
        ),
    ]
    if seconds:
        blocks.append(
            f"Median time of an execution: {np.median(seconds):.1f} s, decomposition into convex pieces included."
        )
    for fault in _FAULTS:
        cases = [case for case in wrong if case["fault"] == fault]
        seen = sum(case["blamed"] or not case["opened"] for case in cases)
        blamed = sum(case["blamed"] for case in cases)
        blocks += (
            [f"{fault}: {seen} of {len(cases)} fail or are blamed, {blamed} blamed on kinematics."] if cases else []
        )
    return blocks


def _summary(opened: tuple[Record, ...], tried: list[Record]) -> str:
    counted = [joint for joint in opened if _counts(joint)]
    done = [joint for joint in counted if joint["failure"] is None]
    planned = [joint["seconds"] for joint in tried]
    return (
        f"{len({joint['model'] for joint in opened})} objects, {len(opened)} joints. {len(counted)} of them are doors, "
        f"lids or drawers (limited, their outermost point moves by more than {_WAY * 1e2:.0f} cm) with a "
        f"hold outside. Of {len(done)} ({len(done) / max(len(counted), 1):.0%}) the arm opens at least 90 % of the "
        f"range. Median time of a plan: {np.median(planned) if planned else 0.0:.1f} s of one core."
    )


STUDY = Study(
    title="The built-in arm opens the benchmark's doors and drawers",
    options=ArmTaskOptions,
    measure=measure,
    report=report,
)
