"""glTF: what is seen, in a tree of nodes that stand where the joints are; joints are told in the nodes' extras."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import trimesh

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.formats.content import Content, Shape
    from kinematify.robot.robot import DescribedJoint

_OUTSIDE = "y up"  # node above the root link, which may well be named "world"
_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])
"""From z up to glTF's y up."""


def write_glb(content: Content, out: Path, *, free: bool) -> tuple[str, ...]:
    """Write a GLB file; arguments, result and errors as for `write_mjcf`."""
    del free  # nothing is fixed where nothing is simulated
    scene = trimesh.Scene(base_frame=_OUTSIDE)
    graph: Any = scene.graph
    graph.update(frame_from=_OUTSIDE, frame_to=content.root, matrix=_UP)
    for joint in content.model.kinematics.joints_downward:
        extras = {"kinematify": _described(joint)}
        graph.update(frame_from=joint.parent, frame_to=joint.child, matrix=joint.T_parent_child, metadata=extras)
    for body in content.bodies:
        for number, shape in enumerate(body.visuals):
            name = f"{body.name}_{number}"
            scene.add_geometry(_mesh(shape), geom_name=name, node_name=f"{name}_mesh", parent_node_name=body.name)
    exported: Any = scene.export  # untyped in trimesh
    out.write_bytes(exported(file_type="glb"))
    moving = sum(joint.joint.kind is not JointType.FIXED for joint in content.joints)
    return (f"glTF has no joints: the nodes of {moving} tell theirs in extras.kinematify; physics is left out.",)


def _described(joint: DescribedJoint) -> dict[str, object]:
    """A joint as JSON."""
    told: dict[str, object] = {"joint": joint.name, "type": joint.kind.value}
    if joint.kind is not JointType.FIXED:
        told["axis"] = joint.axis.tolist()
    if np.isfinite([joint.lower, joint.upper]).all() and joint.kind is not JointType.FIXED:
        told |= {"lower": float(joint.lower), "upper": float(joint.upper)}
    return told


def _mesh(shape: Shape) -> trimesh.Trimesh:
    mesh = trimesh.Trimesh(shape.vertices, shape.faces, process=False)
    color = np.round(255.0 * np.array(shape.color)).astype(np.uint8)
    look: Any = trimesh.visual
    material = look.material.PBRMaterial(baseColorFactor=color, metallicFactor=0.0, roughnessFactor=0.8)
    mesh.visual = look.TextureVisuals(material=material)
    return mesh
