"""Blueprints as text: parts made of primitives and the joints between them, in YAML or JSON.

```yaml
name: toolbox
parts:
  - name: body
    material: steel
    shapes: [{kind: box, size: [0.4, 0.2, 0.15], xyz: [0, 0, 0.075]}]
    subtract: [{kind: box, size: [0.39, 0.19, 0.15], xyz: [0, 0, 0.08]}]
  - name: lid
    color: red
    shapes: [{kind: box, size: [0.4, 0.2, 0.01], xyz: [0, 0, 0.156]}]
joints:
  - {type: revolute, parent: body, child: lid, axis: [-1, 0, 0], pivot: [0, 0.1, 0.151], lower: 0, upper: 1.9}
```

Metres and radians, world frame, z up. Parts are given where they stand at zero; a joint that has a `value` is shown
there. Positive motion opens. A file only states what there is: nothing in it is run.
"""

from __future__ import annotations

import difflib
import json
import math
import re
from abc import abstractmethod
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
import yaml
from manifold3d import Manifold
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, field_validator, model_validator

from kinematify.errors import InputError
from kinematify.generate.procedural.blueprint import BlueprintJoint
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.materials import COLORS, MATERIALS
from kinematify.generate.procedural.parameter import pairs
from kinematify.generate.procedural.solids import SEGMENTS, ball, hull, lathe, ring, rounded_block, section, union
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Mimic
from kinematify.robot.transforms import rotation_about, rotation_from_rpy

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.materials import RGB
    from kinematify.robot.arrays import FloatArray

MOST_PARTS = 200
MOST_SHAPES = 200
"""Of one part."""
LARGEST = 1000.0
"""Of any length or coordinate [m]."""
LARGEST_FILE = 2_000_000
"""[bytes]."""
MIRRORS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
"""Normals of planes that things are mirrored across, by axis."""
_AXES = {**MIRRORS, "-x": (-1.0, 0.0, 0.0), "-y": (0.0, -1.0, 0.0), "-z": (0.0, 0.0, -1.0)}
_SHORT = pairs(
    "box size|rounded_box size radius|cylinder radius length|capsule radius length|rod radius ends|sphere radius"
    "|cone radius top_radius length|tube radius inner_radius length|torus radius wire_radius|prism outline length"
    "|lathe outline|revolute parent child lower upper|prismatic parent child lower upper|continuous parent child"
    "|fixed parent child"
)
"""Kind of shape or joint -> its first fields, which may be listed under its name."""
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
_SHOWN = 5  # problems of a file that are shown at once

Length = Annotated[float, Field(gt=0.0, le=LARGEST)]
Coordinate = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]
Angle = Annotated[float, Field(ge=-1000.0, le=1000.0)]
Vector = tuple[Coordinate, Coordinate, Coordinate]
Outline = Annotated[tuple[tuple[Coordinate, Coordinate], ...], Field(min_length=3, max_length=500)]
Name = Annotated[str, Field(max_length=64)]


