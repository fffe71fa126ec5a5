"""glTF: what is seen, in a tree of nodes that stand where the joints are; joints are told in the nodes' extras."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import trimesh

from kinematify.formats.content import GREY
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.formats.content import Content
    from kinematify.robot.robot import Joint, Shape

_OUTSIDE = "y up"  # node above the root link, which may well be named "world"
_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])
"""From z up to glTF's y up."""


def write_glb(content: Content, out: Path, *, free: bool) -> tuple[str, ...]:
    """Write a GLB file; arguments, result and errors as for `write_mjcf`."""
    del free  # nothing is fixed where nothing is simulated
    scene = trimesh.Scene(base_frame=_OUTSIDE)
    graph: Any = scene.graph
    graph.update(frame_from=_OUTSIDE, frame_to=content.robot.root, matrix=_UP)
    for joint in content.robot.joints_downward:
        extras = {"kinematify": _described(joint)}
        graph.update(frame_from=joint.parent, frame_to=joint.child, matrix=joint.T_parent_child, metadata=extras)
    for link in content.robot.links:
        for number, shape in enumerate(link.visuals):
            name = f"{link.name}_{number}"
            scene.add_geometry(_mesh(shape), geom_name=name, node_name=f"{name}_mesh", parent_node_name=link.name)
    exported: Any = scene.export  # untyped in trimesh
    out.write_bytes(exported(file_type="glb"))
    moving = sum(joint.kind is not JointType.FIXED for joint in content.robot.joints)
    return (f"glTF has no joints: the nodes of {moving} tell theirs in extras.kinematify; physics is left out.",)


def _described(joint: Joint) -> dict[str, object]:
    """A joint as JSON."""
    told: dict[str, object] = {"joint": joint.name, "type": joint.kind.value}
    if joint.kind is not JointType.FIXED:
        told["axis"] = joint.axis.tolist()
    if np.isfinite([joint.lower, joint.upper]).all() and joint.kind is not JointType.FIXED:
        told |= {"lower": float(joint.lower), "upper": float(joint.upper)}
    return told


def _mesh(shape: Shape) -> trimesh.Trimesh:
    mesh = trimesh.Trimesh(shape.mesh.vertices, shape.mesh.faces, process=False)
    color = np.round(255.0 * np.array(shape.color or GREY)).astype(np.uint8)
    look: Any = trimesh.visual
    material = look.material.PBRMaterial(baseColorFactor=color, metallicFactor=0.0, roughnessFactor=0.8)
    mesh.visual = look.TextureVisuals(material=material)
    return mesh
