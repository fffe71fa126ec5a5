"""A release collects the files of changes, sets the version everywhere, and refuses what it cannot place."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.places import ROOT
from tools.release import VERSIONED, release


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    for name in ("CHANGELOG.md", *VERSIONED):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    (tmp_path / "changes").mkdir()
    (tmp_path / "changes" / "colour.fixed.md").write_text("- A colour is\nkept.\n")
    (tmp_path / "changes" / "names.breaking.md").write_text(f"The option `--x` is gone. {'Use `--y`. ' * 20}\n")
    return tmp_path


def test_a_release_says_what_breaks_first_and_sets_the_version(checkout: Path) -> None:
    before = (checkout / "CHANGELOG.md").read_text()
    release(checkout, "7.1.0", "2030-01-02")
    head, added, older = (
        (checkout / "CHANGELOG.md").read_text().partition("\n## [7.1.0] - 2030-01-02\n\n### Breaking\n\n")
    )
    assert added
    assert older.startswith("- The option `--x` is gone. ")
    assert "`.\n\n### Fixed\n\n- A colour is kept.\n\n## [" in older
    assert before == head + "\n## [" + older.partition("\n## [")[2]
    assert all("7.1.0" in (checkout / name).read_text() for name in VERSIONED)
    assert list((checkout / "changes").iterdir()) == []


@pytest.mark.parametrize(
    ("name", "text", "version", "message"),
    [
        ("a.changed.md", "Something.", "7.1.0", "a.changed.md is empty or not named"),
        ("a.added.md", "\n", "7.1.0", "is empty"),
        ("a.added.md", "word " * 3000, "7.1.0", "lines; 80 are allowed"),
        ("a.added.md", "Something.", "0.0.9", "not above the last release"),
    ],
)
def test_what_cannot_be_placed_is_refused_and_changes_nothing(
    checkout: Path, name: str, text: str, version: str, message: str
) -> None:
    (checkout / "changes" / name).write_text(text)
    before = {path: path.read_text() for path in checkout.rglob("*.*") if path.is_file()}
    with pytest.raises(ValueError, match=message):
        release(checkout, version, "2030-01-02")
    assert {path: path.read_text() for path in checkout.rglob("*.*") if path.is_file()} == before
