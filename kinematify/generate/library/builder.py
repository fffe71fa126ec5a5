"""The sheet on which a recipe draws an object, and the hand that draws it: the same object, modelled in many ways."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.generate.library.shapes import Point, Shape

_ROUND = {"cylinder", "capsule", "cone", "tube", "torus", "lathe"}


@dataclass(frozen=True, kw_only=True)
class ModelingStyle:
    """How one person models, whatever the object is."""

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

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> ModelingStyle:
        """Somebody."""

        def one_of(*options: Any) -> Any:
            return options[int(rng.integers(len(options)))]

        return cls(
            gap=one_of(0.0, 0.0, 0.0005, 0.002, 0.005, 0.01),
            has_bore=one_of(True, False),
            hollow=one_of(True, True, False),
            sides=one_of(8, 12, 16, 24, 32, 48),
            grips=one_of("merged", "merged", "apart", "none"),
            barrels=one_of(True, False, False),
            max_penetration=one_of(0.0, 0.0, 0.2, 0.5),
            line=one_of(0.0, 0.5, 0.5, 1.0),
            drawer=one_of("tray", "tray", "block", "front"),
            wheel=one_of("disc", "disc", "tyre", "spokes"),
            knob=one_of("plain", "plain", "pointer", "bar", "ball", "star"),
            initial_opening=one_of(0.0, 0.0, 0.0, 0.1, 0.3, 0.6),
            rounded=one_of(False, False, False, True),
        )


CAREFUL = ModelingStyle(
    gap=0.001, has_bore=True, hollow=True, sides=24, grips="merged", barrels=False, max_penetration=0.0, line=1.0,
        drawer="tray",
    wheel="disc", knob="plain", initial_opening=0.0, rounded=False,
)  # fmt: skip
"""Models so that everything moves freely."""


class ObjectBuilder:
    """Collects parts and joints; world frame, z up, metres; front is -y unless a recipe has none."""

    def __init__(self, name: str, style: ModelingStyle, rng: np.random.Generator | None = None) -> None:
        """Begin an object."""
        self.name, self.style, self.rng = name, style, rng
        self._parts: dict[str, dict[str, Any]] = {}
        self._joints: list[dict[str, Any]] = []
        self._loops: list[dict[str, Any]] = []

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

    def part(self, name: str, *shapes: Shape, material: str = "plastic", color: str | None = None) -> str:
        """Add a part, or shapes to a part that is there; returns its name."""
        if name not in self._parts:
            self._parts[name] = {"name": name, "shapes": [], "subtract": [], "material": material, "color": color}
        self._parts[name]["shapes"] += [self._handmade(shape) for shape in shapes]
        return name

    def front(self, name: str, parent: str, *shapes: Shape, material: str | None = None) -> str:
        """Add a part that looks like its parent, unless a material is given; returns its name."""
        look = self._parts[parent]
        if material or name in self._parts:
            return self.part(name, *shapes, material=material or "")
        return self.part(name, *shapes, material=look["material"], color=look["color"])

    def cut(self, name: str, *shapes: Shape) -> None:
        """Take shapes away from a part."""
        self._parts[name]["subtract"] += [self._handmade(shape) for shape in shapes]

    def bore(self, name: str, *shapes: Shape) -> None:
        """Take shapes away where this hand makes holes."""
        if self.style.has_bore:
            self.cut(name, *shapes)

    def _handmade(self, shape: Shape) -> Shape:
        if shape["kind"] in _ROUND:
            return {"sides": self.style.sides, **shape}
        return shape

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
        """Let a part turn within limits [rad]; `rest` is where it is unless it is drawn `ajar`, which it may be."""
        self._join("revolute", child, parent, axis, pivot, lower, upper, ajar, rest)

    def spin(self, child: str, parent: str, axis: Point, pivot: Point) -> None:
        """Let a part turn without end."""
        self._joints.append(
            {"type": "continuous", "child": child, "parent": parent, "axis": list(axis), "pivot": list(pivot)}
        )

    def slide(
        self, child: str, parent: str, axis: Point, upper: float, lower: float = 0.0, *, ajar: bool = True
    ) -> None:
        """Let a part slide within limits [m]."""
        self._join("prismatic", child, parent, axis, (0.0, 0.0, 0.0), lower, upper, ajar)

    def fix(self, child: str, parent: str) -> None:
        """A part of its own that does not move."""
        self._joints.append({"type": "fixed", "child": child, "parent": parent})

    def follow(self, child: str, leader: str, multiplier: float = 1.0) -> None:
        """Let the joint of a part follow that of another one."""
        joint = next(joint for joint in self._joints if joint["child"] == child)
        joint |= {"value": 0.0, "mimic": {"leader": leader, "multiplier": multiplier}}

    def close(self, child: str, parent: str, pivot: Point) -> None:
        """Let two parts share a pin besides the joints of the tree."""
        self._loops.append({"parts": [parent, child], "pivot": list(map(float, pivot))})

    def _join(
        self,
        kind: str,
        child: str,
        parent: str,
        axis: Point,
        pivot: Point,
        lower: float,
        upper: float,
        ajar: bool,
        rest: float = 0.0,
    ) -> None:
        value = (
            self.style.initial_opening * upper * self.draw(0.3, 1.0)
            if ajar and self.style.initial_opening and self.maybe(0.7)
            else rest
        )
        placed = {"axis": list(map(float, axis)), "pivot": list(map(float, pivot))}
        limits = {"lower": float(lower), "upper": float(upper), "value": value}
        self._joints.append({"type": kind, "child": child, "parent": parent, **placed, **limits})

    # ---- the whole -------------------------------------------------------------------------------------------------

    def description(self) -> dict[str, Any]:
        """The object as a blueprint file says it; what stands on nothing comes first."""
        children = {joint["child"] for joint in self._joints}
        return {
            "name": self.name,
            "category": self.name,
            "parts": sorted(self._parts.values(), key=lambda part: part["name"] in children),
            "joints": self._joints,
            "loops": self._loops,
        }


def spread(count: int, low: float, high: float) -> Sequence[float]:
    """Middles of `count` equal fields between two bounds [m]."""
    step = (high - low) / max(count, 1)
    return [low + (k + 0.5) * step for k in range(count)]
