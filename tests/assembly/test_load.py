"""Every form of input, every complaint about it, and what is set aside instead of lost."""

from __future__ import annotations

import base64
import io
import json
import os
import stat
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
import trimesh

from kinematify.assembly.load import load_assembly
from kinematify.config import load_config
from kinematify.errors import AssemblyError, InputError
from kinematify.robot.weld import welded

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly
    from kinematify.config import AssemblyConfig

CONFIG = load_config().assembly


def changed(**values: object) -> AssemblyConfig:
    return CONFIG.model_copy(update=values)


def box(x: float = 0.0, size: float = 1.0) -> trimesh.Trimesh:
    """A box of 1 x 2 x 3 `size`, which tells the axes apart, with its corner at (x, 0, 0)."""
    return trimesh.creation.box(bounds=[[x, 0, 0], [x + size, 2 * size, 3 * size]])


def scene(names: tuple[str, ...] = ("body", "door")) -> trimesh.Scene:
    """Instances of one box, each 2 m further along x by its node's transform."""
    made = trimesh.Scene()
    for k, name in enumerate(names):
        made.add_geometry(
            box(),
            node_name=name,
            geom_name="shape",
            transform=trimesh.transformations.translation_matrix([2.0 * k, 0, 0]),
        )
    return made


def folder_of(path: Path, **meshes: trimesh.Trimesh) -> Path:
    path.mkdir(exist_ok=True)
    for name, mesh in meshes.items():
        mesh.export(path / f"{name}.obj")
    return path


def zipped(path: Path, files: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


def obj(mesh: trimesh.Trimesh) -> bytes:
    return str(mesh.export(file_type="obj")).encode()


def load(path: Path, config: AssemblyConfig = CONFIG, **options: object) -> Assembly:
    return load_assembly(path, config=config, **options)  # type: ignore[arg-type]


# ---- forms of input -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", ["glb", "gltf"])
def test_gltf_nodes_are_parts_with_their_transforms_and_z_up(tmp_path: Path, suffix: str) -> None:
    if suffix == "glb":
        scene().export(tmp_path / "a.glb")
    else:
        for name, content in scene().export(file_type="gltf").items():
            (tmp_path / name).write_bytes(content)
    loaded = load(next(tmp_path.glob("*.gl*f" if suffix == "gltf" else "*.glb")))
    assert loaded.names == ("body", "door")
    np.testing.assert_allclose(loaded.parts[0].bounds, [[0, -3, 0], [1, 0, 2]], atol=1e-6)
    np.testing.assert_allclose(loaded.parts[1].bounds, [[2, -3, 0], [3, 0, 2]], atol=1e-6)


def test_up_axis_and_scale_can_be_given(tmp_path: Path) -> None:
    scene().export(tmp_path / "a.glb")
    upright = load(tmp_path / "a.glb", up="z", scale=0.1)
    np.testing.assert_allclose(upright.parts[0].bounds, [[0, 0, 0], [0.1, 0.2, 0.3]], atol=1e-6)
    folder = folder_of(tmp_path / "parts", a=box(), b=box(2))
    np.testing.assert_allclose(load(folder, up="y").parts[0].bounds, [[0, -3, 0], [1, 0, 2]], atol=1e-6)
    np.testing.assert_allclose(load(folder).parts[0].bounds, [[0, 0, 0], [1, 2, 3]], atol=1e-6)


def cabinet(z: float, front: float) -> trimesh.Scene:
    """Two bodies and a handle in front of them, z up, on the height `z`, the front at y = `front`."""
    made = trimesh.Scene()
    made.add_geometry(trimesh.creation.box(bounds=[[0, front, z], [1, front + 0.5, z + 0.8]]), node_name="body")
    made.add_geometry(trimesh.creation.box(bounds=[[1, front, z], [2, front + 0.5, z + 0.8]]), node_name="door")
    knob = [[1.4, front - 0.03, z + 0.3], [1.44, front, z + 0.34]]
    made.add_geometry(trimesh.creation.box(bounds=knob), node_name="knob")
    return made


@pytest.mark.parametrize(
    ("z", "front", "words"),
    [(0.0, -0.25, "lowest point is at z = 0"), (-0.4, -0.25, "broad foot"), (0.7, 0.2, "broad foot")],
)
def test_a_gltf_file_that_looks_z_up_is_reported_with_the_remedy(
    z: float, front: float, words: str, tmp_path: Path
) -> None:
    made = cabinet(z, front)
    made.export(tmp_path / "a.glb")
    (warning,) = load(tmp_path / "a.glb").warnings
    assert words in warning
    assert "--up z" in warning
    assert load(tmp_path / "a.glb", up="z").warnings == ()
    made.apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, (1, 0, 0)))
    made.export(tmp_path / "b.glb")
    assert load(tmp_path / "b.glb").warnings == (), "with y up, as the standard says"


