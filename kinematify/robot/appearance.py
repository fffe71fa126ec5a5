"""Appearance of a mesh: a material per triangle, with colour, opacity, roughness, metal and texture."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.robot.arrays import ReadOnlyArrays
from kinematify.robot.vectors import lengths_of, triangle_normals

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray

    Rgba = tuple[float, float, float, float]


def srgb_of(linear: NDArray[Any]) -> FloatArray:
    """Return linear light as sRGB in [0, 1], of the same shape; what is out of range is cut."""
    clipped = np.clip(np.asarray(linear, dtype=np.float64), 0.0, 1.0)
    values: FloatArray = np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)
    return values


def linear_of(srgb: NDArray[Any]) -> FloatArray:
    """Return sRGB in [0, 1] as linear light, of the same shape."""
    given = np.asarray(srgb, dtype=np.float64)
    values: FloatArray = np.where(given <= 0.04045, given / 12.92, ((given + 0.055) / 1.055) ** 2.4)
    return values


MAX_MATERIALS = 64
"""Of one mesh; every one becomes a mesh of its own in formats with a single colour per mesh."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Texture(ReadOnlyArrays):
    """A picture on a surface."""

    name: str
    """Of its file or in its file, for messages."""
    pixels: NDArray[np.uint8]
    """sRGB and opacity, shape (h, w, 4), the upper row first. Read-only."""

    def color_at(self, uv: FloatArray) -> FloatArray:
        """Return sRGB and opacity in [0, 1] of the nearest pixels, shape (n, 4); the picture repeats.

        Args:
            uv: To the right and up, in widths and heights of the picture from its lower left corner, shape (n, 2).
        """
        height, width = self.pixels.shape[:2]
        column = np.floor(np.mod(uv[:, 0], 1.0) * width).astype(np.int64) % width
        row = height - 1 - np.floor(np.mod(uv[:, 1], 1.0) * height).astype(np.int64) % height
        colors: FloatArray = self.pixels[row, column] / 255.0
        return colors


@dataclass(frozen=True, kw_only=True)
class Material:
    """Material of a surface to the eye, as glTF has it."""

    name: str = ""
    """As in the file; empty where it names none."""
    color: Rgba = (0.7, 0.7, 0.7, 1.0)
    """sRGB and opacity in [0, 1]; a texture is multiplied by it."""
    metallic: float = 0.0
    """0 for paint, plastic or wood, 1 for bare metal."""
    roughness: float = 0.8
    """0 for a mirror, 1 for chalk."""
    texture: Texture | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class Appearance(ReadOnlyArrays):
    """The materials of a mesh; it goes with the faces, so that vertices may be merged and moved without it."""

    materials: tuple[Material, ...]
    material_of_face: IntArray
    """Index into `materials`, shape (F,). Read-only."""
    uv: FloatArray | None = None
    """Place of the corners of every face in the texture, shape (F, 3, 2), see `Texture.color_at`; None: no texture.
    Read-only."""
    notes: tuple[str, ...] = field(default=())
    """What the file says and could not be read, one clause each, such as a texture that is not there."""

    def of_faces(self, index: IntArray) -> Appearance:
        """Return the appearance of some faces, in the order of their indices, shape (n,)."""
        return replace(
            self,
            material_of_face=self.material_of_face[index],
            uv=None if self.uv is None else self.uv[index],
        )

    def mirrored(self) -> Appearance:
        """Return the appearance of the same faces with their second and third corner exchanged."""
        return self if self.uv is None else replace(self, uv=self.uv[:, [0, 2, 1]])

    @cached_property
    def is_textured(self) -> bool:
        """True if a face shows a texture."""
        return self.uv is not None and any(self.materials[k].texture for k in np.unique(self.material_of_face))

    def colors_at(self, face: IntArray, barycentric: FloatArray) -> FloatArray:
        """Return sRGB and opacity in [0, 1] at points on faces, shape (n, 4).

        Args:
            face: Shape (n,).
            barycentric: Weights of the face's corners, shape (n, 3).
        """
        chosen = self.material_of_face[face]
        colors: FloatArray = np.array([material.color for material in self.materials])[chosen]
        for index, material in enumerate(self.materials):
            at = np.flatnonzero(chosen == index)
            if material.texture is not None and self.uv is not None and len(at):
                uv = np.einsum("nc,nck->nk", barycentric[at], self.uv[face[at]])
                colors[at] *= material.texture.color_at(uv)
        return colors

    def mean_color(self, vertices: FloatArray, faces: IntArray) -> Rgba:
        """Return the mean of the colours, sRGB and opacity, weighted by area.

        Args:
            vertices: Shape (V, 3).
            faces: Those that this is the appearance of, shape (F, 3).
        """
        areas = lengths_of(triangle_normals(vertices[faces]))
        spots = np.array([[2, 1, 1], [1, 2, 1], [1, 1, 2]]) / 4.0
        seen = [self.colors_at(np.arange(len(faces)), np.tile(spot, (len(faces), 1))) for spot in spots]
        weights = areas if areas.sum() > 0.0 else np.ones(len(faces))
        red, green, blue, opacity = np.average(np.mean(seen, axis=0), axis=0, weights=weights).tolist()
        return red, green, blue, opacity

    def with_few_materials(self) -> Appearance:
        """Return it with at most `MAX_MATERIALS` materials: like colours become one where there are more."""
        used, index = np.unique(self.material_of_face, return_inverse=True)
        materials = tuple(self.materials[k] for k in used)
        if len(materials) <= MAX_MATERIALS:
            return replace(self, materials=materials, material_of_face=index)
        return painted(np.array([material.color for material in materials])[index], notes=self.notes)


