"""Which module imports which, read from the source of the package and of its tests; nothing of it is run."""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from kinematify import _HOMES

ROOT = Path(__file__).resolve().parent.parent
ORDER = (
    "errors", "versions", "processes", "configs", "config", "robot", "assembly", "geometry", "contact",
    "joints", "grouping", "topology", "paper", "model", "simulation", "render", "generate", "pipeline", "manipulation",
    "formats", "validation", "refinement", "vision", "creation", "batch", "envs", "view", "evaluation", "cli",
    "__main__",
)  # fmt: skip
"""Packages and modules of `kinematify`: each imports only from what stands to its left; none imports `benchmarks`."""


@cache
def modules() -> dict[str, Path]:
    """File of every module of the package, benchmarks, tests and tools by dotted name, through the symlinks too."""
    found = {}
    for top in ("kinematify", "benchmarks", "tests", "tools"):
        for folder, _, files in os.walk(ROOT / top, followlinks=True):
            for path in sorted(Path(folder, file) for file in files if file.endswith(".py")):
                found[".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")] = path
    return found


def imported_names(source: str) -> Iterator[str]:
    """Dotted names of what a module imports, wherever in the file, or names in a string to import it late."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                raise ValueError(f"line {node.lineno} has a relative import; write the whole name of the module")
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            if named := re.fullmatch(r"((?:kinematify|benchmarks)(?:\.\w+)+)(?:(\.)|:[\w/-]+)?", node.value):
                yield f"{named[1]}.*" if named[2] else named[1]  # with a dot at its end it is the start of an f-string
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "kinematify":
            yield f"kinematify.{node.attr}"


@cache
def import_graph() -> dict[str, frozenset[str]]:
    """For every module the modules of the package, its tests and tools that it imports."""
    resolved = {
        name: {module for imported in imported_names(path.read_text("utf-8")) for module in _modules_of(imported)}
        for name, path in modules().items()
    }
    return {name: frozenset(imported - {name}) for name, imported in resolved.items()}


def _modules_of(name: str) -> set[str]:
    """The module that a dotted name is or is taken from, all of a package for `package.*`; none of other projects.

    A public name of `kinematify` represents the module that it is loaded from.
    """
    top, _, public = name.partition(".")
    if top == "kinematify" and public in _HOMES:
        return {_HOMES[public]}
    if name.endswith(".*"):
        return {module for module in modules() if module.rpartition(".")[0] == name[:-2]}
    while name and name not in modules():
        name = name.rpartition(".")[0]
    return {name} - {"", "kinematify", "benchmarks", "tests", "tools"}
