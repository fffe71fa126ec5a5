"""Doors, gates, windows and shutters as others model them."""

from __future__ import annotations

from kinematify.generate.library.kind import kind, length, whole, yes
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
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
    words="hatch, trapdoor, roof hatch, deck hatch, attic hatch, loft hatch",
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


@kind(
    "garden gate",
    words="yard gate, fence gate, side gate, picket gate, wicket gate",
    usual={"double gate, double garden gate": {"leaves": 2, "width": 2.4}},
    width=length(0.6, 4, default=1.0, usual=(0.8, 1.4)),
    height=length(0.6, 2, default=1.1, usual=(0.9, 1.4)),
    leaves=whole(1, 2, words="leaf, wing, door"),
    pickets=whole(2, 24, default=7, words="picket, bar, slat, board", help="Of every leaf."),
    styles=False,
)
def gate(b: ObjectBuilder, width: float, height: float, leaves: int, pickets: int) -> None:
    """Leaves of pickets between two posts, and a bolt."""
    w = width / 2
    b.part(
        "posts",
        [slab((s * w, s * (w + 0.09)), 0.045, (0, height + 0.1)) for s in (-1, 1)],
        slab(w + 0.09, 0.045, (0, 0.02)),
        look="wood",
    )
    g = max(b.gap(0.05), 0.004)
    for k in range(leaves):
        s = 1 - 2 * k
        low, high = sorted((-s * (w - g), s * (w - g) if leaves == 1 else -s * g))
        step = (high - low) / pickets
        b.part(
            f"leaf_{k + 1}",
            [slab((low, high), (-0.03, -0.005), (z, z + 0.08)) for z in (0.2 * height, 0.75 * height)],
            [
                slab((x - 0.3 * step, x + 0.3 * step), (-0.005, 0.015), (0.08, height))
                for x in spread(pickets, low, high)
            ],
            [slab((a, c), (-0.03, 0.015), (0.08, height)) for a, c in ((low, low + 0.05), (high - 0.05, high))],
            look="wood",
        )
        b.hinge(f"leaf_{k + 1}", "posts", -s * Z, (-s * (w - g), -0.03, 0), 1.7)
    # A bolt behind the rail of the last leaf: it reaches into the other post, or behind the other leaf.
    s, end, last = (1, w, "leaf_1") if leaves == 1 else (-1, 0, "leaf_2")
    here, level = end - s * 0.16, 0.75 * height + 0.04
    spans = [(x, x + s * 0.02) for x in (here, here + s * 0.12)]
    guides = [slab(span, (-0.055, -0.029), (level - 0.015, level + 0.015)) for span in spans]
    b.part(last, b.painted(*guides, look="steel"))
    b.part(
        "bolt",
        b.cylinder(0.007, (end + s * 0.05, end - s * 0.2), -0.04, level),
        b.cylinder(0.005, here + s * 0.105, (-0.04, -0.08), level),
        look="steel",
    )
    for name in (last, "posts"):
        b.cut(name, b.cylinder(0.009, (end - s * 0.17, end + s * 0.06), -0.04, level))
    b.slide("bolt", last, -s * X, 0.06)
