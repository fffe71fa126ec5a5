"""Does a sentence become what it says?

Right: everything that a reader expects of the sentence holds of what was built, or what nobody can build is refused
(where words are named, by these words). Listed: the object is built, and each expectation that it does not meet is
listed as not built. Refused: nothing is built. Silently wrong: an expectation is not met and nothing says so, or
something impossible is built. Objects are measured; what was understood does not count. Expectations were written
before the parser saw the sentences. Each list was tried once before it was looked at; words and objects were added
after that.
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


def first_tries() -> list[tuple[str, ...]]:
    """What came of each list when it was tried for the first time, as rows of a table."""
    said = yaml.safe_load(_FIRST.read_text(encoding="utf-8"))
    return [(SETS[facts.get("list", name)], facts["code"], *map(str, facts["counts"])) for name, facts in said.items()]


def report(found: Report[Record]) -> list[str]:
    """Counts by list, and every sentence of the new ones, and of the others what is not right."""
    rows = []
    groups = grouped(found.records, by=lambda record: str(record["set"]))
    for name, group in groups.items():
        counts = Counter(record["came"] for record in group)
        rows.append((SETS[name], str(len(group)), *(str(counts[came]) for came in CAME)))
    blocks = [
        explained(__doc__),
        "## First tries",
        table(("sentences", "code", "number", *CAME), first_tries()),
        "## Now, all of them seen",
        table(("sentences", "number", *CAME), rows),
    ]
    for name, group in groups.items():
        shown = [record for record in group if record["came"] != RIGHT or name != "written"]
        lines = [
            (record["text"], record["came"], record["why"].split(". ", maxsplit=1)[0].replace("|", "\\|"))
            for record in shown
        ]
        blocks += [f"## {SETS[name].capitalize()}", table(("sentence", "came out", "why"), lines) or "All right."]
    return blocks


def faults(found: Report[Record]) -> list[str]:
    """Sentences that became something else."""
    return [f"{record['text']!r}: {record['why']}" for record in found.records if record["came"] == WRONG]


STUDY = Study(
    title="What becomes of sentences", options=SentencesOptions, measure=measure, report=report, faults=faults
)
