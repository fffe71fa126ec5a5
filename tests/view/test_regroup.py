"""Parts are merged and named in the viewer, and the command that is shown infers the same parts."""

from __future__ import annotations

import json
import shlex
from typing import TYPE_CHECKING

import pytest

from kinematify.cli.app import run
from kinematify.errors import InputError
from kinematify.view.keep import ModelFolder
from tests.one_mesh import write_bin_with_lid
from tests.view.pages import candidates_in

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A model of one mesh: a box of boards with a lid that has a knob; boards are one part, lid and knob another."""
    mesh, groups = tmp_path / "bin.ply", tmp_path / "groups.json"
    write_bin_with_lid(mesh)
    parts = [[f"piece_{k:03d}" for k in range(5)], ["piece_005", "piece_006"]]
    groups.write_text(json.dumps({"parts": [{"pieces": part} for part in parts]}), encoding="utf-8")
    words = [
        "infer",
        mesh,
        "-o",
        tmp_path / "model",
        "--groups",
        groups,
        "--up",
        "z",
        "--no-preview",
        "--no-validation",
    ]
    assert run([str(word) for word in words]) == 0
    return tmp_path / "model"


def pieces_of(folder: Path) -> set[frozenset[str]]:
    stated = json.loads((folder / "groups.json").read_text(encoding="utf-8"))
    return {frozenset(part["pieces"]) for part in stated["parts"]}


def test_parts_are_merged_the_command_does_the_same_and_that_can_be_undone(folder: Path) -> None:
    before = pieces_of(folder)
    apart = json.loads((folder / "groups.json").read_text(encoding="utf-8"))
    apart["parts"] = [{"pieces": [f"piece_{k:03d}" for k in range(5)]}]
    groups = folder.parent / "apart.json"
    groups.write_text(json.dumps(apart), encoding="utf-8")
    mesh, out = folder.parent / "bin.ply", folder.parent / "apart"
    words = [
        "infer",
        str(mesh),
        "-o",
        str(out),
        "--groups",
        str(groups),
        "--up",
        "z",
        "--no-preview",
        "--no-validation",
    ]
    assert run(words) == 0
    assert {child for _, child in candidates_in(out)} == {"piece_005", "piece_006"}
    model = ModelFolder(out)
    reported = model.merge("piece_005", "piece_006")
    assert pieces_of(out) == before
    assert " --up z " in reported.command, "the mesh is read in the same manner"
    with pytest.raises(InputError, match="another one remains"):
        ModelFolder(out).merge(*{part for pair in candidates_in(out) for part in pair})
    model.undo()
    assert pieces_of(out) != before
    assert run([*shlex.split(reported.command)[1:], "--no-preview", "--no-validation"]) == 0


def test_a_name_given_on_the_page_or_in_the_file_is_that_of_the_link(folder: Path, tmp_path: Path) -> None:
    reported = ModelFolder(folder).rename("piece_005", "lid")
    assert {child for _, child in candidates_in(folder)} == {"lid"}
    pieces = {"piece_005", "piece_006"}
    stated = json.loads((folder / "groups.json").read_text(encoding="utf-8"))["parts"]
    assert {"lid": pieces} == {part["name"]: set(part["pieces"]) for part in stated if pieces & set(part["pieces"])}
    with pytest.raises(InputError, match="cannot be named"):
        ModelFolder(folder).rename("lid", "no name")
    again = tmp_path / "again"
    command = [str(again) if word == str(folder) else word for word in shlex.split(reported.command)[1:]]
    assert run([*command, "--no-preview", "--no-validation"]) == 0
    assert {child for _, child in candidates_in(again)} == {"lid"}
