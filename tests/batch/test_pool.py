"""The pool: processes that crash, hang or lose their caller end alone, and what has ended is not run again."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from pydantic import TypeAdapter

from kinematify.batch.task_pool import Pool
from kinematify.processes.pool import Processes, TaskFailure, WorkItem, run_tasks
from tests.places import ROOT

NUMBER = TypeAdapter(dict[str, int])


def process_of_worker(number: int) -> dict[str, int]:
    return {"process": os.getpid()}


def crash() -> dict[str, int]:
    os.kill(os.getpid(), signal.SIGSEGV)
    return {}


def fail() -> dict[str, int]:
    raise ValueError("no such number")


def hang_with_a_child(file: Path) -> dict[str, int]:
    child = subprocess.Popen(["sleep", "600"])
    file.write_text(f"{child.pid} {os.getpid()}")
    time.sleep(600.0)
    return {}


def results(
    tasks: dict[str, Callable[[], dict[str, int]]], folder: Path, **how: float
) -> dict[str, dict[str, int] | TaskFailure]:
    settings = {"timeout": 60.0, **how}
    pool = Pool(folder=folder, workers=2)
    return pool.run(tasks, NUMBER, ledger="numbers", said=lambda key, result: key, **settings)  # type: ignore[arg-type]


def gone(pid: int) -> bool:
    """Whether a process has ended, within five seconds."""
    for _ in range(100):
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        except FileNotFoundError:
            return True
        if state == "Z":
            return True
        time.sleep(0.05)
    return False


def test_what_went_wrong_is_reported_and_kept(tmp_path: Path) -> None:
    found = results({"crash": crash, "fail": fail}, tmp_path)
    crashed, failed = found["crash"], found["fail"]
    assert isinstance(crashed, TaskFailure)
    assert isinstance(failed, TaskFailure)
    assert (crashed.status, failed.status) == ("crash", "error")
    assert "SIGSEGV" in crashed.message
    assert failed.message.startswith("ValueError: no such number (fail, line")
    assert results({"crash": crash, "fail": fail}, tmp_path) == found


def test_a_hang_is_stopped_with_all_that_it_started(tmp_path: Path) -> None:
    (tmp_path / "work").mkdir()
    found = results({"hang": partial(hang_with_a_child, tmp_path / "pids")}, tmp_path / "work", timeout=3.0)
    assert isinstance(found["hang"], TaskFailure)
    assert found["hang"].status == "timeout"
    assert all(gone(int(pid)) for pid in (tmp_path / "pids").read_text().split())


@pytest.mark.parametrize(("reuse", "most"), [(1, 6), (3, 3)])
def test_a_process_takes_as_many_tasks_as_allowed(reuse: int, most: int, tmp_path: Path) -> None:
    tasks = {str(number): partial(process_of_worker, number) for number in range(6)}
    taken = Counter(answer["process"] for answer in results(tasks, tmp_path, reuse=reuse).values())
    assert max(taken.values()) <= reuse
    assert 6 / reuse <= len(taken) <= most  # one that has taken all it may is replaced while another is still busy


_CALLER = """
from functools import partial
from pathlib import Path
from test_pool import hang_with_a_child, results
if __name__ == "__main__":
    results({{"hang": partial(hang_with_a_child, Path({file!r}))}}, Path({folder!r}))
"""


def test_a_caller_that_is_killed_takes_its_processes_with_it(tmp_path: Path) -> None:
    file = tmp_path / "pids"
    script = tmp_path / "caller.py"
    script.write_text(_CALLER.format(file=str(file), folder=str(tmp_path / "work")))
    places = os.pathsep.join([str(ROOT / "tests" / "batch"), str(ROOT), *sys.path])
    caller = subprocess.Popen([sys.executable, str(script)], env={**os.environ, "PYTHONPATH": places})
    deadline = time.monotonic() + 300.0
    while time.monotonic() < deadline and not (file.is_file() and file.read_text()):
        time.sleep(0.05)
    caller.kill()
    caller.wait()
    assert all(gone(int(pid)) for pid in file.read_text().split())


def crash_once(marker: Path) -> dict[str, int]:
    if marker.exists():
        return {"seven": 7}
    marker.touch()
    return crash()


def test_a_task_whose_worker_died_is_begun_again(tmp_path: Path) -> None:
    calls = {"once": partial(crash_once, tmp_path / "marker"), "always": crash}
    tasks = [WorkItem(key=key, call=call, timeout=60.0) for key, call in calls.items()]
    found = dict(run_tasks(tasks, Processes(1), lives=2))
    assert found["once"] == {"seven": 7}
    assert isinstance(found["always"], TaskFailure)
    assert found["always"].message == "the worker ended with SIGSEGV, the last of 2 that it cost"


def take_memory() -> int:
    return len(bytearray(2**33))


def test_what_needs_more_memory_than_allowed_fails_alone() -> None:
    tasks = [WorkItem(key=call.__name__, call=call, timeout=60.0) for call in (take_memory, fail)]
    found = dict(run_tasks(tasks, Processes(1, memory=2**32)))
    assert isinstance(found["take_memory"], TaskFailure)
    assert found["take_memory"].message.startswith("MemoryError")
    assert isinstance(found["fail"], TaskFailure)
    assert found["fail"].message.startswith("ValueError")
