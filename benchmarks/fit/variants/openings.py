"""Doors, gates, windows and shutters as others model them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.kinds.openings import surround
from kinematify.generate.library.kind import angle, choice, kind, length, whole, yes
from kinematify.generate.library.mechanisms import knob, lever
from kinematify.generate.library.panels import filled, grip, leaf, seam
from kinematify.generate.procedural.builder import spread
from kinematify.generate.procedural.solids import X, Y, Z, beam, box, slab, vector

if TYPE_CHECKING:
    from kinematify.generate.procedural.builder import ObjectBuilder
    from kinematify.generate.procedural.solids import Point


def pane(d: ObjectBuilder, name: str, lower: Point, upper: Point) -> None:
    """A plate of wood between two corners that is a plain slab, has a panel let in, or is a frame about a pane."""
    low, high = np.minimum(lower, upper), np.maximum(lower, upper)
    d.part(name, look="wood")
    filled(d, name, low, high, -Y, d.pick("plain", "panel", "pane", "pane"))


@kind(
    "parametric room door",
    like="door",
    width=length(0.65, 1.2),
    height=length(1.8, 2.4),
    thickness=length(0.025, 0.07),
    turning=yes(0.3),
)
def room_door(b: ObjectBuilder, width: float, height: float, thickness: float, turning: bool) -> None:
    """One leaf in a frame, in a wall or between posts; now and then its handle turns."""
    low = b.pick(0, 0, 0.015)
    surround(b, "frame", wide=width, low=low, high=height, front=-thickness, sill=b.maybe(0.3))
    side = b.pick(X, -X)
    leaf(
        b,
        "leaf",
        parent="frame",
        lower=(-width / 2, -thickness, low),
        upper=(width / 2, 0, height),
        hinge=side,
        inset=True,
        reach=b.draw(1.2, 2.4),
        back=b.pick(0, 0, 0, 0 if b.style.has_bore else 1.4),
        handle=not turning,
        glazed=0.25,
    )
    if turning:
        at = -0.42 * width * side - thickness * Y + 0.48 * height * Z
        if b.maybe():
            lever(b, "handle", parent="leaf", at=at, out=-Y, along=side, length=b.draw(0.1, 0.16), reach=b.draw(0.5, 1))
        else:
            knob(b, "handle", parent="leaf", at=at, radius=0.03, high=0.06, out=-Y, reach=b.draw(0.7, 1.6))


@kind(
    "slab garage door",
    like="garage_door",
    width=length(2.2, 3.0),
    height=length(1.9, 2.4),
    thickness=length(0.03, 0.08),
    kind=choice(("top", "middle", "slides")),
)
def slab_garage_door(b: ObjectBuilder, width: float, height: float, thickness: float, kind: str) -> None:
    """A plate before or in an opening that tilts about its upper edge or its middle, or is pushed up."""
    surround(b, "wall", wide=width, low=0.0, high=height, front=-thickness if kind != "slides" else 0, sill=False)
    if kind == "top":
        leaf(
            b,
            "door",
            parent="wall",
            lower=(-width / 2, -thickness, 0),
            upper=(width / 2, 0, height),
            hinge=Z,
            inset=True,
            reach=b.draw(1.2, 1.57),
            glazed=0.0,
        )
    else:
        play = max(seam(b, 1, thickness), 0.003 if kind == "middle" else -1)
        if kind == "slides":
            b.part("door", slab(width / 2 + 0.05, (-thickness - play, -play), (0, height + 0.05)), look="metal")
        else:
            b.part("door", slab(width / 2 - play, (-thickness, 0), (0.01, height - 0.15)), look="metal")
        for z in spread(b.count(1, 5), 0, height - 0.15):
            b.part(
                "door",
                slab(0.45 * width, (-thickness - play - 0.015, -thickness - play + 0.005), (z - 0.04, z + 0.04)),
            )
        if kind == "slides":
            b.slide("door", parent="wall", axis=Z, upper=b.draw(0.7, 0.95) * height)
        else:
            middle = b.draw(0.45, 0.55) * (height - 0.15)
            b.hinge("door", parent="wall", axis=X, pivot=(0, -0.5 * thickness, middle), upper=1.3, ajar=False)


@kind(
    "slab gate",
    words="plank gate, farm gate, field gate",
    like="door",
    width=length(0.8, 1.3),
    height=length(0.8, 1.9),
    thickness=length(0.02, 0.06),
    number=whole(1, 2, words="leaf, wing"),
    post=length(0.06, 0.25),
    foot=length(0.02, 0.1),
)
def slab_gate(
    b: ObjectBuilder, width: float, height: float, thickness: float, number: int, post: float, foot: float
) -> None:
    """One or two leaves of boards between posts or in a fence."""
    for s in (-1, 1):
        a = s * number * width / 2
        b.part("posts", slab((a, a + s * post), post / 2, (0, height * b.draw(1, 1.15))), look="wood")
        if b.maybe(0.4):
            b.part(
                "posts",
                [
                    slab((a + 0.5 * s * post, a + s * b.draw(0.8, 1.5)), 0.02, (z, z + 0.08))
                    for z in (0.2 * height, 0.75 * height)
                ],
            )
    b.part("posts", slab(number * width / 2 + post, post / 2, (-0.1, 0)))
    y = b.pick(-post / 2, -thickness / 2)
    play = seam(b, width, thickness)
    for k in range(number):
        s = -1 if k == 0 and b.maybe() else 1
        side = (-X, X)[k] if number == 2 else s * X
        a, b_ = (-width * number / 2, width / 2) if number == 1 else ((-width, 0), (0, width))[k]
        a = a + play
        b_ = b_ - max(play, 0)
        name = f"leaf_{k}"
        if b.maybe():
            b.part(name, box((a, y, foot), (b_, y + thickness, height)), look="wood")
        else:
            boards = b.count(4, 9)
            wide = (b_ - a) / boards * b.draw(0.5, 0.95)
            b.part(
                name,
                [box((x - wide / 2, y, foot), (x + wide / 2, y + thickness, height)) for x in spread(boards, a, b_)],
            )
            b.part(
                name,
                [
                    box((a, y + 0.4 * thickness, z), (b_, y + thickness, z + 0.09))
                    for z in (foot + 0.12 * height, 0.75 * height)
                ],
            )
        edge = a if side[0] < 0 else b_
        b.hinge(
            name,
            parent="posts",
            axis=np.cross(-Y, side),
            pivot=(edge, y + (1 - b.style.line) * thickness, 0.5 * height),
            upper=b.draw(1.2, 1.6),
        )


@kind(
    "house shutters",
    like="shutters",
    width=length(0.7, 1.4),
    height=length(0.8, 1.6),
    thickness=length(0.02, 0.04),
)
def house_shutters(b: ObjectBuilder, width: float, height: float, thickness: float) -> None:
    """Two leaves before a wall beside a window, shut or folded back."""
    for x in (-0.5 * width - 0.6, 0.5 * width):
        b.part("wall", box((x, 0, -0.4), (x + 0.6, 0.25, height + 0.3)), look="wood")
    for z in (-0.4, height):
        b.part("wall", slab(width / 2 + 0.6, (0, 0.25), (z, z + (0.4 if z < 0 else 0.3))))
    if b.maybe():
        b.part("wall", slab(width / 2, (0.12, 0.14), (0, height)))
    for k, side in enumerate((-X, X)):
        a, b_ = ((-width / 2, 0), (0, width / 2))[k]
        if b.maybe(0.7):
            leaf(
                b,
                f"shutter_{k}",
                parent="wall",
                lower=(a, -thickness, 0),
                upper=(b_, 0, height),
                hinge=side,
                reach=b.draw(2.5, 3),
                glazed=0.5,
            )
        else:
            slats = b.count(5, 12)
            g = max(b.gap(0.3), 0)
            b.part(
                f"shutter_{k}",
                [
                    beam(0.9 * thickness, 0.06, (a + g, -g - thickness / 2, z), (b_ - g, -g - thickness / 2, z), Z)
                    for z in spread(slats, 0, height)
                ],
            )
            b.part(
                f"shutter_{k}", [box((x, -thickness - g, 0), (x + 0.04, -g, height)) for x in (a + g, b_ - g - 0.04)]
            )
            edge = vector(a + g if k == 0 else b_ - g, -g - b.style.line * thickness, height / 2)
            b.hinge(f"shutter_{k}", parent="wall", axis=np.cross(-Y, side), pivot=edge, upper=b.draw(2.5, 3))


@kind(
    "pane window",
    like="window",
    number=whole(1, 3, words="sash, pane, casement"),
    width=length(0.4, 0.9),
    height=length(0.5, 1.5),
    thickness=length(0.02, 0.05),
    kind=choice(("side", "side", "top", "bottom", "pivot")),
)
def pane_window(b: ObjectBuilder, number: int, width: float, height: float, thickness: float, kind: str) -> None:
    """One to three panes in a frame: hinged at a side, above, below, or about their middle; some stand fast."""
    surround(b, "frame", wide=number * width, low=0.0, high=height, front=-thickness, sill=True)
    for x in spread(number - 1, -number * width / 2 + width / 2, number * width / 2 - width / 2):
        b.part("frame", box((x - 0.02, -thickness, 0), (x + 0.02, 0.03, height)))
    moving = b.count(0, number - 1)
    for k, x in enumerate(spread(number, -number * width / 2, number * width / 2)):
        a = x - width / 2 + 0.02 * (k > 0)
        b_ = x + width / 2 - 0.02 * (k < number - 1)
        name = f"sash_{k}"
        if k != moving and b.maybe(0.3):
            b.part("frame", box((a, -0.6 * thickness, 0), (b_, -0.4 * thickness, height)))
        elif kind == "pivot":
            play = max(seam(b, width, thickness), 0.001)
            pane(b, name, lower=(a + play, -thickness, play), upper=(b_ - play, 0.0, height - play))
            level = 0.5 * height
            b.hinge(
                name,
                parent="frame",
                axis=X,
                pivot=((a + b_) / 2, -thickness / 2, level),
                upper=b.draw(0.6, 1.5),
                ajar=False,
            )
        else:
            hinge = {"side": b.pick(X, -X), "top": Z, "bottom": -Z}[kind]
            leaf(
                b,
                name,
                parent="frame",
                lower=(a, -thickness, 0),
                upper=(b_, 0, height),
                hinge=hinge,
                inset=True,
                glazed=0.8,
                reach=b.draw(0.8, 1.7) if kind == "side" else b.draw(0.2, 0.9),
            )


@kind(
    "plain sliding window",
    like="sash_window",
    width=length(0.7, 1.8),
    height=length(0.6, 1.5),
    thickness=length(0.02, 0.04),
    upright=yes(0.4),
    lap=length(0.02, 0.05),
    still=yes(0.4),
)
def plain_sliding_window(
    b: ObjectBuilder, width: float, height: float, thickness: float, upright: bool, lap: float, still: bool
) -> None:
    """Sashes in two planes, side by side or one above the other; one or both slide."""
    surround(b, "frame", wide=width, low=0.0, high=height, front=-thickness, sill=True)
    play = seam(b, 0.5, thickness)
    for k in range(2):
        y = -thickness + k * (thickness + max(play, 0))
        share = 0.5 * (height if upright else width)
        a, b_ = (play, share + lap / 2) if k == 0 else (share - lap / 2, 2 * share - play)
        corners = (
            ((-width / 2 + play, y, a), (width / 2 - play, y + thickness, b_))
            if upright
            else ((-width / 2 + a, y, play), (-width / 2 + b_, y + thickness, height - play))
        )
        if k == 1 and still:
            b.part("frame", box(corners[0], corners[1]))
        else:
            name = f"sash_{k}"
            pane(b, name, lower=corners[0], upper=corners[1])
            s = 1 if k == 0 else -1
            b.slide(name, parent="frame", axis=s * (Z if upright else X), upper=b.draw(0.75, 0.9) * (share - lap))


@kind(
    "double door",
    like="door",
    width=length(1.1, 2.2),
    height=length(1.9, 2.6),
    thickness=length(0.03, 0.08),
    reach=angle(1.2, 2.2),
)
def double_door(b: ObjectBuilder, width: float, height: float, thickness: float, reach: float) -> None:
    """Two leaves that meet in the middle, of one width or one narrow."""
    low = b.pick(0, 0, 0.02)
    surround(b, "frame", wide=width, low=low, high=height, front=-thickness, sill=b.maybe(0.3))
    middle = b.pick(0, 0, b.draw(-0.15, 0.15) * width)
    for k, (side, edge) in enumerate(((-X, -width / 2), (X, width / 2))):
        leaf(
            b,
            f"leaf_{k}",
            parent="frame",
            lower=(edge, -thickness, low),
            upper=(middle, 0, height),
            hinge=side,
            inset=True,
            reach=reach,
            glazed=0.25,
        )


@kind(
    "folding door",
    like="door",
    number=whole(2, 4, words="panel, leaf, fold"),
    width=length(0.35, 0.6),
    height=length(1.6, 2.2),
    thickness=length(0.02, 0.04),
    stands=yes(0.5),
)
def folding_door(b: ObjectBuilder, number: int, width: float, height: float, thickness: float, stands: bool) -> None:
    """Two to four narrow leaves that hang on each other: a bifold door or a screen."""
    if stands:
        surround(b, "frame", wide=number * width, low=0.0, high=height, front=-thickness, sill=False)
    else:
        pane(b, "frame", lower=(-number * width / 2 - width, -thickness, 0.0), upper=(-number * width / 2, 0.0, height))
    parent = "frame"
    for k in range(number if not stands else 2):
        x = -number * width / 2 + k * width
        leaf(
            b,
            f"leaf_{k}",
            parent=parent,
            lower=(x, -thickness, 0.0),
            upper=(x + width, 0.0, height),
            hinge=-X,
            out=Y if k % 2 else -Y,
            inset=True,
            reach=1.5 if k == 0 else 2.8,
            handle=k == 1,
            glazed=0.25,
        )
        parent = f"leaf_{k}"


@kind(
    "sliding room door",
    like="door",
    width=length(0.8, 1.3),
    height=length(1.9, 2.3),
    thickness=length(0.03, 0.05),
    number=whole(1, 2, words="leaf, panel"),
)
def sliding_room_door(b: ObjectBuilder, width: float, height: float, thickness: float, number: int) -> None:
    """A leaf or two before a wall or behind it, on a rail or on nothing."""
    half = width * number
    for s in (-1, 1):
        if number == 2 or s > 0:
            b.part(
                "wall",
                box((s * width * number / 2, 0, 0), (s * (half + width), b.draw(0.08, 0.2), height + 0.3)),
                look="wood",
            )
        else:
            b.part(
                "wall", box((-width * number / 2, 0, 0), (-width * number / 2 - 0.1, b.draw(0.08, 0.2), height + 0.3))
            )
    b.part("wall", box((-half, 0, height), (half + 0.05, 0.1, height + 0.3)))
    if b.maybe():
        b.part("wall", box((-half - 0.5 * width * (number - 1), 0, 0), (half + 0.5 * width, 0.1, -0.02)))
    play = seam(b, 0.5, thickness)
    for k in range(number):
        s = 1 if k == number - 1 else -1
        a = s * -0.02 if number == 2 else -width / 2
        b_ = s * (width if number == 2 else width / 2)
        if number == 2:
            a = s * max(play, 0)
        pane(b, f"leaf_{k}", lower=(a, -thickness - play, 0.005), upper=(b_, -play, height + 0.03))
        grip(
            b, f"leaf_{k}", at=(a + s * 0.1, -thickness - play, 0.5 * height), out=-Y, along=Z, length=b.draw(0.1, 0.4)
        )
        b.slide(f"leaf_{k}", parent="wall", axis=s * X, upper=b.draw(0.7, 0.95) * width)
    if b.maybe(0.5):
        b.part(
            "wall",
            b.cylinder(
                0.02,
                (-half, -thickness - play - 0.03, height + 0.15),
                (half + width, -thickness - play - 0.03, height + 0.15),
            ),
            box((half - 0.02, -thickness - play - 0.05, height + 0.12), (half + 0.02, 0.02, height + 0.18)),
        )
