"""From a USD with the physics schema to a `Robot`: rigid bodies, their joints, what is seen and what collides."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pxr import Usd, UsdGeom, UsdPhysics, UsdUtils

from kinematify.errors import DescriptionError
from kinematify.robot.appearance import srgb_of
from kinematify.robot.body_tree import WORLD, tree_of
from kinematify.robot.joint_type import JointType
from kinematify.robot.mesh_file import to_z_up
from kinematify.robot.polygons import triangle_places
from kinematify.robot.robot import Joint, Link, Mimic, inertial_of
from kinematify.robot.transforms import rotation_from_quaternion, transformed
from kinematify.robot.urdf_geometry import mesh_shape, primitive

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.body_tree import Edge, Losses
    from kinematify.robot.robot import Inertial, Robot, Shape

_MOST_FILES = 500
_AXES = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}
_SAME = 1e-9
_DEFINED = re.compile(r'^\s*(?:def|over)\s+(?:\w+\s+)?"([^"]+)"')


@dataclass(frozen=True, kw_only=True, eq=False)
class _Stage:
    """A stage with its bodies, all lengths in metres and z up."""

    stage: Any
    unit: float
    """Length of the stage's unit [m]."""
    T_world_stage: FloatArray
    """With `unit` as its scale."""
    kilograms: float
    bodies: dict[Any, str]
    """Names by the path of the prim."""
    joints: dict[Any, str]
    """The same of joints."""
    lines: dict[str, int]
    cache: Any = field(default_factory=lambda: UsdGeom.XformCache(Usd.TimeCode.Default()))
    losses: Losses = field(default_factory=lambda: defaultdict(list))
    notes: list[str] = field(default_factory=list)

    def scaled_pose(self, prim: Any) -> FloatArray:
        """Map from a prim's own coordinates to the world [m]."""
        return np.asarray(self.T_world_stage @ np.array(self.cache.GetLocalToWorldTransform(prim)).T)

    def pose(self, prim: Any) -> FloatArray:
        """T_world_prim without the scale."""
        return _rigid(self.scaled_pose(prim))

    def body_of(self, path: Any) -> Any:
        """The prim of the body that a path is in; None for the world."""
        prim = self.stage.GetPrimAtPath(path)
        while prim and prim.GetPath() not in self.bodies:
            prim = prim.GetParent()
        return prim or None


def read_usd(path: Path, *_: Any) -> Robot:
    """Read a USD, binary, text or zipped, whatever is given beside it.

    Raises:
        DescriptionError: USD does not open it, it refers to files outside of its folder, or it holds no rigid body.
    """
    try:
        _check_references(path)
        stage = Usd.Stage.Open(str(path))
    except DescriptionError:
        raise
    except Exception as error:  # pxr.Tf.ErrorException, which mypy does not know
        raise DescriptionError(f"USD does not open {path}: {' '.join(str(error).split())[:300]}") from error
    everything = list(stage.Traverse(Usd.TraverseInstanceProxies()))
    prims = [prim for prim in everything if prim.HasAPI(UsdPhysics.RigidBodyAPI)]
    hinges = [prim for prim in everything if prim.IsA(UsdPhysics.Joint)]
    if not prims:
        raise DescriptionError(f"The USD {path} has no rigid body (UsdPhysicsRigidBodyAPI). Give a model with physics.")
    unit, T_world_stage = UsdGeom.GetStageMetersPerUnit(stage), np.eye(4)
    lies = UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y
    T_world_stage[:3, :3] = unit * (to_z_up("y" if lies else "z"))
    read = _Stage(
        stage=stage,
        unit=unit,
        T_world_stage=T_world_stage,
        kilograms=UsdPhysics.GetStageKilogramsPerUnit(stage),
        bodies=_names(prims),
        joints=_names(hinges),
        lines=_lines(path),
    )
    bodies = [_link(read, prim) for prim in prims]
    hinges.sort(key=lambda prim: bool(UsdPhysics.Joint(prim).GetExcludeFromArticulationAttr().Get()))
    ordered = [edge for prim in hinges if (edge := _edge(read, prim)) is not None]
    joints = {joint.name for joint, _ in ordered}
    ordered = [
        (joint if joint.mimic is None or joint.mimic.joint in joints else replace(joint, mimic=None), T)
        for joint, T in ordered
    ]
    poses = {read.bodies[prim.GetPath()]: read.pose(prim) for prim in prims}
    top = stage.GetDefaultPrim()
    lost = ("Camera", "PhysicsDistanceJoint")
    for prim in everything:
        if prim.GetTypeName() in lost or prim.GetTypeName().endswith("Light"):
            read.losses[f"prims of the type {prim.GetTypeName()}"].append(prim.GetName())
    title = top.GetName() if top else path.stem
    return tree_of(title, path, bodies, ordered, poses=poses, notes=read.notes, losses=read.losses)


