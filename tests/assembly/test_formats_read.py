"""What formats of meshes hold is read, or refused by name: polygons, skins, compression, slicers, structure, places."""

from __future__ import annotations

import json
import struct
import sys
import zipfile
from itertools import pairwise
from pathlib import Path
from typing import Any

import DracoPy
import meshopt
import numpy as np
import pytest
import trimesh

from kinematify.assembly.load import load_assembly
from kinematify.assembly.part import Part
from kinematify.errors import AssemblyError, EnvironmentFault
from kinematify.robot.mesh_file import read_meshes
from kinematify.robot.weld import is_closed

U = np.array([[0, 0], [0.3, 0], [0.6, 0], [0.6, 0.4], [0.58, 0.4], [0.58, 0.02], [0.02, 0.02], [0.02, 0.4], [0, 0.4]])
"""A wall seen from above, with a corner on a straight edge."""
RINGS = [[*range(8, -1, -1)], [*range(9, 18)], *([k, (k + 1) % 9, (k + 1) % 9 + 9, k + 9] for k in range(9))]
POINTS = np.concatenate([np.insert(U, 2, z, axis=1) for z in (0.0, 0.26)])


def u_shape(path: Path) -> Path:
    """Two concave polygons and nine quads, in the format of the suffix."""
    rows = "\n".join(f"{x} {y} {z}" for x, y, z in POINTS)
    faces = "\n".join(f"{len(ring)} {' '.join(map(str, ring))}" for ring in RINGS)
    path.write_text(
        {
            ".obj": "\n".join(
                [*(f"v {x} {y} {z}" for x, y, z in POINTS), *(f"f {' '.join(str(k + 1) for k in r)}" for r in RINGS)]
            ),
            ".off": f"OFF\n18 11 0\n{rows}\n{faces}\n",
            ".ply": "ply\nformat ascii 1.0\nelement vertex 18\nproperty float x\nproperty float y\nproperty float z\n"
            f"element face 11\nproperty list uchar int vertex_indices\nend_header\n{rows}\n{faces}\n",
            ".dae": '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>'
            '<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="54">'
            f'{rows}</float_array><technique_common><accessor source="#a" count="18" stride="3">'
            '<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>'
            '</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
            '<polylist count="11"><input semantic="VERTEX" source="#v" offset="0"/><vcount>'
            f"{' '.join(str(len(r)) for r in RINGS)}</vcount><p>{' '.join(str(k) for r in RINGS for k in r)}</p>"
            "</polylist></mesh></geometry></library_geometries><library_visual_scenes>"
            '<visual_scene id="s"><node name="wall"><instance_geometry url="#g"/></node></visual_scene>'
            '</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>',
        }[path.suffix]
    )
    return path


@pytest.mark.parametrize("suffix", ["obj", "off", "ply", "dae"])
def test_triangles_lie_inside_of_concave_polygons(tmp_path: Path, suffix: str) -> None:
    (mesh,) = read_meshes(u_shape(tmp_path / f"u.{suffix}"), appearance=True)
    area = Part(name="u", vertices=mesh.vertices, faces=mesh.faces).area
    assert area == pytest.approx(0.772), "two polygons of 0.0272 and walls of 0.26 around 2.76"
    assert is_closed(mesh.vertices, mesh.faces)
    assert len(mesh.faces) == 2 * 7 + 2 * 9
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).volume == pytest.approx((0.6 * 0.4 - 0.56 * 0.38) * 0.26)


BOXES = {
    "body": [(0, 0, 0, 0.6, 0.4, 0.02), (0, 0, 0.02, 0.02, 0.4, 0.8), (0.58, 0, 0.02, 0.6, 0.4, 0.8)],
    "door": [(0.03, -0.02, 0.4, 0.57, 0, 0.79), (0.5, -0.05, 0.5, 0.52, -0.02, 0.7)],
    "drawer": [(0.03, -0.02, 0.03, 0.57, 0, 0.39), (0.04, 0, 0.03, 0.56, 0.3, 0.05)],
}


