"""Music, games, sports and toys."""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.library.kind import choice, kind, length, whole, yes
from kinematify.generate.library.mechanisms import bail, button, case, caster, crank, knob, legs, lever, plunger, wheel
from kinematify.generate.library.panels import leaf
from kinematify.generate.procedural.builder import spread
from kinematify.generate.procedural.solids import X, Y, Z, beam, block, box, slab, vector

if TYPE_CHECKING:
    from kinematify.generate.procedural.builder import ObjectBuilder


@kind("parametric gyroscope", like="gyroscope", radius=length(0.03, 0.3))
def parametric_gyroscope(b: ObjectBuilder, radius: float) -> None:
    """A wheel in a ring in a ring."""
    p = b.sized(radius)
    g = b.gap(0.05 * radius) + 0.0002
    c = vector(0, 0, 1.7 * radius)
    b.part(
        "stand",
        p.cylinder(0.8, 0, 0.1),
        [p.beam(0.1, 0.1, (s * 1.5, 0, 0.05), (s * 1.5, 0, 1.75), Y) for s in (-1, 1)],
        p.beam(0.1, 0.1, (-1.5, 0, 0.05), (1.5, 0, 0.05)),
        look="metal",
    )
    b.part(
        "gimbal",
        b.tube(1.38 * radius, 1.25 * radius, c - 0.06 * radius * Y, c + 0.06 * radius * Y),
        [b.cylinder(0.04 * radius, c + s * 1.3 * radius * X, c + s * 1.55 * radius * X) for s in (-1, 1)],
        look="metal",
    )
    b.bore("stand", b.cylinder(0.04 * radius + 1.5 * g, c - 2 * radius * X, c + 2 * radius * X))
    b.spin("gimbal", parent="stand", axis=X, pivot=c)
    b.part(
        "wheel",
        b.cylinder(1 * radius, c - 0.08 * radius * Y, c + 0.08 * radius * Y),
        b.cylinder(0.04 * radius, c - 1.24 * radius * Z, c + 1.24 * radius * Z),
        look="metal",
    )
    b.part("gimbal", [b.cylinder(0.06 * radius, c + s * 1.245 * radius * Z, c + s * 1.3 * radius * Z) for s in (-1, 1)])
    b.spin("wheel", parent="gimbal", axis=Z, pivot=c)


@kind("parametric upright piano", like="piano", number=whole(5, 10, words="key"))
def upright_piano(b: ObjectBuilder, number: int) -> None:
    """Keys, a fallboard, pedals, a lid."""
    w = 1 * b.draw(0.6, 1.4)
    b.part(
        "piano",
        slab(w / 2, (0, 0.35), (0, 1.2)),
        slab(w / 2, (-0.25, 0.01), (0.6, 0.65)),
        [box((s * w / 2, -0.28, 0), (s * (w / 2 - 0.04), 0.01, 0.8)) for s in (-1, 1)],
        look="wood",
    )
    g = max(b.gap(0.05), 0.0005)
    for k, x in enumerate(spread(number, -w / 2 + 0.05, w / 2 - 0.05)):
        a = (w - 0.1) / number / 2 - g
        b.part(f"key_{k}", box((x - a, -0.2, 0.665), (x + a, -g, 0.685)))
        b.hinge(f"key_{k}", parent="piano", axis=X, pivot=(x, -g, 0.665), upper=0.05, ajar=False)
    for k, x in enumerate((-0.08, 0.08)):
        b.part(f"pedal_{k}", box((x - 0.02, -0.12, 0.06), (x + 0.02, -g, 0.075)), look="metal")
        b.hinge(f"pedal_{k}", parent="piano", axis=X, pivot=(x, -g, 0.06), upper=0.15, ajar=False)
    leaf(
        b,
        "lid",
        parent="piano",
        lower=(-w / 2, 0, 1.2),
        upper=(w / 2, 0.35, 1.22),
        hinge=Y,
        out=Z,
        reach=1.5,
        handle=False,
    )


@kind("parametric hi hat", like="hi_hat", height=length(0.7, 1.0), radius=length(0.14, 0.2))
def parametric_hi_hat(b: ObjectBuilder, height: float, radius: float) -> None:
    """A bass drum pedal, and a hi-hat whose upper cymbal rides on its rod."""
    b.part(
        "stand",
        b.cylinder(0.012, 0.02, height - 0.02),
        [b.cylinder(0.01, (0, 0, 0.3 * height), (0.3 * cos(a), 0.3 * sin(a), 0)) for a in np.arange(3) * 2.1 + 1.57],
        b.cone(radius, 0.03, height, height - 0.03),
        slab(0.05, (-0.35, 0), (0, 0.02)),
        look="metal",
    )
    g = b.gap(0.01) + 0.0003
    b.part(
        "cymbal",
        b.cone(radius, 0.03, height + 0.012, height + 0.05),
        b.cylinder(0.004, height - 0.2 if b.style.has_bore else height + 0.01, height + 0.2),
        look="metal",
    )
    b.bore("stand", b.cylinder(0.004 + 1.5 * g, height - 0.25, height + 1))
    b.slide("cymbal", parent="stand", axis=Z, upper=0.05, ajar=False)
    b.part("pedal", beam(0.08, 0.01, (0, -0.33, 0.03 + g), (0, -0.05, 0.12)), look="metal")
    b.hinge("pedal", parent="stand", axis=X, pivot=(0, -0.33, 0.03 + g), upper=0.05, lower=-0.25, ajar=False)


