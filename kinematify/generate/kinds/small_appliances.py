"""Coffee machines, fans, lamps, laptops and more, carved."""

from __future__ import annotations

from collections.abc import Sequence
from math import asin, cos, degrees, pi, radians, sin
from typing import TYPE_CHECKING, Any

import numpy as np
from manifold3d import Manifold

from kinematify.generate.library import mechanisms
from kinematify.generate.library.kind import choice, kind, length, whole
from kinematify.generate.library.mechanisms import button, knob
from kinematify.generate.library.panels import add_door, add_drawer
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.pieces.bearing_pieces import FRONT, BackEdge, add_barrels, at, bent_fork, stub
from kinematify.generate.procedural.pieces.fronts import Bay, room
from kinematify.generate.procedural.solids import (
    SEGMENTS,
    Point,
    Y,
    Z,
    ball,
    box,
    cylinder,
    hull,
    rod,
    slab,
    union,
    vector,
)

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray


@kind(
    walls=8,
    words="bread toaster, pop up toaster, retro toaster, toy toaster",
    carved_from="metal",
    width=length(0.14, 0.5, default=0.19, usual=(0.16, 0.32), help="Outer width."),
    depth=length(0.2, 0.5, default=0.28, usual=(0.24, 0.36), help="Outer depth."),
    height=length(0.15, 0.35, default=0.19, usual=(0.17, 0.24), help="Outer height."),
    levers=whole(1, 2, help="In front.", words="lever, handle"),
    slots=whole(1, 4, usual=(1, 2), help="In all; each lever has as many.", words="slot, slice"),
    knob=choice({"knob": "dial", "none": ""}, help="One beside every lever."),
    tray=choice({"tray": "crumb tray", "none": ""}, help="For crumbs."),
)
def toaster(
    w: ObjectBuilder,
    width: float,
    depth: float,
    height: float,
    levers: int,
    slots: int,
    knob: str,
    tray: str,
    open: float,
    clearance: float,
) -> None:
    """Toasters: levers in front that carry the bread down, knobs, and a crumb tray."""
    floor = 0.034  # underside of the slots [m]
    wall = 0.012
    shaft = 0.05  # y where the slots for the bread begin; in front of it is the room of the levers [m]
    plate = 0.005  # thickness of what carries the bread [m]
    half = 0.5 * width
    round_ = 0.02
    corners = [(s * (half - round_), y) for s in (-1, 1) for y in (round_, depth - round_)]
    w.part("body", hull(*[cylinder(round_, x, y, (0, height)) for x, y in corners]))
    share = (width - 2.0 * round_) / levers
    each = -(-slots // levers)
    for k in range(levers):
        middle = (k + 0.5) * share - half + round_
        # A lever in an upright slit, one piece with the plates that carry the bread; it moves down.
        name = f"lever_{k + 1}"
        wide = min(0.032, 0.72 * share / each)
        back = depth - 0.03
        slit = 0.004
        level = max(0.62 * height, floor + 0.05)
        low = floor + clearance + 0.001
        across = 0.5 * each * (wide + 0.01)
        its_room = box((middle - across, wall, floor), (middle + across, shaft + 0.001, height - 0.02))
        opening = box((middle - slit - clearance, -1.0, low - 0.002), (middle + slit + clearance, shaft, level + 0.012))
        plates: list[Manifold] = []
        rooms = [its_room, opening]
        gap = clearance + 0.001
        for k_2 in range(each):
            x = middle + (k_2 - 0.5 * (each - 1)) * (wide + 0.01)
            rooms = [*rooms, box((x - 0.5 * wide, shaft, floor), (x + 0.5 * wide, back, height + 1.0))]
            plates = [
                *plates,
                box((x - 0.5 * wide + gap, 0.03, level), (x + 0.5 * wide - gap, back - gap, level + plate)),
            ]
        left = middle - 0.5 * (each - 1) * (wide + 0.01) - 0.5 * wide + gap
        bridge = box((left, 0.026, level), (2.0 * middle - left, 0.038, level + plate))
        stem = box((middle - slit, -0.012, level), (middle + slit, 0.03, level + plate))
        grip = min(0.014, 0.16 * share)
        its_knob = box((middle - grip, -0.028, level - 0.004), (middle + grip, -0.01, level + 0.009))
        w.cut("body", union(*rooms))
        w.part(name, bridge, stem, its_knob, plates)
        w.slide(name, "body", (0, 0, -1), level - low, pivot=(middle, 0, level), rest=open * (level - low))
        if knob == "knob":
            with w.fitted(open) as b:
                mechanisms.knob(
                    b,
                    f"knob_{k + 1}",
                    parent="body",
                    at=[middle + 0.33 * share, 0, 0.3 * height],
                    out=-Y,
                    radius=min(0.014, 0.13 * share),
                    deep=0.7 * wall,
                    reach=4.7,
                )
    if tray == "tray":
        # A flat tray for crumbs that comes out behind.
        half_2 = 0.5 * width - 0.03
        front = 0.04
        w.cut("body", slab(half_2, (front, depth + 1.0), (0.008, 0.024)))
        gap_2 = clearance
        outer = box((gap_2 - half_2, front + gap_2, 0.008 + gap_2), (half_2 - gap_2, depth - 0.002, 0.024 - gap_2))
        inner = box(
            (gap_2 + 0.003 - half_2, front + gap_2 + 0.003, 0.011 + gap_2), (half_2 - gap_2 - 0.003, depth - 0.006, 1.0)
        )
        lip = slab(0.2 * half_2, (depth - 0.003, depth + 0.014), (0.012, 0.02))
        w.part("tray", outer - inner, lip, look="metal")
        travel = 0.7 * (depth - front)
        w.slide("tray", "body", (0, 1, 0), travel, pivot=(0, depth, 0.016), rest=open * travel)
    w.settle()


@kind(
    words=(
        "coffee maker, espresso machine, coffee brewer, espresso maker, filter coffee machine, drip coffee maker, "
        "coffee brewing machine"
    ),
    width=length(0.16, 0.8, default=0.22, usual=(0.18, 0.3), help="Outer width."),
    depth=length(0.22, 0.5, default=0.26, usual=(0.24, 0.34), help="Outer depth."),
    height=length(0.28, 0.6, default=0.34, usual=(0.3, 0.42), help="Outer height."),
    kind=choice(
        {"filter": "drip, jug, carafe", "espresso": "portafilter"}, help="A jug under a filter, or portafilters."
    ),
    groups=whole(1, 3, default=1, usual=(1, 2), help="For espresso.", words="group, spout"),
    buttons=whole(0, 5, usual=(0, 4), help="In a row.", words="key"),
    button=choice(("square", "round"), help="Their shape."),
    hinge=choice(("edge", "barrel"), help="Of the filter: hidden or visible."),
    carved_from="plastic",
)
def coffee_machine(
    w: ObjectBuilder,
    width: float,
    depth: float,
    height: float,
    kind: str,
    groups: int,
    buttons: int,
    button: str,
    hinge: str,
    open: float,
    clearance: float,
) -> None:
    """Coffee machines: with a jug under a filter that swings out, or with portafilters and a steam wand."""
    the_lid = 0.01  # thickness [m]
    base = 0.05  # height of the base [m]
    wall = 0.012
    the_hinge = 0.004  # radius [m]
    # Underside of what stands over the jug or the cups [m].
    head = height - max(0.3 * height, 0.1)
    column = 0.6 * depth
    half = 0.5 * width
    top = height - the_lid
    w.part(
        "body",
        slab(half, (0, depth), (0, base)),
        slab(half, (column, depth), (0, top)),
        slab(half, (0, depth), (head, top)),
    )
    # A lid over the water tank, hinged behind.
    half_2 = 0.5 * width
    level = height - the_lid
    front = 0.6 * depth
    below = level - clearance
    tank = box((wall - half_2, front + wall, base + wall), (half_2 - wall, depth - wall, height + 1.0))
    above = slab(half_2 + 1.0, (-1.0, depth + 1.0), (below, height + 1.0))
    w.cut("body", tank, above)
    lid = slab(half_2, (front, depth), (level, height))
    grip = slab(0.1 * width, (front - 0.008, front + 0.01), (level + 0.003, height))
    w.part("lid", lid, grip)
    edge = BackEdge(y=depth, level=level, below=0.1, above=the_lid, clearance=clearance)
    pivot = add_barrels(
        w, "lid", parent="body", edge=edge, places=(-0.3 * width, 0.3 * width), length=0.04, radius=the_hinge
    )
    w.hinge("lid", "body", (-1, 0, 0), pivot, 1.8, rest=open * 1.8)
    if kind == "filter":
        # A door with the filter's basket behind it; both swing out to the left.
        opening = Bay(
            left=-0.5 * width,
            right=0.5 * width,
            bottom=head,
            top=height - the_lid - clearance,
            depth=0.6 * depth,
            wall=wall,
        )
        w.cut("body", room(opening))
        add_door(w, "filter", "body", opening, side="left", hinge=hinge, handle="edge", opened=open)
        radius = min(0.22 * width, 0.2 * depth)
        bottom = head + wall
        top_2 = opening.top - wall
        centre = (0.0, radius + 0.012 + clearance)
        cup = cylinder(radius, (*centre, bottom), (*centre, top_2)) - cylinder(
            radius - 0.003, (*centre, bottom + 0.003), (*centre, top_2 + 1.0)
        )
        arm = slab(0.02, (-0.5 * wall - clearance, 0.014 + clearance), (bottom, top_2))
        w.part("filter", cup, arm - cylinder(radius - 0.003, (*centre, bottom + 0.003), (*centre, top_2 + 1.0)))
        # A jug on the hot plate, which is drawn out to the front.
        radius_2 = min(0.4 * width, 0.26 * depth)
        level_2 = base + clearance
        top_3 = base + 0.8 * (head - base)
        y = 0.3 * depth
        glass = cylinder(radius_2, 0, y, (level_2, top_3))
        hollow = cylinder(radius_2 - 0.004, 0, y, (level_2 + 0.004, top_3 + 1.0))
        reach = y - radius_2
        grip_2 = union(
            slab(0.008, (reach - 0.045, reach - 0.033), (level_2 + 0.2 * (top_3 - level_2), top_3)),
            *[
                slab(0.008, (reach - 0.04, y), (z, z + 0.012))
                for z in (level_2 + 0.25 * (top_3 - level_2), top_3 - 0.014)
            ],
        )
        w.part("jug", glass - hollow, grip_2 - cylinder(radius_2 - 0.002, 0, y, (-1, 1)), look="glass")
        travel = 0.7 * depth
        w.slide("jug", "body", (0, -1, 0), travel, pivot=(0, y, level_2), rest=open * travel)
    else:
        # Portafilters that turn in their groups, a steam wand with its knob, and a drip tray.
        share = 0.8 * width / groups
        radius_3 = min(0.032, 0.3 * share)
        y_2 = 0.3 * depth
        reach_2 = radius_3 + 0.09
        turn = min(0.7, asin(min(1.0, (share - 0.022) / reach_2)))
        for k in range(groups):
            x = (k + 0.5) * share - 0.5 * width
            pivot_2 = (x, y_2, head - 0.01)
            boss, hole, rotor = stub(pivot_2, (0, 0, -1), radius_3, clearance, length=0.022)
            w.part("body", boss)
            w.cut("body", hole)
            level_3 = pivot_2[2] - clearance - 0.014
            grip_3 = rod(0.009, x, (y_2, y_2 - reach_2), level_3)
            spout = cylinder(0.008, x, y_2, (level_3 - 0.02, level_3))
            name = f"portafilter_{k + 1}"
            w.part(name, rotor, grip_3, spout)
            w.hinge(name, "body", (0, 0, -1), pivot_2, turn, rest=open * turn)
        x = 0.42 * width
        pivot_2 = (x, 0.15 * depth, head - 0.006)
        boss, hole, rotor = stub(pivot_2, (0, 0, -1), 0.009, clearance, length=0.012)
        w.part("body", boss)
        w.cut("body", hole)
        start = (*pivot_2[:2], pivot_2[2] - clearance - 0.009)
        tip = (x, 0.15 * depth - 0.04, base + 0.35 * (head - base))
        w.part("steam_wand", rotor, rod(0.004, start, tip))
        w.hinge("steam_wand", "body", (0, 0, 1), pivot_2, 0.9, rest=open * 0.9)
        opening_2 = Bay(left=-0.5 * width, right=0.5 * width, bottom=0.0, top=base, depth=0.58 * depth, wall=wall)
        w.cut("body", room(opening_2))
        add_drawer(w, "drip_tray", "body", opening_2, handle="edge", opened=open)
        with w.fitted() as b:
            knob(b, "knob", "body", [x, 0, 0.5 * (head + height - the_lid)], min(0.018, 0.07 * width), -Y)
    # In a row: on the base under a jug, else on the head.
    low = kind == "filter"
    level_4 = 0.5 * base if low else 0.5 * (head + height - the_lid)
    for k_2 in range(buttons):
        x_2 = (0.7 * (k_2 + 0.5) / buttons - (0.35 if low else 0.45)) * width
        cap = min(0.016, 0.5 * width / buttons - 2.0 * clearance)
        with w.fitted() as b:
            mechanisms.button(
                b,
                f"button_{k_2 + 1}",
                parent="body",
                at=(x_2, 0, level_4),
                out=-Y,
                size=(cap, cap),
                high=0.004,
                is_round=button == "round",
            )
    w.settle()


@kind(
    usual={"ceiling fan, overhead fan": {"kind": "ceiling"}},
    words=("ventilator, table fan, floor fan, desk fan, pedestal fan, standing fan, room fan, usb fan, electric fan"),
    kind=choice(
        {"stand": "desk, table, floor, pedestal, standing", "ceiling": "", "box": "window"},
        help="On a stand, under a ceiling, or in a box.",
    ),
    blades=whole(2, 8, default=4, usual=(3, 6), help="Of the rotor.", words="blade, wing, vane"),
    diameter=length(0.16, 0.6, default=0.3, usual=(0.2, 0.45), help="Of stand or box fans' blades."),
    span=length(0.6, 2.5, default=1.2, usual=(0.9, 1.4), help="Of a ceiling fan's blades."),
    height=length(0.3, 1.8, default=0.5, usual=(0.4, 1.2), help="Of the whole; a box fan's follows from its diameter."),
    buttons=whole(0, 4, default=0, help="None: a knob.", words="key"),
    carved_from="plastic",
)
def fan(
    w: ObjectBuilder,
    kind: str,
    blades: int,
    diameter: float,
    span: float,
    height: float,
    buttons: int,
    open: float,
    clearance: float,
) -> None:
    """Fans: blades that turn without end, in a cage on a stand, under a ceiling or in a box."""
    fork = (0.036, 0.013)  # width and radius of the hinge that a head tilts on [m]
    flange = 0.014  # of the rotor [m]
    pitch = 16.0  # of the blades [deg]
    wire = 0.004  # thickness of the cage's rods [m]
    spokes = 12
    down = np.diag([1.0, -1.0, -1.0])

    # Width of a blade, the level of its middle, and how far the rotor reaches outwards [m].
    def blades_of(radius: float) -> Point:
        wide = min(0.5 * radius, 2.4 * radius / blades)
        level = 0.006 + 0.5 * wide * sin(radians(pitch)) + clearance
        return (wide, level, max(2.0 * level - 0.004, flange + clearance))

    # Add boss, hole and rotor.
    def rotor_of(parent: str, place: FloatArray, radius: float) -> None:
        count = blades
        hub = min(0.2 * radius, 0.06)
        boss, hole, rotor = stub((0, 0, 0), (0, 0, 1), hub, clearance, length=flange)
        wide, level, front = blades_of(radius)
        root = (0.2 * radius, 0.25 * wide)
        tip = (radius - 0.5 * wide, 0.5 * wide)
        ends = [cylinder(r, x, 0, (-0.0015, 0.0015), segments=24) for x, r in (root, tip)]
        blade = (hull(*ends) + slab((0, root[0]), root[1], 0.0015)).rotate((pitch, 0, 0))
        blades_2 = [blade.translate((0, 0, level)).rotate((0, 0, 360.0 * k / count)) for k in range(count)]
        cap = cylinder(0.9 * hub, clearance + 0.001, front)
        w.part(f"{parent}", boss.transform(place))
        w.cut(f"{parent}", hole.transform(place))
        w.part("rotor", union(rotor, cap, *blades_2).transform(place))
        w.spin("rotor", f"{parent}", place[:, 2], place[:, 3])

    # Rods behind and before the blades, and a rim around them.
    def cage(radius: float, motor: float, front: float) -> Manifold:
        outer = radius + 0.012
        back = -0.002 - wire
        top = front + 0.008
        rim = cylinder(outer + wire, back, top + wire) - cylinder(outer, -1, 1)
        rods: list[Manifold] = []
        for k in range(spokes):
            for start, level in ((0.6 * motor, back), (0.0, top)):
                rod = slab((start, outer + 0.5 * wire), 0.5 * wire, (level, level + wire))
                rods = [*rods, rod.rotate((0, 0, 360.0 * k / spokes))]
        rods = [*rods, cylinder(0.7 * motor, top, top + 1.5 * wire)]
        return union(rim, *rods)

    # Buttons in a row, or a knob, on top of the base.
    def controls(place: Point, depth: float) -> None:
        count = buttons
        for k in range(max(count, 1)):
            where = (place[0] + 0.021 * (k - 0.5 * (max(count, 1) - 1)), *place[1:])
            if count:
                with w.fitted() as b:
                    button(b, f"button_{k + 1}", "base", where, (0.013, 0.012), 0.004, Z)
            else:
                with w.fitted(open) as b:
                    knob(b, "knob", "base", where, 0.016, Z, reach=4.7)

    if kind == "stand":
        # A foot with a post; a yoke that swings on it, and in the yoke a head that tilts.
        radius = 0.5 * diameter
        foot = 0.07 + 0.5 * radius
        motor = max(0.032, 0.22 * radius)
        lift = motor + 0.028
        axle = max(height - radius - 0.016, 1.2 * radius + 0.09, lift + 0.11)
        tilt = vector(0.0, 0.0, axle - lift)
        swing = (0.0, 0.0, tilt[2] - 0.042)
        w.part("base", cylinder(foot, 0, 0.025), cylinder(0.014, (0, 0, 0.02), swing))
        boss, hole, rotor = stub(swing, (0, 0, 1), 0.018, clearance, length=0.015)
        w.part("base", boss)
        w.cut("base", hole)
        forked, tongue = bent_fork(tilt, (0.0, 0.0), fork[0], fork[1], clearance)
        w.part("yoke", rotor, forked)
        w.hinge("yoke", "base", (0, 0, 1), swing, 0.8, -0.8, rest=open * 0.8)
        front = -0.5 * radius - 0.03
        housing = cylinder(motor, 0, (0.03, front), axle)
        neck = slab(0.008, 0.01, (tilt[2] + 0.015, axle))
        w.part("head", tongue, neck, housing)
        w.hinge("head", "yoke", (-1, 0, 0), tilt, 0.3, -0.3, rest=open * 0.3)
        place = at((0, front, axle), FRONT)
        rotor_of("head", place, radius)
        w.part("head", cage(radius, motor, blades_of(radius)[2]).transform(place))
        controls((0.0, -0.6 * foot, 0.025), 0.018)
    elif kind == "ceiling":
        # A canopy, a rod and a motor with the rotor below.
        radius_2 = 0.5 * span
        level = blades_of(radius_2)[2] + 0.004
        w.part(
            "base",
            cylinder(0.075, height - 0.05, height),
            cylinder(0.012, level, height - 0.04),
            cylinder(0.09, level, level + 0.09),
        )
        rotor_of("base", at((0, 0, level), down), radius_2)
        w.part("rotor", cylinder(0.02, 0, 0.005))
    elif kind == "box":
        # A square duct with bars behind and in front of the blades.
        radius_3 = 0.5 * diameter
        half = radius_3 + 0.03
        motor_2 = max(0.03, 0.22 * radius_3)
        back = 0.06
        centre = (0.0, back, half)
        w.part("base", cylinder(motor_2, (0, back + 0.03, half), centre))
        rotor_of("base", at(centre, FRONT), radius_3)
        front_2 = back - blades_of(radius_3)[2] - 0.02
        duct = slab(half, (front_2, back + 0.05), (0, 2 * half))
        duct = duct - slab((0.012 - half, half - 0.012), 1.0, (0.012, 2 * half - 0.012))
        bars: list[Any] = []
        for share in np.linspace(-0.8, 0.8, 9):
            x = share * half
            bars = [*bars, box((x - 0.003, front_2, 0.005), (x + 0.003, front_2 + 0.006, 2 * half - 0.005))]
            bars = [*bars, box((x - 0.003, back + 0.01, 0.005), (x + 0.003, back + 0.018, 2 * half - 0.005))]
        bars = [*bars, box((0.005 - half, back + 0.01, half - 0.004), (half - 0.005, back + 0.018, half + 0.004))]
        w.part("base", duct, bars)
        controls((0.0, back + 0.03, 2.0 * half), 0.009)
    w.settle()


@kind(
    words=(
        "lamp, table lamp, reading lamp, task lamp, work lamp, architect lamp, desk light, study lamp, bedside lamp, "
        "drawing lamp, drafting lamp, led lamp, piano lamp, anglepoise lamp, workshop lamp, table light, reading "
        "light, bedside light"
    ),
    carved_from="metal",
    part_words={"arm": "arm segment, segment"},
    joints=whole(
        1, 4, default=3, help="Hinges; the fourth lets the post turn.", words="joint, hinge, degree of freedom, dof"
    ),
    arm=length(0.15, 0.8, default=0.3, usual=(0.2, 0.4), help="Length of an arm."),
    base=length(0.06, 0.2, default=0.09, usual=(0.07, 0.12), help="Radius."),
    shade=length(0.03, 0.12, default=0.06, usual=(0.045, 0.08), help="Radius."),
    switch=choice(("none", "button", "knob"), help="On the base."),
)
def desk_lamp(
    w: ObjectBuilder, joints: int, arm: float, base: float, shade: float, switch: str, open: float, clearance: float
) -> None:
    """Desk lamps: arms on pins one after the other, and a shade at the end."""
    # the_leans: Of the post, the arms and the head's neck, from the upright towards the front [rad]; by hinges.
    radius = 0.011  # of the hinges [m]
    the_leans = {1: (0.0, 0.9), 2: (0.0, 0.3, 1.3), 3: (0.0, -0.4, 0.8, 1.6)}
    swings = ((-0.3, 0.4), (-0.25, 0.6), (-0.4, 0.5))  # of the hinges, counted from the head, positive upwards [rad]

    # A hollow cone that hangs on the neck with a bulb in it; its mouth looks where `lean` says.
    def shade_of(neck: FloatArray, lean: float) -> Sequence[Manifold]:
        wide = shade
        deep = 1.1 * shade
        cone = Manifold.cylinder(deep, 0.35 * wide, wide, SEGMENTS)
        inner = Manifold.cylinder(deep, 0.35 * wide - 0.002, wide - 0.002, SEGMENTS).translate((0, 0, 0.004))
        bulb = ball(0.3 * wide, (0, 0, 0.45 * deep)) + cylinder(0.12 * wide, 0.002, 0.4 * deep)
        socket = cylinder(0.3 * wide, -0.03, 0.002)
        made = [cone - inner, bulb, socket]
        return [solid.translate((0, 0, 0.01)).rotate((degrees(lean), 0, 0)).translate(neck) for solid in made]

    hinges = min(joints, 3)
    w.part("base", cylinder(base, 0, 0.02), cylinder(0.6 * base, 0.019, 0.028))
    # A button or a knob in front of the post.
    place = (0, -0.8 * base, 0.02)
    if switch == "button":
        with w.fitted() as b:
            button(b, "button", "base", place, (0.016, 0.012), 0.004, Z)
    elif switch == "knob":
        with w.fitted(open) as b:
            knob(b, "knob", "base", place, 0.12 * base, Z, reach=4.7)
    parent = "base"
    pivot = vector(0.0, 0.0, 0.08 if hinges > 1 else 0.03 + 0.8 * arm)
    if joints > hinges:
        boss, hole, rotor = stub((0, 0, 0.045), (0, 0, 1), 0.016, clearance, length=0.018)
        w.part("base", boss)
        w.cut("base", hole)
        parent = "post"
        w.part(parent, rotor)
        w.hinge(parent, "base", (0, 0, 1), (0, 0, 0.045), 2.5, -2.5)
        pivot = pivot + vector(0.0, 0.0, 0.02)
        start = (0.0, 0.0, 0.06)
    else:
        start = (0.0, 0.0, 0.02)
    w.part(parent, cylinder(0.9 * radius, start, pivot - (0.0, 0.0, 2.0 * radius)))
    leans = the_leans[hinges]
    for k in range(hinges):
        last = k + 1 == hinges
        forked, tongue = bent_fork(pivot, (leans[k], leans[k + 1]), 0.026, radius, clearance)
        w.part(parent, forked)
        along = vector(0.0, -sin(leans[k + 1]), cos(leans[k + 1]))
        end = pivot + (0.02 + shade if last else arm) * along
        begin = pivot + 1.6 * radius * along
        stop = end - (0.0 if last else 2.0 * radius) * along
        name = "head" if last else f"arm_{k + 1}"
        w.part(name, tongue, rod(0.55 * radius, begin, stop))
        if last:
            w.part(name, shade_of(end, leans[k + 1] + 0.5 * pi))
        least, most = swings[hinges - 1 - k]
        w.hinge(name, parent, (-1, 0, 0), pivot, most, least, rest=open * most)
        parent = name
        pivot = end
    w.settle()
