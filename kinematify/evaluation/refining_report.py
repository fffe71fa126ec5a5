"""The ablation of the refinement as Markdown and JSON: what it mends, what it costs, and where it does harm."""

from __future__ import annotations

import json
from collections import defaultdict
from dataclasses import dataclass
from statistics import fmean, median
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter

from kinematify.errors import InputError, OutputError
from kinematify.evaluation.degrade import GAP
from kinematify.evaluation.perturb import CLEAN, MISSING, NOISE, SPURIOUS
from kinematify.evaluation.refining import RefiningResult

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from kinematify.evaluation.metrics import JointScore
    from kinematify.evaluation.refining import TierResult

SCHEMA = 1
WRONG_DEG = 10.0
"""A joint is wrong if its type is, or if its axis is off by more [deg]."""
_RESULTS = TypeAdapter(tuple[RefiningResult, ...])

READING = f"""\
Every object is inferred once, and each tier refines that answer. Means are over the joints of an object, then over
objects; a joint whose parent and child are not joined in the answer counts 90 deg. Wrong joints: another type, or an
axis off by more than {WRONG_DEG:.0f} deg. Passes: no error about motion by the exact geometry. Times: of the inference
and the refinement together, over that of the inference alone, median.

Perturbations: the tolerance of contact halved and doubled; vertices moved by up to {NOISE:.0%} of the smallest side of
their part's box; {MISSING} contacts left out; {SPURIOUS} contacts made up between parts that do not touch; one part cut
in two along its mesh; gaps of {GAP:.0%} of the diagonal between all parts."""


@dataclass(frozen=True, kw_only=True)
class TierSummary:
    """Means of one tier over objects."""

    objects: int
    angle_deg: float
    types: float
    limit_iou: float
    ted: float
    wrong: int
    joints: int
    passes: float
    cost: float
    """Median of the times over that of the inference."""


def summarise_tiers(results: Iterable[RefiningResult]) -> dict[str, TierSummary]:
    """Means by tier, no feedback first; results without an answer are left out."""
    by_tier: dict[str, list[tuple[TierResult, TierResult]]] = defaultdict(list)
    for result in results:
        for tier in result.tiers:
            by_tier[tier.tier].append((result.tiers[0], tier))
    return {name: _summary(pairs) for name, pairs in by_tier.items()}


def _summary(pairs: Sequence[tuple[TierResult, TierResult]]) -> TierSummary:
    scored = [(off, tier) for off, tier in pairs if tier.score.joints]
    joints = [[*tier.score.joints] for _, tier in scored]
    return TierSummary(
        objects=len(scored),
        angle_deg=fmean(fmean(joint.angle_deg for joint in group) for group in joints),
        types=fmean(fmean(joint.type_right for joint in group) for group in joints),
        limit_iou=fmean(fmean(joint.limit_iou for joint in group) for group in joints),
        ted=fmean(tier.score.ted.value for _, tier in scored),
        wrong=sum(is_wrong(joint) for group in joints for joint in group),
        joints=sum(map(len, joints)),
        passes=fmean(tier.errors == 0 for _, tier in scored),
        cost=median(tier.seconds / max(off.seconds, 1e-9) for off, tier in scored),
    )


def is_wrong(joint: JointScore) -> bool:
    """Another type, or an axis that is off."""
    return not joint.type_right or joint.angle_deg > WRONG_DEG


def harmed(results: Iterable[RefiningResult]) -> list[tuple[str, ...]]:
    """Object, perturbation, tier and what became worse, for every answer that the refinement made worse."""
    rows: list[tuple[str, ...]] = []
    for result in results:
        for tier in result.tiers[1:]:
            worse = _worse(result.tiers[0], tier)
            if worse:
                rows.append((result.object, result.perturbation, tier.tier, "; ".join(worse), "; ".join(tier.changes)))
    return rows


def _worse(off: TierResult, tier: TierResult) -> list[str]:
    found = []
    for before, after in zip(off.score.joints, tier.score.joints, strict=True):
        if after.type_right < before.type_right:
            found.append(f"{after.joint} is {after.predicted_kind or 'not in the tree'}, which is wrong")
        elif after.angle_deg > before.angle_deg + 1.0:
            found.append(
                f"the axis of {after.joint} is off by {after.angle_deg:.1f} deg ({before.angle_deg:.1f} before)"
            )
        elif after.limit_iou < before.limit_iou - 0.02:
            found.append(
                f"the range of {after.joint} overlaps by {after.limit_iou:.2f} ({before.limit_iou:.2f} before)"
            )
    if tier.score.ted.value > off.score.ted.value:
        found.append(f"the tree is off by {tier.score.ted.value:g} ({off.score.ted.value:g} before)")
    return found


