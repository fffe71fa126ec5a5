"""Validate models that nobody planted a fault in: the benchmark's, and URDFs that PyBullet's data package ships.

Writes results/validate_published.{json,md}: every error by check and place, and how many warnings there are. What the
errors mean, one by one, stands in docs/validate.md.
"""

from __future__ import annotations

import argparse
import json
import time
from collections import Counter
from dataclasses import asdict, dataclass
from pathlib import Path

import pybullet_data

from kinematify.evaluation.datasets import find_objects
from kinematify.validation.finding import Severity, Status
from kinematify.validation.run import validate

SHIPPED = (
    "a1/a1", "aliengo/aliengo", "bicycle/bike", "biped/biped2d_pybullet", "cartpole", "differential/diff_ring",
    "franka_panda/panda", "humanoid/humanoid", "husky/husky", "kuka_iiwa/model", "kuka_iiwa/model_vr_limits",
    "laikago/laikago", "laikago/laikago_toes_limits", "mini_cheetah/mini_cheetah", "pendulum5", "pr2_gripper",
    "quadruped/minitaur", "quadruped/quadruped", "quadruped/spirit40", "quadruped/vision60", "r2d2", "racecar/racecar",
    "xarm/xarm6_robot", "xarm/xarm6_with_gripper",
)  # fmt: skip
"""Articulated models of the package pybullet_data, without ``.urdf``."""


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What was said of one model."""

    model: str
    source: str
    seconds: float
    errors: tuple[tuple[str, str], ...]
    """Check, and the joint, link or pair that it names."""
    warnings: dict[str, int]
    """Number by check."""
    blocked: int


def main() -> None:
    """Validate one model after the other, each with all checks."""
    arguments = _arguments()
    models = [("benchmark", item.name, item.urdf) for item in find_objects(arguments.data)]
    folder = Path(pybullet_data.getDataPath())
    models += [("pybullet_data", name, folder / f"{name}.urdf") for name in SHIPPED]
    found = []
    for source, name, urdf in models:
        found.append(_verdict(source, name, urdf))
        print(f"{name}: {found[-1].seconds:.1f} s, {len(found[-1].errors)} errors", flush=True)
    arguments.output.mkdir(parents=True, exist_ok=True)
    values = {"schema": 1, "models": [asdict(item) for item in found]}
    (arguments.output / "validate_published.json").write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    (arguments.output / "validate_published.md").write_text(_markdown(found), encoding="utf-8")


def _verdict(source: str, name: str, urdf: Path) -> Verdict:
    start = time.perf_counter()
    report = validate(urdf)
    errors = [finding for finding in report.findings if finding.severity is Severity.ERROR]
    warnings = Counter(finding.check for finding in report.findings if finding.severity is Severity.WARNING)
    places = [(item.check, item.joint or item.link or " and ".join(item.pair or ())) for item in errors]
    return Verdict(
        model=name,
        source=source,
        seconds=round(time.perf_counter() - start, 1),
        errors=tuple(places),
        warnings=dict(sorted(warnings.items())),
        blocked=sum(check.status is Status.BLOCKED for check in report.checks),
    )


def _markdown(found: list[Verdict]) -> str:
    about = (
        "Written by `python benchmarks/published.py`: all checks, models as they are. Most of the benchmark's have "
        "neither mass nor collision geometry, which KV201 and KV240 warn of."
    )
    parts = ["# What `kinematify validate` says of published models", "", about]
    for source in dict.fromkeys(item.source for item in found):
        mine = [item for item in found if item.source == source]
        wrong = sum(bool(item.errors) for item in mine)
        parts += [
            "",
            f"## {source}: {wrong} of {len(mine)} models with errors",
            "",
            "| model | time [s] | errors | warnings | checks that a fault blocks |",
            "|---|---|---|---|---|",
            *(_line(item) for item in mine),
        ]
    return "\n".join(parts) + "\n"


def _line(item: Verdict) -> str:
    counts = Counter(check for check, _ in item.errors)
    errors = ", ".join(
        f"{check} ({'; '.join(place for name, place in item.errors if name == check) if count < 4 else count})"
        for check, count in counts.items()
    )
    warnings = ", ".join(f"{check} x {count}" if count > 1 else check for check, count in item.warnings.items())
    return f"| {item.model} | {item.seconds} | {errors} | {warnings} | {item.blocked or ''} |"


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder of models, the benchmark's if absent")
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    return parser.parse_args()


if __name__ == "__main__":
    main()
