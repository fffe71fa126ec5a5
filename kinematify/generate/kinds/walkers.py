"""Robots with legs, carved."""

from __future__ import annotations

from math import asin, cos, pi, sin

import numpy as np
from manifold3d import Manifold

from kinematify.generate.kinds.limbs import leg_solids, limb_solids
from kinematify.generate.library.kind import choice, kind, length, whole
from kinematify.generate.procedural.builder import ObjectBuilder
from kinematify.generate.procedural.pieces.bearing_pieces import at, fork, fork_room, stub
from kinematify.generate.procedural.solids import Point, ball, box, cylinder, hull, off, rod, slab, vector


@kind(
    words=("robot dog, dog robot, four legged robot, quadruped robot, robot cat, robotic dog, mechanical dog"),
    title="robot on four legs",
    carved_from="metal",
    joints=whole(2, 3, default=3, help="Of every leg.", words="joint, joint per leg, dof"),
    length=length(0.25, 2.0, default=0.4, usual=(0.3, 0.7), help="Of the trunk."),
    width=length(0.14, 1.0, default=0.18, usual=(0.16, 0.3), help="Of the trunk."),
    thigh=length(0.15, 0.6, default=0.2, usual=(0.16, 0.28), help="Its length."),
    shank=length(0.12, 0.6, default=0.2, usual=(0.16, 0.28), help="Its length."),
    joint_radius=length(0.02, 0.05, default=0.03, usual=(0.024, 0.034), help="Of the stubs."),
)
def quadruped(
    w: ObjectBuilder,
    joints: int,
    length: float,
    width: float,
    thigh: float,
    shank: float,
    joint_radius: float,
    clearance: float,
) -> None:
    """Robots on four legs: a trunk and legs of two or three joints on flanged stubs."""

    # How far hips roll inwards, and thighs and shanks swing, until two legs could meet [rad].
    def swings_of() -> Point:
        leg = thigh + shank
        beside = 0.5 * width
        between = length + 0.04
        thigh_2 = asin(min(sin(0.8), between / leg))
        return (min(0.2, beside / leg), thigh_2, asin(min(sin(1.2), between / shank)))

    half = 0.5 * length
    wide = 0.5 * width
    lengths = (thigh, shank)
    high = lengths[0] + lengths[1] + 0.5 * joint_radius
    w.part(
        "trunk",
        slab(half, wide, (high - 1.3 * joint_radius, high + 1.7 * joint_radius)),
        slab((half - 0.05, half + 0.03), 0.03, (high + joint_radius, high + 2.7 * joint_radius)),
    )
    for leg, side in (
        ("front_left", (1, 1)),
        ("front_right", (1, -1)),
        ("rear_left", (-1, 1)),
        ("rear_right", (-1, -1)),
    ):
        hip = vector(side[0] * (half + 0.02), side[1] * (wide - joint_radius), high)
        boss, hole, links, pivots = leg_solids(clearance, hip, side, joint_radius, lengths)
        w.part("trunk", boss)
        w.cut("trunk", hole)
        above = "trunk"
        roll, its_thigh, its_shank = swings_of()
        if joints > 2:
            w.part(f"{leg}_hip", links["hip"])
            most, least = (0.5, -roll) if side[1] > 0 else (roll, -0.5)
            w.hinge(f"{leg}_hip", "trunk", (1, 0, 0), pivots[0], most, least)
            above = f"{leg}_hip"
        else:
            hip_2 = pivots[0]
            w.part(
                "trunk",
                links["hip"],
                cylinder(joint_radius, off(hip_2, -joint_radius, 0, 0), off(hip_2, joint_radius, 0, 0)),
            )
        w.part(f"{leg}_thigh", links["thigh"])
        w.hinge(f"{leg}_thigh", above, (0, 1, 0), pivots[1], its_thigh, -its_thigh)
        w.part(f"{leg}_shank", links["shank"])
        w.hinge(f"{leg}_shank", f"{leg}_thigh", (0, 1, 0), pivots[2], its_shank, -its_shank)
    w.settle()


