"""A real browser for pages that are measured and tested: the Chromium of the system, without a window."""

from __future__ import annotations

import os
import shutil
from contextlib import contextmanager
from typing import TYPE_CHECKING

from kinematify.errors import EnvironmentFault
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser

_NAMES = ("chromium", "chromium-browser", "google-chrome")
_FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""It draws by the processor, as machines without a graphics card must."""


@contextmanager
def open_browser() -> Iterator[Browser]:
    """Start the browser that the variable ``KINEMATIFY_BROWSER`` names, else the Chromium of the system.

    Raises:
        EnvironmentFault: There is none, or playwright is not installed.
    """
    require("A page that is measured", "playwright")
    from playwright.sync_api import sync_playwright  # noqa: PLC0415  # for tests and measurements of pages alone

    path = os.environ.get("KINEMATIFY_BROWSER") or next(filter(None, map(shutil.which, _NAMES)), None)
    if path is None:
        raise EnvironmentFault("There is no Chromium on this machine (Debian: apt-get install chromium).")
    with sync_playwright() as engine:
        browser = engine.chromium.launch(executable_path=path, args=list(_FLAGS))
        yield browser
        browser.close()