@pytest.mark.parametrize("up", ["x", "y", "-z"])
def test_whatever_points_up_points_to_z(tmp_path: Path, up: str) -> None:
    """A long arrow of boxes along the given axis stands on z, and no part is mirrored."""
    sign, axis = (-1.0, up[1]) if up.startswith("-") else (1.0, up)
    way = sign * np.eye(3)["xyz".index(axis)]
    near, far = (trimesh.creation.box((0.1, 0.2, 0.3)).apply_translation(k * way) for k in (1.0, 5.0))
    loaded = load(folder_of(tmp_path / "parts", near=near, far=far), up=up)
    middles = {part.name: part.bounds.mean(axis=0) for part in loaded.parts}
    np.testing.assert_allclose(middles["far"] - middles["near"], [0, 0, 4], atol=1e-6)
    assert all(trimesh.Trimesh(part.vertices, part.faces).volume > 0 for part in loaded.parts)


def test_gltf_node_with_two_materials_is_one_part(tmp_path: Path) -> None:
    """Two primitives of one mesh, as every modelling program writes them for two materials."""
    tree = json.loads(scene().export(file_type="gltf")["model.gltf"])
    files = scene().export(file_type="gltf")
    tree["meshes"][0]["primitives"] = tree["meshes"][0]["primitives"] * 2
    files["model.gltf"] = json.dumps(tree).encode()
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    assert load(tmp_path / "model.gltf").names == ("body", "door")


@pytest.mark.parametrize("suffix", ["obj", "stl", "ply", "off"])
def test_folder_gives_one_part_per_file(tmp_path: Path, suffix: str) -> None:
    for k in (10, 9, 1):
        both = trimesh.util.concatenate([box(1.5 * k), box(1.5 * k + 1.5)])  # pieces of one file stay together
        both.export(tmp_path / f"part_{k}.{suffix}")
    loaded = load(tmp_path)
    assert loaded.names == ("part_1", "part_9", "part_10")
    np.testing.assert_allclose(loaded.parts[0].bounds, [[1.5, 0, 0], [4, 2, 3]], atol=1e-6)
    assert all(len(part.faces) == 24 for part in loaded.parts)


@pytest.mark.parametrize("word", ["o", "g"])
def test_obj_objects_and_groups_are_parts(tmp_path: Path, word: str) -> None:
    text = io.StringIO()
    for k, name in enumerate(("body", "left door")):
        mesh = box(2.0 * k)
        text.write(f"{word} {name}\nusemtl m\n")
        text.writelines(f"v {x} {y} {z} 0.5 0.5 0.5\nvn 0 0 1\n" for x, y, z in mesh.vertices)
        text.writelines(f"f {a}/1/1 {b}//2 {c}\n" for a, b, c in mesh.faces + 1 + 8 * k)
    (tmp_path / "a.obj").write_text(text.getvalue())
    loaded = load(tmp_path / "a.obj")
    assert loaded.names == ("body", "left_door")
    assert loaded.original_names["left_door"] == "left door"
    np.testing.assert_allclose(loaded.parts[1].bounds, [[2, 0, 0], [3, 2, 3]])


def test_obj_polygons_and_indices_that_count_back(tmp_path: Path) -> None:
    square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\n"
    raised = square.replace("0\n", "5\n")
    (tmp_path / "a.obj").write_text(f"g one\n{square}g two\n{raised}")
    loaded = load(tmp_path / "a.obj")
    assert [part.area for part in loaded.parts] == [1.0, 1.0]
    assert [part.bounds[0, 2] for part in loaded.parts] == [0.0, 5.0]


