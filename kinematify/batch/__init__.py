"""Many objects: tasks in processes that may crash, on this machine or on a cluster, and `kinematify batch`.

Called as a function, the package converts a library, as the command does (`kinematify.batch.run_batch.batch`).
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kinematify.batch.run_batch import BatchResult


class _Package(ModuleType):
    """The package as a function: `kinematify.batch` is both."""

    def __call__(self, *inputs: Any, **options: Any) -> BatchResult:
        """Call `kinematify.batch.run_batch.batch`, whose arguments these are."""
        from kinematify.batch.run_batch import batch as run  # noqa: PLC0415 - workers and readers of manifests need less

        return run(*inputs, **options)


batch = sys.modules[__name__]
batch.__class__ = _Package
