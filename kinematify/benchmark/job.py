"""One job of the benchmark: an object under a condition, inferred and scored inside a worker process."""

from __future__ import annotations

import hashlib
import importlib
import json
import resource
import sys
import time
import traceback
from dataclasses import asdict, dataclass, field
from pathlib import PurePath
from typing import TYPE_CHECKING, Literal

from kinematify.assembly.description import read_description
from kinematify.assembly.erase import erase
from kinematify.assembly.part import Assembly
from kinematify.benchmark.datasets import BenchObject, Condition
from kinematify.benchmark.metrics import ObjectScore, score_object
from kinematify.benchmark.prediction import NOTHING_PREDICTED, prediction_of
from kinematify.config import Config

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.assembly.erase import ErasedModel
    from kinematify.benchmark.prediction import Prediction
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

    def key(self, code_version: str) -> str:
        """Name of the job's result: equal only where nothing that the result depends on has changed."""
        facts = {
            "object": self.item.name,
            "content": self.item.content_hash,
            "gripper": self.item.gripper_joints,
            "condition": asdict(self.condition),
            "config": self.config.model_dump(mode="json"),
            "infer": self.infer,
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
        erased = _erased(job)
    except Exception as error:
        return unscored(job, key, Failure(status="unreadable", message=_sentence(error), seconds=0.0))
    answer = _Answer() if failure is not None else _infer(job, erased)
    failure = failure or answer.failure
    score = score_object(
        erased.truth,
        answer.prediction,
        centroids=[part.centroid for part in erased.parts],
        diagonal=erased.assembly.diagonal,
        gripper_joints=job.item.gripper_joints,
    )
    return _result(job, key, failure, answer, score)


def _erased(job: Job) -> ErasedModel:
    description = read_description(job.item.urdf, package_dirs=job.item.package_dirs)
    condition = job.condition
    return erase(description, pose=condition.pose, seed=condition.seed, yaw_deg=condition.yaw_deg)


@dataclass(frozen=True, kw_only=True)
class _Answer:
    prediction: Prediction = NOTHING_PREDICTED
    seconds: float = 0.0
    stage_seconds: dict[str, float] = field(default_factory=dict)
    failure: Failure | None = None


def _infer(job: Job, erased: ErasedModel) -> _Answer:
    infer = _function(job.infer)
    # A fresh assembly: whatever erasing noted about names or origin stays behind.
    shown = Assembly(parts=erased.parts, source="benchmark")
    start = time.perf_counter()
    try:
        inference = infer(shown, config=job.config)
        seconds = time.perf_counter() - start
        part_index = {name: index for index, name in enumerate(erased.truth.part_names)}
        prediction = prediction_of(inference.trees[0], inference.joints, inference.assembly.names, part_index)
    except Exception as error:
        seconds = time.perf_counter() - start
        return _Answer(seconds=seconds, failure=Failure(status="error", message=_sentence(error), seconds=seconds))
    return _Answer(prediction=prediction, seconds=seconds, stage_seconds=dict(inference.timings))


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
    )


def _peak_mb() -> float:
    """Peak resident memory of this process [MB]; the kernel counts kB on Linux and bytes on macOS."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 2**20 if sys.platform == "darwin" else peak / 2**10
