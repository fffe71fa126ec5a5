"""One job of the benchmark: an object under a condition, inferred and scored inside a worker process."""

from __future__ import annotations

import hashlib
import importlib
import json
import resource
import sys
import time
import traceback
from dataclasses import asdict, dataclass, field, replace
from pathlib import PurePath
from typing import TYPE_CHECKING, Literal

from kinematify.assembly.erase import erase
from kinematify.assembly.part import Assembly
from kinematify.config import Config
from kinematify.evaluation.datasets import BenchObject, Condition
from kinematify.evaluation.metrics import ObjectScore, score_object
from kinematify.evaluation.perturb import CLEAN, perturbed, without_pieces
from kinematify.evaluation.prediction import NOTHING_PREDICTED, prediction_of
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.assembly.erase import ErasedModel
    from kinematify.evaluation.perturb import Perturbed
    from kinematify.evaluation.prediction import Prediction
    from kinematify.pipeline import Inference

INFER = "kinematify.pipeline:infer"
"""Function under test, as ``module:name``."""

Status = Literal["ok", "error", "timeout", "crash", "unreadable"]


@dataclass(frozen=True, kw_only=True)
class Job:
    """What a worker is given; small and picklable."""

    item: BenchObject
    condition: Condition
    variant: str
    """Label of the configuration."""
    config: Config
    infer: str = INFER
    input: str = CLEAN
    """`CLEAN`, or one of `kinematify.evaluation.perturb.DEGRADED`."""

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
    """What came of a job."""

    key: str
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


@dataclass(frozen=True, kw_only=True)
class Failure:
    """How an inference ended that gave no answer."""

    status: Status
    message: str
    seconds: float


def run_job(job: Job, *, key: str, failure: Failure | None = None) -> JobResult:
    """Pose an object, erase its kinematics, infer from the parts alone, and score the answer.

    Every exception becomes a result, so that one object never ends the run.

    Args:
        job: The object, its condition and the configuration.
        key: Name under which the result is filed.
        failure: Given where the inference has already taken a worker down: it is not run again, and its missing
            answer is scored.
    """
    try:
        erased = erased_model(job)
        given = perturbed(job.input, shown_parts(erased), job.config, seed=job.condition.seed)
    except Exception as error:
        return unscored(job, key, Failure(status="unreadable", message=_sentence(error), seconds=0.0))
    answer = _Answer() if failure is not None else _infer(job, erased, given)
    failure = failure or answer.failure
    score = score_object(
        erased.truth,
        answer.prediction,
        centroids=[part.centroid for part in erased.parts],
        diagonal=erased.assembly.diagonal,
        gripper_joints=job.item.gripper_joints,
    )
    return replace(_result(job, key, failure, answer, score), cuts=len(given.pieces))


def erased_model(job: Job) -> ErasedModel:
    """The object in the pose of its condition, without its kinematics."""
    robot = read_robot(job.item.urdf, package_dirs=job.item.package_dirs, geometry="shown")
    condition = job.condition
    return erase(robot, pose=condition.pose, seed=condition.seed, yaw_deg=condition.yaw_deg)


@dataclass(frozen=True, kw_only=True)
class _Answer:
    prediction: Prediction = NOTHING_PREDICTED
    seconds: float = 0.0
    stage_seconds: dict[str, float] = field(default_factory=dict)
    failure: Failure | None = None
    cuts_mended: int = 0


def shown_parts(erased: ErasedModel) -> Assembly:
    """A fresh assembly: whatever erasing noted about names or origin stays behind."""
    return Assembly(parts=erased.parts, source="benchmark")


def _infer(job: Job, erased: ErasedModel, given: Perturbed) -> _Answer:
    infer = _function(job.infer)
    start = time.perf_counter()
    try:
        inference = infer(given.assembly, config=given.config)
        seconds = time.perf_counter() - start
        part_index = {name: index for index, name in enumerate((*erased.truth.part_names, *given.pieces))}
        prediction = prediction_of(inference.trees[0], inference.joints, inference.assembly.names, part_index)
        pieces = {part_index[piece]: part_index[whole] for piece, whole in given.pieces.items()}
        prediction, mended = without_pieces(prediction, pieces)
    except Exception as error:
        seconds = time.perf_counter() - start
        return _Answer(seconds=seconds, failure=Failure(status="error", message=_sentence(error), seconds=seconds))
    return _Answer(prediction=prediction, seconds=seconds, stage_seconds=dict(inference.timings), cuts_mended=mended)


def _function(dotted: str) -> Callable[..., Inference]:
    module, _, name = dotted.partition(":")
    function: Callable[..., Inference] = getattr(importlib.import_module(module), name)
    return function


def _sentence(error: Exception) -> str:
    place = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({place.name}, line {place.lineno} of {PurePath(place.filename).name})"


def unscored(job: Job, key: str, failure: Failure) -> JobResult:
    """Return the result of a job whose truth cannot be read either."""
    return _result(job, key, failure, _Answer(), None)


def _result(job: Job, key: str, failure: Failure | None, answer: _Answer, score: ObjectScore | None) -> JobResult:
    stopped = failure is not None and failure.status in ("timeout", "crash")
    return JobResult(
        key=key,
        object=job.item.name,
        kind=job.item.kind,
        category=job.item.category,
        condition=job.condition.name,
        variant=job.variant,
        status="ok" if failure is None else failure.status,
        message="" if failure is None else failure.message,
        seconds=answer.seconds if failure is None else failure.seconds,
        stage_seconds=answer.stage_seconds,
        peak_mb=None if stopped else _peak_mb(),
        score=score,
        input=job.input,
        cuts_mended=answer.cuts_mended,
    )


def _peak_mb() -> float:
    """Peak resident memory of this process [MB]; the kernel counts kB on Linux and bytes on macOS."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 2**20 if sys.platform == "darwin" else peak / 2**10
