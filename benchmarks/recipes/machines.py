"""Tools, machines, fittings and controls of workshops, plants and offices."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import (
    arm,
    bail,
    button,
    case,
    caster,
    drawer,
    knob,
    leaf,
    lever,
    plunger,
    rotor,
)
from benchmarks.recipes.object_builder import spread
from benchmarks.recipes.shapes import (
    X,
    Y,
    Z,
    ball,
    beam,
    block,
    box,
    capsule,
    cone,
    prism,
    ring,
    rod,
    scaled,
    tube,
)

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder
    from benchmarks.recipes.shapes import Shape

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def toolbox(d: ObjectBuilder) -> None:
    """A case with a lid, a bail and drawers."""
    w, t, h = d.u(0.35, 0.6), d.u(0.18, 0.3), d.u(0.15, 0.3)
    case(d, "box", (-w / 2, -t / 2, 0), (w / 2, t / 2, h), opening=Z, wall=0.008, material="steel")
    leaf(d, "lid", "box", (-w / 2, -t / 2, h), (w / 2, t / 2, h + 0.04), hinge=Y, out=Z, reach=1.6, handle=False,
        material="steel")
    if d.maybe():
        bail(d, "handle", "lid", (-0.3 * w, 0, h + 0.05), (0.3 * w, 0, h + 0.05), 0.08, 0.012, Z, lower=-0.5, upper=0.5)
        d.part("lid", *(block((s * 0.29 * w, 0, h + 0.045), (0.02 * w, 0.03, 0.03)) for s in (-1, 1)))
    g = d.gap(0.03)
    for k, s in enumerate((-1.0, 1.0)):
        x = s * 0.35 * w
        d.part(f"latch_{k}", box((x - 0.015, -t / 2 - 0.008 - g, h - 0.03), (x + 0.015, -t / 2 - g, h + 0.02)),
            material="steel")
        d.hinge(f"latch_{k}", "box", X, (x, -t / 2 - g - 0.008 * d.pick(0, 1), h - 0.03), 1.4, initial_opening=False)


def tool_cart(d: ObjectBuilder) -> None:
    """Drawers of many heights, a lid, casters, a push bar."""
    w, t, z, h = d.u(0.55, 0.8), d.u(0.4, 0.5), 0.13, d.u(0.75, 1.0)
    case(d, "cabinet", (-w / 2, -t / 2, z), (w / 2, t / 2, h), material="steel")
    d.part("cabinet", *(beam(0.02, 0.02, (w / 2, s * 0.4 * t, h - 0.08), (w / 2 + 0.07, s * 0.4 * t,
        h - 0.08)) for s in (-1, 1)), rod(0.014, (w / 2 + 0.07, -0.45 * t, h - 0.08), (w / 2 + 0.07, 0.45 * t,
        h - 0.08)))
    low = z + 0.02
    for k, share in enumerate(sorted((d.u(0.5, 1.5) for _ in range(d.n(3, 6))), reverse=True)):
        top = low + share * 0.115
        if top > h - 0.03:
            break
        drawer(d, f"drawer_{k}", "cabinet", (-0.46 * w, -t / 2, low), (0.46 * w, 0.4 * t, top), out=-Y,
            material="steel")
        low = top + 0.012
    if d.maybe():
        leaf(d, "lid", "cabinet", (-w / 2, -t / 2, h), (w / 2, t / 2, h + 0.04), hinge=Y, out=Z, reach=1.4,
            handle=False)
    for k, (x, y) in enumerate([(x, y) for x in (-0.42 * w, 0.42 * w) for y in (-0.4 * t, 0.4 * t)]):
        caster(d, f"caster_{k}", "cabinet", (x, y, z), z)


def bench_vice(d: ObjectBuilder) -> None:
    """A jaw that slides, a screw with a tommy bar."""
    w, n = d.u(0.1, 0.16), d.u(0.2, 0.3)
    d.part("body", box((-w / 2, 0, 0), (w / 2, 0.7 * n, 0.06)), box((-w / 2, 0, 0), (w / 2, 0.12 * n, 0.14)),
        box((-0.3 * w, 0.1 * n, 0.05), (0.3 * w, 0.7 * n, 0.1)), material="steel")
    g = d.gap(0.03) + 0.0004
    y = -d.u(0.05, 0.3) * n
    d.bore("body", box((-0.16 * w - g, -0.1, 0.06 - g), (0.16 * w + g, n, 0.09 + g)))
    d.part("jaw", box((-w / 2, y - 0.12 * n, 0.03), (w / 2, y, 0.14)), box((-0.16 * w, y - 0.01, 0.06), (0.16 * w,
        0.5 * n if d.hand.has_bore else -g, 0.09)), material="steel")
    d.slide("jaw", "body", -Y, 0.3 * n, y + g, initial_opening=False)
    at = np.array([0, y - 0.12 * n, 0.075])
    d.part("screw", rod(0.014, at - g * Y, at - 0.05 * Y), rod(0.005, at + np.array([-0.07, -0.04, 0]),
        at + np.array([0.07, -0.04, 0])), material="steel")
    d.spin("screw", "jaw", -Y, at)


def drill_press(d: ObjectBuilder) -> None:
    """A table that slides on the column, a quill, a star handle, a chuck."""
    h = d.u(0.7, 1.6)
    d.part("stand", box((-0.15, -0.25, 0), (0.15, 0.15, 0.04)), rod(0.035, (0, 0.08, 0.03), (0, 0.08, h)), box((-0.09,
        -0.22, h - 0.2), (0.09, 0.14, h)), material="steel")
    g = d.gap(0.03) + 0.0004
    z = d.u(0.25, 0.45) * h
    d.part("table", box((-0.13, -0.24, z), (0.13, 0.02, z + 0.025)), tube(0.055, 0.036 + g if d.hand.has_bore else 0.01,
        (0, 0.08, z - 0.04), (0, 0.08, z + 0.06)), box((-0.04, -0.1, z - 0.02), (0.04, 0.035, z + 0.01)),
        material="steel")
    d.bore("table", rod(0.036 + 1.5 * g, (0, 0.08, 0), (0, 0.08, h)))
    d.slide("table", "stand", Z, 0.15 * h, -0.1 * h, initial_opening=False)
    q = np.array([0, -0.14, h - 0.2])
    d.part("quill", rod(0.03, q - 0.06 * Z, q + (0.1 * Z if d.hand.has_bore else -g * Z)), material="steel")
    d.bore("stand", rod(0.03 + 1.5 * g, q - Z, q + 0.12 * Z))
    d.slide("quill", "stand", -Z, 0.03 if not d.hand.has_bore else 0.08, initial_opening=False)
    d.part("chuck", cone(0.014, 0.022, q - 0.11 * Z, q - (0.06 + g) * Z), rod(0.004, q - 0.18 * Z, q - 0.1 * Z),
        material="steel")
    d.spin("chuck", "quill", Z, q - 0.06 * Z)
    at = np.array([0.09, -0.08, h - 0.12])
    d.part("feed", rod(0.018, at + g * X, at + 0.04 * X), *(rod(0.007, at + 0.025 * X,
        at + 0.04 * X + 0.16 * np.array([0.2, np.cos(a), np.sin(a)])) for a in np.arange(3) * 2.1), material="steel")
    d.hinge("feed", "stand", X, at, 3.0, -0.2, initial_opening=False)


def lathe_machine(d: ObjectBuilder) -> None:
    """A spindle, a carriage on a bed, a tailstock, handwheels."""
    n = d.u(1.2, 2.0)
    d.part("bed", box((-n / 2, -0.14, 0), (n / 2, 0.14, 0.1)), box((-n / 2, -0.02, 0.05), (n / 2, 0.02, 0.14)),
        box((-n / 2, -0.14, 0.08), (-n / 2 + 0.3, 0.14, 0.4)), material="steel")
    g = d.gap(0.03) + 0.0004
    at = np.array([-n / 2 + 0.3, 0, 0.28])
    d.part("chuck", rod(0.07, at + g * X, at + 0.06 * X), *(block(at + 0.07 * X + 0.045 * np.array([0, np.cos(a),
        np.sin(a)]), (0.04, 0.02, 0.02)) for a in np.arange(3) * 2.1), material="steel")
    d.spin("chuck", "bed", X, at)
    x_carriage = d.u(0.0, 0.08) * n
    for name, x, h in (("carriage", x_carriage, 0.24), ("tailstock", 0.4 * n, 0.31)):
        d.part(name, box((x - 0.07, -0.13, 0.1 + g), (x + 0.07, 0.13, 0.18)), box((x - 0.04, -0.04, 0.15), (x + 0.04,
            0.04, h)), material="steel")
        d.bore(name, box((x - 1, -0.02 - g, 0), (x + 1, 0.02 + g, 0.14 + g)))
        d.slide(name, "bed", -X if name == "tailstock" else X, 0.12 * n, -0.06 * n, initial_opening=False)
    knob(d, "handwheel", "carriage", (x_carriage, -0.13, 0.14), 0.025, 0.03, -Y)


def press(d: ObjectBuilder) -> None:
    """An arbor press: a ram and a lever."""
    h = d.u(0.35, 0.6)
    d.part("frame", box((-0.08, -0.1, 0), (0.08, 0.14, 0.04)), box((-0.04, 0.05, 0.03), (0.04, 0.13, h)), box((-0.05,
        -0.06, h - 0.14), (0.05, 0.13, h)), material="steel")
    g = d.gap(0.02) + 0.0003
    a = 0.016
    d.bore("frame", box((-a - g, -a - g - 0.02, 0.05), (a + g, a + g - 0.02, h + 1)))
    d.part("ram", box((-a, -a - 0.02, 0.12), (a, a - 0.02, h + 0.06 if d.hand.has_bore else h - 0.14 - g)),
        material="steel")
    d.slide("ram", "frame", -Z, 0.06, initial_opening=False)
    lever(d, "lever", "frame", (0.05, 0.03, h - 0.06), X, np.array([0, -0.8, 0.6]), d.u(0.2, 0.4), reach=1.2)


def hand_pump(d: ObjectBuilder) -> None:
    """A well pump: a long lever on a post and a spout; the rod goes up and down."""
    h = d.u(0.7, 1.1)
    d.part("post", rod(0.09, (0, 0, 0), (0, 0, 0.04)), rod(0.055, (0, 0, 0.03), (0, 0, h)), capsule(0.025, (0, 0,
        0.75 * h), (0.2, 0, 0.72 * h)), beam(0.03, 0.03, (-0.04, 0, h - 0.05), (-0.12, 0, h + 0.05), Y),
        material="steel")
    g = d.gap(0.02) + 0.0005
    d.bore("post", rod(0.01 + 1.5 * g, (0, 0, 0.4), (0, 0, h + 1)))
    d.part("rod", rod(0.01, (0, 0, 0.5 * h if d.hand.has_bore else h + g), (0, 0, h + 0.12)), material="steel")
    d.slide("rod", "post", Z, 0.08, initial_opening=False)
    arm(d, "handle", "post", (-0.12, 0, h + 0.05), (-0.6, 0, h - 0.2), 0.03, Y, lower=-0.4, upper=0.4)


def gate_valve(d: ObjectBuilder) -> None:
    """A handwheel above a body between flanges."""
    r = d.u(0.02, 0.15)
    d.part("body", tube(r, 0.7 * r, (-3 * r, 0, 0), (3 * r, 0, 0)), *(tube(1.7 * r, 0.7 * r, (s * 3 * r, 0, 0),
        (s * 2.6 * r, 0, 0)) for s in (-1, 1)), ball(1.3 * r, (0, 0, 0)), cone(0.9 * r, 0.5 * r, (0, 0, r), (0, 0,
        3 * r)), material="steel")
    g = d.gap(r)
    at = np.array([0, 0, 3 * r])
    n = d.n(3, 6)
    d.part("handwheel", rod(0.25 * r, at + g * Z, at + 1.2 * r * Z), ring(1.6 * r, 0.18 * r, at + 0.9 * r * Z, Z),
        *(beam(0.2 * r, 0.15 * r, at + 0.9 * r * Z, at + 0.9 * r * Z + 1.6 * r * np.array([np.cos(a), np.sin(a),
        0])) for a in np.arange(n) * 2 * np.pi / n), material="steel")
    d.spin("handwheel", "body", Z, at) if d.maybe() else d.hinge("handwheel", "body", Z, at, 9.0, initial_opening=False)


def ball_valve(d: ObjectBuilder) -> None:
    """A lever that turns by a quarter above a pipe."""
    r, n = d.u(0.01, 0.06), d.n(1, 3)
    d.part("pipe", rod(r, (-4 * r * n, 0, 0), (4 * r * n, 0, 0)), material="steel")
    for k, x in enumerate(spread(n, -4 * r * n, 4 * r * n)):
        d.part("pipe", rod(1.4 * r, (x - 1.5 * r, 0, 0), (x + 1.5 * r, 0, 0)), rod(0.5 * r, (x, 0, 0), (x, 0, 1.8 * r)))
        lever(d, f"lever_{k}", "pipe", (x, 0, 1.8 * r), Z, d.pick(X, Y), 5.0 * r, reach=1.57)


def control_box(d: ObjectBuilder) -> None:
    """Knobs, push buttons, an emergency stop, switches and a key on a box."""
    w, h, t = d.u(0.15, 0.4), d.u(0.15, 0.5), d.u(0.06, 0.2)
    case(d, "box", (-w / 2, 0, 0), (w / 2, t, h), material="steel")
    rows = d.n(2, 4)
    for i, z in enumerate(spread(rows, 0.05 * h, 0.95 * h)):
        kind = d.pick("knobs", "buttons", "levers", "sliders")
        n = d.n(1, 4)
        pitch = min(0.9 * w / n, 0.8 * h / rows)
        for k, x in enumerate(spread(n, -0.45 * w, 0.45 * w)):
            name = f"{kind[:-1]}_{i}_{k}"
            if kind == "knobs":
                knob(d, name, "box", (x, 0, z), 0.3 * pitch, 0.3 * pitch, -Y, reach=d.pick(None, 4.7))
            elif kind == "buttons":
                button(d, name, "box", (x, 0, z), (0.6 * pitch, 0.6 * pitch), 0.15 * pitch, -Y, is_round=d.maybe(0.7))
            elif kind == "levers":
                g = d.gap(0.1 * pitch)
                tip = (x, -0.5 * pitch, z + 0.25 * pitch)
                d.part("box", rod(0.18 * pitch, (x, 0.01 * pitch, z), (x, -0.06 * pitch, z)))
                d.part(name, capsule(0.06 * pitch, (x, -0.12 * pitch - g, z), tip))
                d.hinge(name, "box", X, (x, -0.12 * pitch - g if d.hand.has_bore else 0.0, z), 0.8, -0.05,
                    initial_opening=False)
            else:
                g = d.gap(0.1 * pitch) + 0.0002
                d.bore("box", box((x - 0.05 * pitch - g, -0.01, z - 0.4 * pitch), (x + 0.05 * pitch + g, 0.1 * t,
                    z + 0.4 * pitch)))
                d.part(name, box((x - 0.05 * pitch, 0.05 * t if d.hand.has_bore else -g, z - 0.1 * pitch),
                    (x + 0.05 * pitch, -0.2 * pitch, z + 0.1 * pitch)), box((x - 0.12 * pitch, -0.08 * pitch,
                    z - 0.1 * pitch), (x + 0.12 * pitch, -0.25 * pitch, z + 0.1 * pitch)))
                d.slide(name, "box", Z, 0.25 * pitch, -0.25 * pitch, initial_opening=False)


def fuse_box(d: ObjectBuilder) -> None:
    """A door with switches behind or beside it."""
    w, h = d.u(0.2, 0.4), d.u(0.25, 0.5)
    case(d, "box", (-w / 2, 0, 0), (w / 2, 0.12, h), opening=-Y, wall=0.01, material="steel")
    d.part("box", box((-w / 2 + 0.005, 0.06, 0.005), (w / 2 - 0.005, 0.11, h - 0.005)))
    leaf(d, "door", "box", (-w / 2, -0.012, 0), (w / 2, 0, h), hinge=d.pick(X, -X), out=-Y, reach=2.0, material="steel")
    if d.hand.hollow:
        for k, x in enumerate(spread(d.n(3, 8), -0.4 * w, 0.4 * w)):
            g = d.gap(0.01)
            d.part(f"breaker_{k}", box((x - 0.006, 0.06 - g, 0.5 * h - 0.01), (x + 0.006, 0.035, 0.5 * h + 0.012)))
            d.hinge(f"breaker_{k}", "box", X, (x, 0.06 - g, 0.5 * h - 0.01), 0.6, initial_opening=False)


def knife_switch(d: ObjectBuilder) -> None:
    """A blade with a handle between clips."""
    n, w = d.n(1, 3), d.u(0.04, 0.08)
    d.part("board", box((-w * n, -0.01, -0.12), (w * n, 0.0, 0.12)), material="plastic")
    g = d.gap(0.005) + 0.0003
    xs = spread(n, -0.8 * w * n, 0.8 * w * n)
    for x in xs:
        for z in (-0.08, 0.05):
            d.part("board", *(box((x + s * (0.004 + g), -0.04, z - 0.012), (x + s * (0.007 + g), -0.001,
                z + 0.012)) for s in (-1, 1)))
        d.part("blade", box((x - 0.004, -0.035, -0.085), (x + 0.004, -0.02, 0.09)), material="metal")
    d.part("blade", box((xs[0] - 0.005, -0.035, 0.09), (xs[-1] + 0.005, -0.02, 0.1)), rod(0.008, (0, -0.027, 0.095), (0,
        -0.09, 0.11)))
    if not d.hand.has_bore:
        d.part(d.pick("board", "blade"), rod(0.003, (xs[0] - 0.01, -0.0275, -0.08), (xs[-1] + 0.01, -0.0275, -0.08)))
    d.hinge("blade", "board", X, (0, -0.0275, -0.08), 1.2)


def big_lever_console(d: ObjectBuilder) -> None:
    """Levers in slots on a desk, joysticks, pedals below."""
    w = d.u(0.5, 1.2)
    d.part("console", prism([(0, 0), (0.5, 0), (0.5, 0.9), (0.3, 0.9), (0, 0.75)], (0, 0, 0), w, "x"), material="steel")
    n = d.n(2, 5)
    up = np.array([0, -0.15, 0.3]) / np.hypot(0.15, 0.3)
    for k, x in enumerate(spread(n, -0.45 * w, 0.45 * w)):
        at = np.array([x, 0.15, 0.825])
        g = d.gap(0.02) + 0.001
        d.bore("console", box((x - 0.009 - g, 0.03, 0.7), (x + 0.009 + g, 0.27, 1.0)))
        d.part(f"lever_{k}", rod(0.008, at - (0.06 * up if d.hand.has_bore else -g * up), at + 0.2 * up), ball(0.02,
            at + 0.21 * up))
        d.hinge(f"lever_{k}", "console", X, at - (0.05 * up if d.hand.has_bore else 0 * up), 0.35, -0.35,
            initial_opening=False)
    for k, x in enumerate(spread(d.n(0, 2) or 1, -0.3 * w, 0.3 * w)):
        g = d.gap(0.02) + 0.0005
        d.part(f"pedal_{k}", beam(0.08, 0.015, (x, -g, 0.06), (x, -0.2, 0.14), Z), material="metal")
        d.hinge(f"pedal_{k}", "console", X, (x, -g, 0.05), 0.3, initial_opening=False)


def robot_arm(d: ObjectBuilder) -> None:
    """Four to six links of blocks and cylinders; turns about z, then y, y, x, y."""
    k = d.u(0.3, 1.2)
    d.part("base", rod(0.16 * k, (0, 0, 0), (0, 0, 0.12 * k)), material="steel")
    g = d.gap(0.1 * k)
    d.part("shoulder", rod(0.13 * k, (0, 0, 0.12 * k + g), (0, 0, 0.25 * k)), box((-0.06 * k, -0.05 * k, 0.2 * k),
        (0.06 * k, 0.05 * k, 0.36 * k)))
    d.hinge("shoulder", "base", Z, (0, 0, 0.12 * k), 2.9, -2.9, initial_opening=False)
    step = 0.1 * k + d.gap(0.1 * k) if d.hand.has_bore else 0.0
    chain = [np.array([0, 0, 0.32 * k]), np.array([0.1 * k, 0, 0.75 * k]), np.array([0.5 * k, 0, 0.8 * k]),
        np.array([0.62 * k, 0, 0.7 * k])]
    parent = "shoulder"
    for i, (a, b) in enumerate(pairwise(chain)):
        arm(d, f"link_{i}", parent, a + i * step * Y, b + i * step * Y, 0.1 * k, Y, lower=-1.0 if i else -0.6,
            upper=1.0 if i else 0.6)
        parent = f"link_{i}"
    end = chain[-1] + 3 * step * Y
    d.part("flange", rod(0.04 * k, end + np.array([0.05 * k + g + 0.02 * k, 0, -0.06 * k]), end + np.array([0.12 * k, 0,
        -0.06 * k])))
    if not d.hand.has_bore:
        d.spin("flange", parent, X, end + np.array([0.07 * k, 0, -0.06 * k]))
    else:
        d.fix("flange", parent)


def scissor_table(d: ObjectBuilder) -> None:
    """A platform over a base; the links are left out, as quick models do."""
    w, t, h = d.u(0.5, 1.2), d.u(0.4, 0.8), d.u(0.3, 0.6)
    d.part("base", box((-w / 2, -t / 2, 0), (w / 2, t / 2, 0.06)), tube(0.05, 0.035, (0, 0, 0.05), (0, 0, 0.8 * h)),
        material="steel")
    g = d.gap(0.03) + 0.0005
    d.part("platform", box((-w / 2, -t / 2, h), (w / 2, t / 2, h + 0.05)),
        rod(0.035 - 1.5 * g if d.hand.has_bore else 0.035, (0, 0, 0.3 * h), (0, 0, h + 0.01)), material="steel")
    d.slide("platform", "base", Z, 0.4 * h, -0.1 * h, initial_opening=False)


def bottle_jack(d: ObjectBuilder) -> None:
    """A post that rises out of a body, with a lever."""
    r, h = d.u(0.03, 0.05), d.u(0.15, 0.25)
    d.part("body", box((-2 * r, -2 * r, 0), (2 * r, 2 * r, 0.02)), rod(1.3 * r, (0, 0, 0.01), (0, 0, h)), rod(0.5 * r,
        (1.6 * r, 0, 0), (1.6 * r, 0, 0.5 * h)), box((0, -0.4 * r, 0.3 * h), (2 * r, 0.4 * r, 0.4 * h)),
        material="steel")
    plunger(d, "post", "body", (0, 0, h + 0.02), (0, 0, 0.2 * h), 0.7 * r, travel=0.6 * h)
    arm(d, "lever", "body", (1.6 * r, 0, 0.5 * h), (1.6 * r + 0.3, 0, 0.6 * h), 0.5 * r, Y, lower=-0.8, upper=0.2)


def telescope_mast(d: ObjectBuilder) -> None:
    """Three to five tubes in each other: a mast, an antenna, a crane's boom."""
    n, r, h = d.n(2, 4), d.u(0.02, 0.1), d.u(0.4, 1.5)
    square = d.maybe()
    lying = d.maybe(0.3)
    along, foot = (Y, 3 * r * Z) if lying else (Z, 0 * Z)

    def shape(q: float, a: float, b: float) -> Shape:
        ends = foot + a * along, foot + b * along
        return beam(2 * q, 2 * q, *ends) if square else rod(q, *ends)

    d.part("tube_0", shape(r, 0, h), block(foot, (4 * r, 4 * r, 0.3 * r)) if not lying else box((-1.5 * r, 0, 0),
        (1.5 * r, 0.4 * h, 2.2 * r)), material="steel")
    for k in range(1, n + 1):
        q = r * (1 - 0.2 * k)
        g = d.gap(0.1 * r) + 0.0002
        d.part(f"tube_{k}", shape(q, 0.05 * h * k + 0.01, h + 0.08 * h * k) if d.hand.has_bore else shape(q,
            h + 0.08 * h * (k - 1), h + 0.08 * h * k + 0.08 * h), material="metal")
        d.bore(f"tube_{k - 1}", shape(q + 1.5 * g, 0.04 * h * k, 3 * h))
        d.slide(f"tube_{k}", f"tube_{k - 1}", along, 0.6 * h)


