"""Question about a whole mesh: which numbered pieces are one moving part, and how it moves. One reader of answers."""

from __future__ import annotations

import json
import shlex
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.assembly.assemble import part_names
from kinematify.assembly.load import load_assembly
from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.grouping.groups import joined_pieces, numbered_pieces
from kinematify.grouping.numbered_pieces import BODY, MOST_NUMBERS, NamedPart
from kinematify.render.piece_sheet import draw_sheet
from kinematify.robot.vectors import box_around

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from PIL.Image import Image

    from kinematify.assembly.part import Assembly, Part
    from kinematify.config import Config
    from kinematify.robot.arrays import FloatArray, IntArray

_AXES = {"x": np.array([1.0, 0.0, 0.0]), "y": np.array([0.0, 1.0, 0.0]), "z": np.array([0.0, 0.0, 1.0])}
_SIDES = tuple(f"{sign}{axis}" for axis in _AXES for sign in "-+")
_RUN, _TINY, _SAME = 4, 6.0, 0.6  # congruent pieces in a row of the list; their size and difference [% of the object]
_QUESTION = """\
The pictures show one object whose mesh fell into numbered pieces. Every piece has its own colour; colours \
mean nothing. Black numbers lie on their piece; red ones point at it with a line. The arrows +x, +y, +z in the \
corner are the directions of the object; z is up. In some pictures only pieces that others hide are coloured, \
and the rest is pale; "pulled apart" moves pieces away from the middle. The list has the extent of every piece \
in percent of the longest side of the object. Pieces that are too small for a number follow the piece they lie \
on.

What is the object? Which parts of it move in the real object, relative to the part that is still (the \
body), or to another moving part? One part is all pieces that move together: a door with its frame, pane, \
handle and hinge leaf; a drawer with its front, sides, bottom and handle. List everything that a hand can \
open, fold, slide, turn, swing, press or roll, also when it is rarely done: flaps, both of two sliding panes, \
hanging handles, latches, keys, dials, wheels. Everything that you do not list is body: shelves, legs, fixed \
panels, decoration. The picture may show parts open or closed. Where a moving part is not a piece of its own \
but a region of a larger one, name it under "cut" and not under "parts".

Answer with JSON only: {{"object": "...", "reason": "two sentences", "parts": [{{"name": "...", "pieces": \
[numbers], "moves": "turns" | "slides", "axis": "x" | "y" | "z" | [dx, dy, dz], "edge": where a turning part \
has its line: sides of the part's box, e.g. ["-y"] or ["-x", "-z"], [] if through its middle, "on": "body" or \
the name of another part, "sure": 0..1}}], "cut": [{{"piece": number, "what": "..."}}]}}

Pieces:
{list}"""


@dataclass(frozen=True, kw_only=True)
class PieceAnswer:
    """Moving parts of a mesh, as somebody named them."""

    parts: tuple[NamedPart, ...] = ()
    named: int = 0
    """Parts that the answer had."""
    about: str = ""
    """What the object is."""
    notes: tuple[str, ...] = ()
    """What could not be used, one sentence each."""
    fault: str = ""
    """Why there is no answer, where there is none."""
    tokens: int = 0

    def described(self) -> tuple[str, ...]:
        """How many parts were taken from the answer, and what could not be used."""
        if self.fault:
            return (f"Geometry alone groups the pieces: {self.fault}.",)
        taken = f"{len(self.parts)} of {self.named} parts were taken from the answer"
        return (f"{taken}{f', which calls the object {self.about!r}' if self.about else ''}.", *self.notes)


