"""What goes wrong on the viewer's page or with what it shows is reported, and nothing is lost."""

from __future__ import annotations

import os
from contextlib import contextmanager
from typing import TYPE_CHECKING

from tests.browser import opened
from tests.inferred import write_inferred
from tests.view.pages import PATIENCE, mistakes, press, served

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


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


def test_a_read_only_folder_is_reported_and_stays_as_it_is(tmp_path: Path) -> None:
    folder = tmp_path / "safe" / "model"
    write_inferred("edge_door", folder)
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    with served(folder, 18170) as window, opened(window.url) as (page, reported):
        page.wait_for_selector("text=At rest", timeout=PATIENCE)
        joint = next(iter(window.viewer.values))
        window.viewer.choose(joint)
        page.get_by_text(f"{joint} moves").first.wait_for(timeout=PATIENCE)
        window.viewer.try_candidate(joint, 1)
        with read_only(folder):
            press(page, "Keep this")
            page.get_by_text("Nothing was changed").first.wait_for(timeout=PATIENCE)
        assert "permissions" in page.inner_text("body")
        assert not mistakes(reported)
        assert before == {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        press(page, "Keep this")
        page.get_by_text("The same from the command line").wait_for(timeout=PATIENCE)
    assert before[folder / "model.urdf"] != (folder / "model.urdf").read_bytes(), "kept when it may be written again"
