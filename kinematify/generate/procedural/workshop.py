"""Where a family puts its object together: solids become bodies, and joints say how they move."""

from __future__ import annotations

import math
from copy import copy
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from kinematify.assembly.part import Part
from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint, BlueprintLoop
from kinematify.generate.procedural.materials import MATERIALS, grain_coordinates, surface_of
from kinematify.generate.procedural.solids import flat, union
from kinematify.robot.appearance import Appearance
from kinematify.robot.joint_type import JointType
from kinematify.robot.vectors import lengths_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import Any

    from manifold3d import Manifold

    from kinematify.generate.procedural.materials import RGB
    from kinematify.generate.procedural.solids import Point, Solids
    from kinematify.robot.arrays import FloatArray


STYLES = ("clean", "remeshed", "coarse", "bumpy")
"""As in ``--set style=``; clean is what a CAD program exports."""
_SHARE = 0.35  # of the clearance that a surface may move; two that face each other still stay apart
_TIGHTEST = 5e-4  # [m] small hinges are built tighter than what is asked for
_EDGES = 40.0  # edges along the diagonal of a remeshed part
_MAX_TRIANGLES = 20_000  # of a remeshed part
_WAVES = 12  # of the bumps


def styled(solid: Manifold, style: str, *, clearance: float, rng: np.random.Generator) -> Manifold:
    """Return a solid in a style.

    Args:
        solid: The clean one.
        style: Of `STYLES`.
        clearance: Gap between parts that move past each other [m].
        rng: Draws the bumps and the place of every vertex.
    """
    reach = _SHARE * min(clearance, _TIGHTEST)
    if style == "coarse":
        return solid.simplify(reach)
    if style == "clean":
        return solid
    fine = _refined(solid)
    if style == "remeshed":
        return fine
    waves = _waves(solid, rng)
    return fine.warp_batch(lambda points: points + reach * _bumps(np.asarray(points), waves))


def _refined(solid: Manifold) -> Manifold:
    """Split long edges, as far as the number of triangles allows."""
    lower, upper = np.array(solid.bounding_box()[:3]), np.array(solid.bounding_box()[3:])
    length = float(np.linalg.norm(upper - lower)) / _EDGES
    while True:
        fine = solid.refine_to_length(length)
        if fine.num_tri() <= max(_MAX_TRIANGLES, 2 * solid.num_tri()):
            return fine
        length *= 1.5


def _waves(solid: Manifold, rng: np.random.Generator) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Wave vectors [rad/m], (w, 3), phases, (w,), and directions, (w, 3), of a smooth field."""
    size = float(np.linalg.norm(np.subtract(solid.bounding_box()[3:], solid.bounding_box()[:3])))
    directions = rng.normal(size=(_WAVES, 3))
    directions /= lengths_of(directions)[:, None]
    lengths = size * rng.uniform(0.05, 0.25, size=_WAVES)
    vectors = rng.normal(size=(_WAVES, 3))
    vectors *= (2.0 * np.pi / lengths / lengths_of(vectors))[:, None]
    return vectors, rng.uniform(0.0, 2.0 * np.pi, size=_WAVES), directions


def _bumps(points: FloatArray, waves: tuple[FloatArray, FloatArray, FloatArray]) -> FloatArray:
    """A field of displacements of length 1 at most, (n, 3)."""
    vectors, phases, directions = waves
    field = np.sin(points @ vectors.T + phases) @ directions
    return field / max(float(lengths_of(field).max()), 1e-12)


Look: TypeAlias = "tuple[str, str | RGB | None]"
"""Material, and colour where it is not the material's own."""
_UNMOVED = np.eye(3, 4)


