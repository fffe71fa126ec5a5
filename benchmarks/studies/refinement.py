"""What is refinement worth: what does simulating and choosing again mend, what does it cost, where does it do harm?

Every object is inferred once, and each tier refines that answer. Means are over the joints of an object, then over
objects; a joint whose parent and child are not joined in the answer counts 90 deg. Wrong joints: another type, or an
axis off by more than 10 deg. Passes: no error about motion by the exact geometry. Times: of the inference and the
refinement together, over that of the inference alone, median.

Perturbations: the tolerance of contact halved and doubled; vertices moved by up to 2 % of the smallest side of their
part's box; 2 contacts left out; 3 contacts made up between parts that do not touch; one part cut in two along its mesh;
gaps of 1 % of the diagonal between all parts.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from operator import itemgetter
from statistics import fmean, median
from typing import TYPE_CHECKING, Annotated

from pydantic import Field, TypeAdapter

from benchmarks.study import Options, Study, among, explained
from kinematify.config import load_config
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, find_objects, matching
from kinematify.evaluation.job import erased_item, predicted, score_erased, shown_parts
from kinematify.evaluation.metrics import ObjectScore
from kinematify.evaluation.perturb import CLEAN, PERTURBATIONS, perturbed
from kinematify.evaluation.record import grouped, table
from kinematify.pipeline import infer
from kinematify.refinement import refine
from kinematify.refinement.tiers import TIERS

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.metrics import JointScore
    from kinematify.evaluation.record import Report
    from kinematify.pipeline import Inference

OFF = "no feedback"
WRONG_DEG = 10.0
"""A joint is wrong if its type is, or if its axis is off by more [deg]."""
_GIVEN = "given"


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """One table of the study."""

    title: str
    data: str
    objects: tuple[str, ...] = ("*",)
    tiers: tuple[str, ...] = ("geometry",)
    perturbations: tuple[str, ...] = (CLEAN,)


PARTS = {
    "everyday": Comparison(title="Everyday objects, clean input", data="everyday"),
    "tiers": Comparison(
        title="The dear tiers, some everyday objects, clean input",
        data="everyday",
        objects=(
            "trash_can_102181", "window_102906", "fridge_11178", "bottle_3763", "trash_can_102155", "cabinet_40147",
        ),
        tiers=("geometry", "engines", "task"),
    ),
    "robots": Comparison(title="Robots, clean input", data="robots", objects=("allegro", "fetch", "go2")),
    "perturbed": Comparison(
        title="Everyday objects, perturbed input",
        data="everyday",
        objects=(
            "bag_101673", "bottle_3763", "box_100141", "bucket_100438", "cabinet_40147", "coffee_machine_102145",
            "dishwasher_11700", "door_9128", "drawer_cabinet_20279", "faucet_1466", "fridge_11178",
            "kitchen_pot_100040", "laptop_10040", "microwave_7128", "oven_7138", "safe_101619", "stapler_102990",
            "suitcase_101668", "switch_100976", "toaster_103473", "toilet_102703", "trash_can_102155",
            "washing_machine_103480", "window_102906",
        ),
        perturbations=PERTURBATIONS,
    ),
}  # fmt: skip


class RefinementOptions(Options):
    """Which objects, how perturbed, refined how far; without DATA the parts of the project's own table."""

    parts: Annotated[tuple[str, ...], among(PARTS)] = Field(
        tuple(PARTS), description="Some of everyday, tiers, robots, perturbed."
    )
    data: str | None = Field(None, description="Folder or set of objects to measure instead of the parts.")
    objects: tuple[str, ...] = Field(("*",), description="With --data: names or patterns of objects.")
    tiers: Annotated[tuple[str, ...], among(TIERS)] = Field(
        ("geometry",), description="With --data: some of geometry, engines, task."
    )
    perturb: Annotated[tuple[str, ...], among(PERTURBATIONS)] = Field(
        (), description=f"With --data: input that is a little wrong too; some of {', '.join(PERTURBATIONS)}."
    )
    config: str = Field("default", description="Configuration of the inference.")