def _check_references(path: Path) -> None:
    """Refuse a file that refers to layers outside of its folder before any of them is composed."""
    folder, waiting, seen = path.resolve().parent, [path.resolve()], set[Path]()
    while waiting:
        layer = waiting.pop()
        if layer in seen or layer.suffix.lower() == ".usdz":
            continue
        seen.add(layer)
        if len(seen) > _MOST_FILES:
            raise DescriptionError(f"The USD {path} refers to more than {_MOST_FILES} layers. Flatten it.")
        sublayers, references, payloads = UsdUtils.ExtractExternalReferences(str(layer))
        for name in (*sublayers, *references, *payloads):
            suffix = Path(name).suffix.lower()
            if not suffix.startswith(".usd"):
                continue
            target = (layer.parent / name).resolve()
            if "://" in name or not target.is_relative_to(folder):
                raise DescriptionError(
                    f"The USD {layer} refers to {name!r}, outside of the folder {folder}. Copy it there, or flatten "
                    "the stage (usdcat --flatten)."
                )
            if target.is_file():
                waiting.append(target)


def _names(prims: list[Any]) -> dict[Any, str]:
    """The name that a prim shows or has, with its path where two are alike."""
    found: dict[Any, str] = {}
    for prim in prims:
        name = prim.GetDisplayName() or prim.GetName()
        taken = name in found.values() or name == WORLD
        found[prim.GetPath()] = str(prim.GetPath())[1:].replace("/", "_") if taken else name
    return found


def _lines(path: Path) -> dict[str, int]:
    """Lines of a text file that define a prim, by its name."""
    with path.open("rb") as file:
        if not file.read(5).startswith(b"#usda"):
            return {}
    text = path.read_text(encoding="utf-8", errors="replace").splitlines()
    return {found[1]: number + 1 for number, line in reversed([*enumerate(text)]) if (found := _DEFINED.match(line))}


def _rigid(T: FloatArray) -> FloatArray:
    """The rotation nearest to a transform, with its translation."""
    left, _, right = np.linalg.svd(T[:3, :3])
    result = np.eye(4)
    result[:3, :3] = left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right
    result[:3, 3] = T[:3, 3]
    return result


