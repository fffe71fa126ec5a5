"""Any mesh file becomes named triangle meshes in the file's world frame; every failure is one AssemblyError."""

from __future__ import annotations

import io
import logging
import re
import subprocess
import sys
import tempfile
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from kinematify.errors import AssemblyError, KinematifyError
from kinematify.robot.appearance import joined, painted
from kinematify.robot.exact_faces import ExactFaces, joined_faces
from kinematify.robot.gltf_file import read_gltf
from kinematify.robot.mesh_paths import CAD_SUFFIXES, GLTF_SUFFIXES, MESH_SUFFIXES
from kinematify.robot.obj_file import read_obj
from kinematify.robot.weld import without_unused
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from trimesh import Trimesh
    from trimesh.scene import Scene

    from kinematify.robot.appearance import Appearance
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.gltf_file import GltfNode


# Without a handler of its own the logger of trimesh would write to the user's terminal; a program that sets up
# logging still hears it.
logging.getLogger("trimesh").addHandler(logging.NullHandler())

TO_Z_UP = {
    "X_UP": np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]),
    "Y_UP": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
}
"""Axis that a COLLADA file may state as the one that points up -> rotation that turns it to z."""
_STL_HEADER = 84
"""Bytes before the triangles of a binary STL; the last four are their number."""
_STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


@dataclass(frozen=True, kw_only=True, eq=False)
class RawMesh:
    """A triangle mesh as it is in a file, not yet checked."""

    name: str
    """Name of the node, group or object; empty where the file names none."""
    vertices: FloatArray
    """File's world frame and unit, shape (V, 3); may hold anything, NaN included."""
    faces: IntArray
    """Shape (F, 3); every index is below V."""
    unit: str = ""
    """Unit that the file states, where it is neither metres nor converted to them."""
    up: str = ""
    """Key of `TO_Z_UP` if the file states such an axis, which was not respected."""
    appearance: Appearance | None = None
    """Of the faces; None where the file states no material and no colours, and where it was not asked for."""
    exact: ExactFaces | None = None
    """Cylinders and planes in the frame of the vertices, of this mesh and of what it was cut from; None where the file
    states none."""

    def of_faces(self, index: IntArray) -> RawMesh:
        """Return the mesh of some faces, in the order of their indices, shape (n,)."""
        appearance = None if self.appearance is None else self.appearance.of_faces(index)
        return replace(self, faces=self.faces[index], appearance=appearance)

    def moved(self, linear: FloatArray, offset: FloatArray | None = None) -> RawMesh:
        """Return the mesh after p -> linear @ p + offset, shapes (3, 3) and (3,); its faces keep their order."""
        exact = None if self.exact is None else self.exact.moved(linear, np.zeros(3) if offset is None else offset)
        turned = self.vertices @ linear.T
        return replace(self, vertices=turned if offset is None else turned + offset, exact=exact)


def read_meshes(path: Path, *, empty_ok: bool = False, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read a mesh file: one mesh per node of a scene, group of an OBJ, or object of a 3MF, transforms applied.

    COLLADA lengths are turned into metres by the unit that the file states, and its up axis is reported but ignored: so
    does RViz, in which robots are checked by eye (Pinocchio and yourdfpy ignore the unit too). Unreferenced vertices
    may remain.

    Args:
        path: A file with one of `MESH_SUFFIXES` or `CAD_SUFFIXES`.
        empty_ok: True returns a well-formed file without triangles as it is, perhaps as no mesh at all.
        appearance: Read materials, textures and colours too; what of them cannot be read is a note, not an error.

    Raises:
        AssemblyError: The file is missing, empty, truncated, of another format, or (unless `empty_ok`) holds no
            triangle.
        EnvironmentFault: It is a STEP, and cascadio is not installed.
    """
    if path.suffix.lower() not in (*MESH_SUFFIXES, *CAD_SUFFIXES):
        raise AssemblyError(
            f"The file {path} is not a mesh that can be read. Give one of {', '.join(MESH_SUFFIXES)}; convert other "
            "formats, for example with Blender."
        )
    if not path.is_file():
        raise AssemblyError(f"There is no mesh file {path}. Check the path.")
    meshes = _guarded(path, _READERS.get(path.suffix.lower(), _read_scene), appearance=appearance)
    if not empty_ok and not any(len(mesh.faces) for mesh in meshes):
        raise AssemblyError(
            f"The file {path} holds no triangle (it may be empty, a point cloud, or a drawing). Give a file with a "
            "triangle mesh."
        )
    return meshes


def compacted(mesh: RawMesh) -> RawMesh:
    """Return the mesh without vertices that no face uses."""
    vertices, faces = without_unused(mesh.vertices, mesh.faces)
    return replace(mesh, vertices=vertices, faces=faces)


def merged(meshes: tuple[RawMesh, ...], name: str) -> RawMesh:
    """Return all `meshes` as one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return RawMesh(
        name=name,
        vertices=np.concatenate([mesh.vertices for mesh in meshes]),
        faces=np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]),
        unit=meshes[0].unit if meshes else "",
        up=meshes[0].up if meshes else "",
        appearance=joined([mesh.appearance for mesh in meshes], [len(mesh.faces) for mesh in meshes]),
        exact=joined_faces([mesh.exact for mesh in meshes]),
    )


