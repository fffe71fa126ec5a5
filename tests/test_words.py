"""Docs, help and messages are in plain technical English: words that a reader would have to guess are not used."""

from __future__ import annotations

import ast
import importlib
import re
from typing import TYPE_CHECKING

import click

from kinematify.cli.app import COMMANDS
from tests.places import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

INSTEAD = {
    "told": "reported, warned, distinguished",
    "tells": "shows, reports, distinguishes",
    "stands": "is",
    "mend": "fix",
    "mends": "fixes",
    "mended": "fixed",
    "mending": "fixing",
    "heed": "apply, respect",
    "heeded": "applied, respected",
    "heeds": "applies, respects",
    "anew": "again; retrain",
    "left out": "held-out; omitted",
    "ways": "directions, sides, range",
    "hands": "authors",
    "blame": "cause",
    "blames": "causes",
    "blamed": "causes",
}
"""Word -> what to write."""
WORD = re.compile(rf"\b({'|'.join(INSTEAD)})\b", re.IGNORECASE)
ALLOWED = (
    ("docs/validate.md", "`blame`"),  # the key of schema 1
    ("*", "hands of a clock"),
    ("docs/gallery.md", "`hands`"),  # of a clock
)
"""File, phrase: there the word is the right one."""


def found(name: str, text: str) -> Iterator[tuple[int, str]]:
    """Line, counted from 0, and word of each hit that is not allowed."""
    for file, phrase in ALLOWED:
        if file in ("*", name):
            text = text.replace(phrase, "")
    for line, words in enumerate(text.splitlines()):
        yield from ((line, match[0]) for match in WORD.finditer(words))


def pages() -> Iterator[tuple[str, int, str]]:
    """Name, first line and text of each page."""
    for page in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))):
        yield page.relative_to(ROOT).as_posix(), 1, page.read_text("utf-8")


def helps() -> Iterator[tuple[str, int, str]]:
    """The same of the help of each command."""
    for name in COMMANDS:
        command = importlib.import_module(f"kinematify.cli.{name}").command
        yield f"kinematify {name} --help", 1, command.get_help(click.Context(command, info_name=f"kinematify {name}"))


def messages() -> Iterator[tuple[str, int, str]]:
    """The same of each string of the code that has a space and is no docstring."""
    for top in ("kinematify", "validation", "envs"):
        for file in sorted((ROOT / top).rglob("*.py")):
            text = file.read_text("utf-8")
            if not WORD.search(text):
                continue
            tree = ast.parse(text)
            bare = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
            for node in ast.walk(tree):
                said = node.value if isinstance(node, ast.Constant) and id(node) not in bare else None
                if isinstance(said, str) and " " in said:
                    yield file.relative_to(ROOT).as_posix(), node.lineno, said


def test_no_reader_has_to_guess_a_word() -> None:
    hits = [
        f"{name}:{first + line}: {word!r}; write: {INSTEAD[word.lower()]}"
        for texts in (pages(), helps(), messages())
        for name, first, text in texts
        for line, word in found(name, text)
    ]
    assert not hits, f"{len(hits)} words of the list:\n" + "\n".join(hits)


def test_a_word_of_the_list_is_found_with_its_line() -> None:
    assert list(found("docs/input.md", "Fine.\nThe unit is Heeded, the page left out.")) == [
        (1, "Heeded"),
        (1, "left out"),
    ]
    assert not list(found("docs/input.md", "The hands of a clock turn, the handset stands_by"))
