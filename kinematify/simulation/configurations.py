"""The configurations in which the kinematics of all engines are compared with that of the file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import read_only
from kinematify.robot.robot import joint_ends, joint_values, rest_configuration

if TYPE_CHECKING:
    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot

GRAVITY = 9.81
"""Along -z of the root link's frame [m/s^2]; every engine is set to it."""
PIN_SOLREF, PIN_SOLIMP = (0.004, 1.0), (0.99, 0.999, 1.0e-4)
"""Of pins that close a loop in MuJoCo: its defaults let a driven four-bar open by 0.4 % of its size, these by 0.004 %
at the default step."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Configurations:
    """Rows of joint values; followers have the value that their mimic rule gives them."""

    links: tuple[str, ...]
    """All links, in the order of the document."""
    joints: tuple[str, ...]
    """Every joint that is not fixed, followers included, in the order of the document."""
    q: FloatArray
    """Joint values [rad or m], shape (n, j): zero, rest, a Latin hypercube, then the ends of every joint. Read-only."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "q", read_only(self.q, np.float64))

    def named(self, row: int) -> dict[str, float]:
        """Return one row as joint -> value, as a finding wants it."""
        return dict(zip(self.joints, self.q[row].tolist(), strict=True))


def pose_configurations(robot: Robot, settings: EngineSettings, seed: int) -> Configurations:
    """Return the same rows in every process: zero, rest, quasi-random ones, and both ends of every joint.

    Args:
        robot: The tree; shapes play no part.
        settings: How many rows.
        seed: Of the run (`ValidationSettings.seed`).
    """
    leaders = robot.leaders
    rest = rest_configuration(robot)
    middle = np.array([rest[joint.name] for joint in leaders])
    lower, upper = joint_ends(leaders)
    values = np.vstack(
        [
            np.zeros((1, len(leaders))),
            middle[None],
            spread_rows(lower, upper, settings.pose_rows, seed),
            _at_ends(middle, lower, upper, settings.pose_end_rows),
        ]
    )
    joints = tuple(joint.name for joint in robot.joints if joint.kind != "fixed")
    return Configurations(
        links=tuple(link.name for link in robot.links),
        joints=joints,
        q=_with_followers(robot, [joint.name for joint in leaders], joints, values),
    )


def spread_rows(lower: FloatArray, upper: FloatArray, rows: int, seed: int) -> FloatArray:
    """Latin hypercube in the box of the limits, shape (rows, m): every joint's range is covered evenly.

    NumPy alone makes it; SciPy's Sobol points would cost every engine's process half a second for the import.
    """
    generator = np.random.default_rng(seed)
    strata = np.array([generator.permutation(rows) for _ in lower]).reshape(len(lower), rows).T
    points: FloatArray = (strata + generator.random(strata.shape)) / rows
    return lower + points * (upper - lower)


def _at_ends(middle: FloatArray, lower: FloatArray, upper: FloatArray, rows: int) -> FloatArray:
    """Each joint at each end, the others at rest; several joints share a row where there are too many for `rows`."""
    count = min(len(middle), max(1, rows // 2))
    values = np.tile(middle, (2 * count, 1))
    for joint in range(len(middle)):
        values[2 * (joint % count), joint] = lower[joint]
        values[2 * (joint % count) + 1, joint] = upper[joint]
    return values


def _with_followers(robot: Robot, leaders: list[str], joints: tuple[str, ...], values: FloatArray) -> FloatArray:
    rows = [joint_values(robot, dict(zip(leaders, row.tolist(), strict=True))) for row in values]
    return np.array([[row[name] for name in joints] for row in rows]).reshape(len(values), len(joints))


def link_poses(robot: Robot, rows: Configurations) -> FloatArray:
    """Return the pose of every link in every row, the root at the origin, shape (n, L, 4, 4)."""
    index = {name: k for k, name in enumerate(rows.links)}
    column = {name: k for k, name in enumerate(rows.joints)}
    poses = np.tile(np.eye(4), (len(rows.q), len(rows.links), 1, 1))
    for joint in robot.joints_downward:
        values = rows.q[:, column[joint.name]] if joint.name in column else np.zeros(len(rows.q))
        poses[:, index[joint.child]] = poses[:, index[joint.parent]] @ joint.T_parent_child @ joint.motions(values)
    return poses
