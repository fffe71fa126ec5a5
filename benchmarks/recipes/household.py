"""Kitchen, bath, cleaning and small things of a household."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import (
    bail,
    button,
    cap,
    case,
    crank,
    drawer,
    knob,
    leaf,
    legs,
    lever,
    rotor,
)
from benchmarks.recipes.object_builder import spread
from benchmarks.recipes.shapes import X, Y, Z, ball, beam, block, box, capsule, cone, prism, rod

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def pot_with_lid(d: ObjectBuilder) -> None:
    """A pot whose lid is lifted off."""
    r, h = d.u(0.08, 0.18), d.u(0.06, 0.2)
    d.part("pot", rod(r, (0, 0, 0), (0, 0, h)), material="steel")
    if d.hand.hollow:
        d.cut("pot", rod(0.95 * r, (0, 0, 0.05 * h), (0, 0, 2 * h)))
    for s in (-1.0, 1.0):
        d.part("pot", block((s * 1.1 * r, 0, 0.8 * h), (0.3 * r, 0.4 * r, 0.1 * h)))
    g = d.gap(r)
    d.part("lid", d.pick(rod(1.02 * r, (0, 0, h + g), (0, 0, h + g + 0.006)), cone(1.0 * r, 0.3 * r, (0, 0, h + g), (0,
        0, h + g + 0.2 * r))))
    d.part("lid", rod(0.12 * r, (0, 0, h + g), (0, 0, h + 0.35 * r)), ball(0.18 * r, (0, 0, h + 0.4 * r)))
    d.slide("lid", "pot", Z, d.u(1.0, 2.0) * h)


def pedal_bin(d: ObjectBuilder) -> None:
    """A bin with a lid and a pedal."""
    r, h = d.u(0.12, 0.2), d.u(0.3, 0.65)
    shape = d.pick(rod(r, (0, 0, 0), (0, 0, h)), box((-r, -r, 0), (r, r, h)))
    d.part("bin", shape, material="steel")
    if d.hand.hollow:
        d.cut("bin", rod(0.9 * r, (0, 0, 0.02), (0, 0, h + 1)))
    g = d.gap(r)
    d.part("lid", {**shape, **({"length": 0.04} if "length" in shape else {"size": [2 * r, 2 * r, 0.04]}), "xyz": [0, 0,
        h + g + 0.02]})
    d.hinge("lid", "bin", -X, (0, r, h + g), d.u(1.2, 1.6))
    low = 0.02 + d.gap(0.05)
    d.part("pedal", box((-0.03, -r - 0.07, low), (0.03, -r - g - 0.001 if d.hand.has_bore else -0.6 * r, low + 0.012)))
    d.hinge("pedal", "bin", X, (0, -r - g - 0.001 if d.hand.has_bore else -r, low), 0.25, initial_opening=False)


def kettle(d: ObjectBuilder) -> None:
    """A lid on a hinge, a bail or a fixed handle, a whistle or switch."""
    r, h = d.u(0.07, 0.11), d.u(0.12, 0.25)
    d.part("body", cone(r, 0.75 * r, (0, 0, 0), (0, 0, h)), cone(0.25 * r, 0.12 * r, (0.6 * r, 0, 0.5 * h), (1.5 * r, 0,
        0.9 * h)), material="steel")
    g = d.gap(r)
    d.part("lid", rod(0.72 * r, (0, 0, h + g), (0, 0, h + 0.01 + g)), rod(0.1 * r, (0, 0, h + g), (0, 0, h + 0.03)))
    if d.maybe():
        d.hinge("lid", "body", -X, (0, 0.72 * r, h + g), 1.6)
        d.part("body", beam(0.02, 0.03, (-0.8 * r, 0, 0.9 * h), (-1.6 * r, 0, 0.85 * h)), beam(0.02, 0.03, (-1.6 * r, 0,
            0.9 * h), (-1.5 * r, 0, 0.3 * h), X), beam(0.02, 0.03, (-1.5 * r, 0, 0.3 * h), (-0.8 * r, 0, 0.2 * h)))
        lever(d, "switch", "body", (-1.55 * r, -0.012, 0.6 * h), -Y, X, 0.03, reach=0.4)
    else:
        d.slide("lid", "body", Z, 0.5 * r)
        bail(d, "handle", "body", (0, -0.7 * r, h * 0.98), (0, 0.7 * r, h * 0.98), r, 0.012, Z, lower=-1.0, upper=1.0)


def pepper_mill(d: ObjectBuilder) -> None:
    """A head that turns on a body."""
    r, h = d.u(0.02, 0.035), d.u(0.08, 0.3)
    d.part("body", rod(r, (0, 0, 0), (0, 0, 0.3 * h)), cone(r, 0.6 * r, (0, 0, 0.3 * h), (0, 0, 0.7 * h)),
        material="wood")
    g = d.gap(r)
    d.part("head", rod(0.6 * r, (0, 0, 0.7 * h + g), (0, 0, 0.75 * h)), ball(0.95 * r, (0, 0, 0.75 * h + 0.9 * r + g)),
        material="wood")
    if d.maybe(0.3):
        d.part("head", beam(0.01, 0.005, (0, 0, 0.75 * h + 1.8 * r), (2.2 * r, 0, 0.75 * h + 1.8 * r)), rod(0.006,
            (2.2 * r, 0, 0.75 * h + 1.8 * r), (2.2 * r, 0, 0.75 * h + 2.8 * r)))
    d.spin("head", "body", Z, (0, 0, 0.7 * h))


def jar_with_clip(d: ObjectBuilder) -> None:
    """A glass jar with a hinged lid, or one that is screwed."""
    r, h = d.u(0.03, 0.07), d.u(0.08, 0.2)
    d.part("jar", rod(r, (0, 0, 0), (0, 0, h)), material="glass")
    if d.hand.hollow:
        d.cut("jar", rod(0.9 * r, (0, 0, 0.05 * h), (0, 0, h + 0.01)))
    if d.maybe():
        g = d.gap(r)
        d.part("lid", rod(r, (0, 0, h + g), (0, 0, h + g + 0.012)), material="glass")
        d.part("lid", block((0, 1.06 * r, h + g + 0.006), (0.3 * r, 0.14 * r, 0.01)))
        d.hinge("lid", "jar", -X, (0, 1.1 * r, h + g), 2.0)
    else:
        cap(d, "lid", "jar", (0, 0, h), r, 0.02, Z, turns=d.maybe())


def tap(d: ObjectBuilder) -> None:
    """A basin mixer: a lever or two handles, a spout that swings."""
    r, h, reach = d.u(0.018, 0.03), d.u(0.08, 0.3), d.u(0.1, 0.22)
    d.part("base", rod(1.3 * r, (0, 0, 0), (0, 0, 0.02)), rod(r, (0, 0, 0), (0, 0, 0.6 * h)), material="steel")
    swings = d.maybe()
    g = d.gap(r)
    spout = [rod(r, (0, 0, 0.6 * h + g), (0, 0, h)), capsule(0.6 * r, (0, 0, 0.9 * h), (0, -reach, 0.9 * h)),
        rod(0.6 * r, (0, -reach, 0.9 * h), (0, -reach, 0.7 * h))]
    d.part("spout" if swings else "base", *spout, material="steel")
    if not swings:
        d.part("base", rod(0.98 * r, (0, 0, 0.5 * h), (0, 0, 0.7 * h)))
    else:
        d.hinge("spout", "base", Z, (0, 0, 0.6 * h), 1.4, -1.4, initial_opening=False)
    if d.maybe():
        for k, s in enumerate((-1.0, 1.0)):
            d.part("base", rod(0.6 * r, (0, 0, 0.3 * h), (s * 3 * r, 0, 0.3 * h)))
            knob(d, f"handle_{k}", "base", (s * 3 * r, 0, 0.3 * h), 0.8 * r, 1.2 * r, s * X, reach=d.pick(None, 1.57))
    else:
        on = "spout" if swings else "base"
        d.part("lever", rod(0.8 * r, (0, 0, h + g), (0, 0, h + 0.02)), beam(0.014, 0.008, (0, 0, h + 0.016), (0, -0.1,
            h + 0.03)))
        d.hinge("lever", on, Z, (0, 0, h), 1.0, -1.0, initial_opening=False)


def shower_mixer(d: ObjectBuilder) -> None:
    """A bar on a wall with a knob at either end and a hand shower on a rail."""
    w, r = d.u(0.2, 0.35), d.u(0.018, 0.028)
    d.part("bar", box((-w, 0.04, -0.1), (w, 0.06, 1.0)), rod(r, (-w / 2, 0, 0), (w / 2, 0, 0)), material="steel")
    for s in (-1.0, 1.0):
        d.part("bar", rod(0.7 * r, (s * w / 3, 0, 0), (s * w / 3, 0.05, 0)))
        knob(d, f"knob_{int(s + 1)}", "bar", (s * w / 2, 0, 0), 1.15 * r, 2.0 * r, s * X, reach=d.pick(None, 1.6))
    d.part("bar", rod(0.01, (0, -0.02, 0.2), (0, -0.02, 0.9)), *(rod(0.008, (0, -0.02, z), (0, 0.05, z)) for z in (0.22,
        0.88)))
    g = d.gap(0.01)
    d.part("holder", block((0, -0.02, z := d.u(0.4, 0.7)), (0.05, 0.05, 0.06)), cone(0.02, 0.04, (0, -0.05, z), (0,
        -0.1, z + 0.03)))
    d.bore("holder", rod(0.01 + 1.5 * g, (0, -0.02, 0), (0, -0.02, 1)))
    d.slide("holder", "bar", Z, 0.8 - z, 0.28 - z, initial_opening=False)


def cistern(d: ObjectBuilder) -> None:
    """A toilet: seat, lid and a flush button, lever or chain pull."""
    w, h = d.u(0.34, 0.4), d.u(0.36, 0.45)
    d.part("bowl", cone(0.3 * w, 0.48 * w, (0, 0, 0), (0, 0, h)), box((-w / 2, 0.45 * w, 0), (w / 2, 0.95 * w, h)),
        box((-w / 2, 0.6 * w, h), (w / 2, 0.95 * w, h + 0.38)), material="ceramic")
    g = d.gap(0.03) + 0.001
    d.part("seat", rod(0.5 * w, (0, -0.06 * w, h + g), (0, -0.06 * w, h + g + 0.02)))
    d.cut("seat", rod(0.33 * w, (0, -0.06 * w, h), (0, -0.06 * w, h + 0.1)))
    y = 0.46 * w
    d.part("seat", box((-0.3 * w, 0.4 * w, h + g), (0.3 * w, y, h + g + 0.02)))
    d.hinge("seat", "bowl", -X, (0, y, h + g), 1.55)
    d.part("lid", rod(0.5 * w, (0, -0.06 * w, h + 2 * g + 0.02), (0, -0.06 * w, h + 2 * g + 0.035)), box((-0.3 * w,
        0.4 * w, h + 2 * g + 0.02), (0.3 * w, y, h + 2 * g + 0.035)))
    d.hinge("lid", "bowl", -X, (0, y, h + g), 1.55, initial_opening=False)
    top = (0, 0.78 * w, h + 0.38)
    if d.maybe():
        button(d, "flush", "bowl", top, (0.05, 0.05), 0.012, Z, is_round=d.maybe())
    else:
        lever(d, "flush", "bowl", (0.5 * w, 0.75 * w, h + 0.3), X, -Y, 0.08, reach=0.7)


def towel_rail(d: ObjectBuilder) -> None:
    """Arms that swing about an upright on a wall."""
    h, n = d.u(0.2, 0.6), d.n(2, 4)
    d.part("wall_mount", box((-0.04, 0.02, 0), (0.04, 0.04, h)), rod(0.012, (0, 0, 0.03), (0, 0, h - 0.03)),
        *(box((-0.01, -0.01, z), (0.01, 0.03, z + 0.02)) for z in (0.01, h - 0.03)), material="steel")
    step = (h - 0.1) / n
    g = d.gap(0.02)
    for k, z in enumerate(spread(n, 0.05, h - 0.05)):
        d.part(f"arm_{k}", rod(0.02, (0, 0, z - 0.4 * step), (0, 0, z + 0.4 * step)), rod(0.008, (0, 0, z), (0,
            -d.u(0.25, 0.5), z)), material="steel")
        d.bore(f"arm_{k}", rod(0.012 + 1.5 * g + 0.0005, (0, 0, 0), (0, 0, h)))
        d.hinge(f"arm_{k}", "wall_mount", Z, (0, 0, z), 1.2, -1.2)


def ironing_board(d: ObjectBuilder) -> None:
    """Legs that fold about a pin under a board."""
    w, t, h = d.u(1.0, 1.4), d.u(0.3, 0.45), d.u(0.75, 0.95)
    d.part("board", box((-w / 2, -t / 2, h), (w / 2, t / 2, h + 0.03)), material="steel")
    for s in (-1.0, 1.0):
        d.part("board", box((0.2 * w - 0.02, s * 0.3 * t - 0.01, h - 0.04), (0.2 * w + 0.02, s * 0.3 * t + 0.01,
            h + 0.01)))
    y = 0.3 * t - 0.01 - d.gap(0.02) - 0.01
    for s in (-1.0, 1.0):
        d.part("legs", beam(0.02, 0.02, (0.2 * w, s * y, h - 0.025), (-0.3 * w, s * y, 0.02)))
    d.part("legs", beam(0.02, 0.02, (-0.3 * w, -0.4 * t, 0.02), (-0.3 * w, 0.4 * t, 0.02)), beam(0.02, 0.02, (0, -y,
        h * 0.6), (0, y, h * 0.6)))
    if d.hand.barrels:
        d.part("legs", rod(0.006, (0.2 * w, -0.3 * t, h - 0.025), (0.2 * w, 0.3 * t, h - 0.025)))
    d.hinge("legs", "board", Y, (0.2 * w, 0, h - 0.025), 0.4, -0.3, initial_opening=False)


def clothes_airer(d: ObjectBuilder) -> None:
    """A frame with wings that fold up."""
    w, t, h = d.u(0.8, 1.1), d.u(0.5, 0.6), d.u(0.8, 1.0)
    r = 0.008
    for s in (-1.0, 1.0):
        d.part("frame", rod(r, (s * w / 2, -t / 2, h), (s * w / 2, t / 2, h)), rod(r, (s * w / 2, -t / 2, h),
            (-s * w / 3, -t / 2, 0)), rod(r, (s * w / 2, t / 2, h), (-s * w / 3, t / 2, 0)), material="steel")
        d.part("frame", rod(r, (-w / 2, s * t / 2, h), (w / 2, s * t / 2, h)))
    d.part("frame", *(rod(0.004, (-w / 2, y, h), (w / 2, y, h)) for y in spread(5, -t / 2, t / 2)))
    g = d.gap(0.01) + 0.001
    for k, s in enumerate((-1.0, 1.0)):
        a, b = s * (w / 2 + 2 * r + g), s * (w / 2 + d.u(0.3, 0.5))
        d.part(f"wing_{k}", *(rod(r, (x, -t / 2, h), (x, t / 2, h)) for x in (a, b)), *(rod(r, (a, y, h), (b, y,
            h)) for y in (-t / 2, t / 2)))
        d.hinge(f"wing_{k}", "frame", Y * -s, (a, 0, h), 1.3, -1.4, initial_opening=False)


def bread_bin(d: ObjectBuilder) -> None:
    """A quarter round lid that rolls back, or a front flap."""
    w, r = d.u(0.3, 0.45), d.u(0.1, 0.16)
    d.part("bin", box((-w / 2, -r, 0), (w / 2, r, 0.02)), box((-w / 2, 0.7 * r, 0), (w / 2, r, r)), material="wood")
    for s in (-1.0, 1.0):
        d.part("bin", box((s * w / 2, -r, 0), (s * (w / 2 - 0.015), r, r)))
    g = d.gap(0.05) + 0.0005
    half = w / 2 - 0.015 - g
    d.part("lid", rod(0.98 * r, (-half, -0.2 * r, 0.05 + g), (half, -0.2 * r, 0.05 + g)))
    d.cut("lid", rod(0.9 * r, (-half + 0.01, -0.2 * r, 0.05 + g), (half - 0.01, -0.2 * r, 0.05 + g)), box((-1, -0.2 * r,
        -1), (1, 1, 0.05 + 0.3 * r)), box((-1, -1, -1), (1, 1, 0.022 + g)))
    d.cut("lid", box((-1, 0.3 * r, -1), (1, 1, 1)))
    d.hinge("lid", "bin", -X, (0, -0.2 * r, 0.05 + g), 0.5)


def knife_block(d: ObjectBuilder) -> None:
    """Knives that are drawn out of a slanted block."""
    w, h, n = d.u(0.1, 0.2), d.u(0.2, 0.28), d.n(3, 6)
    d.part("block", prism([(-0.1, 0), (0.08, 0), (0.08, 0.6 * h), (-0.02, h)], (0, 0, 0), w, "x"), material="wood")
    out = np.array([0.0, 0.0, 1.0])
    for k, x in enumerate(spread(n, -0.45 * w, 0.45 * w)):
        y = d.u(-0.02, 0.02)
        g = d.gap(0.01)
        d.bore("block", box((x - 0.0015 - g, y - 0.015 - g, 0.04), (x + 0.0015 + g, y + 0.015 + g, 2 * h)))
        d.part(f"knife_{k}", box((x - 0.0015, y - 0.015, 0.05), (x + 0.0015, y + 0.015, h + 0.02)), material="steel")
        d.part(f"knife_{k}", box((x - 0.3 * w / n, y - 0.012, h + 0.01), (x + 0.3 * w / n, y + 0.012, h + 0.1)))
        d.slide(f"knife_{k}", "block", out, 0.12)


def stand_mixer(d: ObjectBuilder) -> None:
    """A head that tilts, a beater that turns, a speed lever."""
    k = d.u(0.8, 1.2)
    d.part("base", box((-0.09 * k, -0.2 * k, 0), (0.09 * k, 0.12 * k, 0.03)), box((-0.05 * k, 0.02 * k, 0), (0.05 * k,
        0.1 * k, 0.22 * k)), material="metal")
    g = d.gap(0.05)
    z = 0.22 * k + g
    d.part("head", box((-0.05 * k, -0.2 * k, z), (0.05 * k, 0.1 * k, z + 0.1 * k)))
    d.hinge("head", "base", -X, (0, 0.1 * k, z), 0.8)
    d.part("beater", rod(0.012, (0, -0.14 * k, z - g - 0.02), (0, -0.14 * k, z - g)), ball(0.04 * k, (0, -0.14 * k,
        z - 0.07 * k)))
    if d.hand.has_bore:
        d.cut("head", rod(0.006 + 2 * g, (0, -0.14 * k, 0), (0, -0.14 * k, z + 0.05)))
        d.part("beater", rod(0.006, (0, -0.14 * k, z - 0.03), (0, -0.14 * k, z + 0.045)))
    d.spin("beater", "head", Z, (0, -0.14 * k, z))
    knob(d, "speed", "head", (0.05 * k, -0.02, z + 0.05 * k), 0.015, 0.015, X, reach=3.0)


def food_processor(d: ObjectBuilder) -> None:
    """A bowl on a base, a lid, a knob, buttons."""
    r = d.u(0.07, 0.1)
    case(d, "base", (-0.11, -0.1, 0), (0.11, 0.1, 0.12), material="plastic")
    g = d.gap(r)
    d.part("bowl", rod(r, (0, 0, 0.12 + g), (0, 0, 0.27)), material="glass")
    d.hinge("bowl", "base", Z, (0, 0, 0.12), 0.5, initial_opening=False)
    d.part("lid", rod(1.03 * r, (0, 0, 0.27 + g), (0, 0, 0.285 + g)), rod(0.3 * r, (0, 0.4 * r, 0.27 + g), (0, 0.4 * r,
        0.35)))
    d.slide("lid", "bowl", Z, 0.1)
    knob(d, "dial", "base", (0.05, -0.1, 0.07), 0.025, 0.02, -Y, reach=4.0)
    for k, z in enumerate((0.04, 0.08)):
        button(d, f"button_{k}", "base", (-0.05, -0.1, z), (0.03, 0.02), 0.006, -Y, is_round=d.maybe())


def waffle_iron(d: ObjectBuilder) -> None:
    """Two shells on a hinge with handles, sandwich maker or grill."""
    w, t = d.u(0.2, 0.35), d.u(0.2, 0.3)
    shape = d.maybe()
    low = rod(w / 2, (0, 0, 0.02), (0, 0, 0.07)) if shape else box((-w / 2, -t / 2, 0.02), (w / 2, t / 2, 0.07))
    r = w / 2 if shape else t / 2
    d.part("lower", low, box((-0.04, -r - 0.1, 0.04), (0.04, -0.9 * r, 0.06)), box((-0.05, 0.8 * r, 0.03), (0.05,
        r + 0.02, 0.07)), material="metal")
    g = d.gap(0.05)
    up = rod(w / 2, (0, 0, 0.07 + g), (0, 0, 0.12)) if shape else box((-w / 2, -t / 2, 0.07 + g), (w / 2, t / 2, 0.12))
    d.part("upper", up, box((-0.04, -r - 0.1, 0.08), (0.04, -0.9 * r, 0.1)), box((-0.05, 0.8 * r, 0.07 + g), (0.05,
        r + 0.02, 0.1)))
    d.hinge("upper", "lower", -X, (0, r + 0.02, 0.07 + g / 2), d.u(1.2, 1.7))


def range_cooker(d: ObjectBuilder) -> None:
    """An oven with a door, knobs in a row, a drawer for pans."""
    w, t, h = d.u(0.5, 0.9), 0.6, d.u(0.85, 0.92)
    case(d, "range", (-w / 2, 0, 0), (w / 2, t, h), material="steel")
    d.bore("range", box((-w / 2 + 0.06, -0.1, 0.25), (w / 2 - 0.06, t - 0.1, h - 0.2)))
    leaf(d, "door", "range", (-w / 2 + 0.01, -0.03, 0.22), (w / 2 - 0.01, 0, h - 0.15), hinge=-Z, out=-Y, reach=1.5,
        material="steel")
    drawer(d, "pan_drawer", "range", (-w / 2 + 0.03, 0, 0.03), (w / 2 - 0.03, t - 0.1, 0.18), out=-Y, handle=d.maybe())
    for k, x in enumerate(spread(d.n(3, 6), -0.45 * w, 0.45 * w)):
        knob(d, f"knob_{k}", "range", (x, 0, h - 0.07), 0.022, 0.025, -Y, reach=d.pick(None, 4.7))


def top_loader(d: ObjectBuilder) -> None:
    """A washing machine with a lid above, a drum and a dial."""
    w, h = d.u(0.4, 0.65), d.u(0.85, 1.0)
    case(d, "housing", (-w / 2, -0.3, 0), (w / 2, 0.3, h), material="steel")
    d.part("housing", box((-w / 2, 0.2, h - 0.01), (w / 2, 0.3, h + 0.15)))
    r = 0.19
    g = d.gap(r)
    d.cut("housing", rod(r + 0.02, (0, -0.05, 0.3), (0, -0.05, h + 0.01)))
    d.part("drum", rod(r, (0, -0.05, 0.3 + g), (0, -0.05, h - 0.05)), material="steel")
    d.cut("drum", rod(0.95 * r, (0, -0.05, 0.32), (0, -0.05, h)))
    d.spin("drum", "housing", Z, (0, -0.05, 0.3))
    leaf(d, "lid", "housing", (-0.42 * w, -0.29, h), (0.42 * w, 0.195, h + 0.02), hinge=Y, out=Z, reach=1.4)
    for k, x in enumerate(spread(d.n(1, 3), -0.4 * w, 0.4 * w)):
        knob(d, f"dial_{k}", "housing", (x, 0.25, h + 0.15), 0.03, 0.03, Z)


def urn(d: ObjectBuilder) -> None:
    """An urn with a spigot."""
    r, h = d.u(0.12, 0.18), d.u(0.3, 0.5)
    d.part("urn", rod(r, (0, 0, 0.05), (0, 0, h)), rod(0.7 * r, (0, 0, 0), (0, 0, 0.06)), rod(0.012, (0, -0.8 * r, 0.1),
        (0, -r - 0.06, 0.1)), material="steel")
    g = d.gap(r)
    d.part("lid", cone(r, 0.3 * r, (0, 0, h + g), (0, 0, h + 0.05)), ball(0.02, (0, 0, h + 0.06)))
    d.slide("lid", "urn", Z, 0.15)
    d.part("spigot", box((-0.006, -r - 0.05, 0.112 + g), (0.006, -r - 0.03, 0.16)), rod(0.012, (0, -r - 0.04,
        0.112 + g), (0, -r - 0.04, 0.12)))
    d.hinge("spigot", "urn", Z, (0, -r - 0.04, 0.112), 1.57)


def manual_coffee_grinder(d: ObjectBuilder) -> None:
    """A box with a crank above and a drawer below."""
    w, h = d.u(0.09, 0.14), d.u(0.1, 0.2)
    d.part("mill", box((-w / 2, -w / 2, 0), (w / 2, w / 2, h)), cone(0.4 * w, 0.2 * w, (0, 0, h), (0, 0, h + 0.04)),
        material="wood")
    crank(d, "crank", "mill", (0, 0, h + 0.04), Z, d.u(0.08, 0.13))
    drawer(d, "drawer", "mill", (-0.35 * w, -w / 2, 0.01), (0.35 * w, 0.3 * w, 0.4 * h), out=-Y)


def french_press(d: ObjectBuilder) -> None:
    """A plunger through a lid, on a glass."""
    r, h = d.u(0.035, 0.055), d.u(0.12, 0.2)
    d.part("glass", rod(r, (0, 0, 0), (0, 0, h)), material="glass")
    d.part("glass", beam(0.02, 0.01, (r, 0, 0.8 * h), (r + 0.04, 0, 0.8 * h)), beam(0.02, 0.01, (r + 0.035, 0,
        0.82 * h), (r + 0.035, 0, 0.2 * h), X))
    d.cut("glass", rod(0.92 * r, (0, 0, 0.005), (0, 0, h + 0.1)))
    g = d.gap(r)
    z = d.u(0.5, 0.85) * h
    d.part("plunger", rod(0.92 * r - 2 * g - 0.0003, (0, 0, z), (0, 0, z + 0.006)), rod(0.003, (0, 0, z), (0, 0,
        h + 0.08)), ball(0.01, (0, 0, h + 0.085)), material="steel")
    d.slide("plunger", "glass", -Z, 0.8 * z, initial_opening=False)


def salad_spinner(d: ObjectBuilder) -> None:
    """A lid with a crank or a pump knob on a bowl."""
    r, h = d.u(0.1, 0.14), d.u(0.12, 0.18)
    d.part("bowl", cone(0.8 * r, r, (0, 0, 0), (0, 0, h)))
    if d.hand.hollow:
        d.cut("bowl", cone(0.75 * r, 0.95 * r, (0, 0, 0.01), (0, 0, h + 0.001)))
    g = d.gap(r)
    d.part("lid", rod(1.02 * r, (0, 0, h + g), (0, 0, h + g + 0.03)))
    d.slide("lid", "bowl", Z, 0.1)
    if d.maybe():
        crank(d, "crank", "lid", (0, 0, h + g + 0.03), Z, 0.6 * r, spins=False)
    else:
        button(d, "pump", "lid", (0, 0, h + g + 0.03), (0.5 * r, 0.5 * r), 0.03, Z, is_round=True)


def soap_dispenser(d: ObjectBuilder) -> None:
    """A pump head that goes down on a bottle."""
    r, h = d.u(0.025, 0.045), d.u(0.1, 0.18)
    d.part("bottle", d.pick(rod(r, (0, 0, 0), (0, 0, h)), box((-r, -r, 0), (r, r, h))), rod(0.4 * r, (0, 0, h), (0, 0,
        h + 0.02)))
    g = d.gap(0.01)
    d.bore("bottle", rod(0.004 + 1.5 * g, (0, 0, 0.3 * h), (0, 0, h + 0.1)))
    d.part("pump", rod(0.004, (0, 0, 0.5 * h if d.hand.has_bore else h + 0.02), (0, 0, h + 0.06)), rod(0.3 * r, (0, 0,
        h + 0.05), (0, 0, h + 0.065)), beam(0.01, 0.008, (0, 0, h + 0.06), (0, -1.6 * r, h + 0.058)))
    d.slide("pump", "bottle", -Z, 0.025, initial_opening=False)


def spray_bottle(d: ObjectBuilder) -> None:
    """A trigger below a head, a nozzle that turns."""
    r, h = d.u(0.03, 0.045), d.u(0.14, 0.2)
    d.part("bottle", rod(r, (0, 0, 0), (0, 0, h)), cone(r, 0.4 * r, (0, 0, h), (0, 0, h + 0.04)), box((-0.012, -0.09,
        h + 0.035), (0.012, 0.03, h + 0.07)))
    g = d.gap(0.01)
    d.part("trigger", beam(0.016, 0.008, (0, -0.07, h + 0.034 - g), (0, -0.09, h - 0.03), Y))
    d.hinge("trigger", "bottle", X, (0, -0.07, h + 0.034 - g), 0.35, initial_opening=False)
    d.part("nozzle", rod(0.009, (0, -0.09 - g, h + 0.055), (0, -0.108, h + 0.055)))
    d.spin("nozzle", "bottle", -Y, (0, -0.09, h + 0.055))


def window_blind(d: ObjectBuilder) -> None:
    """Slats that all tilt, and a wand."""
    w, n = d.u(0.5, 1.2), d.n(4, 9)
    h = 0.06 * n
    d.part("rail", box((-w / 2, -0.03, h), (w / 2, 0.03, h + 0.04)), material="metal")
    for s in (-1.0, 1.0):
        d.part("rail", box((s * w / 2, -0.012, -0.02), (s * (w / 2 + 0.01), 0.012, h + 0.02)))
    g = d.gap(0.02) + 0.0003
    for k, z in enumerate(spread(n, 0, h - 0.01)):
        d.part(f"slat_{k}", box((-w / 2 + g, -0.025, z - 0.001), (w / 2 - g, 0.025, z + 0.001)), material="metal")
        d.hinge(f"slat_{k}", "rail", X, (0, 0, z), 0.9, -0.9, initial_opening=False)


def dishwasher_with_racks(d: ObjectBuilder) -> None:
    """A dishwasher: a door that folds down, two racks that roll out."""
    w, t, h = d.pick(0.45, 0.6), 0.55, d.u(0.8, 0.87)
    case(d, "washer", (-w / 2, 0, 0), (w / 2, t, h), opening=-Y, wall=0.025, material="steel")
    if not d.hand.hollow:
        d.cut("washer", box((-w / 2 + 0.025, -0.1, 0.12), (w / 2 - 0.025, t - 0.03, h - 0.025)))
    d.part("washer", box((-w / 2, 0.001, 0), (w / 2, t, 0.12)))
    leaf(d, "door", "washer", (-w / 2, -0.04, 0.1), (w / 2, 0, h), hinge=-Z, out=-Y, reach=1.5, material="steel")
    g = d.gap(0.05)
    for k, z in enumerate((0.17, 0.5 * h)):
        a = w / 2 - 0.03 - g
        d.part(f"rack_{k}", box((-a, 0.02, z), (a, t - 0.06, z + 0.015)), material="metal")
        for x in (-a, a - 0.008):
            d.part(f"rack_{k}", box((x, 0.02, z), (x + 0.008, t - 0.06, z + 0.12)))
        for y in spread(d.n(3, 6), 0.04, t - 0.08):
            d.part(f"rack_{k}", rod(0.004, (-a, y, z + 0.1), (a, y, z + 0.1)))
        d.slide(f"rack_{k}", "washer", -Y, 0.4)


def ceiling_fan(d: ObjectBuilder) -> None:
    """Blades on a motor below a rod, pull chain now and then."""
    h, r = d.u(0.2, 0.4), d.u(0.4, 0.7)
    d.part("mount", rod(0.06, (0, 0, h), (0, 0, h + 0.04)), rod(0.012, (0, 0, 0), (0, 0, h + 0.02)), rod(0.08, (0, 0,
        -0.06), (0, 0, 0.02)), material="metal")
    rotor(d, "rotor", "mount", (0, 0, -0.06), -Z, r, d.n(3, 5), wide=0.2)


def tower_fan(d: ObjectBuilder) -> None:
    """A column that swings on its base, with buttons and a dial."""
    h, r = d.u(0.7, 1.1), d.u(0.06, 0.1)
    d.part("base", rod(1.8 * r, (0, 0, 0), (0, 0, 0.03)))
    g = d.gap(r)
    d.part("column", rod(r, (0, 0, 0.03 + g), (0, 0, h)))
    d.hinge("column", "base", Z, (0, 0, 0.03), 0.7, -0.7, initial_opening=False)
    for k, x in enumerate(spread(d.n(1, 3), -0.7 * r, 0.7 * r)):
        button(d, f"button_{k}", "column", (x, -0.3 * r, h), (0.015, 0.015), 0.005, Z, is_round=True)
    knob(d, "timer", "column", (0, 0.4 * r, h), 0.3 * r, 0.015, Z, reach=d.pick(None, 4.0))


def wood_stove(d: ObjectBuilder) -> None:
    """A wood stove with a glazed door, an ash drawer and a damper."""
    w, h = d.u(0.4, 0.7), d.u(0.6, 1.0)
    case(d, "stove", (-w / 2, -0.2, 0.1), (w / 2, 0.2, h), material="steel")
    legs(d, "stove", (-w / 2, -0.2, 0), (w / 2, 0.2, 0.105), 0.04)
    d.part("stove", rod(0.07, (0, 0.05, h - 0.01), (0, 0.05, h + 0.4)))
    d.bore("stove", box((-0.35 * w, -0.3, 0.35 * h), (0.35 * w, 0.1, 0.85 * h)))
    leaf(d, "door", "stove", (-0.4 * w, -0.225, 0.32 * h), (0.4 * w, -0.2, 0.88 * h), hinge=d.pick(X, -X), out=-Y,
        reach=2.0, material="steel")
    drawer(d, "ash_drawer", "stove", (-0.3 * w, -0.2, 0.13), (0.3 * w, 0.1, 0.13 + 0.12 * h), out=-Y, material="steel")
    knob(d, "damper", "stove", (0.07 - 0.001, 0.05, h + 0.2), 0.02, 0.03, X, reach=1.57)
