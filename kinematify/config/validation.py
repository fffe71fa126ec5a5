"""Thresholds of the checks: one class per family, each value with its reason."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kinematify.config import StageConfig, load, section
from kinematify.config.task_settings import TaskSettings

if TYPE_CHECKING:
    from pathlib import Path


class BudgetSettings(StageConfig):
    """Time and memory."""

    seconds: float = 120.0  # thirty times what the slowest stage takes on the largest known robots; --budget gives more
    """Processor time of each isolated stage with those that it comes after [s]; what is left over is not finished."""
    stage_bytes: int = 8000000000  # address space, not memory: torch and the engines map several GB that they never use
    """Address space of one isolated stage [bytes]."""


class FileSettings(StageConfig):
    """KV1xx: the file, the tree and the meshes."""

    max_elements: int = 300000  # the largest known robot has 4,000; parsing this many takes two seconds
    """XML elements of a file."""
    max_links: int = 1000  # MuJoCo needs 20 s for a chain of 2,000, Pinocchio crashes with 20,000
    """Links, and joints, of a model."""
    max_depth: int = 200  # the longest known chain has 30 joints; MuJoCo has a limit of its own above this
    """Joints one below the other."""
    max_mimic_chain: int = 50  # readers follow leaders recursively
    """Followers of followers."""
    max_line_bytes: int = 7800  # PyBullet reads lines of 7,899 bytes and fails at 8,279
    """Longer lines are a warning [bytes]."""
    max_name: int = 200  # PyBullet crashes with a name of 1,100 characters; file systems take 255
    """Longer names are a warning [characters]."""
    max_number: float = 1.0e6  # a thousand kilometres: double precision is down to 0.1 nm, floats in engines to 6 cm
    """Largest absolute value of any number, in its own unit."""
    max_angle: float = 6.3  # a whole turn, rounded up
    """Larger roll, pitch and yaw are a warning [rad]."""
    zero_axis: float = 1.0e-6  # shorter ones are rounding errors of an exporter
    """Axes of this length or shorter have no direction."""
    unit_axis_tolerance: float = 1.0e-5  # axes written with six digits
    """Deviation of the length of an axis from one that is not mentioned."""
    rounded_axis_tolerance: float = 0.01  # axes written with two digits turn a joint by less than 1 % too much
    """Deviation that is only a note."""
    zero_scale: float = 1.0e-9  # nanometres as metres
    """Absolute factors of a mesh scale up to here leave nothing."""
    max_mesh_bytes: int = 500000000  # 10 million triangles as binary STL
    """Larger mesh files are not opened [bytes]."""
    max_faces: int = 5000000  # about 1 GB in memory; the largest known robots have 1.5 million
    """Triangles of all mesh files together."""
    stl_faces: int = 200000  # limit of MuJoCo
    """Triangles that MuJoCo reads from an STL; meshes with more are a warning."""
    flat: float = 1.0e-6  # MuJoCo cannot make a hull of less, a sheet of metal has 1e-4
    """Thickness of a mesh that counts as flat, fraction of its diagonal."""
    oversize: float = 40.0  # at most 30 (the rail of a cart) in 190 models of robots and objects
    """Size of a link over that of the largest other link that only a slip of units explains."""
    undersize: float = 100.0  # at most 35 (a finger tip, a knob of a washing machine) in the same models
    """Size of the largest link over that of one with a mesh file that only a slip of units explains."""
    apart: float = 20.0  # at most 2.3 in the same models
    """Distance between a link and its parent over the sum of their sizes that only a slip of units explains."""
    tiny: float = 0.004  # a hand of 0.2 m that was taken for millimetres twice has 0.2 mm
    """Diagonal of the largest link below which the unit of a model is wrong [m]."""
    small: float = 0.015  # a wrist watch is larger
    """Diagonal of a model below which its unit is suspicious [m]."""
    large: float = 20.0  # a lorry with its trailer
    """Diagonal of a model above which its unit is suspicious [m]."""
    huge: float = 60.0  # a model in millimetres is 1,000 times too large, one in centimetres 100 times
    """Diagonal above which the unit of a model that moves is wrong [m]."""


class PhysicsSettings(StageConfig):
    """KV2xx: declared physics."""

    loop_gap: float = 1.0e-3  # clearances of pins are larger
    """Loops that are open by more are a warning, in sizes of the model."""
    tiny_mass: float = 1.0e-5  # 10 mg: the smallest screws of robots have 100 mg
    """Lighter bodies are a warning [kg]."""
    huge_mass: float = 10000.0  # the heaviest industrial arms
    """Heavier bodies are a warning [kg]."""
    dense: float = 22000.0  # osmium has 22,600
    """Denser hulls are a warning [kg/m^3]."""
    # a slip of units makes a thousand or a million of it; toys are published with 200,000
    impossibly_dense: float = 1.0e6
    """Denser hulls are an error [kg/m^3]."""
    light: float = 20.0  # foam; thin shells are open meshes most of the time and are not judged
    """Less dense solids are a warning [kg/m^3]."""
    moment_rounding: float = 1.01  # flat parts have equality, and files are written with few digits
    """Largest principal moment over the sum of the others that rounding explains."""
    moment_ratio: float = 1.5  # real robots are published with up to 1.26
    """The same, beyond which it is an error."""
    gyration_large: float = 1.5  # above 1 it is impossible; meshes are published without screws, motors and covers
    """Largest radius of gyration over the distance of the outermost point."""
    gyration_small: float = 0.03  # a dense motor in one end of a long cover has 0.1
    """Smallest value of the same."""
    copied_links: int = 3  # two alike are a pair; real twins have one size
    """Links with one mass and one inertia from which on they are placeholders where sizes differ."""
    copied_volume: float = 4.0  # legs of quadrupeds that share one inertia differ by 2, placeholders of an arm by 1800
    """Room of the largest of them over that of the smallest from which on sizes differ."""
    copied_share: float = 1.0e-3  # sensors and feet of quadrupeds have 1e-4 and less
    """Masses below this fraction of the model's are next to nothing on purpose."""
    listed: int = 4  # placeholders stand in every link of a file
    """More links with such an inertia are one finding."""
    centre_outside: float = 0.1  # motors stand out of simplified meshes
    """Centres of mass may lie so far outside the hull, fraction of the body's diagonal."""
    centre_far: float = 0.5
    """Beyond this it is an error, fraction of the body's diagonal."""
    frame_share: float = 0.05  # frames of tools and sensors have a gram, so that engines take them
    """Links without geometry are taken for frames up to this fraction of the body's mass."""
    full_turn: float = 6.4  # a whole turn, rounded up
    """Wider ranges of hinges are a warning unless they are round numbers of degrees [rad]."""
    widest_turn: float = 12.6  # two whole turns: wrists of arms turn once to each side
    """Wider ranges are an error [rad]."""
    widest_wrist: float = 18.0  # wrists of the largest arms turn by 455 degrees to each side
    """Wider ranges are an error even with round limits [rad]."""
    endless: float = 1500.0  # two whole turns to each side in degrees; more is a way to write that there is no limit
    """Wider ranges mean that there is no limit [rad]."""
    widest_slide: float = 5.0  # the longest gantries of laboratories
    """Longer ranges of slides are a warning [m]."""
    slide_sizes: float = 3.0  # drawers and lifts move by less than the model's size
    """The same, fraction of the model's diagonal."""
    slide_wrong: float = 10.0  # centimetres for metres
    """Longer ranges are an error, fraction of the model's diagonal."""
    mimic_slack: float = 0.01  # limits are written with two digits
    """Followers may go so far beyond their limits, fraction of their range, at least of 1 rad or m."""
    damping: float = 10000.0  # above this no motor moves a joint by 1 rad/s
    """Larger damping or friction is a warning [N m s/rad, N s/m, N m or N]."""
    load_doublings: int = 5
    """Two to this power configurations are sampled for the weight."""
    bare_share: float = 0.2  # plates and logos lie flush with what carries them
    """A link without collision geometry counts if it stands out so far of that of its body, fraction of its size."""
    bare_minority: float = 0.1  # one link of a robot: it was forgotten
    """It counts anyway if no larger share of the links has none."""
    marker: float = 0.01  # boxes of a millimetre mark frames
    """Smaller links may do without, fraction of the model's diagonal."""
    shift: float = 0.25  # simplified shapes of robots are off by up to 0.2
    """Displacement of the collision geometry, fraction of the visual diagonal."""
    shift_same: float = 0.02  # copies of the visual mesh are not off at all
    """The same where both are of the same size."""
    shift_wrong: float = 0.1
    """The same, beyond which it is an error."""
    same_size: float = 0.02
    """Extents that differ less are the same, fraction of the visual diagonal."""
    beyond: float = 0.5
    """How far collision geometry may reach beyond the visual one, fraction of the visual diagonal."""
    inflation: float = 1.5  # hollows of half the volume
    """Volume of a hull over that of its mesh."""


