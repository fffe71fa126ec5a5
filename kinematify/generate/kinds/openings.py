"""Doors, gates, windows and shutters as others model them."""

from __future__ import annotations

from kinematify.generate.library.builder import ObjectBuilder
from kinematify.generate.library.kind import kind, yes
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.solids import X, Y, Z, box, slab


def surround(d: ObjectBuilder, name: str, wide: float, low: float, high: float, front: float, *, sill: bool) -> None:
    """Return what a leaf closes: a frame, a wall with an opening, or two posts, from `front` backward."""
    kind = d.pick("frame", "frame", "wall", "posts")
    side = d.draw(0.3, 1.0) if kind == "wall" else d.draw(0.03, 0.12)
    back = front + d.draw(0.05, 0.2)
    for s in (-1.0, 1.0):
        d.part(name, box((s * wide / 2, front, low), (s * (wide / 2 + side), back, high)), look="wood")
    if kind != "posts":
        d.part(name, slab(wide / 2 + side, (front, back), (high, high + side)))
    if sill or d.maybe(0.2):
        d.part(name, slab(wide / 2 + side, (front, back), (low - d.draw(0.02, 0.06), low)))
    elif kind == "posts":
        d.part(name, slab(wide / 2 + side, (front, back), (low - 0.05, low - d.draw(0.0, 0.02) - 0.01)))
        for s in (-1.0, 1.0):
            d.part(name, box((s * wide / 2, front, low - 0.05), (s * (wide / 2 + side), back, low)))
    if kind == "frame" and d.maybe(0.3):  # a trim around it, on the far side
        trim = side + d.draw(0.02, 0.05)
        for s in (-1.0, 1.0):
            d.part(name, box((s * wide / 2, back - 0.01, low), (s * (wide / 2 + trim), back + 0.01, high)))
        d.part(name, slab(wide / 2 + trim, (back - 0.01, back + 0.01), (high, high + trim)))


@kind(words="stable door, half door, split door", width=(0.7, 1.1), height=(1.9, 2.2), thickness=(0.03, 0.06))
def dutch_door(b: ObjectBuilder, width: float, height: float, thickness: float) -> None:
    """A leaf that is cut across: the halves turn alone."""
    surround(b, "frame", wide=width, low=0.0, high=height, front=-thickness, sill=b.maybe(0.3))
    level = b.draw(0.4, 0.6) * height
    side = b.pick(X, -X)
    for name, a, b_ in (("lower_leaf", 0, level), ("upper_leaf", level, height)):
        leaf(
            b,
            name,
            "frame",
            (-width / 2, -thickness, a),
            (width / 2, 0, b_),
            hinge=side,
            inset=True,
            reach=b.draw(1.4, 2.2),
            glazed=0.25,
        )


@kind(
    words="hatch, trapdoor, trap door, roof hatch, deck hatch, attic hatch, loft hatch",
    width=(0.5, 1.0),
    depth=(0.5, 0.9),
    high=(0.02, 0.06),
    rim=(0.1, 0.5),
    flush=yes(0.5),
)
def floor_hatch(b: ObjectBuilder, width: float, depth: float, high: float, rim: float, flush: bool) -> None:
    """A flap in a floor, a deck or a roof, flush or on its rim."""
    for s in (-1, 1):
        b.part(
            "deck",
            slab((s * width / 2, s * (width / 2 + rim)), depth / 2 + rim, (-0.08, 0)),
            slab(width / 2, (s * depth / 2, s * (depth / 2 + rim)), (-0.08, 0)),
            look="wood",
        )
    lift = -high if flush else 0
    edge = 0 if flush else 0.03
    leaf(
        b,
        "flap",
        "deck",
        (-width / 2 - edge, -depth / 2 - edge, lift),
        (width / 2 + edge, depth / 2 + edge, lift + high),
        hinge=b.pick(X, -X, Y, -Y),
        out=Z,
        inset=flush,
        reach=b.draw(1.2, 1.9),
        glazed=0.15,
    )
