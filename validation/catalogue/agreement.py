"""KV6xx: do the engines and the analytical model agree?."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check
from kinematify.validation.finding import Blame, Severity

CHECKS: tuple[Check, ...] = (
    Check(
        id="KV601",
        title="Links stand where they should, in every engine",
        severity=Severity.ERROR,
        blame=Blame.ENGINE,
        verifies="Forward kinematics of MuJoCo, PyBullet, Pinocchio and Kinematify in the same configurations: zero, "
        "rest, both ends of every joint and quasi-random ones. A joint whose child stands elsewhere relative to its "
        "parent by more than agreement.position (times the size of the model) or agreement.angle is an error, so is a "
        "link that an engine has lost.",
        matters="A policy that was trained in one engine fails in another where a link stands elsewhere.",
        remedy="Write the joint with a unit axis, plain decimal numbers and a type that every engine knows.",
    ),
    Check(
        id="KV602",
        title="Mass matrix: MuJoCo and Pinocchio agree",
        severity=Severity.WARNING,
        blame=Blame.ENGINE,
        verifies="The joint-space inertia of the tree in the same configurations, entry by entry, relative to the "
        "inertias of the two joints that it couples; more than agreement.mass_matrix is a warning at the joint where "
        "it begins.",
        matters="An engine that has changed an inertia moves the joint with another acceleration.",
        remedy="Write inertias that a rigid body can have: positive, and no moment above the sum of the others.",
    ),
    Check(
        id="KV603",
        title="Gravity torques: MuJoCo and Pinocchio agree",
        severity=Severity.WARNING,
        blame=Blame.ENGINE,
        verifies="The torques and forces that hold the model still, relative to the largest that the joint sees; more "
        "than agreement.gravity is a warning at the joint farthest from the root that shows it.",
        matters="Motors that were chosen with one engine's torques do not hold the model in the other.",
        remedy="Check mass and centre of mass of the links that hang on the joint.",
    ),
    Check(
        id="KV604",
        title="Engines see the same collisions",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="Pairs of links that overlap in one engine by more than agreement.contact_depth and do not touch in "
        "the other, and either against the exact geometry, in the same configurations.",
        matters="A motion that is free in one engine is blocked in the other: margins, hulls or lost shapes differ.",
        remedy="Give the two links collision geometry of boxes, cylinders, spheres or convex meshes.",
    ),
    Check(
        id="KV605",
        title="The model weighs the same everywhere",
        severity=Severity.ERROR,
        blame=Blame.ENGINE,
        verifies="The mass of each link and of the whole model in every engine against the file; a relative "
        "difference above agreement.mass_error is an error. Links without a mass in the file are left out.",
        matters="A mass that an engine drops or makes up changes every motion, and no message tells.",
        remedy="Give every link an <inertial> element with a mass above zero.",
    ),
)