def _link(read: _Stage, prim: Any) -> Link:
    name, T_body_world = read.bodies[prim.GetPath()], np.linalg.inv(read.pose(prim))
    line = read.lines.get(prim.GetName(), 0)
    seen: list[Shape] = []
    felt: list[Shape] = []
    inside = iter(Usd.PrimRange(prim, Usd.TraverseInstanceProxies()))
    for item in inside:
        if item != prim and item.GetPath() in read.bodies:
            inside.PruneChildren()
        elif item.IsA(UsdGeom.Gprim):
            shape = _shape(read, item, T_body_world @ read.scaled_pose(item), line)
            if shape is None:
                read.losses[f"geometries of the type {item.GetTypeName()}"].append(name)
                continue
            if _collides(item, prim):
                felt.append(shape)
            imageable = UsdGeom.Imageable(item)
            shown = imageable.ComputePurpose() in (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
            if shown and imageable.ComputeVisibility() != UsdGeom.Tokens.invisible:
                seen.append(shape)
    inertial = _inertial(read, prim, line)
    return Link(name=name, inertial=inertial, visuals=tuple(seen), collisions=tuple(felt), line=line)


def _collides(item: Any, body: Any) -> bool:
    """Whether a geometry, or what holds it within its body, is a collider that is on."""
    while item and item.GetPath().HasPrefix(body.GetPath()):
        if item.HasAPI(UsdPhysics.CollisionAPI):
            return UsdPhysics.CollisionAPI(item).GetCollisionEnabledAttr().Get() is not False
        item = item.GetParent()
    return False


def _inertial(read: _Stage, prim: Any, line: int) -> Inertial | None:
    api = UsdPhysics.MassAPI(prim) if prim.HasAPI(UsdPhysics.MassAPI) else None
    mass = float(api.GetMassAttr().Get() or 0.0) if api else 0.0
    if api is None or not mass > 0.0:
        read.losses["masses that engines compute from density and colliders"].append(read.bodies[prim.GetPath()])
        return None
    diagonal = np.array(api.GetDiagonalInertiaAttr().Get() or (0.0, 0.0, 0.0), dtype=np.float64)
    scaled, rigid = read.scaled_pose(prim), read.pose(prim)
    center = np.array(api.GetCenterOfMassAttr().Get() or (0.0, 0.0, 0.0), dtype=np.float64)
    if not np.isfinite(center).all():  # the schema's own value for: not stated
        center = np.zeros(3)
    T = _turned(api.GetPrincipalAxesAttr().Get())
    T[:3, 3] = (np.linalg.inv(rigid) @ scaled @ np.append(center, 1.0))[:3]
    xx, yy, zz = (diagonal * read.kilograms * read.unit**2).tolist()
    return inertial_of(mass * read.kilograms, T, (xx, 0.0, 0.0, yy, 0.0, zz), line)


def _turned(turn: Any) -> FloatArray:
    """The transform of a quaternion; identity where none is stated."""
    T = np.eye(4)
    if turn is not None and turn.GetLength() > 0.0:
        T[:3, :3] = rotation_from_quaternion(np.array([turn.GetReal(), *turn.GetImaginary()], dtype=np.float64))
    return T


def _shape(read: _Stage, prim: Any, T: FloatArray, line: int) -> Shape | None:
    """A geometry in the frame of its body; a scale that a primitive cannot have makes it a mesh."""
    colors, opacities = (
        UsdGeom.Gprim(prim).GetDisplayColorAttr().Get(),
        UsdGeom.Gprim(prim).GetDisplayOpacityAttr().Get(),
    )
    color = None
    if colors:
        red, green, blue = srgb_of(np.array(colors[0])).tolist()
        color = (red, green, blue, float(opacities[0]) if opacities else 1.0)
    if prim.IsA(UsdGeom.Mesh):
        vertices, faces = _triangles(UsdGeom.Mesh(prim))
        if not len(faces):
            return None
        vertices = transformed(vertices, T)
        return mesh_shape(vertices, faces if np.linalg.det(T[:3, :3]) > 0.0 else faces[:, ::-1], np.eye(4), color, line)
    kind, size, axis = _primitive(prim)
    if not kind:
        return None
    turned = T @ _along(axis)
    scale = np.linalg.norm(turned[:3, :3], axis=0)
    rigid = _rigid(turned)
    straight = np.allclose(rigid[:3, :3] * scale, turned[:3, :3], atol=_SAME * scale.max())
    round_, even = np.isclose(scale[0], scale[1], rtol=1e-6), np.isclose(scale[0], scale[2], rtol=1e-6)
    if straight and (kind == "box" or (round_ and (even or kind == "cylinder"))):
        lengths = [size[0] * scale[0], *(length * scale[2] for length in size[1:])]
        return primitive(
            kind, tuple((np.array(size) * scale).tolist() if kind == "box" else lengths), rigid, color, line
        )
    mesh = primitive(kind, size, np.eye(4)).mesh
    return mesh_shape(transformed(mesh.vertices, turned), mesh.faces, np.eye(4), color, line)


def _primitive(prim: Any) -> tuple[str, tuple[float, ...], str]:
    """Kind, size and axis of a geometry; an empty kind for what is no primitive of ours."""
    if prim.IsA(UsdGeom.Cube):
        return "box", (float(UsdGeom.Cube(prim).GetSizeAttr().Get()),) * 3, "Z"
    if prim.IsA(UsdGeom.Sphere):
        return "sphere", (float(UsdGeom.Sphere(prim).GetRadiusAttr().Get()),), "Z"
    for kind, schema in (("cylinder", UsdGeom.Cylinder), ("capsule", UsdGeom.Capsule)):
        if prim.IsA(schema):
            found = schema(prim)
            size = (float(found.GetRadiusAttr().Get()), float(found.GetHeightAttr().Get()))
            return kind, size, str(found.GetAxisAttr().Get())
    return "", (), "Z"


def _along(axis: str) -> FloatArray:
    """Rotation that brings z to an axis of a primitive."""
    columns = {"X": (1, 2, 0), "Y": (2, 0, 1), "Z": (0, 1, 2)}[axis]
    T = np.eye(4)
    T[:3, :3] = np.eye(3)[:, columns]
    return T


def _triangles(mesh: Any) -> tuple[FloatArray, IntArray]:
    """Vertices and triangles of a mesh, which lie inside of its faces."""
    vertices = np.array(mesh.GetPointsAttr().Get() or [], dtype=np.float64).reshape(-1, 3)
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get() or [], dtype=np.int64)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get() or [], dtype=np.int64)
    if counts.sum() != len(corners) or (len(corners) and not 0 <= corners.min() <= corners.max() < len(vertices)):
        raise DescriptionError(f"The faces of the mesh {mesh.GetPath()} do not fit its points. Export it again.")
    faces = corners[np.repeat(counts > 2, counts)]
    faces = faces[triangle_places(vertices[faces], counts[counts > 2])]
    if mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded:
        faces = faces[:, ::-1]
    return vertices, faces


