"""Things of a household."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.library.kind import angle, kind, length, yes
from kinematify.generate.library.mechanisms import bail, button, case, crank, knob, lever, rotor
from kinematify.generate.library.panels import drawer, leaf
from kinematify.generate.procedural.builder import spread
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, slab

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.builder import ObjectBuilder


@kind("parametric pedal bin", like="trash_can", radius=length(0.12, 0.2), height=length(0.3, 0.65))
def pedal_bin(b: ObjectBuilder, radius: float, height: float) -> None:
    """A bin with a lid and a pedal."""
    is_round = b.pick(True, False)

    def body(low: float, high: float) -> Manifold:
        return b.cylinder(radius, low, high) if is_round else slab(radius, radius, (low, high))

    b.part("bin", body(0, height), look="steel")
    if b.style.hollow:
        b.cut("bin", b.cylinder(0.9 * radius, 0.02, height + 1))
    g = b.gap(radius)
    b.part("lid", body(height + g, height + g + 0.04))
    b.hinge("lid", parent="bin", axis=-X, pivot=(0, radius, height + g), upper=b.draw(1.2, 1.6))
    low = 0.02 + b.gap(0.05)
    b.part(
        "pedal",
        slab(0.03, (-radius - 0.07, -radius - g - 0.001 if b.style.has_bore else -0.6 * radius), (low, low + 0.012)),
    )
    b.hinge(
        "pedal",
        parent="bin",
        axis=X,
        pivot=(0, -radius - g - 0.001 if b.style.has_bore else -radius, low),
        upper=0.25,
        ajar=False,
    )


@kind("parametric pepper mill", like="pepper_mill", radius=length(0.02, 0.035), height=length(0.08, 0.3))
def parametric_pepper_mill(b: ObjectBuilder, radius: float, height: float) -> None:
    """A head that turns on a body."""
    b.part(
        "body",
        b.cylinder(radius, 0, 0.3 * height),
        b.cone(radius, 0.6 * radius, 0.3 * height, 0.7 * height),
        look="wood",
    )
    g = b.gap(radius)
    b.part(
        "head",
        b.cylinder(0.6 * radius, 0.7 * height + g, 0.75 * height),
        ball(0.95 * radius, (0, 0, 0.75 * height + 0.9 * radius + g)),
        look="wood",
    )
    if b.maybe(0.3):
        b.part(
            "head",
            beam(0.01, 0.005, (0, 0, 0.75 * height + 1.8 * radius), (2.2 * radius, 0, 0.75 * height + 1.8 * radius)),
            b.cylinder(
                0.006, (2.2 * radius, 0, 0.75 * height + 1.8 * radius), (2.2 * radius, 0, 0.75 * height + 2.8 * radius)
            ),
        )
    b.spin("head", parent="body", axis=Z, pivot=(0, 0, 0.7 * height))


@kind(
    "parametric tap",
    like="faucet",
    radius=length(0.018, 0.03),
    height=length(0.08, 0.3),
    reach=angle(0.1, 0.22),
    swings=yes(0.5),
)
def tap(b: ObjectBuilder, radius: float, height: float, reach: float, swings: bool) -> None:
    """A basin mixer: a lever or two handles, a spout that swings."""
    b.part("base", b.cylinder(1.3 * radius, 0, 0.02), b.cylinder(radius, 0, 0.6 * height), look="steel")
    g = b.gap(radius)
    spout = (
        b.cylinder(radius, 0.6 * height + g, height),
        b.rod(0.6 * radius, (0, 0, 0.9 * height), (0, -reach, 0.9 * height)),
        b.cylinder(0.6 * radius, (0, -reach, 0.9 * height), (0, -reach, 0.7 * height)),
    )
    b.part(f"{'spout' if swings else 'base'}", spout, look="steel")
    if not swings:
        b.part("base", b.cylinder(0.98 * radius, 0.5 * height, 0.7 * height))
    else:
        b.hinge("spout", parent="base", axis=Z, pivot=(0, 0, 0.6 * height), upper=1.4, lower=-1.4, ajar=False)
    if b.maybe():
        for k, s in enumerate((-1, 1)):
            b.part("base", b.cylinder(0.6 * radius, (0, 0, 0.3 * height), (s * 3 * radius, 0, 0.3 * height)))
            knob(
                b,
                f"handle_{k}",
                parent="base",
                at=(s * 3 * radius, 0, 0.3 * height),
                radius=0.8 * radius,
                high=1.2 * radius,
                out=s * X,
                reach=b.pick(None, 1.57),
            )
    else:
        on = "spout" if swings else "base"
        b.part(
            "lever",
            b.cylinder(0.8 * radius, height + g, height + 0.02),
            beam(0.014, 0.008, (0, 0, height + 0.016), (0, -0.1, height + 0.03)),
        )
        b.hinge("lever", parent=on, axis=Z, pivot=(0, 0, height), upper=1.0, lower=-1.0, ajar=False)


@kind(
    "cistern",
    words="toilet with cistern, flush toilet",
    like="toilet",
    width=length(0.34, 0.4),
    height=length(0.36, 0.45),
)
def cistern(b: ObjectBuilder, width: float, height: float) -> None:
    """A toilet: seat, lid and a flush button, lever or chain pull."""
    b.part(
        "bowl",
        b.cone(0.3 * width, 0.48 * width, 0, height),
        slab(width / 2, (0.45 * width, 0.95 * width), (0, height)),
        slab(width / 2, (0.6 * width, 0.95 * width), (height, height + 0.38)),
        look="ceramic",
    )
    g = b.gap(0.03) + 0.001
    b.part("seat", b.cylinder(0.5 * width, (0, -0.06 * width, height + g), (0, -0.06 * width, height + g + 0.02)))
    b.cut("seat", b.cylinder(0.33 * width, (0, -0.06 * width, height), (0, -0.06 * width, height + 0.1)))
    y = 0.46 * width
    b.part("seat", slab(0.3 * width, (0.4 * width, y), (height + g, height + g + 0.02)))
    b.hinge("seat", parent="bowl", axis=-X, pivot=(0, y, height + g), upper=1.55)
    b.part(
        "lid",
        b.cylinder(0.5 * width, (0, -0.06 * width, height + 2 * g + 0.02), (0, -0.06 * width, height + 2 * g + 0.035)),
        slab(0.3 * width, (0.4 * width, y), (height + 2 * g + 0.02, height + 2 * g + 0.035)),
    )
    b.hinge("lid", parent="bowl", axis=-X, pivot=(0, y, height + g), upper=1.55, ajar=False)
    top = (0, 0.78 * width, height + 0.38)
    if b.maybe():
        button(b, "flush", parent="bowl", at=top, size=(0.05, 0.05), high=0.012, out=Z, is_round=b.maybe())
    else:
        lever(
            b,
            "flush",
            parent="bowl",
            at=(0.5 * width, 0.75 * width, height + 0.3),
            out=X,
            along=-Y,
            length=0.08,
            reach=0.7,
        )


@kind(
    "winged clothes airer", like="drying_rack", width=length(0.8, 1.1), depth=length(0.5, 0.6), height=length(0.8, 1.0)
)
def clothes_airer(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A frame with wings that fold up."""
    r = 0.008
    for s in (-1, 1):
        b.part(
            "frame",
            b.cylinder(r, (s * width / 2, -depth / 2, height), (s * width / 2, depth / 2, height)),
            b.cylinder(r, (s * width / 2, -depth / 2, height), (-s * width / 3, -depth / 2, 0)),
            b.cylinder(r, (s * width / 2, depth / 2, height), (-s * width / 3, depth / 2, 0)),
            look="steel",
        )
        b.part("frame", b.cylinder(r, (-width / 2, s * depth / 2, height), (width / 2, s * depth / 2, height)))
    b.part(
        "frame",
        [b.cylinder(0.004, (-width / 2, y, height), (width / 2, y, height)) for y in spread(5, -depth / 2, depth / 2)],
    )
    g = b.gap(0.01) + 0.001
    for k, s in enumerate((-1, 1)):
        a = s * (width / 2 + 2 * r + g)
        b_ = s * (width / 2 + b.draw(0.3, 0.5))
        b.part(
            f"wing_{k}",
            [b.cylinder(r, (x, -depth / 2, height), (x, depth / 2, height)) for x in (a, b_)],
            [b.cylinder(r, (a, y, height), (b_, y, height)) for y in (-depth / 2, depth / 2)],
        )
        b.hinge(f"wing_{k}", parent="frame", axis=Y * -s, pivot=(a, 0, height), upper=1.3, lower=-1.4, ajar=False)


