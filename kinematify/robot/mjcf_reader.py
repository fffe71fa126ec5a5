"""From an MJCF to a `Robot`, as MuJoCo compiles it: includes, defaults and units are MuJoCo's to understand."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from lxml import etree

from kinematify.errors import DescriptionError
from kinematify.robot.body_tree import WORLD, tree_of
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Joint, Link, LoopJoint, Mimic, inertial_of
from kinematify.robot.transforms import joint_motion, pose_at, rotation_from_quaternion
from kinematify.robot.urdf_geometry import ellipsoid, mesh_shape, primitive

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.body_tree import Edge, Losses
    from kinematify.robot.robot import Inertial, Robot, Shape

_SEEN_GROUPS = 3
"""MuJoCo's viewer shows groups below it."""
_GEOMS = mujoco.mjtGeom
_FREE = {int(mujoco.mjtJoint.mjJNT_FREE): "floating", int(mujoco.mjtJoint.mjJNT_BALL): "ball"}
_UNHELD = {
    "tendons": "tendons", "sensors": "sensors", "sites": "sites", "keys": "keyframes", "pairs": "contact pairs",
    "excludes": "contact exclusions", "flexes": "flexible bodies", "skins": "skins", "hfields": "height fields",
    "cameras": "cameras", "plugins": "plugins", "tuples": "tuples",
}  # fmt: skip
"""What a specification lists that a robot does not hold."""


def read_mjcf(path: Path, *_: Any) -> Robot:
    """Read an MJCF, whatever is given beside it; a body with several joints becomes a chain of links.

    Raises:
        DescriptionError: MuJoCo does not open it.
    """
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        model, omitted = _compiled(spec)
    except ValueError as error:
        raise DescriptionError(f"MuJoCo does not read {path}: {' '.join(str(error).split())}. Correct it.") from error
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    names = [_called(model.body(k).name, "body", k) if k else WORLD for k in range(model.nbody)]
    lines = {kind: {item.id: _line(item) for item in getattr(spec, kind)} for kind in ("bodies", "joints", "geoms")}
    losses: Losses = defaultdict(list)
    for kind, what in _UNHELD.items():
        if found := getattr(spec, kind, ()):
            losses[what] = [str(getattr(item, "name", "")) for item in found]
    bodies: list[Link] = []
    edges: list[Edge] = []
    notes = [*omitted.values(), *_joint_notes(model, losses)]
    mimics, shapes = _followers(model, losses), _shapes(model, lines["geoms"], losses)
    loops = _loops(model, names, losses)
    for k, name in enumerate(names):
        above, line = _chain(model, k, names), lines["bodies"].get(k, 0)
        bodies += [Link(name=joint.child, line=line) for joint, _ in above[:-1]]
        seen, felt = shapes[k]
        bodies.append(Link(name=name, inertial=_inertial(model, k, line), visuals=seen, collisions=felt, line=line))
        first = int(model.body_jntadr[k])
        edges += [
            (replace(joint, mimic=mimics.get(joint.name), line=lines["joints"].get(first + number, line)), anchor)
            for number, (joint, anchor) in enumerate(above)
        ]
    poses = {name: _pose(data.xpos[k], data.xquat[k]) for k, name in enumerate(names)}
    title = spec.modelname or path.stem
    robot = tree_of(title, path, bodies, edges, poses=poses, loops=loops, notes=notes, losses=losses)
    return replace(robot, apart=_apart(model, names))


def _apart(model: Any, names: list[str]) -> frozenset[frozenset[str]]:
    """Pairs of bodies whose shapes `contype` and `conaffinity`, an `exclude` or a switch keep from colliding."""
    kinds, masks, body = model.geom_contype, model.geom_conaffinity, model.geom_bodyid
    acting = np.argwhere((kinds[:, None] & masks) | (kinds & masks[:, None]))
    listed = np.column_stack([model.pair_geom1, model.pair_geom2])
    excluded = {frozenset((int(pair) >> 16, int(pair) & 0xFFFF)) for pair in model.exclude_signature}
    meeting = {frozenset(pair) for pair in body[acting].tolist()} - excluded
    meeting |= {frozenset(pair) for pair in body[listed].tolist()}
    if model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_CONTACT:
        meeting = set()
    pairs = combinations(sorted({*body[(kinds | masks) > 0].tolist()}), 2)
    return frozenset(frozenset(names[k] for k in pair) for pair in pairs if frozenset(pair) not in meeting)