def _edge(read: _Stage, prim: Any) -> Edge | None:
    joint = UsdPhysics.Joint(prim)
    if joint.GetJointEnabledAttr().Get() is False:
        return None
    ends = []
    for relation, at, turn in (
        (joint.GetBody0Rel(), joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr()),
        (joint.GetBody1Rel(), joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr()),
    ):
        targets = relation.GetTargets()
        target = read.stage.GetPrimAtPath(targets[0]) if targets else None
        body = read.body_of(targets[0]) if targets else None
        scaled = read.scaled_pose(target) if target else read.T_world_stage
        T_world_joint = _rigid(scaled) @ _turned(turn.Get())
        T_world_joint[:3, 3] = (scaled @ np.append(np.array(at.Get() or (0.0, 0.0, 0.0), dtype=np.float64), 1.0))[:3]
        T_world_body = read.pose(body) if body else np.eye(4)
        ends.append((read.bodies[body.GetPath()] if body else WORLD, np.linalg.inv(T_world_body) @ T_world_joint))
    (parent, T_parent), (child, T_child) = ends
    if parent == child:
        return None
    name = read.joints[prim.GetPath()]
    declared = {"PhysicsSphericalJoint": "ball", "PhysicsFixedJoint": "fixed"}.get(prim.GetTypeName(), "")
    made = Joint(
        name=name, kind=JointType.FIXED, parent=parent, child=child, T_parent_child=T_parent,
        declared_kind=declared, line=read.lines.get(prim.GetName(), 0),
    )  # fmt: skip
    for schema, kind in (
        (UsdPhysics.RevoluteJoint, JointType.REVOLUTE),
        (UsdPhysics.PrismaticJoint, JointType.PRISMATIC),
    ):
        if prim.IsA(schema):
            return _moving(read, made, schema(prim), kind), T_child
    if declared != "fixed" and not joint.GetExcludeFromArticulationAttr().Get():
        read.notes.append(f"The joint {name} ({prim.GetTypeName()}) is read as fixed.")
    return made, T_child


def _moving(read: _Stage, joint: Joint, schema: Any, kind: JointType) -> Joint:
    """A hinge or slide with its limits, its drive, and what Newton, MuJoCo and PhysX add."""
    prim, turns = schema.GetPrim(), kind.turns
    unit = np.pi / 180.0 if turns else read.unit
    force = read.kilograms * read.unit ** (2 if turns else 1)
    lower, upper = (
        -np.inf if low is None else float(low) * unit
        for low in (schema.GetLowerLimitAttr().Get(), schema.GetUpperLimitAttr().Get())
    )
    limited = bool(np.isfinite([lower, upper]).all()) and lower <= upper
    drive = UsdPhysics.DriveAPI(prim, "angular" if turns else "linear")
    most, damping = drive.GetMaxForceAttr().Get(), drive.GetDampingAttr().Get()
    speed = _number(prim, "newton:velocityLimit", "physxJoint:maxJointVelocity")
    passive = damping is not None and not drive.GetStiffnessAttr().Get()
    return replace(
        joint,
        kind=kind if limited or not turns else JointType.CONTINUOUS,
        axis=np.array(_AXES[str(schema.GetAxisAttr().Get() or "X")]),
        lower=lower if limited else -np.inf,
        upper=upper if limited else np.inf,
        has_limit=limited,
        effort=float(most) * force if most is not None and 0.0 < most < np.inf else None,
        velocity=speed * unit if speed is not None and 0.0 < speed < np.inf else None,
        damping=(float(damping) * force / unit if passive else None) or None,
        friction=_number(prim, "mjc:frictionloss", "newton:friction") or None,
        mimic=_mimic(read, prim, turns=turns),
    )


def _number(prim: Any, *names: str) -> float | None:
    values = (attribute.Get() for name in names if (attribute := prim.GetAttribute(name)))
    return next((float(value) for value in values if value is not None), None)


def _mimic(read: _Stage, prim: Any, *, turns: bool) -> Mimic | None:
    """The rule of Newton's schema, or of PhysX's (q + gearing q_leader + offset = 0)."""
    for relation in prim.GetRelationships():
        name, targets = relation.GetName(), relation.GetTargets()
        if not targets or not name.endswith(("newton:mimicJoint", ":referenceJoint")):
            continue
        leader = read.stage.GetPrimAtPath(targets[0])
        stem = name.removesuffix("referenceJoint")
        newton = name == "newton:mimicJoint"
        slope = _number(prim, "newton:mimicCoef1" if newton else f"{stem}gearing") or (1.0 if newton else 0.0)
        offset = _number(prim, "newton:mimicCoef0" if newton else f"{stem}offset") or 0.0
        own = np.pi / 180.0 if turns else 1.0
        other = np.pi / 180.0 if leader.IsA(UsdPhysics.RevoluteJoint) else 1.0
        sign = 1.0 if newton else -1.0
        return Mimic(
            joint=read.joints.get(leader.GetPath(), ""),
            multiplier=sign * slope * own / other,
            offset=sign * offset * own,
        )
    return None
