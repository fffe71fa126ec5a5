"""The configurations in which all engines are compared, and the file in which each leaves what it computed there.

Every engine stage calls `agreement_configurations` (same answer everywhere), fills an `EnginePoses` and leaves it with
`write_poses`; `validation/agreement.py` compares them. An engine's own names, orders and merged links stay inside its
stage: what is written is in the order of the document.
"""

from __future__ import annotations

import zipfile
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import read_only
from kinematify.robot.robot import joint_ends, joint_values, rest_configuration

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config.validation import AgreementSettings
    from kinematify.robot.arrays import FloatArray, IntArray
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
    dynamic: int
    """Mass matrices and gravity torques are computed for the first so many rows only."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "q", read_only(self.q, np.float64))

    def named(self, row: int) -> dict[str, float]:
        """Return one row as joint -> value, as a finding wants it."""
        return dict(zip(self.joints, self.q[row].tolist(), strict=True))


@dataclass(frozen=True, kw_only=True, eq=False)
class EnginePoses:
    """Poses of one engine at the rows of `Configurations`; the contract of `poses-ENGINE.npz`.

    The base is fixed: the root link's frame is the world, gravity is `GRAVITY` along its -z. The matrices are those of
    the tree without mimic constraints: followers are degrees of freedom of their own. What an engine cannot tell is
    None.
    """

    links: tuple[str, ...]
    """As in `Configurations`."""
    joints: tuple[str, ...]
    """As in `Configurations`."""
    q: FloatArray
    """As in `Configurations`, shape (n, j)."""
    T_world_link: FloatArray
    """Pose of every link's frame (not of its centre of mass), shape (n, L, 4, 4); NaN for links the engine lost."""
    masses: FloatArray | None = None
    """Mass of every link as the engine has it [kg], shape (L,); NaN for links it lost or merged into others."""
    total_mass: float | None = None
    """Of everything it loaded [kg]."""
    mass_matrix: FloatArray | None = None
    """Joint-space inertia over `joints`, shape (k, j, j), k = `Configurations.dynamic`; NaN for joints it lost."""
    gravity: FloatArray | None = None
    """Torques and forces at the joints that hold the model still [N m or N], shape (k, j); NaN for joints it lost.
    A positive value pushes the joint upwards in its own coordinate (MuJoCo: `qfrc_bias` at zero velocity; Pinocchio:
    `computeGeneralizedGravity`)."""
    contacts: IntArray | None = None
    """Row, link, link (smaller index first) of every pair of links that touches or overlaps, shape (c, 3), each once;
    links are indices into `links`. Links that fixed joints join, and links without collision shapes, are omitted."""
    contact_depth: FloatArray | None = None
    """Deepest point of each of `contacts` [m], positive where they overlap, shape (c,)."""


def agreement_configurations(robot: Robot, settings: AgreementSettings, seed: int) -> Configurations:
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
            spread_rows(lower, upper, settings.random_rows, seed),
            _at_ends(middle, lower, upper, settings.end_rows),
        ]
    )
    joints = tuple(joint.name for joint in robot.joints if joint.kind != "fixed")
    return Configurations(
        links=tuple(link.name for link in robot.links),
        joints=joints,
        q=_with_followers(robot, [joint.name for joint in leaders], joints, values),
        dynamic=min(len(values), settings.dynamic_rows, max(2, settings.dynamic_numbers // max(1, len(joints) ** 2))),
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


def write_poses(work: Path, engine: str, poses: EnginePoses) -> None:
    """Leave what an engine computed for the agreement checks."""
    arrays = {name: np.asarray(value) for name, value in vars(poses).items() if value is not None}
    with (work / f"poses-{engine}.npz").open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)


def read_poses(work: Path, engine: str) -> EnginePoses | None:
    """Return what an engine left, or None where it left nothing or was cut off while writing."""
    try:
        # NumPy leaves a file open that it cannot read, unless it was opened here.
        with (work / f"poses-{engine}.npz").open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile):
        return None
    return EnginePoses(
        links=tuple(arrays.pop("links").tolist()),
        joints=tuple(arrays.pop("joints").tolist()),
        total_mass=float(arrays.pop("total_mass")) if "total_mass" in arrays else None,
        **arrays,
    )
