"""KV201 to KV203, KV206 and KV209: is there a mass, and can it be the true one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.finding import Severity
from kinematify.validation.precheck.problem import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.declared import DeclaredInertial, DeclaredLink
    from kinematify.validation.asset.bodies import Body, Physics, Room


def missing_masses(physics: Physics) -> Iterator[Problem]:
    """KV201: one problem for the whole model where no link has a mass."""
    moving = [body for body in physics.bodies if body.moves]
    without = [body for body in moving if all(link.inertial is None for link in body.links)]
    if not without:
        return
    if len(without) == len(moving) and len(moving) > 1:
        yield Problem(
            message=f"None of the {len(moving)} bodies that move has an <inertial>: PyBullet gives each link 1 kg, "
            "MuJoCo the mass of its hull, Pinocchio none.",
            remedy="Add an <inertial> to every link; 100 to 1000 kg/m3 times the volume is a start.",
            link=without[0].called,
            value=len(without),
            limit=0,
        )
        return
    for body in without:
        frame = not body.rooms
        yield Problem(
            message=f"The link {body.called}, which the joint {body.joint} moves, has no <inertial>"
            + (" and no geometry: MuJoCo refuses it." if frame else ": PyBullet gives it 1 kg, Pinocchio nothing."),
            remedy="Add a small mass and inertia, such as 0.001 kg and 1e-7 kg m2."
            if frame
            else f"Add an <inertial>{_suggested(body)}.",
            link=body.called,
            line=physics.model.link_by_name[body.called].line,
        )


def _suggested(body: Body) -> str:
    volume = None if body.room is None else body.room.solid
    return "" if volume is None else f"; at 1000 kg/m3 its geometry has {1000.0 * volume:.3g} kg"


def masses_not_positive(physics: Physics) -> Iterator[Problem]:
    """KV202."""
    still = not any(body.moves for body in physics.bodies)
    for body in physics.bodies:
        for link in body.links:
            inertial = link.inertial
            if inertial is None or inertial.mass > 0.0:
                continue
            problem = _not_positive(physics, body, link, inertial, still=still)
            if problem is not None:
                yield problem


def _not_positive(
    physics: Physics, body: Body, link: DeclaredLink, inertial: DeclaredInertial, *, still: bool
) -> Problem | None:
    """Zero is harmless for a frame that is fixed to a mass, and PyBullet's sign for a base that never moves."""
    frame = link.name not in body.rooms
    if inertial.mass == 0.0 and frame and (body.mass > 0.0 or not body.moves):
        return None
    refused = body.moves and body.mass == 0.0
    certain = inertial.mass < 0.0 or (refused and not frame)
    note = inertial.mass == 0.0 and not body.moves and still
    consequence = (
        "no engine can compute with that"
        if inertial.mass < 0.0
        else "MuJoCo refuses it, and in PyBullet the link never moves"
        if refused
        else "PyBullet takes it for scenery that never moves"
        if not body.moves
        else "the mass is missing from the body that it belongs to"
    )
    return Problem(
        message=f"The link {link.name} has a mass of {inertial.mass:g} kg: {consequence}.",
        remedy=f"Write the true mass{_suggested(body)}.",
        severity=Severity.ERROR if certain else Severity.NOTE if note else Severity.WARNING,
        link=link.name,
        value=inertial.mass,
        limit=0.0,
        unit="kg",
        line=inertial.line,
    )


def implausible_masses(physics: Physics) -> Iterator[Problem]:
    """KV203."""
    settings = physics.settings
    for body in physics.bodies:
        if body.mass <= 0.0 or not body.rooms:
            continue
        if settings.tiny_mass <= body.mass <= settings.huge_mass:
            continue
        tiny = body.mass < settings.tiny_mass
        yield Problem(
            message=f"The link {body.heaviest.name} has a mass of {body.mass:g} kg; expected {settings.tiny_mass:g} to "
            f"{settings.huge_mass:g} kg.",
            remedy="Write the true mass in kilograms; exporters that know no material write a placeholder.",
            link=body.heaviest.name,
            value=body.mass,
            limit=settings.tiny_mass if tiny else settings.huge_mass,
            unit="kg",
            line=body.heaviest.line,
        )


def implausible_densities(physics: Physics) -> Iterator[Problem]:
    """KV206: too heavy even for a solid hull, or too light for what its closed surfaces enclose."""
    settings = physics.settings
    for body in physics.bodies:
        room = body.room
        if room is None or body.mass <= 0.0 or room.diagonal <= 0.0:
            continue
        heavy, light = body.mass / room.hull.volume, body.mass / _largest_volume(room)
        if heavy > settings.dense:
            yield _density(body, heavy, settings.dense, certain=heavy > settings.impossibly_dense)
        elif light < settings.light:
            yield _density(body, light, settings.light, certain=False)


def _largest_volume(room: Room) -> float:
    """Volume that the body fills at most [m^3]: what lies inside its surfaces, or its hull where they are open."""
    return float(room.hull.volume) if room.solid is None else min(room.solid, float(room.hull.volume))


def _density(body: Body, density: float, limit: float, *, certain: bool) -> Problem:
    heavy = density > limit
    return Problem(
        message=f"The link {body.heaviest.name} has {body.mass:.4g} kg in a volume that makes {density:.3g} kg/m3 of "
        f"it; {'gold has 19,300' if heavy else 'foam has 30'}, {limit:g} is the limit.",
        remedy="Correct the mass, or the unit of the geometry: "
        + ("it is too heavy or too small." if heavy else "it is too light or too large."),
        severity=Severity.ERROR if certain else Severity.WARNING,
        link=body.heaviest.name,
        value=density,
        limit=limit,
        unit="kg/m3",
        line=body.heaviest.line,
    )


def steep_mass_ratios(physics: Physics) -> Iterator[Problem]:
    """KV209: a heavy body on a light one; a light one on a heavy one is harmless in joint coordinates."""
    for body in physics.bodies:
        if body.joint is None:
            continue
        parent = physics.body_of[physics.model.joint_by_name[body.joint].joint.parent]
        if parent.moves and body.mass > physics.settings.mass_ratio * parent.mass > 0.0:
            yield Problem(
                message=f"The joint {body.joint} carries {body.mass:.3g} kg ({body.called}) on {parent.mass:.3g} kg "
                f"({parent.called}), a ratio of {body.mass / parent.mass:.0f}.",
                remedy="Check both masses; give the light link a mass nearer to that of its neighbour.",
                joint=body.joint,
                link=parent.called,
                value=body.mass / parent.mass,
                limit=physics.settings.mass_ratio,
            )


PROBES = {
    "KV201": missing_masses,
    "KV202": masses_not_positive,
    "KV203": implausible_masses,
    "KV206": implausible_densities,
    "KV209": steep_mass_ratios,
}
