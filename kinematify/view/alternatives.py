"""Joints that the inference also thought of, from `inference.json`, as they can be tried on the model."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import InputError
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Alternative:
    """One candidate of a joint; world frame at zero."""

    title: str
    kind: JointType
    axis: FloatArray
    """Unit direction, shape (3,)."""
    pivot: FloatArray
    """A point on the axis [m], shape (3,)."""


def load_alternatives(path: Path) -> dict[tuple[str, str], tuple[Alternative, ...]]:
    """Return the candidates of every joint, best first, keyed by (parent, child) part names.

    Args:
        path: `inference.json` of a model folder.

    Raises:
        InputError: It cannot be read.
    """
    try:
        joints = json.loads(path.read_text(encoding="utf-8"))["joints"]
        return {(joint["parent"], joint["child"]): tuple(map(_alternative, joint["candidates"])) for joint in joints}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{path} is no record of an inference ({type(error).__name__}: {error}). Run `kinematify infer` again, or "
            "view the model from another folder."
        ) from error


def _alternative(candidate: dict[str, Any]) -> Alternative:
    axis, pivot = (np.asarray(candidate[key], dtype=np.float64) for key in ("axis", "pivot"))
    direction = ", ".join(f"{value:.2f}" for value in axis)
    title = f"{candidate['type']} ({direction}), score {float(candidate['score']):.2f}, {candidate['source']}"
    return Alternative(title=title, kind=JointType(candidate["type"]), axis=axis, pivot=pivot)
