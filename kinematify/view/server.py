"""The viewer itself: a web server with the model, a slider per joint, findings and alternatives (viser)."""

from __future__ import annotations

import colorsys
import threading
import time
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import quaternion_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import viser

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint
    from kinematify.view.alternatives import Alternative
    from kinematify.view.scene import Touch, ViewScene

_TOUCHING, _WRONG = (214, 158, 46), (214, 40, 40)
_AXIS = (214, 26, 41)
_SLIDE = (18, 84, 219)
_AS_WRITTEN = "as in the file"
_FRAME = 1.0 / 30.0
_SWEEP_SECONDS = 4.0
_SLIDER_STEPS = 400
_TOLD = 12
"""Touching pairs that are listed."""


@dataclass(frozen=True, kw_only=True)
class Sight:
    """A finding as the viewer shows it."""

    title: str
    message: str
    q: Mapping[str, float] = field(default_factory=dict)
    links: tuple[str, ...] = ()


class ModelViewer:
    """What is on the page and what it does; every client sees the same."""

    def __init__(
        self,
        server: viser.ViserServer,
        scene: ViewScene,
        *,
        alternatives: Mapping[tuple[str, str], Sequence[Alternative]],
        sights: Sequence[Sight],
    ) -> None:
        """Build the page.

        Args:
            server: Running.
            scene: The model.
            alternatives: Candidates of joints by (parent, child) link.
            sights: Findings.
        """
        self._server, self._scene = server, scene
        self._lock = threading.RLock()  # sliders, buttons and the sweep come from threads of their own
        self._q = {joint.name: scene.rest[joint.name] for joint in scene.leaders}
        self._marked: frozenset[str] = frozenset()
        self._sweeping: str | None = None
        self._meshes: dict[str, Any] = {}
        self._colors: dict[str, tuple[int, int, int]] = {}
        self._sliders: dict[str, Any] = {}
        self._axes: dict[str, Any] = {}
        self._add_bodies()
        self._add_joints(alternatives)
        self._add_findings(sights)
        self._add_parts()
        self._status = server.gui.add_markdown("")
        self._place()

    def set(self, values: Mapping[str, float]) -> None:
        """Move joints, sliders included; names that are no leaders are passed over."""
        with self._lock:
            for name, value in values.items():
                if name in self._sliders:
                    slider = self._sliders[name]
                    self._q[name] = float(np.clip(value, slider.min, slider.max))
                    slider.value = self._q[name]
            self._place()

    @property
    def values(self) -> dict[str, float]:
        """Where the leaders stand [rad or m]."""
        with self._lock:
            return dict(self._q)

    @property
    def touching(self) -> list[Touch]:
        """What meets where the joints stand now."""
        with self._lock:
            return self._scene.touches(self._q)

    def run(self, stop: threading.Event) -> None:
        """Sweep what is to be swept until told to stop."""
        start, last = time.monotonic(), ""
        while not stop.wait(_FRAME):
            name = self._sweeping
            if name is None:
                last = ""
                continue
            if name != last:
                start, last = time.monotonic(), name
            slider = self._sliders[name]
            share = 0.5 - 0.5 * np.cos(2.0 * np.pi * (time.monotonic() - start) / _SWEEP_SECONDS)
            self.set({name: slider.min + share * (slider.max - slider.min)})

    def _add_bodies(self) -> None:
        self._server.scene.set_up_direction("+z")
        self._server.initial_camera.position, self._server.initial_camera.look_at = self._scene.camera
        for index, (top, (vertices, faces)) in enumerate(self._scene.meshes.items()):
            if not len(faces):
                continue
            self._colors[top] = _color(index)
            self._meshes[top] = self._server.scene.add_mesh_simple(
                f"/bodies/{top}",
                vertices.astype(np.float32),
                faces.astype(np.uint32),
                color=self._colors[top],
                flat_shading=True,
                side="double",
            )

    def _add_joints(self, alternatives: Mapping[tuple[str, str], Sequence[Alternative]]) -> None:
        with self._server.gui.add_folder("Joints"):
            self._server.gui.add_button("Back to rest").on_click(lambda _: self._rest())
            for joint in self._scene.leaders:
                self._add_joint(joint, alternatives.get((joint.parent, joint.child), ()))

    def _add_joint(self, joint: Joint, candidates: Sequence[Alternative]) -> None:
        gui, (lower, upper) = self._server.gui, self._scene.range_of(joint)
        unit = "m" if joint.kind is JointType.PRISMATIC else "rad"
        step = max((upper - lower) / _SLIDER_STEPS, 1e-9)
        slider = gui.add_slider(f"{joint.name} [{unit}]", lower, max(upper, lower + step), step, self._q[joint.name])
        self._sliders[joint.name] = slider
        slider.on_update(_ignoring_event(partial(self._slid, joint.name)))
        gui.add_button(f"Sweep {joint.name}").on_click(_ignoring_event(partial(self._sweep, joint.name)))
        if candidates:
            titles = [_AS_WRITTEN, *(f"{k + 1}: {item.title}" for k, item in enumerate(candidates))]
            choice = gui.add_dropdown(f"{joint.name} tried", titles, initial_value=_AS_WRITTEN)
            choice.on_update(lambda event: self._try(joint, candidates, titles.index(event.target.value)))
        self._draw_axis(joint)

    def _add_findings(self, sights: Sequence[Sight]) -> None:
        if not sights:
            return
        with self._server.gui.add_folder("Findings"):
            for sight in sights:
                button = self._server.gui.add_button(sight.title, hint=sight.message)
                button.on_click(_ignoring_event(partial(self.show, sight)))
            self._told = self._server.gui.add_markdown("")

    def _add_parts(self) -> None:
        with self._server.gui.add_folder("Parts", expand_by_default=False):
            for top in self._meshes:
                self._add_part(top)

    def _add_part(self, top: str) -> None:
        box = self._server.gui.add_checkbox(top, True)
        box.on_update(lambda event: self._toggle(top, visible=event.target.value))

    def show(self, sight: Sight) -> None:
        """Bring the model where a finding was seen, and mark what it is about."""
        with self._lock:
            self._sweeping = None
            self._marked = frozenset(sight.links)
            self._told.content = f"**{sight.title}**: {sight.message}"
            self.set({**self._scene.rest, **sight.q})

    def _rest(self) -> None:
        with self._lock:
            self._sweeping, self._marked = None, frozenset()
            self.set(self._scene.rest)

    def _slid(self, name: str) -> None:
        with self._lock:
            if self._q[name] != self._sliders[name].value:
                self._q[name] = float(self._sliders[name].value)
                self._place()

    def _sweep(self, name: str) -> None:
        with self._lock:
            self._sweeping = None if self._sweeping == name else name

    def _toggle(self, top: str, *, visible: bool) -> None:
        self._meshes[top].visible = visible

    def _try(self, joint: Joint, candidates: Sequence[Alternative], number: int) -> None:
        with self._lock:
            self._scene.try_joint(joint.name, candidates[number - 1] if number else None)
            self._draw_axis(joint)
            self._place()

    def _draw_axis(self, joint: Joint) -> None:
        """Draw the axis with the range; it stays with the parent while the joint moves."""
        points = self._scene.glyph(joint).astype(np.float32)
        color = _SLIDE if joint.kind is JointType.PRISMATIC else _AXIS
        colors = np.broadcast_to(np.array(color, dtype=np.uint8), points.shape)
        self._axes[joint.name] = self._server.scene.add_line_segments(
            f"/axes/{joint.name}", points, colors, thickness=3.0, thickness_units="screen"
        )

    def _place(self) -> None:
        """Put everything where the joints stand, and colour what touches."""
        poses = self._scene.poses(self._q)
        touches = self._scene.touches(self._q)
        colors = dict(self._colors)
        for touch in reversed(touches):  # the worst come first, and so last here
            if not touch.tolerated:
                colors.update(dict.fromkeys(touch.pair, _WRONG))
        for group in self._scene.groups:
            if self._marked & set(group.links):
                colors[group.top] = _TOUCHING
        with self._server.atomic():
            for top, mesh in self._meshes.items():
                mesh.wxyz, mesh.position = quaternion_of(poses[top][:3, :3]), poses[top][:3, 3]
                if top in colors and mesh.color != colors[top]:
                    mesh.color = colors[top]
            for joint in self._scene.leaders:
                self._place_axis(joint, poses)
        self._status.content = _told(touches)

    def _place_axis(self, joint: Joint, poses: Mapping[str, FloatArray]) -> None:
        T = poses[joint.parent] @ joint.T_parent_child
        handle = self._axes[joint.name]
        handle.wxyz, handle.position = quaternion_of(T[:3, :3]), T[:3, 3]


def _ignoring_event(action: Callable[[], None]) -> Callable[[Any], None]:
    """A callback of the page that does not care what caused it."""
    return lambda _: action()


def _told(touches: Sequence[Touch]) -> str:
    """Collisions and contacts in words."""
    if not touches:
        return "Nothing touches."
    lines = [
        f"- {'touch as at rest' if touch.tolerated else '**collide**'}: {' - '.join(touch.pair)}, "
        f"{1e3 * touch.depth:.3g} mm deep"
        for touch in touches[:_TOLD]
    ]
    more = [f"- and {len(touches) - _TOLD} more"] if len(touches) > _TOLD else []
    return "\n".join([*lines, *more])


def _color(index: int) -> tuple[int, int, int]:
    """A light grey for the root, then hues that differ from one body to the next, sRGB."""
    if index == 0:
        return 200, 197, 190
    red, green, blue = colorsys.hls_to_rgb((0.08 + 0.61803398875 * index) % 1.0, 0.62, 0.5)
    return round(255 * red), round(255 * green), round(255 * blue)
