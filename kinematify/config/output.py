"""The model that is written and its picture."""

from __future__ import annotations

from typing import Literal

from kinematify.config.base import StageConfig


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
    play: float
    """Joints that turn close no farther than to zero where they could go so much farther [rad]: that is play."""
    play_travel: float
    """The same for joints that slide."""
    play_share: float
    """It is play only up to this share of the range."""
    max_travel: float
    """Largest travel of a joint that slides, in each direction."""
    max_name_length: int
    """Longer model names are cut [characters]."""


class CollisionConfig(StageConfig):
    """Collision geometry of the model that is written."""

    mode: Literal["auto", "mesh"]
    """``auto``: boxes and convex pieces, carved by the motion; ``mesh``: the visual meshes."""
    clearance: float
    """Distance that is kept between what a joint moves and what it does not [m]."""
    clearance_share: float
    """It is smaller for small objects: at most this."""
    thinnest_share: float
    """What would be left thinner is dropped, fraction of the clearance."""
    most_pieces: int
    """Convex pieces of a link before it is carved."""
    most_carved: int
    """Pieces of a link after that; those that stand for least of its surface are dropped."""
    link_gap: float
    """Pieces may reach so far beyond a link's surface, fraction of its diagonal."""
    model_gap: float
    """Or so far, whichever is more, fraction of the model's diagonal."""
    cuts: int
    """Cuts through concave meshes of a model."""
    cuts_per_link: int
    """The same for models with many links."""
    corners: int
    """Vertices of a piece that was joined from others, at most."""
    forced_share: float
    """Links whose surfaces get deeper into each other than at rest by more than this fraction of the model's size block
    each other; what is less is carved."""
    turn_slack: float
    """How far beyond their limits joints that turn are kept free [rad]."""
    slide_slack: float
    """The same for joints that slide [m]."""


class DynamicsConfig(StageConfig):
    """Friction, damping and weight of the model that is written."""

    hand_force: float
    """What a hand pulls a drawer with [N]."""
    hand_torque: float
    """What a hand turns a door with [N m]."""
    motor_torque: float
    """The most that the motor of a joint that turns is given [N m]."""
    motor_force: float
    """The same for one that slides [N]."""
    hand_share: float
    """Weight and friction take at most this share of it."""
    holding: float
    """Friction over the weight that pulls at a joint where it rests."""
    rubbing: float
    """Friction of bearings and slides over the weight on them."""
    most_friction: float
    """Friction is at most this share of a hand's force."""
    settling_time: float
    """A part that was pushed comes to rest in about this time [s]: inertia over damping."""
    opening_time: float
    """A hand moves it over its whole range in at most about this time [s]."""


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
    glyph_halo: float
    """Width of the light rim of a joint arrow."""
    hidden_glyph: float
    """Opacity of a joint arrow behind a surface, between 0 and 1."""
    moved_fraction: float
    """Share of a joint's range by which it is moved."""
    max_turn: float
    """Joints are not turned farther than this in a picture [deg]."""
    max_slide: float
    """Joints are not slid farther than this in a picture."""
    chain_joints: int
    """Long chains of more moving joints than this turn less, so that they do not curl up."""
    exploded: float
    """Parts of the exploded view move away from the centre by this multiple of their distance from it."""
    legend_entries: int
    """Joints named below the picture; the rest is counted."""
