"""Toilets and faucets, carved."""

from __future__ import annotations

from itertools import pairwise
from math import cos, pi, radians, sin

from manifold3d import Manifold

from kinematify.generate.library.kind import choice, kind, length, whole
from kinematify.generate.library.mechanisms import button, lever
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.pieces.bearing_pieces import fork, fork_room, stub
from kinematify.generate.procedural.solids import Point, X, Y, Z, bore, box, cylinder, hull, off, rod, slab, union


@kind(
    words="water closet, loo, lavatory, toilet bowl, commode toilet, wc, kids toilet",
    carved_from="ceramic",
    width=length(0.3, 0.6, default=0.4, usual=(0.35, 0.45), help="Outer width."),
    depth=length(0.55, 0.9, default=0.68, usual=(0.6, 0.75), help="Outer depth."),
    height=length(0.25, 0.55, usual=(0.36, 0.45), help="Of the bowl's rim."),
    flush=choice({"lever": "flush lever", "button": "flush button, push button"}, help="What it is flushed by."),
)
def toilet(
    w: ObjectBuilder, width: float, depth: float, height: float, flush: str, open: float, clearance: float
) -> None:
    """Toilets: a seat and a lid on one pin line, and a flush lever or button on the tank."""
    knuckle = 0.009  # radius [m]
    the_tank = 0.11  # from the pins to the tank [m]
    seat = 0.018  # thickness [m]
    lid = 0.014  # thickness [m]
    pin = 0.0045  # radius [m]
    opens = 1.65  # [rad]

    # Of the bowl: narrower than the tank and not as wide as it is long.
    def breadth(back: float) -> float:
        return min(0.9 * width, 0.85 * back)

    # A round front and a straight back, between two levels.
    def oval(width: float, front: float, back: float, span: tuple[float, float]) -> Manifold:
        radius = 0.5 * width
        round_part = cylinder(radius, 0, front + radius, (span[0], span[1]))
        return hull(round_part, slab(0.8 * radius, (back - 0.01, back), (span[0], span[1])))

    # A bowl on a foot, with a deck that reaches back under the tank.
    def bowl(back: float) -> Manifold:
        width = breadth(back)
        foot = oval(0.55 * width, 0.2 * back, depth - 0.1, (0.0, 0.05))
        rim = oval(width, 0.0, depth - 0.05, (height - 0.06, height))
        hollow = hull(
            oval(0.7 * width, 0.15 * width, 0.85 * back, (height - 0.001, height + 0.1)),
            oval(0.3 * width, 0.35 * width, 0.6 * back, (0.35 * height, 0.36 * height)),
        )
        return union(hull(foot, rim.trim_by_plane((0, 0, -1), -(height - 0.03))), rim) - hollow

    # A knuckle that reaches forward to the back face of what it carries.
    def knuckle_of(
        span: tuple[float, float], axis: tuple[float, float], back: float, heights: tuple[float, float]
    ) -> Manifold:
        y, z = axis
        lower, upper = sorted(span)
        return hull(
            cylinder(knuckle, (lower, upper), y, z),
            box((lower, back - 0.0002, heights[0]), (upper, back + 0.0001, heights[1])),
        )

    tight = min(clearance, 0.3 * knuckle)
    tank_depth = 0.24 * depth
    axis = (depth - tank_depth - the_tank, height + tight + seat)
    tank_top = height + 0.85 * depth * 0.6
    tank = slab(0.5 * width, (depth - tank_depth, depth), (height - 0.05, tank_top))
    seam = slab(width, (-1, depth - tank_depth + 0.003), (tank_top - 0.035, tank_top - 0.032))
    w.part("body", bowl(axis[0]), tank - seam)
    # Seat and lid; the seat owns the pins, posts of the body and knuckles of the lid stand on them.
    y, z = axis
    its_width = breadth(y)
    back = y - knuckle - tight - 0.001
    level = height + tight
    ring = oval(its_width, 0.0, back, (level, level + seat)) - oval(
        0.62 * its_width, 0.19 * its_width, 0.8 * back, (level - 1.0, level + 1.0)
    )
    cover = oval(its_width, 0.0, back, (level + seat + tight, level + seat + tight + lid))
    to_seat = (level, level + 0.5 * seat)
    to_lid = (level + seat + tight + 0.3 * lid, level + seat + tight + lid)
    posts: list[Manifold] = []
    knuckles: list[Manifold] = []
    pins: list[Manifold] = []
    of_lid: list[Manifold] = []
    holes: list[Manifold] = []
    for side in (-1.0, 1.0):
        spans = [(side * (0.03 + k * 0.022), side * (0.03 + (k + 1) * 0.022 - tight)) for k in range(3)]
        lid_at, seat_at, post_at = spans
        of_lid = [*of_lid, knuckle_of(lid_at, axis, back, to_lid)]
        knuckles = [*knuckles, knuckle_of(seat_at, axis, back, to_seat)]
        post = cylinder(knuckle, (post_at[0], post_at[1]), y, z)
        xs = sorted(post_at)
        posts = [*posts, hull(post, box((xs[0], y - knuckle, height - 0.002), (xs[1], y + knuckle, height)))]
        ends = ((lid_at[0], y, z), (post_at[1], y, z))
        pins = [*pins, cylinder(pin, *ends)]
        holes = [*holes, bore(pin, tight, (0.5 * lid_at[0], y, z), (1.2 * post_at[1], y, z))]
    w.part("body", posts)
    w.cut("body", holes)
    pivot = (0.0, y, z)
    w.part("seat", ring, knuckles, pins, look="plastic")
    w.part("lid", union(cover, *of_lid) - union(*holes), look="plastic")
    w.hinge("seat", "body", (-1, 0, 0), pivot, opens - 0.95 * open * opens)
    w.hinge("lid", "seat", (-1, 0, 0), pivot, opens, rest=open * opens)
    # A lever at the front of the tank, or a button on its top; `corner` is y of the front and z of the top.
    front, top = (depth - tank_depth, tank_top)
    if flush == "button":
        with w.fitted(open) as b:
            button(b, "button", "body", [0, front + 0.12 * depth, top], (0.06, 0.035), 0.012, Z)
    else:
        with w.fitted(open) as b:
            lever(b, "lever", "body", [-0.35 * width, front, top - 0.08], -Y, X, 0.09, reach=-0.8)
    w.settle()


