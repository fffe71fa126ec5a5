"""Boxes, bottles, buckets and bins, carved."""

from __future__ import annotations

from collections.abc import Sequence
from math import asin, atan2, cos, degrees, hypot, pi, sin

from manifold3d import Manifold

from kinematify.generate.library.kind import choice, kind, length, share, whole
from kinematify.generate.library.mechanisms import caster, in_fork
from kinematify.generate.library.panels import grip
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.pieces.bearing_pieces import BackEdge, add_barrels, barrel
from kinematify.generate.procedural.solids import (
    Point,
    X,
    Z,
    beam,
    bore,
    box,
    cylinder,
    hull,
    lathe,
    ring,
    rod,
    slab,
    tray,
    union,
    vector,
)


@kind(
    words=(
        "chest box, treasure chest, toolbox, jewelry box, crate, case, container, casket, trunk, pencil box, storage "
        "box, sewing kit box, money box"
    ),
    usual={
        "storage bench, hope chest, blanket chest, toy box, toy chest": {"width": 1.1, "depth": 0.45, "height": 0.5},
        "cool box, esky, cooler, ice chest": {"width": 0.6, "depth": 0.4, "height": 0.4},
        "lunchbox, pencil case, gift box, ring box, glasses case": {"width": 0.25, "depth": 0.15, "height": 0.1},
        "briefcase, record case, camera case, cash box, file box": {"width": 0.45, "depth": 0.3, "height": 0.2},
        (
            "linen chest, dowry chest, blanket box, storage bin, recycling bin, recycling box, deck box, cushion box, "
            "coffer, log box, coal box, storage chest, storage trunk, pirate chest, steamer trunk"
        ): {"width": 1, "depth": 0.5, "height": 0.5},
        (
            "bait box, fishing box, ammo box, ammunition box, first aid box, first aid kit, medicine box, shoe box, "
            "shoebox, packing box, moving box, shipping box, shipping crate, transport box, flight case, equipment "
            "case, road case, tool case, drill case, vanity case, beauty case, humidor, cooler box, keepsake box, "
            "memory box, toy crate, tool crate"
        ): {"width": 0.4, "depth": 0.3, "height": 0.25},
        "gun case, rifle case, poker case, chess box": {"width": 0.9, "depth": 0.35, "height": 0.15},
        "coffin": {"width": 2, "depth": 0.7, "height": 0.5},
        "snuff box, trinket box, spice box, card box, cigarette case, cufflink box, charging case": {
            "width": 0.12,
            "depth": 0.08,
            "height": 0.06,
        },
    },
    title="box with a lid",
    carved_from="wood",
    width=length(0.06, 2.0, default=0.3, usual=(0.15, 0.6), help="Outer width."),
    depth=length(0.05, 1.5, default=0.2, usual=(0.1, 0.4), help="Outer depth."),
    height=length(0.04, 1.5, default=0.15, usual=(0.06, 0.35), help="Without the lid."),
    wall=length(0.003, 0.015, default=0.006, usual=(0.004, 0.012), help="Of the boards."),
    lid=choice(
        {"hinged": "hinge, flip", "sliding": "slide, slider", "loose": "lift off, removable"}, help="How the lid moves."
    ),
    hinge=choice(
        ("edge", "barrel", "piano"), help="Of a hinged lid: hidden, two barrels, or one along the whole edge."
    ),
    top=choice({"flat": "", "round": "vaulted, domed, curved"}, help="Of a hinged lid."),
)
def box_(
    w: ObjectBuilder,
    width: float,
    depth: float,
    height: float,
    wall: float,
    lid: str,
    hinge: str,
    top: str,
    open: float,
    clearance: float,
) -> None:
    """Boxes with a lid: hinged, sliding in grooves, or lifted off straight."""

    # What stands on the lid of a treasure chest: a part of a cylinder that rises over the depth.
    def vault(width: float, depth: float, level: float, rise: float) -> Manifold:
        radius = 0.5 * rise + 0.125 * depth * depth / rise
        centre = (0.5 * depth, level + rise - radius)
        whole = cylinder(radius, (-0.5 * width, *centre), (0.5 * width, *centre), segments=96)
        return whole.trim_by_plane((0, 0, 1), level)

    if lid == "hinged":
        # A lid that turns up about the upper back edge.
        level = height + clearance
        w.part("body", tray((-0.5 * width, 0, 0), (0.5 * width, depth, height), wall))
        its_lid = slab(0.5 * width, (0, depth), (level, level + wall))
        if top == "round":
            its_lid = its_lid + vault(width, depth, level + 0.5 * wall, max(wall, min(0.35 * depth, 0.4 * height)))
        grip = slab(0.12 * width, (-0.012, 0.1 * depth), (level, level + 0.3 * wall))
        w.part("lid", its_lid, grip)
        pivot = (0.0, depth, level)
        if hinge != "edge":
            edge = BackEdge(y=depth, level=level, below=height, above=wall, clearance=clearance)
            whole = hinge == "piano"
            places, length = ((0.0,), 0.9 * width) if whole else ((-0.3 * width, 0.3 * width), min(0.05, 0.3 * width))
            radius = min(0.004, 0.5 * wall)
            knuckles = 9 if whole else 3
            pivot = add_barrels(
                w, "lid", parent="body", edge=edge, places=places, length=length, radius=radius, knuckles=knuckles
            )
        w.hinge("lid", "body", (-1, 0, 0), pivot, 1.9, rest=open * 1.9)
    elif lid == "sliding":
        # A lid that is drawn out along -y in grooves of the side walls, as of a pencil box.
        level_2 = height - 2.0 * wall
        thick = wall
        groove = 0.5 * wall
        body = tray((-0.5 * width, 0, 0), (0.5 * width, depth, height), wall)
        half = 0.5 * width - wall + groove
        slot = slab(half, (-1.0, depth - wall + groove), (level_2, level_2 + thick))
        mouth = box((wall - 0.5 * width, -1.0, level_2), (0.5 * width - wall, wall + 0.001, height + 1.0))
        w.part("body", body - slot - mouth)
        gap = min(clearance, 0.25 * wall)
        its_lid = box((gap - half, 0, level_2 + gap), (half - gap, depth - wall + groove - gap, level_2 + thick - gap))
        notch = slab(0.1 * width, (0.08 * depth, 0.08 * depth + 0.006), (level_2, level_2 + thick + 0.3 * wall))
        w.part("lid", its_lid, notch.trim_by_plane((0, 0, 1), level_2 + 0.5 * thick))
        w.slide("lid", "body", (0, -1, 0), 0.85 * depth, pivot=(0, 0, level_2), rest=open * (0.85 * depth))
    elif lid == "loose":
        # A lid that reaches over the rim and is lifted off.
        gap_2 = max(clearance, 0.0002)
        w.part("body", tray((-0.5 * width, 0, 0), (0.5 * width, depth, height), wall))
        out = gap_2 + wall
        skirt = max(2.0 * wall, 0.2 * height)
        lower = (-0.5 * width - out, -out, height - skirt)
        cap = box(lower, (0.5 * width + out, depth + out, height + gap_2 + wall))
        inner = slab(0.5 * width + gap_2, (-gap_2, depth + gap_2), (height - skirt - 1.0, height + gap_2))
        w.part("lid", cap - inner)
        travel = 1.2 * skirt
        w.slide("lid", "body", (0, 0, 1), travel, pivot=(0, 0.5 * depth, height), rest=open * travel)
    w.settle()


