"""`python -m tools.draw_view FOLDER OUT`: pictures of the viewer's page at three widths, by a real browser.

The test of the page calls `keep_candidate` too.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.view.window import model_window
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
    window = model_window(folder / "model.urdf")
    window.run_aside()
    joint = next(iter(window.viewer.values))
    for width in WIDTHS:
        with opened(window.url, width=width) as (page, _):
            page.wait_for_selector("text=Nothing collides", timeout=_PATIENCE)
            # It says that this machine has no graphics card, and lies over the model.
            page.add_style_tag(content=".mantine-Notifications-root { display: none; }")
            window.viewer.choose(joint)
            window.viewer.set({joint: 0.9})
            (out / f"view_{width}.png").write_bytes(_picture_at_rest(page))
    window.close()


def _picture_at_rest(page: Page) -> bytes:
    """A PNG of a page on which the model has faded in: two in a row are the same."""
    last, picture = b"", page.screenshot(timeout=_PATIENCE)
    while picture != last:
        page.wait_for_timeout(3000)
        last, picture = picture, page.screenshot(timeout=_PATIENCE)
    return picture


if __name__ == "__main__":
    draw(Path(sys.argv[1]), Path(sys.argv[2]))
