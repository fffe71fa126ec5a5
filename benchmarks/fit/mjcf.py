"""Part of an MJCF scene as a `Robot`, compiled by MuJoCo: includes, classes and frames are what they are there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from lxml import etree

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Joint, Link, LinkMesh, Robot, Shape
from kinematify.robot.urdf_geometry import primitive

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.robot.arrays import FloatArray, IntArray

_HIDDEN = 3
"""Geoms of this group and higher are hidden where MuJoCo shows a model: collision geometry."""
_TURN = 2.0 * np.pi
_KINDS = {mujoco.mjtJoint.mjJNT_HINGE: JointType.REVOLUTE, mujoco.mjtJoint.mjJNT_SLIDE: JointType.PRISMATIC}
_ENDLESS = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD)
_LOOKS = ("texture", "material", "skin", "region")
"""Elements that say nothing about shape or motion; some packages name their files twice, or not at all."""


def read_mjcf(document: _Element, path: Path, bodies: Sequence[str]) -> Robot:
    """Read the trees of some bodies of a scene; link frames are parallel to the world at the joints.

    Bodies without a joint belong to the body that carries them, and the first body's own joints are omitted: it is the
    base link. Zero is the configuration in which the model is drawn. Geometry is what is shown; where two sorts are,
    what collides is omitted.

    Args:
        document: The MJCF.
        path: Where it is; includes and meshes are looked up beside it.
        bodies: Names, or numbers as text where a body has no name; ``world`` for what stands still beside the trees.

    Raises:
        ValueError: MuJoCo cannot read the file, or a body is not in it.
    """
    model = _compiled(document, path)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    roots = [_body(model, name) for name in bodies]
    group_of = _rigid_groups(model, roots)
    origins = {roots[0]: np.zeros(3)}
    joints = []
    for body in sorted(set(group_of.values()) - {roots[0]}):
        above = group_of.get(int(model.body_parentid[body]), roots[0])
        for number, joint in enumerate(_joints(model, body)):
            origins[body] = data.xanchor[joint]
            if number:
                raise ValueError(f"The body {_name(model, body)} of {path} has several joints. Name another body.")
            joints.append(_joint(model, data, joint, above, origins[body] - origins[above]))
    links = [
        Link(
            name=_name(model, group),
            visuals=tuple(_shape(model, data, geom, origins[group]) for geom in _shown(model, group_of, group)),
        )
        for group in (roots[0], *sorted(set(group_of.values()) - {roots[0]}))
    ]
    return Robot(name=path.stem, links=tuple(links), joints=tuple(joints))


def _compiled(document: _Element, path: Path) -> mujoco.MjModel:
    """The model; looks are taken out first where the file stands alone."""
    if document.find(".//include") is not None:
        return mujoco.MjModel.from_xml_path(str(path))
    for element in [*document.iter(*_LOOKS)]:
        parent = element.getparent()
        if parent is not None:
            parent.remove(element)
    for element in document.iter("geom", "site"):
        element.attrib.pop("material", "")
    for element in document.iter("compiler"):
        element.attrib.pop("inertiagrouprange", "")  # bodies of shown geometry alone would have no mass
    etree.SubElement(document, "compiler", boundmass="1e-3", boundinertia="1e-6", balanceinertia="true")
    spec = mujoco.MjSpec.from_string(etree.tostring(document, encoding="unicode"))
    spec.modelfiledir = str(path.parent)
    return spec.compile()


def _body(model: mujoco.MjModel, name: str) -> int:
    number = int(name) if name.isdigit() else mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
    if not 0 <= number < model.nbody:
        raise ValueError(f"The scene has no body {name}.")
    return number


def _name(model: mujoco.MjModel, body: int) -> str:
    return (model.body(body).name or f"body_{body}").replace(" ", "_").replace("/", "_").replace(":", "_")


def _joints(model: mujoco.MjModel, body: int) -> list[int]:
    first = int(model.body_jntadr[body])
    return [] if first < 0 else [*range(first, first + int(model.body_jntnum[body]))]


def _rigid_groups(model: mujoco.MjModel, roots: Sequence[int]) -> dict[int, int]:
    """Body -> the body whose joint moves it, over all bodies of the trees; parents come before children in MuJoCo."""
    group_of: dict[int, int] = {}
    for body in range(model.nbody):
        parent = int(model.body_parentid[body])
        if body == roots[0]:
            group_of[body] = body
        elif body in roots or (parent in group_of and parent != 0):
            moves = bool(_joints(model, body))
            group_of[body] = body if moves else group_of.get(parent, roots[0])
    return group_of


def _joint(model: mujoco.MjModel, data: mujoco.MjData, joint: int, parent: int, place: FloatArray) -> Joint:
    """The joint whose frame stands at `place` in the parent's [m], shape (3,)."""
    child = int(model.jnt_bodyid[joint])
    kind = _KINDS.get(mujoco.mjtJoint(int(model.jnt_type[joint])))
    if kind is None:
        raise ValueError(f"The body {_name(model, child)} moves freely. Name the bodies of one object.")
    drawn = float(model.qpos0[model.jnt_qposadr[joint]])
    lower, upper = (model.jnt_range[joint] - drawn).tolist() if model.jnt_limited[joint] else (-np.inf, np.inf)
    if kind is JointType.REVOLUTE and upper - lower >= _TURN:
        kind, lower, upper = JointType.CONTINUOUS, -np.inf, np.inf
    if kind is JointType.PRISMATIC and not np.isfinite(upper):
        lower, upper = -1.0, 1.0
    T_parent_child = np.eye(4)
    T_parent_child[:3, 3] = place
    return Joint(
        name=(model.joint(joint).name or f"{_name(model, child)}_joint").replace(" ", "_"),
        kind=kind,
        parent=_name(model, parent),
        child=_name(model, child),
        T_parent_child=T_parent_child,
        axis=data.xaxis[joint].copy(),
        lower=lower,
        upper=upper,
    )


