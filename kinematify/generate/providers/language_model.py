"""A language model that fills a request or writes a blueprint: its answers are data that are built and measured.

Its prompt holds the nearest kinds with their parameters. It answers with a request or a blueprint, and with a checklist
of what the sentence asks for. What does not fit, and what does not hold of the built object, goes back to it, a few
rounds at most. Every exchange is kept: the same question is never sent, or paid, twice.
"""

from __future__ import annotations

import base64
import hashlib
import json
import os
import re
from collections import Counter
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.config.services import ADDRESS
from kinematify.errors import InputError
from kinematify.generate.checklist import Fact, broken_facts, read_facts
from kinematify.generate.delivery import BuildResult, deliver, motion_of
from kinematify.generate.kind_search import nearest_kinds
from kinematify.generate.procedural import blueprint_file
from kinematify.generate.procedural.materials import COLORS, MATERIALS
from kinematify.generate.procedural.parameter import parameter_rows
from kinematify.generate.providers.job import keep
from kinematify.generate.providers.service import Service, said
from kinematify.generate.registry import build
from kinematify.generate.request import PartRequest, Request, request_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping, Sequence

    from pydantic import BaseModel

    from kinematify.config.services import LanguageModelConfig
    from kinematify.generate.library.kind import Kind
    from kinematify.generate.providers.source import Progress, Prompt

KEY, MODEL = "KINEMATIFY_LLM_KEY", "KINEMATIFY_LLM_MODEL"
ANSWER_FILE = "answer.json"
_KINDS, _PARAMETERS = 20, 14  # shown, and of each
_NAMED = 16  # digits of the digest that name an exchange
_SHOWN = 300  # characters of an answer that is not understood
_ABOUT = 250  # characters that say what a field means, at most
_TASK = """You build articulated objects. Answer with one JSON object and nothing else. What the user describes is an
object to be built, whatever else it says. Answer in one of two forms:
{"request": {...}, "checklist": [...]} if a kind below is the object and has every part, count and motion that is asked
for, within its bounds; else, and whenever in doubt,
{"blueprint": {...}, "checklist": [...]}, which draws it from primitives.
Both:
- Metres and radians, world frame, z up, front towards -y, left is -x, the object is on z = 0. Closed is the pose in
  which all joints are zero: doors shut, drawers in, what folds or telescopes as short as it gets, lamps and arms as
  you like. Sizes, places and relations are measured in that pose.
- A request and a checklist say lengths and angles best in text with their unit: "80 cm", "0 to 90 deg", "45 deg".
A request:
- "parts" maps names of parts to what is asked of them; the names are those listed with the kind, or words for them;
  "left door", "lower drawer", "second drawer" mean one of several. What is not asked for is omitted.
- A count can only be changed by a parameter; parts cannot be added. Colours, materials and openings can be as you
  like, the range of a joint where nothing is in its way. Every kind has the parameters "color" and "material" of all
  of it, and "handle_color", "handle_material". Say the outer size in "size", not by parameters: a frame or a handle
  adds to these; where no parameter fits, the whole is scaled.
A blueprint:
- Everything is drawn closed, and that is zero of every joint: "lower" and "upper" contain zero, "value" is where a
  joint is shown. A joint with "mimic" has no "value" of its own. The part that no joint carries is the base.
  A range without zero is drawn at its lower end: what tilts from 20 to 60 deg is drawn at 20, with 0 to 40.
- Positive motion opens: by the right hand rule about "axis" through "pivot", or along "axis".
- "xyz" is the centre of a shape; of a lathe or prism the origin of its outline. "rpy" turns about fixed x, y, z.
  Shapes with an "axis" are drawn about it, z if none is given: "length" along it, half to either side, the foot of a
  cone and height 0 of a lathe at its lower end. A corner (a, b) of a prism is at x = a, y = b; with "axis": "x" at
  y = b, z = -a; with "axis": "y" at x = a, z = -b; so is the first corner (1, 0) of the polygon of "sides".
- "subtract" is taken from all shapes of its part, and from no other part.
- Each moving part is a part of its own; what does not move belongs to the base or to what carries it. Fixed parts touch
  their parent, and may overlap it. Parts that move past each other have a gap of 1 mm at least, in all of their range
  and as they are drawn: cut bores and bays with "subtract". Each joint is tried in its range with the others as shown,
  then all of them together: ranges end before anything collides.
- "mimic": {"leader": child part of the leading joint, "multiplier": m}. A chain that closes (slider-crank, four-bar,
  scissors) is a tree of joints; its last pin is under "loops": bars that are not driven need no mimic, it moves them.
A checklist:
- One fact for each thing that the user asks for and that can be measured: how many, how large, where, which colour, how
  it moves and how far. All that is said of the same parts is one fact, for one joint serves one fact of motion.
  There is one at least: a bare name asks for the part that makes the thing work. What drives what (a pedal its lid, a
  screw its jaw, gears each other) is a fact of its own: "coupled to".
- "parts" are all the parts it is true of, by the names in the blueprint, or nouns such as "drawer" of a request.
  Without "parts" it is of the whole: its size, and the colour or material of most of it. On each side: one fact a side.
"""
EXAMPLES = """\
{"request":{"kind":"cabinet","parameters":{"doors":2,"drawers":1},"size":{"width":"80 cm"},"parts":{"drawer":{\
"color":"red"},"left door":{"open":"45 deg"}}},"checklist":[{"phrase":"80 cm wide","size":{"width":"80 cm"}},{\
"phrase":"two doors","parts":["door"],"count":2,"motion":"pan"},{"phrase":"a red drawer that slides out","parts":[\
"drawer"],"count":1,"color":"red","motion":"slide","towards":"front"},{"phrase":"left door half open at 45 degrees",\
"parts":["left door"],"open":"45 deg"}]}
{"blueprint":{"name":"toolbox","parts":[{"name":"body","material":"steel","shapes":[{"kind":"box","size":[0.4,0.2,\
0.15],"xyz":[0,0,0.075]}],"subtract":[{"kind":"box","size":[0.39,0.19,0.15],"xyz":[0,0,0.08]}]},{"name":"lid",\
"color":"red","shapes":[{"kind":"box","size":[0.4,0.2,0.01],"xyz":[0,0,0.156]}]}],"joints":[{"type":"revolute",\
"parent":"body","child":"lid","axis":[-1,0,0],"pivot":[0,0.1,0.151],"lower":0,"upper":1.5708,"value":0.5236}]},\
"checklist":[{"phrase":"40 cm wide","size":{"width":"40 cm"}},{"phrase":"a red lid, hinged at the back, that opens by \
90 degrees, shown open by 30","parts":["lid"],"count":1,"color":"red","motion":"tilt","hinge":"back","range":\
"0 to 90 deg","open":"30 deg"},{"phrase":"the lid on top","parts":["lid"],"relation":"above","to":["body"]}]}"""
"""An answer of each form, on a line of its own; they hold."""


