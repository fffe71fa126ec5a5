"""Findings of runs in which nothing is driven: sag, escape, energy, the time step, the drop; whatever the engine."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.simulation.prepared import Method
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.declared import DeclaredModel
    from kinematify.robot.mechanism import Mechanism
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.engines.outcome import Case
    from kinematify.validation.stage import OpenCheck

_HARDLY = 0.02
"""Motion that is too small to say anything, fraction of the range."""


def usable_efforts(declared: DeclaredModel, prepared: Prepared, mechanism: Mechanism) -> FloatArray:
    """Return the declared effort of every leader [N m or N]; infinite where none is declared or masses are made up."""
    efforts = np.full(len(mechanism.travels), np.inf)
    for leader, travel in enumerate(mechanism.travels):
        effort = declared.joint_by_name[travel.joint].effort
        carried = mechanism.moved[leader][mechanism.body_of_link]
        made_up = any(
            prepared.link_by_name[name].mass_added
            for name, moves in zip(mechanism.links, carried, strict=True)
            if moves and prepared.link_by_name[name].method is not Method.NONE
        )
        if effort is not None and effort > 0.0 and not made_up:
            efforts[leader] = effort
    return efforts


def find_sag(check: OpenCheck, case: Case, held: FloatArray, *, holding: FloatArray, efforts: FloatArray) -> None:
    """Add a finding for every joint that its servo does not hold.

    Args:
        check: Open, of the engine.
        case: The model.
        held: Values of the leaders while they are held at rest, shape (steps, leaders).
        holding: What holds each at rest [N m or N], shape (leaders,).
        efforts: From `usable_efforts`, shape (leaders,).
    """
    travels = case.mechanism.travels
    sag = np.abs(held - case.mechanism.rest).max(axis=0)
    ranges = np.array([travel.range for travel in travels])
    check.measured["sag_of_range"] = float(np.max(sag[ranges > 0.0] / ranges[ranges > 0.0], initial=0.0))
    for leader in np.flatnonzero((sag > case.settings.sag * ranges) & (ranges > 0.0)).tolist():
        travel, need, effort = travels[leader], abs(float(holding[leader])), float(efforts[leader])
        unit = "N m" if travel.turns else "N"
        weak = need > 0.9 * effort
        why = f"it takes {need:.3g} {unit} to hold it, its effort is {effort:.3g} {unit}" if weak else "it is pushed"
        check.find(
            f"Held at {travel.rest:.4g} {travel.unit}, joint {travel.joint} moves by {sag[leader]:.3g} {travel.unit}: "
            f"{why}.",
            f"Raise its effort above {1.5 * need:.3g} {unit}, or reduce what it carries."
            if weak
            else "Remove the overlap at rest that pushes it, or raise the effort of the joints that carry it.",
            joint=travel.joint,
            q={travel.joint: travel.rest},
            value=need if weak else sag[leader],
            limit=effort if weak else case.settings.sag * travel.range,
            unit=unit if weak else travel.unit,
        )


def find_passive_escape(check: OpenCheck, case: Case, released: FloatArray, *, window: int) -> None:
    """Add a finding for every joint that falls through its limit and stays there; stops may yield to a blow.

    Args:
        check: Open, of the engine.
        case: The model.
        released: Values of the leaders without servos, shape (steps, leaders).
        window: Steps for which it must stay beyond.
    """
    drift = np.abs(released - case.mechanism.rest).max(axis=0)
    turning = np.array([travel.turns for travel in case.mechanism.travels])
    check.measured["drift_rad"] = float(np.max(drift[turning], initial=0.0))
    check.measured["drift_m"] = float(np.max(drift[~turning], initial=0.0))
    for leader, travel in enumerate(case.mechanism.travels):
        outside = np.maximum(travel.lower - released[:, leader], released[:, leader] - travel.upper)
        windows = np.lib.stride_tricks.sliding_window_view(outside, min(window, len(outside)))
        beyond = float(windows.min(axis=1).max())
        if travel.limited and travel.range > 0.0 and beyond > case.settings.escape * travel.range:
            check.find(
                f"Released, joint {travel.joint} falls {beyond:.3g} {travel.unit} beyond its limit.",
                "Give the part a plausible mass and inertia, and limits that fit its motion.",
                joint=travel.joint,
                value=beyond,
                limit=case.settings.escape * travel.range,
                unit=travel.unit,
            )


def find_growth(check: OpenCheck, energy: FloatArray, floor: float, settings: EngineSettings) -> None:
    """Add a finding if energy grows.

    Args:
        check: Open, of the engine.
        energy: Potential and kinetic energy of an undamped run [J], shape (steps, 2).
        floor: Growth that does not count [J].
        settings: Of the engines.
    """
    total, kinetic = energy.sum(axis=1), float(energy[:, 1].max())
    growth = float(np.max(total - total[0]))
    check.measured |= {"growth_J": max(0.0, growth), "kinetic_J": kinetic}
    if growth > max(floor, settings.energy * kinetic):
        check.find(
            f"Released without damping, the model gains {growth:.3g} J, {growth / max(kinetic, 1e-12):.0%} of its "
            f"largest kinetic energy.",
            "Correct inertia tensors and overlaps at rest, or simulate with a smaller time step.",
            value=growth,
            limit=max(floor, settings.energy * kinetic),
            unit="J",
        )


def find_difference_of_steps(check: OpenCheck, case: Case, coarse: FloatArray, fine: FloatArray) -> None:
    """Add a finding for every joint that moves otherwise with a smaller time step.

    Args:
        check: Open, of the engine.
        case: The model.
        coarse: Values of the leaders, shape (steps, leaders).
        fine: The same at the same times, from smaller steps.
    """
    difference = np.abs(coarse - fine).max(axis=0)
    motion = np.maximum(np.abs(coarse - case.mechanism.rest), np.abs(fine - case.mechanism.rest)).max(axis=0)
    for leader, travel in enumerate(case.mechanism.travels):
        if motion[leader] <= _HARDLY * travel.range:
            continue
        share = float(difference[leader] / motion[leader])
        check.measured["difference"] = max(check.measured.get("difference", 0.0), share)
        if share > case.settings.step_difference:
            check.find(
                f"With a quarter of the time step, joint {travel.joint} moves otherwise by {difference[leader]:.3g} "
                f"{travel.unit}, {share:.0%} of its motion.",
                "Correct masses and inertias of what it carries, or simulate with a smaller time step.",
                joint=travel.joint,
                value=difference[leader],
                limit=case.settings.step_difference * motion[leader],
                unit=travel.unit,
            )


def find_drop(check: OpenCheck, *, depth: float, speed: float, settings: EngineSettings) -> None:
    """Add findings for a model that does not settle on the floor.

    Args:
        check: Open, of the engine.
        depth: Of its lowest point below the floor at the end [m].
        speed: Of its fastest link at the end [m/s].
        settings: Of the engines.
    """
    check.measured |= {"depth": max(0.0, depth), "speed": speed}
    if depth > settings.sink:
        check.find(
            f"Dropped from {settings.drop * 100:.3g} cm, the model ends up {depth * 1e3:.3g} mm deep in the floor.",
            "Give the parts that touch the floor closed collision geometry, and plausible masses.",
            value=depth,
            limit=settings.sink,
            unit="m",
        )
    if speed > settings.rest_speed:
        check.find(
            f"Dropped from {settings.drop * 100:.3g} cm, the model still moves at {speed:.3g} m/s after "
            f"{settings.drop_seconds:.3g} s.",
            "Nothing to mend where it topples or rolls; else check masses, inertias and overlaps.",
            severity=Severity.NOTE,
            value=speed,
            limit=settings.rest_speed,
            unit="m/s",
        )
