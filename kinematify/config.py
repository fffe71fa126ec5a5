"""Typed configuration: one class per stage, values in `configs/*.yaml` where each has its reason.

Lengths are fractions of the assembly's diagonal unless a field says otherwise, so that nothing depends on units.
A YAML file may name another one with `extends:` and then states only what differs.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from kinematify.errors import ConfigError

CONFIG_FOLDER = Path(__file__).resolve().parent / "configs"


class StageConfig(BaseModel):
    """Base of all stages: strict types, unknown keys and non-finite numbers refused, frozen."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, allow_inf_nan=False)


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
    """Unpacked size of a ZIP [bytes]."""


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
    """Distinct lines that are refined and scored on all samples."""
    keep: int
    """Distinct lines kept per edge."""
    normal_tolerance: float
    """Angle between a normal and the meridian plane that still counts as consistent [deg]."""
    fine_tolerance: float
    """The same in the last round of refinement [deg]."""
    refine_steps: int
    """Rounds of refinement."""
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


class Config(StageConfig):
    """All stages."""

    name: str
    seed: int
    assembly: AssemblyConfig
    surface: SurfaceConfig
    contact: ContactConfig
    bearing: BearingConfig
    model: ModelConfig
    preview: PreviewConfig


def load_config(name_or_path: str | Path = "default", **overrides: Any) -> Config:
    """Load a shipped configuration by name (``default``, ``fast``, ``paper``) or any YAML file by path.

    Args:
        name_or_path: Name of a file in `kinematify/configs` without suffix, or a path.
        overrides: Top-level values that replace those of the file, e.g. ``seed=7``.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value has the wrong type.
    """
    values = _read_layers(_config_path(name_or_path), seen=())
    values.update(overrides)
    try:
        return Config.model_validate(values)
    except ValidationError as error:
        problems = "; ".join(f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
        raise ConfigError(
            f"The configuration {name_or_path} does not fit: {problems}. Compare it with default.yaml."
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