@dataclass(frozen=True, kw_only=True)
class Refining:
    """One object, perturbed or not, refined by some tiers."""

    item: BenchObject
    perturbation: str
    tiers: tuple[str, ...]
    config: str


@dataclass(frozen=True, kw_only=True)
class TierResult:
    """The answer of one tier."""

    tier: str
    """`OFF`, or one of `kinematify.refinement.tiers.TIERS`."""
    score: ObjectScore
    seconds: float
    """Of the inference and the refinement together [s]."""
    errors: int
    """Errors about motion in the model, by the exact geometry."""
    changes: tuple[str, ...]
    """What was chosen anew in the round that was kept."""


@dataclass(frozen=True, kw_only=True)
class RefiningResult:
    """What came of one object."""

    object: str
    kind: str
    perturbation: str
    tiers: tuple[TierResult, ...]
    part: str = _GIVEN
    """Of `PARTS`."""


_RESULT = TypeAdapter(RefiningResult)


def measure(options: RefinementOptions, work: Work) -> Measured:
    """Infer and refine every object."""
    parts = {name: PARTS[name] for name in options.parts}
    if options.data is not None:
        given = Comparison(
            title="Objects as given",
            data=options.data,
            objects=options.objects,
            tiers=options.tiers,
            perturbations=(CLEAN, *options.perturb),
        )
        parts = {_GIVEN: given}
    asked = {
        (name, f"{item.name}, {perturbation}"): Refining(
            item=item, perturbation=perturbation, tiers=part.tiers, config=options.config
        )
        for name, part in parts.items()
        for perturbation in part.perturbations
        for item in matching(find_objects(part.data), part.objects)
    }
    named = {f"{place}, {' and '.join(task.tiers)}": task for (_, place), task in asked.items()}
    found = work.each(refined, named, timeout=7200.0)
    records = []
    for (name, place), task in asked.items():
        record = found.get(f"{place}, {' and '.join(task.tiers)}")
        if record is not None:
            records.append({**record, "part": name})
    return records, {"titles": {name: part.title for name, part in parts.items()}}


def refined(asked: Refining) -> Record:
    """Infer one object, then let every tier refine the answer."""
    erased = erased_item(asked.item, CONDITIONS[0])
    given = perturbed(asked.perturbation, shown_parts(erased), load_config(asked.config), seed=CONDITIONS[0].seed)
    start = time.perf_counter()
    inference = infer(given.assembly, config=given.config, graph=given.graph)
    seconds = time.perf_counter() - start

    def score(answer: Inference) -> ObjectScore:
        prediction, _ = predicted(erased, given, answer)
        return score_erased(erased, prediction, gripper_joints=asked.item.gripper_joints)

    tiers: list[TierResult] = []
    for tier in asked.tiers:
        start = time.perf_counter()
        refinement = refine(inference, tier=tier)
        spent = time.perf_counter() - start
        history = refinement.history
        if not tiers:
            errors = history.rounds[0].motion_errors
            tiers.append(TierResult(tier=OFF, score=score(inference), seconds=seconds, errors=errors, changes=()))
        changes = tuple(f"{item.part}: {item.what} {item.before} -> {item.after}" for item in history.changed)
        tiers.append(
            TierResult(
                tier=tier,
                score=score(refinement.inference),
                seconds=seconds + spent,
                errors=history.rounds[history.kept].motion_errors,
                changes=changes,
            )
        )
    result = RefiningResult(
        object=asked.item.name, kind=asked.item.kind, perturbation=asked.perturbation, tiers=tuple(tiers)
    )
    record: Record = _RESULT.dump_python(result, mode="json")
    return record


def results_of(records: Iterable[Record]) -> list[RefiningResult]:
    """Return records as they were before they were written."""
    return [_RESULT.validate_python(record) for record in records]