def boxes(name: str) -> list[trimesh.Trimesh]:
    return [trimesh.creation.box(bounds=np.reshape(box, (2, 3))) for box in BOXES[name]]


def whole(name: str) -> trimesh.Trimesh:
    return trimesh.util.concatenate(boxes(name))


def obj_text(groups: list[tuple[str, trimesh.Trimesh]], offset: Any = 0.0) -> str:
    lines, count = [], 1
    for head, mesh in groups:
        lines.append(head)
        lines += [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in mesh.vertices + offset]
        lines += [f"f {a} {b} {c}" for a, b, c in mesh.faces + count]
        count += len(mesh.vertices)
    return "\n".join(lines) + "\n"


def test_obj_lines_go_on_behind_a_backslash_and_what_is_not_read_is_listed(tmp_path: Path) -> None:
    plain = obj_text([(f"o parts\\{name}", whole(name)) for name in BOXES])
    (tmp_path / "a.obj").write_text("\ufeff" + plain, encoding="utf-8")
    odd = (
        plain.replace(" 0.400000\n", " 0.400000 # note\r\n").replace(" 0.02", " \\\n  0.02").replace("f 1 ", "f 1 \\\n")
    )
    (tmp_path / "b.obj").write_text(odd + "curv 0 1 1 2\nl 1 2\n", newline="")
    one, other = load_assembly(tmp_path / "a.obj"), load_assembly(tmp_path / "b.obj")
    assert one.names == other.names == ("parts_body", "parts_door", "parts_drawer")
    assert [part.mesh_hash for part in one.parts] == [part.mesh_hash for part in other.parts]
    assert other.warnings == ("Not read of the file: lines that begin with curv; lines that begin with l.",)


# ---- glTF -----------------------------------------------------------------------------------------------------------


class Gltf:
    """A document that grows by arrays."""

    def __init__(self) -> None:
        self.data = b""
        self.document: dict[str, Any] = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": []}

    def view(self, content: bytes) -> int:
        content += bytes(-len(content) % 4)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)})
        self.data += content
        return len(self.document["bufferViews"]) - 1

    def accessor(self, values: Any, kind: str, dtype: str, **more: Any) -> int:
        array = np.asarray(values, dtype=dtype)
        number = {"<f4": 5126, "<u2": 5123, "<u4": 5125, "<u1": 5121}[dtype]
        stated = {"componentType": number, "type": kind, "count": len(array), **more}
        self.document["accessors"].append(stated if more else {"bufferView": self.view(array.tobytes()), **stated})
        return len(self.document["accessors"]) - 1

    def primitive(self, mesh: trimesh.Trimesh, **more: Any) -> dict[str, Any]:
        position = self.accessor(mesh.vertices, "VEC3", "<f4")
        indices = self.accessor(mesh.faces.reshape(-1), "SCALAR", "<u4")
        return {"attributes": {"POSITION": position}, "indices": indices, **more}

    def write(self, path: Path, **document: Any) -> Path:
        text = json.dumps({**self.document, "buffers": [{"byteLength": len(self.data)}], **document}).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(self.data), 0x4E4942)
        content = chunks + self.data
        path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(content)) + content)
        return path