def syringe(d: ObjectBuilder) -> None:
    """A syringe: a plunger in a barrel."""
    r, n = d.u(0.004, 0.02), d.u(0.06, 0.15)
    up = d.pick(X, Z)
    d.part("barrel", rod(r, 0 * up, n * up), rod(0.3 * r, -0.15 * n * up, 0.01 * up), beam(4 * r, 1.5 * r,
        n * up - 0.002 * up, n * up, Y), material="glass")
    plunger(d, "plunger", "barrel", (n + d.u(0.1, 0.7) * n) * up, 0.25 * n * up, 0.8 * r, travel=0.2 * n)
    d.part("plunger", rod(1.5 * r, 1.95 * n * up, (1.95 * n + 0.004) * up), rod(0.6 * r, 0.9 * n * up, 1.95 * n * up))


def cable_reel(d: ObjectBuilder) -> None:
    """A drum with flanges on a stand, with a crank."""
    r, w = d.u(0.1, 0.4), 0.0
    w = d.u(0.6, 1.2) * r
    c = np.array([0, 0, 1.2 * r])
    for s in (-1.0, 1.0):
        d.part("stand", beam(0.08 * r, 0.08 * r, (s * (w / 2 + 0.12 * r), -0.8 * r, 0), c + s * (w / 2 + 0.12 * r) * X,
            X), beam(0.08 * r, 0.08 * r, (s * (w / 2 + 0.12 * r), 0.8 * r, 0), c + s * (w / 2 + 0.12 * r) * X, X),
            material="steel")
    d.part("stand", beam(0.08 * r, 0.08 * r, (-w / 2 - 0.12 * r, 0.8 * r, 0.04 * r), (w / 2 + 0.12 * r, 0.8 * r,
        0.04 * r)), beam(0.08 * r, 0.08 * r, (-w / 2 - 0.12 * r, -0.8 * r, 0.04 * r), (w / 2 + 0.12 * r, -0.8 * r,
        0.04 * r)))
    g = d.gap(0.05 * r) + 0.0003
    d.part("drum", rod(0.5 * r, c - w / 2 * X, c + w / 2 * X), *(rod(r, c + s * w / 2 * X,
        c + s * (w / 2 - 0.05 * r) * X) for s in (-1, 1)), rod(0.03 * r, c - (w / 2 + 0.2 * r) * X,
        c + (w / 2 + 0.2 * r) * X), material="wood")
    if d.maybe():
        e = c + (w / 2 + 0.2 * r) * X
        d.part("drum", beam(0.05 * r, 0.05 * r, e, e + 0.4 * r * Y), rod(0.03 * r, e + 0.38 * r * Y,
            e + 0.38 * r * Y + 0.3 * r * X))
    d.bore("stand", rod(0.03 * r + 1.5 * g, c - 2 * r * X, c + 2 * r * X))
    d.spin("drum", "stand", X, c)


