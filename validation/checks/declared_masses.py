"""KV201 to KV203 and KV206: is there a mass, and can it be the true one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.check import CauseScope, check
from kinematify.validation.checks.shared import something_moves, something_weighs
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.robot.robot import Inertial, Link
    from kinematify.validation.asset.rigid_bodies import Body, Physics, Room
    from kinematify.validation.check import OpenCheck


@check(
    "KV201",
    title="Bodies that move have a mass",
    fails="A body that moves has no mass",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    needs=(something_moves,),
)
def missing_masses(result: OpenCheck, physics: Physics) -> None:
    """Of the links that fixed joints hold together, at least one has an <inertial>. Where no body of the file has one,
    that is one finding. So are links without one beside others that have it: it is a warning if PyBullet, which takes
    1 kg for each, even if it merges them, makes a body that moves twice as heavy; else a note.

    Why it matters: Without it PyBullet takes 1 kg, MuJoCo what its collision geometry weighs, Pinocchio nothing: no two
    engines move the model alike.

    Remedy: Add an <inertial> to the link; 100 to 1000 kg/m3 times its volume is a start.
    """
    moving = [body for body in physics.bodies if body.moves]
    _merged(result, [body for body in moving if body.mass > 0.0])
    without = [body for body in moving if all(link.inertial is None for link in body.links)]
    if not without:
        return
    if len(without) == len(moving) and len(moving) > 1:
        result.find(
            f"None of the {len(moving)} bodies that move has an <inertial>: PyBullet gives each link 1 kg, "
            "MuJoCo what its collision geometry weighs, Pinocchio none.",
            "Add an <inertial> to every link; 100 to 1000 kg/m3 times the volume is a start.",
            link=without[0].called,
            value=len(without),
            limit=0,
        )
        return
    for body in without:
        frame = not body.rooms
        result.find(
            f"The link {body.called}, which the joint {body.joint} moves, has no <inertial>"
            + (" and no geometry." if frame else ": PyBullet gives it 1 kg, Pinocchio nothing."),
            f"Add an <inertial>{_suggested(body.room)}; a frame may have 0.001 kg and 1e-7 kg m2.",
            joint=body.joint,
            link=body.called,
            line=physics.model.link_by_name[body.called].line,
        )


def _merged(result: OpenCheck, weighed: list[Body]) -> None:
    """Report links without a mass that are fixed to others with one, the body that changes most by them first."""
    extra = {body: [link for link in body.links if link.inertial is None] for body in weighed}
    worst = max(weighed, key=lambda body: len(extra[body]) / body.mass, default=None)
    if worst is None or not extra[worst]:
        return
    names = (f"{link.name}{'' if link.name in worst.rooms else ' (a frame)'}" for link in extra[worst])
    result.find(
        f"Links without an <inertial> that are fixed to links with one: {sum(map(len, extra.values()))}. "
        f"PyBullet gives each 1 kg: what {worst.joint} moves has {worst.mass:.3g} kg and gets {len(extra[worst])} kg "
        f"more: {', '.join(names)}.",
        "Write an <inertial> of 1e-6 kg for frames, and the true one for what is solid.",
        severity=Severity.WARNING if len(extra[worst]) >= worst.mass else Severity.NOTE,
        engine="pybullet",
        joint=worst.joint,
        link=extra[worst][0].name,
        line=extra[worst][0].line,
    )


def _suggested(room: Room | None) -> str:
    volume = None if room is None else room.solid
    return "" if volume is None else f"; at 1000 kg/m3 its geometry has {1000.0 * volume:.3g} kg"


@check(
    "KV202",
    title="Masses are above zero",
    fails="A mass is not above zero",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
)
def masses_not_positive(result: OpenCheck, physics: Physics) -> None:
    """No mass is zero or negative. Zero is allowed for a frame that is fixed to something with a mass, and a note for a
    base that does not move and where others of its body have a mass, which may be all of it.

    Why it matters: Nothing without a mass can be moved by a force; PyBullet freezes it where it is.

    Remedy: Write the true mass in kilograms.
    """
    for body in physics.bodies:
        for link in body.links:
            inertial = link.inertial
            if inertial is not None and inertial.mass <= 0.0:
                _not_positive(result, body, link, inertial)


def _not_positive(result: OpenCheck, body: Body, link: Link, inertial: Inertial) -> None:
    """Zero is harmless for a frame that is fixed to a mass, and PyBullet's sign for a base that never moves."""
    frame = link.name not in body.rooms
    if inertial.mass == 0.0 and frame and (body.mass > 0.0 or not body.moves):
        return
    refused = body.moves and body.mass == 0.0
    certain = inertial.mass < 0.0 or (refused and not frame)
    note = inertial.mass == 0.0 and (not body.moves or body.mass > 0.0)
    consequence = (
        "no engine can compute with that"
        if inertial.mass < 0.0
        else "a body that moves needs one, and in PyBullet the link never moves"
        if refused
        else "PyBullet takes it for scenery that never moves"
        if not body.moves
        else f"if it weighs anything, that is missing from the {body.mass:.3g} kg of what it is fixed to"
    )
    result.find(
        f"The link {link.name} has a mass of {inertial.mass:g} kg: {consequence}.",
        f"Write the true mass{_suggested(body.rooms.get(link.name))}.",
        severity=Severity.ERROR if certain else Severity.NOTE if note else Severity.WARNING,
        link=link.name,
        value=inertial.mass,
        limit=0.0,
        unit="kg",
        line=inertial.line,
    )


