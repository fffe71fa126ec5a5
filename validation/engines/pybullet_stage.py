"""The PyBullet stage: load, pose, contacts at rest, hold, drive, push, release, drop; and `poses-pybullet.npz`."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.mechanism import Mechanism
from kinematify.robot.read import read_without_geometry
from kinematify.simulation.prepared import load_prepared
from kinematify.validation.catalogue.engines import CHECKS
from kinematify.validation.engines.configurations import (
    GRAVITY,
    EnginePoses,
    agreement_configurations,
    write_poses,
)
from kinematify.validation.engines.freely import (
    find_difference_of_steps,
    find_drop,
    find_growth,
    find_passive_escape,
    find_sag,
    usable_efforts,
)
from kinematify.validation.engines.loading import compare_with_file
from kinematify.validation.engines.outcome import (
    Case,
    find_escapes,
    find_overlaps,
    find_penetrations,
    find_unreached,
    tell_curves,
)
from kinematify.validation.engines.placed import find_misplaced, link_poses
from kinematify.validation.engines.pybullet_drive import drive_all, set_up
from kinematify.validation.engines.pybullet_free import drop, hold, release, release_finely
from kinematify.validation.engines.pybullet_measure import measure
from kinematify.validation.engines.pybullet_model import Refused, link_masses, load, loaded_model, printed
from kinematify.validation.engines.run_end import RunEnd, find_unstable
from kinematify.validation.engines.touching import touching
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.declared import DeclaredModel
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.engines.outcome import Driven
    from kinematify.validation.engines.pybullet_drive import Bench, Session
    from kinematify.validation.engines.pybullet_free import Free
    from kinematify.validation.engines.pybullet_measure import Measured
    from kinematify.validation.engines.pybullet_model import PybulletModel
    from kinematify.validation.engines.touching import Touching
    from kinematify.validation.stage import OpenCheck, Recorder, StageRequest

ENGINE = "pybullet"
_IDS = tuple(check.id for check in CHECKS if ENGINE in check.engines)
_MAX_JOINTS = 120
"""PyBullet's tables end at 128 degrees of freedom per body; larger models overwrite its memory."""
_FLOOR_OF_ENERGY = 1e-5
"""Growth that does not count, fraction of the energy of a fall of the whole model by its own size."""
_DIVERGED = ("a value is not finite",)
_LATE = "time ran out before it"


def run(request: StageRequest, recorder: Recorder) -> None:
    """Tell all PyBullet checks; see `kinematify.validation.stage`."""
    declared, prepared = read_without_geometry(request.urdf), load_prepared(request.work)
    mechanism = Mechanism(description=declared.kinematics)
    if len(mechanism.joints) > _MAX_JOINTS:
        for name in _IDS:
            with recorder.check(name, ENGINE) as check:
                check.skip(f"PyBullet handles {_MAX_JOINTS} moving joints; the model has {len(mechanism.joints)}")
        return
    work = _Work(request=request, declared=declared, prepared=prepared, mechanism=mechanism)
    _load(recorder, work)
    if work.measuring is None:
        _block(recorder, _IDS[1:], "PyBullet does not load the model as it is in the file (KV501)")
        return
    _compare_poses(recorder, work, work.measuring)
    _look_at_rest(recorder, work, work.measuring)
    if work.bench is None:
        _block(recorder, _IDS[3:], "the contacts at rest could not be measured (KV503)")
        return
    _tell_free(recorder, work, work.bench)
    _tell_driven(recorder, work, work.bench)
    _tell_stable_and_warnings(recorder, work, work.bench)


@dataclass(kw_only=True, eq=False)
class _Work:
    """What the checks share, filled as they run."""

    request: StageRequest
    declared: DeclaredModel
    prepared: Prepared
    mechanism: Mechanism
    measuring: PybulletModel | None = None
    """Everything collides in it; it is only looked at."""
    masses: dict[str, float] = field(default_factory=dict)
    """As PyBullet has them [kg], keyed by link."""
    seen: Measured | None = None
    """Along the sweep of every joint."""
    bench: Bench | None = None
    ends: list[RunEnd] = field(default_factory=list)
    """Of all runs so far."""

    def load(self, *, fixed: bool = True, looking: bool = False) -> PybulletModel:
        """Load into a new world, see `pybullet_model.load`."""
        step = self.request.settings.engines.pybullet_time_step
        return load(self.prepared.urdf, self.mechanism, self.prepared, step=step, fixed=fixed, looking=looking)

    def case(self, sweep: Touching) -> Case:
        """Return what findings name."""
        return Case(mechanism=self.mechanism, prepared=self.prepared, sweep=sweep, request=self.request)


