"""Weight of a failure: how often it occurs where a joint is wrong, against how often where it is right.

The counts in ``failure_rates.json`` are of wrong joints planted in true mechanisms; `kinematify bench failures` makes
them. A weight is a lower confidence bound of the logarithm of the ratio of the two rates, the unit in which the choice
of joints adds up evidence: what was seen on few joints proves little.
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

RIGHT, LINE, TYPE, PARENT, RANGE = "right", "line", "type", "parent", "range"
CLASSES = (RIGHT, LINE, TYPE, PARENT, RANGE)
"""What a joint was: right, or wrong in its line (axis or place), its type, its parent, or its range or sign."""
RATES_FILE = "failure_rates.json"
_SURE = 1.645  # standard errors: the true ratio is larger in 95 of 100 cases


@dataclass(frozen=True, kw_only=True)
class FailureRates:
    """Counts of joints, and of those that a check found fault with."""

    joints: Mapping[str, int]
    """Class of joint -> how many were simulated."""
    failures: Mapping[str, Mapping[str, Mapping[str, int]]]
    """Check -> severity of its worst finding -> class of joint -> how many of them it found that fault with."""
    provenance: Mapping[str, Any]

    def weight(self, check: str, severity: Severity, wrong: str) -> float:
        """Return what a failure of a check says for a wrong joint and against a right one [log odds], 0 if nothing.

        Args:
            check: Its id.
            severity: Of its finding: a warning is more frequent on right joints than an error.
            wrong: `LINE`, `TYPE`, `PARENT` or `RANGE`.
        """
        seen, failed = self.joints, self.failures.get(check, {}).get(severity, {})
        if not (seen.get(wrong) and seen.get(RIGHT)):
            return 0.0
        # The usual interval of a ratio of two rates (Katz and others 1978), with half a failure added for none.
        ratio, variance = 0.0, 0.0
        for what, sign in ((wrong, 1.0), (RIGHT, -1.0)):
            count, joints = failed.get(what, 0) + 0.5, seen.get(what, 0) + 0.5
            ratio += sign * math.log(count / joints)
            variance += max(1.0 / count - 1.0 / joints, 0.0)
        return max(ratio - _SURE * math.sqrt(variance), 0.0)


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