def _guarded(path: Path, read: Callable[[Path, bool], tuple[RawMesh, ...]], *, appearance: bool) -> tuple[RawMesh, ...]:
    """Run a reader; loaders of third parties fail in as many ways as there are broken files."""
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            meshes = read(path, appearance)
            _check_indices(meshes)
    except MemoryError as error:
        raise AssemblyError(f"The mesh file {path} does not fit into memory. Simplify it first.") from error
    except KinematifyError:
        raise
    except Exception as error:
        reason = f"{error}".strip().partition("\n")[0][:200] or type(error).__name__
        raise AssemblyError(
            f"The file {path} cannot be read as a {path.suffix.lower()} mesh ({reason}). It may be truncated or of "
            "another format: export it again and check that it opens in a viewer."
        ) from error
    return meshes


def _check_indices(meshes: tuple[RawMesh, ...]) -> None:
    for mesh in meshes:
        if len(mesh.faces) and not 0 <= mesh.faces.min() <= mesh.faces.max() < len(mesh.vertices):
            raise ValueError("a face refers to a vertex that the file does not hold")


def _read_obj(path: Path, appearance: bool) -> tuple[RawMesh, ...]:
    vertices, groups = read_obj(path, appearance=appearance)
    if not len(vertices):
        raise ValueError("it has no vertex")
    meshes = tuple(
        RawMesh(name=group.name, vertices=vertices, faces=group.faces, appearance=group.appearance) for group in groups
    )
    _check_indices(meshes)
    # Every group keeps its own vertices only: with thousands of groups the copies would fill the memory.
    return tuple(compacted(mesh) for mesh in meshes) if len(meshes) > 1 else meshes


def _read_stl(path: Path, appearance: bool) -> tuple[RawMesh, ...]:
    """Nearly all are binary, and those need no trimesh; it tells what is wrong with others."""
    content = path.read_bytes()
    count = int.from_bytes(content[80:84], "little")
    if not count or len(content) != _STL_HEADER + count * _STL_TRIANGLE.itemsize:
        return _read_scene(path, appearance)
    corners = np.frombuffer(content, _STL_TRIANGLE, offset=_STL_HEADER)["corners"].reshape(-1, 3)
    faces = np.arange(3 * count, dtype=np.int64).reshape(-1, 3)
    return (RawMesh(name=path.name, vertices=corners.astype(np.float64), faces=faces),)


def _read_gltf(path: Path, appearance: bool) -> tuple[RawMesh, ...]:
    return tuple(map(_of_node, read_gltf(path, appearance=appearance)))


def _read_step(path: Path, appearance: bool) -> tuple[RawMesh, ...]:
    return tuple(map(_of_node, read_step(path, appearance=appearance)))


def _of_node(node: GltfNode) -> RawMesh:
    mesh = RawMesh(
        name=node.name, vertices=node.vertices, faces=node.faces, appearance=node.appearance, exact=node.exact
    )
    return _placed(mesh, node.T_world_node)


