"""From an SDF to a `Robot`: the model of a file, or the one with most joints of a world; frames of SDF 1.4 to 1.12."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from kinematify.errors import DescriptionError
from kinematify.robot.body_tree import WORLD, tree_of
from kinematify.robot.joint_type import JointType
from kinematify.robot.mesh_paths import mesh_candidates
from kinematify.robot.robot import Joint, Link, Mimic, inertial_of
from kinematify.robot.transforms import rotation_from_quaternion, rotation_from_rpy
from kinematify.robot.urdf_geometry import SIZES, NoShape, ellipsoid, geometry_source, primitive
from kinematify.robot.urdf_numbers import MOMENTS, line_of
from kinematify.robot.urdf_text import parse_description

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.robot.appearance import Rgba
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.body_tree import Edge, Losses
    from kinematify.robot.robot import Inertial, Robot, Shape
    from kinematify.robot.urdf_geometry import GeometrySource

_ENDLESS = 1e15
"""Limits beyond it say that there is none; SDF's own value is 1e16."""
_DEEPEST = 8
"""Models within models."""
_KINDS = {
    "fixed": JointType.FIXED, "ball": JointType.FIXED, "revolute": JointType.REVOLUTE,
    "continuous": JointType.REVOLUTE, "prismatic": JointType.PRISMATIC,
    "revolute2": JointType.REVOLUTE, "universal": JointType.REVOLUTE,
}  # fmt: skip
_MODEL = "__model__"


@dataclass(frozen=True, kw_only=True, eq=False)
class _Model:
    """What is in a model and the models within it, by name with its scope."""

    source: GeometrySource
    version: tuple[int, ...]
    links: dict[str, _Element] = field(default_factory=dict)
    joints: dict[str, _Element] = field(default_factory=dict)
    frames: dict[str, tuple[FloatArray, str | None, str]] = field(default_factory=dict)
    """Pose of a frame, the frame that it is relative to (None: the top), and what it is attached to."""
    losses: Losses = field(default_factory=lambda: defaultdict(list))
    notes: list[str] = field(default_factory=list)

    def scope(self, name: str) -> str:
        """The model that something is in, with ``::`` at its end."""
        return name[: name.rfind("::") + 2] if "::" in name else ""

    def body(self, name: str) -> str:
        """The link that a name represents: itself, that of a frame, or the first of a model."""
        for _ in range(len(self.frames) + 1):
            if name in self.links or name == WORLD:
                return name
            if name not in self.frames:
                break
            name = self.frames[name][2]
        raise DescriptionError(f"A joint of the SDF names {name!r}, which is no link and no frame. Correct the name.")

    def placed(self, name: str | None) -> FloatArray:
        """T_top_frame of a frame."""
        T, seen = np.eye(4), set[str]()
        while name is not None:
            if name in seen or name not in self.frames:
                what = "depends on itself" if name in seen else "is not there"
                raise DescriptionError(f"The frame {name!r} of the SDF {what}. Correct its relative_to.")
            seen.add(name)
            local, name, _ = self.frames[name]
            T = local @ T
        return T