def _load(recorder: Recorder, work: _Work) -> None:
    """Tell KV501, and keep the model in which everything collides."""
    with recorder.check("KV501", ENGINE) as check:
        try:
            fixed, free = work.load(looking=True), work.load(fixed=False)
        except Refused as refusal:
            said = printed(work.request.work / f"{ENGINE}.log") or [str(refusal)]
            check.find(
                f"PyBullet refuses the model: {' '.join(said[-3:])[:400]}",
                "Mend what PyBullet's message names, and the other findings of the file.",
            )
            return
        compare_with_file(
            check, work.declared, work.prepared, loaded_model(fixed, free), work.request.settings.engines.same
        )
        work.masses = link_masses(free)
        free.disconnect()
        if fixed.complete:
            work.measuring = fixed


def _compare_poses(recorder: Recorder, work: _Work, measuring: PybulletModel) -> None:
    """Tell KV502, and leave what the agreement checks compare."""
    request = work.request
    with recorder.check("KV502", ENGINE) as check:
        rows = agreement_configurations(work.declared.kinematics, request.settings.agreement, request.settings.seed)
        seen = measure(measuring, rows.q, dynamic=rows.dynamic)
        find_misplaced(
            check,
            rows,
            ours=link_poses(work.declared.kinematics, rows),
            theirs=seen.T_world_link,
            size=measuring.size,
            settings=request.settings.engines,
        )
        masses = np.array([work.masses.get(name, np.nan) for name in rows.links])
        write_poses(
            request.work,
            ENGINE,
            EnginePoses(
                links=rows.links,
                joints=rows.joints,
                q=rows.q,
                T_world_link=seen.T_world_link,
                masses=masses,
                total_mass=float(np.nansum(masses)),
                mass_matrix=seen.inertia,
                gravity=seen.gravity[: rows.dynamic],
                contacts=np.column_stack([seen.contacts.row, seen.contacts.links]),
                contact_depth=seen.contacts.depth,
            ),
        )


def _look_at_rest(recorder: Recorder, work: _Work, measuring: PybulletModel) -> None:
    """Tell KV503; the contacts along the sweep of every joint are measured here once for all checks."""
    settings = work.request.settings.engines
    with recorder.check("KV503", ENGINE) as check:
        rows = work.mechanism.sweep(settings.sweep_samples)
        seen = measure(measuring, work.mechanism.all_values(rows), dynamic=1)
        sweep = touching(
            seen.contacts,
            work.mechanism,
            work.prepared,
            rows=len(rows),
            tolerance=settings.contact_depth * measuring.size,
        )
        find_overlaps(check, work.case(sweep))
        work.bench = set_up(measuring, work.prepared, seen=seen, sweep=sweep, settings=settings)
        check.measured["switched_off_pairs"] = float(len(work.bench.at_rest))
        if work.bench.at_rest:
            _tell_switched_off(check, work, work.bench)
        work.seen = seen


def _tell_switched_off(check: OpenCheck, work: _Work, bench: Bench) -> None:
    names = sorted(f"{work.mechanism.links[a]} and {work.mechanism.links[b]}" for a, b in bench.at_rest)
    more = f" and {len(names) - 8} more pairs" if len(names) > 8 else ""
    check.find(
        "PyBullet inflates every mesh by 1 mm and knows no overlap that is allowed. These pairs touch at rest that way "
        f"and would be pushed apart, so they do not act on each other while the model moves: {', '.join(names[:8])}"
        f"{more}. How deep they get is measured instead, and a joint stops where they get deeper than allowed.",
        "Nothing needs to be done; for your own simulation leave 2 mm between collision shapes, or filter these pairs.",
        severity=Severity.NOTE,
    )


def _ready(check: OpenCheck, work: _Work, *needed: object) -> bool:
    """False, with the reason told, if nothing moves, time is over, or what a check needs is not there."""
    if not work.mechanism.travels:
        check.skip("no joint moves")
    elif work.request.remaining <= 0.0:
        check.skip(_LATE)
    elif any(thing is None for thing in needed):
        check.block("the runs that it looks at did not take place")
    else:
        return True
    return False


