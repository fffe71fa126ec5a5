"""The verdict of `kinematify validate` on a model before anybody trains on it; kept between runs."""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify import __version__
from kinematify.envs.bundled import FAMILY_PREFIX, PREFIX
from kinematify.errors import EnvironmentFault, InputError
from kinematify.geometry.cut_cache import cache_folder

if TYPE_CHECKING:
    from kinematify.envs.articulated_object import ArticulatedObject

_CHECKS = "KV1*,KV2*,KV30*,KV31*,KV801,KV803,KV804"
"""File, declared physics, overlap at rest and along the motion, loading and moving in an engine."""
_SHOWN = 3
_KEPT = 500


def require_valid(articulated_object: ArticulatedObject, engine: str, *, allow_invalid: bool) -> str:
    """Return the verdict on a model: ``pass``, ``warn``, ``fail``, or ``bundled`` for objects of the package.

    Args:
        articulated_object: The model.
        engine: That it will run in.
        allow_invalid: Take it even if it fails.

    Raises:
        InputError: It fails; the message names the worst findings.
        EnvironmentFault: The validation itself failed.
    """
    if articulated_object.source.startswith((PREFIX, FAMILY_PREFIX)):
        return "bundled"
    verdict, errors = _verdict(articulated_object, engine)
    if verdict == "fail" and not allow_invalid:
        more = f" and {len(errors) - _SHOWN} more" if len(errors) > _SHOWN else ""
        raise InputError(
            f"The model {articulated_object.source} does not pass kinematify validate: "
            f"{' '.join(errors[:_SHOWN])}{more} Fix it "
            "(kinematify validate shows all findings with remedies), or pass allow_invalid=True to train on it anyway."
        )
    return verdict


def content_digest(articulated_object: ArticulatedObject) -> str:
    """Digest of the URDF and of all meshes that it names."""
    bundled = articulated_object.source.startswith((PREFIX, FAMILY_PREFIX))  # each process writes it in another folder
    place = articulated_object.source if bundled else articulated_object.urdf
    digest = hashlib.sha256(f"{__version__} {place}".encode() + articulated_object.urdf.read_bytes())
    for link in articulated_object.declared.links:
        for shape in (*link.visuals, *link.collisions):
            digest.update(shape.mesh.vertices.tobytes())
            digest.update(shape.mesh.faces.tobytes())
    return digest.hexdigest()


def kept(folder: str, digest: str) -> dict[str, object] | None:
    """Return what an earlier run has kept, or None."""
    with suppress(OSError, ValueError):
        found = json.loads((cache_folder().parent / folder / f"{digest}.json").read_text(encoding="utf-8"))
        return found if isinstance(found, dict) else None
    return None


def tell(text: str) -> None:
    """Write a line of progress before what takes seconds; workers of AsyncVectorEnv leave it to their parent."""
    if multiprocessing.parent_process() is None:
        sys.stderr.write(f"kinematify: {text}\n")
        sys.stderr.flush()


def keep(folder: str, digest: str, facts: dict[str, object]) -> None:
    """Keep facts for later runs; a full or read-only disk costs time only."""
    place = cache_folder().parent / folder
    with suppress(OSError):
        place.mkdir(parents=True, exist_ok=True)
        partly = place / f"{digest}.{os.getpid()}.part"
        partly.write_text(json.dumps(facts), encoding="utf-8")
        partly.replace(place / f"{digest}.json")
        oldest_first = sorted(place.glob("*.json"), key=lambda item: item.stat().st_mtime)
        for item in oldest_first[: max(0, len(oldest_first) - _KEPT)]:
            item.unlink(missing_ok=True)


def _verdict(articulated_object: ArticulatedObject, engine: str) -> tuple[str, list[str]]:
    """Verdict and the messages of its errors."""
    digest = hashlib.sha256(f"{content_digest(articulated_object)} {engine}".encode()).hexdigest()
    known = kept("verdicts", digest)
    if known is None:
        tell(f"validating {articulated_object.source} in {engine}; it takes seconds, once for a model")
        known = _validated(articulated_object.urdf, engine)
        keep("verdicts", digest, known)
    errors = known["errors"]
    assert isinstance(errors, list)
    return str(known["verdict"]), [str(error) for error in errors]


def _validated(urdf: Path, engine: str) -> dict[str, object]:
    """Run `kinematify validate` in a process of its own: workers of AsyncVectorEnv may start no other kind."""
    words = [sys.executable, "-m", "kinematify", "validate", str(urdf), "--json", "-", "--engines", engine]
    done = subprocess.run([*words, "--checks", _CHECKS], capture_output=True, text=True, check=False)
    if done.returncode not in {0, 1}:
        kind = InputError if done.returncode == 2 else EnvironmentFault
        raise kind(f"kinematify validate {urdf} ended with status {done.returncode}: {done.stderr.strip()}")
    report = json.loads(done.stdout)
    errors = [
        f"{finding['check']}: {finding['message']}" for finding in report["findings"] if finding["severity"] == "error"
    ]
    return {"verdict": report["verdict"], "errors": errors}
