"""Does an object look in its model, in the viewer and in exports as it does in its file?

GLB files as a script makes them, boxes of one colour, with a picture, with colours of vertices, or glossy, go through
the inference. *Model* and exports: share of places (three of every triangle) whose colour differs from that of the file
at the same place by more than 5 % of a channel. *Viewer*: the file itself, as three.js shows it, stands where the
model stood in the same page, under the same light without shadows; share of the object's pixels that differ by more
than 5 % of a channel, and the mean difference. *GLB in the viewer*: the same for the export.
"""

from __future__ import annotations

import shutil
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
import trimesh
from PIL import Image
from pydantic import Field
from scipy.spatial import cKDTree

from benchmarks.browser import open_browser
from benchmarks.study import Options, Study, explained
from kinematify.assembly.load import load_assembly
from kinematify.errors import EnvironmentFault, KinematifyError
from kinematify.evaluation.record import table
from kinematify.formats.export import export
from kinematify.pipeline import infer, write_inference
from kinematify.robot.appearance import Appearance, Material, Texture, plain, srgb_of
from kinematify.robot.mesh_file import TO_Z_UP, RawMesh, merged, read_meshes
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import quaternion_of
from kinematify.view.drawn import DrawnModel
from kinematify.view.window import Window, read_model

if TYPE_CHECKING:
    from collections.abc import Callable

    from playwright.sync_api import Page

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.record import Report
    from kinematify.robot.arrays import FloatArray

ALIKE = 0.05
"""Of the range of a channel."""
KINDS = ("plain", "texture", "vertices", "glossy")
_SIZE = (300, 400)
"""Of a picture of the page: height and width [pixels]."""
_PATIENCE = 120.0
"""For a picture to come to rest without a graphics card [s]."""
_PORT = 18400
_FORMATS = {"glb": "out.glb", "mjcf": "out.xml", "usd": "out.usda"}
_COLUMNS = ("urdf", *_FORMATS)


class ColorsOptions(Options):
    """How many."""

    objects: int = Field(20, ge=1, description="Files that are made.")


@dataclass(frozen=True, kw_only=True)
class Dressed:
    """One file to be made."""

    seed: int
    folder: Path
    """Of this file alone."""

    @property
    def given(self) -> Path:
        """The file."""
        return self.folder / f"object_{self.seed}.glb"

    @property
    def urdf(self) -> Path:
        """What was inferred of it."""
        return self.folder / "model" / "model.urdf"

    def exported(self, kind: str) -> Path:
        """The model in another format."""
        return self.folder / _FORMATS[kind]


def measure(options: ColorsOptions, work: Work) -> Measured:
    """Take every file round, then show all of them in one page: it takes longer to open than to show a file."""
    asked = {
        f"object {seed}": Dressed(seed=seed, folder=work.folder / f"object_{seed}") for seed in range(options.objects)
    }
    records = work.each(taken_round, asked, workers=1)
    shown = work.each(shown_on_a_page, {"page": tuple(asked[name] for name in records)}, workers=1)
    return [record | shown["page"][name] for name, record in records.items()] if shown else [], {}


def taken_round(asked: Dressed) -> Record:
    """Compare one file with what becomes of it."""
    shutil.rmtree(asked.folder, ignore_errors=True)
    asked.folder.mkdir(parents=True)
    make_object(asked.seed, asked.folder)
    write_inference(infer(load_assembly(asked.given)), asked.urdf.parent, preview=False)
    given = seen_of_glb(asked.given)
    record: Record = {"object": asked.seed, "urdf": unlike(given, seen_of_urdf(asked.urdf))}
    read: dict[str, Callable[[Path], RawMesh]] = {"glb": seen_of_glb, "mjcf": seen_of_mjcf, "usd": seen_of_usd}
    for kind in _FORMATS:
        export(asked.urdf, kind, asked.exported(kind))
        record[kind] = unlike(given, read[kind](asked.exported(kind)))
    return record


