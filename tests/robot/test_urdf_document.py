"""Reading the text of a URDF and finding its meshes, where files in the wild differ from the standards."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from kinematify.errors import DescriptionError
from kinematify.robot.mesh_paths import find_mesh, mesh_candidates
from kinematify.robot.urdf_text import has_doctype, parse_text, with_plain_declaration


@pytest.mark.parametrize(
    "declaration",
    [b'<?xml version="0.0" ?>', b"<?xml version='9'?>", b'\n<!-- made by hand -->\n<?xml version="1.0"?>'],
)
def test_declarations_that_other_readers_skip_do_no_harm(declaration: bytes) -> None:
    robot = parse_text(declaration + b'\n<robot name="a"/>\n\x00')
    assert robot.get("name") == "a"
    assert robot.sourceline == declaration.count(b"\n") + 2, "lines must keep their numbers"


def test_a_sound_declaration_and_its_encoding_are_kept() -> None:
    text = '<?xml version="1.0" encoding="iso-8859-1"?><robot name="Tür"/>'.encode("latin-1")
    assert with_plain_declaration(text) == text
    assert parse_text(text).get("name") == "Tür"
    assert parse_text('<robot name="Tür"/>'.encode("utf-16")).get("name") == "Tür"


def test_a_doctype_is_seen_and_its_entities_stay_closed() -> None:
    robot = parse_text(b'<!DOCTYPE robot [<!ENTITY a "b">]><robot>&a;</robot>')
    assert has_doctype(robot)
    assert (robot.text or "") == ""


def test_a_tree_as_deep_as_an_attack_is_refused() -> None:
    with pytest.raises(etree.XMLSyntaxError, match="depth"):
        parse_text(b"<robot>" + b"<link>" * 5000 + b"</link>" * 5000 + b"</robot>")


@pytest.mark.parametrize("filename", ["a" * 5000 + ".obj", "package://[x/mesh.obj", "nul%00.obj", "file:///%00"])
def test_names_that_no_file_can_have_are_missing_files(filename: str, tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match="mesh"):
        find_mesh(filename, tmp_path, (), "link a")


def test_a_package_is_looked_up_in_the_given_folders_first(tmp_path: Path) -> None:
    given = tmp_path / "packages"
    places = mesh_candidates("package://robot/meshes/a.obj", tmp_path / "robot" / "urdf", (given,), "link a")
    assert places[0] == given / "robot" / "meshes" / "a.obj"
    assert tmp_path / "robot" / "meshes" / "a.obj" in places
