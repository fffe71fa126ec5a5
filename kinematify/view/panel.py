"""The panel at the side of the page (viser's gui): its widgets and what they show; the viewer connects them."""

from __future__ import annotations

import html
import json
import math
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Sequence

    import viser

    from kinematify.robot.robot import Joint
    from kinematify.view.inference_view import FindingMarker, ViewModel
    from kinematify.view.keep import SavedEdit

_AS_WRITTEN, _OWN = "as in the file", "-"
_TYPES = {
    "turns": JointType.REVOLUTE,
    "turns without end": JointType.CONTINUOUS,
    "slides": JointType.PRISMATIC,
    "fixed": JointType.FIXED,
}
"""Types that a joint can be set to by hand."""
_MARKUP = re.compile(r"[\\`*_{}\[\]<>]")
_SLIDER_STEPS = 100
"""An arrow key moves a slider by one."""
_LISTED_PAIRS, _LISTED_FINDINGS = 12, 40
"""Touching pairs and findings that are listed; the report has all."""
_NAME_UNDER_POINTER = """
if (!window.partName) {
  const label = window.partName = document.body.appendChild(document.createElement('div'));
  label.id = 'part-name';
  label.style.cssText = 'position:fixed;z-index:99;pointer-events:none;display:none;padding:2px 8px;' +
    'border-radius:4px;background:#222c;color:#fff;font:13px sans-serif';
  window.addEventListener('pointermove', event => setTimeout(() => {
    const page = window.__viserMutable, state = page?.scene?.__r3f?.root.getState();
    const names = new Map(Object.entries(page?.nodeRefFromName ?? {}).map(([name, node]) => [node, name]));
    let found;
    for (const { eventObject } of state?.internal.hovered.values() ?? [])
      for (let node = eventObject; node; node = node.parent) found ??= names.get(node)?.split('/')[2];
    label.style.display = found ? 'block' : 'none';
    label.textContent = found ?? '';
    label.style.left = event.clientX + 14 + 'px';
    label.style.top = event.clientY + 14 + 'px';
  }), true);
}"""
"""Shows the name of the part under the pointer, which viser marks but does not report."""
PAGE = (
    '<style>.mantine-Paper-root[style*="max-height: 60%"]{max-height:50% !important}</style>'
    f'<img src="data:," style="display:none" onerror="{html.escape(_NAME_UNDER_POINTER)}">'
)
"""Leaves the upper half of a narrow window to the model. A page runs no <script> that arrives later, but what an image
does that cannot be loaded."""
_COPY = """
const said = {}, done = () => this.textContent = 'Copied';
const older = () => {
  const box = document.body.appendChild(document.createElement('textarea'));
  box.value = said;
  box.select();
  document.execCommand('copy');
  box.remove();
  done();
};
navigator.clipboard ? navigator.clipboard.writeText(said).then(done, older) : older();"""
"""Copies a text; pages that are not served to the own machine or by https have no `navigator.clipboard`."""
_COPY_BUTTON = (
    '<button style="margin:0 0.75em 0.5em;padding:0.3em 1em;border:1px solid #228be6;border-radius:4px;'
    'background:none;color:#228be6;cursor:pointer" onclick="{}">Copy command</button>'
)