def _compiled(spec: Any) -> tuple[Any, dict[str, str]]:
    """Compile a specification without the pictures and skins at which MuJoCo stops; a sentence for each by its name."""
    omitted: dict[str, str] = {}
    while True:
        try:
            return spec.compile(), omitted
        except ValueError as error:
            said = str(error)
            for found in (*spec.textures, *spec.skins):
                if any(f"{Path(file).name}'" in said for file in (found.file, *getattr(found, "cubefiles", ()))):
                    break
            else:
                raise
            what = f"{type(found).__name__.removeprefix('Mjs').lower()} {found.name}"
            line, reason = _line(found), said.splitlines()[0]
            omitted[found.name] = f"The {what} is omitted (line {line}), since MuJoCo refuses it: {reason}."
            for material in spec.materials:
                material.textures = ["" if name == found.name else name for name in material.textures]
            spec.delete(found)


def write_repaired(path: Path, out: Path) -> Path:
    """Write an MJCF without the pictures and skins that MuJoCo refuses, by its text: MuJoCo itself writes six digits.

    Raises:
        ValueError: MuJoCo refuses the file for something else.
    """
    _, omitted = _compiled(mujoco.MjSpec.from_file(str(path)))
    root = etree.parse(path).getroot()
    for item in [*root.iter("texture", "skin", "layer")]:
        name = item.get("texture") or item.get("name") or Path(item.get("file", "")).stem
        if name in omitted:
            item.getparent().remove(item)
    for material in root.iter("material"):
        if material.get("texture") in omitted:
            del material.attrib["texture"]
    for include in root.iter("include"):
        include.set("file", str(path.parent / include.get("file", "")))
    places = {str(key): str(value) for item in root.iter("compiler") for key, value in item.items()}
    folders = {key: str(path.parent / places.get(key, places.get("assetdir", ""))) for key in ("meshdir", "texturedir")}
    etree.SubElement(root, "compiler", folders)
    out.write_bytes(etree.tostring(root))
    return out


def _called(name: str, kind: str, number: int) -> str:
    return name or f"{kind}_{number}"


def _line(item: Any) -> int:
    """Where the main file declares it; 0 for what an included file does."""
    words = str(item.info).split()
    return int(words[-1]) if words and words[-1].isdecimal() else 0


def _pose(position: FloatArray, quaternion: FloatArray) -> FloatArray:
    return pose_at(position, rotation_from_quaternion(np.asarray(quaternion, dtype=np.float64)))


def _chain(model: Any, body: int, names: list[str]) -> list[Edge]:
    """Joints between a body and its parent, the upper first; links without mass are between them."""
    if body == 0:
        return []
    parent, name = names[model.body_parentid[body]], names[body]
    T_above = _pose(model.body_pos[body], model.body_quat[body])
    first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
    if not count:
        return [
            (
                Joint(name=f"{name}_fixed", kind=JointType.FIXED, parent=parent, child=name, T_parent_child=T_above),
                np.eye(4),
            )
        ]
    edges: list[Edge] = []
    for k in range(first, first + count):
        child = name if k == first + count - 1 else f"{name}_{k - first + 1}"
        anchor = pose_at(model.jnt_pos[k])
        joint = _joint(model, k, parent, child)
        start = joint_motion(joint.kind, joint.axis, np.zeros(3), -_reference(model, k))
        edges.append((replace(joint, T_parent_child=T_above @ anchor @ start), anchor))
        parent, T_above = child, np.eye(4)
    return edges


