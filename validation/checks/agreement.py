"""KV601 to KV605 but the contacts: what the engines left, compared with each other and the analytical model."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.engines import ENGINES
from kinematify.validation.check import CauseScope, check
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint
    from kinematify.simulation.configurations import EnginePoses
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.engine_results import EngineResults

REFERENCE = "pinocchio"
"""Masses and torques are held against it: it computes them in closed form."""
_TINY = 1e-12


@check(
    "KV601",
    title="Links stand where they should, in every engine",
    fails="Links stand elsewhere in an engine",
    severity=Severity.ERROR,
    cause=Cause.ENGINE,
)
def poses_differ(result: OpenCheck, left: EngineResults) -> None:
    """Forward kinematics of MuJoCo, PyBullet, Pinocchio and Kinematify in the same configurations: zero, rest, both
    ends of every joint and quasi-random ones. A joint whose child is elsewhere relative to its parent by more
    than agreement.position (times the size of the model) or agreement.angle is an error, so is a link that an
    engine has lost.

    Why it matters: A policy that was trained in one engine fails in another where a link is elsewhere.

    Remedy: Write the joint with a unit axis, plain decimal numbers and a type that every engine knows.
    """
    if not left.chosen:
        result.skip("no engine was asked for")
        return
    for engine, poses in left.engines.items():
        for link in _lost(poses, left.rows.links):
            result.find(
                f"{ENGINES[engine].title} has lost the link {link}: it has no pose.",
                "Give the link a mass and a name that is not used twice.",
                link=link,
                engine=engine,
            )
    joints = left.model.joints
    own = _relative(left, left.own)
    theirs = {engine: _relative(left, poses.T_world_link) for engine, poses in left.engines.items()}
    errors = {engine: _pose_errors(own, relative) for engine, relative in theirs.items()}
    limits = np.array([left.settings.position * left.size, left.settings.angle])
    for engine, error in errors.items():
        largest = np.nanmax(error, axis=(0, 1), initial=0.0)
        result.measured[f"{engine}_position_m"], result.measured[f"{engine}_angle_rad"] = largest.tolist()
    for index, joint in enumerate(joints):
        off = [engine for engine, error in errors.items() if (error[:, index] > limits).any()]
        if len(off) >= 2 and len(off) == len(errors) and _agree([theirs[e][:, index] for e in off], limits):
            _tell_pose(result, left, joint, errors[off[0]][:, index], limits, engine=None)
        else:
            for engine in off:
                _tell_pose(result, left, joint, errors[engine][:, index], limits, engine=engine)
    left.say_absent(result, left.chosen, left.engines)


def _lost(poses: EnginePoses, links: tuple[str, ...]) -> list[str]:
    lost = ~np.isfinite(poses.T_world_link).all(axis=(0, 2, 3))
    return [links[index] for index in np.flatnonzero(lost)]


def _relative(left: EngineResults, T_world_link: FloatArray) -> FloatArray:
    """Pose of each joint's child in its parent, shape (n, joints, 4, 4): an error is seen where it begins."""
    place = {link: index for index, link in enumerate(left.rows.links)}
    joints = left.model.joints
    parent = T_world_link[:, [place[joint.parent] for joint in joints]]
    child = T_world_link[:, [place[joint.child] for joint in joints]]
    turned_back = np.swapaxes(parent[..., :3, :3], -1, -2)
    relative = np.zeros_like(child)
    relative[..., :3, :3] = turned_back @ child[..., :3, :3]
    relative[..., :3, 3] = np.einsum("...ij,...j->...i", turned_back, child[..., :3, 3] - parent[..., :3, 3])
    return relative


def _pose_errors(first: FloatArray, second: FloatArray) -> FloatArray:
    """Distance [m] and angle [rad] between poses, shape (..., 2); NaN where one is lost."""
    distance = np.linalg.norm(first[..., :3, 3] - second[..., :3, 3], axis=-1)
    # The norm of the difference of two rotations is exact for small angles, unlike the arc cosine of a trace.
    chord = np.linalg.norm(first[..., :3, :3] - second[..., :3, :3], axis=(-2, -1)) / np.sqrt(8.0)
    return np.stack([distance, 2.0 * np.arcsin(np.minimum(chord, 1.0))], axis=-1)


