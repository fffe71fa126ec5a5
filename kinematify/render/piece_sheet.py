"""The sheet: one picture in which every piece of a mesh has a flat colour and its number, where it can be seen."""

from __future__ import annotations

import colorsys
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from scipy.ndimage import distance_transform_edt, find_objects

from kinematify.geometry.rays import RayScene
from kinematify.render.camera import fit_camera
from kinematify.robot.vectors import box_around, lengths_of

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from kinematify.assembly.part import Part
    from kinematify.render.camera import Camera
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray

    Seen = tuple[IntArray, FloatArray, FloatArray]
    """Number of the piece (-1 for none), depth and normal of every pixel."""

_SIDE, _PROBE, _COLUMNS, _PANELS, _WHOLE = 560, 160, 3, 6, 3
_VIEWS = np.radians([(azimuth, height) for height in (-20.0, 20.0, 50.0) for azimuth in np.arange(22.5, 360.0, 45.0)])
"""Azimuth and elevation of the camera: eight sides, never straight at a face, from three heights."""
_TOWARDS = np.column_stack([f(_VIEWS[:, 0]) * np.cos(_VIEWS[:, 1]) for f in (np.cos, np.sin)] + [np.sin(_VIEWS[:, 1])])
_FIELD = np.radians(20.0)
_ENOUGH, _FEW, _LITTLE = 40, 300, 120  # pixels: of a probe; of a panel below which a piece counts as hidden, or as tiny
_TINY, _CLOSE = 0.08, 0.16  # of the object's longest side: tiny pieces, and what is near them
_ROOM = 0.04  # around what is seen close
_APART = 0.8  # pulled apart, pieces are so much farther from the middle
_MOST_APART = 25
_FONT = ImageFont.load_default(15)


