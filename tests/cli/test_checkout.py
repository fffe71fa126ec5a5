"""`benchmarks/` beside the package: found, or refused with one message and exit status 2."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import benchmarks
import kinematify
from kinematify.cli.app import run
from kinematify.evaluation import checkout
from tests.places import ROOT


def test_the_checkout_is_of_one_version() -> None:
    assert kinematify.__version__ == benchmarks.KINEMATIFY_VERSION
    assert checkout.has_benchmarks()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "needs the folder benchmarks/"),
        ('"""Benchmarks of another project."""\n', "needs the folder benchmarks/"),
        ('KINEMATIFY_VERSION = "0.0.1"\n', "belongs to version 0.0.1, and this is Kinematify"),
    ],
    ids=["absent", "of another project", "of another version"],
)
def test_what_is_not_ours_is_refused(
    text: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    if text:
        (tmp_path / "benchmarks").mkdir()
        (tmp_path / "benchmarks" / "__init__.py").write_text(text)
    monkeypatch.setattr(checkout, "ROOT", tmp_path)
    monkeypatch.chdir(tmp_path)
    for words in (["bench", "--list"], ["bench", "detection"]):
        assert run(words) == 2
        captured = capsys.readouterr()
        assert captured.out == ""
        assert message in captured.err


def test_it_is_found_from_any_folder(tmp_path: Path) -> None:
    """Even where the folder holds another package of that name."""
    (tmp_path / "benchmarks").mkdir()
    (tmp_path / "benchmarks" / "__init__.py").write_text("")
    code = f"import sys; sys.path.append({str(ROOT)!r}); from kinematify.cli.app import run; run(['bench', '--list'])"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "detection" in done.stdout
