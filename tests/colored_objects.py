"""Objects with colours and textures, and how a file shows them, place by place."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
import trimesh
from PIL import Image
from scipy.spatial import cKDTree

from kinematify.errors import KinematifyError
from kinematify.robot.appearance import Appearance, Material, Texture, plain, srgb_of
from kinematify.robot.mesh_file import read_meshes, to_z_up
from kinematify.robot.raw_mesh import RawMesh, merged
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray

ALIKE = 0.05
"""Of the range of a channel."""
KINDS = ("plain", "texture", "vertices", "glossy")


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
    return mesh.moved(to_z_up("y"))


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
    from pxr import Usd, UsdGeom, UsdShade  # takes a second

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
            uv = np.array(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").ComputeFlattened(), dtype=float)[faces]
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
