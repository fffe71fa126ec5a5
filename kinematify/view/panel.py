"""The panel at the side of the page (viser's gui): what it shows, and what is done when a person touches it."""

from __future__ import annotations

import math
import re
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import viser

    from kinematify.robot.robot import Joint
    from kinematify.view.inference_view import Shown, Sight
    from kinematify.view.keep import Kept
    from kinematify.view.viewer_scene import Touch, ViewScene

_AS_WRITTEN, _OWN = "as in the file", "-"
_TYPES = {
    "turns": JointType.REVOLUTE,
    "turns without end": JointType.CONTINUOUS,
    "slides": JointType.PRISMATIC,
    "fixed": JointType.FIXED,
}
"""What a joint can be set to by hand."""
_MARKUP = re.compile(r"[\\`*_{}\[\]<>]")
_POSES = ("At rest", "Opened", "Random")
_SLIDER_STEPS = 100
"""An arrow key moves a slider by one."""
_TOLD = 12
"""Touching pairs that are listed."""
_SIGHTS = 40
"""Findings that are listed; the report has all."""


class Actions(Protocol):
    """Actions of a person on the panel."""

    def take_pose(self, name: str) -> None:
        """Bring all joints into a pose."""

    def slide(self, joint: str, value: float) -> None:
        """Move a joint [rad or m] by its slider."""

    def play(self) -> None:
        """Make the chosen joint go to and fro, or stop."""

    def try_candidate(self, joint: str, number: int) -> None:
        """Move a joint as one of its candidates says, 0 for as in the file."""

    def state(self, key: Literal["parent", "twin"], name: str) -> None:
        """Write the model with another parent of the chosen joint's part, or with the joint of its twin."""

    def set_by_hand(self) -> None:
        """Begin to set the chosen joint by hand."""

    def change_kind(self) -> None:
        """Another type was chosen by hand."""

    def change_line(self) -> None:
        """The axis or the limits were moved by hand."""

    def keep(self) -> Kept | None:
        """Write the model with what is tried."""

    def undo(self) -> None:
        """Write the model as it was before."""

    def show(self, sight: Sight) -> None:
        """Show the place of a finding."""

    def take_apart(self, share: float) -> None:
        """Take the model apart, 0 for not at all."""

    def show_axes(self, visible: bool) -> None:  # the value of a box
        """Show or hide the axes of all joints."""

    def show_part(self, top: str, visible: bool) -> None:  # the value of a box
        """Show or hide a part."""

    def send_picture(self, client: Any) -> None:
        """Make the page of a client make a picture."""

    def send_film(self, client: Any) -> None:
        """Film the joints for a client."""


