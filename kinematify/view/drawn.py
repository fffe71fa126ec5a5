"""Content of the 3D scene of the page: bodies, the axes of joints, what glows, ground and light (viser's scene)."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import trimesh
from trimesh.exchange.gltf import export_glb

from kinematify.formats.glb import surface_mesh
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import quaternion_of, rotation_from_x
from kinematify.robot.vectors import crossed, dots, vertex_normals
from kinematify.robot.weld import is_closed

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import viser

    from kinematify.robot.appearance import Surface
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Joint
    from kinematify.view.inference_view import DrawnChain
    from kinematify.view.viewer_scene import ViewScene

_export_glb: Any = export_glb  # untyped in trimesh


def glb_of(surfaces: Sequence[Surface], *, double_sided: bool) -> bytes:
    """Return surfaces as meshes of a GLB file, without normals, so that its triangles look flat.

    Args:
        surfaces: Of one part.
        double_sided: Whether the back of a triangle can be seen, as where the part is open. A page lays the shadow of a
            triangle that has two sides on itself.
    """
    meshes: Any = [surface_mesh(surface) for surface in surfaces]
    for mesh in meshes:
        mesh.visual.material.doubleSided = double_sided
    return bytes(_export_glb(trimesh.Scene(meshes), include_normals=False))


Color = tuple[int, int, int]

_AXIS = (214, 26, 41)
_SLIDE = (18, 84, 219)
_CLOSED = (120, 40, 160)
"""Of the dashed line where a chain of joints closes."""
_ABOVE_PANEL = 0.35
"""Of the distance to the camera: how much higher than the middle a model stands in a narrow window."""
_GIZMO = 0.2
"""Of the model's size."""
_GLOW = 0.45
_SWOLLEN = 1.5e-3
"""Of the model's size: how far the glow stands off the surface."""


