"""The registry of checks: each is one function, and all that describes it is at that function.

    @check(
        "KV222",
        title="Zero lies within the limits",
        fails="Zero lies outside the limits",
        severity=Severity.NOTE,
        cause=Cause.KINEMATICS,
    )
    def zero_outside(result: OpenCheck, physics: Physics) -> None:
        '''Zero is a value that the joint may take.

        Why it matters: Engines and viewers start at zero, which is then outside the limits.

        Remedy: Start from a configuration within the limits.
        '''

`kinematify explain`, `docs/checks.md`, the rules of SARIF, the plan of a run and the feedback of `kinematify refine`
are made from it. The functions stand in `validation/checks`; reading them loads no engine.
"""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from kinematify.simulation.engines import ENGINES
from kinematify.validation.finding import Observation, Severity, Status, not_finished

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.simulation.engines import EngineEntry
    from kinematify.validation.finding import Cause
    from kinematify.validation.validated_file import ValidatedFile

    CheckFunction = Callable[["OpenCheck", Any], None]
    EngineChoice = Callable[[EngineEntry], bool]
    Need = Callable[[Any], str | None]

FAMILIES = {
    "KV1": "file and tree",
    "KV2": "declared physics",
    "KV3": "kinematics by geometry",
    "KV7": "task of a robot",
    "KV8": "file as loaded",
}
"""Title of each family, keyed by the beginning of its ids."""
_NOT_OURS = ("KV1", "KV2", "KV8")
"""Families whose findings no choice of a joint can fix."""


class FeedbackRow(StrEnum):
    """Reaction of `kinematify refine` to a finding, a row of the table in `validation/run/feedback.py`."""

    AS_GIVEN = "none: the overlap is as given, no axis is the cause"
    INTO_PARENT = "against this line, this type and this parent; if one side is free, it is the opening one"
    END = "the range ends there"
    OTHER_PARENT = "against the parent of what runs into another body, for that body"
    NOT_CARRIED = "against this parent"
    DERAILED = "against this line, this type and this parent; a slide ends before"
    GUIDE = "the range ends before"
    EXPORTER = "none: files, frames or masses are for the exporter to fix"


class CauseScope(StrEnum):
    """Subject that a cause and what follows from it must both be about."""

    MODEL = "the model"
    BODY = "a body in common"
    PAIR = "the same two bodies"
    CONTACT = "the same two bodies, or the same engine where what follows names none"
    JOINT = "the same joint"


@dataclass(frozen=True, kw_only=True)
class Check:
    """A check with its documentation; ids are stable for ever."""

    id: str
    """``KVnnn``; the first digit is the family."""
    title: str
    """A few words that are true where it passes, as in a table."""
    fails: str
    """A few words that are true where it finds something."""
    severity: Severity
    """The worst that it reports, and what it reports where nothing else is said."""
    cause: Cause
    """The usual cause."""
    runs_in: EngineChoice | None = None
    """Says of an engine whether it is asked; None: no engine is."""
    guard: bool = False
    """After an error of it nothing else is asked of its subject."""
    verifies: str
    """What is looked at and what counts as wrong, thresholds by their setting's name."""
    matters: str
    """What goes wrong in practice if it is ignored."""
    remedy: str
    """How to fix it."""
    feedback: FeedbackRow | None = None
    """What refinement makes of its findings; None if nothing."""
    doubts: bool = False
    """Its findings put axis, place, type, parent or direction of a joint in doubt; a robot's task wants to know."""
    follows: Mapping[str, CauseScope] = field(default_factory=dict)
    """Checks whose findings can be the cause of its own, and what both must be about; the first that fits is taken."""
    needs: tuple[Need, ...] = ()
    """Asked before it runs, with the context: each gives the reason why there is nothing to look at, or None."""
    function: CheckFunction
    """Looks at its subject and adds findings to the open check."""

    @property
    def engines(self) -> tuple[str, ...]:
        """Engines that it runs in; empty: none."""
        return tuple(name for name, entry in ENGINES.items() if self.runs_in is not None and self.runs_in(entry))

    @property
    def subject(self) -> str:
        """Class of its second argument: the thing that it looks at, which `validation/run/needs.py` makes."""
        _, subject, *_ = self.function.__annotations__.values()
        return str(subject)

    def run(self, result: OpenCheck, context: Any) -> None:
        """Look at a context and add what is found, or say why there is nothing to look at."""
        reason = next((reason for need in self.needs if (reason := need(context)) is not None), None)
        if reason is not None:
            result.skip(reason)
        else:
            self.function(result, context)


REGISTRY: dict[str, Check] = {}
"""Checks keyed by id, in the order in which their modules were read; `validation.checks.CHECKS` has all of them."""