def _shown(model: mujoco.MjModel, group_of: dict[int, int], group: int) -> list[int]:
    """Geoms of a rigid group that a person sees."""
    geoms = [
        geom
        for geom in range(model.ngeom)
        if group_of.get(int(model.geom_bodyid[geom])) == group
        and mujoco.mjtGeom(int(model.geom_type[geom])) not in _ENDLESS
    ]
    visible = [geom for geom in geoms if model.geom_group[geom] < _HIDDEN and model.geom_rgba[geom][3] > 0.0]
    drawn = [geom for geom in visible if not (model.geom_contype[geom] or model.geom_conaffinity[geom])]
    return drawn or visible or geoms


def _shape(model: mujoco.MjModel, data: mujoco.MjData, geom: int, origin: FloatArray) -> Shape:
    T_link_geom = np.eye(4)
    T_link_geom[:3, :3] = data.geom_xmat[geom].reshape(3, 3)
    T_link_geom[:3, 3] = data.geom_xpos[geom] - origin
    kind, size = mujoco.mjtGeom(int(model.geom_type[geom])), model.geom_size[geom].tolist()
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return primitive("box", tuple(2.0 * length for length in size), T_link_geom)
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return primitive("sphere", (size[0],), T_link_geom)
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        return primitive("cylinder", (size[0], 2.0 * size[1]), T_link_geom)
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        return primitive("capsule", (size[0], 2.0 * size[1]), T_link_geom)
    vertices, faces = _ellipsoid(size) if kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID else _mesh(model, geom)
    placed = vertices @ T_link_geom[:3, :3].T + T_link_geom[:3, 3]
    return Shape(mesh=LinkMesh(vertices=placed, faces=faces), T_link_shape=T_link_geom)


def _ellipsoid(radii: Sequence[float]) -> tuple[FloatArray, IntArray]:
    sphere = primitive("sphere", (1.0,), np.eye(4)).mesh
    return sphere.vertices * np.asarray(radii), sphere.faces


def _mesh(model: mujoco.MjModel, geom: int) -> tuple[FloatArray, IntArray]:
    mesh = int(model.geom_dataid[geom])
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    face, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    return (
        model.mesh_vert[first : first + count].astype(np.float64),
        model.mesh_face[face : face + faces].astype(np.int64),
    )
