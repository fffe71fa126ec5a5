"""How often does each failure occur on right joints, and how often on wrong ones?

Wrong joints are planted in true mechanisms as `kinematify bench refine` does, and nothing is refined. *Line*: an axis
turned by 90 deg, a moved pivot, or the second-best hypothesis where it is of the right type; *type*, *parent*: the
other type, another parent; *range*: the other sign, or a range that reaches twice as far. A joint failed a check that
found an error about it, or a warning and no error; the two are counted apart, and what collision geometry alone causes
is not counted. What a failure weighs in `kinematify refine` is a lower bound (95 %) of the logarithm of the ratio of
a rate to that on right joints; `--write FILE` writes the counts as `validation/failure_rates.json` has them.
"""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import Field

from benchmarks.planted import (
    AXIS,
    NOTHING,
    PARENT,
    PIVOT,
    RANGE,
    SECOND,
    SIGN,
    TYPE,
    planted_faults,
    true_mechanism,
)
from benchmarks.study import Options, Study, explained
from kinematify import __version__
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.errors import OutputError
from kinematify.evaluation.benchmark_job import erased_item
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, find_objects, matching
from kinematify.evaluation.result_record import table
from kinematify.refinement.joint_plan import Plan
from kinematify.refinement.simulate import Simulator
from kinematify.validation import failure_rates
from kinematify.validation.failure_rates import CLASSES, RIGHT, FailureRates
from kinematify.validation.finding import Severity
from kinematify.validation.run.feedback import only_collision_meets

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report
    from kinematify.pipeline.inference import Inference
    from kinematify.validation.finding import Observation

SAMPLE = (
    "audibot", "bigym_base_doors", "bigym_base_drawers", "bigym_dishwasher", "bigym_wall_cabinet", "bullet_racecar",
    "calvin_table_A", "calvin_table_B", "doorgym_pull_left", "doorgym_pull_right", "drake_cupboard", "fs_boxcabinet",
    "fs_hood_panel", "gz_cart_rigid", "gz_cessna", "gz_hinged_door", "gz_polaris_ev", "gz_prius_hybrid",
    "gz_scanse_sweep", "gz_src_doorway", "gz_tricycle", "gz_velodyne", "gz_wooden_case", "habitat_fridge",
    "jsk_fridge", "koki_handle_door", "lb_white_cabinet", "px4_bluerov2", "px4_gimbal", "px4_lawnmower",
    "px4_rover_ackermann", "robel_valve3", "robel_valve4", "simpler_mk_station", "src_leak_patch_tool",
    "src_satellite_dish", "src_solar_panel", "tz_button", "tz_cabinet_hammer", "urdformer_13", "urdformer_55",
)  # fmt: skip
"""Objects of other hands whose licence lets us fit to them; none of them is measured by `kinematify bench refine`."""
_FAULTS = (AXIS, PIVOT, TYPE, SIGN, PARENT, SECOND, RANGE)
_CLASS = {
    AXIS: failure_rates.LINE,
    PIVOT: failure_rates.LINE,
    TYPE: failure_rates.TYPE,
    PARENT: failure_rates.PARENT,
    SIGN: failure_rates.RANGE,
    RANGE: failure_rates.RANGE,
}


class FailuresOptions(Options):
    """Which objects, where the counts go."""

    data: str = Field("everyday2", description="Folder or set of objects.")
    objects: tuple[str, ...] = Field(SAMPLE, description="Names or patterns of objects; * for all.")
    seed: int = Field(0, description="Draws the joints.")
    write: str | None = Field(None, description="File for the counts.")


@dataclass(frozen=True, kw_only=True)
class Watched:
    """One object whose joints are watched."""

    item: BenchObject
    seed: int


def measure(options: FailuresOptions, work: Work) -> Measured:
    """Simulate every object as it is and with each fault, and count."""
    asked = {
        item.name: Watched(item=item, seed=options.seed)
        for item in matching(find_objects(options.data), options.objects)
    }
    records = [joint for record in work.each(watched, asked, timeout=7200.0).values() for joint in record["joints"]]
    if options.write is not None:
        provenance = {
            **options.model_dump(mode="json", exclude={"write"}),
            "objects": sorted({record["object"] for record in records}),
            "made": datetime.now(UTC).date().isoformat(),
            "kinematify": __version__,
        }
        _write(rates_of(records, provenance), Path(options.write))
    return records, {}