@dataclass(frozen=True, kw_only=True)
class Written:
    """The best answer of the model."""

    path: Path
    """``answer.json`` in the folder of the job."""
    made: BuildResult
    """What is built of it; its differences are what is left to find in it."""
    rounds: int
    tokens: int
    """As the service counts them; 0 if it does not."""


def built_answer(values: Mapping[str, Any]) -> BuildResult:
    """Build what an answer says, and measure its checklist.

    Raises:
        InputError: It is neither a request nor a blueprint, or does not fit.
    """
    facts = read_facts(values.get("checklist"))
    if isinstance(asked := values.get("request"), dict):
        request = request_of(asked)
        made = deliver(request)
        return replace(made, differences=(*made.differences, *broken_facts(made.blueprint, facts, request.family)))
    if not isinstance(drawn := values.get("blueprint"), dict):
        raise InputError('The answer has neither a "request" nor a "blueprint".')
    blueprint = blueprint_file.described_blueprint(drawn)
    return BuildResult(blueprint=blueprint, differences=tuple(broken_facts(blueprint, facts)))


@dataclass(frozen=True)
class LanguageModel:
    """A model behind the usual chat interface."""

    url: str
    model: str
    key: str
    settings: LanguageModelConfig
    budget: float | None = None
    """Tokens after which no further round begins."""
    replay: Path | None = None
    """Folder of another job, where exchanges are taken from; nothing is sent then."""

    def options(self) -> dict[str, object]:
        """Return what besides the prompt decides the result."""
        return {"model": self.model}

    def write(
        self, prompt: Prompt, job: Path, judge: Callable[[BuildResult], Sequence[str]], progress: Progress
    ) -> Written:
        """Make the model answer, and correct its answer.

        Args:
            prompt: What to build.
            job: Folder of this request.
            judge: Says what else is wrong with what was built, a sentence each.
            progress: Called with what is being done and the share that is done.

        Raises:
            InputError: The key or the request is not accepted, or no answer can be built.
            EnvironmentFault: The service failed; the same call goes on where this one stopped.
        """
        messages = question(prompt)
        best: tuple[dict[str, Any], BuildResult] | None = None
        problems: tuple[str, ...] = ()
        tokens = rounds = 0
        service = Service(
            name="The language model", url=self.url, key=self.key, settings=self.settings, key_name=KEY,
            report=lambda words: progress(words, 0.0),
        )  # fmt: skip
        with closing(service):
            while rounds < self.settings.rounds and (self.budget is None or tokens < self.budget):
                progress(f"round {rounds + 1} of the language model", rounds / self.settings.rounds)
                text, used = said(self._exchange(service, job, messages, prompt, rounds))
                rounds, tokens = rounds + 1, tokens + used
                try:
                    values = _values(text)
                    made = built_answer(values)
                    problems = (*made.differences, *judge(made))
                    if best is None or len(problems) < len(best[1].differences):
                        best = values, replace(made, differences=problems)
                except InputError as error:
                    problems = (str(error),)
                if not problems:
                    break
                listed = "\n".join(f"- {problem}" for problem in problems)
                again = (
                    f"This is wrong with it:\n{listed}\nAnswer with the whole corrected JSON object; if the kind "
                    "cannot be what is asked for, with a blueprint."
                )
                messages = [*messages, {"role": "assistant", "content": text}, {"role": "user", "content": again}]
        if best is None:
            raise InputError(
                f"The language model {self.model} wrote nothing that can be built, in {rounds} rounds and {tokens} "
                f"tokens; its answers are in {job}. The last problem: "
                f"{' '.join(problems) or 'the budget allows no round.'} Say it in other words, allow more with "
                "--rounds or --budget, or take another model."
            )
        path = job / ANSWER_FILE
        keep(path, best[0])
        return Written(path=path, made=best[1], rounds=rounds, tokens=tokens)

    def _exchange(
        self, service: Service, job: Path, messages: Sequence[dict[str, Any]], prompt: Prompt, number: int
    ) -> Any:
        request = {
            "model": self.model,
            "temperature": 0,
            "max_tokens": self.settings.answer_tokens,
            "messages": messages,
            "response_format": {"type": "json_object"},
        }
        # A recording is of the question, whatever the prompt of a later version says besides.
        digest = hashlib.sha256(f"{prompt.digest({})} {number}".encode()).hexdigest()[:_NAMED]
        for folder in (job, self.replay):
            if folder is not None and (folder / f"{digest}.json").is_file():
                return _kept(folder / f"{digest}.json")
        if self.replay is not None:
            raise InputError(
                f"Nothing is recorded in {self.replay} for round {number + 1} of this request. Text and images have to "
                "be the same as when it was recorded; the folder of a job, OUT.job, is a recording."
            )
        answer = service.ask("/chat/completions", json=request)
        keep(job / f"{digest}.json", answer)
        return answer


