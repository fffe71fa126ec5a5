"""What an object looks like goes from its file through the model to every format."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
import pytest
import trimesh
from PIL import Image
from pxr import Usd, UsdGeom, UsdShade
from scipy.spatial import cKDTree

from kinematify.assembly.load import load_assembly
from kinematify.config import load_config
from kinematify.formats.export import export
from kinematify.joints.candidate import JointEstimate
from kinematify.model.build import build_model
from kinematify.model.palette import link_colors
from kinematify.model.scene import posed_meshes
from kinematify.model.urdf import write_urdf
from kinematify.render.camera import fit_camera
from kinematify.render.picture import PictureScene, render_scene
from kinematify.robot.appearance import plain
from kinematify.robot.joint_type import JointType
from kinematify.robot.mesh_file import RawMesh, merged, read_meshes
from kinematify.robot.read import read_robot
from kinematify.topology.tree import KinematicTree

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.robot.arrays import FloatArray

_ALIKE = 0.05
"""Of the range of a channel."""


def _box(size: float, x: float) -> trimesh.Trimesh:
    box: trimesh.Trimesh = trimesh.creation.box((size, size, size))
    for _ in range(3):
        box = box.subdivide()
    box.apply_translation((x, 0.0, 0.0))
    return box


def _picture(random: np.random.Generator) -> Image.Image:
    """Four quarters of different colours, so that a turned or mirrored picture is noticed."""
    quarters = random.integers(20, 236, (2, 2, 3), dtype=np.uint8)
    return Image.fromarray(np.kron(quarters, np.ones((16, 16, 1), dtype=np.uint8)))


def _dressed(mesh: trimesh.Trimesh, kind: str, random: np.random.Generator) -> trimesh.Trimesh:
    look: Any = trimesh.visual
    color = [*random.uniform(0.05, 0.95, 3).tolist(), 1.0]
    if kind == "plain":
        mesh.visual = look.TextureVisuals(material=look.material.PBRMaterial(baseColorFactor=color, metallicFactor=0.0))
    elif kind == "texture":
        uv = mesh.vertices[:, :2] / 0.2 + 0.5
        material = look.material.PBRMaterial(baseColorTexture=_picture(random), baseColorFactor=[1.0, 1.0, 1.0, 1.0])
        mesh.visual = look.TextureVisuals(uv=uv, material=material)
    else:
        chosen = random.integers(30, 226, (3, 4))
        chosen[:, 3] = 255
        third = np.digitize(mesh.triangles_center[:, 2], (-0.03, 0.03))
        mesh.visual = look.ColorVisuals(mesh, face_colors=chosen[third].astype(np.uint8))
    return mesh


def _make(seed: int, folder: Path) -> Path:
    """A GLB of two or three boxes with colours of all kinds."""
    random = np.random.default_rng(seed)
    scene = trimesh.Scene()
    for index in range(2 + seed % 2):
        kind = ("plain", "texture", "vertices")[(seed + index) % 3]
        mesh = _dressed(_box(0.2, 0.21 * index), kind, random)
        if kind == "vertices":  # corners of their own, so that no colour is a mixture
            mesh.unmerge_vertices()
        scene.add_geometry(mesh, geom_name=f"part {index}", node_name=f"part {index}")
    path = folder / f"object_{seed}.glb"
    written: Any = scene.export
    path.write_bytes(written(file_type="glb"))
    return path


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


def _spots(mesh: RawMesh) -> tuple[FloatArray, FloatArray]:
    """Places on a mesh, three of each face, and their colours."""
    looks = mesh.appearance or plain((0.7, 0.7, 0.7, 1.0), len(mesh.faces))
    weights = np.array([[0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]])
    corners = mesh.vertices[mesh.faces]
    places = np.concatenate([np.einsum("c,fck->fk", weight, corners) for weight in weights])
    every = np.arange(len(mesh.faces))
    colors = np.concatenate([looks.colors_at(every, np.tile(weight, (len(every), 1))) for weight in weights])
    return places, colors


def _unlike(given: RawMesh, found: RawMesh) -> float:
    """Share of the places of one mesh whose colour differs at the same place of the other one."""
    places, colors = _spots(given)
    others, seen = _spots(found)
    distance, nearest = cKDTree(others).query(places)
    assert distance.max() < 1e-5, "the same shape at the same place"
    return float((np.abs(seen[nearest, :3] - colors[:, :3]).max(axis=1) > _ALIKE).mean())


def _upright(mesh: RawMesh) -> RawMesh:
    turned = mesh.vertices @ np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]).T
    return RawMesh(name=mesh.name, vertices=turned, faces=mesh.faces, appearance=mesh.appearance)


@pytest.mark.parametrize("seed", range(20))
def test_a_glb_keeps_its_colours_in_the_urdf_and_as_glb(seed: int, tmp_path: Path) -> None:
    path = _make(seed, tmp_path)
    given = _upright(merged(read_meshes(path, appearance=True), "given"))
    urdf = write_urdf(_model(load_assembly(path)), tmp_path)
    out = tmp_path / "out.glb"
    assert not any("colour" in lost for lost in export(urdf, "glb", out).lost)
    assert _unlike(given, _upright(merged(read_meshes(out, appearance=True), "out"))) < 0.01


def test_mjcf_has_the_colours_and_the_textures(tmp_path: Path) -> None:
    urdf = write_urdf(_model(load_assembly(_make(3, tmp_path))), tmp_path)
    export(urdf, "mjcf", tmp_path / "out.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out.xml"))
    seen = [geom for geom in range(model.ngeom) if model.geom_contype[geom] == 0]
    textured = [geom for geom in seen if model.geom_matid[geom] >= 0]
    assert len(textured) == 1
    assert model.ntex == 1
    stated = [shape for link in read_robot(urdf, appearance=True).links for shape in link.visuals]
    plain_one = next(s for s in stated if s.mesh.appearance and len(s.mesh.appearance.materials) == 1
                     and not s.mesh.appearance.is_textured)  # fmt: skip
    assert plain_one.color is not None
    assert any(model.geom_rgba[geom] == pytest.approx(plain_one.color, abs=1e-3) for geom in seen)
    assert len(seen) == 1 + 1 + 3, "a plain part, one with a texture, and one of three colours"


def test_usd_has_materials_with_their_textures(tmp_path: Path) -> None:
    urdf = write_urdf(_model(load_assembly(_make(3, tmp_path))), tmp_path)
    export(urdf, "usd", tmp_path / "out.usda")
    stage = Usd.Stage.Open(str(tmp_path / "out.usda"))
    shown = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh) and "/visuals/" in str(prim.GetPath())]
    assert len(shown) == 5
    assert all(UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0] for prim in shown)
    pictures = [
        UsdShade.Shader(prim).GetInput("file").Get()
        for prim in stage.Traverse()
        if prim.IsA(UsdShade.Shader) and UsdShade.Shader(prim).GetIdAttr().Get() == "UsdUVTexture"
    ]
    assert [Path(picture.resolvedPath).is_file() for picture in pictures] == [True]


def test_a_picture_shows_the_texture(tmp_path: Path) -> None:
    look: Any = trimesh.visual
    halves = np.zeros((2, 2, 3), dtype=np.uint8)
    halves[:, 0], halves[:, 1] = (220, 20, 20), (20, 20, 220)
    scene = trimesh.Scene()
    for index in range(2):
        box = _box(0.2, 0.21 * index)
        uv = (box.vertices[:, :2] - box.bounds[0, :2]) / 0.2 * 0.98 + 0.01
        material = look.material.PBRMaterial(baseColorTexture=Image.fromarray(halves))
        box.visual = look.TextureVisuals(uv=uv, material=material)
        scene.add_geometry(box, node_name=f"part {index}")
    written: Any = scene.export
    (tmp_path / "halves.glb").write_bytes(written(file_type="glb"))
    model = _model(load_assembly(tmp_path / "halves.glb"))
    shown = PictureScene(meshes=tuple(posed_meshes(model, {}, link_colors(model)).values()))
    camera = fit_camera(
        shown.outline, azimuth=-np.pi / 2, elevation=0.4, field_of_view=0.5, size=(200, 120), margin=5.0
    )
    pixels = np.asarray(render_scene(shown, camera, load_config().preview)).astype(int)
    row = pixels[60]
    reddish = np.flatnonzero(row[:, 0] > row[:, 2] + 60)
    bluish = np.flatnonzero(row[:, 2] > row[:, 0] + 60)
    assert len(reddish) > 20 and len(bluish) > 20  # noqa: PT018
    assert reddish.min() < bluish.min() < reddish.max() < bluish.max(), "red, blue, red, blue from left to right"


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


def test_materials_of_an_obj_are_read_and_what_is_missing_is_told(tmp_path: Path) -> None:
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
    box = _dressed(_box(0.2, 0.0), "plain", np.random.default_rng(1))
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