@kind(
    words=(
        "six legged robot, spider robot, robot spider, hexapod robot, insect robot, robot ant, robot insect, robotic "
        "spider, ant robot, beetle robot"
    ),
    title="robot on six legs",
    legs=whole(4, 8, usual=(6, 8), help="Around the trunk.", words="leg"),
    joints=whole(2, 3, default=3, help="Of every leg.", words="joint, joint per leg, dof"),
    trunk=length(0.12, 1.0, default=0.2, usual=(0.14, 0.3), help="Its diameter."),
    femur=length(0.1, 0.5, default=0.12, usual=(0.1, 0.18), help="Its length."),
    tibia=length(0.12, 0.5, default=0.16, usual=(0.13, 0.22), help="Its length."),
    joint_radius=length(0.012, 0.025, default=0.018, usual=(0.015, 0.02), help="Of the stubs."),
    carved_from="plastic",
)
def hexapod(
    w: ObjectBuilder,
    legs: int,
    joints: int,
    trunk: float,
    femur: float,
    tibia: float,
    joint_radius: float,
    clearance: float,
) -> None:
    """Robots on six legs, or four to eight, that stand around a round trunk."""
    # outwards: turns a leg that hangs down, its first joint along x, to reach out along x, that joint upright.
    outwards = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    lengths = (femur, tibia)
    high = lengths[1] - 1.5 * joint_radius - clearance
    ring = max(0.5 * trunk, 3.5 * joint_radius / sin(pi / legs))
    plate = ((0, 0, high - 1.4 * joint_radius), (0, 0, high - 0.2 * joint_radius))
    w.part(
        "trunk",
        cylinder(ring + 0.4 * joint_radius, *plate),
        ball(0.5 * ring, (0, 0, high - 0.2 * joint_radius)).trim_by_plane((0, 0, 1), high - joint_radius),
    )
    for k in range(legs):
        angle = 2.0 * pi * (k + 0.5) / legs
        cosine = cos(angle)
        sine = sin(angle)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        place = at((ring * cosine, ring * sine, high), turn @ outwards)
        # A coxa on an upright joint, a femur that reaches out and a tibia that reaches down.
        leg = f"leg_{k + 1}"
        lengths_2 = (femur, tibia)
        boss, hole, links, pivots = leg_solids(clearance, np.zeros(3), (1, 1), joint_radius, lengths_2)
        knee = pivots[2]
        shank = links["shank"].translate(-knee).rotate((0, 90, 0)).translate(knee)
        coxa, its_femur, its_tibia = [link.transform(place) for link in (links["hip"], links["thigh"], shank)]
        upright, femur_at, tibia_at = [place @ (*pivot, 1.0) for pivot in pivots]
        w.part("trunk", boss.transform(place))
        w.cut("trunk", hole.transform(place))
        above = "trunk"
        across = -place[:, 1]
        if joints > 2:
            above = f"{leg}_coxa"
            w.part(above, coxa)
            w.hinge(above, "trunk", (0, 0, 1), upright, 0.3, -0.3)
        else:
            w.part(
                "trunk",
                coxa,
                cylinder(joint_radius, off(upright, 0, 0, -joint_radius), off(upright, 0, 0, joint_radius)),
            )
        w.part(f"{leg}_femur", its_femur)
        w.hinge(f"{leg}_femur", above, across, femur_at, 0.8, -0.3)
        w.part(f"{leg}_tibia", its_tibia)
        w.hinge(f"{leg}_tibia", f"{leg}_femur", across, tibia_at, 0.9, -0.35)
    w.settle()


