"""Findings of a check with their evidence, the status of the check itself, and facts of joints (design section 4)."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from fnmatch import fnmatchcase
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.robot import Joint


class Severity(StrEnum):
    """Severity of a finding; an error makes the verdict ``fail``."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


class Cause(StrEnum):
    """Who can act on a finding."""

    KINEMATICS = "kinematics"
    """Axis, pivot, type, parent or limit of a joint: the inference can choose again."""
    PHYSICS = "physics"
    """Mass, inertia, collision geometry, effort: the exporter can add or correct them."""
    ASSET = "asset"
    """The file or a mesh is broken."""
    ENGINE = "engine"
    """Engines disagree with each other or with the analytical model."""
    TASK = "task"
    """A robot cannot use the object."""


class Status(StrEnum):
    """Status of a check; skipped and blocked never count as passed."""

    PASS = "pass"
    FAIL = "fail"
    """It has at least one error or warning."""
    SKIPPED = "skipped"
    """It does not apply, was not asked for, or was not finished; the reason is given."""
    BLOCKED = "blocked"
    """An earlier failure or a crash kept it from running; the reason is given."""


_NOT_FINISHED = "not finished: "


def not_finished(why: str) -> str:
    """Reason of a check that time ran out for; it says nothing against the model."""
    return f"{_NOT_FINISHED}{why}"


def is_unfinished(reason: str | None) -> bool:
    """True if a check has this reason because time ran out."""
    return (reason or "").startswith(_NOT_FINISHED)


@dataclass(frozen=True, kw_only=True)
class Observation:
    """One thing that a check saw, with where, how much and what to do; `run/conclusion.py` makes a finding of it."""

    check: str
    """Id, e.g. ``KV301``."""
    severity: Severity
    """By what this check saw alone."""
    cause: Cause
    joint: str | None = None
    link: str | None = None
    pair: tuple[str, str] | None = None
    """Two links, in the order of the document."""
    engine: str | None = None
    q: Mapping[str, float] | None = None
    """Configuration in which it was seen, joint -> value [rad or m]."""
    value: float | None = None
    """What was measured, in `unit`."""
    limit: float | None = None
    """What it was compared with, in `unit`."""
    unit: str | None = None
    message: str
    """One or two sentences: what was found and what was expected."""
    remedy: str
    """What to do, with target values where they are known."""
    line: int | None = None
    """Line of the URDF that it is about."""
    reproduction: str | None = None
    """Plain Python that shows it in the engine, without Kinematify."""

    def __post_init__(self) -> None:
        if self.q is not None:
            object.__setattr__(self, "q", MappingProxyType(dict(self.q)))

    # Findings come from other processes, and a read-only view cannot be sent.
    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "q": None if self.q is None else dict(self.q)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self.__post_init__()


@dataclass(frozen=True, kw_only=True)
class Finding(Observation):
    """One thing that is wrong, or worth knowing: what a check saw, as severe as it is beside all other results."""

    suppressed: str | None = None
    """Reason given by the user for not counting it; it is still reported."""
    follows_from: Finding | None = field(default=None, compare=False, repr=False)
    """Finding that it follows from and is reported under; it has no cause itself."""


Content = TypeVar("Content", bound=Observation)


@dataclass(frozen=True, kw_only=True)
class CheckResult(Generic[Content]):
    """The outcome of one check in one engine: with observations when the check ends, with findings in a report."""

    check: str
    engine: str | None
    """``mujoco``, ``pybullet``, ``pinocchio``, or None where no engine is involved."""
    status: Status
    reason: str | None = None
    """Why it was skipped, blocked or not finished."""
    seconds: float = 0.0
    findings: tuple[Content, ...] = ()
    measured: Mapping[str, float] = field(default_factory=dict)
    """Named figures worth reading even where nothing is wrong, e.g. the largest tracking error."""

    @property
    def unfinished(self) -> bool:
        """True if time ran out before it was complete; what it found by then stands."""
        return is_unfinished(self.reason)


@dataclass(frozen=True, kw_only=True)
class Suppression:
    """Findings of `check` at `where` do not count, because of `reason`."""

    check: str
    """Id or glob, e.g. ``KV3*``."""
    reason: str
    where: str = "*"
    """Glob that the joint, the link or one link of the pair must match; ``*`` is anywhere."""

    def covers(self, finding: Observation) -> bool:
        """True if the rule applies to the finding."""
        if not fnmatchcase(finding.check, self.check):
            return False
        names = [name for name in (finding.joint, finding.link, *(finding.pair or ())) if name is not None]
        return self.where == "*" or any(fnmatchcase(name, self.where) for name in names)


@dataclass(frozen=True, kw_only=True)
class JointSummary:
    """Facts of one joint at the end."""

    joint: str
    kind: str
    declared_limits: tuple[float, float] | None
    """[rad or m]; None where there are none."""
    free_travel: tuple[float, float] | None = None
    """Range around rest in which nothing collides [rad or m]; None if it was not measured."""
    best_alternative: Mapping[str, Any] | None = None
    """``kind``, ``axis``, ``pivot`` (world frame at zero), ``score`` of a joint that explains the geometry better."""


def summary_of(joint: Joint, **known: Any) -> JointSummary:
    """Return what a file declares of a joint, with what is known of it besides."""
    limited = joint.kind in (JointType.REVOLUTE, JointType.PRISMATIC)
    limits = (joint.lower, joint.upper) if limited else None
    return JointSummary(joint=joint.name, kind=joint.kind.value, declared_limits=limits, **known)
