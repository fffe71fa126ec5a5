"""USD with the physics schema: rigid bodies side by side, joints between them, everything in one file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade

from kinematify.formats.content import GREY, shown_surfaces
from kinematify.robot.appearance import linear_of
from kinematify.robot.joint_type import JointType
from kinematify.robot.material_files import write_texture
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import quaternion_of, rotation_from_x, rpy_of
from kinematify.robot.vectors import lengths_of, triangle_normals

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from kinematify.formats.content import Content
    from kinematify.robot.appearance import Material, Rgba, Surface, Texture
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Joint, Link, LoopJoint, Shape

_FRICTION = 1.0
"""Of surfaces that state none: MuJoCo's default, which a URDF is simulated with; USD's own is 0."""


def write_usd(content: Content, out: Path, *, free: bool) -> None:
    """Write a USD file, text (``.usda``) or binary (``.usd``, ``.usdc``).

    Arguments and errors as for `write_mjcf`.
    """
    writer = _UsdWriter(content, out)
    writer.add_all(free=free)
    if not writer.stage.GetRootLayer().Export(str(out)):
        raise OSError(f"USD could not write {out}")


class _UsdWriter:
    """One stage in memory."""

    def __init__(self, content: Content, out: Path) -> None:
        self._content, self._out = content, out
        self._materials: dict[Material, Any] = {}
        self._frictions: dict[float, Any] = {}
        self._joints: dict[str, Any] = {}
        self.stage = Usd.Stage.CreateInMemory()
        UsdGeom.SetStageUpAxis(self.stage, UsdGeom.Tokens.z)
        UsdGeom.SetStageMetersPerUnit(self.stage, 1.0)
        UsdPhysics.SetStageKilogramsPerUnit(self.stage, 1.0)
        self._top = Sdf.Path.absoluteRootPath.AppendChild(content.robot.name)
        self._paths = {link.name: self._top.AppendChild(link.name) for link in content.robot.links}

    def add_all(self, *, free: bool) -> None:
        """Everything below one prim, which is the file's default."""
        top = UsdGeom.Xform.Define(self.stage, self._top)
        self.stage.SetDefaultPrim(top.GetPrim())
        Usd.ModelAPI(top).SetKind("component")
        UsdPhysics.Scene.Define(self.stage, self._top.AppendChild("physics_scene"))
        UsdPhysics.ArticulationRootAPI.Apply(top.GetPrim())
        _author(top.GetPrim(), "NewtonArticulationRootAPI", selfCollisionEnabled=(Sdf.ValueTypeNames.Bool, True))
        UsdGeom.Scope.Define(self.stage, self._top.AppendChild("materials"))
        robot = self._content.robot
        poses = forward_kinematics(robot, {})
        for link, shown in zip(robot.links, self._content.old_links, strict=True):
            self._add_link(link, shown, poses[link.name])
        joints = self._top.AppendChild("joints")
        UsdGeom.Scope.Define(self.stage, joints)
        pinned = [] if free else [joints.AppendChild(self._content.root_joint)]
        for path in pinned:
            UsdPhysics.FixedJoint.Define(self.stage, path).CreateBody1Rel().SetTargets([self._paths[robot.root]])
        for joint, shown in zip(robot.joints, self._content.old_joints, strict=True):
            self._add_joint(joint, shown, joints.AppendChild(joint.name))
        self._add_followers()
        self._add_motors()
        self._add_roles(top.GetPrim(), pinned)
        for loop in robot.loops:
            self._add_loop(loop, joints.AppendChild(loop.name))
        self._keep_apart()

    def _add_link(self, link: Link, shown: str, T_world_link: FloatArray) -> None:
        path = self._paths[link.name]
        xform = UsdGeom.Xform.Define(self.stage, path)
        xform.GetPrim().SetDisplayName(shown)
        _place(xform, T_world_link)
        UsdPhysics.RigidBodyAPI.Apply(xform.GetPrim())
        self._add_mass(xform.GetPrim(), link)
        for folder, shapes in (("visuals", link.visuals), ("collisions", link.collisions)):
            above = path.AppendChild(folder)
            scope = UsdGeom.Scope.Define(self.stage, above)
            if folder == "collisions":
                scope.CreatePurposeAttr(UsdGeom.Tokens.guide)
            for number, shape in enumerate(shapes):
                name = f"{shape.kind}_{number}"
                if folder == "visuals" and shape.kind == "mesh":
                    for index, surface in enumerate(shown_surfaces(shape)):
                        self._add_surface(self._frame(above.AppendChild(f"{name}_{index}"), np.eye(4)), surface)
                    continue
                prim = self._add_shape(above.AppendChild(name), shape)
                if folder == "collisions":
                    self._let_collide(prim, link.name, is_mesh=shape.kind == "mesh")

    def _let_collide(self, prim: Any, link: str, *, is_mesh: bool) -> None:
        """USD's own schema, and the names under which MuJoCo and Newton look for it."""
        UsdPhysics.CollisionAPI.Apply(prim)
        prim.AddAppliedSchema("MjcCollisionAPI")
        if is_mesh:
            UsdPhysics.MeshCollisionAPI.Apply(prim).CreateApproximationAttr(UsdPhysics.Tokens.convexHull)
            prim.AddAppliedSchema("NewtonMeshCollisionAPI")
        UsdShade.MaterialBindingAPI.Apply(prim).Bind(
            self._friction(link), UsdShade.Tokens.weakerThanDescendants, "physics"
        )

    def _friction(self, link: str) -> Any:
        """The physics material of a link, in the scope of all materials; written when first asked for."""
        value, _ = self._content.extensions.surfaces.get(link, (_FRICTION, _FRICTION))
        if value not in self._frictions:
            name = f"friction_{len(self._frictions)}"
            found = UsdShade.Material.Define(self.stage, self._top.AppendChild("materials").AppendChild(name))
            physics = UsdPhysics.MaterialAPI.Apply(found.GetPrim())
            physics.CreateStaticFrictionAttr(value)
            physics.CreateDynamicFrictionAttr(value)
            self._frictions[value] = found
        return self._frictions[value]

    def _frame(self, path: Any, T: FloatArray) -> Any:
        """A frame of its own around one geometry; returns the path of the geometry."""
        xform = UsdGeom.Xform.Define(self.stage, path)
        xform.AddTranslateOp().Set(Gf.Vec3d(*map(float, T[:3, 3])))
        # As three angles: ExclusiveXFormParentChecker of SimReady takes no quaternion here.
        xform.AddRotateXYZOp().Set(_vector(np.degrees(rpy_of(T[:3, :3]))))
        return path.AppendChild("geometry")

    def _add_mass(self, prim: Any, link: Link) -> None:
        if link.inertial is None:
            return
        moments, axes = np.linalg.eigh(link.inertial.tensor)
        axes[:, 2] *= np.sign(np.linalg.det(axes))
        mass = UsdPhysics.MassAPI.Apply(prim)
        mass.CreateMassAttr(link.inertial.mass)
        mass.CreateCenterOfMassAttr(_vector(link.inertial.center_of_mass))
        mass.CreateDiagonalInertiaAttr(_vector(moments))
        mass.CreatePrincipalAxesAttr(_turn(axes))

    def _add_shape(self, path: Any, shape: Shape) -> Any:
        if shape.kind == "mesh":
            found = self._mesh(self._frame(path, np.eye(4)), shape.mesh.vertices, shape.mesh.faces)
        else:
            found = _primitive(self.stage, self._frame(path, shape.T_link_shape), shape)
        _display(found, shape.color or GREY)
        return found.GetPrim()

    def _mesh(self, path: Any, vertices: FloatArray, faces: IntArray) -> Any:
        found = UsdGeom.Mesh.Define(self.stage, path)
        found.CreatePointsAttr([_vector(point) for point in vertices])
        found.CreateFaceVertexCountsAttr([3] * len(faces))
        found.CreateFaceVertexIndicesAttr(faces.ravel().tolist())
        found.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
        found.CreateNormalsAttr([_vector(normal) for normal in _normals(vertices[faces])])
        found.SetNormalsInterpolation(UsdGeom.Tokens.uniform)
        _bound(found)
        return found

    def _add_surface(self, path: Any, surface: Surface) -> None:
        """Return what is seen of one material: a display colour, and the material itself for renderers that know it."""
        found = self._mesh(path, surface.vertices, surface.faces)
        _display(found, surface.material.color)
        if surface.uv is not None:
            places = UsdGeom.PrimvarsAPI(found).CreatePrimvar(
                "st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex
            )
            once, index = np.unique(surface.uv, axis=0, return_inverse=True)
            places.Set([Gf.Vec2f(*map(float, place)) for place in once])
            places.SetIndices(index.ravel().tolist())
        UsdShade.MaterialBindingAPI.Apply(found.GetPrim()).Bind(self._material(surface.material))

    def _material(self, material: Material) -> Any:
        """The material in the file, written when first asked for."""
        if material in self._materials:
            return self._materials[material]
        path = self._top.AppendChild("materials").AppendChild(f"material_{len(self._materials)}")
        found = UsdShade.Material.Define(self.stage, path)
        shader = UsdShade.Shader.Define(self.stage, path.AppendChild("surface"))
        shader.CreateIdAttr("UsdPreviewSurface")
        _inputs(shader, "Float", opacity=material.color[3], metallic=material.metallic, roughness=material.roughness)
        color = shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
        light = linear_of(np.array(material.color[:3]))
        if material.texture is None:
            color.Set(_vector(light))
        else:
            self._show_texture(path, color, material.texture, light)
        found.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
        self._materials[material] = found
        return found

    def _show_texture(self, path: Any, color: Any, texture: Texture, light: FloatArray) -> None:
        """Make a picture beside the file, times a colour, be what an input shows."""
        folder = self._out.parent / f"{self._out.stem}_textures"
        folder.mkdir(exist_ok=True)
        file = folder / f"{path.name}.png"
        write_texture(file, texture)
        reader = UsdShade.Shader.Define(self.stage, path.AppendChild("places"))
        reader.CreateIdAttr("UsdPrimvarReader_float2")
        _inputs(reader, "String", varname="st")
        picture = UsdShade.Shader.Define(self.stage, path.AppendChild("texture"))
        picture.CreateIdAttr("UsdUVTexture")
        _inputs(picture, "Asset", file=f"{folder.name}/{file.name}")
        _inputs(picture, "Token", sourceColorSpace="sRGB")
        _inputs(picture, "Float4", scale=Gf.Vec4f(*light.tolist(), 1.0))
        _inputs(picture, "Token", wrapS="repeat", wrapT="repeat")
        picture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(reader.ConnectableAPI(), "result")
        color.ConnectToSource(picture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3))

    def _add_joint(self, joint: Joint, shown: str, path: Any) -> None:
        kind = {JointType.FIXED: UsdPhysics.FixedJoint, JointType.PRISMATIC: UsdPhysics.PrismaticJoint}
        found = kind.get(joint.kind, UsdPhysics.RevoluteJoint).Define(self.stage, path)
        self._joints[joint.name] = found.GetPrim()
        found.GetPrim().SetDisplayName(shown)
        self._connect(found, joint.parent, joint.child)
        turn = np.eye(3) if joint.kind is JointType.FIXED else rotation_from_x(joint.axis)
        T = joint.T_parent_child
        found.CreateLocalPos0Attr(_vector(T[:3, 3]))
        found.CreateLocalRot0Attr(_turn(T[:3, :3] @ turn))
        found.CreateLocalPos1Attr(_vector(np.zeros(3)))
        found.CreateLocalRot1Attr(_turn(turn))
        if joint.kind is JointType.FIXED:
            return
        found.CreateAxisAttr(UsdGeom.Tokens.x)
        if joint.is_limited:
            unit = np.degrees if joint.kind.turns else np.asarray
            found.CreateLowerLimitAttr(float(unit(joint.lower)))
            found.CreateUpperLimitAttr(float(unit(joint.upper)))
        self._add_drive(found.GetPrim(), joint)

    def _connect(self, joint: Any, first: str, second: str) -> None:
        joint.CreateBody0Rel().SetTargets([self._paths[first]])
        joint.CreateBody1Rel().SetTargets([self._paths[second]])

    def _add_followers(self) -> None:
        """Joints that follow: Newton's schema, whose offset is in the unit of the follower as all angles of USD."""
        for joint in self._content.robot.joints:
            if joint.mimic is None or joint.kind is JointType.FIXED:
                continue
            leader = self._content.robot.joint_by_name[joint.mimic.joint]
            unit = np.degrees(1.0) if joint.kind.turns else 1.0
            gain = joint.mimic.multiplier * unit / (np.degrees(1.0) if leader.kind.turns else 1.0)
            _author(
                self._joints[joint.name], "NewtonMimicAPI",
                mimicCoef0=(Sdf.ValueTypeNames.Float, float(joint.mimic.offset * unit)),
                mimicCoef1=(Sdf.ValueTypeNames.Float, float(gain)),
            )  # fmt: skip
            self._joints[joint.name].CreateRelationship("newton:mimicJoint").SetTargets(
                [self._joints[leader.name].GetPath()]
            )

    def _add_motors(self) -> None:
        """The motors of the MJCF export, under the names of MuJoCo's schema."""
        for joint in self._content.robot.joints:
            if joint.leads and joint.effort and joint.effort > 0.0:
                path = self._joints[joint.name].GetPath()
                motor = self.stage.DefinePrim(path.AppendChild("motor"), "MjcActuator")
                motor.CreateRelationship("mjc:target").SetTargets([path])
                for side, sign in (("min", -1.0), ("max", 1.0)):
                    name = f"mjc:ctrlRange:{side}"
                    motor.CreateAttribute(name, Sdf.ValueTypeNames.Double).Set(sign * float(joint.effort))

    def _add_roles(self, top: Any, pinned: list[Any]) -> None:
        """Add the joints and links that Isaac Sim lists of a robot; one fixed to the world is a manipulator."""
        if pinned:
            top.CreateAttribute("isaac:robotType", Sdf.ValueTypeNames.Token).Set("Manipulator")
        joints = [joint.GetPath() for joint in self._joints.values()]
        top.CreateRelationship("isaac:physics:robotJoints").SetTargets([*pinned, *joints])
        top.CreateRelationship("isaac:physics:robotLinks").SetTargets(list(self._paths.values()))

    def _add_loop(self, loop: LoopJoint, path: Any) -> None:
        found = UsdPhysics.SphericalJoint.Define(self.stage, path)
        self._connect(found, *loop.links)
        found.CreateLocalPos0Attr(_vector(loop.points[0]))
        found.CreateLocalPos1Attr(_vector(loop.points[1]))
        found.CreateExcludeFromArticulationAttr(True)  # an articulation is a tree

    def _add_drive(self, prim: Any, joint: Joint) -> None:
        """Damping and the largest effort; an importer adds the gains that it wants."""
        turns = joint.kind.turns
        drive = UsdPhysics.DriveAPI.Apply(prim, "angular" if turns else "linear")
        per_degree = np.pi / 180.0 if turns else 1.0
        stiffness, rest = self._content.extensions.springs.get(joint.name, (0.0, 0.0))
        drive.CreateStiffnessAttr(stiffness * per_degree)
        if stiffness:
            drive.CreateTargetPositionAttr(rest / per_degree)
        drive.CreateDampingAttr(float((joint.damping or 0.0) * per_degree))
        if joint.effort and joint.effort > 0.0:
            drive.CreateMaxForceAttr(float(joint.effort))
        friction, number = float(joint.friction or 0.0), Sdf.ValueTypeNames.Float
        prim.AddAppliedSchema("MjcJointAPI")
        prim.CreateAttribute("mjc:frictionloss", Sdf.ValueTypeNames.Double).Set(friction)
        _author(prim, "NewtonJointAPI", friction=(number, friction))
        if joint.velocity:
            prim.CreateAttribute("newton:velocityLimit", number).Set(float(joint.velocity / per_degree))

    def _keep_apart(self) -> None:
        """Pairs that no joint connects; those that one connects do not collide anyway."""
        joined = {frozenset((joint.parent, joint.child)) for joint in self._content.robot.joints}
        for first, second in self._content.apart:
            if frozenset((first, second)) not in joined:
                prim = self.stage.GetPrimAtPath(self._paths[first])
                UsdPhysics.FilteredPairsAPI.Apply(prim).CreateFilteredPairsRel().AddTarget(self._paths[second])


