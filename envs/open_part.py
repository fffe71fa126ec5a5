"""OpenPart: a hand without a robot opens a door, a drawer or a lid."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.spaces import Box
from gymnasium.utils import EzPickle

from kinematify.envs.base import OpeningEnv, made, one_of
from kinematify.envs.goal import CONTROL_STEP, OPEN_BOUND, PLACE_BOUND, SPEED_BOUND, SUBSTEPS
from kinematify.envs.worlds import HAND_SPEED, hand_facts
from kinematify.errors import InputError
from kinematify.simulation.engine import depth_of

if TYPE_CHECKING:
    from pathlib import Path

    from gymnasium import spaces
    from numpy.typing import NDArray

    from kinematify.envs.articulated_object import Target
    from kinematify.envs.goal import Goal
    from kinematify.envs.worlds import HandFacts
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.world import ObjectState

    Space = spaces.Space[NDArray[np.float32]]


FORCE, POSITION = "force", "position"


class OpenPartEnv(OpeningEnv):
    """Open one part of an object, and leave it open and at rest, by a force at the point where it would be held.

    There is no robot: the hand is a force (``control="force"``) or a spring between a commanded place and the part
    (``control="position"``), at the best hold that a gripper would find, or at the outermost point of the part.
    Friction, damping, weight, limits and collisions of the object are those of the engine. Episodes are truncated
    after 100 steps of 0.05 s.

    ## Action space

    `Box(-1, 1, (3,), float32)`, along the axes of the world:

    | index | force control | position control |
    |---|---|---|
    | 0 to 2 | force in shares of `full_force` [N] | speed of the hand in shares of 1.2 ways per second [m/s] |

    `full_force` is three times what opens the part from rest to rest in 1.5 s, against its weight, friction and
    damping. In position control the spring pulls with at most this force, which it has when the hand is 8 % of the
    way ahead.

    ## Observation space

    `Box((57,), float32)` for models of up to 16 joints (`S` = 16; models with more get the next multiple of 16):

    | index | what | lowest | highest | unit |
    |---|---|---|---|---|
    | 0 to 15 | where each joint is in its range; slot 0 is the one that is opened, 0 closed, 1 open | -2 | 2 | 1 |
    | 16 to 31 | their speeds, in ranges per second | -20 | 20 | 1/s |
    | 32 to 47 | 1 for slots with a joint | 0 | 1 | 1 |
    | 48 to 50 | the hold, from where it is at rest (usual place of the object), world axes | -10 | 10 | m |
    | 51 to 53 | from the hold to where the hand wants it, zero in force control | -10 | 10 | m |
    | 54 to 56 | unit direction in which the hold moves when the part opens | -1 | 1 | 1 |

    ## Reward

    Dense, in [0, 1]: 0.5 times the share of `open_fraction` that is open, plus 0.5 for success. The first part is
    paid in full up to 1.5 ways per second, falls to nothing at 3, and is not paid for a part that was thrown. Sparse
    (``reward="sparse"``): 1 for success, else 0.

    ## Success, and the end

    Success: at least `open_fraction` of the way is open, no faster than 0.1 ways per second during the last step, and
    not thrown. *Thrown* is a part that was faster than 1.5 ways per second where it counts as open; it must come back
    by 10 % of the way before it counts again. Episodes end on success only with ``terminate_on_success=True``; they
    also end if the engine becomes unstable or the hold gets three sizes of the object away.

    ## Start

    The part is open by 0 to 5 % of its way, all other joints rest, nothing moves. A start in which two parts are
    deeper in each other than 0.2 % of the object's size is drawn again. ``reset(options=...)`` takes ``joint``
    (name), ``qpos`` (joint -> value [rad or m]) and ``open_fraction`` (0 to 1); the last two replace the draw.

    ## Info

    ``is_success``, ``open_fraction`` [1], ``thrown``, ``max_penetration`` [m] (beyond what touches at rest),
    ``escaped``, ``unstable``, ``warnings`` (of the engine, with counts), ``joint``, ``validation`` (``pass``,
    ``warn``, ``fail``, ``bundled``).

    ## Randomisation

    ``randomize=True``, or some of ``damping`` and ``friction`` (factors 0.5 to 2 for each joint; friction of surfaces
    too), ``mass`` (factor 0.8 to 1.25 for each link), ``pose`` (0.05 m along x and y, 0.35 rad about z, either way)
    and ``color`` (0.25 of each channel). Joints without damping in the file get 1.5 1/s times the inertia that they
    move, those without friction 0.3 m/s^2 or rad/s^2 times it, or 1.3 times what their own weight would move them with.
    """

    def __init__(
        self,
        model: str | Path | None = None,
        *,
        control: str = FORCE,
        robot: str | Path | None = None,
        closing: bool = False,
        **keywords: Any,
    ) -> None:
        """Make the environment.

        Args:
            model: As for `OpeningEnv`.
            control: ``force`` or ``position``.
            robot: None; `DrawerPullEnv` has robots.
            closing: Begin with the part open, and shut it: closed counts as open everywhere, and open as closed.
            keywords: Of `OpeningEnv`.

        Raises:
            InputError: A keyword is impossible, or the model cannot be used; the message says what to do.
            EnvironmentFault: The validation itself failed.
        """
        EzPickle.__init__(self, model, control=control, robot=robot, closing=closing, **keywords)
        one_of("control", control, (FORCE, POSITION))
        if robot is not None:
            raise InputError(
                f"OpenPart has no robot, but robot={str(robot)!r} was given. Leave it out, or make "
                "kinematify/DrawerPull-v0, which has one."
            )
        self.control, self._closing = control, closing
        super().__init__(model, **keywords)
        self._make_world()
        self.action_space: Space = Box(-1.0, 1.0, (3,), np.float32)
        self.observation_space: Space = hand_space(self.goal)
        self.bounds = hand_bounds(self.goal)

    def _targeted(self, joint: str) -> Target:
        found = super()._targeted(joint)
        return found.reversed if self._closing else found

    def _make_world(self) -> None:
        self.facts: HandFacts = hand_facts(self.articulated_object, self.target, spring=self.control == POSITION)
        self.world = self.facts.opened(self.engine)
        self._command = self._hold = np.zeros(3)
        self._stride = HAND_SPEED * self.target.way * CONTROL_STEP
        self._lead = self.facts.hand.force / self.facts.hand.stiffness

    def _place(self, leaders: FloatArray) -> float:
        """The hand's spring is slack."""
        self.world.place(self.articulated_object.scene.mechanism.all_values(leaders[None])[0])
        self._hold = self.world.observe().hold
        if self.control == POSITION:
            self._command = self._hold.copy()
            self.world.command(self._command)
        return depth_of(self.world)

    def commanded(self, before: FloatArray, hold: FloatArray, action: FloatArray) -> FloatArray:
        """Return what an action commands of the hand, shapes (..., 3): forces in shares, or a place [m].

        Args:
            before: What was commanded until now.
            hold: Where the part is held [m].
            action: Within -1 and 1.
        """
        if self.control == FORCE:
            return action
        lead = before - hold + self._stride * action
        return np.asarray(hold + np.minimum(np.maximum(lead, -self._lead), self._lead))

    def _act(self, action: NDArray[np.float32]) -> None:
        clipped = np.minimum(np.maximum(np.asarray(action, dtype=np.float64), -1.0), 1.0)
        self._command = self.commanded(self._command, self._hold, clipped)
        self.world.command(self._command)
        self.world.step(SUBSTEPS)

    def _observe(self, reading: ObjectState) -> NDArray[np.float32]:
        self._hold = reading.hold
        command = self._command - reading.hold if self.control == POSITION else np.zeros(3)
        return observe_hand(self.goal, reading, self.middle, command, self.bounds)