@kind("parametric metronome", like="metronome", height=length(0.15, 0.25))
def parametric_metronome(b: ObjectBuilder, height: float) -> None:
    """A rod that swings on a tapered case, and a weight on it."""
    p = b.sized(height)
    b.part(
        "case",
        p.prism([(-0.35, 0), (0.35, 0), (0.12, 1), (-0.12, 1)], (0, 0, 0), 0.4, "y"),
        look="wood",
    )
    g = b.gap(0.01) + 0.0003
    y = -0.2 * height - g - 0.004
    b.part(
        "rod",
        beam(0.008, 0.004, (0, y, 0.2 * height), (0, y, 1.1 * height), Y),
        b.cylinder(0.01, (0, y - 0.004, 0.2 * height), (0, y + 0.004, 0.2 * height)),
        look="metal",
    )
    b.hinge("rod", parent="case", axis=-Y, pivot=(0, y, 0.2 * height), upper=0.6, lower=-0.6)
    z = b.draw(0.5, 0.8) * height
    b.part("weight", slab(0.015, (y - 0.012, y - 0.002 - g), (z, z + 0.025)), look="metal")
    b.slide("weight", parent="rod", axis=Z, upper=0.2 * height, lower=-0.1 * height, ajar=False)


@kind("parametric wall clock", like="clock", radius=length(0.08, 0.25))
def wall_clock(b: ObjectBuilder, radius: float) -> None:
    """Two or three hands about one axis, a pendulum."""
    b.part("clock", b.cylinder(radius, (0, 0, 0), (0, 0.04, 0)), look="wood")
    g = b.gap(0.01) + 0.0005
    y = 0.0
    for name, n, wide in (("hour_hand", 0.5, 0.08), ("minute_hand", 0.8, 0.05), ("second_hand", 0.85, 0.02))[
        : b.count(2, 3)
    ]:
        y = y - g
        a = b.draw(0, 6.28)
        u = vector(cos(a), 0, sin(a))
        b.part(
            name,
            beam(
                wide * radius,
                0.002,
                vector(0, y - 0.001, 0) - 0.12 * radius * u,
                vector(0, y - 0.001, 0) + n * radius * u,
                Y,
            ),
            b.cylinder(0.06 * radius, (0, y, 0), (0, y - 0.002, 0)),
            look="metal",
        )
        b.spin(name, parent="clock", axis=-Y, pivot=(0, 0, 0))
        y = y - 0.002
    if b.maybe():
        b.part(
            "clock",
            box((-0.4 * radius, 0, -2.6 * radius), (-0.35 * radius, 0.04, -0.8 * radius)),
            box((0.35 * radius, 0, -2.6 * radius), (0.4 * radius, 0.04, -0.8 * radius)),
            slab(0.4 * radius, (0.03, 0.04), (-2.6 * radius, -0.8 * radius)),
        )
        b.part(
            "pendulum",
            b.cylinder(0.02 * radius, (0, 0.015, -1.02 * radius - g), (0, 0.015, -2.1 * radius)),
            b.cylinder(0.15 * radius, (0, 0.01, -2.2 * radius), (0, 0.02, -2.2 * radius)),
            look="metal",
        )
        b.hinge(
            "pendulum",
            parent="clock",
            axis=Y,
            pivot=(0, 0.015, -1.02 * radius - g),
            upper=0.08,
            lower=-0.08,
            ajar=False,
        )


@kind("parametric exercise bike", like="exercise_bike", radius=length(0.16, 0.24))
def parametric_exercise_bike(b: ObjectBuilder, radius: float) -> None:
    """A flywheel, cranks, a seat post."""
    b.part(
        "frame",
        slab((-0.5, -0.42), 0.25, (0, 0.06)),
        slab((0.45, 0.53), 0.25, (0, 0.06)),
        slab((-0.45, 0.5), 0.025, (0.02, 0.07)),
        beam(0.06, 0.06, (-0.2, 0, 0.05), (-0.25, 0, 0.6)),
        [box((0.3 - 0.02, s * 0.06 - 0.01, 0.05), (0.32, s * 0.06 + 0.01, 0.08 + 2.3 * radius)) for s in (-1, 1)],
        slab((0.28, 0.34), 0.07, (0.06 + 2.2 * radius, 1)),
        b.cylinder(0.015, (0.31, -0.25, 1), (0.31, 0.25, 1)),
        slab(0.05, 0.03, (0.05, 0.36)),
        look="steel",
    )
    g = b.gap(0.02) + 0.0005
    b.part(
        "flywheel",
        b.cylinder(radius, (0.3, -0.02, 0.09 + radius), (0.3, 0.02, 0.09 + radius)),
        b.cylinder(0.012, (0.3, -0.08, 0.09 + radius), (0.3, 0.08, 0.09 + radius)),
        look="steel",
    )
    b.bore("frame", b.cylinder(0.012 + 1.5 * g, (0.3, -0.1, 0.09 + radius), (0.3, 0.1, 0.09 + radius)))
    b.spin("flywheel", parent="frame", axis=Y, pivot=(0.3, 0, 0.09 + radius))
    c = vector(0, 0, 0.3)
    for s in (-1, 1):
        b.part(
            "cranks",
            beam(0.012, 0.03, c + s * 0.05 * Y, c + s * 0.05 * Y + s * 0.16 * X),
            box(c + vector(s * 0.16 - 0.03, s * 0.06, -0.01), c + vector(s * 0.16 + 0.03, s * 0.14, 0.01)),
            look="metal",
        )
    b.part("cranks", b.cylinder(0.01, c - 0.06 * Y, c + 0.06 * Y))
    b.bore("frame", b.cylinder(0.01 + 1.5 * g, c - 0.1 * Y, c + 0.1 * Y))
    b.spin("cranks", parent="frame", axis=Y, pivot=c)
    b.bore("frame", beam(0.05, 0.05, (-0.2, 0, 0.1), (-0.27, 0, 0.8)))
    b.part(
        "seat",
        beam(
            0.05 - 2 * g if b.style.has_bore else 0.05,
            0.05 - 2 * g if b.style.has_bore else 0.05,
            (-0.21, 0, 0.2) if b.style.has_bore else (-0.25, 0, 0.6),
            (-0.27, 0, 0.8),
        ),
        slab((-0.4, -0.15), 0.1, (0.8, 0.86)),
    )
    b.slide("seat", parent="frame", axis=vector(-0.07, 0, 0.7) / np.hypot(0.07, 0.7), upper=0.15, ajar=False)


