"""Needs of checks, and what makes each once: file, meshes, geometry, joints, an engine, a robot with its task.

Each is made in a process of its own, and what it is made with is imported there. A check says by the class of its
second argument which of them it looks at.
"""

from __future__ import annotations

import time
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from kinematify.robot.urdf_text import read_text
from kinematify.simulation.engines import ENGINES
from kinematify.validation.check import OpenCheck
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import CheckResult, Severity, Status, summary_of
from kinematify.validation.isolation import Stage
from kinematify.validation.stage import cache_model, model_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from kinematify.robot.robot import Robot
    from kinematify.validation.check import Check
    from kinematify.validation.finding import JointSummary, Observation
    from kinematify.validation.geometry.look import JointMotion
    from kinematify.validation.stage import StageRequest

    Run = Callable[[StageRequest, "Recorder"], object]

CheckKey = tuple[str, str | None]
"""Id of a check and the engine it runs in."""
_SHOWN = 50
"""Findings per check of the text; what a thousand lines have in common is seen in the first fifty."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Subjects:
    """Things that some checks look at, one after the other."""

    items: Callable[[], Sequence[object]]
    """Makes them; asked once for each check."""
    nothing: str | None = None
    """Why there are none, so that the checks do not apply."""
    left: Callable[[], str | None] = lambda: None
    """Those that time ran out before."""
    counted: str | None = None
    """Name of their number among what is measured."""


class Recorder:
    """Runs the checks of a stage and passes each result on at once."""

    def __init__(self, tell: Callable[[CheckResult[Observation] | JointSummary], None], request: StageRequest) -> None:
        """Keep where results go and which checks are wanted."""
        self._tell, self._request = tell, request
        self.fatal: set[str] = set()
        """Checks after whose errors nothing else may read the file."""

    def is_selected(self, *checks: str) -> bool:
        """True if at least one of the checks was asked for; work for none of them can be omitted."""
        return any(check in self._request.selected for check in checks)

    @contextmanager
    def _check(self, name: str, engine: str | None) -> Iterator[OpenCheck]:
        """Run one check.

        An exception inside makes the check ``blocked`` with the exception's text, and the stage goes on: a validator
        must survive what it validates.
        """
        check, start = OpenCheck(id=name, engine=engine, source=self._request.source), time.perf_counter()
        try:
            yield check
        except Exception as error:  # the boundary of a check: whatever fails inside is said, not raised
            check.block(f"{type(error).__name__}: {error}")
        if check.is_fatal or check.status is Status.BLOCKED:
            self.fatal.add(name)
        self._tell(_closed(check, time.perf_counter() - start))

    def run(
        self,
        subjects: Mapping[str, Subjects],
        engines: Sequence[str | None] = (None,),
        *,
        most: int | None = None,
        stopped: tuple[Status, str] | None = None,
    ) -> bool:
        """Run all checks of some subjects that were asked for; True if a guard forbids to go on.

        Args:
            subjects: By the class that checks ask for (`Check.subject`).
            engines: In which they run; None: in none.
            most: Findings of a check that are kept.
            stopped: Status and reason of the others where a guard forbids to go on; None: nothing is said of them.
        """
        checks = [check for check in CHECKS.values() if check.subject in subjects and self.is_selected(check.id)]
        for check in sorted(checks, key=lambda check: not check.guard):
            forbidden = not check.guard and self._stopped
            if forbidden and stopped is None:
                break
            for engine in [engine for engine in check.engines or (None,) if engine in engines]:
                with self._check(check.id, engine) as result:
                    if forbidden and stopped is not None:
                        result.status, result.reason = stopped
                    else:
                        self._look(result, subjects[check.subject])
                    if most is not None:
                        _shorten(result, most)
        return self._stopped

    @property
    def _stopped(self) -> bool:
        return any(CHECKS[name].guard for name in self.fatal)

    def _look(self, result: OpenCheck, subjects: Subjects) -> None:
        if subjects.nothing is not None:
            result.skip(subjects.nothing)
            return
        items = subjects.items()
        if subjects.counted is not None:
            result.measured[subjects.counted] = len(items)
        for item in items:
            CHECKS[result.id].run(result, item)
        left = subjects.left()
        if left is not None:
            result.leave(left)

    def summarise(self, summary: JointSummary) -> None:
        """Tell what is known of a joint or a pair; later summaries of the same joint add to earlier ones."""
        self._tell(summary)


def _shorten(result: OpenCheck, most: int) -> None:
    left = len(result.findings) - most
    if left > 0:
        del result.findings[most:]
        result.measured["not_listed"] = left
        result.reason = f"{left} more findings of this kind are not listed"


def _closed(check: OpenCheck, seconds: float) -> CheckResult[Observation]:
    counted = any(finding.severity is not Severity.NOTE for finding in check.findings)
    status = check.status or (Status.FAIL if counted else Status.PASS)
    return CheckResult(
        check=check.id,
        engine=check.engine,
        # What was found before a check was cut short still stands.
        status=Status.FAIL if counted else status,
        reason=check.reason if check.source is None else check.source.reason(check.reason),
        seconds=seconds,
        findings=tuple(check.findings),
        measured=check.measured,
    )


def file(request: StageRequest, recorder: Recorder) -> bool:
    """Check the text of a URDF, before any mesh is opened and any engine sees it; True if others may read it.

    Raises:
        DescriptionError: The file is missing, cannot be opened, or is something else than a URDF.
    """
    from kinematify.validation.document import Urdf

    source = read_text(request.urdf)
    if recorder.run({"UrdfText": Subjects(items=lambda: [source])}, most=_SHOWN) or source.robot is None:
        return False
    urdf = Urdf.of(source.robot, request, source.text)
    recorder.run({"Urdf": Subjects(items=lambda: [urdf])}, most=_SHOWN)
    return not recorder.fatal


def meshes(request: StageRequest, recorder: Recorder) -> Robot | None:
    """Check the mesh files, then what the file declares beside its kinematics; the model, None if it cannot be read.

    A mesh that nothing can use stops everything. The model is left for the later stages.
    """
    from kinematify.validation.asset.mesh_look import MeshContext
    from kinematify.validation.asset.rigid_bodies import measure

    look = MeshContext(request)
    unusable = Status.BLOCKED, "a mesh cannot be used"
    if recorder.run({"MeshContext": Subjects(items=lambda: [look])}, stopped=unusable):
        return None
    cache_model(look.model, request.work)
    if recorder.is_selected(*(name for name, _ in _checks_of("Physics"))):
        physics = measure(look.model, request.settings.physics)
        recorder.run({"Physics": Subjects(items=lambda: [physics])})
    return look.model


def geometry(request: StageRequest, recorder: Recorder) -> None:
    """Look at collision at rest and along the motion by exact geometry, without an engine."""
    from kinematify.geometry.scene import colliding_shapes, read_scene
    from kinematify.validation.geometry.look import BY_FILE, GeometryContext
    from kinematify.validation.srdf_file import srdf_of

    scene = read_scene(model_of(request), request.settings.geometry, colliding_shapes, thin=True)
    srdf = srdf_of(request.urdf.resolve(), scene.model.name, scene.model.link_by_name)
    look = GeometryContext(
        scene,
        seed=request.settings.seed,
        in_time=lambda: request.remaining > 0.0,
        compare_visible=True,
        disabled=dict.fromkeys(request.apart, BY_FILE) if srdf is None else srdf.disabled,
    )
    few = "fewer than two bodies have geometry" if len(scene.bodies) < 2 else None
    fixed = few or (None if scene.travels else "no joint moves")

    def motions() -> Sequence[JointMotion]:
        for sweep in look.sweeps if "motions" not in vars(look) else ():
            recorder.summarise(summary_of(scene.model.joint_by_name[sweep.travel.joint], free_travel=sweep.free))
        return look.motions

    recorder.run(
        {
            "GeometryContext": Subjects(items=lambda: [look], nothing=few),
            "JointMotion": Subjects(items=motions, nothing=fixed, left=lambda: look.left, counted="joints"),
        }
    )
    if fixed is None:
        motions()


def joints(request: StageRequest, recorder: Recorder) -> None:
    """Hold each declared joint against the contact geometry."""
    from kinematify.config import load_config
    from kinematify.validation.joint_case import better_joint, read_cases

    robot, settings = model_of(request), request.settings
    config = load_config("evidence")  # coarser than that of the inference, for the joint is known already
    every = read_cases(robot, config, settings.evidence, request.doubted, seed=settings.seed)
    if not every:
        nothing = Subjects(items=tuple, nothing="no joint moves a body with geometry against another one")
        recorder.run({"JointCase": nothing})
        return
    cases = [case for case in every if request.remaining and (not case.examined or case.measures.posterior)]
    left = len(every) - len(cases)
    of_joints = f"{left} of the joints" if left else None
    recorder.run({"JointCase": Subjects(items=lambda: cases, left=lambda: of_joints, counted="joints")})
    for case in cases:
        joint = robot.joint_by_name[case.measures.joint.source]
        recorder.summarise(summary_of(joint, best_alternative=better_joint(robot, case)))


def engine(request: StageRequest, recorder: Recorder, *, name: str) -> None:
    """Load the untouched file into an engine with its defaults."""
    from kinematify.validation.as_loaded_context import AsLoadedContext

    context = AsLoadedContext(request=request, engine=name)
    recorder.run({"AsLoadedContext": Subjects(items=lambda: [context])}, engines=(name,))


def task(request: StageRequest, recorder: Recorder) -> None:
    """Plan, execute and film how a robot uses the object."""
    from kinematify.validation.task.pull_task import PullTask

    if request.task is None:
        return
    robot = PullTask(request, request.task)
    recorder.run(
        {"PullTask": Subjects(items=lambda: [robot])},
        engines=(None, *request.task_engines),
        stopped=(Status.SKIPPED, "the task cannot be set up, see KV701"),
    )


def keys(checks: Iterable[Check]) -> tuple[CheckKey, ...]:
    """(id, engine) of every result that the checks give."""
    return tuple((check.id, engine) for check in checks for engine in (check.engines or (None,)))


def _checks_of(*subjects: str) -> tuple[CheckKey, ...]:
    return keys(check for check in CHECKS.values() if check.subject in subjects)


def _stage(name: str, run: Run, checks: tuple[CheckKey, ...], *imports: str, library: str | None = None) -> Stage:
    return Stage(name=name, run=partial(_recorded, run), checks=checks, imports=(__name__, *imports), library=library)


def _recorded(run: Run, request: StageRequest, tell: Callable[[CheckResult[Observation] | JointSummary], None]) -> None:
    """Run a stage in its process."""
    run(request, Recorder(tell, request))


def mesh_stage() -> Stage:
    """Meshes and declared physics; what comes later needs readable meshes."""
    imports = "kinematify.validation.asset.rigid_bodies", "kinematify.validation.asset.mesh_look"
    return _stage("asset", meshes, _checks_of("MeshContext", "Physics"), *imports)


def geometry_stage() -> Stage:
    """Exact geometry at rest and in motion."""
    return _stage(
        "geometry", geometry, _checks_of("GeometryContext", "JointMotion"), "kinematify.validation.geometry.look"
    )


def later_stages(chosen: Sequence[str]) -> list[Stage]:
    """What comes after the geometry, which tells how far every joint is free and which ones are in doubt.

    The evidence of the contacts, and the untouched file in each engine.
    """
    evidence = _stage("evidence", joints, _checks_of("JointCase"), "kinematify.validation.joint_case")
    return [evidence] + [
        _stage(
            f"{name} as loaded",
            partial(engine, name=name),
            tuple(key for key in _checks_of("AsLoadedContext") if key[1] == name),
            "kinematify.validation.as_loaded_context",
            library=None if ENGINES[name].prints_when_loaded else ENGINES[name].module,
        )
        for name in chosen
    ]


def task_stage() -> Stage:
    """A robot uses the object; it comes after all others, since it wants to know which joints they doubt."""
    return _stage("task", task, _checks_of("PullTask"))


def stages_of(chosen: Sequence[str]) -> list[Stage]:
    """All stages of a run without a task, in some engines."""
    return [mesh_stage(), geometry_stage(), *later_stages(chosen)]


def needed(stages: Sequence[Stage], selected: Collection[str]) -> list[Stage]:
    """Return the stages that tell a selected check."""
    return [stage for stage in stages if any(check in selected for check, _ in stage.checks)]