def markdown(results: Sequence[RefiningResult], header: dict[str, Any], name: str) -> str:
    """The ablation as a document."""
    facts = (
        f"- command: `{header['command']}`\n- date: {header['date']}, code {header['code']}\n"
        f"- machine: {header['processor']}, {header['workers']} workers"
    )
    sections = [f"# {name}", facts, READING]
    for kind in dict.fromkeys(result.kind for result in results):
        own = [result for result in results if result.kind == kind]
        sections.append(f"## {kind}: clean input" if kind != "robot" else "## robots: clean input")
        sections.append(tier_table([result for result in own if result.perturbation == CLEAN]))
        perturbed = [result for result in own if result.perturbation != CLEAN]
        if perturbed:
            sections += [f"## {kind}: perturbed input", perturbation_table(perturbed)]
    sections += ["## Where feedback did harm", harm_table(harmed(results)), *_failures(results)]
    return "\n\n".join(section for section in sections if section) + "\n"


def tier_table(results: Sequence[RefiningResult]) -> str:
    """One line per tier."""
    head = (
        "| | objects | axis angle [deg] | types | limits (IoU) | TED | wrong joints | passes | time |",
        "|---|---|---|---|---|---|---|---|---|",
    )
    lines = [f"| {name} | {_cells(item)} |" for name, item in summarise_tiers(results).items()]
    return "\n".join((*head, *lines))


def _cells(item: TierSummary) -> str:
    return (
        f"{item.objects} | {item.angle_deg:.2f} | {item.types:.1%} | {item.limit_iou:.3f} | {item.ted:.2f} | "
        f"{item.wrong} of {item.joints} | {item.passes:.1%} | {item.cost:.2f}"
    )


def perturbation_table(results: Sequence[RefiningResult]) -> str:
    """One line per perturbation and tier, and one per tier for all of them."""
    head = (
        "| | tier | objects | axis angle [deg] | types | limits (IoU) | TED | wrong joints | passes | time |",
        "|---|---|---|---|---|---|---|---|---|---|",
    )
    lines = []
    groups = {
        name: [r for r in results if r.perturbation == name] for name in dict.fromkeys(r.perturbation for r in results)
    }
    for title, group in (*groups.items(), ("**all**", list(results))):
        lines += [f"| {title} | {name} | {_cells(item)} |" for name, item in summarise_tiers(group).items()]
    return "\n".join((*head, *lines))


def harm_table(rows: Sequence[tuple[str, ...]]) -> str:
    """What `harmed` found, a line each."""
    if not rows:
        return "Nowhere."
    head = ("| object | input | tier | what became worse | what was chosen anew |", "|---|---|---|---|---|")
    return "\n".join((*head, *(f"| {' | '.join(row)} |" for row in rows)))


def _failures(results: Sequence[RefiningResult]) -> list[str]:
    lines = [f"- {item.object}, {item.perturbation}: {item.message}" for item in results if item.message]
    return ["## Without an answer", "\n".join(lines)] if lines else []


def write_refining_report(
    results: Sequence[RefiningResult], header: dict[str, Any], folder: Path, *, name: str
) -> tuple[Path, Path]:
    """Write ``<name>.md`` and ``<name>.json`` into a folder and return their paths.

    Raises:
        OutputError: The folder cannot be written.
    """
    values = {"schema": SCHEMA, "header": header, "results": _RESULTS.dump_python(tuple(results), mode="json")}
    paths = folder / f"{name}.md", folder / f"{name}.json"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        paths[0].write_text(markdown(results, header, name), encoding="utf-8")
        paths[1].write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    except OSError as error:
        raise OutputError(
            f"The report cannot be written to {folder}: {error}. Give a folder that can be written."
        ) from error
    return paths


def load_refining_report(path: Path) -> tuple[tuple[RefiningResult, ...], dict[str, Any]]:
    """Read what `write_refining_report` has written: results and header.

    Raises:
        InputError: The file does not exist or is no such report.
    """
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
        return _RESULTS.validate_python(values["results"]), values["header"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{path} is not a report of a refinement: {error}. Give a JSON file that `kinematify bench --refine` has "
            "written."
        ) from error


def tier_rows(results: Sequence[RefiningResult]) -> list[tuple[str, ...]]:
    """Rows for a terminal: kind, input, tier and the same figures."""
    rows = []
    keys = dict.fromkeys((result.kind, result.perturbation) for result in results)
    for kind, perturbation in keys:
        group = [result for result in results if (result.kind, result.perturbation) == (kind, perturbation)]
        for name, item in summarise_tiers(group).items():
            rows.append((kind, perturbation, name, *(cell.strip() for cell in _cells(item).split("|"))))
    return rows


TIER_HEADINGS = ("kind", "input", "tier", "objects", "angle [deg]", "types", "limits", "TED", "wrong", "passes", "time")
"""Of `tier_rows`."""
