"""Thresholds of the checks: one class per family, values with their reasons in `configs/validation.yaml`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kinematify.config import StageConfig, load_values, validated
from kinematify.config.task import TaskSettings

if TYPE_CHECKING:
    from pathlib import Path


class BudgetSettings(StageConfig):
    """Time and memory."""

    seconds: float
    """Processor time of each isolated stage with those that it comes after [s]; what is left over is not finished."""
    stage_bytes: int
    """Address space of one isolated stage [bytes]."""


class FileSettings(StageConfig):
    """KV1xx: the file, the tree and the meshes."""

    max_elements: int
    """XML elements of a file."""
    max_links: int
    """Links, and joints, of a model."""
    max_depth: int
    """Joints one below the other."""
    max_mimic_chain: int
    """Followers of followers."""
    max_line_bytes: int
    """Longer lines are a warning [bytes]."""
    max_name: int
    """Longer names are a warning [characters]."""
    max_number: float
    """Largest absolute value of any number, in its own unit."""
    max_angle: float
    """Larger roll, pitch and yaw are a warning [rad]."""
    zero_axis: float
    """Axes of this length or shorter have no direction."""
    unit_axis_tolerance: float
    """Deviation of the length of an axis from one that is not mentioned."""
    rounded_axis_tolerance: float
    """Deviation that is only a note."""
    zero_scale: float
    """Absolute factors of a mesh scale up to here leave nothing."""
    max_mesh_bytes: int
    """Larger mesh files are not opened [bytes]."""
    max_faces: int
    """Triangles of all mesh files together."""
    stl_faces: int
    """Triangles that MuJoCo reads from an STL; meshes with more are a warning."""
    flat: float
    """Thickness of a mesh that counts as flat, fraction of its diagonal."""
    degenerate_share: float
    """Share of triangles without area that is a warning."""
    oversize: float
    """Size of a link over that of the largest other link that only a slip of units explains."""
    undersize: float
    """Size of the largest link over that of one with a mesh file that only a slip of units explains."""
    apart: float
    """Distance between a link and its parent over the sum of their sizes that only a slip of units explains."""
    tiny: float
    """Diagonal of the largest link below which the unit of a model is wrong [m]."""
    small: float
    """Diagonal of a model below which its unit is suspicious [m]."""
    large: float
    """Diagonal of a model above which its unit is suspicious [m]."""
    huge: float
    """Diagonal above which the unit of a model that moves is wrong [m]."""


class PhysicsSettings(StageConfig):
    """KV2xx: declared physics."""

    tiny_mass: float
    """Lighter bodies are a warning [kg]."""
    huge_mass: float
    """Heavier bodies are a warning [kg]."""
    dense: float
    """Denser hulls are a warning [kg/m^3]."""
    impossibly_dense: float
    """Denser hulls are an error [kg/m^3]."""
    light: float
    """Less dense solids are a warning [kg/m^3]."""
    mass_ratio: float
    """Mass of a body over that of the body that carries it."""
    moment_rounding: float
    """Largest principal moment over the sum of the others that rounding explains."""
    moment_ratio: float
    """The same, beyond which it is an error."""
    gyration_large: float
    """Largest radius of gyration over the distance of the outermost point."""
    gyration_small: float
    """Smallest value of the same."""
    copied_links: int
    """Links with one mass and one inertia from which on they are placeholders where sizes differ."""
    copied_volume: float
    """Room of the largest of them over that of the smallest from which on sizes differ."""
    copied_share: float
    """Masses below this fraction of the model's are next to nothing on purpose."""
    listed: int
    """More links with such an inertia are one finding."""
    centre_outside: float
    """Centres of mass may lie so far outside the hull, fraction of the body's diagonal."""
    centre_far: float
    """Beyond this it is an error, fraction of the body's diagonal."""
    frame_share: float
    """Links without geometry are taken for frames up to this fraction of the body's mass."""
    full_turn: float
    """Wider ranges of hinges are a warning unless they are round numbers of degrees [rad]."""
    widest_turn: float
    """Wider ranges are an error [rad]."""
    widest_wrist: float
    """Wider ranges are an error even with round limits [rad]."""
    endless: float
    """Wider ranges mean that there is no limit [rad]."""
    widest_slide: float
    """Longer ranges of slides are a warning [m]."""
    slide_sizes: float
    """The same, fraction of the model's diagonal."""
    slide_wrong: float
    """Longer ranges are an error, fraction of the model's diagonal."""
    mimic_slack: float
    """Followers may go so far beyond their limits, fraction of their range, at least of 1 rad or m."""
    damping: float
    """Larger damping or friction is a warning [N m s/rad, N s/m, N m or N]."""
    margin: float
    """Effort over the largest weight at a joint below which it is mentioned; below 1 it is a warning."""
    load_doublings: int
    """Two to this power configurations are sampled for the weight."""
    bare_share: float
    """A link without collision geometry counts if it stands out so far of that of its body, fraction of its size."""
    bare_minority: float
    """It counts anyway if no larger share of the links has none."""
    marker: float
    """Smaller links may do without, fraction of the model's diagonal."""
    shift: float
    """Displacement of the collision geometry, fraction of the visual diagonal."""
    shift_same: float
    """The same where both are of the same size."""
    shift_wrong: float
    """The same, beyond which it is an error."""
    same_size: float
    """Extents that differ less are the same, fraction of the visual diagonal."""
    beyond: float
    """How far collision geometry may reach beyond the visual one, fraction of the visual diagonal."""
    inflation: float
    """Volume of a hull over that of its mesh."""
    collision_shapes: int
    """More shapes per link are a note."""
    collision_faces: int
    """More triangles per link are a note."""


