"""The ablation of the refinement: every object inferred once, and refined by every tier, clean and perturbed."""

from __future__ import annotations

import hashlib
import json
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import asdict, dataclass
from multiprocessing import active_children, get_context
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import TypeAdapter

from kinematify.assembly.erase import erase
from kinematify.assembly.part import Assembly
from kinematify.config import Config
from kinematify.evaluation.datasets import BenchObject, Condition
from kinematify.evaluation.ledger import Ledger, code_version
from kinematify.evaluation.metrics import ObjectScore, score_object
from kinematify.evaluation.perturb import CLEAN, perturbed, without_pieces
from kinematify.evaluation.prediction import prediction_of
from kinematify.evaluation.run import selected_conditions, selected_objects
from kinematify.pipeline import infer
from kinematify.refinement import refine
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from kinematify.assembly.erase import ErasedModel
    from kinematify.evaluation.perturb import Perturbed
    from kinematify.evaluation.run import BenchmarkRequest
    from kinematify.pipeline import Inference

OFF = "no feedback"


@dataclass(frozen=True, kw_only=True)
class RefiningJob:
    """One object, perturbed or not, refined by some tiers."""

    item: BenchObject
    condition: Condition
    perturbation: str
    tiers: tuple[str, ...]
    config: Config

    def key(self, code_version: str) -> str:
        """Name of the result: equal only where nothing that it depends on has changed."""
        facts = {
            "object": self.item.name,
            "content": self.item.content_hash,
            "condition": asdict(self.condition),
            "perturbation": self.perturbation,
            "tiers": self.tiers,
            "config": self.config.model_dump(mode="json"),
            "code": code_version,
        }
        return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()


@dataclass(frozen=True, kw_only=True)
class TierResult:
    """The answer of one tier."""

    tier: str
    """`OFF`, or one of `kinematify.refinement.tiers.TIERS`."""
    score: ObjectScore
    seconds: float
    """Of the inference and the refinement together [s]."""
    errors: int
    """Errors about motion in the model, by the exact geometry."""
    changes: tuple[str, ...]
    """What was chosen anew in the round that was kept."""


@dataclass(frozen=True, kw_only=True)
class RefiningResult:
    """What came of a job."""

    key: str
    object: str
    kind: str
    condition: str
    perturbation: str
    message: str
    """Why there is no answer; empty otherwise."""
    tiers: tuple[TierResult, ...]


RESULT = TypeAdapter(RefiningResult)


def run_refining(jobs: Sequence[tuple[str, RefiningJob]], *, workers: int) -> Iterator[RefiningResult]:
    """Yield the result of every job as it finishes; a crash ends the jobs that were under way."""
    waiting = list(jobs)
    while waiting:
        done: set[str] = set()
        with ProcessPoolExecutor(workers, mp_context=get_context("forkserver"), max_tasks_per_child=1) as pool:
            futures = {pool.submit(run_one, job, key): (key, job) for key, job in waiting}
            try:
                for future in as_completed(futures):
                    key, job = futures[future]
                    try:
                        result = future.result()
                    except BrokenProcessPool:
                        result = _failed(job, key, "a worker crashed")
                    done.add(key)
                    yield result
            except (KeyboardInterrupt, GeneratorExit):
                pool.shutdown(wait=False, cancel_futures=True)
                for process in active_children():  # leaving the pool would wait for what is under way
                    process.kill()
                raise
        waiting = [(key, job) for key, job in waiting if key not in done]


def run_one(job: RefiningJob, key: str) -> RefiningResult:
    """Infer and refine one object; an exception becomes a result."""
    try:
        robot = read_robot(job.item.urdf, package_dirs=job.item.package_dirs, geometry="shown")
        condition = job.condition
        erased = erase(robot, pose=condition.pose, seed=condition.seed, yaw_deg=condition.yaw_deg)
        given = perturbed(
            job.perturbation, Assembly(parts=erased.parts, source="benchmark"), job.config, seed=condition.seed
        )
        return _result(job, key, _tiers(job, erased, given))
    except Exception as error:  # one object never ends the run
        return _failed(job, key, f"{type(error).__name__}: {error}")