@kind("parametric stand mixer", like="stand_mixer", size=length(0.8, 1.2))
def parametric_stand_mixer(b: ObjectBuilder, size: float) -> None:
    """A head that tilts, a beater that turns, a speed lever."""
    b.part(
        "base",
        slab(0.09 * size, (-0.2 * size, 0.12 * size), (0, 0.03)),
        slab(0.05 * size, (0.02 * size, 0.1 * size), (0, 0.22 * size)),
        look="metal",
    )
    g = b.gap(0.05)
    z = 0.22 * size + g
    b.part("head", slab(0.05 * size, (-0.2 * size, 0.1 * size), (z, z + 0.1 * size)))
    b.hinge("head", parent="base", axis=-X, pivot=(0, 0.1 * size, z), upper=0.8)
    b.part(
        "beater",
        b.cylinder(0.012, (0, -0.14 * size, z - g - 0.02), (0, -0.14 * size, z - g)),
        ball(0.04 * size, (0, -0.14 * size, z - 0.07 * size)),
    )
    if b.style.has_bore:
        b.cut("head", b.cylinder(0.006 + 2 * g, (0, -0.14 * size, 0), (0, -0.14 * size, z + 0.05)))
        b.part("beater", b.cylinder(0.006, (0, -0.14 * size, z - 0.03), (0, -0.14 * size, z + 0.045)))
    b.spin("beater", parent="head", axis=Z, pivot=(0, -0.14 * size, z))
    knob(
        b, "speed", parent="head", at=(0.05 * size, -0.02, z + 0.05 * size), radius=0.015, high=0.015, out=X, reach=3.0
    )


