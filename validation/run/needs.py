"""Needs of checks, and what makes each once: file, meshes, geometry, joints, an engine, a robot with its task.

Each is made in a process of its own, and what it is made with is imported there. A check says by the class of its
second argument which of them it looks at.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from kinematify.robot.urdf_text import read_text
from kinematify.simulation.engines import ENGINES
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Status
from kinematify.validation.isolation import Stage
from kinematify.validation.model_cache import cache_model, model_of
from kinematify.validation.run.recorder import Recorder, Subjects
from kinematify.validation.summary import summary_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Sequence

    from kinematify.robot.robot import Robot
    from kinematify.validation.check import Check
    from kinematify.validation.finding import CheckResult, Observation
    from kinematify.validation.geometry.look import JointMotion
    from kinematify.validation.stage import StageRequest
    from kinematify.validation.summary import JointSummary

    Run = Callable[[StageRequest, Recorder], object]

CheckKey = tuple[str, str | None]
"""Id of a check and the engine it runs in."""
_SHOWN = 50
"""Findings per check of the text; what a thousand lines have in common is seen in the first fifty."""


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
    imports = ("kinematify.validation.run.recorder", *imports)
    return Stage(name=name, run=partial(_recorded, run), checks=checks, imports=imports, library=library)


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
