"""All that is known of one parent-child pair before a joint is proposed: frames, shape, contact, handle, bearing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.bearings.scores import BearingLine, EdgeBearing
from kinematify.joints.features.frames import UP, body_axes, box_frame, find_fold
from kinematify.joints.features.journal import facing_faces, find_journal

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config import FrontCuesConfig, JointsConfig, RailsConfig
    from kinematify.contact.graph import ContactGraph
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.features.frames import BoxFrame, Fold
    from kinematify.joints.features.journal import Journal
    from kinematify.joints.features.workspace import ContactView, PartCache
    from kinematify.robot.arrays import BoolArray, FloatArray


def foot_side(part: BoxFrame, body: FloatArray, config: FrontCuesConfig) -> FloatArray:
    """Unit level direction from the middle of a body to a small part at one side of its foot, else zero, shape (3,).

    A pedal is where the user's foot is, in front. A bin on two wheels is tipped back onto them, so they are behind.

    Args:
        part: Box frame of the part.
        body: Bounds of the body in the world frame [m], shape (2, 3).
        config: What counts as small, low and on one side.
    """
    extents = body[1] - body[0]
    middle = 0.5 * (part.lower + part.upper) @ part.axes
    offset = (middle - body.mean(axis=0)) * (1.0, 1.0, 0.0)
    distance = float(np.linalg.norm(offset))
    small = part.diagonal < config.small * float(np.linalg.norm(extents))
    low = middle[2] - body[0, 2] < config.low * extents[2]
    aside = distance > config.aside * 0.5 * float(extents[:2].min())
    return np.asarray(offset / distance) if small and low and aside else np.zeros(3)


def front_of(
    body: FloatArray, frames: Sequence[BoxFrame], rolling: Sequence[bool], config: FrontCuesConfig
) -> FloatArray:
    """The level direction in which the front of a body looks, zero where nothing at its foot says so, shape (3,).

    Args:
        body: Bounds of the body in the world frame [m], shape (2, 3).
        frames: Box frames of the parts that it carries.
        rolling: Which of them are wheels.
        config: What counts as small, low and on one side.
    """
    front = np.zeros(3)
    for frame, rolls in zip(frames, rolling, strict=True):
        if rolls or is_level_plate(frame):
            front += foot_side(frame, body, config) * (-1.0 if rolls else 1.0)
    length = float(np.linalg.norm(front))
    # Feet or castors all around cancel out.
    return front / length if length > config.agreeing else np.zeros(3)


def is_level_plate(frame: BoxFrame) -> bool:
    """True if a part is thin upwards, as what is trodden on."""
    sides = np.sort(frame.extents)
    return bool(abs(float(frame.axes[frame.thin] @ UP)) > np.cos(np.radians(30.0)) and sides[0] < 0.5 * sides[1])


@dataclass(frozen=True, kw_only=True, eq=False)
class Handle:
    """Handle that a person pulls: a bump on the outer side of a panel, or small parts mounted on it."""

    centre: FloatArray
    """World frame [m], shape (3,)."""
    direction: FloatArray
    """Unit direction of a long handle, zero for a short one, shape (3,)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class JointScene:
    """One tree edge with everything that the cues look at; lengths in metres, world frame."""

    cache: PartCache
    parent: int
    child: int
    frame: BoxFrame
    """Box frame of the child."""
    parent_frame: BoxFrame
    """Box frame of the parent, along its own axes."""
    upright_axes: FloatArray
    """Upright axes of the whole object, one per row, shape (3, 3)."""
    body_box: FloatArray
    """Lower and upper corner of the parent along the child's axes [m], shape (2, 3)."""
    contact: ContactView
    others: tuple[int, ...]
    """Obstacles besides the parent: every part outside the child's subtree."""
    outward: FloatArray
    """Unit normal of the panel away from the body along the child's thin direction, zero if undecided, shape (3,)."""
    handle: Handle | None
    smallness: float
    """1 for a part that is small beside its parent, 0 for a large one."""
    panel: bool
    """The slab is thin, and the part is not small."""
    plate: bool
    """The slab is thin, whatever its size."""
    disc: float
    """How round the part is seen along its thin direction, 0 for a square, 1 for a disc."""
    upright: bool
    """The thin direction lies flat, as in a closed door."""
    flat: bool
    """The thin direction points up, as in a closed lid."""
    bearing: EdgeBearing | None
    """Its first line is the journal where there is one."""
    journal: Journal | None
    """The line about which the parent holds the child all around; not looked for in trees of joints in series."""
    serial: bool
    """The tree has several joints in series, as arms, legs and hands have."""
    has_bearing: bool
    """The best line of the bearing passes the gate."""
    prismatic_score: float
    """1 where both sides of the contact are extruded far more clearly than they are round, as on a linear guide."""
    rail_lead: float
    """Score of the contact's rail over that of its best line; 0 without a rail."""
    is_round: bool
    """The contact is about as round as it is extruded, or more."""
    compact: float
    """1 where the contact is a small patch of the child, as in a machine's joint; 0 where it is spread out."""
    mechanism: float
    """1 in a linkage (compact contact, or a tree of several joints in series), 0 for furniture."""
    on_top: bool
    """The child lies above most of its parent."""
    parent_moves: bool
    """The parent is itself moved by a joint."""
    enclosed: float
    """Share of the six directions from the child's centre in which the parent stands in the way."""
    covered: bool
    """The parent stands above the child's centre as well as below it."""
    inside: float
    """Share of the child's surface that lies inside the parent's box."""
    rolls: bool
    """The child is a disc standing on the floor."""
    fold: Fold | None
    """Where the front of the child is folded as a rocker's; not looked for in large lids, which may have a ridge."""
    front: FloatArray
    """Of lids, level direction in which the front of the parent looks as its foot tells, else zero, shape (3,)."""
    pedal_direction: FloatArray
    """Level direction from the parent to the child where that is a pedal, else zero, shape (3,)."""
    depth: int
    """Joints from the root to the child."""
    twins: tuple[BoxFrame, ...]
    """Box frames of congruent siblings that carry nothing; none where the child itself carries something."""

    @property
    def anchor(self) -> FloatArray:
        """Centroid of the contact, the child's centre without one [m], shape (3,)."""
        return self.contact.centroid if len(self.contact.points) else self.centre

    @cached_property
    def gripping(self) -> bool:
        """The child and its one twin are fingers: no bearing, no panel, out of the parent and apart from each other.

        At the end of a chain that is enough. On a base, where doors, legs and wheels are twins too, the pair must also
        be parallel and thin along the line between them.
        """
        if len(self.twins) != 1:
            return False
        (twin,) = self.twins
        apart_line = twin.centre - self.centre
        apart_line = apart_line / max(float(np.linalg.norm(apart_line)), 1e-12)
        closing = abs(float(apart_line @ self.frame.axes[self.frame.thin]))
        parallel = abs(float(apart_line @ twin.axes[twin.thin]))
        facing = min(closing, parallel) > np.cos(np.radians(3.0)) and not self.plate and self.smallness < 1.0
        chain_end = (self.depth >= 2 and self.smallness < 1.0) or facing  # buttons of a door are no fingers
        apart = float(np.linalg.norm(twin.centre - self.centre)) < 2.0 * float(self.parent_frame.extents.max())
        return bool(chain_end and self.inside < 0.8 and apart and not self.has_bearing and not self.is_round)

    @property
    def grips(self) -> FloatArray:
        """Unit direction from a finger to its twin, shape (1, 3); (0, 3) for all other parts."""
        offsets = [twin.centre - self.centre for twin in self.twins] if self.gripping else []
        long_enough = [offset for offset in offsets if np.linalg.norm(offset) > 1e-6 * self.diagonal]
        return np.array([offset / np.linalg.norm(offset) for offset in long_enough]).reshape(-1, 3)

    @property
    def diagonal(self) -> float:
        """Diagonal of the assembly [m]."""
        return self.cache.diagonal

    @property
    def centre(self) -> FloatArray:
        """Centre of the child's slab, shape (3,)."""
        return self.frame.centre


