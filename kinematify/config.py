"""Typed configuration: one class per stage, values in `configs/*.yaml` where each has its reason.

Lengths are fractions of the assembly's diagonal unless a field says otherwise, so that nothing depends on units.
A YAML file may name another one with `extends:` and then states only what differs.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Literal, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError, model_validator

from kinematify.errors import ConfigError

CONFIG_FOLDER = Path(__file__).resolve().parent / "configs"


class StageConfig(BaseModel):
    """Base of all stages: strict types, unknown keys and non-finite numbers refused, frozen."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, allow_inf_nan=False)


_Stage = TypeVar("_Stage", bound=StageConfig)


class AssemblyConfig(StageConfig):
    """Limits on what is accepted as input."""

    max_parts: int
    """More parts than this are refused."""
    max_faces: int
    """Faces of all parts together; more are refused."""
    max_part_faces: int
    """A part with more faces is simplified to this number for inference (output keeps the original)."""
    min_vertices: int
    """A part with fewer distinct vertices is set aside (paper III-B: too few vertices)."""
    min_extent: float
    """A part whose largest extent is below this fraction of the assembly's diagonal is set aside."""
    max_archive_bytes: int
    """Size of a mesh file, and unpacked size of a ZIP [bytes]."""
    weld: float
    """Vertices closer than this fraction of their mesh's diagonal are merged."""
    duplicate: float
    """Two parts whose vertices agree within this fraction of the assembly's diagonal are the same part twice."""


class SurfaceConfig(StageConfig):
    """Derived geometry of a part's surface."""

    crease_angle: float
    """Faces that meet at a larger dihedral angle form a sharp edge [deg]."""


class ContactConfig(StageConfig):
    """Which parts touch, and where; lengths as fractions of the assembly's diagonal."""

    tolerance: float
    """Largest gap that counts as contact."""
    band: float
    """Samples farther from the other part than this say nothing about the joint."""
    samples: int
    """Surface samples per side of a contact."""
    cluster_samples: int
    """Surface samples per part for comparing shapes."""
    cluster_tolerance: float
    """Largest Chamfer distance of congruent parts, as a fraction of the part's diagonal."""


class RailConfig(StageConfig):
    """Fit of the direction along which a contact is extruded."""

    pairs: int
    """Random pairs of normals per side."""
    tolerance: float
    """Angle by which a normal may leave the plane across the direction [deg]."""
    edge_tolerance: float
    """Angle by which a guiding edge may leave the direction [deg]."""
    edge_floor: float
    """What a rail without guiding edges keeps of its score, against one with nothing but such edges."""
    refine_steps: int
    """Rounds of refinement."""

    @property
    def tolerance_sine(self) -> float:
        """Sine of `tolerance`."""
        return math.sin(math.radians(self.tolerance))

    @property
    def edge_tolerance_sine(self) -> float:
        """Sine of `edge_tolerance`."""
        return math.sin(math.radians(self.edge_tolerance))


