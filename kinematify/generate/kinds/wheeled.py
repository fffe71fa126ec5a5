"""Wheels, casters and carts as others model them."""

from __future__ import annotations

from kinematify.generate.library.kind import choice, kind, whole
from kinematify.generate.library.mechanisms import caster, in_fork, legs, wheel
from kinematify.generate.library.panels import leaf, seam
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, box, slab


@kind(
    words=(
        "platform truck, flatbed cart, platform trolley, transport cart, trolley, flatbed trolley, warehouse trolley"
    ),
    width=(0.35, 0.7),
    depth=(0.5, 1.1),
    radius=(0.03, 0.1),
)
def platform_cart(b: ObjectBuilder, width: float, depth: float, radius: float) -> None:
    """A plate with a push bar on fixed wheels in forks and on casters."""
    top = 2.6 * radius
    b.part("deck", slab(width / 2, (0, depth), (top, top + b.draw(0.02, 0.06))), look="wood")
    if b.maybe(0.7):
        h = b.draw(0.6, 1)
        bar = b.draw(0.01, 0.02)
        for s in (-1, 1):
            b.part("deck", b.cylinder(bar, s * 0.42 * width, depth - 0.03, (top, top + h)))
        b.part("deck", b.cylinder(bar, (-0.42 * width, 0.42 * width), depth - 0.03, top + h))
    wide = b.draw(0.3, 0.6) * radius
    for k, s in enumerate((-1, 1)):
        in_fork(b, f"wheel_{k}", "deck", (s * 0.38 * width, 0.85 * depth, radius), radius, wide, top + 0.005)
        if b.maybe():
            caster(b, f"caster_{k}", "deck", (s * 0.38 * width, 0.12 * depth, top), top)
        else:
            in_fork(b, f"front_wheel_{k}", "deck", (s * 0.38 * width, 0.15 * depth, radius), radius, wide, top + 0.005)


@kind(
    words="wheeled box, rolling storage box, laundry cart",
    width=(0.05, 0.8),
    depth=(0.1, 1.4),
    height=(0.05, 0.6),
    number=whole(2, 3, words="axle"),
    form=choice(("beside", "below", "within")),
)
def box_on_wheels(b: ObjectBuilder, width: float, depth: float, height: float, number: int, form: str) -> None:
    """A toy, a cabinet or a carriage: a block with four to six discs at its sides, below it or half in it."""
    r = b.draw(0.15, 0.4) * min(height, depth / number, width)
    wide = b.draw(0.2, 0.7) * r
    foot = {"beside": b.draw(0.3, 1.2) * r, "below": 2.05 * r, "within": b.draw(0.5, 1) * r}[form]
    b.part("box", slab(width / 2, (0, depth), (foot, foot + height)), look="wood")
    if b.maybe(0.4):
        b.part("box", slab(0.4 * width, (0.3 * depth, 0.9 * depth), (foot + height, foot + 1.6 * height)))
    play = seam(b, r, wide)
    if form != "beside" or b.style.has_bore:
        play = max(play, 0.001)
    for i, y in enumerate(spread(number, 0, depth)):
        for s in (-1, 1):
            x = s * (width / 2 + wide / 2 + play) if form == "beside" else s * (width / 2 - 0.6 * wide - play)
            if form == "within":
                reach = r + play
                b.cut("box", box((s * width, y - reach, foot - 1), (x - s * (wide / 2 + play), y + reach, r + reach)))
            wheel(b, f"wheel_{i}_{'left' if s < 0 else 'right'}", "box", (x, y, r), r, wide, s * X)


