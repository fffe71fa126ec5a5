"""KV6xx: what the engines left behind, compared with each other and with the analytical model."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kinematify.validation.stage import Recorder, StageRequest


def compare(request: StageRequest, recorder: Recorder) -> None:
    """Tell the agreement checks."""
