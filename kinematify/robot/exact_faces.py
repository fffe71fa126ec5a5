"""Cylinders and planes as a CAD file states them, which are exact where triangles are not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import read_only
from kinematify.robot.vectors import lengths_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class ExactFaces:
    """The round and flat faces of a part; arrays are read-only."""

    axes: FloatArray
    """Unit direction of every cylinder, shape (C, 3)."""
    points: FloatArray
    """A point on the axis of every cylinder, in the frame and unit of the vertices beside it, shape (C, 3)."""
    normals: FloatArray
    """Unit normal of every plane, shape (P, 3)."""

    def __post_init__(self) -> None:
        for name in ("axes", "points", "normals"):
            object.__setattr__(self, name, read_only(np.reshape(getattr(self, name), (-1, 3)), np.float64))

    def moved(self, linear: FloatArray, offset: FloatArray) -> ExactFaces:
        """Return the faces after p -> linear @ p + offset, shapes (3, 3) and (3,)."""
        return ExactFaces(
            axes=_units(self.axes @ linear.T),
            points=self.points @ linear.T + offset,
            normals=_units(self.normals @ np.linalg.inv(linear)),
        )


def joined_faces(faces: Sequence[ExactFaces | None]) -> ExactFaces | None:
    """Return all of them as those of one part; None where no file states any."""
    stated = [item for item in faces if item is not None]
    if not stated:
        return None
    return ExactFaces(
        axes=np.concatenate([item.axes for item in stated]),
        points=np.concatenate([item.points for item in stated]),
        normals=np.concatenate([item.normals for item in stated]),
    )


def _units(rows: FloatArray) -> FloatArray:
    return rows / lengths_of(rows)[:, None]