@kind(
    words=(
        "humanoid robot, android, biped, bipedal robot, person shaped robot, toy robot, robot toy, robot figure, robot "
        "man, toy humanoid"
    ),
    title="robot with arms and legs",
    thigh=length(0.25, 0.6, default=0.36, usual=(0.3, 0.42), help="Its length."),
    shank=length(0.25, 0.6, default=0.36, usual=(0.3, 0.42), help="Its length."),
    torso=length(0.3, 0.7, default=0.42, usual=(0.36, 0.5), help="Its height."),
    shoulders=length(0.36, 0.9, default=0.5, usual=(0.44, 0.56), help="Their width."),
    upper_arm=length(0.16, 0.45, default=0.26, usual=(0.22, 0.3), help="Its length."),
    forearm=length(0.15, 0.4, default=0.22, usual=(0.2, 0.28), help="Its length."),
    joint_radius=length(0.02, 0.036, usual=(0.022, 0.032), help="Of the stubs."),
    feet=choice({"feet": "foot", "none": ""}, help="Feet on ankles."),
    hands=choice(("turning", "fixed"), help="Of the palms about the forearms."),
    carved_from="plastic",
)
def humanoid(
    w: ObjectBuilder,
    thigh: float,
    shank: float,
    torso: float,
    shoulders: float,
    upper_arm: float,
    forearm: float,
    joint_radius: float,
    feet: str,
    hands: str,
    clearance: float,
) -> None:
    """Robots with legs, arms and a head. They look along x, as robots do."""
    the_sole = 1.6  # of the ankles over the floor, in joint radii
    # Half the distance of the shoulders' pivots [m].
    shoulder = max(0.5 * shoulders, 8.5 * joint_radius)

    # How far a leg rolls inwards until it meets the other one, and outwards until it meets a hand [rad].
    def roll() -> tuple[float, float]:
        inwards = min(0.1, 2.2 * joint_radius / (thigh + shank))
        room = shoulder - 7.4 * joint_radius - 2.0 * clearance
        arm = upper_arm + forearm + 5.0 * joint_radius
        below = arm - torso - 2.2 * joint_radius
        return (inwards, 0.4 if below <= 0.0 else min(0.4, 0.9 * room / (below + joint_radius)))

    # A block from x and z to x and z, between two y in any order.
    def between(lower: tuple[float, float], upper: tuple[float, float], one: float, other: float) -> Manifold:
        y0, y1 = sorted((one, other))
        return box((lower[0], y0, lower[1]), (upper[0], y1, upper[1]))

    hip = thigh + shank + (the_sole if feet == "feet" else 0.5) * joint_radius
    wide = 1.6 * joint_radius
    back = -2.0 * joint_radius - clearance
    top = hip + 3.6 * joint_radius
    w.part(
        "pelvis",
        slab((back - 2.0 * joint_radius, back), wide + joint_radius, (hip - 1.2 * joint_radius, top)),
        slab(
            (back - 2.0 * joint_radius, 2.0 * joint_radius), wide + 0.5 * joint_radius, (top - 0.8 * joint_radius, top)
        ),
    )
    for name, sy in (("left", 1), ("right", -1)):
        # Hip, thigh and shank, and a foot.
        lengths = (thigh, shank)
        boss, hole, links, pivots = leg_solids(clearance, vector(back, sy * wide, hip), (1, sy), joint_radius, lengths)
        w.part("pelvis", boss)
        w.cut("pelvis", hole)
        w.part(f"{name}_hip", links["hip"])
        inwards, outwards = roll()
        most, least = (outwards, -inwards) if sy > 0 else (inwards, -outwards)
        w.hinge(f"{name}_hip", "pelvis", (1, 0, 0), pivots[0], most, least)
        w.part(f"{name}_thigh", links["thigh"])
        w.hinge(f"{name}_thigh", f"{name}_hip", (0, -1, 0), pivots[1], 1.2, -0.6)
        w.part(f"{name}_shank", links["shank"])
        w.hinge(f"{name}_shank", f"{name}_thigh", (0, 1, 0), pivots[2], 1.8)
        if feet == "feet":
            # A sole beside the end of a shank, on a stub through it.
            ankle = off(pivots[2], 0, -sy * (0.8 * joint_radius + clearance), -lengths[1])
            small = 0.6 * joint_radius
            pivot = off(ankle, 0, sy * small, 0)
            boss_2, hole_2, rotor = stub(pivot, (0, sy, 0), small, clearance, length=2.0 * small)
            w.part(f"{name}_shank", boss_2)
            w.cut(f"{name}_shank", hole_2)
            outer = pivot[1] + sy * (2.0 * small + clearance)
            inner = pivot[1] + sy * (0.4 * small + clearance)
            strut = between((-0.5 * joint_radius, 0.2 * joint_radius), (0.5 * joint_radius, ankle[2]), inner, outer)
            sole = between(
                (-2.2 * joint_radius, 0.0),
                (4.2 * joint_radius, 0.4 * joint_radius),
                ankle[1] - sy * 1.2 * joint_radius,
                outer,
            )
            w.part(f"{name}_foot", rotor, strut, sole, look="rubber")
            w.hinge(f"{name}_foot", f"{name}_shank", (0, 1, 0), pivot, 0.5, -0.5)
    # A torso that turns on the pelvis, its head and its arms.
    half = shoulder
    waist = (-joint_radius, 0.0, top)
    x = -joint_radius
    boss_3, hole_3, rotor_2 = stub(waist, (0, 0, 1), 1.6 * joint_radius, clearance, length=joint_radius)
    w.part("pelvis", boss_3)
    w.cut("pelvis", hole_3)
    low = top + 1.5 * joint_radius
    high = top + torso
    side = half - 3.2 * joint_radius
    trunk = hull(
        slab((x - 1.5 * joint_radius, x + 1.5 * joint_radius), 0.6 * side, (low - 0.7 * joint_radius, low)),
        slab((x - 2.0 * joint_radius, x + 2.2 * joint_radius), side, (high - 0.5 * torso, high)),
    )
    w.part("torso", rotor_2, trunk)
    w.hinge("torso", "pelvis", (0, 0, 1), waist, 1.2, -1.2)
    pivot_2 = off((x, 0.0, high), 0, 0, joint_radius)
    boss_4, hole_4, rotor_3 = stub(pivot_2, (0, 0, 1), joint_radius, clearance)
    w.part("torso", boss_4)
    w.cut("torso", hole_4)
    centre = off(pivot_2, 0.2 * joint_radius, 0, 3.6 * joint_radius)
    size = 2.0 * joint_radius
    skull = hull(ball(size, centre), ball(0.7 * size, off(centre, 0.5 * size, 0, -0.6 * size)))
    eyes = [ball(0.18 * size, off(centre, 0.95 * size, s * 0.4 * size, 0.1 * size)) for s in (-1, 1)]
    w.part("head", rotor_3, cylinder(0.8 * joint_radius, off(pivot_2, 0, 0, 0.5 * joint_radius), centre), skull, eyes)
    w.hinge("head", "torso", (0, 0, 1), pivot_2, 1.2, -1.2)
    for name_2, sy_2 in (("left", 1), ("right", -1)):
        shoulder_2 = vector(x, sy_2 * half, high - 1.4 * joint_radius)
        w.part("torso", cylinder(joint_radius, off(shoulder_2, 0, -sy_2 * half, 0), shoulder_2))
        # Upper arm, forearm and a hand that turns about the forearm.
        lengths_2 = (upper_arm, forearm)
        boss, hole, upper, lower, elbow, wrist = limb_solids(clearance, shoulder_2, sy_2, joint_radius, lengths_2)
        w.part("torso", boss)
        w.cut("torso", hole)
        w.part(f"{name_2}_upper_arm", upper)
        w.hinge(f"{name_2}_upper_arm", "torso", (0, -1, 0), shoulder_2, 2.6, -0.8)
        w.part(f"{name_2}_forearm", lower)
        w.hinge(f"{name_2}_forearm", f"{name_2}_upper_arm", (0, -1, 0), elbow, 2.0)
        small_2 = 0.6 * joint_radius
        end = off(wrist, 0, 0, -0.6 * joint_radius)
        palm = [off(end, 0, 0, -z * joint_radius - clearance) for z in (1.0, 2.4)]
        hand = hull(
            *[
                rod(0.3 * joint_radius, off(p, -0.6 * joint_radius, 0, 0), off(p, 0.6 * joint_radius, 0, 0))
                for p in palm
            ]
        )
        thumb = rod(
            0.25 * joint_radius,
            off(palm[0], 0.6 * joint_radius, 0, 0),
            off(palm[1], 1.3 * joint_radius, 0, 0.3 * joint_radius),
        )
        if hands == "fixed":
            w.part(f"{name_2}_forearm", hand, thumb, cylinder(small_2, wrist, off(end, 0, 0, -joint_radius)))
        else:
            boss_5, hole_5, rotor_4 = stub(end, (0, 0, -1), small_2, clearance, length=1.2 * small_2)
            w.part(f"{name_2}_forearm", boss_5)
            w.cut(f"{name_2}_forearm", hole_5)
            w.part(f"{name_2}_hand", rotor_4, hand, thumb)
            w.hinge(f"{name_2}_hand", f"{name_2}_forearm", (0, 0, 1), end, 1.4, -1.4)
    w.settle()


