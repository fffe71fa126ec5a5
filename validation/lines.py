"""Where in the file a finding is: the line of the joint or link that it names, if its check did not say it itself."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

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
