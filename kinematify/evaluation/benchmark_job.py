"""One job of the benchmark: an object under a condition, inferred and scored inside a worker process."""

from __future__ import annotations

import hashlib
import importlib
import json
import time
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal, Protocol

from kinematify.assembly.erasure import erase
from kinematify.assembly.part import Assembly
from kinematify.config import Config
from kinematify.evaluation.datasets import BenchObject, Condition
from kinematify.evaluation.metrics import NOTHING_PREDICTED, ObjectScore, Prediction, prediction_of, score_object
from kinematify.pipeline.infer_assembly import peak_mb
from kinematify.processes.pool import sentence
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.assembly.erasure import ErasedModel
    from kinematify.pipeline.inference import Inference
    from kinematify.processes.pool import TaskFailure

INFER = "kinematify.pipeline.infer_assembly:infer"
"""Function under test, as ``module:name``."""

CLEAN = "clean"
"""Parts as they are."""

Status = Literal["ok", "error", "timeout", "crash", "unreadable"]


@dataclass(frozen=True, kw_only=True)
class Job:
    """Input of a worker; small and picklable."""

    item: BenchObject
    condition: Condition
    variant: str
    """Label of the configuration."""
    config: Config
    infer: str = INFER
    input: str = CLEAN
    """`CLEAN`, or what `degrade` does to the parts."""
    degrade: str = ""
    """Function that makes the input, as ``module:name``: (input, parts, config, seed=...) -> `Degraded`."""

    def key(self, code_version: str) -> str:
        """Name of the job's result: equal only where nothing that the result depends on has changed."""
        facts = {
            "object": self.item.name,
            "content": self.item.content_hash,
            "gripper": self.item.gripper_joints,
            "condition": asdict(self.condition),
            "config": self.config.model_dump(mode="json"),
            "infer": self.infer,
            "input": self.input,
            "code": code_version,
        }
        return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()


@dataclass(frozen=True, kw_only=True)
class JobResult:
    """Result of a job."""

    object: str
    kind: str
    category: str
    condition: str
    variant: str
    status: Status
    message: str
    """Why it is not ok; empty otherwise."""
    seconds: float
    """Wall time of the inference alone, or until it was stopped [s]."""
    stage_seconds: dict[str, float] = field(default_factory=dict)
    peak_mb: float | None = None
    """Peak resident memory of the worker [MB]; None where it was stopped from outside."""
    score: ObjectScore | None = None
    """A failed inference is scored as if it had predicted nothing; None where the truth cannot be read."""
    input: str = CLEAN
    """What was done to the meshes."""
    cuts: int = 0
    """Places where a part had been cut in two."""
    cuts_mended: int = 0
    """Cuts whose two sides came out as fixed to each other."""


class Degraded(Protocol):
    """Parts that an inference is given instead of an object's own."""

    assembly: Assembly
    pieces: Mapping[str, str]
    """Name of a piece that was cut off -> the part that it was cut from."""

    def rejoined(self, prediction: Prediction, index: Mapping[str, int]) -> tuple[Prediction, int]:
        """Return a prediction over the parts before they were cut, and how many cuts came out as fixed.

        Args:
            prediction: Over all parts.
            index: Part or piece -> its number in the prediction.
        """


def run_job(job: Job, failure: TaskFailure | None = None) -> JobResult:
    """Pose an object, erase its kinematics, infer from the parts alone, and score the answer.

    Every exception becomes a result, so that one object never ends the run.

    Args:
        job: The object, its condition and the configuration.
        failure: Given where the inference has already taken a process down: it is not run again, and its missing
            answer is scored.
    """
    try:
        erased = erased_item(job.item, job.condition)
        assembly = shown_parts(erased)
        given = degraded(job, assembly)
    except Exception as error:
        return _result(job, "unreadable", sentence(error), _Answer(), None)
    answer = (
        _infer(job, erased, assembly, given)
        if failure is None
        else _Answer(seconds=failure.seconds, message=failure.message)
    )
    status: Status = failure.status if failure is not None else "error" if answer.message else "ok"
    score = score_erased(erased, answer.prediction, gripper_joints=job.item.gripper_joints)
    return replace(_result(job, status, answer.message, answer, score), cuts=0 if given is None else len(given.pieces))