class Panel:
    """The widgets of one model; they go when the gui is reset."""

    def __init__(
        self,
        gui: viser.GuiApi,
        shown: ViewModel,
        sights: Sequence[FindingMarker],
        parts: Sequence[str],
        *,
        can_keep: bool,
    ) -> None:
        """Build them in place of those that were there.

        Args:
            gui: Of the server.
            shown: The model.
            sights: Findings.
            parts: Top links of what can be seen.
            can_keep: Whether a change can be written.
        """
        self._gui, self._scene, self._can_keep = gui, shown.scene, can_keep
        self.sliders: dict[str, Any] = {}
        """By joint."""
        gui.reset()
        gui.set_panel_label(self._scene.robot.name)
        gui.add_html(PAGE)
        self.poses = gui.add_button_group("Pose", ("At rest", "Opened", "Random"))
        self.status = gui.add_markdown("Looking for collisions ...")
        self.news = gui.add_markdown("", visible=False)
        self._copy = gui.add_html("", visible=False)
        self.keep = gui.add_button("Keep this", visible=False, color="green", hint="Writes the model with this change.")
        self.undo = gui.add_button("Undo", visible=False, hint="Writes the model as it was before the last change.")
        tabs = gui.add_tab_group()
        with tabs.add_tab("Joints"):
            self._add_joints(shown)
        self.places: list[tuple[Any, FindingMarker]] = []
        """Buttons that show the place of a finding."""
        if sights:
            with tabs.add_tab(f"Findings ({len(sights)})"):
                self._add_findings(sights)
        with tabs.add_tab("View"):
            self.axes = gui.add_checkbox("Axes", initial_value=True)
            self.picture, self.film = gui.add_button("Picture (PNG)"), gui.add_button("Film (GIF)")
            with gui.add_folder("Parts", expand_by_default=False):
                self.boxes = {top: gui.add_checkbox(top, initial_value=True) for top in parts}

    def _add_joints(self, shown: ViewModel) -> None:
        gui = self._gui
        for joint in self._scene.leaders:
            lower, upper, step = self._ends(joint)
            start = float(np.clip(self._scene.rest[joint.name] * self.factor(joint.name), lower, upper))
            self.sliders[joint.name] = gui.add_slider(self._label(joint), lower, upper, step, start)
        if not self.sliders:
            gui.add_markdown("No joint of this model moves.")
        self._text = gui.add_markdown(_introduction(shown))
        self.play = gui.add_button("Play", visible=False)
        self.parent: Any = gui.add_dropdown("Parent", ("",), visible=False)
        self.twin: Any = gui.add_dropdown("Same joint as", (_OWN,), visible=False)
        self.choice: Any = gui.add_dropdown("Candidates", (_AS_WRITTEN,), visible=False)
        self.edit = gui.add_button(
            "Edit", visible=False, hint="Type, axis and limits; the red arrow of the gizmo is the axis."
        )
        self.hand_type: Any = gui.add_dropdown("Type", tuple(_TYPES), visible=False)
        self.hand_limits: Any = gui.add_multi_slider("Limits", -360.0, 360.0, 0.1, (0.0, 90.0), visible=False)

    def _add_findings(self, sights: Sequence[FindingMarker]) -> None:
        for sight in sights[:_LISTED_FINDINGS]:
            with self._gui.add_folder(sight.title, expand_by_default=len(sights) <= 3):
                self._gui.add_markdown(plain(sight.message))
                self.places.append((self._gui.add_button("Show the place"), sight))
        if len(sights) > _LISTED_FINDINGS:
            self._gui.add_markdown(f"{len(sights) - _LISTED_FINDINGS} more are in the report.")

    def move(self, joint: str, value: float) -> float:
        """Move the slider of a joint; return the value [rad or m] within its ends."""
        slider, factor = self.sliders[joint], self.factor(joint)
        inside = float(np.clip(value, slider.min / factor, slider.max / factor))
        slider.value = float(np.clip(inside * factor, slider.min, slider.max))
        return inside

    def refit(self, joint: Joint) -> None:
        """Give a slider the range and the unit of what is tried."""
        slider = self.sliders[joint.name]
        slider.label = self._label(joint)
        slider.min, slider.max, slider.step = self._ends(joint)
        slider.value = float(np.clip(0.0, slider.min, slider.max))

    def show_joint(self, joint: Joint, candidates: Sequence[str], parents: Sequence[str], twins: Sequence[str]) -> None:
        """Show a joint, its candidates in words, what its part could hang on and whose joint it could have."""
        self.play.visible, self.play.label = True, f"Play {joint.name}"
        for handle, offered, visible in (
            (self.choice, (_AS_WRITTEN, *(f"{k}: {words}" for k, words in enumerate(candidates, start=1))), candidates),
            (self.parent, tuple(dict.fromkeys((joint.parent, *parents))), self._can_keep and len(parents) > 1),
            (self.twin, (_OWN, *twins), self._can_keep and twins),
        ):
            handle.options, handle.visible = offered, bool(visible)
        self.edit.visible = self._can_keep
        self.show_as_written()

    def show_as_written(self) -> None:
        """Show of the chosen joint what the file says, with nothing that waits to be kept."""
        for handle in (self.choice, self.parent, self.twin):
            handle.value = handle.options[0]
        self.hand_type.visible = self.hand_limits.visible = False
        self.offer("")

    def describe(self, joint: Joint, probability: float | None) -> None:
        """Say type, range and probability of a joint as it is shown: as it is tried, or as in the file."""
        kind, (lower, upper), factor = self._scene.kind_of(joint), self._scene.range_of(joint), self.factor(joint.name)
        words = [kind.value]
        if kind in (JointType.REVOLUTE, JointType.PRISMATIC):
            words.append(f"{factor * lower:z.4g} to {factor * upper:z.4g} {'deg' if kind.turns else 'mm'}")
        words += [] if probability is None else [f"{probability:.0%} sure"]
        moves = plain(f"{joint.child} on {joint.parent}: {', '.join(words)}.")
        self._text.content = f"**{plain(joint.name)}** moves {moves}"

    def offer(self, words: str) -> None:
        """Say what waits to be kept, with the button that writes it; nothing does where there are no words."""
        if words or self.keep.visible:
            self.keep.visible = bool(words) and self._can_keep
            self.news.content, self.news.visible = f"Not written yet: **{plain(words)}**", self.keep.visible
            self._copy.visible = False

    def tell(self, text: str, kept: SavedEdit | None = None) -> None:
        """Say what happened to the file: Markdown, or what was kept, with the command that does the same."""
        if kept is not None:
            text = "\n\n".join(
                [f"Kept. The same from the command line:\n\n```\n{kept.command}\n```", *map(plain, kept.warnings)]
            )
            self._copy.content = _COPY_BUTTON.format(html.escape(_COPY.replace("{}", json.dumps(kept.command), 1)))
            self._copy.visible = True
        self.news.content, self.news.visible = text, bool(text)

    def begin_by_hand(self, kind: JointType, limits: tuple[float, float]) -> None:
        """Show what a joint is set with by hand, at its type and limits [rad or m]."""
        self.hand_type.value = next(words for words, item in _TYPES.items() if item is kind)
        self.fit_limits(kind, limits)
        self.hand_type.visible = self.hand_limits.visible = True

    def by_hand(self) -> tuple[JointType, tuple[float, float]]:
        """Type and limits [rad or m] that were set by hand."""
        kind = _TYPES[self.hand_type.value]
        lower, upper = (float(end) / _factor_of(kind) for end in self.hand_limits.value)
        return kind, (lower, upper)

    def fit_limits(self, kind: JointType, limits: tuple[float, float]) -> None:
        """Give the two handles of the limits the range and unit of a type, and their places [rad or m]."""
        reach = 360.0 if kind.turns else 1000.0 * self._scene.size
        factor, handle = _factor_of(kind), self.hand_limits
        handle.label = f"Limits [{'deg' if kind.turns else 'mm'}]"
        handle.min, handle.max, handle.step = -reach, reach, 0.1
        handle.value = tuple(round(float(np.clip(factor * end, -reach, reach)), 1) for end in limits)

    def _ends(self, joint: Joint) -> tuple[float, float, float]:
        """Lower end, upper end and step of a slider, in its unit."""
        lower, upper = (self.factor(joint.name) * end for end in self._scene.range_of(joint))
        step = float(f"{max((upper - lower) / _SLIDER_STEPS, 1e-6):.3g}")
        digits = 2 - math.floor(math.log10(max(upper - lower, 1e-3)))
        lower = round(lower, digits)
        return lower, max(round(upper, digits), lower + step), step

    def _label(self, joint: Joint) -> str:
        return f"{joint.name} [{'deg' if self._scene.kind_of(joint).turns else 'mm'}]"

    def factor(self, joint: str) -> float:
        """Units of a slider per rad or m."""
        return _factor_of(self._scene.kind_of(self._scene.robot.joint_by_name[joint]))