def _tiers(job: RefiningJob, erased: ErasedModel, given: Perturbed) -> tuple[TierResult, ...]:
    start = time.perf_counter()
    inference = infer(given.assembly, config=given.config, graph=given.graph)
    seconds = time.perf_counter() - start
    score = _score(job, erased, given, inference)
    found: list[TierResult] = []
    for tier in job.tiers:
        start = time.perf_counter()
        refinement = refine(inference, tier=tier)
        spent = time.perf_counter() - start
        history = refinement.history
        if not found:
            errors = history.rounds[0].motion_errors
            found.append(TierResult(tier=OFF, score=score, seconds=seconds, errors=errors, changes=()))
        found.append(
            TierResult(
                tier=tier,
                score=_score(job, erased, given, refinement.inference),
                seconds=seconds + spent,
                errors=history.rounds[history.kept].motion_errors,
                changes=tuple(f"{item.part}: {item.what} {item.before} -> {item.after}" for item in history.changed),
            )
        )
    return tuple(found)


def _score(job: RefiningJob, erased: ErasedModel, given: Perturbed, inference: Inference) -> ObjectScore:
    index = {name: number for number, name in enumerate(erased.truth.part_names)}
    for number, name in enumerate(given.pieces):
        index[name] = len(erased.truth.part_names) + number
    prediction = prediction_of(inference.trees[0], inference.joints, inference.assembly.names, index)
    pieces = {index[piece]: index[main] for piece, main in given.pieces.items()}
    return score_object(
        erased.truth,
        without_pieces(prediction, pieces)[0],
        centroids=[part.centroid for part in erased.parts],
        diagonal=erased.assembly.diagonal,
        gripper_joints=job.item.gripper_joints,
    )


def _result(job: RefiningJob, key: str, tiers: tuple[TierResult, ...], message: str = "") -> RefiningResult:
    return RefiningResult(
        key=key,
        object=job.item.name,
        kind=job.item.kind,
        condition=job.condition.name,
        perturbation=job.perturbation,
        message=message,
        tiers=tiers,
    )


def _failed(job: RefiningJob, key: str, message: str) -> RefiningResult:
    return _result(job, key, (), message)


def run_refining_benchmark(
    request: BenchmarkRequest,
    *,
    tiers: Sequence[str],
    perturbations: Sequence[str],
    progress: Callable[[str, float], None] | None = None,
) -> tuple[RefiningResult, ...]:
    """Run the ablation, taking up what an earlier run with the same code and configuration has finished.

    Args:
        request: Objects, conditions, configuration (the first variant) and where to work.
        tiers: Of `kinematify.refinement.tiers.TIERS`; perturbed input is refined by the first alone.
        perturbations: `CLEAN` and some of `perturb.PERTURBATIONS`.
        progress: Told what has just finished and the fraction done.

    Raises:
        InputError: There is no such data, object or condition.
        OutputError: The work folder cannot be written.
    """
    config = request.variants[0].load()
    jobs = [
        RefiningJob(
            item=item,
            condition=condition,
            perturbation=perturbation,
            tiers=tuple(tiers) if perturbation == CLEAN else tuple(tiers[:1]),
            config=config,
        )
        for perturbation in perturbations
        for item in selected_objects(request)
        for condition in selected_conditions(request)
    ]
    version_hash = _code_version()
    keyed = [(job.key(version_hash), job) for job in jobs]
    with Ledger(request.work_folder / "refining.jsonl", RESULT) as ledger:
        if request.fresh:
            ledger.clear()
        results = ledger.read()
        missing = [(key, job) for key, job in keyed if key not in results]
        for result in run_refining(missing, workers=request.workers):
            ledger.append(result)
            results[result.key] = result
            if progress is not None:
                done = sum(key in results for key, _ in keyed) / len(keyed)
                progress(
                    f"{result.object}, {result.perturbation}{': ' if result.message else ''}{result.message}", done
                )
    return tuple(results[key] for key, _ in keyed)


def _code_version() -> str:
    """Hash of all sources that a refinement depends on; the checks of the validation are among them."""
    digest = hashlib.sha256(code_version().encode())
    package = Path(__file__).resolve().parents[1]
    for folder in ("refinement", "validation"):
        for path in sorted((package / folder).rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()
