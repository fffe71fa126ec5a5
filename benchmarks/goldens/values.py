"""Values that goldens are hashes of: JSON without machine, time or folder in it."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Mapping
from enum import Enum
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.generate.procedural.blueprint import Blueprint

Values = dict[str, Any]
"""By name, each a JSON value."""
EXACT, SPREAD, PORTABLE = KINDS = ("exact", "spread", "portable")
"""Same on one platform, there within the spread of repeated runs, and on all platforms."""
_FEW = 3
"""Numbers of an array that are shown instead of their hash."""


def made(
    *, exact: Values | None = None, spread: Values | None = None, portable: Values | None = None
) -> dict[str, Values]:
    """Return what one item of a subject gives."""
    return {EXACT: exact or {}, SPREAD: spread or {}, PORTABLE: portable or {}}


def digest(value: Any) -> str:
    """SHA-256 of a JSON value; the order of keys counts."""
    return hashlib.sha256(json.dumps(value).encode()).hexdigest()


def array_hash(array: Any) -> str:
    """Shape, type and hash of an array's bytes."""
    array = np.ascontiguousarray(array)
    return f"{array.shape} {array.dtype} {hashlib.sha256(array.tobytes()).hexdigest()}"


def file_hashes(folder: Path) -> Values:
    """SHA-256 of every file of a folder and below, by path."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def plain(value: Any) -> Any:
    """A value as JSON; arrays as hashes, dataclasses as the values of their fields."""
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, (np.ndarray, np.generic)):
        return array_hash(value) if value.size > _FEW else plain(value.tolist())
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if dataclasses.is_dataclass(value):
        return plain([getattr(value, item.name) for item in dataclasses.fields(value)])
    return value  # what JSON cannot hold is refused when it is hashed


def shape_of(value: Any) -> Any:
    """The schema of a JSON value: names of keys and types; a list is the schemas of its items, each once."""
    if isinstance(value, Mapping):
        return {key: shape_of(item) for key, item in value.items()}
    if isinstance(value, list):
        shapes = [shape_of(item) for item in value]
        return [shape for number, shape in enumerate(shapes) if shape not in shapes[:number]]
    return "number" if isinstance(value, (int, float)) and not isinstance(value, bool) else type(value).__name__


def blueprint_values(blueprint: Blueprint) -> tuple[Values, Values]:
    """An object with exact joints, to the last bit, and what of it is the same on every platform."""
    exact = {
        "parts": [
            {
                "name": part.name,
                "mesh": part.mesh_hash,
                "color": plain(part.color),
                "density": part.density,
                "appearance": plain(part.appearance),
            }
            for part in blueprint.parts
        ],
        "joints": [
            {
                "parent": joint.parent,
                "child": joint.child,
                "kind": joint.kind.value,
                **{name: plain(getattr(joint, name)) for name in ("axis", "pivot", "lower", "upper", "value", "mimic")},
            }
            for joint in blueprint.joints
        ],
        "loops": plain(blueprint.loops),
        "parameters": plain(blueprint.parameters),
    }
    structure = {
        "name": blueprint.name,
        "family": blueprint.family,
        "parts": [part.name for part in blueprint.parts],
        "joints": [[joint.parent, joint.child, joint.kind.value] for joint in blueprint.joints],
        "followers": [joint.child for joint in blueprint.joints if joint.mimic is not None],
        "loops": [[loop.one, loop.other] for loop in blueprint.loops],
        "parameters": {name: _rounded(value) for name, value in blueprint.parameters.items()},
    }
    return exact, structure


def _rounded(value: Any) -> Any:
    return f"{value:.6g}" if isinstance(value, float) else plain(value)


def first_difference(before: Any, now: Any, place: str = "") -> str:
    """Where two JSON values first differ and how, in words; empty where they are the same."""
    if isinstance(before, dict) and isinstance(now, dict):
        for key in (*before, *(key for key in now if key not in before)):
            if key not in before or key not in now:
                return f"{place}/{key}: only {'now' if key in now else 'before'}"
            if found := first_difference(before[key], now[key], f"{place}/{key}"):
                return found
        return "" if list(before) == list(now) else f"{place}: keys in another order"
    if isinstance(before, list) and isinstance(now, list):
        for number, (one, other) in enumerate(zip(before, now, strict=False)):
            if found := first_difference(one, other, f"{place}/{number}"):
                return found
        return "" if len(before) == len(now) else f"{place}: {len(before)} items before, {len(now)} now"
    return "" if digest(before) == digest(now) else f"{place}: {_short(before)} before, {_short(now)} now"


def _short(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 100 else f"{text[:97]}..."