def unscored(job: Job, failure: TaskFailure) -> JobResult:
    """Return the result of a job whose truth cannot be read either."""
    return _result(job, failure.status, failure.message, _Answer(seconds=failure.seconds), None)


def score_erased(erased: ErasedModel, prediction: Prediction, *, gripper_joints: Sequence[str] = ()) -> ObjectScore:
    """Compare a prediction with the joints that were erased; `score_object` says how."""
    return score_object(
        erased.truth,
        prediction,
        centroids=[part.centroid for part in erased.parts],
        part_diagonals=[part.diagonal for part in erased.parts],
        diagonal=erased.assembly.diagonal,
        gripper_joints=gripper_joints,
    )


def erased_item(item: BenchObject, condition: Condition) -> ErasedModel:
    """An object in the pose of a condition, without its kinematics."""
    robot = read_robot(item.urdf, package_dirs=item.package_dirs, geometry="shown")
    return erase(robot, pose=condition.pose, seed=condition.seed, yaw_deg=condition.yaw_deg)


def shown_parts(erased: ErasedModel) -> Assembly:
    """A fresh assembly: whatever erasing noted about names or origin stays behind."""
    return Assembly(parts=erased.parts, source="benchmark")


def degraded(job: Job, assembly: Assembly) -> Degraded | None:
    """Return what the inference of a job is given instead of the parts; None where it is given the parts."""
    if job.input == CLEAN:
        return None
    made: Degraded = imported(job.degrade)(job.input, assembly, job.config, seed=job.condition.seed)
    return made


def predicted(erased: ErasedModel, inference: Inference, given: Degraded | None = None) -> tuple[Prediction, int]:
    """Return an inference by the parts of the truth, and how many cuts it fixed."""
    names = (*erased.truth.part_names, *(given.pieces if given is not None else ()))
    index = {name: number for number, name in enumerate(names)}
    prediction = prediction_of(inference.trees[0], inference.joints, inference.assembly.names, index)
    return (prediction, 0) if given is None else given.rejoined(prediction, index)


@dataclass(frozen=True, kw_only=True)
class _Answer:
    prediction: Prediction = NOTHING_PREDICTED
    seconds: float = 0.0
    stage_seconds: dict[str, float] = field(default_factory=dict)
    message: str = ""
    cuts_mended: int = 0


def _infer(job: Job, erased: ErasedModel, assembly: Assembly, given: Degraded | None) -> _Answer:
    start = time.perf_counter()
    try:
        inference = imported(job.infer)(
            given.assembly if given is not None else assembly, config=job.config, **_known(job, erased)
        )
        seconds = time.perf_counter() - start
        prediction, mended = predicted(erased, inference, given)
    except Exception as error:
        return _Answer(seconds=time.perf_counter() - start, message=sentence(error))
    return _Answer(prediction=prediction, seconds=seconds, stage_seconds=dict(inference.timings), cuts_mended=mended)


def _known(job: Job, erased: ErasedModel) -> dict[str, str]:
    """Return what a method is given beside the parts: the base link, where its configuration takes that as input."""
    if job.config.topology.base_rule != "given":
        return {}
    return {"base": erased.truth.part_names[erased.truth.parents.index(-1)]}


def imported(dotted: str) -> Callable[..., Any]:
    """Return a function by ``module:name``."""
    module, _, name = dotted.partition(":")
    function: Callable[..., Any] = getattr(importlib.import_module(module), name)
    return function


def _result(job: Job, status: Status, message: str, answer: _Answer, score: ObjectScore | None) -> JobResult:
    return JobResult(
        object=job.item.name,
        kind=job.item.kind,
        category=job.item.category,
        condition=job.condition.name,
        variant=job.variant,
        status=status,
        message=message,
        seconds=answer.seconds,
        stage_seconds=answer.stage_seconds,
        peak_mb=None if status in ("timeout", "crash") else peak_mb(),
        score=score,
        input=job.input,
        cuts_mended=answer.cuts_mended,
    )