@kind("parametric basketball hoop", like="basketball_hoop", height=length(1.2, 3.0))
def parametric_basketball_hoop(b: ObjectBuilder, height: float) -> None:
    """A ring that folds down on a board, on a base with wheels."""
    b.part(
        "stand",
        slab(0.4, (0, 0.7), (0, 0.15)),
        beam(0.1, 0.1, (0, 0.4, 0.1), (0, 0.4, height), Y),
        slab(0.55, (0.05, 0.08), (height - 0.1, height + 0.65)),
        beam(0.08, 0.08, (0, 0.4, height - 0.05), (0, 0.07, height)),
        look="steel",
    )
    g = b.gap(0.05) + 0.0005
    b.part(
        "ring",
        b.torus(0.23, 0.01, (0, -0.25, height + 0.02), Z),
        slab(0.06, (-0.03, 0.05 - g), (height, height + 0.04)),
        look="steel",
    )
    b.hinge("ring", parent="stand", axis=X, pivot=(0, 0.05 - g, height + (0 if b.style.has_bore else 0.02)), upper=0.6)
    for s in (-1, 1):
        wheel(
            b,
            f"wheel_{int(s > 0)}",
            parent="stand",
            middle=(s * 0.43, 0.1, 0.06),
            radius=0.06,
            wide=0.04,
            out=s * X,
            axle=0.01,
        )


@kind("parametric table football", like="foosball_table", length=length(0.8, 1.3))
def table_football(b: ObjectBuilder, length: float) -> None:
    """Rods with figures that turn (and slide); here they turn."""
    w = 0.7
    z = 0.8
    b.part(
        "table",
        slab(w / 2, length / 2, (z - 0.25, z - 0.2)),
        [slab((s * w / 2, s * (w / 2 - 0.03)), length / 2, (z - 0.25, z)) for s in (-1, 1)],
        [slab(w / 2, (s * length / 2, s * (length / 2 - 0.03)), (z - 0.25, z)) for s in (-1, 1)],
        look="wood",
    )
    legs(b, "table", lower=(-w / 2, -length / 2, 0), upper=(w / 2, length / 2, z - 0.24), thick=0.08)
    g = b.gap(0.01) + 0.0003
    for k, y in enumerate(spread(b.count(3, 6), -0.4 * length, 0.4 * length)):
        b.part(
            f"rod_{k}",
            b.cylinder(0.008, (-w / 2 - 0.25, y, z - 0.06), (w / 2 + 0.15, y, z - 0.06)),
            b.cylinder(0.016, (-w / 2 - 0.3, y, z - 0.06), (-w / 2 - 0.18, y, z - 0.06)),
            [
                box((x - 0.015, y - 0.01, z - 0.16), (x + 0.015, y + 0.01, z - 0.02))
                for x in spread(b.count(1, 4), -0.3, 0.3)
            ],
            look="metal",
        )
        b.bore("table", b.cylinder(0.008 + 1.5 * g, (-w, y, z - 0.06), (w, y, z - 0.06)))
        b.spin(f"rod_{k}", parent="table", axis=X, pivot=(0, y, z - 0.06))


@kind("parametric hole punch", like="hole_punch", length=length(0.08, 0.15), width=length(0.05, 0.12))
def parametric_hole_punch(b: ObjectBuilder, length: float, width: float) -> None:
    """A lever on a base."""
    b.part(
        "base",
        slab(length / 2, width / 2, (0, 0.012)),
        [
            box((-0.35 * length, s * 0.3 * width, 0.01), (-0.15 * length, s * (0.3 * width - 0.004), 0.05))
            for s in (-1, 1)
        ],
        look="steel",
    )
    g = b.gap(0.005) + 0.0002
    half = 0.3 * width - 0.004 - g
    b.part(
        "handle",
        slab((-0.3 * length, 0.6 * length), half, (0.035, 0.045)),
        [box((-0.3 * length, s * half, 0.028), (-0.2 * length, s * (half - 0.003), 0.04)) for s in (-1, 1)],
        look="steel",
    )
    if not b.style.has_bore:
        b.part(
            f"{b.pick('handle', 'base')}",
            b.cylinder(0.003, (-0.25 * length, -0.32 * width, 0.035), (-0.25 * length, 0.32 * width, 0.035)),
        )
    b.hinge("handle", parent="base", axis=Y, pivot=(-0.25 * length, 0, 0.035), upper=0.2, lower=-0.2, ajar=False)