def watched(asked: Watched) -> Record:
    """The joints of one object, right and wrong, with the checks that each failed."""
    mechanism = true_mechanism(erased_item(asked.item, CONDITIONS[0]), load_config())
    if mechanism is None:
        return {"joints": []}
    right = _failed(mechanism.inference)
    joints = [_record(asked, part, RIGHT, NOTHING, failed) for part, failed in right.items()]
    for planted in planted_faults(mechanism, asked.seed, _FAULTS):
        failed = _failed(planted.inference)[planted.part]
        what = _CLASS.get(planted.fault) or _class_of_second(mechanism.inference, planted.inference, planted.part)
        joints.append(_record(asked, planted.part, what, planted.fault, failed))
    return {"joints": joints}


def _class_of_second(right: Inference, wrong: Inference, part: str) -> str:
    child = right.assembly.names.index(part)
    kinds = [next(joint.kind for joint in item.joints if joint.child == child).turns for item in (right, wrong)]
    return failure_rates.LINE if kinds[0] == kinds[1] else failure_rates.TYPE


def _record(asked: Watched, part: str, what: str, fault: str, failed: Mapping[str, Severity]) -> Record:
    return {
        "object": asked.item.name,
        "part": part,
        "class": what,
        "fault": fault,
        "failed": dict(sorted(failed.items())),
    }


def _failed(inference: Inference) -> dict[str, dict[str, Severity]]:
    """Checks that found fault with the joint above each part, with the worst that they found."""
    plan = Plan(inference=inference)
    verdict = Simulator(plan.model, load_settings().geometry).judge(plan.model)
    carrier = {joint.child: joint.name for joint in plan.model.joints}
    failed: dict[str, dict[str, Severity]] = {name: {} for name in carrier.values()}
    for finding in verdict.findings:
        joint = _suspected(finding, carrier)
        if joint not in failed or only_collision_meets(finding):
            continue
        if finding.severity is not Severity.NOTE and failed[joint].get(finding.check) is not Severity.ERROR:
            failed[joint][finding.check] = finding.severity
    return {part: failed[name] for part, name in carrier.items()}


def _suspected(finding: Observation, carrier: dict[str, str]) -> str | None:
    """The joint that a finding is about: of KV311 that of the part which is brought into another body."""
    parts = [carrier[part] for part in finding.pair or () if part in carrier]
    if finding.check == "KV311" and finding.joint not in parts and parts:
        return parts[0]
    return finding.joint


def rates_of(records: Iterable[Record], provenance: Record) -> FailureRates:
    """Count joints and failures by class."""
    joints: Counter[str] = Counter()
    failures: dict[str, dict[str, Counter[str]]] = {}
    for record in records:
        joints[record["class"]] += 1
        for check, severity in record["failed"].items():
            failures.setdefault(check, {}).setdefault(severity, Counter())[record["class"]] += 1
    counts = {
        check: {severity: dict(counted) for severity, counted in sorted(failures[check].items())}
        for check in sorted(failures)
    }
    return FailureRates(joints=dict(joints), failures=counts, provenance=provenance)


def _write(rates: FailureRates, path: Path) -> None:
    try:
        path.write_text(json.dumps(asdict(rates), indent=1) + "\n", encoding="utf-8")
    except OSError as error:
        raise OutputError(
            f"The counts cannot be written to {path}: {error}. Give another file with --write."
        ) from error


def report(found: Report[Record]) -> list[str]:
    """Rates and weights of every check, errors and warnings apart."""
    rates = rates_of(found.records, {})
    wrong = [what for what in CLASSES if what != RIGHT]
    rows = [
        (
            check,
            severity,
            *(f"{counts.get(what, 0)} of {rates.joints.get(what, 0)}" for what in CLASSES),
            *(f"{rates.weight(check, Severity(severity), what):.2f}" for what in wrong),
        )
        for check, by_severity in rates.failures.items()
        for severity, counts in by_severity.items()
    ]
    return [explained(__doc__), table(("check", "finding", *CLASSES, *(f"weight, {what}" for what in wrong)), rows)]


STUDY = Study(title="How often failures occur", options=FailuresOptions, measure=measure, report=report)
