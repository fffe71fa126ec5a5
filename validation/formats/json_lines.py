"""JSON: one object for one model, one object per line for several."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.outcome import Outcome


def as_json_text(outcomes: Sequence[Outcome]) -> str:
    """Return the outcomes as text: indented if there is one, else a line each, in the order of the models."""
    if len(outcomes) == 1:
        return json.dumps(outcomes[0].as_json(), indent=2, allow_nan=False) + "\n"
    return "".join(json.dumps(outcome.as_json(), allow_nan=False) + "\n" for outcome in outcomes)
