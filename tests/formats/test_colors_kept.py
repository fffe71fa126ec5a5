"""What an object looks like goes from its file through the model to every format."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import trimesh
from PIL import Image

from kinematify.assembly.load import load_assembly
from kinematify.config import load_config
from kinematify.contact.tree import KinematicTree
from kinematify.formats.export_model import export
from kinematify.joints.candidate import JointEstimate
from kinematify.model.build import build_model
from kinematify.model.urdf import write_urdf
from kinematify.robot.joint_type import JointType
from kinematify.robot.mesh_file import read_meshes
from tests.colored_objects import (
    dressed,
    make_object,
    seen_of_glb,
    seen_of_mjcf,
    seen_of_urdf,
    seen_of_usd,
    unlike,
)

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly
    from kinematify.model.kinematic_model import KinematicModel


def _box(size: float, x: float) -> trimesh.Trimesh:
    box: trimesh.Trimesh = trimesh.creation.box((size, size, size))
    for _ in range(3):
        box = box.subdivide()
    box.apply_translation((x, 0.0, 0.0))
    return box


def _model(assembly: Assembly) -> KinematicModel:
    """The parts one behind the other on slides."""
    tree = KinematicTree(parents=tuple(range(-1, len(assembly.parts) - 1)))
    joints = [
        JointEstimate(
            parent=parent,
            child=child,
            kind=JointType.PRISMATIC,
            axis=np.array([0.0, 0.0, 1.0]),
            pivot=assembly.parts[child].centroid,
            lower=0.0,
            upper=0.1,
            confidence=1.0,
            alternatives=(),
            evidence={},
        )
        for parent, child in tree.edges()
    ]
    return build_model(assembly, tree, joints, name="object", config=load_config().model)


@pytest.mark.parametrize("seed", range(6))
def test_a_glb_keeps_its_colours_in_the_urdf_and_as_glb(seed: int, tmp_path: Path) -> None:
    path = make_object(seed, tmp_path)
    given = seen_of_glb(path)
    urdf = write_urdf(_model(load_assembly(path)), tmp_path)
    out = tmp_path / "out.glb"
    assert not any("materials" in loss.what for loss in export(urdf, "glb", out).lost)
    assert unlike(given, seen_of_glb(out)) < 0.01
    assert unlike(given, seen_of_urdf(urdf)) < 0.03, "rounded places in a picture"


@pytest.mark.parametrize("seed", range(2))
def test_mjcf_and_usd_have_the_colours_and_the_textures(seed: int, tmp_path: Path) -> None:
    path = make_object(seed, tmp_path)
    urdf = write_urdf(_model(load_assembly(path)), tmp_path)
    export(urdf, "mjcf", tmp_path / "out.xml")
    export(urdf, "usd", tmp_path / "out.usda")
    assert unlike(seen_of_glb(path), seen_of_mjcf(tmp_path / "out.xml")) < 0.01
    assert unlike(seen_of_glb(path), seen_of_usd(tmp_path / "out.usda")) < 0.01


def _colors(path: Path) -> list[list[tuple[float, ...]]]:
    """The colours of every part of a file, in steps of a tenth."""
    meshes = read_meshes(path, appearance=True)
    assert all(mesh.appearance is not None for mesh in meshes)
    return [
        sorted({tuple(np.round(item.color, 1).tolist()) for item in mesh.appearance.materials})
        for mesh in meshes
        if mesh.appearance is not None
    ]


_TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"


def test_materials_of_an_obj_are_read_and_what_is_missing_is_reported(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(
        f"mtllib a.mtl\n{_TETRAHEDRON}vt 0 0\nvt 1 0\nvt 0 1\no box\nusemtl paint\nf 1 2 3\nusemtl wood\n"
        "f 1/1 2/2 4/3\nf 1/1 3/2 4/3\nusemtl paint\nf 2 3 4\n",
        encoding="utf-8",
    )
    (tmp_path / "a.mtl").write_text(
        "newmtl paint\nKd 0.1 0.2 0.9\nd 0.5\nnewmtl wood\nKd 1 1 1\nmap_Kd wood.png\n", encoding="utf-8"
    )
    (mesh,) = read_meshes(tmp_path / "a.obj", appearance=True)
    assert mesh.appearance is not None
    assert mesh.appearance.notes == ("the texture wood.png is not there",)
    assert [mesh.appearance.materials[k].name for k in mesh.appearance.material_of_face] == [
        "paint", "wood", "wood", "paint",
    ]  # fmt: skip
    assert _colors(tmp_path / "a.obj") == [[(0.1, 0.2, 0.9, 0.5), (1.0, 1.0, 1.0, 1.0)]]
    Image.new("RGB", (4, 4), (200, 0, 0)).save(tmp_path / "wood.png")
    (mesh,) = read_meshes(tmp_path / "a.obj", appearance=True)
    assert mesh.appearance is not None
    assert not mesh.appearance.notes
    assert mesh.appearance.colors_at(np.array([1]), np.full((1, 3), 1 / 3))[0, 0] == pytest.approx(200 / 255)


def test_colours_of_vertices_of_obj_and_ply_are_read(tmp_path: Path) -> None:
    words = [f"v {x} {y} {z} 0.9 0.1 0.1" for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))]
    (tmp_path / "a.obj").write_text("\n".join([*words, "f 1 2 3", "f 1 2 4", ""]), encoding="utf-8")
    assert _colors(tmp_path / "a.obj") == [[(0.9, 0.1, 0.1, 1.0)]]
    box = trimesh.creation.box()
    box.visual = trimesh.visual.ColorVisuals(box, vertex_colors=np.tile([[26, 230, 26, 255]], (8, 1)))
    box.export(tmp_path / "a.ply")
    assert _colors(tmp_path / "a.ply") == [[(0.1, 0.9, 0.1, 1.0)]]


def test_colours_of_collada_are_read(tmp_path: Path) -> None:
    box = dressed(_box(0.2, 0.0), "plain", np.random.default_rng(1))
    visual: Any = box.visual
    stated = visual.material.baseColorFactor
    written: Any = trimesh.exchange.dae.export_collada
    (tmp_path / "a.dae").write_bytes(written(box))
    (found,) = _colors(tmp_path / "a.dae")
    assert found[0] == pytest.approx(np.array(stated) / 255.0, abs=0.06)


def test_colours_of_3mf_are_read(tmp_path: Path) -> None:
    written: Any = trimesh.creation.box().export
    (tmp_path / "plain.3mf").write_bytes(written(file_type="3mf"))
    with zipfile.ZipFile(tmp_path / "plain.3mf") as given, zipfile.ZipFile(tmp_path / "a.3mf", "w") as made:
        for name in given.namelist():
            text = given.read(name)
            if name.endswith(".model"):
                bases = b'<basematerials id="77"><base name="red" displaycolor="#E61A1A"/></basematerials>'
                text = re.sub(rb"(<(?:\w+:)?resources[^>]*>)", rb"\1" + bases, text, count=1)
                text = re.sub(rb"<((?:\w+:)?object) ", rb'<\1 pid="77" pindex="0" ', text, count=1)
            made.writestr(name, text)
    assert _colors(tmp_path / "a.3mf") == [[(0.9, 0.1, 0.1, 1.0)]]
    assert read_meshes(tmp_path / "plain.3mf", appearance=True)[0].appearance is None


def test_a_file_of_thousands_of_materials_keeps_colours_that_are_near(tmp_path: Path) -> None:
    box = _box(0.2, 0.0)
    random = np.random.default_rng(5)
    materials = [f"newmtl m{k}\nKd {r:.3f} {g:.3f} {b:.3f}\n" for k, (r, g, b) in enumerate(random.random((5000, 3)))]
    (tmp_path / "many.mtl").write_text("".join(materials), encoding="utf-8")
    lines = ["mtllib many.mtl\n", *(f"v {x} {y} {z}\n" for x, y, z in box.vertices.tolist())]
    for part, start in (("low", 0.0), ("high", 1.0)):
        lines += [f"o {part}\n", *(f"v {x} {y} {z + start}\n" for x, y, z in box.vertices.tolist())]
    count = len(box.vertices)
    for part, place in (("low", 1), ("high", 2)):
        lines.append(f"o {part}\n")
        for number, (a, b, c) in enumerate((box.faces + 1 + place * count).tolist()):
            lines.append(f"usemtl m{number + 700 * place}\nf {a} {b} {c}\n")
    (tmp_path / "many.obj").write_text("".join(lines), encoding="utf-8")
    assembly = load_assembly(tmp_path / "many.obj")
    assert any("more than 64 materials" in warning for warning in assembly.warnings)
    assert all(part.appearance and len(part.appearance.materials) <= 64 for part in assembly.parts)