@dataclass(frozen=True, kw_only=True, eq=False)
class PieceQuestion:
    """An unsegmented mesh that somebody is asked about."""

    assembly: Assembly
    pieces: tuple[IntArray, ...]
    """Indices of the pieces that have each number, from 1."""

    @cached_property
    def shown(self) -> tuple[Part, ...]:
        """What each number means, as one mesh."""
        return joined_pieces(self.assembly, self.pieces).parts

    @cached_property
    def picture(self) -> Image:
        """The sheet of numbered pieces."""
        return draw_sheet(self.shown)

    @property
    def text(self) -> str:
        """Return what is asked, with the extent of every piece."""
        return _QUESTION.format(list="\n".join(_listed(self.shown)))

    def schema(self) -> dict[str, Any]:
        """JSON schema of an answer."""
        number = {"type": "integer", "minimum": 1, "maximum": len(self.pieces)}
        axis = {"anyOf": [{"enum": list(_AXES)}, _array({"type": "number"})]}
        part = {
            "name": {"type": "string"}, "pieces": _array(number), "moves": {"enum": ["turns", "slides"]},
            "axis": axis, "edge": _array({"enum": list(_SIDES)}), "on": {"type": "string"}, "sure": {"type": "number"},
        }  # fmt: skip
        cut = _object({"piece": number, "what": {"type": "string"}})
        said = {"type": "string"}
        return _object({"object": said, "reason": said, "parts": _array(_object(part)), "cut": _array(cut)})

    def read(self, text: str, tokens: int = 0) -> PieceAnswer:
        """Read an answer that may be anything; what cannot be used is dropped and named.

        Args:
            text: JSON, perhaps inside of other text.
            tokens: What it cost.
        """
        found = _object_in(text)
        if found is None:
            return PieceAnswer(fault='the answer holds no JSON object with "parts"', tokens=tokens)
        stated = [item if isinstance(item, dict) else {} for item in found["parts"]]
        notes, used, kept = list[str](), set[int](), list[tuple[dict[str, Any], set[int]]]()
        for item in stated:
            name, said = str(item.get("name") or "part"), item.get("pieces")
            said = said if isinstance(said, list) else []
            numbers = [k for k in said if type(k) is int and 1 <= k <= len(self.pieces)]
            own, wrong = set(numbers) - used, [k for k in said if k not in numbers][:5]
            if wrong:
                notes.append(f"{name} names {wrong}, but pieces have the numbers 1 to {len(self.pieces)}: omitted.")
            if used & set(numbers):
                notes.append(f"{name} names pieces {sorted(used & set(numbers))} of another part: omitted.")
            if name.casefold() == BODY or not own:
                reason = "the body does not move" if name.casefold() == BODY else "no piece is left of it"
                notes.append(f"{name} is omitted: {reason}.")
                continue
            used |= own
            kept.append((item, own))
        if kept and len(used) == len(self.pieces):
            item, _ = kept.pop(int(np.argmax([sum(self.shown[k - 1].area for k in own) for _, own in kept])))
            notes.append(f"{item.get('name')} is the body: all pieces were named, and it is the largest part.")
        names = part_names([BODY, *(str(item.get("name") or "part") for item, _ in kept)])[1:]
        parts = [self._part(name, item, own) for name, (item, own) in zip(names, kept, strict=True)]
        notes += self._cuts(found.get("cut"))
        name_of = {str(item.get("name")): name for name, (item, _) in zip(names, kept, strict=True)}
        return PieceAnswer(
            parts=_hung(parts, name_of, notes),
            named=len(stated), about=str(found.get("object") or "")[:80], notes=tuple(notes), tokens=tokens,
        )  # fmt: skip

    def _part(self, name: str, item: dict[str, Any], numbers: set[int]) -> NamedPart:
        moves, sure, edge = item.get("moves"), item.get("sure"), item.get("edge")
        return NamedPart(
            name=name,
            pieces=np.concatenate([self.pieces[k - 1] for k in sorted(numbers)]),
            turns=None if moves not in ("turns", "slides") else moves == "turns",
            axis=_direction(item.get("axis")),
            edges=tuple(side for side in edge if side in _SIDES) if isinstance(edge, list) else None,
            on=str(item.get("on") or BODY),
            sure=min(max(float(sure), 0.0), 1.0) if isinstance(sure, int | float) else 1.0,
        )

    def _cuts(self, stated: Any) -> list[str]:
        """Parts that are no pieces of their own."""
        cuts = [item for item in stated if isinstance(item, dict)] if isinstance(stated, list) else []
        return [
            f"The answer names {str(item.get('what'))[:60]!r}, no piece of its own (piece {item.get('piece')}): "
            "--pieces cut cuts surfaces where they fold inwards, and asks again."
            for item in cuts
        ]


def piece_question(assembly: Assembly, config: Config) -> PieceQuestion:
    """The question about an object: pieces of a mesh, or the largest parts where it is segmented.

    Raises:
        InputError: It is one piece.
    """
    areas = [-part.area for part in assembly.parts]
    largest = tuple(np.array([k]) for k in np.argsort(areas, kind="stable")[:MOST_NUMBERS])
    pieces = largest if assembly.segmented else numbered_pieces(assembly, config.grouping)
    if len(pieces) < 2:
        raise InputError(
            f"{assembly.source} has no pieces to ask about. A mesh of two loose shells or more is expected; --pieces "
            "cut divides one closed surface where it folds inwards."
        )
    return PieceQuestion(assembly=assembly, pieces=pieces)


