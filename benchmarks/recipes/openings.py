"""Doors, gates, shutters and windows as plain leaves in plain frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import knob, lever
from benchmarks.recipes.object_builder import spread
from benchmarks.recipes.panels import pane, pull, seam, slab, surround
from benchmarks.recipes.shapes import X, Y, Z, beam, box, rod

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def room_door(d: ObjectBuilder) -> None:
    """One leaf in a frame, in a wall or between posts; now and then its handle turns."""
    w, h, t, low = d.u(0.65, 1.2), d.u(1.8, 2.4), d.u(0.025, 0.07), d.pick(0.0, 0.0, 0.015)
    surround(d, "frame", w, low, h, -t, sill=d.maybe(0.3))
    side = d.pick(X, -X)
    turning = d.maybe(0.3)
    slab(d, "leaf", "frame", (-w / 2, -t, low), (w / 2, 0, h), hinge=side, inset=True, reach=d.u(1.2, 2.4),
        back=d.pick(0.0, 0.0, 0.0, 0.0 if d.hand.has_bore else 1.4), handle=not turning)
    if turning:
        at = -0.42 * w * side - t * Y + 0.48 * h * Z
        if d.maybe():
            lever(d, "handle", "leaf", at, -Y, side, d.u(0.1, 0.16), reach=d.u(0.5, 1.0))
        else:
            knob(d, "handle", "leaf", at, 0.03, 0.06, -Y, reach=d.u(0.7, 1.6))


def double_door(d: ObjectBuilder) -> None:
    """Two leaves that meet in the middle, of one width or one narrow."""
    w, h, t, low = d.u(1.1, 2.2), d.u(1.9, 2.6), d.u(0.03, 0.08), d.pick(0.0, 0.0, 0.02)
    surround(d, "frame", w, low, h, -t, sill=d.maybe(0.3))
    middle = d.pick(0.0, 0.0, d.u(-0.15, 0.15) * w)
    reach = d.u(1.2, 2.2)
    for k, (side, edge) in enumerate(((-X, -w / 2), (X, w / 2))):
        slab(d, f"leaf_{k}", "frame", (edge, -t, low), (middle, 0, h), hinge=side, inset=True, reach=reach)


def dutch_door(d: ObjectBuilder) -> None:
    """A leaf that is cut across: the halves turn alone."""
    w, h, t = d.u(0.7, 1.1), d.u(1.9, 2.2), d.u(0.03, 0.06)
    surround(d, "frame", w, 0.0, h, -t, sill=d.maybe(0.3))
    level = d.u(0.4, 0.6) * h
    side = d.pick(X, -X)
    for name, a, b in (("lower_leaf", 0.0, level), ("upper_leaf", level, h)):
        slab(d, name, "frame", (-w / 2, -t, a), (w / 2, 0, b), hinge=side, inset=True, reach=d.u(1.4, 2.2))


def sliding_room_door(d: ObjectBuilder) -> None:
    """A leaf or two before a wall or behind it, on a rail or on nothing."""
    w, h, t = d.u(0.8, 1.3), d.u(1.9, 2.3), d.u(0.03, 0.05)
    n = d.n(1, 2)
    half = w * n
    for s in (-1.0, 1.0):
        if n == 2 or s > 0:
            d.part("wall", box((s * w * n / 2, 0, 0), (s * (half + w), d.u(0.08, 0.2), h + 0.3)), material="wood")
        else:
            d.part("wall", box((-w * n / 2, 0, 0), (-w * n / 2 - 0.1, d.u(0.08, 0.2), h + 0.3)))
    d.part("wall", box((-half, 0, h), (half + 0.05, 0.1, h + 0.3)))
    if d.maybe():
        d.part("wall", box((-half - 0.5 * w * (n - 1), 0, 0), (half + 0.5 * w, 0.1, -0.02)))
    play = seam(d, 0.5, t)
    for k in range(n):
        s = 1.0 if k == n - 1 else -1.0
        a, b = (s * -0.02 if n == 2 else -w / 2), s * (w if n == 2 else w / 2)
        if n == 2:
            a = s * max(play, 0.0)
        pane(d, f"leaf_{k}", (a, -t - play, 0.005), (b, -play, h + 0.03))
        pull(d, f"leaf_{k}", (a + s * 0.1, -t - play, 0.5 * h), -Y, Z, 0.5)
        d.slide(f"leaf_{k}", "wall", s * X, d.u(0.7, 0.95) * w)
    if d.maybe(0.5):
        d.part("wall", rod(0.02, (-half, -t - play - 0.03, h + 0.15), (half + w, -t - play - 0.03, h + 0.15)),
            box((half - 0.02, -t - play - 0.05, h + 0.12), (half + 0.02, 0.02, h + 0.18)))


def folding_door(d: ObjectBuilder) -> None:
    """Two to four narrow leaves that hang on each other: a bifold door or a screen."""
    n, w, h, t = d.n(2, 4), d.u(0.35, 0.6), d.u(1.6, 2.2), d.u(0.02, 0.04)
    stands = d.maybe()
    if stands:
        surround(d, "frame", n * w, 0.0, h, -t, sill=False)
    else:
        pane(d, "frame", (-n * w / 2 - w, -t, 0.0), (-n * w / 2, 0.0, h))
    parent = "frame"
    for k in range(n if not stands else 2):
        x = -n * w / 2 + k * w
        slab(d, f"leaf_{k}", parent, (x, -t, 0.0), (x + w, 0.0, h), hinge=-X, out=Y if k % 2 else -Y, inset=True,
            reach=1.5 if k == 0 else 2.8, handle=k == 1)
        parent = f"leaf_{k}"


def slab_garage_door(d: ObjectBuilder) -> None:
    """A plate before or in an opening that tilts about its upper edge or its middle, or is pushed up."""
    w, h, t = d.u(2.2, 3.0), d.u(1.9, 2.4), d.u(0.03, 0.08)
    kind = d.pick("top", "middle", "slides")
    surround(d, "wall", w, 0.0, h, -t if kind != "slides" else 0.0, sill=False)
    if kind == "top":
        slab(d, "door", "wall", (-w / 2, -t, 0), (w / 2, 0, h), hinge=Z, inset=True, reach=d.u(1.2, 1.57), glazed=0.0)
        return
    play = max(seam(d, 1.0, t), 0.003 if kind == "middle" else -1.0)
    if kind == "slides":
        d.part("door", box((-w / 2 - 0.05, -t - play, 0), (w / 2 + 0.05, -play, h + 0.05)), material="metal")
    else:
        d.part("door", box((-w / 2 + play, -t, 0.01), (w / 2 - play, 0, h - 0.15)), material="metal")
    for z in spread(d.n(1, 5), 0.0, h - 0.15):  # ribs
        d.part("door", box((-0.45 * w, -t - play - 0.015, z - 0.04), (0.45 * w, -t - play + 0.005, z + 0.04)))
    if kind == "slides":
        d.slide("door", "wall", Z, d.u(0.7, 0.95) * h)
    else:
        middle = d.u(0.45, 0.55) * (h - 0.15)
        d.hinge("door", "wall", X, (0, -0.5 * t, middle), 1.3, initial_opening=False)


def slab_gate(d: ObjectBuilder) -> None:
    """One or two leaves of boards between posts or in a fence."""
    w, h, t, n = d.u(0.8, 1.3), d.u(0.8, 1.9), d.u(0.02, 0.06), d.n(1, 2)
    post = d.u(0.06, 0.25)
    for s in (-1.0, 1.0):
        a = s * n * w / 2
        d.part("posts", box((a, -post / 2, 0), (a + s * post, post / 2, h * d.u(1.0, 1.15))), material="wood")
        if d.maybe(0.4):
            d.part("posts", *(box((a + 0.5 * s * post, -0.02, z), (a + s * d.u(0.8, 1.5), 0.02, z + 0.08))
                for z in (0.2 * h, 0.75 * h)))
    d.part("posts", box((-n * w / 2 - post, -post / 2, -0.1), (n * w / 2 + post, post / 2, 0.0)))
    foot = d.u(0.02, 0.1)
    y = d.pick(-post / 2, -t / 2)
    play = seam(d, w, t)
    for k in range(n):
        s = -1.0 if k == 0 and d.maybe() else 1.0
        side = (-X, X)[k] if n == 2 else s * X
        a, b = (-w * n / 2, w / 2) if n == 1 else ((-w, 0.0), (0.0, w))[k]
        a, b = a + play, b - max(play, 0.0)
        name = f"leaf_{k}"
        if d.maybe():
            d.part(name, box((a, y, foot), (b, y + t, h)), material="wood")
        else:
            boards = d.n(4, 9)
            wide = (b - a) / boards * d.u(0.5, 0.95)
            d.part(name, *(box((x - wide / 2, y, foot), (x + wide / 2, y + t, h)) for x in spread(boards, a, b)))
            d.part(name, *(box((a, y + 0.4 * t, z), (b, y + t, z + 0.09)) for z in (foot + 0.12 * h, 0.75 * h)))
        edge = a if side[0] < 0 else b
        d.hinge(name, "posts", np.cross(-Y, side), (edge, y + (1.0 - d.hand.line) * t, 0.5 * h), d.u(1.2, 1.6))


def house_shutters(d: ObjectBuilder) -> None:
    """Two leaves before a wall beside a window, shut or folded back."""
    w, h, t = d.u(0.7, 1.4), d.u(0.8, 1.6), d.u(0.02, 0.04)
    for x in (-0.5 * w - 0.6, 0.5 * w):
        d.part("wall", box((x, 0, -0.4), (x + 0.6, 0.25, h + 0.3)), material="wood")
    for z in (-0.4, h):
        d.part("wall", box((-w / 2 - 0.6, 0, z), (w / 2 + 0.6, 0.25, z + (0.4 if z < 0 else 0.3))))
    if d.maybe():
        d.part("wall", box((-w / 2, 0.12, 0), (w / 2, 0.14, h)))
    for k, side in enumerate((-X, X)):
        a, b = ((-w / 2, 0.0), (0.0, w / 2))[k]
        if d.maybe(0.7):
            slab(d, f"shutter_{k}", "wall", (a, -t, 0), (b, 0, h), hinge=side, reach=d.u(2.5, 3.0), glazed=0.5)
        else:
            slats = d.n(5, 12)
            g = max(d.gap(0.3), 0.0)
            d.part(f"shutter_{k}", *(beam(0.9 * t, 0.06, (a + g, -g - t / 2, z), (b - g, -g - t / 2, z), Z)
                for z in spread(slats, 0, h)))
            d.part(f"shutter_{k}", *(box((x, -t - g, 0), (x + 0.04, -g, h)) for x in (a + g, b - g - 0.04)))
            edge = np.array([a + g if k == 0 else b - g, -g - d.hand.line * t, h / 2])
            d.hinge(f"shutter_{k}", "wall", np.cross(-Y, side), edge, d.u(2.5, 3.0))


def pane_window(d: ObjectBuilder) -> None:
    """One to three panes in a frame: hinged at a side, above, below, or about their middle; some stand fast."""
    n, w, h, t = d.n(1, 3), d.u(0.4, 0.9), d.u(0.5, 1.5), d.u(0.02, 0.05)
    surround(d, "frame", n * w, 0.0, h, -t, sill=True)
    for x in spread(n - 1, -n * w / 2 + w / 2, n * w / 2 - w / 2):
        d.part("frame", box((x - 0.02, -t, 0), (x + 0.02, 0.03, h)))
    kind = d.pick("side", "side", "top", "bottom", "pivot")
    moving = d.n(0, n - 1)
    for k, x in enumerate(spread(n, -n * w / 2, n * w / 2)):
        a, b = x - w / 2 + 0.02 * (k > 0), x + w / 2 - 0.02 * (k < n - 1)
        name = f"sash_{k}"
        if k != moving and d.maybe(0.3):
            d.part("frame", box((a, -0.6 * t, 0), (b, -0.4 * t, h)))
        elif kind == "pivot":
            play = max(seam(d, w, t), 0.001)
            pane(d, name, (a + play, -t, play), (b - play, 0.0, h - play))
            level = 0.5 * h
            d.hinge(name, "frame", X, ((a + b) / 2, -t / 2, level), d.u(0.6, 1.5), initial_opening=False)
        else:
            hinge = {"side": d.pick(X, -X), "top": Z, "bottom": -Z}[kind]
            slab(d, name, "frame", (a, -t, 0), (b, 0, h), hinge=hinge, inset=True, glazed=0.8,
                reach=d.u(0.8, 1.7) if kind == "side" else d.u(0.2, 0.9))


def plain_sliding_window(d: ObjectBuilder) -> None:
    """Sashes in two planes, side by side or one above the other; one or both slide."""
    w, h, t = d.u(0.7, 1.8), d.u(0.6, 1.5), d.u(0.02, 0.04)
    upright = d.maybe(0.4)
    surround(d, "frame", w, 0.0, h, -t, sill=True)
    lap = d.u(0.02, 0.05)
    still = d.maybe(0.4)
    play = seam(d, 0.5, t)
    for k in range(2):
        y = -t + k * (t + max(play, 0.0))
        share = 0.5 * (h if upright else w)
        a, b = (play, share + lap / 2) if k == 0 else (share - lap / 2, 2 * share - play)
        corners = ((-w / 2 + play, y, a), (w / 2 - play, y + t, b)) if upright else (
            (-w / 2 + a, y, play), (-w / 2 + b, y + t, h - play))
        if k == 1 and still:
            d.part("frame", box(*corners))
            continue
        name = f"sash_{k}"
        pane(d, name, *corners)
        s = 1.0 if k == 0 else -1.0
        d.slide(name, "frame", s * (Z if upright else X), d.u(0.75, 0.9) * (share - lap))


def floor_hatch(d: ObjectBuilder) -> None:
    """A flap in a floor, a deck or a roof, flush or on its rim."""
    w, t, high = d.u(0.5, 1.0), d.u(0.5, 0.9), d.u(0.02, 0.06)
    rim = d.u(0.1, 0.5)
    for s in (-1.0, 1.0):
        d.part("deck", box((s * w / 2, -t / 2 - rim, -0.08), (s * (w / 2 + rim), t / 2 + rim, 0)),
            box((-w / 2, s * t / 2, -0.08), (w / 2, s * (t / 2 + rim), 0)), material="wood")
    flush = d.maybe()
    lift = -high if flush else 0.0
    edge = 0.0 if flush else 0.03
    slab(d, "flap", "deck", (-w / 2 - edge, -t / 2 - edge, lift), (w / 2 + edge, t / 2 + edge, lift + high),
        hinge=d.pick(X, -X, Y, -Y), out=Z, inset=flush, reach=d.u(1.2, 1.9), glazed=0.15)