def _rail_lead(bearing: EdgeBearing | None) -> float:
    """Score of the contact's rail over that of its best line; 0 without a rail."""
    if bearing is None or bearing.rail is None:
        return 0.0
    best = bearing.lines[0].score if bearing.lines else 0.0
    return bearing.rail.score / max(best, 1e-3)


def _is_round(bearing: EdgeBearing | None, config: RailsConfig) -> bool:
    """True if the contact is about as round as it is extruded, or more; where it is neither, that says nothing."""
    if bearing is None or not bearing.lines or bearing.lines[0].score < config.rounded_least:
        return False
    return 0.0 < _rail_lead(bearing) < config.rounded_lead


def _prismatic_score(bearing: EdgeBearing | None, config: RailsConfig) -> float:
    lead = _rail_lead(bearing)
    if lead == 0.0 or bearing is None or bearing.rail is None:
        return 0.0
    strong = np.interp(bearing.rail.score, (config.score_none, config.score_full), (0.0, 1.0))
    leading = np.interp(lead, (config.lead_none, config.lead_full), (0.0, 1.0))
    return float(strong * leading)


def part_frames(cache: PartCache, tree: KinematicTree, config: JointsConfig) -> dict[int, BoxFrame]:
    """Box frame of every part, parents before children; the root prefers the upright frame of the body."""
    root = cache.samples(tree.root)
    body = body_axes(root.normals, root.areas)
    frames: dict[int, BoxFrame] = {}
    for part, above in [(tree.root, -1), *((child, parent) for parent, child in tree.edges())]:
        preferred = [body] if above < 0 else [frames[above].axes, body]
        vertices = cache.assembly.parts[part].vertices[np.unique(cache.assembly.parts[part].faces)]
        frames[part] = box_frame(vertices, cache.samples(part), preferred, config.frames)
    return frames