class BearingConfig(StageConfig):
    """Fit of bearing lines to a contact edge."""

    fade: float
    """Distance to the other part over which evidence fades, fraction of the assembly's diagonal."""
    fade_part: float
    """The same as a fraction of the smaller part's diagonal; the smaller of the two counts."""
    negligible: float
    """Samples with less than this fraction of the largest weight are dropped."""
    pairs: int
    """Random pairs of normals per side."""
    circles: int
    """Circles through feature edges per side."""
    coarse_samples: int
    """Samples per side for the first scoring of all lines."""
    shortlist: int
    """Distinct lines, best by area, that are refined."""
    shortlist_circles: int
    """Distinct lines, best by circles, that are refined as well."""
    keep: int
    """Distinct lines kept per edge."""
    apart_angle: float
    """Lines closer than this in direction [deg] and closer than `apart` at the contact are one line."""
    apart: float
    """The distance that goes with it, fraction of the assembly's diagonal; proposals use twice both."""
    normal_tolerance: float
    """Angle between a normal and the meridian plane that still counts as consistent [deg]."""
    fine_tolerance: float
    """The same in the last round of refinement [deg]."""
    refine_steps: int
    """Rounds of refinement."""
    refine_samples: int
    """Samples per side in all rounds but the last two."""
    flange_weight: float
    """Weight of area perpendicular to the axis against area around it."""
    circle_tolerance: float
    """Angle by which a piece of edge may miss the tangent of a circle [deg]."""
    circle_cell: float
    """Radii and heights that differ by less belong to one circle, fraction of the diagonal."""
    least_arc: float
    """Shortest arc that counts, in full turns."""
    circle_floor: float
    """What an edge without any circle keeps of its score, against a full circle."""
    circle_weight: float
    """Weight of edge pieces against area in the refinement."""
    turned_support: float
    """A part whose whole surface turns into itself to this share may turn about its own axis."""
    turned_length: float
    """Largest length along the axis of such a part, in diameters."""
    turned_score: float
    """Score of a fully round part without any bearing on the other side."""
    turned_samples: int
    """Samples, and pairs of normals, for the axis of a whole part."""
    rail: RailConfig
    """The counterpart for sliding joints, fitted to the same samples."""

    @property
    def normal_tolerance_sine(self) -> float:
        """Sine of `normal_tolerance`."""
        return math.sin(math.radians(self.normal_tolerance))

    @property
    def fine_tolerance_sine(self) -> float:
        """Sine of `fine_tolerance`."""
        return math.sin(math.radians(self.fine_tolerance))

    @property
    def circle_tolerance_sine(self) -> float:
        """Sine of `circle_tolerance`."""
        return math.sin(math.radians(self.circle_tolerance))


class QualityConfig(StageConfig):
    """Weight of a contact edge in the tree search."""

    half_score: float
    """Bearing score at which half of the full quality is reached."""
    contact_weight: float
    """Largest quality of an edge without any bearing."""
    strength_power: float
    """Exponent of the contact strength; small values compress its range."""
    bridge_share: float
    """What an edge between parts that do not touch keeps of it."""


class ModelConfig(StageConfig):
    """Mass properties, limits and names of the model that is written."""

    solid_density: float
    """Density of the volume of a closed mesh [kg/m^3]."""
    hull_density: float
    """Density of the convex hull of a mesh that is open or flat [kg/m^3]."""
    min_mass: float
    """Smallest mass of a link [kg]."""
    min_inertia: float
    """Smallest principal moment of a link [kg m^2]."""
    min_thickness: float
    """Thinner parts get this thickness for mass and collision."""
    min_thickness_m: float
    """The same as a length [m]; the larger of the two counts."""
    turn_effort: float
    """Effort limit of joints that turn [N m]."""
    slide_effort: float
    """Effort limit of joints that slide [N]."""
    turn_velocity: float
    """Velocity limit of joints that turn [rad/s]."""
    slide_velocity: float
    """Velocity limit of joints that slide [m/s]."""
    min_travel: float
    """Smallest range between the limits [rad if it turns, else fraction of the diagonal]."""
    max_travel: float
    """Largest travel of a joint that slides, in each direction."""
    max_name_length: int
    """Longer model names are cut [characters]."""


class PreviewConfig(StageConfig):
    """Pictures of a model; lengths as fractions of the diagonal of what is shown."""

    panel_width: int
    """Width of one panel [pixels]."""
    panel_height: int
    """Height of one panel [pixels]."""
    subsamples: int
    """Rays per pixel side where edges are smoothed."""
    openness_rays: int
    """Rays per pixel for how much of the sky a point sees."""
    openness_reach: float
    """Surfaces beyond this distance do not darken a point."""
    floor_cells: int
    """Cells per side of the map of the shadow on the floor."""
    smooth_angle: float
    """Faces that meet at a larger angle are shaded with a sharp edge [deg]."""
    field_of_view: float
    """Smaller opening angle of the camera [deg]."""
    elevation: float
    """Height of the camera above the horizon [deg]."""
    azimuths: int
    """Directions around the object that are tried for the best view."""
    probe_pixels: int
    """Width of the small pictures that compare views [pixels]."""
    glyph_radius: float
    """Half the thickness of a joint arrow."""
    hidden_glyph: float
    """Opacity of a joint arrow behind a surface, between 0 and 1."""
    moved_fraction: float
    """Share of a joint's range by which it is moved."""
    max_turn: float
    """Joints are not turned farther than this in a picture [deg]."""
    max_slide: float
    """Joints are not slid farther than this in a picture."""
    chain_joints: int
    """With more moving joints than this, each turns less, so that a chain does not curl up."""
    exploded: float
    """Parts of the exploded view move away from the centre by this multiple of their distance from it."""
    legend_entries: int
    """Joints named below the picture; the rest is counted."""


