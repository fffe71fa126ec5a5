"""A real browser for tests of pages: the Chromium of the system, without a window."""

from __future__ import annotations

import os
import shutil
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Page

_PATIENCE = 180_000
"""For a page on a machine without a graphics card that other tests share [ms]."""
_NAMES = ("chromium", "chromium-browser", "google-chrome")


def browser_path() -> str:
    """Path of the browser; skips the test where there is none."""
    named = os.environ.get("KINEMATIFY_BROWSER")
    found = named or next((path for path in map(shutil.which, _NAMES) if path), None)
    if found is None:
        pytest.skip("there is no Chromium on this machine (Debian: apt-get install chromium)")
    return found


@contextmanager
def opened(address: str, *, dark: bool = False, width: int = 1200) -> Iterator[tuple[Page, list[str]]]:
    """Open an address; yield the page and, as they come, errors of its scripts and what it says on the console."""
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    path = browser_path()
    flags = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    with playwright.sync_playwright() as engine:
        browser = engine.chromium.launch(executable_path=path, args=flags)
        page = browser.new_page(viewport={"width": width, "height": 800}, color_scheme="dark" if dark else "light")
        page.set_default_timeout(_PATIENCE)
        told: list[str] = []
        page.on("console", lambda message: told.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: told.append(f"error: {error}"))
        page.on("request", lambda request: _note_request(request.url, told))
        page.goto(address)
        yield page, told
        browser.close()


def _note_request(url: str, told: list[str]) -> None:
    if not url.startswith(("file:", "data:", "blob:")):
        told.append(f"request: {url}")
