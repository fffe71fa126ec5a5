"""Things of a household."""

from __future__ import annotations

from kinematify.generate.library.kind import kind, whole
from kinematify.generate.library.mechanisms import bail, button, case, knob, legs, lever
from kinematify.generate.library.panels import drawer, leaf
from kinematify.generate.procedural.builder import ObjectBuilder, spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, block, box, prism, slab, vector


@kind(
    words=(
        "pot, cooking pot, stockpot, stew pot, casserole, dutch oven, soup pot, pasta pot, bean pot, soup tureen, soup "
        "kettle, rice pot"
    ),
    radius=(0.08, 0.18),
    height=(0.06, 0.2),
)
def pot_with_lid(b: ObjectBuilder, radius: float, height: float) -> None:
    """A pot whose lid is lifted off."""
    b.part("pot", b.cylinder(radius, 0, height), look="steel")
    if b.style.hollow:
        b.cut("pot", b.cylinder(0.95 * radius, 0.05 * height, 2 * height))
    for s in (-1, 1):
        b.part("pot", block((s * 1.1 * radius, 0, 0.8 * height), (0.3 * radius, 0.4 * radius, 0.1 * height)))
    g = b.gap(radius)
    b.part(
        "lid",
        b.pick(
            b.cylinder(1.02 * radius, height + g, height + g + 0.006),
            b.cone(1 * radius, 0.3 * radius, height + g, height + g + 0.2 * radius),
        ),
    )
    b.part(
        "lid",
        b.cylinder(0.12 * radius, height + g, height + 0.35 * radius),
        ball(0.18 * radius, (0, 0, height + 0.4 * radius)),
    )
    b.slide("lid", "pot", Z, b.draw(1, 2) * height)


@kind(
    words="tea kettle, electric kettle, water kettle, stovetop kettle, whistling kettle, water boiler",
    radius=(0.07, 0.11),
    height=(0.12, 0.25),
)
def kettle(b: ObjectBuilder, radius: float, height: float) -> None:
    """A lid on a hinge, a bail or a fixed handle, a whistle or switch."""
    b.part(
        "body",
        b.cone(radius, 0.75 * radius, 0, height),
        b.cone(0.25 * radius, 0.12 * radius, (0.6 * radius, 0, 0.5 * height), (1.5 * radius, 0, 0.9 * height)),
        look="steel",
    )
    g = b.gap(radius)
    b.part(
        "lid",
        b.cylinder(0.72 * radius, height + g, height + 0.01 + g),
        b.cylinder(0.1 * radius, height + g, height + 0.03),
    )
    if b.maybe():
        b.hinge("lid", "body", -X, (0, 0.72 * radius, height + g), 1.6)
        b.part(
            "body",
            beam(0.02, 0.03, (-0.8 * radius, 0, 0.9 * height), (-1.6 * radius, 0, 0.85 * height)),
            beam(0.02, 0.03, (-1.6 * radius, 0, 0.9 * height), (-1.5 * radius, 0, 0.3 * height), X),
            beam(0.02, 0.03, (-1.5 * radius, 0, 0.3 * height), (-0.8 * radius, 0, 0.2 * height)),
        )
        lever(b, "switch", "body", (-1.55 * radius, -0.012, 0.6 * height), -Y, X, 0.03, reach=0.4)
    else:
        b.slide("lid", "body", Z, 0.5 * radius)
        bail(
            b,
            "handle",
            "body",
            (0, -0.7 * radius, height * 0.98),
            (0, 0.7 * radius, height * 0.98),
            radius,
            0.012,
            Z,
            lower=-1.0,
            upper=1.0,
        )


@kind(words="jar, preserving jar, storage jar, cookie jar, candy jar", radius=(0.03, 0.07), height=(0.08, 0.2))
def jar_with_clip(b: ObjectBuilder, radius: float, height: float) -> None:
    """A glass jar with a hinged lid, or one that is screwed."""
    b.part("jar", b.cylinder(radius, 0, height), look="glass")
    if b.style.hollow:
        b.cut("jar", b.cylinder(0.9 * radius, 0.05 * height, height + 0.01))
    if b.maybe():
        g = b.gap(radius)
        b.part("lid", b.cylinder(radius, height + g, height + g + 0.012), look="glass")
        b.part("lid", block((0, 1.06 * radius, height + g + 0.006), (0.3 * radius, 0.14 * radius, 0.01)))
        b.hinge("lid", "jar", -X, (0, 1.1 * radius, height + g), 2.0)
    else:
        turns = b.maybe()
        gap = b.gap(radius)
        b.part("jar", b.cylinder(0.8 * radius, height - 0.1 * 0.02, height + 0.75 * 0.02))
        b.part("lid", b.cylinder(radius, height + gap, height + 0.02))
        if b.style.has_bore:
            hole = (0, 0, height - 0.02), (0, 0, height + 0.8 * 0.02 + gap)
            b.cut("lid", b.cylinder(0.8 * radius + 1.5 * gap, *hole))
        if turns:
            b.spin("lid", "jar", Z, (0, 0, height))
        else:
            b.slide("lid", "jar", Z, 0.02)


