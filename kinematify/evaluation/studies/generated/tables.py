"""Results of the families as JSON and Markdown, the worst family first and every kind of error with an example."""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from statistics import fmean
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from kinematify.evaluation.studies.generated.job import Result

TITLES = ("family", "objects", "joints", "truth without error", "inferred without error", "errors of the truth",
          "errors of the inferred", "angle [deg]", "types", "TED", "seconds")  # fmt: skip


def write_tables(
    results: Sequence[Result], facts: Mapping[str, Any], folder: Path, *, command: str, wanted: int
) -> str:
    """Write families.json and families.md, and return the latter's table; `wanted` objects make it complete."""
    groups = _worst_first(results)
    lines = [row(name, group) for name, group in groups.items()]
    lines.append(row("**all**", results))
    table = "\n".join(f"| {' | '.join(cells)} |" for cells in (TITLES, ("---",) * len(TITLES), *lines))
    machine = ", ".join(f"{name} {facts[name]}" for name in ("kinematify", "python", "platform") if name in facts)
    stopped = f" (stopped early: {len(results)} of its {wanted} objects)" if len(results) < wanted else ""
    text = f"""# families

- command: `{command}`{stopped}
- {machine}

Objects of every family of `kinematify generate`, drawn by seeds. The model with the known joints and the model that was
inferred from the parts alone go through `kinematify validate`; shares count models without any error. In
brackets: in how many objects a check says so. Angle, types and TED compare the inferred joints with the known ones, as
`kinematify bench` does: mean over the joints of an object, then over objects; types over all joints.

{table}

## One example of each error

{_examples(groups)}
"""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "families.md").write_text(text, encoding="utf-8")
    rows = {name: _numbers(group) for name, group in groups.items()}
    record = {
        "command": command,
        "wanted": wanted,
        "environment": facts,
        "all": _numbers(results),
        "families": rows,
        "objects": list(results),
    }
    (folder / "families.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return table


def row(name: str, results: Sequence[Result]) -> tuple[str, ...]:
    """Return the cells of a group."""
    numbers = _numbers(results)
    return (
        name,
        str(numbers["objects"]),
        str(numbers["joints"]),
        f"{numbers['truth']:.0%}",
        f"{numbers['inferred']:.0%}",
        _counted(numbers["truth_errors"]),
        _counted(numbers["inferred_errors"]),
        f"{numbers['angle_deg']:.2f}",
        f"{numbers['types']:.1%}",
        f"{numbers['ted']:.2f}",
        f"{numbers['seconds']:.1f}",
    )


def _worst_first(results: Iterable[Result]) -> dict[str, list[Result]]:
    groups = defaultdict(list)
    for result in results:
        groups[result["family"]].append(result)

    def goodness(name: str) -> tuple[float, float, str]:
        numbers = _numbers(groups[name])
        return (numbers["truth"] + numbers["inferred"], -numbers["angle_deg"], name)

    return {name: groups[name] for name in sorted(groups, key=goodness)}


def _numbers(results: Sequence[Result]) -> dict[str, Any]:
    joints = sum(result["joints"] for result in results)
    shares = {whose: fmean(not result[whose]["errors"] for result in results) for whose in ("truth", "inferred")}
    errors = {f"{whose}_errors": dict(_checks(results, whose)) for whose in ("truth", "inferred")}
    return {
        "objects": len(results),
        "joints": joints,
        **shares,
        **errors,
        "angle_deg": fmean(result["accuracy"]["angle_deg"] for result in results),
        "types": sum(result["accuracy"]["types_right"] for result in results) / max(joints, 1),
        "ted": fmean(result["accuracy"]["ted"] for result in results),
        "seconds": fmean(result["seconds"] for result in results),
    }


def _checks(results: Iterable[Result], whose: str) -> Counter[str]:
    """In how many objects each check has an error."""
    return Counter(check for result in results for check in sorted({e["check"] for e in result[whose]["errors"]}))


def _counted(checks: Mapping[str, int]) -> str:
    return ", ".join(f"{check} ({count})" for check, count in sorted(checks.items(), key=lambda item: -item[1])) or "-"


def _examples(groups: Mapping[str, Sequence[Result]]) -> str:
    first: dict[tuple[str, str, str], str] = {}
    for name, group in groups.items():
        for result in group:
            for whose in ("truth", "inferred"):
                for error in result[whose]["errors"]:
                    place = f"{name}, seed {result['seed']}, {whose}, {error['check']}, {error['where']}"
                    first.setdefault((name, whose, error["check"]), f"- {place}: {error['message']}")
    return "\n".join(first.values()) or "None."