@kind("parametric waffle iron", like="waffle_iron", width=length(0.2, 0.35), depth=length(0.2, 0.3), shape=yes(0.5))
def parametric_waffle_iron(b: ObjectBuilder, width: float, depth: float, shape: bool) -> None:
    """Two shells on a hinge with handles, sandwich maker or grill."""
    low = b.cylinder(width / 2, 0.02, 0.07) if shape else slab(width / 2, depth / 2, (0.02, 0.07))
    r = width / 2 if shape else depth / 2
    b.part(
        "lower",
        low,
        slab(0.04, (-r - 0.1, -0.9 * r), (0.04, 0.06)),
        slab(0.05, (0.8 * r, r + 0.02), (0.03, 0.07)),
        look="metal",
    )
    g = b.gap(0.05)
    up = b.cylinder(width / 2, 0.07 + g, 0.12) if shape else slab(width / 2, depth / 2, (0.07 + g, 0.12))
    b.part(
        "upper",
        up,
        slab(0.04, (-r - 0.1, -0.9 * r), (0.08, 0.1)),
        slab(0.05, (0.8 * r, r + 0.02), (0.07 + g, 0.1)),
    )
    b.hinge("upper", parent="lower", axis=-X, pivot=(0, r + 0.02, 0.07 + g / 2), upper=b.draw(1.2, 1.7))


