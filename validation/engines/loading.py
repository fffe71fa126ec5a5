"""Has an engine loaded what the file says: the same joints with the same types and limits, the same masses?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from kinematify.robot.declared import DeclaredModel
    from kinematify.robot.robot import DescribedJoint
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.stage import OpenCheck

ENGINE_TITLES = {"mujoco": "MuJoCo", "pybullet": "PyBullet", "pinocchio": "Pinocchio"}
"""As they are written in messages."""
_LIMIT_SLACK = 1e-6
"""Difference of a limit [rad or m] that no decimal number in a file explains."""


@dataclass(frozen=True, kw_only=True)
class LoadedJoint:
    """A joint as an engine has it."""

    turns: bool
    lower: float
    """[rad or m]; -inf if unlimited."""
    upper: float
    """[rad or m]; +inf if unlimited."""


@dataclass(frozen=True, kw_only=True)
class LoadedModel:
    """What an engine made of `prepared.urdf`."""

    joints: Mapping[str, LoadedJoint]
    """Joints that move, keyed by name."""
    masses: Mapping[str, float]
    """[kg], keyed by link; links that the engine merged into others are missing."""
    total_mass: float
    """[kg]."""


def compare_with_file(
    check: OpenCheck, model: DeclaredModel, prepared: Prepared, loaded: LoadedModel, mass_error: float
) -> None:
    """Add a finding for every joint or mass that an engine has otherwise than it was given.

    Args:
        check: Open, of the engine.
        model: The file, with or without geometry.
        prepared: What the engine was given.
        loaded: What it made of it.
        mass_error: Relative difference that is an error.
    """
    engine = ENGINE_TITLES[check.engine or ""]
    for described in model.kinematics.joints:
        if described.kind != "fixed":
            _compare_joint(check, engine, described, loaded.joints.get(described.name))
    for link in prepared.links:
        mass = loaded.masses.get(link.link, link.mass)
        if not link.mass_added and not np.isclose(mass, link.mass, rtol=mass_error, atol=1e-9):
            check.find(
                f"{engine} gives the link {link.link} {mass:.6g} kg; the file says {link.mass:.6g} kg.",
                "Write mass and inertia in an <inertial> element with plain decimal numbers.",
                link=link.link,
                value=mass,
                limit=link.mass,
                unit="kg",
                line=model.link_by_name[link.link].line,
            )
    check.measured["joints"] = float(len(loaded.joints))
    check.measured["mass"] = loaded.total_mass
    if not check.findings and not np.isclose(loaded.total_mass, prepared.total_mass, rtol=mass_error):
        check.find(
            f"The model weighs {loaded.total_mass:.6g} kg in {engine}; its links weigh {prepared.total_mass:.6g} kg in "
            "the file.",
            "Give every link a mass of its own; an engine has dropped or made up one.",
            value=loaded.total_mass,
            limit=prepared.total_mass,
            unit="kg",
        )


def _compare_joint(check: OpenCheck, engine: str, joint: DescribedJoint, loaded: LoadedJoint | None) -> None:
    said = _difference(engine, joint, loaded)
    if said:
        check.find(
            said,
            f"Write the joint {joint.name} with a type, axis and limits that {engine} reads as they are meant.",
            # Importers take an empty range for none; that the range is empty is told where limits are checked.
            severity=Severity.WARNING if joint.lower >= joint.upper else None,
            joint=joint.name,
        )


def _difference(engine: str, joint: DescribedJoint, loaded: LoadedJoint | None) -> str:
    if loaded is None:
        return (
            f"The joint {joint.name} ({joint.kind}) does not move in {engine}, which has lost it or taken it for fixed."
        )
    if loaded.turns != joint.kind.turns:
        now = "turns" if loaded.turns else "slides"
        return f"The joint {joint.name} is {joint.kind} in the file and {now} in {engine}."
    ends = list(_ends(joint, loaded))
    if any(not _same(declared, found) for declared, found in ends):
        unit = "rad" if joint.kind.turns else "m"
        declared, found = ([f"{end[side]:.6g}" for end in ends] for side in (0, 1))
        return (
            f"The joint {joint.name} has the limits {' to '.join(declared)} {unit} in the file and "
            f"{' to '.join(found)} {unit} in {engine}."
        )
    return ""


def _ends(joint: DescribedJoint, loaded: LoadedJoint) -> Iterator[tuple[float, float]]:
    yield joint.lower, loaded.lower
    yield joint.upper, loaded.upper


def _same(declared: float, found: float) -> bool:
    return declared == found or abs(declared - found) <= _LIMIT_SLACK * max(1.0, abs(declared))
