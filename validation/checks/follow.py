"""Causes that several checks share, for `Check.follows`."""

from __future__ import annotations

from kinematify.validation.check import Shared

AT_REST = {"KV301": Shared.PAIR, "KV302": Shared.PAIR}
"""Two bodies are in each other as the file stands."""
IN_ENGINES = {**AT_REST, "KV332": Shared.PAIR}
"""Two bodies are in each other where engines collide their hulls."""
ON_THE_WAY = {"KV312": Shared.JOINT, "KV310": Shared.JOINT, "KV311": Shared.JOINT}
"""Exact geometry blocks a joint."""
NOT_A_BODY = {"KV201": Shared.MODEL, "KV202": Shared.MODEL, "KV204": Shared.MODEL, "KV205": Shared.MODEL}
"""Masses and inertias that no engine can compute with."""