def harmed(results: Iterable[RefiningResult]) -> list[tuple[str, ...]]:
    """Object, perturbation, tier, what became worse and what was chosen anew, for every answer that became worse."""
    rows: list[tuple[str, ...]] = []
    for result in results:
        for tier in result.tiers[1:]:
            worse = _worse(result.tiers[0], tier)
            if worse:
                rows.append((result.object, result.perturbation, tier.tier, "; ".join(worse), "; ".join(tier.changes)))
    return list(dict.fromkeys(rows))


def _worse(off: TierResult, tier: TierResult) -> list[str]:
    found = []
    for before, after in zip(off.score.joints, tier.score.joints, strict=True):
        if after.type_right < before.type_right:
            found.append(f"{after.joint} is {after.predicted_kind or 'not in the tree'}, which is wrong")
        elif after.angle_deg > before.angle_deg + 1.0:
            change = f"{after.angle_deg:.1f} deg ({before.angle_deg:.1f} before)"
            found.append(f"the axis of {after.joint} is off by {change}")
        elif after.limit_iou < before.limit_iou - 0.02:
            change = f"{after.limit_iou:.2f} ({before.limit_iou:.2f} before)"
            found.append(f"the range of {after.joint} overlaps by {change}")
    if tier.score.ted.value > off.score.ted.value:
        found.append(f"the tree is off by {tier.score.ted.value:g} ({off.score.ted.value:g} before)")
    return found


def part_tables(found: Report[Record]) -> dict[str, str]:
    """Title and table of every part."""
    return {
        found.summary["titles"][part]: _part_table(results_of(records))
        for part, records in grouped(found.records, by=itemgetter("part")).items()
    }


def _part_table(results: Sequence[RefiningResult]) -> str:
    """One line per perturbation and tier, and one per tier for all perturbations."""
    groups = [
        (name, [result for result in results if result.perturbation == name])
        for name in dict.fromkeys(result.perturbation for result in results)
    ]
    groups += [("**all**", list(results))] if len(groups) > 1 else []
    titles = ("input", "tier", "objects", "axis angle [deg]", "types", "limits (IoU)", "TED", "wrong joints", "passes")
    rows = [(name, *row) for name, group in groups for row in _tier_rows(group)]
    return table((*titles, "time"), rows)


def _tier_rows(results: Sequence[RefiningResult]) -> list[tuple[str, ...]]:
    """Means by tier, no feedback first."""
    pairs = [(result.tiers[0], tier) for result in results for tier in result.tiers if tier.score.joints]
    rows: list[tuple[str, ...]] = []
    for name in dict.fromkeys(tier.tier for _, tier in pairs):
        own = [(off, tier) for off, tier in pairs if tier.tier == name]
        joints = [tier.score.joints for _, tier in own]
        rows.append((
            name,
            str(len(own)),
            f"{fmean(fmean(joint.angle_deg for joint in group) for group in joints):.2f}",
            f"{fmean(fmean(joint.type_right for joint in group) for group in joints):.1%}",
            f"{fmean(fmean(joint.limit_iou for joint in group) for group in joints):.3f}",
            f"{fmean(tier.score.ted.value for _, tier in own):.2f}",
            f"{sum(_is_wrong(joint) for group in joints for joint in group)} of {sum(map(len, joints))}",
            f"{fmean(tier.errors == 0 for _, tier in own):.1%}",
            f"{median(tier.seconds / max(off.seconds, 1e-9) for off, tier in own):.2f}",
        ))  # fmt: skip
    return rows


def _is_wrong(joint: JointScore) -> bool:
    return not joint.type_right or joint.angle_deg > WRONG_DEG


def report(found: Report[Record]) -> list[str]:
    """A table for each part, and where feedback did harm."""
    rows = harmed(results_of(found.records))
    titles = ("object", "input", "tier", "what became worse", "what was chosen anew")
    tables = [block for title, text in part_tables(found).items() for block in (f"## {title}", text)]
    return [
        explained(__doc__),
        *tables,
        "## Where feedback did harm",
        table(titles, rows) if rows else "Nowhere.",
        "How to read this: [docs/method.md](../docs/method.md#7-refinement).",
    ]


STUDY = Study(title="What refinement is worth", options=RefinementOptions, measure=measure, report=report)
