"""KV240 to KV243: collision geometry, and whether it stands where the visual geometry stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.asset.bodies import closed_volume, room_of
from kinematify.validation.finding import Severity
from kinematify.validation.precheck.problem import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.declared import DeclaredLink
    from kinematify.validation.asset.bodies import Body, Physics, Room


def missing_collisions(physics: Physics) -> Iterator[Problem]:
    """KV240: one problem for the whole model where no link has any."""
    solid = [body for body in physics.bodies if body.rooms]
    if solid and not physics.collision:
        yield Problem(
            message=f"None of the {len(solid)} bodies has collision geometry: nothing touches anything in an engine.",
            remedy="Copy each <visual> to a <collision>, or write simpler shapes; concave ones are best cut into "
            "convex pieces.",
            link=solid[0].called,
            value=0,
            limit=len(solid),
        )
        return
    for body in solid:
        yield from _uncovered(physics, body)


def _uncovered(physics: Physics, body: Body) -> Iterator[Problem]:
    """What lies within the hull of its body is decoration, unless nearly all links of the file have collisions."""
    solid = {name for other in physics.bodies for name in other.rooms}
    exception = len(solid - set(physics.collision)) <= max(1.0, physics.settings.bare_minority * len(solid))
    felt = body.placed({name: physics.collision[name] for name in body.rooms if name in physics.collision})
    for name, room in body.rooms.items():
        if name in physics.collision or (felt is None and name != body.called):
            continue
        counts = felt is None or exception or _stands_out(body, name, felt) > physics.settings.bare_share
        yield Problem(
            message=f"The link {name} has no collision geometry, though it measures {room.diagonal:.3g} m and other "
            "links of the model have some: " + ("what meets it passes through." if counts else "it is small."),
            remedy="Copy its <visual> to a <collision>, or write a simpler shape.",
            severity=None if counts else Severity.NOTE,
            link=name,
            line=physics.model.link_by_name[name].line,
        )


def _stands_out(body: Body, name: str, felt: Room) -> float:
    """How far a link stands out of the hull of what its body collides with, fraction of the link's diagonal."""
    placed = body.placed({name: body.rooms[name]})
    if placed is None or placed.diagonal == 0.0:
        return 0.0
    return max(felt.outside(point) for point in placed.points) / placed.diagonal


def displaced_collisions(physics: Physics) -> Iterator[Problem]:
    """KV241."""
    for body in physics.bodies:
        for link in body.links:
            seen, felt = physics.visual.get(link.name), physics.collision.get(link.name)
            if seen is not None and felt is not None and seen.diagonal > 0.0:
                problem = _displaced(physics, body, link, seen, felt)
                if problem is not None:
                    yield problem


def _displaced(physics: Physics, body: Body, link: DeclaredLink, seen: Room, felt: Room) -> Problem | None:
    settings = physics.settings
    shift = common_shift(seen, felt)
    moved = float(np.linalg.norm(shift)) / seen.diagonal
    same = np.abs((felt.high - felt.low) - (seen.high - seen.low)).max() < settings.same_size * seen.diagonal
    beyond = float(np.maximum(seen.low - felt.low, felt.high - seen.high).max()) / seen.diagonal
    if moved <= (settings.shift_same if same else settings.shift) and beyond <= settings.beyond:
        return None
    if moved > settings.shift or same:
        words = f"stands {moved * seen.diagonal:.3g} m beside the visual geometry ({_vector(shift)})"
        value, limit = moved, settings.shift_same if same else settings.shift
    else:
        words = f"reaches {beyond * seen.diagonal:.3g} m beyond the visual geometry"
        value, limit = beyond, settings.beyond
    return Problem(
        message=f"The collision geometry of the link {link.name} {words}, which measures {seen.diagonal:.3g} m.",
        remedy=f"Correct the <origin> of the <collision>; moving it by {_vector(-shift)} would do."
        if moved > settings.shift or same
        else "Check the scale and the <origin> of the <collision>.",
        severity=Severity.ERROR if same and moved > settings.shift_wrong else Severity.WARNING,
        link=link.name,
        value=value * seen.diagonal,
        limit=limit * seen.diagonal,
        unit="m",
        line=link.collisions[0].line,
    )


def common_shift(seen: Room, felt: Room) -> FloatArray:
    """By how much both ends of a bounding box moved the same way [m], shape (3,).

    A coarse shape is larger or smaller at both ends, and one that covers a part of a link ends at the same place at
    one side at least; only a displaced one moves both ends the same way.
    """
    low, high = felt.low - seen.low, felt.high - seen.high
    return np.where(low * high > 0.0, np.sign(low) * np.minimum(np.abs(low), np.abs(high)), 0.0)


def _vector(values: FloatArray) -> str:
    return " ".join(f"{value + 0.0:.3g}" for value in values)


def inflated_hulls(physics: Physics) -> Iterator[Problem]:
    """KV242: one problem per link, the worst of its meshes."""
    for link in physics.model.links:
        worst = max((_inflation(index, link) for index in range(len(link.collisions))), default=(0.0, 0))
        ratio, index = worst
        if ratio > physics.settings.inflation:
            shape = link.collisions[index]
            name = shape.file.name if shape.file is not None else shape.kind
            yield Problem(
                message=f"The hull of the collision mesh {name} of the link {link.name} has {ratio:.3g} times the "
                "volume of the mesh, and MuJoCo and PyBullet see the hull: what reaches into its hollows collides.",
                remedy="Cut it into convex pieces and write each as a <collision> (kinematify export --to urdf, or "
                "CoACD).",
                link=link.name,
                value=ratio,
                limit=physics.settings.inflation,
                line=shape.line,
            )


def _inflation(index: int, link: DeclaredLink) -> tuple[float, int]:
    shape = link.collisions[index]
    volume = closed_volume(shape.mesh) if shape.kind == "mesh" else None
    room = room_of([shape]) if volume is not None else None
    return (0.0 if room is None or volume is None else float(room.hull.volume) / volume), index


def heavy_collisions(physics: Physics) -> Iterator[Problem]:
    """KV243."""
    settings = physics.settings
    for link in physics.model.links:
        shapes = len(link.collisions)
        faces = sum(len(shape.mesh.faces) for shape in link.collisions if shape.kind == "mesh")
        many = shapes > settings.collision_shapes
        if many or faces > settings.collision_faces:
            yield Problem(
                message=f"The link {link.name} has {shapes} collision shapes with {faces} triangles; engines become "
                "slow with so many.",
                remedy="Use fewer and simpler shapes: boxes and cylinders, or convex pieces of some 50 corners.",
                link=link.name,
                value=shapes if many else faces,
                limit=settings.collision_shapes if many else settings.collision_faces,
                line=link.line,
            )


PROBES = {
    "KV240": missing_collisions,
    "KV241": displaced_collisions,
    "KV242": inflated_hulls,
    "KV243": heavy_collisions,
}
