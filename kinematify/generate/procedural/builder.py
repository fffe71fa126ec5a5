"""Builder on which a kind puts its object together, and modelling styles: the same object, modelled in many ways."""

from __future__ import annotations

import math
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.assembly.part import Part
from kinematify.generate.procedural import solids
from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint, BlueprintLoop, parents_first
from kinematify.generate.procedural.materials import MATERIALS, grain_coordinates, surface_of
from kinematify.generate.procedural.mesh_styles import styled
from kinematify.generate.procedural.solids import flat, union
from kinematify.robot.appearance import Appearance
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Mimic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from typing import TypeAlias

    from manifold3d import Manifold

    from kinematify.generate.procedural.materials import RGB
    from kinematify.generate.procedural.solids import Point, Solids
    from kinematify.robot.arrays import FloatArray

    Look: TypeAlias = tuple[str, str | RGB | None]
    """Material, and colour where it is not the material's own."""

_LENGTHS = {"ball": 2, "lathe": 2, "cylinder": 4, "rod": 4, "cone": 5, "tube": 5, "beam": 4}
"""How many arguments of a shape are points and lengths, 3 of others; the rest are directions."""
_ROUND = (solids.cylinder, solids.cone, solids.tube, solids.torus, solids.rod, solids.lathe)
_ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class ModelingStyle:
    """Modelling style of one person, whatever the object is."""

    gap: float
    """Clearance where parts move past each other [m]; less on small parts."""
    has_bore: bool
    """Shafts and drawers stand in holes; otherwise in the solid, or on it."""
    hollow: bool
    """Cases have walls; otherwise they are blocks."""
    sides: int
    """Of what is round."""
    grips: str
    """``merged`` with what they are fixed to, ``apart``, or ``none``."""
    barrels: bool
    """Hinges are drawn."""
    max_penetration: float
    """What is put on a surface stands in it by this share of its height."""
    line: float
    """Where hinges run in the thickness of a leaf: 0 at its back, 1 at its front."""
    drawer: str
    """``tray``, ``block``, or ``front``: the front alone."""
    wheel: str
    """``disc``, ``tyre`` or ``spokes``."""
    knob: str
    """``plain``, ``pointer``, ``bar``, ``ball`` or ``star``."""
    initial_opening: float
    """Share of the way that it stands open."""
    rounded: bool
    """Boxes have rounded edges."""


CAREFUL = ModelingStyle(
    gap=0.001, has_bore=True, hollow=True, sides=24, grips="merged", barrels=False, max_penetration=0.0, line=1.0,
        drawer="tray",
    wheel="disc", knob="plain", initial_opening=0.0, rounded=False,
)  # fmt: skip
"""Models so that everything moves freely."""


@dataclass(kw_only=True)
class _Drawn:
    """A part; what is cut from it is cut from all its solids, whenever they were added."""

    look: Look
    solids: list[Manifold] = field(default_factory=list)
    cuts: list[Manifold] = field(default_factory=list)

    def whole(self) -> Manifold:
        """All of it in one solid."""
        solid = self.solids[0] if len(self.solids) == 1 else union(*self.solids)
        return solid - union(*self.cuts) if self.cuts else solid


