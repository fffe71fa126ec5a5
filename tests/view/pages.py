"""A model folder on the viewer's page, and what tests do there."""

from __future__ import annotations

from contextlib import contextmanager
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from kinematify.robot.read import read_robot
from kinematify.view.inference_view import shown_with
from kinematify.view.viewer_scene import ViewScene

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from playwright.sync_api import Page

    from kinematify.robot.arrays import IntArray
    from kinematify.view.alternatives import JointAlternative
    from kinematify.view.server import ModelViewer
    from kinematify.view.window import Window


PATIENCE = 180_000
"""Without a graphics card [ms]."""


def candidates_in(folder: Path) -> Mapping[tuple[str, str], tuple[JointAlternative, ...]]:
    """What the page offers for each joint of a model folder, by parent and child."""
    return shown_with(ViewScene(read_robot(folder / "model.urdf")), folder / "inference.json").alternatives


@contextmanager
def served(folder: Path, port: int) -> Iterator[Window[ModelViewer]]:
    """The page of a model folder."""
    from kinematify.view.window import model_window  # needs viser

    window = model_window(folder / "model.urdf", port=port)
    window.run_aside()
    try:
        yield window
    finally:
        window.close()


def limited(viewer: ModelViewer, limits: tuple[float, float]) -> None:
    """Put the two handles of the limits somewhere [deg or mm], as the slider does while a joint is set by hand."""
    viewer._panel.hand_limits.value = limits
    viewer.change_line()


def press(page: Page, words: str) -> None:
    """Press a button; frames are so rare without a graphics card that plain clicks wait for ever."""
    page.locator("button", has_text=words).first.evaluate("button => button.click()")


def picture(page: Page) -> IntArray:
    """The page as it is now, RGB from 0 to 255, shape (height, width, 3)."""
    with Image.open(BytesIO(page.screenshot(timeout=PATIENCE))) as seen:
        return np.asarray(seen.convert("RGB"), dtype=int)


def mistakes(reported: list[str]) -> list[str]:
    """Errors of the page's scripts.

    Without those of a slow page, where viser takes updates of a panel and the new panel together and says so.
    """
    return [line for line in reported if line.startswith("error") and "non-existent component" not in line]


def downloaded(page: Page, button: str, out: Path) -> Path:
    """Press a button of the tab "View" that makes a file, and save that."""
    page.get_by_role("tab", name="View").focus()
    page.keyboard.press("Enter")
    press(page, button)
    page.locator("button", has_text=out.suffix).first.wait_for(state="attached", timeout=PATIENCE)
    with page.expect_download(timeout=PATIENCE) as download:
        press(page, out.suffix)
    download.value.save_as(out)
    return out
