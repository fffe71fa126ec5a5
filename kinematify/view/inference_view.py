"""Joints of `inference.json` of a model folder, as the page shows it."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import InputError
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics
from kinematify.view.alternatives import JointAlternative

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import LoopJoint, Robot
    from kinematify.view.viewer_scene import ViewScene


_DASHES = 9
_REACH = 0.15
"""Of the model's size: how far the line of a pin is drawn to either side."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DrawnChain:
    """Two links that share a pin, which no joint of the tree joins."""

    links: tuple[str, str]
    points: tuple[FloatArray, FloatArray]
    """The pin in the frame of either link [m], each of shape (3,)."""
    axis: FloatArray
    """Of the pin, unit, frame of the first link, shape (3,); zero where it is a point."""
    description: str
    """Which joint was cut, and why."""

    def dashes(self, poses: Mapping[str, FloatArray], size: float) -> FloatArray:
        """Return line segments along the pin and between its two ends, frame of the root link [m], shape (n, 2, 3).

        Args:
            poses: Of the links, frame of the root link, shape (4, 4) each.
            size: Of the model [m].
        """
        first, second = (
            (poses[link] @ np.append(point, 1.0))[:3] for link, point in zip(self.links, self.points, strict=True)
        )
        reach = _REACH * size * (poses[self.links[0]][:3, :3] @ self.axis)
        return np.concatenate([_dashed(first - reach, first + reach), _dashed(first, second)])


@dataclass(frozen=True, kw_only=True)
class FindingMarker:
    """A finding as the viewer shows it."""

    title: str
    message: str
    q: Mapping[str, float] = field(default_factory=dict)
    links: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class ViewModel:
    """A model to look at."""

    scene: ViewScene
    alternatives: Mapping[tuple[str, str], tuple[JointAlternative, ...]] = field(default_factory=dict)
    """Candidates of joints by (parent, child) link."""
    confidences: Mapping[str, float] = field(default_factory=dict)
    """Of the joint above each link."""
    doubtful: tuple[str, ...] = ()
    """Links whose joints are to be looked at, the least sure first."""
    doubtful_below: float = 0.0
    """Confidence below which they are."""
    chains: tuple[DrawnChain, ...] = ()
    """Where chains of joints close."""
    parents: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """What each part but the base could hang on: the parts that it touches first, then all others."""
    twins: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Congruent parts with a joint, of each part that has such."""


def _dashed(start: FloatArray, end: FloatArray) -> FloatArray:
    """Dashes as long as the gaps between them, shape (n, 2, 3)."""
    shares = np.linspace(0.0, 1.0, 2 * _DASHES)[:, None]
    points: FloatArray = (start + shares * (end - start)).reshape(_DASHES, 2, 3)
    return points


def shown_with(scene: ViewScene, path: Path) -> ViewModel:
    """Return a model with what its record tells.

    Args:
        scene: The model.
        path: `inference.json` of its folder.

    Raises:
        InputError: It cannot be read.
    """
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        return ViewModel(
            scene=scene,
            alternatives=_alternatives_of(record),
            confidences={item["child"]: float(item["confidence"]) for item in record["joints"] if "confidence" in item},
            doubtful=tuple(map(str, record.get("doubtful", ()))),
            doubtful_below=float(record.get("doubtful_below", 0.0)),
            chains=(
                *declared_chains(scene.robot),
                *(_chain(item, scene.robot) for item in record.get("closed_chains", ()) if not item.get("loop")),
            ),
            parents=_possible_parents(record),
            twins=_twins(record),
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(
            f"{path} is no record of an inference ({type(error).__name__}: {error}). Run `kinematify infer` again, or "
            "view the model from another folder."
        ) from error


def _possible_parents(record: dict[str, Any]) -> dict[str, tuple[str, ...]]:
    names = [item["name"] for item in record.get("parts", ())]
    touching = {frozenset((item["a"], item["b"])) for item in record.get("contacts", ())}
    return {
        child: tuple(sorted((name for name in names if name != child), key=lambda name: {child, name} not in touching))
        for child in (joint["child"] for joint in record["joints"])
    }


def _twins(record: dict[str, Any]) -> dict[str, tuple[str, ...]]:
    moved = {joint["child"] for joint in record["joints"]}
    groups = [[name for name in cluster if name in moved] for cluster in record.get("clusters", ())]
    return {name: tuple(twin for twin in group if twin != name) for group in groups for name in group}


def _alternatives_of(record: dict[str, Any]) -> dict[tuple[str, str], tuple[JointAlternative, ...]]:
    return {(joint["parent"], joint["child"]): tuple(_alternatives(joint)) for joint in record["joints"]}


def _alternatives(joint: dict[str, Any]) -> list[JointAlternative]:
    found = [
        JointAlternative(
            kind=JointType(candidate["type"]),
            axis=np.asarray(candidate["axis"], dtype=np.float64),
            pivot=np.asarray(candidate["pivot"], dtype=np.float64),
            probability=candidate.get("evidence", {}).get("probability"),
            score=float(candidate["score"]),
        )
        for candidate in joint["candidates"]
    ]
    fixed = JointAlternative(
        kind=JointType.FIXED,
        axis=np.array([0.0, 0.0, 1.0]),
        pivot=np.zeros(3),
        probability=joint.get("evidence", {}).get("probability_fixed"),
    )
    return [*found, fixed]


def _chain(item: dict[str, Any], robot: Robot) -> DrawnChain:
    """A closed chain whose pin is given in the world frame at zero."""
    first, second = item["parts"]
    zero = forward_kinematics(robot, {})
    T_first_world, T_second_world = np.linalg.inv(zero[first]), np.linalg.inv(zero[second])
    pin = np.append(np.asarray(item["pivot"], dtype=np.float64), 1.0)
    return DrawnChain(
        links=(first, second),
        points=((T_first_world @ pin)[:3], (T_second_world @ pin)[:3]),
        axis=np.asarray(T_first_world[:3, :3] @ item["axis"], dtype=np.float64),
        description=str(item["description"]),
    )


def declared_chains(robot: Robot) -> tuple[DrawnChain, ...]:
    """Return the chains that a URDF closes itself, by a loop joint."""
    return tuple(
        DrawnChain(
            links=loop.links,
            points=loop.points,
            axis=_pin_axis(robot, loop),
            description=f"{loop.links[0]} and {loop.links[1]} share a point; the loop joint {loop.name} closes the "
            "chain.",
        )
        for loop in robot.loops
    )


def _pin_axis(robot: Robot, loop: LoopJoint) -> FloatArray:
    """Along which the pin of a loop is drawn, frame of its first link: parallel to a joint that carries the loop."""
    T = forward_kinematics(robot, {})
    for link in loop.links:
        joint = robot.joint_above.get(link)
        if joint is not None and joint.kind.turns:
            axis: FloatArray = T[loop.links[0]][:3, :3].T @ T[link][:3, :3] @ joint.axis
            return axis
    return np.zeros(3)
