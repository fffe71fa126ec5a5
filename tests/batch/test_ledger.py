"""Lines of a ledger: whole after a kill, none of them half written on a full disk."""

from __future__ import annotations

import resource
from pathlib import Path

import pytest

from kinematify.batch.ledger import Ledger
from kinematify.errors import OutputError


def test_half_a_line_of_a_killed_run_is_dropped(tmp_path: Path) -> None:
    path = tmp_path / "lines.jsonl"
    path.write_text('{"a": 1}\nno JSON\n[2]\n{"a": 2}\n{"a": ')
    with Ledger(path) as ledger:
        ledger.append({"a": 3})
        assert [facts["a"] for facts in ledger] == [1, 2, 3]


def test_a_full_disk_leaves_whole_lines(tmp_path: Path) -> None:
    with Ledger(tmp_path / "lines.jsonl") as ledger:
        ledger.append({"a": "x" * 80})
        soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
        try:
            resource.setrlimit(resource.RLIMIT_FSIZE, (100, hard))
            with pytest.raises(OutputError, match=r"lines.jsonl.* disk with space"):
                ledger.append({"a": "y" * 80})
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        ledger.append({"a": "z"})
        assert [facts["a"][0] for facts in ledger] == ["x", "z"]


def test_lines_are_replaced_as_a_whole(tmp_path: Path) -> None:
    path = tmp_path / "lines.jsonl"
    with Ledger(path) as ledger:
        ledger.append({"a": 1})
        ledger.rewrite([{"a": 2}])
        ledger.append({"a": 3})
    assert path.read_text() == '{"a": 2}\n{"a": 3}\n'
    assert [entry.name for entry in tmp_path.iterdir()] == ["lines.jsonl"]


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with (
        pytest.raises(OutputError, match=r"cannot be kept in .*file/lines.jsonl"),
        Ledger(tmp_path / "file/lines.jsonl"),
    ):
        pass
