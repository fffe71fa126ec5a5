"""KV2xx: masses, limits and collision geometry as declared."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check
from kinematify.validation.finding import Blame, Severity

CHECKS: tuple[Check, ...] = (
    Check(
        id="KV201",
        title="Bodies that move have a mass",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies=(
            "Of the links that fixed joints hold together, at least one has an <inertial>. Where no body of the file "
            "has one, that is one finding."
        ),
        matters=(
            "Without it PyBullet takes 1 kg, MuJoCo the mass of the hull, Pinocchio nothing: no two engines move the "
            "model alike. MuJoCo refuses a body without mass and geometry."
        ),
        remedy="Add an <inertial> to the link; 100 to 1000 kg/m3 times its volume is a start.",
    ),
    Check(
        id="KV202",
        title="Masses are above zero",
        severity=Severity.ERROR,
        blame=Blame.PHYSICS,
        verifies=(
            "No mass is zero or negative. Zero is allowed for a frame that is fixed to something with a mass, a note "
            "for scenery without joints, and a warning where the link does not move or others of its body have a mass."
        ),
        matters="MuJoCo refuses such a body if it moves; PyBullet freezes it where it is.",
        remedy="Write the true mass in kilograms.",
    ),
    Check(
        id="KV203",
        title="Masses are plausible",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="The mass of every body with geometry lies between `tiny_mass` and `huge_mass`.",
        matters="Placeholders and grams for kilograms make contacts stiff and motions absurd.",
        remedy="Write the true mass in kilograms.",
    ),
    Check(
        id="KV204",
        title="Inertia tensors are positive definite",
        severity=Severity.ERROR,
        blame=Blame.PHYSICS,
        verifies=(
            "All principal moments of inertia are above zero. It is a warning for bodies that do not move, and where "
            "some moments are zero and none is negative."
        ),
        matters="MuJoCo refuses the model; PyBullet takes the inertia for zero and the simulation blows up.",
        remedy="Compute the tensor from the geometry; the finding names the values of a box of the same size.",
    ),
    Check(
        id="KV205",
        title="Principal moments satisfy the triangle inequality",
        severity=Severity.ERROR,
        blame=Blame.PHYSICS,
        verifies=(
            "No principal moment is larger than the sum of the other two: an error above `moment_ratio` times the sum "
            "for bodies that move, a note below `moment_rounding`, a warning otherwise."
        ),
        matters="No distribution of mass has such moments: MuJoCo refuses them, PyBullet takes the inertia for zero.",
        remedy="Compute the tensor from the geometry, or write it with more digits.",
    ),
    Check(
        id="KV206",
        title="Densities are plausible",
        severity=Severity.ERROR,
        blame=Blame.PHYSICS,
        verifies=(
            "The mass of a body over the volume of its hull is not above `dense` (an error above `impossibly_dense`), "
            "and over the volume inside its surfaces not below `light`."
        ),
        matters="The mass or the unit of the meshes is wrong, and with it every force.",
        remedy="Correct the mass, or the scale of the geometry.",
    ),
    Check(
        id="KV207",
        title="Inertia fits the geometry",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies=(
            "The largest radius of gyration lies between `gyration_small` and `gyration_large` times the distance of "
            "the outermost point of the body from the centre of mass."
        ),
        matters="An inertia copied from another link, or in another unit, makes joints sluggish or nervous.",
        remedy="Compute the tensor from the geometry.",
    ),
    Check(
        id="KV208",
        title="Centres of mass lie in the geometry",
        severity=Severity.ERROR,
        blame=Blame.PHYSICS,
        verifies=(
            "The centre of mass lies in the hull of the body, inflated by `centre_outside` of its diagonal; beyond "
            "`centre_far` it is an error."
        ),
        matters="Gravity turns the part the wrong way, and joints need torques that they do not need in truth.",
        remedy="Correct the <origin> of the <inertial>: its unit, or the frame that it is meant in.",
    ),
    Check(
        id="KV209",
        title="Neighbours have comparable masses",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="No body that moves carries one that is more than `mass_ratio` times as heavy.",
        matters="Solvers need tiny time steps for a heavy body on a light one, or shake.",
        remedy="Check both masses.",
    ),
    Check(
        id="KV220",
        title="Ranges of joints are plausible",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies=(
            "No hinge turns by more than `widest_turn` (a warning from `full_turn` on, unless both limits are round "
            "numbers of degrees; a warning beyond `endless`, where no limit was meant). No slide moves by more than "
            "`widest_slide` or `slide_sizes` times the size of the model; beyond `slide_wrong` times it is an error."
        ),
        matters="Degrees for radians and millimetres for metres load in every engine, and the joint then moves freely.",
        remedy="Write radians and metres; the finding names the converted values.",
    ),
    Check(
        id="KV221",
        title="Ranges of joints are not empty",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="The lower limit of a revolute or prismatic joint is below the upper one.",
        matters="MuJoCo and Pinocchio take equal limits for none, PyBullet locks the joint.",
        remedy="Write the true range, or make the joint fixed.",
    ),
    Check(
        id="KV222",
        title="Zero lies within the limits",
        severity=Severity.NOTE,
        blame=Blame.KINEMATICS,
        verifies="Zero is a value that the joint may take.",
        matters="Engines and viewers start at zero, which is then outside the limits.",
        remedy="Start from a configuration within the limits.",
    ),
    Check(
        id="KV223",
        title="Joints state effort and velocity",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="Effort and velocity of every joint with a <limit> are there and above zero.",
        matters="Pinocchio and ROS refuse a limit without them; with zero no controller moves the joint.",
        remedy="Write what the drive can do; for a passive joint what it can bear.",
    ),
    Check(
        id="KV224",
        title="Damping and friction are plausible",
        severity=Severity.ERROR,
        blame=Blame.PHYSICS,
        verifies=(
            "Neither is negative; neither is above `damping` (a warning), and friction is below effort (a warning)."
        ),
        matters="Negative damping makes energy out of nothing; friction above the effort locks the joint.",
        remedy="Write zero, or what was measured.",
    ),
    Check(
        id="KV225",
        title="Mimic joints stay within their limits",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="While the leader goes through its range, the follower stays within its own, to `mimic_slack`.",
        matters="The coupling pushes the follower against its stop, and the engine lets the two fight.",
        remedy="Make the limits of both joints agree with multiplier and offset.",
    ),
    Check(
        id="KV226",
        title="Joints can bear the weight",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies=(
            "The torque or force of gravity at a joint, the worst of rest and some sampled configurations with the "
            "root fixed and gravity along -z, is below its effort; within a factor of `margin` it is a note."
        ),
        matters="A joint that cannot hold its load sags in every controlled simulation.",
        remedy="Check the masses beyond the joint and its effort.",
    ),
    Check(
        id="KV240",
        title="Links have collision geometry",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies=(
            "Every body with geometry has collision geometry, and so has each of its links that stands out of the rest "
            "by `bare_share` of its size (others are a note, unless they are fewer than `bare_minority` of all links). "
            "Where no link of the file has any, that is one finding."
        ),
        matters="Grippers and other parts pass through the link in every engine.",
        remedy="Copy the <visual> to a <collision>, or write a simpler shape.",
    ),
    Check(
        id="KV241",
        title="Collision geometry stands where it is seen",
        severity=Severity.ERROR,
        blame=Blame.PHYSICS,
        verifies=(
            "The bounding box of the collision geometry is not shifted against that of the visual one by more than "
            "`shift` of its diagonal (`shift_same` if both have the same size; from `shift_wrong` on that is an "
            "error), and does not reach `beyond` it. Coarse shapes and shapes of a part of the link are fine."
        ),
        matters="The model collides with what nobody sees, and is not stopped by what everybody sees.",
        remedy="Correct the <origin> of the <collision>.",
    ),
    Check(
        id="KV242",
        title="Collision meshes are nearly convex",
        severity=Severity.NOTE,
        blame=Blame.PHYSICS,
        verifies="The hull of a closed collision mesh has at most `inflation` times its volume.",
        matters=(
            "MuJoCo and PyBullet collide the hull: a drawer cannot enter a cabinet that is one mesh. Kinematify cuts "
            "such meshes into convex pieces for its own runs."
        ),
        remedy="Cut the mesh into convex pieces and write each as a <collision>.",
    ),
    Check(
        id="KV243",
        title="Amount of collision geometry",
        severity=Severity.NOTE,
        blame=Blame.PHYSICS,
        verifies="No link has more than `collision_shapes` shapes or `collision_faces` triangles to collide with.",
        matters="Contacts take most of the time of a simulation.",
        remedy="Use fewer and simpler shapes.",
    ),
)
