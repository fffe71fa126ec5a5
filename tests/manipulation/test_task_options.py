"""What `kinematify validate --task pull` refuses before it begins."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest

from kinematify.cli.app import run
from kinematify.manipulation.manipulator import builtin_robot
from tests.manipulation.furniture import write_drawer_cabinet

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--robot", "{arm}", "--tool", "hand"], "--task pull"),
        (["--task", "pull", "--robot", "{arm}"], "--tool"),
        (["--task", "pull", "--robot", "{arm}", "--tool", "claw"], "has no link 'claw'"),
        (
            ["--task", "pull", "--robot", "{arm}", "--tool", "hand", "--gripper", "thumb"],
            "has no movable joint 'thumb'",
        ),
        (["--task", "pull", "--robot", "{arm}.xacro", "--tool", "hand"], "There is no file"),
        (["--task", "pull", "--robot", "{cabinet}", "--tool", "body"], "There is no arm"),
        (["--task", "pull", "--films", "{arm}"], "is no folder"),
        (["--task", "juggle"], "juggle"),
        (["--base", "1", "0", "0", "180"], "--task pull"),
    ],
    ids=lambda value: None if isinstance(value, str) else " ".join(value[-2:]),
)
def test_robot_that_cannot_do_it_ends_with_2_and_the_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    cabinet = write_drawer_cabinet(tmp_path / "cabinet.urdf")
    shutil.copy(builtin_robot().urdf, tmp_path / "arm.urdf")
    filled = [word.format(arm=tmp_path / "arm.urdf", cabinet=cabinet) for word in words]
    assert run(["validate", str(cabinet), *filled]) == 2
    assert said.lower() in " ".join(capsys.readouterr().err.split()).lower()