class FramesConfig(StageConfig):
    """Box frames of parts."""

    volume_slack: float
    """A preferred frame may hold a box larger than the smallest by this fraction."""
    handle_share: float
    """Share of the area facing the thin direction that may lie outside the slab on either side."""
    handle_gap: float
    """An end is cut off if it reaches beyond the slab by more than this fraction of the slab's thickness."""


class SweepConfig(StageConfig):
    """Virtual motion test."""

    points: int
    """Points that stand for the moving part."""
    shrink: float
    """Fraction by which they are drawn towards the part's centre."""
    hinge_zone: float
    """Points closer to the axis than this fraction of the part's reach are exempt."""
    grace: float
    """Motion at the start that is not tested, fraction of the assembly's diagonal."""
    step_deg: float
    """Length of the straight pieces of a turn [deg]."""
    share: float
    """A motion is blocked once more than this share of the points has hit something."""


class GateConfig(StageConfig):
    """When a bearing line is taken as it is: either is enough."""

    product: float
    """Surface score times circle score."""
    located: float
    """Round area on both parts that locates the line, without flat seats (geometric mean of the shares)."""


class PanelsConfig(StageConfig):
    """Candidate lines and cues of turning joints."""

    sweep_deg: float
    """Turn that is tested either way [deg]."""
    full_turn_deg: float
    """Free turn beyond which more is no better [deg]."""
    part_deg: float
    """Turn after which the part must still be near its parent [deg]."""
    separation_points: int
    """Points that measure the gap after the turn."""
    bearings: int
    """Bearing lines among the candidates."""
    least_contact: int
    """Contact samples needed to propose lines from the contact."""
    cluster_gap: float
    """Gap between two contact zones, fraction of the part's longest side."""
    hinge_band: float
    """Contact within this fraction of the part's reach counts as being at the line."""
    ajar_share: float
    """A panel with more of its contact at one edge stands open."""
    tall: float
    """Height over width above which an upright panel is tall."""
    tall_handle: float
    """What remains of the direction of a handle on a tall panel."""
    margin_cap: float
    """Largest effect of the difference of margins."""
    weak_margin: float
    """What remains of the difference of margins for lids, and where a handle is clearly off centre."""
    cap: float
    """Largest influence of a single cue, in units of the score."""
    bearing_bonus: float
    """What a bearing that passes the gate adds to its line."""
    weights: dict[str, float]
    """Weight of each cue of `joints/panels.py`; lengths in diagonals."""


class SlidesConfig(StageConfig):
    """Candidate directions and cues of sliding joints."""

    sweep: float
    """Travel that is tested either way, fraction of the diagonal."""
    useful_share: float
    """Free travel beyond which more is no better, fraction of the part's length that way."""
    useful_least: float
    """The same as a fraction of the diagonal, for parts that are short that way."""
    short_travel: float
    """Travel on which crossings are counted, fraction of the diagonal."""
    distinct_deg: float
    """Directions closer than this are one [deg]."""
    cap: float
    """Largest influence of a single cue, in units of the score."""
    weights: dict[str, float]
    """Weight of each cue of `joints/slides.py`; lengths in diagonals."""


