"""Which files the words of a user stand for."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from kinematify.errors import InputError
from kinematify.validation.models import find_models


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Models at several depths, other files, and a link that leads back up."""
    for name in ("b.urdf", "a.URDF", "deep/down/c.urdf", "deep/mesh.obj", "meshes/x.stl", "meshes/y.stl"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("<robot/>")
    (tmp_path / "deep" / "up").symlink_to(tmp_path, target_is_directory=True)
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path)
    return tmp_path


def names(*words: str) -> list[str]:
    return [path.as_posix() for path in find_models(words)]


def test_a_file_is_taken_as_it_is(folder: Path) -> None:
    assert names("deep/mesh.obj") == ["deep/mesh.obj"]


def test_a_folder_stands_for_its_models_and_link_loops_do_no_harm(folder: Path) -> None:
    assert names(".") == ["a.URDF", "b.urdf", "deep/down/c.urdf"]


def test_patterns_reach_any_depth(folder: Path) -> None:
    assert names("deep/d*/*.urdf") == ["deep/down/c.urdf"]
    assert "deep/down/c.urdf" in names("**/*.urdf")
    assert names("d*p") == ["deep/down/c.urdf"]


def test_a_file_with_signs_of_a_pattern_in_its_name_is_a_file(folder: Path) -> None:
    (folder / "arm[1].urdf").write_text("<robot/>")
    assert names("arm[1].urdf") == ["arm[1].urdf"]


def test_each_model_comes_once_and_in_order(folder: Path) -> None:
    assert names("b.urdf", ".", str(folder / "b.urdf"), "deep/up/b.urdf") == ["b.urdf", "a.URDF", "deep/down/c.urdf"]


@pytest.mark.parametrize(
    ("word", "message"),
    [
        ("b.urd", r"no file or folder b\.urd\. Did you mean b\.urdf\?"),
        ("none/x.urdf", "no file or folder none/x.urdf"),
        ("meshes", r"holds no \.urdf, .* file at any depth\. It holds 2 other files \(2 with \.stl\)"),
        ("empty", "It is empty"),
        ("*.mjcf", r"Nothing matches the pattern \*\.mjcf"),
        ("emp*", "1 folders without any"),
    ],
)
def test_words_for_nothing_are_refused(folder: Path, word: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        find_models([word])


def test_a_folder_without_a_urdf_represents_its_other_descriptions(folder: Path) -> None:
    for name in ("arm.xacro", "arm.sdf"):
        (folder / "empty" / name).write_text("<robot/>")
    assert [path.name for path in find_models(["empty"])] == ["arm.sdf", "arm.xacro"]
    (folder / "empty" / "arm.urdf").write_text("<robot/>")
    assert [path.name for path in find_models(["empty"])] == ["arm.urdf"]


def test_broken_links_circles_and_pipes_are_refused(folder: Path) -> None:
    (folder / "lost.urdf").symlink_to("nowhere.urdf")
    (folder / "round.urdf").symlink_to("round.urdf")
    os.mkfifo(folder / "pipe.urdf")
    for name in ("lost.urdf", "round.urdf"):
        with pytest.raises(InputError, match="leads nowhere or in a circle"):
            find_models([name])
    with pytest.raises(InputError, match="neither a file nor a folder"):
        find_models(["pipe.urdf"])
    assert names(".") == ["a.URDF", "b.urdf", "deep/down/c.urdf"]
