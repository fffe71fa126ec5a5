"""What a failure weighs: how often it occurs where a joint is wrong, against how often where it is right.

The counts in ``failure_rates.json`` are of wrong joints planted in true mechanisms; `kinematify bench failures` makes
them. A weight is the logarithm of the ratio of the two rates, the unit in which the choice of joints adds up evidence.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from kinematify.errors import EnvironmentFault

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.validation.finding import Severity

RIGHT, LINE, TYPE, PARENT = "right", "line", "type", "parent"
CLASSES = (RIGHT, LINE, TYPE, PARENT)
"""What a joint was: right, or wrong in its line (axis or place), its type or its parent."""
GEOMETRY, ENGINES, TASK = "geometry", "engines", "task"
RATES_FILE = "failure_rates.json"
_DRAWN = 5.0  # joints of the common rate that are added to those of every class


@dataclass(frozen=True, kw_only=True)
class FailureRates:
    """Counts of joints, and of those that a check found fault with."""

    joints: Mapping[str, Mapping[str, int]]
    """Tier -> class of joint -> how many were simulated there."""
    failures: Mapping[str, Mapping[str, Mapping[str, int]]]
    """Check -> severity of its worst finding -> class of joint -> how many of them it found that fault with."""
    provenance: Mapping[str, Any]

    def weight(self, check: str, severity: Severity, wrong: str) -> float:
        """What a failure of a check says for a wrong joint and against a right one [log odds], 0 if nothing.

        Args:
            check: Its id.
            severity: Of its finding: a warning is more frequent on right joints than an error.
            wrong: `LINE`, `TYPE` or `PARENT`.
        """
        return max(math.log(self._rate(check, severity, wrong) / self._rate(check, severity, RIGHT)), 0.0)

    def _rate(self, check: str, severity: Severity, what: str) -> float:
        """Rate of failures; few joints are drawn towards the rate of all, so that chance says nothing."""
        seen, failed = self.joints.get(tier_of(check), {}), self.failures.get(check, {}).get(severity, {})
        common = (sum(failed.values()) + 0.5) / (sum(seen.values()) + 1.0)
        return (failed.get(what, 0) + _DRAWN * common) / (seen.get(what, 0) + _DRAWN)


def tier_of(check: str) -> str:
    """Return the tier of `kinematify refine` that runs a check."""
    if check.startswith("KV7"):
        return TASK
    return GEOMETRY if check.startswith(("KV30", "KV31", "KV32")) else ENGINES


@cache
def shipped_rates() -> FailureRates:
    """The rates that come with the package.

    Raises:
        EnvironmentFault: Their file is missing or damaged.
    """
    try:
        known = json.loads((files("kinematify.validation") / RATES_FILE).read_text(encoding="utf-8"))
        return FailureRates(**known)
    except (OSError, ValueError, TypeError) as error:
        raise EnvironmentFault(
            f"The rates of failures ({RATES_FILE}) cannot be read: {error}. Install kinematify again, or write them "
            "with 'kinematify bench failures'."
        ) from error
