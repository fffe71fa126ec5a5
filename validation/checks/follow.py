"""Causes that several checks share, for `Check.follows`."""

from __future__ import annotations

from kinematify.validation.check import CauseScope

AT_REST = {"KV301": CauseScope.PAIR, "KV302": CauseScope.PAIR}
"""Two bodies are in each other as the file is."""
NOT_A_BODY = {
    "KV201": CauseScope.MODEL,
    "KV202": CauseScope.MODEL,
    "KV204": CauseScope.MODEL,
    "KV205": CauseScope.MODEL,
}
"""Masses and inertias that no engine can compute with."""
