"""Objects that a file writes down step by step: what is drawn where, by how much it varies, and how it moves.

A step is a mapping with one verb: `part`, `cut` and `bore` draw shapes; `hinge`, `spin`, `slide`, `fix`, `follow` and
`close` join parts; every function of `mechanisms` and `panels` is a verb, too; `let`, `for` and `when` compute, repeat
and choose; `define` makes a function of steps that `give` a value, and `call` uses one. `as` names what a verb returns.
Values are formulas; names of parts and materials are texts with formulas in braces.

Steps can also carve, which takes effect at once: then the verbs are `body`, `add`, `cut`, `turns`, `slides`, `within` a
frame, and the pieces in `kinematify.generate.procedural.pieces`. Formulas name the same solids in both.

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
from inspect import Parameter, Signature
from itertools import pairwise
from types import FunctionType
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.generate.library import mechanisms, panels
from kinematify.generate.library.builder import spread
from kinematify.generate.library.expressions import evaluated, filled_in
from kinematify.generate.procedural import solids

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence


Step = dict[str, Any]
_MOST_ROUNDS = 500
"""Of one loop."""
_TEXTS = ("parent", "other", "fork", "material", "color", "leader", "child", "names")


def public(module: Any) -> dict[str, Callable[..., Any]]:
    """Functions and classes that a module offers, keyed by name."""
    return {
        name: item
        for name, item in vars(module).items()
        if isinstance(item, FunctionType | type) and item.__module__ == module.__name__ and not name.startswith("_")
    }


MECHANISMS = {name: call for name, call in (public(mechanisms) | public(panels)).items() if name != "seam"}
"""Verbs that draw a part together with its joint, keyed by name."""


ARITHMETIC: Mapping[str, Any] = {
    **{name: getattr(math, name) for name in ("sqrt", "tan", "atan2", "asin", "acos", "radians")},
    **{name: getattr(np, name) for name in ("sin", "cos", "hypot", "sign", "cross", "linspace", "cumsum", "pi")},
    **{call.__name__: call for call in (abs, min, max, int, round, len, enumerate, sorted, zip, list, sum, bool)},
    "X": solids.X, "Y": solids.Y, "Z": solids.Z, "vector": solids.vector, "array": np.array, "norm": np.linalg.norm,
    "arange": np.arange, "range": range, "spread": spread, "pairwise": pairwise,
}  # fmt: skip
"""What formulas may name, besides parameters, what `let` computes, and shapes or solids."""
SOLIDS = public(solids)
"""Solids that formulas may name."""


class StepRunner:
    """Carries out the steps of a description on one target."""

    def __init__(self, target: Any, verbs: Mapping[str, Callable[..., Any]]) -> None:
        """`verbs` are called with the target, a name, shapes or solids, and what else a step gives."""
        self._target, self._verbs = target, verbs

    def run(self, steps: Sequence[Step], names: dict[str, Any]) -> None:
        """Carry out steps; `names` are what formulas may name, and take what is computed.

        Raises:
            ValueError: A step cannot be carried out; the message quotes it.
        """
        for step in steps:
            if "let" in step:
                for name, formula in step["let"].items():
                    _assign(name, formula, names)
            elif "for" in step:
                self._repeat(step, names)
            elif "when" in step:
                self.run(step["do"] if evaluated(step["when"], names) else step.get("else", ()), names)
            elif "define" in step:
                names.update(_function(step["define"], names, self._followed(step)))
            elif "within" in step:
                frame = self._target.from_frame(evaluated(step["within"], names))
                StepRunner(frame, self._verbs).run(step["do"], names)
            elif "call" in step:
                evaluated(step["call"], names)
            else:
                self._draw(step, names)

    def _repeat(self, step: Step, names: dict[str, Any]) -> None:
        for number, item in enumerate(evaluated(step["in"], names)):
            if number >= _MOST_ROUNDS:
                raise ValueError(f"the loop over {step['in']!r} has more than {_MOST_ROUNDS} rounds")
            _unpack(step["for"], item, names)
            self.run(step["do"], names)

    def _followed(self, step: Step) -> Callable[[dict[str, Any]], Any]:
        """Return what `define` does: names that its steps give stay inside."""

        def followed(inner: dict[str, Any]) -> Any:
            self.run(step["do"], inner)
            return evaluated(step.get("give", 0), inner)

        return followed

    def _draw(self, step: Step, names: dict[str, Any]) -> None:
        (verb, target), *rest = step.items()
        given = {
            key: _text(value, names) if key in _TEXTS else evaluated(value, names) for key, value in rest if key != "as"
        }
        name = filled_in(target, names)
        drawn = _flat(given.pop("shapes", None) or given.pop("solids", ()))
        try:
            found = self._verbs[verb](self._target, name, *drawn, **given)
        except (TypeError, KeyError) as error:
            raise ValueError(f"the step {verb} {name} cannot be carried out: {error}") from error
        if "as" in step:
            names[step["as"]] = found


def _text(value: Any, names: dict[str, Any]) -> Any:
    return [filled_in(item, names) for item in value] if isinstance(value, list) else filled_in(value, names)


def _flat(found: Any) -> list[Any]:
    """Shapes or solids out of lists of them."""
    return [item for part in found for item in (_flat(part) if isinstance(part, list | tuple) else [part])]


def _assign(target: str, formula: Any, names: dict[str, Any]) -> None:
    """Give names the value of a formula; ``area(x)`` becomes a function."""
    if target.endswith(")") and target[0] != "(":
        names.update(_function(target, names, lambda inner: evaluated(formula, inner)))
    else:
        _unpack(target, evaluated(formula, names), names)


def _function(
    signature: str, names: dict[str, Any], body: Callable[[dict[str, Any]], Any]
) -> dict[str, Callable[..., Any]]:
    """Return a function by its name; `signature` is as Python has it, ``area(x, *others, scale=1.0)``.

    Args:
        signature: Name, and parameters in brackets.
        names: That its body may use; those of the day when it is called.
        body: Is given them with the arguments.
    """
    name, _, inside = signature.partition("(")
    parameters = []
    for item in _split(inside[:-1]):
        key, _, default = item.partition("=")
        kind = Parameter.VAR_POSITIONAL if key.startswith("*") else Parameter.POSITIONAL_OR_KEYWORD
        value = evaluated(default, names) if default else Parameter.empty
        parameters += [Parameter(key.strip("* "), kind, default=value)] if key else []
    taken = Signature(parameters)

    def called(*args: Any, **given: Any) -> Any:
        bound = taken.bind(*args, **given)
        bound.apply_defaults()
        return body({**names, **bound.arguments})

    return {name: called}


def _unpack(targets: str, value: Any, names: dict[str, Any]) -> None:
    """Give names their values; `k, (x, y)` takes a pair whose second is one."""
    parts = _split(targets)
    if len(parts) == 1 and not targets.strip().startswith("("):
        names[parts[0]] = value
        return
    for part, item in zip(parts, value, strict=True):
        _unpack(part.strip("()") if part.startswith("(") else part, item, names)


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
