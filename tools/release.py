"""Collect `changes/` into the changelog and set the version: `python -m tools.release 0.2.0`; `--show` only prints."""

from __future__ import annotations

import argparse
import datetime
import re
import sys
import textwrap
from pathlib import Path

from tools.imports import ROOT

HEADINGS = {"breaking": "Breaking", "added": "Added", "fixed": "Fixed", "removed": "Removed"}
"""Type of a change, the middle of its file's name -> heading, in the order of the changelog."""
VERSIONED = {
    "kinematify/__init__.py": '^(__version__ = ")(.+)(")$',
    "benchmarks/__init__.py": '^(KINEMATIFY_VERSION = ")(.+)(")$',
    "CITATION.cff": "^(version: )(.+)()$",
}
"""File -> where its version is."""
MOST_LINES = 80
WIDTH = 150


def collected(folder: Path) -> str:
    """Return the section of a release from the files of its changes, without its title.

    Raises:
        ValueError: There is none, one is empty or has no known type, or they take more than `MOST_LINES` lines.
    """
    found: dict[str, list[str]] = {kind: [] for kind in HEADINGS}
    for path in sorted(folder.glob("*.md")):
        kind, text = path.stem.rpartition(".")[2], " ".join(path.read_text("utf-8").split())
        if kind not in found or not text:
            raise ValueError(f"{path} is empty or not named NAME.TYPE.md, TYPE one of {', '.join(HEADINGS)}.")
        found[kind].append(
            textwrap.fill(f"- {text.removeprefix('- ')}", WIDTH, subsequent_indent="  ", break_on_hyphens=False)
        )
    sections = [f"### {HEADINGS[kind]}\n\n" + "\n".join(texts) + "\n" for kind, texts in found.items() if texts]
    section = "\n".join(sections)
    if not section:
        raise ValueError(f"{folder} holds no change. Write one: changes/NAME.TYPE.md.")
    if (lines := section.count("\n")) > MOST_LINES:
        raise ValueError(f"The changes take {lines} lines; {MOST_LINES} are allowed. Join or shorten some.")
    return section


def release(root: Path, version: str, day: str) -> None:
    """Write the section of a version, set the version everywhere, and remove the files of the changes.

    Raises:
        ValueError: As `collected`; or the version is not above the last one.
    """
    changelog = root / "CHANGELOG.md"
    head, mark, older = changelog.read_text("utf-8").partition("\n## [")
    last = older.partition("]")[0]
    if mark and [int(n) for n in version.split(".")] <= [int(n) for n in last.split(".")]:
        raise ValueError(f"{version} is not above the last release, {last}.")
    section = collected(root / "changes")
    changelog.write_text(f"{head}\n## [{version}] - {day}\n\n{section}{mark}{older}", "utf-8")
    for name, pattern in VERSIONED.items():
        path = root / name
        path.write_text(re.sub(pattern, rf"\g<1>{version}\g<3>", path.read_text("utf-8"), flags=re.MULTILINE), "utf-8")
    for path in (root / "changes").glob("*.md"):
        path.unlink()


def main() -> None:
    """Release, or show what the release would say."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("version", help="for example 0.2.0")
    parser.add_argument("--show", action="store_true", help="print the section, and change nothing")
    asked = parser.parse_args()
    try:
        if asked.show:
            sys.stdout.write(collected(ROOT / "changes"))
        else:
            release(ROOT, asked.version, datetime.date.today().isoformat())
    except ValueError as error:
        raise SystemExit(str(error)) from error


if __name__ == "__main__":
    main()
