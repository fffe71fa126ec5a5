"""The viewer's page in a browser: a candidate is chosen, kept, and found in the file; it fits a narrow window."""

from __future__ import annotations

import os
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image

from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.view.panel import _introduction
from kinematify.view.window import read_model
from tests.browser import opened, wait_until
from tests.inferred import write_inferred
from tests.view.pages import PATIENCE, downloaded, limited, mistakes, picture, press, served
from tools.draw_view import keep_candidate

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_inferred("edge_door", tmp_path / "model")


_NOBODY = 65534


@contextmanager
def read_only(folder: Path) -> Iterator[None]:
    """A folder that may only be read, not even by the superuser's own process, which else may write everything."""
    before = os.geteuid()
    opened_up = [path for path in folder.parents if before == 0 and not path.stat().st_mode & 0o001]
    modes = {path: path.stat().st_mode for path in (folder, folder.parent, *opened_up)}
    for path, mode in modes.items():
        path.chmod(mode & ~0o222 | 0o555)
    if before == 0:
        os.seteuid(_NOBODY)
    try:
        yield
    finally:
        os.seteuid(before)
        for path, mode in modes.items():
            path.chmod(mode)


def test_a_candidate_is_chosen_refused_where_nothing_may_be_written_and_else_kept_and_found_in_the_file(
    folder: Path,
) -> None:
    (joint,) = read_robot(folder / "model.urdf").joints
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    with served(folder, 18140) as window, opened(window.url, width=400) as (page, reported):
        page.wait_for_selector("text=At rest", timeout=PATIENCE)
        window.viewer.choose(joint.name)
        window.viewer.set({joint.name: 0.5})
        page.get_by_text(f"{joint.name} moves").first.wait_for(timeout=PATIENCE)
        window.viewer.try_candidate(joint.name, 1)
        with read_only(folder):
            press(page, "Keep this")
            page.get_by_text("Nothing was changed").first.wait_for(timeout=PATIENCE)
        assert "permissions" in page.inner_text("body")
        assert before == {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        said = keep_candidate(page, joint.name, "fixed")
        assert f"--hint {joint.child}=fixed" in said
        press(page, "Copy command")
        page.get_by_text("Copied").wait_for(timeout=PATIENCE)
        copied = page.evaluate("navigator.clipboard.readText()")
        assert copied.startswith("kinematify infer ")
        assert copied.endswith(f"--hint {joint.child}=fixed")
        assert page.evaluate("document.documentElement.scrollWidth") <= 400, "nothing hangs over the side"
        assert not mistakes(reported)
    assert read_robot(folder / "model.urdf").joints[0].kind is JointType.FIXED


def test_a_joint_is_set_by_hand_taken_back_and_filmed_while_a_second_browser_watches_and_a_third_leaves(
    folder: Path, tmp_path: Path
) -> None:
    (joint,) = read_robot(folder / "model.urdf").joints
    with served(folder, 18150) as window, opened(window.url) as (page, reported):
        leaving, second = (page.context.new_page() for _ in range(2))
        for seen in (leaving, second):
            seen.goto(window.url)
        leaving.wait_for_selector("text=At rest", timeout=PATIENCE)
        window.viewer.choose(joint.name)
        leaving.close()
        for seen in (page, second):
            seen.get_by_text(f"{joint.name} moves").first.wait_for(timeout=PATIENCE)
        press(page, "Edit")
        second.get_by_text("Limits [deg]").first.wait_for(timeout=PATIENCE)
        limited(window.viewer, (-10.0, 50.0))
        press(page, "Keep this")
        page.get_by_text("The same from the command line").wait_for(timeout=PATIENCE)
        second.get_by_text("The same from the command line").wait_for(timeout=PATIENCE)
        (found,) = read_robot(folder / "model.urdf").joints
        assert (found.lower, found.upper) == pytest.approx(np.radians([-10.0, 50.0]), abs=1e-5)
        assert np.allclose(found.axis, joint.axis, atol=1e-5)
        press(second, "Undo")
        page.get_by_text("The same from the command line").wait_for(state="detached", timeout=PATIENCE)
        assert not mistakes(reported)
        second.close()
        wait_until(page, lambda: np.ptp(picture(page)[200:600, 300:600], axis=(0, 1)).max() > 50)  # the door is drawn
        downloaded(page, "Film (GIF)", tmp_path / "film.gif")
        downloaded(page, "Picture (PNG)", tmp_path / "picture.png")
    (again,) = read_robot(folder / "model.urdf").joints
    assert (again.lower, again.upper) == (joint.lower, joint.upper)
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames > 10
        shut = np.asarray(film.convert("RGB"), dtype=int)
        film.seek(film.n_frames // 2)
        assert np.abs(np.asarray(film.convert("RGB"), dtype=int) - shut).max() > 50
    with Image.open(tmp_path / "picture.png") as taken:
        assert taken.size == (1600, 1200)
        pixels = np.asarray(taken.convert("RGB"), dtype=int)
    middle, corner = pixels[500:700, 700:900].reshape(-1, 3), pixels[:100, :100].reshape(-1, 3)
    assert np.abs(np.median(middle, axis=0) - np.median(corner, axis=0)).max() > 50, "the door before the sky"


def test_where_a_chain_closes_is_drawn_along_its_pin_wherever_it_stands(tmp_path: Path) -> None:
    urdf = write_inferred("four_bars", tmp_path / "model") / "model.urdf"
    robot = read_robot(urdf)
    (loop,) = robot.loops
    assert "closes the chain" in _introduction(read_model(urdf, ()))
    with served(urdf.parent, 18190) as window:
        window.viewer._add_marks()  # as when a page has its first picture
        for angle in (0.0, 0.4):
            window.viewer.set({"crank_joint": angle})
            T_root_link = forward_kinematics(robot, {"crank_joint": angle})
            ends = [
                T_root_link[link] @ np.append(point, 1.0) for link, point in zip(loop.links, loop.points, strict=True)
            ]
            assert np.allclose(*ends, atol=1e-6), "its followers keep the pin in one place"
            line = window.server.scene._handle_from_node_name["/closed/0"]
            assert len(line.points) > 1
            assert line.visible
            assert np.allclose(line.points[..., :2], ends[0][:2], atol=1e-5), "the dashed line along its pin"
