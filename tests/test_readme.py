"""What README, CONTRIBUTING and the pages in docs quote exists: commands, options, targets, paths, Python names."""

from __future__ import annotations

import ast
import re
import shlex
from pathlib import Path

import click
import pytest

import kinematify
from benchmarks.study import study_command
from kinematify.cli.app import COMMANDS, cli
from tests.places import ROOT

PAGES = ("README.md", "CONTRIBUTING.md", *sorted(f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md")))
MADE_BY_COMMANDS = ("out/", "OUT/", "meshes/", "parts/", "inferred/", "OUT.job/")
# Ids of environments, repositories elsewhere, what is yours.
NO_PATHS = (
    r".*-v\d|ZebraDevs/fetch_ros|Daniella1/.*|mees/.*|ros-industrial/.*|models/|jackal/.*|more/.*|assets/.*|"
    r"changes/NAME\.TYPE\.md"
)


def blocks(text: str, language: str) -> str:
    """Content of all fenced code blocks of one language."""
    return "\n".join(re.findall(rf"^```{language}\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL))


def command_lines(text: str) -> list[list[str]]:
    """Words after `kinematify` of every command in shell blocks and in `quotes`."""
    lines = blocks(text, "bash").splitlines() + re.findall(r"`([^`\n]+)`", text)
    found = [re.match(r"(?:\.venv/bin/)?kinematify +([a-z].*)", line) for line in lines]
    return [shlex.split(match[1], comments=True) for match in found if match]


def problem_of(words: list[str]) -> str | None:
    """Why these words are no valid call, None if they are."""
    name, *rest = words
    command = cli.get_command(click.Context(cli), name)
    if command is None:
        return f"no command {name}"
    if name == "bench" and rest:
        command = study_command(rest[0]) or command
    known = {option for parameter in command.params for option in parameter.opts} | {"--help"}
    unknown = [word for word in rest if word.startswith("-") and word != "-" and word not in known]
    return f"{name} has no option {', '.join(unknown)}" if unknown else None


def missing_paths(text: str, folder: Path = ROOT) -> list[str]:
    """Paths in links and `quotes` of a page in `folder` that are not in the repository and not made by a command."""
    quoted = re.findall(r"\]\(([^)#]+)\)", text) + re.findall(r"`([\w.-]+/[\w./-]*)`", text)
    quoted += [word for words in command_lines(text) for word in words if "/" in word]
    here = {path.split("#")[0] for path in quoted if "://" not in path and not path.startswith(("../shared", "/"))}
    return sorted(
        path
        for path in here
        if not path.startswith(MADE_BY_COMMANDS)
        and not re.fullmatch(NO_PATHS, path)
        and not any((place / path).exists() for place in (folder, ROOT, ROOT / "kinematify"))
    )


def make_targets() -> set[str]:
    """Targets of the Makefile."""
    return set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text("utf-8"), flags=re.MULTILINE))


@pytest.fixture(params=PAGES)
def page(request: pytest.FixtureRequest) -> Path:
    return ROOT / request.param


def test_commands_and_options_exist(page: Path) -> None:
    assert [problem for words in command_lines(page.read_text("utf-8")) if (problem := problem_of(words))] == []


def test_paths_exist(page: Path) -> None:
    assert missing_paths(page.read_text("utf-8"), page.parent) == []


@pytest.mark.parametrize("name", ["README.md", "CONTRIBUTING.md"])
def test_make_targets_exist(name: str) -> None:
    text = (ROOT / name).read_text("utf-8")
    quoted = re.findall(r"^make ([a-z]+)", blocks(text, "bash"), flags=re.MULTILINE)
    quoted += re.findall(r"`make ([a-z]+)", text)
    assert quoted
    assert set(quoted) <= make_targets()


def test_the_page_of_commands_shows_every_command() -> None:
    text = (ROOT / "docs" / "commands.md").read_text("utf-8")
    assert {words[0] for words in command_lines(text)} == set(COMMANDS) | {"bench"}


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_python_example_uses_public_names(page: str) -> None:
    tree = ast.parse(blocks((ROOT / page).read_text("utf-8"), "python"))
    used = {
        node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "kinematify"
    }
    assert used
    assert used <= set(kinematify.__all__)


@pytest.mark.parametrize(("page", "mark"), [("README.md", "figures"), ("docs/results.md", "tables")])
def test_marks_of_generated_tables_come_once_and_in_order(page: str, mark: str) -> None:
    text = (ROOT / page).read_text("utf-8")
    assert re.findall(rf"<!-- {mark}:(\w+) -->", text) == ["begin", "end"]


def test_the_checks_can_fail() -> None:
    text = "`kinematify guess x` and `kinematify infer x --no-such` [a](docs/none.md) `no/such/file.py`"
    assert [problem_of(words) for words in command_lines(text)] == ["no command guess", "infer has no option --no-such"]
    assert missing_paths(text) == ["docs/none.md", "no/such/file.py"]