def _agree(poses: list[FloatArray], limits: FloatArray) -> bool:
    return all(not (_pose_errors(first, second) > limits).any() for first, second in combinations(poses, 2))


def _tell_pose(
    result: OpenCheck,
    left: EngineResults,
    joint: Joint,
    error: FloatArray,
    limits: FloatArray,
    *,
    engine: str | None,
) -> None:
    """Add a finding for the row in which a joint is off most; engine None: all engines agree against Kinematify."""
    excess = np.nan_to_num(error / limits)
    row, what = (int(index) for index in np.unravel_index(int(np.argmax(excess)), excess.shape))
    value, unit = float(error[row, what]), ("m", "rad")[what]
    who = "All engines have" if engine is None else f"{ENGINES[engine].title} has"
    result.find(
        f"{who} the link {joint.child} {value:.3g} {unit} away from where the {joint.kind} joint {joint.name} of the "
        f"file puts it relative to {joint.parent}.",
        f"Write the joint {joint.name} with a unit axis, plain decimal numbers and a type that every engine knows.",
        joint=joint.name,
        link=joint.child,
        engine=engine,
        q=left.rows.named(row),
        value=value,
        limit=float(limits[what]),
        unit=unit,
        line=left.model.joint_by_name[joint.name].line,
    )


@check(
    "KV602",
    title="Mass matrix: MuJoCo and Pinocchio agree",
    fails="Mass matrix: MuJoCo and Pinocchio differ",
    severity=Severity.WARNING,
    cause=Cause.ENGINE,
)
def mass_matrices_differ(result: OpenCheck, left: EngineResults) -> None:
    """The joint-space inertia of the tree in the same configurations, entry by entry, relative to the inertias of the
    two joints that it couples; more than agreement.mass_matrix is a warning at the joint where it begins.

    Why it matters: An engine that has changed an inertia moves the joint with another acceleration.

    Remedy: Write inertias that a rigid body can have: positive, and no moment above the sum of the others.
    """
    reference = left.engines.get(REFERENCE)
    if not _has_reference(result, left) or reference is None or reference.mass_matrix is None:
        return
    diagonal = np.abs(np.einsum("kii->ki", reference.mass_matrix))
    diagonal = np.maximum(diagonal, _TINY * np.nanmax(diagonal, initial=1.0))
    scale = np.sqrt(diagonal[:, :, None] * diagonal[:, None, :])
    for engine, poses in left.engines.items():
        if engine == REFERENCE or poses.mass_matrix is None:
            continue
        error = np.abs(poses.mass_matrix - reference.mass_matrix) / scale
        result.measured[f"{engine}_relative"] = float(np.nanmax(error, initial=0.0))
        _tell_dynamics(
            result,
            left,
            engine,
            error=np.nan_to_num(error).max(axis=2),
            limit=left.settings.mass_matrix,
            what="the inertia that the joint {joint} moves",
        )
    left.say_absent(result, ("mujoco", REFERENCE), left.engines)


@check(
    "KV603",
    title="Gravity torques: MuJoCo and Pinocchio agree",
    fails="Gravity torques: MuJoCo and Pinocchio differ",
    severity=Severity.WARNING,
    cause=Cause.ENGINE,
)
def gravity_differs(result: OpenCheck, left: EngineResults) -> None:
    """The torques and forces that hold the model still, relative to the largest that the joint sees; more than
    agreement.gravity is a warning at the joint farthest from the root that shows it.

    Why it matters: Motors that were chosen with one engine's torques do not hold the model in the other.

    Remedy: Check mass and centre of mass of the links that hang on the joint.
    """
    reference = left.engines.get(REFERENCE)
    if not _has_reference(result, left) or reference is None or reference.gravity is None:
        return
    # A joint that gravity hardly loads is held against the weight of the model.
    turns = np.array([left.model.joint_by_name[name].kind.turns for name in left.rows.joints], dtype=bool)
    weight = 1e-6 * GRAVITY * (reference.total_mass or 0.0) * np.where(turns, left.size, 1.0)
    scale = np.maximum(np.nan_to_num(np.abs(reference.gravity)).max(axis=0, initial=0.0), weight) + _TINY
    for engine, poses in left.engines.items():
        if engine == REFERENCE or poses.gravity is None:
            continue
        error = np.abs(poses.gravity - reference.gravity) / scale
        result.measured[f"{engine}_relative"] = float(np.nanmax(error, initial=0.0))
        _tell_dynamics(
            result,
            left,
            engine,
            error=np.nan_to_num(error),
            limit=left.settings.gravity,
            what="the torque or force that holds the joint {joint} against gravity",
        )
    left.say_absent(result, ("mujoco", REFERENCE), left.engines)


