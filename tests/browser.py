"""A page in a real browser; tests are skipped where there is none."""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

import pytest

from benchmarks.browser import open_browser
from kinematify.errors import EnvironmentFault

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from playwright.sync_api import Page

_PATIENCE = 180_000
"""For a page on a machine without a graphics card that other tests share [ms]."""


@contextmanager
def opened(address: str, *, dark: bool = False, width: int = 1200) -> Iterator[tuple[Page, list[str]]]:
    """Open an address; yield the page and, as they come, errors of its scripts and what it says on the console."""
    with ExitStack() as stack:
        try:
            browser = stack.enter_context(open_browser())
        except EnvironmentFault as fault:
            pytest.skip(str(fault))
        size, scheme = {"width": width, "height": 800}, "dark" if dark else "light"
        context = browser.new_context(viewport=size, color_scheme=scheme)
        context.set_default_timeout(_PATIENCE)
        page = context.new_page()
        messages: list[str] = []
        page.on("console", lambda message: messages.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: messages.append(f"error: {error}"))
        page.on("request", lambda request: _note_request(request.url, messages))
        page.goto(address)
        yield page, messages


def wait_until(page: Page, is_so: Callable[[], object]) -> None:
    """Wait for a state of the page or of the program behind it, however slow the machine is, or fail."""
    for _ in range(_PATIENCE // 200):
        if is_so():
            return
        page.wait_for_timeout(200)
    raise AssertionError("The page never came into the state that was waited for.")


def _note_request(url: str, messages: list[str]) -> None:
    if not url.startswith(("file:", "data:", "blob:")):
        messages.append(f"request: {url}")