def joint_scene(
    cache: PartCache,
    tree: KinematicTree,
    frames: Mapping[int, BoxFrame],
    edge: tuple[int, int],
    bearing: EdgeBearing | None,
    *,
    config: JointsConfig,
) -> JointScene:
    """Gather what the cues need for the tree edge (parent, child)."""
    parent, child = edge
    frame = frames[child]
    local = frame.local(cache.assembly.parts[parent].vertices[np.unique(cache.assembly.parts[parent].faces)])
    body_box = np.stack([local.min(axis=0), local.max(axis=0)])
    outward = _outward(frame, body_box)
    smallness = _smallness(frames[parent], frame, config)
    contact = cache.contact(parent, child, config.contact_band * cache.diagonal)
    compact = _compactness(frame, contact, config)
    walls = _walls(cache, parent, frame)
    low, high = cache.assembly.parts[parent].bounds[:, 2]
    serial = max(tree.depths) >= config.serial_depth
    sides = np.sort(frame.extents)
    up = abs(float(frame.axes[frame.thin] @ UP))
    moving = _subtree(tree, child)
    journal = None if serial else _journal(cache, parent, child, frame, config)
    if journal is not None:
        bearing = _with_journal(bearing, edge, journal)
    plate = _is_plate(sides, up < config.upright_cosine, config)
    panel = plate and smallness < 1.0
    on_top = bool(frame.centre[2] > low + 0.75 * (high - low))
    folds = plate and not (panel and on_top and up > config.flat_cosine)
    return JointScene(
        cache=cache,
        parent=parent,
        child=child,
        frame=frame,
        parent_frame=frames[parent],
        upright_axes=cache.upright_axes,
        body_box=body_box,
        contact=contact,
        others=tuple(i for i in range(len(tree.parents)) if i != parent and i not in moving),
        outward=outward,
        handle=_handle(cache, tree, child, frame, outward),
        smallness=smallness,
        panel=panel,
        plate=plate,
        disc=_disc(cache, child, frame),
        upright=up < config.upright_cosine,
        flat=up > config.flat_cosine,
        bearing=bearing,
        journal=journal,
        serial=serial,
        has_bearing=journal is not None or (bearing is not None and passes_gate(bearing, contact, config)),
        prismatic_score=_prismatic_score(bearing, config.rails),
        rail_lead=_rail_lead(bearing),
        is_round=_is_round(bearing, config.rails),
        compact=compact,
        mechanism=1.0 if serial else compact,
        on_top=on_top,
        parent_moves=parent != tree.root,
        enclosed=float(walls.mean()),
        covered=bool(walls[np.abs(np.concatenate([frame.axes, -frame.axes]) @ UP) > config.flat_cosine].all()),
        inside=_inside(cache, child, frame, body_box),
        rolls=rolls(cache, child, frame),
        fold=find_fold(cache.samples(child), frame, config.rockers) if folds else None,
        front=_front(cache, tree, parent, frames, config) if panel and up > config.flat_cosine else np.zeros(3),
        pedal_direction=_pedal_direction(cache, parent, frame, config),
        depth=tree.depths[child],
        twins=tuple(frames[part] for part in _leaf_twins(cache.graph, tree, edge)),
    )