@kind("parametric range cooker", like="oven", width=length(0.5, 0.9), height=length(0.85, 0.92))
def range_cooker(b: ObjectBuilder, width: float, height: float) -> None:
    """An oven with a door, knobs in a row, a drawer for pans."""
    t = 0.6
    case(b, "range", lower=(-width / 2, 0, 0), upper=(width / 2, t, height), material="steel")
    b.bore("range", slab(width / 2 - 0.06, (-0.1, t - 0.1), (0.25, height - 0.2)))
    leaf(
        b,
        "door",
        parent="range",
        lower=(-width / 2 + 0.01, -0.03, 0.22),
        upper=(width / 2 - 0.01, 0, height - 0.15),
        hinge=-Z,
        out=-Y,
        reach=1.5,
        material="steel",
    )
    drawer(
        b,
        "pan_drawer",
        parent="range",
        lower=(-width / 2 + 0.03, 0, 0.03),
        upper=(width / 2 - 0.03, t - 0.1, 0.18),
        out=-Y,
        handle=b.maybe(),
    )
    for k, x in enumerate(spread(b.count(3, 6), -0.45 * width, 0.45 * width)):
        knob(
            b,
            f"knob_{k}",
            parent="range",
            at=(x, 0, height - 0.07),
            radius=0.022,
            high=0.025,
            out=-Y,
            reach=b.pick(None, 4.7),
        )


@kind(
    "top loader",
    words="top loading washing machine, top load washer",
    like="washing_machine",
    width=length(0.4, 0.65),
    height=length(0.85, 1.0),
)
def top_loader(b: ObjectBuilder, width: float, height: float) -> None:
    """A washing machine with a lid above, a drum and a dial."""
    case(b, "housing", lower=(-width / 2, -0.3, 0), upper=(width / 2, 0.3, height), material="steel")
    b.part("housing", slab(width / 2, (0.2, 0.3), (height - 0.01, height + 0.15)))
    r = 0.19
    g = b.gap(r)
    b.cut("housing", b.cylinder(r + 0.02, (0, -0.05, 0.3), (0, -0.05, height + 0.01)))
    b.part("drum", b.cylinder(r, (0, -0.05, 0.3 + g), (0, -0.05, height - 0.05)), look="steel")
    b.cut("drum", b.cylinder(0.95 * r, (0, -0.05, 0.32), (0, -0.05, height)))
    b.spin("drum", parent="housing", axis=Z, pivot=(0, -0.05, 0.3))
    leaf(
        b,
        "lid",
        parent="housing",
        lower=(-0.42 * width, -0.29, height),
        upper=(0.42 * width, 0.195, height + 0.02),
        hinge=Y,
        out=Z,
        reach=1.4,
    )
    for k, x in enumerate(spread(b.count(1, 3), -0.4 * width, 0.4 * width)):
        knob(b, f"dial_{k}", parent="housing", at=(x, 0.25, height + 0.15), radius=0.03, high=0.03, out=Z)


@kind("parametric manual coffee grinder", like="hand_grinder", width=length(0.09, 0.14), height=length(0.1, 0.2))
def manual_coffee_grinder(b: ObjectBuilder, width: float, height: float) -> None:
    """A box with a crank above and a drawer below."""
    b.part(
        "mill",
        slab(width / 2, width / 2, (0, height)),
        b.cone(0.4 * width, 0.2 * width, height, height + 0.04),
        look="wood",
    )
    crank(b, "crank", parent="mill", at=(0, 0, height + 0.04), out=Z, length=b.draw(0.08, 0.13))
    drawer(
        b,
        "drawer",
        parent="mill",
        lower=(-0.35 * width, -width / 2, 0.01),
        upper=(0.35 * width, 0.3 * width, 0.4 * height),
        out=-Y,
    )


@kind("parametric french press", like="plunger_pot", radius=length(0.035, 0.055), height=length(0.12, 0.2))
def french_press(b: ObjectBuilder, radius: float, height: float) -> None:
    """A plunger through a lid, on a glass."""
    b.part("glass", b.cylinder(radius, 0, height), look="glass")
    b.part(
        "glass",
        beam(0.02, 0.01, (radius, 0, 0.8 * height), (radius + 0.04, 0, 0.8 * height)),
        beam(0.02, 0.01, (radius + 0.035, 0, 0.82 * height), (radius + 0.035, 0, 0.2 * height), X),
    )
    b.cut("glass", b.cylinder(0.92 * radius, 0.005, height + 0.1))
    g = b.gap(radius)
    z = b.draw(0.5, 0.85) * height
    b.part(
        "plunger",
        b.cylinder(0.92 * radius - 2 * g - 0.0003, z, z + 0.006),
        b.cylinder(0.003, z, height + 0.08),
        ball(0.01, (0, 0, height + 0.085)),
        look="steel",
    )
    b.slide("plunger", parent="glass", axis=-Z, upper=0.8 * z, ajar=False)


