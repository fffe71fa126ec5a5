"""The viewer's page in a browser: a candidate is chosen, kept, and found in the file; it fits a narrow window."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image

from kinematify.pipeline import infer, write_inference
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from tests.browser import opened
from tests.objects import BUILDERS
from tools.draw_view import keep_candidate

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from playwright.sync_api import Page

    from kinematify.view.window import Window

PATIENCE = 180_000
"""Without a graphics card [ms]."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    pytest.importorskip("viser", reason="viser is not installed")
    write_inference(infer(BUILDERS["edge_door"]().assembly), tmp_path / "model", preview=False)
    return tmp_path / "model"


@contextmanager
def served(folder: Path, port: int) -> Iterator[Window]:
    from kinematify.view.window import Window  # needs viser

    window = Window(folder / "model.urdf", port=port)
    window.run_aside()
    try:
        yield window
    finally:
        window.close()


def press(page: Page, words: str) -> None:
    """Press a button; frames are so rare without a graphics card that plain clicks wait for ever."""
    page.locator("button", has_text=words).first.evaluate("button => button.click()")


def test_a_candidate_is_chosen_kept_and_found_in_the_file(folder: Path) -> None:
    (joint,) = read_robot(folder / "model.urdf").joints
    with served(folder, 18140) as window, opened(window.url, width=400) as (page, told):
        page.wait_for_selector("text=At rest", timeout=PATIENCE)
        window.viewer.choose(joint.name)
        said = keep_candidate(page, joint.name, "fixed")
        assert f"--hint {joint.child}=fixed" in said
        assert page.evaluate("document.documentElement.scrollWidth") <= 400, "nothing hangs over the side"
        assert not [line for line in told if line.startswith("error")]
    assert read_robot(folder / "model.urdf").joints[0].kind is JointType.FIXED


def test_a_joint_is_set_by_hand_kept_and_taken_back_while_a_second_browser_watches_and_a_third_leaves(
    folder: Path,
) -> None:
    (joint,) = read_robot(folder / "model.urdf").joints
    with served(folder, 18150) as window:
        with opened(window.url) as (leaving, _):
            leaving.wait_for_selector("text=At rest", timeout=PATIENCE)
            window.viewer.choose(joint.name)
        with opened(window.url) as (page, told):
            second = page.context.browser.new_page()
            second.goto(window.url)
            for seen in (page, second):
                seen.get_by_text(f"{joint.name} moves").first.wait_for(timeout=PATIENCE)
            press(page, "Set by hand")
            second.get_by_text("Limits [deg]").first.wait_for(timeout=PATIENCE)
            window.viewer.set_limits(-10.0, 50.0)
            press(page, "Keep this")
            page.get_by_text("The same from the command line").wait_for(timeout=PATIENCE)
            second.get_by_text("The same from the command line").wait_for(timeout=PATIENCE)
            (found,) = read_robot(folder / "model.urdf").joints
            assert (found.lower, found.upper) == pytest.approx(np.radians([-10.0, 50.0]), abs=1e-5)
            assert np.allclose(found.axis, joint.axis, atol=1e-5)
            press(second, "Take the last choice back")
            page.get_by_text("The same from the command line").wait_for(state="detached", timeout=PATIENCE)
            assert not [line for line in told if line.startswith("error")]
    (again,) = read_robot(folder / "model.urdf").joints
    assert (again.lower, again.upper) == (joint.lower, joint.upper)


def test_a_film_of_the_joint_is_downloaded(folder: Path, tmp_path: Path) -> None:
    with served(folder, 18160) as window, opened(window.url) as (page, _):
        page.wait_for_selector("text=At rest", timeout=PATIENCE)
        page.get_by_role("tab", name="View").focus()
        page.keyboard.press("Enter")
        press(page, "Film (GIF)")
        page.locator("button", has_text=".gif").first.wait_for(state="attached", timeout=PATIENCE)
        with page.expect_download(timeout=PATIENCE) as download:
            press(page, ".gif")
        download.value.save_as(tmp_path / "film.gif")
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames > 10
        shut = np.asarray(film.convert("RGB"), dtype=int)
        film.seek(film.n_frames // 2)
        assert np.abs(np.asarray(film.convert("RGB"), dtype=int) - shut).max() > 50