@kind(
    "parametric ring binder",
    like="ring_binder",
    width=length(0.2, 0.3),
    height=length(0.25, 0.35),
    thickness=length(0.02, 0.08),
)
def parametric_ring_binder(b: ObjectBuilder, width: float, height: float, thickness: float) -> None:
    """Two covers about a spine, lying open or shut."""
    g = b.gap(0.01) + 0.0002
    b.part("spine", box((-0.003, 0, 0), (0, height, thickness)), look="cardboard")
    for k, (z0, z1) in enumerate(((-0.003 - g, -g), (thickness + g, thickness + g + 0.003))):
        b.part(f"cover_{k}", box((-0.003, 0, z0), (width, height, z1)), look="cardboard")
        b.hinge(
            f"cover_{k}",
            parent="spine",
            axis=Y * (1 if k == 0 else -1),
            pivot=(-0.003, 0, z1 if k == 0 else z0),
            upper=b.draw(1.4, 3),
        )


@kind(
    "parametric folding phone",
    like="flip_phone",
    width=length(0.05, 0.15),
    thickness=length(0.05, 0.12),
    a=length(0.006, 0.015),
    round_=yes(0.3),
)
def folding_phone(b: ObjectBuilder, width: float, thickness: float, a: float, round_: bool) -> None:
    """Two halves on a hinge: a phone, a console, a compact, a cigarette case."""
    g = b.gap(0.005) + 0.0001
    b.part(
        "lower",
        b.cylinder(width / 2, 0, a) if round_ else slab(width / 2, thickness / 2, (0, a)),
    )
    y = width / 2 if round_ else thickness / 2
    b.part(
        "upper",
        b.cylinder(width / 2, a + g, 2 * a) if round_ else slab(width / 2, thickness / 2, (a + g, 2 * a)),
    )
    if b.style.barrels and (not b.style.has_bore):
        b.part(
            "lower",
            b.cylinder(0.5 * a, (-0.4 * width, y, a), (-0.2 * width, y, a)),
            b.cylinder(0.5 * a, (0.2 * width, y, a), (0.4 * width, y, a)),
        )
        b.part("upper", b.cylinder(0.5 * a, (-0.19 * width, y, a), (0.19 * width, y, a)))
    b.hinge("upper", parent="lower", axis=-X, pivot=(0, y, a + (g / 2 if b.style.gap else 0)), upper=b.draw(1.5, 3))
    if b.maybe() and (not round_):
        for k, x in enumerate(spread(3, -0.35 * width, 0.35 * width)):
            button(
                b,
                f"key_{k}",
                parent="lower",
                at=(x, -thickness / 2, a / 2),
                size=(0.1 * width, 0.4 * a),
                high=0.1 * a,
                out=-Y,
            )


@kind("parametric refracting telescope", like="telescope", size=length(0.5, 1.2))
def refracting_telescope(b: ObjectBuilder, size: float) -> None:
    """An optical tube on a mount with two axes, a focuser that draws out."""
    b.part("pier", b.cone(0.15 * size, 0.08 * size, 0, 0.8 * size), look="metal")
    g = b.gap(0.03 * size) + 0.0003
    b.part(
        "fork",
        b.cylinder(0.1 * size, 0.8 * size + g, 0.86 * size),
        [
            slab(
                (s * 0.11 * size - 0.015 * size, s * 0.11 * size + 0.015 * size), 0.04 * size, (0.84 * size, 1.1 * size)
            )
            for s in (-1, 1)
        ],
        slab(0.12 * size, 0.04 * size, (0.83 * size, 0.87 * size)),
        look="metal",
    )
    b.spin("fork", parent="pier", axis=Z, pivot=(0, 0, 0.8 * size))
    c = vector(0, 0, 1.05 * size)
    b.part(
        "tube",
        b.cylinder(0.07 * size, c - 0.5 * size * Y, c + 0.4 * size * Y),
        [b.cylinder(0.03 * size, c + s * 0.05 * size * X, c + s * (0.095 * size - g) * X) for s in (-1, 1)],
        look="metal",
    )
    b.hinge("tube", parent="fork", axis=X, pivot=c, upper=0.35, lower=-0.35, ajar=False)
    plunger(
        b,
        "focuser",
        parent="tube",
        start=c + 0.55 * size * Y,
        end=c + 0.3 * size * Y,
        radius=0.03 * size,
        travel=0.06 * size,
    )


