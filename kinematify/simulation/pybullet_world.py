"""Files in worlds of PyBullet, and what it says of single configurations.

PyBullet speaks in indices of its own and in tuples; nothing of either leaves this package.
"""

from __future__ import annotations

import weakref
from collections import defaultdict
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
import pybullet as bullet

from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.contacts import Contacts, deepest
from kinematify.simulation.engine import Refused

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import LeaderMechanism

_FLAGS = (
    bullet.URDF_USE_SELF_COLLISION
    | bullet.URDF_USE_SELF_COLLISION_INCLUDE_PARENT  # else neighbours pass through each other
    | bullet.URDF_USE_INERTIA_FROM_FILE  # else inertias are made up from the collision shapes
)
_HULL_MARGIN = 1e-3
"""Bullet inflates convex hulls of meshes by it [m]; primitives keep their size."""
_LARGE_INERTIA = 0.1
"""Principal moments [kg m^2] below it are never refused."""
_BASE = -1


@dataclass(frozen=True, kw_only=True, eq=False)
class PybulletBody:
    """A model in a world, and where the links and joints of the document stand in it."""

    client: int
    body: int
    mechanism: LeaderMechanism
    link: IntArray
    """PyBullet's index of each link, -1 for the root, -2 for lost ones, shape (L,)."""
    joint: IntArray
    """PyBullet's index of each of `LeaderMechanism.joints`, -2 for lost ones, shape (J,)."""
    margin: FloatArray
    """By which each link's shapes are inflated [m], shape (L,)."""
    mass_scale: float = 1.0
    """Of all masses in this world over those of the file, see `load`."""

    @property
    def complete(self) -> bool:
        """True if no link and no joint was lost."""
        return bool((self.link >= _BASE).all() and (self.joint >= 0).all())

    @cached_property
    def freeing(self) -> weakref.finalize[..., Any]:
        """Frees the world, once: PyBullet gives the same number to the next one."""
        return weakref.finalize(self, bullet.disconnect, physicsClientId=self.client)

    @cached_property
    def indices(self) -> list[int]:
        """`joint` as PyBullet wants it."""
        return [int(index) for index in self.joint]

    @cached_property
    def joint_infos(self) -> list[tuple[Any, ...]]:
        """What PyBullet tells of each joint, by its index."""
        count = bullet.getNumJoints(self.body, physicsClientId=self.client)
        return [bullet.getJointInfo(self.body, k, physicsClientId=self.client) for k in range(count)]

    @cached_property
    def order(self) -> IntArray:
        """Place of each joint among PyBullet's degrees of freedom, which follow its indices, shape (J,)."""
        return np.argsort(np.argsort(self.joint))

    @cached_property
    def link_of(self) -> dict[int, int]:
        """Link of the document by PyBullet's index."""
        return {index: link for link, index in enumerate(self.link.tolist())}

    @cached_property
    def size(self) -> float:
        """Largest side of the box around all collision shapes at zero [m], at least 1 mm."""
        self.place(np.zeros(len(self.joint)))
        boxes = [
            bullet.getAABB(self.body, index, physicsClientId=self.client)
            for index in self.link.tolist()
            if bullet.getCollisionShapeData(self.body, index, physicsClientId=self.client)
        ]
        corners = np.array(boxes).reshape(-1, 3)
        return float(max(np.ptp(corners, axis=0).max(), 1e-3)) if len(corners) else 1.0

    def place(self, values: FloatArray) -> None:
        """Set all joints, shape (J,) [rad or m], and stop them."""
        if self.indices:
            bullet.resetJointStatesMultiDof(
                self.body,
                self.indices,
                [[value] for value in values.tolist()],
                [[0.0]] * len(values),
                physicsClientId=self.client,
            )

    def state(self) -> tuple[list[float], list[float], list[float]]:
        """Return values, speeds and motor torques of all joints."""
        states = bullet.getJointStates(self.body, self.indices, physicsClientId=self.client)
        return [s[0] for s in states], [s[1] for s in states], [s[3] for s in states]

    def link_states(self) -> list[tuple[tuple[float, ...], ...]]:
        """Return PyBullet's state of every link but the root, by its index.

        Of each, [0] is the centre of mass, [4] and [5] are the frame, [6] is the speed of the centre of mass.
        """
        count = bullet.getNumJoints(self.body, physicsClientId=self.client)
        states = bullet.getLinkStates(
            self.body, range(count), computeLinkVelocity=1, computeForwardKinematics=1, physicsClientId=self.client
        )
        return list(states or ())

    def contacts(self, row: int) -> list[tuple[int, int, int, float]]:
        """Return (row, link, link, depth [m]) of all contacts of the configuration that was set."""
        self.find_contacts_anew()
        points = bullet.getContactPoints(self.body, self.body, physicsClientId=self.client)
        link_of = self.link_of
        return [(row, link_of[point[3]], link_of[point[4]], -point[8]) for point in points]

    def find_contacts_anew(self) -> None:
        """Forget the contacts of earlier configurations.

        PyBullet keeps contacts from step to step as points that move with the bodies. Where a body was set to another
        place they are wrong, so all pairs are made to be found anew.
        """
        for index in self.link.tolist():
            bullet.setCollisionFilterGroupMask(self.body, index, 1, 1, physicsClientId=self.client)
        bullet.performCollisionDetection(physicsClientId=self.client)

    def touching_bodies(self) -> frozenset[tuple[int, int]]:
        """Return pairs of bodies that pushed each other in the last step, smaller index first."""
        body, link_of = self.mechanism.body_of_link, self.link_of
        points = bullet.getContactPoints(self.body, self.body, physicsClientId=self.client)
        pairs = ((int(body[link_of[p[3]]]), int(body[link_of[p[4]]])) for p in points if p[9] > 0.0)
        return frozenset((min(pair), max(pair)) for pair in pairs)

    def corrected(self, found: Sequence[tuple[int, int, int, float]]) -> Contacts:
        """Return the contacts without the inflation of hulls: only those in which the shapes themselves meet."""
        table = np.array(found, dtype=np.float64).reshape(-1, 4)
        links = table[:, 1:3].astype(np.int64)
        depth = table[:, 3] - self.margin[links].sum(axis=1)
        kept = depth > 0.0
        return deepest(table[kept, 0].astype(np.int64), links[kept], depth[kept])

    def gravity(self, values: FloatArray) -> FloatArray:
        """Return the torques and forces that hold the model still [N m or N], shape (J,)."""
        q = np.zeros(len(values))
        q[self.order] = values
        zero = [0.0] * len(values)
        torques = bullet.calculateInverseDynamics(self.body, q.tolist(), zero, zero, physicsClientId=self.client)
        held: FloatArray = np.array(torques)[self.order] / self.mass_scale
        return held

    def mass_matrix(self, values: FloatArray) -> FloatArray:
        """Return the joint-space inertia, shape (J, J)."""
        q = np.zeros(len(values))
        q[self.order] = values
        matrix = bullet.calculateMassMatrix(self.body, q.tolist(), physicsClientId=self.client)
        ordered: FloatArray = np.array(matrix).reshape(len(values), len(values))[np.ix_(self.order, self.order)]
        return ordered / self.mass_scale

    def index_of(self, link: str) -> int:
        """PyBullet's index of a link."""
        return int(self.link[self.mechanism.links.index(link)])

    def frame(self, link: str) -> FloatArray:
        """World pose of a link's frame, shape (4, 4)."""
        index = self.index_of(link)
        if index == _BASE:
            inertial = bullet.getDynamicsInfo(self.body, _BASE, physicsClientId=self.client)
            return np.asarray(self.centre(link) @ np.linalg.inv(pose_of(inertial[3], inertial[4])))
        state = bullet.getLinkState(self.body, index, computeForwardKinematics=1, physicsClientId=self.client)
        return pose_of(state[4], state[5])

    def centre(self, link: str) -> FloatArray:
        """World pose of a link's centre of mass, in which constraints are stated, shape (4, 4)."""
        index = self.index_of(link)
        if index == _BASE:
            return pose_of(*bullet.getBasePositionAndOrientation(self.body, physicsClientId=self.client))
        state = bullet.getLinkState(self.body, index, computeForwardKinematics=1, physicsClientId=self.client)
        return pose_of(state[0], state[1])

    def release(self, *, ideal: bool = False) -> None:
        """Switch all motors off, which are on from the start; `ideal`: damping and friction too."""
        for index in self.indices:
            bullet.setJointMotorControl2(
                self.body, index, bullet.VELOCITY_CONTROL, force=0.0, physicsClientId=self.client
            )
        if ideal:
            for index in self.link.tolist():
                bullet.changeDynamics(
                    self.body, index, linearDamping=0.0, angularDamping=0.0, jointDamping=0.0,
                    physicsClientId=self.client,
                )  # fmt: skip

    def silence(self) -> None:
        """Let no two links act on each other but those that `act` names."""
        for index in self.link.tolist():
            bullet.setCollisionFilterGroupMask(self.body, index, 0, 0, physicsClientId=self.client)

    def act(self, pairs: Iterable[tuple[int, int]], *, on: bool) -> None:
        """Let the links of these pairs (indices in the document) act on each other, or not."""
        for first, second in pairs:
            bullet.setCollisionFilterPair(
                self.body, self.body, int(self.link[first]), int(self.link[second]), int(on),
                physicsClientId=self.client,
            )  # fmt: skip

    def fastest_link(self) -> float:
        """Return the largest speed of a centre of mass [m/s], infinite where it is no number."""
        speeds = np.array([state[6] for state in self.link_states()]).reshape(-1, 3)
        largest = float(np.linalg.norm(speeds, axis=1).max(initial=0.0))
        return largest if np.isfinite(largest) else np.inf

    def masses(self) -> dict[str, float]:
        """Mass of each link that is there [kg]; the base must be free."""
        links = zip(self.mechanism.links, self.link.tolist(), strict=True)
        return {
            name: bullet.getDynamicsInfo(self.body, index, physicsClientId=self.client)[0]
            for name, index in links
            if index >= _BASE
        }

    def disconnect(self) -> None:
        """Free the world now; it is freed anyway when nothing refers to it any more."""
        self.freeing()


