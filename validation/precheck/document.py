"""KV10x to KV14x: the text of a URDF, before any mesh is opened and any engine sees it.

Every probe reads the XML tree and hands back all problems of its kind, so that one run tells all of them.
"""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING

from kinematify.robot.urdf_text import read_text
from kinematify.validation.catalogue import CATALOGUE
from kinematify.validation.finding import Severity, Status
from kinematify.validation.precheck import joints, names, numbers, references, shapes, text, tree
from kinematify.validation.precheck.urdf import Urdf

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from kinematify.validation.precheck.problem import Problem
    from kinematify.validation.stage import OpenCheck, Recorder, StageRequest

    Probe = Callable[[Urdf], Iterator[Problem]]

_SHOWN = 50
"""Findings per check; what a thousand lines have in common is seen in the first fifty."""

_PROBES: dict[str, Probe] = {**text.PROBES, **names.PROBES, **tree.PROBES, **joints.PROBES}
_PROBES |= {**numbers.PROBES, **shapes.PROBES, **references.PROBES}


def precheck(request: StageRequest, recorder: Recorder) -> bool:
    """Check the document; True if later stages may read it.

    Args:
        request: Names the document, where packages lie, and the caps.
        recorder: Told the checks KV101 to KV144; after an error of the text itself only those that could still run.

    Raises:
        DescriptionError: The file is missing, cannot be opened, or is something else than a URDF.
    """
    source = read_text(request.urdf)
    with recorder.check("KV101") as check:
        _add_all(check, text.syntax_problems(source))
    with recorder.check("KV102") as check:
        _add_all(check, text.doctype_problems(source))
        refused = bool(check.findings)
    if source.robot is None or refused:
        return False
    urdf = Urdf.of(source.robot, request, source.text)
    with recorder.check("KV103") as check:
        oversized = _add_all(check, text.cap_problems(urdf))
    if oversized:
        return False
    blocked = [_blocked(name, probe, urdf, recorder) for name, probe in sorted(_PROBES.items())]
    return not any(blocked)


def _blocked(name: str, probe: Probe, urdf: Urdf, recorder: Recorder) -> bool:
    """Run a probe; True if what it finds, or that it failed, forbids later stages to read the file."""
    blocks = True
    with recorder.check(name) as check:
        blocks = _add_all(check, probe(urdf))
    return blocks or check.status is Status.BLOCKED


def _add_all(check: OpenCheck, problems: Iterator[Problem]) -> bool:
    """Add the problems as findings; True if one of them forbids later stages to read the file."""
    usual = CATALOGUE[check.id].severity
    blocks = False
    for problem in islice(problems, _SHOWN):
        problem.add_to(check)
        blocks |= (problem.severity or usual) is Severity.ERROR and not problem.harmless
    left = list(problems)
    if left:
        check.measured["not_listed"] = len(left)
        check.reason = f"{len(left)} more findings of this kind are not listed"
        blocks |= any((problem.severity or usual) is Severity.ERROR and not problem.harmless for problem in left)
    return blocks
