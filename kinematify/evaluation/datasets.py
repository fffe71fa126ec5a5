"""Objects with ground truth, and the conditions under which each is shown to the method."""

from __future__ import annotations

import hashlib
import json
import os
from collections import Counter
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import cached_property
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from kinematify.errors import EnvironmentFault, InputError
from kinematify.versions import install_command, not_installed

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

BENCH_VARIABLE = "KINEMATIFY_BENCH"
PIP_DATA = "pip"
"""The word that represents robots of the PyPI package example-robot-data."""
SETS = ("robots", "everyday", "everyday2", "articraft", "infinigen", "kitchen", "kinart")
"""Sets of the benchmark folder, each a folder in it and a word for it: robots, household objects of one data set,
household objects and devices of many others, objects that language models programmed, those of a generator, and two
sets that nothing is fitted to or chosen by."""
DEFAULT_SETS = ("robots", "everyday")
"""What is measured where nothing is asked for; the others were added later and are measured by themselves."""


@dataclass(frozen=True, kw_only=True)
class Condition:
    """Pose of an object before its kinematics are erased."""

    name: str
    pose: Literal["rest", "random"]
    seed: int
    """Draws the random configuration, and the order and names of the parts."""
    yaw_deg: float
    """Turn about the vertical axis [deg]."""


CONDITIONS = (
    Condition(name="rest", pose="rest", seed=0, yaw_deg=0.0),
    Condition(name="random-0", pose="random", seed=0, yaw_deg=0.0),
    Condition(name="random-1", pose="random", seed=1, yaw_deg=0.0),
    Condition(name="random-2", pose="random", seed=2, yaw_deg=0.0),
    Condition(name="yaw37", pose="rest", seed=0, yaw_deg=37.0),
)
"""The conditions of the protocol."""


@dataclass(frozen=True, kw_only=True)
class BenchObject:
    """A robot description with ground truth."""

    name: str
    urdf: Path
    kind: str
    """``robot``, ``everyday`` or ``other``."""
    category: str
    gripper_joints: tuple[str, ...] = ()
    """Fingers that the paper's count of degrees of freedom leaves out."""
    package_dirs: tuple[Path, ...] = ()
    """Folders in which ``package://`` names are looked up."""

    @cached_property
    def content_hash(self) -> str:
        """Hash of the URDF and of names and sizes of all files beside it and below: the same wherever it lies."""
        digest = hashlib.sha256(self.urdf.read_bytes())
        for path in self._files:
            digest.update(f"{path.relative_to(self.urdf.parent).as_posix()}:{path.stat().st_size}".encode())
        return digest.hexdigest()

    @cached_property
    def mesh_bytes(self) -> int:
        """Size of all files beside the URDF and below [bytes]; a guess at how long the object takes."""
        return sum(path.stat().st_size for path in self._files)

    @cached_property
    def _files(self) -> list[Path]:
        return [path for path in sorted(self.urdf.parent.rglob("*")) if path.is_file()]


def find_objects(data: str | Path | None = None) -> tuple[BenchObject, ...]:
    """Return the objects of a data set, by name.

    Args:
        data: A folder searched for URDF files at any depth, one URDF file, one of `SETS`, ``pip`` for robots of the
            PyPI package example-robot-data, or None for the `DEFAULT_SETS` of the benchmark folder (`bench_folder`), or
            all of that folder where it is not divided into sets.

    Raises:
        InputError: The path does not exist or holds no URDF.
        EnvironmentFault: The package example-robot-data is not installed.
    """
    if data is None:
        folder = bench_folder()
        return _objects_below(*[found for name in DEFAULT_SETS if (found := folder / name).is_dir()] or [folder])
    if str(data) in SETS:
        return _objects_below(bench_folder() / str(data))
    if str(data) == PIP_DATA:
        return _pip_objects()
    path = Path(data)
    if path.is_file():
        return (_object_of(path),)
    if path.is_dir():
        return _objects_below(path)
    raise InputError(
        f"There is no benchmark data at {path}. Give a folder with URDF files, one URDF file, or one of "
        f"the words {', '.join((*SETS, PIP_DATA))}."
    )


def matching(objects: Iterable[BenchObject], patterns: Sequence[str]) -> tuple[BenchObject, ...]:
    """Return the objects whose name, category or kind matches one of the patterns.

    Args:
        objects: To choose from.
        patterns: As file names are matched; none for all objects.

    Raises:
        InputError: None matches.
    """
    found = tuple(objects)
    chosen = tuple(
        item
        for item in found
        if not patterns
        or any(fnmatchcase(word, pattern) for word in (item.name, item.category, item.kind) for pattern in patterns)
    )
    if not chosen:
        known = sorted({word for item in found for word in (item.name, item.category, item.kind)})
        raise InputError(
            f"No object, category or kind matches --objects {' '.join(patterns)}. There are {', '.join(known)}."
        )
    return chosen


