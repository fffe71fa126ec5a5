"""From a URDF to a `Robot`: strict where a mistake would change the mechanism, tolerant where files commonly differ."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np
from lxml import etree

from kinematify.errors import DescriptionError
from kinematify.robot.description import form_of, read_foreign
from kinematify.robot.joint_type import FREE_KINDS, JointType
from kinematify.robot.linkage import with_closures
from kinematify.robot.robot import (
    Joint,
    Link,
    LoopJoint,
    Mimic,
    Robot,
    UpAxis,
    forward_kinematics,
    inertial_of,
    rest_configuration,
)
from kinematify.robot.transforms import transformed
from kinematify.robot.urdf_geometry import geometry_source
from kinematify.robot.urdf_numbers import MOMENTS, line_of, number, optional_number, origin_transform, vector
from kinematify.robot.urdf_text import parse_description, parse_text
from kinematify.robot.vectors import lengths_of, triangle_normals

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.urdf_geometry import GeometrySource

    Geometry = Literal["all", "shown", "parts", "none"]
    from kinematify.robot.robot import Inertial, LinkMesh


def read_robot(
    path: Path,
    *,
    package_dirs: Sequence[Path] = (),
    geometry: Geometry = "all",
    appearance: bool = False,
    arguments: Mapping[str, str] | None = None,
) -> Robot:
    """Read a URDF, xacro, MJCF, SDF or USD; every mesh file is opened once.

    ``package://NAME/...`` is looked up in `package_dirs` (each a package or a folder of packages), then in the folders
    above the URDF. Floating and planar joints represent a body that is free in the world: above the first geometry they
    are read as fixed, elsewhere they are refused. A revolute joint without limits is continuous. COLLADA meshes that
    state another axis than z as the one that points up are turned where links meet only then. A visual or collision
    without usable geometry, such as a mesh that is missing, is left out. Each such reading is a note in the result.

    Args:
        path: The file.
        package_dirs: Where packages lie.
        geometry: ``shown`` leaves out the collision shapes of links that have visual ones, ``none`` opens no mesh file
            and gives links without any shapes. ``parts`` is ``shown`` for those who ask which links are one body and
            where they stand: what else a joint or an inertial states may be malformed, which is a note.
        appearance: Read materials, textures and colours of a URDF's meshes too.
        arguments: Of a xacro.

    Raises:
        DescriptionError: The file cannot be read, or is not a kinematic tree of single-axis joints. The message names
            the link or joint and says what to do.
    """
    source, form = geometry_source(path, package_dirs, appearance=appearance), form_of(path)
    if form == "urdf":
        return parse_robot(parse_description(path), path, source, geometry)
    read = read_foreign(path, form, package_dirs, arguments or {})
    if isinstance(read, str):
        return parse_robot(parse_text(read.encode()), path, source, geometry)
    robot: Robot = read
    return replace(robot, links=tuple(_without_hidden(link, geometry) for link in robot.links))


def _without_hidden(link: Link, geometry: Geometry) -> Link:
    if geometry == "none":
        return replace(link, visuals=(), collisions=())
    return replace(link, collisions=()) if link.visuals and geometry != "all" else link


def parse_robot(element: _Element, path: Path, source: GeometrySource, geometry: Geometry = "all") -> Robot:
    """Do the work of `read_robot` on a parsed document with a source that may have opened the mesh files already.

    Args:
        element: What `parse_description` returned.
        path: The URDF file.
        source: Where meshes are looked up.
        geometry: As for `read_robot`.

    Raises:
        DescriptionError: As for `read_robot`.
    """
    spared = source.omitted if geometry == "parts" else None
    joints = tuple(_joint(item, spared) for item in element.findall("joint"))
    names = [_name(item) for item in element.findall("link")]
    _check_tree(path, names, joints)
    try:
        _check_mimics(joints)
    except DescriptionError as error:
        _spared(error, spared)
        joints = tuple(replace(joint, mimic=None) for joint in joints)
    links = _links(element, source, geometry)
    robot = Robot(
        name=element.get("name") or path.stem,
        links=links,
        joints=joints,
        loops=tuple(_loop(item, names) for item in element.iterchildren("*") if etree.QName(item).localname in _LOOPS),
        path=path.resolve(),
        notes=(*(note for joint in joints if (note := _note(joint))), *source.omitted),
        lacking=frozenset(source.lacking),
    )
    if source.states_up_axis:
        robot = upright_reading(
            robot, replace(robot, links=_links(element, replace(source, heeds_up_axis=True), geometry))
        )
    _check_free_joints(robot, [joint for joint in joints if joint.declared_kind in FREE_KINDS])
    return with_closures(robot) if robot.loops else robot


def _links(element: _Element, source: GeometrySource, geometry: Geometry) -> tuple[Link, ...]:
    return tuple(_link(item, source, geometry) for item in element.findall("link"))


def _link(element: _Element, source: GeometrySource, geometry: Geometry) -> Link:
    visuals = () if geometry == "none" else source.shapes(element, "visual")
    hidden = geometry == "none" or (geometry != "all" and visuals)
    return Link(
        name=_name(element),
        inertial=_inertial(element, source.omitted if geometry == "parts" else None),
        visuals=visuals,
        collisions=() if hidden else source.shapes(element, "collision"),
        line=line_of(element),
    )


def _name(element: _Element) -> str:
    name = element.get("name")
    if not name:
        raise DescriptionError(f"A <{element.tag}> in line {element.sourceline} has no name. Name it.")
    return name


def _spared(error: DescriptionError, spared: dict[str, None] | None) -> None:
    """Make an error a note of those who do not need what is malformed; raise it for all others."""
    if spared is None:
        raise error
    spared[f"Not read, and not needed here: {error}"] = None


def _inertial(link: _Element, spared: dict[str, None] | None) -> Inertial | None:
    element = link.find("inertial")
    if element is None:
        return None
    where = f"link {link.get('name')} (line {line_of(element)})"
    mass, inertia = element.find("mass"), element.find("inertia")
    try:
        moments = [0.0 if inertia is None else number(inertia, key, 0.0, where) for key in MOMENTS]
        stated = 0.0 if mass is None else number(mass, "value", 0.0, where)
        return inertial_of(stated, origin_transform(element, where), moments, line_of(element))
    except DescriptionError as error:
        _spared(error, spared)
        return None


def _joint(element: _Element, spared: dict[str, None] | None) -> Joint:
    name = _name(element)
    where = f"joint {name} (line {line_of(element)})"
    placed = Joint(
        name=name,
        kind=JointType.CONTINUOUS,
        parent=_end(element, "parent", where),
        child=_end(element, "child", where),
        T_parent_child=origin_transform(element, where),
        declared_kind=element.get("type") or "",
        line=line_of(element),
    )
    try:
        return _with_motion(placed, element, where)
    except DescriptionError as error:
        _spared(error, spared)
        kind = JointType.FIXED if placed.declared_kind == JointType.FIXED else JointType.CONTINUOUS
        return replace(placed, kind=kind, declared_kind=kind)


def _with_motion(joint: Joint, element: _Element, where: str) -> Joint:
    kind, lower, upper = _kind_and_limits(element, joint.declared_kind, where)
    return replace(
        joint,
        kind=kind,
        axis=_axis(element, kind, where),
        lower=lower,
        upper=upper,
        mimic=None if kind is JointType.FIXED else _mimic(element, where),
        has_limit=element.find("limit") is not None,
        effort=optional_number(element, "limit", "effort", where),
        velocity=optional_number(element, "limit", "velocity", where),
        damping=optional_number(element, "dynamics", "damping", where),
        friction=optional_number(element, "dynamics", "friction", where),
    )


_ENDLESS = 1e6
"""Limits beyond this are none [rad]."""
_LOOPS = {
    "loop_joint": (("link1", "link", "link1", "xyz"), ("link2", "link", "link2", "xyz")),
    "ball_constraint": (
        ("ball_constraint_body_A", "name", "ball_constraint_p_AP", "value"),
        ("ball_constraint_body_B", "name", "ball_constraint_p_BQ", "value"),
    ),
}
"""What closes a chain (Isaac Sim, `drake:ball_constraint`): where both ends name their link, and their point."""


def _loop(element: _Element, known: Sequence[str]) -> LoopJoint:
    tag = etree.QName(element).localname
    children = {etree.QName(child).localname: child for child in element}
    ends = []
    for link_tag, link_key, point_tag, point_key in _LOOPS[tag]:
        link = children[link_tag].get(link_key) if link_tag in children else None
        if link not in known or link is None:
            raise DescriptionError(
                f"The {tag} {element.get('name', '')} in line {element.sourceline} joins the link {link!r}. Name two "
                "links of the file."
            )
        point = children.get(point_tag)
        place = np.zeros(3) if point is None else vector(point, point_key, (0.0, 0.0, 0.0), f"{tag} of {link}")
        ends.append((link, place))
    (first, one), (second, other) = ends
    return LoopJoint(name=element.get("name") or f"{second}_loop", links=(first, second), points=(one, other))


def _kind_and_limits(element: _Element, declared: str, where: str) -> tuple[JointType, float, float]:
    """A hinge without limits, or with some so far to both sides that they are none, as Gazebo's 1e16, is continuous."""
    if declared not in (*JointType, *FREE_KINDS):
        known = ", ".join([*JointType, *FREE_KINDS])
        raise DescriptionError(f"The {where} has the type {declared!r}; URDF knows {known}. Correct it.")
    kind = JointType.FIXED if declared in FREE_KINDS else JointType(declared)
    if kind is JointType.FIXED:
        return kind, 0.0, 0.0
    limit = element.find("limit")
    if limit is None and kind is JointType.PRISMATIC:
        raise DescriptionError(f"The prismatic {where} has no <limit>. Give it lower and upper in metres.")
    if limit is None or kind is JointType.CONTINUOUS:
        return JointType.CONTINUOUS, -np.inf, np.inf
    lower, upper = (number(limit, end, 0.0, where) for end in ("lower", "upper"))
    if kind.turns and lower < -_ENDLESS and upper > _ENDLESS:
        return JointType.CONTINUOUS, -np.inf, np.inf
    if lower > upper:
        raise DescriptionError(f"The {where} has the lower limit {lower} above the upper limit {upper}. Swap them.")
    return kind, lower, upper


