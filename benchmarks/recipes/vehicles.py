"""What rides, sails, flies and rolls, and what stands outdoors."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes.mechanisms import arm, case, caster, grip, leaf, rotor, wheel
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
    lathe,
    prism,
    ring,
    rod,
    scaled,
    tube,
)

if TYPE_CHECKING:
    from benchmarks.recipes.object_builder import ObjectBuilder

# fmt: off
# A recipe reads as a list of shapes and joints, which one argument a line would hide.


def _axles(d: ObjectBuilder, on: str, xs: list[float], half: float, radius: float, wide: float, axle: float) -> None:
    """Pairs of wheels; the car drives along x, its sides are at y = -half and half."""
    for i, x in enumerate(xs):
        for s, side in ((-1.0, "right"), (1.0, "left")):
            wheel(d, f"wheel_{i}_{side}", on, (x, s * (half + axle + wide / 2), radius), radius, wide, s * Y, axle=axle)


def box_car(d: ObjectBuilder) -> None:
    """A car of boxes: four wheels, doors, a tailgate and a bonnet as they come."""
    n, w, r = d.u(2.5, 4.5), d.u(1.4, 1.9), d.u(0.25, 0.35)
    d.part("body", box((-n / 2, -w / 2, r), (n / 2, w / 2, r + 0.55)), box((-0.45 * n, -0.45 * w, r + 0.5), (0.15 * n,
        0.45 * w, r + 1.1)), material="steel")
    _axles(d, "body", [-0.32 * n, 0.32 * n], w / 2, r, d.u(0.15, 0.25), d.pick(0.01, 0.05))
    for s, side in ((-1.0, "right"), (1.0, "left")):
        if d.maybe(0.7):
            y = s * w / 2
            leaf(d, f"door_{side}", "body", (-0.12 * n, y, r + 0.1), (0.15 * n, y + s * 0.04, r + 0.5), hinge=X,
                out=s * Y, reach=1.1, material="steel")
    if d.maybe():
        leaf(d, "bonnet", "body", (0.16 * n, -0.45 * w, r + 0.55), (n / 2, 0.45 * w, r + 0.58), hinge=-X, out=Z,
            reach=1.0, handle=False, material="steel")
    if d.maybe():
        leaf(d, "tailgate", "body", (-n / 2 - 0.03, -0.42 * w, r + 0.1), (-n / 2, 0.42 * w, r + 0.55), hinge=d.pick(Z,
            -Z), out=-X, reach=1.4, material="steel")


def pickup_truck(d: ObjectBuilder) -> None:
    """A cab, a bed with a tailgate, four wheels."""
    n, w, r = d.u(4.0, 5.5), d.u(1.7, 2.0), d.u(0.32, 0.42)
    d.part("body", box((-n / 2, -w / 2, r), (n / 2, w / 2, r + 0.4)), box((-0.05 * n, -0.46 * w, r + 0.3), (0.28 * n,
        0.46 * w, r + 1.15)), box((0.2 * n, -w / 2, r), (n / 2, w / 2, r + 0.7)), material="steel")
    for s in (-1.0, 1.0):
        d.part("body", box((-n / 2, s * w / 2, r + 0.3), (-0.05 * n, s * (w / 2 - 0.06), r + 0.8)))
    leaf(d, "tailgate", "body", (-n / 2 - 0.05, -w / 2 + 0.07, r + 0.41), (-n / 2, w / 2 - 0.07, r + 0.8), hinge=-Z,
        out=-X, reach=1.57, handle=d.maybe(), material="steel")
    _axles(d, "body", [-0.3 * n, 0.32 * n], w / 2, r, 0.25, 0.02)
    if d.maybe():
        leaf(d, "bonnet", "body", (0.3 * n, -0.45 * w, r + 0.7), (n / 2, 0.45 * w, r + 0.73), hinge=-X, out=Z,
            reach=1.0, handle=False)


def van(d: ObjectBuilder) -> None:
    """A sliding side door, two rear doors, wheels."""
    n, w, r, h = d.u(4.5, 6.0), d.u(1.8, 2.1), 0.33, d.u(1.6, 2.2)
    case(d, "body", (-n / 2, -w / 2, r), (n / 2, w / 2, r + h), material="steel")
    leaf_w = w / 2 - 0.02
    for s, side in ((-1.0, "right"), (1.0, "left")):
        leaf(d, f"rear_{side}", "body", (-n / 2 - 0.04, 0.01 * s, r + 0.15), (-n / 2, s * leaf_w, r + h - 0.1),
            hinge=s * Y, out=-X, reach=d.u(1.6, 2.6), material="steel")
    g = d.gap(0.1)
    y = -w / 2 - g
    d.part("side_door", box((-0.1 * n, y - 0.05, r + 0.1), (0.15 * n, y, r + h - 0.15)), material="steel")
    d.part("body", box((-0.4 * n, -w / 2 - 0.03, r + h - 0.14 + g), (0.16 * n, -w / 2 + 0.01, r + h - 0.11)))
    grip(d, "side_door", (0.12 * n, y - 0.05, r + h / 2), -Y, Z, 0.2)
    d.slide("side_door", "body", -X, 0.24 * n)
    _axles(d, "body", [-0.3 * n, 0.32 * n], w / 2, r, 0.22, 0.02)


def bus_or_tram(d: ObjectBuilder) -> None:
    """Double doors that slide apart or swing, and many wheels."""
    n, w, r, h = d.u(6.0, 12.0), 2.5, 0.45, 2.5
    case(d, "body", (-n / 2, -w / 2, r), (n / 2, w / 2, r + h), material="steel")
    swings = d.maybe()
    g = d.gap(0.1) + 0.002
    for i, x in enumerate(spread(1 if n < 9.0 else 2, -0.25 * n, 0.2 * n)):
        for s in (-1.0, 1.0):
            name = f"door_{i}_{'front' if s > 0 else 'rear'}"
            a, b = sorted((x + s * 0.01, x + s * 0.65))
            if swings:
                leaf(d, name, "body", (a, -w / 2 - 0.04, r + 0.1), (b, -w / 2, r + 2.1), hinge=s * X, out=-Y, reach=1.5,
                    material="glass")
            else:
                d.part(name, box((a, -w / 2 - 0.04 - g, r + 0.1), (b, -w / 2 - g, r + 2.1)), material="glass")
                d.slide(name, "body", s * X, 0.6)
    _axles(d, "body", [-0.35 * n, 0.3 * n], w / 2, r, 0.28, 0.02)


def tractor(d: ObjectBuilder) -> None:
    """Large wheels behind, small ones in front on a swinging axle; a three-point arm."""
    r, q = d.u(0.6, 0.9), d.u(0.3, 0.45)
    d.part("body", box((-0.7, -0.3, r - 0.2), (1.4, 0.3, r + 0.4)), box((-0.7, -0.5, r + 0.3), (0.1, 0.5, r + 0.45)),
        rod(0.04, (1.0, 0.1, r + 0.3), (1.0, 0.1, r + 0.9)), material="steel")
    for s, side in ((-1.0, "right"), (1.0, "left")):
        wheel(d, f"rear_{side}", "body", (-0.4, s * 0.6, r), r, 0.4, s * Y, axle=0.1)
    g = d.gap(0.1) + 0.005
    d.part("axle", box((1.1, -0.55, q - 0.05), (1.2, 0.55, q + 0.05)), box((1.1, -0.06, q), (1.2, 0.06, r - 0.2 - g)),
        material="steel")
    d.hinge("axle", "body", X, (1.15, 0, q), 0.1, -0.1, initial_opening=False)
    for s, side in ((-1.0, "right"), (1.0, "left")):
        wheel(d, f"front_{side}", "axle", (1.15, s * 0.68, q), q, 0.2, s * Y, axle=0.03)
    d.part("hitch", beam(0.5, 0.06, (-0.71 - g, 0, r), (-1.4, 0, r - 0.2)))
    d.hinge("hitch", "body", Y, (-0.71 - g, 0, r + 0.04), 0.4, initial_opening=False)
    d.part("steering", rod(0.02, (0.2, 0, r + 0.4 + d.gap(0.02)), (0.12, 0, r + 0.7)), ring(0.18, 0.015, (0.12, 0,
        r + 0.7), np.array([-0.25, 0, 0.97])))
    d.hinge("steering", "body", np.array([-0.08, 0, 0.3]) / np.hypot(0.08, 0.3), (0.2, 0, r + 0.4), 3.0, -3.0,
        initial_opening=False)


def bicycle(d: ObjectBuilder) -> None:
    """A frame, a fork that steers, two wheels, cranks."""
    r, b = d.u(0.28, 0.36), d.u(0.9, 1.1)
    t = 0.02
    head, top = np.array([b - 0.18, 0, r + 0.44]), np.array([b - 0.22, 0, r + 0.6])
    seat, axle = np.array([0.3, 0, r + 0.5]), np.array([0.42, 0, r - 0.05])
    d.part("frame", *(rod(t, p, q) for p, q in ((head, axle), (top, seat), (seat, axle), (head, top))),
        material="steel")
    for s in (-0.05, 0.05):
        d.part("frame", rod(0.6 * t, (0, s, r), axle + s * Y), rod(0.6 * t, (0, s, r), seat + s * 0.3 * Y), beam(0.06,
            0.03, axle - 0.06 * Y, axle + 0.06 * Y))
    d.part("frame", capsule(0.05, seat + np.array([-0.1, 0, 0.12]), seat + np.array([0.1, 0, 0.12])), rod(t, seat,
        seat + 0.12 * Z))
    axis = (top - head) / np.linalg.norm(top - head)
    g = d.gap(0.03)
    low = head - (0.04 + g) * axis
    foot = np.array([b, 0, r])
    d.part("fork", *(rod(0.6 * t, low + s * Y, foot + s * Y) for s in (-0.05, 0.05)), beam(0.12, 0.03, low - 0.06 * Y,
        low + 0.06 * Y), material="steel")
    if d.hand.has_bore:
        d.part("fork", rod(0.4 * t, low, top + 0.2 * axis))
        d.cut("frame", rod(0.4 * t + 1.5 * g, low - 0.05 * axis, top + 0.1 * axis))
    else:
        d.part("fork", rod(0.8 * t, low, top + 0.2 * axis))
    bar = top + 0.2 * axis
    d.part("fork", rod(0.6 * t, bar - 0.28 * Y, bar + 0.28 * Y))
    d.hinge("fork", "frame", axis, head, 0.7, -0.7, initial_opening=False)
    for name, on, at in (("rear_wheel", "frame", np.array([0, 0, r])), ("front_wheel", "fork", foot)):
        d.part(name, ring(r - 0.02, 0.018, at, Y), rod(0.03, at - 0.03 * Y, at + 0.03 * Y), *(beam(0.004, 0.004,
            at - (r - 0.02) * v, at + (r - 0.02) * v) for v in (X, Z, (X + Z) / 2**0.5, (X - Z) / 2**0.5)),
            material="rubber")
        d.spin(name, on, Y, at)
    for s in (-1.0, 1.0):
        d.part("cranks", beam(0.012, 0.03, axle + s * 0.075 * Y, axle + s * 0.075 * Y + s * 0.17 * X), rod(0.012,
            axle + s * 0.07 * Y + s * 0.16 * X, axle + s * 0.17 * Y + s * 0.16 * X), material="metal")
    d.part("cranks", rod(0.008, axle - 0.08 * Y, axle + 0.08 * Y))
    d.bore("frame", rod(0.008 + 1.5 * d.gap(0.02) + 0.0005, axle - 0.2 * Y, axle + 0.2 * Y))
    d.spin("cranks", "frame", Y, axle)


def scooter(d: ObjectBuilder) -> None:
    """A kick scooter: a deck, a steering column, two wheels."""
    n, r, h = d.u(0.5, 0.7), d.u(0.05, 0.1), d.u(0.7, 1.0)
    g = d.gap(0.02) + 0.0005
    d.part("deck", box((0, -0.06, 0.07), (n, 0.06, 0.09)), *(box((-2.2 * r, s, r - 0.015), (0.02, s * 1.4,
        0.085)) for s in (-0.03, 0.03)), material="metal")
    d.part("deck", beam(0.04, 0.04, (n - 0.01, 0, 0.08), (n + 0.08, 0, 0.2)), tube(0.028,
        0.02 if d.hand.has_bore else 0.001, (n + 0.08, 0, 0.17), (n + 0.08, 0, 0.27)))
    d.part("column", rod(0.02 - (g if d.hand.has_bore else 0.0), (n + 0.08, 0, 0.12), (n + 0.08, 0, h)), rod(0.014,
        (n + 0.08, -0.2, h), (n + 0.08, 0.2, h)), box((n + 0.055, -0.045, 0.12), (n + 0.105, 0.045, 0.14)),
        material="metal")
    for s in (-0.04, 0.04):
        d.part("column", beam(0.03, 0.008, (n + 0.08, s, 0.14), (n + 0.1, s, 0.035), Y))
    d.hinge("column", "deck", Z, (n + 0.08, 0, 0.2), 0.9, -0.9, initial_opening=False)
    for name, on, x in (("rear_wheel", "deck", -1.4 * r), ("front_wheel", "column", n + 0.1)):
        q = 0.045 if on == "column" else r
        d.part(name, rod(q, (x, -0.025, q), (x, 0.025, q)), material="rubber")
        d.spin(name, on, Y, (x, 0, q))


def skateboard(d: ObjectBuilder) -> None:
    """A deck, two trucks that tilt, four wheels."""
    n, w, r = d.u(0.6, 0.9), d.u(0.18, 0.24), d.u(0.025, 0.035)
    d.part("deck", box((-n / 2, -w / 2, 0.1), (n / 2, w / 2, 0.112)), *(rod(w / 2, (s * n / 2, 0, 0.1), (s * n / 2, 0,
        0.112)) for s in (-1, 1)), *(block((s * 0.3 * n, 0, 0.095), (0.08, 0.06, 0.012)) for s in (-1, 1)),
        material="wood")
    g = d.gap(0.02) + 0.0005
    for k, s in enumerate((-1.0, 1.0)):
        x = s * 0.3 * n
        name = f"truck_{k}"
        d.part(name, box((x - 0.015, -0.38 * w, r - 0.008), (x + 0.015, 0.38 * w, r + 0.008)), rod(0.012, (x, 0, r), (x,
            0, 0.085 - g)), material="metal")
        d.hinge(name, "deck", X, (x, 0, 0.07), 0.2, -0.2, initial_opening=False)
        for q in (-1.0, 1.0):
            wheel(d, f"wheel_{k}_{int(q > 0)}", name, (x, q * (0.38 * w + 0.022), r), r, 0.035, q * Y, axle=0.004)


def wheelbarrow(d: ObjectBuilder) -> None:
    """A tray, two handles, one wheel in a fork."""
    n, w, r = d.u(0.7, 0.9), d.u(0.5, 0.65), d.u(0.15, 0.2)
    d.part("barrow", prism([(-0.4 * n, 0.35), (0.35 * n, 0.35), (0.55 * n, 0.65), (-0.5 * n, 0.65)], (0, 0, 0), w, "y"),
        material="steel")
    if d.hand.hollow:
        d.cut("barrow", prism([(-0.38 * n, 0.37), (0.34 * n, 0.37), (0.54 * n, 0.7), (-0.5 * n, 0.7)], (0, 0, 0),
            w - 0.04, "y"))
    for s in (-1.0, 1.0):
        d.part("barrow", rod(0.018, (-1.2 * n, s * 0.3, 0.6), (-0.3 * n, s * 0.2, 0.34)), rod(0.018, (-0.3 * n, s * 0.2,
            0.34), (0.62 * n, s * 0.08, r)), rod(0.018, (-0.4 * n, s * 0.2, 0.36), (-0.4 * n, s * 0.2, 0)))
    at = np.array([0.6 * n, 0, r])
    d.part("wheel", rod(r, at - 0.04 * Y, at + 0.04 * Y), material="rubber")
    if d.hand.barrels and not d.hand.has_bore:
        d.part(d.pick("wheel", "barrow"), rod(0.01, at - 0.09 * Y, at + 0.09 * Y))
    d.spin("wheel", "barrow", Y, at)


def hand_truck(d: ObjectBuilder) -> None:
    """A sack truck with two wheels and a plate that folds up."""
    w, h, r = d.u(0.35, 0.5), d.u(1.0, 1.3), d.u(0.08, 0.14)
    for s in (-1.0, 1.0):
        d.part("frame", rod(0.016, (s * w / 2, 0, 0.03), (s * w / 2, 0, h)), material="steel")
    d.part("frame", *(rod(0.012, (-w / 2, 0, z), (w / 2, 0, z)) for z in (0.06, 0.4 * h, 0.7 * h, h)))
    d.part("frame", *(beam(0.03, 0.02, (s * w / 2, 0, r), (s * w / 2, 0.1, r)) for s in (-1.0, 1.0)), rod(0.01,
        (-w / 2 - 0.005, 0.1, r), (w / 2 + 0.005, 0.1, r)))
    for s in (-1.0, 1.0):
        wheel(d, f"wheel_{int(s > 0)}", "frame", (s * (w / 2 + 0.05), 0.1, r), r, 0.05, s * X, axle=0.012)
    g = d.gap(0.03) + 0.001
    y = -0.018 - g
    d.part("plate", box((-0.45 * w, -0.25, 0.025), (0.45 * w, y, 0.033)), material="steel")
    d.hinge("plate", "frame", -X, (0, y, 0.029), 1.5, initial_opening=False)


def shopping_cart(d: ObjectBuilder) -> None:
    """A wire basket, four casters, a child's flap."""
    n, w, h = d.u(0.7, 1.0), d.u(0.45, 0.6), d.u(0.9, 1.05)
    z0 = 0.45
    d.part("cart", box((-n / 2, -w / 2, z0), (n / 2, w / 2, z0 + 0.01)), *(box((-n / 2, s * w / 2, z0), (n / 2,
        s * (w / 2 - 0.01), h - 0.15)) for s in (-1.0, 1.0)), box((n / 2 - 0.01, -w / 2, z0), (n / 2, w / 2, h - 0.15)),
        material="steel")
    d.part("cart", *(beam(0.025, 0.025, (x, s * 0.45 * w, 0.12), (x, s * 0.45 * w, z0 + 0.005), X) for s in (-1,
        1) for x in (-0.4 * n, 0.4 * n)), *(beam(0.03, 0.03, (-0.42 * n, s * 0.45 * w, 0.135), (0.42 * n, s * 0.45 * w,
        0.135)) for s in (-1, 1)))
    d.part("cart", *(rod(0.012, (-n / 2, s * (w / 2 - 0.005), h - 0.2), (-n / 2 - 0.12, s * (w / 2 - 0.005),
        h)) for s in (-1, 1)), rod(0.014, (-n / 2 - 0.12, -w / 2, h), (-n / 2 - 0.12, w / 2, h)))
    leaf(d, "flap", "cart", (-n / 2 - 0.012, -w / 2 + 0.02, z0 + 0.02), (-n / 2, w / 2 - 0.02, h - 0.17), hinge=Z,
        out=-X, reach=0.6, handle=False, material="steel")
    for k, (x, y) in enumerate([(x, y) for x in (-0.38 * n, 0.38 * n) for y in (-0.45 * w, 0.45 * w)]):
        caster(d, f"caster_{k}", "cart", (x, y, 0.12), 0.12)


