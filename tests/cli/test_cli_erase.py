"""`kinematify erase`: parts without names in a folder, the truth beside it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from kinematify.cli.app import run

URDF = """<robot name="box_with_lid">
  <link name="box"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="lid">
    <visual><origin xyz="0.5 0 0.05"/><geometry><box size="1 1 0.1"/></geometry></visual>
  </link>
  <joint name="hinge" type="revolute">
    <parent link="box"/><child link="lid"/><origin xyz="-0.5 0 0.5"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="2" effort="1" velocity="1"/>
  </joint>
</robot>
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "model.urdf"
    path.write_text(URDF)
    return path


def test_parts_are_written_and_the_truth_lies_beside_them(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = model.parent / "parts"
    assert run(["erase", str(model), "-o", str(out)]) == 0
    assert {path.suffix for path in out.iterdir()} == {".obj"}
    assert len(list(out.iterdir())) == 2
    assert "hinge" in (model.parent / "parts.truth.json").read_text()
    text = capsys.readouterr().out
    assert "2 parts" in text
    assert f"kinematify infer {out}" in text


@pytest.mark.parametrize("options", [["--pose", "random"], ["--yaw", "37"], ["--seed", "5"]])
def test_options_change_the_parts(model: Path, options: list[str]) -> None:
    plain, changed = model.parent / "plain", model.parent / "changed"
    assert run(["erase", str(model), "-o", str(plain)]) == 0
    assert run(["erase", str(model), "-o", str(changed), *options]) == 0
    texts = [[path.read_text() for path in sorted(folder.iterdir())] for folder in (plain, changed)]
    assert texts[0] != texts[1]
    truth = json.loads((model.parent / "changed.truth.json").read_text())
    assert {"--pose": truth["pose"] == "random", "--yaw": truth["yaw_deg"] == 37.0, "--seed": truth["seed"] == 5}[
        options[0]
    ]


@pytest.mark.parametrize(
    ("content", "text"),
    [(None, "There is no file"), ("<robot", "broken.urdf"), ("", "broken.urdf"), ("<robot name='r'/>", "broken.urdf")],
)
def test_unusable_descriptions_end_with_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: str | None, text: str
) -> None:
    path = tmp_path / "broken.urdf"
    if content is not None:
        path.write_text(content)
    assert run(["erase", str(path), "-o", str(tmp_path / "out")]) == 2
    message = capsys.readouterr().err
    assert message.startswith("Error: ")
    assert message.count("\n") == 1
    assert text in message
    assert not (tmp_path / "out").exists()


def test_existing_output_is_left_alone(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = model.parent / "parts"
    out.mkdir()
    (out / "mine.txt").write_text("mine")
    assert run(["erase", str(model), "-o", str(out)]) == 2
    assert "exists already" in capsys.readouterr().err
    assert [path.name for path in out.iterdir()] == ["mine.txt"]