class DrawnModel:
    """A model in the scene of a server."""

    def __init__(
        self,
        server: viser.ViserServer,
        scene: ViewScene,
        chains: Sequence[DrawnChain],
        clicked: Callable[[str], None],
    ) -> None:
        """Draw the bodies in their light, in place of what was there; `add_marks` draws the rest.

        Args:
            server: Running.
            scene: The model.
            chains: Where it closes.
            clicked: Called with the top link of a part that is clicked.
        """
        self._server, self._scene, self._chains, self._on_click = server, scene, chains, clicked
        self._frames: dict[str, Any] = {}
        self._glows: dict[str, Any] = {}
        self._axes: dict[str, Any] = {}
        self._dashes: list[Any] = []
        self._shows_axes = True
        self.complete = False
        """Whether everything is drawn."""
        server.scene.reset()
        server.scene.set_up_direction("+z")
        server.scene.configure_default_lights(enabled=True, cast_shadow=True)
        self._add_bodies()

    def add_marks(self) -> None:
        """Draw what the first picture does not need, and would wait for: ground, axes, and where chains close."""
        self.complete = True
        self._add_ground()
        for joint in self._scene.leaders:
            self.draw_axis(joint)

    @property
    def parts(self) -> tuple[str, ...]:
        """Top links of what can be seen."""
        return tuple(self._frames)

    def place(self, q: Mapping[str, float]) -> None:
        """Put everything where the joints stand, leader -> value [rad or m]."""
        poses = self._scene.poses(q)
        with self._server.atomic():
            for top, frame in self._frames.items():
                frame.wxyz, frame.position = quaternion_of(poses[top][:3, :3]), poses[top][:3, 3]
            for name, handle in self._axes.items():
                joint = self._scene.robot.joint_by_name[name]
                T = poses[joint.parent] @ joint.T_parent_child
                handle.wxyz, handle.position = quaternion_of(T[:3, :3]), T[:3, 3]
            if self.complete:
                self._draw_chains(poses)

    def show_part(self, top: str, visible: bool) -> None:  # the value of a box
        """Show or hide a part."""
        self._frames[top].visible = visible

    def show_axes(self, visible: bool) -> None:  # the value of a box
        """Show or hide the axes of all joints."""
        self._shows_axes = visible
        for handle in self._axes.values():
            handle.visible = visible

    def draw_axis(self, joint: Joint) -> None:
        """Draw the axis with the range; it stays with the parent while the joint moves."""
        points = self._scene.glyph(joint)
        color = _AXIS if self._scene.kind_of(joint).turns else _SLIDE
        visible = self._shows_axes and self._scene.kind_of(joint) is not JointType.FIXED
        self._axes[joint.name] = self._add_lines(f"/axes/{joint.name}", points, color, visible=visible)

    def step_back(self, client: viser.ClientHandle) -> None:
        """Make a window that is higher than wide see the whole model."""
        if client.camera.aspect < 1.0:
            eye, target = self._scene.camera
            _aim(client, eye - target, target)

    def fit(self, q: Mapping[str, float]) -> None:
        """Make every page see the whole model in a configuration, from the side from which it looks."""
        low, high = self._scene.extent(q)
        size = 1.1 * max(float(np.linalg.norm(high - low)), self._scene.size)
        for client in self._server.get_clients().values():
            back = client.camera.position - client.camera.look_at
            _aim(client, back * size / max(float(np.linalg.norm(back)), 1e-9), 0.5 * (low + high))

    def add_gizmo(self, axis: FloatArray, pivot: FloatArray) -> Any:
        """Return a gizmo whose red arrow is an axis, frame of the root link [m], shape (3,) each."""
        return self._server.scene.add_transform_controls(
            "/by_hand",
            scale=_GIZMO * self._scene.size,
            depth_test=False,
            wxyz=quaternion_of(rotation_from_x(axis)),
            position=pivot,
        )

    def let_glow(self, top: str, color: Color | None) -> None:
        """Make a part glow, or no more."""
        handle = self._glows.get(top)
        if color is None or top not in self._frames:
            if handle is not None:
                handle.visible = False
            return
        if handle is None:
            handle = self._glows[top] = self._add_glow(top, color)
        if handle.color != color:
            handle.color = color
        handle.visible = True

    def _add_glow(self, top: str, color: Color) -> Any:
        vertices, faces = self._scene.meshes[top]
        swollen = vertices + _SWOLLEN * self._scene.size * vertex_normals(vertices, faces)
        handle = self._server.scene.add_mesh_simple(
            f"/parts/{top}/glow",
            swollen.astype(np.float32),
            faces.astype(np.uint32),
            color=color,
            opacity=_GLOW,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )
        handle.on_click(partial(self._clicked, top))
        return handle

    def _clicked(self, top: str, _: Any) -> None:
        self._on_click(top)

    def look(self) -> None:
        """Make pages look first from the side towards which the parts move."""
        eye, target = self._scene.camera
        camera = self._server.initial_camera
        camera.position, camera.look_at, camera.up = tuple(eye), tuple(target), (0.0, 0.0, 1.0)
        camera.near = 1e-3 * self._scene.size

    def _add_ground(self) -> None:
        size = self._scene.size
        _, target = self._scene.camera
        cell = 10.0 ** math.floor(math.log10(max(size, 1e-6)) - 0.5)
        self._server.scene.add_grid(
            "/ground",
            width=4.0 * size,
            height=4.0 * size,
            cell_size=cell,
            section_size=10.0 * cell,
            cell_thickness=0.6,
            cell_color=(224, 224, 228),
            section_color=(196, 196, 204),
            plane_color=(247, 247, 249),
            plane_opacity=0.9,
            shadow_opacity=0.2,
            position=(float(target[0]), float(target[1]), self._scene.ground - 1e-3 * size),
        )

    def _add_bodies(self) -> None:
        for top, surfaces in self._scene.surfaces.items():
            self._frames[top] = self._server.scene.add_frame(f"/parts/{top}", show_axes=False)
            handle = self._server.scene.add_glb(
                f"/parts/{top}/seen", glb_of(surfaces, double_sided=not _is_solid(*self._scene.meshes[top]))
            )
            handle.on_click(partial(self._clicked, top))

    def _add_lines(self, name: str, points: FloatArray, color: Color, *, visible: bool = True) -> Any:
        colors = np.broadcast_to(np.array(color, dtype=np.uint8), points.shape)
        return self._server.scene.add_line_segments(
            name, points.astype(np.float32), colors, thickness=3.0, thickness_units="screen", visible=visible
        )

    def _draw_chains(self, poses: Mapping[str, FloatArray]) -> None:
        """Draw a dashed line along every pin that was cut, and from one end of it to the other where it came apart."""
        for number, chain in enumerate(self._chains):
            points = chain.dashes(poses, self._scene.size)
            if number == len(self._dashes):
                self._dashes.append(self._add_lines(f"/closed/{number}", points, _CLOSED))
            self._dashes[number].points = points.astype(np.float32)


def _aim(client: viser.ClientHandle, back: FloatArray, target: FloatArray) -> None:
    """Make a page look at a point; in a window that is higher than wide, above the panel, from farther away.

    Args:
        client: The page.
        back: From the point to the camera [m], shape (3,).
        target: The point [m], shape (3,).
    """
    back = back / min(client.camera.aspect, 1.0)
    below = _ABOVE_PANEL * float(np.linalg.norm(back)) if client.camera.aspect < 1.0 else 0.0
    point = target - [0.0, 0.0, below]
    with client.atomic():
        client.camera.position, client.camera.look_at = point + back, point


def _is_solid(vertices: FloatArray, faces: IntArray) -> bool:
    """True if a mesh is closed and its triangles look outward."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return is_closed(vertices, faces) and float(dots(a, crossed(b, c)).sum()) > 0.0