class PrepareSettings(StageConfig):
    """The file that engines are given: decomposition of concave collision meshes."""

    thickness: float = 1.0e-3  # MuJoCo makes no hull of a plane; sheets of furniture have more
    """Thickness that flat geometry is given, fraction of its diagonal."""
    least_thickness: float = 1.0e-4  # MuJoCo refuses meshes below 1e-15 m^3
    """The same, at least [m]."""
    corners: int = 128  # the outermost points of a ball in so many directions leave 1 % of its radius out
    """Vertices of the hull of a convex mesh at most."""
    link_gap: float = 0.02  # 2 cm on a door of 1 m; drawers and their boards come out exact
    """Pieces may reach so far beyond a mesh, fraction of its diagonal."""
    model_gap: float = 0.007  # 1 cm on a robot of 1.4 m: screw holes and ribs need no cuts
    """Or so far, whichever is more, fraction of the model's diagonal."""
    most_components: int = 40  # the carcass of a cabinet has up to 40 boards; more are screws and letters
    """Connected pieces of a mesh that are looked at one by one, the largest; the others count as one."""
    cuts: int = 48  # 15 ms each
    """Cuts through concave meshes of a model."""
    cuts_per_link: int = 4  # a humanoid has 24 links and some time
    """The same for models with many links."""
    cached_files: int = 1000  # 30 kB each
    """Cuts of so many models are kept for the next run; 0 keeps none."""
    frame_mass: float = 1.0e-6  # engines refuse zero; no sum of masses shows it
    """Of links that add nothing to the body that they are fixed to [kg]."""
    dummy_mass: float = 1.0e-3  # the links between the joints of a universal joint: light, yet no stiff equations
    """Of bodies without geometry and without mass [kg]."""
    ball_radius: float = 0.01  # a body of the size of a thumb
    """Radius of gyration of what has a mass and no geometry [m]."""
    moment_slack: float = 0.01  # flat parts have equality, and tensors are written with few digits
    """A tensor that had to be changed by more is said to be made up, fraction of its largest entry."""
    effort: float = 1000.0  # more than any known joint: a made-up value must not hold a motion back
    """Of joints that state none [N m or N]."""
    velocity: float = 100.0
    """Of joints that state none [rad/s or m/s]."""


