"""Let the built-in arm open every door and drawer of the benchmark's everyday objects, and wrong copies of them.

Writes results/task.{json,md}: for each joint how much of it opens, what stops it and how long the plan took; with
--execute also what MuJoCo and PyBullet make of the plan, and with --wrong how often a wrong axis, type or direction is
noticed: the plan fails or the joint is blamed.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections import Counter
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.config.validation import load_settings
from kinematify.evaluation.datasets import find_objects
from kinematify.geometry.scene import read_scene
from kinematify.manipulation import execute_mujoco, execute_pybullet
from kinematify.manipulation.copies import write_scaled
from kinematify.manipulation.execute import Hold, load
from kinematify.manipulation.kinematics import Arm
from kinematify.manipulation.place import object_box
from kinematify.manipulation.planning import Failure, PullPlan, depend, plan_pull
from kinematify.manipulation.request import PULL, TaskRequest
from kinematify.manipulation.robot import builtin_robot
from kinematify.manipulation.sizes import sizing
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.transforms import rotation_about
from kinematify.robot.write import write_robot
from kinematify.validation.run import validate
from kinematify.validation.task.stage import motion_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.config.validation import ValidationSettings
    from kinematify.geometry.scene import Scene
    from kinematify.robot.robot import Joint
    from kinematify.validation.finding import Finding

_WAY = 0.12  # a door or drawer moves its outermost point by more [m]; buttons, knobs and levers move less
_ENDLESS = "endless"  # wheels and dials have no range to be opened
_UNTRIED = (Failure.NO_WAY, Failure.NO_GRASP)
_FAULTS = ("axis turned by 90 deg", "axis turned by 20 deg", "type swapped")


@dataclass(frozen=True, kw_only=True)
class Opened:
    """What became of one joint."""

    model: str
    joint: str
    kind: str
    way: float
    """Of its outermost point [m]."""
    fraction: float
    failure: str | None
    words: str
    first: list[str]
    """Joints that are opened before."""
    holds: int
    """Grasps that were found."""
    tried: int
    seconds: float
    """Of one core, for the plan."""
    executed: dict[str, str]
    """By engine and way of holding: the share of the way that opened, or what went wrong."""
    executed_seconds: float

    @property
    def counts(self) -> bool:
        """A door, lid or drawer with a hold outside."""
        return self.kind != _ENDLESS and self.way > _WAY and self.failure not in _UNTRIED


@dataclass(frozen=True, kw_only=True)
class Noticed:
    """What became of one wrong joint."""

    model: str
    joint: str
    fault: str
    opened: bool
    """The plan succeeded."""
    blamed: bool
    """A finding blames the kinematics of this joint."""


def main() -> None:
    """Plan, and write down what came of it."""
    arguments = _arguments()
    settings = load_settings()
    objects = [item for item in find_objects(arguments.data) if item.urdf.parent.parent.name == "everyday"]
    objects = [item for item in objects if not arguments.only or any(word in item.name for word in arguments.only)]
    opened: list[Opened] = []
    for item in objects[: arguments.most]:
        with tempfile.TemporaryDirectory() as folder:
            for joint in _opened(item.name, item.urdf, Path(folder), settings, execute=arguments.execute):
                opened.append(joint)
                print(
                    f"{joint.model} {joint.joint}: {joint.fraction:.2f} {joint.failure or ''} {joint.words}", flush=True
                )
    noticed = list(_noticed(opened, {item.name: item.urdf for item in objects}, settings, arguments.wrong))
    arguments.output.mkdir(parents=True, exist_ok=True)
    values = {"schema": 1, "joints": [asdict(j) for j in opened], "wrong": [asdict(n) for n in noticed]}
    (arguments.output / "task.json").write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    (arguments.output / "task.md").write_text(_markdown(opened, noticed, _command(arguments)), encoding="utf-8")


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path, help="folder of the benchmark")
    parser.add_argument("--output", type=Path, default=Path("results"))
    parser.add_argument("--only", nargs="*", help="parts of names of objects")
    parser.add_argument("--most", type=int, help="so many objects")
    parser.add_argument("--execute", action="store_true", help="run the plans in MuJoCo and PyBullet")
    parser.add_argument("--wrong", type=int, default=0, help="so many wrong copies of joints that open")
    return parser.parse_args()


def _opened(name: str, urdf: Path, folder: Path, settings: ValidationSettings, *, execute: bool) -> Iterator[Opened]:
    arm = Arm(builtin_robot(folder), settings.task.plan, seed=settings.seed)
    scene = _sized(urdf, folder, settings)
    plans = depend([plan_pull(arm, scene, travel.joint, settings.task, seed=settings.seed) for travel in scene.travels])
    for travel, plan in zip(scene.travels, plans, strict=True):
        start = time.perf_counter()
        executed = _executed(plan, arm, folder, settings) if execute else {}
        yield Opened(
            model=name,
            joint=travel.joint,
            kind=("hinge" if travel.turns else "slide") if travel.limited else _ENDLESS,
            way=plan.way,
            fraction=plan.fraction,
            failure=None if plan.failure is None else plan.failure.value,
            words=plan.words,
            first=list(plan.first),
            holds=0 if plan.grasps is None else len(plan.grasps.grasps),
            tried=plan.tried,
            seconds=plan.seconds,
            executed=executed,
            executed_seconds=time.perf_counter() - start if executed else 0.0,
        )


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
    runs = [execute_mujoco.execute(loaded, settings.task.execution, hold=hold) for hold in Hold]
    runs.append(execute_pybullet.execute(loaded, settings.task.execution))
    return {f"{run.engine} {run.hold.value}": run.reason or f"{run.share:.2f}" for run in runs}


def _noticed(
    opened: list[Opened], urdfs: dict[str, Path], settings: ValidationSettings, most: int
) -> Iterator[Noticed]:
    """Wrong copies of joints that opened, spread over the objects."""
    joints = [joint for joint in opened if joint.counts and joint.failure is None]
    cases = [(joint, fault) for fault in _FAULTS for joint in joints]
    for joint, fault in [cases[round(k)] for k in np.linspace(0, len(cases) - 1, min(most, len(cases)))]:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / urdfs[joint.model].parent.name / "model.urdf"
            path.parent.mkdir()
            _write_wrong(urdfs[joint.model], path, joint.joint, fault)
            found = validate(
                path, settings=settings, selected={f"KV70{k}" for k in range(1, 7)}, engines=(),
                task=TaskRequest(kind=PULL), workers=1,
            ).findings  # fmt: skip
        own = [finding for finding in found if finding.joint == joint.joint]
        yield Noticed(
            model=joint.model, joint=joint.joint, fault=fault, opened=any(map(_opens, own)),
            blamed=any(finding.blame.value == "kinematics" for finding in own),
        )  # fmt: skip
        print(f"{joint.model} {joint.joint} {fault}: {[(f.check, f.severity.value, f.blame.value) for f in own]}")


def _opens(finding: Finding) -> bool:
    return finding.check == "KV705" and finding.severity.value == "note"


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


def _command(arguments: argparse.Namespace) -> str:
    words = [f"--only {' '.join(arguments.only)}"] if arguments.only else []
    words += [f"--most {arguments.most}"] if arguments.most else []
    words += ["--execute"] if arguments.execute else []
    words += [f"--wrong {arguments.wrong}"] if arguments.wrong else []
    return " ".join(["python benchmarks/task.py ../shared/bench", *words])


def _markdown(opened: list[Opened], noticed: list[Noticed], command: str) -> str:
    counted = [joint for joint in opened if joint.counts]
    done = [joint for joint in counted if joint.failure is None]
    lines = [
        "# The built-in arm opens the benchmark's doors and drawers",
        "",
        f"`{command}`: {_summary(opened, counted, done)}",
        "",
        "| model | joint | kind | after | opened | failure | cause | s |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
        *(
            f"| {j.model} | {j.joint} | {j.kind} | {', '.join(j.first)} | {j.fraction:.0%} | {j.failure or ''} | "
            f"{j.words} | {j.seconds:.1f} |"
            for j in opened
            if j.failure != Failure.NO_WAY.value
        ),
    ]
    executed = Counter(
        (way, result.replace(".", "").isdigit()) for joint in opened for way, result in joint.executed.items()
    )
    for way in sorted({way for way, _ in executed}):
        lines += ["", f"{way}: {executed[way, True]} of {executed[way, True] + executed[way, False]} plans succeed."]
    seconds = [joint.executed_seconds / len(joint.executed) for joint in opened if joint.executed]
    if seconds:
        lines += [
            "",
            f"Median time of an execution: {np.median(seconds):.1f} s, decomposition into convex pieces included.",
        ]
    for fault in _FAULTS:
        cases = [case for case in noticed if case.fault == fault]
        if cases:
            seen = sum(case.blamed or not case.opened for case in cases)
            blamed = sum(case.blamed for case in cases)
            lines += ["", f"{fault}: {seen} of {len(cases)} fail or are blamed, {blamed} blamed on kinematics."]
    return "\n".join(lines) + "\n"


def _summary(opened: list[Opened], counted: list[Opened], done: list[Opened]) -> str:
    planned = [joint.seconds for joint in opened if joint.failure != Failure.NO_WAY.value]
    return (
        f"{len({joint.model for joint in opened})} objects, {len(opened)} joints. {len(counted)} of them are doors, "
        f"lids or drawers (limited, their outermost point moves by more than {_WAY * 1e2:.0f} cm) with a "
        f"hold outside. Of {len(done)} ({len(done) / max(len(counted), 1):.0%}) the arm opens at least 90 % of the "
        f"range. Median time of a plan: {np.median(planned) if planned else 0.0:.1f} s of one core."
    )


if __name__ == "__main__":
    main()
