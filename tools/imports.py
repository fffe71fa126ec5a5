"""Which module imports which, read from the source of the package and of its tests; nothing of it is run."""

from __future__ import annotations

import ast
import os
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from kinematify import _HOMES

ROOT = Path(__file__).resolve().parent.parent
ORDER = (
    "errors", "versions", "config", "robot", "assembly", "geometry", "render", "contact", "joints", "topology", "paper",
    "model", "formats", "generate", "pipeline", "simulation", "manipulation", "validation", "refinement", "vision",
    "envs", "evaluation", "view", "cli", "__main__",
)  # fmt: skip
"""Packages and modules of `kinematify`: each imports only from what stands to its left."""


@cache
def modules() -> dict[str, Path]:
    """File of every module of the package and of its tests by dotted name, through the symlinks too."""
    found = {}
    for top in ("kinematify", "tests", "tools"):
        for folder, _, files in os.walk(ROOT / top, followlinks=True):
            for path in sorted(Path(folder, file) for file in files if file.endswith(".py")):
                found[".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")] = path
    return found


def imported_names(source: str) -> Iterator[str]:
    """Dotted names of what a module imports, wherever in the file."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                raise ValueError(f"line {node.lineno} has a relative import; write the whole name of the module")
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@cache
def import_graph() -> dict[str, frozenset[str]]:
    """For every module the modules that it imports or names in a string, as the command line does to load late.

    A public name of `kinematify` stands for the module that it is loaded from.
    """
    return {name: frozenset(_resolved(path) - {name}) for name, path in modules().items()}


def _resolved(path: Path) -> set[str]:
    source = path.read_text("utf-8")
    names = set(imported_names(source))
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "kinematify":
            names.add(f"kinematify.{node.attr}")
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            names.add(node.value.partition(":")[0])
    return {module for name in names if (module := _module_of(name))}


def _module_of(name: str) -> str | None:
    """The module that a dotted name is, or is taken from."""
    top, _, public = name.partition(".")
    if top == "kinematify" and public in _HOMES:
        return _HOMES[public]
    while name and name not in modules():
        name = name.rpartition(".")[0]
    return None if name in ("", "kinematify", "tests", "tools") else name