def test_joints_of_a_skin_are_rigid_parts_at_its_rest_whatever_its_node_says(tmp_path: Path) -> None:
    """Bones lie elsewhere and are turned; inverse bind matrices bring the mesh to where it is seen."""
    file = Gltf()
    meshes = [whole(name) for name in BOXES]
    together = trimesh.util.concatenate(meshes)
    bound = np.repeat(np.arange(3), [len(mesh.vertices) for mesh in meshes])
    primitive = file.primitive(together)
    joints = np.column_stack([bound, np.zeros((len(bound), 3))])
    primitive["attributes"]["JOINTS_0"] = file.accessor(joints, "VEC4", "<u1")
    primitive["attributes"]["WEIGHTS_0"] = file.accessor(np.eye(4)[np.zeros(len(bound), int)], "VEC4", "<f4")
    bones = [trimesh.transformations.rotation_matrix(k, [0, 1, 0], [k, 2, 3]) for k in range(3)]
    inverse = [np.linalg.inv(bone).T.reshape(-1) for bone in bones]
    skin = {"joints": [0, 1, 2], "inverseBindMatrices": file.accessor(inverse, "MAT4", "<f4")}
    nodes = [{"name": name, "matrix": bone.T.reshape(-1).tolist()} for name, bone in zip(BOXES, bones, strict=True)]
    nodes += [{"children": [0, 1, 2, 4]}, {"name": "Cabinet", "mesh": 0, "skin": 0, "scale": [100, 100, 100]}]
    content = {"nodes": nodes, "meshes": [{"primitives": [primitive]}], "skins": [skin], "scenes": [{"nodes": [3]}]}
    loaded = load_assembly(file.write(tmp_path / "a.glb", **content, animations=[{}]), up="z")
    assert loaded.names == ("body", "door", "drawer")
    for part, mesh in zip(loaded.parts, meshes, strict=True):
        np.testing.assert_allclose(part.bounds, mesh.bounds, atol=1e-5)
    assert loaded.warnings == ("Not read of the file: 1 animations.",)


