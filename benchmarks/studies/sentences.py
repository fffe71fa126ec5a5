"""Does a sentence become what it says?

Right: everything that a reader expects of the sentence holds of what was built, or what nobody can build is refused
(where words are named, by these words). Listed: the object is built, and each expectation that it does not meet is
listed as not built. Refused: nothing is built. Silently wrong: an expectation is not met and nothing says so, or
something impossible is built. Objects are measured; what was understood does not count. Expectations were written
before the parser saw the sentences. Each list was tried once before it was looked at; words and objects were added
after that, so only the column "first try" is held-out.

At the first try 11 to 38 of 60 were right in the early lists, whose other nouns were refused; of the last one 27 of 40.
What is not right moved from refused to listed: the object is built, and what it lacks is said. Silently wrong at the
first try were up to 10 of 60 once objects were composed, and 2 to 7 of 40 since. Lists written without sight of the
library are harder than those written beside it.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from benchmarks.expectations import SETS, broken_expectations, is_listed, load_sentences
from benchmarks.study import Options, Study, explained
from kinematify.errors import InputError
from kinematify.evaluation.result_record import grouped, table
from kinematify.generate.sentence import from_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report

RIGHT, LISTED, REFUSED, WRONG = "right", "listed", "refused", "silently wrong"
CAME = (RIGHT, LISTED, REFUSED, WRONG)

_FIRST = Path(__file__).parent.with_name("sentences") / "first_tries.yaml"


class SentencesOptions(Options):
    """All sentences, always."""


@dataclass(frozen=True, kw_only=True)
class Sentences:
    """One list of sentences."""

    name: str
    items: tuple[Mapping[str, Any], ...]


def measure(options: SentencesOptions, work: Work) -> Measured:
    """Build every sentence of every list."""
    asked = {name: Sentences(name=name, items=tuple(load_sentences(name))) for name in SETS}
    records = [record for answer in work.each(built, asked).values() for record in answer["sentences"]]
    return records, {}


def built(asked: Sentences) -> Record:
    """Build the sentences of one list."""
    return {"sentences": [{"set": asked.name, **outcome(item)} for item in asked.items]}


def outcome(item: Mapping[str, Any]) -> Record:
    """What came of one sentence, and why it is not right."""
    try:
        made = from_text(item["text"]).made()
    except InputError as error:
        said = str(error)
        if item.get("impossible"):
            return {"text": item["text"], "came": RIGHT, "why": said}
        if "refuse" not in item:
            return {"text": item["text"], "came": REFUSED, "why": said}
        missing = _unnamed(item, said)
        why = f"the refusal does not name {', '.join(missing)}: {said}" if missing else said
        return {"text": item["text"], "came": WRONG if missing else RIGHT, "why": why}
    listed = "; ".join(made.not_built)
    if "refuse" in item and not _unnamed(item, listed):
        return {"text": item["text"], "came": LISTED, "why": f"not built: {listed}"}
    closed = made.blueprint.moved({joint.child: -joint.value for joint in made.blueprint.joints})
    broken = broken_expectations(item, made.blueprint, closed)
    silent = [why for why in broken if not is_listed(why, listed, item)]
    came = WRONG if silent else LISTED if broken else RIGHT
    return {"text": item["text"], "came": came, "why": "; ".join(broken), "not_built": listed}


def _unnamed(item: Mapping[str, Any], said: str) -> list[str]:
    return [word for word in item["refuse"] if word.lower() not in said.lower()]


def first_tries() -> dict[str, str]:
    """List -> what came of it when it was tried for the first time, before anything was added because of it."""
    said = yaml.safe_load(_FIRST.read_text(encoding="utf-8"))
    return {name: " / ".join(map(str, counts[1:])) for name, counts in said.items()}


def report(found: Report[Record]) -> list[str]:
    """Counts by list, now and at the first try, and what is silently wrong."""
    came = Counter(record["came"] for record in found.records)
    groups, first = grouped(found.records, by=lambda record: str(record["set"])), first_tries()
    rows = []
    for name, group in groups.items():
        counts = Counter(record["came"] for record in group)
        now = " / ".join(str(counts[what]) for what in CAME)
        rows.append((SETS[name], str(len(group)), first.get(name, "not recorded"), now))
    wrong = [f"- {fault.partition('. ')[0]}" for fault in faults(found)]
    return [
        explained(__doc__),
        f"Counts are {' / '.join(CAME)}. Now, all of them seen: {' / '.join(str(came[what]) for what in CAME)}.",
        table(("sentences", "number", "first try", "now"), rows),
        "\n".join(["Silently wrong now:", "", *wrong]) if wrong else "",
    ]


def faults(found: Report[Record]) -> list[str]:
    """Sentences that became something else."""
    return [f"{record['text']!r}: {record['why']}" for record in found.records if record["came"] == WRONG]


STUDY = Study(
    title="What becomes of sentences", options=SentencesOptions, measure=measure, report=report, faults=faults
)