def _introduction(shown: ViewModel) -> str:
    """Return how to begin, the joints to look at first, and where chains of joints close."""
    said = ["Move a slider (arrow keys move it by 1 % of the range) or click a part."]
    if shown.doubtful:
        names = plain(", ".join(shown.doubtful))
        said.append(f"Check these joints first, their confidence is below {shown.doubtful_below:.0%}: **{names}**.")
    said += [f"Dashed line: {plain(chain.description)}" for chain in shown.chains]
    return "\n\n".join(said)


def collision_text(touches: Sequence[tuple[tuple[str, str], float, bool]] | Exception) -> str:
    """Collisions in Markdown, or why they cannot be looked for."""
    if isinstance(touches, Exception):
        return f"Collisions cannot be looked for. {plain(str(touches))}"
    bad = [(pair, depth) for pair, depth, tolerated in touches if not tolerated]
    lines = [
        f"- **{plain(' and '.join(pair))}** interpenetrate by {1e3 * depth:.3g} mm"
        for pair, depth in bad[:_LISTED_PAIRS]
    ]
    more = [f"- and {len(bad) - _LISTED_PAIRS} more pairs"] if len(bad) > _LISTED_PAIRS else []
    return "\n".join([*lines, *more]) or "Nothing collides."


def plain(text: str) -> str:
    """Text as Markdown that shows it as it is: `<mimic>` would be a tag, and is not seen."""
    return _MARKUP.sub(r"\\\g<0>", text)


def _factor_of(kind: JointType) -> float:
    """Degrees per rad, or millimetres per m."""
    return 180.0 / math.pi if kind.turns else 1000.0