@pytest.mark.parametrize("way", ["sparse", "morph", "instances", "draco", "meshopt"])
def test_whatever_way_gltf_stores_positions(tmp_path: Path, way: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two boxes, the second 3 m to the right."""
    file, mesh = Gltf(), trimesh.creation.box((1, 1, 1))
    moved = mesh.vertices + np.array([3, 0, 0])
    first, second = {"name": "left", "mesh": 0}, {"name": "right", "mesh": 1}
    primitive = file.primitive(mesh)
    other = json.loads(json.dumps(primitive))
    package = {"draco": "DracoPy", "meshopt": "meshopt"}.get(way, "")
    if way == "sparse":
        sparse = {
            "count": 8,
            "indices": {"bufferView": file.view(np.arange(8, dtype="<u2").tobytes()), "componentType": 5123},
            "values": {"bufferView": file.view(moved.astype("<f4").tobytes())},
        }
        other["attributes"]["POSITION"] = file.accessor(moved, "VEC3", "<f4", sparse=sparse)
    elif way == "morph":
        other["targets"] = [{"POSITION": file.accessor(np.tile([6.0, 0, 0], (8, 1)), "VEC3", "<f4")}]
        second["weights"] = [0.5]
    elif way == "instances":
        places = {"TRANSLATION": file.accessor([[3.0, 0, 0]], "VEC3", "<f4")}
        second["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": places}}
    elif way == "draco":
        packed = DracoPy.encode(moved.astype("f4"), mesh.faces.astype("u4"), preserve_order=True, quantization_bits=16)
        other["extensions"] = {
            "KHR_draco_mesh_compression": {"bufferView": file.view(packed), "attributes": {"POSITION": 0}}
        }
        other["attributes"]["POSITION"] = file.accessor(moved, "VEC3", "<f4", min=[0])
        other["indices"] = file.accessor(mesh.faces.reshape(-1), "SCALAR", "<u4", min=[0])
    else:
        packed = bytes(meshopt.encode_gltf_buffer(moved.astype("<f4").view("u1"), "ATTRIBUTES"))
        place = file.view(packed)
        stated = {
            "buffer": 0,
            "byteOffset": file.document["bufferViews"][place]["byteOffset"],
            "byteLength": len(packed),
        }
        stated |= {"byteStride": 12, "count": 8, "mode": "ATTRIBUTES"}
        file.document["bufferViews"].append(
            {"buffer": 0, "byteLength": 96, "extensions": {"EXT_meshopt_compression": stated}}
        )
        other["attributes"]["POSITION"] = file.accessor(moved, "VEC3", "<f4", bufferView=place + 1)
    content = {"nodes": [first, second], "meshes": [{"primitives": [primitive]}, {"primitives": [other]}]}
    path = file.write(tmp_path / "a.glb", **content)
    loaded = load_assembly(path, up="z")
    np.testing.assert_allclose(loaded.parts[1].bounds, [[2.5, -0.5, -0.5], [3.5, 0.5, 0.5]], atol=1e-4)
    if package:
        monkeypatch.setitem(sys.modules, package, None)
        with pytest.raises(EnvironmentFault, match=rf"needs {package}, not installed here.*install .*{package}"):
            load_assembly(path)


# ---- 3MF ------------------------------------------------------------------------------------------------------------

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
HEAD = '<?xml version="1.0" encoding="UTF-8"?>'
TYPES = (
    f'{HEAD}<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" '
    'ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" '
    'ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
)


def relations(target: str) -> str:
    kind = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
    return (
        f'{HEAD}<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship '
        f'Target="{target}" Id="r" Type="{kind}"/></Relationships>'
    )


def mesh_object(number: int, mesh: trimesh.Trimesh, **attributes: str) -> str:
    stated = " ".join(f'{key}="{value}"' for key, value in {"type": "model", **attributes}.items())
    points = "".join(f'<vertex x="{x:.4f}" y="{y:.4f}" z="{z:.4f}"/>' for x, y, z in 1000.0 * mesh.vertices)
    faces = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in mesh.faces)
    shape = f"<mesh><vertices>{points}</vertices><triangles>{faces}</triangles></mesh>"
    return f'<object id="{number}" {stated}>{shape}</object>'


def threemf(path: Path, resources: str, items: str, extra: str = "", **files: str) -> Path:
    content = f"<resources>{resources}</resources><build>{items}</build>"
    model = f'{HEAD}<model unit="millimeter" xmlns="{CORE}" {extra}>{content}'
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", TYPES)
        archive.writestr("_rels/.rels", relations("/3D/3dmodel.model"))
        archive.writestr("3D/3dmodel.model", f"{model}</model>")
        for name, text in files.items():
            archive.writestr(name, text)
    return path


PRODUCTION = 'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" requiredextensions="p"'


def test_parts_of_a_slicers_3mf_lie_in_files_of_their_own_and_are_named_by_its_settings(tmp_path: Path) -> None:
    inner = "".join(mesh_object(k, whole(name)) for k, name in enumerate(BOXES, start=1))
    inner += mesh_object(4, whole("door"))
    files = {
        "3D/_rels/3dmodel.model.rels": relations("/3D/Objects/a.model"),
        "3D/Objects/a.model": f'{HEAD}<model unit="millimeter" xmlns="{CORE}" {PRODUCTION}>'
        f"<resources>{inner}</resources>"
        "<build/></model>",
        "Metadata/model_settings.config": f'{HEAD}<config><object id="8"><metadata key="name" value="cabinet"/>'
        + "".join(
            f'<part id="{k}" subtype="{kind}"><metadata key="name" value="{name}"/></part>'
            for k, (name, kind) in enumerate(
                [
                    ("body.stl", "normal_part"),
                    ("C:\\x\\door.step", "normal_part"),
                    ("drawer", "normal_part"),
                    ("hole", "negative_part"),
                ],
                start=1,
            )
        )
        + "</object></config>",
    }
    components = "".join(
        f'<component p:path="/3D/Objects/a.model" objectid="{k}" transform="1 0 0 0 1 0 0 0 1 {x} 0 0"/>'
        for k, x in ((1, 0), (2, 0), (3, 5), (4, 0))
    )
    path = threemf(
        tmp_path / "a.3mf",
        f'<object id="8" type="model"><components>{components}</components></object>',
        '<item objectid="8" transform="1 0 0 0 1 0 0 0 1 100 0 0"/>',
        PRODUCTION,
        **files,
    )
    loaded = load_assembly(path)
    assert loaded.names == ("body", "door", "drawer")
    np.testing.assert_allclose(loaded.parts[0].bounds, whole("body").bounds + np.array([0.1, 0, 0]), atol=1e-6)
    np.testing.assert_allclose(loaded.parts[2].bounds, whole("drawer").bounds + np.array([0.105, 0, 0]), atol=1e-6)
    assert loaded.warnings == ("Not read of the file: the negative_part hole.",)


def test_triangles_of_a_3mf_are_parts_where_the_slicer_says_so(tmp_path: Path) -> None:
    ends = np.cumsum([0, *(len(whole(name).faces) for name in BOXES)])
    volumes = "".join(
        f'<volume firstid="{start}" lastid="{end - 1}"><metadata type="volume" key="name" value="{name}.stl"/>'
        '<metadata type="volume" key="volume_type" value="ModelPart"/></volume>'
        for name, (start, end) in zip(BOXES, pairwise(ends), strict=True)
    )
    settings = {"Metadata/Slic3r_PE_model.config": f'{HEAD}<config><object id="1">{volumes}</object></config>'}
    together = trimesh.util.concatenate([whole(name) for name in BOXES])
    path = threemf(tmp_path / "a.3mf", mesh_object(1, together), '<item objectid="1"/>', **settings)
    loaded = load_assembly(path)
    assert loaded.names == tuple(BOXES)
    assert [len(part.faces) for part in loaded.parts] == np.diff(ends).tolist()


@pytest.mark.parametrize(
    ("resources", "extra", "message"),
    [
        (mesh_object(1, whole("door")), 'xmlns:zz="http://example.com/zz" requiredextensions="zz"', "extension .*zz"),
        ("bomb", "", "more than 10000 times"),
        ('<object id="1"><components><component objectid="1"/></components></object>', "", "cannot be read"),
        (mesh_object(1, whole("door")).replace('v1="0"', 'v1="9999"', 1), "", "cannot be read"),
    ],
)
def test_3mf_that_cannot_be_read_is_refused(tmp_path: Path, resources: str, extra: str, message: str) -> None:
    last = 1
    if resources == "bomb":
        last = 12
        resources = mesh_object(1, whole("door")) + "".join(
            f'<object id="{k}"><components>{f"""<component objectid="{k - 1}"/>""" * 10}</components></object>'
            for k in range(2, 13)
        )
    with pytest.raises(AssemblyError, match=message):
        load_assembly(threemf(tmp_path / "a.3mf", resources, f'<item objectid="{last}"/>', extra))


# ---- structure, places, archives ------------------------------------------------------------------------------------


def test_names_of_an_obj_group_beside_the_number_of_its_mesh_are_parts(tmp_path: Path) -> None:
    groups = [
        (f"g Mesh{10 * k + j} {name} Model\nusemtl mat{j % 2}", mesh)
        for k, name in enumerate(BOXES)
        for j, mesh in enumerate(boxes(name))
    ]
    (tmp_path / "a.obj").write_text(obj_text(groups))
    loaded = load_assembly(tmp_path / "a.obj")
    assert loaded.names == tuple(BOXES)
    assert "door (Mesh10 door Model, Mesh11 door Model)" in loaded.warnings[0]
    assert len(load_assembly(tmp_path / "a.obj", pieces="keep").parts) == 7
    words = [
        (f"g {side} {name}", mesh) for name in ("door", "drawer") for side, mesh in zip("ab", boxes(name), strict=True)
    ]
    (tmp_path / "b.obj").write_text(obj_text(words))
    assert load_assembly(tmp_path / "b.obj").names == ("a_door", "a_drawer", "b_door", "b_drawer"), "names of two words"
    twice = [(f"o {side}\ng panel", mesh) for side, mesh in zip(("left", "right"), boxes("door"), strict=True)]
    (tmp_path / "c.obj").write_text(obj_text(twice))
    assert load_assembly(tmp_path / "c.obj").names == ("left_panel", "right_panel"), "groups of two objects"


@pytest.mark.parametrize("own", ["Object_{n}", "{parent}_{material}_0", ""])
def test_gltf_nodes_that_an_exporter_split_are_named_and_joined_by_their_parents(tmp_path: Path, own: str) -> None:
    file = Gltf()
    file.document["materials"] = [{"name": "wood"}, {"name": "metal"}]
    nodes: list[dict[str, Any]] = [{"name": "RootNode", "children": []}]
    meshes = []
    for name in BOXES:
        nodes[0]["children"].append(len(nodes))
        nodes.append(parent := {"name": name, "children": []})
        parts = [whole("body")] if name == "body" else boxes(name)
        for material, mesh in enumerate(parts):
            parent["children"].append(len(nodes))
            called = own.format(n=len(nodes), parent=name, material=("wood", "metal")[material])
            nodes.append({"mesh": len(meshes), **({"name": called} if called else {})})
            meshes.append({"primitives": [file.primitive(mesh, material=material)]})
    content = {"nodes": nodes, "meshes": meshes, "scenes": [{"nodes": [0]}]}
    assert load_assembly(file.write(tmp_path / "a.glb", **content), up="z").names == tuple(BOXES)


@pytest.mark.parametrize("kind", ["faces", "materials", "numbers"])
def test_groups_that_are_pieces_are_grouped_or_reported(tmp_path: Path, kind: str) -> None:
    """The sides of boxes, the faces of one material, or boxes that are numbered."""
    if kind == "numbers":
        groups = [(f"g Mesh{k}", mesh) for k, mesh in enumerate(m for name in (*BOXES, *BOXES) for m in boxes(name))]
        for k, (_, mesh) in enumerate(groups):
            mesh.apply_translation([0, 2.0 * (k > 6), 0])
    else:
        every = [mesh for name in BOXES for mesh in boxes(name)]
        sides = [mesh.submesh([np.arange(12)[k % 2 :: 2]], append=True) for mesh in every for k in range(2)]
        groups = [(f"g side{k}", side) for k, side in enumerate(sides)]
        if kind == "materials":
            (tmp_path / "a.mtl").write_text("newmtl wood\nnewmtl metal\n")
            halves = [trimesh.util.concatenate(sides[k::2]) for k in range(2)]
            groups = [
                (f"{head}g {name}\nusemtl {name}", half)
                for head, name, half in zip(("mtllib a.mtl\n", ""), ("wood", "metal"), halves, strict=True)
            ]
    (tmp_path / "a.obj").write_text(obj_text(groups))
    loaded = load_assembly(tmp_path / "a.obj")
    assert loaded.segmented == (kind == "numbers")
    assert len(loaded.parts) == (14 if kind == "numbers" else 7)
    assert "--pieces group" in loaded.warnings[-1] if kind == "numbers" else "--pieces keep" in loaded.warnings[-1]


def test_an_object_in_coordinates_of_a_survey_is_stored_about_its_own_centre(tmp_path: Path) -> None:
    text = [(f"o {name}", whole(name)) for name in BOXES]
    (tmp_path / "near.obj").write_text(obj_text(text))
    survey = np.array([432100.25, 5418300.5, 120.0])
    (tmp_path / "far.obj").write_text(obj_text(text, survey))
    near, far = load_assembly(tmp_path / "near.obj"), load_assembly(tmp_path / "far.obj")
    assert near.warnings == ()
    assert np.abs(far.bounds).max() < 1.0
    np.testing.assert_allclose(np.ptp(far.bounds, axis=0), np.ptp(near.bounds, axis=0), atol=1e-6)
    (said,) = far.warnings
    centre = np.array([float(word) for word in said.partition("(")[2].partition(")")[0].split(",")])
    np.testing.assert_allclose(far.bounds + centre, near.bounds + survey, atol=1e-6)
