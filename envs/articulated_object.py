"""The object of an environment: its file, stood on the floor, and the way on which its joint opens."""

from __future__ import annotations

import difflib
import shutil
import tempfile
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from multiprocessing.util import Finalize, get_temp_dir
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.envs.bundled import DEFAULT, FAMILY_PREFIX, PREFIX, write_bundled
from kinematify.errors import InputError
from kinematify.geometry.scene import read_scene
from kinematify.manipulation.grasp import moved_bodies, search_grasps
from kinematify.manipulation.plan_request import Hold
from kinematify.manipulation.robot_place import object_box
from kinematify.model.collision import collides_as_it_is
from kinematify.model.masses import prepared_inertials
from kinematify.model.output import urdf_of
from kinematify.refinement.urdf_editor import UrdfEditor
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import pose_at, transformed
from kinematify.robot.vectors import lengths_of
from kinematify.simulation.engines import engines_that_hold

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import Travel
    from kinematify.robot.robot import Robot

AUTO = "auto"
ENGINES = engines_that_hold(Hold.WELD)
"""In which environments run."""
_PLINTH = 0.4  # objects whose parts swing below them stand so much higher [m]
_WAY_SAMPLES = 33
_LEAST_SHARE = 0.4  # of the longest way of the part: nobody pulls a lid next to its hinge
_WIDEST = 0.1  # hold that is looked for [m]
_LEAST_WAY = 1e-4  # a part whose hold moves by less cannot be seen to open [m]


