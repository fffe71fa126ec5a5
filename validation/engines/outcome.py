"""What became of the drives through the ranges, whatever the engine, and the findings that follow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.mechanism import sweep_rows
from kinematify.validation.engines.surfaces import surfaces_meet
from kinematify.validation.engines.touching import stand_in_error, stand_in_reason
from kinematify.validation.finding import Blame, Severity
from kinematify.validation.left_model import model_of
from kinematify.validation.report import JointCurve

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import Mechanism, Travel
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.engines.drive import Drive
    from kinematify.validation.engines.touching import Touching
    from kinematify.validation.stage import OpenCheck, Recorder, StageRequest


@dataclass(frozen=True, kw_only=True, eq=False)
class Driven:
    """How one drive went."""

    drive: Drive
    reached: float
    """Where the joint stands when way and wait are over [rad or m]."""
    force: float
    """The largest of its servo until then [N m or N]."""
    lag: float
    """The largest behind the command [rad or m]."""
    beyond: float
    """How far it gets beyond the limit at which it is pushed [rad or m]; negative if it does not get there."""
    excess: FloatArray
    """How much deeper than allowed each pair of `Touching` gets on the way [m], shape (pairs,)."""
    at_end: FloatArray
    """The same where the joint stands at last, shape (pairs,)."""
    looks: FloatArray
    """What is drawn of the way: command, value [rad or m], force [N m or N] and depth beyond what is allowed [m] at
    each look, shape (4, looks)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Case:
    """Everything about a model that the findings name."""

    mechanism: Mechanism
    prepared: Prepared
    sweep: Touching
    """Along `Mechanism.sweep`, from the kinematics alone."""
    request: StageRequest

    @property
    def settings(self) -> EngineSettings:
        """Thresholds of the engine stages."""
        return self.request.settings.engines

    def travel(self, driven: Driven) -> Travel:
        """Return the way of the joint that is driven."""
        return self.mechanism.travels[driven.drive.leader]

    def arrived(self, driven: Driven) -> bool:
        """True if the joint got to its end."""
        return abs(driven.drive.end - driven.reached) <= self.settings.reach * self.travel(driven).range

    def separates(self, leader: int) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Which pairs of the sweep a joint moves against each other, shape (pairs,)."""
        moved = self.mechanism.moved[leader]
        first, second = self.sweep.bodies.T
        result: np.ndarray[tuple[int], np.dtype[np.bool_]] = moved[first] != moved[second]
        return result

    def excess_towards(self, driven: Driven) -> tuple[FloatArray, FloatArray]:
        """Excess of each pair between rest and the end by kinematics alone (pairs, n), and the joint's values (n,)."""
        travel, count = self.travel(driven), self.settings.sweep_samples
        values = np.linspace(travel.lower, travel.upper, count)
        side = values >= travel.rest if driven.drive.end == travel.upper else values <= travel.rest
        rows = sweep_rows(driven.drive.leader, count)
        return self.sweep.excess[:, rows][:, side], values[side]


def find_overlaps(check: OpenCheck, case: Case) -> None:
    """Add a finding for every overlap at rest, and a note about those of pairs that a joint connects."""
    sweep = case.sweep
    overlapping = np.flatnonzero(sweep.at_rest > sweep.tolerance).tolist()
    joined = [k for k in overlapping if tuple(sweep.bodies[k].tolist()) in case.mechanism.neighbours]
    check.measured |= {
        "touching_pairs": float(np.count_nonzero(sweep.at_rest > 0.0)),
        "overlapping_pairs": float(len(overlapping)),
        "deepest": float(sweep.at_rest.max(initial=0.0)),
    }
    for index in overlapping:
        if index not in joined:
            _find_overlap(check, case, index)
    if joined:
        names = ", ".join(
            f"{' and '.join(sweep.pair(k, case.mechanism.links))} {sweep.at_rest[k] * 1e3:.3g} mm" for k in joined
        )
        check.find(
            f"Links that a joint connects overlap at rest: {names}. As much is allowed to them in all other runs, and "
            "what their convex stand-ins can exceed the meshes by.",
            "Nothing needs to be done where a bearing is modelled as solid; else shrink the collision geometry.",
            severity=Severity.NOTE,
        )


