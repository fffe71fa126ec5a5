"""The page of all nights: a row for each night, and for each object its metrics over the nights.

A line ends where the scenario changes: what lies on both sides of the gap must not be compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from statistics import fmean
from typing import TYPE_CHECKING

from kinematify.evaluation.nightly.night_page import METRIC_SCALES, METRIC_TITLES
from kinematify.evaluation.nightly.runs import AS_LOADED, OPENED, PULLED
from kinematify.validation.formats.chart import Axes, Series, line_chart, sparkline
from kinematify.validation.formats.html_frame import badge, page, table, text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from kinematify.evaluation.nightly.runs import Run
    from kinematify.evaluation.nightly.store import Night
    from kinematify.validation.formats.html_frame import Cell

_COLUMNS = ("angle_deg", "ted", "types", "limit_iou")
"""Metrics of the benchmark in the table; the others are in the charts of each object."""


@dataclass(frozen=True, kw_only=True)
class _Point:
    night: int
    """Index of the night."""
    value: float
    scenario: str


_EXPLAINED = (
    '<p class="faint">Each metric is the mean over the poses of an object. A line ends where the scenario (input, '
    "pose, thresholds) changes. The runs themselves stand in <code>*/runs.jsonl</code>.</p>"
)


class _History:
    """Nights with their runs by object, which are asked for often."""

    def __init__(self, nights: Sequence[Night]) -> None:
        self.nights = nights
        self.groups: list[dict[str | None, list[Run]]] = []
        """Of each night; None: all runs."""
        for night in nights:
            groups: dict[str | None, list[Run]] = {None: list(night.runs)}
            for run in night.runs:
                groups.setdefault(run.object, []).append(run)
            self.groups.append(groups)


def trend_page(nights: Sequence[Night]) -> str:
    """Return the page of all nights.

    Args:
        nights: The oldest first.
    """
    history = _History(nights)
    names = sorted({run.object for night in nights for run in night.runs})
    body = [
        f"<h1>kinematify nightly: {len(nights)} nights</h1>",
        _EXPLAINED,
        "<h2>Nights</h2>",
        _nights(nights),
        "<h2>Means over all objects</h2>",
        f'<div class="charts">{_charts(history, None)}</div>',  # only nights over the same runs are joined by a line
        "<h2>Objects</h2>",
        _objects(history, names),
        *(
            f'<details id="object-{text(name)}"><summary>{text(name)}</summary>'
            f'<div class="charts">{_charts(history, name)}</div></details>'
            for name in names
        ),
    ]
    return page(f"kinematify nightly: {len(nights)} nights", body)


def _nights(nights: Sequence[Night]) -> str:
    rows: list[tuple[Cell, ...]] = [
        (
            f'<a href="{text(night.name)}/index.html">{text(night.name)}</a>',
            badge(night.header["gate"]),
            str(night.header["objects"]),
            str(night.header["runs"]),
            *(str(night.header["counts"].get(kind, 0)) for kind in _CLASSES),
            f"{night.header['seconds'] / 60.0:.1f}",
            text(night.header["processor"]),
        )
        for night in reversed(nights)
    ]
    headings = ("night", "gate", "objects", "runs", *_CLASSES, "min", "machine")
    classes = ("", "", *["number"] * (len(_CLASSES) + 3), "")
    return table(headings, rows, name="nights", classes=classes)


_CLASSES = ("new", "worse", "newly skipped", "still failing", "fixed", "better", "slower", "faster", "new series")


def _measures() -> list[tuple[str, str, Callable[[Sequence[Run]], float | None]]]:
    """Title, unit and value of everything that is drawn."""
    return [
        *((title, "", _metric_value(metric)) for metric, title in METRIC_TITLES.items()),
        ("inference", "time [s]", _seconds("accuracy")),
        ("findings, published model", "errors and warnings", _findings("truth")),
        ("findings, inferred model", "errors and warnings", _findings("inferred")),
        ("joints that move as loaded, inferred model", "", _share(AS_LOADED, "inferred")),
        ("opened by an arm", "", _share(OPENED, PULLED)),
        ("validation", "time [s]", _seconds("validation")),
    ]


def _share(metric: str, case: str) -> Callable[[Sequence[Run]], float | None]:
    return lambda runs: _mean(run.values.get(metric) for run in runs if run.case == case)


def _metric_value(metric: str) -> Callable[[Sequence[Run]], float | None]:
    def value(runs: Sequence[Run]) -> float | None:
        mean = _mean(run.values.get(metric) for run in runs if run.what == "accuracy")
        return None if mean is None else METRIC_SCALES.get(metric, 1.0) * mean

    return value


def _seconds(what: str) -> Callable[[Sequence[Run]], float | None]:
    return lambda runs: _mean(run.seconds for run in runs if run.what == what)


def _findings(case: str) -> Callable[[Sequence[Run]], float | None]:
    return lambda runs: _mean(
        float(len(run.problems)) for run in runs if run.what == "validation" and run.case == case and run.answered
    )


def _mean(values: Iterable[float | None]) -> float | None:
    """Mean of the values that exist."""
    known = [value for value in values if value is not None]
    return fmean(known) if known else None


def _points(history: _History, name: str | None, pick: Callable[[Sequence[Run]], float | None]) -> list[_Point]:
    """One point for each night with a value; the scenario is that of all runs that were looked at."""
    points = []
    for index, groups in enumerate(history.groups):
        runs = groups.get(name, ())
        value = pick(runs)
        if value is not None:
            scenario = "-".join(sorted(f"{run.object}{run.case}{run.scenario}" for run in runs))
            points.append(_Point(night=index, value=value, scenario=scenario))
    return points


def _series(points: Sequence[_Point]) -> list[list[_Point]]:
    """Points in runs of the same scenario."""
    found: list[list[_Point]] = []
    for point in points:
        if found and found[-1][-1].scenario == point.scenario:
            found[-1].append(point)
        else:
            found.append([point])
    return found


def _charts(history: _History, name: str | None) -> str:
    """All charts of an object, or of all objects together."""
    drawn = [(title, unit, _points(history, name, pick)) for title, unit, pick in _measures()]
    return "".join(_chart(title, points, history.nights, unit) for title, unit, points in drawn)


def _chart(title: str, points: Sequence[_Point], nights: Sequence[Night], unit: str) -> str:
    lines = [
        Series(
            label="series",
            points=tuple((float(p.night), p.value) for p in part),
            links=tuple((f"{nights[p.night].name}: {p.value:.4g}", f"{nights[p.night].name}/index.html") for p in part),
        )
        for part in _series(points)
    ]
    ends = sorted({points[0].night, points[-1].night}) if points else []
    ticks = tuple((float(k), nights[k].name[5:10]) for k in ends)
    return line_chart(title, lines, Axes(x="night", y=unit, ticks=ticks), width=270, height=140, legend=False)


def _objects(history: _History, names: Sequence[str]) -> str:
    rows: list[tuple[Cell, ...]] = [
        (
            f'<a href="#object-{text(name)}">{text(name)}</a>',
            *(_trend_cell(history, name, _metric_value(metric)) for metric in _COLUMNS),
            _trend_cell(history, name, _findings("truth")),
            _trend_cell(history, name, _findings("inferred")),
            _trend_cell(history, name, _seconds("accuracy")),
        )
        for name in names
    ]
    headings = (
        "object",
        *(METRIC_TITLES[m] for m in _COLUMNS),
        "findings, truth",
        "findings, inferred",
        "inference [s]",
    )
    return table(headings, rows, name="objects", classes=("", *["number"] * (len(_COLUMNS) + 3)))


def _trend_cell(history: _History, name: str, pick: Callable[[Sequence[Run]], float | None]) -> Cell:
    """The latest value, with the line of the series that it belongs to."""
    points = _points(history, name, pick)
    if not points:
        return ""
    part = _series(points)[-1]
    return f"{sparkline([(p.night, p.value) for p in part])} {part[-1].value:.4g}", f"{part[-1].value:.6g}"