def wheelchair(d: ObjectBuilder) -> None:
    """Two large wheels, two casters, foot rests that swing up."""
    w, r, z = d.u(0.42, 0.52), d.u(0.28, 0.32), 0.5
    d.part("chair", box((-0.22, -w / 2, z), (0.22, w / 2, z + 0.03)), box((-0.25, -w / 2, z), (-0.22, w / 2, z + 0.45)),
        *(box((-0.25, s * w / 2, 0.25), (0.25, s * (w / 2 - 0.03), z + 0.2)) for s in (-1.0, 1.0)), material="steel")
    _axles(d, "chair", [-0.15], w / 2, r, 0.03, 0.03)
    for k, s in enumerate((-1.0, 1.0)):
        d.part("chair", beam(0.03, 0.03, (0.22, s * (w / 2 - 0.015), 0.3), (0.35, s * (w / 2 - 0.015), 0.17), Y),
            block((0.35, s * (w / 2 - 0.015), 0.175), (0.05, 0.05, 0.05)))
        caster(d, f"caster_{k}", "chair", (0.35, s * (w / 2 - 0.015), 0.15), 0.15)
        g = d.gap(0.02) + 0.001
        d.part(f"rest_{k}", beam(0.02, 0.02, (0.26 + g, s * 0.1, 0.45), (0.48, s * 0.1, 0.16), Y), box((0.44, s * 0.03,
            0.15), (0.56, s * 0.15, 0.16)))
        d.part("chair", rod(0.012, (0.2, s * 0.1, 0.47), (0.25, s * 0.1, 0.45)), box((0.18, s * 0.08, 0.46), (0.22,
            s * 0.12, z + 0.01)))
        d.hinge(f"rest_{k}", "chair", Y * -1.0, (0.26 + g, s * 0.1, 0.45), 0.9, initial_opening=False)


