"""Does a sentence become what it says?

Right: everything that a reader expects of the sentence holds of what was built, or a sentence that nobody can build is
refused by the words that are at fault. Refused: told that it cannot be built, with the words. Wrong: something else is
built, or a senseless sentence is refused without naming its words. What was built is looked at, not what was
understood; expectations were written before the parser saw the sentences. Of the new ones 53 came out right, 44
refused and 3 wrong when they were first tried; of sixty more 38 came out right, 19 refused, and 3 wrong by what was
expected of their names; of sixty in the styles of visitors 21 came out right and 39 refused; of sixty of people who
walk in, at random objects, 15 came out right, 44 refused and 1 wrong; of sixty more of them 36 came out right, 23
refused and 1 wrong when they were first tried, after the objects were added that files describe. Who wrote these last
ones added the objects, too. Of their 36 a person who looks would call four something else than was meant: a tilting
umbrella of which only the ribs tilt, a cabinet on wheels with two, a double oven of two ovens side by side, sliding
doors one above the other. Of sixty more, written before the parser was opened again, 17 came out right, 41 refused and
2 wrong by what was expected of a name and a height; then grammar, words and mechanisms were widened, and of the last
sixty 18 came out right, 41 refused and 1 wrong by what was expected of its joint. Of these 18 a person would call two
something else than was meant: a kitchen scale with two pans, a handle on top that was to be at the side. Words and
bodies were added since each of these, with the sentences known; after those sixty toys, displays and locks, and
doors that roll up. Sixty more were written before 59 objects were added that files describe: tried once after that, 30
came out right, 29 refused and 1 wrong by what was expected of a name (the crank of a hose reel, which was one part with
the drum). Their author added the objects, too, from a list of common things; 5 of the 30 rest on these. A person would
call four of the 30 something else than was meant: a folding bus door that swings, a garden gate like a room's door,
hedge shears like paper scissors, a shower like a wardrobe. Ten more objects were added with these sentences known,
and one expectation was changed (a garlic press has two pivots, as an older list says).
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from benchmarks.expectations import SETS, broken_expectations, load_sentences
from benchmarks.study import Options, Study, explained
from kinematify.errors import InputError
from kinematify.evaluation.record import grouped, table
from kinematify.generate.request import from_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.record import Report

RIGHT, REFUSED, WRONG = "right", "refused", "wrong"


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
        request = from_text(item["text"])
        made = request.build()
    except InputError as error:
        said = str(error)
        if item.get("impossible"):
            return {"text": item["text"], "came": RIGHT, "why": said}
        if "refuse" not in item:
            return {"text": item["text"], "came": REFUSED, "why": said}
        missing = [word for word in item["refuse"] if word.lower() not in said.lower()]
        return {
            "text": item["text"],
            "came": WRONG if missing else RIGHT,
            "why": f"the refusal does not name {', '.join(missing)}: {said}" if missing else said,
        }
    closed = made.moved({joint.child: -joint.value for joint in made.joints})
    broken = broken_expectations(item, made, closed)
    return {"text": item["text"], "came": WRONG if broken else RIGHT, "why": "; ".join(broken)}


def report(found: Report[Record]) -> list[str]:
    """Counts by list, and every sentence of the new ones, and of the others what is not right."""
    rows = []
    groups = grouped(found.records, by=lambda record: str(record["set"]))
    for name, group in groups.items():
        counts = Counter(record["came"] for record in group)
        rows.append((SETS[name], str(len(group)), *(str(counts[came]) for came in (RIGHT, REFUSED, WRONG))))
    blocks = [explained(__doc__), table(("sentences", "number", RIGHT, REFUSED, WRONG), rows)]
    for name, group in groups.items():
        shown = [record for record in group if record["came"] != RIGHT or name != "written"]
        lines = [(record["text"], record["came"], _first(record["why"])) for record in shown]
        blocks += [f"## {SETS[name].capitalize()}", table(("sentence", "came out", "why"), lines) or "All right."]
    return blocks


def _first(said: str) -> str:
    """The first sentence of a message, fit for a cell."""
    return said.split(". ", maxsplit=1)[0].replace("|", "\\|")


def faults(found: Report[Record]) -> list[str]:
    """Sentences that became something else."""
    return [f"{record['text']!r}: {record['why']}" for record in found.records if record["came"] == WRONG]


STUDY = Study(
    title="What becomes of sentences", options=SentencesOptions, measure=measure, report=report, faults=faults
)
