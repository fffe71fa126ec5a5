"""KV10x to KV14x: the text of a URDF, before any mesh is opened and any engine sees it.

Every check reads the XML tree and tells all problems of its kind, so that one run tells all of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.robot.urdf_text import read_text
from kinematify.validation.checks import CHECKS, checks_of
from kinematify.validation.document import Urdf
from kinematify.validation.finding import Status

if TYPE_CHECKING:
    from kinematify.validation.check import Check, OpenCheck
    from kinematify.validation.stage import Recorder, StageRequest

_TEXT = ("KV101", "KV102")
_WHOLE = "KV108"
_SIZE = "KV103"
_SHOWN = 50
"""Findings per check; what a thousand lines have in common is seen in the first fifty."""


def precheck(request: StageRequest, recorder: Recorder) -> bool:
    """Check the document; True if later stages may read it.

    Args:
        request: Names the document, where packages lie, and the caps.
        recorder: Called with the checks KV101 to KV144; after an error of the text itself only those that could run.

    Raises:
        DescriptionError: The file is missing, cannot be opened, or is something else than a URDF.
    """
    source = read_text(request.urdf)
    refused = [_blocks(CHECKS[name], source, recorder) for name in _TEXT]
    if source.robot is None or any(refused):
        return False
    urdf = Urdf.of(source.robot, request, source.text)
    if _blocks(CHECKS[_SIZE], urdf, recorder):
        return False
    _blocks(CHECKS[_WHOLE], request.losses, recorder)
    done = (*_TEXT, _SIZE, _WHOLE)
    others = [check for check in checks_of("KV10", "KV11", "KV12", "KV13", "KV14") if check.id not in done]
    blocked = [_blocks(check, urdf, recorder) for check in others]
    return not any(blocked)


def _blocks(check: Check, context: object, recorder: Recorder) -> bool:
    """Run a check; True if what it finds, or that it failed, forbids later stages to read the file."""
    blocks = True
    with recorder.check(check.id) as result:
        check.run(result, context)
        _shorten(result)
        blocks = result.is_fatal
    return blocks or result.status is Status.BLOCKED


def _shorten(result: OpenCheck) -> None:
    left = len(result.findings) - _SHOWN
    if left > 0:
        del result.findings[_SHOWN:]
        result.measured["not_listed"] = left
        result.reason = f"{left} more findings of this kind are not listed"