def _note(joint: Joint) -> str:
    if joint.declared_kind in FREE_KINDS:
        return f"The {joint.declared_kind} joint {joint.name} above the root body is read as fixed."
    if joint.declared_kind != joint.kind:
        return f"The revolute joint {joint.name} has no limits, or endless ones, and is read as continuous."
    return ""


def _end(element: _Element, tag: str, where: str) -> str:
    end = element.find(tag)
    link = None if end is None else end.get("link")
    if not link:
        raise DescriptionError(f'The {where} names no {tag} link. Add <{tag} link="..."/>.')
    return link


def _axis(element: _Element, kind: JointType, where: str) -> FloatArray:
    default = (1.0, 0.0, 0.0)
    axis = element.find("axis")
    if kind is JointType.FIXED or axis is None:
        return np.array(default)
    direction = vector(axis, "xyz", default, where)
    length = float(np.linalg.norm(direction))
    if length == 0.0:
        raise DescriptionError(f"The {where} has an axis of zero length. Give it a direction.")
    return direction / length


def _mimic(element: _Element, where: str) -> Mimic | None:
    mimic = element.find("mimic")
    if mimic is None:
        return None
    return Mimic(
        joint=mimic.get("joint") or "",
        multiplier=number(mimic, "multiplier", 1.0, where),
        offset=number(mimic, "offset", 0.0, where),
    )


