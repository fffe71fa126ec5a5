"""Robot arms, gantries, grippers and hands, carved."""

from __future__ import annotations

import numpy as np

from kinematify.generate.kinds.limbs import finger_palm, fingered, jaw_rail, jaws
from kinematify.generate.library.kind import choice, kind, length, whole
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.pieces.bearing_pieces import at, fork, fork_room, stub
from kinematify.generate.procedural.solids import box, cylinder, hull, off, slab, union, vector


@kind(
    "robot arm",
    words=(
        "arm, manipulator, robotic arm, articulated arm, industrial robot, axis robot, cobot, collaborative robot, "
        "welding robot, painting robot, robot manipulator, assembly robot"
    ),
    carved_from="metal",
    joints=whole(
        1, 12, usual=(3, 7), help="Joints in series.", words="joint, dof, axis, degree of freedom, degrees of freedom"
    ),
    length=length(0.2, 3.0, default=0.9, usual=(0.5, 1.5), help="Sum of the links."),
    gripper=choice(
        {
            "none": "",
            "jaws": "gripper, parallel gripper, jaw gripper, two finger gripper",
            "fingers": "finger gripper, fingered gripper",
        },
        help="What is on its flange.",
        drawn=False,
    ),
    fingers=whole(
        2, 6, default=3, usual=None, help="Of a gripper with fingers; two are jaws.", words="finger", drawn=False
    ),
    radius=length(0.01, 0.15, default=0.04, usual=(0.03, 0.06), help="Of joints."),
)
def serial_arm(
    w: ObjectBuilder,
    joints: int,
    length: float,
    gripper: str,
    fingers: int,
    radius: float,
    open: float,
    clearance: float,
) -> None:
    """Robot arms: a foot and any number of joints that turn about the upright and across it in turn."""
    half = 0.06  # of a gripper: half the way of its jaws, length of its fingers [m]
    finger = 0.07  # of a gripper: half the way of its jaws, length of its fingers [m]
    reach = length / max(joints, 1) - 3.0 * radius
    parent = "foot"
    side = 1.0
    w.part(parent, slab((-3 * radius, 2 * radius), 2 * radius, (0, 0.02)), cylinder(radius, 0.01, 0.02 + 1.1 * radius))
    tip = vector(0.0, 0.0, 0.02 + radius)
    for k in range(joints):
        name = f"link_{k + 1}"
        upright = k % 2 == 0
        pivot = off(tip, 0, 0, radius) if upright else off(tip, 0, side * radius, 0.5 * radius)
        axis = np.array([0.0, 0.0, 1.0] if upright else [0.0, side, 0.0])
        boss, hole, rotor = stub(pivot, axis, radius, clearance, length=radius if upright else 2 * radius)
        w.part(parent, boss)
        w.cut(parent, hole)
        tip = pivot + (radius + clearance) * axis
        solids = [rotor]
        if not upright:
            solids = [*solids, cylinder(radius, tip, tip + radius * axis)]
            side = -side
        end = off(tip, 0, 0, max(reach, 2.5 * radius))
        w.part(name, solids, cylinder(0.75 * radius, tip, end))
        most = 2.8 if upright else 1.7
        w.hinge(name, parent, (0, 0, 1) if upright else (0, 1, 0), pivot, most, -most)
        tip = end
        parent = name
    w.part(parent, box(tip - 0.8 * radius, off(tip, 1.2 * radius, 0.8 * radius, 0.2 * radius)))
    if gripper != "none":
        is_jaws = gripper == "jaws" or fingers == 2
        flange = at(off(tip, 0, 0, 0.2 * radius - 0.001))
        palm = jaw_rail(half) if is_jaws else finger_palm(fingers)
        w.part(parent, [solid.transform(flange) for solid in palm])
        if is_jaws:
            jaws(w, clearance, flange, parent, "finger", half, finger, open)
        else:
            fingered(w, clearance, flange, parent, "finger", fingers, finger, open)
    w.settle()