@kind(
    words=(
        "tap, water tap, kitchen tap, kitchen faucet, mixer tap, spigot, basin tap, bathroom faucet, sink "
        "faucet, bath tap, garden tap, sink tap, outdoor tap, shower tap, bathtub faucet, lab tap"
    ),
    carved_from="steel",
    height=length(0.18, 0.6, default=0.24, usual=(0.2, 0.36), help="Of spout or post."),
    reach=length(0.12, 0.35, default=0.16, usual=(0.14, 0.22), help="Of the spout, forward."),
    pipe=length(0.008, 0.016, usual=(0.01, 0.014), help="Radius of the pipe."),
    handles=whole(1, 2, default=2, help="Of one with handles that twist."),
    handle=choice(
        {
            "lever": "single lever, mixer",
            "twist": "twist handle, twisting, twist, cross handle, knob, valve",
            "swivel": "swivelling, swiveling, swivelling spout, swivel spout",
        },
        help="What moves.",
    ),
    cross=choice(("cross", "bar"), help="Shape of handles that twist."),
)
def faucet(
    w: ObjectBuilder,
    height: float,
    reach: float,
    pipe: float,
    handles: int,
    handle: str,
    cross: str,
    open: float,
    clearance: float,
) -> None:
    """Faucets: a lever that turns and lifts, handles that twist, or a spout that swivels."""
    the_plate = 0.01  # thickness of the base plate [m]

    # A pipe that rises, bends forward over a half circle and ends above its outlet.
    def spout(radius: float, foot: Point, rise: float, reach: float) -> Manifold:
        bend = 0.5 * reach
        arc = [off(foot, 0, -bend * (1.0 - cos(radians(a))), rise + bend * sin(radians(a))) for a in range(0, 151, 25)]
        points = [foot, *arc]
        return union(*[rod(radius, one, two) for one, two in pairwise(points)])

    if handle == "lever":
        # A cartridge on the post turns, and the lever on it lifts.
        post = 1.8 * pipe
        outlet = [rod(pipe, (0, 0, 0.62 * height), (0, -reach, 0.7 * height))]
        boss, hole, rotor = stub((0, 0, height), (0, 0, 1), post, clearance, length=1.2 * pipe)
        plate = cylinder(2.6 * pipe, 0, the_plate)
        w.part("body", plate, cylinder(post, 0, height), boss, outlet)
        w.cut("body", hole)
        small = 0.6 * pipe
        gap = min(clearance, 0.2 * pipe)
        hinge = height + clearance + 1.2 * pipe + fork_room(small, gap) + 0.5 * small
        forked, tongue = [s.translate((0, 0, hinge)) for s in fork(2.6 * pipe, small, gap, hinge - height - 1.2 * pipe)]
        w.part("cartridge", rotor, forked)
        its_handle = rod(small, (0, 0, hinge + 2.0 * small), (0, -0.9 * reach, hinge + 3.5 * small))
        w.part("lever", tongue, its_handle)
        w.hinge("cartridge", "body", (0, 0, 1), (0, 0, height), 0.8, -0.8)
        w.hinge("lever", "cartridge", (-1, 0, 0), (0, 0, hinge), 0.5, rest=open * 0.5)
    elif handle == "twist":
        # Cross handles on posts beside the spout, or one on its top.
        half = 5.5 * pipe
        places = {1: (half,), 2: (-half, half)}[handles]
        plate_2 = slab(1.35 * half, 2.2 * pipe, (0, the_plate))
        rise = height - 0.5 * reach - pipe - the_plate
        its_pipe = spout(pipe, (0, 0, 0.5 * the_plate), max(rise, 3.0 * pipe), reach)
        w.part("body", plate_2, its_pipe.trim_by_plane((0, 0, 1), 0.0))
        top = the_plate + 4.0 * pipe
        for k, x in enumerate(places):
            boss_2, hole_2, rotor_2 = stub((x, 0, top), (0, 0, 1), 1.4 * pipe, clearance, length=2.0 * pipe)
            w.part("body", boss_2, cylinder(1.4 * pipe, x, 0, (0.5 * the_plate, top)))
            w.cut("body", hole_2)
            level = top + clearance + 1.6 * pipe
            arms = [rod(0.5 * pipe, (x - 2.6 * pipe, x + 2.6 * pipe), 0, level)]
            if cross == "cross":
                arms = [*arms, rod(0.5 * pipe, x, (-2.6 * pipe, 2.6 * pipe), level)]
            w.part(f"handle_{k + 1}", rotor_2, arms)
            w.hinge(f"handle_{k + 1}", "body", (0, 0, 1), (x, 0, top), 1.5 * pi, rest=open * (1.5 * pi))
    elif handle == "swivel":
        # A high spout that swivels on the post, and a lever at the post's side.
        post_2 = 1.7 * pipe
        top_2 = 7.0 * pipe
        plate_3 = cylinder(2.6 * pipe, 0, the_plate)
        boss_3, hole_3, rotor_3 = stub((0, 0, top_2), (0, 0, 1), post_2, clearance, length=1.5 * pipe)
        side = (2.6 * pipe, 0, 4.0 * pipe)
        side_boss, side_hole, side_rotor = stub(side, (1, 0, 0), 1.2 * pipe, clearance, length=1.5 * pipe)
        w.part("body", plate_3, cylinder(post_2, 0, top_2), boss_3, side_boss)
        w.cut("body", hole_3, side_hole)
        foot = (0, 0, top_2 + clearance + pipe)
        rise_2 = height - foot[2] - 0.5 * reach - pipe
        w.part("spout", rotor_3, spout(pipe, foot, max(rise_2, 2.0 * pipe), reach))
        tip = off(side, clearance + 0.9 * pipe, 0, 0)
        lever = rod(0.55 * pipe, tip, off(tip, 2.0 * pipe, -0.6 * pipe, 5.0 * pipe))
        w.part("lever", side_rotor, lever)
        w.hinge("spout", "body", (0, 0, 1), (0, 0, top_2), 2.0, -2.0)
        w.hinge("lever", "body", (1, 0, 0), side, 1.0, rest=open * 1.0)
    w.settle()