class GeometrySettings(StageConfig):
    """KV30x to KV33x: collision along the motion; "untouched" is what the 54 benchmark models show."""

    hole: float = 0.05  # screw holes and seams of decimated housings have 1 %, a box without a lid 17 %
    """Area of the holes of a shell that still has an inside, fraction of its surface."""
    most_faces: int = 6000  # a link of 0.3 m keeps its surface to a tenth of a millimetre, drawers keep their edges
    """Triangles of a mesh; larger ones are simplified before they are swept."""
    points: int = 900  # 300 corners, 300 on edges, 300 on faces: 5 cm apart on a door of 1 m
    """Points on a body's surface that are asked how deep they are."""
    tolerance: float = 0.01  # untouched hinges and slides: 147 of 160 joints stay below
    """Depth beyond that at rest that does not count, fraction of the model's size."""
    part_tolerance: float = 0.25  # buttons and latches: their shafts are often missing in the hole that they move in
    """The same as a fraction of the smaller part's size; the smaller one of the two counts."""
    wrong: float = 0.03  # of untouched parents and children only drawers that do go through the back reach it
    """Depth that is an error, fraction of the model's size."""
    noise: float = 0.001  # 1 mm on an object of 1 m: faces that slide on one another
    """Growth of depth that is rounding of meshes, fraction of the model's size."""
    rest_overlap: float = 0.005
    """Overlap at rest of bodies without a joint between them that is worth a warning, fraction of the model's size."""
    rest_joined: float = 0.35  # wheels in their arches and shafts in solid housings reach 0.4 of the smaller part
    """The same of neighbours, fraction of the smaller part's size."""
    hover: float = 0.01  # robots and furniture are below 0.6 %
    """Gap at rest between a part and what carries it that is worth a warning, fraction of the model's size."""
    lost: float = 0.025  # untouched doors and drawers reach 1.5 %
    """Growth of that gap along the range that is worth a warning, fraction of the model's size."""
    far: float = 0.1
    """Growth of that gap that is an error, fraction of the model's size."""
    step: float = 0.02  # a wall of 2 cm cannot be jumped over on an object of 1 m, and what has passed is noticed
    """Motion of the fastest corner from sample to sample, fraction of the model's size."""
    samples_least: int = 12
    """Samples of a joint to one side, declared range and what lies beyond it each."""
    samples_most: int = 64
    """The same at most."""
    gap_samples: int = 8
    """Configurations to one side in which the gap is measured."""
    fine_angle: float = 0.1
    """Precision of a first contact [deg]."""
    fine_length: float = 1.0e-4
    """The same of slides [m]; no finer than a ten thousandth of the model's size."""
    early: float = 0.25  # wrong lines run into the parent at once; good ranges lose a fifth at most
    """A side of the range that is free over less than this share of the whole range is blocked early."""
    early_turn: float = 30.0  # legs of published robots without stops reach another body 54 to 177 deg from rest
    """More of a turn that is free is not early for a chain that reaches itself, or a joint without stops [deg]."""
    late: float = 0.05  # designers leave that much for cushions
    """Declared ends this close behind the free travel are not mentioned, fraction of the range."""
    guide: float = 1.0
    """Share of its guide that a slide may run out."""
    always: float = 0.95  # the customary share in motion planning
    """Share of configurations in which a pair that always collides does so."""
    random_rows: int = 128
    """Quasi-random configurations of all joints."""
    listed: int = 8
    """Pairs that one finding names."""


