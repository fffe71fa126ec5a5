"""The sheet on which a recipe draws an object, and the hand that draws it: the same object, modelled in many ways."""

from __future__ import annotations

import math
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.generate.procedural import solids
from kinematify.generate.procedural.blueprint import BlueprintJoint
from kinematify.generate.procedural.materials import MATERIALS
from kinematify.generate.procedural.solids import flat, union
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Mimic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.solids import Point, Solids
    from kinematify.generate.procedural.workshop import Look, Workshop
    from kinematify.robot.arrays import FloatArray

_Motion = tuple[float, float, float]
"""Lower and upper limit, and the value at which a joint is shown [rad or m]."""
_LENGTHS = {"ball": 2, "lathe": 2, "cylinder": 4, "rod": 4, "cone": 5, "tube": 5, "beam": 4}
"""How many arguments of a shape are points and lengths, 3 of others; the rest are directions."""
_ROUND = (solids.cylinder, solids.cone, solids.tube, solids.torus, solids.rod, solids.lathe)


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


class ObjectBuilder:
    """Collects parts and joints; world frame, z up, metres; front is -y unless a recipe has none."""

    def __init__(
        self, name: str, style: ModelingStyle, workshop: Workshop, rng: np.random.Generator | None = None
    ) -> None:
        """Begin an object, or add to the one that is in a workshop."""
        self.name, self.style, self.workshop, self.rng = name, style, workshop, rng
        self._parts = {name: _Drawn(look=look) for name, look in workshop.looks.items()}
        self.joints: list[BlueprintJoint] = []
        """Each with the `value` at which it is shown."""
        self.loops: list[tuple[str, str, Point]] = []
        """Two parts, and a point on the pin that they share besides the joints of the tree [m]."""
        self.rounds = {solid.__name__: partial(solid, segments=style.sides) for solid in _ROUND}
        """What is round, with as many sides as this hand gives it."""
        self.cylinder, self.cone, self.tube, self.torus, self.rod, self.lathe = self.rounds.values()

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

    def part(self, name: str, *solids: Solids, look: str | Look = "plastic") -> str:
        """Add a part, or shapes to a part that is there; returns its name.

        Args:
            name: Of the part.
            solids: Its shapes.
            look: ``steel``, ``red steel`` or ``red``, which is of plastic; or material and colour.
        """
        shapes = flat(solids)
        if any(shape.is_empty() for shape in shapes):
            raise ValueError(f"a shape of {name} has no volume")
        self._parts.setdefault(name, _Drawn(look=look_of(look))).solids.extend(shapes)
        return name

    def painted(self, *shapes: Manifold, material: str, color: str | None = None) -> Sequence[Manifold]:
        """Give shapes a look of their own, whatever they become part of; returns them."""
        return self.workshop.painted(*shapes, look=(material, color))

    def front(self, name: str, parent: str, *shapes: Solids, material: str | None = None) -> str:
        """Add a part that looks like its parent, unless a material is given; returns its name."""
        return self.part(name, *shapes, look=material or self._parts[parent].look)

    def sized(self, size: float) -> Sized:
        """Return points and shapes in units of a size [m]."""
        return Sized(self, size)

    def cut(self, name: str, *shapes: Solids) -> None:
        """Take shapes away from a part."""
        self._parts[name].cuts.extend(flat(shapes))

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
        """Make a part turn within limits [rad]; `rest` is where it is unless it is drawn `ajar`, which it may be."""
        shown = self._shown(child, lower, upper, rest, ajar=ajar)
        self._add_joint(JointType.REVOLUTE, child, parent, axis, pivot, shown)

    def spin(self, child: str, parent: str, axis: Point, pivot: Point) -> None:
        """Make a part turn without end."""
        self._add_joint(JointType.CONTINUOUS, child, parent, axis, pivot, (-math.inf, math.inf, 0.0))

    def slide(
        self, child: str, parent: str, axis: Point, upper: float, lower: float = 0.0, *, ajar: bool = True
    ) -> None:
        """Make a part slide within limits [m]."""
        shown = self._shown(child, lower, upper, 0.0, ajar=ajar)
        self._add_joint(JointType.PRISMATIC, child, parent, axis, (0.0, 0.0, 0.0), shown)

    def fix(self, child: str, parent: str) -> None:
        """A part of its own that does not move."""
        self._add_joint(JointType.FIXED, child, parent, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    def follow(self, child: str, leader: str, multiplier: float = 1.0) -> None:
        """Make the joint of a part follow that of another one."""
        place = [joint.child for joint in self.joints].index(child)
        follows = Mimic(joint=leader, multiplier=multiplier, offset=0.0)
        self.joints[place] = replace(self.joints[place], value=0.0, mimic=follows)

    def close(self, child: str, parent: str, pivot: Point) -> None:
        """Close a loop: two parts share a pin besides the joints of the tree."""
        self.loops.append((parent, child, pivot))

    def _shown(self, child: str, lower: float, upper: float, rest: float, *, ajar: bool) -> _Motion:
        """Limits, and the value at which a joint is shown: where it rests unless it is drawn `ajar`."""
        opens = ajar and self.style.initial_opening and self.maybe(0.7)
        value = self.style.initial_opening * upper * self.draw(0.3, 1.0) if opens else rest
        if not lower <= value <= upper or lower == upper:
            raise ValueError(f"{child} would stand at {value:g} and move from {lower:g} to {upper:g}")
        return lower, upper, value

    def _add_joint(self, kind: JointType, child: str, parent: str, axis: Point, pivot: Point, motion: _Motion) -> None:
        lower, upper, value = map(float, motion)
        joint = BlueprintJoint(
            parent=parent, child=child, kind=kind, lower=lower, upper=upper, value=value,
            axis=np.asarray(axis, dtype=np.float64), pivot=np.asarray(pivot, dtype=np.float64),
        )  # fmt: skip
        self.joints.append(joint)

    # ---- the whole -------------------------------------------------------------------------------------------------

    @property
    def looks(self) -> Mapping[str, Look]:
        """Looks of all parts."""
        return {name: part.look for name, part in self._parts.items()}

    def solids(self) -> Mapping[str, Manifold]:
        """Return all parts; what stands on nothing comes first."""
        children = {joint.child for joint in self.joints}
        found = {}
        for name in sorted(self._parts, key=children.__contains__):
            part = self._parts[name]
            found[name] = union(*part.solids) - union(*part.cuts) if part.cuts else union(*part.solids)
            if found[name].is_empty():
                raise ValueError(f"nothing is left of the part {name}")
        return found


def look_of(said: str | Look) -> Look:
    """Return material and colour of a look, plastic where it names a colour alone."""
    if not isinstance(said, str):
        return said
    color, _, material = ("", "", said) if said in MATERIALS else said.rpartition(" ")
    return (material, color or None) if material in MATERIALS else ("plastic", said)


class Sized:
    """Points in units of a size, and under their names all shapes whose points and lengths are given in it."""

    def __init__(self, builder: ObjectBuilder, size: float) -> None:
        """Take what is round as a builder draws it."""
        self._rounds, self._size = builder.rounds, float(size)

    def __call__(self, x: float, y: float, z: float) -> FloatArray:
        """Return a point."""
        return self._size * np.array([x, y, z], dtype=np.float64)

    def __getattr__(self, name: str) -> Callable[..., Manifold]:
        """Return a function that makes a shape."""
        make, count = self._rounds.get(name) or getattr(solids, name), _LENGTHS.get(name, 3)
        return lambda *given: make(*(np.multiply(self._size, item) for item in given[:count]), *given[count:])


@contextmanager
def drawn_on(workshop: Workshop, clearance: float, rest: float = 0.0) -> Iterator[ObjectBuilder]:
    """Return a builder that lets a careful hand add parts to an object that is there, and change its parts.

    Args:
        workshop: With the object; parts are drawn in its frame.
        clearance: Between parts that move past each other [m].
        rest: Share of the way that what is added stands open.
    """
    there = set(workshop.looks)
    style = replace(CAREFUL, gap=clearance, sides=solids.SEGMENTS, knob="pointer")
    builder = ObjectBuilder("", style, workshop)
    yield builder
    for name, part in builder._parts.items():
        if name not in there:
            material, color = part.look
            workshop.body(name, *part.solids, material=material, color=color)
        elif part.solids:
            workshop.add(name, *part.solids)
        if part.cuts:
            workshop.cut(name, *part.cuts)
    for joint in builder.joints:
        workshop.add_joint(joint, rest)


def spread(count: int, low: float, high: float) -> Sequence[float]:
    """Middles of `count` equal fields between two bounds [m]."""
    step = (high - low) / max(count, 1)
    return [low + (k + 0.5) * step for k in range(count)]