@kind("parametric salad spinner", like="salad_spinner", radius=length(0.1, 0.14), height=length(0.12, 0.18))
def parametric_salad_spinner(b: ObjectBuilder, radius: float, height: float) -> None:
    """A lid with a crank or a pump knob on a bowl."""
    b.part("bowl", b.cone(0.8 * radius, radius, 0, height))
    if b.style.hollow:
        b.cut("bowl", b.cone(0.75 * radius, 0.95 * radius, 0.01, height + 0.001))
    g = b.gap(radius)
    b.part("lid", b.cylinder(1.02 * radius, height + g, height + g + 0.03))
    b.slide("lid", parent="bowl", axis=Z, upper=0.1)
    if b.maybe():
        crank(b, "crank", parent="lid", at=(0, 0, height + g + 0.03), out=Z, length=0.6 * radius, spins=False)
    else:
        button(
            b,
            "pump",
            parent="lid",
            at=(0, 0, height + g + 0.03),
            size=(0.5 * radius, 0.5 * radius),
            high=0.03,
            out=Z,
            is_round=True,
        )


@kind("parametric soap dispenser", like="soap_dispenser", radius=length(0.025, 0.045), height=length(0.1, 0.18))
def parametric_soap_dispenser(b: ObjectBuilder, radius: float, height: float) -> None:
    """A pump head that goes down on a bottle."""
    b.part(
        "bottle",
        b.pick(b.cylinder(radius, 0, height), slab(radius, radius, (0, height))),
        b.cylinder(0.4 * radius, height, height + 0.02),
    )
    g = b.gap(0.01)
    b.bore("bottle", b.cylinder(0.004 + 1.5 * g, 0.3 * height, height + 0.1))
    b.part(
        "pump",
        b.cylinder(0.004, 0.5 * height if b.style.has_bore else height + 0.02, height + 0.06),
        b.cylinder(0.3 * radius, height + 0.05, height + 0.065),
        beam(0.01, 0.008, (0, 0, height + 0.06), (0, -1.6 * radius, height + 0.058)),
    )
    b.slide("pump", parent="bottle", axis=-Z, upper=0.025, ajar=False)


@kind("parametric spray bottle", like="spray_bottle", radius=length(0.03, 0.045), height=length(0.14, 0.2))
def parametric_spray_bottle(b: ObjectBuilder, radius: float, height: float) -> None:
    """A trigger below a head, a nozzle that turns."""
    b.part(
        "bottle",
        b.cylinder(radius, 0, height),
        b.cone(radius, 0.4 * radius, height, height + 0.04),
        slab(0.012, (-0.09, 0.03), (height + 0.035, height + 0.07)),
    )
    g = b.gap(0.01)
    b.part("trigger", beam(0.016, 0.008, (0, -0.07, height + 0.034 - g), (0, -0.09, height - 0.03), Y))
    b.hinge("trigger", parent="bottle", axis=X, pivot=(0, -0.07, height + 0.034 - g), upper=0.35, ajar=False)
    b.part("nozzle", b.cylinder(0.009, (0, -0.09 - g, height + 0.055), (0, -0.108, height + 0.055)))
    b.spin("nozzle", parent="bottle", axis=-Y, pivot=(0, -0.09, height + 0.055))


