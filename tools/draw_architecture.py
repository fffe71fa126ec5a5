"""Write the drawing and the table of packages in docs/architecture.md again from the code."""

from __future__ import annotations

import ast

import networkx as nx

from tools.imports import ORDER, ROOT, import_graph, modules
from tools.size import measured, packages

PAGE = ROOT / "docs" / "architecture.md"
EVERYWHERE = {"errors", "versions", "configs", "config", "__main__"}
"""Imported by nearly all, or the way in: they would only add arrows."""


def drawing() -> str:
    """Mermaid source: an arrow from A to B where B imports A, unless a longer way over others says so already."""
    imports = nx.DiGraph()
    for name, imported in import_graph().items():
        for module in imported:
            source, target = _package(module), _package(name)
            if source and target and source != target:
                imports.add_edge(source, target)
    shown = nx.transitive_reduction(imports).edges
    arrows = [f"    {source} --> {target}" for source in ORDER for target in ORDER if (source, target) in shown]
    return "\n".join(["```mermaid", "flowchart LR", *arrows, "```"])


def _package(module: str) -> str | None:
    """The package of a module, None if the drawing leaves it out."""
    top, *rest = module.split(".")
    return rest[0] if top == "kinematify" and rest and rest[0] not in EVERYWHERE else None


def table() -> str:
    """Markdown: every package with the first sentence of its docstring and its tokens."""
    sizes = {name: size.tokens for name, size in packages().items()}
    rows = []
    for name in ORDER:
        path = modules()[f"kinematify.{name}"]
        sentence = (ast.get_docstring(ast.parse(path.read_text("utf-8"))) or "").split("\n\n")[0].replace("\n", " ")
        tokens = sizes.get(name) or measured(path.name, path.read_text("utf-8")).tokens
        rows.append(f"| `{name}` | {sentence} | {tokens:,} |")
    return "\n".join(["| package | what it does | tokens |", "|---|---|---|", *rows])


def rewritten(page: str) -> str:
    """The page with its two generated parts made again."""
    for name, content in (("drawing", drawing()), ("packages", table())):
        begin, end = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
        if begin not in page or end not in page:
            raise SystemExit(f"{PAGE} has no lines {begin} and {end}; the {name} goes between them.")
        before, _, rest = page.partition(begin)
        page = f"{before}{begin}\n{content}\n{end}{rest.partition(end)[2]}"
    return page


if __name__ == "__main__":
    PAGE.write_text(rewritten(PAGE.read_text("utf-8")), "utf-8")
