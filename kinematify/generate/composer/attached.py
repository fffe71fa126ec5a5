"""Put a mechanism that a sentence asks for on an object that has none: on a plate, on a free side of the object."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import islice, product
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.composer.bodies import BODIES, BODY
from kinematify.generate.composer.compose import Composition, compose
from kinematify.generate.composer.place import Placement
from kinematify.generate.composer.side import FACING, columns
from kinematify.generate.procedural.clearance import carried_by, depth_of, solid_of
from kinematify.generate.procedural.language.words import lemma, stem_of
from kinematify.generate.procedural.pieces.fronts import Bay, Fitting
from kinematify.generate.procedural.solids import box
from kinematify.generate.procedural.workshop import Workshop
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Iterator

    from manifold3d import Manifold

    from kinematify.assembly.part import Part
    from kinematify.generate.composer.compose import MechanismSpec
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.robot.arrays import FloatArray

_SCALES = (1.0, 0.7, 0.5, 0.35)
"""Of the mechanism, from usual to small."""
_CELL = 1.3  # sides of a place, in those that the mechanism needs at least
_MARGIN, _THICK, _THIN = 1.15, 0.015, 0.003  # of the plate about its places; thickness, where nothing moves [m]
_LEVEL = 1e-3  # of a surface [m]
_GAP = 5e-4  # between the surface and the plate [m]
_MOST_PLACES = 12  # that are tried
_GRID = 13  # places along either side of the object at which it is looked for
_SAMPLES, _STEPS = 5, 5  # points of a plate along either side; poses of a joint
_QUARTER = 0.5 * math.pi
_ENDS = {"top": 1, "bottom": -1}
_UNDER = ("axles", "corners")
"""How mechanisms are arranged that the whole stands on."""
_BOARD, _UNDERNEATH = "dolly", "chassis"
_LEAST, _FLAT = 0.15, 0.1  # [m] its least side; its height, of its shorter side
_PAD, _HELD_BY = 0.5, 0.3  # of a plate's height, so deep is a pad at most; share of the plate that is before a surface
_MOST_OF_IT = 1.2  # sides of a plate, that an uneven side has at least
_HAND_SIZED = 0.08  # [m] of a place, up to which a mechanism gets a pad
_MEETS = 0.97  # of a pad, that is left where it meets a surface


def attached(blueprint: Blueprint, wanted: MechanismSpec, *, clearance: float = 0.001) -> Blueprint:
    """Return an object with mechanisms on a plate that is fixed to its base link, or to the part that carries them.

    Args:
        blueprint: Closed.
        wanted: What, how many, on which part, and on which side; its usual one if none is said.
        clearance: Gap between parts that move past each other [m].

    Raises:
        InputError: There is no such part, or no side of it has a level, free place of its size.
    """
    if wanted.mechanism.arranged in _UNDER:
        return _on_wheels(blueprint, wanted, clearance)
    for k, carrier in enumerate(_carriers(blueprint, wanted)):
        blueprint = _on_part(blueprint, carrier, wanted, clearance, f"_{k + 1}" if k else "")
    return blueprint


def _on_wheels(blueprint: Blueprint, wanted: MechanismSpec, clearance: float) -> Blueprint:
    """An object on a board with wheels, casters or legs, as large as its own footprint.

    Raises:
        InputError: So many do not fit under it.
    """
    bounds = blueprint.assembly.bounds
    spinning = {joint.child for joint in blueprint.joints if joint.kind is JointType.CONTINUOUS}
    low = float(bounds[0, 2]) + _FLAT * float(np.ptp(bounds, axis=0)[2])
    if any(part.name in spinning and part.bounds[0, 2] < low for part in blueprint.parts):
        raise InputError(f"There is something that turns below it already; there is no place for a {wanted.title}.")
    width, depth, _ = np.ptp(bounds, axis=0)
    board = next(body for body in BODIES if _BOARD in body.words)
    size = (max(float(width), _LEAST), max(float(depth), _LEAST), _FLAT * max(float(min(width, depth)), _LEAST))
    under = compose(
        Composition(body=board, wanted=(replace(wanted, side="", carrier=""),), size=size), clearance=clearance
    )
    top = float(under.parts[0].bounds[1, 2]) + _GAP
    place = np.eye(4)
    place[:3, 3] = [*(bounds - under.parts[0].bounds).mean(axis=0)[:2], 0.0]
    lifted = blueprint.lifted(top - float(bounds[0, 2]))
    made = lifted.carrying(replace(under, family=_UNDERNEATH), blueprint.root, place)
    taken = {part.name for part in blueprint.parts}
    plain = {f"{_UNDERNEATH}_{part.name}": part.name for part in under.parts[1:]}
    return made.renamed({new: old for new, old in plain.items() if old not in taken})


def _carriers(blueprint: Blueprint, wanted: MechanismSpec) -> list[Part]:
    """The parts that mechanisms stand on: the base link, each of a name, or the one at the place that is said.

    Raises:
        InputError: None is called so, or the place says none of them.
    """
    words = wanted.carrier.split()
    if not words:
        return [blueprint.parts[0]]
    noun = lemma(words[-1])
    found = [part for part in blueprint.parts if f"_{stem_of(part.name)}".endswith(f"_{noun}")]
    side = next((word for word in words if word in FACING), "")
    if side and found:
        outward = -np.array(FACING[side], dtype=np.float64)[1]
        found = [max(found, key=lambda part: float(part.bounds.mean(axis=0) @ outward))]
    if not found:  # a solid of it, or nothing of it
        return [blueprint.parts[0]]
    if len(found) > 1 and not {"each", "every", "both", "all"} & set(words):
        raise InputError(f"There is no one {noun} for a {wanted.title}.")
    return found


def _on_part(blueprint: Blueprint, carrier: Part, wanted: MechanismSpec, clearance: float, number: str) -> Blueprint:
    kind = wanted.mechanism
    is_end = wanted.side in _ENDS and wanted.side not in kind.sides  # at the bottom of one of its sides
    sides, end = ((), _ENDS[wanted.side]) if is_end else ((wanted.side,) if wanted.side else (), 0)
    if kind.arranged != "grid" or not set(sides) <= set(kind.sides):
        raise InputError(f"There is no place for a {wanted.title} there.")
    turns = any(joint.kind is JointType.CONTINUOUS for joint in blueprint.joints)
    on_pads = max(kind.least) <= _HAND_SIZED and not (turns and kind.words[0] == "crank")  # which turns what is there
    tried = [*((scale, True) for scale in _SCALES[:-1]), *((scale, False) for scale in _SCALES if on_pads)]
    for scale, is_level in tried:
        size = scale * np.ptp(_plate(wanted, clearance).parts[0].bounds, axis=0)[[0, 2]]
        for side in sides or kind.sides:
            places = _places(blueprint, carrier, side, size, is_level=is_level, end=end)
            for middle, deep in islice(places, _MOST_PLACES):
                turn = np.array(FACING[side], dtype=np.float64).T
                place = np.eye(4)
                place[:3, :3], place[:3, 3] = turn, turn @ (middle - np.array([0.0, _GAP, 0.0]))
                pad = _pad(carrier, place, size, deep) if deep else None
                if deep and pad is None:
                    continue
                plate = _plate(wanted, clearance, pad and pad.scale((1.0 / scale,) * 3)).scaled(scale)
                name = f"{wanted.stem}{number}{'_plate' if kind.moves else ''}"
                made = blueprint.carrying(replace(plate, family=name), carrier.name, place)
                if _stays_clear(made, carrier.name, name):
                    taken = {part.name for part in blueprint.parts}
                    plain = {f"{name}_{part.name}": f"{part.name}{number}" for part in plate.parts[1:]}
                    return made.renamed({long: short for long, short in plain.items() if short not in taken})
    raise InputError(f"There is no free place for a {wanted.title}.")


def _pad(carrier: Part, place: FloatArray, size: FloatArray, deep: float) -> Manifold | None:
    """Return the solid between the back of a plate and an uneven surface, in the plate's frame; None if there is none.

    Args:
        carrier: Part with the surface.
        place: Frame of the plate, shape (4, 4).
        size: Of the plate, along and across [m], shape (2,).
        deep: How far behind the plate the surface is [m].
    """
    half = 0.5 * size
    whole = box((-half[0], -_GAP, -half[1]), (half[0], deep, half[1]))
    left = whole - solid_of(carrier).transform(np.linalg.inv(place)[:3])
    before = [piece for piece in left.decompose() if piece.bounding_box()[1] < 0.0]
    return before[0] if len(before) == 1 and left.volume() < _MEETS * whole.volume() else None


def _stays_clear(made: Blueprint, carrier: str, plate: str) -> bool:
    """True if a plate is not in what carries it or in a handle there, and meets nothing while its carrier moves."""
    own, joint = carried_by(plate, made.joints), made.joint_above.get(carrier)
    moves = joint is not None and math.isfinite(joint.upper - joint.lower)
    for value in np.linspace(joint.lower, joint.upper, _STEPS) if joint is not None and moves else [0.0]:
        solids = {part.name: solid_of(part) for part in made.moved({carrier: float(value)}).parts}
        if any(depth_of(solids[plate], solids[name]) > _GAP for name in solids.keys() - own):
            return False
    return True


def _plate(wanted: MechanismSpec, clearance: float, pad: Manifold | None = None) -> Blueprint:
    """A plate with mechanisms side by side, its back in the plane y = 0, or on a pad behind that."""
    side = _CELL * max(wanted.mechanism.least)
    width = side * wanted.count
    thick = _THICK if wanted.mechanism.moves else _THIN
    half_width, half_height = 0.5 * _MARGIN * width, 0.5 * _MARGIN * side
    workshop = Workshop(f"{wanted.stem}_plate", material="plastic", color="dark grey")
    back = box((-half_width, -thick, -half_height), (half_width, 0.0, half_height))
    workshop.body(BODY, back, *([pad] if pad else []))
    area = Bay(left=-0.5 * width, right=0.5 * width, bottom=-0.5 * side, top=0.5 * side, depth=thick, wall=thick)
    surface = np.column_stack([np.eye(3), (0.0, -thick, 0.0)])
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


def _places(
    blueprint: Blueprint, carrier: Part, side: str, size: FloatArray, *, is_level: bool, end: int
) -> Iterator[tuple[FloatArray, float]]:
    """Find places of a part that nothing goes before: level ones, or others.

    The most central ones come first, or those next to the top (end 1) or the bottom (-1) of the side.

    Yields:
        Their middles in the frame of a side, shape (3,): to the right, into the object, and up [m]; and how deep a pad
        has to be to meet the surface, 0 for level ones [m].
    """
    turn = np.array(FACING[side], dtype=np.float64)
    corners = (carrier.vertices @ turn.T)[carrier.faces]
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    is_base = carrier is blueprint.parts[0]
    others = [bounds @ turn.T for bounds in _swept(blueprint, carrier)]
    deepest = float(high[1] if is_base else low[1])
    at = [np.linspace(low[k] + 0.5 * size[j], high[k] - 0.5 * size[j], _GRID) for j, k in enumerate((0, 2))]
    if (high[[0, 2]] - low[[0, 2]] < (1.0 if is_level else _MOST_OF_IT) * size).any():
        return
    centre = 0.5 * (low + high)[[0, 2]]
    centre[1] += 0.5 * end * (high - low)[2]
    middles = sorted(((x, z) for x in at[0] for z in at[1]), key=lambda place: float(np.hypot(*(place - centre))))
    shares = sorted(np.linspace(-0.5, 0.5, _SAMPLES), key=abs, reverse=True)  # corners tell soonest
    for x, z in middles:
        if any(_before(box_, np.array([x, z]), size, deepest) for box_ in others):
            continue
        depths: list[float] = []
        for a, b in product(shares, shares):
            depths.append(_depth(corners, x + a * size[0], z + b * size[1]))
            if is_level and not max(depths) - min(depths) < _LEVEL:  # nor is it where nothing is
                break
        else:
            there = [depth for depth in depths if depth - min(depths) < _PAD * size[1]]
            if is_level:
                yield np.array([x, min(depths), z]), 0.0
            elif len(there) > _HELD_BY * len(depths):
                yield np.array([x, min(depths), z]), max(there) - min(there) + 0.2 * size[1]


def _swept(blueprint: Blueprint, carrier: Part) -> list[FloatArray]:
    """Bounds of the parts that a part does not carry, shape (2, 3) each: of those that move, in some poses."""
    own = carried_by(carrier.name, blueprint.joints)
    if carrier is not blueprint.parts[0]:
        return [part.bounds for part in blueprint.parts if part.name not in own]
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
    """True if a box is before or at a place, within the room that the mechanism takes."""
    low, high = bounds.min(axis=0), bounds.max(axis=0)
    apart = (np.abs(0.5 * (low + high)[[0, 2]] - middle) > 0.5 * ((high - low)[[0, 2]] + size) + 0.002).any()
    return not apart and float(low[1]) < deepest


def _depth(corners: FloatArray, x: float, z: float) -> float:
    """Return how far behind a point of a side's plane its surface is; infinite where there is none."""
    place = np.array([x, z])
    a, b, c = (corners[:, k][:, [0, 2]] - place for k in range(3))
    areas = np.stack([p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] for p, q in ((b, c), (c, a), (a, b))], axis=1)
    total = areas.sum(axis=1)
    inside = (np.abs(total) > 1e-12) & ((areas * np.sign(total)[:, None]) >= 0.0).all(axis=1)
    hits = (areas[inside] * corners[inside][:, :, 1]).sum(axis=1) / total[inside]
    return float(hits.min(initial=np.inf))
