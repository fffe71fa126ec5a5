"""Could simulation tell right joints from wrong ones better than it does?

Every near-best candidate (3 log odds, 8 at most) of every joint between the right parts, simulated by exact geometry.
Right: the type, and an axis within 10 deg. Each criterion stands beside the score of the inference in a conditional
logit over the candidates of a joint, with weights from generated objects. Loss: negative log likelihood on everyday
objects, with those weights, and with the best that everyday objects themselves would give, which is a bound and no
method. Offered: wrong joints with a right candidate among the near-best. Faults: wrong and right joints whose motion
the simulation finds fault with.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field
from scipy.optimize import minimize

from benchmarks.study import Options, Study, explained
from kinematify.assembly.part import Assembly
from kinematify.config.validation import load_settings
from kinematify.evaluation.axis_metrics import axis_angle
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, find_objects
from kinematify.evaluation.job import erased_item
from kinematify.evaluation.record import table
from kinematify.generate.procedural.blueprint import ground_truth
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.paper.sdf_grid import exact_distance
from kinematify.pipeline import infer
from kinematify.refinement.candidates import CandidateJoints, is_same
from kinematify.refinement.plan import Plan
from kinematify.refinement.simulate import Simulator
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import joint_motion

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.assembly.truth import GroundTruth
    from kinematify.contact.graph import ContactGraph
    from kinematify.evaluation.record import Report
    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline import Inference
    from kinematify.robot.arrays import FloatArray

MARGIN, MOST = 3.0, 8
RIGHT_DEG = 10.0
SHARES = (0.1, 0.5, 1.0)
_SAMPLES = 200
_TOUCH = 0.01  # fraction of the part's diagonal
_RIDGE = 0.05  # keeps weights finite where generated objects hold no error
_LINKAGES = ("hand", "humanoid", "hexapod", "quadruped", "snake", "serial_arm", "scara", "gantry")
CRITERIA: dict[str, Callable[[Record], float]] = {
    "way that is free to the freer side": lambda c: min(max(-c["free"][0], c["free"][1]), 1.0),
    "a stop at once to one side, as what is closed has": lambda c: float(min(-c["free"][0], c["free"][1]) < 0.03),
    "contact kept after a tenth of the way": lambda c: c["kept"][0],
    "contact kept after half of it": lambda c: c["kept"][1],
    "contact kept at its end": lambda c: c["kept"][2],
    "motion of the contact into its surface": lambda c: c["normal"],
    "any finding about the motion": lambda c: float(bool(c["checks"])),
    "contact with the parent lost (KV320)": lambda c: float("KV320" in c["checks"]),
    "other parts hit (KV311)": lambda c: float("KV311" in c["checks"]),
}  # fmt: skip
"""Of a candidate: score, kind, right, chosen; free: shares of the part's length or of half a turn to both sides; kept:
share of the contact that stays one after 10, 50 and 100 % of the way; normal: share of its speed into the surface."""


class CriteriaOptions(Options):
    """What is fitted and judged on."""

    data: str = Field("everyday", description="Folder or set of objects to judge on.")
    seeds: int = Field(2, ge=1, description="Generated objects per family, to fit on.")


@dataclass(frozen=True, kw_only=True)
class Source:
    """Where an object comes from: a family with a seed, or a file."""

    family: str = ""
    seed: int = 0
    item: BenchObject | None = None


def measure(options: CriteriaOptions, work: Work) -> Measured:
    """Simulate the candidates of generated and of everyday objects, then fit on the former and judge on the latter."""
    # Robots and hands are left out, for nothing near-best competes there.
    generated = {
        f"{family}_{seed}": Source(family=family, seed=seed)
        for seed in range(options.seeds)
        for family in FAMILIES
        if family not in _LINKAGES
    }
    everyday = {item.name: Source(item=item) for item in find_objects(options.data)}
    sets = {"generated": generated, "everyday": everyday}
    joints = {
        name: [
            {"object": item, **joint}
            for item, record in work.each(simulated, given).items()
            for joint in record["joints"]
        ]
        for name, given in sets.items()
    }
    rows = []
    for name, criterion in {"score alone": lambda candidate: 0.0, **CRITERIA}.items():
        ours, theirs = (_choices(joints[of], criterion) for of in ("generated", "everyday"))
        weights, own = _fit(ours), _fit(theirs)
        rows.append({
            "criterion": name, "weight": float(weights[1]), "fitted": _share_right(weights, ours),
            "judged": _share_right(weights, theirs), "loss": _loss(weights, theirs), "loss_own": _loss(own, theirs),
        })  # fmt: skip
    return rows, {"joints": {name: _counts(found) for name, found in joints.items()}}


def simulated(source: Source) -> Record:
    """Every joint of an object between the right parts, with its near-best candidates."""
    if source.item is None:
        blueprint = build(FAMILIES[source.family], {}, seed=source.seed)
        parts, truth = blueprint.parts, ground_truth(blueprint)
    else:
        erased = erased_item(source.item, CONDITIONS[0])
        parts, truth = erased.parts, erased.truth
    return {"joints": list(_joints(infer(Assembly(parts=parts, source="benchmark")), truth))}


def _joints(inference: Inference, truth: GroundTruth) -> Iterator[Record]:
    """Every joint between the right parts, with its near-best candidates."""
    names, index = inference.assembly.names, {name: k for k, name in enumerate(truth.part_names)}
    true = {(joint.parent, joint.child): joint for joint in truth.joints}
    plan = Plan(
        assembly=inference.assembly, config=inference.config, tree=inference.trees[0], joints=inference.joints
    )  # fmt: skip
    simulator = Simulator(plan.model, load_settings().geometry)
    maker = CandidateJoints(inference.assembly, inference.graph, inference.bearings, inference.config)
    for joint in inference.joints:
        wanted = true.get((index[names[joint.parent]], index[names[joint.child]]))
        if wanted is None or joint.kind is JointType.FIXED or not joint.alternatives:
            continue
        best = max(candidate.score for candidate in joint.alternatives)
        near = sorted(joint.alternatives, key=lambda c: (not is_same(joint, c), -c.score))
        near = [c for c in near if c.score > best - MARGIN or is_same(joint, c)][:MOST]
        yield {"child": names[joint.child], "candidates": [
            {"score": c.score - best, "kind": c.kind.value, "chosen": is_same(joint, c),
             "right": c.kind.turns == wanted.kind.turns and axis_angle(c.axis, wanted.axis) < RIGHT_DEG,
             **_measured(plan, simulator, inference.graph, maker.realise(plan.tree, joint, c))}
            for c in near
        ]}  # fmt: skip


def _measured(plan: Plan, simulator: Simulator, graph: ContactGraph, joint: JointEstimate) -> Record:
    """What moving one joint shows."""
    tried = plan.with_joint(joint)
    part, parent = plan.assembly.parts[joint.child], plan.assembly.parts[joint.parent]
    verdict = simulator.judge_joint(tried.model, tried.joint_of[part.name])
    unit = np.pi if joint.kind.turns else float(np.ptp(part.vertices @ joint.axis))
    low, high = next((s.free_travel for s in verdict.joints if s.free_travel is not None), (0.0, 0.0))
    measured = {"free": [low / unit, high / unit], "checks": [finding.check for finding in verdict.findings],
                "kept": [0.5] * len(SHARES), "normal": 0.5}  # fmt: skip
    edge = graph.by_pair.get((min(joint.parent, joint.child), max(joint.parent, joint.child)))
    samples = None if edge is None else edge.samples_b if edge.b == joint.child else edge.samples_a
    if samples is None or not len(samples.points):
        return measured
    few = np.linspace(0, len(samples.points) - 1, min(_SAMPLES, len(samples.points))).astype(int)
    points, normals, areas = samples.points[few], samples.normals[few], samples.areas[few]
    weights = areas / areas.sum()
    near = exact_distance(parent, points) + _TOUCH * part.diagonal
    end = min(joint.upper, np.pi / 2) if joint.kind.turns else joint.upper
    measured["kept"] = [
        float((weights * (exact_distance(parent, _moved(joint, share * end, points)) < near)).sum()) for share in SHARES
    ]
    speed = (_moved(joint, 1e-4, points) - points) / 1e-4
    into = float((weights * np.abs((speed * normals).sum(axis=1))).sum())
    measured["normal"] = into / max(float((weights * np.linalg.norm(speed, axis=1)).sum()), 1e-12)
    return measured


def _moved(joint: JointEstimate, value: float, points: FloatArray) -> FloatArray:
    T = joint_motion(joint.kind, joint.axis, joint.pivot, value)
    return points @ T[:3, :3].T + T[:3, 3]


def _choices(joints: Sequence[Record], criterion: Callable[[Record], float]) -> list[tuple[FloatArray, FloatArray]]:
    """Per joint with something to choose, rows of (score, criterion) and which candidates are right."""
    found = []
    for joint in joints:
        right = np.array([c["right"] for c in joint["candidates"]])
        if right.any() and not right.all():
            found.append((np.array([[c["score"], criterion(c)] for c in joint["candidates"]]), right))
    return found


def _loss(weights: FloatArray, choices: Sequence[tuple[FloatArray, FloatArray]]) -> float:
    """Negative log likelihood of the right candidates."""
    total = 0.0
    for rows, right in choices:
        odds = rows @ weights
        odds -= odds.max()
        total -= float(np.log(np.exp(odds[right]).sum() / np.exp(odds).sum()))
    return total


def _fit(choices: Sequence[tuple[FloatArray, FloatArray]]) -> FloatArray:
    found = minimize(lambda w: _loss(w, choices) + _RIDGE * float(w @ w), np.zeros(2), method="BFGS")
    return np.asarray(found.x)


def _share_right(weights: FloatArray, choices: Sequence[tuple[FloatArray, FloatArray]]) -> float:
    return float(np.mean([right[np.argmax(rows @ weights)] for rows, right in choices]))


def report(found: Report[Record]) -> list[str]:
    """What there was to choose, and what each criterion adds."""
    counts = [
        (name, *(str(c[key]) for key in ("objects", "joints", "right", "offered", "doubted")))
        for name, c in found.summary["joints"].items()
    ]
    rows = [
        (
            r["criterion"], f"{r['weight']:+.2f}", f"{100 * r['fitted']:.1f}", f"{100 * r['judged']:.1f}",
            f"{r['loss']:.1f}", f"{r['loss_own']:.1f}",
        )
        for r in found.records
    ]  # fmt: skip
    titles = (
        "criterion",
        "weight",
        "generated right [%]",
        "everyday right [%]",
        "loss",
        "loss with weights of its own",
    )
    return [
        explained(__doc__),
        table(("", "objects", "joints", "chosen right", "offered", "faults: wrong / right"), counts),
        table(titles, rows),
    ]


def _counts(joints: Sequence[Record]) -> Record:
    chosen = [next((c for c in joint["candidates"] if c["chosen"]), None) for joint in joints]
    wrong = [k for k, c in enumerate(chosen) if c is None or not c["right"]]
    faulty = [c for c in chosen if c is not None and c["checks"]]
    offered = sum(any(c["right"] for c in joints[k]["candidates"]) for k in wrong)
    return {
        "objects": len({joint["object"] for joint in joints}), "joints": len(joints),
        "right": len(joints) - len(wrong), "offered": f"{offered} of {len(wrong)}",
        "doubted": f"{sum(not c['right'] for c in faulty)} / {sum(c['right'] for c in faulty)}",
    }  # fmt: skip


STUDY = Study(title="What simulation could tell of joints", options=CriteriaOptions, measure=measure, report=report)
