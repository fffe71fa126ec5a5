"""The MuJoCo checks that need steps: hold, release, drive, push, drop, and what MuJoCo itself said meanwhile."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.engines.configurations import GRAVITY
from kinematify.validation.engines.freely import (
    find_difference_of_steps,
    find_drop,
    find_growth,
    find_passive_escape,
    find_sag,
    usable_efforts,
)
from kinematify.validation.engines.mujoco_drive import drive_all, set_up
from kinematify.validation.engines.mujoco_free import drop, hold_and_release, release_finely
from kinematify.validation.engines.mujoco_measure import measure
from kinematify.validation.engines.mujoco_runs import around_fastest
from kinematify.validation.engines.outcome import (
    Case,
    Driven,
    find_escapes,
    find_penetrations,
    find_unreached,
    tell_curves,
)
from kinematify.validation.engines.run_end import RunEnd, find_unstable
from kinematify.validation.finding import Blame

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.robot.declared import DeclaredModel
    from kinematify.robot.mechanism import Mechanism
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.engines.mujoco_drive import Bench, Session
    from kinematify.validation.engines.mujoco_measure import Measured
    from kinematify.validation.engines.mujoco_model import MujocoModel, Source
    from kinematify.validation.engines.mujoco_runs import Trajectories
    from kinematify.validation.engines.touching import Touching
    from kinematify.validation.stage import OpenCheck, Recorder, StageRequest

ENGINE = "mujoco"
_NOTHING_MOVES = "no joint moves"
_TIME = re.compile(r" Time = ")
_LATE = "time ran out before it"
_FLOOR_OF_ENERGY = 1e-5
"""Growth that does not count, fraction of the energy of a fall of the whole model by its own size."""


@dataclass(kw_only=True, eq=False)
class MujocoWork:
    """What the checks share, filled as they run."""

    request: StageRequest
    declared: DeclaredModel
    prepared: Prepared
    mechanism: Mechanism
    source: Source
    measuring: MujocoModel
    threads: int
    said: list[str]
    """Texts of MuJoCo's own warnings, added to at any time."""
    seen: Measured | None = None
    """Along the sweep of every joint."""
    sweep: Touching | None = None
    """The contacts there."""
    ends: list[RunEnd] = field(default_factory=list)
    """Of all runs so far."""

    @property
    def size(self) -> float:
        """Of the model [m]."""
        return float(max(self.measuring.model.stat.extent, 1e-9))

    def case(self, sweep: Touching) -> Case:
        """Return what findings name."""
        return Case(mechanism=self.mechanism, prepared=self.prepared, sweep=sweep, request=self.request)


def simulate_all(recorder: Recorder, work: MujocoWork, seen: Measured, sweep: Touching) -> None:
    """Tell KV404 to KV412; the checks that gather what all runs gave come last, and they need all runs."""
    gathered = {"KV407", "KV410"}
    bench = _tell_free(recorder, work, seen, sweep)
    if recorder.wants("KV405", "KV406", "KV409", *gathered):
        _tell_driven(recorder, work, bench, seen)
    if recorder.wants("KV411", *gathered):
        _tell_drop(recorder, work, bench)
    _tell_stable(recorder, work)
    _tell_warnings(recorder, work)


