"""The model that is written and its picture."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from kinematify.config.base import StageConfig


class ModelConfig(StageConfig):
    """Mass properties, limits and names of the model that is written."""

    solid_density: float = 1000.0  # plastics, water and robots with hollow castings; metal alone would be 2700 to 7800
    """Density of the volume of a closed mesh [kg/m^3]."""
    hull_density: float = 300.0  # the hull of a shell encloses mostly air: measured furniture is 100 to 400
    """Density of the convex hull of a mesh that is open or flat [kg/m^3]."""
    # 2 mm of steel, 6 mm of glass, 23 mm of wood: what is sheet, tube, board or case is built so
    density: float | None = None  # `infer --density`
    """Of all parts, solid or not, if it is given [kg/m^3]; materials and walls then say nothing."""
    masses: dict[str, float] = Field(default_factory=dict)  # `infer --mass`
    """Masses of parts that are known, by name [kg]."""
    wall_weight: float = 15.0
    """Heavier bodies are hollow: mass of walls over the surface on which they are [kg/m^2]."""
    min_mass: float = 1.0e-6  # MuJoCo refuses moving bodies below 1e-15; far below any part one can handle
    """Smallest mass of a link [kg]."""
    min_inertia: float = 1.0e-12  # the same bound for moments; that of a 1 mm cube of plastic is 1.7e-13
    """Smallest principal moment of a link [kg m^2]."""
    min_thickness: float = 1.0e-4  # sheet metal of 0.1 mm on an object of 1 m; flat meshes have no hull
    """Thinner parts get this thickness for mass and collision."""
    min_thickness_m: float = 5.0e-5  # MuJoCo refuses meshes below 1e-15 m^3, which is a cube of 1e-5 m
    """The same as a length [m]; the larger of the two counts."""
    turn_effort: float = 100.0  # holds the leg of a humanoid; motors of robots have 10 to 300
    """Effort limit of joints that turn [N m]."""
    slide_effort: float = 200.0  # opens a heavy drawer; people pull with up to 300
    """Effort limit of joints that slide [N]."""
    turn_velocity: float = 3.0  # half a turn per second: common for robot arms
    """Velocity limit of joints that turn [rad/s]."""
    slide_velocity: float = 1.0  # a drawer pulled by hand
    """Velocity limit of joints that slide [m/s]."""
    min_travel: float = 1.0e-3  # equal limits would be read as none (MuJoCo) ; 0.06 deg moves nothing visibly
    """Smallest range between the limits [rad if it turns, else fraction of the diagonal]."""
    play: float = 0.09  # 5 deg: no door of -4 deg; what was given open by more keeps its way back
    """Joints that turn close no farther than to zero where they could go so much farther [rad]: that is play."""
    play_travel: float = 0.02
    """The same for joints that slide."""
    play_share: float = 0.1
    """It is play only up to this share of the range."""
    max_travel: float = 1.0  # a part that slides by the diagonal has left the object
    """Largest travel of a joint that slides, in each direction."""
    max_name_length: int = 200  # PyBullet crashes on robot names of 1100 characters
    """Longer model names are cut [characters]."""


class CollisionConfig(StageConfig):
    """Collision geometry of the model that is written."""

    # engines see a mesh as its hull: a drawer in a hollow cabinet would stand in a block
    mode: Literal["auto", "mesh"] = "auto"
    """``auto``: boxes and convex pieces, carved by the motion; ``mesh``: the visual meshes."""
    clearance: float = 4.0e-3  # Bullet adds 1 mm to every convex mesh, and doors sag by another one in their hinges
    """Distance that is kept between what a joint moves and what it does not [m]."""
    clearance_share: float = 0.02  # a stapler of 20 cm has all of it, a button of 1 cm keeps its shape
    """It is smaller for small objects: at most this."""
    thinnest_share: float = 0.2  # slivers of half a millimetre hold nothing up
    """What would be left thinner is dropped, fraction of the clearance."""
    most_pieces: int = 48  # the motion may cut them into some more
    """Convex pieces of a link before it is carved."""
    most_carved: int = 64  # engines take them without pain
    """Pieces of a link after that; those that represent least of its surface are dropped."""
    link_gap: float = 0.012  # fingers go around the handle of a drawer, which stands off by 2 cm
    """Pieces may reach so far beyond a link's surface, fraction of its diagonal."""
    model_gap: float = 0.005  # with half as much again, boards and rails that slide past each other lose 5 cm (dresser)
    """Or so far, whichever is more, fraction of the model's diagonal."""
    cuts: int = 64  # 20 ms each; a drawer with a handle takes 15
    """Cuts through concave meshes of a model."""
    cuts_per_link: int = 4
    """The same for models with many links."""
    corners: int = 64
    """Vertices of a piece that was joined from others, at most."""
    forced_share: float = 0.03  # solids are drawn into each other by up to 2 %; a drawer through a wall gets deeper
    """Links whose surfaces get deeper into each other than at rest by more than this fraction of the model's size block
    each other; what is less is carved."""
    turn_slack: float = 0.01  # engines' limits are soft: 0.6 deg
    """How far beyond their limits joints that turn are kept free [rad]."""
    slide_slack: float = 2.0e-3
    """The same for joints that slide [m]."""