class KindConfig(StageConfig):
    """Log odds of sliding against turning."""

    bias: float
    """Log odds of sliding before any evidence."""
    cap: float
    """Largest influence of a single cue."""
    stuck_candidates: int
    """Turning candidates that must all be blocked before a part counts as fixed."""
    stuck_factor: float
    """Room up to this many times the thresholds below is looked at again, without grace."""
    stuck_deg: float
    """Turn below which a part counts as stuck [deg]."""
    stuck_slide: float
    """Travel below which a part counts as stuck, fraction of its own diagonal."""
    weights: dict[str, float]
    """Weight of each cue of `joints/kind.py`; positive for sliding."""


class LimitsConfig(StageConfig):
    """Limits from sweeps: an upper bound of the designed range."""

    panel_deg: float
    """Largest opening of a panel [deg]."""
    drawer: float
    """Travel of a drawer as a fraction of its own length."""
    button: float
    """Travel of a button as a fraction of its own thickness."""
    least_deg: float
    """A turning joint keeps at least this range [deg]."""
    least_slide: float
    """A sliding joint keeps at least this travel, fraction of the diagonal."""


class RailsConfig(StageConfig):
    """When the rail of a contact speaks for sliding."""

    score_none: float
    """Rail score up to which it says nothing."""
    score_full: float
    """Rail score from which it says all it can."""
    lead_none: float
    """The same for the rail's score over that of the best bearing line."""
    lead_full: float
    """Full where the lead is at least this."""
    held_deg: float
    """Free turn about a line along the rail beyond which the rail is a pin [deg]."""
    rounded_lead: float
    """Below this lead a pair of end parts is hinged, not sliding."""


class JointsConfig(StageConfig):
    """Choice of each joint's type, axis, direction and limits."""

    method: Literal["geometry", "cavl"]
    """Bearings, panels and slides, or the paper's DW-CAVL alone."""
    samples: int
    """Surface samples per part."""
    alternatives: int
    """Distinct candidates kept per type."""
    contact_band: float
    """Contact samples within this distance beyond the gap count as touching, fraction of the diagonal."""
    small_full: float
    """A part below this fraction of its parent's diagonal is small."""
    small_none: float
    """A part above this fraction of its parent's diagonal is not small."""
    panel_thinness: float
    """A panel is thinner than this fraction of its second side."""
    upright_cosine: float
    """A panel whose thin direction is less vertical than this is upright."""
    spread_full: float
    """Contact spread below this fraction of the child's half diagonal is compact."""
    spread_none: float
    """Contact spread above this fraction of the child's half diagonal is not compact."""
    serial_depth: int
    """A tree with this many joints in series is a linkage."""
    flat_cosine: float
    """A panel whose thin direction is more vertical than this is flat."""
    frames: FramesConfig
    sweep: SweepConfig
    gate: GateConfig
    panels: PanelsConfig
    slides: SlidesConfig
    kind: KindConfig
    rails: RailsConfig
    limits: LimitsConfig


class BaseConfig(StageConfig):
    """Weights of the cues for the base link; each cue is in [0, 1], each weight the score it can reach."""

    bulk_decades: float
    """A part this many powers of ten smaller than the largest has no bulk left."""
    vertical: float
    """Axes with a larger vertical component stand upright [cosine]."""
    body_share: float
    """Share of all other parts that the largest part must carry directly to be the body of an object."""
    body_weight: float
    """Score of the body of an object."""
    twin_discount: float
    """Factor on a body that has a congruent twin."""
    pedestal_rise: float
    """Height above the lowest point at which the end of a chain is no pedestal any more, in diagonals."""
    pedestal_bulk: float
    """Share of size in the score of a pedestal."""
    pedestal_low: float
    """Share of lowness in the score of a pedestal."""
    pedestal_flat: float
    """Share of a level bottom in the score of a pedestal."""
    pedestal_upright: float
    """Share of a vertical first axis in the score of a pedestal."""
    junction_weight: float
    """Score of the part where the lowest congruent limbs meet, whatever its size."""
    junction_bulk: float
    """What its size can add."""
    ground_band: float
    """Parts that begin this far above the lowest point reach the ground, in diagonals."""
    heavy_weight: float
    """Score of the largest part where it reaches the ground."""
    hub_weight: float
    """Score of the part in which most long chains meet."""