def test_collada_nodes_are_parts_and_its_up_axis_and_unit_are_respected(tmp_path: Path) -> None:
    corners = box().vertices.reshape(-1).tolist()
    faces = box().faces.reshape(-1).tolist()
    pieces = "".join(
        '<triangles count="6"><input semantic="VERTEX" source="#v" offset="0"/>'
        f"<p>{' '.join(map(str, half))}</p></triangles>"
        for half in (faces[:18], faces[18:])
    )
    nodes = "".join(
        f'<node id="ID{k}" name="{name}"><translate>{2 * k} 0 0</translate><instance_geometry url="#box"/></node>'
        for k, name in enumerate(("body", "door"))
    )
    (tmp_path / "a.dae").write_text(
        '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="0.01"/>'
        '<up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="box"><mesh><source id="p">'
        f'<float_array id="a" count="{len(corners)}">{" ".join(map(str, corners))}</float_array><technique_common>'
        f'<accessor source="#a" count="{len(corners) // 3}" stride="3"><param name="X" type="float"/>'
        '<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>'
        '<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
        f"{pieces}</mesh></geometry></library_geometries><library_visual_scenes>"
        f'<visual_scene id="s">{nodes}</visual_scene></library_visual_scenes><scene>'
        '<instance_visual_scene url="#s"/></scene></COLLADA>'
    )
    loaded = load(tmp_path / "a.dae")
    assert loaded.names == ("body", "door"), "a node of two materials is one part"
    assert [len(part.faces) for part in loaded.parts] == [12, 12]
    assert np.allclose(loaded.parts[0].bounds, [[0.0, -0.03, 0.0], [0.01, 0.0, 0.02]]), "y points up, centimetres"
    assert np.allclose(load(tmp_path / "a.dae", up="z").parts[0].bounds[1], [0.01, 0.02, 0.03])


def test_3mf_objects_are_parts_in_the_unit_that_the_file_states_unless_a_scale_is_given(tmp_path: Path) -> None:
    scene().export(tmp_path / "a.3mf")
    loaded, raw = load(tmp_path / "a.3mf"), load(tmp_path / "a.3mf", scale=1.0)
    assert loaded.names == ("body", "door")
    assert loaded.lengths == "millimetres (stated by the file or its format)"
    assert np.allclose(loaded.bounds, 1e-3 * raw.bounds)
    assert raw.lengths == "1 m per unit (--scale)"
    (tmp_path / "parts").mkdir()
    for name, x in (("a", 0.0), ("b", 3000.0)):
        box(x).export(tmp_path / "parts" / f"{name}.3mf")
    assert load(tmp_path / "parts").lengths == "millimetres (stated by the file or its format)", "in a folder as well"


@pytest.mark.parametrize(
    ("factor", "scale", "reported", "remedy"),
    [
        (1000.0, 1.0, "2 km long", "2 m long: give --scale 0.001"),
        (25.0, 1.0, "50 m long", "50 mm long: give --scale 0.001"),
        (25.0, 0.0001, "5 mm long", ""),
        (25.0, 0.00001, "0.5 mm long", "500 mm long: give --scale 0.01"),
        (1.0, 1.0, "", ""),
    ],
)
def test_an_unusual_size_is_reported_with_the_guess_and_the_remedy(
    tmp_path: Path, factor: float, scale: float, reported: str, remedy: str
) -> None:
    given = trimesh.util.concatenate([box(0), box(3)])  # 4 m long
    given.apply_scale(0.5 * factor)
    given.export(tmp_path / "a.stl")
    warnings = load(tmp_path / "a.stl", scale=scale).warnings
    if not remedy:
        assert not warnings
    else:
        assert any(reported in warning and remedy in warning for warning in warnings)


@pytest.mark.parametrize(("factor", "metres", "read_as"), [(100.0, 0.4, "millimetres"), (1.0, 4.0, "metres")])
def test_a_long_object_without_a_unit_is_in_millimetres(
    tmp_path: Path, factor: float, metres: float, read_as: str
) -> None:
    given = trimesh.util.concatenate([box(0), box(3)])  # 4 units long
    given.apply_scale(factor)
    for suffix in ("stl", "obj", "ply", "off"):
        given.export(tmp_path / f"a.{suffix}")
        loaded = load(tmp_path / f"a.{suffix}")
        assert np.ptp(loaded.bounds, axis=0).max() == pytest.approx(metres)
        assert loaded.lengths.startswith(read_as)
        assert "--scale" in loaded.lengths
    trimesh.Scene([given]).export(tmp_path / "a.glb")
    assert np.ptp(load(tmp_path / "a.glb").bounds, axis=0).max() == pytest.approx(4.0 * factor), "glTF is in metres"


