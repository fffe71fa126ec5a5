"""The viewer itself: joints are moved, tried, kept and taken back, as the panel or a program asks."""

from __future__ import annotations

import io
import math
import threading
import time
from dataclasses import replace
from functools import partial
from operator import methodcaller
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from PIL import Image

from kinematify.errors import KinematifyError
from kinematify.refinement.hints import Hint
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import quaternion_of, rotation_from_quaternion, rotation_from_x
from kinematify.view.alternatives import JointAlternative, agreeing, described, distinct
from kinematify.view.drawn import DrawnModel
from kinematify.view.panel import Panel, collision_text

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import viser

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint
    from kinematify.view.inference_view import FindingMarker, ViewModel
    from kinematify.view.keep import ModelFolder, SavedEdit
    from kinematify.view.viewer_scene import ViewScene

_CHOSEN, _MARKED, _WRONG = (66, 133, 244), (245, 166, 35), (219, 40, 40)
"""Of the part whose joint is chosen, of what a finding is about, and of what collides."""
_FRAME = 1.0 / 30.0
_LOOK_AGAIN = 2.0
"""Between two looks at whether the file was changed [s]."""
_SWEEP_SECONDS = 4.0
_HEAD_START = 1.5
"""That the first client has for its first picture, before more is drawn and collisions are looked for, which keeps a
processor busy for a second [s]."""
_PICTURE = (1600, 1200)
_FILM, _FRAMES, _FILM_SECONDS = (480, 360), 24, 3.0


def _connect(widget: Any, action: Callable[[Any], object]) -> None:
    """Call an action with the event when a person uses a widget; what the program sets on it has no client."""
    subscribe = widget.on_click if hasattr(widget, "on_click") else widget.on_update
    subscribe(lambda event: None if event.client is None else action(event))


def _film(scene: ViewScene, ends: Mapping[str, tuple[float, float]], camera: Any) -> bytes:
    """GIF of joints that go from one end to the other and back, the others at rest, as a camera of a page sees them."""
    from kinematify.render.camera import camera_at  # noqa: PLC0415  # loads the ray caster
    from kinematify.render.film import draw_all, write_gif  # noqa: PLC0415
    from kinematify.render.picture import PictureScene  # noqa: PLC0415

    scenes = []
    for number in range(_FRAMES):
        share = 0.5 - 0.5 * math.cos(2.0 * math.pi * number / _FRAMES)
        q = {**scene.rest, **{name: lower + share * (upper - lower) for name, (lower, upper) in ends.items()}}
        scenes.append(PictureScene(meshes=scene.posed(q)))
    content = io.BytesIO()
    seen = camera_at(camera.position, camera.look_at, float(camera.fov), _FILM)
    write_gif(draw_all(scenes, seen), content, _FILM_SECONDS / _FRAMES)
    return content.getvalue()