def helicopter(d: ObjectBuilder) -> None:
    """A main rotor, a tail rotor, a door on each side."""
    k = d.u(0.1, 1.0)
    d.part("hull", capsule(0.6 * k, (-0.5 * k, 0, 1.2 * k), (0.6 * k, 0, 1.2 * k)), cone(0.3 * k, 0.1 * k, (-0.8 * k, 0,
        1.4 * k), (-3.2 * k, 0, 1.6 * k)), rod(0.12 * k, (0, 0, 1.7 * k), (0, 0, 2.0 * k)), box((-3.3 * k, -0.03 * k,
        1.5 * k), (-3.0 * k, 0.03 * k, 2.2 * k)), material="metal")
    for s in (-1.0, 1.0):
        d.part("hull", rod(0.04 * k, (-0.8 * k, s * 0.5 * k, 0.3 * k), (0.9 * k, s * 0.5 * k, 0.3 * k)), *(rod(0.03 * k,
            (x * k, s * 0.5 * k, 0.3 * k), (x * k, s * 0.3 * k, 0.8 * k)) for x in (-0.4, 0.5)))
    rotor(d, "main_rotor", "hull", (0, 0, 2.0 * k), Z, d.u(2.0, 2.6) * k, d.n(2, 5), wide=0.07)
    d.part("hull", rod(0.06 * k, (-3.15 * k, 0, 1.8 * k), (-3.15 * k, 0.2 * k, 1.8 * k)))
    rotor(d, "tail_rotor", "hull", (-3.15 * k, 0.2 * k, 1.8 * k), Y, 0.5 * k, d.n(2, 4))


