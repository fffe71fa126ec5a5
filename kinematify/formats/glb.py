"""glTF: what is seen, in a tree of nodes that stand where the joints are; joints are in the nodes' extras."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import trimesh
from PIL import Image

from kinematify.formats.content import shown_surfaces
from kinematify.robot.appearance import linear_of
from kinematify.robot.joint_type import JointType
from kinematify.robot.mesh_file import to_z_up

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.formats.content import Content
    from kinematify.robot.appearance import Surface
    from kinematify.robot.robot import Joint

_OUTSIDE = "y up"  # node above the root link, which may well be named "world"


def write_glb(content: Content, out: Path, *, free: bool) -> None:
    """Write a GLB file; arguments and errors as for `write_mjcf`."""
    del free  # nothing is fixed where nothing is simulated
    scene = trimesh.Scene(base_frame=_OUTSIDE)
    graph: Any = scene.graph
    T_outside_root = np.eye(4)
    T_outside_root[:3, :3] = to_z_up("y").T
    graph.update(frame_from=_OUTSIDE, frame_to=content.robot.root, matrix=T_outside_root)
    for joint in content.robot.joints_downward:
        extras = {"kinematify": _described(joint)}
        graph.update(frame_from=joint.parent, frame_to=joint.child, matrix=joint.T_parent_child, metadata=extras)
    for link in content.robot.links:
        seen = [surface for shape in link.visuals for surface in shown_surfaces(shape)]
        for number, surface in enumerate(seen):
            name = f"{link.name}_{number}"
            scene.add_geometry(
                surface_mesh(surface), geom_name=name, node_name=f"{name}_mesh", parent_node_name=link.name
            )
    exported: Any = scene.export  # untyped in trimesh
    out.write_bytes(exported(file_type="glb"))


def _described(joint: Joint) -> dict[str, object]:
    """A joint as JSON."""
    extras: dict[str, object] = {"joint": joint.name, "type": joint.kind.value}
    if joint.kind is not JointType.FIXED:
        extras["axis"] = joint.axis.tolist()
    if joint.is_limited and joint.kind is not JointType.FIXED:
        extras |= {"lower": float(joint.lower), "upper": float(joint.upper)}
    return extras


def surface_mesh(surface: Surface) -> trimesh.Trimesh:
    """Return a surface with its material as glTF describes it."""
    mesh = trimesh.Trimesh(surface.vertices, surface.faces, process=False)
    look: Any = trimesh.visual
    stated = surface.material
    texture = stated.texture
    material = look.material.PBRMaterial(
        name=stated.name or None,
        # The factor is linear light in glTF, while the bytes of a picture are sRGB.
        baseColorFactor=[*linear_of(np.array(stated.color[:3])).tolist(), stated.color[3]],
        baseColorTexture=None if texture is None else Image.fromarray(texture.pixels),
        metallicFactor=stated.metallic,
        roughnessFactor=stated.roughness,
        alphaMode="BLEND" if stated.color[3] < 1.0 else "OPAQUE",
    )
    mesh.visual = look.TextureVisuals(uv=surface.uv, material=material)
    return mesh