def conveyor(d: ObjectBuilder) -> None:
    """Rollers between two rails."""
    n, w, k = d.n(5, 10), d.u(0.3, 0.8), d.u(0.05, 0.09)
    length = 2.6 * k * n
    for s in (-1.0, 1.0):
        d.part("frame", box((0, s * w / 2, 0.5), (length, s * (w / 2 + 0.03), 0.6)), *(box((x - 0.02, s * w / 2, 0),
            (x + 0.02, s * (w / 2 + 0.03), 0.55)) for x in (0.1 * length, 0.9 * length)), material="steel")
    d.part("frame", *(box((x - 0.02, -w / 2, 0.2), (x + 0.02, w / 2, 0.24)) for x in (0.1 * length, 0.9 * length)))
    g = d.gap(0.02) + 0.0005
    for i, x in enumerate(spread(n, 0, length)):
        c = np.array([x, 0, 0.58])
        d.part(f"roller_{i}", rod(k, c - (w / 2 - g) * Y, c + (w / 2 - g) * Y), material="metal")
        if d.hand.barrels or d.hand.has_bore:
            d.part(f"roller_{i}", rod(0.25 * k, c - (w / 2 + 0.02) * Y, c + (w / 2 + 0.02) * Y))
            d.bore("frame", rod(0.25 * k + 1.5 * g, c - w * Y, c + w * Y))
        d.spin(f"roller_{i}", "frame", Y, c)