def light_aircraft(d: ObjectBuilder) -> None:
    """A propeller, ailerons, an elevator, a rudder, wheels."""
    n, b = d.u(5.0, 8.0), d.u(7.0, 11.0)
    k = d.pick(1.0, 0.1)
    p = scaled(k)
    d.part("airframe", cone(0.6 * k, 0.15 * k, p(0.25 * n, 0, 1.2), p(-0.7 * n, 0, 1.4)), cone(0.6 * k, 0.3 * k,
        p(0.25 * n, 0, 1.2), p(0.33 * n, 0, 1.2)), material="metal")
    z = d.pick(0.9, 1.75)
    d.part("airframe", box(p(-0.05 * n, -b / 2, z), p(0.12 * n, b / 2, z + 0.12)), box(p(-0.68 * n, -1.4, 1.4),
        p(-0.58 * n, 1.4, 1.46)), box(p(-0.68 * n, -0.03, 1.4), p(-0.58 * n, 0.03, 2.4)), box(p(-0.05 * n, -0.2, 1.0),
        p(0.1 * n, 0.2, 1.8)))
    g = d.gap(0.1 * k) / k + 0.001
    for k2, s in enumerate((-1.0, 1.0)):
        d.part(f"aileron_{k2}", box(p(-0.11 * n, s * 0.3 * b, z + 0.02), p(-0.05 * n - g, s * 0.49 * b, z + 0.1)))
        d.hinge(f"aileron_{k2}", "airframe", Y, p(-0.05 * n - g, 0, z + d.pick(0.06, 0.06, 0.1)), 0.4,
            -0.02 if d.hand.has_bore else -0.4, initial_opening=False)
    d.part("elevator", box(p(-0.74 * n, -1.4, 1.41), p(-0.68 * n - g - 0.04, -0.2, 1.45)), box(p(-0.74 * n, 0.2, 1.41),
        p(-0.68 * n - g - 0.04, 1.4, 1.45)), box(p(-0.74 * n, -0.2, 1.42), p(-0.72 * n, 0.2, 1.44)))
    d.hinge("elevator", "airframe", Y, p(-0.68 * n - g, 0, 1.43), 0.4, -0.4, initial_opening=False)
    d.part("rudder", box(p(-0.74 * n, -0.02, 1.75), p(-0.68 * n - g - 0.04, 0.02, 2.4)))
    d.hinge("rudder", "airframe", Z, p(-0.68 * n - g, 0, 1.5), 0.4, -0.4, initial_opening=False)
    rotor(d, "propeller", "airframe", p(0.33 * n, 0, 1.2), X, 0.95 * k, d.n(2, 3), wide=0.12)
    for i, (x, y) in enumerate(((0.05 * n, -1.1), (0.05 * n, 1.1))):
        d.part("airframe", rod(0.05 * k, p(x, 0.2 * np.sign(y), 1.0), p(x, y * 0.86, 0.22)))
        wheel(d, f"wheel_{i}", "airframe", p(x, y, 0.22), 0.2 * k, 0.14 * k, np.sign(y) * Y, axle=0.04 * k)


def drone(d: ObjectBuilder) -> None:
    """A quadcopter: four or six rotors on arms, a camera that tilts."""
    r, n = d.u(0.1, 0.4), d.pick(4, 4, 6)
    d.part("frame", block((0, 0, 0.25 * r), (0.6 * r, 0.4 * r, 0.15 * r)), material="plastic")
    for k, a in enumerate((np.arange(n) + 0.5) * 2 * np.pi / n):
        tip = np.array([1.1 * r * np.cos(a), 1.1 * r * np.sin(a), 0.25 * r])
        d.part("frame", beam(0.08 * r, 0.05 * r, (0, 0, 0.25 * r), tip), rod(0.09 * r, tip - 0.05 * r * Z,
            tip + 0.12 * r * Z), rod(0.02 * r, tip - 0.05 * r * Z, (tip[0], tip[1], 0)))
        rotor(d, f"rotor_{k}", "frame", tip + 0.12 * r * Z, Z, 0.5 * r, 2, wide=0.14)
    g = d.gap(0.1 * r)
    d.part("camera", ball(0.09 * r, (0.3 * r + 0.1 * r + g, 0, 0.22 * r)), rod(0.05 * r, (0.4 * r, 0, 0.22 * r),
        (0.55 * r, 0, 0.22 * r)))
    d.hinge("camera", "frame", Y, (0.4 * r + g, 0, 0.22 * r), 1.0, -0.3, initial_opening=False)


def sailing_boat(d: ObjectBuilder) -> None:
    """A hull, a boom that swings at the mast, a rudder with a tiller."""
    n = d.u(2.0, 6.0)
    d.part("hull", prism([(-0.5 * n, -0.16 * n), (0.25 * n, -0.17 * n), (0.5 * n, 0), (0.25 * n, 0.17 * n), (-0.5 * n,
        0.16 * n)], (0, 0, 0.08 * n), 0.16 * n, "z"), rod(0.012 * n, (0.1 * n, 0, 0.1 * n), (0.1 * n, 0, 1.2 * n)),
        material="wood")
    if d.hand.hollow:
        d.cut("hull", box((-0.45 * n, -0.13 * n, 0.1 * n), (0.05 * n, 0.13 * n, 0.3 * n)))
    g = d.gap(0.02 * n) + 0.0005
    z = 0.28 * n
    d.part("boom", rod(0.01 * n, (0.1 * n - 0.012 * n - g, 0, z), (-0.4 * n, 0, z)), material="wood")
    if d.maybe(0.7):
        d.part("boom", prism([(0.08 * n, z), (-0.4 * n, z), (0.085 * n, 1.15 * n)], (0, 0, 0), 0.004 * n, "y"))
    d.hinge("boom", "hull", Z, (0.1 * n, 0, z) if d.maybe() else (0.088 * n - g, 0, z), 1.2, -1.2)
    x = -0.5 * n - g
    d.part("rudder", box((x - 0.1 * n, -0.008 * n, -0.15 * n), (x - 0.01 * n, 0.008 * n, 0.2 * n)), beam(0.02 * n,
        0.02 * n, (x - 0.05 * n, 0, 0.2 * n), (x + 0.2 * n, 0, 0.24 * n)), material="wood")
    d.hinge("rudder", "hull", Z, (x, 0, 0), 0.7, -0.7)


def rowing_boat(d: ObjectBuilder) -> None:
    """Two oars in their locks."""
    n = d.u(2.0, 4.0)
    d.part("hull", prism([(-0.5 * n, -0.12 * n), (0.2 * n, -0.18 * n), (0.5 * n, 0), (0.2 * n, 0.18 * n), (-0.5 * n,
        0.12 * n)], (0, 0, 0.1 * n), 0.2 * n, "z"), material="wood")
    if d.hand.hollow:
        d.cut("hull", prism([(-0.46 * n, -0.1 * n), (0.18 * n, -0.15 * n), (0.4 * n, 0), (0.18 * n, 0.15 * n),
            (-0.46 * n, 0.1 * n)], (0, 0, 0.15 * n), 0.2 * n, "z"))
    g = d.gap(0.02 * n) + 0.0005
    for k, s in enumerate((-1.0, 1.0)):
        y = s * 0.16 * n
        d.part("hull", block((0, y, 0.2 * n), (0.06 * n, 0.04 * n, 0.03 * n)))
        z = 0.215 * n + g + 0.012 * n
        d.part(f"oar_{k}", rod(0.012 * n, (0, s * 0.05 * n, z), (0, s * 0.6 * n, z)), block((0, s * 0.65 * n, z),
            (0.06 * n, 0.14 * n, 0.01 * n)), material="wood")
        if d.hand.barrels:
            d.part(d.pick("hull", f"oar_{k}"), rod(0.006 * n, (0, y, 0.2 * n), (0, y, z)))
        d.hinge(f"oar_{k}", "hull", Z, (0, y, 0.2 * n), 0.7, -0.7)


