"""The page of a mesh of pieces: they are clicked, named as moving parts, and the answer is written on a button."""

from __future__ import annotations

import json
import threading
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.grouping.numbered_pieces import BODY
from kinematify.render.piece_sheet import piece_colors
from kinematify.robot.vectors import box_around
from kinematify.view.panel import PAGE, plain

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence
    from pathlib import Path

    import viser

    from kinematify.vision.piece_question import PieceQuestion

_PICKED, _NAMED, _LINE, _CHOSEN = (66, 133, 244), (214, 214, 220), (90, 90, 96), (214, 26, 41)
"""Of pieces that are picked and that belong to a part, and of the lines of their box."""
_THICK = 0.012
"""Of a line, as a share of the object's size."""
_HOW = (
    "Click the pieces of one moving part, then the line of their box that it turns about or slides along, and press "
    "**One part**. Click a part to change it; **Hide** shows what is behind."
)


class PiecePage:
    """The page that answers the question about a mesh; only its button writes."""

    def __init__(self, server: viser.ViserServer, question: PieceQuestion, out: Path, command: str) -> None:
        """Build the page.

        Args:
            server: Running.
            question: About the mesh.
            out: The answer, JSON.
            command: Makes a model of it.
        """
        self._question, self._out, self._command, self._server = question, out, command, server
        self.parts: list[dict[str, Any]] = []
        """As in the answer."""
        self.picked: set[int] = set()
        """Numbers of pieces that no part has."""
        self.line: tuple[str, list[str]] | None = None
        """Axis and sides of the box of the picked ones."""
        self._hidden: set[int] = set()
        self._lock = threading.RLock()  # every click comes from a thread of its own
        box = box_around([part.bounds for part in question.shown])
        self._size = float(np.linalg.norm(np.ptp(box, axis=0)))
        self._add_widgets(server.gui)
        self._colors = (255.0 * piece_colors(len(question.shown))).astype(int).tolist()
        self._pieces = {}
        for number, (part, color) in enumerate(zip(question.shown, self._colors, strict=True), 1):
            faces, vertices = part.faces.astype(np.uint32), part.vertices.astype(np.float32)
            handle: Any = server.scene.add_mesh_simple(
                f"/pieces/{number}/shape", vertices, faces, color=tuple(color), flat_shading=True, side="double"
            )
            self._pieces[number] = handle
            self._connect(handle, partial(self.click, number))
        middle, camera = box.mean(axis=0), server.initial_camera
        camera.position, camera.look_at = tuple(middle + self._size * np.array([0.5, -1.0, 0.6])), tuple(middle)
        camera.up, camera.near = (0.0, 0.0, 1.0), 1e-3 * self._size
        self._show()

    def _add_widgets(self, gui: viser.GuiApi) -> None:
        gui.add_html(PAGE)
        gui.add_markdown(_HOW)
        self._said = gui.add_markdown("")
        self._name: Any = gui.add_text("Name", "")
        self._moves: Any = gui.add_dropdown("Moves", ("turns", "slides"))
        self._on = gui.add_dropdown("On", (BODY,))
        one, hide, show = (gui.add_button(words) for words in ("One part", "Hide", "Show all"))
        self._write = gui.add_button(f"Write {self._out.name}", color="green")
        self._written = gui.add_markdown("")
        for button, action in ((one, self.one_part), (hide, self.hide), (show, self._hidden.clear),
                               (self._write, self.write)):  # fmt: skip
            self._connect(button, action)

    def _connect(self, widget: Any, action: Callable[[], object]) -> None:
        """Call an action on each click, and show what came of it."""

        def act(_: Any) -> None:
            with self._lock:
                action()
                self._show()

        widget.on_click(act)

    def run(self, stop: threading.Event) -> None:
        """Serve until `stop` is set."""
        stop.wait()

    def click(self, number: int) -> None:
        """Pick a piece, or no more; a part of which one is clicked is no part any more, but all of it is picked."""
        part = next((part for part in self.parts if number in part["pieces"]), None)
        if part is None:
            self.picked ^= {number}
            self.line = None
            return
        self.parts.remove(part)
        self.picked, self._name.value, self._moves.value = set(part["pieces"]), part["name"], part["moves"]
        self.line = part["axis"] and (part["axis"], part["edge"])

    def one_part(self) -> None:
        """Make the picked pieces one moving part, which is hidden, so that what is behind it can be seen."""
        if self.picked:
            axis, sides = self.line or (None, None)
            self.parts.append({
                "name": self._name.value.strip() or f"part_{len(self.parts) + 1}", "pieces": sorted(self.picked),
                "moves": self._moves.value, "axis": axis, "edge": sides, "on": self._on.value, "sure": 1.0,
            })  # fmt: skip
            self.hide()
            self._name.value = ""

    def hide(self) -> None:
        """Hide the picked pieces; none is picked then."""
        self._hidden |= self.picked
        self.picked, self.line = set(), None

    def write(self) -> None:
        """Write the answer, and say what its reader takes of it."""
        text = json.dumps({"object": "", "reason": "", "parts": self.parts, "cut": []}, indent=1)
        try:
            self._out.write_text(text + "\n", encoding="utf-8")
            said = (*self._question.read(text).described(), f"Next:\n\n```\n{self._command}\n```")
        except OSError as error:
            said = (f"{self._out} cannot be written: {error.strerror}.",)
        self._written.content = "\n\n".join(said)

    def _show(self) -> None:
        """Show pieces, lines and words as they are now."""
        named = {number for part in self.parts for number in part["pieces"]}
        with self._server.atomic():
            for number, handle in self._pieces.items():
                own = _NAMED if number in named else self._colors[number - 1]
                handle.color = _PICKED if number in self.picked else tuple(own)
                handle.visible = number not in self._hidden
            self._draw_lines()
        self._on.options = (BODY, *(part["name"] for part in self.parts))
        self._write.disabled = not self.parts
        said = [f"Picked: {_listed(self.picked)}" + (f", {_words(*self.line)}" if self.line else "")]
        said += [
            f"- **{plain(part['name'])}**: {_listed(part['pieces'])}; {part['moves']}, "
            f"{_words(part['axis'], part['edge'] or []) if part['axis'] else 'no line'}, on {plain(part['on'])}"
            for part in self.parts
        ]
        self._said.content = "\n\n".join(said)

    def _draw_lines(self) -> None:
        """Draw the edges of the box around the picked pieces, and the lines through its middle."""
        scene = self._server.scene
        scene.remove_by_name("/lines")
        if not self.picked:
            return
        scene.add_frame("/lines", show_axes=False)
        low, high = box_around([self._question.shown[number - 1].bounds for number in self.picked])
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        for along, signs in product(range(3), ((0, 0), (-1, -1), (-1, 1), (1, -1), (1, 1))):
            across = [k for k in range(3) if k != along]
            at, extent = middle.copy(), np.full(3, _THICK * self._size)
            at[across] += half[across] * signs
            extent[along] += 2.0 * half[along]
            line = "xyz"[along], [f"{'-+'[sign > 0]}{'xyz'[k]}" for k, sign in zip(across, signs, strict=True) if sign]
            color = _CHOSEN if line == self.line else _LINE
            handle = scene.add_box(f"/lines/{_words(*line)}/bar", color, extent, position=at)
            self._connect(handle, partial(setattr, self, "line", line))


def _words(axis: str, sides: Sequence[str]) -> str:
    return f"{axis} at {' '.join(sides) or 'the middle'}"


def _listed(numbers: Collection[int]) -> str:
    return ", ".join(map(str, sorted(numbers))) or "none"
