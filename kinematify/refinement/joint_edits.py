"""Joints changed by what `validate` measured: swapped limits, stops; never one that would be crippled by it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.robot import rest_configuration
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


@dataclass(kw_only=True)
class JointEdits:
    """Edits of the joints of one editor, over several looks at it."""

    editor: UrdfEditor
    left: dict[str, str] = field(default_factory=dict)
    """Why a joint stays, by name."""
    _done: set[tuple[str, str]] = field(default_factory=set)

    def apply(self, report: ValidationReport, robot: Robot | None) -> bool:
        """Change what the findings of a report allow to be changed.

        Args:
            report: Of the editor as it was written last.
            robot: What it says; None where it cannot be read yet.

        Returns:
            Whether anything was changed.
        """
        count = len(self.editor.diffs)
        for finding in report.counted:
            if finding.joint is None:
                continue
            if finding.check == "KV137":
                self._once(finding, self._swap)
            elif finding.check == "KV134":
                self._once(finding, self._direct)
        if robot is None:
            return len(self.editor.diffs) > count
        free = {item.joint: item.free_travel for item in report.joints}
        for name, found in _blocked(report, robot).items():
            travel = free.get(name)
            if travel is not None:
                self._limit(robot.joint_by_name[name], found, travel, rest_configuration(robot)[name])
        return len(self.editor.diffs) > count

    def _once(self, finding: Finding, edit: Callable[[str, _Element], None]) -> None:
        name = finding.joint or ""
        if (finding.check, name) not in self._done:
            self._done.add((finding.check, name))
            edit(name, self.editor.joint(name))

    def _swap(self, name: str, element: _Element) -> None:
        limit = element.find("limit")
        if limit is not None:
            with self.editor.diffed(f"{name}: the limits were swapped (KV137)", element):
                lower, upper = limit.get("lower", "0"), limit.get("upper", "0")
                limit.set("lower", upper)
                limit.set("upper", lower)

    def _direct(self, name: str, element: _Element) -> None:
        axis = element.find("axis")
        if axis is not None:
            with self.editor.diffed(f"{name}: an axis without direction gets the default of URDF (KV134)", element):
                axis.set("xyz", "1 0 0")

    def _limit(self, joint: Joint, doubt: Finding, free: tuple[float, float], rest: float) -> None:
        """End the range where contact stops the joint, or reverse an axis that leads into the parent."""
        if ("range", joint.name) in self._done:
            return
        self._done.add(("range", joint.name))
        declared = joint.upper - joint.lower
        if not np.isfinite(declared) or declared <= 0.0:
            self.left[joint.name] = "it has no range that could end earlier"
            return
        lower, upper = max(joint.lower, free[0]), min(joint.upper, free[1])
        element = self.editor.joint(joint.name)
        if (
            upper - lower >= _LEAST_RANGE * declared
            and lower <= min(rest, 0.0) + _SAME
            and upper >= max(rest, 0.0) - _SAME
        ):
            limit = element.find("limit")
            if limit is not None:
                with self.editor.diffed(
                    f"{joint.name}: the range ends where contact stops it ({doubt.check})", element
                ):
                    for name, value, given in (("lower", lower, joint.lower), ("upper", upper, joint.upper)):
                        if abs(value - given) > _SAME:
                            limit.set(name, f"{value:.6g}")
            return
        mirrored = min(-joint.lower, free[1]) - max(-joint.upper, free[0])
        if doubt.check == "KV310" and rest == 0.0 and mirrored >= _FREE * declared:
            with self.editor.diffed(f"{joint.name}: the axis led into the parent and is reversed (KV310)", element):
                _child(element, "axis").set("xyz", numbers(-joint.axis))
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


def _child(element: _Element, tag: str) -> _Element:
    found = element.find(tag)
    if found is None:
        found = element.makeelement(tag)
        element.append(found)
    return found
