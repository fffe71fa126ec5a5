"""Machines of factories, farms and shops."""

from __future__ import annotations

from itertools import pairwise
from math import cos, sin
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.kind import kind, length
from kinematify.generate.library.mechanisms import arm, bail, case, knob, plunger, rotor
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.solids import X, Y, Z, beam, block, box, slab, vector

if TYPE_CHECKING:
    from kinematify.generate.procedural.builder import ObjectBuilder


@kind("parametric toolbox", like="box", width=length(0.35, 0.6), depth=length(0.18, 0.3), height=length(0.15, 0.3))
def toolbox(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A case with a lid, a bail and drawers."""
    case(
        b,
        "box",
        lower=(-width / 2, -depth / 2, 0),
        upper=(width / 2, depth / 2, height),
        opening=Z,
        wall=0.008,
        material="steel",
    )
    leaf(
        b,
        "lid",
        parent="box",
        lower=(-width / 2, -depth / 2, height),
        upper=(width / 2, depth / 2, height + 0.04),
        hinge=Y,
        out=Z,
        reach=1.6,
        handle=False,
        material="steel",
    )
    if b.maybe():
        bail(
            b,
            "handle",
            parent="lid",
            start=(-0.3 * width, 0, height + 0.053),
            end=(0.3 * width, 0, height + 0.053),
            high=0.08,
            thick=0.012,
            up=Z,
            lower=-0.5,
            upper=0.5,
        )
        b.part("lid", [block((s * 0.29 * width, 0, height + 0.048), (0.02 * width, 0.03, 0.03)) for s in (-1, 1)])
    g = b.gap(0.03)
    for k, s in enumerate((-1, 1)):
        x = s * 0.35 * width
        b.part(
            f"latch_{k}",
            box((x - 0.015, -depth / 2 - 0.008 - g, height - 0.03), (x + 0.015, -depth / 2 - g, height + 0.02)),
            look="steel",
        )
        b.hinge(
            f"latch_{k}",
            parent="box",
            axis=X,
            pivot=(x, -depth / 2 - g - 0.008 * b.pick(0, 1), height - 0.03),
            upper=1.4,
            ajar=False,
        )


@kind("parametric bench vice", like="vise", width=length(0.1, 0.16), length=length(0.2, 0.3))
def bench_vice(b: ObjectBuilder, width: float, length: float) -> None:
    """A jaw that slides, a screw with a tommy bar."""
    b.part(
        "body",
        slab(width / 2, (0, 0.7 * length), (0, 0.06)),
        slab(width / 2, (0, 0.12 * length), (0, 0.14)),
        slab(0.3 * width, (0.1 * length, 0.7 * length), (0.05, 0.1)),
        look="steel",
    )
    g = b.gap(0.03) + 0.0004
    y = -b.draw(0.05, 0.3) * length
    b.bore("body", slab(0.16 * width + g, (-0.1, length), (0.06 - g, 0.09 + g)))
    b.part(
        "jaw",
        slab(width / 2, (y - 0.12 * length, y), (0.03, 0.14)),
        slab(0.16 * width, (y - 0.01, 0.5 * length if b.style.has_bore else -g), (0.06, 0.09)),
        look="steel",
    )
    b.slide("jaw", parent="body", axis=-Y, upper=0.3 * length, lower=y + g, ajar=False)
    at = vector(0, y - 0.12 * length, 0.075)
    b.part(
        "screw",
        b.cylinder(0.014, at - g * Y, at - 0.05 * Y),
        b.cylinder(0.005, at + vector(-0.07, -0.04, 0), at + vector(0.07, -0.04, 0)),
        look="steel",
    )
    b.spin("screw", parent="jaw", axis=-Y, pivot=at)


@kind("parametric drill press", like="drill_press", height=length(0.7, 1.6))
def parametric_drill_press(b: ObjectBuilder, height: float) -> None:
    """A table that slides on the column, a quill, a star handle, a chuck."""
    b.part(
        "stand",
        slab(0.15, (-0.25, 0.15), (0, 0.04)),
        b.cylinder(0.035, (0, 0.08, 0.03), (0, 0.08, height)),
        slab(0.09, (-0.22, 0.14), (height - 0.2, height)),
        look="steel",
    )
    g = b.gap(0.03) + 0.0004
    z = b.draw(0.25, 0.45) * height
    b.part(
        "table",
        slab(0.13, (-0.24, 0.02), (z, z + 0.025)),
        b.tube(0.055, 0.036 + g if b.style.has_bore else 0.01, (0, 0.08, z - 0.04), (0, 0.08, z + 0.06)),
        slab(0.04, (-0.1, 0.035), (z - 0.02, z + 0.01)),
        look="steel",
    )
    b.bore("table", b.cylinder(0.036 + 1.5 * g, (0, 0.08, 0), (0, 0.08, height)))
    b.slide("table", parent="stand", axis=Z, upper=0.15 * height, lower=-0.1 * height, ajar=False)
    q = vector(0, -0.14, height - 0.2)
    b.part("quill", b.cylinder(0.03, q - 0.06 * Z, q + (0.1 * Z if b.style.has_bore else -g * Z)), look="steel")
    b.bore("stand", b.cylinder(0.03 + 1.5 * g, q - Z, q + 0.12 * Z))
    b.slide("quill", parent="stand", axis=-Z, upper=0.03 if not b.style.has_bore else 0.08, ajar=False)
    b.part(
        "chuck",
        b.cone(0.014, 0.022, q - 0.11 * Z, q - (0.06 + g) * Z),
        b.cylinder(0.004, q - 0.18 * Z, q - 0.1 * Z),
        look="steel",
    )
    b.spin("chuck", parent="quill", axis=Z, pivot=q - 0.06 * Z)
    at = vector(0.09, -0.08, height - 0.12)
    b.part(
        "feed",
        b.cylinder(0.018, at + g * X, at + 0.04 * X),
        [
            b.cylinder(0.007, at + 0.025 * X, at + 0.04 * X + 0.16 * vector(0.2, cos(a), sin(a)))
            for a in np.arange(3) * 2.1
        ],
        look="steel",
    )
    b.hinge("feed", parent="stand", axis=X, pivot=at, upper=3.0, lower=-0.2, ajar=False)


@kind("lathe machine", like="lathe", length=length(1.2, 2.0))
def lathe_machine(b: ObjectBuilder, length: float) -> None:
    """A spindle, a carriage on a bed, a tailstock, handwheels."""
    b.part(
        "bed",
        slab(length / 2, 0.14, (0, 0.1)),
        slab(length / 2, 0.02, (0.05, 0.14)),
        slab((-length / 2, -length / 2 + 0.3), 0.14, (0.08, 0.4)),
        look="steel",
    )
    g = b.gap(0.03) + 0.0004
    at = vector(-length / 2 + 0.3, 0, 0.28)
    b.part(
        "chuck",
        b.cylinder(0.07, at + g * X, at + 0.06 * X),
        [block(at + 0.07 * X + 0.045 * vector(0, cos(a), sin(a)), (0.04, 0.02, 0.02)) for a in np.arange(3) * 2.1],
        look="steel",
    )
    b.spin("chuck", parent="bed", axis=X, pivot=at)
    x_carriage = b.draw(0, 0.08) * length
    for name, x, h in (("carriage", x_carriage, 0.24), ("tailstock", 0.4 * length, 0.31)):
        b.part(
            name,
            slab((x - 0.07, x + 0.07), 0.13, (0.1 + g, 0.18)),
            slab((x - 0.04, x + 0.04), 0.04, (0.15, h)),
            look="steel",
        )
        b.bore(name, slab((x - 1, x + 1), 0.02 + g, (0, 0.14 + g)))
        b.slide(
            name,
            parent="bed",
            axis=-X if name == "tailstock" else X,
            upper=0.12 * length,
            lower=-0.06 * length,
            ajar=False,
        )
    knob(b, "handwheel", parent="carriage", at=(x_carriage, -0.13, 0.14), radius=0.025, high=0.03, out=-Y)


@kind("parametric hand pump", like="hand_water_pump", height=length(0.7, 1.1))
def hand_pump(b: ObjectBuilder, height: float) -> None:
    """A well pump: a long lever on a post and a spout; the rod goes up and down."""
    b.part(
        "post",
        b.cylinder(0.09, 0, 0.04),
        b.cylinder(0.055, 0.03, height),
        b.rod(0.025, (0, 0, 0.75 * height), (0.2, 0, 0.72 * height)),
        beam(0.03, 0.03, (-0.04, 0, height - 0.05), (-0.12, 0, height + 0.05), Y),
        look="steel",
    )
    g = b.gap(0.02) + 0.0005
    b.bore("post", b.cylinder(0.01 + 1.5 * g, 0.4, height + 1))
    b.part("rod", b.cylinder(0.01, 0.5 * height if b.style.has_bore else height + g, height + 0.12), look="steel")
    b.slide("rod", parent="post", axis=Z, upper=0.08, ajar=False)
    arm(
        b,
        "handle",
        parent="post",
        start=(-0.12, 0, height + 0.05),
        end=(-0.6, 0, height - 0.2),
        thick=0.03,
        axis=Y,
        lower=-0.4,
        upper=0.4,
    )


@kind("parametric robot arm", like="serial_arm", size=length(0.3, 1.2))
def robot_arm(b: ObjectBuilder, size: float) -> None:
    """Four to six links of blocks and cylinders; turns about z, then y, y, x, y."""
    b.part("base", b.cylinder(0.16 * size, 0, 0.12 * size), look="steel")
    g = b.gap(0.1 * size)
    b.part(
        "shoulder",
        b.cylinder(0.13 * size, 0.12 * size + g, 0.25 * size),
        slab(0.06 * size, 0.05 * size, (0.2 * size, 0.36 * size)),
    )
    b.hinge("shoulder", parent="base", axis=Z, pivot=(0, 0, 0.12 * size), upper=2.9, lower=-2.9, ajar=False)
    step = 0.1 * size + b.gap(0.1 * size) if b.style.has_bore else 0
    chain = [
        vector(0, 0, 0.32 * size),
        vector(0.1 * size, 0, 0.75 * size),
        vector(0.5 * size, 0, 0.8 * size),
        vector(0.62 * size, 0, 0.7 * size),
    ]
    parent = "shoulder"
    for i, (a, b_) in enumerate(pairwise(chain)):
        arm(
            b,
            f"link_{i}",
            parent=parent,
            start=a + i * step * Y,
            end=b_ + i * step * Y,
            thick=0.1 * size,
            axis=Y,
            lower=-1 if i else -0.6,
            upper=1 if i else 0.6,
        )
        parent = f"link_{i}"
    end = chain[-1] + 3 * step * Y
    b.part(
        "flange",
        b.cylinder(
            0.04 * size,
            end + vector(0.05 * size + g + 0.02 * size, 0, -0.06 * size),
            end + vector(0.12 * size, 0, -0.06 * size),
        ),
    )
    if not b.style.has_bore:
        b.spin("flange", parent=parent, axis=X, pivot=end + vector(0.07 * size, 0, -0.06 * size))
    else:
        b.fix("flange", parent=parent)


@kind("parametric syringe", like="syringe", radius=length(0.004, 0.02), length=length(0.06, 0.15))
def parametric_syringe(b: ObjectBuilder, radius: float, length: float) -> None:
    """A syringe: a plunger in a barrel."""
    up = b.pick(X, Z)
    b.part(
        "barrel",
        b.cylinder(radius, 0 * up, length * up),
        b.cylinder(0.3 * radius, -0.15 * length * up, 0.01 * up),
        beam(4 * radius, 1.5 * radius, length * up - 0.002 * up, length * up, Y),
        look="glass",
    )
    plunger(
        b,
        "plunger",
        parent="barrel",
        start=(length + b.draw(0.1, 0.7) * length) * up,
        end=0.25 * length * up,
        radius=0.8 * radius,
        travel=0.2 * length,
    )
    b.part(
        "plunger",
        b.cylinder(1.5 * radius, 1.95 * length * up, (1.95 * length + 0.004) * up),
        b.cylinder(0.6 * radius, 0.9 * length * up, 1.95 * length * up),
    )


@kind("parametric cable reel", like="winch", radius=length(0.1, 0.4))
def cable_reel(b: ObjectBuilder, radius: float) -> None:
    """A drum with flanges on a stand, with a crank."""
    w = 0.0
    w = b.draw(0.6, 1.2) * radius
    c = vector(0, 0, 1.2 * radius)
    for s in (-1, 1):
        b.part(
            "stand",
            beam(
                0.08 * radius,
                0.08 * radius,
                (s * (w / 2 + 0.12 * radius), -0.8 * radius, 0),
                c + s * (w / 2 + 0.12 * radius) * X,
                X,
            ),
            beam(
                0.08 * radius,
                0.08 * radius,
                (s * (w / 2 + 0.12 * radius), 0.8 * radius, 0),
                c + s * (w / 2 + 0.12 * radius) * X,
                X,
            ),
            look="steel",
        )
    b.part(
        "stand",
        beam(
            0.08 * radius,
            0.08 * radius,
            (-w / 2 - 0.12 * radius, 0.8 * radius, 0.04 * radius),
            (w / 2 + 0.12 * radius, 0.8 * radius, 0.04 * radius),
        ),
        beam(
            0.08 * radius,
            0.08 * radius,
            (-w / 2 - 0.12 * radius, -0.8 * radius, 0.04 * radius),
            (w / 2 + 0.12 * radius, -0.8 * radius, 0.04 * radius),
        ),
    )
    g = b.gap(0.05 * radius) + 0.0003
    b.part(
        "drum",
        b.cylinder(0.5 * radius, c - w / 2 * X, c + w / 2 * X),
        [b.cylinder(radius, c + s * w / 2 * X, c + s * (w / 2 - 0.05 * radius) * X) for s in (-1, 1)],
        b.cylinder(0.03 * radius, c - (w / 2 + 0.2 * radius) * X, c + (w / 2 + 0.2 * radius) * X),
        look="wood",
    )
    if b.maybe():
        e = c + (w / 2 + 0.2 * radius) * X
        b.part(
            "drum",
            beam(0.05 * radius, 0.05 * radius, e, e + 0.4 * radius * Y),
            b.cylinder(0.03 * radius, e + 0.38 * radius * Y, e + 0.38 * radius * Y + 0.3 * radius * X),
        )
    b.bore("stand", b.cylinder(0.03 * radius + 1.5 * g, c - 2 * radius * X, c + 2 * radius * X))
    b.spin("drum", parent="stand", axis=X, pivot=c)


@kind("parametric microscope", like="microscope", size=length(0.8, 1.2))
def parametric_microscope(b: ObjectBuilder, size: float) -> None:
    """A stage that slides, a turret, focus knobs, a tilting tube."""
    p = b.sized(size)
    b.part(
        "stand",
        p.slab(0.08, 0.1, (0, 0.03)),
        p.slab(0.03, (0.05, 0.09), (0.02, 0.3)),
        p.slab(0.03, (-0.04, 0.09), (0.27, 0.31)),
        p.cylinder(0.02, (0, -0.02, 0.3), (0, -0.09, 0.4)),
        look="metal",
    )
    g = b.gap(0.01) + 0.0003
    b.part(
        "stage",
        box(p(-0.07, -0.09, 0.13), p(0.07, 0.05, 0.14) - g * Y),
        box(p(-0.02, 0.02, 0.12), p(0.02, 0.05, 0.17) - g * Y),
    )
    b.slide("stage", parent="stand", axis=Z, upper=0.03 * size, lower=-0.03 * size, ajar=False)
    at = p(0, -0.02, 0.27)
    b.part(
        "turret",
        b.cylinder(0.025 * size, at - g * Z, at - 0.015 * size * Z),
        [
            b.cylinder(0.006 * size, at - 0.01 * size * Z + 0.015 * size * v, at - 0.05 * size * Z + 0.018 * size * v)
            for v in (X, -0.5 * X + 0.87 * Y, -0.5 * X - 0.87 * Y)
        ],
        look="metal",
    )
    b.spin("turret", parent="stand", axis=Z, pivot=at)
    for s in (-1, 1):
        knob(
            b,
            f"focus_{int(s > 0)}",
            parent="stand",
            at=p(s * 0.03, 0.07, 0.08),
            radius=0.02 * size,
            high=0.02 * size,
            out=s * X,
        )


@kind("parametric balance scale", like="balance_scale", size=length(0.2, 0.5))
def parametric_balance_scale(b: ObjectBuilder, size: float) -> None:
    """A beam that tilts on a post, two pans that hang."""
    b.part("stand", b.cylinder(0.25 * size, 0, 0.04 * size), b.cone(0.03 * size, 0.004 * size, 0, size), look="metal")
    g = b.gap(0.03 * size)
    z = size + g + 0.02 * size
    b.part("beam", slab(0.5 * size, 0.02 * size, (z - 0.02 * size, z + 0.02 * size)), look="metal")
    b.hinge("beam", parent="stand", axis=Y, pivot=(0, 0, b.pick(z, size)), upper=0.15, lower=-0.15, ajar=False)
    for i, s in enumerate((-1, 1)):
        x = s * 0.47 * size
        low = z - 0.02 * size - g
        b.part(
            f"pan_{i}",
            b.cylinder(0.008 * size, (x, 0, low), (x, 0, low - 0.45 * size)),
            b.cylinder(0.18 * size, (x, 0, low - 0.47 * size), (x, 0, low - 0.45 * size)),
        )
        b.hinge(f"pan_{i}", parent="beam", axis=Y, pivot=(x, 0, low), upper=0.3, lower=-0.3, ajar=False)


@kind("parametric desk fan", like="fan", radius=length(0.1, 0.2), height=length(0.2, 0.35))
def desk_fan(b: ObjectBuilder, radius: float, height: float) -> None:
    """A base, a neck that tilts, a guard with a rotor."""
    b.part(
        "base",
        b.cylinder(0.8 * radius, 0, 0.03),
        b.cylinder(0.12 * radius, (0, 0.1 * radius, 0.02), (0, 0.1 * radius, height)),
    )
    g = b.gap(0.02)
    c = vector(0, 0.1 * radius, height + 0.25 * radius + g)
    b.part(
        "head",
        b.cylinder(0.25 * radius, c + 0.4 * radius * Y, c - 0.2 * radius * Y),
        b.tube(0.25 * radius, 0.18 * radius, c - 0.19 * radius * Y, c - 0.23 * radius * Y),
        b.torus(radius, 0.04 * radius, c - 0.22 * radius * Y, Y),
        [
            beam(
                0.02 * radius,
                0.02 * radius,
                c - 0.22 * radius * Y + 0.2 * radius * v,
                c - 0.22 * radius * Y + radius * v,
            )
            for v in (X, -X, Z, -Z)
        ],
    )
    b.hinge(
        "head",
        parent="base",
        axis=X,
        pivot=(0, 0.1 * radius, height + (g if b.style.has_bore else 0)),
        upper=0.02 if b.style.has_bore else 0.4,
        ajar=False,
    )
    rotor(
        b, "rotor", parent="head", at=c - 0.2 * radius * Y, out=-Y, radius=0.7 * radius, blades=b.count(3, 5), wide=0.25
    )


@kind("parametric reading lamp", like="desk_lamp", size=length(0.25, 0.45))
def reading_lamp(b: ObjectBuilder, size: float) -> None:
    """Two arms and a shade on a foot."""
    b.part(
        "foot",
        b.cylinder(0.3 * size, 0, 0.06 * size),
        b.cylinder(0.03 * size if b.style.has_bore else 0.05 * size, 0.05 * size, 0.2 * size),
        look="metal",
    )
    step = 0.06 * size + b.gap(0.06 * size) if b.style.has_bore else 0
    a = vector(0, 0, 0.18 * size)
    b_ = vector(-0.35 * size, 0, 1 * size)
    c = vector(0.5 * size, 0, 1.5 * size)
    arm(b, "lower_arm", parent="foot", start=a, end=b_, thick=0.06 * size, axis=Y, lower=-0.5, upper=0.5)
    arm(
        b,
        "upper_arm",
        parent="lower_arm",
        start=b_ + step * Y,
        end=c + step * Y,
        thick=0.06 * size,
        axis=Y,
        lower=-0.6,
        upper=0.6,
    )
    g = b.gap(0.05 * size)
    e = c + 2 * step * Y
    b.part(
        "shade", b.cone(0.08 * size, 0.3 * size, e + (0.04 * size + g) * X + 0 * Z, e + 0.4 * size * X - 0.2 * size * Z)
    )
    b.hinge(
        "shade",
        parent="upper_arm",
        axis=Y,
        pivot=e + (0 if not b.style.has_bore else 0.03 * size) * X,
        upper=0.05 if b.style.has_bore else 0.8,
        lower=-0.05 if b.style.has_bore else -0.5,
        ajar=False,
    )


@kind("parametric pallet truck", like="pallet_jack", length=length(1.0, 1.3))
def pallet_truck(b: ObjectBuilder, length: float) -> None:
    """Two forks, a drawbar that swings, wheels under it."""
    r = 0.09
    b.part(
        "truck",
        [box((0, s * 0.2 - 0.08, 0.08), (length, s * 0.2 + 0.08, 0.13)) for s in (-1, 1)],
        slab((-0.16, 0.02), 0.28, (0.2, 0.45)),
        [slab(0.02, (s * 0.2 - 0.08, s * 0.2 + 0.08), (0.08, 0.3)) for s in (-1, 1)],
        look="steel",
    )
    g = b.gap(0.05) + 0.0005
    b.part(
        "drawbar_head",
        b.cylinder(0.05, (-0.1, 0, 0.2 - g), (-0.1, 0, 0.14)),
        slab((-0.22, -0.04), 0.05, (0.06, 0.15)),
        look="steel",
    )
    b.hinge("drawbar_head", parent="truck", axis=Z, pivot=(-0.1, 0, 0.2), upper=0.8, lower=-0.8, ajar=False)
    for s in (-1, 1):
        b.part(
            f"wheel_{int(s > 0)}", b.cylinder(r, (-0.1, s * (0.05 + g), r), (-0.1, s * (0.11 + g), r)), look="rubber"
        )
        b.spin(f"wheel_{int(s > 0)}", parent="drawbar_head", axis=s * Y, pivot=(-0.1, 0, r))
    x = -0.221 - (0.022 if b.style.has_bore else 0) - g
    b.part("drawbar_head", [box((x - 0.02, s * 0.024, 0.1), (-0.21, s * 0.034, 0.14)) for s in (-1, 1)])
    b.bore("drawbar_head", b.cylinder(0.008 + 1.5 * g, (x, -1, 0.12), (x, 1, 0.12)))
    b.part(
        "drawbar",
        b.cylinder(0.008, (x, -0.034, 0.12), (x, 0.034, 0.12)),
        beam(0.04, 0.04, (x, 0, 0.12), (-0.4, 0, 1.1), Y),
        b.cylinder(0.015, (-0.4, -0.15, 1.1), (-0.4, 0.15, 1.1)),
        look="steel",
    )
    b.hinge(
        "drawbar",
        parent="drawbar_head",
        axis=-Y,
        pivot=(x, 0, 0.12),
        upper=0.5 if not b.style.has_bore else 0.3,
        ajar=False,
    )


@kind("parametric door bolt", like="door_bolt", length=length(0.08, 0.25))
def parametric_door_bolt(b: ObjectBuilder, length: float) -> None:
    """A sliding bolt in guides with a keeper."""
    k = 0.06 * length
    b.part(
        "plate",
        slab((0, length), (0, k * 0.5), 2.5 * k),
        slab((length + 2 * k, length + 4 * k), (0, k * 0.5), 2.5 * k),
        slab((length - 0.01 * length, length + 2.1 * k), (0.2 * k, 0.5 * k), 0.4 * k),
        look="steel",
    )
    g = b.gap(0.2 * k) + 0.0001
    y = -(k + g)
    for x in (0.25 * length, 0.8 * length):
        b.part("plate", slab((x - k, x + k), (y - 1.6 * k, 0.1 * k), 1.8 * k))
    b.bore("plate", b.cylinder(k + 1.5 * g, (-length, y, 0), (2 * length, y, 0)))
    b.part(
        "bolt",
        b.cylinder(k, (0.02 * length, y, 0), (length, y, 0)),
        b.cylinder(0.6 * k, (0.5 * length, y, 0), (0.5 * length, y - 3 * k, 0)),
        look="steel",
    )
    b.slide("bolt", parent="plate", axis=X, upper=3 * k)


@kind("steering rack", like="rack_and_pinion", length=length(0.5, 1.0))
def steering_rack(b: ObjectBuilder, length: float) -> None:
    L = length
    p = b.sized(L)
    b.part(
        "housing",
        p.cylinder(0.04, (-0.3, 0, 0), (0.3, 0, 0)),
        p.cylinder(0.035, (0, -0.03, 0.03), (0, -0.03, 0.12)),
        [slab((s * 0.25 * L - 0.02 * L, s * 0.25 * L + 0.02 * L), 0.06 * L, (-0.06 * L, -0.03 * L)) for s in (-1, 1)],
        look="metal",
    )
    b.bore("housing", p.cylinder(0.0215, (-1, 0, 0), (1, 0, 0)))
    b.bore("housing", p.cylinder(0.0135, (0, -0.03, 0.045), (0, -0.03, 1)))
    b.part(
        "rack",
        p.cylinder(0.02, (-0.42, 0, 0), (0.42, 0, 0)),
        [p.ball(0.03, (s * 0.43, 0, 0)) for s in (-1, 1)],
        look="steel",
    )
    b.slide("rack", parent="housing", axis=X, lower=-0.08 * L, upper=0.08 * L)
    b.part(
        "pinion",
        p.cylinder(0.012, (0, -0.03, 0.055), (0, -0.03, 0.3)),
        p.cylinder(0.03, (0, -0.03, 0.28), (0, -0.03, 0.3)),
        look="steel",
    )
    b.hinge("pinion", parent="housing", axis=Z, pivot=[0, -0.03 * L, 0], lower=-6.28, upper=6.28)
    b.follow("rack", leader="pinion", multiplier=0.0127 * L)


@kind("shock absorber", like="hydraulic_cylinder", length=length(0.2, 0.5))
def shock_absorber(b: ObjectBuilder, length: float) -> None:
    L = length
    b.part(
        "cylinder",
        b.cylinder(0.07 * L, 0.06 * L, 0.6 * L),
        b.cylinder(0.05 * L, (-0.04 * L, 0, 0.03 * L), (0.04 * L, 0, 0.03 * L)),
        look="black steel",
    )
    b.bore("cylinder", b.cylinder(0.027 * L, 0.12 * L, L))
    b.part(
        "rod",
        b.cylinder(0.025 * L, 0.2 * L, 0.97 * L),
        b.cylinder(0.05 * L, (-0.04 * L, 0, L), (0.04 * L, 0, L)),
        b.cylinder(0.08 * L, 0.9 * L, 0.92 * L),
        look="chrome",
    )
    b.slide("rod", parent="cylinder", axis=Z, lower=-0.07 * L, upper=0.22 * L)
