"""Pictures of a whole model: at rest beside moved."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from kinematify.config import load_config
from kinematify.model.urdf import distinct_colors, link_colors, link_shades, usual_colors
from kinematify.processes.forked import each
from kinematify.render.model_scene import (
    GLYPH_COLORS,
    best_azimuth,
    glyph_color,
    joint_glyphs,
    moving_joints,
    opened_configuration,
    posed_meshes,
)
from kinematify.render.picture import (
    BACKGROUND,
    INK,
    PictureScene,
    PosedMesh,
    camera_for,
    in_bytes,
    render_scene,
    row_of,
)
from kinematify.robot.appearance import linear_of, srgb_of
from kinematify.robot.transforms import transformed

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.config import PreviewConfig
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.render.camera import Camera
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot

_FAINT = (120, 126, 138)
MARGIN = 34  # [pixels] around the object in a panel
_ROBOT_MARGIN = 24.0  # [pixels] around a robot alone
_LEAST_SHARE = 60  # [percent] of the configured width and height that a panel keeps in any case
_CAPTION, _CAPTION_MIDDLE = 46, 29  # [pixels] height of the line above a panel, and where its words are
_LEGEND_ROW = 30  # [pixels]
_LEGEND_COLUMN = 370  # [pixels] room for a swatch, a name and a type
_LEGEND_PAD = 24  # [pixels]
_BADGE = 12  # [pixels] radius of a number on a part
_BADGE_STEP = 3  # [pixels] steps in which its place is sought


@dataclass(frozen=True)
class PreviewPanel:
    """What a panel shows."""

    caption: str
    scene: PictureScene
    numbers: tuple[int, ...] = ()
    """Of the legend, one per mesh of the scene; empty where colours distinguish them."""


@dataclass(frozen=True)
class _Entry:
    """One line of the legend."""

    color: FloatArray
    """sRGB of the swatch, shape (3,)."""
    name: str
    kind: str
    ink: tuple[int, int, int]
    """Colour of the word for the kind."""
    number: int | None = None
    """As it stands on the part; None where colours distinguish parts."""


def render_preview(model: KinematicModel, path: Path, config: PreviewConfig, robot: Robot | None = None) -> None:
    """Write a PNG with the model at rest and with every joint moved, side by side, and a legend of its joints.

    Args:
        model: What to show.
        path: PNG file to write.
        config: Size and quality.
        robot: As of `opened_configuration`.

    Raises:
        OSError: The file cannot be written.
    """
    write_sheet(model, rest_and_moved(model, config, ("at rest", "every joint moved"), robot), config, path)


def draw_robot(robot: Robot, poses: Mapping[str, FloatArray], azimuth: float) -> Image.Image:
    """Draw what is seen of a robot that has geometry.

    Args:
        robot: In the colours of its file; links without have distinct ones.
        poses: Of every link, world frame, shape (4, 4) each.
        azimuth: Of the camera, from x towards y [rad].
    """
    colors, config = usual_colors(len(robot.links)), load_config().preview
    scene = PictureScene(
        meshes=tuple(
            PosedMesh(
                vertices=transformed(mesh.vertices, poses[link.name]),
                faces=mesh.faces,
                color=color,
                appearance=mesh.appearance,
            )
            for link, color in zip(robot.links, colors, strict=True)
            for mesh in link.meshes
            if len(mesh.faces)
        )
    )
    size = (config.panel_width, config.panel_height)
    return render_scene(scene, camera_for([scene], azimuth, config, size=size, margin=_ROBOT_MARGIN), config)


def rest_and_moved(
    model: KinematicModel, config: PreviewConfig, captions: tuple[str, str], robot: Robot | None = None
) -> tuple[PreviewPanel, PreviewPanel]:
    """Panels of a model at rest and with every joint moved (`opened_configuration`), with their captions."""
    number_of = {entry.name: entry.number for entry in _legend_entries(model)}
    numbers = tuple(number for name in _drawn_links(model) if (number := number_of[name]) is not None)
    rest, moved = (
        PreviewPanel(caption, scene_of(model, q, config), numbers)
        for caption, q in zip(captions, ({}, opened_configuration(model, config, robot)), strict=True)
    )
    return rest, moved


def _drawn_links(model: KinematicModel) -> list[str]:
    """Names of all links, moving ones first."""
    moving = [joint.child for joint in moving_joints(model)]
    return [*moving, *(link.name for link in model.links if link.name not in set(moving))]


def scene_of(model: KinematicModel, q: Mapping[str, float], config: PreviewConfig) -> PictureScene:
    """All links in shades of their colours, moving ones first, and the arrows of their joints."""
    meshes = posed_meshes(model, q, link_colors(model), link_shades(model))
    return PictureScene(
        meshes=tuple(meshes[name] for name in _drawn_links(model)),
        glyphs=tuple(joint_glyphs(model, q, config).values()),
    )


def write_sheet(model: KinematicModel, panels: Sequence[PreviewPanel], config: PreviewConfig, path: Path) -> None:
    """Write a PNG with panels in a row under their captions, the legend below."""
    size, images = draw_panels(model, panels, config)
    legend = _legend(model, config, size[0] * len(panels))
    captions = [panel.caption for panel in panels]
    sheet = row_of(images, captions, above=_CAPTION, middle=_CAPTION_MIDDLE, below=legend.height)
    sheet.paste(legend, (0, _CAPTION + size[1]))
    sheet.save(path, "PNG", compress_level=4)  # half the time of the default, a file 5 % larger


def draw_panels(
    model: KinematicModel, panels: Sequence[PreviewPanel], config: PreviewConfig
) -> tuple[tuple[int, int], list[Image.Image]]:
    """Width and height of all panels, and what each shows; the last two are seen by the same camera."""
    shared = [panel.scene for panel in panels[-2:]]
    azimuth = best_azimuth(model, shared, config)
    groups = [shared if panel.scene in shared else [panel.scene] for panel in panels]
    size = panel_size(groups, azimuth, config)

    def drawn(number: int) -> Image.Image:
        panel = panels[number]
        camera = camera_for(groups[number], azimuth, config, size=size, margin=MARGIN)
        image = render_scene(panel.scene, camera, config)
        if panel.numbers and panel.caption:
            _draw_numbers(image, panel, camera)
        return image

    return size, each(drawn, range(len(panels)))


def _draw_numbers(image: Image.Image, panel: PreviewPanel, camera: Camera) -> None:
    """Write its number on each mesh where most of it is seen around; small ones first, none over others or arrows."""
    from scipy.ndimage import distance_transform_edt  # noqa: PLC0415 - a tenth of a second, and few have numbers

    seen = panel.scene.mesh_of_pixel(camera, _BADGE_STEP)
    if panel.scene.glyphs_alone is not None:
        seen[panel.scene.glyphs_alone.mesh_of_pixel(camera, _BADGE_STEP) >= 0] = -1
    rows, columns = np.ogrid[: seen.shape[0], : seen.shape[1]]
    for mesh in np.argsort([np.count_nonzero(seen == mesh) for mesh in range(len(panel.numbers))]):
        inside = distance_transform_edt(seen == mesh)
        row, column = (int(index) for index in np.unravel_index(inside.argmax(), inside.shape))
        if inside[row, column] > 0.0:
            _draw_badge(ImageDraw.Draw(image), (_BADGE_STEP * column, _BADGE_STEP * row), panel.numbers[mesh])
            seen[np.hypot(rows - row, columns - column) < 2 * _BADGE / _BADGE_STEP] = -1


def _draw_badge(draw: ImageDraw.ImageDraw, center: tuple[int, int], number: int) -> None:
    draw.circle(center, _BADGE, fill=(255, 255, 255), outline=INK)
    draw.text(center, str(number), fill=INK, font=ImageFont.load_default(15), anchor="mm")


def panel_size(groups: Sequence[Sequence[PictureScene]], azimuth: float, config: PreviewConfig) -> tuple[int, int]:
    """Width and height that all panels need: less than configured where everything shown is slim or flat."""
    largest = (config.panel_width, config.panel_height)
    needed = np.zeros(2)
    for group in groups:
        camera = camera_for(group, azimuth, config, size=largest, margin=MARGIN)
        seen, _ = camera.project(np.concatenate([scene.outline for scene in group]))
        needed = np.maximum(needed, np.ptp(seen, axis=0) + 2.0 * MARGIN)
    least = [_LEAST_SHARE * pixels // 100 for pixels in largest]
    width, height = (max(round(float(need)), few) for need, few in zip(needed, least, strict=True))
    return min(width, largest[0]), min(height, largest[1])


def _legend(model: KinematicModel, config: PreviewConfig, width: int) -> Image.Image:
    """Swatch, part and joint type of the base and every joint, in columns; what does not fit is counted."""
    entries = _legend_entries(model)
    hidden = max(len(entries) - config.legend_entries, 0)
    rows = -(-min(len(entries), config.legend_entries) // (columns := max(width // _LEGEND_COLUMN, 1)))
    image = Image.new("RGB", (width, _LEGEND_ROW * (rows + (hidden > 0)) + 2 * _LEGEND_PAD), in_bytes(BACKGROUND))
    draw = ImageDraw.Draw(image)
    for index, entry in enumerate(entries[: config.legend_entries]):
        row, column = divmod(index, columns)
        corner = (_LEGEND_PAD + column * (width // columns), _LEGEND_PAD + row * _LEGEND_ROW)
        _draw_entry(draw, corner, entry)
    if hidden:
        place = (_LEGEND_PAD, _LEGEND_PAD + rows * _LEGEND_ROW + _LEGEND_ROW // 2)
        draw.text(place, f"and {hidden} more", fill=_FAINT, font=ImageFont.load_default(17), anchor="lm")
    return image


def _legend_entries(model: KinematicModel) -> list[_Entry]:
    shades = link_shades(model)
    colors = link_colors(model)
    shown = {name: srgb_of(shades[name] * linear_of(color)) for name, color in colors.items()}
    entries = [_Entry(shown[model.root], model.root, "base", _FAINT)]
    for joint in model.joints:
        moves = joint.kind in GLYPH_COLORS
        ink = in_bytes(glyph_color(joint.kind, colors[joint.child])) if moves else _FAINT
        entries.append(_Entry(shown[joint.child], joint.child, joint.kind.value, ink))
    if distinct_colors(np.array([entry.color for entry in entries])):
        return entries
    return [replace(entry, number=index) for index, entry in enumerate(entries, start=1)]


def _draw_entry(draw: ImageDraw.ImageDraw, corner: tuple[int, int], entry: _Entry) -> None:
    left, middle = corner[0], corner[1] + _LEGEND_ROW // 2
    font = ImageFont.load_default(17)
    draw.rounded_rectangle((left, middle - 8, left + 16, middle + 8), radius=4, fill=in_bytes(entry.color))
    left += 26
    if entry.number is not None:
        _draw_badge(draw, (left + _BADGE, middle), entry.number)
        left += 2 * _BADGE + 8
    name = _shortened(entry.name, font, _LEGEND_COLUMN - 92 - font.getlength(entry.kind))
    draw.text((left, middle), name, fill=INK, font=font, anchor="lm")
    after = left + 10 + font.getlength(name)
    draw.text((after, middle), entry.kind, fill=entry.ink, font=font, anchor="lm")


def _shortened(name: str, font: ImageFont.FreeTypeFont | ImageFont.ImageFont, room: float) -> str:
    """The name, its end replaced by dots where it does not fit [pixels]."""
    if font.getlength(name) <= room:
        return name
    kept = next(count for count in range(len(name), -1, -1) if font.getlength(name[:count] + "...") <= room)
    return name[:kept] + "..."
