"""Parts of engines and vehicles: brakes, pumps, shafts."""

from __future__ import annotations

from math import cos, sin

from kinematify.generate.library.kind import kind, whole
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.solids import X, Y, Z, beam, slab


@kind(
    walls=60,
    words="disk brake, brake disc, brake caliper",
    part_words={"disc": "disk, rotor", "pad": "brake pad, piston"},
    radius=(0.08, 0.18),
)
def disc_brake(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    b.part(
        "carrier",
        p.slab(0.15, (0.2, 0.3), (-0.2, 1.1)),
        p.slab(0.35, (-0.32, 0.3), (1.05, 1.2)),
        p.slab(0.35, (-0.32, -0.2), (0.7, 1.1)),
        p.slab(0.35, (0.2, 0.3), (0.7, 1.1)),
        look="grey steel",
    )
    b.bore("carrier", p.cylinder(0.13, 0, (-1, 1), 0))
    b.part(
        "disc",
        p.cylinder(1, 0, (-0.03, 0.03), 0),
        p.cylinder(0.12, 0, (-0.2, 0.4), 0),
        p.cylinder(0.35, 0, (-0.15, 0), 0),
        look="steel",
    )
    b.spin("disc", "carrier", Y, (0, 0, 0))
    for k, s in enumerate((-1, 1)):
        b.part(
            f"pad_{k + 1}",
            slab(0.25 * r, (min(s * 0.06 * r, s * 0.18 * r), max(s * 0.06 * r, s * 0.18 * r)), (0.72 * r, 0.98 * r)),
            look="black rubber",
        )
        b.slide(f"pad_{k + 1}", "carrier", -s * Y, 0.025 * r)


@kind(
    words="valve train, cam shaft with followers",
    part_words={"shaft": "cam", "follower": "valve, tappet, pushrod, lifter"},
    followers=whole(1, 6),
)
def camshaft(b: ObjectBuilder, followers: int) -> None:
    n = followers
    L = 0.08 * followers + 0.06
    b.part(
        "frame",
        slab(0.5 * L + 0.02, 0.06, (0, 0.012)),
        [slab((s * 0.5 * L - 0.012, s * 0.5 * L + 0.012), 0.03, (0.01, 0.22)) for s in (-1, 1)],
        slab(0.5 * L, 0.03, (0.19, 0.22)),
        look="metal",
    )
    b.bore("frame", b.cylinder(0.0108, (-L, L), 0, 0.08))
    b.part(
        "shaft",
        b.cylinder(0.01, (-0.5 * L - 0.03, 0.5 * L + 0.06), 0, 0.08),
        [
            b.cylinder(0.02, (x - 0.012, x + 0.012), 0.012 * cos(2.1 * k), 0.08 + 0.012 * sin(2.1 * k))
            for k, x in enumerate([0.08 * (k - 0.5 * (n - 1)) for k in range(n)])
        ],
        look="steel",
    )
    b.spin("shaft", "frame", X, (0, 0, 0.08))
    for k in range(n):
        x = 0.08 * (k - 0.5 * (n - 1))
        b.bore("frame", b.cylinder(0.0068, x, 0, (0.15, 0.3)))
        b.part(
            f"follower_{k + 1}",
            b.cylinder(0.006, x, 0, (0.13, 0.25)),
            b.cylinder(0.016, x, 0, (0.127, 0.133)),
            look="steel",
        )
        b.slide(f"follower_{k + 1}", "frame", Z, 0.016, lower=-0.008)


@kind(words="hydraulic gear pump", part_words={"drive_gear": "shaft, driver", "idler": "gear"}, radius=(0.03, 0.06))
def gear_pump(b: ObjectBuilder, radius: float) -> None:
    r = radius
    p = b.sized(r)
    b.part(
        "housing",
        p.cylinder(1.6, -0.85, (-0.5, 0.4), 0),
        p.cylinder(1.6, 0.85, (-0.5, 0.4), 0),
        p.slab(0.85, (-0.5, 0.4), 1.6),
        look="metal",
    )
    b.cut("housing", p.cylinder(1.12, -0.85, (-1, 0.05), 0), p.cylinder(1.12, 0.85, (-1, 0.05), 0))
    b.bore("housing", p.cylinder(0.29, -0.85, (-1, 1), 0), p.cylinder(0.29, 0.85, (-1, 0.3), 0))
    for s, name in zip((-1, 1), ("drive_gear", "idler"), strict=False):
        b.part(
            name,
            p.cylinder(0.72, s * 0.85, (-0.4, 0), 0),
            b.cylinder(0.25 * r, s * 0.85 * r, (-0.4 * r, 0.9 * r if s < 0 else 0.25 * r), 0),
            [
                beam(
                    0.16 * r,
                    0.4 * r,
                    (s * 0.85 * r, -0.2 * r, 0),
                    (s * 0.85 * r + 0.97 * r * cos(a), -0.2 * r, 0.97 * r * sin(a)),
                    Y,
                )
                for a in [6.28318 * (k + (0.5 if s > 0 else 0)) / 10 for k in range(10)]
            ],
            look="steel",
        )
        b.spin(name, "housing", s * Y, [s * 0.85 * r, 0, 0])
    b.follow("idler", "drive_gear", 1)
