"""KV820 and KV821: a contract for objects, asked for by `--contract`: it rests on a floor, and its motors move it."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from kinematify.simulation.engine import Unloadable
from kinematify.simulation.engine_runs import stand
from kinematify.simulation.engines import open_engine
from kinematify.simulation.world import OpenedFile
from kinematify.validation.check import CauseScope, check
from kinematify.validation.checks.as_loaded import not_loaded, nothing_moves
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.validation.as_loaded_context import AsLoadedContext
    from kinematify.validation.check import OpenCheck

_FLOOR = attrgetter("floor")
_SECONDS = 3.0
"""For which an object is left alone [s]."""
_LIMITS = {"moved": 0.05, "turned": np.radians(5.0), "deepest": 1e-3}
"""How far an object that rests may move [m], turn [rad], and be in what it touches [m]."""


@check(
    "KV820",
    title="Contract: the object rests on a floor",
    fails="Contract: the object does not rest on a floor",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    runs_in=_FLOOR,
)
def rests_on_floor(result: OpenCheck, context: AsLoadedContext) -> None:
    """Only with `--contract`. The unchanged file, its base free, is set on a floor in MuJoCo with its lowest point and
    all joints at rest. After 3 s under gravity it touches the floor, its base has moved by less than 5 cm and turned by
    less than 5 deg, and no contact is deeper than 1 mm.

    Why it matters: An object that falls over, sinks in or jumps when a scene is loaded is of no use.

    Remedy: Write collision geometry where the visible geometry is, and masses and inertias that belong to it.
    """
    request, values = context.request, {} if isinstance(context.loading, Unloadable) else context.values
    file = OpenedFile(urdf=request.native or request.resolved or request.urdf, root=context.robot.root, on_floor=True)
    try:
        run = stand(open_engine(context.engine, file), values, _SECONDS)
    except Unloadable as error:
        result.block(f"MuJoCo does not set it on a floor: {error}")
        return
    result.measured |= run
    if not run["on_floor"] or any(not run[name] < limit for name, limit in _LIMITS.items()):
        result.find(
            f"{_SECONDS:g} s after it was set on a floor in MuJoCo, its base has moved by {run['moved'] * 1e3:.3g} mm "
            f"and turned by {np.degrees(run['turned']):.3g} deg; it has {run['on_floor']:.0f} contacts with the floor, "
            f"and the deepest of all contacts is {run['deepest'] * 1e3:.3g} mm.",
            "Write collision geometry where the visible geometry is, and masses and inertias that belong to it.",
        )


@check(
    "KV821",
    title="Contract: motors move the joints",
    fails="Contract: a motor does not move a joint",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    runs_in=_FLOOR,
    follows={"KV804": CauseScope.JOINT},
    needs=(not_loaded, nothing_moves),
)
def motors_move(result: OpenCheck, context: AsLoadedContext) -> None:
    """Only with `--contract`. Each joint is moved from rest to the farther end of what exact geometry leaves free of
    its range, its followers with it, the others held, under gravity, by no more than its declared effort (the force of
    a hand where none is stated), and gets over as_loaded.reach of that way. A joint of effort 0 has no motor.

    Why it matters: A joint that a hand moves and its own motor does not cannot be used by a controller.

    Remedy: Check the effort, damping and friction of the joint, the masses beyond it, and what collides on its way.
    """
    for travel in context.travels:
        effort = context.robot.joint_by_name[travel.joint].effort
        force = context.strength(travel) if effort is None else effort
        if force <= 0.0:
            continue
        end = max(context.free(travel) or (travel.lower, travel.upper), key=lambda value: abs(value - travel.rest))
        value = context.by_motor(travel, end, force)
        if (value - travel.rest) / (end - travel.rest) < context.settings.reach:
            result.find(
                f"With {force:.3g} {'N m' if travel.turns else 'N'} its motor brings {travel.joint} to {value:.4g} "
                f"{travel.unit} of {end:.4g} {travel.unit} in MuJoCo, under gravity, the others held.",
                f"Check effort, damping and friction of {travel.joint}, the masses beyond it, and what is in its way.",
                joint=travel.joint,
                q={travel.joint: value},
                value=value,
                limit=end,
                unit=travel.unit,
            )