@kind("parametric centrifuge", like="centrifuge", radius=length(0.1, 0.22))
def parametric_centrifuge(b: ObjectBuilder, radius: float) -> None:
    """A lid over a rotor, a dial in front."""
    case(
        b,
        "housing",
        lower=(-1.3 * radius, -1.4 * radius, 0),
        upper=(1.3 * radius, 1.3 * radius, 1.3 * radius),
        material="plastic",
    )
    b.cut("housing", b.cylinder(1.1 * radius, 0.4 * radius, 2 * radius))
    g = b.gap(0.05 * radius)
    b.part(
        "rotor",
        b.cone(0.95 * radius, 0.6 * radius, 0.5 * radius, 1 * radius),
        b.cylinder(0.15 * radius, 0.4 * radius + g, 0.55 * radius),
        look="metal",
    )
    b.spin("rotor", parent="housing", axis=Z, pivot=(0, 0, 0.4 * radius))
    leaf(
        b,
        "lid",
        parent="housing",
        lower=(-1.25 * radius, -1.3 * radius, 1.3 * radius),
        upper=(1.25 * radius, 1.25 * radius, 1.4 * radius),
        hinge=Y,
        out=Z,
        reach=1.3,
    )
    for k, x in enumerate(spread(b.count(1, 2), -radius, radius)):
        knob(
            b,
            f"dial_{k}",
            parent="housing",
            at=(x, -1.4 * radius, 0.6 * radius),
            radius=0.18 * radius,
            high=0.15 * radius,
            out=-Y,
            reach=4.0,
        )


@kind("parametric hospital bed", like="hospital_bed", width=length(0.85, 1.0), z=length(0.45, 0.6))
def parametric_hospital_bed(b: ObjectBuilder, width: float, z: float) -> None:
    """A back section that rises, rails that drop, casters."""
    n = 2.0
    b.part(
        "frame",
        slab((0, n), width / 2, (z - 0.1, z)),
        slab((0.75, n), width / 2, (z, z + 0.1)),
        slab((-0.03, 0), width / 2, (z - 0.2, z + 0.5)),
        slab((n, n + 0.03), width / 2, (z - 0.2, z + 0.4)),
        [
            box((x - 0.04, s * 0.4 * width - 0.04, 0.15), (x + 0.04, s * 0.4 * width + 0.04, z - 0.05))
            for x in (0.2, n - 0.2)
            for s in (-1, 1)
        ],
        look="steel",
    )
    g = b.gap(0.05) + 0.0005
    b.part("back", slab((0.03, 0.75 - g), width / 2 - 0.02, (z + g, z + 0.1)))
    b.hinge(
        "back",
        parent="frame",
        axis=Y,
        pivot=(0.75 - g, 0, z + (0.1 if b.style.has_bore else b.pick(0, 0.05, 0.1))),
        upper=1.0,
    )
    for k, s in enumerate((-1, 1)):
        y = s * (width / 2 + g + 0.001)
        b.part(
            f"rail_{k}",
            [b.cylinder(0.012, (0.5, y + s * 0.012, q), (1.5, y + s * 0.012, q)) for q in (z, z + 0.15, z + 0.3)],
            [b.cylinder(0.01, (x, y + s * 0.012, z - 0.02), (x, y + s * 0.012, z + 0.3)) for x in spread(5, 0.5, 1.5)],
            look="steel",
        )
        if b.maybe():
            b.slide(f"rail_{k}", parent="frame", axis=-Z, upper=0.3, ajar=False)
        else:
            b.hinge(
                f"rail_{k}",
                parent="frame",
                axis=-s * X,
                pivot=(1.0, y + s * 0.012, z - 0.02),
                upper=2.5 if not b.style.has_bore else 1.5,
                ajar=False,
            )
    for k, (x, s) in enumerate([(x, s) for x in (0.2, n - 0.2) for s in (-1, 1)]):
        caster(b, f"caster_{k}", parent="frame", top=(x, s * 0.4 * width, 0.15), high=0.15)


@kind("parametric drip stand", like="iv_stand", height=length(0.9, 1.2), number=whole(4, 5, words="caster, wheel"))
def drip_stand(b: ObjectBuilder, height: float, number: int) -> None:
    """A pole that telescopes on five casters, hooks that turn."""
    b.part("foot", b.cylinder(0.015, 0.1, height), look="steel")
    for k, a in enumerate(np.arange(number) * 2 * pi / number):
        tip = vector(0.3 * cos(a), 0.3 * sin(a), 0.09)
        b.part(
            "foot", beam(0.03, 0.02, (0, 0, 0.12), tip + 0.01 * Z), b.cylinder(0.015, tip - 0.015 * Z, tip + 0.02 * Z)
        )
        caster(b, f"caster_{k}", parent="foot", top=tip - 0.015 * Z, high=0.075)
    plunger(
        b,
        "pole",
        parent="foot",
        start=(0, 0, height + 0.5),
        end=(0, 0, 0.4) if b.style.has_bore else (0, 0, height - 0.05),
        radius=0.009,
        travel=0.4,
    )
    b.part("pole", [b.cylinder(0.004, (0, 0, height + 0.48), (0.12 * s, 0, height + 0.54)) for s in (-1, 1)])


