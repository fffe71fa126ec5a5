"""The page of one night: the gate, what changed, a matrix of objects and checks, accuracy, and every problem."""

from __future__ import annotations

import json
from base64 import b64encode
from typing import TYPE_CHECKING

from kinematify.evaluation.nightly.comparison import QUALITY, ChangeKind
from kinematify.evaluation.nightly.runs import AS_LOADED, OPENED
from kinematify.evaluation.nightly.store import MODELS
from kinematify.evaluation.nightly.validity import page_name
from kinematify.validation.check import FAMILIES
from kinematify.validation.formats.html_frame import badge, page, table, text

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from kinematify.evaluation.nightly.comparison import Change
    from kinematify.evaluation.nightly.runs import Run
    from kinematify.evaluation.nightly.store import Night
    from kinematify.validation.formats.html_frame import Cell

METRIC_TITLES = {
    "angle_deg": "axis angle [deg]",
    "line_m": "axis line [mm]",
    "ted": "tree edits",
    "types": "types right",
    "root": "root right",
    "limit_iou": "limit overlap",
    "opens": "opens right",
}
_GOOD = (ChangeKind.FIXED, ChangeKind.BETTER)
_COUNTED = ("errors", "warnings", "move as loaded", "opened by an arm", "s")
METRIC_SCALES = {"line_m": 1000.0}
_LEGEND = (
    '<p class="faint">truth: the published model; inferred: what the inference makes of its parts at rest; '
    "pulled: the published model, opened by an arm. "
    "Skipped: none of the family's checks applied; blocked: something kept a check from running.</p>"
)
_SEEN = 20
"""Rows that a page shows before they are asked for: a night of many objects stays readable on a few screens."""


def night_page(night: Night, pages: Collection[str] = (), pictures: Mapping[str, bytes] | None = None) -> str:
    """Return the page of a night.

    Args:
        night: The night.
        pages: Files in its folder of models.
        pictures: Of objects that changed, PNG by name.
    """
    title = f"kinematify nightly {night.name}: {night.header['gate']}"
    return page(
        title,
        [
            _head(night),
            *_changes(night),
            _pictures(pictures or {}),
            *_matrix(night, pages),
            *_accuracy(night),
            *_runs(night),
        ],
    )


def nights_page(nights: Sequence[Night]) -> str:
    """Return the page of all nights, a row each.

    Args:
        nights: The oldest first.
    """
    classes = [kind.value for kind in ChangeKind if kind is not ChangeKind.GONE]
    rows: list[tuple[Cell, ...]] = [
        (
            f'<a href="{text(night.name)}/index.html">{text(night.name)}</a>',
            badge(night.header["gate"]),
            str(night.header["objects"]),
            str(night.header["runs"]),
            *(str(night.header["counts"].get(kind, 0)) for kind in classes),
            f"{night.header['seconds'] / 60.0:.1f}",
            text(night.header["processor"]),
        )
        for night in reversed(nights)
    ]
    headings = ("night", "gate", "objects", "runs", *classes, "min", "machine")
    title = f"kinematify nightly: {len(nights)} nights"
    kinds = ("", "", *["number"] * (len(classes) + 3), "")
    return page(title, [f"<h1>{title}</h1>", table(headings, rows, name="nights", classes=kinds)])


def _pictures(pictures: Mapping[str, bytes]) -> str:
    shown = (
        f'<figure><img alt="{text(name)}" width="320" src="data:image/png;base64,{b64encode(image).decode()}">'
        f"<figcaption>{text(name)}</figcaption></figure>"
        for name, image in pictures.items()
    )
    return f'<div class="charts">{"".join(shown)}</div>' if pictures else ""