class RewardWeights(StageConfig):
    """Weights of the terms of a tree's reward; only their ratios count."""

    struct: float
    """R_struct: shallow trees of the preferred out-degree."""
    static: float
    """R_static: little gravitational torque."""
    contact: float
    """R_contact: mean weight of the edges."""
    sym: float
    """R_sym: congruent parts at equal depth on corresponding parents."""
    hier: float
    """R_hier: children no larger than parents."""
    base: float
    """Score of the root under the base rule."""


class TopologyConfig(StageConfig):
    """How a contact graph becomes a ranked list of kinematic trees."""

    mode: Literal["mcts", "mst", "bfs"]
    """Search, maximum spanning trees alone, or breadth-first orientation alone."""
    reward: Literal["default", "paper"]
    """Our terms with joint quality, or the five terms of the paper with contact strength."""
    base_rule: Literal["scored", "degree"]
    """Our scored rule, or the paper's highest degree."""
    cluster_edges: Literal["penalise", "forbid"]
    """What happens to edges inside a cluster of congruent parts."""
    weights: RewardWeights
    base: BaseConfig
    preferred_degree: int
    """``k`` of R_struct."""
    max_bases: int
    """Base links that are tried at most."""
    base_margin: float
    """A base link is tried when its score is at most this far below the best."""
    iterations: int
    """Simulations of the tree search, shared by all base links."""
    exploration: float
    """``C`` of UCT."""
    normalise_returns: bool
    """Stretch returns to [0, 1] between the worst and best seen, so that ``C`` has a meaning."""
    competitive_ratio: float
    """An edge is searched when its weight is at least this share of the weakest edge it could replace."""
    max_open_edges: int
    """Edges outside the spanning tree that are searched at most."""
    keep: int
    """Distinct trees that are kept."""
    virtual_distance: float
    """``d_max``: centroids farther apart are joined only when nothing nearer is left, in diagonals."""
    proximity_weight: float
    """Share of contact strength in an edge's weight; breaks ties between equal joints."""
    cluster_penalty: float
    """Factor on the quality of an edge inside a cluster that has a rival."""
    decisive_ratio: float
    """An edge inside a cluster that is this many times better than its rival is not weakened."""


class SdfConfig(StageConfig):
    """Grids of signed distances (III-B)."""

    resolution: int
    """Cells along the longest side of a part's grid."""
    margin: float
    """Room around the part, fraction of the part's own diagonal."""
    band_cells: float
    """Distances are exact within this many cells of the surface, at least 2; beyond, to half a cell."""
    cache_bytes: int
    """Grids kept in memory [bytes]."""


class CavlConfig(StageConfig):
    """DW-CAVL: contact-aware virtual motions that rank joint candidates (III-D)."""

    volume_margin: float
    """m_vol: distances below it count as touching."""
    sharpness: float
    """Logistic sharpness k, in units of 1 / m_vol."""
    contact_width: float
    """sigma_c: samples within this distance of the other part anchor it."""
    epsilon: float
    """epsilon_small: total weight below which a term fades out; all samples together weigh 1."""
    consistency_weight: float
    """lambda_c: price of separation near the contact."""
    collision_weight: float
    """lambda_coll: price of penetration."""
    pivot_weight: float
    """lambda_p: price of a pivot away from the contact centroid."""
    length_unit: float
    """Length that counts as 1 in J; a smaller one spreads the scores 1 / (1 + J)."""
    angles_deg: list[float]
    """Theta of revolute candidates [deg]."""
    travels: list[float]
    """Theta of prismatic candidates, paired with `angles_deg`."""
    match_motion: bool
    """Turn and slide so that the contact moves equally far: by at most `angles_deg` and about `travels`."""
    least_lever: float
    """Smallest lever arm of a contact in that comparison."""
    better_direction: bool
    """Average over the positive or the negative half of Theta, whichever costs less; false: over all of it."""
    symmetric: bool
    """Average J over both parts' fields; false: the parent's field alone, as in the paper."""
    type_ratio: float
    """zeta: revolute if s_rev > zeta s_pri."""
    random_axes: int
    """Random directions in the paper's candidate pool."""
    pivot_offsets: list[float]
    """Shifts of the pivot along every candidate axis."""
    rank_points: int
    """Samples per part when the pool is ranked."""
    refine_points: int
    """Samples per part when the best are refined and scored."""
    top: int
    """Candidates of each type that are refined."""
    refine_steps: int
    """Gradient steps; 0 leaves the candidates where they are."""
    learning_rate: float
    """Step of the gradient descent [rad, and fraction of the diagonal]."""
    batch_queries: int
    """Distance queries at a time; bounds the memory at about 200 bytes each."""

    @model_validator(mode="after")
    def _paired(self) -> CavlConfig:
        signs = [(angle > 0) - (angle < 0) for angle in self.angles_deg]
        if not signs or 0 in signs or signs != [(travel > 0) - (travel < 0) for travel in self.travels]:
            raise ValueError("angles_deg and travels must be pairs of equal sign, without zeros")
        return self

    def without_anchor(self) -> CavlConfig:
        """Collision avoidance alone: the paper's ablation "w/o DW-CAVL"."""
        return self.model_copy(update={"consistency_weight": 0.0, "pivot_weight": 0.0})