def gear_train(d: ObjectBuilder) -> None:
    """Toothed wheels side by side on a plate; the others follow the first."""
    n, r = d.n(2, 4), d.u(0.03, 0.08)
    radii = [r * d.u(0.6, 1.4) for _ in range(n)]
    xs = np.cumsum([0.0] + [1.08 * (a + b) for a, b in pairwise(radii)])
    d.part("plate", box((-1.2 * radii[0], 0, -1.5 * r), (xs[-1] + 1.2 * radii[-1], 0.01, 1.5 * r)), material="steel")
    g = d.gap(0.1 * r) + 0.0002
    for k, (x, q) in enumerate(zip(xs, radii, strict=True)):
        c = np.array([x, 0, 0])
        teeth = [beam(0.12 * q, 0.012, c - (g + 0.008) * Y, c - (g + 0.008) * Y + q * np.array([np.cos(a), 0,
            np.sin(a)]), Y) for a in np.arange(12) * np.pi / 6]
        d.part(f"gear_{k}", rod(0.88 * q, c - g * Y, c - (g + 0.015) * Y), *teeth, rod(0.15 * q, c - g * Y,
            c - 0.04 * Y), material="metal")
        d.spin(f"gear_{k}", "plate", -Y, c)
        if k:
            d.follow(f"gear_{k}", "gear_0", (-1.0) ** k * radii[0] / q)