@kind(
    usual={"flip cap bottle, flip top bottle, sauce bottle": {"cap": "flip"}},
    words=(
        "water bottle, wine bottle, drinking bottle, flask, milk bottle, bottle of water, thermos, thermos flask, "
        "vacuum flask, sports bottle, shampoo bottle, ketchup bottle, medicine bottle, oil bottle, beer bottle, "
        "vinegar bottle, vial, soda bottle, juice bottle"
    ),
    title="bottle with a cap",
    width=length(0.04, 0.3, default=0.075, usual=(0.055, 0.1), help="Outer diameter.", words="diameter"),
    height=length(0.1, 0.6, default=0.24, usual=(0.16, 0.32), help="Without the cap."),
    neck=length(0.024, 0.08, default=0.03, usual=(0.026, 0.04), help="Its diameter."),
    cap=choice(
        {
            "screw": "screw top, screw on, twist, twist off, twisting",
            "pull": "stopper, cork, plug, push on, pull off",
            "flip": "flip top, hinged, flip up, snap",
        },
        help="How it opens.",
        words="lid, top",
    ),
    carved_from="plastic",
)
def bottle(w: ObjectBuilder, width: float, height: float, neck: float, cap: str, open: float, clearance: float) -> None:
    """Bottles: a hollow body with a neck, and a cap that turns, is pulled out or flips open."""
    the_cap = 0.002  # wall of a cap [m]
    the_ribs = 24  # around a cap
    hinge = 0.002  # radius [m]
    # Radius and height of the neck [m].
    the_neck = (min(0.5 * neck, 0.4 * width), max(0.02, 0.08 * height))
    wall = min(0.003, 0.25 * the_neck[0])

    # Body, shoulder and neck with a bead under the cap; hollow, with a floor.
    def vessel() -> Manifold:
        radius = 0.5 * width
        neck, tall = the_neck
        shoulder = height - tall
        sides = shoulder - min(1.2 * (radius - neck) + 0.01, 0.5 * shoulder)
        foot = min(0.004, 0.2 * radius)
        outline = [(radius - foot, 0.0), (radius, foot), (radius, sides), (neck, shoulder), (neck, height)]
        outer = lathe([(0.0, 0.0), *outline, (0.0, height)])
        inside = [
            (radius - wall, 2.0 * foot),
            (radius - wall, sides),
            (neck - wall, shoulder),
            (neck - wall, height + 0.01),
        ]
        inner = lathe([(0.0, wall), (radius - foot - wall, wall), *inside, (0.0, height + 0.01)])
        bead = cylinder(neck + 0.0015, shoulder, shoulder + 0.002)
        return outer + bead - inner

    w.part("body", vessel())
    if cap == "screw":
        # A cap over the neck, with ribs around it; a bead of the neck holds its lip, as a thread would.
        its_neck, tall = the_neck
        bottom = height - tall + 0.002 + clearance
        top = height + clearance
        lip = (its_neck + clearance) / cos(pi / 48)
        bead = lip + 0.001
        inner = (bead + clearance) / cos(pi / 48)
        outer = inner + the_cap
        held = bottom + 0.003 + clearance
        its_ring = cylinder(bead, held, held + 0.002) - cylinder(its_neck - 0.0001, -1.0, 1.0)
        w.part("body", its_ring)
        ribs = [
            cylinder(0.0008, outer * cos(a), outer * sin(a), (bottom, top))
            for a in [2.0 * pi * k / the_ribs for k in range(the_ribs)]
        ]
        hollow = cylinder(inner, bottom + 0.003, top) + cylinder(lip, -1.0, top)
        its_cap = cylinder(outer, bottom, top + the_cap) - hollow
        w.part("cap", its_cap, ribs, look="plastic")
        w.spin("cap", "body", (0, 0, 1), (0, 0, height))
    elif cap == "pull":
        # A stopper in the neck with a head above the rim.
        its_neck, tall_2 = the_neck
        tight = min(clearance, 0.2 * its_neck)
        deep = 0.8 * tall_2
        plug = cylinder(its_neck - wall - tight / cos(pi / 48), height - deep, height + 0.003)
        head = cylinder(1.15 * its_neck, height + tight, height + tight + 0.6 * its_neck)
        knob = cylinder(0.8 * its_neck, height, height + tight + 0.9 * its_neck)
        w.part("cap", plug, head, knob.trim_by_plane((0, 0, 1), height + tight), look="plastic")
        w.slide("cap", "body", (0, 0, 1), 1.2 * deep, pivot=(0, 0, height), rest=open * (1.2 * deep))
    elif cap == "flip":
        # A flat cap on a hinge behind the mouth, with a tab in front.
        its_neck, _unused = the_neck
        level = height + clearance
        thick = 0.006
        half = 0.6 * its_neck
        y = its_neck + 0.001
        inner_2 = cylinder(its_neck - wall, height - 0.02, height + 1.0)
        w.part("body", slab(half, (0.5 * its_neck, y), (height - 0.01, height)) - inner_2)
        back = slab(half, (0, y), (level, level + thick))
        tab = slab(0.3 * its_neck, (-its_neck - 0.004, 0), (level + 0.5 * thick, level + thick))
        w.part("cap", cylinder(its_neck, level, level + thick), back, tab, look="plastic")
        edge = BackEdge(y=y, level=level, below=0.009, above=thick, clearance=min(clearance, 0.5 * hinge))
        pivot = add_barrels(w, "cap", parent="body", edge=edge, places=(0.0,), length=1.6 * half, radius=hinge)
        w.hinge("cap", "body", (-1, 0, 0), pivot, 1.5, rest=open * 1.5)
    w.settle()


