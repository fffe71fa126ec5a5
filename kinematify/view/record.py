"""What `inference.json` of a model folder tells of its joints, as the page shows it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import InputError
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics
from kinematify.view.alternatives import Alternative
from kinematify.view.shown import ClosedChain, Shown

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.robot import Robot
    from kinematify.view.scene import ViewScene


def shown_with(scene: ViewScene, path: Path) -> Shown:
    """Return a model with what its record tells.

    Args:
        scene: The model.
        path: `inference.json` of its folder.

    Raises:
        InputError: It cannot be read.
    """
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        return Shown(
            scene=scene,
            alternatives=_alternatives_of(record),
            doubtful=tuple(map(str, record.get("doubtful", ()))),
            doubtful_below=float(record.get("doubtful_below", 0.0)),
            chains=tuple(_chain(item, scene.robot) for item in record.get("closed_chains", ())),
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise _no_record(path, error) from error


def load_alternatives(path: Path) -> dict[tuple[str, str], tuple[Alternative, ...]]:
    """Return the candidates of every joint, best first, keyed by (parent, child) part names; the last one is fixed.

    Args:
        path: `inference.json` of a model folder.

    Raises:
        InputError: It cannot be read.
    """
    try:
        return _alternatives_of(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise _no_record(path, error) from error


def _no_record(path: Path, error: Exception) -> InputError:
    return InputError(
        f"{path} is no record of an inference ({type(error).__name__}: {error}). Run `kinematify infer` again, or "
        "view the model from another folder."
    )


def _alternatives_of(record: dict[str, Any]) -> dict[tuple[str, str], tuple[Alternative, ...]]:
    return {(joint["parent"], joint["child"]): tuple(_alternatives(joint)) for joint in record["joints"]}


def _alternatives(joint: dict[str, Any]) -> list[Alternative]:
    found = [
        Alternative(
            kind=JointType(candidate["type"]),
            axis=np.asarray(candidate["axis"], dtype=np.float64),
            pivot=np.asarray(candidate["pivot"], dtype=np.float64),
            probability=candidate.get("evidence", {}).get("probability"),
            score=float(candidate["score"]),
        )
        for candidate in joint["candidates"]
    ]
    fixed = Alternative(
        kind=JointType.FIXED,
        axis=np.array([0.0, 0.0, 1.0]),
        pivot=np.zeros(3),
        probability=joint.get("evidence", {}).get("probability_fixed"),
    )
    return [*found, fixed]


def _chain(item: dict[str, Any], robot: Robot) -> ClosedChain:
    """A closed chain whose pin is given in the world frame at zero."""
    first, second = item["parts"]
    zero = forward_kinematics(robot, {})
    T_first_world, T_second_world = np.linalg.inv(zero[first]), np.linalg.inv(zero[second])
    pin = np.append(np.asarray(item["pivot"], dtype=np.float64), 1.0)
    return ClosedChain(
        links=(first, second),
        points=((T_first_world @ pin)[:3], (T_second_world @ pin)[:3]),
        axis=np.asarray(T_first_world[:3, :3] @ item["axis"], dtype=np.float64),
        told=str(item["told"]),
    )


def declared_chains(robot: Robot) -> tuple[ClosedChain, ...]:
    """Return the chains that a URDF closes itself, by a `loop_joint`."""
    return tuple(
        ClosedChain(
            links=loop.links,
            points=loop.points,
            axis=np.zeros(3),
            told=f"{loop.links[0]} and {loop.links[1]} share a point; the loop_joint {loop.name} closes the chain.",
        )
        for loop in robot.loops
    )