class _Described(BaseModel):
    """Unknown fields and numbers that are not finite are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, use_attribute_docstrings=True)


def _in_full(values: Any) -> Any:
    """Name the fields of a shape or a joint: {cylinder: [0.1, 0.5]} is {kind: cylinder, radius: 0.1, length: 0.5}."""
    short = next((name for name in _SHORT if name in values), "") if isinstance(values, dict) else ""
    if not short:
        return values
    fields, others = _SHORT[short].split(), dict(values)
    given = others.pop(short)
    listed = given if len(fields) > 1 else [given]
    if not isinstance(listed, list) or len(listed) != len(fields):
        raise ValueError(f"{short} takes a list of {', '.join(fields)}, but it is {given}")
    return {"type" if "parent" in fields else "kind": short, **dict(zip(fields, listed, strict=True)), **others}


class Repetition(_Described):
    """Something stands there several times: evenly about an axis, the first where it is given, or evenly over a way."""

    count: Annotated[int, Field(ge=1, le=60)] | Name
    """How often, 60 times at most; in the file of a kind it may be the name of one of its `counts`."""
    about: Literal["x", "y", "z"] = "z"
    """Direction of the axis."""
    through: Vector = (0.0, 0.0, 0.0)
    """A point on the axis, world frame [m]."""
    upright: bool = False
    """It is carried around the axis without being turned; `through` is then counted from where it stands."""
    over: Vector | None = None
    """Way from the first to the last instead, in whose middle it is given, world frame [m]; one alone stands there."""

    def transforms(self, counts: Mapping[str, int]) -> list[FloatArray]:
        """Where each of them is, seen from where it is given, each of shape (3, 4)."""
        number = counts[self.count] if isinstance(self.count, str) else self.count
        if self.over is not None:
            shares = np.linspace(-0.5, 0.5, number) if number > 1 else (0.0,)
            return [np.column_stack([np.eye(3), share * np.array(self.over)]) for share in shares]
        axis, point = np.array(MIRRORS[self.about]), np.array(self.through)
        turns = [rotation_about(axis, 2.0 * math.pi * k / number) for k in range(number)]
        return [np.column_stack([np.eye(3) if self.upright else turn, point - turn @ point]) for turn in turns]


class _Placed(_Described):
    """Fields of every primitive; it is made about the origin, turned, moved, then repeated, then mirrored."""

    xyz: Vector = (0.0, 0.0, 0.0)
    """Of its middle [m]."""
    rpy: tuple[Angle, Angle, Angle] = (0.0, 0.0, 0.0)
    """Turns about the fixed x, y and z axes, in this order [rad], as in URDF."""
    mirrored: tuple[Literal["x", "y", "z"], ...] = ()
    """A list: it stands across the plane through the world's origin that each axis is normal to, too."""
    repeated: Repetition | None = None
    """How often it stands there."""

    def solid(self, counts: Mapping[str, int]) -> Manifold:
        """The primitive where it is, as often as `counts` say that are only named."""
        solid = self._upright().transform(np.column_stack([rotation_from_rpy(np.array(self.rpy)), self.xyz]))
        if self.repeated is not None:
            solid = union(*(solid.transform(placed) for placed in self.repeated.transforms(counts)))
        for axis in self.mirrored:
            solid += solid.mirror(MIRRORS[axis])
        return solid

    def _upright(self) -> Manifold:
        """The primitive about the origin along its axis, if it has one."""
        return self._made()

    @abstractmethod
    def _made(self) -> Manifold:
        """The primitive about the origin."""


class _Round(_Placed):
    """A primitive about an axis."""

    axis: Literal["x", "y", "z"] = "z"
    """Before it is turned by `rpy`."""
    sides: int = Field(SEGMENTS, ge=3, le=256)
    """Of the polygon that represents a circle."""

    def _upright(self) -> Manifold:
        return self._made().rotate({"x": (0.0, 90.0, 0.0), "y": (-90.0, 0.0, 0.0), "z": (0.0, 0.0, 0.0)}[self.axis])


class BoxShape(_Placed):
    """A box."""

    kind: Literal["box"]
    size: tuple[Length, Length, Length]
    """Along x, y and z [m]."""

    def _made(self) -> Manifold:
        return Manifold.cube(self.size, True)


class RoundedBoxShape(_Placed):
    """A box whose edges and corners are rounded."""

    kind: Literal["rounded_box"]
    size: tuple[Length, Length, Length]
    """Along x, y and z [m]."""
    radius: Length
    """Of the edges [m]; less than half of the smallest side."""

    @model_validator(mode="after")
    def _fits(self) -> RoundedBoxShape:
        if 2.0 * self.radius >= min(self.size):
            raise ValueError(
                f"the radius {self.radius:g} is not less than half of the smallest side {min(self.size):g}"
            )
        return self

    def _made(self) -> Manifold:
        return rounded_block(self.size, self.radius)


class CylinderShape(_Round):
    """A cylinder."""

    kind: Literal["cylinder"]
    radius: Length
    length: Length

    def _made(self) -> Manifold:
        return Manifold.cylinder(self.length, self.radius, self.radius, self.sides, True)


class CapsuleShape(_Round):
    """A cylinder with round ends."""

    kind: Literal["capsule"]
    radius: Length
    length: Length
    """Of the cylinder between the ends [m]."""

    def _made(self) -> Manifold:
        ball = Manifold.sphere(self.radius, self.sides)
        return Manifold.batch_hull([ball.translate((0, 0, sign * 0.5 * self.length)) for sign in (-1, 1)])


class RodShape(_Placed):
    """A cylinder with round ends, from one point to another."""

    kind: Literal["rod"]
    radius: Length
    ends: tuple[Vector, Vector]
    """Middles of the round ends [m]."""

    def _made(self) -> Manifold:
        return hull(*(ball(self.radius, end) for end in self.ends))


class SphereShape(_Placed):
    """A ball."""

    kind: Literal["sphere"]
    radius: Length

    def _made(self) -> Manifold:
        return Manifold.sphere(self.radius, 32)