@kind(
    "parametric interior door",
    like="door",
    width=length(0.7, 1.0),
    height=length(1.9, 2.1),
    thickness=length(0.03, 0.05),
)
def interior_door(b: ObjectBuilder, width: float, height: float, thickness: float) -> None:
    """A frame, a leaf with a lever handle on one or both sides, a bolt."""
    b.part(
        "frame",
        [box((s * width / 2, -0.03, 0), (s * (width / 2 + 0.07), 0.09, height + 0.07)) for s in (-1, 1)],
        slab(width / 2 + 0.07, (-0.03, 0.09), (height, height + 0.07)),
        look="wood",
    )
    if b.maybe(0.4):
        b.part(
            "frame",
            box((-width / 2 - 0.9, 0, 0), (-width / 2 - 0.06, 0.07, height + 0.4)),
            box((width / 2 + 0.06, 0, 0), (width / 2 + 0.9, 0.07, height + 0.4)),
            slab(width / 2 + 0.1, (0, 0.07), (height + 0.06, height + 0.4)),
        )
    side = b.pick(X, -X)
    g = 0.003
    leaf(
        b,
        "leaf",
        parent="frame",
        lower=(-width / 2 + g, 0.0, 0.005),
        upper=(width / 2 - g, thickness, height - g),
        hinge=side,
        out=-Y if b.style.line > 0.6 else Y,
        reach=1.57,
        handle=False,
        material="wood",
    )
    if b.maybe(0.8):
        for k, (y, out) in enumerate(((0 + b.gap(0.02) * 0, -Y), (thickness, Y))[: b.count(1, 2)]):
            lever(
                b,
                f"handle_{k}",
                parent="leaf",
                at=-side * (width / 2 - 0.07) + vector(0, y, 1),
                out=out,
                along=side,
                length=0.12,
                reach=0.7,
            )


@kind(
    "parametric revolving door",
    like="revolving_door",
    radius=length(0.9, 1.6),
    height=length(2.0, 2.4),
    number=whole(3, 4, words="wing, leaf, panel, door"),
)
def parametric_revolving_door(b: ObjectBuilder, radius: float, height: float, number: int) -> None:
    """Wings about a post in a drum."""
    b.part("drum", b.cylinder(radius + 0.1, height, height + 0.15), b.cylinder(radius + 0.1, -0.03, 0), look="metal")
    wall = b.tube(radius + 0.08, radius + 0.03, -0.01, height + 0.01)
    b.part("drum", wall, look="glass")
    b.cut("drum", slab(0.7 * radius, 2 * radius, (0.001, height - 0.001)))
    g = b.gap(0.05) + 0.001
    b.part(
        "wings",
        b.cylinder(0.04, g, height - g),
        [
            beam(
                height - 0.1,
                0.015,
                (0, 0, height / 2),
                (radius * cos(a), radius * sin(a), height / 2),
                vector(-sin(a), cos(a), 0),
            )
            for a in np.arange(number) * 2 * pi / number
        ],
        look="glass",
    )
    b.spin("wings", parent="drum", axis=Z, pivot=(0, 0, 0))


@kind(
    "parametric casement window",
    like="window",
    width=length(0.6, 1.4),
    height=length(0.7, 1.4),
    number=whole(1, 2, words="sash, casement"),
    way=choice(("side", "side", "bottom", "top")),
)
def casement_window(b: ObjectBuilder, width: float, height: float, number: int, way: str) -> None:
    """One or two sashes that swing, tilt or are hung at the top, with a handle."""
    t = 0.06
    b.part(
        "frame",
        [box((s * width / 2, 0, 0), (s * (width / 2 + t), 0.07, height)) for s in (-1, 1)],
        [slab(width / 2 + t, (0, 0.07), (z, z + t)) for z in (-t, height)],
        look="wood",
    )
    for k, x in enumerate(spread(number, -width / 2, width / 2)):
        hinge = -Z if way == "bottom" else Z if way == "top" else -X if k == 0 else X
        low = vector(x - width / 2 / number + 0.003, 0.005, 0.003)
        high = vector(x + width / 2 / number - 0.003, 0.055, height - 0.003)
        leaf(
            b,
            f"sash_{k}",
            parent="frame",
            lower=low,
            upper=high,
            hinge=hinge,
            out=-Y,
            reach=0.5 if way == "bottom" else 1.3,
            handle=False,
        )
        b.cut(
            f"sash_{k}",
            box((low[0] + 0.07, -1, 0.07), (high[0] - 0.07, 0.02, height - 0.07)),
            box((low[0] + 0.07, 0.03, 0.07), (high[0] - 0.07, 1, height - 0.07)),
        )
        if b.maybe():
            lever(
                b,
                f"handle_{k}",
                parent=f"sash_{k}",
                at=-hinge * 0.5 * (width / number if way == "side" else height) * 0.93 + vector(x, 0.005, height / 2),
                out=-Y,
                along=X if way != "side" else -Z,
                length=0.1,
                reach=1.57,
            )


