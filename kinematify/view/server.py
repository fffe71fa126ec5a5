"""The viewer itself: joints are moved, tried, kept and taken back; the panel at its side (viser's gui)."""

from __future__ import annotations

import io
import math
import threading
import time
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from PIL import Image

from kinematify.errors import KinematifyError
from kinematify.pipeline.inference import DOUBTFUL
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rotation_from_quaternion
from kinematify.view.alternatives import Alternative, described, distinct
from kinematify.view.drawn import DrawnModel
from kinematify.view.film import film_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import viser

    from kinematify.robot.robot import Joint
    from kinematify.view.keep import Kept, ModelFolder
    from kinematify.view.scene import Touch
    from kinematify.view.shown import Shown

_CHOSEN, _MARKED, _WRONG = (66, 133, 244), (245, 166, 35), (219, 40, 40)
"""Of the part whose joint is chosen, of what a finding is about, and of what collides."""
_AS_WRITTEN = "as in the file"
_TYPES = {
    "turns": JointType.REVOLUTE,
    "turns without end": JointType.CONTINUOUS,
    "slides": JointType.PRISMATIC,
    "fixed": JointType.FIXED,
}
"""What a joint can be set to by hand."""
_FRAME = 1.0 / 30.0
_SWEEP_SECONDS = 4.0
_SLIDER_STEPS = 400
_TOLD = 12
"""Touching pairs that are listed."""
_SIGHTS = 40
"""Findings that are listed; the report has all."""
_POSES = ("At rest", "Opened", "Random")
_PICTURE = (1600, 1200)


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
        shown: Shown,
        *,
        sights: Sequence[Sight],
        folder: ModelFolder | None = None,
        reopen: Callable[[], Shown] | None = None,
    ) -> None:
        """Build the page.

        Args:
            server: Running.
            shown: The model.
            sights: Findings.
            folder: Where a candidate that is kept is written; None: nothing can be kept.
            reopen: Reads the folder again after it was written.
        """
        self._server, self._folder, self._reopen = server, folder, reopen
        self._lock = threading.RLock()  # sliders, buttons and the sweep come from threads of their own
        self._random = np.random.default_rng(0)
        server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="medium")
        self._open(shown, sights, _doubts(shown))

    def _open(self, shown: Shown, sights: Sequence[Sight], said: str) -> None:
        """Show a model from the beginning."""
        with self._lock:
            scene = shown.scene
            self._scene, self._alternatives = scene, shown.alternatives
            self._q = {joint.name: scene.rest[joint.name] for joint in scene.leaders}
            self._marked: frozenset[str] = frozenset()
            self._sweeping: str | None = None
            self._chosen: str | None = None
            self._apart = 0.0
            self._stale = True
            self._colliding: frozenset[str] = frozenset()
            self._sliders: dict[str, Any] = {}
            self._gizmo: Any = None
            self._drawn = DrawnModel(self._server, scene, shown.chains, self._clicked)
            self._server.gui.reset()
            self._server.gui.set_panel_label(scene.robot.name)
            self._add_panel(sights, said)
            self._place()

    def set(self, values: Mapping[str, float]) -> None:
        """Move joints [rad or m], sliders included; names that are no leaders are passed over."""
        with self._lock:
            for name, value in values.items():
                if name in self._sliders:
                    slider, factor = self._sliders[name], self._factor(name)
                    self._q[name] = float(np.clip(value, slider.min / factor, slider.max / factor))
                    slider.value = float(np.clip(self._q[name] * factor, slider.min, slider.max))
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
        """Sweep what is to be swept and look for collisions until told to stop."""
        start, last = time.monotonic(), ""
        while not stop.wait(_FRAME):
            name = self._sweeping
            if name is not None:
                if name != last:
                    start = time.monotonic()
                share = 0.5 - 0.5 * np.cos(2.0 * np.pi * (time.monotonic() - start) / _SWEEP_SECONDS)
                lower, upper = self._scene.range_of(self._scene.robot.joint_by_name[name])
                self.set({name: float(lower + share * (upper - lower))})
            last = name or ""
            if self._stale:
                self._look_for_collisions()

    def choose(self, joint: str) -> None:
        """Let the part of a joint glow, and show what is known of the joint."""
        with self._lock:
            if self._chosen != joint and joint in self._sliders:
                self._chosen, self._marked = joint, frozenset()
                self._end_by_hand()
                self._fill_joint(joint)
                self._glow()

    def show(self, sight: Sight) -> None:
        """Bring the model where a finding was seen, and mark what it is about."""
        with self._lock:
            self._sweeping, self._chosen = None, None
            self._marked = frozenset(sight.links)
            self.set({**self._scene.rest, **sight.q})
            self._glow()

    def try_candidate(self, joint: str, number: int) -> None:
        """Move a joint as one of its candidates says, 0 for as in the file, and show that on the page."""
        with self._lock:
            self._end_by_hand()
            candidates = self._candidates(self._scene.robot.joint_by_name[joint])
            self._try(joint, candidates[number - 1] if number else None)

    def _try(self, joint: str, alternative: Alternative | None) -> None:
        self._scene.try_joint(joint, alternative)
        self._sweeping = None
        item = self._scene.robot.joint_by_name[joint]
        self._drawn.draw_axis(item)
        self._refit_slider(item)
        self._keep.visible = alternative is not None and self._folder is not None
        self._place()

    def set_by_hand(self) -> None:
        """Begin to set the chosen joint by hand: all joints at zero, where its axis stands as it is given."""
        with self._lock:
            if self._chosen is None:
                return
            joint = self._scene.robot.joint_by_name[self._chosen]
            self.set(dict.fromkeys(self._sliders, 0.0))
            axis, pivot = self._scene.line_of(joint)
            kind = self._scene.kind_of(joint)
            self._end_by_hand()
            self._hand_type.value = next(words for words, item in _TYPES.items() if item is kind)
            self._fit_ends(kind, self._scene.range_of(joint))
            self._gizmo = self._drawn.add_gizmo(axis, pivot)
            self._gizmo.on_update(_ignoring_event(self._hand_moved))
            for handle in (self._hand_type, self._hand_ends):
                handle.visible = True
            self._hand_moved()

    def set_limits(self, lower: float, upper: float) -> None:
        """Put the two handles of the limits somewhere [deg or mm]; only while a joint is set by hand."""
        self._hand_ends.value = (lower, upper)
        self._hand_moved()

    def _end_by_hand(self) -> None:
        if self._gizmo is not None:
            self._gizmo.remove()
        self._gizmo = None
        self._hand_type.visible = self._hand_ends.visible = False

    def _fit_ends(self, kind: JointType, ends: tuple[float, float]) -> None:
        """Give the two handles of the limits their range and unit."""
        reach = 360.0 if kind.turns else 1000.0 * self._scene.size
        factor = _factor_of(kind)
        handle = self._hand_ends
        handle.label = f"Limits [{'deg' if kind.turns else 'mm'}]"
        handle.min, handle.max, handle.step = -reach, reach, 0.1
        handle.value = tuple(round(float(np.clip(factor * end, -reach, reach)), 1) for end in ends)

    def _hand_kind(self) -> None:
        """Begin the range of another type anew: a quarter turn, or half of the model's size."""
        with self._lock:
            if self._gizmo is not None:
                kind = _TYPES[self._hand_type.value]
                self._fit_ends(kind, (0.0, 0.5 * math.pi if kind.turns else 0.5 * self._scene.size))
                self._hand_moved()

    def _hand_moved(self) -> None:
        """Try the joint as gizmo, type and limits say."""
        with self._lock:
            if self._gizmo is None or self._chosen is None:
                return
            kind = _TYPES[self._hand_type.value]
            lower, upper = (float(end) / _factor_of(kind) for end in self._hand_ends.value)
            limited = kind in (JointType.REVOLUTE, JointType.PRISMATIC)
            alternative = Alternative(
                kind=kind,
                axis=rotation_from_quaternion(np.asarray(self._gizmo.wxyz))[:, 0],
                pivot=np.array(self._gizmo.position, dtype=np.float64),
                by_hand=True,
                limits=(min(lower, 0.0), max(upper, 0.0)) if limited else None,
            )
            self._try(self._chosen, alternative)

    def keep(self) -> Kept | None:
        """Write the model with the joint as it is tried, and show it anew; None if it could not be written."""
        assert self._folder is not None
        with self._lock:
            joint = None if self._chosen is None else self._scene.robot.joint_by_name[self._chosen]
            tried = None if joint is None else self._scene.tried(joint.name)
        if joint is None or tried is None:
            return None
        return self._written(partial(self._folder.keep, joint.child, tried))

    def _undo(self) -> None:
        assert self._folder is not None
        self._written(self._folder.undo)

    def _written(self, write: Callable[[], Kept | None]) -> Kept | None:
        """Change the folder, tell what came of it, and show what it holds."""
        assert self._reopen is not None
        self._keep.disabled = True
        waiting = [
            client.add_notification("Inferring again ...", "The model is written when it is done.", loading=True)
            for client in self._server.get_clients().values()
        ]
        try:
            kept = write()
            shown = self._reopen()
        except KinematifyError as error:
            self._keep.disabled = False
            self._tell("Nothing was changed", str(error))
            return None
        finally:
            for item in waiting:
                item.remove()
        self._open(shown, (), _doubts(shown) if kept is None else _kept_words(kept))
        return kept

    def _tell(self, title: str, body: str) -> None:
        for client in self._server.get_clients().values():
            client.add_notification(title, body, color="red")

    def _add_panel(self, sights: Sequence[Sight], said: str) -> None:
        gui = self._server.gui
        poses = gui.add_button_group("Pose", _POSES)
        poses.on_click(lambda event: self._pose(event.target.value))
        self._status = gui.add_markdown("Looking for collisions ...")
        tabs = gui.add_tab_group()
        with tabs.add_tab("Joints"):
            self._add_joints(said)
        if sights:
            with tabs.add_tab(f"Findings ({len(sights)})"):
                self._add_findings(sights)
        with tabs.add_tab("View"):
            self._add_view()

    def _add_joints(self, said: str) -> None:
        gui = self._server.gui
        for joint in self._scene.leaders:
            self._add_slider(joint)
        if not self._scene.leaders:
            gui.add_markdown("No joint of this model moves.")
        self._told = gui.add_markdown(said)
        self._play = gui.add_button("Play", visible=False)
        self._play.on_click(_ignoring_event(self._sweep))
        self._options = [_AS_WRITTEN]
        self._choice: Any = gui.add_dropdown("It could also", (_AS_WRITTEN,), visible=False)
        self._choice.on_update(_ignoring_event(self._tried))
        self._by_hand = gui.add_button(
            "Set by hand", visible=False, hint="Type, axis and limits; the red arrow of the gizmo is the axis."
        )
        self._by_hand.on_click(_ignoring_event(self.set_by_hand))
        self._hand_type: Any = gui.add_dropdown("Type", tuple(_TYPES), visible=False)
        self._hand_type.on_update(_ignoring_event(self._hand_kind))
        self._hand_ends: Any = gui.add_multi_slider("Limits", -360.0, 360.0, 0.1, (0.0, 90.0), visible=False)
        self._hand_ends.on_update(_ignoring_event(self._hand_moved))
        self._keep = gui.add_button("Keep this", visible=False, color="green", hint="Writes the model with this joint.")
        self._keep.on_click(_ignoring_event(self.keep))
        can_undo = self._folder is not None and self._folder.can_undo
        back = gui.add_button("Take the last choice back", visible=can_undo)
        back.on_click(_ignoring_event(self._undo))

    def _add_slider(self, joint: Joint) -> None:
        lower, upper, step = self._ends(joint)
        start = float(np.clip(self._q[joint.name] * self._factor(joint.name), lower, upper))
        slider = self._server.gui.add_slider(f"{joint.name} [{self._unit(joint)}]", lower, upper, step, start)
        slider.on_update(partial(self._slid, joint.name))
        self._sliders[joint.name] = slider

    def _ends(self, joint: Joint) -> tuple[float, float, float]:
        """Lower end, upper end and step of a slider, in its unit."""
        factor = self._factor(joint.name)
        lower, upper = (factor * end for end in self._scene.range_of(joint))
        decade = math.floor(math.log10(max((upper - lower) / _SLIDER_STEPS, 1e-9)))
        step = 10.0**decade
        return round(lower, -decade), round(max(upper, lower + step), -decade), step

    def _refit_slider(self, joint: Joint) -> None:
        """Give a slider the range and the unit of what is tried."""
        self._q[joint.name] = float(np.clip(0.0, *self._scene.range_of(joint)))
        slider = self._sliders[joint.name]
        lower, upper, step = self._ends(joint)
        slider.label = f"{joint.name} [{self._unit(joint)}]"
        slider.min, slider.max, slider.step = lower, upper, step
        slider.value = float(np.clip(0.0, lower, upper))

    def _factor(self, name: str) -> float:
        """Units of a slider per rad or m."""
        return _factor_of(self._scene.kind_of(self._scene.robot.joint_by_name[name]))

    def _unit(self, joint: Joint) -> str:
        return "deg" if self._scene.kind_of(joint).turns else "mm"

    def _candidates(self, joint: Joint) -> tuple[Alternative, ...]:
        bounds = self._scene.bounds.get(self._scene.group_of(joint.child))
        size = self._scene.size if bounds is None else float(np.linalg.norm(bounds[1] - bounds[0]))
        return distinct(self._alternatives.get((joint.parent, joint.child), ()), size)

    def _fill_joint(self, name: str) -> None:
        """What is known of the chosen joint, below the sliders."""
        joint = self._scene.robot.joint_by_name[name]
        self._told.content = f"**{name}** moves {joint.child} on {joint.parent} ({joint.kind.value})."
        self._play.visible = True
        self._play.label = f"Play {name}"
        candidates = self._candidates(joint)
        bounds = self._scene.bounds.get(self._scene.group_of(joint.child), np.zeros((2, 3)))
        words = [f"{number}: {described(item, bounds)}" for number, item in enumerate(candidates, start=1)]
        self._options = [_AS_WRITTEN, *words]
        self._choice.options = tuple(self._options)
        self._choice.value = _AS_WRITTEN
        self._choice.visible = bool(candidates)
        self._by_hand.visible = self._folder is not None
        self._keep.visible = False

    def _add_findings(self, sights: Sequence[Sight]) -> None:
        gui = self._server.gui
        for sight in sights[:_SIGHTS]:
            with gui.add_folder(sight.title, expand_by_default=len(sights) <= 3):
                gui.add_markdown(sight.message)
                gui.add_button("Show the place").on_click(_ignoring_event(partial(self.show, sight)))
        if len(sights) > _SIGHTS:
            gui.add_markdown(f"{len(sights) - _SIGHTS} more stand in the report.")

    def _add_view(self) -> None:
        gui = self._server.gui
        gui.add_slider("Taken apart [%]", 0, 100, 1, 0).on_update(lambda event: self._take_apart(event.target.value))
        gui.add_checkbox("Axes", initial_value=True).on_update(lambda event: self._drawn.show_axes(event.target.value))
        gui.add_button("Picture (PNG)").on_click(lambda event: self._send_picture(event.client))
        gui.add_button("Film (GIF)").on_click(lambda event: self._send_film(event.client))
        with gui.add_folder("Parts", expand_by_default=False):
            for top in self._drawn.parts:
                box = gui.add_checkbox(top, initial_value=True)
                box.on_update(partial(self._toggle, top))

    def _pose(self, name: str) -> None:
        with self._lock:
            self._sweeping, self._marked = None, frozenset()
            values = dict(self._scene.rest)
            for joint in self._scene.leaders:
                lower, upper = self._scene.range_of(joint)
                if name == "Opened":
                    values[joint.name] = upper if abs(upper) >= abs(lower) else lower
                elif name == "Random":
                    values[joint.name] = float(self._random.uniform(lower, upper))
            self.set(values)
            self._glow()

    def _clicked(self, top: str) -> None:
        """Choose the joint that carries a part, or the one that leads it."""
        robot = self._scene.robot
        joint = robot.joint_above.get(top)
        while joint is not None and joint.mimic is not None:
            joint = robot.joint_by_name[joint.mimic.joint]
        if joint is not None and joint.name in self._sliders:
            self.choose(joint.name)

    def _slid(self, name: str, event: Any) -> None:
        if event.client is None:  # moved by the program, not by a hand
            return
        with self._lock:
            value = float(self._sliders[name].value) / self._factor(name)
            self._q[name] = value
            self._place()
            self.choose(name)

    def _sweep(self) -> None:
        with self._lock:
            self._sweeping = None if self._sweeping == self._chosen else self._chosen

    def _tried(self) -> None:
        with self._lock:
            if self._chosen is not None and self._choice.value in self._options:
                self.try_candidate(self._chosen, self._options.index(self._choice.value))

    def _toggle(self, top: str, event: Any) -> None:
        self._drawn.show_part(top, event.target.value)

    def _take_apart(self, percent: float) -> None:
        with self._lock:
            self._apart = percent / 100.0
            self._place()

    def _send_picture(self, client: Any) -> None:
        width, height = _PICTURE
        pixels = client.get_render(height, width, transport_format="png")
        content = io.BytesIO()
        Image.fromarray(pixels).save(content, format="PNG")
        client.send_file_download(f"{self._scene.robot.name}.png", content.getvalue())

    def _send_film(self, client: Any) -> None:
        """Film the chosen joint, or all of them, there and back, from where this page looks."""
        with self._lock:
            joints = [joint for joint in self._scene.leaders if self._chosen in (None, joint.name)]
            ends = {joint.name: self._scene.range_of(joint) for joint in joints}
        waiting = client.add_notification("Drawing the film ...", "It takes some seconds.", loading=True)
        try:
            camera = client.camera
            film = film_of(
                self._scene, ends, eye=camera.position, target=camera.look_at, field_of_view=float(camera.fov)
            )
        finally:
            waiting.remove()
        client.send_file_download(f"{self._scene.robot.name}.gif", film)

    def _place(self) -> None:
        """Put everything where the joints stand; collisions are looked for later, since that takes longer."""
        self._drawn.place(self._q, self._apart)
        self._stale = True

    def _look_for_collisions(self) -> None:
        with self._lock:
            self._stale = False
            touches = self._scene.touches(self._q)
            self._colliding = frozenset(top for touch in touches if not touch.tolerated for top in touch.pair)
            self._status.content = _told(touches)
            self._glow()

    def _glow(self) -> None:
        """Let parts glow that collide, that a finding is about, or whose joint is chosen."""
        chosen = self._chosen and self._scene.group_of(self._scene.robot.joint_by_name[self._chosen].child)
        for group in self._scene.groups:
            color = None
            if self._marked & set(group.links):
                color = _MARKED
            elif group.top in self._colliding:
                color = _WRONG
            elif group.top == chosen:
                color = _CHOSEN
            self._drawn.let_glow(group.top, color)