def motor_boat(d: ObjectBuilder) -> None:
    """An outboard that steers, its propeller, a steering wheel, a hatch."""
    n = d.u(3.0, 7.0)
    d.part("hull", prism([(-0.5 * n, 0), (0.4 * n, 0), (0.5 * n, 0.18 * n), (-0.5 * n, 0.18 * n)], (0, 0, 0), 0.36 * n,
        "y"), box((0, -0.12 * n, 0.17 * n), (0.1 * n, 0.12 * n, 0.28 * n)), material="plastic")
    g = d.gap(0.05 * n) + 0.001
    x = -0.5 * n - g
    d.part("outboard", box((x - 0.1 * n, -0.04 * n, 0.12 * n), (x, 0.04 * n, 0.26 * n)), box((x - 0.07 * n, -0.015 * n,
        -0.1 * n), (x - 0.03 * n, 0.015 * n, 0.13 * n)), rod(0.02 * n, (x - 0.09 * n, 0, -0.07 * n), (x - 0.02 * n, 0,
        -0.07 * n)))
    d.hinge("outboard", "hull", Z, (x, 0, 0), 0.03 if d.hand.has_bore else 0.6, -0.03 if d.hand.has_bore else -0.6,
        initial_opening=False)
    rotor(d, "propeller", "outboard", (x - 0.09 * n, 0, -0.07 * n), -X, 0.06 * n, 3, wide=0.5)
    at = np.array([0.0, 0.06 * n, 0.24 * n])
    d.part("wheel", ring(0.045 * n, 0.005 * n, at - 0.03 * n * X, X), rod(0.008 * n, at - g * X, at - 0.03 * n * X),
        *(beam(0.008 * n, 0.005 * n, at - 0.03 * n * X - 0.045 * n * v, at - 0.03 * n * X + 0.045 * n * v,
        X) for v in (Y, Z)))
    d.spin("wheel", "hull", -X, at)
    leaf(d, "hatch", "hull", (0.15 * n, -0.08 * n, 0.18 * n), (0.33 * n, 0.08 * n, 0.18 * n + 0.02), hinge=d.pick(X,
        -X), out=Z, reach=1.5)


def trailer(d: ObjectBuilder) -> None:
    """A flat bed with sides that fold down, two wheels, a jockey wheel that goes up."""
    n, w, r = d.u(1.5, 3.0), d.u(1.0, 1.5), d.u(0.22, 0.32)
    z = r + 0.2
    d.part("bed", box((-n / 2, -w / 2, z), (n / 2, w / 2, z + 0.05)), beam(0.08, 0.08, (n / 2 - 0.1, 0, z),
        (n / 2 + 0.8, 0, z)), *(box((-0.1, s * w / 2, r - 0.05), (0.1, s * (w / 2 - 0.08), z + 0.01)) for s in (-1, 1)),
        material="steel")
    _axles(d, "bed", [0.0], w / 2, r, 0.16, 0.03)
    h = d.u(0.25, 0.4)
    for k, (s, out) in enumerate(((-1.0, -Y), (1.0, Y))):
        leaf(d, f"side_{k}", "bed", (-n / 2 + 0.03, s * w / 2, z + 0.055), (n / 2 - 0.03, s * (w / 2 - 0.025),
            z + 0.05 + h), hinge=-Z, out=out, reach=1.6, handle=False)
    leaf(d, "tailgate", "bed", (-n / 2 - 0.025, -w / 2, z + 0.055), (-n / 2, w / 2, z + 0.05 + h), hinge=-Z, out=-X,
        reach=1.6, handle=d.maybe())
    x = n / 2 + 0.6
    d.part("bed", tube(0.035, 0.022 if d.hand.has_bore else 0.002, (x, 0.07, z - 0.1), (x, 0.07, z + 0.15)))
    g = d.gap(0.02) + 0.0005
    d.part("jockey", rod(0.022 - (1.5 * g if d.hand.has_bore else 0), (x, 0.07, 0.14), (x, 0.07, z + 0.2)), *(beam(0.03,
        0.006, (x, 0.07 + s, 0.15), (x, 0.07 + s, 0.06), Y) for s in (-0.035, 0.035)), block((x, 0.07, 0.15), (0.04,
        0.08, 0.02)), material="steel")
    d.slide("jockey", "bed", Z, 0.05, initial_opening=False)
    d.part("jockey_wheel", rod(0.08, (x, 0.045, 0.07), (x, 0.095, 0.07)), material="rubber")
    d.cut("jockey", rod(0.085, (x, 0.043, 0.07), (x, 0.097, 0.07)))
    d.spin("jockey_wheel", "jockey", Y, (x, 0.07, 0.07))


def forklift(d: ObjectBuilder) -> None:
    """A carriage that rises on a mast, wheels, a seat lid."""
    n, w, r = 1.6, 1.0, d.u(0.22, 0.3)
    d.part("truck", box((-n / 2, -w / 2, 0.15), (n / 2, w / 2, 0.8)), *(box((n / 2, s * 0.42 * w - 0.05, 0.08),
        (n / 2 + 0.1, s * 0.42 * w + 0.05, d.u(1.8, 2.4))) for s in (-1, 1)), *(rod(0.03, (x, s * 0.45 * w, 0.7), (x,
        s * 0.45 * w, 1.9)) for s in (-1, 1) for x in (-0.4, 0.5)), box((-0.5, -0.5 * w, 1.88), (0.6, 0.5 * w, 1.92)),
        material="steel")
    g = d.gap(0.05) + 0.001
    x = n / 2 + 0.1 + g
    d.part("carriage", box((x, -0.45 * w, 0.1), (x + 0.04, 0.45 * w, 0.6)), *(box((x, s * 0.3 - 0.06, 0.06), (x + 1.0,
        s * 0.3 + 0.06, 0.1)) for s in (-1, 1)), material="steel")
    d.slide("carriage", "truck", Z, 1.2)
    for i, x in enumerate((-0.5, 0.45)):
        for s in (-1.0, 1.0):
            wheel(d, f"wheel_{i}_{int(s > 0)}", "truck", (x, s * (w / 2 + 0.07), r), r, 0.12, s * Y, axle=0.01)
    leaf(d, "seat", "truck", (-0.6, -0.3, 0.8), (-0.05, 0.3, 0.9), hinge=X, out=Z, reach=1.2, handle=False)


