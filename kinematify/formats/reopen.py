"""What was written is opened in its target, whose model is compared with the one that was meant."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from kinematify.errors import DescriptionError, ExportError
from kinematify.formats.content import with_names
from kinematify.robot.description import read_here
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Joint, Link, Robot, forward_kinematics

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from kinematify.formats.content import Content

_EXACT, _SINGLE = 1e-9, 1e-6
"""Relative differences that do not count: of double precision, and of USD and glTF, which have seven digits."""
_CONFIGURATIONS = 3


def check_target(content: Content, to: str, out: Path) -> None:
    """Open a file that was written in its target and compare joints, poses, masses and inertias.

    Raises:
        ExportError: The target refuses the file, or reads another model in it; says which, and what differs.
    """
    try:
        found = _opened(to, out)
    except (ValueError, KeyError, RuntimeError, DescriptionError) as error:
        raise ExportError(
            f"The {to.upper()} that was written to {out} is refused: {error} Correct what it names in the model, or "
            "report it; do not use the file."
        ) from error
    links, joints = list(content.robot.link_by_name), list(content.robot.joint_by_name)
    if to == "usd" and (len(links), len(joints)) == (len(found.links), len(found.joints)):
        found = with_names(found, links, joints)  # they are in the order of the file; the reader takes shown names
    different = list(_differences(content.robot, found, to))
    if different:
        raise ExportError(
            f"The {to.upper()} that was written to {out} is another model than the given one: {' '.join(different)} "
            "Please report it; do not use the file."
        )


def _opened(to: str, out: Path) -> Robot:
    """Read a file by the library of its format."""
    if to in ("urdf", "glb"):
        return read_robot(out, geometry="none") if to == "urdf" else _open_glb(out)
    if to == "sdf":
        _check_siblings(out)
    robot: Robot = read_here(out, to)
    return robot


def _check_siblings(out: Path) -> None:
    """Refuse what libsdformat, which no package of pip has, refuses of names."""
    for parent in etree.parse(out).iter():
        names = Counter(child.get("name") for child in parent if child.get("name"))
        if names and max(names.values()) > 1:
            raise ValueError(f"two siblings in <{parent.tag}> have the name {names.most_common(1)[0][0]!r}.")


def _differences(meant: Robot, found: Robot, to: str) -> Iterator[str]:
    near = _EXACT if to in ("mjcf", "sdf", "urdf") else _SINGLE
    for what in ("link", "joint"):
        names, others = (
            {item.name for item in getattr(robot, f"{what}s") if getattr(item, "kind", "") is not JointType.FIXED}
            for robot in (meant, found)
        )
        if names != others:
            yield f"The {what}s {', '.join(sorted(names ^ others))} are not in both."
            return
    joints = [joint for joint in meant.joints if joint.kind is not JointType.FIXED]
    for joint in joints:
        other = found.joint_by_name[joint.name]
        if not np.allclose(_described(joint, to), _described(other, to), rtol=_SINGLE, atol=10.0 * _SINGLE):
            yield f"The joint {joint.name} turns, begins, ends or follows otherwise: {other}, not {joint}."
    if to != "glb" and len(meant.loops) != len(found.loops):
        yield f"Of {len(meant.loops)} closed loops {len(found.loops)} are there."
    size = 1.0 + sum(float(np.linalg.norm(joint.T_parent_child[:3, 3])) for joint in meant.joints)
    rng = np.random.default_rng(0)
    for _ in range(_CONFIGURATIONS):
        q = {joint.name: float(rng.uniform(-1.0, 1.0)) for joint in joints}
        poses, others_at = (forward_kinematics(_loose(robot), q) for robot in (meant, found))
        for name, T in poses.items():
            gap = float(np.abs(others_at[name] - T).max())
            if not gap <= near * size:
                yield f"The link {name} is {gap:.3g} away from its pose."
                return
    for link in meant.links:
        stated = found.link_by_name[link.name].inertial
        if link.inertial is not None and to != "glb":
            for key in ("mass", "center_of_mass", "tensor"):
                before, after = getattr(link.inertial, key), getattr(stated, key, np.nan)
                scale = float(np.abs(before).max()) + (key == "center_of_mass")
                most = max(near, _SINGLE) if key == "tensor" else near  # MuJoCo before 4 finds principal axes to 3e-7
                if not np.abs(np.subtract(after, before)).max() <= most * scale:
                    what = "inertia" if key == "tensor" else key.replace("_", " ")
                    yield f"The {what} of the link {link.name} is {after}, not {before}."


def _described(joint: Joint, to: str) -> list[float]:
    rule = joint.mimic if to != "glb" else None
    return [joint.kind.turns, joint.lower, joint.upper, *((rule.multiplier, rule.offset) if rule else (np.inf, np.inf))]


def _loose(robot: Robot) -> Robot:
    """Return the tree in which no joint follows another."""
    return replace(robot, joints=tuple(replace(joint, mimic=None, closure=None) for joint in robot.joints))


def _open_glb(out: Path) -> Robot:
    import trimesh  # noqa: PLC0415

    scene: Any = trimesh.load_scene(out)
    links, joints = [], []
    for (parent, child), edge in scene.graph.transforms.edge_data.items():
        stated = edge.get("metadata", {}).get("kinematify", {})
        if stated or "geometry" not in edge:
            links.append(Link(name=child))
        if stated:
            kind = JointType(stated["type"])
            unlimited = np.inf if kind is JointType.CONTINUOUS else 0.0
            joints.append(
                Joint(
                    name=stated["joint"], kind=kind, parent=parent, child=child, T_parent_child=edge["matrix"],
                    axis=stated.get("axis", (1.0, 0.0, 0.0)), lower=stated.get("lower", -unlimited),
                    upper=stated.get("upper", unlimited),
                )
            )  # fmt: skip
    return Robot(name="", links=tuple(links), joints=tuple(joints))
