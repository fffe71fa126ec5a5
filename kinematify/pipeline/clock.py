"""How long the stages of a run take, told to who waits."""

from __future__ import annotations

import resource
import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Progress = Callable[[str, float], None]


class StageClock:
    """Times the stages and tells who waits."""

    def __init__(self, progress: Progress | None) -> None:
        """Start with no stage.

        Args:
            progress: Called with the name of each stage and the share of the work done before it, in [0, 1].
        """
        self.progress = progress or (lambda stage, share: None)
        self.seconds: dict[str, float] = {}
        """Wall time of every stage that has ended [s]."""

    @contextmanager
    def stage(self, name: str, share: float) -> Iterator[None]:
        """Time what is done inside; `share` of all work is done before it."""
        self.progress(name, share)
        start = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - start


def peak_mb() -> float:
    """Peak resident memory of the process so far [MB]."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1024 * 1024 if sys.platform == "darwin" else 1024)
