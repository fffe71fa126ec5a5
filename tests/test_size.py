"""Tokens of Python, classes and bytes of YAML only decrease; no package is larger than `tests/ceilings.toml` says."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import astuple
from itertools import pairwise

import pytest

from tests.places import ROOT
from tools.size import CEILINGS, Size, ceilings, grown, measured, packages, table


def history() -> list[str]:
    """Text of the table at every commit that changed it, oldest first."""

    def git(*words: str) -> str:
        done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            pytest.skip(f"this folder has no history of git to compare with: {done.stderr.strip()}")
        return done.stdout

    path = CEILINGS.relative_to(ROOT).as_posix()
    first_parents = git("log", "--first-parent", "--reverse", "--format=%H", "--", path).split()
    return [git("show", f"{commit}:{path}") for commit in first_parents]


def test_every_package_is_within_its_ceiling() -> None:
    most, now = ceilings(CEILINGS.read_text("utf-8")), packages()
    sys.stdout.write(table(now) + "\n")
    assert now.keys() == most.keys(), "each package has a ceiling, and each ceiling a package"
    over = [
        f"{name}: {astuple(now[name])} of {astuple(most[name])}"
        for name in now
        if any(a > b for a, b in zip(astuple(now[name]), astuple(most[name]), strict=True))
    ]
    assert over == [], (
        "something has to go before this can come; if another package shrank: python -m tools.size --write"
    )


def test_no_ceiling_of_the_whole_was_raised() -> None:
    versions = [*map(ceilings, history()), ceilings(CEILINGS.read_text("utf-8"))]
    assert [larger for before, now in pairwise(versions) for larger in grown(before, now)] == []


def test_a_raised_ceiling_is_found() -> None:
    before = {"product": Size(10, 2, 5), "joints": Size(10, 2, 5)}
    assert grown(before, {"product": Size(10, 2, 5), "joints": Size(12, 2, 5)}) == []  # another package paid
    assert grown(before, {"product": Size(11, 2, 5)}) == ["product: 11 tokens, 10 before"]
    assert grown(before, {"product": Size(1, 3, 6)}) == [
        "product: 3 classes, 2 before",
        "product: 6 bytes of YAML, 5 before",
    ]


def test_docstrings_comments_and_layout_are_free() -> None:
    plain = "class A:\n    x = 1\n"
    rich = '"""Module."""\n\n\nclass A:\n    """Class."""\n\n    x = 1\n    """Attribute."""\n    # comment\n'
    assert astuple(measured("a.py", plain)) == astuple(measured("a.py", rich)) == (6, 1, 0)
    assert astuple(measured("a.yaml", "a: 1\n")) == (0, 0, 5)