def _leaf_twins(graph: ContactGraph, tree: KinematicTree, edge: tuple[int, int]) -> tuple[int, ...]:
    """Congruent siblings of the child that carry nothing, without the child itself; none if it carries something."""
    parent, child = edge
    twins = () if tree.children[child] else graph.alike.others(child)
    return tuple(part for part in twins if tree.parents[part] == parent and not tree.children[part])


def _journal(cache: PartCache, parent: int, child: int, frame: BoxFrame, config: JointsConfig) -> Journal | None:
    """Return what the parent holds the child by, within the band of their contact."""
    edge = cache.graph.by_pair.get((min(parent, child), max(parent, child)))
    if edge is None:
        return None
    reach = edge.gap + config.contact_band * cache.diagonal
    facing = facing_faces(cache, parent, child, reach, config.journal)
    return find_journal(facing, float(frame.extents.max()), config.journal)


def _with_journal(bearing: EdgeBearing | None, edge: tuple[int, int], journal: Journal) -> EdgeBearing:
    """The bearing of a contact with the journal as its first line."""
    lines = () if bearing is None else bearing.lines
    first = BearingLine(
        axis=journal.axis,
        pivot=journal.pivot,
        score=max([line.score for line in lines], default=0.0) + journal.coverage,
        surface_a=journal.coverage,
        surface_b=journal.coverage,
        circles_a=journal.coverage,
        circles_b=journal.coverage,
    )
    return EdgeBearing(
        a=min(edge),
        b=max(edge),
        centroid=journal.pivot if bearing is None else bearing.centroid,
        lines=(first, *lines),
        rail=None if bearing is None else bearing.rail,
    )


def is_cap(scene: JointScene) -> bool:
    """A lid on top, without a hinge, whose skirt reaches over the rim of its body on all four sides: a shoe box's.

    Such a lid can only be lifted: about any edge, the skirt opposite would run into the rim.
    """
    if not (scene.on_top and scene.flat and scene.panel) or scene.journal is not None:
        return False
    frame = scene.frame
    up = int(np.argmax(np.abs(frame.axes @ UP)))
    sign = np.sign(frame.axes[up] @ UP)
    points = frame.local(scene.cache.samples(scene.child).points)
    height = sign * points[:, up]
    below = height < (sign * scene.body_box[:, up]).max() - 0.25 * np.ptp(height)
    if below.mean() > 0.5:
        return False  # a tray or drawer, which lies in its body
    shares = []
    for k in np.delete(np.arange(3), up):
        margin = 0.05 * np.ptp(points[:, k])
        shares += [(below & (points[:, k] < points[:, k].min() + margin)).mean()]
        shares += [(below & (points[:, k] > points[:, k].max() - margin)).mean()]
    return bool(min(shares) > 0.015)