def connect(step: float, *, iterations: int | None = None) -> int:
    """Return the number of a new world.

    Args:
        step: Time step [s].
        iterations: Of its solver; as many as it likes if None.
    """
    client: int = bullet.connect(bullet.DIRECT)
    solver = {} if iterations is None else {"numSolverIterations": iterations}
    bullet.setPhysicsEngineParameter(enableFileCaching=0, fixedTimeStep=step, physicsClientId=client, **solver)
    bullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=client)
    return client


def load(
    mechanism: LeaderMechanism, urdf: Path, *, step: float, fixed: bool = True, looking: bool = False
) -> PybulletBody:
    """Load a file into a new world; links that fixed joints join do not collide with each other.

    Args:
        mechanism: Its tree.
        urdf: The file, its meshes convex.
        step: Time step [s].
        fixed: False: the base is free.
        looking: The model is set to configurations and never simulated. Large inertias are then scaled down, because
            the inverse dynamics refuses tensors that differ from symmetric ones by 2e-16 kg m^2.

    Raises:
        Refused: PyBullet cannot.
    """
    client = connect(step)
    try:
        loaded = _loaded(client, mechanism, urdf, useFixedBase=fixed, flags=_FLAGS)
    except Refused:
        bullet.disconnect(physicsClientId=client)
        raise
    if looking:
        loaded = replace(loaded, mass_scale=_scaled_down(loaded))
    if loaded.complete:
        loaded.act(_welded_pairs(mechanism), on=False)
    assert loaded.freeing.alive
    return loaded