class PrepareSettings(StageConfig):
    """The file that engines are given: decomposition of concave collision meshes."""

    thickness: float
    """Thickness that flat geometry is given, fraction of its diagonal."""
    least_thickness: float
    """The same, at least [m]."""
    corners: int
    """Vertices of the hull of a convex mesh at most."""
    link_gap: float
    """Pieces may reach so far beyond a mesh, fraction of its diagonal."""
    model_gap: float
    """Or so far, whichever is more, fraction of the model's diagonal."""
    most_components: int
    """Connected pieces of a mesh that are looked at one by one, the largest; the others count as one."""
    cuts: int
    """Cuts through concave meshes of a model."""
    cuts_per_link: int
    """The same for models with many links."""
    cached_files: int
    """Cuts of so many models are kept for the next run; 0 keeps none."""
    frame_mass: float
    """Of links that add nothing to the body that they are fixed to [kg]."""
    dummy_mass: float
    """Of bodies without geometry and without mass [kg]."""
    ball_radius: float
    """Radius of gyration of what has a mass and no geometry [m]."""
    moment_slack: float
    """A tensor that had to be changed by more is said to be made up, fraction of its largest entry."""
    effort: float
    """Of joints that state none [N m or N]."""
    velocity: float
    """Of joints that state none [rad/s or m/s]."""


class GeometrySettings(StageConfig):
    """KV30x to KV33x: collision along the motion."""

    hole: float
    """Area of the holes of a shell that still has an inside, fraction of its surface."""
    points: int
    """Points on a body's surface that are asked how deep they are."""
    tolerance: float
    """Depth beyond that at rest that does not count, fraction of the model's size."""
    part_tolerance: float
    """The same as a fraction of the smaller part's size; the smaller one of the two counts."""
    wrong: float
    """Depth that is an error, fraction of the model's size."""
    noise: float
    """Growth of depth that is rounding of meshes, fraction of the model's size."""
    rest_overlap: float
    """Overlap at rest of bodies without a joint between them that is worth a warning, fraction of the model's size."""
    rest_joined: float
    """The same of neighbours, fraction of the smaller part's size."""
    hover: float
    """Gap at rest between a part and what carries it that is worth a warning, fraction of the model's size."""
    lost: float
    """Growth of that gap along the range that is worth a warning, fraction of the model's size."""
    far: float
    """Growth of that gap that is an error, fraction of the model's size."""
    step: float
    """Motion of the fastest corner from sample to sample, fraction of the model's size."""
    samples_least: int
    """Samples of a joint to one side, declared range and what lies beyond it each."""
    samples_most: int
    """The same at most."""
    gap_samples: int
    """Configurations to one side in which the gap is measured."""
    fine_angle: float
    """Precision of a first contact [deg]."""
    fine_length: float
    """The same of slides [m]; no finer than a ten thousandth of the model's size."""
    early: float
    """A side of the range that is free over less than this share of the whole range is blocked early."""
    early_turn: float
    """More of a turn that is free is not early for a chain that reaches itself, or a joint without stops [deg]."""
    late: float
    """Declared ends this close behind the free travel are not mentioned, fraction of the range."""
    small_range: float
    """A declared range below this fraction of the free travel is worth a note."""
    guide: float
    """Share of its guide that a slide may run out."""
    always: float
    """Share of configurations in which a pair that always collides does so."""
    random_rows: int
    """Quasi-random configurations of all joints."""
    pair_steps: int
    """Values of each joint of a pair of joints."""
    pair_rows: int
    """Configurations of all pairs of joints together."""
    hull_planes: int
    """Directions in which a hull is kept where collision shapes are looked at as engines see them."""
    listed: int
    """Pairs that one finding names."""