def _find_overlap(check: OpenCheck, case: Case, index: int) -> None:
    first, second = pair = case.sweep.pair(index, case.mechanism.links)
    depth = float(case.sweep.at_rest[index])
    real = depth > stand_in_error(case.prepared, pair)
    check.find(
        f"At rest, {first} and {second} overlap by {depth * 1e3:.3g} mm"
        + ("." if real else f", {stand_in_reason(case.prepared, pair)}."),
        f"Move {first} and {second} apart, or shrink their collision geometry."
        if real
        else f"Write convex pieces as collision geometry of {first} and {second}.",
        pair=pair,
        q={travel.joint: travel.rest for travel in case.mechanism.travels},
        value=depth,
        limit=case.sweep.tolerance,
        unit="m",
    )


def tell_curves(recorder: Recorder, case: Case, driven: Sequence[Driven], engine: str) -> None:
    """Tell how the joints were driven, for whoever draws it."""
    for item in driven:
        commanded, reached, force, depth = (tuple(map(float, row)) for row in item.looks)
        recorder.summarise(
            JointCurve(
                joint=case.travel(item).joint,
                engine=engine,
                upper=bool(item.drive.end == case.travel(item).upper),
                commanded=commanded,
                reached=reached,
                force=force,
                depth=depth,
            )
        )


def find_unreached(check: OpenCheck, case: Case, driven: Sequence[Driven]) -> None:
    """Add a finding for every joint that did not get to one of its ends."""
    check.measured["drives"] = float(len(driven))
    check.measured["arrived"] = float(sum(case.arrived(item) for item in driven))
    for item in driven:
        if not case.arrived(item):
            _find_blocked(check, case, item)
        elif item.lag > case.settings.tracking * case.travel(item).range:
            _find_lag(check, case, item)


def _find_blocked(check: OpenCheck, case: Case, driven: Driven) -> None:
    travel = case.travel(driven)
    where = f"Driven from {travel.rest:.4g} towards {driven.drive.end:.4g} {travel.unit}"
    stops = f"{where}, joint {travel.joint} stops at {driven.reached:.4g} {travel.unit}"
    facts = {
        "joint": travel.joint,
        "q": {travel.joint: driven.reached},
        "value": driven.reached,
        "limit": driven.drive.end,
        "unit": travel.unit,
    }
    index = blocking_pair(case, driven)
    if index is None:
        check.find(
            f"{stops} without contact, at a force of {driven.force:.3g} {_force_unit(travel)}.",
            "Check damping, friction and inertia of the joint, and the limits of joints that follow it.",
            severity=Severity.WARNING,
            blame=Blame.PHYSICS,
            **facts,  # type: ignore[arg-type]
        )
        return
    first, second = pair = case.sweep.pair(index, case.mechanism.links)
    excess, values = case.excess_towards(driven)
    deepest = int(np.argmax(excess[index]))
    beyond = excess[index, deepest] > stand_in_error(case.prepared, pair)
    real = bool(beyond) and _stopped_by_surfaces(case, driven, pair, until=float(values[deepest]))
    why = (
        f"there {first} and {second} collide; moved on without physics, they get {excess[index, deepest] * 1e3:.3g} mm "
        f"deeper into each other than at rest (at {values[deepest]:.4g} {travel.unit})"
    )
    if real:
        remedy = f"Correct axis, pivot or limit of {travel.joint} so that {first} and {second} stay clear."
    else:
        reason = stand_in_reason(case.prepared, pair) if not beyond else "while their declared surfaces stay clear"
        why += f", {reason}"
        remedy = f"Write convex pieces as collision geometry of {first} and {second}."
    check.find(
        f"{stops}: {why}.",
        remedy,
        severity=_severity(case, index, real=real, limited=travel.limited),
        blame=Blame.KINEMATICS if real else Blame.PHYSICS,
        pair=pair,
        **facts,  # type: ignore[arg-type]
    )


def _stopped_by_surfaces(case: Case, driven: Driven, pair: tuple[str, str], *, until: float) -> bool:
    """Whether the declared surfaces of two links meet as well, on the way from rest to where the pieces are deepest."""
    leader, (_, values) = driven.drive.leader, case.excess_towards(driven)
    away = np.abs(values - case.travel(driven).rest)
    way = np.argsort(away)[: 1 + int(np.count_nonzero(away < abs(until - case.travel(driven).rest)))]
    rows = np.tile(case.mechanism.rest, (1 + len(way), 1))
    rows[1:, leader] = values[way]
    declared = model_of(case.request)  # the engines themselves do without surfaces
    geometry = case.request.settings.geometry
    return surfaces_meet(declared, pair, rows, tolerance=case.sweep.tolerance, settings=geometry)