@kind(
    words="camping table, card table",
    width=(0.5, 1.8),
    depth=(0.4, 0.9),
    height=(0.4, 0.8),
    thick=(0.015, 0.04),
    leg=(0.015, 0.04),
)
def folding_table(b: ObjectBuilder, width: float, depth: float, height: float, thick: float, leg: float) -> None:
    """A plate whose legs fold under it about their upper ends, or that folds itself in two."""
    play = seam(b, depth, thick)
    if b.maybe(0.7):
        b.part("top", slab(width / 2, depth / 2, (height, height + thick)), look="wood")
        for k, s in enumerate((-1, 1)):
            x = s * (width / 2 - b.draw(0.05, 0.12))
            high = height - play
            for y in (-0.42 * depth, 0.42 * depth):
                b.part(f"legs_{k}", box((x - leg / 2, y - leg / 2, 0), (x + leg / 2, y + leg / 2, high)), look="metal")
            for z in (b.draw(0.1, 0.3) * height, high - leg):
                b.part(f"legs_{k}", slab((x - leg / 2, x + leg / 2), 0.42 * depth, (z, z + leg)))
            b.hinge(f"legs_{k}", "top", s * Y, (x - s * leg / 2, 0, high), 1.5, ajar=False)
    else:
        b.part("half", slab((-width / 2, 0), depth / 2, (height, height + thick)), look="wood")
        legs(b, "half", (-width / 2 + 0.02, -depth / 2 + 0.02, 0), (-0.02, depth / 2 - 0.02, height + 0.002), leg)
        leaf(
            b,
            "other_half",
            "half",
            (0, -depth / 2, height),
            (width / 2, depth / 2, height + thick),
            hinge=-X,
            inset=True,
            handle=False,
            out=b.pick(Z, -Z),
            reach=b.draw(1.4, 1.6),
        )


@kind(
    words=(
        "monitor, computer monitor, screen, display, television, tv, flat screen, computer screen, pc monitor, tv set"
    ),
    width=(0.15, 1.2),
    height=(0.12, 0.7),
    thickness=(0.01, 0.06),
    z=(0.05, 0.3),
    kind=choice(("tilts", "swivels", "rises")),
    radius=(0.01, 0.03),
)
def tilting_screen(
    b: ObjectBuilder, width: float, height: float, thickness: float, z: float, kind: str, radius: float
) -> None:
    """A flat screen on a foot or an arm: it tilts, it swivels, or it goes up on a post."""
    b.part("foot", slab(0.25 * width, (-0.1, 0.12), (0, 0.02)), look="metal")
    y = thickness + radius
    post = z + 0.35 * height
    play = seam(b, 2 * radius, radius)
    if kind == "swivels":
        b.part("foot", b.cylinder(2 * radius, 0, y, (0, 0.04)))
        low = 0.04 + play
        b.part(
            "screen",
            b.cylinder(radius, 0, y, (low, post)),
            slab(radius, (0, y), (post - 2 * radius, post + 2 * radius)),
        )
        b.hinge("screen", "foot", Z, (0, y, low), b.draw(0.5, 1.6), lower=-b.draw(0.5, 1.6), ajar=False)
    elif kind == "tilts":
        b.part("foot", slab(radius, (y, y + 2 * radius), (0, post + radius)))
        g = max(play, 0) if b.style.has_bore else play
        b.part("screen", b.rod(radius, (-2 * radius, 2 * radius), y - radius - g, post))
        b.hinge("screen", "foot", X, (0, y - radius - g, post), min(0.3, 2 * radius / height), lower=-0.4, ajar=False)
    else:
        b.part("foot", slab(radius, (y, y + radius), (0, post + 0.2 * height)))
        g = b.gap(radius)
        b.part(
            "screen", slab(2.2 * radius, (thickness - 0.002, y + 2.2 * radius), (post - 3 * radius, post + 3 * radius))
        )
        b.cut(
            "screen",
            slab(radius + g, (y - g, y + radius + g), (0, 10))
            if b.style.has_bore
            else slab(radius, (y, y + radius), (0, 10)),
        )
        b.slide("screen", "foot", Z, b.draw(0.1, 0.3) * height, lower=-0.1 * height, ajar=False)
    b.part("screen", slab(width / 2, (0, thickness), (z, z + height)))