class PreviewConfig(StageConfig):
    """Pictures of a model; lengths as fractions of the diagonal of what is shown."""

    panel_width: int = 560  # two panels fill the width of a README without scaling on most screens
    """Width of one panel [pixels]."""
    panel_height: int = 516  # a little wide: most objects show a long side
    """Height of one panel [pixels]."""
    subsamples: int = 2  # on a turned grid, 5 levels of coverage: 3 take twice the time and look the same
    """Rays per pixel side where edges are smoothed."""
    openness_rays: int = 8  # times the 16 pixels that are averaged: noise below 5 %
    """Rays per pixel for how much of the sky a point sees."""
    openness_reach: float = 0.25  # dark inside a cabinet, bright beside one
    """Surfaces beyond this distance do not darken a point."""
    floor_cells: int = 96  # soft shadow: finer cells show noise instead of detail
    """Cells per side of the map of the shadow on the floor."""
    smooth_angle: float = 35.0  # cylinders down to 12 segments look round, chamfers stay sharp
    """Faces that meet at a larger angle are shaded with a sharp edge [deg]."""
    field_of_view: float = 24.0  # a long lens: parallel axes look parallel
    """Smaller opening angle of the camera [deg]."""
    elevation: float = 24.0  # sees into drawers and still under tables
    """Height of the camera above the horizon [deg]."""
    azimuths: int = 8  # the corners and sides of a box
    """Directions around the object that are tried for the best view."""
    probe_pixels: int = 96  # enough to count the pixels of a knob
    """Width of the small pictures that compare views [pixels]."""
    glyph_radius: float = 0.0045  # arrows about 5 pixels thick
    """Half the thickness of a joint arrow."""
    glyph_halo: float = 0.0028  # 2 pixels: red stays red on a red door
    """Width of the light rim of a joint arrow."""
    hidden_glyph: float = 0.28  # guessed through the surface, not mistaken for being in front
    """Opacity of a joint arrow behind a surface, between 0 and 1."""
    moved_fraction: float = 1.0  # the whole range: what is too long or too short is seen
    """Share of a joint's range by which it is moved."""
    max_turn: float = 180.0  # more looks like less
    """Joints are not turned farther than this in a picture [deg]."""
    max_slide: float = 0.8  # what slides on rails stays in the picture
    """Joints are not slid farther than this in a picture."""
    chain_joints: int = 8  # arms have 6 or 7
    """Long chains of more moving joints than this turn less, so that they do not curl up."""
    legend_entries: int = 12  # four rows of three
    """Joints named below the picture; the rest is counted."""
