"""KV204, KV205, KV207 and KV208: inertia tensors and centres of mass."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.finding import Severity
from kinematify.validation.precheck.problem import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.declared import DeclaredInertial, DeclaredLink
    from kinematify.validation.asset.bodies import Body, Physics, Room

_ROUNDING = 1e-9
"""Relative rounding of moments that were read from text."""


def tensors_not_positive(physics: Physics) -> Iterator[Problem]:
    """KV204: harmless where nothing moves, for instance in the base of an arm."""
    for body, link, inertial in _weighed(physics):
        low, _, high = np.linalg.eigvalsh(inertial.tensor)
        if low > _ROUNDING * high and high > 0.0:
            continue
        nothing = not np.any(inertial.tensor)
        # A rod without thickness has such moments: a slip, where negative ones are nonsense.
        flat = low >= -_ROUNDING * high and not nothing
        yield Problem(
            message=f"The inertia of the link {link.name} "
            + (
                "is zero"
                if nothing
                else f"is not positive definite: its principal moments are {_moments(inertial)} kg m2"
            )
            + ("; MuJoCo refuses it, and PyBullet takes it for zero." if body.moves else "; no body has that."),
            remedy=_better_tensor(body, link),
            severity=Severity.ERROR if body.moves and not flat else Severity.WARNING,
            link=link.name,
            value=low,
            limit=0.0,
            unit="kg m2",
            line=inertial.line,
        )


def _moments(inertial: DeclaredInertial) -> str:
    return ", ".join(f"{value:.3g}" for value in np.linalg.eigvalsh(inertial.tensor))


def _better_tensor(body: Body, link: DeclaredLink) -> str:
    """That of a box with the extents of the geometry, which is never far from the truth."""
    room = body.rooms.get(link.name)
    mass = link.inertial.mass if link.inertial is not None else 0.0
    if room is None or mass <= 0.0:
        return "Compute it from the geometry, or write that of a small ball: 0.4 times mass times radius squared."
    x, y, z = (room.high - room.low) ** 2
    ixx, iyy, izz = mass / 12.0 * np.array([y + z, x + z, x + y])
    return (
        f"Compute it from the geometry; a box of the same size has ixx={ixx:.3g}, iyy={iyy:.3g}, izz={izz:.3g} and no "
        "products of inertia."
    )


def moments_out_of_proportion(physics: Physics) -> Iterator[Problem]:
    """KV205: in every body two principal moments together are at least the third."""
    settings = physics.settings
    for body, link, inertial in _weighed(physics):
        low, middle, high = np.linalg.eigvalsh(inertial.tensor)
        if low <= _ROUNDING * high or high <= (low + middle) * (1.0 + _ROUNDING):
            continue
        ratio = high / (low + middle)
        rounding = ratio < settings.moment_rounding
        certain = body.moves and ratio > settings.moment_ratio
        yield Problem(
            message=f"The principal moments {_moments(inertial)} kg m2 of the link {link.name} can be those of no "
            f"body: the largest is {ratio:.4g} times the sum of the others. MuJoCo refuses that unless it may balance "
            "them, PyBullet takes the inertia for zero.",
            remedy="Write the tensor with more digits." if rounding else _better_tensor(body, link),
            severity=Severity.ERROR if certain else Severity.NOTE if rounding else Severity.WARNING,
            link=link.name,
            value=ratio,
            limit=1.0,
            line=inertial.line,
        )


def radii_of_gyration(physics: Physics) -> Iterator[Problem]:
    """KV207: no mass of a body lies farther from its centre than its geometry; one problem where many links have it."""
    found = [misfit for misfit in (_misfit(physics, *item) for item in _weighed(physics)) if misfit is not None]
    if len(found) <= physics.settings.listed:
        yield from (misfit.problem for misfit in found)
        return
    worst = max(found, key=lambda misfit: misfit.factor)
    yield replace(
        worst.problem,
        message=f"The inertias of {len(found)} links do not fit their geometry; they look like placeholders. "
        + worst.problem.message,
    )


@dataclass(frozen=True, kw_only=True)
class _Misfit:
    """An inertia that does not fit, and by which factor."""

    problem: Problem
    factor: float


def _misfit(physics: Physics, body: Body, link: DeclaredLink, inertial: DeclaredInertial) -> _Misfit | None:
    settings = physics.settings
    own = body.rooms.get(link.name)
    moments = np.linalg.eigvalsh(inertial.tensor)
    if body.room is None or moments[0] <= 0.0:
        return None
    radius = float(np.sqrt(moments[2] / inertial.mass))
    farthest = _farthest(body.room, _centre(body, link, inertial))
    large = radius > settings.gyration_large * farthest
    if not large and own is not None:
        farthest = _farthest(own, inertial.center_of_mass)
    if farthest == 0.0 or not (large or radius < settings.gyration_small * farthest):
        return None
    problem = Problem(
        message=f"The inertia of the link {link.name} has a radius of gyration of {radius:.3g} m, but its geometry "
        f"reaches {farthest:.3g} m from its centre of mass"
        + (": no mass lies that far out." if large else ": all its mass would sit in the centre."),
        remedy=_better_tensor(body, link),
        link=link.name,
        value=radius,
        limit=(settings.gyration_large if large else settings.gyration_small) * farthest,
        unit="m",
        line=inertial.line,
    )
    return _Misfit(problem=problem, factor=max(radius / farthest, farthest / radius))


def _farthest(room: Room, centre: FloatArray) -> float:
    """Distance of the outermost point of some geometry from a centre of mass in the same frame [m]."""
    return float(np.linalg.norm(room.points - centre, axis=1).max())


def _centre(body: Body, link: DeclaredLink, inertial: DeclaredInertial) -> FloatArray:
    """Centre of mass in the frame of the body, shape (3,)."""
    T_body_link = body.T_body_link[link.name]
    return np.asarray(T_body_link[:3, :3] @ inertial.center_of_mass + T_body_link[:3, 3])


def centres_outside(physics: Physics) -> Iterator[Problem]:
    """KV208: the body counts, not the link, because authors lump what is fixed together."""
    settings = physics.settings
    for body, link, inertial in _weighed(physics):
        room = body.room
        if room is None or room.diagonal == 0.0:
            continue
        outside = room.outside(_centre(body, link, inertial))
        if outside > settings.centre_outside * room.diagonal:
            yield Problem(
                message=f"The centre of mass of the link {link.name} lies {outside:.3g} m outside its geometry, which "
                f"measures {room.diagonal:.3g} m.",
                remedy=f"Write it inside the geometry, for instance {_middle(physics, link)}; check units and frame of "
                "the <origin> of its <inertial>.",
                severity=Severity.ERROR if outside > settings.centre_far * room.diagonal else Severity.WARNING,
                link=link.name,
                value=outside,
                limit=settings.centre_outside * room.diagonal,
                unit="m",
                line=inertial.line,
            )


def _middle(physics: Physics, link: DeclaredLink) -> str:
    room = physics.visual.get(link.name) or physics.collision.get(link.name)
    return "0 0 0" if room is None else " ".join(f"{value:.4g}" for value in 0.5 * (room.low + room.high))


def _weighed(physics: Physics) -> Iterator[tuple[Body, DeclaredLink, DeclaredInertial]]:
    """Links with a mass above zero; what is wrong with the others is said elsewhere."""
    for body in physics.bodies:
        for link in body.links:
            if link.inertial is not None and link.inertial.mass > 0.0:
                yield body, link, link.inertial


PROBES = {
    "KV204": tensors_not_positive,
    "KV205": moments_out_of_proportion,
    "KV207": radii_of_gyration,
    "KV208": centres_outside,
}