def digger(d: ObjectBuilder) -> None:
    """A turntable on tracks, boom, stick and bucket."""
    k = d.u(0.1, 1.0)
    p = scaled(k)
    d.part("tracks", *(capsule(0.35 * k, p(-1.2, s * 1.0, 0.35), p(1.2, s * 1.0, 0.35)) for s in (-1, 1)), box(p(-0.9,
        -1.0, 0.2), p(0.9, 1.0, 0.6)), rod(0.7 * k, p(0, 0, 0.5), p(0, 0, 0.8)), material="steel")
    g = d.gap(0.1 * k)
    d.part("house", box(p(-1.3, -0.9, 0.8) + g * Z, p(1.0, 0.9, 1.3)), box(p(-0.2, 0.1, 1.2), p(0.95, 0.85, 2.3)),
        material="steel")
    d.spin("house", "tracks", Z, (0, 0, 0.8 * k))
    a, b, c = p(1.25, -0.3, 1.1), p(3.0, -0.3, 3.0), p(4.6, -0.3, 1.8)
    d.part("house", box(p(0.9, -0.42, 0.95), p(1.4, -0.18, 1.25)))
    arm(d, "boom", "house", a, b, 0.26 * k, Y, lower=-0.3, upper=0.4)
    arm(d, "stick", "boom", b + (0.26 * k + d.gap(0.26 * k) if d.hand.has_bore else 0.0) * Y,
        c + (0.26 * k + d.gap(0.26 * k) if d.hand.has_bore else 0.0) * Y, 0.2 * k, Y, lower=-0.5, upper=0.5)
    c = c + (0.46 * k + 2 * d.gap(0.26 * k) if d.hand.has_bore else 0.0) * Y
    d.part("bucket", prism([(-0.1 * k, 0.1 * k), (0.25 * k, 0.1 * k), (0.35 * k, -0.5 * k), (-0.35 * k, -0.6 * k)],
        c + (0.35 * k + g if d.hand.has_bore else 0.0) * Y, 0.5 * k, "y"), material="steel")
    d.hinge("bucket", "stick", Y, c, 0.8, -0.3, initial_opening=False)


def swing(d: ObjectBuilder) -> None:
    """Seats on ropes below a beam."""
    n, w, h = d.n(1, 3), d.u(1.5, 3.0), d.u(1.6, 2.3)
    d.part("frame", rod(0.05, (-w / 2, 0, h), (w / 2, 0, h)), *(beam(0.07, 0.07, (s * w / 2, 0, h), (s * w / 2, t * 0.8,
        0), X) for s in (-1, 1) for t in (-1, 1)), material="wood")
    g = d.gap(0.05)
    for k, x in enumerate(spread(n, -0.46 * w, 0.46 * w)):
        a = min(0.25, 0.3 * w / n)
        top = h - 0.05 - g if not d.hand.barrels else h
        d.part(f"seat_{k}", box((x - a, -0.12, 0.42), (x + a, 0.12, 0.45)), *(rod(0.01, (x + s * 0.9 * a, 0, 0.43),
            (x + s * 0.9 * a, 0, top)) for s in (-1, 1)), material="wood")
        d.hinge(f"seat_{k}", "frame", X, (0, 0, d.pick(h, top)) if not d.hand.has_bore else (0, 0, h), 0.8, -0.8,
            initial_opening=False)


def seesaw(d: ObjectBuilder) -> None:
    """A plank on a block or a post."""
    n, h = d.u(1.5, 3.0), d.u(0.35, 0.6)
    d.part("stand", prism([(-0.3, 0), (0.3, 0), (0.05, h - 0.02), (-0.05, h - 0.02)], (0, 0, 0), 0.2, "x"),
        material="wood")
    g = d.gap(0.05)
    d.part("plank", box((-0.12, -n / 2, h + g), (0.12, n / 2, h + g + 0.04)), *(rod(0.015, (-0.12, s * 0.4 * n,
        h + 0.25), (0.12, s * 0.4 * n, h + 0.25)) for s in (-1, 1)), *(rod(0.015, (0, s * 0.4 * n, h), (0, s * 0.4 * n,
        h + 0.25)) for s in (-1, 1)), material="wood")
    if not d.hand.has_bore:
        d.part(d.pick("stand", "plank"), rod(0.03, (-0.13, 0, h), (0.13, 0, h)))
    d.hinge("plank", "stand", X, (0, 0, h + (g if d.hand.has_bore else 0)), 0.3, -0.3)


def merry_go_round(d: ObjectBuilder) -> None:
    """A disc with rails on a post."""
    r = d.u(0.8, 1.6)
    d.part("base", rod(0.15 * r, (0, 0, 0), (0, 0, 0.15)), material="steel")
    g = d.gap(0.1)
    d.part("disc", rod(r, (0, 0, 0.15 + g), (0, 0, 0.2 + g)), material="wood")
    for a in np.arange(n := d.n(3, 6)) * 2 * np.pi / n:
        p, q = (0.9 * r * np.cos(a), 0.9 * r * np.sin(a)), (0.3 * r * np.cos(a), 0.3 * r * np.sin(a))
        d.part("disc", rod(0.02, (*p, 0.16 + g), (*p, 0.8)), rod(0.02, (*p, 0.8), (*q, 0.8)), rod(0.02, (*q, 0.16 + g),
            (*q, 0.8)))
    d.spin("disc", "base", Z, (0, 0, 0.15))


def ferris_wheel(d: ObjectBuilder) -> None:
    """A wheel on two stands with gondolas that hang."""
    r, n = d.u(0.3, 3.0), d.n(4, 8)
    h = 1.25 * r
    for s in (-1.0, 1.0):
        d.part("stand", *(beam(0.06 * r, 0.06 * r, (s * 0.3 * r, t * 0.6 * r, 0), (s * 0.3 * r, 0, h), X) for t in (-1,
            1)), material="steel")
    d.part("stand", box((-0.33 * r, -0.7 * r, -0.05 * r), (0.33 * r, 0.7 * r, 0.0)))
    axle = rod(0.03 * r, (-0.3 * r, 0, h), (0.3 * r, 0, h))
    d.part("stand", axle)
    g = d.gap(0.03 * r)
    for s in (-1.0, 1.0):
        d.part("wheel", ring(r, 0.02 * r, (s * 0.18 * r, 0, h), X), rod(0.08 * r, (s * 0.16 * r, 0, h), (s * 0.2 * r, 0,
            h)), material="steel")
    angles = np.arange(n) * 2 * np.pi / n + 0.3
    for k, a in enumerate(angles):
        u = np.array([0.0, np.cos(a), np.sin(a)])
        at = np.array([0, 0, h]) + r * u
        d.part("wheel", *(beam(0.03 * r, 0.03 * r, (s * 0.18 * r, 0, h), at + s * 0.18 * r * X, X) for s in (-1, 1)),
            rod(0.015 * r, at - 0.18 * r * X, at + 0.18 * r * X))
        low = at - 0.03 * r * Z
        d.part(f"gondola_{k}", block(low - 0.1 * r * Z, (0.2 * r, 0.16 * r, 0.1 * r)), *(beam(0.02 * r, 0.02 * r,
            low + s * 0.09 * r * X - 0.06 * r * Z, low + s * 0.09 * r * X + 0.05 * r * Z, X) for s in (-1, 1)))
        d.bore(f"gondola_{k}", rod(0.0155 * r + 1.5 * g, at - r * X, at + r * X))
        d.spin(f"gondola_{k}", "wheel", X, at)
    d.bore("wheel", rod(0.03 * r + 1.5 * g + 0.0005 * r, (-r, 0, h), (r, 0, h)))
    d.spin("wheel", "stand", X, (0, 0, h))


def windmill(d: ObjectBuilder) -> None:
    """Sails on a cap that turns on a tower, a door below."""
    h, r = d.u(1.0, 8.0), 0.0
    r = 0.45 * h
    d.part("tower", cone(0.22 * h, 0.14 * h, (0, 0, 0), (0, 0, 0.8 * h)), material="wood")
    g = d.gap(0.05 * h)
    d.part("cap", cone(0.16 * h, 0.05 * h, (0, 0, 0.8 * h + g), (0, 0, h)), rod(0.03 * h, (0, 0, 0.87 * h), (0,
        -0.24 * h, 0.87 * h)), material="wood")
    d.spin("cap", "tower", Z, (0, 0, 0.8 * h))
    rotor(d, "sails", "cap", (0, -0.24 * h, 0.87 * h), -Y, r, d.pick(3, 4), wide=0.2)


