"""What README and CONTRIBUTING quote exists: commands, options, make targets, paths, Python names."""

from __future__ import annotations

import ast
import re
import shlex

import click
import pytest

import kinematify
from kinematify.cli.app import COMMANDS, cli
from tests.places import ROOT

PAGES = ("README.md", "CONTRIBUTING.md")
MADE_BY_COMMANDS = ("out/", "meshes/", "parts/", "truth/")


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
    known = {option for parameter in command.params for option in parameter.opts} | {"--help"}
    unknown = [word for word in rest if word.startswith("-") and word != "-" and word not in known]
    return f"{name} has no option {', '.join(unknown)}" if unknown else None


def missing_paths(text: str) -> list[str]:
    """Paths in links and `quotes` that are not in the repository and are not made by a command."""
    quoted = re.findall(r"\]\(([^)#]+)\)", text) + re.findall(r"`([\w.-]+/[\w./-]*)`", text)
    quoted += [word for words in command_lines(text) for word in words if "/" in word]
    here = {path.split("#")[0] for path in quoted if "://" not in path and not path.startswith(("..", "/"))}
    return sorted(
        path
        for path in here
        if not path.startswith(MADE_BY_COMMANDS)
        and not ((ROOT / path).exists() or (ROOT / "kinematify" / path).exists())
    )


def make_targets() -> set[str]:
    """Targets of the Makefile."""
    return set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text("utf-8"), flags=re.MULTILINE))


@pytest.fixture(params=PAGES)
def page(request: pytest.FixtureRequest) -> str:
    return (ROOT / request.param).read_text("utf-8")


def test_commands_and_options_exist(page: str) -> None:
    assert [problem for words in command_lines(page) if (problem := problem_of(words))] == []


def test_paths_exist(page: str) -> None:
    assert missing_paths(page) == []


def test_make_targets_exist(page: str) -> None:
    quoted = re.findall(r"^make ([a-z]+)", blocks(page, "bash"), flags=re.MULTILINE) + re.findall(
        r"`make ([a-z]+)", page
    )
    assert quoted
    assert set(quoted) <= make_targets()


def test_readme_shows_every_command() -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    assert {words[0] for words in command_lines(text)} == set(COMMANDS) | {"bench"}


def test_python_example_uses_public_names() -> None:
    tree = ast.parse(blocks((ROOT / "README.md").read_text("utf-8"), "python"))
    used = {
        node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "kinematify"
    }
    assert used
    assert used <= set(kinematify.__all__)


def test_the_first_screen_has_the_sentence_of_the_demo_and_its_picture() -> None:
    first = "\n".join((ROOT / "README.md").read_text("utf-8").splitlines()[:18])
    sentence = re.search(r"^export SENTENCE := (.+)$", (ROOT / "Makefile").read_text("utf-8"), flags=re.MULTILINE)
    assert sentence
    assert f'"{sentence[1]}"' in first
    assert "](docs/demo.png)" in first
    assert "make demo" in first
    assert "make test" in first


def test_result_markers_stand_once_and_in_order() -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    assert re.findall(r"<!-- results:(\w+) -->", text) == ["begin", "end"]


def test_the_checks_can_fail() -> None:
    text = "`kinematify guess x` and `kinematify infer x --no-such` [a](docs/none.md) `no/such/file.py`"
    assert [problem_of(words) for words in command_lines(text)] == ["no command guess", "infer has no option --no-such"]
    assert missing_paths(text) == ["docs/none.md", "no/such/file.py"]
