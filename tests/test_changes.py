"""Fragments of the list of changes are named by what they are, and say something."""

from __future__ import annotations

from tools.imports import ROOT

TYPES = {"added", "breaking", "fixed", "removed"}


def test_every_fragment_has_a_type_and_a_text() -> None:
    fragments = [file for file in (ROOT / "changes").iterdir() if not file.name.lower().startswith(("readme", "."))]
    assert [file.name for file in fragments if file.suffix != ".md" or file.name.split(".")[-2] not in TYPES] == []
    assert [file.name for file in fragments if not file.read_text("utf-8").strip()] == []
