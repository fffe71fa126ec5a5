"""Doors, gates, windows and shutters as others model them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.library.kind import angle, kind, length, whole, yes
from kinematify.generate.library.panels import grip, leaf, pane, seam
from kinematify.generate.procedural.solids import X, Y, Z, box

if TYPE_CHECKING:
    from kinematify.generate.library.builder import ObjectBuilder


def surround(d: ObjectBuilder, name: str, wide: float, low: float, high: float, front: float, *, sill: bool) -> None:
    """Return what a leaf closes: a frame, a wall with an opening, or two posts, from `front` backward."""
    kind = d.pick("frame", "frame", "wall", "posts")
    side = d.draw(0.3, 1.0) if kind == "wall" else d.draw(0.03, 0.12)
    back = front + d.draw(0.05, 0.2)
    for s in (-1.0, 1.0):
        d.part(name, box((s * wide / 2, front, low), (s * (wide / 2 + side), back, high)), material="wood")
    if kind != "posts":
        d.part(name, box((-wide / 2 - side, front, high), (wide / 2 + side, back, high + side)))
    if sill or d.maybe(0.2):
        d.part(name, box((-wide / 2 - side, front, low - d.draw(0.02, 0.06)), (wide / 2 + side, back, low)))
    elif kind == "posts":
        d.part(
            name, box((-wide / 2 - side, front, low - 0.05), (wide / 2 + side, back, low - d.draw(0.0, 0.02) - 0.01))
        )
        for s in (-1.0, 1.0):
            d.part(name, box((s * wide / 2, front, low - 0.05), (s * (wide / 2 + side), back, low)))
    if kind == "frame" and d.maybe(0.3):  # a trim around it, on the far side
        trim = side + d.draw(0.02, 0.05)
        for s in (-1.0, 1.0):
            d.part(name, box((s * wide / 2, back - 0.01, low), (s * (wide / 2 + trim), back + 0.01, high)))
        d.part(name, box((-wide / 2 - trim, back - 0.01, high), (wide / 2 + trim, back + 0.01, high + trim)))


@kind(
    "double door",
    words=("french doors, double leaf door, french door, saloon doors, swing doors, pair of doors, two leaf door"),
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
    "dutch door",
    words="stable door, half door, split door",
    width=length(0.7, 1.1),
    height=length(1.9, 2.2),
    thickness=length(0.03, 0.06),
)
def dutch_door(b: ObjectBuilder, width: float, height: float, thickness: float) -> None:
    """A leaf that is cut across: the halves turn alone."""
    surround(b, "frame", wide=width, low=0.0, high=height, front=-thickness, sill=b.maybe(0.3))
    level = b.draw(0.4, 0.6) * height
    side = b.pick(X, -X)
    for name, a, b_ in (("lower_leaf", 0, level), ("upper_leaf", level, height)):
        leaf(
            b,
            name,
            parent="frame",
            lower=(-width / 2, -thickness, a),
            upper=(width / 2, 0, b_),
            hinge=side,
            inset=True,
            reach=b.draw(1.4, 2.2),
            glazed=0.25,
        )


@kind(
    "sliding room door",
    words="sliding door, barn door, pocket door, patio door, sliding barn door",
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
                material="wood",
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


@kind(
    "folding door",
    words="bifold door, accordion door, bi-fold door, concertina door",
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
    "floor hatch",
    words="hatch, trapdoor, trap door, roof hatch, deck hatch, attic hatch",
    width=length(0.5, 1.0),
    depth=length(0.5, 0.9),
    high=length(0.02, 0.06),
    rim=length(0.1, 0.5),
    flush=yes(0.5),
)
def floor_hatch(b: ObjectBuilder, width: float, depth: float, high: float, rim: float, flush: bool) -> None:
    """A flap in a floor, a deck or a roof, flush or on its rim."""
    for s in (-1, 1):
        b.part(
            "deck",
            box((s * width / 2, -depth / 2 - rim, -0.08), (s * (width / 2 + rim), depth / 2 + rim, 0)),
            box((-width / 2, s * depth / 2, -0.08), (width / 2, s * (depth / 2 + rim), 0)),
            material="wood",
        )
    lift = -high if flush else 0
    edge = 0 if flush else 0.03
    leaf(
        b,
        "flap",
        parent="deck",
        lower=(-width / 2 - edge, -depth / 2 - edge, lift),
        upper=(width / 2 + edge, depth / 2 + edge, lift + high),
        hinge=b.pick(X, -X, Y, -Y),
        out=Z,
        inset=flush,
        reach=b.draw(1.2, 1.9),
        glazed=0.15,
    )
