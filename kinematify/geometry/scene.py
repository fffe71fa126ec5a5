"""The bodies of a model, what joins them, and where they stand in many configurations at once."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from hashlib import blake2b
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.solid import Solid, merged_corners
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.robot import rigid_groups
from kinematify.robot.transforms import transformed
from kinematify.robot.vectors import as_one, referenced

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.config.validation import GeometrySettings
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import Travel
    from kinematify.robot.robot import Joint, Link, RigidGroup, Robot, Shape

Pair = tuple[int, int]
"""Two bodies, the smaller index first."""

_UNIT_SHARE = 1e-3  # of the model's size: a good unit for FCL, which takes short lengths for none


@dataclass(frozen=True, kw_only=True, eq=False)
class SceneBody:
    """Links that fixed joints hold together; frame: that of the link nearest the root."""

    name: str
    """First link that has geometry."""
    links: tuple[str, ...]
    group: int
    """Index among all rigid groups, those without geometry included."""
    solid: Solid
    shapes: tuple[FloatArray, ...]
    """Corners of each declared shape, body frame [m], shape (V, 3): an engine sees the hull of each."""


@dataclass(frozen=True, kw_only=True)
class Connection:
    """Two bodies with nothing but joints (and frames without geometry) between them."""

    parent: int
    child: int
    joints: tuple[str, ...]
    """From the parent to the child."""

    @property
    def pair(self) -> Pair:
        """Both bodies, the smaller index first."""
        return min(self.parent, self.child), max(self.parent, self.child)


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """A model as geometry in motion."""

    model: Robot
    mechanism: LeaderMechanism
    bodies: tuple[SceneBody, ...]
    """In the order of the tree, parents before children; only those with geometry."""
    settings: GeometrySettings
    unit: float
    """Length of one unit of all FCL trees [m]."""
    solids: dict[bytes, Solid] = field(default_factory=dict)
    """Solids by what they are made of: other scenes of the model take those that are the same, with their trees."""

    @property
    def travels(self) -> tuple[Travel, ...]:
        """Joints that lead, with their ranges."""
        return self.mechanism.travels

    def standing(self, leaders: Mapping[str, float]) -> Scene:
        """The same model with some leaders resting elsewhere [rad or m]."""
        mechanism = replace(self.mechanism, standing={**self.mechanism.standing, **leaders})
        return replace(self, mechanism=mechanism)

    @cached_property
    def size(self) -> float:
        """Diagonal of the model's box at rest [m]."""
        placed = zip(self.bodies, self.at_rest, strict=True)
        corners = np.concatenate([transformed(box_corners(body.solid), T) for body, T in placed])
        return float(np.linalg.norm(np.ptp(corners, axis=0)))

    @cached_property
    def at_rest(self) -> FloatArray:
        """Pose of every body at rest, shape (B, 4, 4)."""
        return np.asarray(self.poses(self.mechanism.rest[None])[0])

    @cached_property
    def connections(self) -> tuple[Connection, ...]:
        """Every body with its nearest ancestor that has geometry."""
        body_of = {body.group: index for index, body in enumerate(self.bodies)}
        found = []
        for index, body in enumerate(self.bodies):
            joints, group = [], body.group
            while self._above[group] is not None:
                joint, group = self._above[group] or ("", 0)
                joints.append(joint)
                if group in body_of:
                    found.append(Connection(parent=body_of[group], child=index, joints=tuple(reversed(joints))))
                    break
        return tuple(found)

    @cached_property
    def connection_of(self) -> dict[Pair, Connection]:
        """Connections keyed by their pair."""
        return {connection.pair: connection for connection in self.connections}

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """All pairs of bodies."""
        return tuple(combinations(range(len(self.bodies)), 2))

    def name(self, pair: Pair) -> tuple[str, str]:
        """Names of both bodies."""
        return self.bodies[pair[0]].name, self.bodies[pair[1]].name

    def between(self, pair: Pair) -> frozenset[int]:
        """Leaders that change where the two bodies stand to each other."""
        ways = [self._ways[self.bodies[index].group] for index in pair]
        leads = self.mechanism.leads
        joints = {name: k for k, name in enumerate(self.mechanism.joints)}
        moving = [leads[joints[name]] for name in ways[0] ^ ways[1]]
        return frozenset(np.flatnonzero(np.any(np.abs(moving) > 0.0, axis=0)).tolist() if moving else ())

    def carries(self, pair: Pair) -> bool:
        """True if one of the two bodies carries the other, perhaps with bodies between them."""
        first, second = (self._ways[self.bodies[index].group] for index in pair)
        return first <= second or second <= first

    @cached_property
    def affected(self) -> tuple[tuple[Pair, ...], ...]:
        """For every leader the pairs that it moves against each other."""
        between = {pair: self.between(pair) for pair in self.pairs}
        return tuple(
            tuple(pair for pair in self.pairs if leader in between[pair]) for leader in range(len(self.travels))
        )

    def poses(self, leaders: FloatArray) -> FloatArray:
        """Pose of every body in the frame of the root link, rows of leaders (n, leaders) -> (n, B, 4, 4)."""
        values = self.mechanism.all_values(leaders)
        column = {name: k for k, name in enumerate(self.mechanism.joints)}
        poses = np.broadcast_to(np.eye(4), (len(leaders), len(self._groups), 4, 4)).copy()
        for group, joint, above, T_above_joint in self._steps:
            motion = joint.motions(values[:, column[joint.name]])
            poses[:, group] = poses[:, above] @ T_above_joint @ motion
        return np.ascontiguousarray(poses[:, [body.group for body in self.bodies]])

    @cached_property
    def _groups(self) -> tuple[RigidGroup, ...]:
        return rigid_groups(self.model)

    @cached_property
    def _above(self) -> list[tuple[str, int] | None]:
        """Joint above each group and the group that it hangs on."""
        group_of = {link: index for index, group in enumerate(self._groups) for link in group.links}
        above = self.model.joint_above
        joints = [above.get(group.top) for group in self._groups]
        return [None if joint is None else (joint.name, group_of[joint.parent]) for joint in joints]

    @cached_property
    def _ways(self) -> list[frozenset[str]]:
        """Joints between the root and each group."""
        ways: list[frozenset[str]] = []
        for above in self._above:
            ways.append(frozenset() if above is None else ways[above[1]] | {above[0]})
        return ways

    @cached_property
    def _steps(self) -> list[tuple[int, Joint, int, FloatArray]]:
        """Group, joint above it, group above it, and the joint's frame at zero in that group's frame."""
        inside = {link: T for group in self._groups for link, T in placed_links(self.model, group).items()}
        joints = self.model.joint_by_name
        return [
            (index, joints[above[0]], above[1], inside[joints[above[0]].parent] @ joints[above[0]].T_parent_child)
            for index, above in enumerate(self._above)
            if above is not None
        ]