def test_one_mesh_without_labels_falls_into_its_pieces(tmp_path: Path) -> None:
    trimesh.util.concatenate([box(9), box(0), box(3)]).export(tmp_path / "a.stl")
    loaded = load(tmp_path / "a.stl")
    assert loaded.names == ("piece_000", "piece_001", "piece_002")
    assert [part.bounds[0, 0] for part in loaded.parts] == [9.0, 0.0, 3.0]
    assert all(len(part.vertices) == 8 for part in loaded.parts)


def test_parts_of_any_form_are_pieces_where_they_are_to_be_grouped(tmp_path: Path) -> None:
    folder = folder_of(tmp_path / "parts", body=trimesh.util.concatenate([box(), box(3)]), door=box(6))
    assert load_assembly(folder).segmented
    pieces = load_assembly(folder, pieces="group")
    assert not pieces.segmented
    assert pieces.names == ("body", "body_2", "door")
    assert set(pieces.original_names.values()) == {"body", "door"}


@pytest.mark.parametrize("form", ["npy", "list", "dict", "texts"])
def test_labels_cut_one_mesh(tmp_path: Path, form: str) -> None:
    trimesh.util.concatenate([box(0), box(1), box(2)]).export(tmp_path / "a.ply")
    values = [7] * 12 + [10] * 12 + [7] * 12
    labels = tmp_path / ("l.npy" if form == "npy" else "l.json")
    if form == "npy":
        np.save(labels, np.array(values, dtype=np.uint8))
    elif form == "texts":
        labels.write_text(json.dumps(["hand le" if value == 7 else "body" for value in values]))
    else:
        labels.write_text(json.dumps(values if form == "list" else {"labels": values}))
    loaded = load(tmp_path / "a.ply", labels=labels)
    assert loaded.names == (("body", "hand_le") if form == "texts" else ("part_7", "part_10"))
    assert sorted(len(part.faces) for part in loaded.parts) == [12, 24]


def test_urdf_gives_rigid_groups_at_rest(tmp_path: Path) -> None:
    box().export(tmp_path / "m.stl")
    shape = '<visual><geometry><mesh filename="m.stl"/></geometry></visual>'
    (tmp_path / "r.urdf").write_text(
        f'<robot name="r"><link name="world"/><link name="base">{shape}</link><link name="lid">{shape}</link>'
        '<joint name="f" type="fixed"><parent link="world"/><child link="base"/></joint>'
        '<joint name="j" type="prismatic"><parent link="base"/><child link="lid"/><axis xyz="1 0 0"/>'
        '<limit lower="2" upper="4" effort="1" velocity="1"/></joint></robot>'
    )
    loaded = load(tmp_path / "r.urdf")
    assert loaded.names == ("base", "lid")
    np.testing.assert_allclose(loaded.parts[1].bounds, [[3, 0, 0], [4, 2, 3]])
    (tmp_path / "m.stl").unlink()
    refused(tmp_path, r"give the description .*r\.urdf")


@pytest.mark.parametrize("form", ["folder", "file", "urdf"])
def test_zip_of_every_form(tmp_path: Path, form: str) -> None:
    if form == "folder":
        files = {"x/a.obj": obj(box()), "x/b.obj": obj(box(3)), "x/notes.txt": b"", "__MACOSX/x/._a.obj": b"junk"}
    elif form == "file":
        files = {"all.glb": scene().export(file_type="glb")}
    else:
        mesh = '<visual><geometry><mesh filename="package://pkg/m/{}.obj"/></geometry></visual>'
        text = (
            f'<robot name="r"><link name="a">{mesh.format("a")}</link><link name="b">{mesh.format("b")}</link>'
            '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>'
        )
        files = {"pkg/urdf/r.urdf": text.encode(), "pkg/m/a.obj": obj(box()), "pkg/m/b.obj": obj(box(3))}
    loaded = load(zipped(tmp_path / "a.zip", files))
    assert loaded.names == (("body", "door") if form == "file" else ("a", "b"))
    assert loaded.source == str(tmp_path / "a.zip")


