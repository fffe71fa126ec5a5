"""Size of the code by package: tokens of Python, classes and bytes of YAML; `--write` lowers the ceilings to it.

Docstrings, comments and layout are free: they are to be good, not few. Kinds of objects (`kinematify/generate/kinds`)
are drawings, and so are `benchmarks/fit/variants`: their Python and YAML together are one number of bytes each, outside
of the product.
"""

from __future__ import annotations

import argparse
import ast
import io
import sys
import tokenize
import tomllib
from dataclasses import astuple, dataclass
from pathlib import Path

from tools.imports import ROOT

CEILINGS = ROOT / "tests" / "ceilings.toml"
TOPS = ("kinematify", "validation", "envs", "configs", "benchmarks", "tests", "tools")
DRAWINGS: dict[tuple[str, ...], str] = {
    ("kinematify", "generate", "kinds"): "kinds",
    ("benchmarks", "fit", "variants"): "variants",
}
OUTSIDE = ("benchmarks", "tests", "tools", "kinds", "variants")
"""Packages that no user installs, and kinds; all others are the product."""
LAYOUT = {
    tokenize.NEWLINE,
    tokenize.NL,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.COMMENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}
HEADER = (
    "# The most tokens of Python, classes and bytes of YAML of each package. The product never grows: a package may\n"
    "# grow by what another one shrinks in the same commit. `python -m tools.size --write` lowers the numbers.\n"
)


@dataclass
class Size:
    """What files add up to."""

    tokens: int = 0
    classes: int = 0
    yaml: int = 0

    def add(self, other: Size) -> None:
        """Add the numbers of another size to this one."""
        self.tokens, self.classes, self.yaml = (a + b for a, b in zip(astuple(self), astuple(other), strict=True))


def measured(name: str, text: str) -> Size:
    """Measure one file by its name and content."""
    if not name.endswith(".py"):
        return Size(yaml=len(text.encode()))
    nodes = list(ast.walk(ast.parse(text)))
    free = {
        (item.value.lineno, item.value.col_offset)
        for body in (getattr(node, "body", None) for node in nodes)
        for item in (body if isinstance(body, list) else ())
        if isinstance(item, ast.Expr) and isinstance(item.value, ast.Constant) and isinstance(item.value.value, str)
    }  # docstrings, and strings below attributes
    words = tokenize.generate_tokens(io.StringIO(text).readline)
    tokens = sum(word.type not in LAYOUT and word.start not in free for word in words)
    return Size(tokens, sum(isinstance(node, ast.ClassDef) for node in nodes))


def packages(root: Path = ROOT) -> dict[str, Size]:
    """Size of every package by name, and of the product; modules directly in `kinematify` are one package."""
    found: dict[str, Size] = {"product": Size()}
    for path in sorted(path for top in TOPS for path in (root / top).rglob("*")):
        if path.suffix not in {".py", ".yaml", ".yml"} or not path.is_file() or "__pycache__" in path.parts:
            continue
        top, *rest = path.relative_to(root).parts
        if top == "kinematify" and (root / top / rest[0]).is_symlink():
            continue
        if name := DRAWINGS.get((top, *rest)[:3]):
            size = Size(yaml=path.stat().st_size)
        else:
            name = rest[0] if top == "kinematify" and len(rest) > 1 else top
            size = measured(path.name, path.read_text("utf-8"))
        found.setdefault(name, Size()).add(size)
        if name not in OUTSIDE:
            found["product"].add(size)
    return found


def ceilings(text: str) -> dict[str, Size]:
    """Read the table of ceilings; none where a file has another form."""
    return {name: Size(**row) for name, row in tomllib.loads(text).items() if set(row) == {"tokens", "classes", "yaml"}}


def grown(before: dict[str, Size], now: dict[str, Size]) -> list[str]:
    """Say which numbers of the product are larger than before, one sentence each."""
    if "product" not in before:
        return []
    units = ("tokens", "classes", "bytes of YAML")
    numbers = zip(units, astuple(before["product"]), astuple(now["product"]), strict=True)
    return [f"product: {new:,} {unit}, {old:,} before" for unit, old, new in numbers if new > old]


def table(sizes: dict[str, Size]) -> str:
    """One line per package, the largest first."""
    rows = sorted(sizes.items(), key=lambda item: (item[0] == "product", -item[1].tokens))
    head = f"{'package':<14}{'tokens':>9}{'classes':>9}{'YAML bytes':>12}"
    return "\n".join([head, *(f"{name:<14}{s.tokens:>9,}{s.classes:>9}{s.yaml:>12,}" for name, s in rows)])


def written(sizes: dict[str, Size]) -> str:
    """Write sizes as the text of `tests/ceilings.toml`."""
    rows = (
        f"{name} = {{ tokens = {s.tokens}, classes = {s.classes}, yaml = {s.yaml} }}"
        for name, s in sorted(sizes.items(), key=lambda item: (item[0] != "product", item[0]))
    )
    return HEADER + "\n".join(rows) + "\n"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", nargs="?", type=Path, default=ROOT, help="checkout to measure")
    parser.add_argument("--write", action="store_true", help="lower the ceilings to what is there")
    options = parser.parse_args()
    counted = packages(options.root)
    sys.stdout.write(table(counted) + "\n")
    if options.write:
        if larger := grown(ceilings(CEILINGS.read_text("utf-8")), counted):
            raise SystemExit("Not written, something has to go first:\n" + "\n".join(larger))
        CEILINGS.write_text(written(counted), "utf-8")