@kind("parametric treasure chest", like="box", width=length(0.3, 0.9), depth=length(0.2, 0.5), height=length(0.15, 0.4))
def treasure_chest(b: ObjectBuilder, width: float, depth: float, height: float) -> None:
    """A barrel lid, bails at both ends, a hasp."""
    case(
        b,
        "chest",
        lower=(-width / 2, -depth / 2, 0),
        upper=(width / 2, depth / 2, height),
        opening=Z,
        wall=0.04 * depth,
    )
    g = b.gap(0.05) + 0.0002
    b.part("lid", b.cylinder(depth / 2, (-width / 2, 0, height + g), (width / 2, 0, height + g)), look="wood")
    b.cut("lid", slab(width, depth, (height - depth, height + g)))
    if b.style.hollow:
        b.cut("lid", b.cylinder(0.44 * depth, (-0.46 * width, 0, height), (0.46 * width, 0, height)))
    b.hinge("lid", parent="chest", axis=-X, pivot=(0, depth / 2, height + g / 2), upper=b.draw(1.2, 1.8))
    for k, s in enumerate((-1, 1)):
        x = s * (width / 2 + 0.012)
        b.part(
            "chest",
            box(
                (s * width / 2 - 0.001 * s, -0.2 * depth, 0.55 * height),
                (s * (width / 2 + 0.024), -0.14 * depth, 0.65 * height),
            ),
            box(
                (s * width / 2 - 0.001 * s, 0.14 * depth, 0.55 * height),
                (s * (width / 2 + 0.024), 0.2 * depth, 0.65 * height),
            ),
        )
        bail(
            b,
            f"bail_{k}",
            parent="chest",
            start=(x, 0.2 * s * depth, 0.6 * height),
            end=(x, -0.2 * s * depth, 0.6 * height),
            high=0.25 * height,
            thick=0.008,
            up=-Z,
            lower=-0.02,
            upper=1.3,
        )


@kind(
    "parametric carousel",
    like="merry_go_round",
    radius=length(0.06, 0.2),
    number=whole(3, 5, words="horse, figure, seat"),
    key=yes(0.4, words="winding key, wind up key"),
)
def carousel(b: ObjectBuilder, radius: float, number: int, key: bool) -> None:
    """A disc that turns with figures on rods that go up and down, a winding key."""
    b.part("base", b.cylinder(radius, 0, 0.4 * radius), look="wood")
    g = b.gap(0.02 * radius) + 0.0002
    b.part(
        "carousel",
        b.cylinder(0.9 * radius, 0.4 * radius + g, 0.5 * radius),
        b.cylinder(0.06 * radius, 0.45 * radius, 1.6 * radius),
        b.cone(0.95 * radius, 0.1 * radius, 1.5 * radius, 2 * radius),
        look="wood",
    )
    b.spin("carousel", parent="base", axis=Z, pivot=(0, 0, 0.4 * radius))
    for k, a in enumerate(np.arange(number) * 2 * pi / number):
        p = 0.65 * radius * vector(cos(a), sin(a), 0)
        z = b.draw(0.75, 1) * radius
        b.part("carousel", b.cylinder(0.02 * radius, p + 0.49 * radius * Z, p + 1.55 * radius * Z))
        b.part(f"horse_{k}", block(p + z * Z, (0.25 * radius, 0.15 * radius, 0.2 * radius)), look="wood")
        b.bore(f"horse_{k}", b.cylinder(0.02 * radius + 1.5 * g, p, p + 3 * radius * Z))
        b.slide(f"horse_{k}", parent="carousel", axis=Z, upper=0.25 * radius, lower=-0.1 * radius, ajar=False)
    if key:
        at = vector(0, -radius, 0.2 * radius)
        b.part(
            "key",
            b.cylinder(0.05 * radius, at - g * Y, at - 0.15 * radius * Y),
            block(at - 0.25 * radius * Y, (0.35 * radius, 0.2 * radius, 0.05 * radius)),
            look="metal",
        )
        b.spin("key", parent="base", axis=-Y, pivot=at)


@kind("parametric nutcracker", like="nutcracker", length=length(0.1, 0.6))
def parametric_nutcracker(b: ObjectBuilder, length: float) -> None:
    """Two arms about a pin: crackers, tongs, pliers, shears of plain bars."""
    k = 0.06 * length
    g = b.gap(0.5 * k) + 0.0001
    gap_y = k * 0.5 + g / 2
    front = b.draw(0.15, 0.9) * length
    b.part(
        "arm_a",
        beam(k, 0.9 * k, (-front, -gap_y, -0.02 * length), (length, -gap_y, 0.12 * length), Y),
        b.cylinder(0.8 * k, (0, -gap_y - 0.45 * k, 0), (0, -gap_y + 0.45 * k, 0)),
        look="steel",
    )
    b.part(
        "arm_b",
        beam(k, 0.9 * k, (-front, gap_y, 0.02 * length), (length, gap_y, -0.12 * length), Y),
        b.cylinder(0.8 * k, (0, gap_y - 0.45 * k, 0), (0, gap_y + 0.45 * k, 0)),
        look="steel",
    )
    if b.style.barrels:
        b.part("arm_a", b.cylinder(0.3 * k, (0, -gap_y, 0), (0, gap_y + 0.6 * k, 0)))
        b.bore("arm_b", b.cylinder(0.3 * k + 1.5 * g, (0, -1, 0), (0, 1, 0)))
    b.hinge("arm_b", parent="arm_a", axis=Y, pivot=(0, 0, 0), upper=0.5, lower=-0.2, ajar=False)


