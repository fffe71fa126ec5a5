"""Validating many models on several processes, resumable: what has been done stands in a file of JSON lines."""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import TYPE_CHECKING, Any

import kinematify
from kinematify.config.validation import load_settings
from kinematify.evaluation.studies.mutants.outcome import facts
from kinematify.validation.catalogue import CATALOGUE
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

Result = dict[str, Any]
"""name, seconds, findings, blocked."""

FILE_FAMILIES = ("KV1", "KV2")
MOTION_FAMILIES = ("KV1", "KV2", "KV3")


def code_version() -> str:
    """Hash of the package with its settings: what another version has said does not count."""
    digest = hashlib.sha256()
    root = Path(kinematify.__file__).parent
    for folder in (root, root / "validation", root / "configs"):
        for path in sorted([*folder.rglob("*.py"), *folder.rglob("*.yaml")]):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def validated(jobs: Sequence[tuple[str, str, tuple[str, ...]]], ledger: Path, workers: int) -> Iterator[Result]:
    """Yield the result of every job (name, URDF, families of checks), those in the ledger first."""
    done = _read(ledger)
    yield from (done[name] for name, _, _ in jobs if name in done)
    left = [job for job in jobs if job[0] not in done]
    # Not a pool of `multiprocessing`, whose processes must not start others, as validation does.
    context = multiprocessing.get_context("spawn")
    with ledger.open("a", encoding="utf-8") as file, ProcessPoolExecutor(workers, mp_context=context) as pool:
        for future in as_completed([pool.submit(_run, job) for job in left]):
            result = future.result()
            file.write(json.dumps(result) + "\n")
            file.flush()
            yield result


def _read(ledger: Path) -> dict[str, Result]:
    if not ledger.is_file():
        return {}
    results = [json.loads(line) for line in ledger.read_text(encoding="utf-8").splitlines() if line.endswith("}")]
    return {result["name"]: result for result in results}


def _run(job: tuple[str, str, tuple[str, ...]]) -> Result:
    name, urdf, families = job
    selected = [check for check in CATALOGUE if check.startswith(families)]
    start = time.perf_counter()
    report = validate(urdf, settings=load_settings(), selected=selected, engines=(), workers=1)
    blocked = [check.check for check in report.checks if check.status.value == "blocked" and check.check in selected]
    return {"name": name, "seconds": time.perf_counter() - start, "findings": facts(report), "blocked": blocked}