@kind(
    words=(
        "pail, water bucket, paint bucket, cleaning bucket, sand bucket, feed bucket, milk pail, beach bucket, toy "
        "bucket, slop bucket"
    ),
    width=length(
        0.12,
        0.8,
        default=0.28,
        usual=(0.2, 0.36),
        help="Outer diameter of the rim, without the bead.",
        words="diameter",
    ),
    height=length(0.1, 0.8, default=0.27, usual=(0.2, 0.35), help="To the rim."),
    taper=share(0.5, 0.95, default=0.72, usual=(0.62, 0.85), help="Foot over rim."),
    wire=length(0.002, 0.006, default=0.003, usual=(0.0025, 0.004), help="Its radius."),
    handle=choice(
        {"grip": "with a grip", "wire": "bare wire"},
        help="A bail with a grip around its top, or the wire alone.",
        words="bail",
    ),
    carved_from="plastic",
)
def bucket(
    w: ObjectBuilder, width: float, height: float, taper: float, wire: float, handle: str, open: float, clearance: float
) -> None:
    """Buckets: a vessel that widens upwards, and a bail that swings on studs at its sides."""
    below = 0.025  # from the rim down to the studs [m]
    the_bead = 0.002  # how far the rim stands out [m]
    wall = 0.003

    def profile(inset: float, bottom: float, top: float) -> Sequence[tuple[float, float]]:
        radius = 0.5 * width
        foot = taper * radius
        return [(0.0, bottom), (foot - inset, bottom), (radius - inset, top), (0.0, top)]

    # Solid as yet; the studs reach into it.
    def vessel() -> Manifold:
        radius = 0.5 * width
        bead = cylinder(radius + the_bead, height - 0.006, height)
        return lathe(profile(0.0, 0.0, height)) + bead

    bucket_inside = lathe(profile(wall, wall, height + 0.0001))

    # A half circle of wire that stands upright over the x axis, with a grip around its top.
    def bail_of(reach: float, wire: float, grip: float) -> Sequence[Manifold]:
        made = [ring(reach, wire, 180.0)]
        if grip > wire:
            made = [*made, ring(reach, grip, 50.0).rotate((0, 0, 65.0))]
        return [solid.rotate((90.0, 0, 0)) for solid in made]

    radius = 0.5 * width
    stud = 1.2 * wire
    level = height - below
    grip = 2.6 * wire if handle == "grip" else wire
    reach = hypot(radius + the_bead + clearance, below) + wire + 0.0005
    w.part("body", vessel())
    bend = 2.4 * stud * (2.4 * stud) / reach
    eyes: list[Manifold] = []
    holes: list[Manifold] = []
    for side in (-1.0, 1.0):
        eye = (side * (reach - wire), side * (reach + wire))
        face = side * (reach - wire - clearance - bend)
        boss = cylinder(2.0 * stud, (side * 0.3 * radius, face), 0, level)
        shaft = cylinder(stud, (side * 0.3 * radius, eye[1] + side * (clearance + 0.0001)), 0, level)
        head = cylinder(1.9 * stud, (eye[1] + side * clearance, eye[1] + side * (clearance + wire)), 0, level)
        w.part("body", boss, shaft, head)
        eyes = [*eyes, cylinder(2.2 * stud, (eye[0], eye[1]), 0, level)]
        holes = [*holes, bore(stud, clearance, (side * 0.5 * reach, 0, level), (side * 2.0 * reach, 0, level))]
    w.cut("body", bucket_inside)
    lies = asin(min(0.9, (below + 1.2 * grip + clearance) / (0.9 * reach)))
    bail = union(*bail_of(reach, wire, grip), *[eye.translate((0, 0, -level)) for eye in eyes])
    bail = bail.rotate((90.0 - degrees(lies), 0, 0)).translate((0, 0, level)) - union(*holes)
    w.part("handle", bail, look="steel")
    swing = pi - 2.0 * lies
    w.hinge("handle", "body", (-1, 0, 0), (0, 0, level), swing, rest=open * swing)
    w.settle()