class EvidenceSettings(StageConfig):
    """KV34x to KV36x: agreement of the declared joint with the contact geometry."""

    same_deg: float
    """Lines closer than this in direction and in position are one [deg]."""
    same_distance: float
    """The same for their distance, fraction of the child's diagonal."""
    far_gap: float
    """A child counts as detached beyond this gap, fraction of the model's diagonal."""
    weak_contact: float
    """A parent is doubtful below this share of the quality of the best other contact."""
    unknown_deg: float
    """Angle to every direction that the two bodies show, beyond which an axis is unexplained [deg]."""
    askew_deg: float
    """The same, beyond which axes are askew where several are by the same angle [deg]."""
    askew_spread: float
    """Difference to the middle of these angles up to which they are the same [deg]."""
    askew_joints: int
    """Axes of one model from which on they are several."""
    wrong_deg: float
    """The same, beyond which it is an error if another joint is also clearly better [deg]."""
    clearly_better: float
    """Lead in the score from which another joint is clearly better."""
    unknown_distance: float
    """Distance to every line that the two bodies show, beyond which an axis is unexplained, fraction of the child's
    diagonal."""
    linkage_distance: float
    """The same in linkages, whose bearings are often left out of the meshes."""
    better: float
    """Lead in the score from which another hinge is worth a warning, outside linkages."""
    better_slide: float
    """The same for another direction of sliding."""
    linkage_better: float
    """The same in linkages, together with `bearing_lead` or with `blocked`."""
    bearing_score: float
    """Score of a bearing line below which it is chance."""
    bearing_lead: float
    """Score of a bearing on both bodies over that of the declared line from which the bearing contradicts it."""
    blocked: float
    """Share of the declared range that the parent blocks, from which a joint of a linkage is doubtful."""
    neighbour_deg: float
    """Up to this angle to the declared axis, another line is nearby [deg]."""
    contact_band: float
    """Places this much farther apart than the nearest are in contact at rest, fraction of the child's diagonal."""
    contact_places: int
    """Samples of a contact from which on it can be told whether half of it opens."""
    opens: float
    """Half of the contact may open by this much more than about the line that fits best, fraction of the child's
    diagonal."""
    bearing_opens: float
    """The same where both bodies are round about the line that fits best."""
    opens_across: float
    """The same where that line is not nearby, outside linkages."""
    stays_closed: float
    """About the line that fits best it opens by at most this share."""
    widest_turn: float
    """Turns are looked at up to here [deg]."""
    longest_slide: float
    """Slides are looked at up to here, fraction of the child's diagonal."""
    type_odds: float
    """Log odds from which the other type is worth a warning."""
    one_sided: float
    """A range is one-sided if its shorter side is below this fraction of its longer one."""
    shut: float
    """A permitted side that is free over less than this share of its range leads into the parent."""
    open: float
    """The other side is open from this share on."""
    panel_inward: float
    """Cosine between the motion of a closed panel and the way into its parent beyond which it opens inwards."""
    widest_door: float
    """Opening beyond which that of an upright panel is unusual [deg]."""
    widest_lid: float
    """The same for a level panel [deg]."""
    whole_turn: float
    """A range from here on, mostly to one side, needs no limits [deg]."""
    lopsided: float
    """A range is mostly to one side if the sum of its ends is above this share of its width."""
    button_travel: float
    """Travel of a button over its own length beyond which it is unusual."""
    button_outward: float
    """How far out on its parent, from 0 in the middle to 1 at the side, a small part may be that moves farther out."""