def _read_scene(path: Path, appearance: bool) -> tuple[RawMesh, ...]:
    import trimesh  # noqa: PLC0415  # takes longer than reading an OBJ or a glTF, which need none of it

    suffix = path.suffix.lower()
    # Without `process` no vertex is merged, so that faces keep their order and labels per face stay valid.
    scene = trimesh.load_scene(path, file_type=suffix[1:], process=False, skip_materials=not appearance)
    if suffix == ".dae":
        content = io.BytesIO(path.read_bytes())
        if not scene.geometry:
            # What is bound to a material that the file does not hold is dropped with it.
            content = _without_materials(path)
            scene = trimesh.load_scene(content, file_type="dae", process=False, skip_materials=True)
        return _collada_meshes(scene, path, content, trimesh.Trimesh, appearance=appearance)
    if scene.geometry and all(isinstance(item, trimesh.PointCloud) for item in scene.geometry.values()):
        raise AssemblyError(f"The file {path} is a point cloud, which has no surface. Make a mesh of it first.")
    meshes = tuple(_scene_meshes(scene, path, trimesh.Trimesh, appearance=appearance))
    if suffix == ".stl" and not meshes and not _is_empty_stl(path):
        raise ValueError("it is neither a binary STL of the length that it states nor a complete ASCII one")
    return meshes


def _without_materials(path: Path) -> io.BytesIO:
    """A COLLADA file in which nothing is bound to a material."""
    tree = etree.parse(path, etree.XMLParser(resolve_entities=False, no_network=True))
    etree.strip_elements(tree, "{*}bind_material", with_tail=False)
    return io.BytesIO(etree.tostring(tree))


def _is_empty_stl(path: Path) -> bool:
    """True for a file that states no triangle, as opposed to one of which no triangle can be read."""
    content = path.read_bytes()
    return content == content[:80] + bytes(4) or (content.startswith(b"solid") and b"facet" not in content)


def _scene_meshes(scene: Scene, path: Path, kind: type[Trimesh], *, appearance: bool) -> Iterator[RawMesh]:
    suffix = path.suffix.lower()
    looks = _scene_appearances(scene, path) if appearance else {}
    for node in scene.graph.nodes_geometry:
        transform, key = scene.graph[node]
        geometry = scene.geometry[key]
        if not isinstance(geometry, kind):
            continue
        vertices = np.asarray(geometry.vertices, dtype=np.float64)
        faces = np.asarray(geometry.faces, dtype=np.int64)
        stated = str(geometry.metadata.get("units", "")) if suffix == ".3mf" else ""
        mesh = RawMesh(name=str(node), vertices=vertices, faces=faces, unit=stated, appearance=looks.get(str(key)))
        yield _placed(mesh, transform)


def _scene_appearances(scene: Scene, path: Path) -> dict[str, Appearance | None]:
    """Appearance of every geometry by its name."""
    from kinematify.robot.material_files import appearance_found, read_3mf_colors  # noqa: PLC0415  # opens pictures

    if path.suffix.lower() != ".3mf":
        return {key: appearance_found(item.visual, np.asarray(item.faces)) for key, item in scene.geometry.items()}
    colors = read_3mf_colors(path)
    counts = [len(item.faces) for item in scene.geometry.values()]
    if [len(item) for item, _ in colors] != counts:
        return {}  # parts of other files, in which the objects do not follow one another
    return {key: painted(item) if stated else None for key, (item, stated) in zip(scene.geometry, colors, strict=True)}


def _placed(mesh: RawMesh, transform: FloatArray) -> RawMesh:
    """Apply the transform of a node, shape (4, 4); mirroring would turn a mesh inside out."""
    if np.array_equal(transform, np.eye(4)):
        return mesh  # formats without nodes can hold millions of vertices: no copy
    moved = mesh.moved(transform[:3, :3], transform[:3, 3])
    if np.linalg.det(transform[:3, :3]) >= 0:
        return moved
    appearance = None if mesh.appearance is None else mesh.appearance.mirrored()
    return replace(moved, faces=mesh.faces[:, [0, 2, 1]], appearance=appearance)