@kind(
    words=(
        "garbage can, trash bin, garbage bin, dustbin, waste bin, rubbish bin, bin, pedal bin, kitchen bin, recycling "
        "can, step bin, office bin, litter bin, bathroom bin"
    ),
    width=length(0.18, 0.8, default=0.28, usual=(0.2, 0.42), help="Outer width or diameter.", words="diameter"),
    height=length(0.2, 1.2, default=0.4, usual=(0.28, 0.7), help="Without the lid."),
    lid=choice(
        {
            "pedal": "pedal bin, foot pedal",
            "swing": "swing lid, swinging, flap, swing top",
            "lift": "lifts, lifts off, lift off, loose, removable",
        },
        help="How it opens.",
        words="cover",
    ),
    shape=choice(("round", "square"), help="Of the bin."),
    carved_from="plastic",
)
def trash_can(
    w: ObjectBuilder, width: float, height: float, lid: str, shape: str, open: float, clearance: float
) -> None:
    """Trash cans: a pedal and a hinged lid, a flap that swings both ways, or a lid that is lifted off."""
    wall = 0.004
    base = 0.06  # height of the solid foot that holds a pedal [m]
    pedal = 0.2  # way of the pedal [rad]

    # A round or a square bin, its axis at the origin, with a floor at the height of its foot.
    def bin(foot: float) -> Manifold:
        half = 0.5 * width
        if shape == "square":
            lower = (-half, -half, foot)
            upper = (half, half, height)
            found = tray(lower, upper, wall) + slab(half, half, (0, foot))
        else:
            inner = cylinder(half - wall, foot + wall, height + 1.0)
            found = cylinder(half, 0, height) - inner
        return found

    # Keeps the seat of the hinge from reaching into the bin.
    def inside(half: float, height: float) -> Manifold:
        return cylinder(half - wall, base + wall, height + 1.0)

    # A plate of the shape of the bin, wider by `grow` on all sides.
    def cover(grow: float, bottom: float, top: float) -> Manifold:
        half = 0.5 * width + grow
        return slab(half, half, (bottom, top)) if shape == "square" else cylinder(half, bottom, top)

    if lid == "pedal":
        half = 0.5 * width
        level = height + clearance
        thick = 0.012
        seat = 0.04
        w.part("body", bin(base), slab(seat, (0.8 * half, half + 0.002), (height - 0.03, height)))
        w.cut("body", inside(half, height))
        w.part("lid", cover(0.0, level, level + thick), slab(seat, (0.0, half + 0.002), (level, level + thick)))
        edge = BackEdge(y=half + 0.002, level=level, below=0.03, above=thick, clearance=clearance)
        pivot = add_barrels(w, "lid", parent="body", edge=edge, places=(0.0,), length=2.0 * seat, radius=0.004)
        w.hinge("lid", "body", (-1, 0, 0), pivot, 1.5, rest=open * 1.5)
        # A lever on a pin across a slot of the foot; its end in front goes down.
        wide = 0.025
        level_2 = 0.036
        radius = 0.005
        back_2 = -half + 0.06
        tip = -half - 0.05
        slot = slab(wide, (-2.0 * half, back_2 + 3.0 * radius), (0.006, base - 0.006))
        pin = ((-wide - 0.01, back_2, level_2), (wide + 0.01, back_2, level_2))
        hole = ((pin[0][0] - 0.002, back_2, level_2), (pin[1][0] + 0.002, back_2, level_2))
        w.cut("body", slot, bore(radius, clearance, *hole))
        inner = wide - max(clearance, 0.0005)
        high = (level_2 - radius, level_2 + radius)
        arm = slab(inner, (tip + 0.02, back_2), high)
        plate = slab(1.6 * wide, (tip, tip + 0.035), high)
        hub = cylinder(1.4 * radius, (-inner, inner), back_2, level_2)
        w.part("pedal", arm, plate, hub, cylinder(radius, *pin), look="steel")
        w.hinge("pedal", "body", (1, 0, 0), (0, back_2, level_2), pedal, rest=open * pedal)
        w.follow("pedal", "lid", pedal / 1.5)
    elif lid == "swing":
        # A flap in the mouth on two pins in the side walls.
        half_2 = 0.5 * width
        level_3 = height - 0.3 * half_2
        inner_2 = half_2 - wall
        radius_2 = 0.004
        if shape == "square":
            reach = inner_2 - clearance - 0.002
            flap = slab(reach, reach, (level_3 - 0.003, level_3 + 0.003))
        else:
            reach = 0.97 * inner_2 - clearance
            flap = cylinder(reach, level_3 - 0.003, level_3 + 0.003)
        ridge = slab(0.5 * reach, 0.008, (level_3, level_3 + 0.012))
        pin_2 = ((-half_2 - 0.002, 0, level_3), (half_2 + 0.002, 0, level_3))
        steepest = asin(min(0.93, 0.95 * (level_3 - wall) / (reach + 0.01)))
        w.part("body", bin(0.0))
        w.cut("body", bore(radius_2, clearance, (-2.0 * half_2, 0, level_3), (2.0 * half_2, 0, level_3)))
        w.part("flap", flap, ridge, cylinder(radius_2, *pin_2))
        w.hinge("flap", "body", (1, 0, 0), (0, 0, level_3), steepest, -steepest, rest=open * steepest)
    elif lid == "lift":
        # A lid with a skirt around the rim and a handle.
        skirt = 0.1 * height
        top = height + clearance + wall
        cap = cover(clearance + 1.5 * wall, height - skirt, top) - cover(clearance, -1.0, height + clearance)
        w.part("body", bin(0.0))
        w.part("lid", cap)
        with w.fitted() as b:
            grip(b, "lid", (0, 0, top), Z, X, 0.12, kind="knob")
        w.slide("lid", "body", (0, 0, 1), 1.2 * skirt, pivot=(0, 0, height), rest=open * (1.2 * skirt))
    w.settle()