@dataclass(frozen=True, kw_only=True, eq=False)
class ArticulatedObject:
    """An object, its files in a folder that lives as long as it does."""

    source: str
    """The `model` keyword."""
    urdf: Path
    loaded: Path
    """What engines load: the URDF, or what `kinematify fix` makes of one whose meshes they would misread."""
    declared: Robot
    scene: Scene
    T_world_root: FloatArray
    """Root link with the object in the middle of the floor, shape (4, 4)."""
    suggested: str
    """Joint of a bundled object, or ``auto``."""
    folder: Path
    """Of everything that was written for it."""

    @property
    def travels(self) -> tuple[Travel, ...]:
        """Joints that lead, in the order of the document."""
        return self.scene.travels

    @property
    def joints(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(travel.joint for travel in self.travels)

    def travel(self, joint: str) -> Travel:
        """The way of a joint that leads; errors as for `leader`."""
        return self.travels[self.leader(joint)]

    def link_pose(
        self, joint: str, value: float | None = None, others: Mapping[str, float] | None = None
    ) -> FloatArray:
        """Pose of the child link of a joint, frame of the root link, shape (4, 4).

        Args:
            joint: One that leads.
            value: Of it [rad or m]; rest if None.
            others: Joints that do not rest [rad or m].
        """
        values = {travel.joint: travel.rest for travel in self.travels} | dict(others or {})
        if value is not None:
            values[joint] = value
        return forward_kinematics(self.declared, values)[self.declared.joint_by_name[joint].child]

    def leader(self, joint: str) -> int:
        """Index of a joint among those that lead.

        Raises:
            InputError: There is none; the message lists all and suggests the nearest.
        """
        if joint in self.joints:
            return self.joints.index(joint)
        near = difflib.get_close_matches(joint, self.joints, n=1, cutoff=0.4)
        hint = f"Did you mean {near[0]}? " if near else ""
        raise InputError(
            f"The model {self.source} has no joint {joint!r} that moves by itself. {hint}Give one of "
            f"{', '.join(self.joints)}, or {AUTO}."
        )

    @cached_property
    def usual(self) -> str:
        """The suggested joint, else the one whose part moves farthest over its range, which is what people open."""
        if self.suggested != AUTO:
            return self.suggested
        return max(self.joints, key=lambda joint: round(_longest_way(self, joint), 3))

    @cached_property
    def drawers(self) -> tuple[str, ...]:
        """Joints that slide, those that go farthest first."""
        slides = [travel.joint for travel in self.travels if not travel.turns]
        return tuple(sorted(slides, key=lambda joint: -round(_longest_way(self, joint), 3)))


@dataclass(frozen=True, kw_only=True, eq=False)
class Target:
    """The joint that is opened, and the point at which its part is held."""

    joint: str
    leader: int
    """Index among the joints that lead."""
    turns: bool
    closed: float
    """Value at rest [rad or m]."""
    opened: float
    """Value at the far end of its range [rad or m]."""
    link: str
    """What it moves."""
    point: FloatArray
    """Where the part is held, frame of the link [m], shape (3,)."""
    way: float
    """Length of the way of that point from closed to opened [m]."""

    @property
    def range(self) -> float:
        """Signed, from closed to opened [rad or m]."""
        return self.opened - self.closed

    def value(self, fraction: float) -> float:
        """Value of the joint where a share of the way is open [rad or m]."""
        return self.closed + fraction * self.range

    @cached_property
    def reversed(self) -> Target:
        """The same way from open to closed."""
        return replace(self, closed=self.opened, opened=self.closed)

    @property
    def path_ratio(self) -> float:
        """Metres of the point per unit of the joint [m/rad or 1]."""
        return self.way / abs(self.range)


def loadable(urdf: Path, folder: Path) -> Path:
    """Return a file that engines load as it is: the given one where its pieces are convex and its links weigh.

    Others are written into the folder as `kinematify fix --all` does, with friction and damping for joints without.
    """
    robot, settings, config = read_robot(urdf), load_settings(), load_config()
    inertials = prepared_inertials(robot, settings.prepare)
    weighed = not any(inertials[link.name].mass_added for link in robot.links if link.has_geometry)
    if weighed and collides_as_it_is(robot):
        return urdf
    editor = UrdfEditor(urdf, folder / f"{urdf.stem}_fixed.urdf")
    solid = [link.name for link in robot.links if link.has_geometry]
    editor.carve(robot, frozenset(solid), config, settings)
    editor.set_inertia(robot, solid, settings.prepare)
    weighed_links = tuple(replace(link, inertial=inertials[link.name]) for link in robot.links)
    editor.set_friction(replace(robot, links=weighed_links))
    return editor.write()


@lru_cache(maxsize=32)
def find_target(articulated_object: ArticulatedObject, joint: str) -> Target:
    """Find once per process where the part of a joint is held, and the way of that point.

    The best hold for a gripper is taken, whatever its part is called; where there is none, the outermost point.

    Args:
        articulated_object: The object.
        joint: A joint that leads.

    Raises:
        InputError: There is no such joint, or it moves nothing.
    """
    travel = articulated_object.travel(joint)
    opened = open_end(travel)
    point = _hold(articulated_object, joint, opened)
    way = 0.0 if point is None else _length(_path(articulated_object, joint, opened, point))
    if point is None or way < _LEAST_WAY:
        raise InputError(
            f"The joint {joint} of the model {articulated_object.source} moves nothing that could be seen to "
            f"open. Give another of its joints: {', '.join(articulated_object.joints)}."
        )
    return Target(
        joint=joint,
        leader=articulated_object.leader(joint),
        turns=travel.turns,
        closed=travel.rest,
        opened=opened,
        link=articulated_object.declared.joint_by_name[joint].child,
        point=point,
        way=way,
    )


def open_end(travel: Travel) -> float:
    """Value at the end of the range that is farther from rest; a quarter of a turn where there is no end [rad or m]."""
    return travel.far_end if travel.limited else travel.rest + 0.5 * np.pi


def _hold(articulated_object: ArticulatedObject, joint: str, opened: float) -> FloatArray | None:
    """Point in the frame of the joint's child link; None where the joint moves no geometry."""
    grasps, _ = search_grasps(articulated_object.scene, joint, _WIDEST)
    least = max(_LEAST_WAY, _LEAST_SHARE * _longest_way(articulated_object, joint))
    for grasp in grasps:
        point = np.asarray(grasp.T_link_grasp[:3, 3])
        if _length(_path(articulated_object, joint, opened, point)) >= least:
            return point
    # The corner that goes farthest, of those the one that lies farthest out in that direction.
    corners = _corners(articulated_object, joint)
    if not len(corners):
        return None
    first, last = (articulated_object.link_pose(joint, value) for value in (None, opened))
    moves = transformed(corners, last) - transformed(corners, first)
    lengths = lengths_of(moves)
    far = np.flatnonzero(lengths >= 0.98 * lengths.max())
    ahead = np.einsum("nd,nd->n", transformed(corners[far], first), moves[far])
    return np.asarray(corners[far[int(ahead.argmax())]])


def _corners(articulated_object: ArticulatedObject, joint: str) -> FloatArray:
    """Corners of all bodies that a joint moves, frame of its child link at rest, shape (n, 3)."""
    own, carried = moved_bodies(articulated_object.scene, joint)
    back = np.linalg.inv(articulated_object.link_pose(joint))
    found = [
        transformed(shape, back @ articulated_object.scene.at_rest[body])
        for body in [*own, *carried]
        for shape in articulated_object.scene.bodies[body].shapes
    ]
    return np.concatenate(found) if found else np.empty((0, 3))


def _longest_way(articulated_object: ArticulatedObject, joint: str) -> float:
    """Longest way of a corner of what a joint moves [m]."""
    corners = _corners(articulated_object, joint)
    if not len(corners):
        return 0.0
    travel = articulated_object.travel(joint)
    poses = [articulated_object.link_pose(joint, value) for value in np.linspace(travel.rest, open_end(travel), 5)]
    places = np.stack([transformed(corners, T) for T in poses])
    return float(lengths_of(np.diff(places, axis=0)).sum(axis=0).max())


def _path(articulated_object: ArticulatedObject, joint: str, opened: float, point: FloatArray) -> FloatArray:
    rest = articulated_object.travel(joint).rest
    poses = [articulated_object.link_pose(joint, value) for value in np.linspace(rest, opened, _WAY_SAMPLES)]
    return np.stack([T[:3, :3] @ point + T[:3, 3] for T in poses])


def _length(path: FloatArray) -> float:
    return float(lengths_of(np.diff(path, axis=0)).sum())


def _standing(scene: Scene) -> FloatArray:
    """The object in the middle of the floor, on a plinth where one of its parts swings below it."""
    rows = scene.mechanism.sweep(5)
    poses = scene.poses(rows)
    lowest = [
        min(float(transformed(shape, T)[:, 2].min()) for body, T in zip(scene.bodies, row, strict=True)
            for shape in body.shapes)
        for row in poses
    ]  # fmt: skip
    low, high = object_box(scene)
    sinks = min(lowest) < low[2] - 0.01 * float(high[2] - low[2])
    return pose_at([*(-0.5 * (low + high)[:2]), -min(lowest) + (_PLINTH if sinks else 0.0)])


def shared_articulated_object(model: str | Path | None) -> ArticulatedObject:
    """Return the object of a `model` keyword, read once per process as long as its file stays the same.

    Args:
        model: A URDF, a folder with ``model.urdf``, ``bundled:NAME``, ``procedural:FAMILY`` or
            ``procedural:FAMILY:SEED``, or None for the default.

    Raises:
        InputError: There is no such model, it cannot be read, or nothing of it moves.
    """
    file = urdf_of(Path(model)) if model is not None and Path(model).exists() else None
    stamp = None if file is None else (file.stat().st_mtime_ns, file.stat().st_size)
    return _loaded(f"{PREFIX}{DEFAULT}" if model is None else str(model), stamp)


@lru_cache(maxsize=8)
def _loaded(source: str, stamp: tuple[int, int] | None) -> ArticulatedObject:
    del stamp
    # In what multiprocessing removes when the process that began has ended, whatever became of its workers.
    folder = Path(tempfile.mkdtemp(prefix="kinematify-env-", dir=get_temp_dir()))
    suggested = AUTO
    if source.startswith((PREFIX, FAMILY_PREFIX)):
        urdf, suggested = write_bundled(source, folder / "object")
    elif Path(source).exists():
        urdf = urdf_of(Path(source)).resolve()
    else:
        raise InputError(
            f"There is no model {source}. Give a URDF file, a folder that kinematify infer or generate has written, "
            f"{PREFIX}NAME for an object that comes with the package, or {FAMILY_PREFIX}FAMILY."
        )
    loaded = loadable(urdf, folder)
    declared = read_robot(loaded)
    scene = read_scene(declared, load_settings().geometry)
    if not scene.travels:
        raise InputError(
            f"The model {source} has no joint that moves by itself, so there is nothing to open. Give a model with a "
            "revolute, continuous or prismatic joint; kinematify infer finds the joints of separate parts."
        )
    articulated_object = ArticulatedObject(
        source=source,
        urdf=urdf,
        loaded=loaded,
        declared=declared,
        scene=scene,
        T_world_root=_standing(scene),
        suggested=suggested,
        folder=folder,
    )
    Finalize(articulated_object, shutil.rmtree, (folder,), {"ignore_errors": True})
    return articulated_object
