"""Small articulated objects of known geometry, as assemblies with the joints that are true for them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import trimesh

from kinematify.assembly.part import Assembly, ExcludedPart, Part
from kinematify.config import load_config
from kinematify.contact.tree import KinematicTree
from kinematify.joints.candidate import JointEstimate
from kinematify.model.build import build_model
from kinematify.model.kinematic_model import KinematicModel
from kinematify.robot.joint_type import JointType

CONFIG = load_config()


@dataclass(frozen=True)
class Mechanism:
    name: str
    assembly: Assembly
    tree: KinematicTree
    joints: tuple[JointEstimate, ...]

    def model(self) -> KinematicModel:
        return build_model(self.assembly, self.tree, self.joints, name=self.name, config=CONFIG.model)


def part(name: str, mesh: trimesh.Trimesh) -> Part:
    return Part(name=name, vertices=mesh.vertices, faces=mesh.faces)


def box(name: str, center: tuple[float, float, float], size: tuple[float, float, float]) -> Part:
    mesh = trimesh.creation.box(size)
    mesh.apply_translation(center)
    return part(name, mesh)


def joint(child: int, kind: str, axis: object, pivot: object, limits: tuple[float, float], *, parent: int = 0):
    return JointEstimate(
        parent=parent,
        child=child,
        kind=JointType(kind),
        axis=np.asarray(axis, dtype=float),
        pivot=np.asarray(pivot, dtype=float),
        lower=limits[0],
        upper=limits[1],
        confidence=1.0,
    )


def door() -> Mechanism:
    parts = (box("frame", (0, 0, 1), (0.1, 0.1, 2)), box("leaf", (0.5, 0, 1), (0.85, 0.05, 1.9)))
    hinge = joint(1, "revolute", (0, 0, 1), (0.06, 0.01, 0.3), (-0.2, 1.7))
    return Mechanism("door", Assembly(parts=parts, source="door"), KinematicTree(parents=(-1, 0)), (hinge,))


def drawer() -> Mechanism:
    parts = (box("drawer", (3.1, -2, 0.4), (0.5, 0.4, 0.2)), box("cabinet", (3, -2, 0.4), (0.6, 0.5, 0.3)))
    slide = joint(0, "prismatic", (0.6, -0.8, 0), (3.1, -2, 0.4), (0.0, 0.35), parent=1)
    return Mechanism("drawer", Assembly(parts=parts, source="drawer"), KinematicTree(parents=(1, -1)), (slide,))


def knob() -> Mechanism:
    turned = trimesh.transformations.rotation_matrix(0.7, (1, 2, 0.5), (0, 0.1, 0))
    mesh = trimesh.creation.cylinder(radius=0.02, height=0.03, sections=24)
    mesh.apply_transform(turned)
    # The hull has no vertex in the middle of a cap, which engines that keep hulls would drop.
    parts = (box("panel", (0, 0, -0.1), (0.3, 0.2, 0.02)), part("knob", mesh.convex_hull))
    axle = joint(1, "continuous", turned[:3, 2], turned[:3, 3], (-np.inf, np.inf))
    return Mechanism("knob", Assembly(parts=parts, source="knob"), KinematicTree(parents=(-1, 0)), (axle,))


def chain() -> Mechanism:
    """Five links with oblique axes and a joint of each kind."""
    rng = np.random.default_rng(5)
    parts = tuple(box(f"link{i}", (0.3 * i, 0.02 * i, 1 + 0.05 * i), (0.3, 0.1 + 0.01 * i, 0.08)) for i in range(5))
    kinds = ("revolute", "prismatic", "continuous", "revolute")
    limits = {"revolute": (-1.0, 2.0), "prismatic": (-0.1, 0.2), "continuous": (-np.inf, np.inf)}
    joints = tuple(
        joint(i, kind, rng.normal(size=3), parts[i].centroid - [0.15, 0.0, 0.01], limits[kind], parent=i - 1)
        for i, kind in enumerate(kinds, start=1)
    )
    tree = KinematicTree(parents=(-1, 0, 1, 2, 3))
    return Mechanism("chain", Assembly(parts=parts, source="chain"), tree, joints)


def flat_and_fixed() -> Mechanism:
    """A flat flap, an open shell fixed to the body, and a set-aside triangle on the flap."""
    flap = Part(
        name="flap",
        vertices=np.array([[0, 0.3, 0.2], [0.4, 0.3, 0.2], [0.4, 0.7, 0.3], [0, 0.7, 0.3]]),
        faces=np.array([[0, 1, 2], [0, 2, 3]]),
    )
    shell = trimesh.creation.box((0.2, 0.2, 0.2))
    shell.apply_translation((0, -0.4, 0))
    open_shell = Part(name="shell", vertices=shell.vertices, faces=shell.faces[2:])
    triangle = Part(name="badge", vertices=flap.vertices[:3] + 0.01, faces=np.array([[0, 1, 2]]))
    empty = Part(name="nothing", vertices=np.zeros((1, 3)), faces=np.empty((0, 3)))
    set_aside = tuple(ExcludedPart(part=item, reason="flat", nearest="flap") for item in (triangle, empty))
    parts = (box("body", (0, 0, 0), (0.6, 0.6, 0.4)), flap, open_shell)
    joints = (
        joint(1, "revolute", (1, 0, 0), (0.1, 0.3, 0.2), (0.0, 1.5)),
        joint(2, "fixed", (0, 0, 1), (0, -0.3, 0), (0.0, 0.0)),
    )
    assembly = Assembly(parts=parts, source="flap", set_aside=set_aside)
    return Mechanism("flap", assembly, KinematicTree(parents=(-1, 0, 0)), joints)
