"""Differences from another night, in classes: quality can fail a night, timing is only reported."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter

from kinematify.evaluation.nightly.runs import GATES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from kinematify.evaluation.nightly.runs import Run

_UNITS = {"angle_deg": " deg", "line_m": " m"}
_SLOWER, _SECONDS = 1.5, 1.0  # shared machines vary by a third


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
GOOD = (ChangeKind.FIXED, ChangeKind.BETTER)


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


@dataclass(frozen=True, kw_only=True)
class Night:
    """A night that is over."""

    name: str
    """``<date>-<commit>``, numbered where one commit was run twice on a day."""
    header: dict[str, Any]
    """Commit, machine, versions, configuration, what it was compared with and the verdict."""
    runs: tuple[Run, ...]
    changes: tuple[Change, ...]

    @property
    def gate(self) -> str:
        """``fail`` where quality became worse, else ``pass``."""
        return "fail" if any(change.gate for change in self.changes) else "pass"


def compare(
    runs: Iterable[Run],
    before: Mapping[tuple[str, str, str], Sequence[Run]],
    *,
    same_machine: bool,
    complete: bool = True,
) -> tuple[Change, ...]:
    """Compare each run with the latest earlier one of the same scenario.

    Args:
        runs: Those of the night to judge.
        before: Earlier runs of each place, the latest first.
        same_machine: Whether times may be compared.
        complete: Whether a run that is missing is reported as gone.

    Returns:
        Changes in the order of the classes, those that fail the night first within a class.
    """
    tonight = {run.place: run for run in runs}
    found: list[Change] = []
    for place, run in tonight.items():
        same = next((other for other in before.get(place, ()) if other.scenario == run.scenario), None)
        if same is None:
            found.append(_change(run, ChangeKind.NEW_SERIES, "", "there is no earlier run of this scenario"))
            continue
        if same.content != run.content:
            found.append(_change(run, ChangeKind.INPUT_CHANGED, "", "its files are others than before"))
        elif same_machine:
            found += _timing(run, same)
        found += _quality(run, same)
    if complete:
        gone = [earlier[0] for place, earlier in before.items() if place not in tonight and earlier]
        found += [_change(run, ChangeKind.GONE, "", "this night has no such run") for run in gone]
    order = list(ChangeKind)
    return tuple(sorted(found, key=lambda change: (order.index(change.kind), not change.gate)))


def counts(changes: Iterable[Change]) -> dict[str, int]:
    """Return how many changes there are of each class, classes without any included."""
    found = Counter(change.kind for change in changes)
    return {kind.value: found.get(kind, 0) for kind in ChangeKind}


def _quality(run: Run, same: Run) -> Iterator[Change]:
    if not run.answered:
        kind = ChangeKind.NEWLY_SKIPPED if same.answered else ChangeKind.STILL_FAILING
        yield _change(run, kind, "", f"{run.status}: {run.message}", gate=same.answered)
        return
    old = {problem.id: problem for problem in same.problems}
    now = {problem.id: problem for problem in run.problems}
    for name, problem in now.items():
        kind = ChangeKind.STILL_FAILING if name in old or not same.answered else ChangeKind.NEW
        gate = kind is ChangeKind.NEW and problem.severity == "error"  # new warnings are listed
        yield _change(run, kind, name, f"{problem.severity}: {problem.text}", gate=gate)
    for name, problem in old.items():
        # What a check that no longer runs has found is not fixed; the check is reported as skipped below.
        if name not in now and problem.check not in run.not_run:
            yield _change(run, ChangeKind.FIXED, name, f"It was: {problem.text}")
    if same.answered:
        for check in sorted(run.not_run.keys() - same.not_run.keys()):
            yield _change(run, ChangeKind.NEWLY_SKIPPED, check, run.not_run[check], gate=True)
    for metric, (more, slack) in GATES.items():
        before, after = same.values.get(metric), run.values.get(metric)
        if before is not None and after is not None and abs(after - before) > slack:
            worse = more * (before - after) > 0.0
            text = f"from {before:.4g} to {after:.4g}{_UNITS.get(metric, '')}"
            yield _change(run, ChangeKind.WORSE if worse else ChangeKind.BETTER, metric, text, gate=worse)


def _timing(run: Run, same: Run) -> Iterator[Change]:
    slow, fast = max(run.seconds, same.seconds), min(run.seconds, same.seconds)
    if run.answered and same.answered and slow - fast >= _SECONDS and slow > _SLOWER * fast:
        kind = ChangeKind.SLOWER if run.seconds == slow else ChangeKind.FASTER
        yield _change(run, kind, "seconds", f"from {same.seconds:.1f} s to {run.seconds:.1f} s")


def _change(run: Run, kind: ChangeKind, subject: str, text: str, *, gate: bool = False) -> Change:
    return Change(kind=kind, object=run.object, what=run.what, case=run.case, subject=subject, text=text, gate=gate)