def microscope(d: ObjectBuilder) -> None:
    """A stage that slides, a turret, focus knobs, a tilting tube."""
    k = d.u(0.8, 1.2)
    p = scaled(k)
    d.part("stand", box(p(-0.08, -0.1, 0), p(0.08, 0.1, 0.03)), box(p(-0.03, 0.05, 0.02), p(0.03, 0.09, 0.3)),
        box(p(-0.03, -0.04, 0.27), p(0.03, 0.09, 0.31)), rod(0.02 * k, p(0, -0.02, 0.3), p(0, -0.09, 0.4)),
        material="metal")
    g = d.gap(0.01) + 0.0003
    d.part("stage", box(p(-0.07, -0.09, 0.13), p(0.07, 0.05, 0.14) - g * Y), box(p(-0.02, 0.02, 0.12), p(0.02, 0.05,
        0.17) - g * Y))
    d.slide("stage", "stand", Z, 0.03 * k, -0.03 * k, initial_opening=False)
    at = p(0, -0.02, 0.27)
    d.part("turret", rod(0.025 * k, at - g * Z, at - 0.015 * k * Z), *(rod(0.006 * k, at - 0.01 * k * Z + 0.015 * k * v,
        at - 0.05 * k * Z + 0.018 * k * v) for v in (X, -0.5 * X + 0.87 * Y, -0.5 * X - 0.87 * Y)), material="metal")
    d.spin("turret", "stand", Z, at)
    for s in (-1.0, 1.0):
        knob(d, f"focus_{int(s > 0)}", "stand", p(s * 0.03, 0.07, 0.08), 0.02 * k, 0.02 * k, s * X)