def _check_tree(path: Path, links: Sequence[str], joints: Sequence[Joint]) -> None:
    """One root, one parent per link, no cycle, every name once and every reference resolved."""
    _check_unique(path, "links", links)
    _check_unique(path, "joints", (joint.name for joint in joints))
    _check_ends(path, set(links), joints)
    below = defaultdict(list)
    for joint in joints:
        below[joint.parent].append(joint.child)
    children = {joint.child for joint in joints}
    roots = [link for link in links if link not in children]
    if not links:
        raise DescriptionError(f"The description {path} holds no link. Give a URDF with at least one.")
    if len(roots) > 1:
        raise DescriptionError(
            f"The description {path} has {len(roots)} root links: {', '.join(roots[:8])}. Join them to one with fixed "
            "joints, or split the file."
        )
    reached = roots
    for link in reached:
        reached += below[link]
    if cycle := [link for link in links if link not in {*reached}]:
        raise DescriptionError(
            f"Links of {path} form a cycle or hang on one: {', '.join(cycle[:8])}. A URDF is a tree: cut one joint."
        )


def _check_unique(path: Path, what: str, names: Iterable[str]) -> None:
    name, count = max(Counter(names).items(), key=lambda item: item[1], default=("", 0))
    if count > 1:
        raise DescriptionError(f"The description {path} has {count} {what} named {name!r}. Names must be unique.")


def _check_ends(path: Path, links: set[str], joints: Sequence[Joint]) -> None:
    carried: dict[str, str] = {}
    for joint in joints:
        for end in (joint.parent, joint.child):
            if end not in links:
                raise DescriptionError(
                    f"The joint {joint.name} in {path} connects the link {end!r}, which is not there. Correct the name."
                )
        if joint.child in carried:
            raise DescriptionError(
                f"The link {joint.child} in {path} hangs on two joints, {carried[joint.child]} and {joint.name}. A "
                "URDF is a tree: cut one of them."
            )
        carried[joint.child] = joint.name