def _head(night: Night) -> str:
    header = night.header
    others = ", ".join(
        f'{words} <a href="../{text(name)}/index.html">{text(name)}</a>'
        for words, name in (("the night before,", header["last"]), ("the baseline,", header["baseline"]))
        if name
    )
    dirty = " with uncommitted changes" if header["dirty"] else ""
    return (
        f"<h1>{badge(header['gate'])} Night {text(night.name)}</h1>"
        f"<p>{header['objects']} objects, {header['runs']} runs, commit {text(header['commit'])}{dirty}, started "
        f"{text(header['started'])}, {header['seconds'] / 60.0:.1f} min with {header['workers']} workers on "
        f"{text(header['processor'])}. Compared with: {others or 'nothing, it is the first'}. "
        '<a href="../index.html">All nights</a>, <a href="runs.jsonl">runs</a>, <a href="night.json">JSON</a>, '
        f'<a href="junit.xml">JUnit</a>.</p>'
        f"<details><summary>Environment and settings</summary><pre>{text(_environment(night))}</pre></details>"
    )


def _environment(night: Night) -> str:
    keys = ("command", "code", "method", "sessions", "python", "packages", "settings")
    return json.dumps({key: night.header[key] for key in keys}, indent=1)


def _changes(night: Night) -> list[str]:
    """Two lists: against the night before, and against the baseline where that is another night."""
    parts = ["<h2>Changes since the night before</h2>", _change_table(night.changes, "changes")]
    if night.baseline_changes:
        parts += ["<h2>Changes since the baseline</h2>", _change_table(night.baseline_changes, "baseline-changes")]
    return parts


def _change_table(changes: Sequence[Change], name: str) -> str:
    listed_changes = [
        change for change in changes if change.kind not in (ChangeKind.STILL_FAILING, ChangeKind.NEW_SERIES)
    ]
    counted = ", ".join(f"{sum(change.kind is kind for change in changes)} {kind.value}" for kind in ChangeKind)
    failing = sum(change.gate for change in changes)
    words = f"<p>Changes that fail the night: {failing}. {counted}. Timing never fails a night.</p>"
    if not listed_changes:
        return f"<p><strong>Nothing changed.</strong></p>{words}"
    rows: list[tuple[Cell, ...]] = [
        (
            (_class_cell(change), f"{list(ChangeKind).index(change.kind):02d}"),
            text(change.object),
            text(f"{change.what}, {change.case}"),
            _subject(change),
            text(change.text),
        )
        for change in listed_changes
    ]
    listed = table(("class", "object", "run", "what", "report"), rows, name=name)
    return words + (listed if len(rows) <= _SEEN else _folded(f"All {len(rows)} changes", listed))


def _class_cell(change: Change) -> str:
    state = "fail" if change.gate else "warn" if change.kind in QUALITY else "pass" if change.kind in _GOOD else "note"
    return f'<span class="verdict {state}">{text(change.kind.value)}</span>'


def _subject(change: Change) -> str:
    """A link to the exact problem, where it is still there."""
    if change.kind is not ChangeKind.NEW:
        return text(change.subject)
    anchor = problem_anchor(change.object, change.what, change.case, change.subject)
    return f'<a href="#{text(anchor)}">{text(change.subject)}</a>'


def _matrix(night: Night, pages: Collection[str]) -> list[str]:
    """Objects against families of checks, five states each."""
    runs = [run for run in night.runs if run.what == "validation"]
    if not runs:
        return []
    families = [family for family in FAMILIES if any(family in run.families for run in runs)]
    rows = [
        (
            _linked(run),
            _model(run, pages),
            run.status,
            *(run.families.get(family, "") for family in families),
            f"{run.values.get('errors') or 0:.0f}",
            f"{run.values.get('warnings') or 0:.0f}",
            _metric(run, AS_LOADED),
            _metric(run, OPENED),
            f"{run.seconds:.1f}",
        )
        for run in runs
    ]
    headings = ("object", "model", "verdict", *(f"{f} {FAMILIES[f]}" for f in families), *_COUNTED)
    classes = ("", "", "state", *["state"] * len(families), *["number"] * len(_COUNTED))
    listed = table(headings, rows, name="validation", classes=classes)
    return ["<h2>Validation</h2>", _LEGEND, _folded(f"{len(rows)} models, family by family", listed)]