@kind(
    words=(
        "snake robot, worm robot, chain robot, snake arm, caterpillar robot, inchworm robot, tentacle, "
        "tentacle robot, toy snake"
    ),
    title="snake robot",
    segments=whole(2, 40, default=8, usual=(4, 10), help="In a row.", words="segment, module, link"),
    radius=length(0.01, 0.2, default=0.03, usual=(0.02, 0.05), help="Of the body."),
    segment=length(0.05, 1.0, default=0.15, usual=(0.12, 0.25), help="Its length."),
    carved_from="plastic",
)
def snake(w: ObjectBuilder, segments: int, radius: float, segment: float, clearance: float) -> None:
    """Snake robots: segments on hinges that turn about the upright and across it in turn."""
    the_size = 0.45  # radius of a hinge beside that of the body
    length = segment
    tight = min(clearance, 0.03 * radius)
    size = the_size * radius
    space = fork_room(size, tight)
    length = max(length, 8.0 * size)
    for k in range(segments):
        start = k * length
        end = (k + 1) * length
        first = k == 0
        last = k + 1 == segments
        name = f"segment_{k + 1}"
        body = cylinder(
            radius,
            (
                start + (0.0 if first else 1.6 * space + 0.5 * radius),
                end - (0.0 if last else 1.6 * space + 0.5 * radius),
            ),
            0,
            radius,
        )
        w.part(name, body)
        if not first:
            # Join segment k to segment k + 1 at x: a fork on the one, a tongue on the other.
            upright = k % 2 == 0
            size_2 = the_size * radius
            forked, tongue = fork(1.6 * radius, size_2, tight, 1.8 * size_2 + 0.9 * radius)
            lay = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
            if upright:
                lay = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
            place = np.column_stack([lay, (start, 0.0, radius)])
            reach = tongue.transform(place)
            w.part(f"segment_{k}", forked.transform(place))
            w.part(f"segment_{k + 1}", reach)
            axis = (0, 0, 1) if upright else (0, 1, 0)
            w.hinge(f"segment_{k + 1}", f"segment_{k}", axis, (start, 0, radius), 0.7, -0.7)
    w.part("segment_1", rod(0.8 * radius, (0, -0.6 * radius), 0, radius))
    w.settle()