class ModelViewer:
    """Page of a model: what it shows and does; every client sees the same.

    What a person tries stays in memory, as the one change that waits to be kept; only `keep` and `undo` write.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        shown: ViewModel,
        *,
        sights: Sequence[FindingMarker],
        open_folder: Callable[[], ModelFolder] | None = None,
        reopen: Callable[[], ViewModel] | None = None,
        changed_at: Callable[[], float] = float,
    ) -> None:
        """Build the page.

        Args:
            server: Running.
            shown: The model.
            sights: Findings.
            open_folder: Gives the place where a change that is kept is written; None: nothing can be kept.
            reopen: Reads the folder again after it was written.
            changed_at: When the file was last written [s]; 0 where it is not there.
        """
        self._server, self._open_folder, self._reopen = server, open_folder, reopen
        self._changed_at, self._read_at = changed_at, changed_at()
        self._folder: ModelFolder | None = None
        self._lock = threading.RLock()  # sliders, buttons and the sweep come from threads of their own
        self._random = np.random.default_rng(0)
        self._q: dict[str, float] = {}
        self._chosen: str | None = None
        self._open(shown, sights)
        self._drawn.look()
        server.on_client_connect(self._connected)

    def _connected(self, client: viser.ClientHandle) -> None:
        self._drawn.step_back(client)

    def _open(self, shown: ViewModel, sights: Sequence[FindingMarker] = ()) -> None:
        """Show a model in the pose of the one before, as far as it has the same joints."""
        with self._lock:
            pose, chosen, self._chosen = self._q, self._chosen, None
            scene = shown.scene
            self._scene, self._shown = scene, shown
            self._q = {joint.name: scene.rest[joint.name] for joint in scene.leaders}
            self._marked: frozenset[str] = frozenset()
            self._colliding: frozenset[str] = frozenset()
            self._sweeping: str | None = None
            self._sweep_start = 0.0
            self._waiting: Callable[[ModelFolder], SavedEdit | None] | None = None
            self._stale = True
            self._gizmo: Any = None
            self._line = (np.array([1.0, 0.0, 0.0]), np.zeros(3))
            self._drawn = DrawnModel(self._server, scene, shown.chains, self.click)
            can_keep = self._open_folder is not None
            self._panel = Panel(self._server.gui, shown, sights, self._drawn.parts, can_keep=can_keep)
            self._connect_panel()
            self.set(pose)
            if chosen is not None:
                self.choose(chosen)

    def _connect_panel(self) -> None:
        """Make the widgets act; those that change the model propose what `keep` would write."""
        panel, drawn = self._panel, self._drawn
        actions: list[tuple[Any, Callable[[Any], object]]] = [
            (panel.poses, lambda event: self.take_pose(event.target.value)),
            (panel.play, self._play),
            (panel.choice, self._try_choice),
            (panel.parent, lambda event: self.state("parent", event.target.value)),
            (panel.twin, lambda event: self.state("twin", event.target.value)),
            (panel.edit, lambda _: self.set_by_hand()),
            (panel.hand_type, self._change_type),
            (panel.hand_limits, lambda _: self.change_line()),
            (panel.keep, lambda _: self.keep()),
            (panel.undo, lambda _: self.undo()),
            (panel.axes, lambda event: drawn.show_axes(event.target.value)),
            (panel.picture, lambda event: self.send_picture(event.client)),
            (panel.film, lambda event: self.send_film(event.client)),
            *((slider, partial(self._slide, name)) for name, slider in panel.sliders.items()),
            *((button, lambda _, sight=sight: self.show(sight)) for button, sight in panel.places),
            *(
                (box, lambda event, top=top: drawn.show_part(top, event.target.value))
                for top, box in panel.boxes.items()
            ),
        ]
        for widget, action in actions:
            _connect(widget, action)
        panel.undo.visible = self._folder is not None and self._folder.can_undo

    def set(self, values: Mapping[str, float]) -> None:
        """Move joints [rad or m], sliders included; names that are no leaders are passed over."""
        with self._lock:
            for name, value in values.items():
                if name in self._panel.sliders:
                    self._q[name] = self._panel.move(name, value)
            self._place()

    @property
    def values(self) -> dict[str, float]:
        """Where the leaders stand [rad or m]."""
        with self._lock:
            return dict(self._q)

    @property
    def parts(self) -> tuple[str, ...]:
        """Top links of what can be seen."""
        return self._drawn.parts

    @property
    def status(self) -> str:
        """Return what the page says of collisions."""
        return str(self._panel.status.content)

    def run(self, stop: threading.Event) -> None:
        """Sweep what is to be swept and look for collisions until `stop` is set."""
        first: float | None = None
        checked = time.monotonic()
        while not stop.wait(_FRAME):
            now = time.monotonic()
            if now - checked > _LOOK_AGAIN:
                checked = now
                self._follow_file()
            if first is None and self._server.get_clients():
                first = now
            if (name := self._sweeping) is not None:
                share = 0.5 - 0.5 * np.cos(2.0 * np.pi * (now - self._sweep_start) / _SWEEP_SECONDS)
                lower, upper = self._scene.range_of(self._scene.robot.joint_by_name[name])
                self.set({name: float(lower + share * (upper - lower))})
            if first is not None and now - first > _HEAD_START:
                self._add_marks()
                if self._stale:
                    self.look_for_collisions()

    def _follow_file(self) -> None:
        """Show the model again if another program wrote its file."""
        changed = self._changed_at()
        if self._reopen is None or changed in (0.0, self._read_at):
            return
        self._read_at = changed
        try:
            shown = self._reopen()
        except KinematifyError as error:
            self._notify("The file was changed and cannot be read; the page shows it as it was", str(error))
            return
        self._folder = None
        self._open(shown)
        self._panel.tell("The file was changed; the page shows it as it is now.")

    def _add_marks(self) -> None:
        with self._lock:
            if not self._drawn.complete:
                self._drawn.add_marks()
                self._drawn.place(self._q)

    def click(self, top: str) -> None:
        """Choose a part, and the joint that carries it or the one that leads that."""
        robot = self._scene.robot
        joint = robot.joint_above.get(top)
        while joint is not None and joint.mimic is not None:
            joint = robot.joint_by_name[joint.mimic.joint]
        if joint is not None:
            self.choose(joint.name)

    def choose(self, joint: str) -> None:
        """Make the part of a joint glow, and show what is known of the joint."""
        with self._lock:
            if self._chosen != joint and joint in self._panel.sliders:
                self.show_as_in_file()
                self._chosen, self._marked = joint, frozenset()
                item = self._scene.robot.joint_by_name[joint]
                said = [words for _, words in self._candidates(item)]
                parents, twins = (of.get(item.child, ()) for of in (self._shown.parents, self._shown.twins))
                self._panel.show_joint(item, said, parents, twins)
                self._panel.describe(item, self._shown.confidences.get(item.child))
                self._glow()

    def show(self, sight: FindingMarker) -> None:
        """Bring the model where a finding was seen, and mark what it is about."""
        with self._lock:
            self._sweeping, self._chosen = None, None
            self._marked = frozenset(sight.links)
            self.set({**self._scene.rest, **sight.q})
            self._glow()

    # ---- what waits to be kept ---------------------------------------------------------------------------------------

    def _propose(self, words: str, change: Callable[[ModelFolder], SavedEdit | None]) -> None:
        """Make a change wait to be kept, in place of the one that did."""
        self._waiting = change
        self._panel.offer(words)

    def show_as_in_file(self) -> None:
        """Show everything as in the file; what waited to be kept is forgotten."""
        self._waiting = None
        self._end_by_hand()
        for name in self._scene.tried_joints:
            self._try(name, None)
        if self._chosen is not None:
            self._panel.show_as_written()
        self._panel.offer("")

    def try_candidate(self, joint: str, number: int) -> None:
        """Move a joint as one of its candidates says, 0 for as in the file, and show that on the page."""
        with self._lock:
            self.choose(joint)
            self.show_as_in_file()
            if number and joint == self._chosen:
                item = self._scene.robot.joint_by_name[joint]
                alternative, words = self._candidates(item)[number - 1]
                self._panel.choice.value = self._panel.choice.options[number]
                self._preview(item, alternative, f"{item.child} {words}")

    def _try_choice(self, event: Any) -> None:
        choice = event.target
        if self._chosen is not None and choice.value in choice.options:  # else its options are new
            self.try_candidate(self._chosen, choice.options.index(choice.value))

    def state(self, key: Literal["parent", "twin"], name: str) -> None:
        """Propose another parent of the chosen joint's part, or the joint of its twin."""
        with self._lock:
            if self._chosen is None:
                return
            self.show_as_in_file()
            joint = self._scene.robot.joint_by_name[self._chosen]
            offered = self._shown.parents if key == "parent" else self._shown.twins
            if (key == "parent" and name == joint.parent) or name not in offered.get(joint.child, ()):
                return
            getattr(self._panel, key).value = name
            hint = Hint(part=joint.child, parent=name) if key == "parent" else Hint(part=joint.child, twin=name)
            said = f"with {name} as its parent" if key == "parent" else f"with the same joint as {name}"
            self._propose(f"{joint.child} {said}", methodcaller("state", hint))

    def _preview(self, joint: Joint, alternative: JointAlternative, words: str) -> None:
        """Move a joint as an alternative says; that waits to be kept."""
        self._try(joint.name, alternative)
        tried = self._scene.tried(joint.name) or alternative
        self._propose(words, methodcaller("keep", joint.child, tried))
        self._glow()

    def _try(self, joint: str, alternative: JointAlternative | None) -> None:
        item = self._scene.robot.joint_by_name[joint]
        self._scene.try_joint(joint, alternative)
        if alternative is not None and alternative.limits is None and alternative.kind is not JointType.FIXED:
            self._scene.try_joint(joint, replace(alternative, limits=self._scene.free_range(item)))
        self._sweeping = None
        self._drawn.draw_axis(item)
        self._q[joint] = float(np.clip(0.0, *self._scene.range_of(item)))
        self._panel.refit(item)
        likely = self._shown.confidences.get(item.child) if alternative is None else alternative.probability
        self._panel.describe(item, likely)
        self._place()

    def keep(self) -> SavedEdit | None:
        """Write the model with what waits, and show it again; None if nothing waits or it could not be written."""
        with self._lock:
            change, self._waiting = self._waiting, None
        kept = None if change is None else self._write(change)
        if kept is None:
            self._waiting = change
        return kept

    def undo(self) -> None:
        """Write the model as it was before the last change, and show it."""
        self._write(methodcaller("undo"))

    def _write(self, change: Callable[[ModelFolder], SavedEdit | None]) -> SavedEdit | None:
        """Change the folder, say what came of it, and show what it holds: nothing else here writes."""
        assert self._open_folder is not None
        assert self._reopen is not None
        panel, folder = self._panel, self._folder or self._open_folder()
        self._folder = folder
        panel.keep.disabled = panel.undo.disabled = True
        waiting = [
            client.add_notification("Inferring again ...", "The model is written when it is done.", loading=True)
            for client in self._server.get_clients().values()
        ]
        try:
            kept = change(folder)
            shown = self._reopen()
        except KinematifyError as error:
            panel.keep.disabled = panel.undo.disabled = False
            self._notify("Nothing was changed", str(error))
            return None
        finally:
            self._read_at = self._changed_at()
            for item in waiting:
                item.remove()
        self._open(shown)
        self._panel.tell("" if kept is not None else "Undone.", kept)
        return kept

    def _notify(self, title: str, body: str) -> None:
        for client in self._server.get_clients().values():
            client.add_notification(title, body, color="red")

    # ---- by hand -----------------------------------------------------------------------------------------------------

    def set_by_hand(self) -> None:
        """Begin to set the chosen joint by hand: all joints at zero, where its axis stands as it is given."""
        with self._lock:
            if self._chosen is None:
                return
            joint = self._scene.robot.joint_by_name[self._chosen]
            if self._scene.tried(joint.name) is None:
                self.show_as_in_file()
            self.set(dict.fromkeys(self._q, 0.0))
            axis, pivot = self._scene.line_of(joint)
            self._end_by_hand()
            self._panel.begin_by_hand(self._scene.kind_of(joint), self._scene.range_of(joint))
            self._line = axis, pivot
            self._gizmo = self._drawn.add_gizmo(axis, pivot)
            _connect(self._gizmo, lambda _: self.move_line())
            self.change_line()

    def _end_by_hand(self) -> None:
        if self._gizmo is not None:
            self._gizmo.remove()
        self._gizmo = None

    def _change_type(self, _: Any) -> None:
        """Begin the range of another type again: a quarter turn, or half of the model's size."""
        with self._lock:
            if self._gizmo is not None:
                kind, _ = self._panel.by_hand()
                self._panel.fit_limits(kind, (0.0, 0.5 * math.pi if kind.turns else 0.5 * self._scene.size))
                self.change_line()

    def move_line(self) -> None:
        """Take the line of the joint from the gizmo, which follows the part that carries it."""
        with self._lock:
            if self._gizmo is not None and self._chosen is not None:
                T = np.linalg.inv(self._carried(self._chosen))
                axis = rotation_from_quaternion(np.asarray(self._gizmo.wxyz))[:, 0]
                self._line = T[:3, :3] @ axis, T[:3, :3] @ np.asarray(self._gizmo.position) + T[:3, 3]
                self.change_line()

    def _carried(self, joint: str) -> FloatArray:
        """Motion of a joint's parent since all joints were at zero, frame of the root link, shape (4, 4)."""
        parent = self._scene.robot.joint_by_name[joint].parent
        moved: FloatArray = self._scene.poses(self._q)[parent] @ np.linalg.inv(self._scene.poses({})[parent])
        return moved

    def change_line(self) -> None:
        """Try the joint as line, type and limits say."""
        with self._lock:
            if self._gizmo is None or self._chosen is None:
                return
            kind, (lower, upper) = self._panel.by_hand()
            limited = kind in (JointType.REVOLUTE, JointType.PRISMATIC)
            alternative = JointAlternative(
                kind=kind,
                axis=self._line[0],
                pivot=self._line[1],
                by_hand=True,
                limits=(min(lower, 0.0), max(upper, 0.0)) if limited else None,
            )
            joint = self._scene.robot.joint_by_name[self._chosen]
            self._preview(joint, alternative, f"{joint.child} moves as it is set here")

    def _candidates(self, joint: Joint) -> list[tuple[JointAlternative, str]]:
        """Candidates of a joint, each with what it does in words."""
        bounds = self._scene.bounds.get(self._scene.group_of(joint.child), np.zeros((2, 3)))
        size = float(np.linalg.norm(bounds[1] - bounds[0])) or self._scene.size
        axis, pivot = self._scene.line_in_file(joint)
        written = JointAlternative(kind=joint.kind, axis=axis, pivot=pivot)
        known = distinct(self._shown.alternatives.get((joint.parent, joint.child), ()), size)
        found = agreeing(known, written, self._shown.confidences.get(joint.child), size)
        return [(item, described(item, bounds)) for item in found]

    # ---- poses and pictures ------------------------------------------------------------------------------------------

    def take_pose(self, name: str) -> None:
        """Bring all joints to rest, to the end of their way, or anywhere."""
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
            if name == "Opened":
                self._drawn.fit(self._q)

    def _slide(self, joint: str, event: Any) -> None:
        """Move a joint whose slider a person moves, and choose it unless a change of another one waits."""
        with self._lock:
            self._q[joint] = float(event.target.value) / self._panel.factor(joint)
            self._place()
            if self._waiting is None:
                self.choose(joint)

    def _play(self, _: Any) -> None:
        """Make the chosen joint go to and fro, or stop."""
        with self._lock:
            self._sweeping = None if self._sweeping == self._chosen else self._chosen
            self._sweep_start = time.monotonic()

    def send_picture(self, client: Any) -> None:
        """Make the page of a client draw a picture from where it looks, and offer it there."""
        width, height = _PICTURE
        pixels = client.get_render(height, width, transport_format="png")
        content = io.BytesIO()
        Image.fromarray(pixels).save(content, format="PNG")
        client.send_file_download(f"{self._scene.robot.name}.png", content.getvalue())

    def send_film(self, client: Any) -> None:
        """Film the chosen joint, or all of them, there and back, from where this page looks."""
        with self._lock:
            joints = [joint for joint in self._scene.leaders if self._chosen in (None, joint.name)]
            ends = {joint.name: self._scene.range_of(joint) for joint in joints}
        waiting = client.add_notification("Drawing the film ...", "It takes some seconds.", loading=True)
        try:
            film = _film(self._scene, ends, client.camera)
        finally:
            waiting.remove()
        client.send_file_download(f"{self._scene.robot.name}.gif", film)

    def _place(self) -> None:
        """Put everything where the joints stand; collisions are looked for later, since that takes longer."""
        self._drawn.place(self._q)
        if self._gizmo is not None and self._chosen is not None:
            T, (axis, pivot) = self._carried(self._chosen), self._line
            self._gizmo.wxyz = quaternion_of(rotation_from_x(T[:3, :3] @ axis))
            self._gizmo.position = T[:3, :3] @ pivot + T[:3, 3]
        self._stale = True

    def look_for_collisions(self) -> None:
        """Say what collides where the joints stand, and let it glow."""
        try:
            self._scene.prepare_collisions()  # not in the lock, for which sliders would wait
        except KinematifyError as error:
            self._stale = False
            self._panel.status.content = collision_text(error)
            return
        with self._lock:
            self._stale = False
            touches = self._scene.touches(self._q)
            self._colliding = frozenset(top for pair, _, tolerated in touches if not tolerated for top in pair)
            self._panel.status.content = collision_text(touches)
            self._glow()

    def _glow(self) -> None:
        """Make parts glow that collide, that a finding is about, or whose joint is chosen."""
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
