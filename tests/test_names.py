"""Modules have names of their own, and docstrings begin with what a thing is or does."""

from __future__ import annotations

import ast
from collections import Counter

from tools.imports import modules

MOST_DOCSTRINGS = 60
"""Docstrings of the product that may begin with a word of `QUESTIONS`."""
QUESTIONS = {"What", "Whether", "How", "See", "Let", "Of"}


def test_no_two_modules_of_the_product_have_one_name() -> None:
    names = Counter(path.stem for name, path in modules().items() if name.startswith("kinematify."))
    assert [name for name, number in names.items() if number > 1 and name not in ("__init__", "base")] == []


def test_docstrings_begin_with_what_a_thing_is_or_does() -> None:
    found = []
    for name, path in modules().items():
        if name.startswith("kinematify"):
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
                    words = (ast.get_docstring(node) or "").split(maxsplit=1)
                    if words and words[0] in QUESTIONS:
                        found.append(f"{name}: {ast.get_docstring(node)}")
    assert len(found) <= MOST_DOCSTRINGS, "\n".join(found)