class Panel:
    """The panel of one model; it goes when the gui is reset."""

    def __init__(
        self,
        gui: viser.GuiApi,
        scene: ViewScene,
        actions: Actions,
        *,
        parts: Sequence[str],
        sights: Sequence[Sight],
        said: str,
        can_keep: bool,
        can_undo: bool,
    ) -> None:
        """Build it in place of what was there.

        Args:
            gui: Of the server.
            scene: The model.
            actions: What is done when something is touched.
            parts: Top links of what can be seen.
            sights: Findings.
            said: What stands below the sliders until a joint is chosen.
            can_keep: Whether a candidate can be written.
            can_undo: Whether a choice can be taken back.
        """
        self._gui, self._scene, self._actions, self._can_keep = gui, scene, actions, can_keep
        self._sliders: dict[str, Any] = {}
        self._joint: str | None = None
        gui.reset()
        gui.set_panel_label(scene.robot.name)
        poses = gui.add_button_group("Pose", _POSES)
        poses.on_click(lambda event: actions.take_pose(event.target.value))
        self._status = gui.add_markdown("Looking for collisions ...")
        tabs = gui.add_tab_group()
        with tabs.add_tab("Joints"):
            self._add_joints(said, can_undo=can_undo)
        if sights:
            with tabs.add_tab(f"Findings ({len(sights)})"):
                self._add_findings(sights)
        with tabs.add_tab("View"):
            self._add_view(parts)

    def has(self, joint: str) -> bool:
        """True if a joint has a slider."""
        return joint in self._sliders

    def move(self, joint: str, value: float) -> float:
        """Move the slider of a joint; return the value [rad or m] within its ends."""
        slider, factor = self._sliders[joint], self._factor(joint)
        inside = float(np.clip(value, slider.min / factor, slider.max / factor))
        slider.value = float(np.clip(inside * factor, slider.min, slider.max))
        return inside

    def refit(self, joint: Joint) -> None:
        """Give a slider the range and the unit of what is tried."""
        slider = self._sliders[joint.name]
        lower, upper, step = self._ends(joint)
        slider.label = self._label(joint)
        slider.min, slider.max, slider.step = lower, upper, step
        slider.value = float(np.clip(0.0, lower, upper))

    def show_joint(self, joint: Joint, candidates: Sequence[str], parents: Sequence[str], twins: Sequence[str]) -> None:
        """Show a joint, its candidates in words, what its part could hang on and whose joint it could have."""
        self._joint = joint.name
        self._play.visible = True
        self._play.label = f"Play {joint.name}"
        self._options = [_AS_WRITTEN, *(f"{number}: {words}" for number, words in enumerate(candidates, start=1))]
        self._choice.options = tuple(self._options)
        self._choice.value = _AS_WRITTEN
        self._choice.visible = bool(candidates)
        self._parent.options = tuple(parents) or (joint.parent,)
        self._parent.value = joint.parent if joint.parent in self._parent.options else self._parent.options[0]
        self._parent.visible = self._can_keep and len(parents) > 1
        self._twin.options = (_OWN, *twins)
        self._twin.value = _OWN
        self._twin.visible = self._can_keep and bool(twins)
        self._by_hand.visible = self._can_keep
        self._keep.visible = False

    def describe(self, joint: Joint, probability: float | None) -> None:
        """Say type, range and probability of a joint as it is shown: as it is tried, or as in the file."""
        kind, (lower, upper), factor = self._scene.kind_of(joint), self._scene.range_of(joint), self._factor(joint.name)
        unit = "deg" if kind.turns else "mm"
        limited = kind in (JointType.REVOLUTE, JointType.PRISMATIC)
        words = [kind.value]
        words += [f"{factor * lower:z.4g} to {factor * upper:z.4g} {unit}"] if limited else []
        words += [] if probability is None else [f"{probability:.0%} sure"]
        moves = _plain(f"{joint.child} on {joint.parent}: {', '.join(words)}.")
        self._text.content = f"**{_plain(joint.name)}** moves {moves}"

    def offer_keeping(self, offered: bool) -> None:  # whether something is tried
        """Show or hide the button that writes what is tried."""
        self._keep.visible = offered and self._can_keep

    def forbid_keeping(self, forbidden: bool) -> None:  # while it is written
        """Make the button that writes what is tried be pressed, or not."""
        self._keep.disabled = forbidden

    @property
    def status(self) -> str:
        """Return what is said of collisions."""
        return str(self._status.content)

    def show_status(self, said: str) -> None:
        """Say what collides, in Markdown, below the poses."""
        self._status.content = said

    def begin_by_hand(self, kind: JointType, limits: tuple[float, float]) -> None:
        """Show what a joint is set with by hand, at its type and limits [rad or m]."""
        self._hand_type.value = next(words for words, item in _TYPES.items() if item is kind)
        self.fit_limits(kind, limits)
        for handle in (self._hand_type, self._hand_limits):
            handle.visible = True

    def end_by_hand(self) -> None:
        """Hide what a joint is set with by hand."""
        self._hand_type.visible = self._hand_limits.visible = False

    @property
    def hand_kind(self) -> JointType:
        """The type that was set by hand."""
        return _TYPES[self._hand_type.value]

    @property
    def hand_limits(self) -> tuple[float, float]:
        """The limits that were set by hand [rad or m]."""
        lower, upper = (float(end) / _factor_of(self.hand_kind) for end in self._hand_limits.value)
        return lower, upper

    def move_hand_limits(self, lower: float, upper: float) -> None:
        """Put the two handles of the limits somewhere [deg or mm]."""
        self._hand_limits.value = (lower, upper)

    def fit_limits(self, kind: JointType, limits: tuple[float, float]) -> None:
        """Give the two handles of the limits the range and unit of a type, and their places [rad or m]."""
        reach = 360.0 if kind.turns else 1000.0 * self._scene.size
        factor = _factor_of(kind)
        handle = self._hand_limits
        handle.label = f"Limits [{'deg' if kind.turns else 'mm'}]"
        handle.min, handle.max, handle.step = -reach, reach, 0.1
        handle.value = tuple(round(float(np.clip(factor * end, -reach, reach)), 1) for end in limits)

    def _add_joints(self, said: str, *, can_undo: bool) -> None:
        gui, actions = self._gui, self._actions
        for joint in self._scene.leaders:
            self._add_slider(joint)
        if not self._scene.leaders:
            gui.add_markdown("No joint of this model moves.")
        self._text = gui.add_markdown(said)
        self._play = gui.add_button("Play", visible=False)
        self._play.on_click(_ignoring_event(actions.play))
        self._options = [_AS_WRITTEN]
        self._parent: Any = gui.add_dropdown("Parent", ("",), visible=False)
        self._parent.on_update(_ignoring_event(lambda: actions.state("parent", self._parent.value)))
        self._twin: Any = gui.add_dropdown("Joint as of", (_OWN,), visible=False)
        self._twin.on_update(_ignoring_event(lambda: actions.state("twin", self._twin.value)))
        self._choice: Any = gui.add_dropdown("Candidates", (_AS_WRITTEN,), visible=False)
        self._choice.on_update(_ignoring_event(self._tried))
        self._by_hand = gui.add_button(
            "Edit", visible=False, hint="Type, axis and limits; the red arrow of the gizmo is the axis."
        )
        self._by_hand.on_click(_ignoring_event(actions.set_by_hand))
        self._hand_type: Any = gui.add_dropdown("Type", tuple(_TYPES), visible=False)
        self._hand_type.on_update(_ignoring_event(actions.change_kind))
        self._hand_limits: Any = gui.add_multi_slider("Limits", -360.0, 360.0, 0.1, (0.0, 90.0), visible=False)
        self._hand_limits.on_update(_ignoring_event(actions.change_line))
        self._keep = gui.add_button("Keep this", visible=False, color="green", hint="Writes the model with this joint.")
        self._keep.on_click(_ignoring_event(actions.keep))
        back = gui.add_button("Undo", visible=can_undo)
        back.on_click(_ignoring_event(actions.undo))

    def _add_slider(self, joint: Joint) -> None:
        lower, upper, step = self._ends(joint)
        start = float(np.clip(self._scene.rest[joint.name] * self._factor(joint.name), lower, upper))
        slider = self._gui.add_slider(self._label(joint), lower, upper, step, start)
        slider.on_update(partial(self._slid, joint.name))
        self._sliders[joint.name] = slider

    def _add_findings(self, sights: Sequence[Sight]) -> None:
        for sight in sights[:_SIGHTS]:
            with self._gui.add_folder(sight.title, expand_by_default=len(sights) <= 3):
                self._gui.add_markdown(_plain(sight.message))
                self._gui.add_button("Show the place").on_click(_ignoring_event(partial(self._actions.show, sight)))
        if len(sights) > _SIGHTS:
            self._gui.add_markdown(f"{len(sights) - _SIGHTS} more are in the report.")

    def _add_view(self, parts: Sequence[str]) -> None:
        gui, actions = self._gui, self._actions
        apart = gui.add_slider("Explode [%]", 0, 100, 1, 0)
        apart.on_update(lambda event: actions.take_apart(event.target.value / 100.0))
        axes = gui.add_checkbox("Axes", initial_value=True)
        axes.on_update(lambda event: actions.show_axes(event.target.value))
        gui.add_button("Picture (PNG)").on_click(lambda event: actions.send_picture(event.client))
        gui.add_button("Film (GIF)").on_click(lambda event: actions.send_film(event.client))
        with gui.add_folder("Parts", expand_by_default=False):
            for top in parts:
                gui.add_checkbox(top, initial_value=True).on_update(partial(self._toggled, top))

    def _toggled(self, top: str, event: Any) -> None:
        self._actions.show_part(top, event.target.value)

    def _slid(self, joint: str, event: Any) -> None:
        if event.client is not None:  # else moved by the program, not by a hand
            self._actions.slide(joint, float(self._sliders[joint].value) / self._factor(joint))

    def _tried(self) -> None:
        if self._joint is not None and self._choice.value in self._options:
            self._actions.try_candidate(self._joint, self._options.index(self._choice.value))

    def _ends(self, joint: Joint) -> tuple[float, float, float]:
        """Lower end, upper end and step of a slider, in its unit."""
        factor = self._factor(joint.name)
        lower, upper = (factor * end for end in self._scene.range_of(joint))
        step = float(f"{max((upper - lower) / _SLIDER_STEPS, 1e-6):.3g}")
        digits = 2 - math.floor(math.log10(max(upper - lower, 1e-3)))
        lower = round(lower, digits)
        return lower, max(round(upper, digits), lower + step), step

    def _label(self, joint: Joint) -> str:
        return f"{joint.name} [{'deg' if self._scene.kind_of(joint).turns else 'mm'}]"

    def _factor(self, joint: str) -> float:
        """Units of a slider per rad or m."""
        return _factor_of(self._scene.kind_of(self._scene.robot.joint_by_name[joint]))


