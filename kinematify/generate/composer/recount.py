"""Give an object another number of alike parts: on their ring, in their rows, or beside the one that there is."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold, Mesh, OpType

from kinematify.errors import InputError
from kinematify.generate.procedural.clearance import DEEP, carried_by, depth_of, solid_of
from kinematify.generate.procedural.language.places import share_within
from kinematify.generate.procedural.language.words import stem_of
from kinematify.generate.procedural.materials import grain_coordinates
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
    from kinematify.robot.arrays import FloatArray

MOST = 40
"""Parts of one kind."""
_APART = 1.1  # of a part's length, from one to the next at least
_SAME = 0.05  # of a part's length, by which rows may be uneven
_POSES, _ROOM = 10, 0.002  # in which a part is cut out of what carries it; room that it gets there [m]
_MOST_CUT, _MOST_SUNK = 0.1, 0.4  # of the volume of what carries it; of its own volume
_LOOSE = 0.01  # [m] farther from what carries it than the first one is
_ALIKE = 0.1  # of its box, by which more or less of it is in the box of what carries it
_ALONG = 0.99  # of a unit vector along an axis
_SMALL = 0.3  # of the length of what carries it, up to which one alone gets neighbours on any side


@dataclass(frozen=True, kw_only=True)
class _Place:
    """Where one part of the new number is."""

    like: str
    transform: FloatArray
    """From where that part is, shape (3, 4)."""

    @property
    def is_there(self) -> bool:
        """True if it is that part itself."""
        return bool(np.allclose(self.transform, np.eye(3, 4), atol=1e-4))


def recounted(blueprint: Blueprint, names: Sequence[str], count: int) -> Blueprint:
    """Return an object with another number of some parts, each with its own joint and with what it carries.

    Args:
        blueprint: Closed.
        names: All parts that are called so; what they carry may be among them.
        count: How many are asked for.

    Raises:
        InputError: They are not alike, stand in no row or ring that takes so many, or something is in the way.
    """
    within = {name for one in names for name in carried_by(one, blueprint.joints) - {one}}
    ones = [name for name in names if name not in within and name in blueprint.joint_above]
    joints = [blueprint.joint_above[name] for name in ones]
    moved = {name for one in ones for name in carried_by(one, blueprint.joints)}
    chained = {name for loop in blueprint.loops for name in (loop.one, loop.other)}
    leads = any(joint.mimic is not None for joint in blueprint.joints if joint.child in moved)
    alike = len({(joint.parent, joint.kind) for joint in joints}) == 1
    if not alike or leads or moved & chained or not 1 <= count <= MOST:
        raise InputError(f"There are not {count} of them: they are not alike.")
    for places in _patterns(blueprint, ones, count):
        made = _placed(blueprint, ones, places, joints[0].parent)
        if made is not None:
            return made
    raise InputError(f"There is no place for {count} of them.")


# ---- where they are ------------------------------------------------------------------------------------------------


def _patterns(blueprint: Blueprint, ones: Sequence[str], count: int) -> Iterator[list[_Place]]:
    """Ways to place so many, the likeliest first."""
    bounds = {part.name: part.bounds for part in blueprint.parts}
    middles = np.array([bounds[name].mean(axis=0) for name in ones])
    size = np.max([np.ptp(bounds[name], axis=0) for name in ones], axis=0)
    ring = _ring(blueprint, ones, middles, size, count) if len(ones) > 2 else None
    if ring is not None and (count > len(ones) or len(ones) % count == 0):
        yield ring
    joint = blueprint.joint_above[ones[0]]
    is_small = size.max() < _SMALL * float(np.ptp(bounds[joint.parent], axis=0).max())
    for along in sorted(range(3), key=lambda axis: (-float(np.ptp(middles, axis=0)[axis]), axis)):
        if len(ones) == 1 and not is_small and abs(joint.axis[along]) < _ALONG:
            continue  # wheels stand side by side on one axle, slides behind each other on one rail
        rows = _rows(middles, along, size)
        if count % len(rows):
            continue
        names = [sorted((float(middles[k, along]), ones[k]) for k in row) for row in rows]
        each = count // len(rows)
        if each < min(map(len, names)):  # some of them are left out, as evenly as may be
            kept = [row[k][1] for row in names for k in _spread(len(row), each)]
            yield [_Place(like=name, transform=np.eye(3, 4)) for name in kept]
        else:
            yield [place for row in names for place in _row(row, along, each, float(size[along]))]


def _ring(
    blueprint: Blueprint, ones: Sequence[str], middles: FloatArray, size: FloatArray, count: int
) -> list[_Place] | None:
    """So many evenly about the axis about which they stand evenly; None if they do not."""
    centre, bounds = middles.mean(axis=0), {part.name: part.bounds for part in blueprint.parts}
    vertices = next(part.vertices for part in blueprint.parts if part.name == ones[0])
    for axis in np.eye(3):
        turned = (vertices - centre) @ rotation_about(axis, 2.0 * math.pi / len(ones)).T + centre
        box = np.array([turned.min(axis=0), turned.max(axis=0)])
        if any(np.allclose(box, bounds[name], atol=_SAME * size.min()) for name in ones[1:]):
            turns = [rotation_about(axis, 2.0 * math.pi * k / count) for k in range(count)]
            return [_Place(like=ones[0], transform=np.column_stack([turn, centre - turn @ centre])) for turn in turns]
    return None


def _rows(middles: FloatArray, along: int, size: FloatArray) -> list[list[int]]:
    """Which of them stand in one row along an axis."""
    rows: list[list[int]] = []
    across = [axis for axis in range(3) if axis != along]
    for k, middle in enumerate(middles):
        row = next((row for row in rows if (np.abs(middles[row[0]] - middle)[across] < _SAME * size.max()).all()), None)
        if row is None:
            rows.append([k])
        else:
            row.append(k)
    return rows


def _spread(number: int, count: int) -> list[int]:
    """Which of a number in a row are left, the one in the middle or both ends among them."""
    return [number // 2] if count == 1 else [round(k * (number - 1) / (count - 1)) for k in range(count)]


def _row(row: Sequence[tuple[float, str]], along: int, count: int, length: float) -> Iterator[_Place]:
    """So many in a row, as far apart as its ends allow, or farther where they would not fit."""
    there = np.array([value for value, _ in row])
    half = max(0.5 * float(np.ptp(there)), 0.5 * _APART * length * (count - 1))
    middle = 0.5 * float(there.min() + there.max())
    for value in np.linspace(middle - half, middle + half, count) if count > 1 else [middle]:
        at, like = row[int(np.argmin(np.abs(there - value)))]
        step = np.zeros(3)
        step[along] = value - at
        yield _Place(like=like, transform=np.column_stack([np.eye(3), step]))


# ---- whether they fit there ----------------------------------------------------------------------------------------


def _placed(blueprint: Blueprint, ones: Sequence[str], places: Sequence[_Place], parent: str) -> Blueprint | None:
    """The object with parts at these places alone; None if they do not fit there."""
    gone = {name for one in ones for name in carried_by(one, blueprint.joints)}
    of = {part.name: part for part in blueprint.parts}
    parts = [part for part in blueprint.parts if part.name not in gone]
    joints = [joint for joint in blueprint.joints if joint.child not in gone]
    new: list[dict[str, str]] = []
    for k, place in enumerate(places, start=1):
        own, root = carried_by(place.like, blueprint.joints), f"{stem_of(place.like)}_{k}"
        names = {name: _renamed(name, place.like, root) for name in of if name in own}
        parts += [replace(of[name], name=names[name], vertices=_at(of[name].vertices, place)) for name in names]
        joints += [_elsewhere(joint, names, place) for joint in blueprint.joints if joint.child in own]
        new.append(names)
    made = replace(blueprint, parts=tuple(parts), joints=tuple(joints))
    if len({part.name for part in parts}) < len(parts):
        return None
    around = of[parent].bounds
    for place in places:
        there = _at(of[place.like].vertices, place)
        box = np.array([there.min(axis=0), there.max(axis=0)])
        if abs(share_within(box, around) - share_within(of[place.like].bounds, around)) > _ALIKE:
            return None
    added = [names[place.like] for place, names in zip(places, new, strict=True) if not place.is_there]
    body = solid_of(of[parent])
    gap = min(solid_of(of[name]).min_gap(body, 1.0) for name in ones)
    carrier = _carrier_with_room(made, of[parent], added, gap)
    if carrier is None:
        return None
    solids = {part.name: solid_of(part) for part in parts} | {parent: solid_of(carrier)}
    for place, names in zip(places, new, strict=True):
        others = [name for name in solids if name not in names.values()]
        hits = not place.is_there and any(depth_of(solids[a], solids[b]) > DEEP for a in names.values() for b in others)
        if hits:
            return None
    return replace(made, parts=tuple(carrier if part.name == parent else part for part in parts))


def _carrier_with_room(made: Blueprint, part: Part, added: Sequence[str], gap: float) -> Part | None:
    """Return the carrier of parts with room for added ones; None if that is too much, or if they are farther off.

    Args:
        made: With the parts that are added.
        part: What carries them.
        added: Their names.
        gap: How far off such parts are from what carries them [m].
    """
    looks = part.appearance
    assert looks is not None, "what is generated has an appearance"
    kinds = looks.material_of_face.astype(np.uint32)
    mesh = Mesh(np.asarray(part.vertices, dtype=np.float32), np.asarray(part.faces, dtype=np.uint32), face_id=kinds)
    mesh.merge()
    before = Manifold(mesh)
    left = before
    for name in added:
        solid = solid_of(next(item for item in made.parts if item.name == name))
        if (solid ^ before).volume() > _MOST_SUNK * solid.volume() or solid.min_gap(before, 1.0) > gap + _LOOSE:
            return None
        if depth_of(solid, before) > DEEP:
            left -= _swept(made, name, solid)
    if left is before:
        return part
    if left.volume() < (1.0 - _MOST_CUT) * before.volume() or len(left.decompose()) > len(before.decompose()):
        return None
    made_of = left.to_mesh()
    vertices = np.asarray(made_of.vert_properties[:, :3], dtype=np.float64)
    faces = np.asarray(made_of.tri_verts, dtype=np.int64)
    own = np.repeat(np.asarray(made_of.run_original_id) == before.original_id(), np.diff(made_of.run_index) // 3)
    appearance = replace(
        looks,
        material_of_face=np.where(own, np.asarray(made_of.face_id, dtype=np.int64), 0),
        uv=None if looks.uv is None else grain_coordinates(vertices, faces),
    )
    return replace(part, vertices=vertices, faces=faces, appearance=appearance)


def _swept(made: Blueprint, name: str, solid: Manifold) -> Manifold:
    """Return what a part is in while its joint moves, with some room about it."""
    joint, box = made.joint_above[name], np.array(solid.bounding_box()).reshape(2, 3)
    factors = (np.ptp(box, axis=0) + 2.0 * _ROOM) / np.ptp(box, axis=0)
    middle = box.mean(axis=0)
    larger = solid.translate(-middle).scale(factors).translate(middle)
    ends = (joint.lower, joint.upper) if math.isfinite(joint.upper - joint.lower) else (0.0, 2.0 * math.pi)
    poses = [larger.transform(joint.motion(value)[:3]) for value in np.linspace(*ends, _POSES)]
    return Manifold.batch_boolean(poses, OpType.Add)


def _renamed(name: str, one: str, root: str) -> str:
    return root + name.removeprefix(one) if name.startswith(one) else f"{root}_{name}"


def _at(points: FloatArray, place: _Place) -> FloatArray:
    return points @ place.transform[:, :3].T + place.transform[:, 3]


def _elsewhere(joint: BlueprintJoint, names: Mapping[str, str], place: _Place) -> BlueprintJoint:
    return replace(
        joint,
        parent=names.get(joint.parent, joint.parent),
        child=names[joint.child],
        axis=place.transform[:, :3] @ joint.axis,
        pivot=_at(joint.pivot, place),
    )