@kind(
    words="shower, shower rail, hand shower, shower head on a rail, shower set",
    width=(0.2, 0.35),
    radius=(0.018, 0.028),
)
def shower_mixer(b: ObjectBuilder, width: float, radius: float) -> None:
    """A bar on a wall with a knob at either end and a hand shower on a rail."""
    b.part("bar", slab(width, (0.04, 0.06), (-0.1, 1)), b.cylinder(radius, (-width / 2, width / 2), 0, 0), look="steel")
    for s in (-1, 1):
        b.part("bar", b.cylinder(0.7 * radius, s * width / 3, (0, 0.05), 0))
        knob(
            b,
            f"knob_{int(s + 1)}",
            parent="bar",
            at=(s * width / 2, 0, 0),
            radius=1.15 * radius,
            high=2 * radius,
            out=s * X,
            reach=b.pick(None, 1.6),
        )
    b.part(
        "bar", b.cylinder(0.01, 0, -0.02, (0.2, 0.9)), [b.cylinder(0.008, 0, (-0.02, 0.05), z) for z in (0.22, 0.88)]
    )
    g = b.gap(0.01)
    z = b.draw(0.4, 0.7)
    b.part("holder", block((0, -0.02, z), (0.05, 0.05, 0.06)), b.cone(0.02, 0.04, (0, -0.05, z), (0, -0.1, z + 0.03)))
    b.bore("holder", b.cylinder(0.01 + 1.5 * g, 0, -0.02, (0, 1)))
    b.slide("holder", "bar", Z, 0.8 - z, lower=0.28 - z, ajar=False)


@kind(
    words="swing arm towel rail, swivel towel bar",
    height=(0.2, 0.6),
    number=whole(1, 6, usual=(2, 4), words="arm, bar, rail"),
)
def towel_rail(b: ObjectBuilder, height: float, number: int) -> None:
    """Arms that swing about an upright on a wall."""
    b.part(
        "wall_mount",
        slab(0.04, (0.02, 0.04), (0, height)),
        b.cylinder(0.012, 0.03, height - 0.03),
        [slab(0.01, (-0.01, 0.03), (z, z + 0.02)) for z in (0.01, height - 0.03)],
        look="steel",
    )
    step = (height - 0.1) / number
    g = b.gap(0.02)
    for k, z in enumerate(spread(number, 0.05, height - 0.05)):
        b.part(
            f"arm_{k}",
            b.cylinder(0.02, z - 0.4 * step, z + 0.4 * step),
            b.cylinder(0.008, 0, (0, -b.draw(0.25, 0.5)), z),
            look="steel",
        )
        b.bore(f"arm_{k}", b.cylinder(0.012 + 1.5 * g + 0.0005, 0, height))
        b.hinge(f"arm_{k}", "wall_mount", Z, (0, 0, z), 1.2, -1.2)