def _joint_notes(model: Any, losses: Losses) -> list[str]:
    """What joints are that ours are not."""
    notes = []
    for k in range(model.njnt):
        kind, name = int(model.jnt_type[k]), _called(model.joint(k).name, "joint", k)
        if kind in _FREE:
            notes.append(f"The {_FREE[kind]} joint {name} is read as fixed.")
        elif model.jnt_stiffness[k].any():
            losses["springs of joints"].append(name)
    several = [_called(model.body(k).name, "body", k) for k in range(model.nbody) if model.body_jntnum[k] > 1]
    if several:
        notes.append(f"Bodies with several joints are chains of links without mass: {', '.join(several)}.")
    return notes


def _reference(model: Any, joint: int) -> float:
    """Value of a joint where its body stands as the file places it [rad or m]."""
    return 0.0 if int(model.jnt_type[joint]) in _FREE else float(model.qpos0[model.jnt_qposadr[joint]])


def _joint(model: Any, k: int, parent: str, child: str) -> Joint:
    kind, name, dof = int(model.jnt_type[k]), _called(model.joint(k).name, "joint", k), int(model.jnt_dofadr[k])
    ends: dict[str, Any] = {"name": name, "parent": parent, "child": child}
    T = np.eye(4)
    if kind in _FREE:
        return Joint(**ends, kind=JointType.FIXED, T_parent_child=T, declared_kind=_FREE[kind])
    turns, limited = kind == int(mujoco.mjtJoint.mjJNT_HINGE), bool(model.jnt_limited[k])
    return Joint(
        **ends,
        kind=(JointType.REVOLUTE if limited else JointType.CONTINUOUS) if turns else JointType.PRISMATIC,
        T_parent_child=T,
        axis=model.jnt_axis[k].copy(),
        lower=float(model.jnt_range[k, 0]) if limited else -np.inf,
        upper=float(model.jnt_range[k, 1]) if limited else np.inf,
        has_limit=limited,
        effort=_effort(model, k),
        damping=float(np.ravel(model.dof_damping[dof])[0]) or None,
        friction=float(np.ravel(model.dof_frictionloss[dof])[0]) or None,
    )


def _effort(model: Any, joint: int) -> float | None:
    """The largest force of a joint's actuators, as far as the file bounds it [N m or N]."""
    if model.jnt_actfrclimited[joint]:
        return float(np.abs(model.jnt_actfrcrange[joint]).max())
    found = []
    for k in range(model.nu):
        kinds = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
        if int(model.actuator_trntype[k]) not in kinds or int(model.actuator_trnid[k, 0]) != joint:
            continue
        gear = abs(float(model.actuator_gear[k, 0]))
        if model.actuator_forcelimited[k]:
            found.append(gear * float(np.abs(model.actuator_forcerange[k]).max()))
        elif model.actuator_ctrllimited[k] and not model.actuator_biasprm[k].any():  # a motor, no servo
            found.append(
                gear * abs(float(model.actuator_gainprm[k, 0])) * float(np.abs(model.actuator_ctrlrange[k]).max())
            )
    return max(found, default=0.0) or None


def _inertial(model: Any, body: int, line: int) -> Inertial | None:
    if body == 0 or not model.body_mass[body] > 0.0:
        return None
    (xx, yy, zz), T = model.body_inertia[body].tolist(), _pose(model.body_ipos[body], model.body_iquat[body])
    return inertial_of(float(model.body_mass[body]), T, (xx, 0.0, 0.0, yy, 0.0, zz), line)


