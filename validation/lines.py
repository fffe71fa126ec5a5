"""Where in the file a finding is: the line of the joint or link that it names, if its check did not say it itself."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.simulation.engines import ENGINES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.description import Description
    from kinematify.robot.robot import Robot
    from kinematify.validation.finding import CheckResult, Finding


def with_lines(results: Sequence[CheckResult], robot: Robot | None) -> list[CheckResult]:
    """Return the results with a line in every finding that names a joint or a link.

    Args:
        results: Of all checks of a run.
        robot: The model as it was read; None where it could not be, and findings keep what lines they have.
    """
    if robot is None:
        return list(results)
    joints = {joint.name: joint.line for joint in robot.joints}
    links = {link.name: link.line for link in robot.links}

    def placed(finding: Finding) -> Finding:
        named = [
            joints.get(finding.joint or ""),
            *(links.get(name) for name in (finding.link, *(finding.pair or ())) if name),
        ]
        line = next((line for line in named if line), None)
        return finding if finding.line or line is None else replace(finding, line=line)

    return [replace(result, findings=tuple(map(placed, result.findings))) for result in results]


_RANGE = "KV220"
_OF_TEXT = ("KV104", "KV143", "KV144")
"""Checks of the URDF's text, which say nothing about a file of another format."""


def in_source(results: Sequence[CheckResult], description: Description) -> list[CheckResult]:
    """Return the results with the lines of a file of another format, and with what engines opened in its place."""

    def moved(finding: Finding) -> Finding:
        links = (finding.link, *(finding.pair or ()))
        named = [("joint", finding.joint or ""), *(("link", name or "") for name in links)]
        line = next(
            (description.lines[tag, name] for tag, name in named if name and (tag, name) in description.lines), 0
        )
        opens = finding.engine == "mujoco" and description.native
        if finding.engine is None or opens:
            return replace(finding, line=line or None)
        title = ENGINES[finding.engine].title
        said = f"{finding.message} ({title} was given the URDF of the {description.title}.)"
        return replace(finding, line=line or None, message=said)

    def is_ours(finding: Finding) -> bool:
        return finding.check in _OF_TEXT or (finding.check == _RANGE and finding.joint in description.endless)

    return [
        result.with_findings(moved(finding) for finding in result.findings if not is_ours(finding))
        for result in results
    ]
