"""No package grows beyond its ceiling, and a ceiling only decreases (`tests/ceilings.toml`)."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from itertools import pairwise

import pytest

from tests.places import ROOT
from tools.count_lines import packages, size

CEILINGS = ROOT / "tests" / "ceilings.toml"
LOOSE = 1.02
"""A ceiling this far above the count no longer holds anything: it is lowered to the count."""


def counted() -> dict[str, int]:
    """Lines of Python of each package, tests apart, of `benchmarks/`, and of YAML in `configs/`."""
    lines = {name: size(files).lines for name, files in packages(ROOT).items()}
    lines["configs/*.yaml"] = sum(file.read_text("utf-8").count("\n") for file in (ROOT / "configs").glob("*.yaml"))
    return lines


def ceilings(text: str) -> dict[str, int]:
    """The table of ceilings."""
    return dict(tomllib.loads(text)["lines"])


def raised(before: dict[str, int], now: dict[str, int], message: str) -> list[str]:
    """Packages whose ceiling rose, or is new, in a commit whose message gives no reason for it."""
    reasons = set(re.findall(r"^Ceiling of (\S+):", message, flags=re.MULTILINE))
    return [name for name, most in now.items() if most > before.get(name, 0) and name not in reasons]


def history() -> list[tuple[str, str]]:
    """Message and text of the table at every commit that changed it, oldest first."""

    def git(*words: str) -> str:
        done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            pytest.skip(f"this folder has no history of git to compare with: {done.stderr.strip()}")
        return done.stdout

    path = CEILINGS.relative_to(ROOT).as_posix()
    commits = git("log", "--reverse", "--format=%H", "--", path).split()
    return [(git("log", "-1", "--format=%B", commit), git("show", f"{commit}:{path}")) for commit in commits]


def test_every_package_is_within_its_ceiling() -> None:
    most, now = ceilings(CEILINGS.read_text("utf-8")), counted()
    table = "\n".join(f"{name:>16} {now.get(name, 0):>7,} of {most.get(name, 0):>7,}" for name in sorted(most | now))
    assert now.keys() == most.keys(), f"each package has a ceiling, and each ceiling a package\n{table}"
    assert [name for name in now if now[name] > most[name]] == [], f"something has to go before this can come\n{table}"
    assert [name for name in now if now[name] * LOOSE + 20 < most[name]] == [], f"lower the ceiling\n{table}"
    product = sum(lines for name, lines in now.items() if name not in ("benchmarks", "configs/*.yaml"))
    sys.stdout.write(f"{table}\n{'the product':>16} {product:>7,}\n")


def test_no_ceiling_was_raised_without_a_reason() -> None:
    versions = history()
    for (_, before), (message, now) in pairwise(versions):
        assert raised(ceilings(before), ceilings(now), message) == [], message.splitlines()[0]
    if versions:
        assert raised(ceilings(versions[-1][1]), ceilings(CEILINGS.read_text("utf-8")), "") == [], "not committed yet"


def test_a_raised_ceiling_is_found() -> None:
    assert raised({"joints": 10}, {"joints": 9}, "") == []
    assert raised({"joints": 10}, {"joints": 11}, "Joints see more") == ["joints"]
    assert raised({"joints": 10}, {"joints": 11}, "Joints see more\n\nCeiling of joints: a new cue pays 2 %") == []
    assert raised({}, {"new": 5}, "") == ["new"]
