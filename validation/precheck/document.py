"""KV10x to KV14x: the text of a URDF, before any mesh is opened and any engine sees it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.assembly.description import parse_description

if TYPE_CHECKING:
    from kinematify.validation.stage import Recorder, StageRequest


def precheck(request: StageRequest, recorder: Recorder) -> bool:
    """Check the document; True if later stages may read it."""
    parse_description(request.urdf)
    return True
