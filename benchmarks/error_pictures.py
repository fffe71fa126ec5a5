"""A wrong joint in pictures: how the part moves in truth, and beside it how it was said to move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from kinematify.model.scene import GLYPH_COLORS, camera_for, sliding_arrow, turning_arrow
from kinematify.render.picture import BACKGROUND, PictureScene, PosedMesh, render_scene
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import joint_motion

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Part
    from kinematify.config import PreviewConfig
    from kinematify.robot.arrays import FloatArray

_CHILD, _PARENT, _REST = np.array([0.95, 0.62, 0.16]), np.array([0.56, 0.68, 0.88]), np.array([0.84, 0.84, 0.85])
_SIZE = (300, 260)  # [pixels] of a panel
_CAPTION, _MARGIN = 20, 14  # [pixels]
_INK = (45, 50, 60)
_MOVED_TURN, _MOVED_SLIDE = np.deg2rad(40.0), 0.2  # at most; slides in diagonals
_ARROW_RADIUS = 0.009  # of the diagonal: seen in a small panel


@dataclass(frozen=True, kw_only=True, eq=False)
class ShownJoint:
    """A joint as it is drawn, world frame."""

    parents: Mapping[int, int]
    """Part -> parent part, -1 for the root."""
    child: int
    kind: JointType
    axis: FloatArray
    """Unit direction, shape (3,)."""
    pivot: FloatArray
    """[m], shape (3,)."""
    lower: float
    upper: float


def draw_error(
    parts: Sequence[Part], truth: ShownJoint, guess: ShownJoint | None, captions: tuple[str, str], config: PreviewConfig
) -> Image.Image:
    """Draw the joint as it is and as it was said to be; the moving part is orange, the one that it hangs on blue.

    Args:
        parts: In the pose that was shown.
        truth: The true joint.
        guess: The one that was inferred above the same part; None where the part was taken for the base.
        captions: Above the two panels.
        config: Quality.
    """
    diagonal = float(np.linalg.norm(np.ptp(np.concatenate([part.bounds for part in parts]), axis=0)))
    scenes = [_scene(parts, joint, truth.child, diagonal) for joint in (truth, guess)]
    azimuth = _best_azimuth(scenes, truth, config)
    camera = camera_for(scenes, azimuth, config, size=_SIZE, margin=_MARGIN)
    sheet = Image.new("RGB", (2 * _SIZE[0], _SIZE[1] + _CAPTION), tuple(np.round(BACKGROUND * 255).astype(int)))
    draw = ImageDraw.Draw(sheet)
    for index, (scene, caption) in enumerate(zip(scenes, captions, strict=True)):
        sheet.paste(render_scene(scene, camera, config), (index * _SIZE[0], _CAPTION))
        place = (index * _SIZE[0] + _SIZE[0] // 2, _CAPTION // 2 + 2)
        draw.text(place, caption, fill=_INK, font=ImageFont.load_default(13), anchor="mm")
    return sheet


def _scene(parts: Sequence[Part], joint: ShownJoint | None, child: int, diagonal: float) -> PictureScene:
    moved = set() if joint is None else _subtree(joint.parents, joint.child)
    parent = -1 if joint is None else joint.parents.get(joint.child, -1)
    T_moved = np.eye(4) if joint is None else _motion(joint, diagonal)
    meshes = []
    for index in sorted(range(len(parts)), key=lambda index: index != child):  # the moving part first
        part = parts[index]
        vertices = part.vertices @ T_moved[:3, :3].T + T_moved[:3, 3] if index in moved else part.vertices
        color = _CHILD if index == child else _PARENT if index == parent else _REST
        meshes.append(PosedMesh(vertices=vertices, faces=part.faces, color=color))
    arrows = () if joint is None or joint.kind is JointType.FIXED else (_arrow(parts[child], joint, T_moved, diagonal),)
    return PictureScene(meshes=tuple(meshes), glyphs=arrows)


def _subtree(parents: Mapping[int, int], top: int) -> set[int]:
    """A part with all that hangs on it."""
    found = {top}
    while more := {part for part, above in parents.items() if above in found and part not in found}:
        found |= more
    return found


def _motion(joint: ShownJoint, diagonal: float) -> FloatArray:
    """How the joint moves its part, shape (4, 4): towards the larger limit, by as much as a picture needs."""
    end = joint.upper if joint.upper >= -joint.lower else joint.lower
    most = _MOVED_TURN if joint.kind.turns else _MOVED_SLIDE * diagonal
    return joint_motion(joint.kind, joint.axis, joint.pivot, float(np.clip(end, -most, most)))


def _arrow(part: Part, joint: ShownJoint, T_moved: FloatArray, diagonal: float) -> PosedMesh:
    used = part.vertices[part.faces.reshape(-1)]
    along = (used - joint.pivot) @ joint.axis
    low, high = float(along.min()), float(along.max())
    length = float(np.clip(1.15 * (high - low), 0.25 * diagonal, 0.8 * diagonal))
    if joint.kind is JointType.PRISMATIC:
        middle = 0.5 * (used.min(axis=0) + used.max(axis=0))
        vertices, faces = sliding_arrow(middle, joint.axis, length, _ARROW_RADIUS * diagonal)
    else:
        center = joint.pivot + 0.5 * (low + high) * joint.axis
        sweep = float(np.deg2rad(250.0))
        vertices, faces = turning_arrow(center, joint.axis, length, _ARROW_RADIUS * diagonal, sweep)
    moved = vertices @ T_moved[:3, :3].T + T_moved[:3, 3]
    return PosedMesh(vertices=moved, faces=faces, color=GLYPH_COLORS[joint.kind])


def _best_azimuth(scenes: Sequence[PictureScene], truth: ShownJoint, config: PreviewConfig) -> float:
    """The side from which the part is seen best in both scenes, and the true axis is not seen end on [rad]."""

    def worth(azimuth: float) -> float:
        probe = camera_for(scenes, azimuth, config, size=(config.probe_pixels, config.probe_pixels), margin=2.0)
        seen = sum(float(np.sqrt(scene.visible_pixels(probe)[0])) for scene in scenes)
        return seen * (0.6 + 0.4 * float(np.sqrt(1.0 - min(abs(float(truth.axis @ probe.forward)), 1.0) ** 2)))

    step = 2.0 * np.pi / config.azimuths
    return max((step * (index + 0.66) for index in range(config.azimuths)), key=worth)
