"""The model that is written: one that engines simulate as they read it."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.config.validation import load_settings
from kinematify.model.collision import fit_collision
from kinematify.model.dynamics import with_dynamics
from kinematify.model.urdf import model_robot
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.config import Config
    from kinematify.config.validation import PrepareSettings
    from kinematify.geometry.sweep import JointSweep
    from kinematify.model.collision import FittedCollision
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.robot.robot import Inertial, Joint, Robot


_DIGITS = 9


@dataclass(frozen=True, kw_only=True, eq=False)
class SimulableModel:
    """A robot to write, and what was done to it."""

    robot: Robot
    collision: FittedCollision | None
    """None where the visual meshes collide."""

    def record(self) -> dict[str, Any]:
        """The collision geometry as JSON values: what was fitted to every link, with both errors [m]."""
        if self.collision is None:
            return {"mode": "mesh"}
        return {
            "mode": "auto",
            "clearance": self.collision.clearance,
            "links": [asdict(link) for link in self.collision.links],
            "jams": [list(jam) for jam in self.collision.jams],
            "blocked": [asdict(item) for item in self.collision.blocked],
        }


def rounded(robot: Robot) -> Robot:
    """Return a robot without digits that are only noise: lengths and angles to 1e-9, mass properties to nine digits."""
    return replace(
        robot,
        links=tuple(replace(link, inertial=_rounded_inertial(link.inertial)) for link in robot.links),
        joints=tuple(
            replace(
                joint,
                T_parent_child=np.round(joint.T_parent_child, _DIGITS),
                lower=round(joint.lower, _DIGITS),
                upper=round(joint.upper, _DIGITS),
            )
            for joint in robot.joints
        ),
    )


def _rounded_inertial(inertial: Inertial | None) -> Inertial | None:
    if inertial is None:
        return None
    decimals = _DIGITS - math.ceil(math.log10(max(float(np.trace(inertial.tensor)), 1e-300)))
    return replace(
        inertial,
        mass=float(f"{inertial.mass:.{_DIGITS}g}"),
        center_of_mass=np.round(inertial.center_of_mass, _DIGITS),
        tensor=np.round(inertial.tensor, decimals),
    )


def simulable_model(
    model: KinematicModel,
    config: Config,
    *,
    powered: bool = False,
    swept: Mapping[str, JointSweep] | None = None,
) -> SimulableModel:
    """Return the model with friction, damping, liftable parts and collision geometry that leaves the motion free.

    Args:
        model: The model.
        config: Of all stages.
        powered: As of `with_dynamics`.
        swept: As of `fit_collision`.
    """
    robot = with_dynamics(rounded(model_robot(model)), powered=powered)
    if config.collision.mode == "mesh":
        return SimulableModel(robot=robot, collision=None)
    settings = load_settings()
    fitted = fit_collision(robot, config.collision, settings.prepare, settings.geometry, swept=swept)
    return SimulableModel(robot=fitted.robot, collision=fitted)


def lacks_drive(joint: Joint) -> bool:
    """True if a joint that moves has no effort or no velocity above zero."""
    return joint.kind is not JointType.FIXED and (_positive(joint.effort) is None or _positive(joint.velocity) is None)


def prepared_joint(joint: Joint, settings: PrepareSettings) -> Joint:
    """Return the joint with what readers demand; negative damping and friction, which they refuse, are omitted."""
    return replace(
        joint,
        effort=_positive(joint.effort) or settings.effort,
        velocity=_positive(joint.velocity) or settings.velocity,
        damping=unless_negative(joint.damping),
        friction=unless_negative(joint.friction),
    )


def _positive(value: float | None) -> float | None:
    return value if value is not None and value > 0.0 else None


def unless_negative(value: float | None) -> float | None:
    """Return a value that engines accept of damping and friction; None in place of one below zero."""
    return value if value is not None and value >= 0.0 else None