def wind_turbine(d: ObjectBuilder) -> None:
    """A nacelle that yaws on a mast and a rotor with three blades."""
    h = d.u(0.5, 40.0)
    d.part("mast", cone(0.04 * h, 0.025 * h, (0, 0, 0), (0, 0, h)), material="steel")
    g = d.gap(0.02 * h)
    d.part("nacelle", box((-0.03 * h, -0.06 * h, h + g), (0.03 * h, 0.12 * h, h + 0.06 * h)), material="plastic")
    d.spin("nacelle", "mast", Z, (0, 0, h))
    rotor(d, "rotor", "nacelle", (0, -0.06 * h, h + 0.03 * h), -Y, 0.6 * h, d.n(2, 4), wide=0.08)


def water_wheel(d: ObjectBuilder) -> None:
    """Paddles between two rings, between walls."""
    r, w = d.u(0.3, 2.0), 0.0
    w = 0.4 * r
    for s in (-1.0, 1.0):
        d.part("walls", box((s * (w / 2 + 0.05 * r), -0.5 * r, 0), (s * (w / 2 + 0.2 * r), 0.5 * r, 1.2 * r)),
            material="wood")
    d.part("walls", box((-w, -1.2 * r, -0.1 * r), (w, 1.2 * r, 0.0)))
    g = d.gap(0.05 * r)
    c = np.array([0, 0, 1.1 * r])
    d.part("wheel", rod(0.06 * r, c - (w / 2 + 0.15 * r) * X, c + (w / 2 + 0.15 * r) * X), *(tube(0.9 * r, 0.8 * r,
        c + s * w / 2 * X, c + s * (w / 2 - 0.04 * r) * X) for s in (-1, 1)), material="wood")
    for a in np.arange(n := d.n(6, 10)) * 2 * np.pi / n:
        u = np.array([0, np.cos(a), np.sin(a)])
        d.part("wheel", beam(w - 0.03 * r, 0.03 * r, c, c + r * u, np.cross(X, u)))
    d.bore("walls", rod(0.06 * r + 1.5 * g + 1e-4, c - r * X, c + r * X))
    d.spin("wheel", "walls", X, c)


def well_with_windlass(d: ObjectBuilder) -> None:
    """A roller with a crank above a well, a bucket beside."""
    r, h = d.u(0.4, 0.7), d.u(0.6, 0.9)
    d.part("well", tube(r, 0.85 * r, (0, 0, 0), (0, 0, h)), *(box((s * 0.93 * r - 0.04, -0.05, 0.5 * h),
        (s * 0.93 * r + 0.04, 0.05, h + 0.7)) for s in (-1, 1)), material="ceramic")
    g = d.gap(0.05) + 0.0005
    z = h + 0.5
    end = r + 0.06
    d.part("roller", rod(0.08, (-0.93 * r + 0.045 + g, 0, z), (0.93 * r - 0.045 - g, 0, z)), rod(0.02, (-0.93 * r, 0,
        z), (end + 0.1, 0, z)), beam(0.03, 0.03, (end + 0.1, 0, z), (end + 0.1, 0.22, z)), rod(0.015, (end + 0.1, 0.21,
        z), (end + 0.25, 0.21, z)), material="wood")
    d.bore("well", rod(0.02 + 1.5 * g, (-0.93 * r - 0.02, 0, z), (r + 1, 0, z)))
    d.spin("roller", "well", X, (0, 0, z))


def garden_gate(d: ObjectBuilder) -> None:
    """One or two leaves of slats between posts."""
    w, h, n = d.u(0.8, 1.2), d.u(0.9, 1.6), d.n(1, 2)
    g = d.gap(0.05) + 0.001
    posts = [-w * n / 2 - 0.06, w * n / 2 + 0.06]
    d.part("posts", *(box((x - 0.05, -0.05, 0), (x + 0.05, 0.05, h + 0.15)) for x in posts), box((posts[0], -0.05,
        -0.05), (posts[1], 0.05, 0.005)), material="wood")
    for k in range(n):
        s = -1.0 if k == 0 else 1.0
        x0, x1 = sorted((s * w * n / 2, s * w * (n / 2 - 1) + s * g))
        x0, x1 = x0 + (g - 0.01 if s < 0 else 0), x1 - (g - 0.01 if s > 0 else 0)
        slats = [box((x - 0.03, -0.012, 0.06), (x + 0.03, 0.012, h)) for x in spread(d.n(5, 8), x0 + 0.01, x1 - 0.01)]
        y = 0.012
        rails = [box((x0, y - 0.001, z), (x1, y + 0.025, z + 0.07)) for z in (0.15, h - 0.2)]
        d.part(f"leaf_{k}", *slats, *rails, material="wood")
        pivot = (s * w * n / 2 + s * 0.005 * d.hand.barrels, d.pick(-0.05, -0.05, -0.012), 0)
        d.hinge(f"leaf_{k}", "posts", Z * s, pivot, d.u(1.2, 1.6))


def mailbox(d: ObjectBuilder) -> None:
    """A door in front and a flag at the side."""
    w, n, h = d.u(0.15, 0.25), d.u(0.35, 0.55), d.u(0.9, 1.2)
    d.part("box", box((-w / 2, 0, h), (w / 2, n, h + w)), rod(w / 2, (0, 0, h + w), (0, n, h + w)), box((-0.04, 0.4 * n,
        0), (0.04, 0.4 * n + 0.08, h + 0.01)), material="steel")
    g = d.gap(0.05)
    d.part("door", box((-w / 2, -0.01 - g, h), (w / 2, -g, h + w)), rod(w / 2, (0, -0.01 - g, h + w), (0, -g, h + w)),
        material="steel")
    grip(d, "door", (0, -0.01 - g, h + 1.2 * w), -Y, X, 0.04)
    d.hinge("door", "box", X, (0, -g - 0.01 * d.pick(0, 1), h), 1.5)
    x = w / 2 + g + 0.001
    d.part("flag", box((x, 0.2 * n, h + 0.3 * w), (x + 0.005, 0.2 * n + 0.02, h + 1.4 * w)), box((x, 0.2 * n,
        h + 1.1 * w), (x + 0.005, 0.2 * n + 0.1, h + 1.45 * w)))
    d.hinge("flag", "box", X * d.pick(1.0, -1.0), (x, 0.2 * n + 0.01, h + 0.35 * w), 1.57)


def barrier(d: ObjectBuilder) -> None:
    """A boom that goes up beside a post."""
    n, h = d.u(1.5, 4.0), d.u(0.9, 1.1)
    d.part("post", box((-0.15, -0.12, 0), (0.15, 0.12, h + 0.1)), material="steel")
    g = d.gap(0.1)
    y = -0.12 - g
    d.part("boom", beam(0.05, 0.1, (-0.35, y - 0.025, h), (n, y - 0.025, h)), material="metal")
    if d.maybe():
        d.part("boom", block((-0.35, y - 0.05, h), (0.25, 0.1, 0.2)))
    if d.hand.barrels and not d.hand.has_bore:
        d.part(d.pick("boom", "post"), rod(0.03, (0, 0, h), (0, y - 0.06, h)))
    d.hinge("boom", "post", -Y, (0, y, h), 1.5)