class ConeShape(_Round):
    """A cone, or what is left of one without its tip."""

    kind: Literal["cone"]
    radius: Length
    """At its foot [m]."""
    top_radius: float = Field(0.0, ge=0.0, le=LARGEST)
    length: Length

    def _made(self) -> Manifold:
        return Manifold.cylinder(self.length, self.radius, self.top_radius, self.sides, True)


class TubeShape(_Round):
    """A cylinder with a bore."""

    kind: Literal["tube"]
    radius: Length
    inner_radius: Length
    length: Length

    @model_validator(mode="after")
    def _has_a_wall(self) -> TubeShape:
        if self.inner_radius >= self.radius:
            raise ValueError(f"the inner radius {self.inner_radius:g} is not less than the radius {self.radius:g}")
        return self

    def _made(self) -> Manifold:
        outer = Manifold.cylinder(self.length, self.radius, self.radius, self.sides, True)
        return outer - Manifold.cylinder(2.0 * self.length, self.inner_radius, self.inner_radius, self.sides, True)


class TorusShape(_Round):
    """A ring of round wire."""

    kind: Literal["torus"]
    radius: Length
    """From the middle to the middle of the wire [m]."""
    wire_radius: Length

    @model_validator(mode="after")
    def _has_a_hole(self) -> TorusShape:
        if self.wire_radius >= self.radius:
            raise ValueError(f"the wire radius {self.wire_radius:g} is not less than the radius {self.radius:g}")
        return self

    def _made(self) -> Manifold:
        return ring(self.radius, self.wire_radius, segments=self.sides)


class PrismShape(_Round):
    """A polygon that is drawn out along the axis, by half of the length to either side."""

    kind: Literal["prism"]
    outline: Outline
    """Corners x, y [m]; either sense."""
    length: Length

    def _made(self) -> Manifold:
        return section(self.outline).extrude(self.length).translate((0, 0, -0.5 * self.length))