def load_at(
    client: int, mechanism: LeaderMechanism, urdf: Path, T_world_root: FloatArray, *, itself: bool
) -> PybulletBody:
    """Load a file into a world, its root fixed at a pose.

    Args:
        client: Number of the world.
        mechanism: Its tree.
        urdf: The file, its meshes convex.
        T_world_root: Shape (4, 4).
        itself: Links that no joint connects collide with each other.

    Raises:
        Refused: PyBullet cannot.
    """
    flags = bullet.URDF_USE_INERTIA_FROM_FILE | (bullet.URDF_USE_SELF_COLLISION if itself else 0)
    place, turn = T_world_root[:3, 3].tolist(), quaternion_of(T_world_root[:3, :3], real_last=True).tolist()
    options = {"basePosition": place, "baseOrientation": turn, "useFixedBase": True, "flags": flags}
    return _loaded(client, mechanism, urdf, **options)


def _loaded(client: int, mechanism: LeaderMechanism, urdf: Path, **options: Any) -> PybulletBody:
    try:
        body = bullet.loadURDF(str(urdf), physicsClientId=client, **options)
    except bullet.error as error:
        raise Refused(str(error)) from error
    infos = [bullet.getJointInfo(body, k, physicsClientId=client) for k in range(bullet.getNumJoints(body, client))]
    links = {text_of(info[12]): info[0] for info in infos}
    links.setdefault(mechanism.robot.root, _BASE)
    joints = {text_of(info[1]): info[0] for info in infos if info[2] != bullet.JOINT_FIXED}
    indices = [links.get(name, -2) for name in mechanism.links]
    inflated = [
        index >= _BASE
        and any(
            shape[2] == bullet.GEOM_MESH for shape in bullet.getCollisionShapeData(body, index, physicsClientId=client)
        )
        for index in indices
    ]
    return PybulletBody(
        client=client,
        body=body,
        mechanism=mechanism,
        link=np.array(indices, dtype=np.int64),
        joint=np.array([joints.get(name, -2) for name in mechanism.joints], dtype=np.int64),
        margin=np.where(inflated, _HULL_MARGIN, 0.0),
    )


