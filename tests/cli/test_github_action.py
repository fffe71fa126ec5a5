"""The action in `examples/github_action`: its validation step, run as GitHub would."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import yaml

from tests.places import ROOT

_DOOR = """<robot name="door">
  <link name="frame"/>
  <link name="leaf"/>
  <joint name="hinge" type="revolute"><parent link="frame"/><child link="leaf"/><axis xyz="0 0 1"/>
    <limit lower="1" upper="-1" effort="1" velocity="1"/></joint>
</robot>
"""


def validated(folder: Path, models: str, baseline: str = "") -> tuple[int, dict[str, str]]:
    """Exit status of the step and what it hands to the next ones."""
    action = yaml.safe_load((ROOT / "examples/github_action/action.yml").read_text())
    (step,) = (step for step in action["runs"]["steps"] if step.get("id") == "validate")
    output = folder / "output"
    output.touch()
    command = folder / "kinematify"
    command.write_text(f'#!/bin/bash\nexec {sys.executable} -m kinematify "$@"\n')
    command.chmod(0o755)
    done = subprocess.run(
        ["bash", "--noprofile", "--norc", "-e", "-o", "pipefail", "-c", step["run"]],
        cwd=folder,
        env={
            **os.environ,
            "PATH": f"{folder}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(ROOT),
            "MODELS": models,
            "OPTIONS": "--engines none --package-dir 'my robots'",
            "BASELINE": baseline,
            "GITHUB_OUTPUT": str(output),
        },
        check=False,
        capture_output=True,
    )
    return done.returncode, dict(line.split("=") for line in output.read_text().splitlines())


def test_a_broken_model_is_annotated_at_its_line_and_fails_the_last_step(tmp_path: Path) -> None:
    (tmp_path / "my robots" / "door").mkdir(parents=True)
    (tmp_path / "my robots" / "door" / "door.urdf").write_text(_DOOR)
    assert validated(tmp_path, "nowhere/*.urdf\nmy robots/**/*.urdf\n") == (0, {"status": "1"})
    sarif: dict[str, Any] = json.loads((tmp_path / "kinematify.sarif").read_text())
    (result,) = (item for item in sarif["runs"][0]["results"] if item["ruleId"] == "KV137")
    place = result["locations"][0]["physicalLocation"]
    assert place["artifactLocation"]["uri"] == "my%20robots/door/door.urdf"
    assert place["region"]["startLine"] in (4, 5)
    assert place["region"]["startColumn"] > 1


def test_with_a_baseline_only_new_findings_fail(tmp_path: Path) -> None:
    file = tmp_path / "door.urdf"
    file.write_text(_DOOR)
    kinematify = [sys.executable, "-m", "kinematify", "validate", "--engines", "none"]
    subprocess.run([*kinematify, str(file), "--suggest-accept", str(tmp_path / "known.yaml")], check=False)
    (tmp_path / "my robots").mkdir()
    assert validated(tmp_path, "door.urdf", "known.yaml") == (0, {"status": "0"})
    file.write_text(_DOOR.replace('xyz="0 0 1"', 'xyz="0 0 0"'))
    (tmp_path / "output").unlink()
    assert validated(tmp_path, "door.urdf", "known.yaml") == (0, {"status": "1"})


def test_the_hook_of_pre_commit_checks_descriptions(tmp_path: Path) -> None:
    (hook,) = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
    assert [bool(re.search(hook["files"], name)) for name in ("a/b.urdf", "c.usda", "d.xml")] == [True, True, False]
    (tmp_path / "door.urdf").write_text(_DOOR)
    words = hook["entry"].split()
    done = subprocess.run([sys.executable, "-m", *words, str(tmp_path / "door.urdf")], check=False, cwd=ROOT)
    assert (words[0], done.returncode) == ("kinematify", 1)


def test_a_pattern_without_a_file_is_an_error(tmp_path: Path) -> None:
    status, _ = validated(tmp_path, "nowhere/*.urdf")
    assert status == 2
