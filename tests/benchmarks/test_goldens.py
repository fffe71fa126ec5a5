"""Goldens (`make goldens` compares the committed sample): what cannot be compared or differs never passes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import golden_values
import pytest

from benchmarks.goldens import __main__ as command
from benchmarks.goldens.__main__ import run
from benchmarks.goldens.subjects import GoldenSubject
from benchmarks.goldens.values import first_difference


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, Any]:
    """A subject of two items, whose goldens are made; what it yields is what the next call is asked for."""
    asked: dict[str, Any] = {"items": {"set/left": "left", "set/right": "right"}, "absent": {}}
    subject = GoldenSubject(
        items=lambda sample: (asked["items"], asked["absent"]), values=golden_values.values_of, reuse=2
    )
    monkeypatch.setattr(command, "SUBJECTS", {"small": subject})
    monkeypatch.chdir(tmp_path)
    assert run(["make", "--jobs", "1", "--keep", "kept"]) == 0
    return asked


def test_the_same_is_the_same(small: dict[str, Any], capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert run(["check"]) == 0
    assert "4 goldens compared, 0 differences" in capsys.readouterr().out


def test_what_changed_came_and_went_is_named(small: dict[str, Any], capsys: pytest.CaptureFixture[str]) -> None:
    small["items"] = {"set/left": "right", "set/gone": "gone"}
    assert run(["check", "--show", "kept"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert "small: missing: set/left: left" in lines
    assert "small: added: set/left: right" in lines
    assert "small: changed: set/left: name" in lines
    assert '    : "left" before, "right" now' in lines
    assert "small: missing: set/right: right" in lines
    assert "small: added: set/gone: gone" in lines


def test_a_crash_is_no_pass(small: dict[str, Any], capsys: pytest.CaptureFixture[str]) -> None:
    small["items"] = {"set/left": "left", "set/right": "crash"}
    assert run(["check"]) == 3
    assert "Not made: small: set/right: the worker ended with SIGABRT" in capsys.readouterr().err


def test_absent_data_are_named_and_nothing_at_all_is_no_pass(
    small: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    small["items"], small["absent"] = {}, {"set": "There is no folder."}
    assert run(["check"]) == 2
    shown = capsys.readouterr()
    assert "small: not compared: set/left, set/right. There is no folder." in shown.out
    assert "Nothing was compared" in shown.err


def test_goldens_of_another_platform_are_refused_but_for_what_is_portable(
    small: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    stored = json.loads(Path("out/goldens.json").read_text())
    stored["platform"] |= {"numpy": "1.0", "last bits": "others"}
    stored["subjects"]["small"]["items"]["set/left"]["exact"] = {"left": "another last bit"}
    Path("out/goldens.json").write_text(json.dumps(stored))
    assert run(["check"]) == 2
    error = capsys.readouterr().err
    assert "another platform" in error
    assert "numpy 1.0 -> " in error
    assert "the processor rounds otherwise" in error
    assert run(["check", "--portable"]) == 0
    shown = capsys.readouterr().out
    assert "Not compared: numbers" in shown
    assert "2 goldens compared, 0 differences" in shown
    small["items"] = {"set/left": "right", "set/right": "right"}
    assert run(["check", "--portable"]) == 1


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"format": 0}, "holds no goldens of format 1"),
        ({"sample": True}, "holds a sample"),
        ({"subjects": {}}, "holds no goldens of small"),
        (None, "There are no goldens"),
    ],
)
def test_goldens_that_cannot_be_compared_end_with_2(
    small: dict[str, Any], change: dict[str, Any] | None, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = Path("out/goldens.json")
    if change is None:
        path.unlink()
    else:
        path.write_text(json.dumps(json.loads(path.read_text()) | change))
    assert run(["check"]) == 2
    assert text in capsys.readouterr().err


def test_a_difference_is_found_at_its_place() -> None:
    before = {"joints": [{"axis": [0.0, 1.0]}], "name": "door"}
    assert first_difference(before, before) == ""
    assert first_difference(before, {**before, "joints": [{"axis": [0.0, 0.5]}]}) == (
        "/joints/0/axis/1: 1.0 before, 0.5 now"
    )
    assert first_difference(before, {"name": "door"}) == "/joints: only before"
    assert first_difference(before, {"name": "door", "joints": before["joints"]}) == ": keys in another order"
    assert first_difference([1], [1, 2]) == ": 1 items before, 2 now"
