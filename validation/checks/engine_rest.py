"""KV403 and their like: overlaps at rest; then runs in which nothing is driven: sag, energy, time step, the drop."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.contacts import stand_in_error, stand_in_reason
from kinematify.validation.check import CauseScope, FeedbackRow, engine_check
from kinematify.validation.checks.follow import IN_ENGINES, NOT_A_BODY
from kinematify.validation.checks.needs import late, no_geometry, nothing_moves
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import Travel
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.engine_context import EngineContext

_HARDLY = 0.02
"""Motion that is too small to say anything, fraction of the range."""
_VISIBLE_ANGLE, _VISIBLE_LENGTH = np.radians(0.1), 1e-3
"""Nobody sees less of a limit that gives way [rad and m]: stops of engines are springs."""
FLOOR_OF_ENERGY = 1e-5
"""Growth that does not count, fraction of the energy of a fall of the whole model by its own size."""
_TOLD_PAIRS = 8


@engine_check(
    "03",
    title="Starts without contact",
    fails="Links overlap when it starts",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    feedback=FeedbackRow.COLLISION,
    follows=IN_ENGINES,
    prepared=True,
)
def starts_without_contact(result: OpenCheck, context: EngineContext) -> None:
    """At rest, no two links overlap by more than engines.contact_depth as the engine sees them (convex pieces). Links
    that a joint connects may overlap by what they have at rest; a note names them.

    PyBullet: The 1 mm by which PyBullet inflates meshes does not count.

    Why it matters: An overlap at the start is pushed apart in the first steps: the model jumps or flies off.

    Remedy: Move the parts apart or shrink their collision geometry by the depth that is named; where a convex stand-in
    overlaps although the mesh does not, write convex pieces as collision geometry.
    """
    _find_overlaps(result, context)
    ignored_pairs, inflation = context.physics.ignored_pairs, context.entry.inflation
    if ignored_pairs:
        links = context.mechanism.links
        names = sorted(f"{links[a]} and {links[b]}" for a, b in ignored_pairs)
        more = f" and {len(names) - _TOLD_PAIRS} more pairs" if len(names) > _TOLD_PAIRS else ""
        thicker = f"inflates every mesh by {inflation * 1e3:.3g} mm and " if inflation else ""
        result.measured["switched_off_pairs"] = float(len(ignored_pairs))
        result.find(
            f"{context.entry.title} {thicker}knows no overlap that is allowed. These pairs touch at rest that way and "
            f"would be pushed apart, so they do not act on each other while the model moves: "
            f"{', '.join(names[:_TOLD_PAIRS])}{more}. How deep they get is measured instead, and a joint stops where "
            "they get deeper than allowed.",
            "Nothing needs to be done; for your own simulation leave 2 mm between collision shapes, or filter these "
            "pairs.",
            severity=Severity.NOTE,
        )


@engine_check(
    "04",
    title="Holds under gravity",
    fails="Does not hold under gravity",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    feedback=FeedbackRow.SINKS,
    follows={"KV226": CauseScope.JOINT, "KV221": CauseScope.JOINT},
    needs=(nothing_moves, late),
)
def holds_under_gravity(result: OpenCheck, context: EngineContext) -> None:
    """Joints held by position servos, none stronger than its declared effort, sag by no more than engines.sag of the
    range. Without servos joints may fall, but none moves beyond its limits by more than engines.escape of its range,
    0.1 deg and 1 mm, whichever is more.

    PyBullet: PyBullet stops a joint one step after its limit and leaves it there; so much is not counted.

    Why it matters: An arm that cannot carry itself collapses at the start of each episode.

    Remedy: Raise the effort above the torque that is named, or reduce the masses.
    """
    held, released = context.held.q, context.released.q
    if not len(held) or not len(released):
        result.block(f"{context.entry.title} diverged in the first step")
        return
    _find_sag(result, context, held)
    _find_passive_escape(result, context, _less_one_step(context, released) if context.entry.stops_late else released)


@engine_check(
    "08",
    title="Energy does not grow",
    fails="Energy grows",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    feedback=FeedbackRow.UNSTABLE,
    follows=NOT_A_BODY,
    needs=(nothing_moves, late),
)
def energy_does_not_grow(result: OpenCheck, context: EngineContext) -> None:
    """Released without servos, damping and friction, the sum of kinetic and potential energy stays within
    engines.energy of the energy that moves.

    PyBullet: It is simulated with a quarter of the usual time step.

    Why it matters: Growing energy comes from inertias that cannot be or from contacts that push: the motion is not
    physical and explodes in longer runs.

    Remedy: Correct the inertia tensors and the overlaps at the start, or reduce the time step.
    """
    run = context.released if context.entry.keeps_energy else context.released_finely
    find_growth(
        result,
        run.energy,
        floor=FLOOR_OF_ENERGY * context.prepared.total_mass * GRAVITY * context.physics.size,
        share=context.settings.energy,
        how="Released without damping",
    )


@engine_check(
    "12",
    title="The time step is small enough",
    fails="The time step is too large",
    severity=Severity.NOTE,
    cause=Cause.PHYSICS,
    feedback=FeedbackRow.EXPORTER,
    needs=(nothing_moves, late),
)
def step_is_small_enough(result: OpenCheck, context: EngineContext) -> None:
    """Falling freely from rest, joints move the same way with a quarter of the time step, within
    engines.step_difference of their motion.

    Why it matters: Where the result depends on the time step, it is an artefact.

    Remedy: Correct masses and inertias of the joint that is named, or simulate with a smaller time step.
    """
    coarse, fine = context.released.q, context.released_finely.q
    count = min(len(coarse), len(fine), round(context.settings.step_seconds / context.simulation.step))
    _find_difference_of_steps(result, context, coarse[:count], fine[:count])


@engine_check(
    "11",
    title="Settles on the floor",
    fails="Does not settle on the floor",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    feedback=FeedbackRow.SINKS,
    needs=(no_geometry, late),
)
def settles_on_the_floor(result: OpenCheck, context: EngineContext) -> None:
    """Make go of engines.drop above a plane with its joints held, the model comes to rest within engines.drop_seconds
    and sinks in by less than engines.sink, that times its size in metres where it is larger than 1 m.

    Why it matters: An object that sinks, trembles or rolls away cannot be placed in a scene.

    Remedy: Give the parts that touch the floor closed collision geometry, and plausible masses.
    """
    dropped = context.dropped
    size = context.physics.size
    find_drop(result, depth=dropped.depth, speed=dropped.speed, size=size, settings=context.settings)


def _find_overlaps(result: OpenCheck, context: EngineContext) -> None:
    """Add a finding for every overlap at rest, and a note about those of pairs that a joint connects."""
    sweep = context.sweep
    overlapping = np.flatnonzero(sweep.at_rest > sweep.tolerance).tolist()
    joined = [k for k in overlapping if tuple(sweep.bodies[k].tolist()) in context.mechanism.neighbours]
    result.measured |= {
        "touching_pairs": float(np.count_nonzero(sweep.at_rest > 0.0)),
        "overlapping_pairs": float(len(overlapping)),
        "deepest": float(sweep.at_rest.max(initial=0.0)),
    }
    for index in overlapping:
        if index not in joined:
            _find_overlap(result, context, index)
    if joined:
        names = ", ".join(
            f"{' and '.join(sweep.pair(k, context.mechanism.links))} {sweep.at_rest[k] * 1e3:.3g} mm" for k in joined
        )
        result.find(
            f"Links that a joint connects overlap at rest: {names}. As much is allowed to them in all other runs, and "
            "what their convex stand-ins can exceed the meshes by.",
            "Nothing needs to be done where a bearing is modelled as solid; else shrink the collision geometry.",
            severity=Severity.NOTE,
        )


def _find_overlap(result: OpenCheck, context: EngineContext, index: int) -> None:
    first, second = pair = context.sweep.pair(index, context.mechanism.links, [0])
    depth = float(context.sweep.at_rest[index])
    real = depth > stand_in_error(context.prepared, pair)
    result.find(
        f"At rest, {first} and {second} overlap by {depth * 1e3:.3g} mm"
        + ("." if real else f", {stand_in_reason(context.prepared, pair)}."),
        f"Move {first} and {second} apart, or shrink their collision geometry."
        if real
        else f"Write convex pieces as collision geometry of {first} and {second}.",
        pair=pair,
        q={travel.joint: travel.rest for travel in context.mechanism.travels},
        value=depth,
        limit=context.sweep.tolerance,
        unit="m",
    )


def _less_one_step(context: EngineContext, released: FloatArray) -> FloatArray:
    """Take back what each leader moves in one step from what it is beyond its limits."""
    lower = np.array([travel.lower for travel in context.mechanism.travels])
    upper = np.array([travel.upper for travel in context.mechanism.travels])
    late = np.abs(np.diff(released, axis=0)).max(axis=0, initial=0.0)
    beyond = released - np.clip(released, lower, upper)
    taken_back: FloatArray = released - np.clip(beyond, -late, late)
    return taken_back


def _find_sag(result: OpenCheck, context: EngineContext, held: FloatArray) -> None:
    """Add a finding for every joint that its servo does not hold.

    Args:
        result: Open, of the engine.
        context: The model.
        held: Values of the leaders while they are held at rest, shape (steps, leaders).
    """
    holding, efforts = context.servos.holding[0], context.efforts
    travels = context.mechanism.travels
    sag = np.abs(held - context.mechanism.rest).max(axis=0)
    ranges = np.array([travel.range for travel in travels])
    result.measured["sag_of_range"] = float(np.max(sag[ranges > 0.0] / ranges[ranges > 0.0], initial=0.0))
    for leader in np.flatnonzero((sag > context.settings.sag * ranges) & (ranges > 0.0)).tolist():
        travel, need, effort = travels[leader], abs(float(holding[leader])), float(efforts[leader])
        unit = "N m" if travel.turns else "N"
        weak = need > 0.9 * effort
        why = f"it takes {need:.3g} {unit} to hold it, its effort is {effort:.3g} {unit}" if weak else "it is pushed"
        result.find(
            f"Held at {travel.rest:.4g} {travel.unit}, joint {travel.joint} moves by {sag[leader]:.3g} {travel.unit}: "
            f"{why}.",
            f"Raise its effort above {1.5 * need:.3g} {unit}, or reduce what it carries."
            if weak
            else "Remove the overlap at rest that pushes it, or raise the effort of the joints that carry it.",
            joint=travel.joint,
            q={travel.joint: travel.rest},
            value=need if weak else sag[leader],
            limit=effort if weak else context.settings.sag * travel.range,
            unit=unit if weak else travel.unit,
        )


def _find_passive_escape(result: OpenCheck, context: EngineContext, released: FloatArray) -> None:
    """Add a finding for every joint that falls through its limit and stays there; stops may yield to a blow.

    Args:
        result: Open, of the engine.
        context: The model.
        released: Values of the leaders without servos, shape (steps, leaders).
    """
    window = round(context.settings.push_seconds / context.simulation.step)
    drift = np.abs(released - context.mechanism.rest).max(axis=0)
    turning = np.array([travel.turns for travel in context.mechanism.travels])
    result.measured["drift_rad"] = float(np.max(drift[turning], initial=0.0))
    result.measured["drift_m"] = float(np.max(drift[~turning], initial=0.0))
    for leader, travel in enumerate(context.mechanism.travels):
        outside = np.maximum(travel.lower - released[:, leader], released[:, leader] - travel.upper)
        windows = np.lib.stride_tricks.sliding_window_view(outside, min(window, len(outside)))
        beyond = float(windows.min(axis=1).max())
        limit = escape_limit(travel, context.settings)
        if travel.limited and travel.range > 0.0 and beyond > limit:
            result.find(
                f"Released, joint {travel.joint} falls {beyond:.3g} {travel.unit} beyond its limit.",
                "Give the part a plausible mass and inertia, and limits that fit its motion.",
                joint=travel.joint,
                value=beyond,
                limit=limit,
                unit=travel.unit,
            )


def escape_limit(travel: Travel, settings: EngineSettings) -> float:
    """Return the excess allowed beyond a limit [rad or m]: a share of the range, and no less than what is visible."""
    return max(settings.escape * travel.range, _VISIBLE_ANGLE if travel.turns else _VISIBLE_LENGTH)


def find_growth(
    result: OpenCheck, energy: FloatArray, *, floor: float, share: float, how: str, reproduction: str | None = None
) -> None:
    """Add a finding if energy grows.

    Args:
        result: Open, of the engine.
        energy: Potential and kinetic energy of a run in which nothing is driven [J], shape (steps, 2).
        floor: Growth that does not count [J].
        share: The same as a fraction of the largest kinetic energy.
        how: The run in a few words.
        reproduction: Code that shows it.
    """
    total, kinetic = energy.sum(axis=1), float(energy[:, 1].max())
    growth, limit = float(np.max(total - total[0])), max(floor, share * kinetic)
    result.measured |= {"growth_J": max(0.0, growth), "kinetic_J": kinetic}
    if growth > limit:
        result.find(
            f"{how}, the model gains {growth:.3g} J, {growth / max(kinetic, 1e-12):.0%} of its largest kinetic energy.",
            "Correct inertia tensors and overlaps at rest, or simulate with a smaller time step.",
            value=growth,
            limit=limit,
            unit="J",
            reproduction=reproduction,
        )


def _find_difference_of_steps(result: OpenCheck, context: EngineContext, coarse: FloatArray, fine: FloatArray) -> None:
    """Add a finding for every joint that moves otherwise with a smaller time step.

    Args:
        result: Open, of the engine.
        context: The model.
        coarse: Values of the leaders, shape (steps, leaders).
        fine: The same at the same times, from smaller steps.
    """
    difference = np.abs(coarse - fine).max(axis=0)
    motion = np.maximum(np.abs(coarse - context.mechanism.rest), np.abs(fine - context.mechanism.rest)).max(axis=0)
    for leader, travel in enumerate(context.mechanism.travels):
        if motion[leader] <= _HARDLY * travel.range:
            continue
        share = float(difference[leader] / motion[leader])
        result.measured["difference"] = max(result.measured.get("difference", 0.0), share)
        if share > context.settings.step_difference:
            result.find(
                f"With a quarter of the time step, joint {travel.joint} moves otherwise by {difference[leader]:.3g} "
                f"{travel.unit}, {share:.0%} of its motion.",
                "Correct masses and inertias of what it carries, or simulate with a smaller time step.",
                joint=travel.joint,
                value=difference[leader],
                limit=context.settings.step_difference * motion[leader],
                unit=travel.unit,
            )


def find_drop(result: OpenCheck, *, depth: float, speed: float, size: float, settings: EngineSettings) -> None:
    """Add findings for a model that does not settle on the floor.

    Args:
        result: Open, of the engine.
        depth: Of its lowest point below the floor at the end [m].
        speed: Of its fastest link at the end [m/s].
        size: Of the model [m].
        settings: Of the engines.
    """
    limit = settings.sink * max(1.0, size)
    result.measured |= {"depth": max(0.0, depth), "speed": speed}
    if depth > limit:
        result.find(
            f"Dropped from {settings.drop * 100:.3g} cm, the model ends up {depth * 1e3:.3g} mm deep in the floor.",
            "Give the parts that touch the floor closed collision geometry, and plausible masses.",
            value=depth,
            limit=limit,
            unit="m",
        )
    if speed > settings.rest_speed:
        result.find(
            f"Dropped from {settings.drop * 100:.3g} cm, the model still moves at {speed:.3g} m/s after "
            f"{settings.drop_seconds:.3g} s.",
            "Nothing to fix where it topples or rolls; else check masses, inertias and overlaps.",
            severity=Severity.NOTE,
            value=speed,
            limit=settings.rest_speed,
            unit="m/s",
        )