def passes_gate(bearing: EdgeBearing, contact: ContactView, config: JointsConfig) -> bool:
    """True where the best line is a bearing beyond doubt.

    Either round surface and circles on both parts, or so much round surface on both parts that it needs no circles.
    """
    if not bearing.lines:
        return False
    line = bearing.lines[0]
    if line.surface * line.circles > config.gate.product:
        return True
    child = located_support(contact.points, contact.normals, contact.weights, line)
    m = len(contact.parent_points)
    parent = located_support(contact.parent_points, contact.parent_normals, np.full(m, 1.0 / max(m, 1)), line)
    return bool(np.sqrt(max(child * parent, 0.0)) > config.gate.located)


def located_support(points: FloatArray, normals: FloatArray, weights: FloatArray, line: BearingLine) -> float:
    """Share of an area that turns into itself about a line, counted by how well it locates the line, in [0, 1].

    Unlike the surface score of a bearing, flat area across the axis counts nothing here.
    """
    if len(points) == 0:
        return 0.0
    offset = points - line.pivot
    radial = offset - (offset @ line.axis)[:, None] * line.axis
    radial /= np.maximum(np.linalg.norm(radial, axis=1), 1e-12)[:, None]
    miss = np.einsum("ij,ij->i", np.cross(line.axis, radial), normals)
    fit = weights * np.exp(-((miss / np.sin(np.radians(3.0))) ** 2))
    across = normals - (normals @ line.axis)[:, None] * line.axis
    return float(2.0 * np.linalg.eigvalsh((across * fit[:, None]).T @ across)[1] / max(float(weights.sum()), 1e-300))


def _compactness(frame: BoxFrame, contact: ContactView, config: JointsConfig) -> float:
    if len(contact.points) == 0:
        return 0.0
    spread = np.sqrt(contact.weights @ np.sum((contact.points - contact.centroid) ** 2, axis=1))
    ratio = spread / (0.5 * frame.diagonal)
    return float(np.clip((config.spread_none - ratio) / (config.spread_none - config.spread_full), 0.0, 1.0))


def _disc(cache: PartCache, part: int, frame: BoxFrame) -> float:
    """Return how round the part is seen along its thin direction, 0 for a square, 1 for a disc."""
    plane = np.delete(np.arange(3), frame.thin)
    flat = frame.local(cache.samples(part).points)[:, plane] - (frame.centre @ frame.axes.T)[plane]
    angles = np.arctan2(flat[:, 1], flat[:, 0])
    sector = np.floor((angles + np.pi) / (2 * np.pi) * 16).astype(np.int64) % 16
    radius = np.zeros(16)
    np.maximum.at(radius, sector, np.linalg.norm(flat, axis=1))
    ratio = float(radius.min() / max(float(radius.max()), 1e-12))
    return float(np.clip((ratio - 0.75) / 0.15, 0.0, 1.0))


def rolls(cache: PartCache, part: int, frame: BoxFrame) -> bool:
    """True if a part is a disc standing on the floor on which the whole object stands."""
    level = abs(float(frame.axes[frame.thin] @ UP)) < 0.1
    lowest = cache.assembly.parts[part].bounds[0, 2] - cache.assembly.bounds[0, 2]
    return bool(level and lowest < 0.01 * cache.diagonal and _disc(cache, part, frame) > 0.5)


def _stands(cache: PartCache, part: int, config: JointsConfig) -> bool:
    """True if a part reaches the floor, or nearly so, as a bin on wheels."""
    rise = cache.assembly.parts[part].bounds[0, 2] - cache.assembly.bounds[0, 2]
    return bool(rise < config.front_cues.low * np.ptp(cache.assembly.bounds[:, 2]))


def _front(
    cache: PartCache, tree: KinematicTree, body: int, frames: Mapping[int, BoxFrame], config: JointsConfig
) -> FloatArray:
    if not _stands(cache, body, config):
        return np.zeros(3)
    carried = tree.children[body]
    rolling = [rolls(cache, part, frames[part]) for part in carried]
    return front_of(cache.assembly.parts[body].bounds, [frames[part] for part in carried], rolling, config.front_cues)