@kind("dishwasher with racks", like="dishwasher", height=length(0.8, 0.87))
def dishwasher_with_racks(b: ObjectBuilder, height: float) -> None:
    """A dishwasher: a door that folds down, two racks that roll out."""
    width = b.pick(0.45, 0.6)
    t = 0.55
    case(b, "washer", lower=(-width / 2, 0, 0), upper=(width / 2, t, height), opening=-Y, wall=0.025, material="steel")
    if not b.style.hollow:
        b.cut("washer", slab(width / 2 - 0.025, (-0.1, t - 0.03), (0.12, height - 0.025)))
    b.part("washer", slab(width / 2, (0.001, t), (0, 0.12)))
    leaf(
        b,
        "door",
        parent="washer",
        lower=(-width / 2, -0.04, 0.1),
        upper=(width / 2, 0, height),
        hinge=-Z,
        out=-Y,
        reach=1.5,
        material="steel",
    )
    g = b.gap(0.05)
    for k, z in enumerate((0.17, 0.5 * height)):
        a = width / 2 - 0.03 - g
        b.part(f"rack_{k}", slab(a, (0.02, t - 0.06), (z, z + 0.015)), look="metal")
        for x in (-a, a - 0.008):
            b.part(f"rack_{k}", box((x, 0.02, z), (x + 0.008, t - 0.06, z + 0.12)))
        for y in spread(b.count(3, 6), 0.04, t - 0.08):
            b.part(f"rack_{k}", b.cylinder(0.004, (-a, y, z + 0.1), (a, y, z + 0.1)))
        b.slide(f"rack_{k}", parent="washer", axis=-Y, upper=0.4)


@kind("lazy susan", like="cake_stand", radius=length(0.15, 0.35))
def lazy_susan(b: ObjectBuilder, radius: float) -> None:
    b.part("base", b.cylinder(0.4 * radius, 0, 0.02), b.cylinder(0.02, 0.02, 0.028), look="wood")
    b.part("tray", b.cylinder(radius, 0.021, 0.05), look="wood")
    b.cut("tray", b.cylinder(0.95 * radius, 0.036, 0.1), b.cylinder(0.022, 0, 0.03))
    b.spin("tray", parent="base", axis=Z, pivot=(0, 0, 0))


@kind("radio", like="boombox", width=length(0.18, 0.3), height=length(0.12, 0.18))
def radio(b: ObjectBuilder, width: float, height: float) -> None:
    w = width / 2
    b.part("case", slab(w, 0.03, (0, height)), look="wood")
    for k, x in enumerate((0.4 * w, 0.75 * w)):
        knob(b, f"knob_{k}", parent="case", at=(x, -0.03, 0.35 * height), radius=0.016, high=0.015, out=-Y)
    b.part(
        "case",
        [
            box((-0.85 * w, -0.033, z - 0.002), (0.1 * w, -0.029, z + 0.002))
            for z in spread(8, 0.15 * height, 0.85 * height)
        ],
        b.cylinder(0.005, (-0.8 * w, 0.02, height - 0.01), (-0.8 * w, 0.02, height + 0.06)),
    )
    b.bore("case", b.cylinder(0.0037, (-0.8 * w, 0.02, 0.02), (-0.8 * w, 0.02, height + 0.1)))
    b.part(
        "antenna",
        b.cylinder(0.0025, (-0.8 * w, 0.02, 0.025), (-0.8 * w, 0.02, height + 0.07)),
        ball(0.004, (-0.8 * w, 0.02, height + 0.072)),
        look="chrome",
    )
    b.slide("antenna", parent="case", axis=Z, upper=0.1)
    bail(
        b,
        "handle",
        parent="case",
        start=(-w, 0, height - 0.02),
        end=(w, 0, height - 0.02),
        high=0.05,
        thick=0.008,
        up=Z,
        lower=-1.2,
        upper=1.2,
    )


@kind("ceiling fan", like="fan", height=length(0.2, 0.4), radius=length(0.4, 0.7))
def ceiling_fan(b: ObjectBuilder, height: float, radius: float) -> None:
    """Blades on a motor below a rod, pull chain now and then."""
    b.part(
        "mount",
        b.cylinder(0.06, height, height + 0.04),
        b.cylinder(0.012, 0, height + 0.02),
        b.cylinder(0.08, -0.06, 0.02),
        look="metal",
    )
    rotor(b, "rotor", parent="mount", at=(0, 0, -0.06), out=-Z, radius=radius, blades=b.count(3, 5), wide=0.2)
