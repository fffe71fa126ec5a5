"""Which of the proposed joints of an edge is the right one: probabilities, the best one, and what else it may be."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import expit

from kinematify.joints.candidate import FIXED, SLIDE, TURN, JointCandidate, JointType
from kinematify.joints.choice.opening import rigid_odds
from kinematify.joints.choice.scorer import shipped_scorer
from kinematify.joints.features.workspace import point_cloud
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import ConfidenceConfig
    from kinematify.joints.candidate import Hypotheses
    from kinematify.joints.features.columns import Features
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


_SAME_COSINE = float(np.cos(np.radians(5.0)))
_SAME_LINE = 0.02
_ANGLE = 4.0  # [deg] off by this much, a direction counts 1/e
_DISTANCE = 0.05  # of the child's diagonal, the same for a line
_SURER = 1.33  # power of what the models say together: each errs where others do not, and their mean is too unsure


@dataclass(frozen=True, kw_only=True, eq=False)
class Posterior:
    """The hypotheses of one edge with their probabilities."""

    hypotheses: Hypotheses
    prior: FloatArray
    """Sum 1, shape (h,)."""
    by_cues: int
    """Position of what the weighted cues alone would choose."""
    support: FloatArray
    """What the weighted cues say of each hypothesis among those of its type, shape (h,); NaN for fixed."""
    size: float
    """Diagonal of the child [m]."""
    prior_log_odds: float
    """Log odds that what cues would choose keeps."""
    fixed: float = 0.0
    """How likely the child is fixed to its parent, whatever moves best."""

    @cached_property
    def posterior(self) -> FloatArray:
        """Probabilities after the lead that what cues would choose has, shape (h,).

        On what neither has seen, cues are right more often where the fit is not clearly surer (`results/choice.md`).
        """
        led = self.prior * np.exp(self.prior_log_odds * self._same[self.by_cues])
        return np.asarray(led / led.sum())

    @cached_property
    def scores(self) -> FloatArray:
        """Log of how right each hypothesis is expected to be, shape (h,); -inf for fixed.

        The lead is in the choice alone: what it puts first stands level with the likeliest, so that votes and
        simulations are not weighed against it twice.
        """
        moving = self.hypotheses.kinds != FIXED
        found = np.where(moving, np.log(np.maximum(self._expected_score @ self.prior, 1e-12)), -np.inf)
        return np.where(self._same[self.best], found.max(), found)

    @cached_property
    def best(self) -> int:
        """Position of the chosen hypothesis: of the one that is expected to be nearest to right.

        Among those that say the same it is the one that cues rank first: a bearing is exact, and an edge of the box
        beside it is not.
        """
        moving = self.hypotheses.kinds != FIXED
        first = int(np.argmax(np.where(moving, self._expected_score @ self.posterior, -1.0)))
        return int(np.argmax(np.where(self._same[first], self.support, -np.inf)))

    @cached_property
    def _expected_score(self) -> FloatArray:
        """Return how right each hypothesis would be where another one is the true joint (`rightness`), shape (h, h).

        So lines that lie side by side share what is likely of a hinge there, and none loses to a slide alone.
        """
        h = self.hypotheses
        degrees = np.degrees(np.arccos(np.clip(np.abs(h.axes @ h.axes.T), 0.0, 1.0)))
        apart = np.where((h.kinds == TURN)[:, None], np.minimum(self._apart, self._apart.T), 0.0)
        return np.asarray((h.kinds[:, None] == h.kinds) * rightness(degrees, apart / self.size))

    @cached_property
    def _apart(self) -> FloatArray:
        """Distance of the pivot of each hypothesis from the line of each other one [m], shape (h, h)."""
        h = self.hypotheses
        return np.asarray(lengths_of(crossed(h.pivots[:, None] - h.pivots[None], h.axes[:, None])))

    @cached_property
    def _same(self) -> BoolArray:
        """Which say the same: type, direction to 5 deg, and line to a fiftieth of the part, shape (h, h)."""
        h = self.hypotheses
        near = (self._apart < _SAME_LINE * self.size) | (h.kinds == SLIDE)[:, None]
        return np.asarray(self._agree & near & near.T)

    @cached_property
    def _agree(self) -> BoolArray:
        """Which agree in type and, to 5 deg, in direction, shape (h, h)."""
        h = self.hypotheses
        return np.asarray((h.kinds[:, None] == h.kinds) & (np.abs(h.axes @ h.axes.T) > _SAME_COSINE))

    def kind(self, index: int) -> JointType:
        """Type of a hypothesis."""
        return JointType.PRISMATIC if self.hypotheses.kinds[index] == SLIDE else JointType.REVOLUTE

    @property
    def confidence(self) -> float:
        """Return how likely type and direction are right: of all hypotheses that agree with the best one in both."""
        surer = replace(self, prior=self.prior**_SURER).posterior
        return float(min(surer[self._agree[self.best]].sum(), 1.0))

    @property
    def odds_prismatic(self) -> float:
        """Log odds of sliding against turning."""
        slide, turn = (max(self.posterior[self.hypotheses.kinds == kind].sum(), 1e-9) for kind in (SLIDE, TURN))
        return float(np.log(slide / turn))

    def alternatives(self, count: int) -> tuple[JointCandidate, ...]:
        """The hypotheses that say different things, best first, `count` of either type at most."""
        h = self.hypotheses
        kept = [self.best]
        for i in np.argsort(-self.scores, kind="stable"):
            few = sum(h.kinds[k] == h.kinds[i] for k in kept) < count
            if h.kinds[i] != FIXED and few and not self._same[i, kept].any():
                kept.append(int(i))
        return tuple(
            JointCandidate(
                kind=self.kind(i),
                axis=h.axes[i],
                pivot=h.pivots[i],
                score=float(self.scores[i]),
                source=str(h.sources[i]),
                evidence={"probability": float(self.posterior[i])},
            )
            for i in kept
        )


def rightness(degrees: FloatArray, apart: FloatArray) -> FloatArray:
    """Return how right a joint of the right type is, in [0, 1]: what the fit aims at, and what the choice expects.

    Args:
        degrees: Angle between its direction and the true one [deg].
        apart: Distance of its line from the true one, in diagonals of the child; 0 for slides. Same shape.
    """
    return np.exp(-((degrees / _ANGLE) ** 2) - (apart / _DISTANCE) ** 2)


def judge(features: Features, config: ConfidenceConfig) -> Posterior:
    """Score every proposed joint of an edge beside all others.

    Args:
        features: What is measured of them.
        config: How much cues and the child's name weigh, and from where on a part is fixed.
    """
    scene, hypotheses, columns = features.scene, features.hypotheses, features.columns
    cloud = point_cloud(scene.cache, scene.parent, scene.child, scene.others, scene.frame.diagonal)
    likely = shipped_scorer().probabilities(hypotheses, columns, cloud)
    odds = rigid_odds(hypotheses.kinds, columns)
    said = kind_said(scene.cache.assembly.parts[scene.child].name)
    if said is not None:
        likely *= np.exp(config.name_weight * (hypotheses.kinds == said))
        odds += config.name_weight if said == FIXED else -config.name_weight
    return Posterior(
        hypotheses=hypotheses,
        prior=likely / likely.sum(),
        fixed=float(expit(odds)),
        by_cues=features.by_cues,
        support=columns["rules_score"],
        size=scene.frame.diagonal,
        prior_log_odds=config.cues_lead,
    )


_WORDS = {
    SLIDE: "drawer tray slider slide button key keycap piston plunger carriage cartridge telescope",
    TURN: (
        "door flap hatch wheel handwheel tire tyre caster knob dial crank propeller prop rotor fan blade turntable "
        "gate lever pedal valve tap faucet arm forearm upperarm elbow wrist shoulder hip knee thigh shin calf "
        "ankle screen visor rudder aileron elevator tailgate trunk bonnet hood thruster pulley gear roller "
        "drum needle pointer shutter"
    ),
    FIXED: (
        "foot feet shelf shelves label logo badge sticker glass pane trim bracket rivet bumper backboard skirting "
        "plinth mounting grille casing housing mirror headlight upholstery cushion"
    ),
}
_KIND_OF = {word: kind for kind, words in _WORDS.items() for word in words.split()}
_SILENT = frozenset(["handle", "grip", "frame", "hinge"])
_LEAST_END = 4
_TOKEN = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")


def kind_said(name: str) -> int | None:
    """FIXED, TURN or SLIDE where a word of the name says so, None where none does: a drawer slides, a door turns.

    The last word that says something decides, as in "oven door" and "drawer_2". Names with a word such as "handle"
    say nothing: those of doors turn, those of drawers are fixed.
    """
    said = None
    for token in _TOKEN.findall(name):
        word = token.lower()
        if word.removesuffix("s") in _SILENT:
            return None
        # It, its singular, or what it ends with ("hingedoor").
        ends = [known for known in _KIND_OF if len(known) >= _LEAST_END and word.endswith(known)]
        forms = (word, word.removesuffix("s"), max(ends, key=len, default=""))
        said = next((_KIND_OF[form] for form in forms if form in _KIND_OF), said)
    return said


_LEAST = 1.0e-6  # probability of a type, so that one part alone cannot rule a type out for all


def agreed(kinds: Sequence[IntArray], likely: Sequence[FloatArray]) -> list[FloatArray]:
    """Probabilities of the hypotheses of edges that are alike, after they have agreed on a type.

    The probability of each type is the geometric mean over the edges; within a type nothing changes.

    Args:
        kinds: FIXED, TURN or SLIDE of the hypotheses of each edge, shape (h,) each.
        likely: Their probabilities, sum 1, shape (h,) each.

    Returns:
        The new probabilities, sum 1, shape (h,) each.
    """
    of_types = [
        [max(probability[kind == each].sum(), _LEAST) for each in (FIXED, TURN, SLIDE)]
        for kind, probability in zip(kinds, likely, strict=True)
    ]
    logs = np.log(np.array(of_types))
    lifted = [
        probability * np.exp(logs.mean(axis=0) - own)[kind]
        for kind, probability, own in zip(kinds, likely, logs, strict=True)
    ]
    return [np.asarray(probability / probability.sum()) for probability in lifted]
