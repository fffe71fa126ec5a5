"""Validation reports built in code, with checks of their own so that they do not hang on the real ones."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.validation.check import Check
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, CheckResult, Finding, JointSummary, Severity, Status
from kinematify.validation.run.report import ValidationReport

if TYPE_CHECKING:
    import pytest

EVIL = "<b>&\"'\x00\x1b[31m\udcff"
"""A name that a format must not pass on as it is."""


def add_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put KV396 (no engine) and KV896 (MuJoCo) among the checks for one test."""
    for name, engine in (("KV396", ""), ("KV896", "mujoco")):
        check = Check(
            id=name,
            title=f"Doors & drawers of {name}",
            fails=f"Doors & drawers of {name} jam",
            severity=Severity.ERROR,
            cause=Cause.KINEMATICS,
            runs_in=lambda entry, engine=engine: entry.name == engine,  # type: ignore[misc]
            verifies="Something with `some_threshold`.",
            matters="It jams.",
            remedy="Move it.",
            function=lambda result, context: None,
        )
        monkeypatch.setitem(CHECKS, name, check)


def finding(**changes: object) -> Finding:
    """An error at one joint, with some fields changed."""
    fields: dict[str, object] = {
        "check": "KV396",
        "severity": Severity.ERROR,
        "cause": Cause.KINEMATICS,
        "message": "The joint hinge_1 overlaps by 5 mm.",
        "remedy": "Turn the axis of hinge_1.",
        "joint": "hinge_1",
        "q": {"hinge_1": 0.5, "slide": 0.0},
        "value": 5.0,
        "limit": 1.0,
        "unit": "mm",
        "line": 7,
    }
    return Finding(**{**fields, **changes})  # type: ignore[arg-type]


def result(*findings: Finding, **changes: object) -> CheckResult:
    """A check with its findings; failed if it has any."""
    fields: dict[str, object] = {
        "check": "KV396",
        "engine": None,
        "status": Status.FAIL if findings else Status.PASS,
        "seconds": 0.25,
        "findings": findings,
        "measured": {"deepest": math.nan},
    }
    return CheckResult(**{**fields, **changes})  # type: ignore[arg-type]


def report(*checks: CheckResult, model: str = "models/door.urdf", interrupted: bool = False) -> ValidationReport:
    """A report with one joint."""
    joint = JointSummary(
        joint="hinge_1",
        kind="revolute",
        declared_limits=(0.0, math.pi),
        free_travel=(0.0, math.pi / 2),
        best_alternative={"kind": "prismatic", "axis": (0.0, 0.0, 1.0), "pivot": None, "score": 0.75},
    )
    facts = {"kinematify": "1.2.3", "seconds": 2.5, "seed": 0, "interrupted": interrupted, "settings": {"x": math.inf}}
    return ValidationReport(model=model, checks=checks, joints=(joint,), environment=facts)


def full_report(**changes: object) -> ValidationReport:
    """One of everything: error, warning, suppressed error, note on a pair, skipped, blocked, blocked by a crash."""
    warning = finding(severity=Severity.WARNING, cause=Cause.PHYSICS, joint=None, link="door", q=None, value=math.inf)
    accepted = finding(joint="hinge_2", suppressed="the seal is soft")
    pair = finding(severity=Severity.NOTE, pair=("frame", "door"), joint=None, message="They touch at rest.")
    crash = finding(check="KV896", engine="mujoco", joint=None, q=None, value=None, limit=None, unit=None, line=None)
    checks = (
        result(finding(), warning, accepted, pair),
        result(check="KV396", status=Status.SKIPPED, reason="it does not apply"),
        result(crash, check="KV896", engine="mujoco", status=Status.BLOCKED, reason="the stage crashed"),
        result(check="KV896", engine="mujoco", status=Status.BLOCKED, reason="no mesh"),
        result(),
    )
    return report(*checks, **changes)  # type: ignore[arg-type]