class LatheShape(_Round):
    """Shape swept by a polygon that is turned about the axis."""

    kind: Literal["lathe"]
    outline: Outline
    """Corners radius, height [m]; either sense."""

    @field_validator("outline")
    @classmethod
    def _on_one_side(cls, outline: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        if min(radius for radius, _ in outline) < 0.0:
            raise ValueError("a radius is negative")
        return outline

    def _made(self) -> Manifold:
        return lathe(self.outline, segments=self.sides)


_Primitive = (
    BoxShape
    | RoundedBoxShape
    | CylinderShape
    | CapsuleShape
    | RodShape
    | SphereShape
    | ConeShape
    | TubeShape
    | TorusShape
    | PrismShape
    | LatheShape
)
Primitive = Annotated[_Primitive, Field(discriminator="kind"), BeforeValidator(_in_full)]


class HullShape(_Placed):
    """The smallest convex solid around primitives: a bar that tapers, a plate with round corners."""

    kind: Literal["hull"]
    shapes: tuple[Primitive, ...] = Field(min_length=1, max_length=50)

    def _made(self) -> Manifold:
        return hull(*(shape.solid({}) for shape in self.shapes))


Shape = Annotated[_Primitive | HullShape, Field(discriminator="kind"), BeforeValidator(_in_full)]


class PartDescription(_Described):
    """One rigid part."""

    name: Name
    """A letter, then letters, digits and ``_``; unique in any letter case."""
    shapes: tuple[Shape, ...] = Field(min_length=1, max_length=MOST_SHAPES)
    """Their union is the part."""
    subtract: tuple[Shape, ...] = Field((), max_length=MOST_SHAPES)
    """Taken away from the union."""
    material: str = "plastic"
    """Of `MATERIALS`: density and looks; glass is transparent, wood shows its grain where no colour is given."""
    color: str | tuple[float, float, float] | None = None
    """Of `COLORS`, or red, green and blue in [0, 1]."""

    @field_validator("name")
    @classmethod
    def _is_a_name(cls, name: str) -> str:
        if not _NAME.fullmatch(name) or name.casefold() == "world":
            raise ValueError(f"{name!r} is no name: a letter, then letters, digits and _, at most 64, and not 'world'")
        return name

    @field_validator("material")
    @classmethod
    def _is_a_material(cls, material: str) -> str:
        return _among(material, MATERIALS, "material")

    @field_validator("color")
    @classmethod
    def _is_a_color(cls, color: str | RGB | None) -> str | RGB | None:
        if isinstance(color, str):
            return _among(color, COLORS, "color")
        if color is not None and not all(0.0 <= share <= 1.0 for share in color):
            raise ValueError("red, green and blue must be from 0 to 1")
        return color

    def solid(self, counts: Mapping[str, int]) -> Manifold:
        """Return what is left of its shapes; `counts` as for a primitive."""
        solid = union(*(shape.solid(counts) for shape in self.shapes))
        return solid - union(*(shape.solid(counts) for shape in self.subtract)) if self.subtract else solid


class MimicDescription(_Described):
    """value = multiplier * value of the leading joint."""

    leader: Name
    """Child part of the joint that leads."""
    multiplier: float = Field(1.0, ge=-1000.0, le=1000.0)


class JointDescription(_Described):
    """Joint of one part on another one."""

    type: Literal["revolute", "continuous", "prismatic", "fixed"]
    parent: Name
    child: Name
    axis: Annotated[Vector, BeforeValidator(lambda axis: _AXES[axis] if str(axis) in _AXES else axis)] = (0.0, 0.0, 1.0)
    """Direction in the world frame, of any length, or x to -z; positive opens, by the right hand rule or along it."""
    pivot: Vector = (0.0, 0.0, 0.0)
    """A point on the axis, world frame [m]; of no effect where the joint does not turn."""
    lower: float | None = Field(None, ge=-LARGEST, le=LARGEST)
    """[rad or m], counted from where the parts are given; for revolute and prismatic joints alone."""
    upper: float | None = Field(None, ge=-LARGEST, le=LARGEST)
    value: float = Field(0.0, ge=-LARGEST, le=LARGEST)
    """At which it is shown [rad or m]; a joint that follows another one stands where that one puts it."""
    mimic: MimicDescription | None = None

    _named = model_validator(mode="before")(_in_full)

    @field_validator("axis")
    @classmethod
    def _is_a_direction(cls, axis: tuple[float, float, float]) -> tuple[float, float, float]:
        if math.hypot(*axis) < 1e-9:
            raise ValueError("the axis has no length")
        return axis

    @model_validator(mode="after")
    def _has_its_limits(self) -> JointDescription:
        limits = (self.lower, self.upper)
        if self.type in ("continuous", "fixed"):
            if limits != (None, None):
                raise ValueError(
                    f"a {self.type} joint has no limits, but lower and upper are {self.lower}, {self.upper}"
                )
            return self
        if self.lower is None or self.upper is None:
            raise ValueError(f"a {self.type} joint needs lower and upper")
        if not self.lower < self.upper:
            raise ValueError(f"lower {self.lower:g} is not less than upper {self.upper:g}")
        if not self.lower <= self.value <= self.upper:
            raise ValueError(f"the value {self.value:g} is not from {self.lower:g} to {self.upper:g}")
        return self

    def joint(self) -> BlueprintJoint:
        """The joint with the value at which it is shown."""
        free = math.inf if self.type == "continuous" else 0.0
        return BlueprintJoint(
            parent=self.parent,
            child=self.child,
            kind=JointType(self.type),
            axis=np.array(self.axis),
            pivot=np.array(self.pivot),
            lower=-free if self.lower is None else self.lower,
            upper=free if self.upper is None else self.upper,
            value=self.value,
            mimic=Mimic(joint=self.mimic.leader, multiplier=self.mimic.multiplier, offset=0.0) if self.mimic else None,
        )


class LoopDescription(_Described):
    """A pin that two parts share besides the joints: it closes a chain of joints, whose bars follow by `mimic`."""

    parts: tuple[Name, Name]
    pivot: Vector
    """A point on the pin, world frame, where the parts are given [m]."""


class BlueprintDescription(_Described):
    """An articulated object; the part that no joint carries is the base link."""

    name: Name
    category: Name = "described"
    parts: tuple[PartDescription, ...] = Field(min_length=2, max_length=MOST_PARTS)
    joints: tuple[JointDescription, ...] = Field(max_length=MOST_PARTS)
    """In any order."""
    loops: tuple[LoopDescription, ...] = Field((), max_length=MOST_PARTS)

    @model_validator(mode="after")
    def _is_a_tree(self) -> BlueprintDescription:
        names = [part.name for part in self.parts]
        _refuse_twice([name.casefold() for name in names], "parts are named")
        for joint in self.joints:
            for name in (joint.parent, joint.child, *([joint.mimic.leader] if joint.mimic else ())):
                _among(name, names, "part")
        for loop in self.loops:
            one, other = (_among(name, names, "part") for name in loop.parts)
            if one == other:
                raise ValueError(f"a loop joins {one} to itself; name two parts")
        _refuse_twice([joint.child for joint in self.joints], "joints carry")
        self._refuse_cycles()
        repeated = [s.repeated for part in self.parts for s in (*part.shapes, *part.subtract) if s.repeated]
        for repetition in repeated:
            self._refuse_unknown_count(repetition)
        roots = sorted(set(names) - {joint.child for joint in self.joints})
        if len(roots) > 1:
            raise ValueError(
                f"no joint carries {' and '.join(roots)}, but only the base link may be without; "
                "join the others to it (type: fixed if they do not move)"
            )
        self._refuse_bad_leaders()
        return self

    def _refuse_unknown_count(self, repetition: Repetition) -> None:
        if isinstance(repetition.count, str):
            raise ValueError(f"the count {repetition.count!r} is no number; only objects that ship with us name counts")

    def _refuse_cycles(self) -> None:
        above = {joint.child: joint.parent for joint in self.joints}
        for start in above:
            chain = [start]
            while chain[-1] in above:
                chain.append(above[chain[-1]])
                if chain[-1] == start:
                    raise ValueError(f"the joints go round in a circle: {' on '.join(chain)}")
                if len(chain) > len(above) + 1:
                    break  # it runs into a circle, which its own members report

    def _refuse_bad_leaders(self) -> None:
        by_child = {joint.child: joint for joint in self.joints}
        for joint in self.joints:
            if joint.mimic is None:
                continue
            if joint.value or joint.type == "fixed":
                raise ValueError(f"the joint of {joint.child} follows another one: it must move, and takes no value")
            leader = by_child.get(joint.mimic.leader)
            if leader is None or leader.mimic is not None or leader.type == "fixed":
                raise ValueError(
                    f"the joint of {joint.child} follows {joint.mimic.leader}, which has no joint that moves by itself"
                )
            value = joint.mimic.multiplier * leader.value
            if joint.lower is not None and joint.upper is not None and not joint.lower <= value <= joint.upper:
                raise ValueError(
                    f"the joint of {joint.child} would stand at {value:g}, which is not from {joint.lower:g} to "
                    f"{joint.upper:g}"
                )


def described_blueprint(values: Mapping[str, Any], *, source: str = "blueprint") -> Blueprint:
    """Build what a description says.

    Args:
        values: As in `BlueprintDescription`; lists, mappings, texts and numbers only.
        source: What it is called in messages, e.g. its path.

    Raises:
        InputError: It does not fit; the message names every place, up to five.
    """
    try:
        described = BlueprintDescription.model_validate(values)
    except ValidationError as error:
        raise InputError(f"The {source} cannot be built: {problems(error)}.") from error
    builder = ObjectBuilder(described.category)
    for part in described.parts:
        solid = part.solid({})
        if solid.is_empty():
            reason = f"Nothing is left of the part {part.name}. Give it shapes with a volume, and subtract less."
            raise InputError(f"The {source} cannot be built. {reason}")
        builder.part(part.name, solid, look=(part.material, part.color))
    for joint in described.joints:
        builder.add_joint(joint.joint())
    for loop in described.loops:
        builder.close(*loop.parts[::-1], loop.pivot)
    builder.arrange()
    return builder.finish(described.name)


def read_values(path: Path) -> Any:
    """Read a YAML or JSON file.

    Raises:
        InputError: It cannot be read.
    """
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise InputError(f"The file {path} is larger than {LARGEST_FILE // 10**6} MB, which is too large.")
        text = path.read_text(encoding="utf-8")
        return json.loads(text) if path.suffix.lower() == ".json" else yaml.safe_load(text)
    except (OSError, ValueError, yaml.YAMLError, RecursionError) as error:
        raise InputError(f"The file {path} cannot be read as JSON or YAML: {error}.") from error


def read_blueprint(path: Path) -> Blueprint:
    """Read a YAML or JSON file and build what it says.

    Raises:
        InputError: It cannot be read or does not fit.
    """
    return described_blueprint(read_values(path), source=f"blueprint {path}")


def _among(name: str, known: Sequence[str] | Mapping[str, object], what: str) -> str:
    if name in known:
        return name
    near = difflib.get_close_matches(name, list(known), n=1)
    hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(list(known)[:20])}"
    raise ValueError(f"there is no {what} {name!r}; {hint}")


def _refuse_twice(names: Sequence[str], what: str) -> None:
    if twice := [name for name, count in Counter(names).items() if count > 1]:
        raise ValueError(f"several {what} {', '.join(sorted(twice))}")


def problems(error: ValidationError) -> str:
    """Return what is wrong with values that a model refused, the first few, each with its place."""
    found = [
        ": ".join(filter(None, (".".join(map(str, item["loc"])), item["msg"])))
        for item in error.errors(include_url=False)
    ]
    more = f"; and {len(found) - _SHOWN} more" if len(found) > _SHOWN else ""
    return "; ".join(found[:_SHOWN]) + more