class ObjectBuilder:
    """Collects parts and joints, closed, at zero; world frame, z up, metres; front is -y unless a kind has none.

    What is cut from a part is cut from all its solids, whenever they are added; where a builder `carves`, from those
    that are there. Seen `from_frame`, it takes everything in the coordinates of that frame.
    """

    def __init__(
        self,
        family: str,
        style: ModelingStyle = CAREFUL,
        rng: np.random.Generator | None = None,
        *,
        carves: bool = False,
        look: Look = ("plastic", None),
        handles: Look = ("metal", None),
    ) -> None:
        """Begin an object.

        Args:
            family: Its kind.
            style: How it is modelled.
            rng: Draws what is left open; nothing is drawn without one.
            carves: A cut takes effect at once.
            look: Material and colour of parts that name none.
            handles: Material and colour of handles.
        """
        self.family, self.style, self.rng, self._carves = family, style, rng, carves
        self._look, self._handles = look, handles
        self._parts: dict[str, _Drawn] = {}
        self._painted: dict[int, Look] = {}
        """By the number that a solid keeps through all that is done to it."""
        self.joints: list[BlueprintJoint] = []
        self.shown: dict[str, float] = {}
        """Child of a joint -> value at which that is shown [rad or m]."""
        self._loops: list[BlueprintLoop] = []
        self._frame: FloatArray | None = None
        self.rounds = {solid.__name__: partial(solid, segments=style.sides) for solid in _ROUND}
        """What is round, with as many sides as this hand gives it."""
        self.cylinder, self.cone, self.tube, self.torus, self.rod, self.lathe = self.rounds.values()

    def from_frame(self, T_frame: FloatArray) -> ObjectBuilder:
        """Return the builder as it is seen from a frame, shape (3, 4), in its own; what is built there stands there."""
        seen = copy(self)
        own = np.eye(3, 4) if self._frame is None else self._frame
        seen._frame = np.column_stack([own[:, :3] @ T_frame[:, :3], own @ np.append(T_frame[:, 3], 1.0)])
        return seen

    @contextmanager
    def fitted(self, opened: float = 0.0) -> Iterator[ObjectBuilder]:
        """Return a builder for parts that are fitted to what is there; when it is left, they are, and cuts take effect.

        Args:
            opened: Share of the way that they stand open.
        """
        fitting = ObjectBuilder(self.family, self.style, handles=self._handles)
        fitting._parts = {name: _Drawn(look=part.look) for name, part in self._parts.items()}
        fitting._painted = self._painted
        yield fitting
        for name, part in fitting._parts.items():
            if part.solids:
                self.part(name, *part.solids, look=part.look)
            if part.cuts:
                self.cut(name, *part.cuts)
        for joint in fitting.joints:
            self.add_joint(replace(joint, value=fitting.shown[joint.child]), opened)

    # ---- draws -----------------------------------------------------------------------------------------------------

    def draw(self, low: float, high: float) -> float:
        """A number; the middle where nothing is drawn."""
        return 0.5 * (low + high) if self.rng is None else float(self.rng.uniform(low, high))

    def count(self, low: int, high: int) -> int:
        """A count, both ends included; the middle where nothing is drawn."""
        return (low + high) // 2 if self.rng is None else int(self.rng.integers(low, high + 1))

    def maybe(self, share: float = 0.5) -> bool:
        """True in a share of the cases; true where nothing is drawn and that share is half at least."""
        return share >= 0.5 if self.rng is None else bool(self.rng.random() < share)

    def pick(self, *options: Any) -> Any:
        """One of them; the first where nothing is drawn."""
        return options[0 if self.rng is None else int(self.rng.integers(len(options)))]

    def gap(self, size: float) -> float:
        """Clearance about something of a size [m]."""
        return min(self.style.gap, 0.03 * size)

    # ---- parts -----------------------------------------------------------------------------------------------------

    def part(self, name: str, *shapes: Solids, look: str | Look | None = None) -> str:
        """Add a part, or shapes to a part that is there; returns its name.

        Args:
            name: Of the part.
            shapes: Its shapes, which overlap or touch.
            look: ``steel``, ``red steel``, or ``red`` alone; or material and colour; as the object if None.
        """
        placed = self._placed(shapes)
        if not self._carves and any(shape.is_empty() for shape in placed):
            raise ValueError(f"a shape of {name} has no volume")
        part = self._parts.setdefault(name, _Drawn(look=self._look_of(look)))
        part.solids = [union(*part.solids, *placed)] if self._carves else [*part.solids, *placed]
        return name

    def _look_of(self, said: str | Look | None) -> Look:
        if not isinstance(said, str):
            return said or self._look
        color, _, material = ("", "", said) if said in MATERIALS else said.rpartition(" ")
        return (material, color or None) if material in MATERIALS else (self._look[0], said)

    def painted(self, *shapes: Manifold, look: str | Look | None = None) -> Sequence[Manifold]:
        """Give shapes a look of their own, whatever they become part of: that of handles if None; returns them."""
        own = self._handles if look is None else self._look_of(look)
        for shape in shapes:
            self._painted.update(dict.fromkeys(shape.to_mesh64().run_original_id, own))
        return shapes

    def front(self, name: str, parent: str, *shapes: Solids, material: str | None = None) -> str:
        """Add a part that looks like its parent, unless a material is given; returns its name."""
        return self.part(name, *shapes, look=material or self._parts[parent].look)

    def sized(self, size: float) -> Sized:
        """Return points and shapes in units of a size [m]."""
        return Sized(self, size)

    def cut(self, name: str, *shapes: Solids) -> None:
        """Take shapes away from a part."""
        part = self._parts[name]
        part.cuts += self._placed(shapes)
        if self._carves:
            part.solids, part.cuts = [part.whole()], []

    def bore(self, name: str, *shapes: Solids) -> None:
        """Take shapes away where this hand makes holes."""
        if self.style.has_bore:
            self.cut(name, *shapes)

    # ---- joints ----------------------------------------------------------------------------------------------------

    def hinge(
        self,
        child: str,
        parent: str,
        axis: Point,
        pivot: Point,
        upper: float,
        lower: float = 0.0,
        *,
        ajar: bool = True,
        rest: float = 0.0,
    ) -> None:
        """Make a part turn within limits [rad].

        Args:
            child: What moves.
            parent: What carries it.
            axis: Direction; positive opens by the right hand rule.
            pivot: A point on the axis [m].
            upper: Limit.
            lower: Limit.
            ajar: It may be drawn open.
            rest: Where it is otherwise.
        """
        self._joint(JointType.REVOLUTE, child, parent, axis, pivot, lower, upper, self._shown(upper, rest, ajar=ajar))

    def spin(self, child: str, parent: str, axis: Point, pivot: Point) -> None:
        """Make a part turn without end."""
        self._joint(JointType.CONTINUOUS, child, parent, axis, pivot, -math.inf, math.inf)

    def slide(
        self,
        child: str,
        parent: str,
        axis: Point,
        upper: float,
        lower: float = 0.0,
        *,
        pivot: Point = _ORIGIN,
        ajar: bool = True,
        rest: float = 0.0,
    ) -> None:
        """Make a part slide within limits [m]; arguments as of `hinge`."""
        self._joint(JointType.PRISMATIC, child, parent, axis, pivot, lower, upper, self._shown(upper, rest, ajar=ajar))

    def fix(self, child: str, parent: str) -> None:
        """A part of its own that does not move."""
        self._joint(JointType.FIXED, child, parent, (0.0, 0.0, 1.0), _ORIGIN, 0.0, 0.0)

    def follow(self, child: str, leader: str, multiplier: float = 1.0) -> None:
        """Make the joint of a part follow that of another one."""
        place = [joint.child for joint in self.joints].index(child)
        follows = Mimic(joint=leader, multiplier=multiplier, offset=0.0)
        self.joints[place] = replace(self.joints[place], mimic=follows)

    def close(self, child: str, parent: str, pivot: Point) -> None:
        """Close a loop: two parts share a pin at a point [m] besides the joints of the tree."""
        self._loops.append(BlueprintLoop(one=parent, other=child, pivot=self._point(pivot)))

    def add_joint(self, joint: BlueprintJoint, opened: float = 0.0) -> None:
        """Add a joint, which is shown at its `value`, or open by a share of its way."""
        axis = joint.axis if self._frame is None else self._frame[:, :3] @ joint.axis
        self.joints.append(replace(joint, axis=axis, pivot=self._point(joint.pivot), value=0.0))
        way = opened * joint.upper if math.isfinite(joint.upper) else 0.0
        self.shown[joint.child] = way or joint.value

    def _shown(self, upper: float, rest: float, *, ajar: bool) -> float:
        """Value at which a joint is shown: where it rests unless it is drawn `ajar`."""
        opens = ajar and self.style.initial_opening and self.maybe(0.7)
        return self.style.initial_opening * upper * self.draw(0.3, 1.0) if opens else rest

    def _joint(
        self,
        kind: JointType,
        child: str,
        parent: str,
        axis: Point,
        pivot: Point,
        lower: float,
        upper: float,
        value: float = 0.0,
    ) -> None:
        if not lower <= value <= upper or (lower == upper and kind is not JointType.FIXED):
            raise ValueError(f"{child} would stand at {value:g} and move from {lower:g} to {upper:g}")
        self.add_joint(
            BlueprintJoint(
                parent=parent, child=child, kind=kind, lower=float(lower), upper=float(upper), value=float(value),
                axis=solids.point(axis), pivot=solids.point(pivot),
            )
        )  # fmt: skip

    def _placed(self, shapes: Sequence[Solids]) -> list[Manifold]:
        frame = self._frame
        return flat(shapes) if frame is None else [shape.transform(frame) for shape in flat(shapes)]

    def _point(self, point: Point) -> FloatArray:
        return np.asarray(point if self._frame is None else self._frame @ np.append(point, 1.0))

    # ---- the whole -------------------------------------------------------------------------------------------------

    def settle(self) -> None:
        """Evaluate all parts now; how they are triangulated depends on which of their operands still exist."""
        for name, part in self._parts.items():
            part.solids, part.cuts = [part.whole()], []
            if part.solids[0].is_empty():
                raise ValueError(f"nothing is left of the part {name}")

    def arrange(self, material: str = "", color: str = "", opened: float = 0.0) -> None:
        """Settle an object that was drawn in any order: the base link comes first, and parents before their children.

        Args:
            material: Of the base link, and of what looks like it; their own if empty.
            color: Of them.
            opened: Share of their way that joints stand open, if it is not zero.
        """
        children = {joint.child for joint in self.joints}
        self._parts = {name: self._parts[name] for name in sorted(self._parts, key=children.__contains__)}
        self.settle()
        base = next(iter(self._parts.values())).look
        for part in self._parts.values():
            if part.look == base:
                part.look = material or base[0], color or base[1]
        self.joints = list(parents_first(self.joints))
        for joint in self.joints:
            way = opened * joint.upper if math.isfinite(joint.upper) else 0.0
            self.shown[joint.child] = way or self.shown[joint.child]

    def finish(
        self,
        name: str = "",
        parameters: Mapping[str, Any] | None = None,
        *,
        mesh_style: str = "clean",
        clearance: float = 0.0,
        seed: int | None = None,
        walls: float | None = None,
    ) -> Blueprint:
        """Return the object in the configuration in which it is shown.

        Args:
            name: Of the object; that of its kind if empty.
            parameters: What it was built with, for the record.
            mesh_style: Of its meshes, see `STYLES`.
            clearance: Gap that the style must keep open [m].
            seed: Draws what the style leaves open.
            walls: Of `Part`.
        """
        rng = np.random.default_rng(seed)
        wholes = {k: styled(v.whole(), mesh_style, clearance, rng) for k, v in self._parts.items()}
        built = Blueprint(
            name=name or self.family,
            family=self.family,
            parts=tuple(self._made(part, number, wholes[part], walls) for number, part in enumerate(wholes)),
            joints=tuple(self.joints),
            loops=tuple(self._loops),
            parameters=parameters or {},
        )
        return built.moved(self.shown)

    def _made(self, name: str, number: int, solid: Manifold, walls: float | None) -> Part:
        mesh, look = solid.to_mesh64(), self._parts[name].look
        vertices, faces = mesh.vert_properties[:, :3], mesh.tri_verts.astype(np.int64)
        looks = [self._painted.get(original, look) for original in mesh.run_original_id]
        kinds = list(dict.fromkeys([look, *looks]))  # what it is made of comes first
        materials = tuple(surface_of(*kind) for kind in kinds)
        has_grain = any(item.texture for item in materials)
        return Part(
            name=name,
            vertices=vertices,
            faces=faces,
            color=materials[0].color[:3],
            appearance=Appearance(
                materials=materials,
                material_of_face=np.repeat([kinds.index(item) for item in looks], np.diff(mesh.run_index) // 3),
                uv=grain_coordinates(vertices, faces, shift=0.37 * number) if has_grain else None,
            ),
            density=MATERIALS[look[0]].density,
            walls=walls,
        )


class Sized:
    """Points in units of a size, and under their names all shapes whose points and lengths are given in it."""

    def __init__(self, builder: ObjectBuilder, size: float) -> None:
        """Take what is round as a builder draws it."""
        self._rounds, self._size = builder.rounds, float(size)

    def __call__(self, x: float, y: float, z: float) -> FloatArray:
        """Return a point."""
        return self._size * solids.vector(x, y, z)

    def __getattr__(self, name: str) -> Callable[..., Manifold]:
        """Return a function that makes a shape."""
        make, count = self._rounds.get(name) or getattr(solids, name), _LENGTHS.get(name, 3)
        return lambda *given: make(*(np.multiply(self._size, item) for item in given[:count]), *given[count:])


def spread(count: int, low: float, high: float) -> Sequence[float]:
    """Middles of `count` equal fields between two bounds [m]."""
    step = (high - low) / max(count, 1)
    return [low + (k + 0.5) * step for k in range(count)]
