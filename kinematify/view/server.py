"""The viewer itself: joints are moved, tried, kept and taken back, as the panel or a program asks."""

from __future__ import annotations

import io
import math
import threading
import time
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from PIL import Image

from kinematify.errors import KinematifyError
from kinematify.refinement.hints import Hint
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import quaternion_of, rotation_from_quaternion, rotation_from_x
from kinematify.view.alternatives import JointAlternative, agreeing, described, distinct
from kinematify.view.drawn import DrawnModel
from kinematify.view.panel import Panel, said_of, said_of_failure, said_of_kept, said_of_touches
from kinematify.view.regroup import GroupPanel

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import viser

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint
    from kinematify.view.inference_view import Shown, Sight
    from kinematify.view.keep import Kept, ModelFolder

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


class ModelViewer:
    """Page of a model: what it does; every client sees the same."""

    def __init__(
        self,
        server: viser.ViserServer,
        shown: Shown,
        *,
        sights: Sequence[Sight],
        open_folder: Callable[[], ModelFolder] | None = None,
        reopen: Callable[[], Shown] | None = None,
        changed_at: Callable[[], float] = float,
    ) -> None:
        """Build the page.

        Args:
            server: Running.
            shown: The model.
            sights: Findings.
            open_folder: Gives the place where a candidate that is kept is written; None: nothing can be kept.
            reopen: Reads the folder again after it was written.
            changed_at: When the file was last written [s]; 0 where it is not there.
        """
        self._server, self._open_folder, self._reopen = server, open_folder, reopen
        self._changed_at, self._read_at = changed_at, changed_at()
        self._folder: ModelFolder | None = None
        self._lock = threading.RLock()  # sliders, buttons and the sweep come from threads of their own
        self._random = np.random.default_rng(0)
        server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="medium")
        self._open(shown, sights, said_of(shown))
        server.on_client_connect(self._connected)

    def _open(self, shown: Shown, sights: Sequence[Sight], said: str) -> None:
        """Show a model from the beginning."""
        with self._lock:
            scene = shown.scene
            self._scene, self._shown = scene, shown
            self._q = {joint.name: scene.rest[joint.name] for joint in scene.leaders}
            self._marked: frozenset[str] = frozenset()
            self._sweeping: str | None = None
            self._chosen: str | None = None
            self._apart = 0.0
            self._stale = True
            self._colliding: frozenset[str] = frozenset()
            self._gizmo: Any = None
            self._line = (np.array([1.0, 0.0, 0.0]), np.zeros(3))
            self._drawn = DrawnModel(self._server, scene, shown.chains, self._clicked)
            self._panel = Panel(
                self._server.gui,
                scene,
                self,
                parts=self._drawn.parts,
                sights=sights,
                said=said,
                can_keep=self._open_folder is not None,
                can_undo=self._folder is not None and self._folder.can_undo,
            )
            self._groups: GroupPanel | None = None
            if self._open_folder is not None:
                self._groups = GroupPanel(
                    self._server.gui,
                    merge=lambda one, other: self.regroup(lambda folder: folder.merge(one, other)),
                    split=lambda part: self.regroup(lambda folder: folder.split(part)),
                    free=lambda pieces: self.regroup(lambda folder: folder.free(pieces)),
                    rejected=shown.rejected,
                )
            self._place()

    def _connected(self, client: viser.ClientHandle) -> None:
        self._drawn.step_back(client)

    def set(self, values: Mapping[str, float]) -> None:
        """Move joints [rad or m], sliders included; names that are no leaders are passed over."""
        with self._lock:
            for name, value in values.items():
                if self._panel.has(name):
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
        return self._panel.status

    def run(self, stop: threading.Event) -> None:
        """Sweep what is to be swept and look for collisions until `stop` is set."""
        start, last = time.monotonic(), ""
        first: float | None = None
        checked = time.monotonic()
        while not stop.wait(_FRAME):
            if time.monotonic() - checked > _LOOK_AGAIN:
                checked = time.monotonic()
                self._follow_file()
            if first is None and self._server.get_clients():
                first = time.monotonic()
            name = self._sweeping
            if name is not None:
                if name != last:
                    start = time.monotonic()
                share = 0.5 - 0.5 * np.cos(2.0 * np.pi * (time.monotonic() - start) / _SWEEP_SECONDS)
                lower, upper = self._scene.range_of(self._scene.robot.joint_by_name[name])
                self.set({name: float(lower + share * (upper - lower))})
            last = name or ""
            if first is not None and time.monotonic() - first > _HEAD_START:
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
            self._tell("The file was changed and cannot be read; the page shows it as it was", str(error))
            return
        self._folder = None
        self._open(shown, (), f"The file was changed; the page shows it as it is now.\n\n{said_of(shown)}")

    def _add_marks(self) -> None:
        with self._lock:
            if not self._drawn.complete:
                self._drawn.add_marks()
                self._drawn.place(self._q, self._apart)

    def choose(self, joint: str) -> None:
        """Make the part of a joint glow, and show what is known of the joint."""
        with self._lock:
            if self._chosen != joint and self._panel.has(joint):
                self._chosen, self._marked = joint, frozenset()
                self._end_by_hand()
                self._show_joint(joint)
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
            self._chosen, self._marked = joint, frozenset()
            candidates = self._candidates(self._scene.robot.joint_by_name[joint])
            self._try(joint, candidates[number - 1] if number else None)
            self._glow()

    def state(self, key: Literal["parent", "twin"], name: str) -> None:
        """Write the model with another parent of the chosen joint's part, or with the joint of its twin."""
        with self._lock:
            if self._chosen is None:
                return
            joint = self._scene.robot.joint_by_name[self._chosen]
            offered = self._shown.parents if key == "parent" else self._shown.twins
            if (key == "parent" and name == joint.parent) or name not in offered.get(joint.child, ()):
                return
            self._end_by_hand()
        assert self._open_folder is not None
        self._folder = self._folder or self._open_folder()
        hint = Hint(part=joint.child, parent=name) if key == "parent" else Hint(part=joint.child, twin=name)
        self._written(partial(self._folder.state, hint))

    def _try(self, joint: str, alternative: JointAlternative | None) -> None:
        item = self._scene.robot.joint_by_name[joint]
        self._scene.try_joint(joint, alternative)
        if alternative is not None and alternative.limits is None and alternative.kind is not JointType.FIXED:
            self._scene.try_joint(joint, replace(alternative, limits=self._scene.free_range(item)))
        self._sweeping = None
        self._drawn.draw_axis(item)
        self._q[joint] = float(np.clip(0.0, *self._scene.range_of(item)))
        self._panel.refit(item)
        self._panel.describe(item, self._probability(item))
        self._panel.offer_keeping(alternative is not None)
        self._place()

    def set_by_hand(self) -> None:
        """Begin to set the chosen joint by hand: all joints at zero, where its axis stands as it is given."""
        with self._lock:
            if self._chosen is None:
                return
            joint = self._scene.robot.joint_by_name[self._chosen]
            self.set(dict.fromkeys(self._q, 0.0))
            axis, pivot = self._scene.line_of(joint)
            kind = self._scene.kind_of(joint)
            self._end_by_hand()
            self._panel.begin_by_hand(kind, self._scene.range_of(joint))
            self._line = axis, pivot
            self._gizmo = self._drawn.add_gizmo(axis, pivot)
            self._gizmo.on_update(lambda _: self.move_line())
            self.change_line()

    def set_limits(self, lower: float, upper: float) -> None:
        """Put the two handles of the limits somewhere [deg or mm]; only while a joint is set by hand."""
        self._panel.move_hand_limits(lower, upper)
        self.change_line()

    def _end_by_hand(self) -> None:
        if self._gizmo is not None:
            self._gizmo.remove()
        self._gizmo = None
        self._panel.end_by_hand()

    def change_kind(self) -> None:
        """Begin the range of another type again: a quarter turn, or half of the model's size."""
        with self._lock:
            if self._gizmo is not None:
                kind = self._panel.hand_kind
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
            kind = self._panel.hand_kind
            lower, upper = self._panel.hand_limits
            limited = kind in (JointType.REVOLUTE, JointType.PRISMATIC)
            alternative = JointAlternative(
                kind=kind,
                axis=self._line[0],
                pivot=self._line[1],
                by_hand=True,
                limits=(min(lower, 0.0), max(upper, 0.0)) if limited else None,
            )
            self._try(self._chosen, alternative)

    def keep(self) -> Kept | None:
        """Write the model with the joint as it is tried, and show it again; None if it could not be written."""
        assert self._open_folder is not None
        self._folder = self._folder or self._open_folder()
        with self._lock:
            joint = None if self._chosen is None else self._scene.robot.joint_by_name[self._chosen]
            tried = None if joint is None else self._scene.tried(joint.name)
        if joint is None or tried is None:
            return None
        return self._written(partial(self._folder.keep, joint.child, tried))

    def regroup(self, change: Callable[[ModelFolder], Kept]) -> Kept | None:
        """Merge or split parts, infer again, and show the model again; None if it could not be written."""
        assert self._open_folder is not None
        folder = self._folder = self._folder or self._open_folder()
        return self._written(lambda: change(folder))

    def undo(self) -> None:
        """Write the model as it was before the last choice, and show it."""
        assert self._folder is not None
        self._written(self._folder.undo)

    def _written(self, write: Callable[[], Kept | None]) -> Kept | None:
        """Change the folder, tell what came of it, and show what it holds."""
        assert self._reopen is not None
        self._panel.forbid_keeping(True)
        waiting = [
            client.add_notification("Inferring again ...", "The model is written when it is done.", loading=True)
            for client in self._server.get_clients().values()
        ]
        try:
            kept = write()
            shown = self._reopen()
        except KinematifyError as error:
            self._panel.forbid_keeping(False)
            self._tell("Nothing was changed", str(error))
            return None
        finally:
            self._read_at = self._changed_at()
            for item in waiting:
                item.remove()
        self._open(shown, (), said_of(shown) if kept is None else said_of_kept(kept))
        return kept

    def _tell(self, title: str, body: str) -> None:
        for client in self._server.get_clients().values():
            client.add_notification(title, body, color="red")

    def _candidates(self, joint: Joint) -> tuple[JointAlternative, ...]:
        bounds = self._scene.bounds.get(self._scene.group_of(joint.child))
        size = self._scene.size if bounds is None else float(np.linalg.norm(bounds[1] - bounds[0]))
        axis, pivot = self._scene.line_in_file(joint)
        written = JointAlternative(kind=joint.kind, axis=axis, pivot=pivot)
        known = distinct(self._shown.alternatives.get((joint.parent, joint.child), ()), size)
        return agreeing(known, written, self._shown.confidences.get(joint.child), size)

    def _show_joint(self, name: str) -> None:
        joint = self._scene.robot.joint_by_name[name]
        bounds = self._scene.bounds.get(self._scene.group_of(joint.child), np.zeros((2, 3)))
        said = [described(item, bounds) for item in self._candidates(joint)]
        self._panel.show_joint(
            joint, said, *(of.get(joint.child, ()) for of in (self._shown.parents, self._shown.twins))
        )
        self._panel.describe(joint, self._probability(joint))

    def _probability(self, joint: Joint) -> float | None:
        """Return how likely the joint is as it is shown: as it is tried, or as in the file."""
        tried = self._scene.tried(joint.name)
        return self._shown.confidences.get(joint.child) if tried is None else tried.probability

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

    def _clicked(self, top: str) -> None:
        """Choose the joint that carries a part, or the one that leads it."""
        robot = self._scene.robot
        if self._groups is not None:
            self._groups.click(top)
        joint = robot.joint_above.get(top)
        while joint is not None and joint.mimic is not None:
            joint = robot.joint_by_name[joint.mimic.joint]
        if joint is not None and self._panel.has(joint.name):
            self.choose(joint.name)

    def slide(self, joint: str, value: float) -> None:
        """Move a joint [rad or m] that a hand has at its slider, and choose it."""
        with self._lock:
            self._q[joint] = value
            self._place()
            self.choose(joint)

    def play(self) -> None:
        """Make the chosen joint go to and fro, or stop."""
        with self._lock:
            self._sweeping = None if self._sweeping == self._chosen else self._chosen

    def show_axes(self, visible: bool) -> None:  # the value of a box
        """Show or hide the axes of all joints."""
        self._drawn.show_axes(visible)

    def show_part(self, top: str, visible: bool) -> None:  # the value of a box
        """Show or hide a part."""
        self._drawn.show_part(top, visible)

    def take_apart(self, share: float) -> None:
        """Take the model apart, 0 for not at all."""
        with self._lock:
            self._apart = share
            self._place()

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
            camera = client.camera
            from kinematify.view.model_film import film_of  # noqa: PLC0415  # loads the ray caster

            film = film_of(
                self._scene, ends, eye=camera.position, target=camera.look_at, field_of_view=float(camera.fov)
            )
        finally:
            waiting.remove()
        client.send_file_download(f"{self._scene.robot.name}.gif", film)

    def _place(self) -> None:
        """Put everything where the joints stand; collisions are looked for later, since that takes longer."""
        self._drawn.place(self._q, self._apart)
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
            self._panel.show_status(said_of_failure(error))
            return
        with self._lock:
            self._stale = False
            touches = self._scene.touches(self._q)
            self._colliding = frozenset(top for touch in touches if not touch.tolerated for top in touch.pair)
            self._panel.show_status(said_of_touches(touches))
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