def judged_shapes(link: Link) -> tuple[Shape, ...]:
    """Collision geometry, or visual geometry where there is none."""
    return link.collisions or link.visuals


def colliding_shapes(link: Link) -> tuple[Shape, ...]:
    """Collision geometry alone: what engines see of a link."""
    return link.collisions


def visible_shapes(link: Link) -> tuple[Shape, ...]:
    """Visual geometry; frames, rotors and sensors that only collide are not seen."""
    return link.visuals


def simplified(model: Robot) -> bool:
    """True if the collision geometry of some link is not simply its visual geometry, where there is any."""

    def described(shapes: tuple[Shape, ...]) -> list[tuple[object, ...]]:
        return [(shape.kind, shape.file, shape.size, shape.T_link_shape.tobytes()) for shape in shapes]

    colliding = [link for link in model.links if link.collisions]
    differ = any(described(link.visuals) != described(link.collisions) for link in colliding)
    return differ and any(link.visuals for link in model.links)


def read_scene(
    model: Robot,
    settings: GeometrySettings,
    shapes_of: Callable[[Link], tuple[Shape, ...]] = judged_shapes,
    *,
    by_link: bool = False,
    solids: dict[bytes, Solid] | None = None,
    thin: bool = False,
) -> Scene:
    """Gather the geometry of the bodies; nothing is measured yet.

    Args:
        model: The robot with its meshes.
        settings: How solids are made.
        shapes_of: Which shapes of a link count; a body without any is judged by all that it has.
        by_link: Links that fixed joints hold together are bodies of their own, in the frame of the link nearest the
            root.
        solids: `Scene.solids` of another scene with the same settings; added to.
        thin: Simplify meshes with more than `most_faces` triangles when they are first measured.
    """
    solids = {} if solids is None else solids
    parts = [
        (index, links, _shapes(model, links, shapes_of) or _shapes(model, links, judged_shapes))
        for index, group in enumerate(rigid_groups(model))
        for placed in [placed_links(model, group)]
        for links in ([{name: T} for name, T in placed.items()] if by_link else [placed])
    ]
    solid = [(index, links, shapes) for index, links, shapes in parts if any(len(faces) for _, faces in shapes)]
    corners = [vertices for _, _, shapes in solid for vertices, _ in shapes]
    largest = max(
        (float(np.linalg.norm(np.ptp(vertices, axis=0))) for vertices in corners if len(vertices)), default=1.0
    )
    unit = _UNIT_SHARE * max(largest, 1e-9)
    return Scene(
        model=model,
        mechanism=LeaderMechanism(robot=model),
        bodies=tuple(
            SceneBody(
                name=next(name for name in links if model.link_by_name[name].has_geometry),
                links=tuple(links),
                group=index,
                solid=_solid(shapes, unit, settings, solids, thin=thin),
                shapes=tuple(referenced(vertices, faces) for vertices, faces in shapes if len(faces)),
            )
            for index, links, shapes in solid
        ),
        settings=settings,
        unit=unit,
        solids=solids,
    )


