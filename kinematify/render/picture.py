"""Pictures of coloured meshes and joint arrows by ray casting; needs no OpenGL, window or graphics card.

Light comes from the whole sky, weakened where surfaces close by hide it, and from a lamp over the viewer's shoulder.
One ray per pixel finds the surfaces; only pixels at edges and arrows get more.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

from kinematify.geometry.rays import RayScene
from kinematify.render.camera import fit_camera
from kinematify.robot.appearance import linear_of, plain, srgb_of
from kinematify.robot.vectors import vertex_normals

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import PreviewConfig
    from kinematify.geometry.rays import RayHits
    from kinematify.render.camera import Camera
    from kinematify.robot.appearance import Appearance
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


BACKGROUND = np.array([0.972, 0.976, 0.984])
"""sRGB of the empty picture, shape (3,)."""
INK = (45, 50, 60)
"""Of words, sRGB in bytes."""
ARM, HAND, STAND = np.array([0.80, 0.83, 0.88]), np.array([0.96, 0.58, 0.20]), np.array([0.55, 0.58, 0.63])
"""sRGB of a robot, of what grips, and of what the robot stands on."""
HELD, OTHERS, CARCASS = np.array([0.16, 0.62, 0.56]), np.array([0.62, 0.72, 0.80]), np.array([0.86, 0.80, 0.71])
"""sRGB of the part of an object that is moved, of its other parts, and of what stands still."""
_FLOOR_SHADOW = 0.6  # share of the light that the floor loses where it sees no sky
_SKY, _LAMP, _GLOSS = 0.80, 0.46, 0.07  # shares of the light; above 1 in all, so that lit faces are bright
_UNDERSIDE = 0.58  # light of the sky on faces that look down, relative to those that look up
_LAMP_IN_DARK = 0.35  # share of the lamp that reaches where the sky does not
_DEPTH_STEP = 0.004  # of the scene's size: a larger step in depth from pixel to pixel is an edge
_COLOR_STEP = 0.02  # of sRGB, a step of 5 in 255: a smaller one is not seen as a jagged edge
_PANES = 6  # a pane of glass has two surfaces
_BEHIND = 1e-5  # of the scene's size: where a ray goes on behind a surface
_SPARSE = 2  # rays to the sky and to arrows start at every second pixel of every second row
_BLOCK = 4096  # pixels with several rays at a time: what NumPy allocates for them stays in the cache
_RIM = 0.9  # opacity of the white rim of an arrow: it stands out of its own colour and of the dark
_OUTLINE_DIRECTIONS = 240
_OUTLINE_VERTICES = 30000


@dataclass(frozen=True, kw_only=True, eq=False)
class PosedMesh:
    """A mesh as it is in the picture."""

    vertices: FloatArray
    """World frame [m], shape (V, 3)."""
    faces: IntArray
    """Shape (F, 3)."""
    color: FloatArray
    """sRGB in [0, 1], shape (3,)."""
    appearance: Appearance | None = None
    """Of the faces, in place of the colour."""
    shade: float = 1.0
    """Factor on the light of all its colours: distinguishes meshes of one material."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PictureScene:
    """Content of a picture; what is derived from it is computed once for all points of view."""

    meshes: tuple[PosedMesh, ...]
    """At least one face in all."""
    glyphs: tuple[PosedMesh, ...] = ()
    """Drawn over the meshes; where a mesh is in front of them they are pale."""

    @cached_property
    def rays(self) -> RayScene:
        """The meshes for ray casting."""
        return RayScene([(mesh.vertices, mesh.faces) for mesh in self.meshes])

    @cached_property
    def glyphs_alone(self) -> PictureScene | None:
        """Return what is drawn over the meshes as a scene of its own, if there is any."""
        return PictureScene(meshes=self.glyphs) if self.glyphs else None

    @cached_property
    def outline(self) -> FloatArray:
        """Extreme points in many directions, glyphs included, shape (n, 3): enough to fit a camera, and few."""
        used = np.zeros(len(self.rays.vertices), dtype=bool)
        used[self.rays.faces] = True
        # A dense mesh has another vertex next to the one that is omitted.
        vertices = self.rays.vertices[used][:: 1 + np.count_nonzero(used) // _OUTLINE_VERTICES]
        points = np.concatenate([vertices, *(glyph.vertices for glyph in self.glyphs)])
        extremes: FloatArray = points[np.unique((_even_directions(_OUTLINE_DIRECTIONS) @ points.T).argmax(axis=1))]
        return extremes

    def mesh_of_pixel(self, camera: Camera, every: int = 1) -> IntArray:
        """Index of the mesh that each pixel shows, or one of `every` per row and column; -1 for none, shape (h, w)."""
        rows, columns = range(0, camera.height, every), range(0, camera.width, every)
        hits = self.rays.first_hits(*camera.rays(_pixel_centers(rows, columns)))
        return hits.mesh.reshape(len(rows), len(columns))

    def visible_pixels(self, camera: Camera) -> IntArray:
        """Count the pixels that show each mesh, shape (len(meshes),)."""
        seen = self.mesh_of_pixel(camera)
        return np.bincount(seen[seen >= 0], minlength=len(self.meshes))


def camera_for(
    scenes: Sequence[PictureScene], azimuth: float, config: PreviewConfig, *, size: tuple[int, int], margin: float
) -> Camera:
    """Camera that shows all scenes inside a margin [pixels] of a picture of some width and height [pixels]."""
    return fit_camera(
        np.concatenate([scene.outline for scene in scenes]),
        azimuth=azimuth,
        elevation=float(np.deg2rad(config.elevation)),
        field_of_view=float(np.deg2rad(config.field_of_view)),
        size=size,
        margin=margin,
    )


def row_of(
    images: Sequence[Image.Image],
    captions: Sequence[str] = (),
    *,
    above: int = 0,
    middle: int = 0,
    font: int = 24,
    below: int = 0,
) -> Image.Image:
    """Pictures of one size side by side, each under its caption.

    Args:
        images: From left to right.
        captions: Of each; none if there are none.
        above: Height of the line of captions [pixels].
        middle: Of the line, from the top [pixels].
        font: Size of its letters [pixels].
        below: Empty height under the pictures [pixels].
    """
    width, height = images[0].size
    row = Image.new("RGB", (width * len(images), above + height + below), in_bytes(BACKGROUND))
    for index, image in enumerate(images):
        row.paste(image, (index * width, above))
    draw = ImageDraw.Draw(row)
    for index, caption in enumerate(captions):
        center = (index * width + width // 2, middle)
        draw.text(center, caption, fill=INK, font=ImageFont.load_default(font), anchor="mm")
    return row


def in_bytes(color: FloatArray) -> tuple[int, int, int]:
    """Colour as Pillow takes it, from sRGB in [0, 1], shape (3,)."""
    red, green, blue = (round(float(value) * 255.0) for value in color)
    return red, green, blue


def render_scene(scene: PictureScene, camera: Camera, config: PreviewConfig) -> Image.Image:
    """Draw meshes over a light floor, and arrows that shine faintly through them.

    Args:
        scene: What to show.
        camera: Point of view and size of the picture.
        config: Quality.

    Returns:
        An RGB image of the camera's size; the same input gives the same pixels.
    """
    return _Painter(scene, camera, config).paint()


@dataclass(frozen=True, eq=False)
class _Viewpoint:
    """Rays of a picture and what they meet."""

    pixels: FloatArray
    """Picture positions [pixels], shape (n, 2)."""
    origins: FloatArray
    """World frame [m], shape (n, 3), or (3,) where all start."""
    directions: FloatArray
    hits: RayHits
    normals: FloatArray
    """Smooth, facing the viewer, zero where nothing is met, shape (n, 3)."""

    def points(self, chosen: IntArray) -> FloatArray:
        """Where some rays meet a mesh [m], shape (*chosen.shape, 3); their origin where they meet none."""
        distance = np.where(self.hits.met[chosen], self.hits.distance[chosen], 0.0)
        origins = self.origins if self.origins.ndim == 1 else self.origins[chosen]
        points: FloatArray = origins + distance[..., None] * self.directions[chosen]
        return points


class _Painter:
    """One picture; holds what all its pixels share."""

    def __init__(self, scene: PictureScene, camera: Camera, config: PreviewConfig) -> None:
        self.rays, self.meshes = scene.rays, scene.meshes
        self.first_faces = np.cumsum([0, *(len(mesh.faces) for mesh in scene.meshes)])
        halo = config.glyph_halo * self.rays.size
        self.glyphs = scene.glyphs_alone.rays if scene.glyphs_alone else None
        self.halo = RayScene([_swollen(mesh, halo) for mesh in scene.glyphs]) if scene.glyphs else None
        self.looks = np.concatenate([_looks(mesh) for mesh in scene.meshes])
        self.glyph_colors = linear_of(np.array([mesh.color for mesh in scene.glyphs]).reshape(-1, 3))
        self.camera, self.config = camera, config
        self.shape = (camera.height, camera.width)
        self.sky = SkyLight(self.rays, config.openness_rays, config.openness_reach)
        self.floor = FloorShadow(self.rays, config.floor_cells)

    def paint(self) -> Image.Image:
        """Cast one ray per pixel, then more where one is not enough."""
        view = self._view(_pixel_centers(*map(range, self.shape)))
        self.sparse = self._sparse_light(view)
        image = self._colors(view, self._light(view, np.arange(len(view.pixels))))
        near = self._near_glyphs(view)
        for rough, has_glyphs in ((self._edges(view, image) & ~near, False), (near, True)):
            chosen = np.flatnonzero(rough)
            for start in range(0, len(chosen), _BLOCK):
                block = chosen[start : start + _BLOCK]
                image[block] = self._subsampled(block, view, has_glyphs=has_glyphs)
        return Image.fromarray(np.round(srgb_of(image) * 255.0).astype(np.uint8).reshape(*self.shape, 3))

    def _view(self, pixels: FloatArray) -> _Viewpoint:
        return self._seen(pixels, *self.camera.rays(pixels))

    def _seen(self, pixels: FloatArray, origins: FloatArray, directions: FloatArray) -> _Viewpoint:
        """Return what rays meet that need not begin at the camera."""
        hits = self.rays.first_hits(origins, directions)
        met = hits.met
        face = hits.face[met]
        smooth = self.rays.smooth_normals(face, hits.barycentric[met], np.deg2rad(self.config.smooth_angle))
        away = np.einsum("ij,ij->i", self.rays.face_normals[face], directions[met]) > 0.0
        normals = np.zeros(directions.shape)
        normals[met] = np.where(away[:, None], -smooth, smooth)
        return _Viewpoint(pixels, origins, directions, hits, normals)

    def _colors(self, view: _Viewpoint, light: FloatArray, panes: int = _PANES) -> FloatArray:
        """Linear colour of what each ray meets: a mesh, the floor or the background, shape (n, 3).

        What is not opaque shows what is behind it, through `panes` surfaces at most.
        """
        met = view.hits.met
        colors = np.empty(view.directions.shape)
        origins = view.origins if view.origins.ndim == 1 else view.origins[~met]
        shadow = self.floor.seen(origins, view.directions[~met], view.pixels[~met], self.camera)
        colors[~met] = linear_of(BACKGROUND) * (1.0 - _FLOOR_SHADOW * shadow)[:, None]
        normal, sky = view.normals[met], light[met]
        upward = _UNDERSIDE + (1.0 - _UNDERSIDE) * 0.5 * (1.0 + normal[:, 2])
        lamp = np.clip(normal @ self._lamp, 0.0, 1.0)
        halfway = self._lamp - view.directions[met]
        cosine = np.einsum("ij,ij->i", normal, halfway) / np.sqrt(np.einsum("ij,ij->i", halfway, halfway))
        matt = _SKY * upward * sky + _LAMP * lamp * (_LAMP_IN_DARK + (1.0 - _LAMP_IN_DARK) * sky)
        gloss = _GLOSS * np.clip(cosine, 0.0, 1.0) ** 40 * sky
        surfaces, opacity = self._surfaces(view)
        colors[met] = surfaces * matt[:, None] + gloss[:, None]
        clear = opacity < 1.0
        if panes and clear.any():
            share, at = opacity[clear, None], np.flatnonzero(met)[clear]
            colors[at] = share * colors[at] + (1.0 - share) * self._behind(view, at, panes)
        return colors

    def _behind(self, view: _Viewpoint, at: IntArray, panes: int) -> FloatArray:
        """Linear colour of what is seen through the surfaces that some rays meet, shape (len(at), 3)."""
        along = view.directions[at]
        behind = self._seen(view.pixels[at], view.points(at) + _BEHIND * self.rays.size * along, along)
        light, met = np.ones(len(at)), np.flatnonzero(behind.hits.met)
        sets = met % len(self.sky.sets)
        light[met] = self.sky.open_share(behind.points(met), behind.normals[met], sets)
        return self._colors(behind, light, panes - 1)

    def _surfaces(self, view: _Viewpoint) -> tuple[FloatArray, FloatArray]:
        """Linear colour and opacity of what rays meet, without light, shapes (number met, 3) and (number met,)."""
        met = np.flatnonzero(view.hits.met)
        looks = self.looks[view.hits.face[met]]
        for index, posed in enumerate(self.meshes):
            if posed.appearance is not None and posed.appearance.is_textured:
                at = np.flatnonzero(view.hits.mesh[met] == index)
                rays = met[at]
                seen = posed.appearance.colors_at(
                    view.hits.face[rays] - self.first_faces[index], view.hits.barycentric[rays]
                )
                looks[at] = np.column_stack([linear_of(seen[:, :3]) * posed.shade, seen[:, 3]])
        return looks[:, :3], looks[:, 3]

    @cached_property
    def _lamp(self) -> FloatArray:
        """Unit direction to the lamp: behind the viewer, above and to the left."""
        right, down, forward = self.camera.axes
        lamp = -0.62 * right - 0.75 * down - forward
        return np.asarray(lamp / np.linalg.norm(lamp), dtype=np.float64)

    def _edges(self, view: _Viewpoint, image: FloatArray) -> BoolArray:
        """Pixels whose neighbours show another surface that looks otherwise in the image, shape (h * w,)."""
        mesh = view.hits.mesh.reshape(self.shape)
        normal = view.normals.reshape(*self.shape, 3)
        depth = np.where(view.hits.met, view.hits.distance, 0.0).reshape(self.shape)
        edge = np.zeros(self.shape, dtype=bool)
        colors = image.reshape(*self.shape, 3)
        for first, second in ((np.s_[:, 1:], np.s_[:, :-1]), (np.s_[1:], np.s_[:-1])):
            bend = np.einsum("ijk,ijk->ij", normal[first], normal[second]) < SAME_SURFACE_COSINE
            step = np.abs(depth[first] - depth[second]) > _DEPTH_STEP * self.rays.size
            differs = (mesh[first] != mesh[second]) | ((mesh[first] >= 0) & (bend | step))
            steps = srgb_of(colors[first][differs]) - srgb_of(colors[second][differs])
            differs[differs] = np.abs(steps).max(axis=1, initial=0.0) > _COLOR_STEP
            edge[first] |= differs
            edge[second] |= differs
        return edge.ravel()

    def _near_glyphs(self, view: _Viewpoint) -> BoolArray:
        if self.halo is None:
            return np.zeros(len(view.pixels), dtype=bool)
        coarse = view.directions.reshape(*self.shape, 3)[::_SPARSE, ::_SPARSE]
        met = self.halo.first_hits(view.origins, coarse.reshape(-1, 3)).met.reshape(coarse.shape[:2])
        grown = np.asarray(Image.fromarray(met.astype(np.uint8)).filter(ImageFilter.MaxFilter(3)), dtype=bool)
        return grown.repeat(_SPARSE, axis=0).repeat(_SPARSE, axis=1)[: self.shape[0], : self.shape[1]].ravel()

    def _subsampled(self, chosen: IntArray, coarse: _Viewpoint, *, has_glyphs: bool) -> FloatArray:
        """Mean linear colour of a turned grid of rays in each chosen pixel, shape (len(chosen), 3)."""
        side = self.config.subsamples
        across, down = (axis.ravel() for axis in np.meshgrid(np.arange(side), np.arange(side)))
        # No two rays share a row or a column: upright and level edges have as many steps as there are rays.
        shares = np.stack([across + (down + 0.5) / side, down + (side - across - 0.5) / side], axis=1)
        fine = self._view((coarse.pixels[chosen][:, None] + shares / side - 0.5).reshape(-1, 2))
        light = self._light(fine, np.repeat(chosen, side * side))
        colors = self._with_glyphs(self._colors(fine, light), fine) if has_glyphs else self._colors(fine, light)
        mean: FloatArray = colors.reshape(len(chosen), side * side, 3).mean(axis=1)
        return mean

    def _sparse_light(self, view: _Viewpoint) -> tuple[IntArray, FloatArray, FloatArray]:
        """Mesh, normal and light of every other pixel of every other row: light changes slowly over a surface."""
        chosen = np.arange(len(view.pixels)).reshape(self.shape)[::_SPARSE, ::_SPARSE]
        mesh, normals = view.hits.mesh[chosen], view.normals[chosen]
        return mesh, normals, self.sky.of_picture(view.points(chosen), normals, mesh)

    def _light(self, view: _Viewpoint, pixel: IntArray) -> FloatArray:
        """Light of the nearest of the sparse pixels that shows the same surface; rays of its own for what none shows.

        Args:
            view: What is seen, through n rays.
            pixel: Number of the pixel of each ray, row by row, shape (n,).
        """
        light = np.ones(len(pixel))
        left = np.flatnonzero(view.hits.met)
        row, column = np.divmod(pixel, self.shape[1])
        mesh, normals, shares = self.sparse
        rows, columns = mesh.shape
        for down, right in product((0, 1, -1), repeat=2):
            places = (
                (row[left] // _SPARSE + down).clip(0, rows - 1),
                (column[left] // _SPARSE + right).clip(0, columns - 1),
            )
            cosine = np.einsum("ij,ij->i", view.normals[left], normals[places])
            alike = (view.hits.mesh[left] == mesh[places]) & (cosine > SAME_SURFACE_COSINE)
            light[left[alike]] = shares[places][alike]
            left = left[~alike]
        light[left] = self.sky.open_share(view.points(left), view.normals[left], left % len(self.sky.sets))
        return light

    def _with_glyphs(self, colors: FloatArray, view: _Viewpoint) -> FloatArray:
        """Lay the arrows with a light rim over colours, pale where a mesh is nearer."""
        if self.glyphs is None or self.halo is None:
            return colors
        rim = self.halo.first_hits(view.origins, view.directions)
        hits = self.glyphs.first_hits(view.origins, view.directions)
        met = hits.met
        lit = rim.met & ~met & (rim.distance <= view.hits.distance)
        colors[lit] += _RIM * (1.0 - colors[lit])
        facing = np.abs(np.einsum("ij,ij->i", self.glyphs.face_normals[hits.face[met]], view.directions[met]))
        shaded = self.glyph_colors[hits.mesh[met]] * (0.55 + 0.5 * facing)[:, None]
        in_front = hits.distance[met] <= view.hits.distance[met]
        opacity = np.where(in_front, 1.0, self.config.hidden_glyph)[:, None]
        colors[met] = opacity * shaded + (1.0 - opacity) * colors[met]
        return colors


def _looks(mesh: PosedMesh) -> FloatArray:
    """Linear colour and opacity of every face without its texture, shape (F, 4)."""
    appearance = mesh.appearance or plain((*mesh.color.tolist(), 1.0), len(mesh.faces))
    painted = np.array([material.color for material in appearance.materials])
    looks = np.column_stack([linear_of(painted[:, :3]) * mesh.shade, painted[:, 3]])
    return looks[appearance.material_of_face]


def _swollen(mesh: PosedMesh, distance: float) -> tuple[FloatArray, IntArray]:
    """A mesh whose surface lies farther out [m]."""
    return mesh.vertices + distance * vertex_normals(mesh.vertices, mesh.faces), mesh.faces


def _pixel_centers(rows: range, columns: range) -> FloatArray:
    """Picture positions of pixels, row by row, shape (len(rows) * len(columns), 2)."""
    x, y = np.meshgrid(np.array(columns) + 0.5, np.array(rows) + 0.5)
    return np.column_stack([x.ravel(), y.ravel()])


SAME_SURFACE_COSINE = 0.94
"""Places of one mesh whose normals differ less (20 deg) share light."""
_TILE = 4  # places per side of the square over which light is averaged; each pixel of it has its own directions
_FLOOR_RAYS = 16  # of each cell; a tile is averaged
_FLOOR_FINE = 8  # places of the smooth map along a cell
_FLOOR_REACH = 0.6  # of the scene's size
_FLOOR_ROOM = 0.4  # of the scene's size: how far the map of the shadow reaches beyond the object
_FLOOR_FADE = 0.5  # of the map's half width: the shadow fades to nothing over this distance
_BORDER = 60.0  # pixels over which the shadow fades towards the border of the picture


class SkyLight:
    """Rays to the sky, the same few directions at like places, so that even surfaces show no noise."""

    def __init__(self, scene: RayScene, rays: int, reach: float) -> None:
        """`rays` at each place, as long as `reach` times the scene's size."""
        self.scene, self.rays, self.reach = scene, rays, reach * scene.size
        ball = _even_directions(self.rays * _TILE**2)
        # Directions that follow each other on the spiral lie at one height: every set takes them from all heights.
        self.sets = ball.reshape(self.rays, _TILE**2, 3).transpose(1, 0, 2).astype(np.float32)

    def open_share(self, points: FloatArray, normals: FloatArray, sets: IntArray) -> FloatArray:
        """Share of the sky that points see within reach.

        Args:
            points: World frame [m], shape (n, 3).
            normals: Unit, shape (n, 3).
            sets: Which set of directions each point uses, from 0 to 15, shape (n,).

        Returns:
            From 0 (dark) to 1 (open), weighted by the cosine to the normal, shape (n,).
        """
        # A point of the unit ball that lies on the surface is cosine distributed as seen from the point of contact.
        towards = self.sets[sets] + normals[:, None, :].astype(np.float32)
        towards /= np.sqrt(np.einsum("nrk,nrk->nr", towards, towards) + 1e-12)[..., None]
        hidden = self.scene.occluded(np.repeat(points, self.rays, axis=0), towards.reshape(-1, 3), self.reach)
        share: FloatArray = 1.0 - np.count_nonzero(hidden.reshape(-1, self.rays), axis=1) / self.rays
        return share

    def of_picture(self, points: FloatArray, normals: FloatArray, mesh: IntArray) -> FloatArray:
        """Share of the sky that a grid of places sees, averaged over a tile of the same surface, shape (h, w).

        Args:
            points: World frame [m], shape (h, w, 3).
            normals: Unit, shape (h, w, 3).
            mesh: Which one each shows, -1 for none, shape (h, w).
        """
        row, column = np.meshgrid(*(np.arange(size) for size in mesh.shape), indexing="ij")
        sets = (row % _TILE) * _TILE + column % _TILE
        share = np.ones(mesh.shape)
        met = mesh >= 0
        share[met] = self.open_share(points[met], normals[met], sets[met])
        return _average_on_surface(share, mesh, normals)


def _even_directions(count: int) -> FloatArray:
    """Unit vectors spread evenly over the sphere along a golden spiral, from pole to pole, shape (count, 3)."""
    index = np.arange(count)
    height = 1.0 - (2.0 * index + 1.0) / count
    turn = index * np.pi * (3.0 - np.sqrt(5.0))
    radius = np.sqrt(1.0 - height**2)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=1)


def _average_on_surface(values: FloatArray, mesh: IntArray, normals: FloatArray) -> FloatArray:
    """Mean over a tile around each pixel of those that show the same mesh with a like normal, shape (h, w)."""
    total, weight = np.zeros_like(values), np.zeros_like(values)
    height, width = mesh.shape
    margins = ((_TILE // 2, _TILE // 2),) * 2
    all_values, all_mesh = np.pad(values, margins), np.pad(mesh, margins)
    all_normals = np.pad(normals, (*margins, (0, 0)))  # no direction is like none
    for down, right in np.ndindex(_TILE, _TILE):
        there = np.s_[down + 1 : down + 1 + height, right + 1 : right + 1 + width]
        cosine = np.einsum("ijk,ijk->ij", normals, all_normals[there])
        alike = (mesh == all_mesh[there]) & (cosine > SAME_SURFACE_COSINE)
        total += alike * all_values[there]
        weight += alike
    return np.where(weight > 0.0, total / np.maximum(weight, 1.0), values)


class FloorShadow:
    """A horizontal plane below the scene that shows nothing but the shadow on it."""

    def __init__(self, scene: RayScene, cells: int) -> None:
        room = _FLOOR_ROOM * scene.size
        self.low, self.high = scene.bounds[0, :2] - room, scene.bounds[1, :2] + room
        # A little lower than the lowest point: an object that stands on the plane would hide its own shadow.
        self.height = scene.bounds[0, 2] - 2e-3 * scene.size
        self.map = self._hidden_share(scene, cells)

    def _hidden_share(self, scene: RayScene, cells: int) -> FloatArray:
        """Share of the sky that the scene hides from places, fading to zero at the border, a square array."""
        x, y = np.meshgrid(*np.linspace(self.low, self.high, cells).T, indexing="ij")
        points, up = np.stack([x, y, np.full_like(x, self.height)], axis=2), np.tile([0.0, 0.0, 1.0], (*x.shape, 1))
        share = 1.0 - SkyLight(scene, _FLOOR_RAYS, _FLOOR_REACH).of_picture(points, up, np.zeros(x.shape, dtype=int))
        places = np.linspace(-1.0, 1.0, _FLOOR_FINE * cells)
        near = np.exp(-((0.35 * cells * np.subtract.outer(places, np.linspace(-1.0, 1.0, cells))) ** 2))
        near /= near.sum(axis=1, keepdims=True)
        faded: FloatArray = near @ share @ near.T * _smooth_step((1.0 - np.hypot.outer(places, places)) / _FLOOR_FADE)
        return faded

    def seen(self, origins: FloatArray, directions: FloatArray, pixels: FloatArray, camera: Camera) -> FloatArray:
        """Darkness of the floor where rays meet it, 0 elsewhere and at the border of the picture, shape (n,).

        Args:
            origins: World frame [m], shape (n, 3), or (3,) where all start.
            directions: Unit, shape (n, 3).
            pixels: Picture positions of the rays [pixels], shape (n, 2).
            camera: For the size of the picture.
        """
        down = directions[:, 2] < -1e-6
        distance = (self.height - origins[..., 2]) / np.where(down, directions[:, 2], -1.0)
        spots = origins[..., :2] + distance[:, None] * directions[:, :2]
        place = (spots - self.low) / (self.high - self.low) * (len(self.map) - 1)
        dark = self.map[tuple(np.rint(place.clip(0.0, len(self.map) - 1)).astype(np.int64).T)]
        inside = np.minimum(pixels, np.array([camera.width, camera.height]) - pixels).min(axis=1)
        share: FloatArray = np.where(down & (distance > 0.0), dark, 0.0) * _smooth_step(inside / _BORDER)
        return share


def _smooth_step(values: FloatArray) -> FloatArray:
    clipped = np.clip(values, 0.0, 1.0)
    smooth: FloatArray = clipped**2 * (3.0 - 2.0 * clipped)
    return smooth