def _scaled_down(loaded: PybulletBody) -> float:
    """Scale masses and inertias by a power of two, which changes no digit, so that all moments are small."""
    client, body, count = loaded.client, loaded.body, len(loaded.joint_infos)
    infos = {index: bullet.getDynamicsInfo(body, index, physicsClientId=client) for index in range(-1, count)}
    largest = max(max(info[2]) for info in infos.values())
    scale = 2.0 ** min(0.0, np.floor(np.log2(_LARGE_INERTIA / max(largest, _LARGE_INERTIA))))
    if scale < 1.0:
        for index, info in infos.items():
            moments = [moment * scale for moment in info[2]]
            bullet.changeDynamics(
                body, index, mass=info[0] * scale, localInertiaDiagonal=moments, physicsClientId=client
            )
    return float(scale)


def _welded_pairs(mechanism: LeaderMechanism) -> list[tuple[int, int]]:
    """Pairs of links that fixed joints join."""
    members: dict[int, list[int]] = defaultdict(list)
    for link, body in enumerate(mechanism.body_of_link.tolist()):
        members[body].append(link)
    return [pair for group in members.values() for pair in combinations(group, 2)]


def pose_of(place: tuple[float, ...], turn: tuple[float, ...]) -> FloatArray:
    """Pose from a place [m] and a quaternion x, y, z, w, shape (4, 4)."""
    T = np.eye(4)
    T[:3, :3] = np.array(bullet.getMatrixFromQuaternion(turn)).reshape(3, 3)
    T[:3, 3] = place
    return T


def text_of(name: bytes) -> str:
    """Return one of PyBullet's names."""
    return name.decode("utf-8", errors="replace")
