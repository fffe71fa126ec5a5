"""KV204, KV205, KV207, KV208 and KV210: inertia tensors and centres of mass."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.asset.slips import slip_of
from kinematify.validation.check import check
from kinematify.validation.checks.shared import something_weighs
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Inertial, Link
    from kinematify.validation.asset.rigid_bodies import Body, Physics, Room
    from kinematify.validation.check import OpenCheck

_ROUNDING = 1e-9
"""Relative rounding of moments that were read from text."""


@check(
    "KV204",
    title="Inertia tensors are positive definite",
    fails="An inertia tensor is not positive definite",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    needs=(something_weighs,),
)
def tensors_not_positive(result: OpenCheck, physics: Physics) -> None:
    """All principal moments of inertia of a body are above zero, those of links that fixed joints hold together summed
    up, as engines fuse them. It is a warning for bodies that do not move, and where some moments are zero and none is
    negative; a link that has none while its body has is a note, a warning where an engine refuses the file for it.

    Why it matters: Nothing turns without inertia: engines refuse such a body, or take it for what it is not.

    Remedy: Compute the tensor from the geometry; the finding names the values of a box of the same size.
    """
    for body, link, inertial in _weighed(physics):
        if _positive(inertial.tensor):
            continue
        if body.fused is not None and _positive(body.fused.tensor):
            _harmless(result, link, inertial, "is zero or not positive definite")
            continue
        low, _, high = np.linalg.eigvalsh(inertial.tensor)
        nothing = not np.any(inertial.tensor)
        # A rod without thickness has such moments: a slip, where negative ones are nonsense.
        flat = low >= -_ROUNDING * high and not nothing
        result.find(
            f"The inertia of the link {link.name} "
            + (
                "is zero."
                if nothing
                else f"is not positive definite: its principal moments are {_moments(inertial)} kg m2."
            ),
            _better_tensor(body, link),
            severity=Severity.ERROR if body.moves and not flat else Severity.WARNING,
            link=link.name,
            value=low,
            limit=0.0,
            unit="kg m2",
            line=inertial.line,
        )


def _positive(tensor: FloatArray) -> bool:
    low, _, high = np.linalg.eigvalsh(tensor)
    return bool(low > _ROUNDING * high and high > 0.0)


def _harmless(result: OpenCheck, link: Link, inertial: Inertial, what: str) -> None:
    """Say of a tensor that engines do not see which fuse the links of fixed joints."""
    result.find(
        f"The inertia of the link {link.name} {what}; fixed joints hold it to links that make up for it.",
        "Nothing to do where it is a frame or a sensor; else compute it from the geometry.",
        severity=Severity.NOTE,
        link=link.name,
        line=inertial.line,
    )


def _moments(inertial: Inertial) -> str:
    return ", ".join(f"{value:.3g}" for value in np.linalg.eigvalsh(inertial.tensor))


def _better_tensor(body: Body, link: Link) -> str:
    """The entry that a power of ten repairs, else a box with the extents of the geometry, never far from the truth."""
    room = body.rooms.get(link.name)
    slip = None if link.inertial is None else slip_of(link.inertial, room)
    if slip is not None:
        return (
            f'Write {slip.entry}="{slip.right:.6g}" in place of {slip.given:.6g}: of all entries and powers '
            "of ten this one alone makes it fit the geometry; kinematify fix writes it."
        )
    mass = link.inertial.mass if link.inertial is not None else 0.0
    if room is None or mass <= 0.0:
        return "Compute it from the geometry, or write that of a small ball: 0.4 times mass times radius squared."
    x, y, z = (room.high - room.low) ** 2
    ixx, iyy, izz = mass / 12.0 * np.array([y + z, x + z, x + y])
    return (
        "Compute it from the geometry; that of a box of the same size is "
        f'<inertia ixx="{ixx:.3g}" iyy="{iyy:.3g}" izz="{izz:.3g}" ixy="0" ixz="0" iyz="0"/>.'
    )


@check(
    "KV205",
    title="Principal moments satisfy the triangle inequality",
    fails="An inertia is physically impossible",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    needs=(something_weighs,),
)
def moments_out_of_proportion(result: OpenCheck, physics: Physics) -> None:
    """No principal moment of a body, its links fused, is larger than the sum of the other two: an error above
    `moment_ratio` times the sum for bodies that move, a note below `moment_rounding`, a warning otherwise. A link that
    has such moments while its body has not is a note, a warning where an engine refuses the untouched file for it.

    Why it matters: No distribution of mass has such moments; engines balance them, refuse them or take them for zero.

    Remedy: Compute the tensor from the geometry, or write it with more digits.
    """
    settings = physics.settings
    for body, link, inertial in _weighed(physics):
        low, middle, high = np.linalg.eigvalsh(inertial.tensor)
        if low <= _ROUNDING * high or _proportionate(inertial.tensor):
            continue
        if body.fused is not None and _proportionate(body.fused.tensor):
            _harmless(result, link, inertial, "can be that of no body")
            continue
        ratio = high / (low + middle)
        rounding = ratio < settings.moment_rounding
        certain = body.moves and ratio > settings.moment_ratio
        result.find(
            f"The principal moments {_moments(inertial)} kg m2 of the link {link.name} can be those of no "
            f"body: the largest is {ratio:.4g} times the sum of the others.",
            "Write the tensor with more digits." if rounding else _better_tensor(body, link),
            severity=Severity.ERROR if certain else Severity.NOTE if rounding else Severity.WARNING,
            link=link.name,
            value=ratio,
            limit=1.0,
            line=inertial.line,
        )


def _proportionate(tensor: FloatArray) -> bool:
    low, middle, high = np.linalg.eigvalsh(tensor)
    return bool(high <= (low + middle) * (1.0 + _ROUNDING))


@check(
    "KV207",
    title="Inertia fits the geometry",
    fails="An inertia does not fit its geometry",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    needs=(something_weighs,),
)
def radii_of_gyration(result: OpenCheck, physics: Physics) -> None:
    """The largest radius of gyration lies between `gyration_small` and `gyration_large` times the distance of the
    outermost point of the body from the centre of mass; the lower bound is for links that have geometry of their own.

    Why it matters: An inertia copied from another link, or in another unit, makes joints sluggish or nervous.

    Remedy: Compute the tensor from the geometry.
    """
    settings = physics.settings
    found = [misfit for item in _weighed(physics) if (misfit := _misfit(physics, *item)) is not None]
    many = len(found) > settings.listed
    for misfit in [max(found, key=lambda misfit: misfit.factor)] if many else found:
        factor = settings.gyration_large if misfit.large else settings.gyration_small
        result.find(
            (
                f"The inertias of {len(found)} links do not fit their geometry; they look like placeholders. "
                if many
                else ""
            )
            + f"The inertia of the link {misfit.link.name} has a radius of gyration of {misfit.radius:.3g} m, but its "
            f"geometry reaches {misfit.farthest:.3g} m from its centre of mass"
            + (": no mass lies that far out." if misfit.large else ": all its mass would sit in the centre."),
            _better_tensor(misfit.body, misfit.link),
            link=misfit.link.name,
            value=misfit.radius,
            limit=factor * misfit.farthest,
            unit="m",
            line=misfit.inertial.line,
        )


@check(
    "KV210",
    title="Links of different size have different inertias",
    fails="Links of different size have one mass and one inertia",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    needs=(something_weighs,),
)
def copied_inertias(result: OpenCheck, physics: Physics) -> None:
    """No `copied_links` links or more have the same mass and the same principal moments of inertia while the largest of
    them takes up `copied_volume` times as much room as the smallest. Masses below `copied_share` of the model's are
    omitted: sensors and frames are given next to nothing on purpose.

    Why it matters: They are placeholders: whatever is simulated with them, torques above all, is not this machine's.

    Remedy: Compute mass and inertia of each link from its geometry and its material, or take them from the maker's
    data.
    """
    settings = physics.settings
    least = settings.copied_share * sum(body.mass for body in physics.bodies)
    alike: dict[tuple[float, ...], list[tuple[Link, float]]] = defaultdict(list)
    for body, link, inertial in _weighed(physics):
        if inertial.mass >= least and link.name in body.rooms:
            moments = (float(f"{value:.5e}") for value in np.linalg.eigvalsh(inertial.tensor))
            alike[inertial.mass, *moments].append((link, float(body.rooms[link.name].hull.volume)))
    for (mass, *_), links in alike.items():
        links.sort(key=lambda item: item[1])
        (small, least_room), (large, most_room) = links[0], links[-1]
        ratio = most_room / least_room
        if len(links) < settings.copied_links or ratio < settings.copied_volume:
            continue
        result.find(
            f"{len(links)} links have the same mass of {mass:g} kg and the same inertia, from {small.name} to "
            f"{large.name}, which takes up {ratio:.3g} times as much room: they look like placeholders.",
            "Compute mass and inertia of each link from its geometry.",
            link=large.name,
            value=ratio,
            limit=settings.copied_volume,
            line=None if large.inertial is None else large.inertial.line,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Misfit:
    """An inertia whose radius of gyration does not fit the geometry."""

    body: Body
    link: Link
    inertial: Inertial
    radius: float
    """Of gyration [m]."""
    farthest: float
    """Distance of the outermost point of the geometry from the centre of mass [m]."""
    large: bool
    """The radius is too large; otherwise too small."""

    @property
    def factor(self) -> float:
        """Return how far the two are apart, above 1."""
        return max(self.radius / self.farthest, self.farthest / self.radius)


def _misfit(physics: Physics, body: Body, link: Link, inertial: Inertial) -> _Misfit | None:
    settings = physics.settings
    own = body.rooms.get(link.name)
    moments = np.linalg.eigvalsh(inertial.tensor)
    if body.room is None or moments[0] <= 0.0:
        return None
    radius = float(np.sqrt(moments[2] / inertial.mass))
    farthest = _farthest(body.room, _centre(body, link, inertial))
    large = radius > settings.gyration_large * farthest
    if not large:
        if own is None:
            return None  # a sensor that is not modelled may be as small as it likes
        farthest = _farthest(own, inertial.center_of_mass)
    if farthest == 0.0 or not (large or radius < settings.gyration_small * farthest):
        return None
    return _Misfit(body=body, link=link, inertial=inertial, radius=radius, farthest=farthest, large=large)


def _farthest(room: Room, centre: FloatArray) -> float:
    """Distance of the outermost point of some geometry from a centre of mass in the same frame [m]."""
    return float(np.linalg.norm(room.points - centre, axis=1).max())


def _centre(body: Body, link: Link, inertial: Inertial) -> FloatArray:
    """Centre of mass in the frame of the body, shape (3,)."""
    T_body_link = body.T_body_link[link.name]
    return np.asarray(T_body_link[:3, :3] @ inertial.center_of_mass + T_body_link[:3, 3])


@check(
    "KV208",
    title="Centres of mass lie in the geometry",
    fails="A centre of mass lies outside the geometry",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    needs=(something_weighs,),
)
def centres_outside(result: OpenCheck, physics: Physics) -> None:
    """The centre of mass lies in the hull of the body, inflated by `centre_outside` of its diagonal; beyond
    `centre_far` it is an error for bodies that move. Links without geometry count above `frame_share` of the body's
    mass: below, they are frames and sensors with a mass that means nothing.

    Why it matters: Gravity turns the part the wrong way, and joints need torques that they do not need in truth.

    Remedy: Correct the <origin> of the <inertial>: its unit, or the frame that it is meant in.
    """
    # the body counts, not the link, because authors lump what is fixed together
    settings = physics.settings
    for body, link, inertial in _weighed(physics):
        room = body.room
        frame = link.name not in body.rooms and inertial.mass <= settings.frame_share * body.mass
        if room is None or room.diagonal == 0.0 or frame:
            continue
        outside = room.outside(_centre(body, link, inertial))
        if outside > settings.centre_outside * room.diagonal:
            result.find(
                f"The centre of mass of the link {link.name} lies {outside:.3g} m outside its geometry, which "
                f"measures {room.diagonal:.3g} m.",
                "Write it inside the geometry: check units and frame of the <origin> of its <inertial>.",
                severity=Severity.ERROR
                if body.moves and outside > settings.centre_far * room.diagonal
                else Severity.WARNING,
                link=link.name,
                value=outside,
                limit=settings.centre_outside * room.diagonal,
                unit="m",
                line=inertial.line,
            )


def _weighed(physics: Physics) -> Iterator[tuple[Body, Link, Inertial]]:
    """Links with a mass above zero; what is wrong with the others is said elsewhere."""
    for body in physics.bodies:
        for link in body.links:
            if link.inertial is not None and link.inertial.mass > 0.0:
                yield body, link, link.inertial