def balance_scale(d: ObjectBuilder) -> None:
    """A beam that tilts on a post, two pans that hang."""
    k = d.u(0.2, 0.5)
    d.part("stand", rod(0.25 * k, (0, 0, 0), (0, 0, 0.04 * k)), rod(0.03 * k, (0, 0, 0), (0, 0, k)), material="metal")
    g = d.gap(0.03 * k)
    z = k + g + 0.02 * k
    d.part("beam", box((-0.5 * k, -0.02 * k, z - 0.02 * k), (0.5 * k, 0.02 * k, z + 0.02 * k)), material="metal")
    d.hinge("beam", "stand", Y, (0, 0, d.pick(z, k)), 0.15, -0.15, initial_opening=False)
    for i, s in enumerate((-1.0, 1.0)):
        x = s * 0.47 * k
        low = z - 0.02 * k - g
        d.part(f"pan_{i}", rod(0.008 * k, (x, 0, low), (x, 0, low - 0.45 * k)), rod(0.18 * k, (x, 0, low - 0.47 * k),
            (x, 0, low - 0.45 * k)))
        d.hinge(f"pan_{i}", "beam", Y, (x, 0, low), 0.3, -0.3, initial_opening=False)


def desk_fan(d: ObjectBuilder) -> None:
    """A base, a neck that tilts, a guard with a rotor."""
    r, h = d.u(0.1, 0.2), d.u(0.2, 0.35)
    d.part("base", rod(0.8 * r, (0, 0, 0), (0, 0, 0.03)), rod(0.12 * r, (0, 0.1 * r, 0.02), (0, 0.1 * r, h)))
    g = d.gap(0.02)
    c = np.array([0, 0.1 * r, h + 0.25 * r + g])
    d.part("head", rod(0.25 * r, c + 0.4 * r * Y, c - 0.2 * r * Y), ring(r, 0.04 * r, c - 0.45 * r * Y, Y),
        *(beam(0.02 * r, 0.02 * r, c - 0.19 * r * Y + 0.22 * r * v, c - 0.45 * r * Y + r * v) for v in (X, -X, Z, -Z)))
    d.hinge("head", "base", X, (0, 0.1 * r, h + (g if d.hand.has_bore else 0)), 0.02 if d.hand.has_bore else 0.4,
        initial_opening=False)
    rotor(d, "rotor", "head", c - 0.2 * r * Y, -Y, 0.7 * r, d.n(3, 5), wide=0.25)