def test_truth_is_never_opened(tmp_path: Path) -> None:
    folder = folder_of(tmp_path / "parts", a=box(), b=box(3))
    for truth in (tmp_path / "parts.truth.json", folder / "a.truth.json"):
        truth.write_text("not even JSON")
        truth.chmod(0)
    assert load(folder).names == ("a", "b")
    with pytest.raises(AssemblyError, match="no labels file"):
        load(folder / "a.obj", labels=folder / "a.truth.json")


def test_other_files_are_named_in_a_warning(tmp_path: Path) -> None:
    folder = folder_of(tmp_path, a=box(), b=box(3))
    for name in ("c.fbx", "a.mtl", "wood.png", ".hidden"):
        (folder / name).write_text("")
    (folder / "more").mkdir()
    assert load(folder).warnings == ("Not read, because they are no mesh files: c.fbx, more.",)


def test_gltf_matrix_rotation_scale_and_mirror(tmp_path: Path) -> None:
    """Every way to state a transform, two levels deep, against the product of the matrices."""
    files = scene(("one", "two", "three")).export(file_type="gltf")
    tree = json.loads(files["model.gltf"])
    mesh = next(node["mesh"] for node in tree["nodes"] if "mesh" in node)
    half = 0.5**0.5
    tree["nodes"] = [
        {"name": "up", "rotation": [half, 0, 0, half], "translation": [0, 0, 5], "children": [1, 2]},
        {"name": "one", "mesh": mesh, "scale": [-1, 1, 2]},
        {"name": "two", "mesh": mesh, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1], "camera": 0},
    ]
    tree["scenes"], tree["scene"] = [{"nodes": [0]}], 0
    files["model.gltf"] = json.dumps(tree).encode()
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    loaded = load(tmp_path / "model.gltf", up="z")
    np.testing.assert_allclose(loaded.parts[0].bounds, [[-1, -6, 5], [0, 0, 7]], atol=1e-6)
    np.testing.assert_allclose(loaded.parts[1].bounds, [[7, -3, 5], [8, 0, 7]], atol=1e-6)
    volumes = [trimesh.Trimesh(part.vertices, part.faces).volume for part in loaded.parts]
    assert volumes == pytest.approx([12.0, 6.0])


@pytest.mark.parametrize(("mode", "corners"), [(5, [0, 1, 2, 3]), (6, [0, 1, 3, 2])])
def test_gltf_strips_and_fans(tmp_path: Path, mode: int, corners: list[int]) -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], dtype="<f4")
    data = points.tobytes() + np.array(corners, dtype="<u2").tobytes()
    views = [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 8}]
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5123, "count": 4, "type": "SCALAR"},
    ]
    primitive = {"attributes": {"POSITION": 0}, "indices": 1, "mode": mode}
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 56, "uri": "data:;base64," + base64.b64encode(data).decode()}],
        "bufferViews": views,
        "accessors": accessors,
        "meshes": [{"name": "sheet", "primitives": [primitive]}],
        "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 1]}],
    }
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    loaded = load(tmp_path / "a.gltf", up="z")
    assert loaded.names == ("sheet", "sheet_2")
    for part in loaded.parts:
        a, b, c = (part.vertices[part.faces[:, k]] for k in range(3))
        np.testing.assert_allclose(np.cross(b - a, c - a), [[0, 0, 1], [0, 0, 1]])  # no triangle is turned over