def said_of(shown: Shown) -> str:
    """Return how to begin, the joints to look at first, and where chains of joints close."""
    said = ["Move a slider (arrow keys move it by 1 % of the range) or click a part."]
    if shown.doubtful:
        names = _plain(", ".join(shown.doubtful))
        said.append(f"Check these joints first, their confidence is below {shown.doubtful_below:.0%}: **{names}**.")
    said += [f"Dashed line: {_plain(chain.description)}" for chain in shown.chains]
    return "\n\n".join(said)


def said_of_kept(kept: Kept) -> str:
    """Return what was written, and the command that does the same."""
    warnings = "".join(f"\n\n{_plain(warning)}" for warning in kept.warnings)
    return f"Kept. The same from the command line:\n\n```\n{kept.command}\n```{warnings}"


def said_of_touches(touches: Sequence[Touch]) -> str:
    """Collisions and contacts in words."""
    bad = [touch for touch in touches if not touch.tolerated]
    if not bad:
        return "Nothing collides."
    lines = [
        f"- **{_plain(' and '.join(touch.pair))}** interpenetrate by {1e3 * touch.depth:.3g} mm"
        for touch in bad[:_TOLD]
    ]
    more = [f"- and {len(bad) - _TOLD} more pairs"] if len(bad) > _TOLD else []
    return "\n".join([*lines, *more])


def said_of_failure(error: Exception) -> str:
    """Why collisions cannot be looked for."""
    return f"Collisions cannot be looked for. {_plain(str(error))}"


def _plain(text: str) -> str:
    """Text as Markdown that shows it as it is: `<mimic>` would be a tag, and is not seen."""
    return _MARKUP.sub(r"\\\g<0>", text)


def _factor_of(kind: JointType) -> float:
    """Degrees per rad, or millimetres per m."""
    return 180.0 / math.pi if kind.turns else 1000.0


def _ignoring_event(action: Callable[[], object]) -> Callable[[Any], None]:
    """A callback of the page that does not care what caused it."""

    def called(_: Any) -> None:
        action()

    return called
