"""How long does `kinematify validate` take, and what do its pose sweeps cost beside the engines' bare loops?

All checks, the whole command from its start on, median of the repeats; with an empty cache of convex pieces, as a
user's first run has, and once more with that of the run before. The last columns are the cost of our sweep of every
joint over that of a bare loop of the engine over the same configurations (goal: at most 1.5).
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco
import pybullet as bullet
from pydantic import Field

from benchmarks.study import Options, Study, explained
from kinematify.config.validation import load_settings
from kinematify.evaluation.datasets import BenchObject, find_objects
from kinematify.evaluation.record import table
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.read import read_robot
from kinematify.simulation.mujoco_engine import MujocoEngine
from kinematify.simulation.prepare import prepare
from kinematify.simulation.prepared import load_prepared
from kinematify.simulation.pybullet_engine import PybulletEngine

if TYPE_CHECKING:
    from collections.abc import Callable

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.record import Report
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.mujoco_model import CompiledModel
    from kinematify.simulation.pybullet_world import PybulletBody

GOALS = {"panda": 6.0, "cabinet_41083": 3.0, "h1": 20.0}
"""Seconds on two cores for all checks."""


class SpeedOptions(Options):
    """What is timed."""

    data: str | None = Field(None, description="Folder or set that holds the models; the benchmark's if not given.")
    repeats: int = Field(3, ge=1, description="Runs of which the median is taken.")


@dataclass(frozen=True, kw_only=True)
class Timing:
    """One model to be timed."""

    item: BenchObject
    repeats: int


def measure(options: SpeedOptions, work: Work) -> Measured:
    """Time the models of the goals, one after the other."""
    asked = {
        item.name: Timing(item=item, repeats=options.repeats)
        for item in find_objects(options.data)
        if item.name in GOALS
    }
    return list(work.each(timed, asked, workers=1).values()), {"cores": len(os.sched_getaffinity(0))}


def timed(asked: Timing) -> Record:
    """Time the command and the sweeps of one model."""
    fresh, cached = [], []
    for _ in range(asked.repeats):
        with tempfile.TemporaryDirectory() as cache:
            fresh.append(_run(asked.item.urdf, cache))
            cached.append(_run(asked.item.urdf, cache))
    with tempfile.TemporaryDirectory() as folder:
        rows, by_mujoco, by_pybullet = _ratios(asked.item.urdf, Path(folder))
    return {
        "model": asked.item.name,
        "seconds": statistics.median(fresh),
        "cached": statistics.median(cached),
        "goal": GOALS[asked.item.name],
        "rows": rows,
        "mujoco": by_mujoco,
        "pybullet": by_pybullet,
    }


def _run(urdf: Path, cache: str) -> float:
    start = time.perf_counter()
    command = [sys.executable, "-m", "kinematify", "validate", str(urdf)]
    environment = os.environ | {"XDG_CACHE_HOME": cache}
    subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    return time.perf_counter() - start


def _ratios(urdf: Path, folder: Path) -> tuple[int, float, float]:
    """Number of configurations, and the cost of our sweep over that of the bare loop in MuJoCo and PyBullet."""
    settings = load_settings()
    model = read_robot(urdf)
    prepare(model, folder, settings.prepare)
    prepared, mechanism = load_prepared(folder), LeaderMechanism(robot=model)
    values = mechanism.all_values(mechanism.sweep(settings.engines.sweep_samples))
    ours = MujocoEngine(settings=settings.engines, threads=1, said=[]).load(prepared, mechanism)
    by_mujoco = _ratio(lambda: ours.measure(values, dynamic=1), lambda: _bare_mujoco(ours.measuring, values))
    theirs = PybulletEngine(settings=settings.engines, log=folder / "pybullet.log").load(prepared, mechanism)
    by_pybullet = _ratio(lambda: theirs.measure(values, dynamic=1), lambda: _bare_pybullet(theirs.looking, values))
    return len(values), by_mujoco, by_pybullet


def _ratio(ours: Callable[[], object], bare: Callable[[], object]) -> float:
    """Taking turns, so that both see the same machine; the best of each."""
    times = [(_timed(ours), _timed(bare)) for _ in range(7)]
    return min(pair[0] for pair in times) / min(pair[1] for pair in times)


def _timed(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def _bare_mujoco(loaded: CompiledModel, values: FloatArray) -> None:
    data = mujoco.MjData(loaded.model)
    for row in values:
        data.qpos[loaded.qpos] = row
        mujoco.mj_fwdPosition(loaded.model, data)


def _bare_pybullet(loaded: PybulletBody, values: FloatArray) -> None:
    joints = loaded.joint.tolist()
    links = [index for index in loaded.link.tolist() if index >= 0]
    for row in values:
        for joint, value in zip(joints, row.tolist(), strict=True):
            bullet.resetJointState(loaded.body, joint, value, physicsClientId=loaded.client)
        bullet.performCollisionDetection(physicsClientId=loaded.client)
        bullet.getContactPoints(loaded.body, loaded.body, physicsClientId=loaded.client)
        bullet.getLinkStates(loaded.body, links, computeForwardKinematics=1, physicsClientId=loaded.client)


def report(found: Report[Record]) -> list[str]:
    """One line per model."""
    rows = [
        (
            item["model"],
            *(f"{item[name]:.1f} s" for name in ("seconds", "cached")),
            f"{item['goal']:.0f} s",
            str(item["rows"]),
            *(f"{item[engine]:.2f}" for engine in ("mujoco", "pybullet")),
        )
        for item in found.records
    ]
    titles = ("model", "first run", "again", "goal", "configurations", "MuJoCo, times bare", "PyBullet, times bare")
    return [explained(__doc__), f"{found.summary['cores']} cores.", table(titles, rows)]


STUDY = Study(title="How long `kinematify validate` takes", options=SpeedOptions, measure=measure, report=report)
