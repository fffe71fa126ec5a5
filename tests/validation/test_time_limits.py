"""Time limits in real processes: what is not finished is said, with what finishes it, and is no fault of the model."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from typing import TYPE_CHECKING

import pytest

from kinematify.cli.app import run
from kinematify.config.validation import load_settings
from kinematify.processes.start import ONE_THREAD
from kinematify.validation import run as validation
from kinematify.validation.checks import checks_of
from kinematify.validation.isolation import Stage, StageEnd, run_stages
from kinematify.validation.run.needs import keys
from kinematify.validation.stage import StageRequest
from tests.validation.engine_models import cabinet

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


CHECKS_LEFT = keys(checks_of("KV34"))


def spin(_request: StageRequest, _tell: object) -> None:
    """Work without end."""
    while True:
        pass


def sleep(_request: StageRequest, _tell: object) -> None:
    """Wait for what never comes."""
    time.sleep(600.0)


def nap(_request: StageRequest, _tell: object) -> None:
    """Wait as a process does whose machine is busy: longer on the clock than its processor time may be."""
    time.sleep(2.5)


def crash(_request: StageRequest, _tell: object) -> None:
    """Die as an engine does."""
    os.kill(os.getpid(), signal.SIGSEGV)


def end_of(folder: Path, work: Callable[[StageRequest, object], None], *, seconds: float) -> StageEnd:
    """How a stage ends."""
    request = StageRequest(
        urdf=folder / "model.urdf",
        package_dirs=(),
        work=folder,
        settings=load_settings(),
        selected=frozenset(),
        deadline=seconds,
    )
    (end,) = run_stages([Stage(name="first", run=work, checks=())], request, workers=1)
    return end


@pytest.mark.parametrize("work", [spin, sleep])
def test_a_stage_out_of_time_is_late(work: Callable[[StageRequest, object], None], tmp_path: Path) -> None:
    end = end_of(tmp_path, work, seconds=0.1)
    assert end.late
    assert "was stopped" in (end.failure or "")


def test_time_on_the_clock_alone_stops_nothing(tmp_path: Path) -> None:
    end = end_of(tmp_path, nap, seconds=2.0)
    assert end.failure is None
    assert end.seconds < 2.0


def test_a_crash_is_not_late(tmp_path: Path) -> None:
    end = end_of(tmp_path, crash, seconds=60.0)
    assert (end.failure, end.late) == ("crashed with SIGSEGV", False)


def test_the_command_needs_no_server_beside_it(tmp_path: Path) -> None:
    script = """
import sys
from kinematify.cli.app import run
from kinematify.processes.start import worker_context
assert run(["validate", sys.argv[1], "--engines", "none"]) == 0
assert worker_context().get_start_method() == "fork", "a library was loaded that keeps threads"
"""
    environment = {name: value for name, value in os.environ.items() if name not in ONE_THREAD}
    words = [sys.executable, "-c", script, str(cabinet().write(tmp_path))]
    subprocess.run(words, env=environment, check=True, capture_output=True)


@pytest.mark.parametrize(("work", "status"), [(spin, 3), (crash, 0)])
def test_what_was_not_finished_is_no_finding_and_ends_with_3(
    work: Callable[[StageRequest, object], None],
    status: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    stage = Stage(name="evidence", run=work, checks=CHECKS_LEFT)
    monkeypatch.setattr(validation, "later_stages", lambda _: [stage])
    model = cabinet().write(tmp_path)
    words = ["validate", str(model), "--engines", "none", "--checks", "KV34*", "--budget", "4"]
    assert run([*words, "--json", str(tmp_path / "report.json")]) == status
    report = json.loads((tmp_path / "report.json").read_text())
    suspected = [item["message"] for item in report["findings"] if item["severity"] != "note"]
    left = [item for item in report["checks"] if (item["check"], item["engine"]) in CHECKS_LEFT]
    if status == 0:
        assert "crashed with SIGSEGV" in suspected[0]
        assert {item["status"] for item in left} == {"blocked"}
        return
    assert suspected == []
    assert {item["status"] for item in left} == {"skipped"}
    assert all(item["reason"].startswith("not finished: the stage evidence was stopped") for item in left)
    assert all(f"to finish: kinematify validate {model} --budget 8" in item["reason"] for item in left)
    assert f"{len(CHECKS_LEFT)} checks not finished, exit status 3" in capsys.readouterr().out