def reading_lamp(d: ObjectBuilder) -> None:
    """Two arms and a shade on a foot."""
    k = d.u(0.25, 0.45)
    d.part("foot", rod(0.3 * k, (0, 0, 0), (0, 0, 0.06 * k)), rod(0.05 * k, (0, 0, 0.05 * k), (0, 0, 0.2 * k)),
        material="metal")
    step = 0.06 * k + d.gap(0.06 * k) if d.hand.has_bore else 0.0
    a, b, c = np.array([0, 0, 0.18 * k]), np.array([-0.35 * k, 0, 1.0 * k]), np.array([0.5 * k, 0, 1.5 * k])
    arm(d, "lower_arm", "foot", a, b, 0.06 * k, Y, lower=-0.5, upper=0.5)
    arm(d, "upper_arm", "lower_arm", b + step * Y, c + step * Y, 0.06 * k, Y, lower=-0.6, upper=0.6)
    g = d.gap(0.05 * k)
    e = c + 2 * step * Y
    d.part("shade", cone(0.08 * k, 0.3 * k, e + (0.04 * k + g) * X + 0.0 * Z, e + 0.4 * k * X - 0.2 * k * Z))
    d.hinge("shade", "upper_arm", Y, e + (0 if not d.hand.has_bore else 0.03 * k) * X, 0.05 if d.hand.has_bore else 0.8,
        -0.05 if d.hand.has_bore else -0.5, initial_opening=False)


def pallet_truck(d: ObjectBuilder) -> None:
    """Two forks, a drawbar that swings, wheels under it."""
    n, r = d.u(1.0, 1.3), 0.09
    d.part("truck", *(box((0, s * 0.2 - 0.08, 0.08), (n, s * 0.2 + 0.08, 0.13)) for s in (-1, 1)), box((-0.2, -0.28,
        0.2), (0.02, 0.28, 0.45)), *(box((-0.02, s * 0.2 - 0.08, 0.08), (0.02, s * 0.2 + 0.08, 0.3)) for s in (-1, 1)),
        material="steel")
    g = d.gap(0.05) + 0.0005
    d.part("drawbar_head", rod(0.05, (-0.1, 0, 0.2 - g), (-0.1, 0, 0.14)), box((-0.16, -0.05, 0.06), (-0.04, 0.05,
        0.15)), material="steel")
    d.hinge("drawbar_head", "truck", Z, (-0.1, 0, 0.2), 1.5, -1.5, initial_opening=False)
    for s in (-1.0, 1.0):
        d.part(f"wheel_{int(s > 0)}", rod(r, (-0.1, s * (0.05 + g), r), (-0.1, s * (0.11 + g), r)), material="rubber")
        d.spin(f"wheel_{int(s > 0)}", "drawbar_head", s * Y, (-0.1, 0, r))
    d.part("drawbar", beam(0.04, 0.04, (-0.16 - g, 0, 0.12), (-0.4, 0, 1.1), Y), rod(0.015, (-0.4, -0.15, 1.1), (-0.4,
        0.15, 1.1)), material="steel")
    d.hinge("drawbar", "drawbar_head", -Y, (-0.16 - g, 0, 0.12), 0.5 if not d.hand.has_bore else 0.3,
        initial_opening=False)


