"""Does a sentence become what it says?

Right: everything that a reader expects of the sentence holds of what was built, or what nobody can build is refused, or
is listed and ends with 1. Listed: the object is built, and what does not hold of it is listed as not as asked, or its
words as not read. Refused: nothing is built. Silently wrong: an expectation is not met and nothing is listed.
Objects are measured. Expectations were written for the grammar that the reader replaced, and call parts as it did; the
lists are of its time and were seen while the reader was written.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from benchmarks.expectations import GROUPS, SETS, broken_expectations, load_sentences
from benchmarks.study import Options, Study, explained
from kinematify.errors import InputError
from kinematify.evaluation.result_record import grouped, table
from kinematify.generate.reader import read_sentence

if TYPE_CHECKING:
    from collections.abc import Mapping

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report

RIGHT, LISTED, REFUSED, WRONG = "right", "listed", "refused", "silently wrong"
CAME = (RIGHT, LISTED, REFUSED, WRONG)


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
    cannot_be = bool(item.get("impossible") or "refuse" in item)
    try:
        made = read_sentence(item["text"]).made()
    except InputError as error:
        return {"text": item["text"], "came": RIGHT if cannot_be else REFUSED, "why": str(error)}
    listed = "; ".join([*made.differences, *made.unread])
    closed = made.blueprint.moved({joint.child: -joint.value for joint in made.blueprint.joints})
    broken = [] if cannot_be and listed else broken_expectations(item, made.blueprint, closed)
    came = RIGHT if not broken else LISTED if listed else WRONG
    return {"text": item["text"], "came": came, "why": "; ".join(broken), "listed": listed}


def report(found: Report[Record]) -> list[str]:
    """Counts by group of lists, and what is silently wrong."""
    rows = []
    for name, records in grouped(found.records, by=lambda record: GROUPS[str(record["set"])]).items():
        counts = Counter(record["came"] for record in records)
        rows.append((name, str(len(records)), *(str(counts[what]) for what in CAME)))
    wrong = [f"- {fault}" for fault in faults(found)]
    return [
        explained(__doc__),
        table(("sentences", "number", *CAME), rows),
        "\n".join(["Silently wrong:", "", *wrong]) if wrong else "",
    ]


def faults(found: Report[Record]) -> list[str]:
    """Sentences that became something else."""
    return [f"{record['text']!r}: {record['why']}" for record in found.records if record["came"] == WRONG]


STUDY = Study(
    title="What becomes of sentences", options=SentencesOptions, measure=measure, report=report, faults=faults
)