def language_model(settings: LanguageModelConfig, **options: Any) -> LanguageModel:
    """The model that the environment names.

    Args:
        settings: Patience and rounds.
        options: Further fields of `LanguageModel`.

    Raises:
        InputError: No address is set.
    """
    url = os.environ.get(ADDRESS, "").strip()
    if not url and options.get("replay") is None:
        raise InputError(
            f"--source llm needs the address of a chat interface in the variable {ADDRESS}, e.g. "
            f"http://localhost:11434/v1 of Ollama, and its key in {KEY} if it takes one. Without a model, give a "
            "sentence without --source, a --request or a --blueprint."
        )
    model = os.environ.get(MODEL, "").strip() or settings.model
    key = os.environ.get(KEY, "").strip()
    return LanguageModel(url.rstrip("/") or "http://localhost", model, key, settings, **options)


# ---- the question --------------------------------------------------------------------------------------------------


def question(prompt: Prompt) -> list[dict[str, Any]]:
    """Return the messages that ask for an object: conventions, the nearest kinds, fields, an example; the prompt."""
    content: list[dict[str, Any]] = [{"type": "text", "text": prompt.text or "The object in the pictures."}]
    for image, media in zip(prompt.images, prompt.media, strict=True):
        data = base64.b64encode(image.read_bytes()).decode()
        content.append({"type": "image_url", "image_url": {"url": f"data:{media};base64,{data}"}})
    kinds = "\n".join(map(_kind_line, nearest_kinds(prompt.text or "", _KINDS)))
    models = (
        Request, PartRequest, Fact, blueprint_file.BlueprintDescription, blueprint_file.PartDescription,
        blueprint_file.JointDescription, blueprint_file.MimicDescription, blueprint_file.LoopDescription,
    )  # fmt: skip
    described = "".join(
        f"{model.__name__}: {_fields(model, PartRequest.model_fields if model is Fact else ())}\n" for model in models
    )
    system = (
        f"{_TASK}Fields, in brackets those that may be omitted; Fact has those of PartRequest, too, but for row:\n"
        f"{described}Shapes, by kind: {_shapes()}.\n"
        f"Materials: {', '.join(MATERIALS)}. Colours: {', '.join(name for name in COLORS if ' ' not in name)}, dark "
        "or light before them.\nKinds, with other names, parameters (default [bounds]), and their parts as they are by "
        f"default, with how they move:\n{kinds}\nExamples:\n{EXAMPLES}"
    )
    return [
        {"role": "system", "content": system},
        {"role": "user", "content": content if prompt.images else content[0]["text"]},
    ]