@kind(
    words=(
        "trolley case, luggage, travel case, roller suitcase, carry on, carry on suitcase, cabin bag, rolling "
        "suitcase, wheeled suitcase, hand luggage, travel suitcase, travel trolley"
    ),
    width=length(0.3, 0.7, default=0.4, usual=(0.34, 0.5), help="Of the shells."),
    depth=length(0.18, 0.45, default=0.24, usual=(0.2, 0.3), help="Of both shells."),
    height=length(0.4, 1.0, default=0.62, usual=(0.52, 0.75), help="With the wheels, the handle pushed in."),
    wheels=whole(2, 4, default=4, help="Castors; two of them only roll.", words="wheel, roller, castor, caster"),
    handle=choice(
        {"trolley": "telescopic, telescoping, extendable, pull out", "side": "carrying"},
        help="One that is drawn out at the top, or only the one at the side.",
    ),
    carved_from="plastic",
)
def suitcase(
    w: ObjectBuilder, width: float, depth: float, height: float, wheels: int, handle: str, open: float, clearance: float
) -> None:
    """Suitcases that stand upright: two shells on a hinge at the left, wheels, and a handle that is drawn out."""
    fork = 0.056  # height of a wheel with its fork [m]
    the_grip = 0.021  # height of the grip above the shells when it is pushed in [m]
    round = 0.04  # radius of the corners [m]
    wall = 0.003
    hinge = 0.004  # radius [m]
    opens = 1.7  # [rad]
    tube = 0.006  # radius of the drawn handle's tubes [m]
    wheel = 0.021  # radius [m]
    # Underside of the shells [m].
    bottom = fork + clearance
    # Upper side of the shells, below the grip where there is one [m].
    top = height - (the_grip if handle == "trolley" else 0.0)

    # The outline of the front, rounded at its corners, between two depths.
    def plate(inset: float, start: float, end: float) -> Manifold:
        half = 0.5 * width - inset
        bottom_2 = bottom + inset
        top_2 = top - inset
        radius = round - inset
        places = [(x, z) for x in (radius - half, half - radius) for z in (bottom_2 + radius, top_2 - radius)]
        return hull(*[cylinder(radius, x, (start, end), z, segments=32) for x, z in places])

    # One half, open at y = `mouth`, with grooves in its broad face.
    def shell(mouth: float, back: float) -> Manifold:
        sign = 1.0 if back > mouth else -1.0
        outer = hull(plate(0.0, mouth, back - sign * 0.012), plate(0.012, mouth, back))
        hollow = plate(wall + 0.009, mouth - sign, back - sign * wall)
        shallow = sorted((back - sign * 0.0015, back + sign))
        grooves = [
            box((x - 0.004, shallow[0], 0.0), (x + 0.004, shallow[1], 9.0))
            for x in [width * share for share in (-0.3, -0.15, 0.0, 0.15, 0.3)]
        ]
        return outer - hollow - union(*grooves)

    # A grip on the right side of the half that stays.
    def side_handle() -> Sequence[Manifold]:
        x = 0.5 * width
        y = 0.25 * depth
        level = 0.5 * (bottom + top)
        ends = [(y, level - 0.06), (y, level + 0.06)]
        posts = [rod(0.006, (x - 0.001, *end), (x + 0.022, *end)) for end in ends]
        return [
            rod(0.007, (x + 0.022, *ends[0]), (x + 0.022, *ends[1])),
            *[p.trim_by_plane((1, 0, 0), x - 0.002) for p in posts],
        ]

    # Barrels at the left side of both halves; returns a point on the pins.
    def hinges() -> Point:
        face = hinge + clearance
        reach = 3.0 * hinge
        deep = (face - 0.0001, face + 0.0002)
        on_body = (*deep, clearance + 0.2 * reach, clearance + reach)
        on_front = (*deep, -reach, -0.2 * reach)
        x = -0.5 * width - face
        for part in (0.25, 0.75):
            halves = barrel(0.05, hinge, clearance, (on_body, on_front))
            for name, half in zip(("body", "front"), halves, strict=False):
                w.part(name, half.translate((x, -clearance, bottom + part * (top - bottom))))
        return (x, -clearance, bottom)

    deep = 0.5 * depth
    w.part("body", shell(0.0, deep), side_handle())
    w.part("front", shell(-clearance, -deep))
    w.hinge("front", "body", (0, 0, -1), hinges(), opens, rest=open * opens)
    if handle == "trolley":
        # Two tubes in sleeves at the back, with a grip above the top.
        x = 0.22 * width
        y = 0.5 * depth - 0.022
        low = bottom + 0.05
        grip = top + 0.012
        tubes: list[Manifold] = []
        for side in (-x, x):
            w.part("body", cylinder(tube + clearance + 0.003, side, y, (bottom + 0.02, top)))
            tubes = [*tubes, cylinder(tube, side, y, (low + clearance, grip))]
        for side in (-x, x):
            w.cut("body", bore(tube, clearance, (side, y, low), (side, y, top + 1.0)))
        bar = rod(0.009, (-x, x), y, grip)
        w.part("handle", tubes, bar, look="metal")
        way = 0.75 * (top - low)
        w.slide("handle", "body", (0, 0, 1), way, pivot=(0, y, top), rest=open * way)
    # Castors under both halves, or two wheels that only roll and feet beside them.
    x_2 = 0.5 * width - 0.07
    y_2 = 0.25 * depth
    back = [("body", -x_2, y_2), ("body", x_2, y_2)]
    front = [("front", -x_2, -y_2), ("front", x_2, -y_2)]
    places = {2: back, 3: [*back, ("front", 0.0, -y_2)], 4: [*back, *front]}[wheels]
    for k, (parent, px, py) in enumerate(places):
        w.part(parent, cylinder(0.009, px, py, (bottom, bottom + 0.028)))
        if wheels == 2:
            with w.fitted() as b:
                in_fork(b, f"wheel_{k + 1}", parent, (px, py, wheel), wheel, 0.02, bottom + 0.001)
        else:
            with w.fitted() as b:
                caster(b, f"wheel_{k + 1}", parent, (px, py, bottom), bottom, fork=f"castor_{k + 1}", deep=0.022)
    if wheels == 2:
        feet = [
            box((s * x_2 - 0.012, -y_2 - 0.012, 0), (s * x_2 + 0.012, 0.012 - y_2, bottom + 0.001)) for s in (-1, 1)
        ]
        w.part("front", feet)
    w.settle()