def _pedal_direction(cache: PartCache, body: int, frame: BoxFrame, config: JointsConfig) -> FloatArray:
    if not is_level_plate(frame) or not _stands(cache, body, config):
        return np.zeros(3)
    return foot_side(frame, cache.assembly.parts[body].bounds, config.front_cues)


def _is_plate(sides: FloatArray, upright: bool, config: JointsConfig) -> bool:
    """True if a slab of these ascending sides is thin; narrow doors of fridges are thick, but high."""
    if sides[0] < config.panel_thinness * sides[1]:
        return True
    thick = sides[0] < config.thick_door * sides[1]
    return bool(upright and thick and sides[0] < config.panel_thinness * np.sqrt(sides[1] * sides[2]))


def _walls(cache: PartCache, parent: int, frame: BoxFrame) -> BoolArray:
    """Test whether the parent is in the way from the child's centre along +x, +y, +z, -x, -y, -z of its frame."""
    steps = cache.diagonal * np.concatenate([frame.axes, -frame.axes])
    hits = cache.first_hits(parent, np.tile(frame.centre, (6, 1)), steps)
    return np.isfinite(hits)


def _inside(cache: PartCache, child: int, frame: BoxFrame, body_box: FloatArray) -> float:
    local = frame.local(cache.samples(child).points)
    margin = 0.01 * np.max(body_box[1] - body_box[0])
    return float(np.all((local > body_box[0] + margin) & (local < body_box[1] - margin), axis=1).mean())


def _subtree(tree: KinematicTree, part: int) -> set[int]:
    found, queue = {part}, [part]
    for node in queue:
        found.update(tree.children[node])
        queue.extend(tree.children[node])
    return found


def _smallness(parent: BoxFrame, child: BoxFrame, config: JointsConfig) -> float:
    ratio = child.diagonal / max(parent.diagonal, 1e-12)
    return float(np.clip((config.small_none - ratio) / (config.small_none - config.small_full), 0.0, 1.0))


def _outward(frame: BoxFrame, body_box: FloatArray) -> FloatArray:
    """The side of the panel that is nearer to the outside of the body."""
    k = frame.thin
    to_lower = 0.5 * (frame.slab_lower[k] + frame.slab_upper[k]) - body_box[0, k]
    to_upper = body_box[1, k] - 0.5 * (frame.slab_lower[k] + frame.slab_upper[k])
    if abs(to_lower - to_upper) < 0.1 * (body_box[1, k] - body_box[0, k]):
        return np.zeros(3)
    return np.asarray(frame.axes[k] * (1.0 if to_upper < to_lower else -1.0))


def _handle(cache: PartCache, tree: KinematicTree, child: int, frame: BoxFrame, outward: FloatArray) -> Handle | None:
    """Bump beyond the slab (on the outer side if that is known), else the parts that hang on the child."""
    points = cache.samples(child).points
    local = frame.local(points)
    k = frame.thin
    margin = 0.02 * float(np.max(frame.extents))
    above = local[:, k] > frame.slab_upper[k] + margin
    below = local[:, k] < frame.slab_lower[k] - margin
    side = float(outward @ frame.axes[k])
    bump = above if side > 0 else below if side < 0 else above | below
    if bump.sum() >= max(4, 0.001 * len(points)):
        return _handle_of(points[bump], frame)
    hanging = [cache.samples(part).points for part in tree.children[child]]
    return _handle_of(np.concatenate(hanging), frame) if hanging else None


def _handle_of(points: FloatArray, frame: BoxFrame) -> Handle:
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    spread = np.ptp(frame.local(points), axis=0)
    longest = int(np.argmax(spread))
    others = np.delete(spread, longest).max()
    long_enough = spread[longest] > 2.0 * others
    return Handle(centre=centre, direction=frame.axes[longest] if long_enough else np.zeros(3))