def test_gltf_that_would_be_misread_is_refused(tmp_path: Path) -> None:
    files = scene().export(file_type="gltf")
    tree = json.loads(files["model.gltf"])
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    for change, message in (
        ({"extensionsRequired": ["EXT_unknown"]}, "needs the extension EXT_unknown"),
        ({"buffers": [{"uri": "../secret.bin", "byteLength": 9}] * len(tree["buffers"])}, "outside of its folder"),
        ({"nodes": [{"children": [0], "mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0}, "no tree"),
        ({"accessors": [{**item, "count": 10**9} for item in tree["accessors"]]}, "cannot be read"),
    ):
        (tmp_path / "model.gltf").write_text(json.dumps({**tree, **change}))
        refused(tmp_path / "model.gltf", message)


# ---- names ----------------------------------------------------------------------------------------------------------


def test_names_are_made_safe_and_recorded(tmp_path: Path) -> None:
    names = ("körper/links 1", "körper links_1", "门", "WORLD", "a" * 300)
    scene(names).export(tmp_path / "a.glb")
    loaded = load(tmp_path / "a.glb")
    assert loaded.names == ("WORLD_part", "a" * 64, "korper_links_1", "korper_links_1_2", "part")
    assert loaded.original_names["part"] == "门"
    assert sorted(loaded.original_names.values()) == sorted(names)


# ---- what is set aside ----------------------------------------------------------------------------------------------

EMPTY = "v 0 0 0\n"
LINE = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3\nf 2 3 4\n"
POINT = "v 8 1 1\nv 8 1 1\nv 8 1 1\nf 1 2 3\n"
NO_AREA = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
NO_AREA += "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 1 1\n2 2 2\n3 0 1 2\n"
TRIANGLE = "v 8 0 0\nv 8 1 0\nv 8 0 1\nf 1 2 3\n"
SHEET = "v 8 0 0\nv 8 1 0\nv 8 1 1\nv 8 0 1\nf 1 2 3\nf 1 3 4\n"


@pytest.mark.parametrize(
    ("content", "reason", "nearest"),
    [
        (EMPTY, "no triangle", "z_large"),
        (LINE, "no area", "a"),
        (POINT, "no area", "b"),
        (TRIANGLE, "3 distinct vertices", "b"),
        (obj(box(4.5, 1e-6)).decode(), "largest extent", "b"),
    ],
)
def test_degenerate_parts_are_set_aside_by_name(tmp_path: Path, content: str, reason: str, nearest: str) -> None:
    folder = folder_of(tmp_path, a=box(), b=box(6), z_large=box(100, 10))
    (folder / "odd one.obj").write_text(content)
    loaded = load(folder)
    assert loaded.names == ("a", "b", "z_large")
    (item,) = loaded.set_aside
    assert reason in item.reason
    assert item.nearest == nearest
    assert item.part.name == "odd_one"
    assert loaded.original_names["odd_one"] == "odd one"


def test_a_sheet_is_a_part(tmp_path: Path) -> None:
    folder = folder_of(tmp_path, a=box())
    (folder / "sheet.obj").write_text(SHEET)
    assert load(folder).names == ("a", "sheet")


def test_the_same_part_twice_is_used_once(tmp_path: Path) -> None:
    again = box()
    again.vertices = again.vertices[::-1] + 1e-9
    again.faces = 7 - again.faces[::-1]
    loaded = load(folder_of(tmp_path, a=box(), b=box(3), c=again))
    assert loaded.names == ("a", "b")
    assert loaded.set_aside[0].nearest == "a"
    assert "the same mesh" in loaded.set_aside[0].reason
    assert loaded.warnings == ("The part c is a once more; only a is used.",)


def test_heavy_parts_are_thinned_and_kept_in_full(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(subdivisions=4)
    ball.apply_translation([9, 0, 0])
    loaded = load(folder_of(tmp_path, a=box(), ball=ball), changed(max_part_faces=1000))
    thin = loaded.parts[1]
    assert 500 < len(thin.faces) <= 1000
    assert thin.area == pytest.approx(ball.area, rel=0.02)
    assert set(loaded.originals) == {"ball"}
    assert len(loaded.originals["ball"].faces) == 5120
    assert "5120 triangles" in loaded.warnings[0]


def test_welding_joins_only_what_is_near() -> None:
    vertices = np.array(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 5e-8, 0], [0, 1 + 5e-8, 0], [1, 1, 0], [7, 7, 7], [1e-5, 0, 0]]
    )
    faces = np.array([[0, 1, 2], [3, 5, 4], [0, 7, 2], [1, 3, 2], [0, 0, 1]])
    points, triangles = welded(vertices, faces, 1e-7)
    np.testing.assert_array_equal(points, vertices[[0, 1, 2, 5, 7]])
    np.testing.assert_array_equal(triangles, [[0, 1, 2], [1, 3, 2], [0, 4, 2]])


# ---- complaints -----------------------------------------------------------------------------------------------------


def refused(path: Path, message: str, config: AssemblyConfig = CONFIG, **options: object) -> None:
    with pytest.raises(AssemblyError, match=message) as caught:
        load(path, config, **options)
    assert "\n" not in str(caught.value)


def test_missing_and_empty(tmp_path: Path) -> None:
    refused(tmp_path / "none.obj", r"There is no file or folder .*none\.obj")
    refused(tmp_path, "holds no mesh file")
    (tmp_path / "a.iges").write_text("")
    refused(tmp_path / "a.iges", r"a\.iges is not an input.*\.glb")
    for suffix in ("obj", "stl", "ply", "off", "glb", "gltf", "3mf"):
        (tmp_path / f"a.{suffix}").write_bytes(b"")
        refused(tmp_path / f"a.{suffix}", rf"a\.{suffix} cannot be read as a \.{suffix} mesh")


def test_one_part_only(tmp_path: Path) -> None:
    refused(folder_of(tmp_path, only=box()), "1 usable part.*--labels")
    refused(tmp_path / "only.obj", "1 usable part")
    folder_of(tmp_path, twin=box())
    refused(tmp_path, "1 usable part.*twin: It is the same mesh")
    (tmp_path / "only.obj").write_text(LINE)
    (tmp_path / "twin.obj").write_text(EMPTY)
    refused(tmp_path, "No part .* with area")
    (tmp_path / "pieces.ply").write_text(NO_AREA)
    refused(tmp_path / "pieces.ply", "No part .* with area")


@pytest.mark.parametrize("suffix", ["obj", "stl", "ply", "off", "glb", "gltf", "3mf"])
def test_nonsense_is_no_mesh(tmp_path: Path, suffix: str) -> None:
    folder = folder_of(tmp_path, good=box(), fine=box(3))
    (folder / f"bad.{suffix}").write_bytes(b"This is a letter, not a mesh.\n" * 40)
    refused(folder, rf"bad\.{suffix} cannot be read")


@pytest.mark.parametrize("suffix", ["glb", "stl", "ply", "3mf"])
@pytest.mark.parametrize("share", [0.1, 0.99])
def test_truncated_files(tmp_path: Path, suffix: str, share: float, capfd: pytest.CaptureFixture[str]) -> None:
    content = scene().export(file_type="glb") if suffix in ("glb", "3mf") else box().export(file_type=suffix)
    if suffix == "3mf":
        content = scene().export(file_type="3mf")
    (tmp_path / f"a.{suffix}").write_bytes(content[: int(share * len(content))])
    refused(tmp_path / f"a.{suffix}", rf"a\.{suffix} .*truncated")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("number", ["nan", "inf"])
def test_coordinates_that_are_not_finite(tmp_path: Path, number: str) -> None:
    folder = folder_of(tmp_path, good=box())
    (folder / "bad.obj").write_text(SHEET.replace("v 8 0 0", f"v 8 {number} 0"))
    refused(folder, "part 'bad' of .* 1 vertices .*not finite")
    refused(folder / "bad.obj", r"of .*bad\.obj .*not finite")


def test_unused_vertices_may_be_anything(tmp_path: Path) -> None:
    folder = folder_of(tmp_path, good=box())
    (folder / "fine.obj").write_text(SHEET + "v nan nan nan\n")
    assert load(folder).names == ("fine", "good")


def test_impossible_indices(tmp_path: Path) -> None:
    folder = folder_of(tmp_path, good=box())
    for line in ("f 1 2 99", "f 0 1 2", "f -99 1 2", "f 1 2", "f 1 2 x", "v 1 2", "v 1 2 x"):
        (folder / "bad.obj").write_text(f"{SHEET}{line}\n")
        refused(folder, r"bad\.obj cannot be read")


def test_too_much(tmp_path: Path) -> None:
    many = trimesh.util.concatenate([box(2.0 * k) for k in range(6)])
    many.export(tmp_path / "many.stl")
    refused(tmp_path / "many.stl", "6 parts; at most 5", changed(max_parts=5))
    refused(tmp_path / "many.stl", "72 triangles; at most 70", changed(max_faces=70))
    refused(tmp_path / "many.stl", "3684 bytes; at most 1000", changed(max_archive_bytes=1000))
    refused(
        folder_of(tmp_path / "f", **{f"p{k}": box(2.0 * k) for k in range(6)}), "6 mesh files", changed(max_parts=5)
    )


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("l.json", "[1, 2]", "one label per triangle"),
        ("l.json", "{}", "cannot be read"),
        ("l.json", "[1", "cannot be read"),
        ("l.json", '[1, "a"]', "cannot be read"),
        ("l.json", "[0.5, 0.5]", "must be integers"),
        ("l.npy", "nonsense", "cannot be read"),
        ("l.txt", "", "no labels file"),
    ],
)
def test_bad_labels(tmp_path: Path, name: str, content: str, message: str) -> None:
    box().export(tmp_path / "a.stl")
    (tmp_path / name).write_text(content)
    refused(tmp_path / "a.stl", message, labels=tmp_path / name)


def test_labels_for_several_parts(tmp_path: Path) -> None:
    refused(folder_of(tmp_path, a=box(), b=box(3)), "Leave --labels out", labels=tmp_path / "l.npy")


def test_pickled_labels_are_not_executed(tmp_path: Path) -> None:
    box().export(tmp_path / "a.stl")
    np.save(tmp_path / "l.npy", np.array([{}] * 12, dtype=object), allow_pickle=True)
    refused(tmp_path / "a.stl", "cannot be read", labels=tmp_path / "l.npy")


@pytest.mark.parametrize("options", [{"up": "w"}, {"scale": 0.0}, {"scale": -1.0}, {"scale": float("nan")}])
def test_bad_arguments(tmp_path: Path, options: dict[str, object]) -> None:
    with pytest.raises(InputError, match=r"Choose|Give"):
        load(tmp_path, **options)


# ---- archives -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["../evil.obj", "x/../../evil.obj", "/evil.obj", "..\\evil.obj", "C:\\evil.obj"])
def test_archive_cannot_write_outside(tmp_path: Path, name: str) -> None:
    path = zipped(tmp_path / "a.zip", {"a.obj": obj(box()), name: obj(box(3))})
    refused(path, r"a\.zip holds .*evil\.obj.*outside")
    assert list(tmp_path.rglob("evil*")) == []


def test_archive_with_a_link(tmp_path: Path) -> None:
    entry = zipfile.ZipInfo("a.obj")
    entry.external_attr = (stat.S_IFLNK | 0o777) << 16
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr(entry, "/etc/passwd")
    refused(tmp_path / "a.zip", "outside")


@pytest.mark.parametrize("suffix", ["zip", "3mf"])
def test_decompression_bomb(tmp_path: Path, suffix: str) -> None:
    path = zipped(tmp_path / f"a.{suffix}", {"a.obj": bytes(5_000_000), "b.obj": obj(box())})
    assert path.stat().st_size < 20_000
    refused(path, "more than 1000000 bytes", changed(max_archive_bytes=1_000_000))


def test_archive_that_lies_about_its_sizes(tmp_path: Path) -> None:
    path = zipped(tmp_path / "a.zip", {"a.obj": bytes(3_000_000), "b.obj": obj(box())})
    content = path.read_bytes()
    lie = content.replace((3_000_000).to_bytes(4, "little"), (100).to_bytes(4, "little"))
    assert lie != content
    path.write_bytes(lie)
    refused(path, "cannot be unpacked")


def test_unusable_archives(tmp_path: Path) -> None:
    (tmp_path / "a.zip").write_bytes(b"not a zip")
    refused(tmp_path / "a.zip", "cannot be unpacked")
    refused(zipped(tmp_path / "b.zip", {}), "holds mesh files in 0 folders")
    refused(zipped(tmp_path / "c.zip", {"x/a.obj": obj(box()), "y/b.obj": obj(box(3))}), "2 folders")
    refused(zipped(tmp_path / "d.zip", {"a.obj": b"junk", "b.obj": obj(box(3))}), r"d\.zip: The file a\.obj cannot")


def test_a_gltf_buffer_that_is_a_pipe_or_a_device_is_missing(tmp_path: Path) -> None:
    for name, content in scene().export(file_type="gltf").items():
        (tmp_path / name).write_bytes(content)
    buffer = next(tmp_path.glob("*.bin"))
    buffer.unlink()
    os.mkfifo(buffer)
    with pytest.raises(AssemblyError, match="buffer"):
        load(tmp_path / "model.gltf")
