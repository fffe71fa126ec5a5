"""docs/first_hour.md is what a new user does: every command and line of it works, in its order."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from kinematify.cli.app import run
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from tests.places import ROOT

if TYPE_CHECKING:
    from pathlib import Path


def _view(words: list[str]) -> None:
    """Start the viewer, see that it answers, and close it."""
    command = [sys.executable, "-m", "kinematify", *words, "--port", "18120"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"})
    assert process.stdout is not None
    assert process.stdout.readline().startswith("http://localhost:")
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == 0


def test_the_first_hour(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("viser", reason="viser is not installed")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / "first_hour.md").read_text("utf-8")
    commands = re.findall(r"^kinematify (.+)$", text, flags=re.MULTILINE)
    assert len(commands) == 5
    for line in commands:
        words = shlex.split(line)
        if words[0] == "view":
            _view(words)
        else:
            assert run(words) == 0, line
    joints = read_robot(tmp_path / "out" / "first" / "model.urdf").joint_by_name
    assert joints["knob_joint"].kind is JointType.FIXED, "the hint was respected"
    (program,) = re.findall(r"^```python\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)
    exec(program, {})
