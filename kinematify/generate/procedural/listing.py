"""The parameters of a family as people read them, on a terminal and on the gallery's page."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.generate.procedural.parameter import Parameter

PARAMETER_HEADINGS = ("parameter", "default", "values", "what it is")


def parameter_rows(parameters: Sequence[Parameter]) -> list[tuple[str, str, str, str]]:
    """Return a row of cells per parameter, see `PARAMETER_HEADINGS`."""
    return [(item.name, _default(item), _values(item), item.help) for item in parameters]


def _default(parameter: Parameter) -> str:
    value = parameter.default
    text = format(value, "g") if isinstance(value, float) else str(value)
    return f"{text} {parameter.unit}".strip()


def _values(parameter: Parameter) -> str:
    if parameter.bounds is not None:
        return f"{parameter.bounds[0]:g} to {parameter.bounds[1]:g} {parameter.unit}".strip()
    return ", ".join(choice for choice in parameter.choices if choice)