@kind(
    words="scara robot, scara arm",
    title="SCARA robot",
    carved_from="metal",
    upper_arm=length(0.15, 1.0, default=0.3, usual=(0.2, 0.4), help="First link."),
    forearm=length(0.15, 1.0, default=0.25, usual=(0.2, 0.35), help="Second link."),
    height=length(0.2, 1.0, default=0.35, usual=(0.25, 0.45), help="Of the column."),
    stroke=length(0.05, 0.13, default=0.12, usual=(0.08, 0.13), help="Of the ram."),
)
def scara(w: ObjectBuilder, upper_arm: float, forearm: float, height: float, stroke: float, clearance: float) -> None:
    """SCARA robots: two upright hinges, a spindle that goes up and down, and a tool that turns on it."""
    size = 0.06
    thick = 0.05
    pivot = (0.0, 0.0, height)
    boss, hole, rotor = stub(pivot, (0, 0, 1), size, clearance)
    w.part("column", slab(0.12, 0.12, (0, 0.03)), cylinder(size, 0.02, height), boss)
    w.cut("column", hole)
    low = height + clearance
    elbow = (upper_arm, 0.0, low + thick)
    boss, hole, second = stub(elbow, (0, 0, 1), size, clearance, length=thick)
    beam = hull(*[cylinder(size, x, 0, (low, low + thick)) for x in (0.0, upper_arm)])
    w.part("upper_arm", rotor, beam, boss)
    w.cut("upper_arm", hole)
    w.hinge("upper_arm", "column", (0, 0, 1), pivot, 2.2, -2.2)
    start = elbow[2] + clearance
    half = 0.016
    x = upper_arm + forearm
    room = half + clearance
    arm = hull(*[cylinder(size, at, 0, (start, start + thick)) for at in (upper_arm, x)])
    head = cylinder(0.7 * size, x, 0, (start - 0.02, start + thick + 0.06))
    w.part("forearm", second, arm, head)
    w.cut("forearm", slab((x - room, x + room), room, (start - 1, start + 1)))
    w.hinge("forearm", "upper_arm", (0, 0, 1), elbow, 2.0, -2.0)
    bottom = start - 0.06
    top = start + thick + 0.09 + stroke
    spindle = slab((x - half, x + half), half, (bottom, top))
    cap = cylinder(0.03, x, 0, (top - 0.001, top + 0.01))
    tip = (x, 0.0, bottom)
    _unused, hole, tool = stub(tip, (0, 0, -1), 0.024, clearance)
    collar = cylinder(0.024, x, 0, (bottom, bottom + 0.03))
    w.part("spindle", spindle, cap, collar)
    w.cut("spindle", hole)
    w.slide("spindle", "forearm", (0, 0, -1), stroke, pivot=tip)
    plate = slab((x - 0.03, x + 0.045), 0.02, (bottom - 0.05, bottom - 0.022))
    w.part("tool", union(tool, plate))
    w.hinge("tool", "spindle", (0, 0, 1), tip, 3.1, -3.1)
    w.settle()


@kind(
    words=(
        "three axis gantry, gantry robot, cartesian robot, cnc machine, cnc router, pick and place machine, pen plotter"
    ),
    title="three-axis gantry",
    carved_from="metal",
    width=length(0.5, 4.0, default=0.9, usual=(0.6, 1.4), help="Between the sides."),
    depth=length(0.4, 4.0, default=1.0, usual=(0.6, 1.5), help="Along the bed."),
    height=length(0.4, 3.0, default=0.6, usual=(0.45, 0.9), help="Of the bridge."),
)
def gantry(w: ObjectBuilder, width: float, depth: float, height: float, clearance: float) -> None:
    """Gantries: a bridge along a bed, a carriage along the bridge, a ram up and down; each on rails."""
    bar = 0.02  # half the width of a rail [m]
    tall = 0.06
    inner = bar + clearance
    bed = [slab(0.5 * width, 0.5 * depth, (0, 0.05))]
    rails = [sign * (0.5 * width - 2 * bar) for sign in (-1, 1)]
    for x in rails:
        bed = [*bed, slab((x - bar, x + bar), 0.5 * depth, (0.04, 0.05 + tall))]
        for y0, y1 in ((-0.5 * depth, -0.5 * depth + 0.02), (0.5 * depth - 0.02, 0.5 * depth)):
            bed = [*bed, box((x - 1.5 * bar, y0, 0.04), (x + 1.5 * bar, y1, 0.07 + tall))]
    w.part("bed", bed)
    foot = 0.12
    top = height
    shoes = [
        slab((x - 2 * bar, x + 2 * bar), 0.5 * foot, (0.05 + clearance, 0.05 + tall + 0.04))
        - slab((x - inner, x + inner), 1, (0, 0.05 + tall + clearance))
        for x in rails
    ]
    posts = [slab((x - bar, x + bar), 0.03, (0.05 + tall + 0.03, top)) for x in rails]
    beam = slab((rails[0], rails[1]), bar, (top - 2 * bar, top))
    w.part("bridge", shoes, posts, beam)
    travel = depth - 0.04 - foot - 0.002
    w.slide("bridge", "bed", (0, 1, 0), 0.5 * travel, -0.5 * travel, pivot=(0, 0, 0.1))
    half = 0.07
    carriage = slab(half, 0.06, (top - 2 * bar - 0.03, top + 0.03))
    carriage = carriage - slab(1, inner, (top - 2 * bar - clearance, top + clearance))
    room = 0.015 + clearance
    tower = slab(0.04, (-0.13, -0.05), (top - 2 * bar - 0.03, top + 0.03))
    tower = tower - slab(room, (-0.09 - room, -0.09 + room), (0, 2 * height))
    w.part("carriage", union(carriage, tower))
    reach = 0.5 * (rails[1] - rails[0]) - bar - half - 0.002
    w.slide("carriage", "bridge", (1, 0, 0), reach, -reach, pivot=(0, 0, top))
    low = top - 2 * bar - 0.08
    stroke = low - 0.12
    ram = slab(0.015, (-0.105, -0.075), (low, top + 0.08 + stroke))
    cap = slab(0.03, (-0.12, -0.06), (top + 0.08 + stroke - 0.001, top + 0.1 + stroke))
    tool = cylinder(0.02, 0, -0.09, (low - 0.03, low + 0.001))
    w.part("ram", ram, cap, tool)
    w.slide("ram", "carriage", (0, 0, -1), stroke, pivot=(0, -0.09, low))
    w.settle()