@kind("parametric pocket knife", like="pocket_knife", length=length(0.06, 0.12), m=whole(1, 3, words="blade, tool"))
def parametric_pocket_knife(b: ObjectBuilder, length: float, m: int) -> None:
    """Blades that fold into a handle."""
    k = 0.1 * length
    pitch = 0.03 * length
    g = b.gap(0.3 * pitch) + 0.0001
    half = m * pitch / 2
    b.part(
        "handle",
        [slab((0, length), (s * (half + 0.03 * length), s * half), k) for s in (-1, 1)],
        slab((0.02 * length, 0.98 * length), half, (-k, -0.8 * k)),
        look="steel",
    )
    for j, y in enumerate(spread(m, -half, half)):
        end = 0.08 * length if j % 2 == 0 else 0.92 * length
        s = 1 if j % 2 == 0 else -1
        a = 0.5 * pitch - g
        b.part(
            f"blade_{j}",
            box((end - s * 0.06 * length, y - a, 0 * k), (end + s * 0.8 * length, y + a, 0.9 * k)),
            b.cylinder(0.6 * k, (end, y - a, 0.3 * k), (end, y + a, 0.3 * k)),
            look="steel",
        )
        if not b.style.has_bore:
            b.part("handle", b.cylinder(0.15 * k, (end, y - pitch / 2, 0.3 * k), (end, y + pitch / 2, 0.3 * k)))
        b.hinge(
            f"blade_{j}", parent="handle", axis=-s * Y, pivot=(end, y, 0.3 * k), upper=1.2 if b.style.has_bore else 3
        )


@kind("parametric dish antenna", like="radar_dish", size=length(0.3, 3.0))
def dish_antenna(b: ObjectBuilder, size: float) -> None:
    """A dish on a mount with two axes: radar, satellite, searchlight."""
    b.part("base", b.cone(0.5 * size, 0.3 * size, 0, 0.5 * size), look="metal")
    g = b.gap(0.05 * size)
    b.part(
        "yoke",
        b.cylinder(0.3 * size, 0.5 * size + g, 0.6 * size),
        [
            slab((s * 0.2 * size - 0.03 * size, s * 0.2 * size + 0.03 * size), 0.08 * size, (0.58 * size, 1.32 * size))
            for s in (-1, 1)
        ],
        look="metal",
    )
    b.spin("yoke", parent="base", axis=Z, pivot=(0, 0, 0.5 * size))
    c = vector(0, 0, 1.25 * size)
    dish = (
        b.cone(0.1 * size, 0.75 * size, c - 0.12 * size * Y, c - 0.4 * size * Y)
        if b.maybe()
        else b.cylinder(0.5 * size, c - 0.12 * size * Y, c - 0.35 * size * Y)
    )
    b.part(
        "dish",
        dish,
        block(c, (0.3 * size, 0.1 * size, 0.1 * size)),
        b.cylinder(0.03 * size, c - 0.1 * size * Y, c - 0.7 * size * Y),
        beam(0.1 * size, 0.1 * size, c, c - 0.15 * size * Y),
    )
    b.hinge("dish", parent="yoke", axis=-X, pivot=c, upper=1.2 if not b.style.has_bore else 0.9, ajar=False)


@kind("lighthouse lamp", words="revolving lamp", like="lighthouse", size=length(0.03, 1.0))
def lighthouse_lamp(b: ObjectBuilder, size: float) -> None:
    """A lamp that turns on a tower: a beacon, a lidar, a rotating sign."""
    b.part(
        "tower",
        b.pick(
            b.cone(0.5 * size, 0.35 * size, 0, size),
            slab(0.4 * size, 0.4 * size, (0, size)),
            b.cylinder(0.4 * size, 0, size),
        ),
    )
    g = b.gap(0.05 * size)
    shape = b.pick(
        b.cylinder(0.35 * size, size + g, 1.6 * size),
        slab(0.5 * size, 0.1 * size, (size + g, 1.3 * size)),
        b.cone(0.35 * size, 0.2 * size, size + g, 1.5 * size),
    )
    b.part("lamp", shape, b.cylinder(0.15 * size, size + g, 1.2 * size))
    if b.maybe():
        b.part("lamp", b.cylinder(0.08 * size, (0, 0, 1.15 * size), (0, -0.4 * size, 1.15 * size)))
    b.spin("lamp", parent="tower", axis=Z, pivot=(0, 0, size))


@kind("movie camera", like="camera", size=length(0.9, 1.2))
def movie_camera(b: ObjectBuilder, size: float) -> None:
    p = b.sized(size)
    b.part(
        "body",
        p.slab(0.05, 0.1, (0, 0.16)),
        p.slab(0.02, (-0.02, 0.03), (-0.1, 0.01)),
        look="black metal",
    )
    b.cut("body", p.slab((0, 0.1), 0.08, (0.02, 0.14)))
    b.part(
        "lens",
        p.cylinder(0.03, (0, -0.101, 0.11), (0, -0.16, 0.11)),
        p.cylinder(0.034, (0, -0.13, 0.11), (0, -0.15, 0.11)),
        look="grey metal",
    )
    b.spin("lens", parent="body", axis=-Y, pivot=p(0, -0.1, 0.11))
    leaf(
        b,
        "door",
        parent="body",
        lower=p(0.051, -0.09, 0.01),
        upper=p(0.057, 0.09, 0.15),
        hinge=Y,
        out=X,
        reach=1.8,
        handle=False,
        material="metal",
    )
    crank(b, "crank", parent="body", at=p(-0.05, 0.03, 0.08), out=-X, length=0.05 * size)