def read_answer_file(question: PieceQuestion, path: Path) -> PieceAnswer:
    """Read what somebody answered.

    Raises:
        InputError: The file cannot be read, or holds no answer.
    """
    try:
        answer = question.read(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"The answer {path} cannot be read ({error}).") from error
    if answer.fault:
        raise InputError(
            f"{path} is no answer: {answer.fault}. `kinematify question` writes the question and schema.json."
        )
    return answer


def _object_in(text: str) -> dict[str, Any] | None:
    """The last JSON object with parts that a text holds."""
    decoder, start, found = json.JSONDecoder(), text.find("{"), None
    while start >= 0:
        try:
            value, end = decoder.raw_decode(text, start)
        except (ValueError, RecursionError):
            end = start + 1
        else:
            found = value if isinstance(value.get("parts"), list) else found
        start = text.find("{", end)
    return found


def _hung(parts: Sequence[NamedPart], name_of: dict[str, str], notes: list[str]) -> tuple[NamedPart, ...]:
    """The parts with what carries them by its new name; the body where that is unknown or leads in a circle."""
    above = {part.name: name_of.get(part.on, BODY) for part in parts}
    for part in parts:
        chain = [part.name]
        while (up := above[chain[-1]]) != BODY and up not in chain:
            chain.append(up)
        if up != BODY or (above[part.name] == BODY != part.on):
            notes.append(
                f"{part.name} is on {part.on!r}, which is {'in a circle' if up != BODY else 'no part'}: on the body."
            )
            above[part.name] = BODY
    return tuple(replace(part, on=above[part.name]) for part in parts)


def _direction(stated: Any) -> FloatArray | None:
    if isinstance(stated, str):
        return _AXES.get(stated.strip("+-").lower())
    try:
        vector = np.asarray(stated, dtype=np.float64)
    except (TypeError, ValueError):
        return None
    length = float(np.linalg.norm(vector)) if vector.shape == (3,) else 0.0
    return vector / length if np.isfinite(length) and length > 0.0 else None


def _listed(parts: Sequence[Part]) -> list[str]:
    """The extent of every piece, one line each; runs of congruent tiny ones have one."""
    low, high = box_around([part.bounds for part in parts])
    boxes = np.array([100.0 * (part.bounds - low) / max(float((high - low).max()), 1e-300) for part in parts])
    sizes = np.sort(np.ptp(boxes, axis=1), axis=1)
    share = 100.0 * np.array([part.area for part in parts]) / max(sum(part.area for part in parts), 1e-300)
    lines, start = [], 0
    while start < len(parts):
        end = start + 1
        while end < len(parts) and sizes[start].max() < _TINY and np.abs(sizes[end] - sizes[start]).max() < _SAME:
            end += 1
        end = end if end - start >= _RUN else start + 1
        (x0, y0, z0), (x1, y1, z1) = boxes[start:end, 0].min(axis=0), boxes[start:end, 1].max(axis=0)
        title = f"{start + 1}" if end == start + 1 else f"{start + 1} to {end}, {end - start} alike, between"
        ends = f"x {x0:.0f}..{x1:.0f}, y {y0:.0f}..{y1:.0f}, z {z0:.0f}..{z1:.0f}"
        lines.append(f"{title}: {ends}; {share[start]:.1f} % of the surface{' each' if end > start + 1 else ''}")
        start = end
    return lines


def _array(items: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": items}


def _object(properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": list(properties), "additionalProperties": False}


def asked_question(mesh: Path, up: str, scale: float | None, pieces: str) -> PieceQuestion:
    """The question about a mesh that nobody segmented.

    Raises:
        InputError: It cannot be read, or is one piece.
    """
    settings = load_config()
    return piece_question(load_assembly(mesh, config=settings.assembly, up=up, scale=scale, pieces=pieces), settings)


def infer_command(mesh: Path, answer: Path) -> str:
    """The command that makes a model of a mesh and an answer."""
    return shlex.join(["kinematify", "infer", str(mesh), "--answer", str(answer), "-o", "OUT"])
