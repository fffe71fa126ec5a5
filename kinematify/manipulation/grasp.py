"""Where a parallel gripper takes hold of a moving part: handles, knobs and rims, found from geometry alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import fcl
import numpy as np

from kinematify.errors import InputError
from kinematify.manipulation.grasp_search import (
    FINGER_LENGTH,
    FINGER_THICKNESS,
    FINGER_WIDTH,
    KNOB_WIDTH,
    PALM_LENGTH,
    PLENTY,
    POINTS_SEEN,
    TIP,
    GraspSearch,
)
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import pose_at
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.geometry.scene import Scene
    from kinematify.manipulation.grasp_search import Candidates
    from kinematify.robot.arrays import FloatArray

    BoolArray = NDArray[np.bool_]

HANDLE, KNOB, RIM = "handle", "knob", "rim"

PALM_WIDTH = 0.15
"""Along the closing direction [m]."""
PALM_THICKNESS = 0.055
"""Across approach and closing direction [m]."""
APPROACH = 0.06
"""The hand comes in along a straight line from so far off [m]."""
SLACK = 0.006  # an arm arrives with an error of 1 to 2 mm
"""Room between pad and surface on either side before the fingers close [m]."""
SLACK_SHARE = 0.15  # small grippers are positioned the more carefully
"""The same at most, fraction of the opening of the gripper."""
LEVER_WEIGHT = 0.4  # the force that opens a door falls with the lever
"""Share of the lever arm in the rank."""
CLEARANCE_WEIGHT = 0.2
"""Share of the room beside the fingers."""
PULL_WEIGHT = 0.2
"""Share of how the motion pulls: along the fingers or onto a pad, better than sideways out of them."""
HANDLE_WEIGHT = 0.2
"""Share of what is made to be held: handles and knobs, not rims."""
SAME_PLACE = 0.04
"""Grasps closer than this with nearly the same directions are one [m]."""
SAME_DEG = 25.0
"""The same for their directions [deg]."""
TRIES = 800  # 0.2 ms each
"""Candidates whose room is checked exactly, the best first."""
MOST = 60  # all directions from which a handle can be held: not each one can be followed
"""Grasps that are returned at most."""
NEAR_POINT = 0.04  # half of a hand's width
"""Grasps belong to a point that the user gave up to this distance [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Grasp:
    """One way to hold a part; turning it by half a turn about the approach direction holds it as well."""

    T_link_grasp: FloatArray
    """Pose in the frame of the joint's child link: +z approaches, +y closes, origin between the pads, shape (4, 4)."""
    width: float
    """Of what is held [m]."""
    spread: float
    """Gap between the pads for which the way in was found free [m]."""
    clearance: float
    """Room beside the fingers, the smaller of both sides [m]."""
    lever: float
    """Hinges: distance from the axis, or half the width where the grasp turns about its own approach direction [m].
    Slides: distance from the middle of the part across the axis; pulling there tilts the part [m]."""
    kind: str
    """``handle``, ``knob`` (small both ways) or ``rim`` (of a plate that goes on behind it)."""
    held: str
    """Body that is held: the joint's own, or one that it carries."""
    score: float
    """Rank in [0, 1]."""


def search_grasps(
    scene: Scene,
    joint: str,
    opening: float,
    *,
    point: FloatArray | None = None,
    leaders: FloatArray | None = None,
    seed: int = 0,
) -> tuple[list[Grasp], str]:
    """Find where a gripper can hold what a joint moves.

    Args:
        scene: The object, in metres, z up.
        joint: Joint that leads.
        opening: Largest gap between the pads [m].
        point: Hold it there, frame of the root link [m], shape (3,); anywhere if None.
        leaders: Values of all leading joints [rad or m], shape (leaders,); rest if None.
        seed: Of the places that are looked at.

    Returns:
        Grasps, the best first, and why there are none.

    Raises:
        InputError: The object has no such leading joint, or `point` is not on what it moves.
    """
    slack = min(SLACK, SLACK_SHARE * opening)  # small grippers are positioned the more carefully
    values = scene.mechanism.rest if leaders is None else leaders
    poses = scene.poses(values[None])[0]
    bodies, carried = moved_bodies(scene, joint)
    if point is not None:
        moved = [*bodies, *carried]
        nearest = min((distance_to(scene, poses, body, point) for body in moved), default=np.inf)
        if nearest > NEAR_POINT:
            raise InputError(
                f"The grasp point {point.tolist()} is {nearest:.3f} m from what {joint} moves "
                f"({', '.join(scene.bodies[body].name for body in moved) or 'nothing with geometry'}); a point on it "
                f"is at most {NEAR_POINT} m off. Give it in metres in the frame of the root link."
            )
    grasps, reason = list[Grasp](), f"Nothing that {joint} moves has geometry."
    for body in [*bodies, *carried]:
        search = GraspSearch(scene, poses, body, slack)
        places = search.places(seed) if point is None else _around(point, seed)
        candidates, counts = search.candidates(places, opening)
        ranked = _Ranked(scene, joint, values, search, candidates)
        grasps = _distinct(ranked, _Room(scene, poses), scene.bodies[body].name, slack)
        reason = _reason(*counts, opening)
        if grasps:
            break
    return grasps, reason


def moved_bodies(scene: Scene, joint: str) -> tuple[list[int], list[int]]:
    """Bodies that hang on a joint with no other body between, and those that these carry.

    Raises:
        InputError: The object has no such leading joint.
    """
    names = [travel.joint for travel in scene.travels]
    if joint not in names:
        raise InputError(
            f"The object has no joint {joint!r} that a robot could move. Its joints that move by themselves are "
            f"{', '.join(names) or 'none'}."
        )
    own = [c.child for c in scene.connections if joint in c.joints]
    carried: list[int] = []
    for body in [*own, *carried]:
        carried += [c.child for c in scene.connections if c.parent == body]
    for body in carried:
        carried += [c.child for c in scene.connections if c.parent == body and c.child not in carried]
    return own, carried


class _Ranked:
    """Candidates with what their rank depends on."""

    def __init__(
        self, scene: Scene, joint: str, leaders: FloatArray, search: GraspSearch, candidates: Candidates
    ) -> None:
        self.candidates, self.search = candidates, search
        values = dict(zip((t.joint for t in scene.travels), leaders.tolist(), strict=True))
        described = scene.model.joint_by_name[joint]
        poses = forward_kinematics(scene.model, values)
        self.T_root_link = poses[described.child]
        self.axis = self.T_root_link[:3, :3] @ described.axis
        travel = next(t for t in scene.travels if t.joint == joint)
        self.sign = 1.0 if travel.far_end == travel.upper else -1.0
        self.turns = travel.turns
        self.lever, pull = self._lever_and_pull()
        self.plate = search.is_plate(candidates)
        self.extent = search.extent(candidates)
        largest = float(self.lever.max(initial=1e-9))
        reach = self.lever / largest if self.turns else 1.0 - self.lever / largest
        self.score = (
            LEVER_WEIGHT * reach
            + CLEARANCE_WEIGHT * np.minimum(candidates.clearance / PLENTY, 1.0)
            + PULL_WEIGHT * pull
            + HANDLE_WEIGHT * ~self.plate
        )

    def kind(self, row: int) -> str:
        """Name what is held."""
        if self.plate[row]:
            return RIM
        small = max(float(self.candidates.width[row]), float(self.extent[row]))
        return KNOB if small <= KNOB_WIDTH else HANDLE

    def _lever_and_pull(self) -> tuple[FloatArray, FloatArray]:
        """Lever arms [m] and how well each grasp pulls in [0, 1], shape (n,) each."""
        found = self.candidates
        offset = found.center - self.T_root_link[:3, 3]
        across = offset - np.outer(offset @ self.axis, self.axis)
        if not self.turns:
            vertices = self.search.meshes[self.search.body][0]
            flat = vertices - np.outer(vertices @ self.axis, self.axis)
            middle = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
            centred = found.center - np.outer(found.center @ self.axis, self.axis) - middle
            motion = np.broadcast_to(self.sign * self.axis, found.center.shape)
            return lengths_of(centred), _pull(found, motion)
        radius = lengths_of(across)
        motion = self.sign * crossed(self.axis, across) / np.maximum(radius, 1e-9)[:, None]
        # A knob is turned by twisting: the pads are the lever.
        twist = 0.5 * found.width * np.abs(found.approach @ self.axis)
        return np.maximum(radius, twist), np.where(twist > radius, 1.0, _pull(found, motion))


def _pull(found: Candidates, motion: FloatArray) -> FloatArray:
    """1 where the motion leads away from the palm or onto a pad, less where it slides sideways or onto the palm."""
    back = -np.einsum("nd,nd->n", found.approach, motion)
    onto_pad = np.abs(np.einsum("nd,nd->n", found.closing, motion))
    return np.asarray(np.maximum(np.maximum(back, onto_pad), 0.0))


class _Room:
    """Test whether the hand and its straight way in are free of the object, exactly."""

    def __init__(self, scene: Scene, poses: FloatArray) -> None:
        self._unit = scene.unit
        self._manager = fcl.DynamicAABBTreeCollisionManager()
        self._objects = [_surface(scene, body, T) for body, T in enumerate(poses)]
        self._manager.registerObjects(self._objects)
        self._manager.setup()

    def free(self, T_root_grasp: FloatArray, spread: float) -> bool:
        """Ask for both fingers and the palm, drawn out by the length of the approach."""
        outward = 0.5 * (spread + FINGER_THICKNESS)
        length = FINGER_LENGTH + APPROACH
        finger = np.array([FINGER_WIDTH, FINGER_THICKNESS, length])
        behind = PALM_LENGTH + APPROACH
        palm = np.array([PALM_THICKNESS, PALM_WIDTH, behind])
        parts = [(finger, np.array([0.0, sign * outward, TIP - 0.5 * length])) for sign in (-1.0, 1.0)]
        parts.append((palm, np.array([0.0, 0.0, TIP - FINGER_LENGTH - 0.5 * behind])))
        return not any(self._meets(T_root_grasp, size, middle) for size, middle in parts)

    def _meets(self, T: FloatArray, size: FloatArray, middle: FloatArray) -> bool:
        place = (T[:3, :3] @ middle + T[:3, 3]) / self._unit
        box = fcl.CollisionObject(fcl.Box(*(size / self._unit)), fcl.Transform(T[:3, :3], place))
        data = fcl.CollisionData()
        self._manager.collide(box, data, fcl.defaultCollisionCallback)
        return bool(data.result.is_collision)


def _distinct(ranked: _Ranked, room: _Room, held: str, slack: float) -> list[Grasp]:
    """Take the best candidates with room, leaving out those that are nearly the same as a better one."""
    found, order = ranked.candidates, np.argsort(-ranked.score, kind="stable")
    alive = np.ones(len(found), dtype=bool)
    grasps: list[Grasp] = []
    tries = 0
    for row in order.tolist():
        if not alive[row]:
            continue
        if tries == TRIES or len(grasps) == MOST:
            break
        tries += 1
        spread = float(found.width[row]) + 2.0 * slack
        T_root_grasp = _frame(found, row)
        if not room.free(T_root_grasp, spread):
            continue
        grasps.append(
            Grasp(
                T_link_grasp=_inverse(ranked.T_root_link) @ T_root_grasp,
                width=float(found.width[row]),
                spread=spread,
                clearance=float(found.clearance[row]),
                lever=float(ranked.lever[row]),
                kind=ranked.kind(row),
                held=held,
                score=float(ranked.score[row]),
            )
        )
        alive &= ~_alike(found, row)
    return grasps


def _alike(found: Candidates, row: int) -> BoolArray:
    cosine = np.cos(np.radians(SAME_DEG))
    near = lengths_of(found.center - found.center[row]) < SAME_PLACE
    same = (found.approach @ found.approach[row] > cosine) & (np.abs(found.closing @ found.closing[row]) > cosine)
    return np.asarray(near & same)


def _frame(found: Candidates, row: int) -> FloatArray:
    return pose_at(found.center[row], np.column_stack([found.side[row], found.closing[row], found.approach[row]]))


def _inverse(T: FloatArray) -> FloatArray:
    return pose_at(-T[:3, :3].T @ T[:3, 3], T[:3, :3].T)


def _around(point: FloatArray, seed: int) -> FloatArray:
    """Places in the ball around a point, the point itself first, shape (n, 3)."""
    rng = np.random.default_rng(seed)
    offsets = rng.normal(size=(POINTS_SEEN, 3))
    offsets *= NEAR_POINT * rng.random((len(offsets), 1)) / lengths_of(offsets)[:, None]
    return np.concatenate([point[None], point + offsets])


def joint_at(scene: Scene, point: FloatArray) -> str:
    """Find the joint whose part is nearest to a point, the last of several that move the same part.

    Args:
        scene: The object, in metres.
        point: Frame of the root link [m], shape (3,).

    Raises:
        InputError: No part that moves is near.
    """
    poses = scene.at_rest
    distances = {
        travel.joint: min((distance_to(scene, poses, body, point) for body in moved_bodies(scene, travel.joint)[0]),
                          default=np.inf)
        for travel in scene.travels
    }  # fmt: skip
    joint = min(distances, key=lambda name: distances[name])
    if distances[joint] > NEAR_POINT:
        raise InputError(
            f"The grasp point {np.round(point, 4).tolist()} (in metres, at the object's real size) is "
            f"{distances[joint]:.3f} m from the nearest part that moves, that of {joint}; a point on a part is at most "
            f"{NEAR_POINT} m off. Give it in the frame of the root link, in the units of the file."
        )
    return joint


def distance_to(scene: Scene, poses: FloatArray, body: int, point: FloatArray) -> float:
    """Distance of a point from the surface of a body [m], in the frame of the root link, bodies at `poses`."""
    dot = fcl.CollisionObject(fcl.Sphere(1e-3), fcl.Transform(point / scene.unit))
    distance = fcl.distance(_surface(scene, body, poses[body]), dot, fcl.DistanceRequest(), fcl.DistanceResult())
    return scene.unit * max(0.0, float(distance))


def _surface(scene: Scene, body: int, T: FloatArray) -> fcl.CollisionObject:
    """Surface of a body at a pose (4, 4), in the unit of the scene."""
    solid = scene.bodies[body].solid
    return fcl.CollisionObject(solid.tree, fcl.Transform(T[:3, :3], (T[:3, :3] @ solid.middle + T[:3, 3]) / scene.unit))


def _reason(seen: int, held: int, free: int, opening: float) -> str:
    if not seen:
        return "No place on the part can be seen from outside."
    if not held:
        return (
            f"Nothing on the part that can be reached from outside has opposite sides within {opening * 1e3:.0f} mm, "
            "which the gripper spans."
        )
    if not free:
        return "Everything that the gripper could span lacks room for its fingers beside it."
    return "Everything that the fingers could hold lacks room for the hand behind them."
