"""An object under every configuration of the paper, without MCTS or DW-CAVL, and with types that an oracle tells.

The paper asks a vision-language model for the type of each joint first, lets congruent parts vote, and falls back on
DW-CAVL. The oracle is such a model that is right in a stated share of its answers; it is asked about every joint of the
tree that was found, and abstains between parts that no true joint connects.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from statistics import fmean
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.paper import PAPER_VARIANTS
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.evaluation.benchmark_job import score_erased, shown_parts
from kinematify.evaluation.metrics import Prediction
from kinematify.evaluation.run_benchmark import changed
from kinematify.geometry.surface import part_surfaces
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.stages import find_trees
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from benchmarks.study import Record
    from kinematify.assembly.erasure import ErasedModel
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.evaluation.datasets import BenchObject
    from kinematify.evaluation.metrics import ObjectScore
    from kinematify.joints.candidate import JointEstimate
    from kinematify.paper.joints import PaperJoints

CONFIGURATIONS = ("paper", "paper-base", "paper-open", "default")
OWN = "own rule"
ORACLES: Mapping[str, float | None] = {OWN: None, "oracle 100 %": 1.0, "oracle 90 %": 0.9, "oracle 80 %": 0.8}
"""What tells the types -> in which share of its answers it is right."""
WITHOUT: Mapping[str, Mapping[str, object]] = {
    variant.label.removeprefix("paper").strip(): variant.changes for variant in PAPER_VARIANTS
}
"""What is omitted, nothing first -> changes of the configuration."""
_DRAWS = 5
"""An oracle that errs is drawn so often, and its figures averaged."""


def configured(erased: ErasedModel, item: BenchObject, *, sdf: str, seed: int) -> list[Record]:
    """Infer one object in every way and score each answer.

    Args:
        erased: The object in its pose.
        item: Where it is from; the paper's count leaves out the joints of its gripper.
        sdf: Kind of the signed distances.
        seed: Draws the errors of the oracles.
    """
    edges = _Edges(erased)
    records = []
    for name in CONFIGURATIONS:
        for without, changes in WITHOUT.items():
            if name == "default" and any(key.startswith("cavl.") for key in changes):
                continue  # it has no DW-CAVL to leave out
            graph, answer = edges.answer(changed(load_config(name), {**changes, "sdf.kind": sdf}))
            for oracle, right in ORACLES.items():
                answered = _answered(answer, graph, erased, right, [seed, *item.name.encode()])
                scores = [score_erased(erased, given, gripper_joints=item.gripper_joints) for given in answered]
                records.append({"rules": name, "without": without, "types_by": oracle, **_mean(scores)})
    return records


@dataclass(kw_only=True)
class _Known:
    """What configurations share."""

    graphs: dict[str, ContactGraph] = field(default_factory=dict)
    choosers: dict[str, PaperJoints] = field(default_factory=dict)
    joints: dict[tuple[str, Pair], JointEstimate] = field(default_factory=dict)


class _Edges:
    """Answers about one object; an edge that several trees have is optimised once."""

    def __init__(self, erased: ErasedModel) -> None:
        self._assembly = shown_parts(erased)
        self._root = erased.truth.parents.index(-1)
        self._known = _Known()

    def answer(self, config: Config) -> tuple[ContactGraph, Prediction]:
        """Contacts, and the tree and joints that a configuration finds."""
        if config.joints.method == "geometry":
            inference = infer(self._assembly, config=config)
            parents = dict(enumerate(inference.trees[0].parents))
            return inference.graph, Prediction(parents=parents, joints=inference.joints)
        contacts = config.contact.model_dump_json()
        if contacts not in self._known.graphs:
            surfaces = part_surfaces(self._assembly, config=config.surface)
            self._known.graphs[contacts] = build_contact_graph(
                self._assembly, surfaces, config=config.contact, seed=config.seed
            )
        graph = self._known.graphs[contacts]
        base = self._root if config.topology.base_rule == "given" else None
        tree = find_trees(self._assembly, graph, {}, config, base=base)[0]
        joints = tuple(self._joint(graph, edge, config) for edge in tree.edges())
        return graph, Prediction(parents=dict(enumerate(tree.parents)), joints=joints)

    def _joint(self, graph: ContactGraph, edge: Pair, config: Config) -> JointEstimate:
        # torch takes seconds to import, and trees do without it.
        from kinematify.paper.joints import PaperJoints  # noqa: PLC0415

        objective = config.contact.model_dump_json() + config.cavl.model_dump_json()
        if objective not in self._known.choosers:
            self._known.choosers[objective] = PaperJoints(self._assembly, graph, config)
        if (objective, edge) not in self._known.joints:
            (joint,) = self._known.choosers[objective].choose([edge])
            self._known.joints[objective, edge] = joint
        return self._known.joints[objective, edge]


def _answered(
    answer: Prediction, graph: ContactGraph, erased: ErasedModel, right: float | None, seeds: list[int]
) -> list[Prediction]:
    """An answer with the types that an oracle tells, once for each draw."""
    if right is None:
        return [answer]
    turns = {frozenset((joint.parent, joint.child)): joint.kind.turns for joint in erased.truth.joints}
    return [
        with_types(answer, turns, graph.clusters, right, np.random.default_rng([*seeds, draw]))
        for draw in range(1 if right == 1.0 else _DRAWS)
    ]


def with_types(
    answer: Prediction,
    turns: Mapping[frozenset[int], bool],
    clusters: Sequence[Sequence[int]],
    right: float,
    random: np.random.Generator,
) -> Prediction:
    """An answer with the joints that are best of the types that an oracle tells.

    Args:
        answer: With candidates of either type.
        turns: The two parts of each true joint -> whether it turns.
        clusters: Congruent parts vote: the type that most answers gave their joints holds for all, a tie for none.
        right: Share of the oracle's answers that are right.
        random: Draws which.
    """
    said: dict[int, bool] = {}
    for joint in answer.joints:
        true, errs = turns.get(frozenset((joint.parent, joint.child))), random.random() >= right
        if true is not None:
            said[joint.child] = true != errs
    for cluster in clusters:
        answered = [part for part in cluster if part in said]
        votes = Counter(said[part] for part in answered)
        if votes[True] != votes[False]:
            said |= dict.fromkeys(answered, votes[True] > votes[False])
    return replace(answer, joints=tuple(_best_of(joint, said.get(joint.child)) for joint in answer.joints))


def _best_of(joint: JointEstimate, turns: bool | None) -> JointEstimate:
    """The best candidate of a type; the joint as it is where it has that type, or no candidate has."""
    if turns is None or (joint.kind is not JointType.FIXED and joint.kind.turns == turns):
        return joint
    best = next((item for item in joint.alternatives if item.kind.turns == turns), None)
    return joint if best is None else replace(joint, kind=best.kind, axis=best.axis, pivot=best.pivot)


def _mean(scores: Sequence[ObjectScore]) -> Record:
    """Figures of one object over all draws."""
    joints = [joint for score in scores for joint in score.joints if not joint.gripper]
    matched = [joint for joint in joints if joint.matched]
    pivots = [joint.pivot_m for joint in joints if joint.pivot_m is not None]
    return {
        "joints": len(joints) // len(scores),
        "matched": len(matched) / max(len(joints), 1),
        "angle_deg": fmean(joint.angle_deg for joint in joints) if joints else None,
        "angle_matched_deg": fmean(joint.angle_deg for joint in matched) if matched else None,
        "pivot_m": fmean(pivots) if pivots else None,
        "types": fmean(joint.type_right for joint in joints) if joints else None,
        "ted": scores[0].ted_without_gripper.value,
    }