class Workshop:
    """Collects bodies and joints; the first body is the base link, every other one is hung on an earlier one.

    Everything is built closed, at zero; `rest` values say where it is when it is shown. Seen `from_frame`, the same
    workshop takes everything in the coordinates of that frame.
    """

    def __init__(
        self,
        family: str,
        *,
        material: str,
        color: str | None = None,
        handles: Look = ("metal", None),
        walls: float | None = None,
    ) -> None:
        """Begin an object.

        Args:
            family: Name of the family.
            material: Of bodies that name none.
            color: Of bodies that name none; the material's own if absent.
            handles: Material and colour of handles.
            walls: Of `Part`.
        """
        self._family = family
        self._material = material
        self._color = color
        self._walls = walls
        self._solids: dict[str, Manifold] = {}
        self._handles = handles
        self._looks: dict[str, Look] = {}
        self._painted: dict[int, Look] = {}
        """By the number that a solid keeps through all that is done to it."""
        self._joints: list[BlueprintJoint] = []
        self._rest: dict[str, float] = {}
        self._loops: list[BlueprintLoop] = []
        self._frame: FloatArray | None = None

    def from_frame(self, T_frame: FloatArray) -> Workshop:
        """Return the workshop as it is seen from a frame; what is built there stands there in the object.

        Args:
            T_frame: The frame in this workshop's own, shape (3, 4).
        """
        seen = copy(self)
        own = _UNMOVED if self._frame is None else self._frame
        seen._frame = np.column_stack([own[:, :3] @ T_frame[:, :3], own @ np.append(T_frame[:, 3], 1.0)])
        return seen

    def body(self, name: str, *solids: Solids, material: str | None = None, color: str | RGB | None = None) -> str:
        """Add a rigid part made of solids that overlap or touch; returns its name."""
        if name in self._solids:
            raise ValueError(f"The family {self._family} makes two bodies named {name}.")
        self._solids[name] = union(*self._placed(flat(solids)))
        self._looks[name] = material or self._material, color or (None if material else self._color)
        return name

    def painted(self, *solids: Manifold, look: Look | None = None) -> Sequence[Manifold]:
        """Give solids a look of their own, whatever they become part of: that of handles if None; returns them."""
        for solid in solids:
            self._painted.update(dict.fromkeys(solid.to_mesh64().run_original_id, look or self._handles))
        return solids

    @property
    def looks(self) -> Mapping[str, Look]:
        """Material and colour of the bodies that are there, keyed by name."""
        return self._looks

    @property
    def moves(self) -> bool:
        """True if there is a joint."""
        return bool(self._joints)

    def add(self, name: str, *solids: Solids) -> None:
        """Add solids to a body that is there."""
        self._solids[name] = union(self._solids[name], *self._placed(flat(solids)))

    def cut(self, name: str, *solids: Solids) -> None:
        """Take solids away from a body that is there."""
        self._solids[name] -= union(*self._placed(flat(solids)))

    def settle(self) -> None:
        """Evaluate all solids now; how they are triangulated depends on which of their operands still exist."""
        for solid in self._solids.values():
            solid.num_tri()

    def turns(
        self,
        child: str,
        parent: str,
        axis: Point,
        pivot: Point,
        limits: tuple[float, float] | None = None,
        *,
        rest: float = 0.0,
    ) -> None:
        """Hang a body on another one by a hinge, or by a bearing that turns without end.

        Args:
            child: The body that moves.
            parent: The body that carries it.
            axis: Direction; positive opens by the right hand rule.
            pivot: A point on the axis [m].
            limits: [rad]; none for a continuous joint.
            rest: Share of the way from zero to the upper limit at which it is shown, in [0, 1].
        """
        kind = JointType.CONTINUOUS if limits is None else JointType.REVOLUTE
        lower, upper = limits or (-math.inf, math.inf)
        joint = BlueprintJoint(
            parent=parent, child=child, kind=kind, axis=np.asarray(axis), pivot=np.asarray(pivot), lower=lower,
            upper=upper,
        )  # fmt: skip
        self.add_joint(joint, rest)

    def slides(
        self,
        child: str,
        parent: str,
        axis: Point,
        pivot: Point,
        limits: tuple[float, float],
        *,
        rest: float = 0.0,
    ) -> None:
        """Hang a body on another one by a slide; arguments as for `turns`, limits in metres."""
        joint = BlueprintJoint(
            parent=parent, child=child, kind=JointType.PRISMATIC, axis=np.asarray(axis), pivot=np.asarray(pivot),
            lower=limits[0], upper=limits[1],
        )  # fmt: skip
        self.add_joint(joint, rest)

    def closes(self, one: str, other: str, pivot: Point) -> None:
        """Say that two bodies share a pin at `pivot` [m] besides the joints of the tree."""
        self._loops.append(BlueprintLoop(one=one, other=other, pivot=self._point(pivot)))

    def _placed(self, solids: Sequence[Manifold]) -> Sequence[Manifold]:
        frame = self._frame
        return solids if frame is None else [solid.transform(frame) for solid in solids]

    def _point(self, point: Point) -> FloatArray:
        return np.asarray(point if self._frame is None else self._frame @ np.append(point, 1.0))

    def add_joint(self, joint: BlueprintJoint, rest: float = 0.0) -> None:
        """Hang a body on another one as a joint says.

        Args:
            joint: It is shown at its `value`, unless it is to stand open.
            rest: As for `turns`.
        """
        axis = joint.axis if self._frame is None else self._frame[:, :3] @ joint.axis
        self._joints.append(replace(joint, axis=axis, pivot=self._point(joint.pivot), value=0.0))
        if joint.mimic is None:
            opened = rest * joint.upper if math.isfinite(joint.upper) else 0.0
            self._rest[joint.child] = opened or joint.value

    def finish(
        self, name: str, parameters: Mapping[str, Any], *, style: str, clearance: float, rng: np.random.Generator
    ) -> Blueprint:
        """Return the object in the configuration in which it is shown.

        Args:
            name: Of the object.
            parameters: What it was built with, for the record.
            style: Of its meshes.
            clearance: Gap that the style must keep open [m].
            rng: Draws what the style leaves open.
        """
        self._solids = {k: styled(solid, style, clearance=clearance, rng=rng) for k, solid in self._solids.items()}
        built = Blueprint(
            name=name,
            family=self._family,
            parts=tuple(self._made(body) for body in self._solids),
            joints=tuple(self._joints),
            loops=tuple(self._loops),
            parameters=parameters,
        )
        return built.moved(self._rest)

    def _made(self, name: str) -> Part:
        mesh = self._solids[name].to_mesh64()
        material, color = self._looks[name]
        vertices, faces = mesh.vert_properties[:, :3], mesh.tri_verts.astype(np.int64)
        looks = [self._painted.get(number, self._looks[name]) for number in mesh.run_original_id]
        kinds = list(dict.fromkeys([self._looks[name], *looks]))  # what it is made of comes first
        runs = np.diff(mesh.run_index) // 3
        materials = tuple(surface_of(*look) for look in kinds)
        shift = 0.37 * list(self._solids).index(name)
        return Part(
            name=name,
            vertices=vertices,
            faces=faces,
            color=surface_of(material, color).color[:3],
            appearance=Appearance(
                materials=materials,
                material_of_face=np.repeat([kinds.index(look) for look in looks], runs),
                uv=grain_coordinates(vertices, faces, shift=shift) if any(item.texture for item in materials) else None,
            ),
            density=MATERIALS[material].density,
            walls=self._walls,
        )
