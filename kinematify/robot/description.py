"""Descriptions in other formats than URDF: distinguished by their content, read by a process that is bounded."""

from __future__ import annotations

import atexit
import importlib
import json
import os
import pickle
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from kinematify.errors import DescriptionError, EnvironmentFault, KinematifyError
from kinematify.robot.mesh_folder import MeshFiles, with_files
from kinematify.robot.urdf_text import MAX_URDF_BYTES, calls_xacro, parse_text
from kinematify.robot.write import write_robot
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.robot.robot import Joint, Robot

SUFFIXES = (".urdf", ".xacro", ".mjcf", ".sdf", ".usd", ".usda", ".usdc", ".usdz")
"""Names of descriptions; an MJCF is often a mere ``.xml``."""
TITLES = {"xacro": "xacro", "mjcf": "MJCF", "sdf": "SDF", "usd": "USD"}
_SECONDS, _MEMORY = 120, 16 << 30
"""What reading a file may take."""
_HEAD = 1 << 20
_ROOT = re.compile(rb"<(?![?!])([\w.-]+:)?([\w.-]+)")
_ROOTS = {b"mujoco": "mjcf", b"mujocoinclude": "mjcf", b"sdf": "sdf", b"gazebo": "sdf"}
_NAMED = re.compile(r'<(link|joint)\s[^>]*?\bname\s*=\s*"([^"]+)"')
_EXPRESSION = re.compile(r"\$[{(].*?[)}]")
_OUR_NAME = re.compile(r"joint_\d+")
_NOTES: dict[Path, tuple[str, ...]] = {}
_EFFORT, _VELOCITY, _SLIDE = 1000.0, 100.0, 100.0
"""Of joints that state none in our URDF, without which engines refuse it [N m or N, rad/s or m/s, m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Description:
    """A description of any format with the URDF that represents it."""

    path: Path
    form: str
    """``urdf``, ``xacro``, ``mjcf``, ``sdf`` or ``usd``."""
    urdf: Path
    """`path` itself if it is one."""
    lines: Mapping[tuple[str, str], int]
    """Line of `path` that declares a link or joint, by ``link`` or ``joint`` and its name; empty for a URDF."""
    notes: tuple[str, ...] = ()
    """What the file holds and the URDF does not, one sentence each."""
    unstated: frozenset[tuple[str, str]] = frozenset()
    """``limit`` with each slide without limits and ``effort`` with each joint without one: a URDF has to state them."""
    native: bool = False
    """MuJoCo opens `path` itself, and has the same joints there."""
    apart: frozenset[frozenset[str]] = frozenset()
    """Pairs of links that the file keeps from colliding, which a URDF cannot say."""

    @property
    def title(self) -> str:
        """Name of the format."""
        return TITLES.get(self.form, "URDF")


def form_of(path: Path) -> str:
    """Return the format of a file by its content; ``urdf`` for what is none of the others."""
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
    except OSError:
        return "urdf"  # whose reader says what is wrong with it
    if head.startswith((b"PXR-USDC", b"#usda")) or path.suffix.lower().startswith(".usd"):
        return "usd"
    root = _ROOT.search(re.sub(rb"<!--.*?-->", b"", head, flags=re.DOTALL))
    name = b"" if root is None else root[2]
    if name == b"robot" and (path.suffix.lower() == ".xacro" or (b"xacro" in head and _is_unexpanded(path))):
        return "xacro"
    return _ROOTS.get(name, "urdf")


def _is_unexpanded(path: Path) -> bool:
    try:
        return calls_xacro(parse_text(path.read_bytes()))
    except (OSError, etree.XMLSyntaxError):
        return False  # the reader of URDF says what is wrong


def read_foreign(path: Path, form: str, package_dirs: Sequence[Path], arguments: Mapping[str, str]) -> Any:
    """Return what a process of its own reads: a `Robot`, or the text of a URDF for a xacro.

    Raises:
        DescriptionError: The file cannot be read, or only with more time or memory than a description needs.
    """
    if path.stat().st_size > 4 * MAX_URDF_BYTES:
        raise DescriptionError(f"The description {path} has {path.stat().st_size} bytes. Is it a mesh?")
    task = json.dumps([str(path.absolute()), form, [str(item) for item in package_dirs], dict(arguments)])
    try:
        done = subprocess.run(
            [sys.executable, "-m", "kinematify.robot.description", task],
            capture_output=True, timeout=_SECONDS, check=False, preexec_fn=_bound,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(item for item in sys.path if item)},
        )  # fmt: skip
    except subprocess.TimeoutExpired as error:
        raise DescriptionError(f"Reading {path} takes more than {_SECONDS} s. Is it meant to?") from error
    if done.returncode:
        said = done.stderr.decode(errors="replace").strip().splitlines()
        raise DescriptionError(
            f"The reader of {path} fails ({done.returncode}): {said[-1] if said else 'it says nothing'}."
        )
    answer = pickle.loads(done.stdout)
    if isinstance(answer, KinematifyError):
        raise answer
    return answer


def _bound() -> None:
    """Limit memory, and forbid to write any file."""
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))


_READERS = {
    "xacro": ("kinematify.robot.xacro_text", "expand_xacro"),
    "mjcf": ("kinematify.robot.mjcf_reader", "read_mjcf"),
    "sdf": ("kinematify.robot.sdf_reader", "read_sdf"),
    "usd": ("kinematify.robot.usd_reader", "read_usd"),
}
"""Module and function of every format, which loads its library when a file needs it."""


def read_here(
    path: Path, form: str, package_dirs: Sequence[Path] = (), arguments: Mapping[str, str] | None = None
) -> Any:
    """Return what `read_foreign` does, in this process and without its bounds: for files that are trusted."""
    if form == "usd":
        require("Reading USD", "usd-core")
    module, function = _READERS[form]
    return getattr(importlib.import_module(module), function)(path, package_dirs, arguments or {})


def open_description(
    path: Path, folder: Path, package_dirs: Sequence[Path] = (), arguments: Mapping[str, str] | None = None
) -> Description:
    """Return a description with a URDF of it: the file itself, or one that is written into a folder.

    Args:
        path: The file.
        folder: Where the URDF of another format, and its meshes, are written.
        package_dirs: Where packages lie.
        arguments: Of a xacro.

    Raises:
        DescriptionError: It cannot be read, or arguments are given to what is no xacro.
    """
    form = form_of(path)
    if arguments and form != "xacro":
        raise DescriptionError(
            f"{path} is no xacro, so it takes no {next(iter(arguments))}:=. Leave the arguments out."
        )
    if form == "urdf":
        return Description(path=path, form=form, urdf=path, lines={})
    urdf = folder / f"{path.name.split('.')[0]}.urdf"
    read = read_foreign(path, form, package_dirs, arguments or {})
    if isinstance(read, str):
        urdf.write_text(read, encoding="utf-8")
        return Description(path=path, form=form, urdf=urdf, lines=_xacro_lines(path, urdf))
    robot: Robot = read
    notes = list(robot.notes)
    joints = tuple(_complete(joint) for joint in robot.joints)
    changed = sum(one is not other for one, other in zip(joints, robot.joints, strict=True))
    if changed:
        made_up = f"{_EFFORT:g}, {_VELOCITY:g} and {_SLIDE:g} m"
        notes.append(f"No effort, speed or end is stated by {changed} of the joints; the URDF says {made_up}.")
    meshes = MeshFiles(urdf)
    links = tuple(with_files(link, meshes) for link in robot.links)
    write_robot(replace(robot, links=links, joints=joints), urdf)
    lines = {("link", link.name): link.line for link in robot.links}
    lines |= {("joint", joint.name): joint.line for joint in robot.joints}
    # MuJoCo's own names and none of ours, and nothing that moves in other ways.
    ours = any(joint.declared_kind == "ball" or _OUR_NAME.fullmatch(joint.name) for joint in joints)
    native = form == "mjcf" and not ours
    unstated = {("limit", joint.name) for joint in robot.joints if joint.kind == "prismatic" and not joint.has_limit}
    unstated |= {("effort", joint.name) for joint in robot.joints if joint.effort is None}
    return Description(
        path=path, form=form, urdf=urdf, lines=lines, notes=tuple(notes), unstated=frozenset(unstated), native=native,
        apart=robot.apart,
    )  # fmt: skip


def urdf_for(path: Path, package_dirs: Sequence[Path] = (), arguments: Mapping[str, str] | None = None) -> Path:
    """Return the URDF of `open_description`, which stays until the program ends; arguments and errors as there."""
    if form_of(path) == "urdf" and not arguments:
        return path
    folder = tempfile.mkdtemp(prefix="kinematify-description-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    opened = open_description(path, Path(folder), package_dirs, arguments)
    _NOTES[opened.urdf.resolve()] = opened.notes
    return opened.urdf


def notes_of(urdf: Path) -> tuple[str, ...]:
    """Return what a URDF of `urdf_for` does not have of its source, one sentence each; nothing for other files."""
    return _NOTES.get(urdf.resolve(), ())


def _complete(joint: Joint) -> Joint:
    """A joint with what engines demand of a URDF."""
    if joint.kind == "fixed":
        return joint
    lower, upper = joint.lower, joint.upper
    if joint.kind == "prismatic" and not np.isfinite([lower, upper]).all():
        lower, upper = max(lower, -_SLIDE), min(upper, _SLIDE)
    effort = _EFFORT if joint.effort is None else joint.effort
    velocity = _VELOCITY if joint.velocity is None else joint.velocity
    same = (lower, upper, effort, velocity) == (joint.lower, joint.upper, joint.effort, joint.velocity)
    return joint if same else replace(joint, lower=lower, upper=upper, effort=effort, velocity=velocity)


def _xacro_lines(path: Path, urdf: Path) -> dict[tuple[str, str], int]:
    """Lines of the file whose ``<link name="${prefix}arm">`` fits a name of the URDF; of included files none."""
    text = path.read_text(encoding="utf-8", errors="replace")
    stated = []
    for found in _NAMED.finditer(text):
        pattern = re.compile(".+".join(map(re.escape, _EXPRESSION.split(found[2]))))
        stated.append((found[1], pattern, text.count("\n", 0, found.start()) + 1))
    lines: dict[tuple[str, str], int] = {}
    for tag, name in _NAMED.findall(urdf.read_text(encoding="utf-8")):
        line = next((line for kind, pattern, line in stated if kind == tag and pattern.fullmatch(name)), None)
        if line is not None:
            lines[tag, name] = line
    return lines


def _main() -> None:
    """Read for another process: a task as JSON, the answer as a pickle."""
    path, form, package_dirs, arguments = json.loads(sys.argv[1])
    answer: Any
    out = os.dup(1)
    os.dup2(2, 1)  # libraries print
    try:
        answer = read_here(Path(path), form, [Path(item) for item in package_dirs], arguments)
    except (DescriptionError, EnvironmentFault) as error:
        answer = error
    except RecursionError:
        answer = DescriptionError(f"The description {path} includes itself, or is nested too deep. Correct it.")
    except MemoryError:
        answer = DescriptionError(f"Reading {path} takes more than {_MEMORY >> 30} GB. Is it meant to?")
    with os.fdopen(out, "wb") as file:
        pickle.dump(answer, file)


if __name__ == "__main__":
    _main()
