"""A file in an engine as its users load it: untouched, with the engine's own defaults, and what it does there."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from kinematify.robot.arrays import FloatArray

_PROPORTIONAL, _INTEGRAL, _MOST_INTEGRAL = 0.3, 0.05, 0.4
"""Of the velocity error that a push takes away in one step: well below what the step can follow."""
_START_SECONDS = 0.5
"""In which a push at least brings a heavy part up to speed."""
NO_NUMBERS = "the values of joints are no numbers any more"
"""What is said of a run that ends in values that are none."""
PATIENCE = 0.8
"""Of a push, which has grown to its full force long before [s]."""


_FLOATS = "it gives links other joints than hinges and slides"


class Unloadable(Exception):
    """An engine does not open a file, or does not build a world; the message is the engine's."""

    def __init__(self, message: str = _FLOATS, reproduction: str = "") -> None:
        """Keep the message and plain code of the engine that shows it.

        Args:
            message: Of the engine; none: it opens the file and lets a link float, which no hand can push to an end.
            reproduction: Plain code of the engine.
        """
        super().__init__(" ".join(message.split())[:400].rstrip("."))
        self.floats, self.reproduction = message == _FLOATS, reproduction


@dataclass(frozen=True, kw_only=True)
class Overlap:
    """Two links whose collision geometry the engine finds in each other."""

    links: tuple[str, str]
    depth: float
    """[m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class EngineRun:
    """EngineRun of a model that is left alone, or that was given a push and let go."""

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


class EngineFile(ABC):
    """A file in an engine as its users load it, and the runs that are made of it; joints are known by their names.

    An engine that only reads implements `poses`, one that simulates all methods to `inertias`. Arrays have the order of
    `joints`.
    """

    code: ClassVar[Mapping[str, str]]
    """Plain code of the engine, which repeats what was found: templates by `joints` (prints each one with its limits),
    `overlap` (how deep two links are in each other), `rest` (the least and largest value of a joint), `push` (how far a
    joint gets), `push_alone` (without contacts), `release` (by how much the energy grows)."""
    joints: Sequence[str]
    """Names of the joints that move."""
    limits: Mapping[str, tuple[float, float]]
    """Lower and upper limit of each joint as the engine has read them [rad or m], infinite where there are none."""
    time_step: float = 1.0
    """Of the engine [s]."""
    look_steps: ClassVar[int] = 1
    """Between two looks at the energy."""
    _file: Mapping[str, object]
    """What the code says of the file, by the names in the templates."""

    # ---- what an engine implements -------------------------------------------------------------------------------

    @abstractmethod
    def poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """Return T_root_link of each link that the engine keeps apart, joints at `values`, shape (3, 4) each."""

    def begin(
        self,
        values: Mapping[str, float],
        speeds: Mapping[str, float] | None = None,
        *,
        contacts: bool,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """Begin a run.

        Args:
            values: Of all joints [rad or m].
            speeds: The same [rad/s or m/s]; None: all stand still.
            contacts: Links collide with each other.
            gravity: It acts.
            released: Indices of joints without motors, where an engine gives joints some; None: motors as loaded.
        """
        raise NotImplementedError

    def steps(self, count: int, every: int = 1) -> Iterator[int]:
        """Simulate, yielding the number of steps done after every few; ends early where the engine gives up."""
        raise NotImplementedError

    def state(self) -> tuple[FloatArray, FloatArray]:
        """Copies of values and speeds of all joints, shape (joints,) each."""
        raise NotImplementedError

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Set values and speeds of all joints in the course of a run."""
        raise NotImplementedError

    def apply(self, joint: int, force: float) -> None:
        """Apply a force to a joint in the next step [N or N m]."""
        raise NotImplementedError

    def energy(self) -> tuple[float, float]:
        """Potential and kinetic [J]."""
        raise NotImplementedError

    def touching(self) -> Iterable[tuple[str, str, float]]:
        """Two links and their depth [m] of every contact; the order of the links is that of the engine."""
        raise NotImplementedError

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """Return what a force at each joint moves in a step of a push [kg or kg m^2], shape (joints,)."""
        raise NotImplementedError

    @property
    def complaint(self) -> str | None:
        """Return what the engine says of the run since `begin`; None if nothing."""
        return None

    def max_safe_force(self, values: Mapping[str, float]) -> FloatArray:
        """Largest force at each joint that the engine answers rightly [N or N m], shape (joints,)."""
        return np.full(len(values), np.inf)

    def motor(self, joint: str, values: Mapping[str, float], target: float, seconds: float) -> float:
        """Drive a joint by its motor, without flags; the farthest value [rad or m]."""
        del target, seconds
        return values[joint]

    def _script_values(self, values: Mapping[str, float]) -> object:
        """Values of all joints as the code has them."""
        return [float(values[name]) for name in self.joints]

    def _links_in_code(self, links: tuple[str, str]) -> object:
        """Two links as the code has them."""
        return links

    def _index_of(self, joint: str) -> int:
        """The engine's index of a joint."""
        return self.joints.index(joint)

    def _moved_in_code(self, push: Push) -> object:
        """Return what a push moves as the code has it."""
        return [self._index_of(name) for name in push.moved]

    # ---- what is made of that ------------------------------------------------------------------------------------

    def rename(self, path: str) -> None:
        """Let the code open another file than the one that was loaded."""
        self._file = {**self._file, "path": path}

    def row(self, values: Mapping[str, float]) -> FloatArray:
        """Values of all joints in the engine's order."""
        return np.array([values[name] for name in self.joints])

    def overlaps(self, values: Mapping[str, float]) -> tuple[Overlap, ...]:
        """Pairs of links that overlap with the joints at `values` [rad or m], the deepest first."""
        self.begin(values, contacts=True, released=())
        return self._overlaps()

    def _overlaps(self) -> tuple[Overlap, ...]:
        depths: dict[tuple[str, str], float] = {}
        for first, second, depth in self.touching():
            depths[first, second] = max(depths.get((first, second), 0.0), depth)
        return deepest_first(depths)

    def rest(self, values: Mapping[str, float], seconds: float, *, contacts: bool) -> EngineRun:
        """Make go at `values`, with or without contacts among the links."""
        self.begin(values, contacts=contacts)
        seen = [self.state()[0] for _ in self.steps(self._steps(seconds))]
        values_seen = np.array(seen).reshape(len(seen), len(self.joints))
        finite = bool(np.isfinite(values_seen).all())
        return EngineRun(seen=values_seen, complaint=self.complaint or (None if finite else NO_NUMBERS))

    def release(self, values: Mapping[str, float], speeds: Mapping[str, float], seconds: float) -> EngineRun:
        """Make go at `values` with `speeds` [rad/s or m/s], without motors and without contacts among the links.

        The energy is seen, first right after the push; it ends where it is no number.
        """
        self.begin(values, speeds, contacts=False, released=range(len(self.joints)))
        seen = [self.energy()]
        for _ in self.steps(self._steps(seconds), self.look_steps):
            energy = self.energy()
            if not math.isfinite(sum(energy)):
                return EngineRun(seen=np.array(seen), complaint="the energy is no number any more")
            seen.append(energy)
        return EngineRun(seen=np.array(seen), complaint=self.complaint)

    def push(self, push: Push, values: Mapping[str, float], *, contacts: bool, gravity: bool = False) -> Pushed:
        """Push a joint from `values`, the others held there."""
        moved = np.array([self.joints.index(name) for name in push.moved])
        self.begin(values, contacts=contacts, gravity=gravity, released=moved.tolist())
        rest, ratios, weights = self.row(values), np.array(push.ratios), np.array(push.weights)
        progress = PushProgress(start=values[push.joint], push=push, time_step=self.time_step)
        done, pushed, still = 0, int(moved[0]), np.zeros_like(rest)
        self.apply(pushed, progress.force(0.0))
        for done in self.steps(push.steps):
            q, v = self.state()
            way, speed = weights @ (q - rest)[moved], float(weights @ v[moved])
            q, v = rest.copy(), still.copy()
            q[moved] += ratios * way
            v[moved] = ratios * speed
            self.set_state(q, v)
            if not progress.goes_on(float(q[pushed]), done):
                break
            self.apply(pushed, progress.force(speed))
        return Pushed(farthest=progress.value, steps=done, overlaps=self._overlaps())

    def script(
        self,
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
            template: Of `code`.
            values: Of all joints [rad or m]; None: zero.
            joint: That is printed.
            seconds: Length of the run [s].
            links: Of an overlap.
            speeds: Of all joints at a release.
            push: With its steps.
        """
        facts: dict[str, object] = {"steps": self._steps(seconds)}
        if push is not None:
            joint, facts = push[0].joint, vars(push[0]) | {"farthest": push[0].farthest, "steps": push[1]}
            facts["moved"] = self._moved_in_code(push[0])
        facts["joint"] = None if joint is None else self._index_of(joint)
        facts["links"] = None if links is None else self._links_in_code(links)
        facts["speeds"] = None if speeds is None else self._script_values(speeds)
        known = dict.fromkeys(self.joints, 0.0) if values is None else values
        return self.code.get(template, "").format(**self._file, values=self._script_values(known), **facts)

    def _steps(self, seconds: float) -> int:
        return round(seconds / self.time_step)


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
        inertias: From `RunningFile.inertias`, by joint.
        force: Of the hand [N or N m]; more is given where a heavy part would take long to start.
        speed: At least [rad/s or m/s]; long ways are gone faster.
        time_step: Of the engine [s].
        resistance: Declared friction that is overcome besides [N or N m].
        damping: The same of declared damping [N s/m or N m s/rad].
        max_safe_force: From `RunningFile.max_safe_force`; no more is given [N or N m].
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
