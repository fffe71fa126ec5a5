"""Runs of a file in an engine: left alone, released, pushed by a hand, driven by a motor, set on a floor."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.simulation.world import FLOOR

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.engine import Engine

_PROPORTIONAL, _INTEGRAL, _MOST_INTEGRAL = 0.3, 0.05, 0.4
"""Of the velocity error that a push takes away in one step: well below what the step can follow."""
_START_SECONDS = 0.5
"""In which a push at least brings a heavy part up to speed."""
NOT_NUMBERS = ("badqpos", "badqvel", "badqacc")
"""Warnings of MuJoCo after which a run counts for nothing."""
NO_NUMBERS = "the values of joints are no numbers any more"
"""What is said of a run that ends in values that are none."""
PATIENCE = 0.8
"""Of a push, which has grown to its full force long before [s]."""


@dataclass(frozen=True, kw_only=True)
class Overlap:
    """Two links whose collision geometry the engine finds in each other."""

    links: tuple[str, str]
    depth: float
    """[m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class EngineRun:
    """A model that is left alone, or that was given a push and let go."""

    seen: FloatArray
    """Values of all joints [rad or m], shape (steps, joints); or potential and kinetic energy [J], shape (looks, 2)."""
    complaint: str | None
    """What the engine says of the run; None if nothing."""


@dataclass(frozen=True, kw_only=True)
class Push:
    """A joint moved by a hand, its followers with it, the others held, without gravity: a force keeps a speed."""

    moved: tuple[str, ...]
    """The joint, and those that mimic it."""
    ratios: tuple[float, ...]
    """Motion of each of `moved` per motion of the joint."""
    weights: tuple[float, ...]
    """What the motion of each counts where an engine lets them drift apart; with `ratios` they make 1."""
    target: float
    """[rad or m]."""
    speed: float
    """Towards the target, with its sign [rad/s or m/s]."""
    proportional: float
    """Force per error of the speed [N s/m or N m s/rad]."""
    integral: float
    """The same, added up in each step."""
    force: float
    """At most [N or N m]."""
    steps: int
    """At most."""
    patience: float
    """After which it is stuck where it goes on by less than a hundredth of its way [s]."""

    @property
    def joint(self) -> str:
        """That is pushed."""
        return self.moved[0]

    @property
    def farthest(self) -> str:
        """The function of Python that picks the value that is farthest on the way."""
        return "max" if self.speed > 0.0 else "min"


@dataclass(frozen=True, kw_only=True)
class Pushed:
    """Result of a push."""

    farthest: float
    """[rad or m]."""
    steps: int
    """After which it arrived, was stuck or was given up."""
    overlaps: tuple[Overlap, ...]
    """Where it ended, the deepest first."""


def row(engine: Engine, values: Mapping[str, float]) -> FloatArray:
    """Return the values of all joints in the engine's order."""
    return np.array([values[name] for name in engine.joints])


def poses(engine: Engine, values: Mapping[str, float]) -> dict[str, FloatArray]:
    """Return T_root_link of each link that the engine keeps apart, joints at `values`, shape (4, 4) each."""
    engine.place(row(engine, values), contacts=False)
    found = engine.link_poses()
    T_root = np.linalg.inv(found[engine.root]) if engine.root in found else np.eye(4)
    return {name: T_root @ pose for name, pose in found.items()}


def overlaps(engine: Engine, values: Mapping[str, float] | None = None) -> tuple[Overlap, ...]:
    """Return pairs of links that overlap, joints at `values` [rad or m] or as they are, the deepest first."""
    if values is not None:
        engine.place(row(engine, values), released=())
    deepest: dict[tuple[str, str], float] = {}
    for pair, depth in zip(*(part.tolist() for part in engine.contacts()), strict=True):
        first, second = (engine.links[number] for number in sorted(pair))
        deepest[first, second] = max(deepest.get((first, second), 0.0), depth)
    return deepest_first(deepest)


def complaint(engine: Engine) -> str | None:
    """Return what the engine says of numbers that are none; None if nothing."""
    broken = [name for name in NOT_NUMBERS if name in engine.warnings()]
    return f"{engine.title} warns {', '.join(name.upper() for name in broken)}" if broken else None


def rest(engine: Engine, values: Mapping[str, float], seconds: float, *, contacts: bool) -> EngineRun:
    """Make go at `values`, with or without contacts among the links."""
    engine.place(row(engine, values), contacts=contacts)
    seen = [engine.state()[0] for _ in _steps(engine, seconds)]
    values_seen = np.array(seen).reshape(len(seen), len(engine.joints))
    finite = bool(np.isfinite(values_seen).all())
    return EngineRun(seen=values_seen, complaint=complaint(engine) or (None if finite else NO_NUMBERS))


def release(engine: Engine, values: Mapping[str, float], speeds: Mapping[str, float], seconds: float) -> EngineRun:
    """Make go at `values` with `speeds` [rad/s or m/s], without motors and without contacts among the links.

    The energy is seen, first right after the push; it ends where it is no number.
    """
    start, pushed = row(engine, values), row(engine, speeds)
    engine.place(start, speeds=pushed, contacts=False, released=range(len(start)))
    seen = [engine.energy()]
    for _ in _steps(engine, seconds, engine.look_steps):
        energy = engine.energy()
        if not math.isfinite(sum(energy)):
            return EngineRun(seen=np.array(seen), complaint="the energy is no number any more")
        seen.append(energy)
    return EngineRun(seen=np.array(seen), complaint=complaint(engine))


def push_joint(
    engine: Engine, push: Push, values: Mapping[str, float], *, contacts: bool, gravity: bool = False
) -> Pushed:
    """Push a joint from `values`, the others held there."""
    moved = np.array([engine.joints.index(name) for name in push.moved])
    start, ratios, weights = row(engine, values), np.array(push.ratios), np.array(push.weights)
    engine.place(start, contacts=contacts, gravity=gravity, released=moved.tolist())
    progress = PushProgress(start=values[push.joint], push=push, time_step=engine.time_step)
    done, pushed, still = 0, int(moved[0]), np.zeros_like(start)
    engine.apply(pushed, progress.force(0.0))
    for done in range(1, push.steps + 1):
        engine.step()
        q, v = engine.state()
        way, speed = weights @ (q - start)[moved], float(weights @ v[moved])
        q, v = start.copy(), still.copy()
        q[moved] += ratios * way
        v[moved] = ratios * speed
        engine.set_state(q, v)
        if not progress.goes_on(float(q[pushed]), done):
            break
        engine.apply(pushed, progress.force(speed))
    return Pushed(farthest=progress.value, steps=done, overlaps=overlaps(engine))


def drive(engine: Engine, joint: str, values: Mapping[str, float], target: float, seconds: float) -> float:
    """Drive a joint by its motor, without contacts and gravity, the others held by theirs; the farthest value."""
    start, index = row(engine, values), engine.joints.index(joint)
    engine.place(start, contacts=False, gravity=False, released=())
    engine.command(row(engine, {**values, joint: target}))
    sign, farthest = np.sign(target - values[joint]), values[joint]
    for _ in _steps(engine, seconds):
        farthest = sign * max(sign * farthest, sign * float(engine.state()[0][index]))
    return float(sign * min(sign * farthest, sign * target))


def stand(engine: Engine, values: Mapping[str, float], seconds: float) -> dict[str, float]:
    """Leave a file alone that stands on a floor (`OpenedFile.on_floor`).

    Returns:
        How far its base has moved [m] and turned [rad], how deep the deepest contact is [m], and how many contacts
        there are with the floor.
    """
    engine.place(np.array([values.get(name, 0.0) for name in engine.joints]))
    start = engine.link_poses()[engine.root]
    engine.step(round(seconds / engine.time_step))
    off, (pairs, depth) = engine.link_poses()[engine.root] - start, engine.contacts()
    half = float(np.linalg.norm(off[:3, :3])) / math.sqrt(8.0)  # the sine of half the angle
    return {
        "moved": float(np.linalg.norm(off[:3, 3])),
        "turned": 2.0 * math.asin(min(half, 1.0)),
        "deepest": float(depth.max(initial=0.0)),
        "on_floor": float((pairs == engine.links.index(FLOOR)).any(axis=1).sum()),
    }


def script(
    engine: Engine,
    template: str,
    values: Mapping[str, float] | None = None,
    *,
    joint: str | None = None,
    seconds: float = 0.0,
    links: tuple[str, str] | None = None,
    speeds: Mapping[str, float] | None = None,
    push: tuple[Push, int] | None = None,
) -> str:
    """Return plain code of the engine that shows what was found; empty where the engine has none for that.

    Args:
        engine: With the file.
        template: Of `Engine.code`.
        values: Of all joints [rad or m]; None: zero.
        joint: That is printed.
        seconds: Length of the run [s].
        links: Of an overlap.
        speeds: Of all joints at a release.
        push: With its steps.
    """
    numbers, keyed = engine.joint_code, engine.keyed

    def coded(known: Mapping[str, float]) -> object:
        found = {numbers[name]: float(known[name]) for name in engine.joints}
        return found if keyed else list(found.values())

    facts: dict[str, object] = {"steps": round(seconds / engine.time_step)}
    if push is not None:
        joint, facts = push[0].joint, vars(push[0]) | {"farthest": push[0].farthest, "steps": push[1]}
        moved = [numbers[name] for name in push[0].moved]
        facts["moved"] = list(zip(moved, push[0].ratios, push[0].weights, strict=True)) if keyed else moved
    facts["joint"] = None if joint is None else numbers[joint]
    both = {engine.link_code.get(name, name) for name in links or ()}
    facts["links"] = both if keyed else sorted(both, key=str)
    facts["speeds"] = None if speeds is None else coded(speeds)
    facts["values"] = coded(dict.fromkeys(engine.joints, 0.0) if values is None else values)
    return engine.code.get(template, "").format(**engine.facts, **facts)


def _steps(engine: Engine, seconds: float, every: int = 1) -> Iterator[None]:
    """Simulate, with a look after every few steps."""
    for _ in range(round(seconds / engine.time_step) // every):
        engine.step(every)
        yield


def velocity_probe(
    ratios: Mapping[str, float],
    way: tuple[float, float],
    *,
    inertias: Mapping[str, float],
    force: float,
    speed: float,
    time_step: float,
    resistance: float = 0.0,
    damping: float = 0.0,
    max_safe_force: float = np.inf,
    patience: float = PATIENCE,
) -> Push:
    """Return the push of a hand that holds a velocity.

    Args:
        ratios: Motion of the joint, 1, and of its followers, by name.
        way: From where to where [rad or m].
        inertias: From `Engine.inertias`, by joint.
        force: Of the hand [N or N m]; more is given where a heavy part would take long to start.
        speed: At least [rad/s or m/s]; long ways are gone faster.
        time_step: Of the engine [s].
        resistance: Declared friction that is overcome besides [N or N m].
        damping: The same of declared damping [N s/m or N m s/rad].
        max_safe_force: From `Engine.max_safe_force`; no more is given [N or N m].
        patience: See `Push`.
    """
    inertia_of = {name: max(inertias[name], 1e-9) for name in ratios}
    inertia = sum(ratio**2 * inertia_of[name] for name, ratio in ratios.items())
    length = abs(way[1] - way[0])
    speed = max(speed, 0.5 * length)
    force = min(max(force, inertia * speed / _START_SECONDS) + resistance + damping * speed, max_safe_force)
    whole = force * time_step / (speed * _START_SECONDS)  # grows to the full force in that time
    return Push(
        moved=tuple(ratios),
        ratios=tuple(ratios.values()),
        weights=tuple(ratio * inertia_of[name] / inertia for name, ratio in ratios.items()),
        target=way[1],
        speed=float(np.copysign(speed, way[1] - way[0])),
        proportional=_PROPORTIONAL * inertia / time_step,
        integral=float(np.clip(whole, _INTEGRAL * inertia / time_step, _MOST_INTEGRAL * inertia / time_step)),
        force=force,
        steps=int((2.0 + 2.0 * length / speed) / time_step),
        patience=patience,
    )


@dataclass(kw_only=True)
class PushProgress:
    """The hand of a push: its force, how far it has got, and whether it goes on."""

    start: float
    push: Push
    time_step: float
    farthest: float = 0.0
    _marked: float = 0.0
    _since: int = 0
    _grown: float = 0.0

    def force(self, speed: float) -> float:
        """Force at the joint in the next step [N or N m], which goes at a speed [rad/s or m/s]."""
        push, slow = self.push, self.push.speed - speed
        self._grown = min(max(self._grown + push.integral * slow, -push.force), push.force)
        return min(max(push.proportional * slow + self._grown, -push.force), push.force)

    def goes_on(self, value: float, step: int) -> bool:
        """Take in the joint's value [rad or m] after a step; False once it has arrived or is stuck."""
        way = self.push.target - self.start
        gone = (value - self.start) * math.copysign(1.0, way)
        self.farthest = max(self.farthest, gone) if math.isfinite(gone) else self.farthest
        if self.farthest > self._marked + 0.01 * abs(way):
            self._marked, self._since = self.farthest, step
        return self.farthest < abs(way) and (step - self._since) * self.time_step < self.push.patience

    @property
    def value(self) -> float:
        """The joint's value where it got farthest [rad or m]."""
        return float(self.start + np.copysign(self.farthest, self.push.target - self.start))


def deepest_first(depths: Mapping[tuple[str, str], float]) -> tuple[Overlap, ...]:
    """Return the overlaps of pairs, keyed by their links [m]."""
    pairs = sorted(depths.items(), key=lambda item: (-item[1], item[0]))
    return tuple(Overlap(links=links, depth=depth) for links, depth in pairs if depth > 0.0)
