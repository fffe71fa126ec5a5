"""Write the results of the README from the reports in results/: python benchmarks/readme_results.py."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.evaluation.paper import ABLATION, TABLE_I, PaperRow, mean_over_robots
from kinematify.evaluation.report import load_report
from kinematify.evaluation.summary import condition_group, median_seconds, summarise

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.evaluation.job import JobResult
    from kinematify.evaluation.run import BenchmarkReport

ROOT = Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- results:begin -->", "<!-- results:end -->"
HEAD = (
    "| | joints | axis angle [deg] | axis line [mm] | tree edits (TED) | types right | time [s] | paper: angle, TED |",
    "|---|---|---|---|---|---|---|---|",
)
WRONG_DEG = 5.0


def row(name: str, results: Sequence[JobResult], paper: PaperRow) -> str:
    values = summarise(results).values
    cells = (
        name,
        f"{values['joints']:.0f}",
        f"{values['angle_deg']:.2f}",
        f"{1000 * (values['line_m'] or 0.0):.1f}",
        f"{values['ted']:.2f}",
        f"{100 * (values['types'] or 0.0):.0f} %",
        f"{median_seconds(results):.1f}",
        f"{paper.angle_deg:.2f}, {paper.ted:.2f}",
    )
    return f"| {' | '.join(cells)} |"


def by_condition(title: str, results: Sequence[JobResult]) -> str:
    parts = []
    for group in dict.fromkeys(condition_group(run.condition) for run in results):
        values = summarise([run for run in results if condition_group(run.condition) == group]).values
        parts.append(
            f"{group} {values['angle_deg']:.2f} deg, TED {values['ted']:.2f}, types {100 * values['types']:.0f} %"
        )
    return f"{title} by condition: {'; '.join(parts)}."


def ablation(reports: Sequence[BenchmarkReport]) -> list[str]:
    """The paper's method as we built it (`--config paper`) beside the numbers that the paper gives."""
    runs = [run for report in reports for run in report.results]
    lines = ["| `--config paper`, at rest: angle [deg], TED | everyday | Fetch | Panda |", "|---|---|---|---|"]
    for variant, theirs in ABLATION.items():
        cells = []
        for name in ("everyday", "fetch", "panda"):
            group = [r for r in runs if r.variant == variant and name in (r.object, r.kind)]
            values = summarise(group).values
            angle, _, ted = theirs[name]
            cells.append(f"{values['angle_deg']:.1f}, {values['ted']:.2f} (paper: {angle:.1f}, {ted:.2f})")
        lines.append(f"| {variant} | {' | '.join(cells)} |")
    return lines


def faults(results: Sequence[JobResult]) -> str:
    wrong: dict[str, set[str]] = {}
    for run in results:
        for joint in run.score.joints if run.score is not None else ():
            if joint.angle_deg > WRONG_DEG or not joint.type_right:
                wrong.setdefault(run.object, set()).add(joint.joint)
    named = ", ".join(f"{name} ({len(joints)})" for name, joints in sorted(wrong.items()))
    return f"Objects with a joint that is wrong in at least one run (joints): {named or 'none'}."


def main() -> None:
    robots, everyday = (load_report(ROOT / "results" / f"{name}.json") for name in ("robots", "everyday"))
    names = sorted({run.object for run in robots.results})
    lines = [
        *HEAD,
        *(row(TABLE_I[n].label, [r for r in robots.results if r.object == n], TABLE_I[n]) for n in names),
        row("**six robots**", robots.results, mean_over_robots()),
        row("**48 everyday objects**", everyday.results, TABLE_I["everyday"]),
        "",
        "Means over the poses rest, three random ones and one turned by 37 deg, from parts without names, by",
        "geometry alone. The paper's everyday objects are others. A joint between the wrong parts counts 90 deg.",
        "",
        by_condition("Robots", robots.results),
        by_condition("Everyday objects", everyday.results),
        "",
        faults(robots.results),
        faults(everyday.results),
        "",
        *ablation([load_report(ROOT / "results" / f"ablation_{name}.json") for name in ("robots", "everyday")]),
        "",
        f"Made by `{robots.header['command']}` and `{everyday.header['command']}`,",
        "written here by `python benchmarks/readme_results.py`.",
    ]
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    before, after = text[: text.index(BEGIN)], text[text.index(END) :]
    readme.write_text(f"{before}{BEGIN}\n" + "\n".join(lines) + f"\n{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
