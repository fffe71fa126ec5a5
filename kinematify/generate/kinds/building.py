"""Windows, doors and panels of switches, carved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import degrees, hypot, pi, tan
from typing import Any

from manifold3d import Manifold

from kinematify.generate.library.kind import choice, kind, length, whole
from kinematify.generate.library.mechanisms import button, knob, lever
from kinematify.generate.library.panels import grip, leaf
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.layout import grid
from kinematify.generate.procedural.pieces.bearing_pieces import barrel
from kinematify.generate.procedural.pieces.fronts import Field
from kinematify.generate.procedural.solids import X, Y, Z, bore, box, cylinder, hull, rod, slab, union

_STOP = 0.012  # how far the strip that a leaf lies against reaches into the opening [m]
_GROOVE = 0.012  # depth of the grooves that leaves run in [m]
_RIB = 0.008  # between two grooves [m]


def side_by_side(whole: Field, count: int, mullion: float, *, together: int = 1) -> list[list[Field]]:
    """Divide a field into `count` equal ones in groups of `together`, with a mullion between groups."""
    groups = -(-count // together)
    width = (whole.right - whole.left - (groups - 1) * mullion) / count
    divided: list[list[Field]] = [[] for _ in range(groups)]
    for k in range(count):
        left = whole.left + k * width + (k // together) * mullion
        divided[k // together].append(Field(left=left, right=left + width, bottom=whole.bottom, top=whole.top))
    return divided


def stopped_opening(groups: Sequence[Sequence[Field]], depth: float, thick: float, clearance: float) -> Manifold:
    """Return what to cut from a frame so that groups of leaves close against a strip behind them."""
    cuts = []
    for group in groups:
        whole = Field(left=group[0].left, right=group[-1].right, bottom=group[0].bottom, top=group[0].top)
        cuts += [whole.box(-1.0, thick + clearance), whole.box(-1.0, depth + 1.0, inset=_STOP)]
    return union(*cuts)


@dataclass(frozen=True, kw_only=True)
class Grooves:
    """Grooves above and below an opening, one behind the other, the first one in front."""

    opening: Field
    count: int
    thick: float
    """Of the leaves [m]."""
    clearance: float
    """[m]."""

    @property
    def depth(self) -> float:
        """Depth of the frame that has room for the grooves [m]."""
        return _RIB + self.count * self._pitch

    @property
    def _pitch(self) -> float:
        return self.thick + 2.0 * self.clearance + _RIB

    def cut(self) -> Manifold:
        """Return what to cut from a frame: the opening and the grooves."""
        grooves = [self._groove(k) for k in range(self.count)]
        return union(self.opening.box(-1.0, self.depth + 1.0), *grooves)

    def _groove(self, track: int) -> Manifold:
        start = _RIB + track * self._pitch
        lower = (self.opening.left, start, self.opening.bottom - _GROOVE)
        return box(lower, (self.opening.right, start + self._pitch - _RIB, self.opening.top + _GROOVE))

    def front(self, track: int) -> float:
        """Y of the front of a leaf in a track [m]."""
        return _RIB + track * self._pitch + self.clearance

    def slab(self, track: int, left: float, right: float) -> Manifold:
        """Return a leaf that runs in a track."""
        y, deep = self.front(track), _GROOVE - self.clearance
        lower = (left, y, self.opening.bottom - deep)
        return box(lower, (right, y + self.thick, self.opening.top + deep))

    def fixed(self, track: int, left: float, right: float) -> Manifold:
        """Return a pane that fills a track and belongs to the frame."""
        y = self.front(track) - self.clearance
        lower = (left, y - 1e-4, self.opening.bottom - _GROOVE)
        return box(lower, (right, y + self.thick + 2.0 * self.clearance + 1e-4, self.opening.top + _GROOVE))


def add_sliding(
    w: ObjectBuilder,
    name: str,
    parent: str,
    tracks: Grooves,
    *,
    count: int,
    finish: Callable[[Manifold, Field, float], Manifold],
    rest: float,
) -> None:
    """Add `count` leaves, each in its own track, that run sideways; beside a single one stands a fixed pane.

    Args:
        w: Where they are added.
        name: Of all, without their numbers.
        parent: The frame, without the opening; it is cut here.
        tracks: As many as leaves, two at least.
        count: Of leaves.
        finish: Carves a slab, given its face and the y of its front.
        rest: Share of the way that they stand open.
    """
    opening, clearance = tracks.opening, tracks.clearance
    shares = max(count, 2)
    pitch = (opening.right - opening.left) / shares
    overlap = min(0.03, 0.1 * pitch)
    w.cut(parent, tracks.cut())
    for k in range(shares):
        left = opening.left + k * pitch + (clearance if k == 0 else -0.5 * overlap)
        right = opening.left + (k + 1) * pitch + (-clearance if k == shares - 1 else 0.5 * overlap)
        face = Field(left=left, right=right, bottom=opening.bottom, top=opening.top)
        if k >= count:
            whole = tracks.fixed(k, left, opening.right + 1e-3)
            w.part(parent, finish(whole, face, tracks.front(k)))
            continue
        w.part(f"{name}_{k + 1}", finish(tracks.slab(k, left, right), face, tracks.front(k)))
        to_right = opening.right - clearance - right
        to_left = left - opening.left - clearance
        sign, room = (1, to_right) if to_right >= to_left else (-1, to_left)
        place = (face.middle[0], tracks.front(k), face.middle[1])
        w.slide(f"{name}_{k + 1}", parent, (sign, 0, 0), 0.95 * room, pivot=place, rest=rest * (0.95 * room))


def fields_of(face: Field, front: float, thick: float, *, bar: float, rows: int, columns: int, sunk: float) -> Manifold:
    """Return what to cut from a leaf so that `rows` x `columns` fields are sunk into both faces between bars.

    Args:
        face: Its borders.
        front: Y of its front [m].
        thick: Its thickness [m].
        bar: Width of the bars around the fields; those between them are half as wide [m].
        rows: Of fields.
        columns: Of fields.
        sunk: Share of the thickness taken away from each side, below one half.
    """
    width = (face.right - face.left - 2.0 * bar - 0.5 * bar * (columns - 1)) / max(columns, 1)
    height = (face.top - face.bottom - 2.0 * bar - 0.5 * bar * (rows - 1)) / max(rows, 1)
    cuts = []
    for row in range(rows):
        for column in range(columns):
            left = face.left + bar + column * (width + 0.5 * bar)
            bottom = face.bottom + bar + row * (height + 0.5 * bar)
            field = Field(left=left, right=left + width, bottom=bottom, top=bottom + height)
            cuts += [field.box(front - 1.0, front + sunk * thick), field.box(front + (1.0 - sunk) * thick, front + 1.0)]
    return union(*cuts)


@kind(
    usual={
        "sliding room door, sliding door, barn door, pocket door, patio door, sliding barn door": {"kind": "sliding"},
        "folding door, bifold door, accordion door, bi-fold door, concertina door": {"kind": "folding", "leaves": 2},
        (
            "double door, french doors, double leaf door, french door, saloon doors, swing doors, pair of doors, two "
            "leaf door"
        ): {"leaves": 2, "width": 1.6},
    },
    words=(
        "doorway, front door, house door, interior door, room door, cellar door, closet door, shower door, entrance "
        "door, back door, office door, bathroom door, bedroom door, kitchen door, balcony door, fire door, screen door"
    ),
    carved_from="wood",
    width=length(0.7, 5.0, default=0.95, usual=(0.8, 1.4), help="Outer width."),
    height=length(1.6, 4.0, default=2.05, usual=(1.9, 2.3), help="Outer height."),
    thick=length(0.02, 0.06, usual=(0.03, 0.05), help="Of a leaf.", words="thick, thickness"),
    frame=length(0.03, 0.08, default=0.05, usual=(0.04, 0.07), help="Its bars' width."),
    kind=choice(
        {
            "hinged": "swinging, swing, french",
            "sliding": "slide, patio, barn",
            "folding": "bifold, accordion, concertina",
        },
        help="How leaves move.",
    ),
    leaves=whole(
        1, 4, default=1, usual=(1, 2), help="That move; a folding door has two at least.", words="leaf, wing, door"
    ),
    panels=whole(0, 8, default=2, usual=(0, 4), help="In every leaf.", words="panel"),
    handle=choice(
        ("lever", "knob", "bar", "none"), help="Levers and knobs turn; a sliding or folding leaf has a grip."
    ),
    hinge=choice(("barrel", "edge"), help="Visible hinges, or hidden ones."),
    hinge_side=choice(("left", "right"), help="Of a single hinged leaf."),
)
def door(
    w: ObjectBuilder,
    width: float,
    height: float,
    thick: float,
    frame: float,
    kind: str,
    leaves: int,
    panels: int,
    handle: str,
    hinge: str,
    hinge_side: str,
    open: float,
    clearance: float,
) -> None:
    """Doors in their frames: hinged leaves, alone or in pairs, leaves that slide in grooves, and leaves that fold."""
    the_depth = 0.11  # of a frame without grooves [m]
    the_barrel = 0.007  # radius [m]
    the_opens = 1.75  # [rad]; less where the leaves of two openings would meet
    floor = 0.006  # under a leaf that has no sill [m]
    folds = 1.25  # of the first leaf of a folding door; the others fold back by twice as much [rad]

    def opening_of(sill: float) -> Field:
        half = 0.5 * width
        bar = frame
        return Field(left=bar - half, right=half - bar, bottom=sill, top=height - bar)

    def frame_of(depth: float) -> Manifold:
        half = 0.5 * width
        return slab(half, (0, depth), (0, height))

    # Width of the bars around a leaf's panels, where handles are.
    def stile_of(face: Field) -> float:
        return min(0.11, 0.22 * (face.right - face.left))

    # A leaf with its panels, one above the other.
    def panels_of(face: Field, front: float) -> Manifold:
        return fields_of(face, front, thick, bar=stile_of(face), rows=panels, columns=1, sunk=0.25)

    def panelled(board: Manifold, face: Field, front: float) -> Manifold:
        return board - panels_of(face, front)

    def below_of(opening: Field) -> Manifold:
        return Field(left=opening.left, right=opening.right, bottom=-1.0, top=0.1).box(-1.0, 1.0)

    if kind == "hinged":
        opening = opening_of(0.0)
        groups = side_by_side(opening, leaves, frame, together=2)
        cut = stopped_opening(groups, the_depth, thick, clearance)
        below = [Field(left=g[0].left, right=g[-1].right, bottom=-1.0, top=0.1).box(-1.0, 1.0) for g in groups]
        w.part("frame", frame_of(the_depth) - cut)
        w.cut("frame", below)
        opens = the_opens if len(groups) == 1 else 1.5
        its_leaves = [(place, field) for group in groups for place, field in enumerate(group)]
        for number, (place, field) in enumerate(its_leaves, start=1):
            edge = ("left", "right")[place]
            if len(its_leaves) == 1 and hinge_side == "right":
                edge = "right"
            x = field.right - 0.5 * stile_of(field) if edge == "left" else field.left + 0.5 * stile_of(field)
            with w.fitted(open) as b:
                leaf(
                    b,
                    f"leaf_{number}",
                    "frame",
                    (field.left, 0, floor),
                    (field.right, thick, field.top),
                    hinge=-X if edge == "left" else X,
                    inset=True,
                    reach=opens,
                    handle="none",
                    barrels=3 if hinge == "barrel" else 0,
                )
            w.cut(
                f"leaf_{number}", panels_of(Field(left=field.left, right=field.right, bottom=floor, top=field.top), 0.0)
            )
            if handle == "bar":
                with w.fitted() as b:
                    grip(b, f"leaf_{number}", (x, 0, 1), -Y, Z, 0.3, kind=handle)
            # A handle that turns: a lever towards the hinge, on both sides where there is room for it, or a knob.
            name = f"handle_{number}"
            stile = stile_of(field)
            if handle == "lever":
                side = 1 if edge == "left" else -1
                with w.fitted(open) as b:
                    lever(
                        b,
                        name,
                        f"leaf_{number}",
                        (x, 0, 1),
                        -Y,
                        -side * X,
                        1.1 * stile,
                        reach=0.8 * side,
                        through=thick if stile > 0.08 else 0.0,
                    )
            elif handle == "knob":
                with w.fitted(open) as b:
                    knob(
                        b,
                        name,
                        f"leaf_{number}",
                        (x, 0, 1),
                        min(0.028, 0.4 * stile),
                        -Y,
                        high=0.04,
                        reach=1.6,
                        material="metal",
                    )
    elif kind == "sliding":
        # Leaves in grooves of sill and lintel; each passes its neighbour.
        tracks = Grooves(opening=opening_of(0.03), count=max(leaves, 2), thick=thick, clearance=clearance)
        w.part("frame", frame_of(tracks.depth))

        def finish(board: Manifold, face: Field, front: float) -> Manifold:
            x = face.left + 0.5 * stile_of(face)
            half = min(0.012, 0.3 * stile_of(face))
            pull = box((x - half, front - 1.0, 0.93), (x + half, front + 0.3 * thick, 1.07))
            return panelled(board, face, front) - pull

        add_sliding(w, "leaf", parent="frame", tracks=tracks, count=leaves, finish=finish, rest=open)
    elif kind == "folding":
        # Leaves in a row, each hinged to the one before, in front and behind in turn; a single one is made of
        # two.
        opening_2 = opening_of(floor)
        row = side_by_side(opening_2, max(2, leaves), 0.0, together=99)[0]
        w.part("frame", frame_of(thick + 0.02) - opening_2.box(-1.0, 1.0) - below_of(opening_2))
        gap = clearance + 0.001
        spare = (
            0.5 * ((thick + the_barrel + clearance) * (thick + the_barrel + clearance)) / (row[0].right - row[0].left)
        )
        parent = "frame"
        for k, field_2 in enumerate(row):
            name_2 = f"leaf_{k + 1}"
            last = k + 1 == len(row)
            right = field_2.right - gap - (spare + gap if last else 0.0)
            board = box((field_2.left + gap, 0, field_2.bottom + gap), (right, thick, field_2.top - gap))
            solids_2 = [panelled(board, field_2, 0.0)]
            if last:
                solids_2 = [
                    *solids_2,
                    box(
                        (right - 0.4 * stile_of(field_2) - 0.004, -0.02, 0.94),
                        (right - 0.4 * stile_of(field_2) + 0.004, 0.001, 1.06),
                    ),
                ]
            inwards = k % 2 == 0
            level = -the_barrel - clearance if inwards else thick + the_barrel + clearance
            w.part(name_2, solids_2)
            # Barrels on the faces of two leaves, or of a jamb and a leaf, about the line at x = field.left, y =
            # level.
            far = gap + 3.0 * the_barrel
            near = gap + 0.6 * the_barrel
            face = (the_barrel + clearance - 0.0002, the_barrel + clearance + 0.0001)
            halves = barrel(0.08, the_barrel, clearance, ((-far, -near, *face), (near, far, *face)))
            its_height = field_2.top - field_2.bottom
            for share in (0.15, 0.5, 0.85):
                place_2 = (field_2.left, level, field_2.bottom + share * its_height)
                for body, half in zip((parent, name_2), halves, strict=False):
                    w.part(body, (half if level < 0 else half.mirror((0, 1, 0))).translate(place_2))
            opens_2 = folds if k == 0 else 2.0 * folds
            w.hinge(
                name_2, parent, (0, 0, -1 if inwards else 1), (field_2.left, level, 0), opens_2, rest=open * opens_2
            )
            parent = name_2
    w.settle()


@kind(
    words=(
        "skylight, roof window, house window, basement window, casement window, attic window, bathroom "
        "window, kitchen window"
    ),
    carved_from="wood",
    width=length(0.6, 4.0, default=1.0, usual=(0.6, 1.6), help="Outer width."),
    height=length(0.5, 3.0, default=1.2, usual=(0.6, 1.6), help="Outer height."),
    frame=length(0.03, 0.08, default=0.05, usual=(0.04, 0.07), help="Its bars' width."),
    kind=choice(
        {
            "casement": "hinged, swinging, french",
            "sliding": "slide, gliding",
            "tilt": "tilting, tilted, hopper, bottom hung",
            "awning": "top hung",
            "pivot": "pivoting, pivoted",
        },
        help="Sashes turn about a side, slide, turn about the lower or upper edge, or about their middle.",
    ),
    sashes=whole(1, 3, default=1, help="That move.", words="sash, window, pane, casement"),
    rows=whole(1, 4, default=1, usual=(1, 2), help="Of panes in a sash."),
    columns=whole(1, 3, default=1, usual=(1, 2), help="Of panes in a sash."),
    hinge=choice(("barrel", "edge"), help="Visible hinges, or hidden ones."),
    handle=choice(("lever", "none"), help="A handle that turns on hinged sashes."),
)
def window(
    w: ObjectBuilder,
    width: float,
    height: float,
    frame: float,
    kind: str,
    sashes: int,
    rows: int,
    columns: int,
    hinge: str,
    handle: str,
    open: float,
    clearance: float,
) -> None:
    """Windows: sashes that slide in grooves, or turn about a side, the lower or upper edge, or pins at mid-height."""
    thick = 0.04  # of a sash [m]
    sash = 0.045  # width of a sash's bars [m]
    the_depth = 0.07  # of a frame without grooves [m]
    pin = 0.008  # radius of what a pivoting sash turns on [m]
    turning = {"casement": 1.5, "tilt": 0.6, "awning": 0.8}  # how far a sash opens [rad]

    def frame_of(depth: float) -> Manifold:
        half = 0.5 * width
        return slab(half, (0, depth), (0, height))

    # Width of the bars around a sash's panes.
    def bar_of(face: Field) -> float:
        return min(sash, 0.2 * (face.right - face.left), 0.2 * (face.top - face.bottom))

    # A sash with its panes.
    def panes_of(face: Field, front: float) -> Manifold:
        return fields_of(face, front, thick, bar=bar_of(face), rows=rows, columns=columns, sunk=0.42)

    def glazed(board: Manifold, face: Field, front: float) -> Manifold:
        return board - panes_of(face, front)

    opening = Field(left=frame - 0.5 * width, right=0.5 * width - frame, bottom=frame, top=height - frame)
    if kind == "sliding":
        tracks = Grooves(opening=opening, count=max(sashes, 2), thick=thick, clearance=clearance)
        w.part("frame", frame_of(tracks.depth))

        def finish(board: Any, face: Any, front: Any) -> Any:
            x = face.left + 0.5 * bar_of(face)
            z = face.middle[1]
            pull = box((x - 0.006, front - 1.0, z - 0.05), (x + 0.006, front + 0.008, z + 0.05))
            return glazed(board, face, front) - pull

        add_sliding(w, "sash", parent="frame", tracks=tracks, count=sashes, finish=finish, rest=open)
    elif kind == "pivot":
        # Sashes on pins in the jambs, which turn about their middle.
        groups = side_by_side(opening, sashes, frame)
        w.part("frame", frame_of(the_depth))
        for number, group in enumerate(groups, start=1):
            field = group[0]
            w.cut("frame", field.box(-1.0, 1.0))
            gap = clearance + 0.001
            half = 0.5 * (field.top - field.bottom)
            swing = gap + hypot(half, 0.5 * thick) - half
            x, z = field.middle
            start = 0.5 * (the_depth - thick)
            lower = (field.left + gap, start, field.bottom + swing)
            board = box(lower, (field.right - gap, start + thick, field.top - swing))
            name = f"sash_{number}"
            reach = 0.4 * frame
            ends = ((field.left - reach, 0.5 * the_depth, z), (field.right + reach, 0.5 * the_depth, z))
            far = ((ends[0][0] - clearance, *ends[0][1:]), (ends[1][0] + clearance, *ends[1][1:]))
            w.cut("frame", bore(pin, clearance, *far))
            pins = cylinder(pin, *ends) - field.box(-1.0, 1.0, inset=2.0 * gap)
            w.part(name, glazed(board, field, start), pins)
            w.hinge(name, "frame", (1, 0, 0), (x, 0.5 * the_depth, z), 1.3, rest=open * 1.3)
    else:
        together = 2 if kind == "casement" else 1
        groups_2 = side_by_side(opening, sashes, frame, together=together)
        w.part("frame", frame_of(the_depth) - stopped_opening(groups_2, the_depth, thick, clearance))
        number_2 = 0
        edges = {"left": -X, "right": X, "bottom": -Z, "top": Z}
        for group_2 in groups_2:
            for place, field_2 in enumerate(group_2):
                number_2 = number_2 + 1
                edge = {"tilt": "bottom", "awning": "top"}.get(kind, ("left", "right")[place])
                with w.fitted(open) as b:
                    leaf(
                        b,
                        f"sash_{number_2}",
                        "frame",
                        (field_2.left, 0, field_2.bottom),
                        (field_2.right, thick, field_2.top),
                        hinge=edges[edge],
                        inset=True,
                        reach=turning[kind],
                        handle="none",
                        barrels=2 if hinge == "barrel" else 0,
                    )
                w.cut(f"sash_{number_2}", panes_of(field_2, 0.0))
                if handle == "lever":
                    # A handle in the middle of the free side, that turns by a quarter.
                    x_2, z_2 = field_2.middle
                    bar = bar_of(field_2)
                    x_2 = {"left": field_2.right - 0.5 * bar, "right": field_2.left + 0.5 * bar}.get(edge, x_2)
                    z_2 = {"bottom": field_2.top - 0.5 * bar, "top": field_2.bottom + 0.5 * bar}.get(edge, z_2)
                    along = X if edge == "top" else -Z
                    with w.fitted(open) as b:
                        lever(
                            b,
                            f"handle_{number_2}",
                            f"sash_{number_2}",
                            (x_2, 0, z_2),
                            -Y,
                            along,
                            2.2 * bar,
                            reach=-0.5 * pi if edge == "left" else 0.5 * pi,
                        )
    w.settle()


@kind(
    words=(
        "light switch, wall switch, switch plate, switch, dimmer switch, toggle switch, rocker switch, double "
        "switch plate, lamp switch, light switch panel"
    ),
    rockers=whole(
        1, 6, default=1, usual=(1, 4), help="Switches side by side.", words="rocker, switch, gang, rocker switch"
    ),
    dimmers=whole(0, 2, default=0, usual=(0, 1), help="At the right.", words="knob, dial"),
    kind=choice(("rocker", "toggle"), help="Of the switches."),
    pitch=length(0.03, 0.08, default=0.045, usual=(0.035, 0.06), help="Of switches."),
    height=length(0.06, 0.15, default=0.085, usual=(0.075, 0.12), help="Of the plate."),
    carved_from="plastic",
)
def switch_panel(
    w: ObjectBuilder, rockers: int, dimmers: int, kind: str, pitch: float, height: float, open: float, clearance: float
) -> None:
    """Light switches: rockers or toggles side by side in a plate, and dimmers."""
    switch_depth = 0.034  # of the housing [m]
    the_tilt = {"rocker": 0.12, "toggle": 0.35}  # from the middle to either end [rad]
    pivot = 0.009  # depth of its pins [m]
    pocket = 0.024  # depth of the room behind a switch [m]
    pin = 0.003  # radius of the pins [m]

    # A wedge with a ridge in its middle, level about its pins, and the room that it needs.
    def rocker(half: float, high: float, clearance: float) -> tuple[Manifold, Manifold]:
        edge = high * tan(the_tilt["rocker"]) - pivot - 0.003
        ridge = slab(half, (-pivot - 0.003, 0.004), 0.001)
        wedge = hull(ridge, slab(half, (edge, edge + 0.003), high))
        reach = hypot(high, edge) + clearance
        wide = half + clearance
        return (wedge, slab(wide, (-1.0, pocket - pivot), reach))

    # A stick on a hub, and the room that it needs.
    def toggle(half: float, clearance: float) -> tuple[Manifold, Manifold]:
        hub = cylinder(0.006, (-half, half), 0, 0)
        stick = hull(rod(0.0035, 0, (0, -0.01), 0), rod(0.0045, 0, (-0.022, -0.024), 0))
        wide = half + clearance
        return (hub + stick, slab(wide, (-1.0, 0.008 + clearance), 0.012 + clearance))

    half = 0.5 * pitch * (rockers + dimmers) + 0.006
    plate = slab(half, (0, 0.004), (0, height))
    housing = box((0.004 - half, 0.001, 0.004), (half - 0.004, switch_depth, height - 0.004))
    w.part("plate", plate, housing)
    for k in range(rockers):
        # A switch on pins that lie along x, tilted to its lower end.
        half_2 = 0.5 * pitch - 0.008
        level = 0.5 * height
        if kind == "rocker":
            solid, room = rocker(half_2, 0.36 * height, clearance)
        else:
            half_2 = min(half_2, 0.01)
            solid, room = toggle(half_2, clearance)
        reach = half_2 + 0.0055
        tight = min(clearance, 0.5 * pin)
        pins = cylinder(pin, (-reach, reach), 0, 0)
        place = ((k + 0.5) * pitch - half + 0.006, pivot, level)
        w.cut("plate", room.translate(place))
        w.cut("plate", bore(pin, tight, (-reach - tight, 0, 0), (reach + tight, 0, 0)).translate(place))
        tilt = the_tilt[kind]
        name = f"rocker_{k + 1}"
        w.part(name, (solid + pins).rotate((degrees(tilt), 0, 0)).translate(place))
        w.hinge(name, "plate", (-1, 0, 0), place, 2.0 * tilt, rest=open * (2.0 * tilt))
    for k in range(dimmers):
        with w.fitted(open) as b:
            knob(
                b,
                f"dimmer_{k + 1}",
                "plate",
                [(rockers + k + 0.5) * pitch - half + 0.006, 0, 0.5 * height],
                0.36 * pitch,
                -Y,
                reach=4.7,
            )
    w.settle()


@kind(
    words=(
        "keypad, control panel, push button panel, number pad, elevator panel, remote control, calculator, numeric "
        "pad, lift panel, elevator button panel, call panel, control unit, alarm panel, remote, tv remote, garage door "
        "opener, pocket calculator, mp3 player, numpad, numeric keypad, key fob, launchpad, card terminal, pos "
        "terminal, payment terminal, tv controller, universal remote, graphing calculator"
    ),
    width=length(0.06, 0.6, default=0.12, usual=(0.08, 0.25), help="Outer width."),
    height=length(0.08, 0.8, default=0.18, usual=(0.12, 0.3), help="Outer height."),
    depth=length(0.02, 0.2, default=0.03, usual=(0.02, 0.06), help="Of the housing."),
    buttons=whole(1, 24, usual=(2, 16), help="In rows, from the top left.", words="key, push button"),
    columns=whole(1, 6, usual=(1, 4), help="Of buttons.", words="column"),
    knobs=whole(0, 4, default=0, usual=(0, 3), help="Above the buttons.", words="dial"),
    shape=choice({"square": "rectangular", "round": "circular"}, help="Of the buttons."),
    display=choice({"none": "", "display": "screen"}, help="A recess for a screen."),
    carved_from="plastic",
)
def button_panel(
    w: ObjectBuilder,
    width: float,
    height: float,
    depth: float,
    buttons: int,
    columns: int,
    knobs: int,
    shape: str,
    display: str,
    open: float,
    clearance: float,
) -> None:
    """Button panels and keypads: buttons in rows on a housing, with knobs and a display above them."""
    w.part("housing", slab(0.5 * width, (0, depth), (0, height)))
    top = 0.94 * height
    if display == "display":
        w.cut("housing", slab(0.42 * width, (-1.0, 0.002), (top - 0.16 * height, top)))
        top = top - 0.2 * height
    if knobs:
        pitch = 0.9 * width / knobs
        radius = min(0.09 * height, 0.38 * pitch)
        for k in range(knobs):
            with w.fitted(open) as b:
                knob(
                    b,
                    f"knob_{k + 1}",
                    "housing",
                    [(k - 0.5 * (knobs - 1)) * pitch, 0, top - 0.1 * height],
                    radius,
                    -Y,
                    deep=min(0.011, 0.5 * radius),
                    reach=4.7,
                )
        top = top - 0.22 * height
    bottom = 0.06 * height
    its_columns = min(columns, buttons)
    rows = -(-buttons // its_columns)
    pitch_2 = min(0.9 * width / its_columns, (top - bottom) / rows)
    tight = min(clearance, 0.08 * pitch_2)
    area = (
        its_columns * min(0.9 * width / its_columns, 1.6 * pitch_2),
        rows * min((top - bottom) / rows, 1.6 * pitch_2),
    )
    size = (0.84 * pitch_2 - 2.0 * tight,) * 2
    for k_2, (x_2, z) in enumerate(grid(buttons, its_columns, area)):
        with w.fitted() as b:
            button(
                b,
                f"button_{k_2 + 1}",
                "housing",
                (x_2, 0, 0.5 * (bottom + top) + z),
                size,
                min(0.006, 0.4 * pitch_2),
                -Y,
                is_round=shape == "round",
            )
    w.settle()