def _has_reference(result: OpenCheck, left: EngineResults) -> bool:
    """False, with the reason said, where there is nothing to compare."""
    if REFERENCE not in left.chosen or not set(left.chosen) - {REFERENCE}:
        result.skip("it needs Pinocchio and another engine, which were not both asked for")
    elif not left.rows.joints:
        result.skip("the model has no joint that moves")
    elif REFERENCE not in left.engines:
        left.say_absent(result, (REFERENCE,), left.engines)
    else:
        return True
    return False


def _tell_dynamics(
    result: OpenCheck, left: EngineResults, engine: str, *, error: FloatArray, limit: float, what: str
) -> None:
    """Add a finding for every joint that differs and carries no other that does: what lies above only inherits it.

    Args:
        result: Open.
        left: What is compared.
        engine: That differs from the reference.
        error: Relative, shape (k, j).
        limit: What it may be.
        what: Differs, with a place for the name of the joint.
    """
    off = [name for name, worst in zip(left.rows.joints, error.max(axis=0), strict=True) if worst > limit]
    inherited = set().union(*(left.ancestors[name] for name in off))
    for name in off:
        if name in inherited:
            continue
        column = error[:, left.rows.joints.index(name)]
        row = int(np.argmax(column))
        child = left.model.joint_by_name[name].child
        result.find(
            f"{ENGINES[engine].title} and {ENGINES[REFERENCE].title} differ in {what.format(joint=name)} by "
            f"{column[row]:.2%} of it.",
            f"Check mass, centre of mass and inertia of {child} and of what is fixed to it: a body can have no moment "
            "above the sum of the two others, and engines repair such values differently.",
            joint=name,
            link=child,
            engine=engine,
            q=left.rows.named(row),
            value=float(column[row]),
            limit=limit,
            line=left.model.joint_by_name[name].line,
        )


@check(
    "KV605",
    title="The model weighs the same everywhere",
    fails="The model weighs something else in an engine",
    severity=Severity.ERROR,
    cause=Cause.ENGINE,
    follows={"KV201": CauseScope.MODEL, "KV202": CauseScope.MODEL},
)
def masses_differ(result: OpenCheck, left: EngineResults) -> None:
    """The mass of each link and of the whole model in every engine against the file; a relative difference above
    agreement.mass_error is an error. Links without a mass in the file are omitted.

    Why it matters: A mass that an engine drops or makes up changes every motion, and no message reports it.

    Remedy: Give every link an <inertial> element with a mass above zero.
    """
    if not left.chosen:
        result.skip("no engine was asked for")
        return
    if not left.engines:  # the stage `prepare` may have left nothing then
        left.say_absent(result, left.chosen, ())
        return
    for engine, poses in left.engines.items():
        known = {} if poses.masses is None else dict(zip(poses.links, poses.masses.tolist(), strict=True))
        for link in left.prepared.links:
            mass = known.get(link.link, np.nan)
            if np.isfinite(mass) and not link.mass_added:
                _compare_mass(result, left, engine, mass, link.mass, link=link.link)
        if poses.total_mass is not None:
            result.measured[f"{engine}_kg"] = poses.total_mass
            _compare_mass(result, left, engine, poses.total_mass, left.prepared.total_mass)
    left.say_absent(result, left.chosen, left.engines)


def _compare_mass(
    result: OpenCheck, left: EngineResults, engine: str, found: float, expected: float, *, link: str | None = None
) -> None:
    if np.isclose(found, expected, rtol=left.settings.mass_error, atol=1e-9):
        return
    result.find(
        f"{'The model' if link is None else f'The link {link}'} weighs {found:.6g} kg in {ENGINES[engine].title} and "
        f"{expected:.6g} kg in the file.",
        "Give every link an <inertial> element with a mass above zero, written as a plain decimal number.",
        link=link,
        engine=engine,
        value=found,
        limit=expected,
        unit="kg",
        line=None if link is None else left.model.link_by_name[link].line,
    )