def _tell_free(recorder: Recorder, work: MujocoWork, seen: Measured, sweep: Touching) -> Bench | None:
    """KV404, KV408, KV412: from one run that is held and one that is released."""
    bench: Bench | None = None
    runs: Trajectories | None = None
    leaders = [work.mechanism.joints.index(travel.joint) for travel in work.mechanism.travels]
    case = work.case(sweep)
    with recorder.check("KV404", ENGINE) as check:
        bench = set_up(
            work.source,
            work.prepared,
            measuring=work.measuring,
            seen=seen,
            sweep=sweep,
            settings=work.request.settings.engines,
            threads=work.threads,
        )
        if _ready(check, work):
            efforts = usable_efforts(work.declared, work.prepared, work.mechanism)
            runs = hold_and_release(bench, efforts)
            _keep(work, bench, runs)
            held, falling = (runs.q[run, : runs.whole[run]][:, leaders] for run in (0, 1))
            find_sag(check, case, held, holding=bench.servos.holding[0], efforts=efforts)
            window = round(case.settings.push_seconds / case.settings.time_step)
            find_passive_escape(check, case, falling, window=window)
    with recorder.check("KV408", ENGINE) as check:
        if _ready(check, work, runs) and runs is not None:
            floor = _FLOOR_OF_ENERGY * work.prepared.total_mass * GRAVITY * work.size
            find_growth(check, runs.energy[1, : runs.whole[1]], floor, case.settings)
    with recorder.check("KV412", ENGINE) as check:
        if _ready(check, work, runs) and runs is not None and bench is not None:
            fine = release_finely(bench)
            count = min(fine.whole[0] // 4, runs.whole[1])
            coarse, finer = runs.q[1, :count], fine.q[0, 3 : 4 * count : 4]
            find_difference_of_steps(check, case, coarse[:, leaders], finer[:, leaders])
    return bench


def _ready(check: OpenCheck, work: MujocoWork, *needed: object) -> bool:
    """False, with the reason told, if nothing moves, time is over, or what a check needs is not there."""
    if not work.mechanism.travels:
        check.skip(_NOTHING_MOVES)
    elif work.request.remaining <= 0.0:
        check.skip(_LATE)
    elif any(thing is None for thing in needed):
        check.block("the runs that it looks at did not take place")
    else:
        return True
    return False


def _keep(work: MujocoWork, bench: Bench, runs: Trajectories) -> None:
    """Note how the free runs ended and how fast they got."""
    step = float(bench.everything.model.opt.timestep)
    around = np.concatenate([around_fastest(runs, run, bench.inertia) for run in (0, 1)])
    places = measure(bench.measuring, around, dynamic=0, threads=1).T_world_link[..., :3, 3]
    for run, when in enumerate(("it was held at rest", "it was released")):
        moved = np.linalg.norm(places[2 * run + 1] - places[2 * run], axis=1)
        work.ends.append(RunEnd(when=when, speed=float(moved.max()) / step, warnings=runs.warnings[run]))


def _tell_driven(recorder: Recorder, work: MujocoWork, bench: Bench | None, seen: Measured) -> None:
    """KV405, KV406, KV409: from two runs per joint."""
    session: Session | None = None
    with recorder.check("KV405", ENGINE) as check:
        if _ready(check, work, bench) and bench is not None:
            session = drive_all(bench, seen, lambda: work.request.remaining)
            work.ends += _ends(work, session)
            tell_curves(recorder, work.case(session.sweep), session.driven, ENGINE)
            find_unreached(check, work.case(session.sweep), session.driven)
            _say_left(check, session)
    tellers: dict[str, Callable[[OpenCheck, Case, Sequence[Driven]], None]]
    tellers = {"KV406": find_penetrations, "KV409": find_escapes}
    for name, tell in tellers.items():
        with recorder.check(name, ENGINE) as check:
            if session is None:
                _ready(check, work, session)
            else:
                tell(check, work.case(session.sweep), session.driven)
                _say_left(check, session)


def _ends(work: MujocoWork, session: Session) -> list[RunEnd]:
    ends: list[RunEnd] = []
    for item, speed, warnings in zip(session.driven, session.fastest, session.warnings, strict=True):
        travel = work.mechanism.travels[item.drive.leader]
        told = float(np.abs(item.drive.speed).max()) * (work.size if travel.turns else 1.0)
        when = f"{travel.joint} was driven to {item.drive.end:.4g} {travel.unit}"
        ends.append(RunEnd(when=when, speed=speed, warnings=warnings, joint=travel.joint, told=told))
    return ends


def _say_left(check: OpenCheck, session: Session) -> None:
    if session.left:
        check.skip(f"time ran out before {session.left} of the drives")


def _tell_drop(recorder: Recorder, work: MujocoWork, bench: Bench | None) -> None:
    with recorder.check("KV411", ENGINE) as check:
        if not work.measuring.model.ngeom:
            check.skip("no link has geometry")
        elif work.request.remaining <= 0.0:
            check.skip(_LATE)
        elif bench is None:
            check.block("the models for runs could not be set up (KV404)")
        else:
            dropped = drop(bench, work.source)
            work.ends.append(RunEnd(when="it was dropped", speed=dropped.speed, warnings=dropped.warnings))
            find_drop(check, depth=dropped.depth, speed=dropped.speed, settings=bench.settings)


def _tell_stable(recorder: Recorder, work: MujocoWork) -> None:
    """KV407: from the ends of all runs."""
    with recorder.check("KV407", ENGINE) as check:
        if not work.ends:
            _ready(check, work, None)
        find_unstable(check, work.ends, size=work.size, explosion=work.request.settings.engines.explosion)


def _tell_warnings(recorder: Recorder, work: MujocoWork) -> None:
    """KV410: whatever MuJoCo said in all runs."""
    with recorder.check("KV410", ENGINE) as check:
        check.measured["warnings"] = float(len(work.said))
        for text in dict.fromkeys(_TIME.split(text)[0] for text in work.said):
            check.find(f"MuJoCo says: {text}", "Begin with masses, inertias and overlaps.", blame=Blame.PHYSICS)