@dataclass(kw_only=True)
class OpenCheck:
    """A check that is under way: findings are added to it, its status follows from them."""

    id: str
    engine: str | None
    source: ValidatedFile | None = None
    """The file, which is written into its findings; None: there is none."""
    findings: list[Observation] = field(default_factory=list)
    measured: dict[str, float] = field(default_factory=dict)
    status: Status | None = None
    reason: str | None = None
    is_fatal: bool = False
    """True after an error that forbids later stages to read the file."""

    def find(
        self,
        message: str,
        remedy: str,
        *,
        severity: Severity | None = None,
        cause: Cause | None = None,
        joint: str | None = None,
        link: str | None = None,
        pair: tuple[str, str] | None = None,
        engine: str | None = None,
        q: dict[str, float] | None = None,
        value: float | None = None,
        limit: float | None = None,
        unit: str | None = None,
        line: int | None = None,
        reproduction: str | None = None,
        harmless: bool = False,
    ) -> None:
        """Add a finding.

        Severity, cause and engine are the check's unless given, see `Observation` for the rest; `harmless` is for an
        error after which later stages may read the file all the same.
        """
        check = REGISTRY[self.id]
        names = [name for name in (joint, link, *(pair or ())) if name is not None]
        message, remedy = (_with_numbers_quoted(text, names) for text in (message, remedy))
        self.is_fatal |= (severity or check.severity) is Severity.ERROR and not harmless
        finding = Observation(
            check=self.id,
            severity=severity or check.severity,
            cause=cause or check.cause,
            message=message,
            remedy=remedy,
            joint=joint,
            link=link,
            pair=pair,
            engine=engine or self.engine,
            q=q,
            value=None if value is None else float(value),
            limit=None if limit is None else float(limit),
            unit=unit,
            line=line,
            reproduction=reproduction or None,
        )
        stated = finding if self.source is None else self.source.in_source(finding)
        self.findings += () if stated is None else (stated,)

    def skip(self, reason: str) -> None:
        """Say that it does not apply."""
        self.status, self.reason = Status.SKIPPED, reason

    def leave(self, what: str) -> None:
        """Say what time ran out for; what was found before stands."""
        self.skip(not_finished(f"time ran out before {what}"))

    def block(self, reason: str) -> None:
        """Say that an earlier failure keeps it from running."""
        self.status, self.reason = Status.BLOCKED, reason


_BEFORE_NAME = r"(?:^|\b(?:[Jj]oints?|[Ll]inks?|[Mm]oving|[Ww]hile|of|and|If|Give) )"
_UNIT = r"(?![\w.]| ?(?:mm|m|rad|deg|kg|N|J|s|%|times|joints|links|to)\b)"


def _with_numbers_quoted(text: str, names: Sequence[str]) -> str:
    """Return a text with names in quotes that are numbers, so that nobody takes them for values."""
    for name in {name for name in names if name.isdecimal()}:
        text = re.sub(rf"({_BEFORE_NAME}){name}{_UNIT}", rf"\g<1>'{name}'", text)
    return text


def check(
    id: str,
    *,
    title: str,
    fails: str,
    severity: Severity,
    cause: Cause,
    runs_in: EngineChoice | None = None,
    guard: bool = False,
    feedback: FeedbackRow | None = None,
    doubts: bool = False,
    follows: Mapping[str, CauseScope] | None = None,
    needs: tuple[Need, ...] = (),
) -> Callable[[CheckFunction], CheckFunction]:
    """Register the decorated function as a check; see `Check` for the arguments.

    The function is called with the open check and what it looks at, and adds findings to the former. Its
    docstring has three paragraphs: what it verifies, ``Why it matters: ...`` and ``Remedy: ...``.
    """

    def register(function: CheckFunction) -> CheckFunction:
        assert id not in REGISTRY, f"{id} is at two functions"
        verifies, matters, remedy = _documentation(id, function)
        REGISTRY[id] = Check(
            id=id,
            title=title,
            fails=fails,
            severity=severity,
            cause=cause,
            runs_in=runs_in,
            guard=guard,
            feedback=feedback or (FeedbackRow.EXPORTER if id.startswith(_NOT_OURS) else None),
            doubts=doubts,
            follows=follows or {},
            needs=needs,
            function=function,
            verifies=verifies,
            matters=matters,
            remedy=remedy,
        )
        return function

    return register


def _documentation(id: str, function: CheckFunction) -> tuple[str, str, str]:
    """Split a docstring into what a check verifies, why that matters, and the remedy."""
    paragraphs = [" ".join(part.split()) for part in inspect.cleandoc(function.__doc__ or "").split("\n\n")]
    verifies, named = paragraphs[0], dict(part.partition(": ")[::2] for part in paragraphs[1:])
    assert verifies, f"{id}: its docstring must say what it verifies"
    assert set(named) == {"Why it matters", "Remedy"}, (
        f"{id}: after what it verifies, its docstring must have the paragraphs `Why it matters: ...` and "
        f"`Remedy: ...`, not {', '.join(named) or 'nothing'}"
    )
    return verifies, named["Why it matters"], named["Remedy"]