def turnstile(d: ObjectBuilder) -> None:
    """Three arms on a slanted hub, or a wing."""
    h = d.u(0.85, 1.0)
    d.part("cabinet", box((-0.15, -0.5, 0), (0.15, 0.5, h)), material="steel")
    g = d.gap(0.05)
    at = np.array([0.15, 0, h - 0.12])
    if d.maybe():
        d.part("arms", rod(0.05, at + g * X, at + 0.08 * X), *(rod(0.02, at + 0.05 * X,
            at + 0.05 * X + 0.45 * np.array([0.5, 0.87 * np.cos(a),
            0.87 * np.sin(a)])) for a in np.arange(3) * 2 * np.pi / 3), material="steel")
        d.spin("arms", "cabinet", X, at)
    else:
        d.part("cabinet", rod(0.04, (0.19, 0, 0), (0.19, 0, 0.1)))
        d.part("arms", rod(0.04, (0.2, 0, 0.1 + g), (0.2, 0, h)), box((0.2, -0.01, 0.3), (0.75, 0.01, h - 0.1)),
            material="glass")
        d.hinge("arms", "cabinet", Z, (0.2, 0, 0.1), 1.5, -1.5, initial_opening=False)


def greenhouse(d: ObjectBuilder) -> None:
    """A house of glass: roof vents that lift, a sliding door."""
    w, n, h = d.u(1.5, 2.5), d.u(1.5, 3.0), 1.6
    t = 0.04
    d.part("frame", *(beam(t, t, (s * w / 2, y, 0), (s * w / 2, y, h), Y) for s in (-1, 1) for y in (0, n)), *(beam(t,
        t, (s * w / 2, 0, z), (s * w / 2, n, z)) for s in (-1, 1) for z in (0.02, h)), *(beam(t, t, (-w / 2, y, 0.02),
        (w / 2, y, 0.02)) for y in (0, n)), *(beam(t, t, (s * w / 2, y, h), (0, y, h + 0.4), Y) for s in (-1,
        1) for y in (0, n)), beam(t, t, (0, 0, h + 0.4), (0, n, h + 0.4)), *(beam(t, t, (-w / 2, y, h), (w / 2, y,
        h)) for y in (0, n)), material="metal")
    slope = np.array([w / 2, 0, -0.4]) / np.hypot(w / 2, 0.4)
    up = np.array([0.4, 0, w / 2]) / np.hypot(w / 2, 0.4)
    g = d.gap(0.02) + 0.021
    for k, y in enumerate(spread(d.n(1, 3), 0.05, n - 0.05)):
        a = np.array([0, y, h + 0.4]) + 0.02 * slope + g * up
        d.part(f"vent_{k}", beam(0.8 * n / 4, 0.01, a, a + 0.45 * w * slope, up), material="glass")
        d.hinge(f"vent_{k}", "frame", -Y, a, 0.7)
    y = -0.02 - d.gap(0.05) - 0.003
    d.part("door", box((-0.4, y - 0.02, 0.03), (0.4, y, h - 0.02)), material="glass")
    d.slide("door", "frame", X, 0.7)


def lawn_mower(d: ObjectBuilder) -> None:
    """A deck with wheels, a blade below, a handle that folds."""
    n, w, r = d.u(0.5, 0.8), d.u(0.4, 0.5), d.u(0.08, 0.12)
    d.part("deck", box((-n / 2, -w / 2, r), (n / 2, w / 2, r + 0.12)), rod(0.12, (0, 0, r + 0.1), (0, 0, r + 0.3)),
        material="steel")
    if d.hand.hollow:
        d.cut("deck", box((-n / 2 + 0.02, -w / 2 + 0.02, 0), (n / 2 - 0.02, w / 2 - 0.02, r + 0.1)))
    for i, x in enumerate((-0.4 * n, 0.4 * n)):
        for s in (-1.0, 1.0):
            wheel(d, f"wheel_{i}_{int(s > 0)}", "deck", (x, s * (w / 2 + 0.035), r), r, 0.05, s * Y, axle=0.01)
    z = r + 0.1 if d.hand.hollow else r
    g = d.gap(0.02)
    d.part("blade", rod(0.02, (0, 0, z - 0.03), (0, 0, z - g)), block((0, 0, z - 0.028), (0.8 * w, 0.05, 0.004)),
        material="steel")
    d.spin("blade", "deck", Z, (0, 0, z))
    x = -n / 2 + 0.05
    d.part("handle", *(rod(0.014, (x, s * 0.3 * w, r + 0.12 + 0.015 + g), (x - 0.7, s * 0.3 * w, 0.95)) for s in (-1,
        1)), rod(0.014, (x - 0.7, -0.3 * w, 0.95), (x - 0.7, 0.3 * w, 0.95)), material="steel")
    d.hinge("handle", "deck", Y, (x, 0, r + 0.135 + g), 1.2, -0.3)


def barbecue(d: ObjectBuilder) -> None:
    """A bowl with a lid, vents that turn, a tray, wheels."""
    r, z = d.u(0.2, 0.32), d.u(0.6, 0.75)
    d.part("bowl", lathe([(0, 0), (0.6 * r, 0.1 * r), (r, 0.7 * r), (0, 0.7 * r)], (0, 0, z)), *(rod(0.012,
        (0.5 * r * np.cos(a), 0.5 * r * np.sin(a), z + 0.2 * r), (0.9 * r * np.cos(a), 0.9 * r * np.sin(a),
        0.05)) for a in np.arange(3) * 2 * np.pi / 3), material="steel")
    if d.hand.hollow:
        d.cut("bowl", lathe([(0, 0.1 * r), (0.55 * r, 0.2 * r), (0.93 * r, 0.75 * r), (0, 0.75 * r)], (0, 0, z)))
    g = d.gap(0.05)
    top = z + 0.7 * r + g
    d.part("lid", lathe([(0, 0), (r, 0), (0.6 * r, 0.6 * r), (0, 0.7 * r)], (0, 0, top)), material="steel")
    grip(d, "lid", (0, -0.75 * r, top + 0.35 * r), -Y, X, 0.15)
    if d.maybe(0.6):
        d.hinge("lid", "bowl", -X, (0, r, top), 1.4)
    else:
        d.slide("lid", "bowl", Z, 0.2)
    d.part("vent", rod(0.2 * r, (0, 0, top + 0.7 * r + g), (0, 0, top + 0.7 * r + 0.004 + g)), rod(0.03 * r, (0, 0,
        top + 0.7 * r + g), (0, 0, top + 0.75 * r)))
    d.hinge("vent", "lid", Z, (0, 0, top + 0.7 * r), 0.8, initial_opening=False)


def parasol(d: ObjectBuilder) -> None:
    """A canopy that tilts on a pole that slides in its stand."""
    h, r = d.u(1.8, 2.5), d.u(0.8, 1.5)
    d.part("stand", rod(0.25, (0, 0, 0), (0, 0, 0.08)), tube(0.03, 0.02 if d.hand.has_bore else 0.001, (0, 0, 0.05),
        (0, 0,
        0.5)), material="steel")
    g = d.gap(0.02) + 0.0003
    d.part("pole", rod(0.02 - (g if d.hand.has_bore else 0), (0, 0, 0.1), (0, 0, 0.8 * h)), material="metal")
    d.slide("pole", "stand", Z, 0.25)
    d.part("canopy", rod(0.018, (0, 0, 0.8 * h + g), (0, 0, h)), cone(r, 0.02, (0, 0, h - 0.05), (0, 0, h + 0.25 * r)))
    d.hinge("canopy", "pole", X, (0, 0, 0.8 * h), 0.02 if d.hand.has_bore else 0.7, initial_opening=False)
