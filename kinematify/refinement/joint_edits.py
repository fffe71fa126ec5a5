"""Joints changed by what `validate` measured: swapped limits, stops, lines; never one that would be crippled by it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.robot.write import numbers
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path
    from typing import Any

    from lxml.etree import _Element

    from kinematify.refinement.urdf_editor import UrdfEditor
    from kinematify.robot.robot import Joint, Robot
    from kinematify.validation.finding import Finding
    from kinematify.validation.run.report import ValidationReport

_LEAST_RANGE = 0.25
"""A limit that leaves less of the declared range is not written."""
_SAME = 1e-6
"""Values that differ by less are the same [rad or m]; so are lines, by angle and distance."""
_LINE = ("KV320", "KV340", "KV349")
"""Facts by which a line is wrong; what the shapes merely suggest changes no joint."""
_BLOCKED = ("KV310", "KV312")
"""Findings that name a contact that ends the way."""
_BESIDE = 0.01
"""A line nearer to the axis than this fraction of the child's size is no other place."""
_FREE = 0.9
"""Of the mirrored range: what has to be free the other way for an axis to be reversed."""


@dataclass(kw_only=True)
class JointEdits:
    """Edits of the joints of one editor, over several looks at it."""

    editor: UrdfEditor
    look: Callable[[Path], ValidationReport]
    """Judges the joints of a file by its geometry."""
    left: dict[str, str] = field(default_factory=dict)
    """Why a joint stays, by name."""
    _done: set[tuple[str, str]] = field(default_factory=set)
    _guessed: set[str] = field(default_factory=set)
    """Joints whose axis had no direction and got the default of URDF."""

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
        doubts = _facts(report, robot)
        summaries = {item.joint: item for item in report.joints}
        lines = {
            name: summary.best_alternative
            for name, summary in summaries.items()
            if summary.best_alternative is not None
            and ("line", name) not in self._done
            and (name in self._guessed or _about(doubts.get(name, ()), _LINE) is not None)
        }
        turned = self._turn_all(robot, lines, doubts)
        for name, found in doubts.items():
            free = summaries[name].free_travel if name in summaries else None
            blocked = _about(found, _BLOCKED)
            if name in turned:
                continue
            if free is not None and blocked is not None:
                self._limit(robot.joint_by_name[name], blocked, free, rest_configuration(robot)[name])
            else:
                self.left.setdefault(name, "the parts show no line that is clearly better")
        return len(self.editor.diffs) > count

    def _turn_all(
        self, robot: Robot, lines: Mapping[str, Mapping[str, Any]], doubts: Mapping[str, Sequence[Finding]]
    ) -> set[str]:
        """Put joints on the lines that the parts show, but for those that are doubted there as well."""
        tried = dict(lines)
        while tried:
            saved, count = self.editor.saved(), len(self.editor.diffs)
            turned = {name for name in tried if self._turn(robot, name, tried[name], doubts.get(name, ()))}
            now = _facts(self.look(self.editor.write()), robot) if turned else {}
            still = {name for name in turned if _about(now.get(name, ()), _LINE) is not None}
            self._done |= {("line", name) for name in tried}
            if not still:
                return turned
            self.editor.restore(saved)
            del self.editor.diffs[count:]
            for name in still:
                self.left[name] = "about the line that the parts show it would be doubted as well"
            tried = {name: tried[name] for name in turned - still}
        return set()

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
            self._guessed.add(name)

    def _turn(self, robot: Robot, name: str, better: Mapping[str, Any], doubts: Sequence[Finding]) -> bool:
        """Put a joint on a line and leave all parts where they are at zero; False if nothing changes."""
        joint, slides = robot.joint_by_name[name], robot.joint_by_name[name].kind is JointType.PRISMATIC
        if (better["kind"] == JointType.PRISMATIC.value) != slides:
            self.left[name] = f"the parts speak for the type {better['kind']}, which is the author's choice"
            return False
        poses = forward_kinematics(robot, {})
        T_world_child, R_world_parent = poses[joint.child], poses[joint.parent][:3, :3]
        axis, pivot = np.array(better["axis"], dtype=float), np.array(better["pivot"], dtype=float)
        own = T_world_child[:3, :3] @ joint.axis
        axis = (
            axis / np.linalg.norm(axis) * (-1.0 if float(axis @ own) < 0.0 and joint.name not in self._guessed else 1.0)
        )
        beside = pivot - T_world_child[:3, 3]
        beside = np.zeros(3) if slides else beside - (beside @ axis) * axis
        turned = float(np.linalg.norm(np.cross(axis, own))) > _SAME
        moved = float(np.linalg.norm(beside)) > _SAME + _BESIDE * _size(robot, joint.child)
        if not turned and not moved:
            return False
        element = self.editor.joint(name)
        doubt = _about(doubts, _LINE)
        why = "" if doubt is None else f" ({doubt.check})"
        with self.editor.diffed(
            f"{name}: the line that the parts show{why}", element, *(self.editor.reparented(name) if moved else ())
        ):
            if turned:
                _child(element, "axis").set("xyz", numbers(np.round(T_world_child[:3, :3].T @ axis, 9)))
            if moved:
                in_parent, in_child = R_world_parent.T @ beside, T_world_child[:3, :3].T @ beside
                self.editor.shift(name, in_parent.tolist(), in_child.tolist())
        return True

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


def _facts(report: ValidationReport, robot: Robot) -> dict[str, list[Finding]]:
    """Findings about joints themselves that are no notes, the worst first, by joint."""
    found: dict[str, list[Finding]] = {}
    for finding in report.counted:
        counts = finding.severity is not Severity.NOTE and finding.cause is Cause.KINEMATICS
        if counts and finding.check in (*_LINE, *_BLOCKED) and finding.joint in robot.joint_by_name:
            found.setdefault(finding.joint or "", []).append(finding)
    return found


def _about(findings: Sequence[Finding], checks: Sequence[str]) -> Finding | None:
    return next((finding for finding in findings if finding.check in checks), None)


def _size(robot: Robot, link: str) -> float:
    """Diagonal of the box around the geometry of a link [m]; 0 without any."""
    corners = [mesh.vertices for mesh in robot.link_by_name[link].meshes if len(mesh.vertices)]
    return float(np.linalg.norm(np.ptp(np.concatenate(corners), axis=0))) if corners else 0.0


def _child(element: _Element, tag: str) -> _Element:
    found = element.find(tag)
    if found is None:
        found = element.makeelement(tag)
        element.append(found)
    return found
