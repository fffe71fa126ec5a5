"""Pictures of the declared model for the HTML report, still and to be turned; made in a process of its own."""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import Part
from kinematify.config import load_config
from kinematify.model.kinematic_model import KinematicModel, ModelLink
from kinematify.model.urdf import link_colors, link_shades
from kinematify.render.model_picture import render_preview
from kinematify.robot.appearance import joined, linear_of, srgb_of
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Inertial, Joint, forward_kinematics, joint_values, rest_configuration, rigid_groups
from kinematify.robot.transforms import pose_at, transformed
from kinematify.validation.formats.view_data import view_data
from kinematify.validation.isolation import Stage, run_stages
from kinematify.validation.stage import StageRequest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config.validation import ValidationSettings
    from kinematify.robot.appearance import Appearance
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import RigidGroup, Robot

_FILE = "picture.png"
_SCENE = "scene.json"
_FACES = 20_000
"""Triangles of the model in a page, about: 250 kB, up to 500 kB for a robot of many small parts."""
_PANEL = {
    "panel_width": 420,  # read on a phone too, and the report must stay small
    "panel_height": 380,
    "openness_rays": 3,  # these four: half the time, which is about a second, and hardly seen at this size
    "subsamples": 2,
    "azimuths": 4,
    "floor_cells": 48,
}
_NO_INERTIAL = Inertial(mass=1.0, center_of_mass=np.zeros(3), tensor=np.eye(3), source="volume")


@dataclass(frozen=True, kw_only=True)
class Drawing:
    """Drawing of a model in a page; a report stands without it."""

    picture: bytes = b""
    """PNG of the model at rest and moved; empty if it could not be drawn in time."""
    scene: str = ""
    """JSON from `view_data`; empty likewise."""


def drawing_of(path: Path, package_dirs: Sequence[Path], settings: ValidationSettings, *, seconds: float) -> Drawing:
    """Draw a model whose file and meshes passed their checks.

    Args:
        path: The URDF file.
        package_dirs: Where packages lie.
        settings: Limits of the process.
        seconds: Processor time that it may take.

    Returns:
        What was drawn in time.
    """
    stage = Stage(name="picture", run=run, checks=())
    with tempfile.TemporaryDirectory(prefix="kinematify-", ignore_cleanup_errors=True) as folder:
        request = StageRequest(
            urdf=path.absolute(),
            package_dirs=tuple(item.absolute() for item in package_dirs),
            work=Path(folder),
            settings=settings,
            selected=frozenset(),
            deadline=seconds,
        )
        (end,) = run_stages([stage], request, workers=1)
        picture, scene = Path(folder, _FILE), Path(folder, _SCENE)
        return Drawing(
            picture=picture.read_bytes() if end.failure is None and picture.is_file() else b"",
            scene=scene.read_text(encoding="utf-8") if scene.is_file() else "",
        )


def scene_of(path: Path, package_dirs: Sequence[Path] = ()) -> str:
    """Return the scene of a model that can be trusted, without a process of its own.

    Args:
        path: The URDF file.
        package_dirs: Where packages lie.

    Raises:
        DescriptionError: It cannot be read.
    """
    robot = read_robot(path, package_dirs=package_dirs, appearance=True)
    return _scene(robot, shown_model(robot))


def _scene(robot: Robot, model: KinematicModel) -> str:
    """The scene in the colours of the picture, so that a part has one colour in both."""
    shades = link_shades(model)
    colors = {name: srgb_of(shades.get(name, 1.0) * linear_of(color)) for name, color in link_colors(model).items()}
    scene = view_data(robot, faces=_FACES, colors=colors)
    return "" if scene is None else json.dumps(scene, allow_nan=False)


def run(request: StageRequest, _tell: object) -> None:
    """Draw the model of a request into its folder; body of the process."""
    robot = read_robot(request.urdf, package_dirs=request.package_dirs, appearance=True)
    model = shown_model(robot)
    scene = _scene(robot, model)
    if scene:
        aside = request.work / f".{_SCENE}"
        aside.write_text(scene, encoding="utf-8")
        aside.replace(request.work / _SCENE)  # a process that is stopped leaves no half of it
    config = load_config("default").preview.model_copy(update=_PANEL)
    if any(len(link.part.faces) > 1 for link in model.links):
        render_preview(model, request.work / _FILE, config)


@dataclass(frozen=True, eq=False)
class _Standing:
    """A robot at rest."""

    robot: Robot
    rest: dict[str, float]
    T_world_link: dict[str, FloatArray]
    top_of: dict[str, str]
    """Link -> the first of those that it is fixed together with."""

    def place(self, link: str) -> FloatArray:
        """Origin of a link in the world [m], shape (3,)."""
        place: FloatArray = self.T_world_link[link][:3, 3]
        return place


def shown_model(robot: Robot) -> KinematicModel:
    """Return the robot as pictures want it: at rest, links fixed together as one, frames along the world's axes."""
    rest = rest_configuration(robot)
    groups = rigid_groups(robot)
    top_of = {name: group.top for group in groups for name in group.links}
    standing = _Standing(robot, rest, forward_kinematics(robot, rest), top_of)
    return KinematicModel(
        name=robot.name,
        links=tuple(_link(standing, group) for group in groups),
        joints=tuple(_joint(standing, joint) for joint in robot.joints if joint.kind is not JointType.FIXED),
    )


def _link(standing: _Standing, group: RigidGroup) -> ModelLink:
    # A link without shape still carries others: a triangle of no area at its origin represents it.
    vertices: list[FloatArray] = [np.tile(standing.place(group.top), (3, 1))]
    faces: list[IntArray] = [np.array([[0, 1, 2]])]
    looks: list[Appearance | None] = [None]
    for name in group.links:
        T_world_link = standing.T_world_link[name]
        for mesh in standing.robot.link_by_name[name].meshes:
            looks.append(mesh.appearance)
            faces.append(mesh.faces + sum(map(len, vertices)))
            vertices.append(transformed(mesh.vertices, T_world_link))
    if group.has_geometry:
        faces.pop(0)
        looks.pop(0)
    look = joined(looks, [len(item) for item in faces])
    corners, triangles = np.concatenate(vertices), np.concatenate(faces)
    color = None if look is None else look.mean_color(corners, triangles)[:3]
    part = Part(name=group.top, vertices=corners, faces=triangles, color=color, appearance=look)
    return ModelLink(name=group.top, part=part, T_world_link=pose_at(standing.place(group.top)), inertial=_NO_INERTIAL)


def _joint(standing: _Standing, joint: Joint) -> Joint:
    parent = standing.top_of[joint.parent]
    lower, upper = _range(standing, joint)
    return Joint(
        name=joint.name,
        kind=joint.kind,
        parent=parent,
        child=joint.child,
        T_parent_child=pose_at(standing.place(joint.child) - standing.place(parent)),
        axis=standing.T_world_link[joint.child][:3, :3] @ joint.axis,
        lower=lower,
        upper=upper,
    )


def _range(standing: _Standing, joint: Joint) -> tuple[float, float]:
    """Limits seen from rest; a follower has those that its leader gives it, so that both move by the same share."""
    at_rest = standing.rest[joint.name]
    if joint.mimic is None:
        return joint.lower - at_rest, joint.upper - at_rest
    leader = joint
    while leader.mimic is not None:
        leader = standing.robot.joint_by_name[leader.mimic.joint]
    if not np.isfinite(leader.upper - leader.lower):
        return 0.0, 0.0
    ends = [
        joint_values(standing.robot, {leader.name: end})[joint.name] - at_rest for end in (leader.lower, leader.upper)
    ]
    return min(ends), max(ends)