def _model(run: Run, pages: Collection[str]) -> str:
    """Which model, leading to its page where there is one."""
    name = page_name(run.object, run.case)
    return f'<a href="{MODELS}/{text(name)}">{text(run.case)}</a>' if name in pages else text(run.case)


def _accuracy(night: Night) -> list[str]:
    runs = [run for run in night.runs if run.what == "accuracy"]
    if not runs:
        return []
    rows = [
        (
            _linked(run),
            text(run.kind),
            text(run.case),
            run.status,
            *(_metric(run, metric) for metric in METRIC_TITLES),
            str(len(run.problems)),
            f"{run.seconds:.1f}",
        )
        for run in runs
    ]
    headings = ("object", "kind", "pose", "status", *METRIC_TITLES.values(), "problems", "s")
    classes = ("", "", "", "", *["number"] * (len(METRIC_TITLES) + 2))
    listed = table(headings, rows, name="accuracy", classes=classes)
    return ["<h2>Accuracy</h2>", _folded(f"{len(rows)} inferences, joint by joint", listed)]


def _folded(words: str, content: str) -> str:
    return f"<details><summary>{words}</summary>{content}</details>"


def _metric(run: Run, metric: str) -> str:
    value = run.values.get(metric)
    return "" if value is None else f"{METRIC_SCALES.get(metric, 1.0) * value:.4g}"


def _runs(night: Night) -> list[str]:
    """A section for each run that has something to tell, closed at first."""
    sections = [_run(run) for run in night.runs if _has_problems(run)]
    return [
        "<h2>Runs with problems</h2>",
        _folded(f"{len(sections)} runs", "".join(sections)) if len(sections) > _SEEN else "".join(sections),
    ]


def _run(run: Run) -> str:
    name = f"{run.object}, {run.what}, {run.case}"
    words = f"{run.status}: {run.message}" if run.message else run.status
    return (
        f'<details id="{text(_run_anchor(*run.place))}"><summary>{text(name)}: {len(run.problems)} problems</summary>'
        f"<p>{text(words)}</p>{_problems(run)}{_not_run(run)}</details>"
    )


def _problems(run: Run) -> str:
    if not run.problems:
        return ""
    rows = [(text(problem.id), problem.severity, text(problem.text)) for problem in run.problems]
    anchors = [problem_anchor(*run.place, problem.id) for problem in run.problems]
    return table(("problem", "severity", "report"), rows, name=f"in-{_run_anchor(*run.place)}", anchors=anchors)


def _not_run(run: Run) -> str:
    if not run.not_run:
        return ""
    left = "".join(f"<li>{text(check)}: {text(why)}</li>" for check, why in sorted(run.not_run.items()))
    return f"<details><summary>{len(run.not_run)} checks did not run</summary><ul>{left}</ul></details>"


def _linked(run: Run) -> str:
    """Name of the object, leading to its section where it has one."""
    name = text(run.object)
    return f'<a href="#{text(_run_anchor(*run.place))}">{name}</a>' if _has_problems(run) else name


def _has_problems(run: Run) -> bool:
    """True if a run has a section."""
    return bool(run.problems) or not run.answered


def _run_anchor(name: str, what: str, case: str) -> str:
    return f"run-{_plain(f'{name}-{what}-{case}')}"


def problem_anchor(name: str, what: str, case: str, problem: str) -> str:
    """Id of the row of a problem in the page of its night."""
    return f"problem-{_plain(f'{name}-{what}-{case}-{problem}')}"


def _plain(words: str) -> str:
    """Letters, digits and dashes alone, so that an address can hold it."""
    return "".join(letter if letter.isascii() and letter.isalnum() else "-" for letter in words)
