"""Differences from another night, in classes: quality can fail a night, timing is only reported."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from pydantic import TypeAdapter

from kinematify.evaluation.nightly.runs import AS_LOADED, JOINTS, MORE_IS_BETTER, OPENED, UNITS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from kinematify.config.nightly_settings import NightlySettings
    from kinematify.evaluation.nightly.runs import Run, RunKey


class ChangeKind(StrEnum):
    """Kind of a change."""

    NEW = "new"
    """A problem that was not there."""
    WORSE = "worse"
    """A metric went the wrong way by more than its gate."""
    NEWLY_SKIPPED = "newly skipped"
    """A check or a run that gave an answer before and does not now; it is not fixed by that."""
    STILL_FAILING = "still failing"
    FIXED = "fixed"
    BETTER = "better"
    SLOWER = "slower"
    """Only reported."""
    FASTER = "faster"
    INPUT_CHANGED = "input changed"
    """The object has other files than before: it is compared with its last result."""
    NEW_SERIES = "new series"
    """There is no earlier run of this scenario to compare with."""
    GONE = "gone"
    """The other night had a run of it."""


QUALITY = (ChangeKind.NEW, ChangeKind.WORSE, ChangeKind.NEWLY_SKIPPED)
"""Classes that may fail a night."""
SHOWN = (*QUALITY, ChangeKind.FIXED, ChangeKind.BETTER, ChangeKind.INPUT_CHANGED)
"""Classes whose objects are drawn."""


@dataclass(frozen=True, kw_only=True)
class Change:
    """One thing that is not as it was, or that is still wrong."""

    kind: ChangeKind
    object: str
    what: str
    case: str
    subject: str
    """Id of the problem, name of the check or of the metric; empty if it is the whole run."""
    text: str
    gate: bool = False
    """It fails the night."""


CHANGES = TypeAdapter(tuple[Change, ...])


def compare(
    runs: Iterable[Run],
    before: Mapping[RunKey, Sequence[Run]],
    settings: NightlySettings,
    *,
    same_machine: bool,
    complete: bool = True,
) -> tuple[Change, ...]:
    """Compare each run with the latest earlier one of the same scenario.

    Args:
        runs: Those of the night to judge.
        before: Earlier runs of each place, the latest first.
        settings: Gates.
        same_machine: Whether times may be compared.
        complete: Whether a run that is missing is reported as gone.

    Returns:
        Changes in the order of the classes, those that fail the night first within a class.
    """
    tonight = {run.place: run for run in runs}
    found: list[Change] = []
    for place, run in tonight.items():
        earlier = before.get(place, ())
        same = next((other for other in earlier if other.scenario == run.scenario), None)
        last = next((other for other in earlier if run.series and other.series == run.series), None)
        if same is None and last is not None:
            found.append(
                _change(run, ChangeKind.INPUT_CHANGED, "", "its files are others than before; compared with them")
            )
            found += [*_losses(run, last), *_quality(run, last, settings)]
        elif same is None:
            why = "pose or thresholds are others than before" if earlier else "there is no earlier night with it"
            found.append(_change(run, ChangeKind.NEW_SERIES, "", f"scenario {run.scenario}: {why}"))
        else:
            found += _quality(run, same, settings)
            found += _timing(run, same, settings) if same_machine else ()
    if complete:
        missing = [earlier[0] for place, earlier in before.items() if place not in tonight and earlier]
        found += [
            _change(run, ChangeKind.GONE, "", "an earlier night had it, this one has no such run") for run in missing
        ]
    order = list(ChangeKind)
    return tuple(sorted(found, key=lambda change: (order.index(change.kind), not change.gate)))


def counts(changes: Iterable[Change]) -> dict[str, int]:
    """Return how many changes there are of each class, classes without any included."""
    found = Counter(change.kind for change in changes)
    return {kind.value: found.get(kind, 0) for kind in ChangeKind}


_VERDICTS = ("pass", "warn", "fail")


def _losses(run: Run, last: Run) -> Iterator[Change]:
    """What a changed input must not lose: its verdict and its joints."""
    if {run.status, last.status} <= {*_VERDICTS} and _VERDICTS.index(run.status) > _VERDICTS.index(last.status):
        yield _change(run, ChangeKind.WORSE, "verdict", f"from {last.status} to {run.status}", gate=True)
    before, now = last.values.get(JOINTS), run.values.get(JOINTS)
    if before is not None and now is not None and now < before:
        yield _change(run, ChangeKind.WORSE, JOINTS, f"from {before:.0f} to {now:.0f}", gate=True)


def _quality(run: Run, same: Run, settings: NightlySettings) -> Iterator[Change]:
    if not run.answered:
        kind = ChangeKind.NEWLY_SKIPPED if same.answered else ChangeKind.STILL_FAILING
        gate = same.answered and settings.gate_newly_skipped
        yield _change(run, kind, "", f"{run.status}: {run.message}", gate=gate)
        return
    old = {problem.id: problem for problem in same.problems}
    now = {problem.id: problem for problem in run.problems}
    for name, problem in now.items():
        known = name in old or not same.answered
        kind = ChangeKind.STILL_FAILING if known else ChangeKind.NEW
        gate = kind is ChangeKind.NEW and problem.severity in settings.gate_severities
        yield _change(run, kind, name, f"{problem.severity}: {problem.text}", gate=gate)
    for name, problem in old.items():
        # What a check that no longer runs has found is not fixed; the check is reported as skipped below.
        if name not in now and problem.check not in run.not_run:
            yield _change(run, ChangeKind.FIXED, name, f"It was: {problem.text}")
    if same.answered:
        for check in sorted(run.not_run.keys() - same.not_run.keys()):
            yield _change(run, ChangeKind.NEWLY_SKIPPED, check, run.not_run[check], gate=settings.gate_newly_skipped)
    yield from _metrics(run, same, settings)


def _metrics(run: Run, same: Run, settings: NightlySettings) -> Iterator[Change]:
    for metric, slack in settings.gates.model_dump().items():
        before, now = same.values.get(metric), run.values.get(metric)
        if before is None or now is None:
            continue
        worse = before - now if metric in (*MORE_IS_BETTER, AS_LOADED, OPENED) else now - before
        if abs(worse) > slack:
            unit = f" {UNITS[metric]}" if metric in UNITS else ""
            text = f"from {before:.4g} to {now:.4g}{unit}"
            yield _change(run, ChangeKind.WORSE if worse > 0.0 else ChangeKind.BETTER, metric, text, gate=worse > 0.0)


def _timing(run: Run, same: Run, settings: NightlySettings) -> Iterator[Change]:
    if not (run.answered and same.answered) or abs(run.seconds - same.seconds) < settings.slower_seconds:
        return
    text = f"from {same.seconds:.1f} s to {run.seconds:.1f} s"
    if run.seconds > settings.slower * same.seconds:
        yield _change(run, ChangeKind.SLOWER, "seconds", text)
    elif same.seconds > settings.slower * run.seconds:
        yield _change(run, ChangeKind.FASTER, "seconds", text)


def _change(run: Run, kind: ChangeKind, subject: str, text: str, *, gate: bool = False) -> Change:
    return Change(kind=kind, object=run.object, what=run.what, case=run.case, subject=subject, text=text, gate=gate)
