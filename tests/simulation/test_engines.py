"""The registry of engines."""

from __future__ import annotations

import pytest

from kinematify.errors import EnvironmentFault
from kinematify.simulation.engines import ENGINES, EngineEntry, require_engine


def test_engine_that_is_not_installed_is_reported_with_the_way_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    absent = EngineEntry(name="absent", title="Absent", packages=("no-such-engine",))
    monkeypatch.setitem(ENGINES, "absent", absent)
    with pytest.raises(EnvironmentFault, match=r"Absent needs no-such-engine, .* install .*no-such-engine"):
        require_engine("absent")
