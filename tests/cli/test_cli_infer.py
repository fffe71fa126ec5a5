"""`kinematify infer` from end to end: the bundled cabinet, bad input, and Ctrl-C in the middle."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from lxml import etree
from PIL import Image

from examples.make_cabinet import JOINTS, TrueJoint
from kinematify.cli.app import run
from tests.inferred import EXAMPLE

BOX = trimesh.creation.box()


@dataclass(frozen=True)
class Made:
    """What one call of the command left."""

    folder: Path
    answer: dict[str, Any]
    said: str
    stderr: str


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    """Infer the cabinet once, in a process of its own."""
    folder = tmp_path_factory.mktemp("infer") / "cabinet"
    answer = folder.with_suffix(".json")
    words = [sys.executable, "-m", "kinematify", "infer", str(EXAMPLE), "-o", str(folder), "--json", str(answer)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return Made(folder, json.loads(answer.read_text()), done.stdout, done.stderr)


def world_pivots(urdf: Path) -> dict[str, np.ndarray]:
    """Child link -> origin of its joint in the world frame; link frames are not turned."""
    root = etree.parse(urdf).getroot()
    parents = {
        joint.find("child").get("link"): (
            joint.find("parent").get("link"),
            np.array([float(number) for number in joint.find("origin").get("xyz").split()]),
        )
        for joint in root.findall("joint")
    }

    def place(link: str) -> np.ndarray:
        if link not in parents:
            return np.zeros(3)
        parent, offset = parents[link]
        return place(parent) + offset

    return {link: place(link) for link in parents}


def test_model_folder_is_complete(made: Made) -> None:
    names = {path.relative_to(made.folder).as_posix() for path in made.folder.rglob("*") if path.is_file()}
    assert {"model.urdf", "inference.json", "preview.png"} <= names
    assert names == set(made.answer["files"])
    assert (made.folder / "preview.png").stat().st_size > 10_000
    with Image.open(made.folder / "preview.png") as picture:
        assert picture.width <= 1120  # more takes time that no page shows
    assert json.loads((made.folder / "inference.json").read_text())["schema"] >= 1


def test_progress_is_on_stderr_in_plain_lines(made: Made) -> None:
    lines = made.stderr.splitlines()
    assert lines[0].endswith("reading the parts")
    assert lines[-1].endswith("done")
    assert all(line.startswith(("[", "Lengths: ")) for line in lines)
    assert "900 mm x" in next(line for line in lines if line.startswith("Lengths: "))
    assert made.stderr.index("Lengths: ") < made.stderr.index("contacts"), "before the work"


def test_it_ends_with_the_verdict_on_what_it_wrote(made: Made) -> None:
    *_, loaded, verdict = made.said.splitlines()
    assert loaded.startswith("as loaded: MuJoCo 5 of 5 joints move, PyBullet 5 of 5")
    assert verdict.startswith(("PASS", "WARN"))


@pytest.mark.parametrize("truth", JOINTS, ids=lambda joint: joint.child)
def test_joints_of_the_cabinet_are_found(made: Made, truth: TrueJoint) -> None:
    (joint,) = [joint for joint in made.answer["joints"] if joint["child"] == truth.child]
    assert (joint["parent"], joint["type"]) == (truth.parent, truth.kind)
    cosine = float(np.dot(joint["axis"], truth.axis))
    assert (abs(cosine) if truth.kind == "continuous" else cosine) > np.cos(np.radians(0.5))
    if truth.kind != "prismatic":
        offset = world_pivots(made.folder / "model.urdf")[truth.child] - np.array(truth.pivot)
        assert np.linalg.norm(np.cross(offset, truth.axis)) < 0.001
    assert made.answer["base"] == "body"


def write_box(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    BOX.export(path)


def empty_folder(place: Path) -> Path:
    place.mkdir()
    return place


def one_part(place: Path) -> Path:
    write_box(place / "only.stl")
    return place


def not_a_mesh(place: Path) -> Path:
    write_box(place / "a.stl")
    (place / "b.obj").write_text("This is a letter.")
    return place


def truncated_glb(place: Path) -> Path:
    scene = trimesh.Scene({"a": BOX, "b": BOX.copy().apply_translation((1, 0, 0))})
    file = place.with_suffix(".glb")
    file.write_bytes(scene.export(file_type="glb")[:400])
    return file


def nan_vertices(place: Path) -> Path:
    write_box(place / "a.stl")
    (place / "b.obj").write_text("v 0 0 0\nv nan 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n")
    return place


def escaping_zip(place: Path) -> Path:
    file = place.with_suffix(".zip")
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("../outside.stl", b"solid")
    return file


def missing(place: Path) -> Path:
    return place


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (empty_folder, "given"), (one_part, "given"), (not_a_mesh, "b.obj"), (truncated_glb, "given.glb"),
        (nan_vertices, "b"), (escaping_zip, "given.zip"), (missing, "given"),
    ],
)  # fmt: skip
def test_bad_input_ends_with_2_and_one_paragraph(
    make: Any, named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out" / "model"
    assert run(["infer", str(make(tmp_path / "given")), "-o", str(out)]) == 2
    captured = capsys.readouterr()
    message = captured.err.splitlines()[-1]
    assert captured.out == ""
    assert message.startswith("Error: ")
    assert named in message
    assert "Traceback" not in captured.err
    assert not (tmp_path / "out").exists()
    assert not (tmp_path / "outside.stl").exists()


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--base", "roof"], "roof"),
        (["--mass", "roof=2"], "roof"),
        (["--density", "0"], "density"),
        (["--config", "no-such"], "There is no configuration no-such"),
        (["--scale", "0"], "scale"),
        (["--labels", "labels.npy"], "--labels"),
    ],
)
def test_bad_options_end_with_2(
    words: list[str], text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["infer", str(EXAMPLE), "-o", str(tmp_path / "out"), *words]) == 2
    message = capsys.readouterr().err.splitlines()[-1]
    assert message.startswith("Error: ")
    assert text in message
    assert list(tmp_path.iterdir()) == []


def test_existing_folders_are_left_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    for force in ([], ["--force"]):
        assert run(["infer", str(EXAMPLE), "-o", str(tmp_path), *force]) == 2
        assert str(tmp_path) in capsys.readouterr().err
        assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_interruption_leaves_nothing(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "kinematify", "infer", str(EXAMPLE), "-o", str(tmp_path / "deep" / "out")]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    assert "reading the parts" in process.stderr.readline()
    process.stderr.readline()  # the first stage of the inference has begun
    process.send_signal(signal.SIGINT)
    out, message = process.communicate(timeout=300)
    assert process.returncode == 130
    assert out == ""
    assert "Interrupted" in message
    assert "Traceback" not in message
    assert list(tmp_path.iterdir()) == []