@kind(
    "cantilever toolbox",
    words="sewing box, cantilever sewing box, concertina toolbox",
    part_words={"arm": "link, strut"},
    details={"handle": 1},
    width=(0.3, 0.6),
    trays=whole(1, 3, words="compartment, tier", help="On each side."),
    styles=False,
)
def cantilever_box(b: ObjectBuilder, width: float, trays: int) -> None:
    """Trays on both sides that swing out like stairs, level on parallel arms."""
    w, deep, side, high, pitch = width / 2, 0.12, 0.06, 0.06, 0.066
    out = w + 0.03
    b.part(
        "body",
        slab(w, deep, (0, 0.09)) - slab(w - 0.006, deep - 0.006, (0.006, 1)),
        [slab((s * (w - 0.002), s * out), 0.012, (0.01, 0.03)) for s in (-1, 1)],
        [slab((s * (out - 0.006), s * out), 0.012, (0.01, 0.16 + pitch * trays)) for s in (-1, 1)],
        b.cylinder(0.01, (-out, out), 0, 0.15 + pitch * trays),
        look="wood",
    )
    opens = 2 * atan2(side, pitch)
    for s, name in ((-1, "front"), (1, "back")):
        parent = "body"
        for k in range(trays):
            z = 0.124 + pitch * k
            here, low = vector(0, 0.03 * s, z), vector(0, 0.09 * s, z - pitch)
            arm, tray = f"arm_{name}_{k + 1}", f"tray_{name}_{k + 1}"
            for t in (-1, 1):
                x = t * (w + 0.004 + 0.006 * (k % 2)) * X
                b.part(arm, beam(0.01, 0.004, here + x, low + x, X), look="steel")
                for pin in (here, low):
                    b.part(arm, b.cylinder(0.003, pin + x, pin + t * (w - 0.004) * X))
            b.part(arm, b.cylinder(0.003, here + w * X, here - w * X))
            level = z - high / 2, z + high / 2
            room = slab(w - 0.005, (s * 0.007, s * (deep - 0.005)), (level[0] + 0.005, 1))
            b.part(tray, slab(w, (s * 0.002, s * deep), level) - room, look="wood")
            for pin, carries in ((here, tray), (low, parent)):
                b.cut(carries, b.cylinder(0.0042, pin + X, pin - X))
            b.hinge(arm, parent, -s * X, low, opens)
            if k:
                b.follow(arm, f"arm_{name}_1")
            b.hinge(tray, arm, -s * X, here, 0.0, -opens)
            b.follow(tray, f"arm_{name}_1", -1)
            parent = tray
