"""The command line: exit statuses, messages of one paragraph, and an answer that stands alone on stdout."""

from __future__ import annotations

import contextlib
import json
import os
import pty
import shlex
import signal
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import click
import pytest

from kinematify.cli import app, doctor
from kinematify.cli.answer import write_answer
from kinematify.cli.app import COMMANDS, run
from kinematify.cli.progress import progress_reporter
from kinematify.errors import EnvironmentFault, InputError, OutputError


@pytest.fixture
def failing(monkeypatch: pytest.MonkeyPatch) -> object:
    """Return a function that makes `kinematify doctor` raise what it is given."""

    def install(error: BaseException) -> None:
        def examine() -> tuple[doctor.PackageState, ...]:
            raise error

        monkeypatch.setattr(doctor, "examine_packages", examine)

    return install


@pytest.mark.parametrize(
    ("error", "status"),
    [
        (InputError("The file x holds no mesh. Give one."), 2),
        (OutputError("The folder x is there. Give --force."), 2),
        (EnvironmentFault("The engine x is missing. Install it."), 3),
    ],
)
def test_our_errors_become_one_paragraph(
    failing, capsys: pytest.CaptureFixture[str], error: Exception, status: int
) -> None:
    failing(error)
    assert run(["doctor"]) == status
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == f"Error: {error}\n"


def test_unexpected_errors_say_how_to_see_more(failing, capsys: pytest.CaptureFixture[str]) -> None:
    failing(ZeroDivisionError("one by none"))
    assert run(["doctor"]) == 3
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert "ZeroDivisionError: one by none" in message
    assert "--traceback" in message
    assert "Traceback (most recent call last)" not in message


@pytest.mark.parametrize("error", [ZeroDivisionError("one by none"), InputError("The file x holds no mesh.")])
def test_traceback_is_shown_when_asked_for(failing, capsys: pytest.CaptureFixture[str], error: Exception) -> None:
    failing(error)
    assert run(["doctor", "--traceback"]) == (2 if isinstance(error, InputError) else 3)
    message = capsys.readouterr().err
    assert "Traceback (most recent call last)" in message
    assert "in examine" in message


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["infre"], "Did you mean 'infer'?"),
        (["infer"], "Missing argument 'ASSEMBLY'"),
        (["infer", "x"], "Missing option '-o' / '--out'"),
        (["infer", "x", "-o", "y", "--sead", "1"], "--seed"),
        (["infer", "x", "-o", "y", "--up", "w"], "'auto', 'z', 'y'"),
        (["doctor", "surplus"], "unexpected extra argument"),
    ],
)
def test_wrong_arguments_end_with_2(words: list[str], text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert text in captured.err


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_examples_that_parse(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run([command, "--help"]) == 0
    text = capsys.readouterr().out
    shown = [shlex.split(line)[1:] for line in text.splitlines() if line.startswith("    kinematify ")]
    assert shown
    for words in shown:
        assert words[0] == command
        arguments = words[1 : next((i for i, word in enumerate(words) if word in (">", "|")), None)]
        loaded = app.cli.get_command(click.Context(app.cli), command)
        with contextlib.suppress(click.exceptions.Exit):  # of options that only show something, as `bench --list`
            loaded.make_context(command, arguments, obj={})


def test_group_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["--help"]) == 0
    text = capsys.readouterr().out
    assert all(f"\n  {name} " in text for name in COMMANDS)


def test_doctor_reports_this_environment(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    assert [requirement.name for requirement in doctor._declared_requirements()] == list(doctor.MODULES)
    absent = [name for name, (module, _) in doctor.MODULES.items() if module and find_spec(module) is None]
    assert not absent
    for name in doctor.MODULES.keys() - {"mujoco", "click", "example-robot-data"}:  # each is imported by a process
        monkeypatch.delitem(doctor.MODULES, name)
    assert run(["doctor", "--json", "-"]) == 0
    answer = json.loads(capsys.readouterr().out)
    states = {entry["package"]: entry["state"] for entry in answer["packages"]}
    assert answer["schema"] == 1
    assert states == {"mujoco": "ok", "click": "ok", "example-robot-data": "ok"}


def finding(**changes: object) -> doctor.PackageState:
    """A healthy package, with some fields changed."""
    fields = {
        "package": "mujoco", "purpose": "engine", "wanted": ">=4.0,<5", "installed": "4.0.0", "state": "ok",
        "optional": False,
    }  # fmt: skip
    return doctor.PackageState(**{**fields, **changes})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changes", "status", "text"),
    [
        ({"state": "missing", "installed": None}, 3, "pip install 'mujoco>=3.7'"),
        ({"state": "missing", "installed": None, "optional": True}, 0, "missing (optional)"),
        ({"state": "version", "installed": "3.1.0"}, 3, "pip install 'mujoco>=3.7'"),
        ({"state": "broken", "problem": "ImportError: libGL"}, 3, "ImportError: libGL"),
        ({}, 0, "Everything works."),
    ],
)
def test_doctor_says_how_to_mend(
    changes: dict[str, object],
    status: int,
    text: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(doctor, "examine_packages", lambda: (finding(**changes),))
    assert run(["doctor"]) == status
    assert text in capsys.readouterr().out


def test_doctor_sees_a_module_that_crashes_or_is_absent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "crashing.py").write_text("import os; os.abort()")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert doctor._import_problem("crashing") == "importing crashing ended with status -6"
    assert "No module named 'absent_module'" in str(doctor._import_problem("absent_module"))
    assert doctor._import_problem("json") is None


def test_answer_goes_to_a_file_or_says_why_not(tmp_path: Path) -> None:
    write_answer({"schema": 1}, str(tmp_path / "answer.json"))
    assert json.loads((tmp_path / "answer.json").read_text()) == {"schema": 1}
    with pytest.raises(
        OutputError, match=r"cannot be written to .*none/answer\.json: No such file or directory\. Give"
    ):
        write_answer({"schema": 1}, str(tmp_path / "none" / "answer.json"))


def test_progress_off_a_terminal_is_one_line_per_stage(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_reporter() as report:
        for stage, fraction in (("contact graph", 0.1), ("contact graph", 0.2), ("joints", 0.5)):
            report(stage, fraction)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert [line.split("] ")[1] for line in captured.err.splitlines()] == ["contact graph", "joints"]


def test_progress_on_a_terminal_is_a_bar_on_stderr() -> None:
    code = (
        "from kinematify.cli.progress import progress_reporter\n"
        "import time\n"
        "with progress_reporter() as report:\n"
        "    report('joints', 0.5); time.sleep(0.3)\n"
    )
    ours, theirs = pty.openpty()
    done = subprocess.run([sys.executable, "-c", code], stderr=theirs, stdout=subprocess.PIPE, check=True, timeout=300)
    os.close(theirs)
    shown = os.read(ours, 100_000).decode()
    os.close(ours)
    assert done.stdout == b""
    assert "joints" in shown
    assert "50%" in shown


def test_interrupted_process_ends_with_130() -> None:
    code = (
        "import sys, time\n"
        "from kinematify.cli import app, doctor\n"
        "def wait():\n    print('waiting', flush=True); time.sleep(60)\n"
        "doctor.examine_packages = wait\n"
        "sys.exit(app.run(['doctor']))\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "waiting\n"
    time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, message = process.communicate(timeout=300)
    assert process.returncode == 130
    assert "Traceback" not in message