def plain(color: Rgba, faces: int) -> Appearance:
    """Return the appearance of a mesh of one colour, sRGB and opacity."""
    return of_one(Material(color=color), faces)


def of_one(material: Material, faces: int, uv: FloatArray | None = None, notes: tuple[str, ...] = ()) -> Appearance:
    """Return the appearance of so many faces of one material; other arguments as in `Appearance`."""
    return Appearance(materials=(material,), material_of_face=np.zeros(faces, dtype=np.int64), uv=uv, notes=notes)


def painted(colors: FloatArray, notes: tuple[str, ...] = ()) -> Appearance:
    """Return materials for colours of faces, at most `MAX_MATERIALS`: the steps of the colours grow until they fit.

    Args:
        colors: sRGB and opacity in [0, 1], shape (F, 4).
        notes: As in `Appearance`.
    """
    for steps in (255, 85, 51, 31, 15, 10, 7, 5, 3):
        rounded, index = np.unique(np.round(colors * steps), axis=0, return_inverse=True)
        if len(rounded) <= MAX_MATERIALS or steps == 3:
            break
    index = index.reshape(-1)
    count = np.bincount(index)[:, None]
    means = np.stack([np.bincount(index, weights=channel) for channel in colors.T], axis=1) / count
    materials = tuple(Material(color=(r, g, b, a)) for r, g, b, a in means.tolist())
    return Appearance(materials=materials, material_of_face=index, notes=notes)


def joined(appearances: Sequence[Appearance | None], faces: Sequence[int]) -> Appearance | None:
    """Return the appearance of meshes that become one; None if none has one.

    Args:
        appearances: Of each mesh; what has none becomes grey.
        faces: Number of faces of each mesh.
    """
    if not any(appearances):
        return None
    known = [one or plain(Material().color, count) for one, count in zip(appearances, faces, strict=True)]
    materials = tuple(dict.fromkeys(material for one in known for material in one.materials))
    place = {material: index for index, material in enumerate(materials)}
    chosen = [np.array([place[item] for item in one.materials], dtype=np.int64)[one.material_of_face] for one in known]
    uv = None
    if any(one.uv is not None for one in known):
        uv = np.concatenate(
            [np.zeros((count, 3, 2)) if one.uv is None else one.uv for one, count in zip(known, faces, strict=True)]
        )
    notes = tuple(dict.fromkeys(note for one in known for note in one.notes))
    return Appearance(materials=materials, material_of_face=np.concatenate(chosen), uv=uv, notes=notes)


@dataclass(frozen=True, kw_only=True, eq=False)
class Surface:
    """The faces of one material."""

    material: Material
    vertices: FloatArray
    """Shape (V, 3); doubled where the texture has a seam."""
    faces: IntArray
    """Shape (F, 3)."""
    uv: FloatArray | None
    """Place of every vertex in the texture, shape (V, 2); None without a texture."""


def surfaces(vertices: FloatArray, faces: IntArray, appearance: Appearance) -> tuple[Surface, ...]:
    """Return a mesh cut into its materials, in the order of these.

    Args:
        vertices: Shape (V, 3).
        faces: Shape (F, 3).
        appearance: Of these faces.
    """
    found = []
    for index, material in enumerate(appearance.materials):
        at = np.flatnonzero(appearance.material_of_face == index)
        if not len(at):
            continue
        corners = faces[at].reshape(-1)
        uv: FloatArray | None = None
        if material.texture is None or appearance.uv is None:
            used, inverse = np.unique(corners, return_inverse=True)
            points = vertices[used]
        else:
            rows = np.column_stack([corners, appearance.uv[at].reshape(-1, 2)])
            distinct, inverse = np.unique(rows, axis=0, return_inverse=True)
            points, uv = vertices[distinct[:, 0].astype(np.int64)], np.asarray(distinct[:, 1:], dtype=np.float64)
        found.append(Surface(material=material, vertices=points, faces=inverse.reshape(-1, 3), uv=uv))
    return tuple(found)
