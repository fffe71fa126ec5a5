"""Measure how long `kinematify validate` takes, and what its pose sweeps cost beside the engines' bare loops.

Writes results/validate_speed.{json,md}. Runs are repeated and the median is kept; every run starts from an empty cache
of convex pieces, as a user's first run does.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco
import numpy as np
import pybullet as bullet

from kinematify.config.validation import load_settings
from kinematify.evaluation.datasets import find_objects
from kinematify.robot.mechanism import Mechanism
from kinematify.robot.read import read_robot
from kinematify.simulation.mujoco_engine import MujocoEngine
from kinematify.simulation.prepare import prepare
from kinematify.simulation.prepared import load_prepared
from kinematify.simulation.pybullet_engine import PybulletEngine

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.mujoco_model import CompiledModel
    from kinematify.simulation.pybullet_world import PybulletWorld

GOALS = {"panda": 6.0, "cabinet_41083": 3.0, "h1": 20.0}
"""Seconds on two cores for all checks."""
RATIO = 1.5
"""Largest cost of a sweep beside the bare loop."""


@dataclass(frozen=True, kw_only=True)
class Speed:
    """One model."""

    model: str
    seconds: float
    """Of the whole command, median."""
    cached: float
    """The same with the convex pieces of an earlier run."""
    goal: float
    rows: int
    """Configurations of the sweep of every joint."""
    mujoco: float
    """Cost of our sweep over that of the bare loop."""
    pybullet: float


def main() -> None:
    """Measure the three models of the goals."""
    arguments = _arguments()
    objects = {item.name: item.urdf for item in find_objects(arguments.data)}
    found = [_speed(name, objects[name], arguments.repeats) for name in GOALS if name in objects]
    text = _markdown(found, arguments.repeats)
    arguments.output.mkdir(parents=True, exist_ok=True)
    (arguments.output / "validate_speed.md").write_text(text, encoding="utf-8")
    values = {"schema": 1, "cores": len(os.sched_getaffinity(0)), "models": [asdict(item) for item in found]}
    (arguments.output / "validate_speed.json").write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    print(text)


def _speed(name: str, urdf: Path, repeats: int) -> Speed:
    fresh, cached = [], []
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as cache:
            fresh.append(_run(urdf, cache))
            cached.append(_run(urdf, cache))
    with tempfile.TemporaryDirectory() as folder:
        rows, by_mujoco, by_pybullet = _ratios(urdf, Path(folder))
    return Speed(
        model=name,
        seconds=statistics.median(fresh),
        cached=statistics.median(cached),
        goal=GOALS[name],
        rows=rows,
        mujoco=by_mujoco,
        pybullet=by_pybullet,
    )


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
    prepared, mechanism = load_prepared(folder), Mechanism(robot=model)
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


def _bare_pybullet(loaded: PybulletWorld, values: FloatArray) -> None:
    joints = loaded.joint.tolist()
    links = [index for index in loaded.link.tolist() if index >= 0]
    for row in values:
        for joint, value in zip(joints, row.tolist(), strict=True):
            bullet.resetJointState(loaded.body, joint, value, physicsClientId=loaded.client)
        bullet.performCollisionDetection(physicsClientId=loaded.client)
        bullet.getContactPoints(loaded.body, loaded.body, physicsClientId=loaded.client)
        bullet.getLinkStates(loaded.body, links, computeForwardKinematics=1, physicsClientId=loaded.client)


def _markdown(found: list[Speed], repeats: int) -> str:
    rows = [
        f"| {item.model} | {item.seconds:.1f} s | {item.cached:.1f} s | {item.goal:.0f} s | {item.rows} | "
        f"{item.mujoco:.2f} | {item.pybullet:.2f} |"
        for item in found
    ]
    about = (
        f"Written by `python benchmarks/validate_speed.py --repeats {repeats}`, {len(os.sched_getaffinity(0))} cores, "
        f"numpy {np.__version__}, MuJoCo {mujoco.__version__}. All checks, the whole command from its start on, median "
        f"of {repeats} runs; with an empty cache of convex pieces, and once more with that of the run before. The last "
        f"columns are the cost of our sweep of every joint over that of a bare loop of the engine over the same "
        f"configurations (goal: at most {RATIO})."
    )
    head = [
        "# How long `kinematify validate` takes",
        "",
        about,
        "",
        "| model | first run | again | goal | configurations | MuJoCo, times bare | PyBullet, times bare |",
        "|---|---|---|---|---|---|---|",
    ]
    return "\n".join([*head, *rows]) + "\n"


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder of models, the benchmark's if absent")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    return parser.parse_args()


if __name__ == "__main__":
    main()
