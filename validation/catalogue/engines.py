"""KV4xx and KV5xx: behaviour in MuJoCo and PyBullet; the same checks in both, so that the engines can be compared."""

from __future__ import annotations

from dataclasses import dataclass

from kinematify.validation.catalogue.check import Check
from kinematify.validation.finding import Blame, Severity


@dataclass(frozen=True, kw_only=True)
class _Kind:
    """A check of both engines; ``{engine}`` stands for the engine's name."""

    number: str
    """Last two digits of the id."""
    title: str
    severity: Severity
    blame: Blame
    verifies: str
    matters: str
    remedy: str
    mujoco: str = ""
    """What is peculiar to the engine, added to `verifies`."""
    pybullet: str = ""


def _in_both_engines(kind: _Kind) -> tuple[Check, Check]:
    """Return the entry of each engine."""
    return (
        _entry(kind, "KV4", "mujoco", "MuJoCo", kind.mujoco),
        _entry(kind, "KV5", "pybullet", "PyBullet", kind.pybullet),
    )


def _entry(kind: _Kind, family: str, key: str, engine: str, peculiar: str) -> Check:
    return Check(
        id=family + kind.number,
        title=kind.title,
        severity=kind.severity,
        blame=kind.blame,
        engines=(key,),
        verifies=" ".join([kind.verifies, peculiar]).strip().replace("{engine}", engine),
        matters=kind.matters.replace("{engine}", engine),
        remedy=kind.remedy.replace("{engine}", engine),
    )


