"""Put the reports of `kinematify bench --refine` in results/ together: python benchmarks/refine_results.py.

Writes results/refine.md, and the short table in the README.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.evaluation.perturb import CLEAN
from kinematify.evaluation.refining_report import (
    READING,
    harm_table,
    harmed,
    load_refining_report,
    perturbation_table,
    tier_table,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.evaluation.refining import RefiningResult

ROOT = Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- refine:begin -->", "<!-- refine:end -->"
REPORTS = {
    "refine_everyday": "Everyday objects, clean input",
    "refine_tiers": "The dear tiers, some everyday objects, clean input",
    "refine_robots": "Robots, clean input",
    "refine_perturbed": "Everyday objects, perturbed input",
}


def table_of(results: Sequence[RefiningResult]) -> str:
    perturbed = [result for result in results if result.perturbation != CLEAN]
    return perturbation_table(perturbed) if perturbed else tier_table(results)


def main() -> None:
    known = {name: ROOT / "results" / f"{name}.json" for name in REPORTS}
    reports = {name: load_refining_report(path) for name, path in known.items() if path.is_file()}
    sections = ["# What refinement is worth", READING]
    rows = []
    for name, (results, header) in reports.items():
        made = f"Made by `{header['command']}`, {header['date']}, code {header['code']}."
        sections += [f"## {REPORTS[name]}", table_of(results), made]
        rows += harmed(results)
    sections += ["## Where feedback did harm", harm_table(rows)]
    note = ROOT / "results" / "refine_notes.md"
    if note.is_file():
        sections.append(note.read_text(encoding="utf-8").strip())
    (ROOT / "results" / "refine.md").write_text("\n\n".join(sections) + "\n", encoding="utf-8")
    write_readme(reports, rows)


def write_readme(
    reports: dict[str, tuple[tuple[RefiningResult, ...], dict[str, object]]], rows: list[tuple[str, ...]]
) -> None:
    """The table of clean input, and where feedback did harm."""
    short = [f"**{REPORTS[name]}**\n\n{table_of(reports[name][0])}" for name in REPORTS if name in reports]
    harm = "; ".join(dict.fromkeys(f"{row[0]} ({row[1]}: {row[3]})" for row in rows)) or "none"
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    before, after = text[: text.index(BEGIN)], text[text.index(END) :]
    body = "\n\n".join([*short, f"Where feedback did harm: {harm}."])
    readme.write_text(f"{before}{BEGIN}\n{body}\n{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
