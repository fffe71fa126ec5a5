"""Numbers that an object writes as formulas: ``0.5 * width``, ``draw(0.2, 0.4)``, ``[x for x in spread(4, 0, 1)]``.

A formula is parsed and every node of it is checked before it is evaluated, so that a file can compute and do nothing
else: no attribute but sizes of fields and motions of solids, no name that starts with an underscore, no call but of
these and of the functions that are given to it.
"""

from __future__ import annotations

import ast
import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import CodeType

_LONGEST = 2000  # characters
_LARGEST = 1_000_000  # whole number that is written out
_ALLOWED = (
    ast.Expression, ast.Constant, ast.Name, ast.Load, ast.Store, ast.Tuple, ast.List, ast.Dict, ast.Starred, ast.Call,
    ast.keyword, ast.BinOp, ast.Add, ast.Sub, ast.Mult, ast.Div, ast.FloorDiv, ast.Mod, ast.MatMult, ast.UnaryOp,
    ast.USub, ast.Not, ast.BoolOp, ast.And, ast.Or, ast.Compare, ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE,
    ast.In, ast.NotIn,
    ast.Is, ast.IsNot, ast.IfExp, ast.Subscript, ast.Slice, ast.ListComp, ast.comprehension,
    ast.JoinedStr, ast.FormattedValue, ast.Attribute,
)  # fmt: skip
_FIELDS = {
    "left", "right", "bottom", "top", "width", "height", "depth", "wall", "middle", "box", "front", "kind", "place",
    "outward", "clearance", "placed", "boss", "hole", "upper", "lower", "knee", "end", "length", "high", "ring", "get",
    "translate", "rotate", "transform", "mirror", "trim_by_plane",
}  # fmt: skip
"""Attributes that formulas may name."""


@lru_cache(maxsize=20_000)
def compiled(text: str) -> CodeType:
    """Return a formula that is safe to evaluate.

    Raises:
        ValueError: It is no formula, or it holds what no formula may.
    """
    if len(text) > _LONGEST:
        raise ValueError(f"the formula {text[:40]!r}... has more than {_LONGEST} characters")
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, RecursionError) as error:
        raise ValueError(f"{text!r} is no formula") from error
    for node in ast.walk(tree):
        if not isinstance(node, _ALLOWED):
            raise ValueError(f"the formula {text!r} may not hold {type(node).__name__}")
        if isinstance(node, ast.Name) and node.id.startswith("_"):
            raise ValueError(f"the formula {text!r} may not hold the name {node.id!r}")
        if isinstance(node, ast.Attribute) and node.attr not in _FIELDS:
            raise ValueError(f"the formula {text!r} may not hold the attribute {node.attr!r}")
        if isinstance(node, ast.Constant) and isinstance(node.value, int) and abs(node.value) > _LARGEST:
            raise ValueError(f"the formula {text!r} holds a number above {_LARGEST}")
        if isinstance(node, ast.FormattedValue) and node.format_spec is not None:
            raise ValueError(f"the formula {text!r} may not lay out numbers")
        if isinstance(node, ast.Call) and not isinstance(node.func, ast.Name | ast.Attribute):
            raise ValueError(f"the formula {text!r} may call only functions by name and methods")
    return compile(tree, "<formula>", "eval")


def evaluated(given: Any, names: dict[str, Any]) -> Any:
    """Return what a value of a file says: numbers as they are, texts as formulas, lists and mappings item by item.

    Args:
        given: From a file.
        names: What formulas may name: functions and values.

    Raises:
        ValueError: A formula cannot be evaluated; the message quotes it.
    """
    if isinstance(given, str):
        try:
            return eval(compiled(given), names)
        except (ArithmeticError, AttributeError, NameError, TypeError, IndexError, KeyError) as error:
            raise ValueError(f"the formula {given!r} cannot be evaluated: {error}") from error
    if isinstance(given, list | tuple):
        return [evaluated(item, names) for item in given]
    if isinstance(given, dict):
        return {key: evaluated(item, names) for key, item in given.items()}
    return given


def filled_in(text: str, names: Mapping[str, Any]) -> str:
    """Return a name with its formulas in braces evaluated, ``wheel_{k + 1}``.

    Raises:
        ValueError: A formula cannot be evaluated, or there are braces in braces.
    """
    filled = re.sub(r"\{([^{}]*)\}", lambda found: str(evaluated(found[1], dict(names))), text)
    if "{" in filled:
        raise ValueError(f"the name {text!r} has braces in braces; compute the inner one by `let` before")
    return filled
