"""What `make check` runs for a change."""

from __future__ import annotations

import pytest

from tests.places import ROOT
from tools.affected_tests import affected_tests, changed_files


def affected(path: str) -> set[str]:
    return {file.relative_to(ROOT).as_posix() for file in affected_tests([ROOT / path])}


@pytest.mark.parametrize(
    ("changed", "test"),
    [
        ("kinematify/vision/votes.py", "tests/vision/test_vision.py"),
        ("kinematify/cli/erase.py", "tests/cli/test_cli_erase.py"),  # commands are loaded late, by their names
        ("validation/finding.py", "tests/validation/test_feedback.py"),  # behind a symlink
        ("kinematify/generate/procedural/pieces/fronts.py", "tests/generate/procedural/test_families.py"),
        ("tests/known.py", "tests/joints/test_kind.py"),
        ("tests/joints/test_kind.py", "tests/joints/test_kind.py"),
        ("configs/paper.yaml", "tests/assembly/test_load.py"),
        ("CONTRIBUTING.md", "tests/test_readme.py"),
        ("validation/formats/assets/viewer.js", "tests/validation/test_formats.py"),
    ],
)
def test_a_change_reaches_its_tests(changed: str, test: str) -> None:
    assert test in affected(changed)


def test_a_change_of_one_package_leaves_most_tests_out() -> None:
    found = affected("kinematify/vision/votes.py")
    assert "tests/geometry/test_surface.py" not in found
    assert len(found) < 10


def test_what_nothing_names_reaches_no_test() -> None:
    assert affected("named" + ".nowhere") == set()


def test_a_base_that_does_not_exist_is_reported() -> None:
    with pytest.raises(SystemExit, match="git merge-base no-such-branch HEAD failed"):
        changed_files("no-such-branch")
