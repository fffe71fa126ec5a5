"""Try the installed package as a user does: `PYTHON tools/smoke.py`; a minute, nothing of a checkout is imported.

A sentence, the example, the verdict of every engine that is installed and the reason of every other one, an
environment, the viewer, and the message about a package that is missing. CI runs it with every Python, with the oldest
and the newest MuJoCo and with the oldest version of every dependency.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "cabinet"
SENTENCE = "a kitchen cabinet with two doors above three drawers, 80 cm wide"
ENGINES = {"mujoco": "mujoco", "pybullet": "pybullet", "pinocchio": "pinocchio"}
ENVIRONMENT = """import gymnasium
env = gymnasium.make("kinematify.envs:kinematify/OpenPart-v0", model="out/cabinet")
env.reset(seed=0)
for _ in range(20):
    observation, reward, *_ = env.step(env.action_space.sample())
assert env.observation_space.contains(observation), observation
"""
VIEWER = """import kinematify
window = kinematify.load("out/example").show(port=0)
assert window.url.startswith("http://"), window.url
window.close()
"""


def main() -> None:
    """Run all steps; ends with 1 at the first that fails."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--require", default="mujoco", help="engines that have to run, separated by commas")
    required = set(parser.parse_args().require.split(","))
    start = time.perf_counter()
    print(f"Python {sys.version.split()[0]}, kinematify {version('kinematify')}, MuJoCo {version('mujoco')}")
    with tempfile.TemporaryDirectory(prefix="kinematify-smoke-") as folder:
        os.chdir(folder)
        command("generate", SENTENCE, "--no-validation", "-o", "out/cabinet")
        command("infer", str(EXAMPLE), "-o", "out/example")
        command("validate", "out/cabinet/model.urdf", "--json", "report.json")
        check_engines(json.loads(Path("report.json").read_text("utf-8")), required)
        command("export", "out/cabinet/model.urdf", "--to", "mjcf", "-o", "cabinet.xml")
        run("an environment", [sys.executable, "-c", ENVIRONMENT])
        run("the viewer", [sys.executable, "-c", VIEWER])
        if find_spec("torch") is None:
            said = command("infer", str(EXAMPLE), "-o", "out/paper", "--config", "paper", status=2)
            assert " needs torch, not installed here. Run: " in said, said
    print(f"All of it works: {time.perf_counter() - start:.0f} s")


def command(*words: str, status: int = 0) -> str:
    """Run `kinematify` and return what it printed."""
    return run(" ".join(words), [sys.executable, "-m", "kinematify", *words], status=status)


def run(name: str, words: list[str], *, status: int = 0) -> str:
    """Run a step; what it printed is shown if it ends otherwise than it should."""
    start = time.perf_counter()
    done = subprocess.run(words, capture_output=True, text=True, timeout=600, check=False)
    print(f"{time.perf_counter() - start:6.1f} s  {name}", flush=True)
    if done.returncode != status:
        raise SystemExit(f"{done.stdout}\n{done.stderr}\nIt ended with {done.returncode}, not with {status}.")
    return done.stdout + done.stderr


def check_engines(report: dict[str, Any], required: set[str]) -> None:
    """An installed engine has results; one that is not says why, and which command installs it."""
    checks = report["checks"]
    for engine, module in ENGINES.items():
        mine = [check for check in checks if check["engine"] == engine]
        ran = [check for check in mine if check["status"] in ("pass", "fail")]
        if find_spec(module) is None:
            assert engine not in required, f"{engine} is not installed"
            assert all("not installed here" in check["reason"] for check in mine), mine
        else:
            assert ran, f"{engine} is installed and has no result: {mine}"


if __name__ == "__main__":
    main()