def read_sdf(path: Path, package_dirs: Sequence[Path] = (), *_: Any) -> Robot:
    """Read an SDF.

    Args:
        path: The file.
        package_dirs: Where its meshes and models are looked up besides.

    Raises:
        DescriptionError: It is no SDF with a model, or a number or a frame cannot be used.
    """
    source = geometry_source(path, package_dirs, appearance=True)
    document = parse_description(path, roots=("sdf", "gazebo"))
    candidates = list(document.iterfind("model")) + list(document.iterfind("world/model"))
    candidates += [
        found for item in document.iterfind("world/include") if (found := _included(item, source, 0)) is not None
    ]
    if not candidates:
        raise DescriptionError(f"The SDF {path} holds no model. Give one with a <model>.")
    chosen = max(candidates, key=lambda item: (len(item.findall(".//joint")), -candidates.index(item)))
    model = _Model(source=source, version=_version(document))
    if len(candidates) > 1:
        model.losses["other models"] = [item.get("name") or "" for item in candidates if item is not chosen]
    _collect(model, chosen, "", 0)
    edges = [edge for name, element in model.joints.items() for edge in _edges(model, name, element)]
    bodies = [_link(model, name, element) for name, element in model.links.items()]
    known = {body.name for body in bodies}
    bodies += [Link(name=joint.child) for joint, _ in edges if joint.child not in known]
    poses = {name: model.placed(name) for name in model.links}
    for tag in ("sensor", "plugin", "light", "gripper"):
        for item in chosen.iter(tag):
            model.losses[f"{tag}s"].append(item.get("name") or "")
    notes, title = [*model.notes, *source.omitted], chosen.get("name") or path.stem
    return tree_of(title, path, bodies, edges, poses=poses, notes=notes, losses=model.losses)


def _version(document: _Element) -> tuple[int, ...]:
    words = (document.get("version") or "1.0").split(".")
    return tuple(int(word) for word in words if word.isdecimal())


def _collect(model: _Model, element: _Element, scope: str, depth: int) -> None:
    """Enter what is in a model; its own frame is known already, but for the top."""
    if depth > _DEEPEST:
        raise DescriptionError(f"The SDF has models more than {_DEEPEST} deep in each other. Is it a circle?")
    own = scope + _MODEL
    if not scope:
        model.frames[own] = (np.eye(4), None, "")
    first = ""
    for item in element.iterchildren("link", "joint", "frame", "model", "include"):
        inner = _included(item, model.source, depth) if item.tag == "include" else item
        name = scope + ((item.findtext("name") if item.tag == "include" else None) or item.get("name") or "")
        if inner is None:
            model.losses["included models that are not there"].append(item.findtext("uri") or "")
            continue
        if item.tag == "include" and name == scope:
            name += inner.get("name") or "included"
        pose = item.find("pose") if item.find("pose") is not None else inner.find("pose")
        base = own
        if item.tag == "joint":
            base = scope + (item.findtext("child") or "").strip()
            model.joints[name] = item
        elif item.tag == "frame" and item.get("attached_to"):
            base = scope + str(item.get("attached_to"))
        elif item.tag == "link":
            model.links[name] = item
            first = first or name
        asked = "" if pose is None else pose.get("relative_to") or ""
        model.frames[name] = (_pose(pose), scope + asked if asked else base, base)
        if item.tag in ("model", "include"):
            model.frames[f"{name}::{_MODEL}"] = (np.eye(4), name, "")
            _collect(model, inner, f"{name}::", depth + 1)
            inside = next((link for link in model.links if link.startswith(f"{name}::")), "")
            model.frames[name] = (*model.frames[name][:2], inside)
            first = first or inside
    model.frames[own] = (*model.frames[own][:2], first)


def _included(item: _Element, source: GeometrySource, depth: int) -> _Element | None:
    """The model that an <include> names, a folder or a file; None where it is not there."""
    uri = (item.findtext("uri") or "").strip()
    if depth > _DEEPEST or not uri or uri.startswith(("http:", "https:")):
        return None
    places = mesh_candidates(uri, source.folder, source.package_dirs, "the SDF")
    found = (file for place in places for file in (place / "model.sdf", place) if file.is_file())
    file = next(found, None)
    model = None if file is None else parse_description(file, roots=("sdf", "gazebo")).find("model")
    if model is not None and file is not None:
        for mesh in model.iter("uri"):
            text = (mesh.text or "").strip()
            if text and "://" not in text:
                mesh.text = str(file.parent / text)
    return model


def _values(element: _Element | None, count: int, default: Sequence[float]) -> list[float]:
    """So many finite numbers in the text of an element."""
    if element is None or not (element.text or "").strip():
        return list(default)
    try:
        found = [float(word) for word in (element.text or "").split()]
    except ValueError:
        found = []
    if len(found) != count or not np.isfinite(found).all():
        raise DescriptionError(
            f"<{element.tag}> in line {line_of(element)} of the SDF is {element.text!r}; expected {count} finite "
            "numbers. Correct it."
        )
    return found