class EvidenceSettings(StageConfig):
    """KV34x to KV36x: agreement of the declared joint with the contact geometry.

    One half of the benchmark objects leads to these values, the other half confirms them.
    """

    same_deg: float = 3.0  # true axes lie within 0.5 deg of a candidate (192 joints)
    """Lines closer than this in direction and in position are one [deg]."""
    same_distance: float = 0.03  # and within 3 % of the part for 95 of 100 hinges
    """The same for their distance, fraction of the child's diagonal."""
    weak_contact: float = 0.35  # no true parent of 138 with rivals is below 0.7
    """A parent is doubtful below this share of the quality of the best other contact."""
    unknown_deg: float = 5.0  # ten times the largest angle of a true axis
    """Angle to every direction that the two bodies show, beyond which an axis is unexplained [deg]."""
    # two of 139 true hinges are farther, of those moved by 20 % of the part two of three
    unknown_distance: float = 0.065
    """Distance to every line that the two bodies show, beyond which an axis is unexplained, fraction of the child's
    diagonal."""
    linkage_distance: float = 0.15  # axes of quadrupeds without bearings in their meshes reach 0.14
    """The same in linkages, whose bearings are often missing in the meshes."""
    better: float = 1.5  # 1 of 76 true joints of furniture trails by more, of wrong ones none by less
    """Lead in log probability from which another joint of the same type is clearly better, outside linkages."""
    linkage_better: float = 3.0  # without a bearing in the meshes, 2 behind is common
    """The same in linkages, together with `bearing_lead` or with `blocked`."""
    bearing_score: float = 0.02  # lines beside the true one reach 0.01
    """Score of a bearing line below which it is chance."""
    bearing_lead: float = 8.0  # a coaxial feature beside the true bearing reaches 5; wrong lines start at 10
    """Score of a bearing on both bodies over that of the declared line from which the bearing contradicts it."""
    blocked: float = 0.5  # collars and overlapping housings block up to a third of good ranges
    """Share of the declared range that the parent blocks, from which a joint of a linkage is doubtful."""
    # planted tilts are 20 deg off; legs without bearings in their meshes have candidates at 90
    neighbour_deg: float = 30.0
    """Up to this angle to the declared axis, another line is nearby [deg]."""
    contact_band: float = 0.01  # clearances of drawers and doors
    """Places this much farther apart than the nearest are in contact at rest, fraction of the child's diagonal."""
    contact_places: int = 8  # one or two samples say nothing of a contact
    """Samples of a contact from which on it is decided whether half of it opens."""
    opens: float = 0.025  # untouched joints that KV344 doubts reach 0.019, three planted tilts of four 0.03
    """Half of the contact may open by this much more than about the line that fits best, fraction of the child's
    diagonal."""
    bearing_opens: float = 0.01  # tilted bearings start at 0.012, untouched ones reach 0.004
    """The same where both bodies are round about the line that fits best."""
    opens_across: float = 0.1  # an untouched switch reaches 0.05, wrong lines 0.12 and more
    """The same where that line is not nearby, outside linkages."""
    stays_closed: float = 0.5  # what opens anyway, as doors do from their frames, is held against no line
    """About the line that fits best it opens by at most this share."""
    widest_turn: float = 90.0
    """Turns are looked at up to here [deg]."""
    longest_slide: float = 0.5
    """Slides are looked at up to here, fraction of the child's diagonal."""
    type_odds: float = 1.0  # one true joint of 30, four swapped ones of five
    """Log odds from which the other type is worth a warning."""
    widest_door: float = 170.0  # 2 of 30 doors of the benchmark open to 180 deg, the others to at most 149
    """Opening beyond which that of an upright panel is unusual [deg]."""
    widest_lid: float = 190.0  # lids are thrown back onto what stands behind: 181 at most
    """The same for a level panel [deg]."""
    whole_turn: float = 359.0  # a stop of one turn can be made, but only knobs of safes have it
    """A range from here on, mostly to one side, needs no limits [deg]."""
    lopsided: float = 0.2  # wrists that turn by more go as far to both sides
    """A range is mostly to one side if the sum of its ends is above this share of its width."""


