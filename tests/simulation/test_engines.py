"""The registry of engines, and one that is added to it."""

from __future__ import annotations

import importlib
import re
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from kinematify.errors import EnvironmentFault
from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES, EngineEntry, require_engine
from kinematify.validation.finding import Severity, Status
from kinematify.validation.run import needs
from tests.simulation.point_engine import ENTRY
from tests.validation.engine_models import cabinet, tell
from tests.validation.test_as_loaded import request_of


def test_engine_that_is_not_installed_is_reported_with_the_way_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    absent = EngineEntry(name="absent", title="Absent", packages=("no-such-engine",))
    monkeypatch.setitem(ENGINES, "absent", absent)
    with pytest.raises(EnvironmentFault, match=r"Absent needs no-such-engine, .* install .*no-such-engine"):
        require_engine("absent")


def table() -> list[list[str]]:
    """Rows of the table of what engines can."""
    page = Path("docs/write_checks.md").read_text("utf-8")
    rows = page[page.index("| what it can |") :].splitlines()
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows if row.startswith("|")]


def test_the_page_says_what_each_engine_can() -> None:
    titles, _, *rows = table()
    for entry in (ENGINES[name] for name in DEFAULT_ENGINES):
        engine = importlib.import_module(entry.module).ENGINE
        public = {name for name, value in vars(engine).items() if callable(value) and not name.startswith("_")}
        said: set[str] = set()
        for _, field, methods, *cells in rows:
            can = cells[titles[3:].index(entry.title)] == "yes"
            assert can is (field == "every one" or bool(getattr(entry, field.strip("`"))))
            said |= set(re.findall(r"`(\w+)`", methods.split(", of")[0])) if can else set()
        assert public == said
        assert len(public) <= 20


def test_an_engine_of_one_file_runs_all_checks_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(ENGINES, ENTRY.name, ENTRY)
    results = tell(partial(needs.engine, name="point"), request_of(cabinet(), tmp_path)).results
    assert {check: result.status for check, result in results.items()} == {
        f"KV80{number}": Status.PASS for number in range(1, 8)
    }
    assert results["KV804"].measured == {"joints": 2.0, "right": 2.0}


def test_what_a_new_engine_does_not_open_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(ENGINES, ENTRY.name, ENTRY)
    request, broken = request_of(cabinet(), tmp_path), tmp_path / "broken.urdf"
    broken.write_text('<robot name="broken"><joint/></robot>')
    results = tell(partial(needs.engine, name="point"), replace(request, urdf=broken, resolved=request.urdf)).results
    (finding,) = results["KV801"].findings
    assert (finding.engine, finding.severity) == ("point", Severity.WARNING)
    assert "Point does not open the file as it is" in finding.message
    assert results["KV804"].status is Status.PASS, "it is asked about the copy that it opens"
