"""What would votes of a vision model be worth that is right in so many of a hundred answers?

**The voters are simulated**: they know the truth and are wrong at random as often as stated (5 draws each), on every
joint for itself; they say how sure they are, honestly but for those of whom the table says otherwise. Votes are added
as log odds by `configs/default.yaml`, section `vision`. Objects at rest, end to end; axis angles are means over an
object's joints, then over objects. It is a bound on what a real model could add: none was asked, and no inference ever
sees these answers elsewhere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field

from benchmarks.study import Options, Study, explained
from kinematify.config import load_config
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, find_objects
from kinematify.evaluation.job import erased_item, score_erased, shown_parts
from kinematify.evaluation.prediction import prediction_of
from kinematify.evaluation.record import table
from kinematify.joints.candidate import JointCandidate
from kinematify.pipeline import infer
from kinematify.vision.answer import TYPES, Direction, HingeSide, JointVotes, Vote
from kinematify.vision.votes import chosen_anew, direction_of, side_of

if TYPE_CHECKING:
    from benchmarks.study import Measured, Record, Work
    from kinematify.assembly.erase import ErasedModel
    from kinematify.assembly.part import Part
    from kinematify.assembly.truth import TrueJoint
    from kinematify.config import VisionConfig
    from kinematify.evaluation.record import Report
    from kinematify.pipeline import Inference

_NOBODY = "nobody"
_VOTERS = ((1.0, 1.0), (0.9, 0.9), (0.8, 0.8), (0.8, 0.95))
"""How often a voter is right, and how often it says it is."""
_DRAWS = 5
_QUESTIONS = ("type", "direction", "side")
_CHOICES = {"type": TYPES, "direction": tuple(Direction), "side": tuple(HingeSide)}


class VotersOptions(Options):
    """Which objects."""

    data: str = Field("everyday", description="Folder or set of objects.")
    most: int | None = Field(None, ge=1, description="So many objects.")


def measure(options: VotersOptions, work: Work) -> Measured:
    """Let voters of all kinds vote on every object."""
    objects = {item.name: item for item in find_objects(options.data)[: options.most]}
    records = list(work.each(voted_on, objects).values())
    rows = [
        {
            "voter": voter,
            **{name: float(np.mean([r["voters"][voter][name] for r in records])) for name in ("angle_deg", "types")},
        }
        for voter in (records[0]["voters"] if records else ())
    ]
    return records, {"objects": len(records), "rows": rows}


def voted_on(item: BenchObject) -> Record:
    """Infer one object once, then let voters of all kinds vote on it."""
    erased = erased_item(item, CONDITIONS[0])
    inference = infer(shown_parts(erased), config=load_config())
    found = {_NOBODY: [_errors(erased, inference)]}
    for questions in (("type",), ("direction",), _QUESTIONS):
        for voter in _VOTERS:
            rng = np.random.default_rng([11, round(100 * voter[0]), len(questions)])
            draws = 1 if voter[0] == 1.0 else _DRAWS
            found[_name(questions, voter)] = [_voted(erased, inference, questions, voter, rng) for _ in range(draws)]
    means = {voter: np.mean(draws, axis=0).tolist() for voter, draws in found.items()}
    return {
        "object": item.name,
        "voters": {voter: {"angle_deg": angle, "types": types} for voter, (angle, types) in means.items()},
    }


def _name(questions: tuple[str, ...], voter: tuple[float, float]) -> str:
    right, says = voter
    return f"{' and '.join(questions)}, {right:.0%} right{'' if says == right else f', says {says:.0%}'}"


def _voted(
    erased: ErasedModel,
    inference: Inference,
    questions: tuple[str, ...],
    voter: tuple[float, float],
    rng: np.random.Generator,
) -> tuple[float, float]:
    """Score an inference after one voter has voted on all joints whose parts stand in the truth."""
    index = {name: k for k, name in enumerate(erased.truth.part_names)}
    truth = {(joint.parent, joint.child): joint for joint in erased.truth.joints}
    votes = {}
    for k, joint in enumerate(inference.joints):
        pair = (index[inference.assembly.names[joint.parent]], index[inference.assembly.names[joint.child]])
        true = truth.get(pair)
        if true is not None:
            right = _right(true, inference.assembly.parts[joint.child], inference.config.vision)
            cast = {name: _cast(right[name], _CHOICES[name], voter, rng) for name in questions}
            votes[k] = JointVotes(kind=cast.get("type"), direction=cast.get("direction"), side=cast.get("side"))
    return _errors(erased, chosen_anew(inference, votes)[0])


def _right(true: TrueJoint, part: Part, config: VisionConfig) -> dict[str, str | None]:
    """The right answers; None where no view shows one."""
    candidate = JointCandidate(kind=true.kind, axis=true.axis, pivot=true.pivot, score=0.0, source="truth")
    return {
        "type": true.kind.value,
        "direction": direction_of(true.axis, config.oblique_deg),
        "side": side_of(candidate, part, config.off_center) if true.kind.turns else None,
    }


def _cast(
    right: str | None, choices: tuple[str, ...], voter: tuple[float, float], rng: np.random.Generator
) -> Vote | None:
    """A vote that says how sure its voter is; who sees nothing to answer abstains."""
    rate, says = voter
    draw, other = rng.random(), rng.integers(len(choices) - 1)
    if right is None:
        return None
    wrong = [choice for choice in choices if choice != right]
    return Vote(choice=str(right if draw < rate else wrong[other]), confidence=min(says, 0.99))


def _errors(erased: ErasedModel, inference: Inference) -> tuple[float, float]:
    """Mean axis angle [deg] and share of types that are right."""
    index = {name: k for k, name in enumerate(erased.truth.part_names)}
    prediction = prediction_of(inference.trees[0], inference.joints, inference.assembly.names, index)
    joints = score_erased(erased, prediction).joints
    return float(np.mean([j.angle_deg for j in joints])), float(np.mean([j.type_right for j in joints]))


def report(found: Report[Record]) -> list[str]:
    """One line per voter."""
    rows = [(row["voter"], f"{row['angle_deg']:.2f}", f"{100.0 * row['types']:.1f}") for row in found.summary["rows"]]
    return [
        f"{found.summary['objects']} objects. " + explained(__doc__),
        table(("voter", "axis angle [deg]", "types [%]"), rows),
    ]


STUDY = Study(
    title="What votes of a vision model would be worth", options=VotersOptions, measure=measure, report=report
)