def draw_sheet(parts: Sequence[Part]) -> Image.Image:
    """Draw up to six panels: whole views, hidden pieces over pale outlines, tiny ones close, and pulled apart.

    Args:
        parts: By their numbers, from 1; world frame, z up.
    """
    sheet = _Sheet(parts)
    panels = sheet.panels()
    rows = -(-len(panels) // _COLUMNS)
    picture = Image.new("RGB", (min(len(panels), _COLUMNS) * _SIDE, rows * _SIDE), "white")
    for k, panel in enumerate(panels):
        picture.paste(panel, (_SIDE * (k % _COLUMNS), _SIDE * (k // _COLUMNS)))
    return picture.quantize(128, dither=Image.Dither.NONE)


def piece_colors(count: int) -> FloatArray:
    """Colour of each number, sRGB, shape (count, 3)."""
    return np.array([
        colorsys.hls_to_rgb(k * 0.618034 % 1.0, (0.62, 0.5, 0.75)[k % 3], (0.75, 0.6, 0.85)[k // 3 % 3])
        for k in range(count)
    ])  # fmt: skip


class _Sheet:
    """What all panels share."""

    def __init__(self, parts: Sequence[Part]) -> None:
        self.parts, self.all = parts, list(range(len(parts)))
        self.low, self.high = box_around([part.bounds for part in parts])
        self.size = max(float((self.high - self.low).max()), 1e-300)
        self.middles = np.array([part.bounds.mean(axis=0) for part in parts])
        self.colors = piece_colors(len(parts))
        self.best = np.zeros(len(parts))
        """Pixels of each piece in the panel that shows most of it."""

    def panels(self) -> list[Image.Image]:
        """Panels until every piece was shown well, or there are six."""
        found = [self._panel(self.all, view) for view in self._views(self.all, _WHOLE)]
        tiny = [k for k in self.all if self.parts[k].diagonal < _TINY * self.size and self.best[k] < _LITTLE]
        hidden = [k for k in self.all if self.best[k] < _FEW and k not in tiny]
        while hidden and len(found) < _PANELS - bool(tiny):
            for view in self._views(hidden, 2 if len(hidden) > _WHOLE else 1)[: _PANELS - len(found)]:
                found.append(self._panel(hidden, view, "hidden pieces, "))
            still = [k for k in hidden if self.best[k] < _FEW / 2]
            hidden = still if len(still) < len(hidden) else []
        while tiny and len(found) < _PANELS:
            near = self._cluster(tiny)
            seen = self._probe(near, self.all)
            view = int(seen.sum(axis=1).argmax())
            hid = bool((seen[view] < _ENOUGH / 8).mean() > 0.5)
            if hid:
                view = int(self._probe(near, near).sum(axis=1).argmax())
            found.append(self._panel(near if hid else self.all, view, "close, ", focus=near))
            tiny = [k for k in tiny if k not in near]
        if len(found) < _PANELS and 3 <= len(self.parts) <= _MOST_APART:
            found.append(self._panel(self.all, self._views(self.all, 1)[0], "pulled apart, ", apart=_APART))
        return found

    def _cluster(self, tiny: Sequence[int]) -> list[int]:
        """Those near the piece that has most others near it."""
        apart: BoolArray = lengths_of(self.middles[tiny][:, None] - self.middles[tiny]) < _CLOSE * self.size
        return [tiny[k] for k in np.flatnonzero(apart[apart.sum(axis=1).argmax()]).tolist()]

    def _vertices(self, k: int, apart: float = 0.0) -> FloatArray:
        return np.asarray(self.parts[k].vertices + apart * (self.middles[k] - 0.5 * (self.low + self.high)))

    def _scene(self, pieces: Sequence[int], apart: float = 0.0) -> RayScene:
        return RayScene([(self._vertices(k, apart), self.parts[k].faces) for k in pieces])

    def _probe(self, pieces: Sequence[int], among: Sequence[int]) -> IntArray:
        """Pixels of pieces from every view, with others in front of them, shape (views, pieces)."""
        scene = self._scene(among)
        region = self._region(pieces) if len(pieces) < len(self.all) and among == self.all else scene.vertices
        found = [_seen(scene, _camera(region, view, _PROBE))[0] for view in range(len(_VIEWS))]
        counts = np.array([np.bincount(ids[ids >= 0], minlength=len(among)) for ids in found])
        return counts[:, [among.index(k) for k in pieces]]

    def _views(self, pieces: Sequence[int], most: int) -> list[int]:
        """Views that together show most pieces; small pieces count as much as large ones."""
        counts = self._probe(pieces, pieces)
        like = np.select([_VIEWS[:, 1] < 0.0, _VIEWS[:, 1] < 0.5], [0.8, 1.06], 1.0)
        filled = 0.002 * len(pieces) * counts.sum(axis=1) / max(counts.sum(axis=1).max(), 1)
        got, chosen = np.zeros(len(pieces)), list[int]()
        for _ in range(most):
            shown = np.minimum(np.maximum(got, counts), _ENOUGH).sum(axis=1) / _ENOUGH
            worth = (shown + filled) * like
            for other in chosen:
                worth[_TOWARDS @ _TOWARDS[other] > 0.6] = -1.0
            best = int(worth.argmax())
            if chosen and shown[best] - np.minimum(got, _ENOUGH).sum() / _ENOUGH < 0.25:
                break
            chosen.append(best)
            got = np.maximum(got, counts[best])
        return chosen

    def _region(self, pieces: Sequence[int]) -> FloatArray:
        low, high = box_around([self.parts[k].bounds for k in pieces])
        room = max(0.15 * float(np.linalg.norm(high - low)), _ROOM * self.size)
        return np.array([low - room, high + room])[np.indices((2, 2, 2)).reshape(3, -1).T, range(3)]

    def _panel(
        self, solid: Sequence[int], view: int, note: str = "", *, focus: Sequence[int] = (), apart: float = 0.0
    ) -> Image.Image:
        """One panel: coloured pieces with numbers, the others pale."""
        scene = self._scene(solid, apart)
        whole = scene if len(solid) == len(self.all) else self._scene(self.all)
        camera = _camera(self._region(focus) if len(focus) else whole.vertices, view, _SIDE)
        ids, depth, normal = _seen(scene, camera)
        right, down, forward = camera.axes
        light = np.clip(normal @ (-0.75 * forward - 0.45 * down - 0.35 * right), 0.0, 1.0)
        pixels = np.where((ids >= 0)[..., None], self.colors[solid][ids] * (0.62 + 0.38 * light)[..., None], 1.0)
        border, crease = _edges(ids, depth, normal, scene.size)
        pixels[crease] *= 0.6
        if whole is not scene:
            pale = _seen(whole, camera)
            pixels[(pale[0] >= 0) & (ids < 0)] = 0.93
            around = np.logical_or(*_edges(*pale, whole.size)) & (
                pale[1] < np.where(ids < 0, np.inf, depth - 1e-3 * whole.size)
            )
            pixels[around] = 0.55 * pixels[around] + 0.2
        pixels[border] = 0.1
        image = Image.fromarray((pixels * 255.0).astype(np.uint8))
        draw = ImageDraw.Draw(image)
        taken: list[tuple[float, ...]] = [(0, 0, _SIDE, 18), (0, _SIDE - 66, 66, _SIDE)]
        _axes(draw, camera)
        side = " ".join(
            f"{'-+'[int(end > 0)]}{axis}"
            for axis, end in zip("xy", _TOWARDS[view], strict=False)
            if abs(end) > 0.3 * np.cos(_VIEWS[view, 1])
        )
        draw.text(
            (_SIDE / 2, 9),
            f"{note}seen from {side}, {'above' if _VIEWS[view, 1] > 0 else 'below'}",
            "black",
            ImageFont.load_default(14),
            "mm",
        )
        shown = _numbered(draw, ids, [k + 1 for k in solid], taken)
        draw.rectangle((0, 0, _SIDE - 1, _SIDE - 1), outline="silver")
        for number, count in shown.items():
            self.best[number - 1] = max(self.best[number - 1], count)
        return image


def _camera(points: FloatArray, view: int, side: int) -> Camera:
    azimuth, elevation = _VIEWS[view]
    return fit_camera(
        points, azimuth=azimuth, elevation=elevation, field_of_view=float(_FIELD), size=(side, side), margin=side / 24
    )


def _seen(scene: RayScene, camera: Camera) -> Seen:
    across, down = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    origin, along = camera.rays(np.column_stack([across.ravel(), down.ravel()]))
    hits = scene.first_hits(origin, along)
    normal = np.where(hits.met[:, None], scene.face_normals[hits.face], 0.0)
    normal *= -np.sign(np.einsum("ij,ij->i", normal, along))[:, None]
    shape = camera.height, camera.width
    return hits.mesh.reshape(shape), hits.distance.reshape(shape), normal.reshape(*shape, 3)


def _edges(ids: IntArray, depth: FloatArray, normal: FloatArray, size: float) -> tuple[BoolArray, BoolArray]:
    """Pixels on the border of a piece, and on creases of one."""
    border, crease = np.zeros((2, *ids.shape), dtype=bool)
    deep = np.where(ids >= 0, depth, 0.0)
    for one, other in ((np.s_[:, 1:], np.s_[:, :-1]), (np.s_[1:], np.s_[:-1])):
        apart = ids[one] != ids[other]
        bent = (normal[one] * normal[other]).sum(axis=2) < 0.8
        border[other] |= apart
        crease[other] |= ~apart & (ids[one] >= 0) & (bent | (np.abs(deep[one] - deep[other]) > 0.02 * size))
    return border, crease


def _axes(draw: ImageDraw.ImageDraw, camera: Camera) -> None:
    at, ink = np.array([33.0, _SIDE - 33.0]), ("crimson", "green", "blue")
    for axis, color, name in zip(np.eye(3), ink, ("+x", "+y", "+z"), strict=True):
        end = 22.0 * camera.axes[:2] @ axis
        draw.line((*at, *(at + end)), color, 3)
        draw.text(
            tuple(at + 1.35 * end), name, color, ImageFont.load_default(12), "mm", stroke_width=2, stroke_fill="white"
        )


def _numbered(
    draw: ImageDraw.ImageDraw, ids: IntArray, numbers: Sequence[int], taken: list[tuple[float, ...]]
) -> dict[int, int]:
    """Write numbers where pieces are widest, or beside them with a line; return the pixels of each that has one."""
    places = []
    for index, box in enumerate(find_objects(ids + 1)):
        inside = None if box is None else np.pad(ids[box] == index, 1)
        if inside is not None and inside.sum() > 5:
            wide = distance_transform_edt(inside)
            row, column = np.unravel_index(int(wide.argmax()), wide.shape)
            at = float(column + box[1].start - 1), float(row + box[0].start - 1)
            places.append((float(wide.max()), numbers[index], at, int(inside.sum())))
    outside, shown = [], {}
    for wide, number, at, count in sorted(places, reverse=True):
        if wide < 7.0 or not _free(_box(at, number)[None], taken)[0]:
            outside.append((number, at, count))
        else:
            _write(draw, at, number, "black", taken)
            shown[number] = count
    reach, turn = (grid.ravel() for grid in np.meshgrid(np.arange(13, 190, 7), np.radians(np.arange(0, 360, 15))))
    for number, at, count in outside:
        to = np.array(at) + np.column_stack([reach * np.cos(turn), reach * np.sin(turn)])
        cells = np.clip(to, 0, _SIDE - 1).astype(int)
        cost = reach + np.where(ids[cells[:, 1], cells[:, 0]] < 0, 0.0, 14.0)
        cost[~_free(np.array([_box(place, number) for place in to]), taken)] = np.inf
        best = int(cost.argmin())
        if np.isfinite(cost[best]):
            draw.line((*at, *to[best]), "black", 1)
            draw.ellipse((at[0] - 2, at[1] - 2, at[0] + 2, at[1] + 2), "black")
            _write(draw, (float(to[best, 0]), float(to[best, 1])), number, "darkred", taken)
            shown[number] = count
    return shown


def _box(at: Collection[float], number: int) -> FloatArray:
    half = 5.5 * len(str(number)) + 1.0
    return np.asarray(np.array([*at, *at]) + np.array([-half, -9.0, half, 9.0]))


def _free(boxes: FloatArray, taken: Sequence[tuple[float, ...]]) -> BoolArray:
    """Boxes that lie in the panel and on no other."""
    other = np.array(taken)
    apart = (boxes[:, None, 2:] < other[:, :2]) | (boxes[:, None, :2] > other[:, 2:])
    return np.asarray(np.all(np.any(apart, axis=2), axis=1) & (boxes > 0.0).all(axis=1) & (boxes < _SIDE).all(axis=1))


def _write(
    draw: ImageDraw.ImageDraw, at: tuple[float, float], number: int, color: object, taken: list[tuple[float, ...]]
) -> None:
    draw.text(at, str(number), color, _FONT, "mm", stroke_width=3, stroke_fill="white")  # type: ignore[arg-type]
    taken.append(tuple(_box(at, number)))