def _tell_free(recorder: Recorder, work: _Work, bench: Bench) -> None:
    """KV504, KV508, KV512: from one run that is held and one that is released."""
    case, model = work.case(bench.sweep), work.load()
    model.act(bench.at_rest, on=False)
    falling: Free | None = None
    with recorder.check("KV504", ENGINE) as check:
        if _ready(check, work):
            efforts = usable_efforts(work.declared, work.prepared, work.mechanism)
            held = _kept(work, "it was held at rest", hold(bench, model, efforts))
            falling = _kept(work, "it was released", release(bench, model))
            if not len(held.q) or not len(falling.q):
                check.block("PyBullet diverged in the first step (KV507)")
                falling = None
            else:
                find_sag(check, case, held.q, holding=bench.servos.holding[0], efforts=efforts)
                find_passive_escape(
                    check, case, _less_one_step(case, falling.q), window=round(case.settings.push_seconds / bench.step)
                )
    fine: Free | None = None
    with recorder.check("KV508", ENGINE) as check:
        if _ready(check, work, falling):
            # PyBullet's integrator gains a tenth in a second of wild motion with its usual step.
            fine = release_finely(bench, model)
            floor = _FLOOR_OF_ENERGY * work.prepared.total_mass * GRAVITY * bench.measuring.size
            find_growth(check, fine.energy, floor, case.settings)
    with recorder.check("KV512", ENGINE) as check:
        if _ready(check, work, falling, fine) and falling is not None and fine is not None:
            count = min(len(fine.q), len(falling.q), round(case.settings.step_seconds / bench.step))
            find_difference_of_steps(check, case, falling.q[:count], fine.q[:count])
    model.disconnect()


def _less_one_step(case: Case, released: FloatArray) -> FloatArray:
    """Take back what each leader moves in one step from what it is beyond its limits.

    PyBullet stops a joint one step after it has passed its limit, and leaves it where it stands then.
    """
    lower = np.array([travel.lower for travel in case.mechanism.travels])
    upper = np.array([travel.upper for travel in case.mechanism.travels])
    late = np.abs(np.diff(released, axis=0)).max(axis=0, initial=0.0)
    beyond = released - np.clip(released, lower, upper)
    taken_back: FloatArray = released - np.clip(beyond, -late, late)
    return taken_back


def _kept(work: _Work, when: str, free: Free) -> Free:
    """Note how a free run ended."""
    work.ends.append(RunEnd(when=when, speed=free.fastest, warnings=_DIVERGED if free.diverged else ()))
    return free


def _tell_driven(recorder: Recorder, work: _Work, bench: Bench) -> None:
    """KV505, KV506, KV509: from two runs per joint."""
    session: Session | None = None
    with recorder.check("KV505", ENGINE) as check:
        if _ready(check, work, work.seen) and work.seen is not None:
            acting = work.load()
            session = drive_all(bench, acting, work.seen, lambda: work.request.remaining)
            acting.disconnect()
            _keep_drives(work, session)
            tell_curves(recorder, work.case(session.sweep), session.driven, ENGINE)
            find_unreached(check, work.case(session.sweep), session.driven)
            _say_left(check, session)
    tellers: dict[str, Callable[[OpenCheck, Case, Sequence[Driven]], None]]
    tellers = {"KV506": find_penetrations, "KV509": find_escapes}
    for name, tell in tellers.items():
        with recorder.check(name, ENGINE) as check:
            if session is None:
                _ready(check, work, session)
            else:
                tell(check, work.case(session.sweep), session.driven)
                _say_left(check, session)


def _keep_drives(work: _Work, session: Session) -> None:
    for leader, speed in session.fastest:
        joint = work.mechanism.travels[leader].joint
        warnings = _DIVERGED if leader in session.diverged else ()
        work.ends.append(RunEnd(when=f"{joint} was driven", speed=speed, warnings=warnings, joint=joint))


def _say_left(check: OpenCheck, session: Session) -> None:
    if session.left:
        check.skip(f"time ran out before {session.left} of the drives")


def _tell_stable_and_warnings(recorder: Recorder, work: _Work, bench: Bench) -> None:
    """KV511, then KV507 and KV510, which gather what all runs gave."""
    with recorder.check("KV511", ENGINE) as check:
        if not any(link.pieces for link in work.prepared.links):
            check.skip("no link has geometry")
        elif work.request.remaining <= 0.0:
            check.skip(_LATE)
        elif recorder.wants("KV511"):
            falling = work.load(fixed=False)
            falling.act(bench.at_rest, on=False)
            end = drop(bench, falling)
            falling.disconnect()
            warnings = _DIVERGED if end.diverged else ()
            work.ends.append(RunEnd(when="it was dropped", speed=end.speed, warnings=warnings))
            find_drop(check, depth=end.depth, speed=end.speed, settings=bench.settings)
    with recorder.check("KV507", ENGINE) as check:
        if work.ends:
            find_unstable(check, work.ends, size=bench.measuring.size, explosion=bench.settings.explosion)
        else:
            _ready(check, work, None)
    with recorder.check("KV510", ENGINE) as check:
        said = list(dict.fromkeys(printed(work.request.work / f"{ENGINE}.log")))
        check.measured["warnings"] = float(len(said))
        for text in said[:10]:
            check.find(f"PyBullet says: {text[:300]}", "Begin with masses, inertias and names of links and joints.")


def _block(recorder: Recorder, names: Iterable[str], reason: str) -> None:
    for name in names:
        with recorder.check(name, ENGINE) as check:
            check.block(reason)
