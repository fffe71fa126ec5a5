"""The gallery of errors: the worst joints first, each with a picture and what was said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from benchmarks.errors import ShownJoint, draw_error, write_error_gallery, wrong_joints
from kinematify.assembly.part import Part
from kinematify.config import load_config
from kinematify.evaluation.run_benchmark import run_benchmark
from kinematify.robot.joint_type import JointType
from tests.secret_cabinets import request, write_object

Z = np.array([0.0, 0.0, 1.0])


def test_wrong_joints_are_shown_worst_first(tmp_path: Path) -> None:
    """The inference of the run calls everything revolute, so the drawer is wrong."""
    write_object(tmp_path / "data" / "three_parts", with_knob=True)
    wanted = request(tmp_path / "data", tmp_path / "work", "star", conditions=("rest", "yaw37"))
    report = run_benchmark(wanted)
    wrong = wrong_joints(report.records)
    assert [(item.joint.joint, item.runs, item.of) for item in wrong] == [("secret_slide", 2, 2)]
    reported: list[str] = []
    page = write_error_gallery(
        report, wanted, tmp_path / "out", name="errors", count=5, progress=lambda what, _: reported.append(what)
    )
    text = page.read_text()
    assert "1 of 2 joints are wrong in at least one run" in text
    assert "## 1. three_parts, secret_slide: revolute instead of prismatic" in text
    assert "wrong in 2 of 2 runs" in text
    assert reported == ["picture of three_parts, secret_slide"]
    with Image.open(tmp_path / "out" / "errors" / "01.webp") as picture:
        assert picture.size[0] == 600


def test_the_panels_differ_where_the_joints_do() -> None:
    corners = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 0.1) for z in (0.0, 1.0)])
    faces = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]])
    parts = [
        Part(name="door", vertices=corners, faces=faces),
        Part(name="wall", vertices=corners - [1, 0, 0], faces=faces),
    ]
    hinge = ShownJoint(
        parents={0: 1, 1: -1}, child=0, kind=JointType.REVOLUTE, axis=Z, pivot=np.zeros(3), lower=0.0, upper=1.0
    )
    config = load_config().preview.model_copy(update={"openness_rays": 2, "subsamples": 1, "azimuths": 2})
    same, other = (
        np.asarray(draw_error(parts, hinge, guess, ("truth", "truth"), config)).astype(int) for guess in (hinge, None)
    )
    assert np.array_equal(same[:, :300], same[:, 300:])
    assert np.abs(other[:, :300] - other[:, 300:]).max() > 50
