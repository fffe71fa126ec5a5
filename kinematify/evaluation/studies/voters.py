"""What a vision model that is right in so many of a hundred answers would be worth: results/voters.{json,md}.

The voters are simulated: they know the truth, and answer wrongly at random as often as they are told to. It is a bound
on what a real model could add, not a measurement of one, and no inference ever sees these answers elsewhere.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.erase import erase
from kinematify.assembly.part import Assembly
from kinematify.config import load_config
from kinematify.evaluation.datasets import CONDITIONS, find_objects
from kinematify.evaluation.metrics import score_object
from kinematify.evaluation.prediction import prediction_of
from kinematify.joints.candidate import JointCandidate
from kinematify.pipeline import infer
from kinematify.robot.read import read_robot
from kinematify.vision.answer import TYPES, Direction, JointVotes, Side, Vote
from kinematify.vision.votes import chosen_anew, direction_of, side_of

if TYPE_CHECKING:
    from kinematify.assembly.erase import ErasedModel
    from kinematify.assembly.part import Part
    from kinematify.assembly.truth import TrueJoint
    from kinematify.config import VisionConfig
    from kinematify.evaluation.metrics import ObjectScore
    from kinematify.pipeline import Inference

_VOTERS = ((1.0, 1.0), (0.9, 0.9), (0.8, 0.8), (0.8, 0.95))
"""How often a voter is right, and how often it says it is."""
_DRAWS = 5
_INTRODUCTION = (
    "`python benchmarks/voters.py ../shared/bench/everyday`: {objects} objects at rest, end to end. **The voters are "
    "simulated**: they know the truth and are wrong at random as often as stated ({draws} draws each), on every joint "
    "for itself; they say how sure they are, honestly but for those of whom the table says otherwise. Votes are added "
    "as log odds by `configs/default.yaml`, section `vision`. No real model was asked."
)
_QUESTIONS = ("type", "direction", "side")

_CHOICES = {"type": TYPES, "direction": tuple(Direction), "side": tuple(Side)}


@dataclass(frozen=True)
class Row:
    """One voter over all objects."""

    voter: str
    angle_deg: float
    """Mean over an object's joints, then over objects."""
    types: float


def main() -> None:
    """Infer every object once, then let voters of all kinds vote on it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path, help="folder of the benchmark")
    parser.add_argument("--output", type=Path, default=Path("results"))
    parser.add_argument("--most", type=int, help="so many objects")
    arguments = parser.parse_args()
    config = load_config()
    scores: dict[str, list[list[ObjectScore]]] = {}
    for item in find_objects(arguments.data)[: arguments.most]:
        erased = erase(read_robot(item.urdf, geometry="shown"), pose="rest", seed=CONDITIONS[0].seed, yaw_deg=0.0)
        inference = infer(Assembly(parts=erased.parts, source="benchmark"), config=config)
        _add(scores, "nobody", [_score(erased, inference)])
        for questions in (("type",), ("direction",), _QUESTIONS):
            for voter in _VOTERS:
                rng = np.random.default_rng([11, round(100 * voter[0]), len(questions)])
                draws = 1 if voter[0] == 1.0 else _DRAWS
                found = [_voted(erased, inference, questions, voter, rng) for _ in range(draws)]
                _add(scores, _name(questions, voter), found)
        print(item.name, flush=True)
    rows = [_row(voter, objects) for voter, objects in scores.items()]
    _write(rows, len(scores["nobody"]), arguments.output)


def _name(questions: tuple[str, ...], voter: tuple[float, float]) -> str:
    right, says = voter
    return f"{' and '.join(questions)}, {right:.0%} right{'' if says == right else f', says {says:.0%}'}"


def _add(scores: dict[str, list[list[ObjectScore]]], voter: str, found: list[ObjectScore]) -> None:
    scores.setdefault(voter, []).append(found)


def _voted(
    erased: ErasedModel,
    inference: Inference,
    questions: tuple[str, ...],
    voter: tuple[float, float],
    rng: np.random.Generator,
) -> ObjectScore:
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
    return _score(erased, chosen_anew(inference, votes)[0])


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


def _score(erased: ErasedModel, inference: Inference) -> ObjectScore:
    index = {name: k for k, name in enumerate(erased.truth.part_names)}
    return score_object(
        erased.truth,
        prediction_of(inference.trees[0], inference.joints, inference.assembly.names, index),
        centroids=[part.centroid for part in erased.parts],
        diagonal=erased.assembly.diagonal,
    )


def _row(voter: str, objects: list[list[ObjectScore]]) -> Row:
    angles = [np.mean([np.mean([j.angle_deg for j in score.joints]) for score in draws]) for draws in objects]
    types = [np.mean([np.mean([j.type_right for j in score.joints]) for score in draws]) for draws in objects]
    return Row(voter, float(np.mean(angles)), float(np.mean(types)))


def _write(rows: list[Row], objects: int, folder: Path) -> None:
    lines = [
        "# What votes of a vision model would be worth",
        "",
        _INTRODUCTION.format(objects=objects, draws=_DRAWS),
        "",
        "| voter | axis angle [deg] | types [%] |",
        "| --- | --- | --- |",
        *(f"| {row.voter} | {row.angle_deg:.2f} | {100.0 * row.types:.1f} |" for row in rows),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "voters.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    values = {"schema": 1, "objects": objects, "rows": [row.__dict__ for row in rows]}
    (folder / "voters.json").write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
