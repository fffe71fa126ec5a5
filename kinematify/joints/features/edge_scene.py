"""All that is known of one parent-child pair before a joint is proposed: frames, shape, contact, handle, bearing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.bearings.scores import BearingLine
from kinematify.joints.features.frames import UP, body_axes, box_frame
from kinematify.joints.features.journal import held_journal
from kinematify.robot.vectors import crossed, unit

if TYPE_CHECKING:
    from kinematify.config import JointsConfig
    from kinematify.contact.tree import KinematicTree
    from kinematify.geometry.sampling import SurfaceSamples
    from kinematify.joints.bearings.scores import EdgeBearing, Rail
    from kinematify.joints.features.frames import BoxFrame
    from kinematify.joints.features.journal import Journal
    from kinematify.joints.features.workspace import ContactView, PartCache
    from kinematify.robot.arrays import BoolArray, FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Handle:
    """Handle that a person pulls: a bump on the outer side of a panel, or small parts mounted on it."""

    centre: FloatArray
    """World frame [m], shape (3,)."""
    direction: FloatArray
    """Unit direction of a long handle, zero for a short one, shape (3,)."""


class TreeScenes:
    """A tree of parts, and what all scenes of its edges share."""

    def __init__(self, cache: PartCache, tree: KinematicTree, config: JointsConfig) -> None:
        """Find the box frames of the parts.

        Args:
            cache: The parts.
            tree: Parent of every part.
            config: Weights and thresholds.
        """
        self.cache, self.tree, self.config = cache, tree, config
        root = cache.samples(tree.root)
        body = body_axes(root.normals, root.areas)
        self.frames: dict[int, BoxFrame] = {}
        """Box frame of every part; that of the root prefers the upright frame of the body, others their parent's."""
        for above, part in [(-1, tree.root), *tree.edges()]:
            preferred = [self.frames[above].axes, body] if above in self.frames else [body]
            self.frames[part] = box_frame(cache.corners(part), cache.samples(part), preferred, config.frames)

    def scene(self, edge: tuple[int, int], bearing: EdgeBearing | None) -> JointScene:
        """The edge (parent, child), whose contact has a bearing."""
        return JointScene(whole=self, parent=edge[0], child=edge[1], fitted=bearing)

    def rolls(self, part: int) -> bool:
        """True if a part is a disc standing on the floor on which the whole object stands."""
        assembly, frame = self.cache.assembly, self.frames[part]
        level = abs(float(frame.thin_axis @ UP)) < 0.1
        lowest = assembly.parts[part].bounds[0, 2] - assembly.bounds[0, 2]
        return bool(level and lowest < 0.01 * self.cache.diagonal and self.disc(part) > 0.5)

    def foot_side(self, part: int, body: int) -> FloatArray:
        """Unit level direction from the middle of a body to a small part at a side of its foot, else zero, shape (3,).

        A pedal is where the user's foot is, in front. A bin on two wheels is tipped back onto them, so they are behind.
        """
        config, frame, bounds = self.config.front_cues, self.frames[part], self.cache.assembly.parts[body].bounds
        extents = bounds[1] - bounds[0]
        middle = 0.5 * (frame.lower + frame.upper) @ frame.axes
        offset = (middle - bounds.mean(axis=0)) * (1.0, 1.0, 0.0)
        distance = float(np.linalg.norm(offset))
        small = frame.diagonal < config.small * float(np.linalg.norm(extents))
        low = middle[2] - bounds[0, 2] < config.low * extents[2]
        aside = distance > config.aside * 0.5 * float(extents[:2].min())
        return np.asarray(offset / distance) if small and low and aside else np.zeros(3)

    def disc(self, part: int) -> float:
        """Return how round a part is seen along its thin direction, 0 for a square, 1 for a disc."""
        frame = self.frames[part]
        plane = np.delete(np.arange(3), frame.thin)
        flat = frame.local(self.cache.samples(part).points)[:, plane] - (frame.centre @ frame.axes.T)[plane]
        angles = np.arctan2(flat[:, 1], flat[:, 0])
        sector = np.floor((angles + np.pi) / (2 * np.pi) * 16).astype(np.int64) % 16
        radius = np.zeros(16)
        np.maximum.at(radius, sector, np.linalg.norm(flat, axis=1))
        ratio = float(radius.min() / max(float(radius.max()), 1e-12))
        return float(np.clip((ratio - 0.75) / 0.15, 0.0, 1.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class JointScene:
    """One tree edge with everything that the cues look at, each when first asked for; metres, world frame."""

    whole: TreeScenes
    parent: int
    child: int
    fitted: EdgeBearing | None
    """Bearing of the contact, as it was fitted."""

    @property
    def cache(self) -> PartCache:
        """Samples and distances of all parts."""
        return self.whole.cache

    @property
    def config(self) -> JointsConfig:
        """Weights and thresholds."""
        return self.whole.config

    @property
    def frame(self) -> BoxFrame:
        """Box frame of the child."""
        return self.whole.frames[self.child]

    @property
    def parent_frame(self) -> BoxFrame:
        """Box frame of the parent, along its own axes."""
        return self.whole.frames[self.parent]

    @property
    def samples(self) -> SurfaceSamples:
        """Surface samples of the child."""
        return self.cache.samples(self.child)

    @property
    def parent_samples(self) -> SurfaceSamples:
        """Surface samples of the parent."""
        return self.cache.samples(self.parent)

    @property
    def diagonal(self) -> float:
        """Diagonal of the assembly [m]."""
        return self.cache.diagonal

    @property
    def bounds(self) -> FloatArray:
        """Lower and upper corner of the child, world frame [m], shape (2, 3)."""
        return self.cache.assembly.parts[self.child].bounds

    @property
    def parent_bounds(self) -> FloatArray:
        """Lower and upper corner of the parent, world frame [m], shape (2, 3)."""
        return self.cache.assembly.parts[self.parent].bounds

    @property
    def centre(self) -> FloatArray:
        """Centre of the child's slab, shape (3,)."""
        return self.frame.centre

    @cached_property
    def body_box(self) -> FloatArray:
        """Lower and upper corner of the parent along the child's axes [m], shape (2, 3)."""
        local = self.frame.local(self.cache.corners(self.parent))
        return np.stack([local.min(axis=0), local.max(axis=0)])

    @cached_property
    def contact(self) -> ContactView:
        """Where the child touches its parent."""
        return self.cache.contact(self.parent, self.child, self.config.contact_band * self.diagonal)

    @property
    def anchor(self) -> FloatArray:
        """Centroid of the contact, the child's centre without one [m], shape (3,)."""
        return self.contact.centroid if len(self.contact.points) else self.centre

    @cached_property
    def others(self) -> tuple[int, ...]:
        """Obstacles besides the parent: every part outside the child's subtree."""
        moving = self.whole.tree.subtree(self.child)
        return tuple(part for part in range(len(self.whole.tree.parents)) if part != self.parent and part not in moving)

    @cached_property
    def outward(self) -> FloatArray:
        """Unit normal of the panel away from the body along the child's thin direction, zero if undecided, (3,)."""
        frame, body, k = self.frame, self.body_box, self.frame.thin
        middle = 0.5 * (frame.slab_lower[k] + frame.slab_upper[k])
        to_lower, to_upper = middle - body[0, k], body[1, k] - middle
        if abs(to_lower - to_upper) < 0.1 * (body[1, k] - body[0, k]):
            return np.zeros(3)
        return np.asarray(frame.axes[k] * (1.0 if to_upper < to_lower else -1.0))

    @cached_property
    def handle(self) -> Handle | None:
        """Bump beyond the slab (on the outer side if that is known), else the parts that hang on the child."""
        points, frame = self.samples.points, self.frame
        height, k = frame.local(points)[:, frame.thin], frame.thin
        margin = 0.02 * float(np.max(frame.extents))
        above, below = height > frame.slab_upper[k] + margin, height < frame.slab_lower[k] - margin
        side = float(self.outward @ frame.axes[k])
        bump = above if side > 0 else below if side < 0 else above | below
        if bump.sum() >= max(4, 0.001 * len(points)):
            return _handle_of(points[bump], frame)
        hanging = [self.cache.samples(part).points for part in self.whole.tree.children[self.child]]
        return _handle_of(np.concatenate(hanging), frame) if hanging else None

    @cached_property
    def smallness(self) -> float:
        """1 for a part that is small beside its parent, 0 for a large one."""
        none, full = self.config.small_none, self.config.small_full
        ratio = self.frame.diagonal / max(self.parent_frame.diagonal, 1e-12)
        return float(np.clip((none - ratio) / (none - full), 0.0, 1.0))

    @property
    def panel(self) -> bool:
        """The slab is thin, and the part is not small."""
        return self.plate and self.smallness < 1.0

    @cached_property
    def plate(self) -> bool:
        """The slab is thin, whatever its size; narrow doors of fridges are thick, but high."""
        sides, thin = np.sort(self.frame.extents), self.config.panel_thinness
        if sides[0] < thin * sides[1]:
            return True
        thick = sides[0] < self.config.thick_door * sides[1]
        return bool(self.upright and thick and sides[0] < thin * np.sqrt(sides[1] * sides[2]))

    @cached_property
    def disc(self) -> float:
        """How round the part is seen along its thin direction, 0 for a square, 1 for a disc."""
        return self.whole.disc(self.child)

    @property
    def _thin_up(self) -> float:
        return abs(float(self.frame.thin_axis @ UP))

    @property
    def upright(self) -> bool:
        """The thin direction lies flat, as in a closed door."""
        return self._thin_up < self.config.upright_cosine

    @property
    def flat(self) -> bool:
        """The thin direction points up, as in a closed lid."""
        return self._thin_up > self.config.flat_cosine

    @cached_property
    def lines(self) -> tuple[BearingLine, ...]:
        """Bearing lines of the contact, best first; the journal stands before them where there is one."""
        lines, journal = () if self.fitted is None else self.fitted.lines, self.journal
        if journal is None:
            return lines
        both = journal.coverage, journal.coverage
        score = max((line.score for line in lines), default=0.0) + journal.coverage
        return BearingLine(axis=journal.axis, pivot=journal.pivot, score=score, surfaces=both, rings=both), *lines

    @cached_property
    def journal(self) -> Journal | None:
        """The line about which the parent holds the child all around; not looked for in trees of joints in series."""
        size = float(self.frame.extents.max())
        return None if self.serial else held_journal(self.cache, self.parent, self.child, size, self.config)

    @cached_property
    def serial(self) -> bool:
        """The tree has several joints in series, as arms, legs and hands have."""
        return max(self.whole.tree.depths) >= self.config.serial_depth

    @cached_property
    def has_bearing(self) -> bool:
        """The best line of the bearing passes the gate."""
        return self.journal is not None or self._passes_gate

    @property
    def _passes_gate(self) -> bool:
        """Either round surface and circles on both parts, or so much round surface that it needs no circles."""
        if not self.lines:
            return False
        line, contact, gate = self.lines[0], self.contact, self.config.gate
        if line.surface * line.circles > gate.product:
            return True
        m = len(contact.parent_points)
        child = located_support(contact.points, contact.normals, contact.weights, line)
        parent = located_support(contact.parent_points, contact.parent_normals, np.full(m, 1.0 / max(m, 1)), line)
        return bool(np.sqrt(max(child * parent, 0.0)) > gate.located)

    @property
    def rail(self) -> Rail | None:
        """Direction along which the contact is extruded."""
        return None if self.fitted is None else self.fitted.rail

    @property
    def _best_score(self) -> float:
        """Score of the best bearing line; 0 without one."""
        return self.lines[0].score if self.lines else 0.0

    @property
    def rail_score(self) -> float:
        """Score of the contact's rail; 0 without one."""
        return self.rail.score if self.rail else 0.0

    @cached_property
    def rail_lead(self) -> float:
        """Score of the contact's rail over that of its best line; 0 without a rail."""
        return self.rail_score / max(self._best_score, 1e-3)

    @cached_property
    def prismatic_score(self) -> float:
        """1 where both sides of the contact are extruded far more clearly than they are round, as on a linear guide."""
        rails = self.config.rails
        strong = np.interp(self.rail_score, (rails.score_none, rails.score_full), (0.0, 1.0))
        return float(strong * np.interp(self.rail_lead, (rails.lead_none, rails.lead_full), (0.0, 1.0)))

    @property
    def _is_round(self) -> bool:
        """The contact is about as round as it is extruded, or more; where it is neither, that says nothing."""
        rails = self.config.rails
        return self._best_score >= rails.rounded_least and 0.0 < self.rail_lead < rails.rounded_lead

    @cached_property
    def compact(self) -> float:
        """1 where the contact is a small patch of the child, as in a machine's joint; 0 where it is spread out."""
        contact, none = self.contact, self.config.spread_none
        if len(contact.points) == 0:
            return 0.0
        spread = np.sqrt(contact.weights @ np.sum((contact.points - contact.centroid) ** 2, axis=1))
        ratio = spread / (0.5 * self.frame.diagonal)
        return float(np.clip((none - ratio) / (none - self.config.spread_full), 0.0, 1.0))

    @property
    def mechanism(self) -> float:
        """1 in a linkage (compact contact, or a tree of several joints in series), 0 for furniture."""
        return 1.0 if self.serial else self.compact

    @property
    def on_top(self) -> bool:
        """The child lies above most of its parent."""
        low, high = self.parent_bounds[:, 2]
        return bool(self.centre[2] > low + 0.75 * (high - low))

    @property
    def parent_moves(self) -> bool:
        """The parent is itself moved by a joint."""
        return self.parent != self.whole.tree.root

    def walls(self, ways: FloatArray) -> BoolArray:
        """Whether the parent is in the way from the child's centre along unit directions (n, 3), shape (n,)."""
        centres = np.tile(self.centre, (len(ways), 1))
        return np.isfinite(self.cache.first_hits(self.parent, centres, self.diagonal * ways))

    @cached_property
    def _walls(self) -> BoolArray:
        """The same along +x, +y, +z, -x, -y, -z of its frame."""
        return self.walls(np.concatenate([self.frame.axes, -self.frame.axes]))

    @property
    def enclosed(self) -> float:
        """Share of the six directions from the child's centre in which the parent stands in the way."""
        return float(self._walls.mean())

    @property
    def covered(self) -> bool:
        """The parent stands above the child's centre as well as below it."""
        upright = np.abs(np.concatenate([self.frame.axes, -self.frame.axes]) @ UP) > self.config.flat_cosine
        return bool(self._walls[upright].all())

    @cached_property
    def inside(self) -> float:
        """Share of the child's surface that lies inside the parent's box."""
        local, (low, high) = self.frame.local(self.samples.points), self.body_box
        margin = 0.01 * np.max(high - low)
        return float(np.all((local > low + margin) & (local < high - margin), axis=1).mean())

    @cached_property
    def rolls(self) -> bool:
        """The child is a disc standing on the floor."""
        return self.whole.rolls(self.child)

    @property
    def _stands(self) -> bool:
        """The parent reaches the floor, or nearly so, as a bin on wheels."""
        bounds = self.cache.assembly.bounds
        rise = self.parent_bounds[0, 2] - bounds[0, 2]
        return bool(rise < self.config.front_cues.low * np.ptp(bounds[:, 2]))

    @cached_property
    def front(self) -> FloatArray:
        """Of lids, level direction in which the front of the parent looks as its foot tells, else zero, shape (3,)."""
        front = np.zeros(3)
        if not (self.panel and self.flat and self._stands):
            return front
        for part in self.whole.tree.children[self.parent]:
            rolls = self.whole.rolls(part)
            if rolls or self.whole.frames[part].is_level_plate:
                front += self.whole.foot_side(part, self.parent) * (-1.0 if rolls else 1.0)
        length = float(np.linalg.norm(front))
        # Feet or castors all around cancel out.
        return front / length if length > self.config.front_cues.agreeing else np.zeros(3)

    @cached_property
    def pedal_direction(self) -> FloatArray:
        """Level direction from the parent to the child where that is a pedal, else zero, shape (3,)."""
        stands = self.frame.is_level_plate and self._stands
        return self.whole.foot_side(self.child, self.parent) if stands else np.zeros(3)

    @cached_property
    def twins(self) -> tuple[BoxFrame, ...]:
        """Box frames of congruent siblings that carry nothing; none where the child itself carries something."""
        tree = self.whole.tree
        alike = () if tree.children[self.child] else self.cache.graph.alike.others(self.child)
        siblings = (part for part in alike if tree.parents[part] == self.parent and not tree.children[part])
        return tuple(self.whole.frames[part] for part in siblings)

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
        distance = float(np.linalg.norm(apart_line))
        apart_line = apart_line / max(distance, 1e-12)
        closing = abs(float(apart_line @ self.frame.thin_axis))
        parallel = abs(float(apart_line @ twin.thin_axis))
        facing = min(closing, parallel) > np.cos(np.radians(3.0)) and not self.plate and self.smallness < 1.0
        # Buttons of a door are no fingers.
        chain_end = (self.whole.tree.depths[self.child] >= 2 and self.smallness < 1.0) or facing
        apart = distance < 2.0 * float(self.parent_frame.extents.max())
        return bool(chain_end and self.inside < 0.8 and apart and not self.has_bearing and not self._is_round)

    @property
    def grips(self) -> FloatArray:
        """Unit direction from a finger to its twin, shape (1, 3); (0, 3) for all other parts."""
        offsets = [twin.centre - self.centre for twin in self.twins] if self.gripping else []
        lengths = [(offset, np.linalg.norm(offset)) for offset in offsets]
        return np.array([offset / long for offset, long in lengths if long > 1e-6 * self.diagonal]).reshape(-1, 3)


def located_support(points: FloatArray, normals: FloatArray, weights: FloatArray, line: BearingLine) -> float:
    """Share of an area that turns into itself about a line, counted by how well it locates the line, in [0, 1].

    Unlike the surface score of a bearing, flat area across the axis counts nothing here.
    """
    if len(points) == 0:
        return 0.0
    offset = points - line.pivot
    radial = offset - (offset @ line.axis)[:, None] * line.axis
    miss = np.einsum("ij,ij->i", crossed(line.axis, unit(radial)), normals)
    fit = weights * np.exp(-((miss / np.sin(np.radians(3.0))) ** 2))
    across = normals - (normals @ line.axis)[:, None] * line.axis
    return float(2.0 * np.linalg.eigvalsh((across * fit[:, None]).T @ across)[1] / max(float(weights.sum()), 1e-300))


def _handle_of(points: FloatArray, frame: BoxFrame) -> Handle:
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    spread = np.ptp(frame.local(points), axis=0)
    longest = int(np.argmax(spread))
    others = np.delete(spread, longest).max()
    long_enough = spread[longest] > 2.0 * others
    return Handle(centre=centre, direction=frame.axes[longest] if long_enough else np.zeros(3))