def _collada_meshes(
    scene: Scene, path: Path, content: io.BytesIO, kind: type[Trimesh], *, appearance: bool
) -> tuple[RawMesh, ...]:
    """One mesh per node with its name, in metres; up as stated in the asset element, empty where it is silent."""
    from collada import Collada, DaeError  # noqa: PLC0415  # only COLLADA files need it

    content.seek(0)
    document = Collada(content, ignore=[DaeError])
    stated = document.assetInfo
    unit = 1.0 if stated.unitmeter is None else float(stated.unitmeter)
    up = stated.upaxis if stated.upaxis in TO_Z_UP else ""
    # The scene has a geometry of a name of its own for every piece, in the order of the document.
    nodes = document.scene.nodes if document.scene else ()
    holders = [holder for node in nodes for holder in _collada_holders(node, _Holder(""))]
    known = len(holders) == len(scene.geometry)
    holder_of = dict(zip(scene.geometry, holders, strict=True)) if known else {}
    pieces: dict[object, list[RawMesh]] = {}
    for mesh in _scene_meshes(scene, path, kind, appearance=appearance):
        pieces.setdefault(holder_of.get(mesh.name, mesh.name), []).append(mesh)
    whole = (merged(tuple(items), str(holder)) for holder, items in pieces.items())
    return tuple(replace(mesh, up=up).moved(unit * np.eye(3)) for mesh in whole)


@dataclass(frozen=True, eq=False)
class _Holder:
    """A node of a COLLADA document where it is: what is instanced twice has two."""

    name: str

    def __str__(self) -> str:
        return self.name


def _collada_holders(node: Any, holder: _Holder) -> Iterator[_Holder]:
    """The nodes that hold the pieces of triangles below a node, one per piece, as trimesh goes through them."""
    from collada.polylist import Polylist  # noqa: PLC0415
    from collada.scene import GeometryNode, Node  # noqa: PLC0415
    from collada.triangleset import TriangleSet  # noqa: PLC0415

    if isinstance(node, GeometryNode):
        for piece in node.geometry.primitives:
            triangles = piece.triangleset() if isinstance(piece, Polylist) else piece
            if isinstance(triangles, TriangleSet) and triangles.vertex is not None:
                yield holder
    elif isinstance(node, Node):
        own = _Holder(node.xmlnode.get("name") or node.id or "")
        for child in node.children or ():
            yield from _collada_holders(child, own)


_READERS = {
    ".obj": _read_obj,
    ".stl": _read_stl,
    **dict.fromkeys(GLTF_SUFFIXES, _read_gltf),
    **dict.fromkeys(CAD_SUFFIXES, _read_step),
}
"""Formats whose groups, names or exact numbers the general reader would lose, or that need none of it."""


_TURN = 0.2
"""Angle between neighbouring triangles of a round face at most [rad]: 32 around a circle."""
_SAG = 0.01
"""Distance of triangles from a curved face, as a share of the length of its edges."""
_CONVERT = """
import cascadio, sys
sys.exit(cascadio.step_to_glb(sys.argv[1], sys.argv[2], tol_linear=float(sys.argv[3]), tol_angular=float(sys.argv[4]),
                              tol_relative=True, include_brep=True, brep_types={"cylinder", "plane"}))
"""
_NUMBERED = re.compile(r"(NAUO|=>\[|NEXT_ASSEMBLY_USAGE)[\d:\]]*", re.IGNORECASE)
"""Names that CAD programs give to instances which nobody named."""
_CONTROLS = re.compile(r"\x1b\[[\d;]*m|\*")


def read_step(path: Path, *, appearance: bool = False) -> tuple[GltfNode, ...]:
    """Read the instances of parts of a STEP file [m], whatever its unit is.

    Args:
        path: A ``.step`` or ``.stp``.
        appearance: Read colours too.

    Raises:
        EnvironmentFault: cascadio is not installed.
        ValueError: The file cannot be converted.
    """
    require(f"Reading {path} (or export it as GLB from the CAD program)", "cascadio")
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        converted = Path(folder) / "converted.glb"
        # In a process of its own: OpenCASCADE writes to the terminal, and broken files have crashed it.
        run = subprocess.run(
            [sys.executable, "-c", _CONVERT, str(path), str(converted), str(_SAG), str(_TURN)],
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
        )
        if run.returncode or not converted.is_file():
            raise ValueError(_reason(run.stdout + run.stderr))
        return read_gltf(converted, appearance=appearance, unnamed=_NUMBERED)


def _reason(output: str) -> str:
    lines = [_CONTROLS.sub("", line).strip() for line in output.splitlines()]
    return next((line for line in lines if "ERR" in line), "the converter gave no reason")
