"""What was written is opened in its target, whose model is compared with the one that was meant."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from kinematify.errors import DescriptionError, ExportError
from kinematify.formats.content import WORLD
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Inertial, Joint, Link, Robot, forward_kinematics
from kinematify.robot.transforms import rotation_from_quaternion, rotation_from_rpy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from lxml.etree import _Element

    from kinematify.formats.content import Content
    from kinematify.robot.arrays import FloatArray

_EXACT, _SINGLE = 1e-9, 1e-6
"""Relative differences that do not count: of double precision, and of USD and glTF, which have seven digits."""
_CONFIGURATIONS = 3


def check_target(content: Content, to: str, out: Path) -> None:
    """Open a file that was written in its target and compare joints, poses, masses and inertias.

    Raises:
        ExportError: The target refuses the file, or reads another model in it; says which, and what differs.
    """
    try:
        found = _OPENERS[to](out)
    except (ValueError, KeyError, RuntimeError, DescriptionError) as error:
        raise ExportError(
            f"The {to.upper()} that was written to {out} is refused: {error}. Correct what it names in the model, or "
            "report it; do not use the file."
        ) from error
    different = list(_differences(content.robot, found, to))
    if different:
        raise ExportError(
            f"The {to.upper()} that was written to {out} is another model than the given one: {' '.join(different)} "
            "Please report it; do not use the file."
        )


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
        ends = np.array([[item.lower, item.upper] for item in (joint, other)])
        if joint.kind.turns != other.kind.turns or not np.allclose(ends[0], ends[1], atol=10.0 * _SINGLE):
            yield f"The joint {joint.name} is {_described(joint)}, there {_described(other)}."
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
        yield from _difference_of_mass(link, found.link_by_name[link.name], near) if to != "glb" else ()


def _difference_of_mass(link: Link, other: Link, near: float) -> Iterator[str]:
    if link.inertial is None:
        return
    masses, centers, tensors = (
        [getattr(item.inertial, key, np.nan) for item in (link, other)] for key in ("mass", "center_of_mass", "tensor")
    )
    for what, (before, after) in (("mass", masses), ("centre of mass", centers), ("inertia", tensors)):
        scale = float(np.abs(before).max()) + (1.0 if what == "centre of mass" else 0.0)
        most = max(near, _SINGLE) if what == "inertia" else near  # MuJoCo before 4 finds principal axes to 3e-7
        if not np.abs(np.subtract(after, before)).max() <= most * scale:
            yield f"The {what} of the link {link.name} is {after}, not {before}."


def _described(joint: Joint) -> str:
    return f"{'a hinge' if joint.kind.turns else 'a slide'} from {joint.lower:g} to {joint.upper:g}"


def _loose(robot: Robot) -> Robot:
    """Return the tree in which no joint follows another."""
    return replace(robot, joints=tuple(replace(joint, mimic=None, closure=None) for joint in robot.joints))


def _tree(links: list[Link], joints: list[Joint]) -> Robot:
    return Robot(name="", links=tuple(links), joints=tuple(joints))


def _transform(position: Any, rotation: FloatArray) -> FloatArray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation, position
    return T


def _open_mjcf(out: Path) -> Robot:
    import mujoco  # noqa: PLC0415

    model = mujoco.MjModel.from_xml_path(str(out))
    links, joints = [], []
    for k in range(1, model.nbody):
        body = model.body(k)
        turned = rotation_from_quaternion(body.iquat)
        tensor = turned @ np.diag(body.inertia) @ turned.T
        inertial = Inertial(mass=float(body.mass[0]), center_of_mass=body.ipos, tensor=tensor)
        links.append(Link(name=body.name, inertial=inertial))
        if not body.parentid[0]:
            continue
        kind, name, more = JointType.FIXED, f"fixed {k}", {}
        if body.jntnum[0]:
            joint = model.joint(int(body.jntadr[0]))
            kind = JointType.PRISMATIC if joint.type[0] == mujoco.mjtJoint.mjJNT_SLIDE else JointType.REVOLUTE
            ends = joint.range if model.jnt_limited[joint.id] else (-np.inf, np.inf)
            name, more = joint.name, {"axis": joint.axis, "lower": float(ends[0]), "upper": float(ends[1])}
        parent = model.body(int(body.parentid[0])).name
        T = _transform(body.pos, rotation_from_quaternion(body.quat))
        joints.append(Joint(name=name, kind=kind, parent=parent, child=body.name, T_parent_child=T, **more))
    return _tree(links, joints)


def _open_sdf(out: Path) -> Robot:
    """No parser of SDFormat can be installed with pip: what libsdformat refuses of names and references is here."""
    model = etree.parse(out).find("model")
    if model is None:
        raise ValueError("it has no <model>")
    for parent in model.iter():
        names = Counter(child.get("name") for child in parent if child.get("name"))
        if names and max(names.values()) > 1:
            raise ValueError(f"two siblings in <{parent.tag}> have the name {names.most_common(1)[0][0]!r}")
    for uri in model.iter("uri"):
        if not (out.parent / str(uri.text)).is_file():
            raise ValueError(f"there is no file {uri.text}")

    def pose(element: _Element) -> FloatArray:
        values = np.array([float(word) for word in element.findtext("pose", "0 0 0 0 0 0").split()])
        return _transform(values[:3], rotation_from_rpy(values[3:]))

    links, joints, T_model = [], [], {WORLD: np.eye(4)}
    for element in model.findall("link"):
        inertial = element.find("inertial")
        T_model[str(element.get("name"))] = pose(element)
        stated = None
        if inertial is not None:
            m = {
                key: float(inertial.findtext(f"inertia/{key}", "0"))
                for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
            }
            stated = Inertial(
                mass=float(inertial.findtext("mass", "1")),
                center_of_mass=pose(inertial)[:3, 3],
                tensor=np.array([[m["".join(sorted("i" + a + b))] for a in "xyz"] for b in "xyz"]),
            )
        links.append(Link(name=str(element.get("name")), inertial=stated))
    for element in model.findall("joint"):
        parent, child = element.findtext("parent", ""), element.findtext("child", "")
        T = np.linalg.inv(T_model[parent]) @ T_model[child]
        kind = element.get("type", "")
        if kind != "ball" and parent != WORLD:
            ends = [float(element.findtext(f"axis/limit/{end}", "0")) for end in ("lower", "upper")]
            lower, upper = (np.copysign(np.inf, end) if abs(end) >= 1e16 else end for end in ends)
            axis = np.array([float(word) for word in element.findtext("axis/xyz", "1 0 0").split()])
            joints.append(
                Joint(
                    name=str(element.get("name")), kind=JointType(kind), parent=parent, child=child, T_parent_child=T,
                    axis=axis, lower=lower, upper=upper,
                )
            )  # fmt: skip
    return _tree(links, joints)


def _open_usd(out: Path) -> Robot:
    from pxr import Usd, UsdPhysics  # noqa: PLC0415

    stage = Usd.Stage.Open(str(out))
    kinds = {"PhysicsRevoluteJoint": JointType.REVOLUTE, "PhysicsPrismaticJoint": JointType.PRISMATIC}
    links, joints = [], []
    for prim in stage.Traverse():
        if prim.HasAPI(UsdPhysics.RigidBodyAPI):
            stated, inertial = UsdPhysics.MassAPI(prim), None
            if prim.HasAPI(UsdPhysics.MassAPI):
                turned = _turn(stated.GetPrincipalAxesAttr().Get())
                inertial = Inertial(
                    mass=stated.GetMassAttr().Get(),
                    center_of_mass=np.array(stated.GetCenterOfMassAttr().Get()),
                    tensor=turned @ np.diag(stated.GetDiagonalInertiaAttr().Get()) @ turned.T,
                )
            links.append(Link(name=prim.GetName(), inertial=inertial))
        joint = UsdPhysics.Joint(prim)
        if not joint or joint.GetExcludeFromArticulationAttr().Get() or not joint.GetBody0Rel().GetTargets():
            continue
        before, after = (
            _transform(place.Get(), _turn(turn.Get()))
            for place, turn in (
                (joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr()),
                (joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr()),
            )
        )
        kind = kinds.get(prim.GetTypeName(), JointType.FIXED)
        unit = np.radians(1.0) if kind.turns else 1.0
        lower, upper = (prim.GetAttribute(f"physics:{end}Limit").Get() or 0.0 for end in ("lower", "upper"))
        parent, child = (ends.GetTargets()[0].name for ends in (joint.GetBody0Rel(), joint.GetBody1Rel()))
        joints.append(
            Joint(
                name=prim.GetName(), kind=kind, parent=parent, child=child,
                T_parent_child=before @ np.linalg.inv(after), axis=after[:3, 0], lower=lower * unit, upper=upper * unit,
            )
        )  # fmt: skip
    return _tree(links, joints)


def _turn(quaternion: Any) -> FloatArray:
    return rotation_from_quaternion(np.array([quaternion.GetReal(), *quaternion.GetImaginary()]))


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
    return _tree(links, joints)


_OPENERS: dict[str, Callable[[Path], Robot]] = {
    "mjcf": _open_mjcf,
    "sdf": _open_sdf,
    "usd": _open_usd,
    "urdf": lambda out: read_robot(out, geometry="none"),
    "glb": _open_glb,
}
