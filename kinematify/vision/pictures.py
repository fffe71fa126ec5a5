"""The picture of a question: the object, two close views of the part, and every option with its axis and a ghost.

Pictures are ray cast, so that no OpenGL is needed. A small opening angle makes them nearly orthographic: what is
parallel looks parallel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from kinematify.model.picture_scene import sliding_arrow, turning_arrow
from kinematify.render.picture import PictureScene, PosedMesh, render_scene
from kinematify.robot.appearance import plain
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rotation_about
from kinematify.vision.motion_options import offered, shuffled
from kinematify.vision.question import JointQuestion
from kinematify.vision.views import around, corners, find_viewpoints, part_pixels

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import PreviewConfig, VisionConfig
    from kinematify.joints.candidate import JointCandidate, JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.refinement.candidates import CandidateJoints
    from kinematify.render.camera import Camera
    from kinematify.robot.arrays import FloatArray
    from kinematify.vision.views import Viewpoint, Viewpoints

_CHILD, _CARRIED = np.array([0.85, 0.13, 0.12]), np.array([0.96, 0.62, 0.60])
_PARENT, _REST, _GHOST = np.array([0.45, 0.62, 0.90]), np.array([0.80, 0.80, 0.80]), np.array([1.0, 0.62, 0.08])
_AXIS = np.array([0.02, 0.42, 0.10])
_GHOST_OPACITY, _CARRIED_OPACITY, _GLASS = 0.4, 0.16, 0.07  # of one surface
_HIDDEN_AXIS = 0.7  # opacity of an axis behind a surface: it is always to be seen
_THICKNESS = 0.012  # of the part's diagonal: half the thickness of an axis
_INSIDE = 0.01  # of the object's diagonal: only so near surfaces darken what is seen through others
_RIM = 0.006  # of the part's diagonal: width of the light rim around an axis
_OVERHANG = 1.25  # length of an axis over that of the part
_SHORTEST = 0.55  # of the part's diagonal: an axis is no shorter
_TURN = np.radians([20.0, 55.0])  # a ghost is turned by so much: seen as moved, and still beside the part
_SLIDE = (0.3, 0.6)  # of the part's length along the axis, or a third of its diagonal if that is more
_FLAT = 0.33
COLUMNS, CAPTION = 3, 24
"""Pictures in a row of a sheet, and the height of the line above each [pixels]."""
_INK, _PAPER, _FRAME = (30, 34, 42), (255, 255, 255), (200, 30, 30)


@dataclass(frozen=True, eq=False)
class _Shown:
    """One joint as it is drawn."""

    inference: Inference
    parent: int
    child: int
    views: Viewpoints
    config: VisionConfig

    @cached_property
    def moving(self) -> frozenset[int]:
        """The child and what it carries."""
        return self.inference.trees[0].subtree(self.child)

    def scene(self, *, glass: bool, ghost: JointCandidate | None = None, value: float = 0.0) -> PictureScene:
        """The parts, mesh i is part i; with a motion its axis and the moved parts."""
        parts = self.inference.assembly.parts
        meshes = [self._mesh(index, glass=glass) for index in range(len(parts))]
        if ghost is None:
            return PictureScene(meshes=tuple(meshes))
        for index in sorted(self.moving):
            opacity = _GHOST_OPACITY if index == self.child else _CARRIED_OPACITY
            look = plain((*_GHOST.tolist(), opacity), len(parts[index].faces))
            moved = _moved(parts[index].vertices, ghost, value)
            meshes.append(PosedMesh(vertices=moved, faces=parts[index].faces, color=_GHOST, appearance=look))
        return PictureScene(meshes=tuple(meshes), glyphs=(self._glyph(ghost, value),))

    def _mesh(self, index: int, *, glass: bool) -> PosedMesh:
        part = self.inference.assembly.parts[index]
        mine = index in self.moving
        color = _CHILD if index == self.child else _CARRIED if mine else _PARENT if index == self.parent else _REST
        look = plain((*color.tolist(), _GLASS), len(part.faces)) if glass and not mine else None
        return PosedMesh(vertices=part.vertices, faces=part.faces, color=color, appearance=look)

    def _glyph(self, option: JointCandidate, value: float) -> PosedMesh:
        part, size = self.inference.assembly.parts[self.child], self.inference.assembly.parts[self.child].diagonal
        middle, axis = part.bounds.mean(axis=0), option.axis * (1.0 if value >= 0.0 else -1.0)
        length = max(_OVERHANG * float(np.ptp(part.vertices @ axis)), _SHORTEST * size)
        radius = _THICKNESS * size
        if option.kind.turns:
            center = option.pivot + float((middle - option.pivot) @ axis) * axis
            vertices, faces = turning_arrow(center, axis, length, radius, np.radians(300.0))
        else:
            vertices, faces = sliding_arrow(middle, axis, length + 18.0 * radius, radius)
        return PosedMesh(vertices=vertices, faces=faces, color=_AXIS)


def joint_question(inference: Inference, place: int, maker: CandidateJoints | None) -> JointQuestion | None:
    """Draw the question about a joint; None where the moving part cannot be shown.

    Args:
        inference: With the joint at this place in `joints`.
        place: Of the joint.
        maker: Finds how far each option can move; None asks for the type alone, without options.
    """
    joint, config = inference.joints[place], inference.config.vision
    part = inference.assembly.parts[joint.child]
    options = () if maker is None else shuffled(offered(joint, part, config), part.mesh_hash)
    views = find_viewpoints(inference.assembly, joint.child, options, config)
    shown = _Shown(inference, joint.parent, joint.child, views, config)
    values = [_value(maker.realise(inference.trees[0], joint, item), item, shown) for item in options if maker]
    close = [view.camera(around(inference.assembly, [joint.child]), config.view_pixels, config)
             for view in (views.best, views.second)]  # fmt: skip
    pixels = min(_pixels(shown, camera) for camera in close)
    if pixels < config.least_pixels:
        return None
    rim = _RIM * part.diagonal / inference.assembly.diagonal
    preview = inference.config.preview.model_copy(
        update={
            "floor_cells": 16,
            "hidden_glyph": _HIDDEN_AXIS,
            "openness_rays": 2,
            "glyph_halo": rim,
            "openness_reach": _INSIDE if views.see_through else inference.config.preview.openness_reach,
        }
    )
    panels = [("whole object", _whole(shown, preview))]
    plainly = shown.scene(glass=views.see_through)
    panels += [(name, render_scene(plainly, camera, preview))
               for name, camera in zip(("close view", "close, from elsewhere"), close, strict=True)]  # fmt: skip
    for number, (option, value) in enumerate(zip(options, values, strict=True), 1):
        moved = shown.scene(glass=views.see_through, ghost=option, value=value)
        caption = f"{number}: {'turns' if option.kind.turns else 'slides'}"
        panels.append((caption, render_scene(moved, close[0], preview)))
    names = inference.assembly.names
    return JointQuestion(
        parent=names[joint.parent], child=names[joint.child], options=options, pixels=pixels,
        picture=_sheet(panels, config.view_pixels), see_through=views.see_through,
    )  # fmt: skip


def _pixels(shown: _Shown, camera: Camera) -> int:
    whole = shown.scene(glass=False)
    alone = PictureScene(meshes=(whole.meshes[shown.child],))
    seen, outline = part_pixels(whole, alone, shown.child, camera)
    return outline if shown.views.see_through else seen


def _whole(shown: _Shown, preview: PreviewConfig) -> Image.Image:
    """The whole object from the side of the best view, with a frame around the part that moves."""
    assembly, config = shown.inference.assembly, shown.config
    view: Viewpoint = shown.views.best
    camera = view.camera(corners(*assembly.bounds), config.view_pixels, config)
    image = render_scene(shown.scene(glass=False), camera, preview)
    box, _ = camera.project(corners(*assembly.parts[shown.child].bounds))
    (left, top), (right, bottom) = box.min(axis=0) - 5.0, box.max(axis=0) + 5.0
    ImageDraw.Draw(image).rectangle((float(left), float(top), float(right), float(bottom)), outline=_FRAME, width=2)
    return image


def _value(realised: JointEstimate, option: JointCandidate, shown: _Shown) -> float:
    """By how much the ghost of an option is moved along its axis [rad or m]: half its range, within bounds."""
    sign = 1.0 if float(realised.axis @ option.axis) >= 0.0 else -1.0
    far = realised.upper if realised.upper >= -realised.lower else realised.lower
    part = shown.inference.assembly.parts[shown.child]
    least, most = _TURN
    if not option.kind.turns:
        length = max(float(np.ptp(part.vertices @ option.axis)), _FLAT * part.diagonal)
        least, most = _SLIDE[0] * length, _SLIDE[1] * length
    half = 0.5 * far if np.isfinite(far) and realised.kind is not JointType.FIXED else most
    return sign * float(np.copysign(np.clip(abs(half), least, most), half or 1.0))


def _moved(vertices: FloatArray, option: JointCandidate, value: float) -> FloatArray:
    """Vertices after a motion, world frame [m], shape (V, 3)."""
    if not option.kind.turns:
        return np.asarray(vertices + value * option.axis)
    turn = rotation_about(option.axis, value)[:3, :3]
    return np.asarray((vertices - option.pivot) @ turn.T + option.pivot)


def _sheet(panels: Sequence[tuple[str, Image.Image]], side: int) -> Image.Image:
    """Panels in rows under their captions."""
    rows = -(-len(panels) // COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * side, rows * (side + CAPTION)), _PAPER)
    draw = ImageDraw.Draw(sheet)
    for index, (name, picture) in enumerate(panels):
        x, y = side * (index % COLUMNS), (side + CAPTION) * (index // COLUMNS)
        sheet.paste(picture, (x, y + CAPTION))
        draw.text((x + side // 2, y + CAPTION // 2), name, fill=_INK, font=ImageFont.load_default(17), anchor="mm")
        draw.rectangle((x, y, x + side - 1, y + side + CAPTION - 1), outline=(205, 208, 214))
    return sheet