@check(
    "KV203",
    title="Masses are plausible",
    fails="A mass is implausible",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    needs=(something_weighs,),
)
def implausible_masses(result: OpenCheck, physics: Physics) -> None:
    """The mass of every body with geometry lies between `tiny_mass` and `huge_mass`.

    Why it matters: Placeholders and grams for kilograms make contacts stiff and motions absurd.

    Remedy: Write the true mass in kilograms.
    """
    settings = physics.settings
    for body in physics.bodies:
        if body.mass <= 0.0 or not body.rooms:
            continue
        if settings.tiny_mass <= body.mass <= settings.huge_mass:
            continue
        tiny = body.mass < settings.tiny_mass
        result.find(
            f"{body.named} has a mass of {body.mass:g} kg; expected {settings.tiny_mass:g} to "
            f"{settings.huge_mass:g} kg.",
            "Write the true mass in kilograms; exporters that know no material write a placeholder.",
            link=body.heaviest.name,
            value=body.mass,
            limit=settings.tiny_mass if tiny else settings.huge_mass,
            unit="kg",
            line=body.heaviest.line,
        )


@check(
    "KV206",
    title="Densities are plausible",
    fails="A density is implausible",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    follows={"KV203": CauseScope.BODY},
    needs=(something_weighs,),
)
def implausible_densities(result: OpenCheck, physics: Physics) -> None:
    """The mass of a body over the volume of its hull is not above `dense` (an error above `impossibly_dense`), and
    over the volume inside its (visible) surfaces not below `light`. Of a body below `marker` of the model's size it is
    a note: such shapes mark frames and sensors.

    Why it matters: The mass or the unit of the meshes is wrong, and with it every force.

    Remedy: Correct the mass, or the scale of the geometry.
    """
    # too heavy even for a solid hull, or too light for what its closed surfaces enclose
    settings = physics.settings
    for body in physics.bodies:
        room = body.room
        if room is None or body.mass <= 0.0 or room.diagonal <= 0.0:
            continue
        seen = body.placed({link.name: physics.visual[link.name] for link in body.links if link.name in physics.visual})
        heavy, light = body.mass / room.hull.volume, body.mass / _largest_volume(seen or room)
        marker = room.diagonal <= settings.marker * physics.diagonal
        if heavy > settings.dense:
            certain = heavy > settings.impossibly_dense
            severity = Severity.NOTE if marker else Severity.ERROR if certain else Severity.WARNING
            _density(result, body, heavy, settings.dense, severity)
        elif light < settings.light:
            _density(result, body, light, settings.light, Severity.NOTE if marker else Severity.WARNING)


def _largest_volume(room: Room) -> float:
    """Volume that the body fills at most [m^3]: what lies inside its surfaces, or its hull where they are open."""
    return float(room.hull.volume) if room.solid is None else min(room.solid, float(room.hull.volume))


def _density(result: OpenCheck, body: Body, density: float, limit: float, severity: Severity) -> None:
    heavy = density > limit
    result.find(
        f"{body.named} has {body.mass:.4g} kg in a volume that makes {density:.3g} kg/m3 of "
        f"it; {'gold has 19,300' if heavy else 'foam has 30'}, {limit:g} is the limit.",
        "Correct the mass, or the unit of the geometry: "
        + ("it is too heavy or too small." if heavy else "it is too light or too large."),
        severity=severity,
        link=body.heaviest.name,
        value=density,
        limit=limit,
        unit="kg/m3",
        line=body.heaviest.line,
    )