class AsLoadedSettings(StageConfig):
    """KV8xx: the untouched file in engines with their defaults."""

    overlap: float = 0.005  # 5 mm on an object of 1 m: hulls of round parts stand so far in each other
    """Depth of an overlap at rest that is worth a warning, fraction of the model's size."""
    overlap_length: float = 0.002  # engines let pressed parts in by up to a millimetre
    """The same, at least [m]."""
    seconds: float = 4.0  # what creeps has crept, what is thrown has arrived
    """For which joints are left alone [s]."""
    still: float = 0.02
    """How far a joint may go that nothing moves, fraction of its range."""
    still_angle: float = 0.02
    """The same, at least [rad]."""
    still_length: float = 0.003
    """The same of slides [m]."""
    torque: float = 15.0  # a hand at the edge of a door
    """Of a hand at a turning part [N m]."""
    force: float = 60.0  # a hand at a drawer
    """Of a hand at a sliding part [N]."""
    turning_speed: float = 1.5
    """At which a hand turns a part, at least [rad/s]."""
    sliding_speed: float = 0.4
    """The same of slides [m/s]."""
    reach: float = 0.95
    """Share of what exact geometry leaves free that a pushed joint has to reach."""
    touch_angle: float = 0.02
    """How much of a way that another body ends may be missing [rad]."""
    touch_length: float = 0.003  # Bullet adds 1 mm to each of two meshes
    """The same of slides [m]."""
    press: float = 0.01  # limits of engines are springs: a full hand bends those of light parts by any length
    """In which what presses a joint against its limit would bring it up to the hand's speed, at least [s]."""
    release_seconds: float = 2.0
    """Motion after a push in which energy is looked at [s]."""
    energy: float = 0.2  # an undamped arm of six joints gains 9 % in MuJoCo with its step of 2 ms
    """Growth of energy, fraction of the largest kinetic energy."""


class ValidationSettings(StageConfig):
    """All families."""

    name: str = "validation"
    """Of the settings; results state it."""
    seed: int = 0
    """Of whatever is sampled."""
    budget: BudgetSettings = section()
    file: FileSettings = section()
    physics: PhysicsSettings = section()
    prepare: PrepareSettings = section()
    geometry: GeometrySettings = section()
    evidence: EvidenceSettings = section()
    as_loaded: AsLoadedSettings = section()
    task: TaskSettings = section()


def load_settings(given: str | Path | ValidationSettings = "validation", **overrides: Any) -> ValidationSettings:
    """Load a shipped file of settings by name, or any YAML file by path; see `kinematify.config.load_config`.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value does not fit.
    """
    return load(ValidationSettings, given, **overrides)
