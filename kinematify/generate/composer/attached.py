"""Put a mechanism that a sentence asks for on an object that has none: on a plate, on a free side of the object."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.composer.bodies import BODY
from kinematify.generate.composer.place import Placement
from kinematify.generate.composer.side import FACING, columns
from kinematify.generate.procedural.pieces.fronts import Bay, Fitting
from kinematify.generate.procedural.solids import box
from kinematify.generate.procedural.workshop import Workshop

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.generate.composer.compose import MechanismSpec
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.robot.arrays import FloatArray

_SCALES = (1.0, 0.7, 0.5)
"""Of the mechanism, from usual to small."""
_CELL = 1.3  # sides of a place, in those that the mechanism needs at least
_MARGIN, _THICK = 1.15, 0.015  # of the plate about its places; thickness [m]
_LEVEL = 1e-3  # of a surface [m]
_GAP = 5e-4  # between the surface and the plate [m]
_GRID = 13  # places along either side of the object at which it is looked for
_SAMPLES, _STEPS = 5, 5  # points of a plate along either side; poses of a joint
_QUARTER = 0.5 * math.pi


def attached(blueprint: Blueprint, wanted: MechanismSpec, *, clearance: float = 0.001) -> Blueprint:
    """Return an object with mechanisms on a plate that is fixed to its base link.

    Args:
        blueprint: Closed.
        wanted: What, how many, and on which side; its usual one if none is said.
        clearance: Gap between parts that move past each other [m].

    Raises:
        InputError: No side has a level, free place of its size.
    """
    kind = wanted.mechanism
    if kind.arranged != "grid" or (wanted.side and wanted.side not in kind.sides):
        raise InputError(f"There is no place for a {wanted.title} there.")
    for scale in _SCALES:
        plate = _plate(wanted, clearance)
        plate = plate.scaled(scale) if scale < 1.0 else plate
        size = np.ptp(plate.parts[0].bounds, axis=0)[[0, 2]]
        for side in (wanted.side,) if wanted.side else kind.sides:
            for middle in _places(blueprint, side, size):
                turn = np.array(FACING[side], dtype=np.float64).T
                place = np.eye(4)
                place[:3, :3], place[:3, 3] = turn, turn @ (middle - np.array([0.0, _GAP, 0.0]))
                made = blueprint.carrying(replace(plate, family=f"{wanted.stem}_plate"), blueprint.root, place)
                plain = {part.name: f"{wanted.stem}_plate_{part.name}" for part in plate.parts[1:]}
                free = {part.name for part in blueprint.parts}
                return made.renamed({new: old for old, new in plain.items() if old not in free})
    raise InputError(f"There is no level, free place for a {wanted.title}.")


def _plate(wanted: MechanismSpec, clearance: float) -> Blueprint:
    """A plate with mechanisms side by side, its back in the plane y = 0."""
    side = _CELL * max(wanted.mechanism.least)
    width = side * wanted.count
    half_width, half_height = 0.5 * _MARGIN * width, 0.5 * _MARGIN * side
    workshop = Workshop(f"{wanted.stem}_plate", material="plastic", color="dark grey")
    workshop.body(BODY, box((-half_width, -_THICK, -half_height), (half_width, 0.0, half_height)))
    area = Bay(left=-0.5 * width, right=0.5 * width, bottom=-0.5 * side, top=0.5 * side, depth=_THICK, wall=_THICK)
    surface = np.column_stack([np.eye(3), (0.0, -_THICK, 0.0)])
    for k, bay in enumerate(columns(area, wanted.count)):
        wanted.mechanism.build(
            Placement(
                workshop=workshop.from_frame(surface, material=wanted.material, color=wanted.color),
                name=f"{wanted.stem}_{k + 1}" if wanted.count > 1 else wanted.stem,
                area=bay,
                hollow=False,
                fitting=Fitting(clearance=clearance, grip="bar", rest=0.0),
                side="front",
                index=k,
            )
        )
    rng = np.random.default_rng(0)
    return workshop.finish(f"{wanted.stem}_plate", {}, style="clean", clearance=clearance, rng=rng)


def _places(blueprint: Blueprint, side: str, size: FloatArray) -> Iterator[FloatArray]:
    """Find level places of the base link that nothing goes before, the most central first.

    Yields:
        Their middles in the frame of a side, shape (3,): to the right, into the object, and up [m].
    """
    turn = np.array(FACING[side], dtype=np.float64)
    base = blueprint.parts[0]
    corners = (base.vertices @ turn.T)[base.faces]
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    others = [bounds @ turn.T for bounds in _swept(blueprint)]
    at = [np.linspace(low[k] + 0.5 * size[j], high[k] - 0.5 * size[j], _GRID) for j, k in enumerate((0, 2))]
    if (high[[0, 2]] - low[[0, 2]] < size).any():
        return
    centre = 0.5 * (low + high)[[0, 2]]
    middles = sorted(((x, z) for x in at[0] for z in at[1]), key=lambda place: float(np.hypot(*(place - centre))))
    shares = np.linspace(-0.5, 0.5, _SAMPLES)
    for x, z in middles:
        if any(_before(box_, np.array([x, z]), size, high[1]) for box_ in others):
            continue
        depths = [_depth(corners, x + a * size[0], z + b * size[1]) for a in shares for b in shares]
        if np.isfinite(depths).all() and np.ptp(depths) < _LEVEL:
            yield np.array([x, min(depths), z])


def _swept(blueprint: Blueprint) -> list[FloatArray]:
    """Bounds of the moving parts in some poses, shape (2, 3) each."""
    found = []
    for share in np.linspace(0.0, 1.0, _STEPS):
        values = {
            joint.child: share * (min(joint.upper, _QUARTER) if joint.kind.turns else joint.upper)
            for joint in blueprint.joints
            if joint.mimic is None and joint.upper > 0.0 and (joint.kind.turns or math.isfinite(joint.upper))
        }
        found += [part.bounds for part in blueprint.moved(values).parts[1:]]
    return found


def _before(bounds: FloatArray, middle: FloatArray, size: FloatArray, deepest: float) -> bool:
    """Whether a box is before or at a place, within the room that the mechanism takes."""
    low, high = bounds.min(axis=0), bounds.max(axis=0)
    apart = (np.abs(0.5 * (low + high)[[0, 2]] - middle) > 0.5 * ((high - low)[[0, 2]] + size) + 0.002).any()
    return not apart and float(low[1]) < deepest


def _depth(corners: FloatArray, x: float, z: float) -> float:
    """How far behind a point of a side's plane its surface is; infinite where there is none."""
    place = np.array([x, z])
    a, b, c = (corners[:, k][:, [0, 2]] - place for k in range(3))
    areas = np.stack([p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] for p, q in ((b, c), (c, a), (a, b))], axis=1)
    total = areas.sum(axis=1)
    inside = (np.abs(total) > 1e-12) & ((areas * np.sign(total)[:, None]) >= 0.0).all(axis=1)
    hits = (areas[inside] * corners[inside][:, :, 1]).sum(axis=1) / total[inside]
    return float(hits.min(initial=np.inf))
