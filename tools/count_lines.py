"""Size of the code by package: lines, functions and how long they are, share of public functions with a docstring."""

from __future__ import annotations

import argparse
import ast
import statistics
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

Definition = ast.FunctionDef | ast.AsyncFunctionDef
HEADER = ("| package | lines | functions | median length | public with docstring |", "|---|---|---|---|---|")
TOPS = ("kinematify", "validation", "envs", "benchmarks")


@dataclass
class Size:
    """What a package, or all of them, adds up to."""

    lines: int
    lengths: list[int]
    """Lines of every function, signature and docstring included."""
    public: int
    documented: int

    def row(self, name: str) -> str:
        """One row of the table."""
        median = statistics.median(self.lengths) if self.lengths else 0
        share = f"{self.documented / self.public:.0%}" if self.public else ""
        return f"| {name} | {self.lines:,} | {len(self.lengths):,} | {median:g} | {share} |"


def definitions(body: list[ast.stmt], *, public: bool = True) -> Iterator[tuple[Definition, bool]]:
    """Functions and methods of a module or class with whether they are public; not those within functions."""
    for node in body:
        if isinstance(node, ast.ClassDef):
            yield from definitions(node.body, public=public and not node.name.startswith("_"))
        elif isinstance(node, Definition):
            yield node, public and not node.name.startswith("_")


def size(files: list[Path]) -> Size:
    """Add up files."""
    total = Size(0, [], 0, 0)
    for file in files:
        source = file.read_text("utf-8")
        total.lines += source.count("\n")
        for node, public in definitions(ast.parse(source).body):
            total.lengths.append((node.end_lineno or node.lineno) - node.lineno + 1)
            total.public += public
            total.documented += public and ast.get_docstring(node) is not None
    return total


def packages(root: Path) -> dict[str, list[Path]]:
    """Files of every package under `root`; modules directly in `kinematify` stand together."""
    found: dict[str, list[Path]] = {}
    for file in sorted(file for top in TOPS for file in (root / top).rglob("*.py")):
        top, *rest = file.relative_to(root).parts
        name = rest[0] if top == "kinematify" and len(rest) > 1 else top
        found.setdefault(name, []).append(file)
    return found


def table(roots: list[Path]) -> str:
    """One Markdown table per tree."""
    blocks = []
    for root in roots:
        found = packages(root)
        rows = [size(files).row(name) for name, files in sorted(found.items())]
        total = size([file for files in found.values() for file in files]).row("**all**")
        blocks.append("\n".join([f"{root}\n", *HEADER, *rows, total]))
    return "\n\n".join(blocks)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("roots", nargs="*", type=Path, default=[Path()], help="trees to count, e.g. two checkouts")
    sys.stdout.write(table(parser.parse_args().roots) + "\n")
