"""KV240 to KV242: collision geometry, and whether it is where the visual geometry is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.check import check
from kinematify.validation.checks.shared import something_collides, something_moves
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.config.validation import PhysicsSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Link
    from kinematify.validation.asset.rigid_bodies import Body, Physics, Room
    from kinematify.validation.check import OpenCheck


@check(
    "KV240",
    title="Links have collision geometry",
    fails="A link has no collision geometry",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
)
def missing_collisions(result: OpenCheck, physics: Physics) -> None:
    """Every body with geometry has collision geometry, and so has each of its links that projects from the rest by
    `bare_share` of its size (others are a note, unless they are fewer than `bare_minority` of all links; so are those
    below `marker` of the model's size, and primitives without a mass on another link, which mark a place). Where no
    link of the file has any, that is one finding.

    Why it matters: Grippers and other parts pass through the link in every engine.

    Remedy: Copy the <visual> to a <collision>, or write a simpler shape.
    """
    solid = [body for body in physics.bodies if body.rooms]
    if solid and not physics.collision:
        result.find(
            f"None of the {len(solid)} bodies has collision geometry: nothing touches anything in an engine.",
            "Copy each <visual> to a <collision>, or write simpler shapes; concave ones are best cut into "
            "convex pieces.",
            link=solid[0].called,
            value=0,
            limit=len(solid),
        )
        return
    for body in solid:
        _uncovered(result, physics, body)


def _uncovered(result: OpenCheck, physics: Physics, body: Body) -> None:
    """Report bare links; what is within the hull of its body is decoration, unless nearly all have some."""
    solid = {name for other in physics.bodies for name in other.rooms}
    exception = len(solid - set(physics.collision)) <= max(1.0, physics.settings.bare_minority * len(solid))
    felt = body.placed({name: physics.collision[name] for name in body.rooms if name in physics.collision})
    for name, room in body.rooms.items():
        if name in physics.collision or (felt is None and name != body.called):
            continue
        counts = felt is None or exception or _stands_out(body, name, felt) > physics.settings.bare_share
        link = physics.model.link_by_name[name]
        drawn = link.inertial is None and name != body.called and all(shape.file is None for shape in link.visuals)
        counts &= room.diagonal > physics.settings.marker * physics.diagonal and not drawn
        result.find(
            f"The link {name} has no collision geometry, though it measures {room.diagonal:.3g} m and other "
            "links of the model have some: " + ("what meets it passes through." if counts else "it is small."),
            "Copy its <visual> to a <collision>, or write a simpler shape.",
            severity=None if counts else Severity.NOTE,
            link=name,
            line=link.line,
        )


def _stands_out(body: Body, name: str, felt: Room) -> float:
    """Return how far a link projects from the hull of what its body collides with, fraction of the link's diagonal."""
    placed = body.placed({name: body.rooms[name]})
    if placed is None or placed.diagonal == 0.0:
        return 0.0
    return max(felt.outside(point) for point in placed.points) / placed.diagonal


@check(
    "KV241",
    title="Collision geometry is where the visual geometry is",
    fails="Collision geometry is beside the visual geometry",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    needs=(something_collides,),
)
def displaced_collisions(result: OpenCheck, physics: Physics) -> None:
    """The bounding box of the collision geometry is not shifted against that of the visual one by more than `shift` of
    its diagonal (`shift_same` if both have the same size; from `shift_wrong` on that is an error, but for small links
    that are fixed to a larger one), and does not reach `beyond` it. Coarse shapes and shapes of a part of the link are
    fine.

    Why it matters: The model collides with what nobody sees, and is not stopped by what everybody sees.

    Remedy: Correct the <origin> of the <collision>.
    """
    for body in physics.bodies:
        for link in body.links:
            seen, felt = physics.visual.get(link.name), physics.collision.get(link.name)
            if seen is not None and felt is not None and seen.diagonal > 0.0:
                certain = link.name == body.called
                _displaced(result, link, seen, felt, physics.settings, certain=certain)


def _displaced(
    result: OpenCheck, link: Link, seen: Room, felt: Room, settings: PhysicsSettings, *, certain: bool
) -> None:
    shift = common_shift(seen, felt)
    moved = float(np.linalg.norm(shift)) / seen.diagonal
    same = np.abs((felt.high - felt.low) - (seen.high - seen.low)).max() < settings.same_size * seen.diagonal
    beyond = float(np.maximum(seen.low - felt.low, felt.high - seen.high).max()) / seen.diagonal
    if moved <= (settings.shift_same if same else settings.shift) and beyond <= settings.beyond:
        return
    if moved > settings.shift or same:
        words = f"is {moved * seen.diagonal:.3g} m beside the visual geometry ({_vector(shift)})"
        value, limit = moved, settings.shift_same if same else settings.shift
    else:
        words = f"reaches {beyond * seen.diagonal:.3g} m beyond the visual geometry"
        value, limit = beyond, settings.beyond
    result.find(
        f"The collision geometry of the link {link.name} {words}, which measures {seen.diagonal:.3g} m.",
        f"Correct the <origin> of the <collision>; moving it by {_vector(-shift)} would do."
        if moved > settings.shift or same
        else "Check the scale and the <origin> of the <collision>.",
        severity=Severity.ERROR if certain and same and moved > settings.shift_wrong else Severity.WARNING,
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


@check(
    "KV242",
    title="Collision meshes are nearly convex",
    fails="A collision mesh is far from its hull",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    needs=(something_collides,),
)
def inflated_hulls(result: OpenCheck, physics: Physics) -> None:
    """The hull of a closed collision mesh has at most `inflation` times its volume, unless it is declared concave. It
    is a warning where no joint moves: cups and shelves are there for what goes into them.

    Why it matters: MuJoCo and PyBullet collide the hull: a drawer cannot enter a cabinet that is one mesh.
    Kinematify cuts such meshes into convex pieces for its own runs.

    Remedy: Cut the mesh into convex pieces and write each as a <collision>.
    """
    # one finding per link, about the worst of its meshes
    for link in physics.model.links:
        ratio, index = max(
            ((physics.inflation(shape), k) for k, shape in enumerate(link.collisions) if not shape.concave),
            default=(0.0, 0),
        )
        if ratio > physics.settings.inflation:
            shape = link.collisions[index]
            name = shape.file.name if shape.file is not None else shape.kind
            result.find(
                f"The hull of the collision mesh {name} of the link {link.name} has {ratio:.3g} times the "
                "volume of the mesh, and MuJoCo and PyBullet see the hull: what reaches into its hollows collides.",
                "Cut it into convex pieces and write each as a <collision> (kinematify export --to urdf, or CoACD).",
                severity=Severity.NOTE if something_moves(physics) is None else None,
                link=link.name,
                value=ratio,
                limit=physics.settings.inflation,
                line=shape.line,
            )