def _check_mimics(joints: Sequence[Joint]) -> None:
    by_name = {joint.name: joint for joint in joints}
    for joint in joints:
        chain = [joint]
        while (mimic := chain[-1].mimic) is not None:
            if mimic.joint not in by_name:
                raise DescriptionError(
                    f"The joint {chain[-1].name} mimics {mimic.joint!r}, which is not there. Correct the name."
                )
            if by_name[mimic.joint] in chain:
                names = " -> ".join(item.name for item in (*chain, by_name[mimic.joint]))
                raise DescriptionError(f"The mimic joints {names} follow each other in a circle. Let one of them lead.")
            chain.append(by_name[mimic.joint])


def _check_free_joints(robot: Robot, free: Sequence[Joint]) -> None:
    for joint in free:
        above = [joint.parent]
        while above[-1] in robot.joint_above:
            above.append(robot.joint_above[above[-1]].parent)
        solid = next((link for link in above if robot.link_by_name[link].has_geometry), None)
        if solid is not None:
            raise DescriptionError(
                f"The joint {joint.name} lets {joint.child} move freely (floating or planar) below the link {solid}. "
                "Only joints with one axis are supported there: describe it as several joints, or as two robots."
            )


_CLOSES = 0.25
"""The axis is respected where that leaves less than this share of the gaps."""
_GAP = 0.01
"""Where gaps are smaller than this fraction of the model's size, nothing speaks against the usual reading."""
_POINTS = 800
"""Points of a link that gaps are measured between."""


def upright_reading(ignored: Robot, respected: Robot) -> Robot:
    """Return the reading of a model in which its links meet, with what was measured.

    Over the published models that state such an axis, links meet with it ignored in five files of six, as RViz reads
    them; in the sixth they are a tenth of the model apart that way.

    Args:
        ignored: The model with all meshes as their numbers stand.
        respected: The same with meshes turned upright whose files say that they lie.
    """
    apart = _mean_gap(ignored), _mean_gap(respected)
    size = float(np.linalg.norm(np.ptp(np.concatenate(list(_points(ignored).values())), axis=0)))
    closes = apart[1] < _CLOSES * apart[0] and apart[0] > _GAP * size
    reading = UpAxis(respected=closes, gap_ignored=apart[0], gap_respected=apart[1])
    if not closes:
        return replace(ignored, up_axis=reading)
    note = "The up axis of the COLLADA meshes is applied, because the links meet only with it."
    return replace(respected, notes=(*respected.notes, note), up_axis=reading)


def _mean_gap(robot: Robot) -> float:
    """Mean distance at rest of links from what carries them [m]; 0 where nothing carries anything."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second, and few files state an axis

    points, gaps = _points(robot), []
    for joint in robot.joints:
        parent = joint.parent
        while parent not in points and parent in robot.joint_above:
            parent = robot.joint_above[parent].parent
        if parent in points and joint.child in points:
            gaps.append(float(cKDTree(points[parent]).query(points[joint.child])[0].min()))
    return float(np.mean(gaps)) if gaps else 0.0


def _points(robot: Robot) -> dict[str, FloatArray]:
    """Return points on what is seen of each link at rest, in the frame of the root [m], shape (k, 3) each."""
    poses = forward_kinematics(robot, rest_configuration(robot))
    points = {}
    for link in robot.links:
        on = [_on_surface(shape.mesh) for shape in link.visuals or link.collisions if len(shape.mesh.faces)]
        if on:
            points[link.name] = transformed(np.concatenate(on), poses[link.name])
    return points


def _on_surface(mesh: LinkMesh) -> FloatArray:
    """Return points drawn uniformly by area, the same on the same faces wherever they stand [m], shape (k, 3)."""
    draw = np.random.default_rng(0)
    corners = mesh.vertices[mesh.faces]
    areas = lengths_of(triangle_normals(corners))
    if not areas.sum() > 0.0:
        return mesh.vertices[:_POINTS]
    face = corners[draw.choice(len(areas), _POINTS, p=areas / areas.sum())]
    root, share = np.sqrt(draw.random((_POINTS, 1))), draw.random((_POINTS, 1))
    points: FloatArray = face[:, 0] * (1.0 - root) + face[:, 1] * root * (1.0 - share) + face[:, 2] * root * share
    return points
