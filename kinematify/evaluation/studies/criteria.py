"""Could simulation tell right joints from wrong ones better than it does: results/refine_criteria.{json,md}.

Every near-best candidate of every joint is given its range and simulated. Each thing that the simulation measures is
put beside the score of the inference in a conditional logit over the candidates of a joint; its weights come from
generated objects, and it is judged on everyday objects. A stopped run goes on where it was stopped.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import minimize

from kinematify.assembly.erase import erase
from kinematify.assembly.part import Assembly
from kinematify.config.validation import load_settings
from kinematify.evaluation.axis_metrics import axis_angle
from kinematify.evaluation.datasets import find_objects
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.truth import ground_truth
from kinematify.joints.candidate import JointType
from kinematify.paper.motion import prismatic_transform, revolute_transform
from kinematify.paper.sdf_grid import exact_distance
from kinematify.pipeline import infer
from kinematify.refinement.candidates import CandidateJoints, is_same
from kinematify.refinement.plan import Plan
from kinematify.refinement.simulate import Simulator
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from kinematify.assembly.part import Part
    from kinematify.assembly.truth import GroundTruth
    from kinematify.contact.graph import ContactGraph
    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline import Inference
    from kinematify.robot.arrays import FloatArray

    Candidate = Mapping[str, Any]
    """score, kind, right, chosen; free: shares of the part's length or of half a turn to both sides; kept: share of
    the contact that stays one after 10, 50 and 100 % of the way; normal: share of its speed into the surface."""

MARGIN, MOST = 3.0, 8
RIGHT_DEG = 10.0
SHARES = (0.1, 0.5, 1.0)
_SAMPLES = 200
_TOUCH = 0.01  # fraction of the part's diagonal
_RIDGE = 0.05  # keeps weights finite where generated objects hold no error
_LINKAGES = ("hand", "humanoid", "hexapod", "quadruped", "snake", "serial_arm", "scara", "gantry")
CRITERIA = {
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


def main() -> None:
    """Simulate what is missing, then fit and judge."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path, help="folder of everyday objects, to judge on")
    parser.add_argument("--seeds", type=int, default=2, help="generated objects per family, to fit on")
    parser.add_argument("--work", type=Path, default=Path(tempfile.gettempdir()) / "kinematify-criteria")
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    fitted = _simulated(_generated(arguments.seeds), arguments.work / "generated.jsonl")
    judged = _simulated(_everyday(arguments.data), arguments.work / "everyday.jsonl")
    _write(fitted, judged, arguments)


# ---- candidates ----------------------------------------------------------------------------------------------------


def _generated(seeds: int) -> Iterator[tuple[str, Any]]:
    """Names with what makes parts and truth; robots and hands are left out, for nothing near-best competes there."""
    for seed in range(seeds):
        for family in FAMILIES:
            if family not in _LINKAGES:
                yield f"{family}_{seed}", (family, seed)


def _everyday(data: Path) -> Iterator[tuple[str, Any]]:
    yield from ((item.name, item.urdf) for item in find_objects(data))


def _made(source: Any) -> tuple[tuple[Part, ...], GroundTruth]:
    if isinstance(source, tuple):
        blueprint = build(FAMILIES[source[0]], {}, seed=source[1])
        return blueprint.parts, ground_truth(blueprint)
    erased = erase(read_robot(source, geometry="shown"), pose="rest", seed=0, yaw_deg=0.0)
    return erased.parts, erased.truth


def _simulated(objects: Iterator[tuple[str, Any]], ledger: Path) -> list[dict[str, Any]]:
    """The joints of all objects with their simulated candidates, from the file as far as it goes."""
    wanted = dict(objects)
    found = [json.loads(line) for line in ledger.read_text().splitlines()] if ledger.is_file() else []
    done = {item["object"] for item in found}
    with ledger.open("a", encoding="utf-8") as file:
        for name, source in wanted.items():
            if name in done:
                continue
            parts, truth = _made(source)
            inference = infer(Assembly(parts=parts, source="benchmark"))
            joints = [{"object": name, **joint} for joint in _joints(inference, truth)]
            found += joints
            file.writelines(json.dumps(joint) + "\n" for joint in joints)
            file.flush()
            print(name, len(joints), flush=True)
    return [item for item in found if item["object"] in wanted]


