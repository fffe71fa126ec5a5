"""Data flows one way: a module imports only from what stands to its left in ORDER."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping

import networkx as nx
import pytest

from tools.imports import ORDER, import_graph, imported_names, modules

NEVER = {("validation", "topology"), ("validation", "pipeline")}  # validation knows models, never the search
FROM_THE_TOP = {"__version__"}


def violations(name: str, source: str) -> list[str]:
    """What module `name` may not import, one sentence each."""
    if name == "kinematify":
        return []  # the public face re-exports lazily from everywhere
    layer = name.split(".")[1]
    if layer not in ORDER:
        return [f"{name}: {layer} has no place in ORDER"]
    found = []
    for target in imported_names(source):
        top, _, rest = target.partition(".")
        if top == "benchmarks":
            found.append(f"{name} imports {target}: no wheel brings it; kinematify.cli.checkout finds it")
        if top == "kinematify" and rest not in FROM_THE_TOP:
            imported = rest.split(".")[0]
            if imported not in ORDER:
                found.append(f"{name} imports {target}: not a layer")
            elif ORDER.index(imported) > ORDER.index(layer) or (layer, imported) in NEVER:
                found.append(f"{name} imports {target}: {imported} is not to the left of {layer}")
    return found


def circles(imports: Mapping[str, Iterable[str]]) -> list[list[str]]:
    """Groups of files of the package or of `benchmarks` that import each other, for types alone included."""
    graph = nx.DiGraph((name, imported) for name in imports for imported in imports[name])
    package = graph.subgraph(name for name in graph if name.startswith(("kinematify.", "benchmarks.")))
    return [sorted(group) for group in nx.strongly_connected_components(package) if len(group) > 1]


def folder_circles(imports: Mapping[str, Iterable[str]], folders: Mapping[str, str]) -> dict[str, set[str]]:
    """Folders of each package, by its name, that import each other.

    Args:
        imports: Modules that each module imports.
        folders: Dotted name of the folder of each module.
    """
    graph = nx.DiGraph()
    for name in imports:
        for imported in imports[name]:
            one, other = folders.get(name, ""), folders.get(imported, "")
            if one != other and one.startswith("kinematify.") and one.split(".")[:2] == other.split(".")[:2]:
                graph.add_edge(one, other)
    found: dict[str, set[str]] = {}
    for group in nx.strongly_connected_components(graph):
        if len(group) > 1:
            package = next(iter(group)).split(".")[1]
            inside = {folder.removeprefix(f"kinematify.{package}").lstrip(".") for folder in group}
            found.setdefault(package, set()).update(inside)
    return found


def test_no_folders_of_a_package_import_each_other() -> None:
    folders = {
        name: name if path.name == "__init__.py" else name.rpartition(".")[0] for name, path in modules().items()
    }
    found = folder_circles(import_graph(), folders)
    assert found == {}, "these folders import each other: move what both need below both"


def test_circles_of_folders_are_found() -> None:
    folders = {
        "kinematify.a.x.one": "kinematify.a.x",
        "kinematify.a.y.two": "kinematify.a.y",
        "kinematify.a.z": "kinematify.a",
    }
    line = {
        "kinematify.a.x.one": ["kinematify.a.y.two"],
        "kinematify.a.y.two": ["kinematify.a.z"],
        "kinematify.a.z": [],
    }
    assert folder_circles(line, folders) == {}
    assert folder_circles({**line, "kinematify.a.z": ["kinematify.a.x.one"]}, folders) == {"a": {"", "x", "y"}}


def test_every_module_imports_only_from_its_left() -> None:
    package = {name: path for name, path in modules().items() if name.split(".")[0] == "kinematify"}
    assert [line for name, path in package.items() for line in violations(name, path.read_text("utf-8"))] == []


def test_no_files_import_each_other() -> None:
    assert circles(import_graph()) == []


def test_no_two_public_classes_of_the_package_have_one_name() -> None:
    places: dict[str, list[str]] = {}
    package = {name: path for name, path in modules().items() if name.split(".")[0] == "kinematify"}
    for name, path in package.items():
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places.setdefault(node.name, []).append(name)
    assert "KinematicModel" in places
    assert {name: found for name, found in places.items() if len(found) > 1} == {}


def test_circles_are_found() -> None:
    imports = {"kinematify.a": ["kinematify.b", "numpy"], "kinematify.b": ["kinematify.c"], "kinematify.c": []}
    assert circles(imports) == []
    assert circles({**imports, "kinematify.c": ["kinematify.a"]}) == [["kinematify.a", "kinematify.b", "kinematify.c"]]


def test_every_layer_exists() -> None:
    assert [layer for layer in ORDER if f"kinematify.{layer}" not in modules()] == []


def test_modules_behind_symlinks_are_seen() -> None:
    assert {"kinematify.cli.app", "kinematify.validation", "kinematify.envs", "benchmarks.study"} <= set(modules())


def test_relative_imports_are_refused() -> None:
    with pytest.raises(ValueError, match="relative import"):
        list(imported_names("from . import load"))


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("kinematify.assembly.load", "from kinematify.contact.graph import ContactGraph"),
        ("kinematify.config", "import kinematify.assembly.part"),
        ("kinematify.paper.cavl", "def f():\n    from kinematify.cli import main"),
        ("kinematify.contact.build_graph", "if TYPE_CHECKING:\n    from kinematify.topology.tree import KinematicTree"),
        ("kinematify.validation.run", "from kinematify.topology.search import search"),
        ("kinematify.model.urdf", "from kinematify import infer"),
        ("kinematify.model.urdf", "importlib.import_module('kinematify.pipeline.infer_assembly')"),
        ("kinematify.cli.bench", "from benchmarks.study import load_study"),
        ("kinematify.cli.bench", "importlib.import_module('benchmarks.study')"),
        ("kinematify.utils", "import os"),
    ],
)
def test_the_check_can_fail(name: str, source: str) -> None:
    assert len(violations(name, source)) == 1


@pytest.mark.parametrize(
    ("name", "source"),
    [
        (
            "kinematify.cli.infer",
            "from kinematify.pipeline.infer_assembly import infer\nfrom kinematify import __version__",
        ),
        ("kinematify.contact.build_graph", "from kinematify.contact.graph import ContactGraph\nimport numpy as np"),
    ],
)
def test_the_check_can_pass(name: str, source: str) -> None:
    assert violations(name, source) == []
