"""Small models of boxes for the engine stages, written as URDF text, and a way to run a stage on them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.validation.finding import CheckResult
from kinematify.validation.run.needs import Recorder
from kinematify.validation.stage import StageRequest

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.validation.finding import JointSummary

Vector = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Box:
    """A box of a link."""

    size: Vector
    at: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Part:
    """A link of boxes and the joint above it."""

    name: str
    boxes: tuple[Box, ...]
    collision: tuple[Box, ...] | None = None
    """Collision geometry where it is not that of `boxes`."""
    parent: str | None = None
    kind: str = "fixed"
    at: Vector = (0.0, 0.0, 0.0)
    axis: Vector = (1.0, 0.0, 0.0)
    limits: tuple[float, float] = (0.0, 1.0)
    effort: float = 1000.0
    mass: float = 2.0
    inertia: Vector = (0.05, 0.05, 0.05)
    center: Vector = (0.0, 0.0, 0.0)
    """Of mass."""
    extra: str = ""
    """Elements to add to the joint, e.g. `mimic`."""


@dataclass(frozen=True, kw_only=True)
class Model:
    """A tree of parts; the joint above a part is called NAME_joint."""

    parts: tuple[Part, ...] = field(default=())

    def with_part(self, name: str, **changes: Any) -> Model:
        """Return the model with a part changed."""
        return Model(parts=tuple(replace(p, **changes) if p.name == name else p for p in self.parts))

    def write(self, folder: Path) -> Path:
        """Write the URDF."""
        path = folder / "model.urdf"
        text = "\n".join(_link(part) + _joint(part) for part in self.parts)
        path.write_text(f'<robot name="model">\n{text}</robot>\n', encoding="utf-8")
        return path


def _link(part: Part) -> str:
    collision = part.boxes if part.collision is None else part.collision
    shapes = "".join(
        f'  <{tag}>\n    <origin xyz="{_text(box.at)}"/>\n    <geometry>\n      <box size="{_text(box.size)}"/>\n'
        f"    </geometry>\n  </{tag}>\n"
        for tag, boxes in (("visual", part.boxes), ("collision", collision))
        for box in boxes
    )
    ixx, iyy, izz = part.inertia
    inertial = (
        f'  <inertial>\n    <origin xyz="{_text(part.center)}"/>\n    <mass value="{part.mass}"/>\n'
        f'    <inertia ixx="{ixx}" iyy="{iyy}" izz="{izz}" ixy="0" ixz="0" iyz="0"/>\n  </inertial>\n'
    )
    return f'<link name="{part.name}">\n{inertial}{shapes}</link>\n'


def _joint(part: Part) -> str:
    if part.parent is None:
        return ""
    return (
        f'<joint name="{part.name}_joint" type="{part.kind}">\n  <parent link="{part.parent}"/>\n'
        f'  <child link="{part.name}"/>\n  <origin xyz="{_text(part.at)}"/>\n  <axis xyz="{_text(part.axis)}"/>\n'
        f'  <limit lower="{part.limits[0]}" upper="{part.limits[1]}" effort="{part.effort}" velocity="2"/>\n'
        f"  {part.extra}\n</joint>\n"
    )


def _text(vector: Vector) -> str:
    return " ".join(str(value) for value in vector)


def cabinet() -> Model:
    """A cabinet, open in front (+x), with a drawer that comes out by 0.3 m and a door beside it."""
    walls = (
        Box(size=(0.4, 0.02, 0.4), at=(0.0, -0.31, 0.0)),
        Box(size=(0.4, 0.02, 0.4), at=(0.0, 0.31, 0.0)),
        Box(size=(0.4, 0.02, 0.4), at=(0.0, 0.0, 0.0)),
        Box(size=(0.4, 0.64, 0.02), at=(0.0, 0.0, -0.21)),
        Box(size=(0.4, 0.64, 0.02), at=(0.0, 0.0, 0.21)),
        Box(size=(0.02, 0.64, 0.44), at=(-0.21, 0.0, 0.0)),
    )
    drawer = Part(
        name="drawer",
        parent="body",
        kind="prismatic",
        boxes=(Box(size=(0.39, 0.27, 0.38)),),
        at=(0.0, -0.155, 0.0),
        limits=(0.0, 0.3),
    )
    door = Part(
        name="door",
        parent="body",
        kind="revolute",
        boxes=(Box(size=(0.02, 0.3, 0.4), at=(0.01, -0.15, 0.0)),),
        at=(0.205, 0.32, 0.0),
        axis=(0.0, 0.0, 1.0),
        limits=(0.0, 1.5),
    )
    return Model(parts=(Part(name="body", boxes=walls, mass=20.0, inertia=(1.0, 1.0, 1.0)), drawer, door))


@dataclass(frozen=True, kw_only=True)
class FindingGroup:
    """What a stage reported of one model."""

    results: dict[str, CheckResult]
    work: Path

    def worst(self, check: str) -> list[str]:
        """Severities of the findings of a check."""
        return [str(finding.severity) for finding in self.results[check].findings]


def tell(run: Callable[[StageRequest, Recorder], object], request: StageRequest) -> FindingGroup:
    """Run a stage in this process."""
    reported: list[CheckResult | JointSummary] = []
    run(request, Recorder(reported.append, request))
    results = [item for item in reported if isinstance(item, CheckResult)]
    assert len({item.check for item in results}) == len(results)
    return FindingGroup(results={item.check: item for item in results}, work=request.work)