def _joints(inference: Inference, truth: GroundTruth) -> Iterator[dict[str, Any]]:
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


def _measured(plan: Plan, simulator: Simulator, graph: ContactGraph, joint: JointEstimate) -> dict[str, Any]:
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
    T = (
        revolute_transform(joint.axis, joint.pivot, value)
        if joint.kind.turns
        else prismatic_transform(joint.axis, value)
    )
    return points @ T[:3, :3].T + T[:3, 3]


# ---- the fit -------------------------------------------------------------------------------------------------------


def _choices(joints: Sequence[Mapping[str, Any]], criterion: Any) -> list[tuple[FloatArray, FloatArray]]:
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


def _write(fitted: list[dict[str, Any]], judged: list[dict[str, Any]], arguments: argparse.Namespace) -> None:
    rows = []
    for name, criterion in {"score alone": lambda c: 0.0, **CRITERIA}.items():
        ours, theirs = _choices(fitted, criterion), _choices(judged, criterion)
        weights, own = _fit(ours), _fit(theirs)
        rows.append({
            "criterion": name, "weight": float(weights[1]), "fitted": _share_right(weights, ours),
            "judged": _share_right(weights, theirs), "loss": _loss(weights, theirs), "loss_own": _loss(own, theirs),
        })  # fmt: skip
    command = f"python benchmarks/criteria.py {arguments.data.as_posix()} --seeds {arguments.seeds}"
    counts = {name: _counts(joints) for name, joints in (("generated", fitted), ("everyday", judged))}
    record = {"schema": 1, "command": command, "joints": counts, "rows": rows}
    (arguments.output / "refine_criteria.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    text = [
        "# What simulation could tell of joints", "", f"`{command}`", "",
        "Every near-best candidate (3 log odds, 8 at most) of every joint between the right parts, simulated by exact",
        "geometry. Right: the type, and an axis within 10 deg. Each criterion stands beside the score of the inference",
        "in a conditional logit over the candidates of a joint, with weights from generated objects. Loss: negative",
        "log likelihood on everyday objects, with those weights, and with the best that everyday objects themselves",
        "would give, which is a bound and no method. Offered: wrong joints with a right candidate among the near-best.",
        "Faults: wrong and right joints whose motion the simulation finds fault with.", "",
        "| | objects | joints | chosen right | offered | faults: wrong / right |",
        "| --- | --- | --- | --- | --- | --- |",
        *(f"| {name} | {c['objects']} | {c['joints']} | {c['right']} | {c['offered']} | {c['doubted']} |"
          for name, c in counts.items()), "",
        "| criterion | weight | generated right [%] | everyday right [%] | loss | loss with weights of its own |",
        "| --- | --- | --- | --- | --- | --- |",
        *(f"| {r['criterion']} | {r['weight']:+.2f} | {100 * r['fitted']:.1f} | {100 * r['judged']:.1f} | "
          f"{r['loss']:.1f} | {r['loss_own']:.1f} |" for r in rows),
    ]  # fmt: skip
    (arguments.output / "refine_criteria.md").write_text("\n".join(text) + "\n", encoding="utf-8")
    print("\n".join(text))


def _counts(joints: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    chosen = [next((c for c in joint["candidates"] if c["chosen"]), None) for joint in joints]
    wrong = [k for k, c in enumerate(chosen) if c is None or not c["right"]]
    faulty = [c for c in chosen if c is not None and c["checks"]]
    offered = sum(any(c["right"] for c in joints[k]["candidates"]) for k in wrong)
    return {
        "objects": len({joint["object"] for joint in joints}), "joints": len(joints),
        "right": len(joints) - len(wrong), "offered": f"{offered} of {len(wrong)}",
        "doubted": f"{sum(not c['right'] for c in faulty)} / {sum(c['right'] for c in faulty)}",
    }  # fmt: skip


if __name__ == "__main__":
    main()