class EngineSettings(StageConfig):
    """KV4xx and KV5xx: behaviour in engines."""

    time_step: float
    """Of MuJoCo [s]."""
    pybullet_time_step: float
    """Of PyBullet [s]."""
    same: float
    """Difference of an axis, limit, mass or inertia that an importer may make, fraction of the value."""
    pose_distance: float
    """Difference of a link's position, fraction of the model's size."""
    pose_deg: float
    """Difference of a link's orientation [deg]."""
    contact_depth: float
    """Overlap that does not count, fraction of the model's size."""
    sweep_samples: int
    """Configurations of a joint from end to end."""
    servo_frequency: float
    """Of the servo of a joint, the others held [Hz]; it is critically damped."""
    servo_margin: float
    """How much stronger a servo is than its motion needs."""
    drive_seconds: float
    """From rest to one end [s]."""
    settle_seconds: float
    """Waiting at the end [s]."""
    reach: float
    """Distance from the end at which a joint has arrived, fraction of the range."""
    tracking: float
    """Lag behind the commanded motion, fraction of the way."""
    push: float
    """How far beyond its limit a joint is commanded, fraction of the range."""
    push_seconds: float
    """For how long [s]."""
    escape: float
    """How far beyond its limit a joint may get, fraction of the range."""
    sag: float
    """Of a held joint under gravity, fraction of the range."""
    passive_seconds: float
    """Free motion from rest, and holding at rest [s]."""
    explosion: float
    """Speed, as a multiple of that of a fall from the height of the model, that is no motion any more."""
    energy: float
    """Growth of energy, fraction of the largest kinetic energy."""
    drop: float
    """Height above the floor [m]."""
    drop_seconds: float
    """From letting go to rest [s]."""
    sink: float
    """Depth in the floor [m]."""
    rest_speed: float
    """Speed of the fastest link that counts as rest [m/s]."""
    step_seconds: float
    """Free motion that is repeated with a quarter of the time step [s]."""
    step_difference: float
    """Difference between the two motions, fraction of the larger one."""


class AsLoadedSettings(StageConfig):
    """KV8xx: the untouched file in engines with their defaults."""

    overlap: float
    """Depth of an overlap at rest that is worth a warning, fraction of the model's size."""
    overlap_length: float
    """The same, at least [m]."""
    seconds: float
    """For which joints are left alone [s]."""
    still: float
    """How far a joint may go that nothing moves, fraction of its range."""
    still_angle: float
    """The same, at least [rad]."""
    still_length: float
    """The same of slides [m]."""
    torque: float
    """Of a hand at a turning part [N m]."""
    force: float
    """Of a hand at a sliding part [N]."""
    turning_speed: float
    """At which a hand turns a part, at least [rad/s]."""
    sliding_speed: float
    """The same of slides [m/s]."""
    reach: float
    """Share of what exact geometry leaves free that a pushed joint has to reach."""
    touch_angle: float
    """How much of a way that another body ends may be missing [rad]."""
    touch_length: float
    """The same of slides [m]."""
    press: float
    """In which what presses a joint against its limit would bring it up to the hand's speed, at least [s]."""
    release_seconds: float
    """Motion after a push in which energy is looked at [s]."""
    energy: float
    """Growth of energy, fraction of the largest kinetic energy."""


class AgreementSettings(StageConfig):
    """KV6xx: agreement of engines."""

    random_rows: int
    """Quasi-random configurations beside zero, rest and the ends of every joint."""
    end_rows: int
    """Configurations at most for the ends of the joints; joints share them where there are more."""
    dynamic_rows: int
    """Configurations with mass matrix and gravity torques."""
    dynamic_numbers: int
    """Entries of all mass matrices together at most; large models have fewer configurations."""
    position: float
    """Distance between two engines' poses of one link that is an error, fraction of the model's size."""
    angle: float
    """The same for the angle between them [rad]."""
    mass_error: float
    """Relative difference of a mass that is an error."""
    mass_matrix: float
    """Relative difference of an entry of the mass matrix that is a warning."""
    gravity: float
    """Relative difference of a gravity torque that is a warning."""
    contact_depth: float
    """Overlap in one engine that the other should see too [m]."""
    contact_share: float
    """The same as a fraction of the model's size; the larger of the two counts."""


class ValidationSettings(StageConfig):
    """All families."""

    name: str
    seed: int
    budget: BudgetSettings
    file: FileSettings
    physics: PhysicsSettings
    prepare: PrepareSettings
    geometry: GeometrySettings
    evidence: EvidenceSettings
    engines: EngineSettings
    as_loaded: AsLoadedSettings
    agreement: AgreementSettings
    task: TaskSettings


def load_settings(name_or_path: str | Path = "validation", **overrides: Any) -> ValidationSettings:
    """Load a shipped file of settings by name, or any YAML file by path; see `kinematify.config.load_config`.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value does not fit.
    """
    return validated(ValidationSettings, {**load_values(name_or_path), **overrides}, name_or_path)
