"""Work in several processes: the same answer, and a clear end where one of them dies."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from kinematify.errors import ExitStatus
from kinematify.processes.start import ONE_THREAD
from tests.objects import write_parts

_LOOP = """
import os, sys
from kinematify.errors import EnvironmentFault, InputError
from kinematify.processes.forked import each, using_processes

def one(number):
    if number == int(sys.argv[1]):
        os.kill(os.getpid(), 9)
    if number == int(sys.argv[2]):
        raise InputError("No such part.")
    return number, os.getpid()

with using_processes(2):
    try:
        found = each(one, range(4))
    except EnvironmentFault as error:
        print(type(error).__name__, error)
    else:
        assert [number for number, _ in found] == [0, 1, 2, 3]
        print(os.getpid() not in {process for _, process in found})
"""


def _loop(killed: int, refused: int) -> str:
    command = [sys.executable, "-c", _LOOP, str(killed), str(refused)]
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=60).stdout


def test_items_are_done_in_copies_of_the_process() -> None:
    assert _loop(-1, -1) == "True\n"


def test_a_process_that_dies_ends_the_loop() -> None:
    said = _loop(2, -1)
    assert said.startswith("EnvironmentFault")
    assert "SIGKILL" in said
    assert "--jobs 1" in said


def test_an_error_ends_the_loop() -> None:
    assert "InputError: No such part." in _loop(-1, 2)


def test_the_model_is_the_same_for_any_number_of_jobs(tmp_path: Path) -> None:
    records = []
    parts = write_parts("nested_drawer", tmp_path / "parts")
    for jobs in ("1", "2"):
        out = tmp_path / jobs
        command = [sys.executable, "-m", "kinematify", "infer", str(parts), "-o", str(out)]
        options = ["--jobs", jobs, "--no-validation", "--no-preview"]
        ended = subprocess.run([*command, *options], capture_output=True, timeout=300, check=False)
        assert ended.returncode == ExitStatus.FINE, ended.stderr.decode()
        record = json.loads((out / "inference.json").read_text(encoding="utf-8"))
        records.append({key: value for key, value in record.items() if key not in ("seconds", "peak_mb")})
    assert records[0] == records[1]


def test_a_validation_is_forked_from_the_inference_before_it(tmp_path: Path) -> None:
    script = """
import sys
from kinematify.cli.app import run
from kinematify.processes.start import worker_context
assert run(["infer", sys.argv[1], "-o", sys.argv[2], "--jobs", "1", "--no-preview"]) == 0
assert worker_context().get_start_method() == "fork", "a server imports again what is there already"
"""
    environment = {name: value for name, value in os.environ.items() if name not in ONE_THREAD}
    words = [sys.executable, "-c", script, str(write_parts("drawer", tmp_path / "parts")), str(tmp_path / "out")]
    subprocess.run(words, env=environment, check=True, capture_output=True)
