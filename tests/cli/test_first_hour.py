"""What a new user does in the first hour: every line of docs/first_hour.md works, and nothing is lost or guessed."""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
import subprocess
import sys
from dataclasses import replace
from typing import TYPE_CHECKING

import gymnasium
import pytest
import trimesh

import kinematify
import kinematify.envs
from kinematify.cli.app import run
from kinematify.errors import InputError
from kinematify.processes.lock import writing
from kinematify.refinement.hints import parse_hints, with_hints
from kinematify.refinement.loop import repaired
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from tests.inferred import EXAMPLE, inferred
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
    process.communicate(timeout=300)
    assert process.returncode == 0


def test_the_first_hour(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
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


@pytest.fixture(scope="module")
def cabinet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A model folder, exact and simulable."""
    out = tmp_path_factory.mktemp("first") / "cabinet"
    kinematify.generate("a cabinet with two doors", out)
    return out


def test_a_range_that_ends_in_another_part_is_cut_unless_a_hint_asks_for_it() -> None:
    found = inferred("cabinet")
    asked = parse_hints(["drawer_left:range=-80..300mm"], found.assembly.names)
    wide = with_hints(found, asked)
    assert repaired(wide).joints == wide.joints, "the user has decided"
    bare = replace(wide, joints=tuple(replace(joint, evidence={}) for joint in wide.joints))
    cut = repaired(bare)
    lower = next(joint.lower for joint in cut.model.joints if joint.child == "drawer_left")
    assert -0.03 < lower <= 0.0, "it meets the back of the body there"
    assert any(text.startswith("drawer_left: range -80 to 300 mm was changed to ") for text in cut.warnings)


def test_an_unrepaired_model_is_refused_in_one_traceback(cabinet: Path, tmp_path: Path) -> None:
    text = (cabinet / "model.urdf").read_text("utf-8").replace("meshes/", f"{cabinet}/meshes/")
    bad = tmp_path / "bad.urdf"
    bad.write_text(re.sub(r'lower="[^"]*" upper="1', 'lower="-1.5" upper="1', text))
    with pytest.raises(InputError, match="does not pass") as caught:
        gymnasium.make("kinematify/OpenPart-v0", model=str(bad))
    assert caught.value.__cause__ is None
    assert caught.value.__context__ is None


@pytest.mark.parametrize(
    "words",
    [
        ["infer", str(EXAMPLE)],
        ["generate", "a cabinet with two doors"],
        ["refine", "{model}"],
        ["export", "{model}", "--to", "mjcf"],
    ],
    ids=lambda words: words[0],
)
def test_two_commands_do_not_write_one_place(
    cabinet: Path, tmp_path: Path, words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    with writing(out):
        assert run([*(word.format(model=cabinet) for word in words), "-o", str(out)]) == 2
    assert f"is being written by process {os.getpid()}" in capsys.readouterr().err
    assert not out.exists()


@pytest.mark.parametrize("form", ["mjcf", "usd", "sdf", "urdf", "glb", "srdf"])
def test_export_makes_the_folder_and_checks_it_before_the_work(
    cabinet: Path, tmp_path: Path, form: str, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "exp" / f"cabinet.{ {'usd': 'usda', 'mjcf': 'xml'}.get(form, form) }"
    (tmp_path / "file").touch()
    assert run(["export", str(cabinet), "--to", form, "-o", str(tmp_path / "file" / "x")]) == 2
    said = capsys.readouterr().err
    assert "is not writable" in said
    assert "reading the model" not in said, "before the work"
    if form != "srdf":  # which needs an arm
        assert run(["export", str(cabinet), "--to", form, "-o", str(out)]) == 0
        assert out.is_file()


def test_fix_writes_nothing_where_nothing_is_to_be_changed(
    cabinet: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "fixed.urdf"
    assert run(["fix", str(cabinet), "-o", str(out)]) == 0
    assert not out.exists()
    assert capsys.readouterr().out.splitlines()[-1] == "Repaired: nothing. Not repaired: nothing."


def test_a_hint_of_a_parent_leaves_no_loop_joint() -> None:
    found = inferred("cabinet")
    names = found.assembly.names
    moved = with_hints(found, parse_hints(["knob:parent=door_left"], names))
    assert moved.model.robot.joint_by_name["knob_joint"].parent == "door_left"
    assert not moved.closed_chains
    assert not moved.model.loops


def test_a_mesh_is_no_model_and_points_to_infer(tmp_path: Path) -> None:
    trimesh.creation.box().export(tmp_path / "x.glb")
    with pytest.raises(InputError, match=r"kinematify infer .*x.glb -o OUT"):
        kinematify.load(tmp_path / "x.glb")


def test_sarif_has_the_rules_that_fired(cabinet: Path, tmp_path: Path) -> None:
    run(["validate", str(cabinet), "--quick", "--sarif", str(tmp_path / "report.sarif")])
    (found,) = json.loads((tmp_path / "report.sarif").read_text("utf-8"))["runs"]
    rules = [rule["id"] for rule in found["tool"]["driver"]["rules"]]
    assert set(rules) == {result["ruleId"] for result in found["results"]}