def door_bolt(d: ObjectBuilder) -> None:
    """A sliding bolt in guides with a keeper."""
    n = d.u(0.08, 0.25)
    k = 0.06 * n
    d.part("plate", box((0, 0, -2.5 * k), (n, k * 0.5, 2.5 * k)), box((n + 2 * k, 0, -2.5 * k), (n + 4 * k, k * 0.5,
        2.5 * k)), box((n - 0.01 * n, 0.2 * k, -0.4 * k), (n + 2.1 * k, 0.5 * k, 0.4 * k)), material="steel")
    g = d.gap(0.2 * k) + 0.0001
    y = -(k + g)
    for x in (0.25 * n, 0.8 * n):
        d.part("plate", box((x - k, y - 1.6 * k, -1.8 * k), (x + k, 0.1 * k, 1.8 * k)))
    d.bore("plate", rod(k + 1.5 * g, (-n, y, 0), (2 * n, y, 0)))
    d.part("bolt", rod(k, (0.02 * n, y, 0), (n, y, 0)), rod(0.6 * k, (0.5 * n, y, 0), (0.5 * n, y - 3.0 * k, 0)),
        material="steel")
    d.slide("bolt", "plate", X, 3 * k)


def hasp_latch(d: ObjectBuilder) -> None:
    """A toggle or hook that turns on a plate."""
    k = d.u(0.02, 0.06)
    d.part("plate", box((-k, 0, -k), (k, 0.15 * k, k)), box((2.5 * k, 0, -k), (3.5 * k, 0.15 * k, k)), box((-k, 0.1 * k,
        -0.4 * k), (3.5 * k, 0.3 * k, 0.4 * k)), rod(0.2 * k, (3.0 * k, 0.1 * k, 0), (3.0 * k, -0.8 * k, 0)),
        material="steel")
    g = d.gap(0.1 * k)
    hook = d.maybe()
    d.part("hook", beam(0.3 * k, 0.4 * k, (-0.2 * k, -0.2 * k - g, 0), (2.7 * k, -0.2 * k - g, 0)), rod(0.3 * k, (0, -g,
        0), (0, -0.45 * k - g, 0)), material="steel")
    if hook:
        d.part("hook", beam(0.3 * k, 0.4 * k, (2.6 * k, -0.2 * k - g, 0.1 * k), (2.6 * k, -0.2 * k - g, 0.9 * k), Y))
    d.hinge("hook", "plate", -Y, (0, 0, 0), 2.0, initial_opening=False)


def pulley_block(d: ObjectBuilder) -> None:
    """Sheaves between cheeks with a hook that swivels."""
    r = d.u(0.03, 0.15)
    n = d.n(1, 3)
    pitch = 0.45 * r
    g = d.gap(0.05 * r) + 0.0002
    ys = spread(n, -n * pitch / 2, n * pitch / 2)
    for y in (-n * pitch / 2 - 0.05 * r, n * pitch / 2 + 0.05 * r):
        d.part("block", box((-0.5 * r, y - 0.05 * r, -1.2 * r), (0.5 * r, y + 0.05 * r, 1.2 * r)), material="steel")
    d.part("block", box((-0.5 * r, -n * pitch / 2 - 0.1 * r, -1.4 * r), (0.5 * r, n * pitch / 2 + 0.1 * r, -1.15 * r)),
        box((-0.5 * r, -n * pitch / 2 - 0.1 * r, 1.15 * r), (0.5 * r, n * pitch / 2 + 0.1 * r, 1.4 * r)))
    d.part("block", rod(0.12 * r, (0, -n * pitch / 2, 0), (0, n * pitch / 2, 0)))
    for k, y in enumerate(ys):
        d.part(f"sheave_{k}", rod(r, (0, y - 0.4 * pitch, 0), (0, y - 0.15 * pitch, 0)), rod(0.8 * r, (0,
            y - 0.2 * pitch, 0), (0, y + 0.2 * pitch, 0)), rod(r, (0, y + 0.15 * pitch, 0), (0, y + 0.4 * pitch, 0)),
            material="metal")
        d.bore(f"sheave_{k}", rod(0.12 * r + 1.5 * g, (0, -r * n, 0), (0, r * n, 0)))
        d.spin(f"sheave_{k}", "block", Y, (0, y, 0))
    d.part("hook", rod(0.12 * r, (0, 0, -1.4 * r - g), (0, 0, -1.8 * r)), ring(0.4 * r, 0.1 * r, (0, 0, -2.2 * r), Y),
        material="steel")
    d.spin("hook", "block", Z, (0, 0, -1.4 * r))