def make_object(seed: int, folder: Path) -> Path:
    """Write a GLB of two or three boxes with colours of all kinds; return its path."""
    random = np.random.default_rng(seed)
    scene = trimesh.Scene()
    for index in range(2 + seed % 2):
        box = trimesh.creation.box((0.2, 0.2, 0.2))
        for _ in range(3):
            box = box.subdivide()
        box.apply_translation((0.21 * index, 0.0, 0.0))
        name = f"part {index}"
        scene.add_geometry(dressed(box, KINDS[(seed + index) % len(KINDS)], random), geom_name=name, node_name=name)
    path = folder / f"object_{seed}.glb"
    written: Any = scene.export  # untyped in trimesh
    path.write_bytes(written(file_type="glb"))
    return path


def dressed(mesh: trimesh.Trimesh, kind: str, random: np.random.Generator) -> trimesh.Trimesh:
    """Give a mesh of 0.2 m colours of one of `KINDS`."""
    look: Any = trimesh.visual
    if kind == "texture":  # four quarters of different colours, so that a turned or mirrored picture is noticed
        quarters = random.integers(20, 236, (2, 2, 3), dtype=np.uint8)
        picture = Image.fromarray(np.kron(quarters, np.ones((16, 16, 1), dtype=np.uint8)))
        material = look.material.PBRMaterial(
            baseColorTexture=picture, baseColorFactor=[1.0, 1.0, 1.0, 1.0], metallicFactor=0.0, roughnessFactor=0.8
        )
        mesh.visual = look.TextureVisuals(uv=mesh.vertices[:, :2] / 0.2 + 0.5, material=material)
    elif kind == "vertices":
        chosen = random.integers(30, 226, (3, 4))
        chosen[:, 3] = 255
        third = np.digitize(mesh.triangles_center[:, 2], (-0.03, 0.03))
        mesh.visual = look.ColorVisuals(mesh, face_colors=chosen[third].astype(np.uint8))
        mesh.unmerge_vertices()  # corners of their own, so that no colour is a mixture
    else:
        glossy = kind == "glossy"
        material = look.material.PBRMaterial(
            baseColorFactor=[*random.uniform(0.05, 0.95, 3).tolist(), 1.0],
            metallicFactor=0.9 if glossy else 0.0,
            roughnessFactor=0.4 if glossy else 0.8,
        )
        mesh.visual = look.TextureVisuals(material=material)
    return mesh


def unlike(given: RawMesh, found: RawMesh) -> float:
    """Share of the places of one mesh whose colour differs at the same place of the other one.

    Raises:
        KinematifyError: They are not of the same shape at the same place.
    """
    places, colors = _places(given)
    others, seen = _places(found)
    distance, nearest = cKDTree(others).query(places)
    if distance.max() > 1e-5:
        raise KinematifyError(f"{found.name} is {distance.max():.2g} m away from what it was made of.")
    return float((np.abs(seen[nearest, :3] - colors[:, :3]).max(axis=1) > ALIKE).mean())


def _places(mesh: RawMesh) -> tuple[FloatArray, FloatArray]:
    """Three places on each triangle, and their colours."""
    looks = mesh.appearance or plain(Material().color, len(mesh.faces))
    weights = np.array([[0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]])
    corners = mesh.vertices[mesh.faces]
    places = np.concatenate([np.einsum("c,fck->fk", weight, corners) for weight in weights])
    every = np.arange(len(mesh.faces))
    colors = np.concatenate([looks.colors_at(every, np.tile(weight, (len(every), 1))) for weight in weights])
    return places, colors


def seen_of_glb(path: Path) -> RawMesh:
    """What is seen of a GLB file, z up."""
    mesh = merged(read_meshes(path, appearance=True), path.name)
    return mesh.moved(TO_Z_UP["Y_UP"])


