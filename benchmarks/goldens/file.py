"""The file of goldens: what is in it, on which platform it holds, and what differs from it."""

from __future__ import annotations

import hashlib
import platform
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, ValidationError

import kinematify
from benchmarks.goldens.values import EXACT, PORTABLE, array_hash
from kinematify.errors import InputError, OutputError
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from collections.abc import Iterator

FORMAT = 1
"""Raised where goldens of an earlier version can no longer be compared, whatever the code does."""
_PACKAGES = (
    "click", "coacd", "cmeel", "drake", "embreex", "gymnasium", "libigl", "libpinocchio", "lxml", "manifold3d",
    "mujoco", "numpy", "pybullet", "pydantic", "python-fcl", "scipy", "torch", "trimesh",
)  # fmt: skip
Hashes = dict[str, dict[str, str]]
"""SHA-256 by name, by `EXACT` and `PORTABLE`."""


class Platform(BaseModel):
    """What the last bits of a number depend on."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    machine: str
    python: str
    packages: dict[str, str]
    computes: str
    """Hash of what the libraries compute on this processor."""

    def differences(self, other: Platform) -> list[str]:
        """What is another on the other platform, in words."""
        names = {**self.packages, **other.packages}
        found = [
            f"{name} {self.packages.get(name)} -> {other.packages.get(name)}"
            for name in names
            if self.packages.get(name) != other.packages.get(name)
        ]
        for name in ("machine", "python"):
            if getattr(self, name) != getattr(other, name):
                found.append(f"{name} {getattr(self, name)} -> {getattr(other, name)}")
        return found + (["the processor computes other last bits"] if self.computes != other.computes else [])


class Subject(BaseModel):
    """Goldens of one subject."""

    model_config = ConfigDict(extra="forbid")

    commit: str
    """Of the code that made them; with a + where files had been changed."""
    items: dict[str, Hashes]


class Goldens(BaseModel):
    """All goldens."""

    model_config = ConfigDict(extra="forbid")

    format: Literal[1] = FORMAT
    sample: bool
    """A part of every subject."""
    platform: Platform
    subjects: dict[str, Subject] = {}


@dataclass(frozen=True, kw_only=True)
class Difference:
    """A golden that is not the same."""

    item: str
    name: str
    kind: str
    """`EXACT` or `PORTABLE`."""
    how: Literal["changed", "missing", "added"]


def this_platform() -> Platform:
    """The platform that this process runs on."""
    system = f"{platform.system()} {platform.machine()}"
    return Platform(
        machine=system,
        python=platform.python_version(),
        packages=package_versions(_PACKAGES),
        computes=_computed(),
    )


def _computed() -> str:
    """Hash of results that take other instructions on other processors: BLAS, LAPACK, elementary functions, torch."""
    import torch  # noqa: PLC0415 - seconds; only a comparison needs it

    rng = np.random.default_rng(0)
    square, line = rng.normal(size=(96, 96)), rng.normal(size=4096)
    weights = torch.from_numpy(square.astype(np.float32))
    found = [
        square @ square, np.linalg.eigh(square + square.T)[1], np.linalg.svd(square)[1], np.linalg.inv(square),
        np.sin(line), np.exp(line), np.arctan2(line, line[::-1]), np.log(np.abs(line)), np.linalg.norm(square, axis=1),
        np.power(np.abs(line), 0.3), np.add.reduce(line), (weights @ weights).numpy(), torch.tanh(weights).numpy(),
        torch.softmax(weights, dim=1).numpy(),
    ]  # fmt: skip
    return hashlib.sha256("".join(map(array_hash, found)).encode()).hexdigest()


def same_checkout() -> None:
    """Refuse to compare a package that is not the one beside this folder.

    Raises:
        InputError: Python would import another one.
    """
    here, there = Path(__file__).resolve().parents[2], Path(kinematify.__file__).resolve().parents[1]
    if here != there:
        raise InputError(
            f"The goldens belong to the checkout {here}, but `import kinematify` finds the package in {there}. Run the "
            "command in the checkout that is to be compared, with PYTHONPATH naming it."
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
            f"{path} holds no goldens of format {FORMAT}: {error.errors()[0]['msg']}. It was written by another "
            "version of `python -m benchmarks.goldens`; make goldens again with the code before the change and this folder."
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


def differences(before: dict[str, Hashes], now: dict[str, Hashes], kinds: tuple[str, ...]) -> Iterator[Difference]:
    """Yield what differs in the items that either side has.

    Args:
        before: Goldens by item.
        now: What was made.
        kinds: `EXACT`, `PORTABLE` or both.
    """
    for item in sorted(before.keys() | now.keys()):
        for kind in kinds:
            one, other = before.get(item, {}).get(kind, {}), now.get(item, {}).get(kind, {})
            for name in (*one, *(name for name in other if name not in one)):
                if one.get(name) != other.get(name):
                    how = "added" if name not in one else "missing" if name not in other else "changed"
                    yield Difference(item=item, name=name, kind=kind, how=how)


KINDS = (EXACT, PORTABLE)
