"""What are answers about joints worth: recorded ones of a strong model, and those of simulated voters?

Objects are inferred at rest from their parts alone. Counted are joints between the right two parts: wrong ones (type,
direction by more than 5 deg, or line by more than 5 % of the object's diagonal) that an answer repairs, and right
ones that it spoils, congruent parts that follow an answer included. Only the questions that `--vlm` asks by default
are counted, unless a row says *all answers*. Recorded answers were given to the pictures and the text of the question
alone. Objects are split into halves by a hash of their names; what a voter's record says is measured on one half and
used on the other (*held-out*), on questions about generated objects (*known objects*, as `kinematify infer` does), or
on all answers (*in-sample*). A simulated voter is right in a stated share of its answers and takes any other choice
else; its record is ten simulated questions about known objects, as `kinematify infer` asks them once for each model.
Answers with a confidence below `vision.least_confidence` count as unsure; that bound was chosen with all recorded
answers in sight, and so were the other settings of the prior. The older form of question asked for type, direction
and side in words; where these name motions among the options, they count as a choice of all of them.
"""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import Field

from benchmarks.study import Options, Study, explained
from kinematify.config import load_config
from kinematify.evaluation.benchmark_job import erased_item, shown_parts
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, bench_folder, find_objects, matching
from kinematify.evaluation.metrics import CLOSE_ANGLE, axis_angle, axis_line_distance
from kinematify.evaluation.result_record import grouped, table
from kinematify.joints.candidate import JointCandidate
from kinematify.pipeline.infer_assembly import infer
from kinematify.robot.joint_type import JointType
from kinematify.vision.motion_options import look_alike, offered
from kinematify.vision.votes import (
    VoterRecord,
    groups,
    map_to_congruent_part,
    place_of_choice,
    posterior,
    prior,
    to_ask,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.assembly.erasure import ErasedModel
    from kinematify.assembly.part import Part
    from kinematify.config import VisionConfig
    from kinematify.evaluation.result_record import Report
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.arrays import BoolArray

ANSWERS = Path(__file__).resolve().parents[1] / "voters"
_SETS = ("articraft", "everyday", "everyday2", "infinigen")
_CLOSE_LINE = 0.05
_SCREENED = 10  # questions about known objects
_PICKS, _WORDS = "picks", "words"
VOTERS: Mapping[str, float | None] = {"at chance": None, "right in 60 %": 0.6, "right in 90 %": 0.9}


class VoterOptions(Options):
    """Which objects, and whose answers."""

    answers: str = Field(str(ANSWERS.name), description="Folder of recorded answers; a name is one of benchmarks/.")
    sets: tuple[str, ...] = Field(_SETS, description="Folders of the benchmark.")
    objects: tuple[str, ...] = Field(("answered",), description="Names or patterns; answered: those with answers.")
    draws: int = Field(200, ge=1, description="How often each simulated voter is drawn.")
    seed: int = Field(0, description="Draws the answers of simulated voters.")


@dataclass(frozen=True, kw_only=True)
class AskedObject:
    """One object with the answers about it."""

    item: BenchObject
    set: str
    answers: str
    """As JSON, so that an earlier record is taken up only where they are the same."""


def measure(options: VoterOptions, work: Work) -> Measured:
    """Infer every object and lay the answers beside the options of its joints."""
    recorded = recorded_answers(options.answers)
    by_object = grouped(recorded, by=lambda answer: answer["object"])
    asked = {}
    for name in options.sets:
        found = find_objects(bench_folder() / name)
        if options.objects != ("answered",):
            found = matching(found, options.objects)
        for item in found:
            if item.name in by_object or options.objects != ("answered",):
                own = json.dumps(by_object.get(item.name, []), sort_keys=True)
                asked[f"{name}, {item.name}"] = AskedObject(item=item, set=name, answers=own)
    records = [row for found in work.each(judged_object, asked, timeout=900.0).values() for row in found["joints"]]
    least = load_config().vision.least_confidence
    screened = [answer for answer in recorded if answer["object"] == "screening" and answer["confidence"] >= least]
    return records, {"screening": [sum(answer["right"] for answer in screened), len(screened)]}


def recorded_answers(folder: str) -> list[Record]:
    """All answers of a folder, each with its object, form, model and date."""
    given = Path(folder)
    path = given if given.is_dir() else ANSWERS.parent / folder
    found: list[Record] = []
    for file in sorted(path.glob("*.json")):
        content = json.loads(file.read_text(encoding="utf-8"))
        about = {key: content[key] for key in ("model", "date", "form")}
        found += [{**about, **answer} for answer in content["answers"]]
    return found


def judged_object(asked: AskedObject) -> Record:
    """Every joint of one object that hangs on the right part: what is right, how likely, and what answers name."""
    erased = erased_item(asked.item, CONDITIONS[0])
    inference = infer(shown_parts(erased), config=load_config())
    return {"joints": judged_joints(erased, inference, json.loads(asked.answers), asked.item.name, asked.set)}


def judged_joints(
    erased: ErasedModel, inference: Inference, answers: Sequence[Record], name: str, folder: str
) -> list[Record]:
    """The joints of an inference as records; see `judged_object`."""
    config, parts = inference.config.vision, inference.assembly.parts
    options = [offered(joint, parts[joint.child], config) for joint in inference.joints]
    asked, _ = to_ask(inference)
    source = {other: place for place in asked for group in groups(inference) if place in group for other in group}
    source |= {place: place for place in asked}
    rows = []
    for place, joint in enumerate(inference.joints):
        right = right_options(erased, inference, place, options[place])
        chosen = place_of_choice(joint, options[place])
        if right is None or chosen is None:
            continue
        origin = source.get(place)
        rows.append({
            "set": folder, "object": name, "joint": place, "child": parts[joint.child].name,
            "confidence": joint.confidence, "right": right, "chosen": chosen, "source": origin,
            "prior": prior(joint, options[place], config).tolist(),
            "follows": None if origin is None else _follows(inference, options, origin, place),
            "answers": {
                form: _named(erased, inference, options, place, [a for a in answers if a["form"] == form])
                for form in (_PICKS, _WORDS)
            },
        })  # fmt: skip
    return rows


def right_options(
    erased: ErasedModel, inference: Inference, place: int, options: Sequence[JointCandidate]
) -> list[bool] | None:
    """Which options, and being fixed, are the true joint; None where no joint is between the two parts."""
    joint, names = inference.joints[place], inference.assembly.names
    index = {part: number for number, part in enumerate(erased.truth.part_names)}
    ends = index[names[joint.parent]], index[names[joint.child]]
    true = [item for item in erased.truth.joints if (item.parent, item.child) == ends]
    if not true:
        return None
    near, allowed = inference.assembly.parts[joint.child].centroid, _CLOSE_LINE * inference.assembly.diagonal

    def is_right(option: JointCandidate) -> bool:
        return any(
            item.kind.turns == option.kind.turns and axis_angle(item.axis, option.axis) <= CLOSE_ANGLE
            and (not option.kind.turns or axis_line_distance(
                true_axis=item.axis, true_pivot=item.pivot, axis=option.axis, pivot=option.pivot, near=near,
            ) <= allowed)
            for item in true
        )  # fmt: skip

    return [*map(is_right, options), False]


def _follows(
    inference: Inference, options: Sequence[Sequence[JointCandidate]], origin: int, place: int
) -> list[list[bool]]:
    """For each option of the joint that is asked about, which options of another joint it names."""
    one, other = (inference.assembly.parts[inference.joints[k].child] for k in (origin, place))
    if origin == place:
        return [[a is b for b in options[place]] for a in options[origin]]
    return [[map_to_congruent_part(one, a, other, b) for b in options[place]] for a in options[origin]]


def _named(
    erased: ErasedModel,
    inference: Inference,
    options: Sequence[Sequence[JointCandidate]],
    place: int,
    answers: Sequence[Record],
) -> dict[str, Any] | None:
    """What the answer about a joint or a twin of it names, and whether it was given about the joint itself."""
    parts = inference.assembly.parts
    found: dict[int, Record] = {}
    for answer in answers:
        part = _part_of(erased, answer)
        found |= {k: answer for k, joint in enumerate(inference.joints) if parts[joint.child].name == part}
    mine = parts[inference.joints[place].child]
    for k in [place, *(k for group in groups(inference) if place in group for k in group if k != place)]:
        theirs = parts[inference.joints[k].child]
        choice = _choice(found[k], theirs, options[k], inference) if k in found else None
        if choice is None:
            continue
        mask, special = choice
        picked = [option for option, chosen in zip(options[k], mask, strict=True) if chosen]
        twin = [any(map_to_congruent_part(theirs, a, mine, b) for a in picked) for b in options[place]]
        return {"named": [*(mask if k == place else twin), *special], "own": k == place}
    return None


def _part_of(erased: ErasedModel, answer: Record) -> str:
    """Name of the part that an answer is about."""
    if "child" in answer:
        return str(answer["child"])
    joint = next((item for item in erased.truth.joints if item.source == answer["joint"]), None)
    return "" if joint is None else erased.truth.part_names[joint.child]


def _choice(
    answer: Record, part: Part, options: Sequence[JointCandidate], inference: Inference
) -> tuple[list[bool], list[bool]] | None:
    """Which options an answer names, and whether it says fixed, or none of them; None for an abstention."""
    config = inference.config.vision
    if answer["form"] == _WORDS:
        named = [said_in_words(answer["answer"], option, part) for option in options]
        return (named, [False, False]) if any(named) else None
    choice = str(answer["choice"])
    if answer["confidence"] < config.least_confidence:
        return None
    if choice in ("fixed", "none of these"):
        return [False] * len(options), [choice == "fixed", choice != "fixed"]
    if not choice.isdecimal():
        return None
    shown = answer["options"][int(choice) - 1]
    picked = JointCandidate(
        kind=JointType(shown["type"]),
        axis=np.array(shown["axis"]),
        pivot=np.array(shown["pivot"]),
        score=0.0,
        source="",
    )
    named = [look_alike(picked, option, part.diagonal, config) for option in options]
    return (named, [False, False]) if any(named) else None


_DIRECTIONS = ("sideways", "depth", "vertical")
_SIDES = (("left", "right"), ("front", "back"), ("bottom", "top"))
_OBLIQUE, _OFF_CENTER = 30.0, 0.2


def said_in_words(answer: Mapping[str, Mapping[str, Any]], option: JointCandidate, part: Part) -> bool:
    """Whether an answer of the older form, in words of somebody in front of the object, means an option."""
    kind, direction, side = (answer[key]["choice"] for key in ("type", "axis_direction", "hinge_side"))
    if kind in ("unsure", "fixed") or direction == "unsure" or (kind != "prismatic") != option.kind.turns:
        return False
    along = int(np.argmax(np.abs(option.axis)))
    if abs(float(option.axis[along])) < np.cos(np.radians(_OBLIQUE)) or _DIRECTIONS[along] != direction:
        return False
    if not option.kind.turns or side == "unsure":
        return True
    offset = option.pivot - part.bounds.mean(axis=0)
    offset = offset - float(offset @ option.axis) * option.axis
    across = int(np.argmax(np.abs(offset)))
    extent = max(float(np.ptp(part.bounds, axis=0)[across]), 1e-12)
    if abs(float(offset[across])) < _OFF_CENTER * extent:
        return bool(side == "middle")
    return bool(side == _SIDES[across][int(offset[across] > 0.0)])


def report(found: Report[Record]) -> list[str]:
    """Recorded answers held-out and in-sample, simulated voters, and every joint that changes."""
    rows, config = list(found.records), load_config().vision
    wrong = [row for row in rows if not _is_right(row, row["chosen"])]
    counts = Counter((row["set"], _is_right(row, row["chosen"])) for row in rows)
    offers = sum(any(row["right"]) for row in wrong)
    asked = [row for row in rows if row["source"] == row["joint"]]
    titles = ("voter", "record", "wrong joints", "repaired", "right joints", "spoiled", "wrong after")
    recorded = [
        line
        for form, label in ((_PICKS, "numbered motions"), (_WORDS, "words"))
        for everything in (False, True)
        for line in _recorded_rows(rows, form, label, config, found.summary["screening"], everything=everything)
    ]
    options = VoterOptions.model_validate(found.header.configuration)
    simulated = [_simulated_row(name, share, rows, options) for name, share in VOTERS.items()]
    right, known = found.summary["screening"]
    objects = {row["object"] for row in rows}
    said = (
        f"{len(objects)} objects, {len(rows)} joints, {len(wrong)} wrong; for {offers} of these the right motion is "
        f"among the options. {len(asked)} questions ({len(asked) / max(len(objects), 1):.1f} an object). The strong "
        f"model answered {right} of {known} questions about generated objects rightly."
    )
    names = dict.fromkeys(row["set"] for row in rows)
    sets = [(name, str(counts[name, True]), str(counts[name, False])) for name in names]
    return [
        explained(__doc__),
        said,
        table(("set", "right", "wrong"), sets),
        "## Recorded answers of a strong model",
        table(titles, recorded),
        f"## Simulated voters, mean of {options.draws} draws",
        table(titles, simulated),
        "## Joints that recorded answers change",
        table(("object", "joint", "confidence", "before", "after"), _changes(rows, config)),
    ]


def _is_right(row: Record, choice: int) -> bool:
    return bool(row["right"][choice])


def half_of(name: str) -> int:
    """Which half an object belongs to, 0 or 1."""
    return hashlib.sha256(name.encode()).digest()[0] % 2


def _recorded_rows(
    rows: Sequence[Record], form: str, label: str, config: VisionConfig, screening: Sequence[int], *, everything: bool
) -> list[tuple[str, ...]]:
    """Figures of one form of question: with the record of the other half, of known objects, and of all answers."""
    used = [row for row in rows if row["answers"][form] is not None and (everything or row["source"] is not None)]
    if not used:
        return []
    label = f"{label}, all answers" if everything else label
    halves = {half: _record_of([row for row in rows if half_of(row["object"]) == half], form) for half in (0, 1)}
    whole = VoterRecord(right=sum(h.right for h in halves.values()), asked=sum(h.asked for h in halves.values()))
    known = VoterRecord(right=screening[0], asked=screening[1])
    records = {
        "held-out": (halves[1], halves[0]),  # of an object of half 0 and of half 1
        **({"known objects": (known, known)} if form == _PICKS else {}),  # they were asked in this form alone
        "in-sample": (whole, whole),
    }
    found = []
    for title, record_of in records.items():
        chosen = {
            _key(row): _after(row, row["answers"][form]["named"], record_of[half_of(row["object"])].reliability(config))
            for row in used
        }
        shown = " / ".join(dict.fromkeys(f"{item.right} of {item.asked}" for item in record_of))
        found.append(_counted(f"{label}, {title}", shown, rows, chosen))
    return found


def _key(row: Record) -> tuple[str, int]:
    return str(row["object"]), int(row["joint"])


def _record_of(rows: Sequence[Record], form: str) -> VoterRecord:
    """Right answers among those that were given about the joint itself, and that could be right."""
    used = [
        row for row in rows if row["answers"][form] is not None and row["answers"][form]["own"] and any(row["right"])
    ]
    right = sum(any(a and b for a, b in zip(row["answers"][form]["named"], row["right"], strict=False)) for row in used)
    return VoterRecord(right=right, asked=len(used))


def _after(row: Record, named: Sequence[bool] | BoolArray, reliability: float) -> int:
    """Place of the likeliest option after an answer."""
    return int(np.argmax(posterior(np.array(row["prior"]), np.array(named, dtype=bool), reliability)[:-1]))


def _counted(title: str, record: str, rows: Sequence[Record], chosen: Mapping[tuple[str, int], int]) -> tuple[str, ...]:
    """A line of figures after other choices of some joints, by `_key`."""
    after = [(_is_right(row, row["chosen"]), _is_right(row, chosen.get(_key(row), row["chosen"]))) for row in rows]
    counts = Counter(after)
    right = counts[True, True] + counts[True, False]
    return title, record, *_figures(len(rows) - right, counts[False, True], right, counts[True, False])


def _figures(wrong: int, repaired: float, right: int, spoiled: float) -> tuple[str, ...]:
    """Wrong joints, repaired, right joints, spoiled, and the share that is wrong after."""
    left = 100.0 * (wrong - repaired + spoiled) / max(wrong + right, 1)
    share = 100.0 * spoiled / max(right, 1)
    return str(wrong), f"{repaired:.3g}", str(right), f"{spoiled:.3g} ({share:.2f} %)", f"{left:.1f} %"


def _simulated_row(name: str, share: float | None, rows: Sequence[Record], options: VoterOptions) -> tuple[str, ...]:
    """Mean figures of a voter that is right in a share of its answers; None for one at chance."""
    config, random = load_config().vision, np.random.default_rng([options.seed, *name.encode()])
    repaired = spoiled = 0
    for _ in range(options.draws):
        often = 1.0 / (config.options + 1) if share is None else share
        reliability = VoterRecord(right=int(random.binomial(_SCREENED, often)), asked=_SCREENED).reliability(config)
        picked = {_key(row): _simulated(row, share, random) for row in rows if row["source"] == row["joint"]}
        for row in rows:
            answer = picked.get((row["object"], row["source"]))
            if answer is not None:
                before, after = (_is_right(row, k) for k in (row["chosen"], _after(row, _on(row, answer), reliability)))
                repaired += after and not before
                spoiled += before and not after
    right = sum(_is_right(row, row["chosen"]) for row in rows)
    figures = _figures(len(rows) - right, repaired / options.draws, right, spoiled / options.draws)
    return name, f"{_SCREENED} known joints", *figures


def _simulated(row: Record, share: float | None, random: np.random.Generator) -> int:
    """Place of what a simulated voter chooses, in options, fixed and none of these."""
    right = [k for k, value in enumerate(row["right"]) if value] or [len(row["right"])]
    if share is None:
        return int(random.integers(len(row["right"])))
    wrong = [k for k in range(len(row["right"])) if k not in right]
    return int(random.choice(right if random.random() < share else wrong))


def _on(row: Record, answer: int) -> BoolArray:
    """What an answer about a joint, or its twin, names among the options of a joint, fixed, and none of these."""
    count = len(row["right"]) - 1
    named = np.zeros(count + 2, dtype=bool)
    if answer < len(row["follows"]):
        named[:count] = row["follows"][answer]
    else:
        named[count + answer - len(row["follows"])] = True
    return named


def _changes(rows: Sequence[Record], config: VisionConfig) -> list[tuple[str, ...]]:
    found = []
    record = _record_of(rows, _PICKS)
    for row in rows:
        answer = row["answers"][_PICKS]
        after = row["chosen"] if answer is None else _after(row, answer["named"], record.reliability(config))
        states = [("right" if _is_right(row, choice) else "wrong") for choice in (row["chosen"], after)]
        if after != row["chosen"]:
            found.append((row["object"], row["child"], f"{row['confidence']:.2f}", *states))
    return found


STUDY = Study(title="What answers about joints are worth", options=VoterOptions, measure=measure, report=report)