class Config(StageConfig):
    """All stages."""

    name: str
    seed: int
    assembly: AssemblyConfig
    surface: SurfaceConfig
    contact: ContactConfig
    bearing: BearingConfig
    quality: QualityConfig
    model: ModelConfig
    preview: PreviewConfig
    joints: JointsConfig
    topology: TopologyConfig
    sdf: SdfConfig
    cavl: CavlConfig


def load_config(name_or_path: str | Path = "default", **overrides: Any) -> Config:
    """Load a shipped configuration by name (``default``, ``fast``, ``paper``) or any YAML file by path.

    Args:
        name_or_path: Name of a file in `kinematify/configs` without suffix, or a path.
        overrides: Top-level values that replace those of the file, e.g. ``seed=7``.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value has the wrong type.
    """
    return validated(Config, {**load_values(name_or_path), **overrides}, name_or_path)


def load_values(name_or_path: str | Path) -> dict[str, Any]:
    """Read a YAML file, shipped or not, with what it extends.

    Raises:
        ConfigError: The name is unknown or the YAML is malformed.
    """
    return _read_layers(_config_path(name_or_path), seen=())


def validated(stage: type[_Stage], values: dict[str, Any], name_or_path: str | Path) -> _Stage:
    """Make a configuration from values.

    Raises:
        ConfigError: A value is missing, unknown or of the wrong type.
    """
    try:
        return stage.model_validate(values)
    except ValidationError as error:
        problems = "; ".join(f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
        raise ConfigError(
            f"The configuration {name_or_path} does not fit: {problems}. Compare it with the one that is shipped."
        ) from error


def _config_path(name_or_path: str | Path) -> Path:
    shipped = CONFIG_FOLDER / f"{name_or_path}.yaml"
    if shipped.is_file():
        return shipped
    path = Path(name_or_path)
    if path.is_file():
        return path
    known = ", ".join(sorted(p.stem for p in CONFIG_FOLDER.glob("*.yaml")))
    raise ConfigError(f"There is no configuration {name_or_path}. Give one of {known}, or the path of a YAML file.")


def _read_layers(path: Path, seen: tuple[Path, ...]) -> dict[str, Any]:
    if path in seen:
        raise ConfigError(f"The configuration {path} extends itself through {', '.join(map(str, seen))}.")
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise ConfigError(f"The configuration {path} cannot be read as YAML: {error}.") from error
    if not isinstance(values, dict):
        raise ConfigError(f"The configuration {path} must hold `key: value` lines, like default.yaml.")
    parent = values.pop("extends", None)
    if parent is None:
        return values
    return _merge(_read_layers(_config_path(parent), (*seen, path)), values)


def _merge(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    merged = dict(base)
    for key, value in changes.items():
        both_maps = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = _merge(merged[key], value) if both_maps else value
    return merged
