"""Templates of every HTML page: a name in a model is text in it, and it loads nothing from other servers."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from kinematify.validation.formats.report_content import printable

_ASSETS = Path(__file__).resolve().parent / "assets"


def rendered(template: str, **facts: Any) -> str:
    """Return a template of the assets with these facts: their texts are escaped, never executed."""
    shown: str = _templates().get_template(template).render(**facts)
    return shown


@cache
def _templates() -> Environment:
    made = Environment(
        loader=FileSystemLoader(_ASSETS),
        autoescape=True,
        trim_blocks=True,
        undefined=StrictUndefined,
        finalize=lambda value: printable(value) if type(value) is str else value,
    )
    asset = {"asset": lambda name: (_ASSETS / name).read_text(encoding="utf-8")}
    made.globals |= {**asset, "scripts": (), "beside": False}
    return made
