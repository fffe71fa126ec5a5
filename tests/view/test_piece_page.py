"""The page of a mesh of pieces in a browser: two parts are clicked together, and the answer makes their model."""

from __future__ import annotations

import json
from functools import partial
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.cli.app import run
from kinematify.robot.read import read_robot
from kinematify.robot.vectors import box_around
from kinematify.vision.piece_question import asked_question, infer_command
from tests.browser import opened, wait_until
from tests.one_mesh import write_bin_with_lid
from tests.view.pages import PATIENCE, mistakes, press

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page

    from kinematify.robot.arrays import FloatArray
    from kinematify.view.piece_page import PiecePage
    from kinematify.view.window import Window


def _under(page: Page, window: Window[PiecePage], point: FloatArray) -> tuple[float, float]:
    """Where the page shows a point of the world [m], pixels."""
    (client,) = window.server.get_clients().values()
    camera = client.camera
    forward = (camera.look_at - camera.position) / np.linalg.norm(camera.look_at - camera.position)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    seen = np.array([right, np.cross(right, forward), forward]) @ (point - camera.position)
    box = page.locator("canvas").first.bounding_box()
    assert box is not None
    scale = 0.5 * box["height"] / np.tan(0.5 * camera.fov) / seen[2]
    return box["x"] + 0.5 * box["width"] + scale * seen[0], box["y"] + 0.5 * box["height"] - scale * seen[1]


def _click(page: Page, window: Window[PiecePage], point: FloatArray, name: str) -> None:
    """Move the pointer about a point of the world until the page names what is under it, and click there."""
    label, shakes = page.locator("#part-name"), cycle((0, 1))

    def there() -> bool:
        x, y = _under(page, window, point)
        page.mouse.move(x + next(shakes), y)
        return label.inner_text() == name

    wait_until(page, there)
    page.mouse.down()
    page.mouse.up()


def test_pieces_and_the_hinge_line_are_clicked_and_only_the_button_writes(tmp_path: Path) -> None:
    from kinematify.view.piece_page import PiecePage  # needs viser
    from kinematify.view.window import Window

    mesh, out = tmp_path / "bin.ply", tmp_path / "answer.json"
    write_bin_with_lid(mesh)
    question = asked_question(mesh, "z", None, "auto")
    window = Window(partial(PiecePage, question=question, out=out, command=infer_command(mesh, out)), port=18210)
    window.run_aside()
    top = max(range(len(question.shown)), key=lambda k: question.shown[k].bounds[1, 2])
    lid = max((k for k in range(len(question.shown)) if k != top), key=lambda k: question.shown[k].bounds[1, 2])
    try:
        with opened(window.url) as (page, reported):
            page.get_by_text("Picked: none").wait_for(timeout=PATIENCE)
            low, high = box_around([question.shown[k].bounds for k in (top, lid)])
            for k, place in ((top, (0.0, 0.0, high[2])), (lid, (0.15, -0.15, question.shown[lid].bounds[1, 2]))):
                _click(page, window, np.array(place), str(k + 1))
                wait_until(page, lambda k=k: k + 1 in window.viewer.picked)
            _click(page, window, np.array([0.0, low[1], low[2]]), "x at -y -z")
            wait_until(page, lambda: window.viewer.line == ("x", ["-y", "-z"]))
            press(page, "One part")
            page.locator("button:enabled", has_text="Write answer.json").wait_for(timeout=PATIENCE)
            assert not out.exists(), "looking writes nothing"
            press(page, "Write answer.json")
            page.get_by_text("1 of 1 parts were taken").first.wait_for(timeout=PATIENCE)
            assert not mistakes(reported)
    finally:
        window.close()
    (part,) = json.loads(out.read_text())["parts"]
    assert (part["pieces"], part["moves"], part["axis"], part["edge"]) == (
        sorted((top + 1, lid + 1)), "turns", "x", ["-y", "-z"],
    )  # fmt: skip
    model = tmp_path / "model"
    words = ["infer", mesh, "--answer", out, "--up", "z", "-o", model, "--no-preview", "--no-validation"]
    assert run([str(word) for word in words]) == 0
    (joint,) = read_robot(model / "model.urdf").joints
    assert joint.child == "part_1"
    assert joint.kind.turns
    assert abs(joint.axis[0]) > 0.99


def test_a_part_that_is_clicked_can_be_changed_and_hidden_pieces_come_back(tmp_path: Path) -> None:
    from kinematify.view.piece_page import PiecePage  # needs viser
    from kinematify.view.window import Window

    mesh = tmp_path / "bin.ply"
    write_bin_with_lid(mesh)
    question = asked_question(mesh, "z", None, "auto")
    window = Window(partial(PiecePage, question=question, out=tmp_path / "none" / "a.json", command=""), port=18211)
    try:
        page = window.viewer
        page.click(1)
        page.one_part()
        assert [part["pieces"] for part in page.parts] == [[1]]
        page.click(1)
        page.click(2)
        page.one_part()
        assert [part["pieces"] for part in page.parts] == [[1, 2]]
        page.write()
        assert "cannot be written" in page._written.content
    finally:
        window.close()


def test_a_mesh_with_an_answer_and_options_of_models_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mesh = tmp_path / "bin.ply"
    write_bin_with_lid(mesh)
    (tmp_path / "answer.json").write_text("{}")
    assert run(["view", str(mesh)]) == 2
    assert "exists" in capsys.readouterr().err
    assert run(["view", str(mesh), "--joint", "lid", "--q", "1"]) == 2
    assert "has no joints" in capsys.readouterr().err