def _shapes(model: Any, lines: dict[int, int], losses: Losses) -> list[tuple[tuple[Shape, ...], tuple[Shape, ...]]]:
    """What is seen and what collides of every body."""
    found: list[tuple[list[Shape], list[Shape]]] = [([], []) for _ in range(model.nbody)]
    for k in range(model.ngeom):
        color = model.mat_rgba[model.geom_matid[k]] if model.geom_matid[k] >= 0 else model.geom_rgba[k]
        shape = _shape(model, k, tuple(map(float, color)), lines.get(k, 0))
        if shape is None:
            kind = _GEOMS(int(model.geom_type[k])).name.removeprefix("mjGEOM_").lower()
            losses[f"geoms of the type {kind}"].append(model.geom(k).name)
            continue
        seen, felt = found[int(model.geom_bodyid[k])]
        collides = bool(model.geom_contype[k] or model.geom_conaffinity[k])
        if collides:
            felt.append(shape)
        if model.geom_group[k] < _SEEN_GROUPS or not collides:
            seen.append(shape)
    return [(tuple(seen), tuple(felt)) for seen, felt in found]


def _shape(model: Any, k: int, color: tuple[float, ...], line: int) -> Shape | None:
    T, size, kind = _pose(model.geom_pos[k], model.geom_quat[k]), model.geom_size[k].tolist(), int(model.geom_type[k])
    sizes = {
        int(_GEOMS.mjGEOM_SPHERE): ("sphere", (size[0],)),
        int(_GEOMS.mjGEOM_CAPSULE): ("capsule", (size[0], 2.0 * size[1])),
        int(_GEOMS.mjGEOM_CYLINDER): ("cylinder", (size[0], 2.0 * size[1])),
        int(_GEOMS.mjGEOM_BOX): ("box", tuple(2.0 * half for half in size)),
    }
    rgba = (color[0], color[1], color[2], color[3])
    if kind in sizes:
        return primitive(*sizes[kind], T, rgba, line)
    if kind == int(_GEOMS.mjGEOM_ELLIPSOID):
        return ellipsoid(size, T, rgba, line)
    if kind != int(_GEOMS.mjGEOM_MESH):
        return None
    mesh = int(model.geom_dataid[k])
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    face, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    vertices = model.mesh_vert[first : first + count].astype(np.float64)
    return mesh_shape(vertices, model.mesh_face[face : face + faces], T, rgba, line)


def _equalities(model: Any, kind: Any) -> Iterator[int]:
    return (k for k in range(model.neq) if int(model.eq_type[k]) == int(kind) and model.eq_active0[k])


def _followers(model: Any, losses: Losses) -> dict[str, Mimic]:
    """Rules of the joints that follow another one along a line, by joint."""
    found = {}
    for k in _equalities(model, mujoco.mjtEq.mjEQ_JOINT):
        follower, leader = int(model.eq_obj1id[k]), int(model.eq_obj2id[k])
        offset, slope, *curved = model.eq_data[k, :5].tolist()
        name = _called(model.joint(follower).name, "joint", follower)
        if leader < 0 or any(curved) or name in found:
            losses["equalities of joints that are no line"].append(name)
            continue
        start = _reference(model, follower) + offset - slope * _reference(model, leader)
        found[name] = Mimic(joint=_called(model.joint(leader).name, "joint", leader), multiplier=slope, offset=start)
    return found


def _loops(model: Any, names: list[str], losses: Losses) -> list[LoopJoint]:
    """Bodies that share a point."""
    found = []
    for k in _equalities(model, mujoco.mjtEq.mjEQ_CONNECT):
        called = _called(model.equality(k).name, "equality", k)
        if int(model.eq_objtype[k]) != int(mujoco.mjtObj.mjOBJ_BODY):
            losses["equalities between sites"].append(called)
            continue
        links = (names[model.eq_obj1id[k]], names[model.eq_obj2id[k]])
        points = (model.eq_data[k, :3].copy(), model.eq_data[k, 3:6].copy())
        found.append(LoopJoint(name=called, links=links, points=points))
    others = (mujoco.mjtEq.mjEQ_WELD, mujoco.mjtEq.mjEQ_TENDON, mujoco.mjtEq.mjEQ_FLEX)
    for k in (k for kind in others for k in _equalities(model, kind)):
        losses["equalities that weld bodies or hold tendons"].append(model.equality(k).name)
    return found
