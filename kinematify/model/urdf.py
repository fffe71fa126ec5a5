"""Writing a model as URDF with one OBJ per mesh, in the subset that every engine reads the same way."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.model.output import MODEL_FILE
from kinematify.robot.appearance import linear_of, srgb_of
from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.robot import Link, LinkMesh, Robot, Shape
from kinematify.robot.vectors import lengths_of
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from kinematify.assembly.part import Part
    from kinematify.model.kinematic_model import KinematicModel, ModelLink
    from kinematify.robot.appearance import Rgba
    from kinematify.robot.arrays import FloatArray


MESH_FOLDER = "meshes"
_MAX_STEM = 100  # file systems end at 255 bytes for a name


def write_urdf(model: KinematicModel, folder: Path) -> Path:
    """Write ``model.urdf`` and ``meshes/*.obj`` into an existing folder.

    Meshes stand in their link's frame, so visual and collision origins are zero. Link and joint frames are written
    with all digits: forward kinematics at zero reproduces the input.

    Args:
        model: What to write.
        folder: An existing folder.

    Returns:
        The path of the URDF.

    Raises:
        OSError: The folder cannot be written.
    """
    return write_model(model_robot(model), folder)


def write_model(robot: Robot, folder: Path) -> Path:
    """Write ``model.urdf`` and the meshes that its shapes name, relative to it, into an existing folder.

    Raises:
        OSError: The folder cannot be written.
        ValueError: A mesh shape names no file.
    """
    (folder / MESH_FOLDER).mkdir(exist_ok=True)
    shapes = (shape for link in robot.links for shape in (*link.visuals, *link.collisions))
    for file, mesh in {shape.file: shape.mesh for shape in shapes if shape.file is not None}.items():
        write_obj(folder / file, mesh.vertices, mesh.faces, OBJ_DIGITS, mesh.appearance)
    return write_robot(robot, folder / MODEL_FILE)


def model_robot(model: KinematicModel) -> Robot:
    """Return the model as its URDF describes it; mesh files are named, relative to the URDF, and not written yet."""
    colors = link_colors(model)
    taken: set[str] = set()
    return Robot(
        name=model.name,
        links=tuple(_link(link, np.round(colors[link.name], 4), taken) for link in model.links),
        joints=model.joints,
        loops=model.loops,
    )


def _link(link: ModelLink, color: FloatArray, taken: set[str]) -> Link:
    origin = link.T_world_link[:3, 3]
    # A set-aside part may have no face at all: engines refuse such a file, and there is nothing to see.
    shown = [link.visual, *(part for part in link.fixed_visuals if len(part.faces))]
    visuals = tuple(_shape(part, origin, taken, _color(part, color)) for part in shown)
    return Link(
        name=link.name,
        inertial=link.inertial,
        visuals=visuals,
        collisions=tuple(_shape(part, origin, taken) for part in link.collision_parts) or visuals[:1],
    )


def _color(part: Part, usual: FloatArray) -> Rgba:
    """The one colour of a mesh that is written beside its materials, for readers that know no others."""
    red, green, blue = (round(value, 4) for value in part.color or usual.tolist())
    opacity = 1.0 if part.appearance is None else part.appearance.mean_color(part.vertices, part.faces)[3]
    return red, green, blue, round(opacity, 4)


def _shape(part: Part, origin: FloatArray, taken: set[str], color: Rgba | None = None) -> Shape:
    """A mesh in the link frame, which has world orientation, with a file name that is distinct on every file system."""
    used, inverse = np.unique(part.faces, return_inverse=True)
    stem = re.sub(r"[^A-Za-z0-9_-]", "_", part.name)[:_MAX_STEM] or "part"
    name, number = stem, 1
    while name.casefold() in taken:
        number += 1
        name = f"{stem}_{number}"
    taken.add(name.casefold())
    return Shape(
        mesh=LinkMesh(vertices=part.vertices[used] - origin, faces=inverse.reshape(-1, 3), appearance=part.appearance),
        file=Path(MESH_FOLDER, f"{name}.obj"),
        color=color,
    )


_GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))  # never repeats, and neighbours in order lie far apart
_FIRST_HUE = 0.75  # [rad] a warm orange
_LIGHTNESS = np.array([0.72, 0.64, 0.80])  # cycled, so that similar hues still differ
_CHROMA = 0.125  # inside sRGB for all hues at these lightnesses but for a little clipping
_ROOT = (0.83, 0.008, 1.2)  # a light warm grey: what stands still stays in the background
_SHADES = (1.0, 0.72, 1.35, 0.52)  # of the light of a material: plainly lighter or darker, and still that material
_ALIKE = 0.1  # of the sides of sRGB: swatches that are nearer are not distinguished

# OKLab to linear sRGB (Ottosson, "A perceptual color space for image processing", 2020).
_OKLAB_TO_LMS = np.array([[1, 0.3963377774, 0.2158037573], [1, -0.1055613458, -0.0638541728],
                          [1, -0.0894841775, -1.2914855480]])  # fmt: skip
_LMS_TO_RGB = np.array([[4.0767416621, -3.3077115913, 0.2309699292], [-1.2684380046, 2.6097574011, -0.3413193965],
                        [-0.0041960863, -0.7034186147, 1.7076147010]])  # fmt: skip


def link_colors(model: KinematicModel) -> dict[str, FloatArray]:
    """Colour of every link: its part's own, else grey for the root and distinct hues of like strength for all others.

    Returns:
        Link name -> sRGB in [0, 1], shape (3,).
    """
    names = [model.root, *(link.name for link in model.links if link.name != model.root)]
    colors = dict(zip(names, usual_colors(len(names)), strict=True))
    known = {link.name: np.array(link.part.color) for link in model.links if link.part.color is not None}
    return {**colors, **known}


def usual_colors(count: int) -> list[FloatArray]:
    """Colours of links that have none: grey for the root link, which is the first, distinct hues for the others.

    Returns:
        sRGB in [0, 1], each of shape (3,).
    """
    hues = (_FIRST_HUE + index * _GOLDEN_ANGLE for index in range(count - 1))
    lights = (float(_LIGHTNESS[index % len(_LIGHTNESS)]) for index in range(count - 1))
    return [_oklch(*_ROOT), *(_oklch(light, _CHROMA, hue) for light, hue in zip(lights, hues, strict=True))][:count]


def link_shades(model: KinematicModel) -> dict[str, float]:
    """Factors on the light of links that tell apart what is of one material; 1 where the colour alone does.

    Returns:
        Link name -> factor.
    """
    colors, shades, taken = link_colors(model), {}, np.empty((0, 3))
    for name in (model.root, *(joint.child for joint in model.joints)):
        linear = linear_of(colors[name])
        offered = [min(shade, 1.0 / max(float(linear.max()), 1e-3)) for shade in _SHADES]
        shown = srgb_of(np.outer(offered, linear))
        nearest = lengths_of(shown[:, None] - taken).min(axis=1, initial=np.inf)
        best = 0 if nearest[0] > _ALIKE else int(nearest.argmax())
        shades[name] = offered[best]
        taken = np.concatenate([taken, shown[best : best + 1]])
    return shades


def distinct_colors(colors: FloatArray) -> bool:
    """True if all of some colours differ to the eye.

    Args:
        colors: sRGB in [0, 1], shape (n, 3).
    """
    apart = lengths_of(colors[:, None] - colors)
    return bool((apart[~np.eye(len(colors), dtype=bool)] > _ALIKE).all())


def _oklch(lightness: float, chroma: float, hue: float) -> FloatArray:
    """OKLCh (hue in rad) to sRGB in [0, 1], shape (3,)."""
    lab = np.array([lightness, chroma * np.cos(hue), chroma * np.sin(hue)])
    return srgb_of(_LMS_TO_RGB @ (_OKLAB_TO_LMS @ lab) ** 3)