def _display(found: Any, color: Rgba) -> None:
    """The colour that is seen where no material is: linear light, as all colours of USD."""
    *rgb, opacity = color
    found.CreateDisplayColorAttr([_vector(linear_of(np.array(rgb)))])
    if opacity < 1.0:
        found.CreateDisplayOpacityAttr([float(opacity)])


def _primitive(stage: Any, path: Any, shape: Shape) -> Any:
    """A geometry at the origin of the frame above it."""
    if shape.kind == "box":
        found = UsdGeom.Cube.Define(stage, path)
        found.CreateSizeAttr(1.0)
        found.AddScaleOp().Set(_vector(shape.size))
    else:
        kinds = {"sphere": UsdGeom.Sphere, "cylinder": UsdGeom.Cylinder, "capsule": UsdGeom.Capsule}
        found = kinds[shape.kind].Define(stage, path)
        found.CreateRadiusAttr(float(shape.size[0]))
    if shape.kind in ("cylinder", "capsule"):
        found.CreateHeightAttr(float(shape.size[1]))
        found.CreateAxisAttr(UsdGeom.Tokens.z)
    _bound(found)
    return found


def _normals(corners: FloatArray) -> FloatArray:
    """One unit normal a triangle; upwards where a triangle has no area."""
    normals = triangle_normals(corners)
    lengths = lengths_of(normals)[:, None]
    return np.where(lengths > 0.0, normals / np.maximum(lengths, 1e-300), [0.0, 0.0, 1.0])


