"""Joints changed by what `validate` measured: swapped limits, degrees, stops; none that would be crippled by it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.robot import rest_configuration
from kinematify.robot.urdf_text import child_of
from kinematify.robot.write import numbers
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Callable

    from lxml.etree import _Element

    from kinematify.refinement.urdf_editor import UrdfEditor
    from kinematify.robot.robot import Joint, Robot
    from kinematify.validation.finding import Finding
    from kinematify.validation.run.report import ValidationReport

_LEAST_RANGE = 0.25
"""A limit that leaves less of the declared range is not written."""
_SAME = 1e-6
"""Values that differ by less are the same [rad or m]."""
_BLOCKED = ("KV310", "KV312")
"""Findings that name a contact that ends the way."""
_FREE = 0.9
"""Of the mirrored range: what has to be free the other way for an axis to be reversed."""


def _swapped(limit: _Element, _finding: Finding) -> dict[str, str]:
    return {"lower": limit.get("upper", "0"), "upper": limit.get("lower", "0")}


def _radians(limit: _Element, finding: Finding) -> dict[str, str]:
    """The ends of a range of whole degrees; nothing of another one."""
    ends = {end: float(limit.get(end, "0")) for end in ("lower", "upper")}
    is_sure = finding.severity is Severity.ERROR and finding.unit == "rad" and all(map(float.is_integer, ends.values()))
    return {end: f"{np.radians(value):.6g}" for end, value in ends.items() if is_sure}


_EDITS: dict[str, tuple[str, str, Callable[[_Element, Finding], dict[str, str]]]] = {
    "KV134": ("axis", "an axis without direction gets the default of URDF", lambda *_: {"xyz": "1 0 0"}),
    "KV137": ("limit", "the limits were swapped", _swapped),
    "KV220": ("limit", "the range was in degrees", _radians),
}
"""Findings of the text -> the element below the joint, what is said of the change, and its new values."""


@dataclass(kw_only=True)
class JointEdits:
    """Edits of the joints of one editor, over several looks at it."""

    editor: UrdfEditor
    left: dict[str, str] = field(default_factory=dict)
    """Why a joint stays, by name."""
    _done: set[tuple[str, str]] = field(default_factory=set)

    def apply(self, report: ValidationReport, robot: Robot | None) -> None:
        """Change what the findings of a report allow to be changed.

        Args:
            report: Of the editor as it was written last.
            robot: What it says; None where it cannot be read yet.
        """
        for finding in report.counted:
            if finding.joint is not None and finding.check in _EDITS:
                self._edit(finding, finding.joint)
        if robot is None:
            return
        free = {item.joint: item.free_travel for item in report.joints}
        for name, found in _blocked(report, robot).items():
            if (travel := free.get(name)) is not None:
                self._limit(robot.joint_by_name[name], found, travel, rest_configuration(robot)[name])

    def _edit(self, finding: Finding, joint: str) -> None:
        name, title, values = _EDITS[finding.check]
        element = self.editor.joint(joint)
        found = element.find(name)
        if found is not None and (finding.check, joint) not in self._done and (given := values(found, finding)):
            with self.editor.diffed(f"{joint}: {title} ({finding.check})", element):
                for key, value in given.items():
                    found.set(key, value)
        self._done.add((finding.check, joint))

    def _limit(self, joint: Joint, doubt: Finding, free: tuple[float, float], rest: float) -> None:
        """End the range where contact stops the joint, or reverse an axis that leads into the parent."""
        if ("range", joint.name) in self._done:
            return
        self._done.add(("range", joint.name))
        declared = joint.upper - joint.lower
        if not 0.0 < declared < np.inf:
            self.left[joint.name] = "it has no range that could end earlier"
            return
        lower, upper = max(joint.lower, free[0]), min(joint.upper, free[1])
        element = self.editor.joint(joint.name)
        if (
            upper - lower >= _LEAST_RANGE * declared
            and lower <= min(rest, 0.0) + _SAME
            and upper >= max(rest, 0.0) - _SAME
        ):
            with self.editor.diffed(f"{joint.name}: the range ends where contact stops it ({doubt.check})", element):
                for name, value, given in (("lower", lower, joint.lower), ("upper", upper, joint.upper)):
                    if abs(value - given) > _SAME:
                        child_of(element, "limit").set(name, f"{value:.6g}")
            return
        mirrored = min(-joint.lower, free[1]) - max(-joint.upper, free[0])
        if doubt.check == "KV310" and rest == 0.0 and mirrored >= _FREE * declared:
            with self.editor.diffed(f"{joint.name}: the axis led into the parent and is reversed (KV310)", element):
                child_of(element, "axis").set("xyz", numbers(-joint.axis))
            return
        kept = max(upper - lower, 0.0) / declared
        self.left[joint.name] = (
            f"limits from {lower:.4g} to {upper:.4g} would leave {kept:.0%} of its range, or "
            "exclude zero or rest; its axis, its place or the shapes are wrong"
        )


def _blocked(report: ValidationReport, robot: Robot) -> dict[str, Finding]:
    """The worst finding about what ends the way of a joint, by joint; no notes."""
    found: dict[str, Finding] = {}
    for finding in report.counted:
        counts = finding.severity is not Severity.NOTE and finding.cause is Cause.KINEMATICS
        if counts and finding.check in _BLOCKED and finding.joint in robot.joint_by_name:
            found.setdefault(finding.joint or "", finding)
    return found
