"""Context of the checks of the untouched file in one engine, computed when first asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import FREE_KINDS
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.read import read_robot
from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.engine import Unloadable
from kinematify.simulation.engine_runs import drive, overlaps, push_joint, release, rest, row, script, velocity_probe
from kinematify.simulation.engines import ENGINES, open_engine
from kinematify.simulation.world import OpenedFile

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from kinematify.config.validation import AsLoadedSettings
    from kinematify.geometry.sweep import Sweeper
    from kinematify.robot.mechanism import Travel
    from kinematify.robot.robot import Joint, Robot
    from kinematify.simulation.engine import Engine
    from kinematify.simulation.engine_runs import EngineRun, Overlap, Push, Pushed
    from kinematify.validation.stage import StageRequest

_LEAST_SIZE = 0.01
"""Smaller models are looked at as if they had it [m]."""
_SAME = 1e-6
"""Limits that differ by less are the same, beside their size [rad or m]."""
_YIELDING = 0.25
"""A limit that does not give way for so long holds: the load is there after a few steps [s]."""
_AHEAD = (0.0, 0.002, 0.005, 0.01, 0.02)
"""Of a way: where what stopped a push is looked for, since engines stop bodies before they meet."""
_FAR_BEYOND = 5.0
"""Where what presses against a limit is let off, in lengths that a limit may give way."""


@dataclass(frozen=True, kw_only=True)
class VelocityProbe:
    """A joint pushed by a hand, the others held."""

    travel: Travel
    values: Mapping[str, float]
    """Where every joint starts [rad or m]."""
    push: Push
    pushed: Pushed
    end: float
    """Value that it has to get to [rad or m]."""
    free: bool = True
    """Whether exact geometry leaves any way free to that side."""
    without_contacts: float | None = None
    """Where it gets where nothing touches [rad or m], if it was tried."""


@dataclass(frozen=True, eq=False, kw_only=True)
class AsLoadedContext:
    """The untouched file in an engine, and its runs."""

    request: StageRequest
    engine: str

    @property
    def title(self) -> str:
        """Title of the engine."""
        return ENGINES[self.engine].title

    @property
    def flag(self) -> str | None:
        """Flag without which links of the file pass through each other; None where they collide by default."""
        return ENGINES[self.engine].contact_flag

    @property
    def opened(self) -> str:
        """The engine, and that it has a copy of the file, if so."""
        copy = self.loading is not self.bare
        return f"{self.title} (a copy with {self.copied})" if copy else self.title

    @property
    def how(self) -> str:
        """The same, with its flag where contacts need one."""
        return self.opened.replace(self.title, f"{self.title} with {self.flag}", 1) if self.flag else self.opened

    @property
    def settings(self) -> AsLoadedSettings:
        """Thresholds, forces and times."""
        return self.request.settings.as_loaded

    @cached_property
    def robot(self) -> Robot:
        """The file without its geometry."""
        return read_robot(self.request.resolved or self.request.urdf, geometry="none")  # less what is broken

    @cached_property
    def mechanism(self) -> LeaderMechanism:
        """The tree."""
        return LeaderMechanism(robot=self.robot)

    @property
    def native(self) -> Path | None:
        """The file, where the engine opens its format and not only a URDF of it."""
        return self.request.native if self.engine == "mujoco" else None

    @property
    def copied(self) -> str:
        """What a copy has that the engine opens in place of a file that it refuses."""
        return "absolute paths of the meshes" if self.native is None else "none of the pictures and skins it refuses"

    @cached_property
    def bare(self) -> Engine | Unloadable:
        """The file in the engine as it is, or what the engine says against it."""
        return self._opened(self.native or self.request.urdf)

    @cached_property
    def loading(self) -> Engine | Unloadable:
        """The file in the engine, from a copy as `copied` says where it is not opened without."""
        resolved = self.request.resolved
        if not isinstance(self.bare, Unloadable) or self.bare.floats or resolved is None:
            return self.bare
        if self.native is not None:
            from kinematify.robot.mjcf_reader import write_repaired  # noqa: PLC0415 - for such files only

            resolved = write_repaired(self.native, self.request.work / "repaired.xml")
        copy = self._opened(resolved)
        if isinstance(copy, Unloadable):
            return self.bare
        copy.facts["path"] = resolved.name
        return copy

    def _opened(self, urdf: Path) -> Engine | Unloadable:
        try:
            root = self.mechanism.links[int(np.flatnonzero(self.mechanism.body_of_link == 0)[0])]
            loaded = open_engine(self.engine, OpenedFile(urdf=urdf, root=root))
        except Unloadable as error:
            return error
        known = set(loaded.joints) <= set(self.mechanism.joints)
        return loaded if known or not self.floats else Unloadable(reproduction=script(loaded, "joints"))

    @property
    def floats(self) -> bool:
        """True if the file has a joint that is neither hinge nor slide."""
        return self.native is not None or any(joint.declared_kind in FREE_KINDS for joint in self.robot.joints)

    @property
    def loaded(self) -> Engine:
        """The file in the engine, once it is there."""
        assert not isinstance(self.loading, Unloadable)
        return self.loading

    @cached_property
    def lost(self) -> tuple[str, ...]:
        """Joints of the file that do not move in the engine."""
        return tuple(name for name in self.mechanism.joints if name not in self.loaded.joints)

    @cached_property
    def misread(self) -> tuple[Joint, ...]:
        """Joints whose limits the engine has read otherwise than they stand in the file."""
        limits = self.loaded.limits
        return tuple(
            joint
            for joint in self.robot.joints
            if joint.name in limits
            and np.isfinite([joint.lower, joint.upper]).all()
            and not np.allclose(limits[joint.name], (joint.lower, joint.upper), rtol=_SAME, atol=_SAME)
        )

    @cached_property
    def travels(self) -> tuple[Travel, ...]:
        """Travels of the joints that lead and that the engine moves."""
        return tuple(travel for travel in self.mechanism.travels if travel.joint not in self.lost)

    @cached_property
    def values(self) -> dict[str, float]:
        """Every joint at rest [rad or m]."""
        return self._values({})

    def _values(self, leaders: Mapping[str, float]) -> dict[str, float]:
        """Every joint, leaders at these values or at rest [rad or m]."""
        row = np.array([leaders.get(travel.joint, travel.rest) for travel in self.mechanism.travels])
        known = dict(zip(self.mechanism.joints, self.mechanism.all_values(row[None])[0].tolist(), strict=True))
        return {**dict.fromkeys(self.loaded.joints, 0.0), **known}

    @property
    def ends(self) -> tuple[dict[str, float], ...]:
        """Every joint at rest, at its lower and at its upper end [rad or m]."""
        lower = self._values({travel.joint: travel.lower for travel in self.travels})
        return self.values, lower, self._values({travel.joint: travel.upper for travel in self.travels})

    @cached_property
    def size(self) -> float:
        """Distance of the farthest link frames at zero and rest [m]; what stands in each other is measured by it."""
        from kinematify.robot.robot import forward_kinematics  # noqa: PLC0415 - for this only

        poses = forward_kinematics(self.robot, dict(self.values))
        extent = np.ptp([pose[:3, 3] for pose in poses.values()], axis=0)
        return max(float(np.linalg.norm(extent)), _LEAST_SIZE)

    @cached_property
    def overlaps(self) -> tuple[Overlap, ...]:
        """At rest, the deepest first, of links that can move against each other: nothing pushes others apart."""
        found = overlaps(self.loaded, self.values)
        return tuple(item for item in found if self._body(item.links[0]) != self._body(item.links[1]))

    def _body(self, link: str) -> int:
        """The rigid body of a link; what stands in the world besides is one with the root."""
        return int(self.mechanism.body_of_link[self._link[link]]) if link in self._link else 0

    @cached_property
    def _link(self) -> dict[str, int]:
        return {name: number for number, name in enumerate(self.mechanism.links)}

    @cached_property
    def passive_run(self) -> EngineRun:
        """Nothing is done."""
        return rest(self.loaded, self.values, self.settings.seconds, contacts=True)

    @cached_property
    def left_without_contacts(self) -> EngineRun:
        """The same where no links touch each other: what gravity does alone."""
        return rest(self.loaded, self.values, self.settings.seconds, contacts=False)

    def way(self, run: EngineRun, travel: Travel) -> np.ndarray:
        """Return the values of a joint in a run [rad or m], shape (steps,)."""
        return run.seen[:, list(self.loaded.joints).index(travel.joint)]

    def still(self, travel: Travel) -> float:
        """Return how far a joint may go that nothing moves [rad or m]."""
        settings = self.settings
        return max(settings.still * travel.range, settings.still_angle if travel.turns else settings.still_length)

    def _nothing(self, travel: Travel) -> float:
        """A shorter way is none [rad or m]; the buttons of a machine have but a millimetre."""
        return self.settings.still * travel.range

    def free(self, travel: Travel) -> tuple[float, float] | None:
        """Return the part of the range that exact geometry leaves free, the range itself where it is not known.

        None where it leaves nothing.
        """
        lower, upper = self.request.free_travel.get(travel.joint, (travel.lower, travel.upper))
        lower, upper = min(max(lower, travel.lower), travel.rest), max(min(upper, travel.upper), travel.rest)
        return (lower, upper) if max(travel.rest - lower, upper - travel.rest) > self._nothing(travel) else None

    def between(self, travel: Travel, overlaps: Iterable[Overlap]) -> Overlap | None:
        """Return the deepest of the overlaps that a joint moves apart or together; None without any."""
        moved = self.mechanism.moved[self.mechanism.travels.index(travel)]
        sides = ((item, [moved[self._body(link)] for link in item.links]) for item in overlaps)
        return next((item for item, (first, second) in sides if first != second), None)

    @cached_property
    def closed(self) -> frozenset[str]:
        """Joints that lead others along a curve in a file whose loops the engine closes, which no hand can do."""
        curves = (joint.closure for joint in self.robot.joints if self.native)
        return frozenset(curve.joint for curve in curves if curve is not None)

    @cached_property
    def hands(self) -> tuple[VelocityProbe, ...]:
        """Every joint pushed to both ends of what is free, of its range where nothing is, the others held."""
        return tuple(
            self._by_hand(travel, end)
            for travel in self.travels
            if travel.joint not in self.closed
            for end in self.free(travel) or (travel.lower, travel.upper)
            if abs(end - travel.rest) > self._nothing(travel)
        )

    def free_without_contacts(self, run: VelocityProbe) -> bool:
        """True if a push that fell short gets to the end where nothing touches."""
        return run.without_contacts is not None and self.reaches_end(run, run.without_contacts)

    def moves_by_motor(self, run: VelocityProbe) -> bool:
        """True if a joint that a push did not bring to its end gets there as the file is loaded without flags.

        By the push without contacts, or by the joint's own motor: engines answer pushes of light parts wrongly.
        """
        if self.flag is None:
            return False
        if self.free_without_contacts(run):
            return True
        target = run.push.target
        driven = drive(self.loaded, run.travel.joint, run.values, target, self.settings.seconds)
        return self.reaches_end(replace(run, end=target), driven)

    def stopped_by(self, run: VelocityProbe) -> tuple[Overlap, float] | None:
        """Return what is in each other where a push ended, and at which value of the joint [rad or m].

        Contacts give way and throw back, so the value is looked at again: it is that where the push ended, or the next
        one on its way where two links that the joint moves against each other overlap; None without any.
        """
        travel, stop = run.travel, run.pushed.farthest
        for step in _AHEAD:
            value = stop + step * (run.end - travel.rest)
            values = dict(run.values)
            for name, ratio in self.ratios(travel).items():
                values[name] = run.values[name] + ratio * (value - travel.rest)
            found = self.between(travel, overlaps(self.loaded, values))
            if found is not None:
                return found, value
        return None

    @cached_property
    def inertias(self) -> dict[str, float]:
        """Return what a force at each joint moves at rest [kg or kg m^2]."""
        return dict(zip(self.loaded.joints, self.loaded.inertias(row(self.loaded, self.values)).tolist(), strict=True))

    @cached_property
    def max_safe_force(self) -> dict[str, float]:
        """Largest force at each joint at rest that the engine answers rightly [N or N m]."""
        return dict(
            zip(self.loaded.joints, self.loaded.max_safe_force(row(self.loaded, self.values)).tolist(), strict=True)
        )

    def ratios(self, travel: Travel) -> dict[str, float]:
        """Return the motion of a joint, 1, and of those that mimic it."""
        leads = self.mechanism.leads[:, self.mechanism.travels.index(travel)]
        moved = dict(zip(self.mechanism.joints, leads.tolist(), strict=True))
        followers = {name: ratio for name, ratio in moved.items() if ratio and name not in (travel.joint, *self.lost)}
        return {travel.joint: 1.0, **followers}

    @cached_property
    def _surfaces(self) -> Sweeper | None:
        """Return the visible surfaces in motion, for joints that fall short; None where they are what collides."""
        from kinematify.geometry.scene import read_scene, simplified, visible_shapes  # noqa: PLC0415 - for these only
        from kinematify.geometry.sweep import Sweeper  # noqa: PLC0415
        from kinematify.validation.stage import model_of  # noqa: PLC0415

        model = model_of(self.request)
        if not simplified(model) and len(self.request.free_travel) == len(self.mechanism.travels):
            return None
        return Sweeper.of(read_scene(model, self.request.settings.geometry, visible_shapes, thin=True))

    def _by_hand(self, travel: Travel, end: float) -> VelocityProbe:
        joint = self.robot.joint_by_name[travel.joint]
        resistance = {"resistance": joint.friction or 0.0, "damping": joint.damping or 0.0}
        push = self._push(travel, (travel.rest, end), self.strength(travel), **resistance)
        pushed = push_joint(self.loaded, push, self.values, contacts=True)
        run = VelocityProbe(
            travel=travel, values=self.values, push=push, pushed=pushed, end=end, free=self.free(travel) is not None
        )
        if self.reaches_end(run, pushed.farthest):
            return run
        if self._surfaces is None:
            seen = float(np.clip(end, *self.request.free_travel[travel.joint]))
        else:
            free = self._surfaces.free_end(self.mechanism.travels.index(travel), float(np.sign(end - travel.rest)))
            seen = min(end, free, key=lambda value: abs(value - travel.rest))
        run = replace(run, end=seen) if abs(seen - travel.rest) > self._nothing(travel) else replace(run, free=False)
        if self.reaches_end(run, pushed.farthest):
            return run
        return replace(run, without_contacts=push_joint(self.loaded, push, self.values, contacts=False).farthest)

    def by_motor(self, travel: Travel, end: float, effort: float) -> float:
        """Value that a joint gets to under gravity by no more than an effort, the others held [rad or m]."""
        push = self._push(travel, (travel.rest, end), effort, effort)
        return push_joint(self.loaded, push, self.values, contacts=True, gravity=True).farthest

    def strength(self, travel: Travel) -> float:
        """Force of the hand [N or N m]."""
        return self.settings.torque if travel.turns else self.settings.force

    def speed(self, travel: Travel) -> float:
        """Speed of the hand [rad/s or m/s]."""
        return self.settings.turning_speed if travel.turns else self.settings.sliding_speed

    def _push(
        self, travel: Travel, way: tuple[float, float], force: float, most: float = np.inf, **more: float
    ) -> Push:
        return velocity_probe(
            self.ratios(travel),
            way,
            inertias=self.inertias,
            force=force,
            speed=self.speed(travel),
            time_step=self.loaded.time_step,
            max_safe_force=min(self.max_safe_force[travel.joint], most),
            **more,
        )

    @cached_property
    def presses(self) -> tuple[VelocityProbe, ...]:
        """Every joint of a declared effort pressed against both declared limits, where nothing touches."""
        return tuple(
            self._press(travel, end, outwards, effort)
            for travel in self.travels
            for joint in (self.robot.joint_by_name[travel.joint],)
            if travel.limited and (effort := joint.effort or 0.0) > 0.0
            for end, declared, outwards in ((travel.lower, joint.lower, -1.0), (travel.upper, joint.upper, 1.0))
            if end == declared
        )

    def _press(self, travel: Travel, end: float, outwards: float, effort: float) -> VelocityProbe:
        inertia = sum(ratio**2 * self.inertias[name] for name, ratio in self.ratios(travel).items())
        force = min(self.strength(travel), effort, inertia * self.speed(travel) / self.settings.press)
        push = self._push(
            travel, (end, end + outwards * _FAR_BEYOND * self.still(travel)), force, most=force, patience=_YIELDING
        )
        values = self._values({travel.joint: end})
        pushed = push_joint(self.loaded, push, values, contacts=False)
        return VelocityProbe(travel=travel, values=values, push=push, pushed=pushed, end=end)

    @cached_property
    def speeds(self) -> dict[str, float]:
        """Every joint at the hand's speed towards the wider side of its range, followers with it [rad/s or m/s]."""
        speeds = dict.fromkeys(self.loaded.joints, 0.0)
        for travel in self.travels:
            up = travel.far_end == travel.upper
            for name, ratio in self.ratios(travel).items():
                speeds[name] += ratio * (self.speed(travel) if up else -self.speed(travel))
        return speeds

    @cached_property
    def released(self) -> EngineRun:
        """All joints given a push and let go."""
        return release(self.loaded, self.values, self.speeds, self.settings.release_seconds)

    @cached_property
    def fall(self) -> float:
        """Energy of a fall of the whole model by its own size [J]."""
        masses = [link.inertial.mass for link in self.robot.links if link.inertial is not None]
        return GRAVITY * float(sum(masses)) * self.size

    def reaches_end(self, run: VelocityProbe, farthest: float) -> bool:
        """True if a push got so far that the joint counts as moving to its end [rad or m]."""
        travel, way = run.travel, abs(run.end - run.travel.rest)
        gone, stopped = abs(farthest - travel.rest), run.end not in (travel.lower, travel.upper)
        touching = self.settings.touch_angle if travel.turns else self.settings.touch_length
        return gone >= self.settings.reach * way or (stopped and gone >= max(way - touching, 0.5 * way))