def _bound(found: Any) -> None:
    """State the box around a geometry, so that readers need not open its points."""
    found.CreateExtentAttr(UsdGeom.Boundable.ComputeExtentFromPlugins(found, Usd.TimeCode.Default()))


def _author(prim: Any, schema: str, **values: tuple[Any, Any]) -> None:
    """Apply a schema of Newton, which USD does not bring with it, and author its attributes by type and value."""
    prim.AddAppliedSchema(schema)
    for name, (kind, value) in values.items():
        prim.CreateAttribute(f"newton:{name}", kind).Set(value)


def _inputs(shader: Any, kind: str, **values: Any) -> None:
    """Set inputs of one type."""
    for name, value in values.items():
        shader.CreateInput(name, getattr(Sdf.ValueTypeNames, kind)).Set(value)


def _place(xform: Any, T: FloatArray) -> None:
    xform.AddTranslateOp().Set(Gf.Vec3d(*map(float, T[:3, 3])))
    xform.AddOrientOp(UsdGeom.XformOp.PrecisionDouble).Set(Gf.Quatd(*map(float, quaternion_of(T[:3, :3]))))


def _vector(values: Iterable[float]) -> Any:
    return Gf.Vec3f(*map(float, values))


def _turn(rotation: FloatArray) -> Any:
    return Gf.Quatf(*map(float, quaternion_of(np.asarray(rotation))))