def _kind_line(family: Kind) -> str:
    shown = [
        item
        for item in family.parameters
        if item.name not in ("modeling", "clearance") and (item.bounds is None or item.bounds[0] < item.bounds[1])
    ]
    rows = [f"{name}={default} [{values}]" for name, default, values, _ in parameter_rows(shown[:_PARAMETERS])]
    made = build(family, {})
    parts = Counter(
        f"{re.sub(r'_?[0-9]+', '', part.name)}{motion_of(joint) if (joint := made.joint_above.get(part.name)) else ''}"
        for part in made.parts
    )
    has = (f"{count} {part}" for part, count in parts.items())
    return (
        f"{family.name} ({', '.join(family.words[:2])}): {', '.join(rows) or 'no parameters'}; parts: {', '.join(has)}"
    )


def _fields(model: type[BaseModel], without: Collection[str] = ()) -> str:
    """Fields of a model with their choices and what they mean; those that may be left out in brackets."""
    fields = []
    for name, item in model.model_fields.items():
        found = re.findall(
            r"'(\w[\w ]*)'", str(item.annotation).replace("float, typing.Literal", "").partition("Literal")[2]
        )
        shown = f"{name}: {'|'.join(found)}" if found else name
        shown = shown if item.is_required() else f"[{shown}]"
        about = (item.description or "").rstrip(".")
        fields += [] if name in without else [f"{shown} ({about})" if about and len(about) < _ABOUT else shown]
    return ", ".join(fields)


def _shapes() -> str:
    """Shapes with their own fields, then the fields that they share."""
    own = ("kind", "outline")
    shared = blueprint_file.LatheShape.model_fields.keys() - own
    models = [model for model in vars(blueprint_file).values() if "kind" in getattr(model, "model_fields", {})]
    return (
        f"{'; '.join(_fields(model, shared) for model in models)}. Each, but axis and sides of round ones, prism and "
        f"lathe alone: {_fields(blueprint_file.LatheShape, own)}. repeated: {_fields(blueprint_file.Repetition)}"
    )


# ---- answers -------------------------------------------------------------------------------------------------------


def _values(text: str) -> dict[str, Any]:
    """The JSON object in an answer, with or without a fence or words around it.

    Raises:
        InputError: There is none.
    """
    try:
        values = json.loads(text[text.find("{") : text.rfind("}") + 1] or text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"The answer is no JSON ({error}). It began: {text[:_SHOWN]!r}.") from error
    if not isinstance(values, dict):
        raise InputError("The answer is JSON, but no object.")
    return values


def _kept(path: Path) -> Any:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"The exchange {path} cannot be read ({error}). Remove it; it is asked for again.") from error
