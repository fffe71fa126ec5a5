"""Data flows one way: a module imports only from what stands to its left in ORDER."""

from __future__ import annotations

import ast
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.places import ROOT

ORDER = (
    "errors", "versions", "config", "robot", "assembly", "geometry", "render", "contact", "joints", "topology", "paper",
    "model", "formats", "generate", "pipeline", "simulation", "manipulation", "validation", "refinement", "vision",
    "envs", "evaluation", "view", "cli", "__main__",
)  # fmt: skip
NEVER = {("validation", "topology"), ("validation", "pipeline")}  # validation knows models, never the search
FROM_THE_TOP = {"__version__"}


def modules() -> list[tuple[str, str]]:
    """Dotted name and source of every module of the package, through the symlinks too."""
    found = []
    for folder, _, files in os.walk(ROOT / "kinematify", followlinks=True):
        for file in sorted(files):
            path = Path(folder, file)
            if path.suffix == ".py":
                parts = path.relative_to(ROOT).with_suffix("").parts
                found.append((".".join(parts[:-1] if parts[-1] == "__init__" else parts), path.read_text("utf-8")))
    return found


def imported_names(source: str) -> Iterator[str]:
    """Dotted names of what a module imports, wherever in the file."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative imports hide the layer"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def violations(name: str, source: str) -> list[str]:
    """What module `name` may not import, one sentence each."""
    if name in ("kinematify", "kinematify.configs"):
        return []  # the public face re-exports lazily from everywhere; configs holds data
    layer = name.split(".")[1]
    if layer not in ORDER:
        return [f"{name}: {layer} has no place in ORDER"]
    found = []
    for target in imported_names(source):
        top, _, rest = target.partition(".")
        if top == "kinematify" and rest not in FROM_THE_TOP:
            imported = rest.split(".")[0]
            if imported not in ORDER:
                found.append(f"{name} imports {target}: not a layer")
            elif ORDER.index(imported) > ORDER.index(layer) or (layer, imported) in NEVER:
                found.append(f"{name} imports {target}: {imported} is not to the left of {layer}")
    return found


def test_every_module_imports_only_from_its_left() -> None:
    assert [problem for name, source in modules() for problem in violations(name, source)] == []


def test_modules_behind_symlinks_are_seen() -> None:
    names = {name for name, _ in modules()}
    assert {"kinematify", "kinematify.cli.app", "kinematify.validation", "kinematify.envs"} <= names


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("kinematify.assembly.load", "from kinematify.contact.graph import ContactGraph"),
        ("kinematify.config", "import kinematify.assembly.part"),
        ("kinematify.paper.cavl", "def f():\n    from kinematify.cli import main"),
        ("kinematify.contact.build", "if TYPE_CHECKING:\n    from kinematify.topology.tree import KinematicTree"),
        ("kinematify.validation.run", "from kinematify.topology.mcts import search"),
        ("kinematify.model.urdf", "from kinematify import infer"),
        ("kinematify.utils", "import os"),
    ],
)
def test_the_check_can_fail(name: str, source: str) -> None:
    assert len(violations(name, source)) == 1


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("kinematify.cli.infer", "from kinematify.pipeline import infer\nfrom kinematify import __version__"),
        ("kinematify.contact.build", "from kinematify.contact.graph import ContactGraph\nimport numpy as np"),
    ],
)
def test_the_check_can_pass(name: str, source: str) -> None:
    assert violations(name, source) == []