def _pose(element: _Element | None) -> FloatArray:
    T = np.eye(4)
    if element is not None and element.get("rotation_format") == "quat_xyzw":
        *T[:3, 3], x, y, z, w = _values(element, 7, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
        T[:3, :3] = rotation_from_quaternion(np.array([w, x, y, z]))
        return T
    values = np.array(_values(element, 6, np.zeros(6).tolist()))
    degrees = element is not None and element.get("degrees") in ("true", "1")
    T[:3, 3], T[:3, :3] = values[:3], rotation_from_rpy(np.radians(values[3:]) if degrees else values[3:])
    return T


def _edges(model: _Model, name: str, element: _Element) -> Iterator[Edge]:
    """A joint; two with a link between them where it has two axes."""
    scope, declared = model.scope(name), element.get("type") or ""
    stated = [(element.findtext(tag) or "").strip() for tag in ("parent", "child")]
    if declared == "gearbox" or not all(stated):
        model.losses[f"joints of the type {declared!r}"].append(name)
        return
    parent, child = (model.body(WORLD if end == WORLD else scope + end) for end in stated)
    kind = _KINDS.get(declared, JointType.FIXED)
    if declared not in _KINDS or declared == "ball":
        model.notes.append(f"The {declared} joint {name} is read as fixed.")
    T_top_joint = model.placed(name)
    T_child = np.linalg.inv(model.placed(child)) @ T_top_joint
    outside = parent == WORLD and WORLD not in model.links
    T_parent = T_top_joint if outside else np.linalg.inv(model.placed(parent)) @ T_top_joint
    joint = Joint(
        name=name, kind=kind, parent=parent, child=child, T_parent_child=T_parent, declared_kind=declared,
        line=line_of(element),
    )  # fmt: skip
    axes = (
        []
        if kind is JointType.FIXED
        else [item for item in (element.find("axis"), element.find("axis2")) if item is not None]
    )
    if kind is JointType.FIXED:
        yield joint, T_child
    elif declared in ("revolute2", "universal") and len(axes) == 2:
        between = f"{name}_between"
        yield replace(_turning(model, joint, axes[0], T_top_joint), child=between), np.eye(4)
        lower = replace(joint, name=f"{name}_2", parent=between, T_parent_child=np.eye(4))
        yield _turning(model, lower, axes[1], T_top_joint), T_child
    else:
        yield _turning(model, joint, axes[0] if axes else etree.Element("axis"), T_top_joint), T_child


def _turning(model: _Model, joint: Joint, axis: _Element, T_top_joint: FloatArray) -> Joint:
    """A joint with what its <axis> states."""
    scope, xyz = model.scope(joint.name), axis.find("xyz")
    direction = np.array(_values(xyz, 3, (0.0, 0.0, 1.0)))
    frame = None if xyz is None else xyz.get("expressed_in")
    if frame is None and (
        model.version < (1, 5) or axis.findtext("use_parent_model_frame", "").strip() in ("1", "true")
    ):
        frame = _MODEL
    if frame:
        direction = T_top_joint[:3, :3].T @ model.placed(scope + frame)[:3, :3] @ direction
    length = float(np.linalg.norm(direction))
    if not length > 0.0:
        raise DescriptionError(f"The joint {joint.name} of the SDF has an axis of zero length. Give it a direction.")
    lower, upper = (
        _values(axis.find(f"limit/{key}"), 1, (sign * np.inf,))[0] for key, sign in (("lower", -1), ("upper", 1))
    )
    limited = max(-lower, upper) < _ENDLESS and joint.declared_kind != "continuous"
    if any(_values(axis.find("dynamics/spring_stiffness"), 1, (0.0,))):
        model.losses["springs of joints"].append(joint.name)
    mimic = None
    if (follows := axis.find("mimic")) is not None:
        slope, offset, start = (
            _values(follows.find(key), 1, (0.0,))[0] for key in ("multiplier", "offset", "reference")
        )
        mimic = Mimic(joint=scope + (follows.get("joint") or ""), multiplier=slope, offset=offset - slope * start)
    effort, velocity, damping, friction = (
        (_values(item, 1, (0.0,))[0] if (item := axis.find(key)) is not None else None)
        for key in ("limit/effort", "limit/velocity", "dynamics/damping", "dynamics/friction")
    )
    return replace(
        joint,
        kind=JointType.CONTINUOUS if joint.kind is JointType.REVOLUTE and not limited else joint.kind,
        axis=direction / length,
        lower=lower if limited else -np.inf,
        upper=upper if limited else np.inf,
        has_limit=limited,
        mimic=mimic,
        effort=None if effort is None or not 0.0 <= effort < _ENDLESS else effort,
        velocity=None if velocity is None or not 0.0 <= velocity < _ENDLESS else velocity,
        damping=damping,
        friction=friction,
    )


def _link(model: _Model, name: str, element: _Element) -> Link:
    seen, felt = (
        tuple(shape for item in element.findall(tag) if (shape := _shape(model, name, item)) is not None)
        for tag in ("visual", "collision")
    )
    return Link(name=name, inertial=_inertial(element), visuals=seen, collisions=felt, line=line_of(element))


def _inertial(link: _Element) -> Inertial | None:
    element = link.find("inertial")
    if element is None:
        return None
    moments = [_values(element.find(f"inertia/{key}"), 1, (float(key[1] == key[2]),))[0] for key in MOMENTS]
    (mass,) = _values(element.find("mass"), 1, (1.0,))
    return inertial_of(mass, _pose(element.find("pose")), moments, line_of(element))


def _shape(model: _Model, link: str, element: _Element) -> Shape | None:
    """A visual or collision; None, with a note, for what is none."""
    geometry, T, line = element.find("geometry"), _pose(element.find("pose")), line_of(element)
    relative = "" if (pose := element.find("pose")) is None else pose.get("relative_to") or ""
    if relative:
        T = np.linalg.inv(model.placed(link)) @ model.placed(model.scope(link) + relative) @ T
    shape = None if geometry is None else next(iter(geometry), None)
    kind = "nothing" if shape is None else str(shape.tag)
    color = _color(element)
    if shape is not None and kind == "ellipsoid":
        return ellipsoid(_values(shape.find("radii"), 3, (1.0, 1.0, 1.0)), T, color, line)
    if shape is None or kind not in (*SIZES, "mesh") or shape.find("submesh") is not None:
        what = f"{kind} with a submesh" if kind == "mesh" else kind
        model.losses[f"{element.tag}s of the shape {what}"].append(f"{link}, line {line}")
        return None
    if kind != "mesh":
        count = 3 if kind == "box" else 1
        size = [value for key in SIZES[kind] for value in _values(shape.find(key), count, (1.0,) * count)]
        if min(size) < 0.0:
            raise DescriptionError(
                f"The {kind} in line {line} of the SDF has the size {size}. No length is below zero."
            )
        return primitive(kind, tuple(size), T, color, line) if min(size) > 0.0 else None
    name, scale = (shape.findtext("uri") or "").strip(), _values(shape.find("scale"), 3, (1.0, 1.0, 1.0))
    try:
        return model.source.mesh(name, np.array(scale), T, f"link {link}", color=color, line=line)
    except NoShape as error:
        model.source.omit(element, error)
        return None


def _color(element: _Element) -> Rgba | None:
    material = element.find("material")
    stated = None if material is None else material.find("diffuse")
    if stated is None:
        return None
    count = 3 + (len((stated.text or "").split()) == 4)
    red, green, blue, opacity = [*_values(stated, count, ()), 1.0][:4]
    return red, green, blue, opacity
