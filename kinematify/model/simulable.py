"""The model that is written: one that engines simulate as they read it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from kinematify.config.validation import load_settings
from kinematify.model.collision import fit_collision
from kinematify.model.dynamics import with_dynamics
from kinematify.model.urdf import model_robot

if TYPE_CHECKING:
    from kinematify.config import Config
    from kinematify.model.collision import FittedCollision
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.robot.robot import Robot


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


def simulable_model(model: KinematicModel, config: Config) -> SimulableModel:
    """Return the model with friction, damping, liftable parts and collision geometry that leaves the motion free."""
    robot = with_dynamics(model_robot(model), config.dynamics)
    if config.collision.mode == "mesh":
        return SimulableModel(robot=robot, collision=None)
    settings = load_settings()
    fitted = fit_collision(robot, config.collision, settings.prepare, settings.geometry)
    return SimulableModel(robot=fitted.robot, collision=fitted)