def hand_space(goal: Goal) -> Space:
    """Space of `observe_hand`."""
    low, high = hand_bounds(goal)
    return Box(low.astype(np.float32), high.astype(np.float32), dtype=np.float32)


def hand_bounds(goal: Goal) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest that `observe_hand` returns, shape (3 * slots + 9,) each."""
    slots = goal.slots
    high = np.repeat([OPEN_BOUND, SPEED_BOUND, 1.0, PLACE_BOUND, PLACE_BOUND, 1.0], [slots, slots, slots, 3, 3, 3])
    low = -high
    low[2 * slots : 3 * slots] = 0.0
    return low, high


def observe_hand(
    goal: Goal, reading: ObjectState, middle: FloatArray, command: FloatArray, bounds: tuple[FloatArray, FloatArray]
) -> NDArray[np.float32]:
    """Return what is seen of an object and a hand, shape (..., 3 * slots + 9), within `bounds` (`hand_space`)."""
    found = np.zeros((*reading.hold.shape[:-1], len(bounds[0])))
    goal.fill_joints(reading, found)
    start = 3 * goal.slots
    found[..., start : start + 3] = reading.hold - middle
    found[..., start + 3 : start + 6] = command
    found[..., start + 6 : start + 9] = goal.direction(reading)
    return np.minimum(np.maximum(found, bounds[0], out=found), bounds[1], out=found).astype(np.float32)


make_open_part = partial(made, OpenPartEnv)
"""What `gymnasium.make` calls; keywords are those of `OpenPartEnv`, `observation` and `pixel_size` (`made`)."""