@kind(words="iron board, ironing table", width=(1.0, 1.4), depth=(0.3, 0.45), height=(0.75, 0.95))
def ironing_board(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """Legs that fold about a pin under a board."""
    b.part("board", slab(width / 2, depth / 2, (height, height + 0.03)), look="steel")
    for x, v in ((0.2 * width, 0.3 * depth), (-0.2 * width, 0.3 * depth - 0.025)):
        b.part("board", [block((x, s * v, height - 0.015), (0.04, 0.02, 0.05)) for s in (-1, 1)])
    y = 0.3 * depth - 0.01 - b.gap(0.02) - 0.01
    for k, (name, inner) in enumerate((("legs", 0.0), ("rear_legs", 0.025))):
        s, at = 1 - 2 * k, y - inner
        bars = [((0.2, side, height - 0.025), (-0.3, side, 0.02)) for side in (-at, at)]
        bars += [
            ((-0.3, -0.4 * depth, 0.02), (-0.3, 0.4 * depth, 0.02)),
            ((-0.2, -at, 0.22 * height), (-0.2, at, 0.22 * height)),
        ]
        b.part(name, [beam(0.02, 0.02, *((s * width * x, v, z) for x, v, z in bar)) for bar in bars])
    if b.style.barrels:
        b.part("legs", b.cylinder(0.006, 0.2 * width, (-0.3 * depth, 0.3 * depth), height - 0.025))
    for s, name in ((1, "legs"), (-1, "rear_legs")):
        pin = (s * 0.2 * width, 0, height - 0.025)
        b.hinge(name, "board", s * Y, pin, 0.4, -0.1, ajar=False)
    b.follow("rear_legs", "legs")


@kind(words="bread box, roll top bread bin", width=(0.3, 0.45), radius=(0.1, 0.16))
def bread_bin(b: ObjectBuilder, width: float, radius: float) -> None:
    """A quarter round lid that rolls back, or a front flap."""
    b.part("bin", slab(width / 2, radius, (0, 0.02)), slab(width / 2, (0.7 * radius, radius), (0, radius)), look="wood")
    for s in (-1, 1):
        b.part("bin", slab((s * width / 2, s * (width / 2 - 0.015)), radius, (0, radius)))
    g = b.gap(0.05) + 0.0005
    half = width / 2 - 0.015 - g
    b.part("lid", b.cylinder(0.98 * radius, (-half, half), -0.2 * radius, 0.05 + g))
    b.cut(
        "lid",
        b.cylinder(0.9 * radius, (-half + 0.01, half - 0.01), -0.2 * radius, 0.05 + g),
        slab(1, (-0.2 * radius, 1), (-1, 0.05 + 0.3 * radius)),
        slab(1, 1, (-1, 0.022 + g)),
    )
    b.cut("lid", slab(1, (0.3 * radius, 1), 1))
    b.hinge("lid", "bin", -X, (0, -0.2 * radius, 0.05 + g), 0.5)


@kind(
    words="knife holder, knife stand",
    width=(0.1, 0.2),
    height=(0.2, 0.28),
    number=whole(1, 8, usual=(3, 6), words="knife"),
)
def knife_block(b: ObjectBuilder, width: float, height: float, number: int) -> None:
    """Knives that are drawn out of a slanted block."""
    b.part(
        "block",
        prism([(-0.1, 0), (0.08, 0), (0.08, 0.6 * height), (-0.02, height)], (0, 0, 0), width, "x"),
        look="wood",
    )
    out = vector(0, 0, 1)
    for k, x in enumerate(spread(number, -0.45 * width, 0.45 * width)):
        y = b.draw(-0.02, 0.02)
        g = b.gap(0.01)
        b.bore("block", box((x - 0.0015 - g, y - 0.015 - g, 0.04), (x + 0.0015 + g, y + 0.015 + g, 2 * height)))
        b.part(f"knife_{k}", box((x - 0.0015, y - 0.015, 0.05), (x + 0.0015, y + 0.015, height + 0.02)), look="steel")
        b.part(
            f"knife_{k}",
            box(
                (x - 0.3 * width / number, y - 0.012, height + 0.01),
                (x + 0.3 * width / number, y + 0.012, height + 0.1),
            ),
        )
        b.slide(f"knife_{k}", "block", out, 0.12)


@kind(radius=(0.07, 0.1))
def food_processor(b: ObjectBuilder, radius: float) -> None:
    """A bowl on a base, a lid, a knob, buttons."""
    case(b, "base", (-0.11, -0.1, 0), (0.11, 0.1, 0.12), material="plastic")
    g = b.gap(radius)
    b.part("bowl", b.cylinder(radius, 0.12 + g, 0.27), look="glass")
    b.hinge("bowl", "base", Z, (0, 0, 0.12), 0.5, ajar=False)
    b.part(
        "lid",
        b.cylinder(1.03 * radius, 0.27 + g, 0.285 + g),
        b.cylinder(0.3 * radius, 0, 0.4 * radius, (0.27 + g, 0.35)),
    )
    b.slide("lid", "bowl", Z, 0.1)
    knob(b, "dial", "base", (0.05, -0.1, 0.07), 0.025, -Y, high=0.02, reach=4.0)
    for k, z in enumerate((0.04, 0.08)):
        button(b, f"button_{k}", "base", (-0.05, -0.1, z), (0.03, 0.02), 0.006, -Y, is_round=b.maybe())


@kind(words="tea urn, coffee urn, samovar, drink dispenser, beverage dispenser", radius=(0.12, 0.18), height=(0.3, 0.5))
def urn(b: ObjectBuilder, radius: float, height: float) -> None:
    """An urn with a spigot."""
    b.part(
        "urn",
        b.cylinder(radius, 0.05, height),
        b.cylinder(0.7 * radius, 0, 0.06),
        b.cylinder(0.012, 0, (-0.8 * radius, -radius - 0.06), 0.1),
        look="steel",
    )
    g = b.gap(radius)
    b.part("lid", b.cone(radius, 0.3 * radius, height + g, height + 0.05), ball(0.02, (0, 0, height + 0.06)))
    b.slide("lid", "urn", Z, 0.15)
    b.part(
        "spigot",
        slab(0.006, (-radius - 0.05, -radius - 0.03), (0.112 + g, 0.16)),
        b.cylinder(0.012, 0, -radius - 0.04, (0.112 + g, 0.12)),
    )
    b.hinge("spigot", "urn", Z, (0, -radius - 0.04, 0.112), 1.57)


@kind(words="venetian blind, blinds", width=(0.5, 1.2), number=whole(2, 40, default=6, usual=(4, 9), words="slat"))
def window_blind(b: ObjectBuilder, width: float, number: int) -> None:
    """Slats that all tilt, and a wand."""
    h = 0.06 * number
    b.part("rail", slab(width / 2, 0.03, (h, h + 0.04)), look="metal")
    for s in (-1, 1):
        b.part("rail", slab((s * width / 2, s * (width / 2 + 0.01)), 0.012, (-0.02, h + 0.02)))
    g = b.gap(0.02) + 0.0003
    for k, z in enumerate(spread(number, 0, h - 0.01)):
        b.part(f"slat_{k}", slab(width / 2 - g, 0.025, (z - 0.001, z + 0.001)), look="metal")
        b.hinge(f"slat_{k}", "rail", X, (0, 0, z), 0.9, -0.9, ajar=False)
        if k:
            b.follow(f"slat_{k}", "slat_0")


@kind(walls=7, words="column fan, oscillating tower fan", height=(0.7, 1.1), radius=(0.06, 0.1))
def tower_fan(b: ObjectBuilder, height: float, radius: float) -> None:
    """A column that swings on its base, with buttons and a dial."""
    b.part("base", b.cylinder(1.8 * radius, 0, 0.03))
    g = b.gap(radius)
    b.part("column", b.cylinder(radius, 0.03 + g, height))
    b.hinge("column", "base", Z, (0, 0, 0.03), 0.7, -0.7, ajar=False)
    for k, x in enumerate(spread(b.count(1, 3), -0.7 * radius, 0.7 * radius)):
        button(b, f"button_{k}", "column", (x, -0.3 * radius, height), (0.015, 0.015), 0.005, Z, is_round=True)
    knob(
        b,
        "timer",
        parent="column",
        at=(0, 0.4 * radius, height),
        radius=0.3 * radius,
        high=0.015,
        out=Z,
        reach=b.pick(None, 4),
    )


@kind(
    words="wood burner, log burner, iron stove, pellet stove, stove with a glass door, wood burning stove",
    width=(0.4, 0.7),
    height=(0.6, 1.0),
)
def wood_stove(b: ObjectBuilder, width: float, height: float) -> None:
    """A wood stove with a glazed door, an ash drawer and a damper."""
    case(b, "stove", (-width / 2, -0.2, 0.1), (width / 2, 0.2, height), material="steel")
    legs(b, "stove", (-width / 2, -0.2, 0), (width / 2, 0.2, 0.105), 0.04)
    b.part("stove", b.cylinder(0.07, 0, 0.05, (height - 0.01, height + 0.4)))
    b.bore("stove", slab(0.35 * width, (-0.3, 0.1), (0.35 * height, 0.85 * height)))
    leaf(
        b,
        "door",
        "stove",
        (-0.4 * width, -0.225, 0.32 * height),
        (0.4 * width, -0.2, 0.88 * height),
        hinge=b.pick(X, -X),
        reach=2.0,
        material="steel",
    )
    drawer(
        b, "ash_drawer", "stove", (-0.3 * width, -0.2, 0.13), (0.3 * width, 0.1, 0.13 + 0.12 * height), material="steel"
    )
    knob(b, "damper", "stove", (0.0715, 0.05, height + 0.2), 0.018, X, high=0.03, reach=1.57)