def _severity(case: Case, index: int, *, real: bool, limited: bool) -> Severity:
    """How bad it is that a pair stops a joint.

    Neighbours above the root pass each other in engines unless one asks for their contacts, and parts that both move
    can get out of each other's way: a robot reaches itself within its ranges.
    """
    pair = tuple(sorted(case.sweep.bodies[index].tolist()))
    if real and limited and pair in case.mechanism.neighbours and pair[0] == 0:
        return Severity.ERROR
    return Severity.WARNING if pair in case.mechanism.neighbours or (real and pair[0] == 0) else Severity.NOTE


def blocking_pair(case: Case, driven: Driven) -> int | None:
    """Return the pair of the sweep that stops a joint: the deepest where it stands, else the deepest ahead of it."""
    parted = case.separates(driven.drive.leader)
    if not parted.any():
        return None
    # A servo at its limit of force presses a contact in by less than the tolerance.
    pressed = np.where(parted, driven.at_end, -np.inf)
    if pressed.max() > -0.5 * case.sweep.tolerance:
        return int(np.argmax(pressed))
    excess, _ = case.excess_towards(driven)
    ahead = np.where(parted, excess.max(axis=1), -np.inf)
    return int(np.argmax(ahead)) if ahead.max() > 0.0 else None


def _find_lag(check: OpenCheck, case: Case, driven: Driven) -> None:
    travel = case.travel(driven)
    check.find(
        f"On its way to {driven.drive.end:.4g} {travel.unit}, joint {travel.joint} lags {driven.lag:.3g} {travel.unit} "
        f"behind its command.",
        "Check damping, friction and inertia of the joint.",
        severity=Severity.NOTE,
        blame=Blame.PHYSICS,
        joint=travel.joint,
        value=driven.lag,
        limit=case.settings.tracking * travel.range,
        unit=travel.unit,
    )


def find_penetrations(check: OpenCheck, case: Case, driven: Sequence[Driven]) -> None:
    """Add a finding for every pair that gets too deep while a joint is driven to an end that it reaches."""
    worst: dict[int, tuple[float, Driven]] = {}
    arrived = [item for item in driven if case.arrived(item)]
    for item in arrived:
        # What is allowed gives way without force; a stop is then as soft as any contact of the engine.
        for pair in np.flatnonzero(item.excess > case.sweep.tolerance).tolist():
            if item.excess[pair] > worst.get(pair, (0.0, item))[0]:
                worst[pair] = (float(item.excess[pair]), item)
    deepest = max((float(item.excess.max(initial=0.0)) for item in arrived), default=0.0)
    check.measured["deepest_beyond_rest"] = deepest + case.sweep.tolerance if deepest > 0.0 else 0.0
    for pair, (excess, item) in sorted(worst.items()):
        _find_penetration(check, case, pair, excess, item)


def _find_penetration(check: OpenCheck, case: Case, pair: int, excess: float, driven: Driven) -> None:
    first, second = names = case.sweep.pair(pair, case.mechanism.links)
    travel = case.travel(driven)
    real = excess > stand_in_error(case.prepared, names)
    check.find(
        f"While {travel.joint} is driven to {driven.drive.end:.4g} {travel.unit}, {first} and {second} get "
        f"{(excess + case.sweep.tolerance) * 1e3:.3g} mm deeper into each other than at rest.",
        f"Correct the joint, or the collision geometry of {first} and {second}.",
        blame=Blame.KINEMATICS if real else Blame.PHYSICS,
        joint=travel.joint,
        pair=names,
        value=excess + case.sweep.tolerance,
        limit=case.sweep.tolerance,
        unit="m",
    )


def find_escapes(check: OpenCheck, case: Case, driven: Sequence[Driven]) -> None:
    """Add a finding for every limit that gives way."""
    pushed = [item for item in driven if case.travel(item).limited and case.arrived(item)]
    if not pushed:
        check.skip("no joint with limits got to one of them")
        return
    shares = [item.beyond / case.travel(item).range for item in pushed]
    check.measured["farthest_of_range"] = max(0.0, *shares)
    for item, share in zip(pushed, shares, strict=True):
        travel = case.travel(item)
        if share > case.settings.escape:
            check.find(
                f"Pushed on at its limit {item.drive.end:.4g} {travel.unit}, joint {travel.joint} gets "
                f"{item.beyond:.3g} {travel.unit} beyond it, {share:.1%} of its range.",
                "Give the part a plausible inertia, and limits that fit its motion.",
                joint=travel.joint,
                value=item.beyond,
                limit=case.settings.escape * travel.range,
                unit=travel.unit,
            )


def _force_unit(travel: Travel) -> str:
    return "N m" if travel.turns else "N"