def bench_folder() -> Path:
    """Return the folder of benchmark models: the environment variable KINEMATIFY_BENCH, else ../shared/bench.

    Raises:
        InputError: Neither exists.
    """
    named, checkout = os.environ.get(BENCH_VARIABLE), Path(__file__).resolve().parents[2]
    folder = Path(named) if named else checkout.parent / "shared" / "bench"
    if folder.is_dir():
        return folder
    place = f" at {folder}" if named or (checkout / "benchmarks").is_dir() else ""  # else it is installed from a wheel
    raise InputError(
        f"There is no benchmark folder{place}. Give a folder of URDF files, set {BENCH_VARIABLE} to one, or use the "
        f"word `{PIP_DATA}` for the robots of a PyPI package."
    )


def _objects_below(*folders: Path) -> tuple[BenchObject, ...]:
    """Objects of all folders by name; those whose own names clash are named by their place."""
    found: list[tuple[BenchObject, str]] = []
    for folder in folders:
        files = [path for path in sorted(folder.rglob("*.urdf")) if _is_main_description(path)]
        if not files:
            raise InputError(
                f"The folder {folder} holds no URDF file at any depth. Give a folder with `model.urdf` folders or "
                "`*.urdf` files."
            )
        for path in files:
            place = path.relative_to(folder)
            stem = place.parent if place.name == "model.urdf" else place.with_suffix("")
            found.append((_object_of(path), stem.as_posix()))
    counts = Counter(item.name for item, _ in found)
    return tuple(replace(item, name=place) if counts[item.name] > 1 else item for item, place in found)


def _is_main_description(path: Path) -> bool:
    """In a model folder only `model.urdf` counts; other files there are variants of it."""
    return path.name == "model.urdf" or not path.with_name("model.urdf").is_file()


def _object_of(urdf: Path) -> BenchObject:
    facts = _source_facts(urdf.parent / "source.json")
    return BenchObject(
        name=urdf.resolve().parent.name if urdf.name == "model.urdf" else urdf.stem,
        urdf=urdf,
        kind=str(facts.get("kind", "other")),
        category=str(facts.get("category", "other")),
        gripper_joints=tuple(facts.get("gripper_joints") or ()),
    )


def _source_facts(path: Path) -> dict[str, Any]:
    try:
        facts = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise InputError(f"The description of the object, {path}, cannot be read as JSON: {error}.") from error
    return facts if isinstance(facts, dict) else {}


_PIP_ROBOTS = (
    ("panda", "arm", "panda_description/urdf/panda.urdf", ("panda_finger_joint1", "panda_finger_joint2")),
    ("go2", "quadruped", "go2_description/urdf/go2.urdf", ()),
    ("allegro", "hand", "allegro_hand_description/urdf/allegro_right_hand.urdf", ()),
    ("ur10", "arm", "ur_description/urdf/ur10_robot.urdf", ()),
)
"""Name, category, place in the package, gripper joints. UR10 is not the paper's UR10e and has no row there."""


def _pip_objects() -> tuple[BenchObject, ...]:
    share = example_robots()
    return tuple(
        BenchObject(
            name=name,
            urdf=share / "example-robot-data" / "robots" / place,
            kind="robot",
            category=category,
            gripper_joints=gripper,
            package_dirs=(share,),
        )
        for name, category, place, gripper in _PIP_ROBOTS
    )


def example_robots() -> Path:
    """Return the folder that holds the installed ROS package `example-robot-data`; its wheel has no module.

    Raises:
        EnvironmentFault: It is not installed.
    """
    try:
        package = distribution("example-robot-data")
    except PackageNotFoundError as error:
        raise EnvironmentFault(not_installed("`pip`", "example-robot-data")) from error
    share = Path(str(package.locate_file("cmeel.prefix/share")))
    robots = share / "example-robot-data" / "robots"
    if all((robots / place).is_file() for _, _, place, _ in _PIP_ROBOTS):
        return share
    raise EnvironmentFault(
        f"The installed example-robot-data {package.version} does not hold all robots in {robots}. Run: "
        f"{install_command('example-robot-data', options=('--force-reinstall',))}"
    )