def seen_of_urdf(path: Path) -> RawMesh:
    """What is seen of a URDF, all joints at zero."""
    robot = read_robot(path, geometry="shown", appearance=True)
    poses = forward_kinematics(robot, {})
    meshes = tuple(
        RawMesh(
            name=link.name,
            vertices=mesh.vertices @ poses[link.name][:3, :3].T + poses[link.name][:3, 3],
            faces=mesh.faces,
            appearance=mesh.appearance,
        )
        for link in robot.links
        for mesh in link.meshes
    )
    return merged(meshes, path.name)


def seen_of_mjcf(path: Path) -> RawMesh:
    """What MuJoCo shows of a model: the geoms that touch nothing."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    meshes = []
    for geom in np.flatnonzero((model.geom_contype == 0) & (model.geom_type == mujoco.mjtGeom.mjGEOM_MESH)):
        mesh = int(model.geom_dataid[geom])
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        start, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
        turn = data.geom_xmat[geom].reshape(3, 3)
        material, texture, uv = int(model.geom_matid[geom]), None, None
        red, green, blue, opacity = (model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]).tolist()
        if material >= 0 and (number := int(model.mat_texid[material, mujoco.mjtTextureRole.mjTEXROLE_RGB])) >= 0:
            texture = _texture_of(model, number)
            corners = model.mesh_facetexcoord[start : start + faces]
            uv = model.mesh_texcoord[int(model.mesh_texcoordadr[mesh]) + corners] * [1.0, -1.0] + [0.0, 1.0]
        looks = Appearance(
            materials=(Material(color=(red, green, blue, opacity), texture=texture),),
            material_of_face=np.zeros(faces, dtype=np.int64),
            uv=uv,
        )
        placed = model.mesh_vert[first : first + count] @ turn.T + data.geom_xpos[geom]
        meshes.append(RawMesh(name="", vertices=placed, faces=model.mesh_face[start : start + faces], appearance=looks))
    return merged(tuple(meshes), path.name)


def _texture_of(model: mujoco.MjModel, number: int) -> Texture:
    width, height, channels = (int(of[number]) for of in (model.tex_width, model.tex_height, model.tex_nchannel))
    start = int(model.tex_adr[number])
    pixels = model.tex_data[start : start + width * height * channels].reshape(height, width, channels)
    opaque = np.full((height, width, 4), 255, dtype=np.uint8)
    opaque[:, :, :channels] = pixels
    return Texture(name=str(number), pixels=opaque)


def seen_of_usd(path: Path) -> RawMesh:
    """What a renderer shows of a USD file: meshes under ``visuals`` with the materials that are bound to them."""
    from pxr import Usd, UsdGeom, UsdShade  # noqa: PLC0415  # takes a second

    stage: Any = Usd.Stage.Open(str(path))
    meshes = []
    for prim in stage.Traverse():
        if not prim.IsA(UsdGeom.Mesh) or "/visuals/" not in str(prim.GetPath()):
            continue
        mesh = UsdGeom.Mesh(prim)
        T = np.array(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(0)).T
        points = np.array(mesh.GetPointsAttr().Get(), dtype=float) @ T[:3, :3].T + T[:3, 3]
        faces = np.array(mesh.GetFaceVertexIndicesAttr().Get(), dtype=np.int64).reshape(-1, 3)
        shader, _, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0].ComputeSurfaceSource()
        color: Any = shader.GetInput("diffuseColor")
        texture, uv = None, None
        if color.HasConnectedSource():
            picture = UsdShade.Shader(color.GetConnectedSource()[0].GetPrim())
            file = picture.GetInput("file").Get().resolvedPath
            texture = Texture(name=file, pixels=np.asarray(Image.open(file).convert("RGBA")))
            light = np.array(picture.GetInput("scale").Get())[:3]
            uv = np.array(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").Get(), dtype=float)[faces]
        else:
            light = np.array(color.Get())
        red, green, blue = srgb_of(light).tolist()
        looks = Appearance(
            materials=(Material(color=(red, green, blue, 1.0), texture=texture),),
            material_of_face=np.zeros(len(faces), dtype=np.int64),
            uv=uv,
        )
        meshes.append(RawMesh(name="", vertices=points, faces=faces, appearance=looks))
    return merged(tuple(meshes), path.name)


def shown_on_a_page(asked: tuple[Dressed, ...]) -> Record:
    """Compare pictures of every model, of the file that it was made of, and of an export, in the same page."""
    window = Window(asked[0].urdf, port=_PORT)
    try:
        with open_browser() as browser:
            page = browser.new_page(viewport={"width": _SIZE[1], "height": _SIZE[0]})
            page.goto(window.url, timeout=1000.0 * _PATIENCE)
            window.server.scene.reset()
            empty = _picture(page, window)
            _seen(asked[0], page, window, empty)  # a page fades in, slower than two pictures can tell
            return {f"object {item.seed}": _seen(item, page, window, empty) for item in asked}
    finally:
        window.close()


def _seen(asked: Dressed, page: Page, window: Window, empty: FloatArray) -> Record:
    scene = window.server.scene
    drawn = DrawnModel(window.server, read_model(asked.urdf, ()).scene, (), lambda _: None)
    drawn.place({}, 0.0)
    scene.configure_default_lights(cast_shadow=False)  # shadows follow later than what casts them
    found = {"model": _picture(page, window, unlike=empty)}
    scene.reset()
    for name, path in (("file", asked.given), ("export", asked.exported("glb"))):
        _picture(page, window, unlike=next(reversed(found.values())))
        handle = scene.add_glb("/given", path.read_bytes(), wxyz=quaternion_of(TO_Z_UP["Y_UP"]))
        found[name] = _picture(page, window, unlike=empty)
        handle.remove()
    _picture(page, window, unlike=found["export"])
    different, mean = _compared(found["file"], found["model"], empty)
    export_different, _ = _compared(found["file"], found["export"], empty)
    return {"viewer": different, "viewer_mean": mean, "glb_viewer": export_different}


def _picture(page: Page, window: Window, unlike: FloatArray | None = None) -> FloatArray:
    """What the page shows when it has come to rest and differs from what was there before, shape (h, w, 3)."""
    end, last = time.monotonic() + _PATIENCE, None
    while time.monotonic() < end:
        page.wait_for_timeout(800)
        client = next(iter(window.server.get_clients().values()), None)
        if client is None:
            continue
        shown = client.get_render(*_SIZE, transport_format="png", timeout=_PATIENCE)[:, :, :3] / 255.0
        changed = unlike is None or np.abs(shown - unlike).max() > ALIKE
        if changed and last is not None and np.abs(shown - last).max() < 0.01:
            return np.asarray(shown)
        last = shown
    raise EnvironmentFault(f"The page did not come to rest within {_PATIENCE:.0f} s. Measure on a quieter machine.")


def _compared(given: FloatArray, found: FloatArray, empty: FloatArray) -> tuple[float, float]:
    """Share of the object's pixels that differ, and their mean difference."""
    there = np.maximum(np.abs(given - empty).max(axis=2), np.abs(found - empty).max(axis=2)) > ALIKE
    difference = np.abs(given - found).max(axis=2)[there]
    return float((difference > ALIKE).mean()), float(difference.mean())


def report(found: Report[Record]) -> list[str]:
    """One line per file, and the mean."""
    titles = ("object", "model", "GLB", "MJCF", "USD", "viewer", "mean difference", "GLB in the viewer")
    names = (*_COLUMNS, "viewer", "viewer_mean", "glb_viewer")
    rows = [(str(item["object"]), *(f"{item[name]:.2%}" for name in names)) for item in found.records]
    means = (f"{np.mean([item[name] for item in found.records]):.2%}" for name in names)
    return [explained(__doc__), table(titles, [*rows, ("**mean**", *means)])]


STUDY = Study(
    title="Colours, from a file to the viewer and to exports", options=ColorsOptions, measure=measure, report=report
)