def _factor_of(kind: JointType) -> float:
    """Degrees per rad, or millimetres per m."""
    return 180.0 / math.pi if kind.turns else 1000.0


def _ignoring_event(action: Callable[[], object]) -> Callable[[Any], None]:
    """A callback of the page that does not care what caused it."""

    def called(_: Any) -> None:
        action()

    return called


def _doubts(shown: Shown) -> str:
    """How to begin, the joints to look at first, and where chains of joints close."""
    said = ["Touch a slider or click a part."]
    if shown.doubtful:
        said.append(f"Look at these, the inference is less than {DOUBTFUL:.0%} sure: **{', '.join(shown.doubtful)}**.")
    said += [f"Dashed line: {chain.told}" for chain in shown.chains]
    return "\n\n".join(said)


def _kept_words(kept: Kept) -> str:
    """What was written, and the command that does the same."""
    warnings = "".join(f"\n\n{warning}" for warning in kept.warnings)
    return f"Kept. The same from the command line:\n\n```\n{kept.command}\n```{warnings}"


def _told(touches: Sequence[Touch]) -> str:
    """Collisions and contacts in words."""
    bad = [touch for touch in touches if not touch.tolerated]
    if not bad:
        return "Nothing collides."
    lines = [
        f"- **{' and '.join(touch.pair)}** stand in each other, {1e3 * touch.depth:.3g} mm deep"
        for touch in bad[:_TOLD]
    ]
    more = [f"- and {len(bad) - _TOLD} more pairs"] if len(bad) > _TOLD else []
    return "\n".join([*lines, *more])
