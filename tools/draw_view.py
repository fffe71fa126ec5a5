"""`python -m tools.draw_view FOLDER OUT`: pictures of the viewer's page at three widths, by a real browser.

The test of the page calls `visit` too, so that the pictures show what is tested.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.view.window import Window
from tests.browser import opened

if TYPE_CHECKING:
    from playwright.sync_api import Page

WIDTHS = (1440, 800, 400)
_PATIENCE = 180_000
"""For a picture without a graphics card [ms]."""


def keep_candidate(page: Page, joint: str, words: str) -> str:
    """Choose a candidate of a joint on the page, keep it, and return what the page says then.

    Args:
        page: Of a window.
        joint: The one that is chosen on it.
        words: How the candidate begins, behind its number.
    """
    page.get_by_text(f"{joint} moves").first.wait_for(timeout=_PATIENCE)
    # Without a graphics card frames are so rare that a page is never seen to stand still, as plain clicks ask for.
    page.locator("input[aria-haspopup=listbox]").last.evaluate("box => box.click()", timeout=_PATIENCE)
    page.locator("[role=option]", has_text=words).first.evaluate("option => option.click()", timeout=_PATIENCE)
    page.locator("button", has_text="Keep this").first.evaluate("button => button.click()", timeout=_PATIENCE)
    page.get_by_text("The same from the command line").wait_for(timeout=_PATIENCE)
    return page.inner_text("body")


def draw(folder: Path, out: Path) -> None:
    """Write ``view_WIDTH.png`` for each of `WIDTHS`."""
    window = Window(folder / "model.urdf")
    window.run_aside()
    joint = next(iter(window.viewer.values))
    for width in WIDTHS:
        with opened(window.url, width=width) as (page, _):
            page.wait_for_selector("text=Nothing collides", timeout=_PATIENCE)
            window.viewer.choose(joint)
            window.viewer.set({joint: 0.9})
            page.wait_for_timeout(4000)
            page.screenshot(path=out / f"view_{width}.png", timeout=_PATIENCE)
    window.close()


if __name__ == "__main__":
    draw(Path(sys.argv[1]), Path(sys.argv[2]))
