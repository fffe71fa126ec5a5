"""Which wrong joints does `kinematify refine` find and repair, and what does it spoil?

Wrong joints are planted in true mechanisms, one at a time: an axis turned by 90 deg, a pivot moved by a fifth of the
part, the other type, the other sign, another parent that the part touches, and *second best*, the hypothesis that the
fitted choice puts next, written in place of a right one with the log odds of it. Contacts are as measured; the
candidates are those of inference, the right one among them. The other wrong joints have the log odds that the fitted
choice gives them beside the candidates, with --level those of the best candidate, so that only simulation tells them
apart. *Found*: a failure points to the joint, in whichever round. *Repaired*: parent, type, axis within 10 deg, line
within a tenth of the part, and the opening side are right afterwards; of *parent*, the parent, on which the joint is
inferred again. *Harm*: joints that were right and no longer are, or whose range overlaps the true one by .1 less. The
rows *nothing* are the true mechanisms as they are.

--inferred OBJECTS asks what simulation can do about the joints that inference gets wrong, with the true tree given. The
rows *as inferred* refine what inference chooses there, with nothing planted; the rows *nothing* are of these objects
too. Then right near-best hypotheses are simulated beside every joint that was chosen wrong. *In the pool*: there is
one. *Preferred*: simulation has more against the joint that was chosen than against a right one. No loop that chooses
by simulation repairs more.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from operator import itemgetter
from statistics import median
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from benchmarks.planted import FAULTS, NOTHING, PARENT, PlantedJoint, planted_faults, true_mechanism
from benchmarks.study import Options, Study, among, explained
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.evaluation.benchmark_job import erased_item
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, find_objects, matching
from kinematify.evaluation.result_record import grouped, table
from kinematify.refinement.candidates import CandidateJoints, is_same
from kinematify.refinement.choose import MARGIN, Chooser
from kinematify.refinement.joint_plan import Plan
from kinematify.refinement.loop import refine
from kinematify.refinement.simulate import Simulator

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.planted import TrueMechanism
    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report

SAMPLE = (
    "bottle_3763", "box_100141", "cabinet_40147", "dishwasher_11700", "door_9128", "drawer_cabinet_20279",
    "faucet_1466", "fridge_11178", "laptop_10040", "oven_7138", "trash_can_102181", "window_102906",
)  # fmt: skip
"""Everyday objects that are measured where none are named; none of them is in the fit of the choice of joints."""
_IOU_LOST = 0.1
AS_INFERRED, INFERRED = "as inferred", "inferred"


class RefineOptions(Options):
    """Which objects, which faults."""

    data: str = Field("everyday", description="Folder or set of objects.")
    objects: tuple[str, ...] = Field(SAMPLE, description="Names or patterns of objects; * for all.")
    faults: Annotated[tuple[str, ...], among(FAULTS)] = Field(FAULTS, description="Some of the faults.")
    level: bool = Field(default=False, description="Planted joints score as the best candidate does.")
    inferred: tuple[str, ...] = Field((), description="Objects refined as they are inferred as well; * for all.")
    seed: int = Field(0, description="Draws the joints.")
    config: str = Field("default", description="Configuration of the inference.")


@dataclass(frozen=True, kw_only=True)
class Planting:
    """One object with its faults."""

    item: BenchObject
    faults: tuple[str, ...]
    level: bool
    seed: int
    config: str


def measure(options: RefineOptions, work: Work) -> Measured:
    """Plant the faults of every object and refine each."""
    every = find_objects(options.data)
    planted = {item.name for item in matching(every, options.objects)}
    inferred = {item.name for item in matching(every, options.inferred)} if options.inferred else set()
    asked = {
        item.name: Planting(
            item=item,
            faults=options.faults if item.name in planted else (),
            level=options.level,
            seed=options.seed,
            config=options.config,
        )
        for item in every
        if item.name in planted | inferred
    }
    found = list(work.each(refined_faults, asked, timeout=7200.0).values())
    judged = {name: planting for name, planting in asked.items() if planting.item.name in inferred}
    found += work.each(judged_inferences, judged, timeout=7200.0).values()
    return [record for object_record in found for record in object_record["faults"]], {}


def refined_faults(asked: Planting) -> Record:
    """Refine one object as it is, and with each fault."""
    mechanism = true_mechanism(erased_item(asked.item, CONDITIONS[0]), load_config(asked.config))
    if mechanism is None:
        return {"faults": []}
    untouched = PlantedJoint(fault=NOTHING, part="", inference=mechanism.inference)
    planted = (untouched, *planted_faults(mechanism, asked.seed, asked.faults, level=asked.level))
    return {"faults": [_refined(mechanism, fault, asked) for fault in planted]}


def judged_inferences(asked: Planting) -> Record:
    """Refine what inference chooses on the true tree of one object, and judge its mistakes by simulation."""
    mechanism = true_mechanism(erased_item(asked.item, CONDITIONS[0]), load_config(asked.config))
    if mechanism is None:
        return {"faults": []}
    whole = PlantedJoint(fault=AS_INFERRED, part="", inference=replace(mechanism.inference, joints=mechanism.chosen))
    judged = [{"object": asked.item.name, "fault": INFERRED, **row} for row in mistakes(mechanism)]
    return {"faults": [_refined(mechanism, whole, asked), *judged]}


def mistakes(mechanism: TrueMechanism) -> list[Record]:
    """Simulate the right near-best hypotheses of every joint that was chosen wrong, beside the chosen one."""
    answer = replace(mechanism.inference, joints=mechanism.chosen)
    plan, wrong = Plan(inference=answer), mechanism.wrong(answer)
    chooser = Chooser(
        plan=plan,
        candidates=CandidateJoints(answer.assembly, answer.graph, answer.bearings, answer.config),
        simulator=Simulator(plan.model, load_settings().geometry),
    )
    records = []
    for joint in answer.joints:
        name = answer.assembly.names[joint.child]
        if name not in wrong:
            continue
        best = joint.alternatives[0].score
        near = [item for item in joint.alternatives if item.score >= best - MARGIN]
        others = [chooser.candidates.realise(answer.trees[0], joint, item) for item in near if not is_same(joint, item)]
        right = [other for other in others if name not in mechanism.wrong(plan.with_joint(other).inference)]
        tried = [chooser.trial(other, 0.0).against for other in (joint, *right)]
        records.append({
            "part": name,
            "hypotheses": len(near),
            "in_pool": bool(right),
            "against": tried[0],
            "preferred": bool(right) and min(tried[1:]) < tried[0],
        })  # fmt: skip
    return records


def _refined(mechanism: TrueMechanism, planted: PlantedJoint, asked: Planting) -> Record:
    start = time.perf_counter()
    refinement = refine(planted.inference)
    seconds = time.perf_counter() - start
    history, answer = refinement.history, refinement.inference
    before, after = mechanism.scores(planted.inference), mechanism.scores(answer)
    wrong, left = mechanism.wrong(planted.inference), mechanism.wrong(answer)
    shorter = {part for part in before if after[part].limit_iou < before[part].limit_iou - _IOU_LOST}
    phrases = [phrase for item in history.rounds for phrase in item.suspected]
    suspected = {part for part in wrong if any(item.startswith(f"{part}: ") for item in phrases)}
    cured = {part for part in wrong if after[part].matched} if planted.fault == PARENT else wrong - left
    return {
        "object": asked.item.name,
        "fault": planted.fault,
        "part": planted.part,
        "failed": list(dict.fromkeys(failed for item in history.rounds for failed in item.failed)),
        "wrong": len(wrong),
        "found": len(suspected),
        "repaired": len(cured),
        "joints": len(before),
        "harmed": sorted((left | shorter) - wrong),
        "changes": [f"{item.part}: {item.what} {item.before} -> {item.after}" for item in history.changed],
        "seconds": round(seconds, 2),
        "inference_seconds": round(sum(mechanism.inference.timings.values()), 2),
    }


def report(found: Report[Record]) -> list[str]:
    """What was found, repaired and spoilt, by fault, and the faults that were not repaired."""
    blocks = [explained(__doc__)]
    inferred = [record for record in found.records if record["fault"] == INFERRED]
    if inferred:
        counts = (
            sum(row["in_pool"] for row in inferred),
            sum(row["against"] > 0.0 for row in inferred),
            sum(row["preferred"] for row in inferred),
        )
        heads = ("wrong joints", "in the pool", "found", "preferred")
        row = (str(len(inferred)), *(_part_of(count, len(inferred)) for count in counts))
        lines = [
            f"- {row['object']}, {row['part']}: {row['hypotheses']} near-best hypotheses, "
            f"{'one' if row['in_pool'] else 'none'} right; {row['against']:.1f} against the chosen one"
            for row in inferred
        ]
        blocks += ["## What simulation shows of joints inferred wrong", table(heads, [row]), "\n".join(lines)]
    planted = [record for record in found.records if record["fault"] != INFERRED]
    titles = ("planted", "faults", "found", "repaired", "harm", "time")
    by_fault = grouped(planted, by=itemgetter("fault"))
    rows = [_row(fault, by_fault[fault]) for fault in (*FAULTS, NOTHING, AS_INFERRED) if fault in by_fault]
    usual = [record for record in planted if record["fault"] in FAULTS[:-1]]
    rows += [_row("**all but second best**", usual)] if usual else []
    blocks += ["## Planted and as inferred", table(titles, rows), "### Not repaired", _misses(planted)]
    return [*blocks, "Time: of the refinement over that of the inference, median."]


def _row(title: str, records: Sequence[Record]) -> tuple[str, ...]:
    wrong, joints = (sum(record[what] for record in records) for what in ("wrong", "joints"))
    harmed = sum(len(record["harmed"]) for record in records)
    return (
        title,
        str(wrong) if wrong else "-",
        *(_part_of(sum(record[what] for record in records), wrong) for what in ("found", "repaired")),
        f"{harmed} of {joints - wrong}",
        f"{median(record['seconds'] / max(record['inference_seconds'], 0.01) for record in records):.2f}",
    )


def _part_of(some: int, of: int) -> str:
    return f"{some} ({some / of:.0%})" if of else "-"


def _misses(records: Sequence[Record]) -> str:
    lines = [
        f"- {record['object']}, {record['part'] or 'as it is'}: {record['fault']}; failed: "
        f"{', '.join(record['failed']) or 'nothing'}; changed: {'; '.join(record['changes']) or 'nothing'}"
        + (f"; harm: {', '.join(record['harmed'])}" if record["harmed"] else "")
        for record in records
        if record["repaired"] < record["wrong"] or record["harmed"]
    ]
    return "\n".join(lines) or "None."


STUDY = Study(title="Planted wrong joints and refinement", options=RefineOptions, measure=measure, report=report)