_KINDS = (
    _Kind(
        number="01",
        title="loads with the same joints, masses and limits",
        severity=Severity.ERROR,
        blame=Blame.ENGINE,
        verifies="{engine} loads the model; every link and joint is there, with the type, axis, limits, mass and "
        "inertia of the file, within engines.same of each value.",
        matters="Importers drop, merge and replace silently: a lost limit or a mass of 1 kg out of nothing changes "
        "every simulation.",
        remedy="Mend what the engine's message names; write limits, masses and inertias in full.",
        mujoco="Links joined by fixed joints are kept apart.",
    ),
    _Kind(
        number="02",
        title="poses agree over the range",
        severity=Severity.ERROR,
        blame=Blame.ENGINE,
        verifies="At zero, at rest, at both ends of every joint and in quasi-random configurations every link stands "
        "where the file's kinematics put it, within engines.pose_distance of the model's size and engines.pose_deg.",
        matters="A frame that the engine reads differently moves a part to another place without a message.",
        remedy="Write origins and axes as plain numbers, the axis as a unit vector; compare the frames of the link "
        "that the message names.",
    ),
    _Kind(
        number="03",
        title="starts without contact",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="At rest, no two links overlap by more than engines.contact_depth as the engine sees them (convex "
        "pieces). Links that a joint connects may overlap by what they have at rest; a note names them.",
        matters="An overlap at the start is pushed apart in the first steps: the model jumps or flies off.",
        remedy="Move the parts apart or shrink their collision geometry by the depth that is named; where a convex "
        "stand-in overlaps although the mesh does not, write convex pieces as collision geometry.",
        pybullet="The 1 mm by which PyBullet inflates meshes does not count.",
    ),
    _Kind(
        number="04",
        title="holds under gravity",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="Joints held by position servos, none stronger than its declared effort, sag by no more than "
        "engines.sag of the range. Without servos joints may fall, but none moves beyond its limits by more than "
        "engines.escape of its range.",
        matters="An arm that cannot carry itself collapses at the start of each episode.",
        remedy="Raise the effort above the torque that is named, or reduce the masses.",
        pybullet="PyBullet stops a joint one step after its limit and leaves it there; so much is not counted.",
    ),
    _Kind(
        number="05",
        title="driven through its range, each joint reaches both ends",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="One joint after the other is driven from rest to both ends by a position servo, the others held. "
        "Each must arrive within engines.reach of its range. A joint that its own base stops is an error if their "
        "collision geometry is what the file declares; where other neighbours or convex stand-ins are in the way it is "
        "a warning, and a note where parts are in the way that can move themselves: a robot reaches itself within its "
        "ranges. A tracking error above engines.tracking is a note.",
        matters="A drawer that does not open in the simulator is of no use, whatever its file says.",
        remedy="Correct axis, pivot or limit of the joint, so that the pair that is named stays clear; where convex "
        "stand-ins meet, write convex pieces as collision geometry.",
        pybullet="Pairs that touch at rest once meshes are inflated by 1 mm do not act on each other, "
        "since PyBullet would push them apart; the joint counts as stopped where they get deeper than allowed.",
    ),
    _Kind(
        number="06",
        title="little penetration while driven",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="While a joint is driven to an end that it reaches, no pair of links gets deeper into each other than "
        "at rest by more than twice engines.contact_depth, beyond what convex stand-ins of neighbours can exceed their "
        "meshes by.",
        matters="Parts that pass through each other teach a policy what reality does not allow.",
        remedy="Correct the joint, or the collision geometry of the pair.",
    ),
    _Kind(
        number="07",
        title="stable",
        severity=Severity.ERROR,
        blame=Blame.PHYSICS,
        verifies="No value becomes infinite or not a number, and nothing moves faster than engines.explosion times "
        "the speed of a free fall from the model's height, neither passive nor held nor driven.",
        matters="A blow-up ends an episode, and silently resets the state in some engines.",
        remedy="Correct masses and inertias (no link far lighter than what it carries), and overlaps at the start.",
    ),
    _Kind(
        number="08",
        title="energy does not grow",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="Released without servos, damping and friction, the sum of kinetic and potential energy stays within "
        "engines.energy of the energy that moves.",
        matters="Growing energy comes from inertias that cannot be or from contacts that push: the motion is not "
        "physical and explodes in longer runs.",
        remedy="Correct the inertia tensors and the overlaps at the start, or reduce the time step.",
        pybullet="It is simulated with a quarter of the usual time step.",
    ),
    _Kind(
        number="09",
        title="limits hold",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="At its end, a joint whose servo pulls on past the limit (by engines.push of the range) gets no "
        "farther beyond it than engines.escape of the range.",
        matters="A door that is pushed through its stop ends up in its frame.",
        remedy="Write a range that is not much smaller than the part's motion, and a plausible inertia: very light "
        "parts slip through soft stops.",
    ),
    _Kind(
        number="10",
        title="no warnings of the engine",
        severity=Severity.WARNING,
        blame=Blame.ENGINE,
        verifies="Loading and all runs give none of the engine's own warnings; those that tell nothing about the model "
        "are left out.",
        matters="Engines warn once in a log that nobody reads and go on with a reset state or dropped contacts.",
        remedy="Each message is given; begin with inertias and overlaps.",
        mujoco="Its counters are read after each run: bad positions, velocities, accelerations, full contact or "
        "constraint buffers.",
        pybullet="What it has printed is read.",
    ),
    _Kind(
        number="11",
        title="settles on the floor",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="Let go of engines.drop above a plane with its joints held, the model comes to rest within "
        "engines.drop_seconds and sinks in by less than engines.sink.",
        matters="An object that sinks, trembles or rolls away cannot be placed in a scene.",
        remedy="Give the parts that touch the floor closed collision geometry, and plausible masses.",
    ),
    _Kind(
        number="12",
        title="the time step is small enough",
        severity=Severity.NOTE,
        blame=Blame.PHYSICS,
        verifies="Falling freely from rest, joints move the same way with a quarter of the time step, within "
        "engines.step_difference of their motion.",
        matters="Where the result depends on the time step, it is an artefact.",
        remedy="Correct masses and inertias of the joint that is named, or simulate with a smaller time step.",
    ),
)

CHECKS: tuple[Check, ...] = tuple(
    sorted((check for kind in _KINDS for check in _in_both_engines(kind)), key=lambda check: check.id)
)
