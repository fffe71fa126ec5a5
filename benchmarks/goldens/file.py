"""The file of goldens: what is in it, on which platform it holds, and what differs from it."""

from __future__ import annotations

import hashlib
import platform
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, ValidationError

import kinematify
from benchmarks.goldens.values import array_hash
from kinematify.errors import InputError, OutputError
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

FORMAT: Final = 1
"""Raised where goldens of an earlier version of this command cannot be compared, whatever the package does."""
_PACKAGES = (
    "click", "coacd", "embreex", "gymnasium", "libigl", "libpinocchio", "lxml", "manifold3d", "mujoco",
    "numpy", "pybullet", "pydantic", "python-fcl", "scipy", "torch", "trimesh",
)  # fmt: skip
Hashes = dict[str, dict[str, str]]
"""SHA-256 by name, by `values.KINDS`."""


class Subject(BaseModel):
    """Goldens of one subject."""

    model_config = ConfigDict(extra="forbid")

    commit: str
    """Of the code that made them; with a + where files had been changed."""
    items: dict[str, Hashes]


class Goldens(BaseModel):
    """All goldens."""

    model_config = ConfigDict(extra="forbid")

    format: Literal[1] = 1
    sample: bool
    """A part of every subject."""
    platform: dict[str, str]
    """Of `this_platform`."""
    subjects: dict[str, Subject] = {}


def this_platform() -> dict[str, str]:
    """What the last bits of a number depend on: system, versions, and a hash of what this processor computes."""
    return {
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **package_versions(_PACKAGES),
        "last bits": _last_bits(),
    }


def _last_bits() -> str:
    """Hash of what takes other instructions on other processors: BLAS, LAPACK, elementary functions, torch."""
    import torch  # noqa: PLC0415 - seconds, in every process otherwise

    rng = np.random.default_rng(0)
    square, line = rng.normal(size=(96, 96)), rng.normal(size=4096)
    weights = torch.from_numpy(square.astype(np.float32))
    found = (
        square @ square, np.linalg.eigh(square + square.T)[1], np.linalg.svd(square)[1], np.linalg.inv(square),
        np.sin(line), np.exp(line), np.arctan2(line, line[::-1]), np.power(np.abs(line), 0.3), np.add.reduce(line),
        (weights @ weights).numpy(), torch.tanh(weights).numpy(), torch.softmax(weights, dim=1).numpy(),
    )  # fmt: skip
    return hashlib.sha256("".join(map(array_hash, found)).encode()).hexdigest()


def other_platform(before: dict[str, str], now: dict[str, str]) -> str:
    """What is another on another platform, in words; empty on the same one."""
    names = (*before, *(name for name in now if name not in before))
    differ = [name for name in names if before.get(name) != now.get(name)]
    return "; ".join(
        f"{name} {before.get(name)} -> {now.get(name)}" if name != "last bits" else "the processor rounds otherwise"
        for name in differ
    )


def refuse_other_checkout() -> None:
    """Refuse to compare a package that is not the one beside this folder.

    Raises:
        InputError: Python would import another one.
    """
    here, there = Path(__file__).resolve().parents[2], Path(kinematify.__file__).resolve().parents[1]
    if here != there:
        raise InputError(
            f"This command belongs to the checkout {here}, but `import kinematify` finds the package in {there}. Run "
            "it in the checkout that is to be compared, with PYTHONPATH naming that checkout."
        )


def read_goldens(path: Path) -> Goldens:
    """Read a file of goldens.

    Raises:
        InputError: There is none, or it is of another version of this command.
    """
    try:
        return Goldens.model_validate_json(path.read_bytes())
    except OSError as error:
        raise InputError(
            f"There are no goldens in {path} ({error.strerror}). Make them with the code before the change: "
            "`python -m benchmarks.goldens make`."
        ) from error
    except ValidationError as error:
        raise InputError(
            f"{path} holds no goldens of format {FORMAT} ({error.errors()[0]['msg']}): another version of "
            "`python -m benchmarks.goldens` wrote it. Make goldens again: the code before the change, this command."
        ) from error


def write_goldens(goldens: Goldens, path: Path) -> None:
    """Write a file of goldens; it appears whole.

    Raises:
        OutputError: It cannot be written.
    """
    aside = path.with_suffix(".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        aside.write_text(goldens.model_dump_json(indent=1) + "\n", encoding="utf-8")
        aside.replace(path)
    except OSError as error:
        raise OutputError(f"The goldens cannot be written to {path}: {error.strerror}. Give another --to.") from error


def differences(
    before: dict[str, Hashes], now: dict[str, Hashes], kinds: Sequence[str]
) -> Iterator[tuple[str, str, str, str]]:
    """Yield item, kind, name and ``changed``, ``missing`` or ``added`` of what is not the same.

    Args:
        before: Goldens by item.
        now: What was made.
        kinds: Of `values.KINDS`.
    """
    for item in (*before, *(item for item in now if item not in before)):
        for kind in kinds:
            one, other = before.get(item, {}).get(kind, {}), now.get(item, {}).get(kind, {})
            for name in (*one, *(name for name in other if name not in one)):
                if one.get(name) != other.get(name):
                    yield item, kind, name, "added" if name not in one else "changed" if name in other else "missing"
