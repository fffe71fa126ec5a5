"""Pictures of a joint for somebody who knows everyday things: from the front, the side, above, and at an angle.

They are ray cast, so that no OpenGL is needed. A small opening angle makes them nearly orthographic: what is parallel
looks parallel.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from kinematify.render.camera import fit_camera
from kinematify.render.picture import PictureScene, PosedMesh, render_scene
from kinematify.vision.answer import JointQuestion

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import PreviewConfig, VisionConfig

_CHILD, _PARENT, _REST = np.array([0.85, 0.13, 0.12]), np.array([0.45, 0.62, 0.9]), np.array([0.8, 0.8, 0.8])
_VIEWS = (("front", -90.0, 2.0), ("from the right", 0.0, 2.0), ("from above", -90.0, 84.0))
_CLOSE = ("the moving part, close", -60.0, 30.0)
_CAPTION, _MARGIN = 22, 12  # [pixels]
_INK, _PAPER = (30, 34, 42), (255, 255, 255)

PROMPT = (
    "The pictures show one object made of rigid parts, standing upright. The part in red moves against the part in "
    "blue; all other parts are grey. Views: from the front, from the right, from above, and a close view. Directions "
    "are those of a person in front of the object: 'vertical' is up and down, 'sideways' is left and right "
    "in the front view, 'depth' is towards and away from the viewer. Say how the red part moves in real life. "
    "axis_direction: the direction of the axis that it turns about, or of the line that it slides along. hinge_side: "
    "the side of the red part at which that axis lies, 'middle' if the axis goes through its middle or if it slides. "
    "Answer 'unsure' to whatever the pictures do not show."
)


def joint_question(
    assembly: Assembly, parent: int, child: int, *, config: VisionConfig, preview: PreviewConfig
) -> JointQuestion:
    """Draw a joint.

    Args:
        assembly: The parts, z up; its front looks along -y.
        parent: Part that the other one hangs on.
        child: Part that moves.
        config: Size and opening angle.
        preview: Quality of the pictures.
    """
    colors = {child: _CHILD, parent: _PARENT}
    whole = [
        PosedMesh(vertices=part.vertices, faces=part.faces, color=colors.get(index, _REST))
        for index, part in enumerate(assembly.parts)
    ]
    scene = PictureScene(meshes=tuple(whole))
    points = np.concatenate([part.bounds for part in assembly.parts])
    corners = _corners(points.min(axis=0), points.max(axis=0))
    views = [_view(scene, corners, (azimuth, elevation), config, preview) for _, azimuth, elevation in _VIEWS]
    low, high = assembly.parts[child].bounds
    room = 0.35 * (high - low) + 0.02 * assembly.diagonal
    views.append(_view(scene, _corners(low - room, high + room), _CLOSE[1:], config, preview))
    names = [name for name, _, _ in (*_VIEWS, _CLOSE)]
    return JointQuestion(
        parent=assembly.names[parent], child=assembly.names[child], picture=_sheet(views, names, config.view_pixels)
    )


def _corners(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    picks = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T
    return np.where(picks, high, low)


def _view(
    scene: PictureScene, points: np.ndarray, place: tuple[float, float], config: VisionConfig, preview: PreviewConfig
) -> Image.Image:
    """Draw from an azimuth and an elevation [deg]."""
    azimuth, elevation = place
    camera = fit_camera(
        points, azimuth=float(np.radians(azimuth)), elevation=float(np.radians(elevation)),
        field_of_view=float(np.radians(config.field_of_view)), size=(config.view_pixels, config.view_pixels),
        margin=_MARGIN,
    )  # fmt: skip
    return render_scene(scene, camera, preview)


def _sheet(views: Sequence[Image.Image], names: Sequence[str], side: int) -> Image.Image:
    sheet = Image.new("RGB", (2 * side, 2 * (side + _CAPTION)), _PAPER)
    draw = ImageDraw.Draw(sheet)
    for index, (view, name) in enumerate(zip(views, names, strict=True)):
        x, y = side * (index % 2), (side + _CAPTION) * (index // 2)
        sheet.paste(view, (x, y + _CAPTION))
        draw.text((x + side // 2, y + _CAPTION // 2), name, fill=_INK, font=ImageFont.load_default(14), anchor="mm")
    return sheet