@kind(
    words="parallel gripper, parallel jaw gripper, claw, robot gripper, grasper",
    carved_from="metal",
    fingers=whole(2, 6, default=2, usual=(2, 4), help="Two are parallel jaws.", words="finger, jaw"),
    width=length(0.06, 0.5, default=0.12, usual=(0.08, 0.16), help="Of two jaws."),
    finger=length(0.05, 0.3, default=0.07, usual=(0.06, 0.1), help="Its length."),
    joints=whole(1, 2, drawn=False, help="Of every finger; parallel jaws have one.", words="knuckle"),
)
def gripper(
    w: ObjectBuilder, fingers: int, width: float, finger: float, joints: int, open: float, clearance: float
) -> None:
    """Grippers: parallel jaws on a rail, or fingers on pins around a palm."""
    half = 0.5 * width
    if fingers == 2 and joints == 1:
        w.part("palm", jaw_rail(half))
        jaws(w, clearance, at((0, 0, 0)), "palm", "finger", half, finger, open)
    else:
        w.part("palm", finger_palm(fingers))
        fingered(w, clearance, at((0, 0, 0)), "palm", "finger", fingers, finger, open, joints)
    w.settle()


@kind(
    words=(
        "robot hand, robotic hand, dexterous hand, humanoid hand, prosthetic hand, anthropomorphic hand, hand "
        "prosthesis, bionic hand"
    ),
    title="robot hand",
    fingers=whole(1, 8, usual=(2, 5), help="Side by side.", words="finger"),
    joints=whole(1, 5, usual=(2, 4), help="Of every finger.", words="joint, phalanx, segment, knuckle"),
    phalanx=length(0.02, 0.2, default=0.045, usual=(0.035, 0.06), help="First phalanx."),
    finger_width=length(0.01, 0.06, default=0.018, usual=(0.014, 0.022), help="Width."),
    carved_from="plastic",
)
def hand(
    w: ObjectBuilder, fingers: int, joints: int, phalanx: float, finger_width: float, open: float, clearance: float
) -> None:
    """Robot hands: a palm with fingers of phalanges on pins, straight at zero."""
    shares = (1.0, 0.72, 0.62)  # length of a phalanx beside the first one
    tight = min(clearance, 0.04 * finger_width)
    radius = 0.4 * finger_width
    pitch = 1.4 * finger_width
    half = 0.5 * pitch * fingers
    level = 0.09
    w.part("palm", slab(half, radius, (0, level - 2 * radius)), cylinder(1.5 * radius, -0.04, 0.01))
    for finger in range(fingers):
        x = (finger - 0.5 * (fingers - 1)) * pitch
        z = level
        parent = "palm"
        for k in range(joints):
            name = f"finger_{finger + 1}_{k + 1}"
            forked, tongue = [solid.translate((x, 0, z)) for solid in fork(finger_width, radius, tight, 2.2 * radius)]
            w.part(parent, forked)
            length = max(phalanx * shares[min(k, 2)], 6.0 * radius)
            top = z + length - (2 * radius if k + 1 < joints else radius)
            solids = [
                tongue,
                slab((x - 0.5 * finger_width, x + 0.5 * finger_width), radius, (z + fork_room(radius, tight), top)),
            ]
            if k + 1 == joints:
                solids = [*solids, cylinder(radius, (x - 0.5 * finger_width, x + 0.5 * finger_width), 0, top)]
            w.part(name, solids)
            w.hinge(name, parent, (1, 0, 0), (x, 0, z), 1.5, rest=open * 1.5)
            parent, z = (name, z + length)
    w.settle()
