"""The viewer's page in a browser: a candidate is chosen, kept, and found in the file; it fits a narrow window."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image

from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.record import write_inference
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from tests.browser import opened, wait_until
from tests.household import four_bars
from tests.objects import BUILDERS
from tests.view.pages import PATIENCE, downloaded, limited, mistakes, picture, press, served
from tools.draw_view import keep_candidate

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_inference(infer(BUILDERS["edge_door"]().assembly), tmp_path / "model", preview=False)
    return tmp_path / "model"


def test_a_candidate_is_chosen_kept_and_found_in_the_file(folder: Path) -> None:
    (joint,) = read_robot(folder / "model.urdf").joints
    with served(folder, 18140) as window, opened(window.url, width=400) as (page, reported):
        page.wait_for_selector("text=At rest", timeout=PATIENCE)
        window.viewer.choose(joint.name)
        window.viewer.set({joint.name: 0.5})
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


def test_a_joint_is_set_by_hand_kept_and_taken_back_while_a_second_browser_watches_and_a_third_leaves(
    folder: Path,
) -> None:
    (joint,) = read_robot(folder / "model.urdf").joints
    with served(folder, 18150) as window, opened(window.url, width=400) as (page, reported):
        leaving, second = (page.context.browser.new_page(viewport=page.viewport_size) for _ in range(2))
        for seen in (leaving, second):
            seen.goto(window.url, timeout=PATIENCE)
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
    (again,) = read_robot(folder / "model.urdf").joints
    assert (again.lower, again.upper) == (joint.lower, joint.upper)


def test_where_a_chain_closes_is_drawn_along_its_pin_wherever_it_stands(tmp_path: Path) -> None:
    write_inference(infer(four_bars().assembly), tmp_path / "model", preview=False)
    robot = read_robot(tmp_path / "model" / "model.urdf")
    (loop,) = robot.loops
    with served(tmp_path / "model", 18190) as window, opened(window.url, width=800) as (page, reported):
        page.wait_for_selector("text=Nothing collides", timeout=PATIENCE)
        assert "closes the chain" in page.inner_text("body")
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
        assert not mistakes(reported)


def test_a_film_of_the_joint_and_a_picture_are_downloaded(folder: Path, tmp_path: Path) -> None:
    with served(folder, 18160) as window, opened(window.url) as (page, _):
        page.wait_for_selector("text=At rest", timeout=PATIENCE)
        wait_until(page, lambda: np.ptp(picture(page)[200:600, 300:600], axis=(0, 1)).max() > 50)  # the door is drawn
        downloaded(page, "Film (GIF)", tmp_path / "film.gif")
        downloaded(page, "Picture (PNG)", tmp_path / "picture.png")
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