def placed_links(model: Robot, group: RigidGroup) -> dict[str, FloatArray]:
    """Pose of every link of a group in the frame of its top link, shape (4, 4) each."""
    placed = {group.top: np.eye(4)}
    for name in group.links[1:]:
        joint = model.joint_above[name]
        placed[name] = placed[joint.parent] @ joint.T_parent_child
    return placed


def _shapes(
    model: Robot, placed: Mapping[str, FloatArray], shapes_of: Callable[[Link], tuple[Shape, ...]]
) -> list[tuple[FloatArray, IntArray]]:
    """Vertices (V, 3) and faces (F, 3) of every shape of some links, each link at its pose."""
    return [
        (transformed(shape.mesh.vertices, T), shape.mesh.faces)
        for name, T in placed.items()
        for shape in shapes_of(model.link_by_name[name])
    ]


def _solid(
    shapes: Sequence[tuple[FloatArray, IntArray]],
    unit: float,
    settings: GeometrySettings,
    known: dict[bytes, Solid],
    *,
    thin: bool,
) -> Solid:
    """The solid of some shapes, the known one where one was made of the same numbers."""
    vertices, faces = as_one(shapes)
    made_of = blake2b(repr((unit, len(vertices))).encode())
    made_of.update(vertices.tobytes())
    made_of.update(faces.tobytes())
    key = made_of.digest()
    if key not in known:
        large = thin and any(len(faces) > settings.most_faces for _, faces in shapes)
        known[key] = Solid(
            vertices,
            faces,
            unit=unit,
            hole=settings.hole,
            points=settings.points,
            measured=(lambda: as_one([_thinned(*shape, settings.most_faces) for shape in shapes])) if large else None,
        )
    return known[key]


def _thinned(vertices: FloatArray, faces: IntArray, most: int) -> tuple[FloatArray, IntArray]:
    """A shape of at most `most` triangles."""
    if len(faces) <= most:
        return vertices, faces
    import fast_simplification  # noqa: PLC0415 - for large meshes only

    vertices, faces = merged_corners(vertices, faces)
    if len(faces) > most:
        vertices, faces = fast_simplification.simplify(vertices, faces, target_count=most)
    return np.asarray(vertices, dtype=np.float64), np.asarray(faces, dtype=np.int64)


def box_corners(solid: Solid) -> FloatArray:
    """Corners of a solid's box, body frame [m], shape (8, 3)."""
    return np.stack(np.meshgrid(*zip(solid.low, solid.high, strict=True), indexing="ij"), axis=-1).reshape(8, 3)


def relative(poses: FloatArray, pair: Pair) -> FloatArray:
    """Pose of the second body in the frame of the first one, shape (n, 4, 4), from poses (n, B, 4, 4)."""
    first, second = poses[:, pair[0]], poses[:, pair[1]]
    turned_back = first[:, :3, :3].transpose(0, 2, 1)
    result = np.zeros_like(second)
    result[:, :3, :3] = turned_back @ second[:, :3, :3]
    result[:, :3, 3] = np.einsum("nij,nj->ni", turned_back, second[:, :3, 3] - first[:, :3, 3])
    result[:, 3, 3] = 1.0
    return result


def inverse(T: FloatArray) -> FloatArray:
    """Inverses of rigid transforms, shape (n, 4, 4)."""
    result = np.zeros_like(T)
    result[:, :3, :3] = T[:, :3, :3].transpose(0, 2, 1)
    result[:, :3, 3] = -np.einsum("nij,nj->ni", result[:, :3, :3], T[:, :3, 3])
    result[:, 3, 3] = 1.0
    return result
