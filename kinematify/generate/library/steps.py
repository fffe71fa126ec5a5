"""Objects that a file writes down step by step: what is drawn where, by how much it varies, and how it moves.

A step is a mapping with one verb: `part`, `cut` and `bore` draw shapes; `hinge`, `spin`, `slide`, `fix` and `follow`
join parts; every function of `mechanisms` and `panels` is a verb, too; `let`, `for` and `when` compute, repeat and
choose. Values are formulas; names of parts and materials are texts with formulas in braces.

```yaml
steps:
- {part: pot, material: steel, shapes: ['cylinder(radius, (0, 0, 0), (0, 0, height))']}
- for: k, x
  in: enumerate(spread(2, -radius, radius))
  do:
  - {knob: 'knob_{k}', parent: pot, at: [x, -radius, 0.1], radius: 0.02, high: 0.02, out: -Y}
```
"""

from __future__ import annotations

import math
from itertools import pairwise
from types import FunctionType
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.generate.library import mechanisms, panels, shapes
from kinematify.generate.library.builder import spread
from kinematify.generate.library.expressions import compiled, evaluated, filled_in

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.generate.library.builder import ObjectBuilder
    from kinematify.robot.arrays import FloatArray

Step = dict[str, Any]
_MOST_ROUNDS = 500
"""Of one loop."""
_TEXTS = ("parent", "material", "color", "leader", "child", "names")
_CORE = ("part", "cut", "bore", "hinge", "spin", "slide", "fix", "follow")


def _public(module: Any) -> dict[str, Callable[..., Any]]:
    return {
        name: function
        for name, function in vars(module).items()
        if isinstance(function, FunctionType) and function.__module__ == module.__name__ and not name.startswith("_")
    }


MECHANISMS = {name: call for name, call in (_public(mechanisms) | _public(panels)).items() if name != "seam"}
"""Verbs that draw a part together with its joint, keyed by name."""


def vector(x: float, y: float, z: float) -> FloatArray:
    """A vector, shape (3,), that formulas can add and scale."""
    return np.array([x, y, z], dtype=np.float64)


_FUNCTIONS: Mapping[str, Any] = {
    **_public(shapes),
    **{name: getattr(math, name) for name in ("sqrt", "tan", "atan2", "asin", "acos", "radians")},
    **{name: getattr(np, name) for name in ("sin", "cos", "hypot", "sign", "cross", "linspace", "cumsum", "pi")},
    **{call.__name__: call for call in (abs, min, max, int, round, len, enumerate, sorted, zip, list, sum, bool)},
    "X": shapes.X, "Y": shapes.Y, "Z": shapes.Z, "vector": vector, "array": np.array, "norm": np.linalg.norm,
    "arange": np.arange, "range": range, "spread": spread, "pairwise": pairwise,
}  # fmt: skip
"""What formulas may name, besides parameters and what `let` computes."""


def checked_steps(steps: Sequence[Step]) -> Sequence[Step]:
    """Return steps as they are, once every verb is known and every formula is one.

    Raises:
        ValueError: One is not; the message quotes it.
    """
    for step in steps:
        verb = next(iter(step), "")
        if verb not in (*_CORE, *MECHANISMS, "let", "for", "when"):
            raise ValueError(f"there is no step {verb!r}; there are {', '.join((*_CORE, *MECHANISMS))}")
        for key in ("do", "else"):
            checked_steps(step.get(key, ()))
        for key, value in step.items():
            if key not in (verb, "do", "else", *_TEXTS) or key in ("let", "when"):
                _check(value)
    return steps


def _check(value: Any) -> None:
    if isinstance(value, str):
        compiled(value)
    for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        _check(item)


def run_steps(steps: Sequence[Step], builder: ObjectBuilder, values: Mapping[str, Any]) -> None:
    """Carry out steps.

    Args:
        steps: In this order.
        builder: Takes what they draw.
        values: Of the parameters.

    Raises:
        ValueError: A step cannot be carried out; the message quotes it.
    """
    style = {f"style_{name}": value for name, value in vars(builder.style).items()}
    draws = {name: getattr(builder, name) for name in ("draw", "count", "maybe", "pick", "gap")}
    own = {"seam": lambda size, thick: panels.seam(builder, size, thick)}
    _run(steps, builder, {"__builtins__": {}, **_FUNCTIONS, **style, **draws, **own, **values})


def _run(steps: Sequence[Step], builder: ObjectBuilder, names: dict[str, Any]) -> None:
    for step in steps:
        if "let" in step:
            for name, formula in step["let"].items():
                _assign(name, evaluated(formula, names), names)
        elif "for" in step:
            for number, item in enumerate(evaluated(step["in"], names)):
                if number >= _MOST_ROUNDS:
                    raise ValueError(f"the loop over {step['in']!r} has more than {_MOST_ROUNDS} rounds")
                _assign(step["for"], item, names)
                _run(step["do"], builder, names)
        elif "when" in step:
            _run(step["do"] if evaluated(step["when"], names) else step.get("else", ()), builder, names)
        else:
            _draw(step, builder, names)


def _draw(step: Step, builder: ObjectBuilder, names: dict[str, Any]) -> None:
    (verb, target), *rest = step.items()
    given = {key: _text(value, names) if key in _TEXTS else evaluated(value, names) for key, value in rest}
    name = filled_in(target, names)
    try:
        if verb in MECHANISMS:
            MECHANISMS[verb](builder, name, **given)
        elif verb in ("part", "cut", "bore"):
            getattr(builder, verb)(name, *_flat(given.pop("shapes", ())), **given)
        else:
            getattr(builder, verb)(name, **given)
    except TypeError as error:
        raise ValueError(f"the step {verb} {name} cannot be carried out: {error}") from error


def _text(value: Any, names: dict[str, Any]) -> Any:
    return [filled_in(item, names) for item in value] if isinstance(value, list) else filled_in(value, names)


def _flat(found: Any) -> list[Any]:
    """Shapes out of lists of shapes."""
    return [shape for item in found for shape in ([item] if isinstance(item, dict) else _flat(item))]


def _assign(targets: str, value: Any, names: dict[str, Any]) -> None:
    """Give names their values; `k, (x, y)` takes a pair whose second is one."""
    parts = _split(targets)
    if len(parts) == 1 and not targets.strip().startswith("("):
        names[parts[0]] = value
        return
    for part, item in zip(parts, value, strict=True):
        _assign(part.strip("()") if part.startswith("(") else part, item, names)


def _split(targets: str) -> list[str]:
    """Split at commas that are in no bracket."""
    found, depth = [""], 0
    for letter in targets:
        depth += (letter == "(") - (letter == ")")
        if letter == "," and depth == 0:
            found.append("")
        else:
            found[-1] += letter
    return [part.strip() for part in found]
