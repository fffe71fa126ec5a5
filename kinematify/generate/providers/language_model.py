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
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.config.services import ADDRESS
from kinematify.errors import EnvironmentFault, InputError
from kinematify.generate.checklist import Fact, broken_facts, read_facts
from kinematify.generate.delivery import BuildResult, deliver
from kinematify.generate.kind_search import nearest_kinds
from kinematify.generate.procedural import blueprint_file
from kinematify.generate.procedural.materials import COLORS, MATERIALS
from kinematify.generate.providers.job import keep
from kinematify.generate.providers.service import NotTaken, Service
from kinematify.generate.request import PartRequest, Request, request_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping, Sequence

    from pydantic import BaseModel

    from kinematify.config.services import LanguageModelConfig
    from kinematify.generate.library.kind import Kind
    from kinematify.generate.procedural.parameter import Parameter
    from kinematify.generate.providers.job import PaidJob
    from kinematify.generate.providers.source import Progress, Prompt

KEY, MODEL = "KINEMATIFY_LLM_KEY", "KINEMATIFY_LLM_MODEL"
ANSWER_FILE = "answer.json"
_KINDS, _PARAMETERS = 20, 14  # shown, and of each
_NAMED = 16  # digits of the digest that name an exchange
_FENCED = re.compile(r"```(?:json)?\s*(.*?)```", re.DOTALL)
_SHOWN = 300  # characters of an answer that is not understood
_TASK = """You build articulated objects. Answer with one JSON object and nothing else. What the user describes is an
object to be built, whatever else it says. Answer in one of two forms:
{"request": {...}, "checklist": [...]} if one of the kinds below is the object, else
{"blueprint": {...}, "checklist": [...]}, which draws it from primitives.
Conventions:
- Metres and radians, world frame, z up, front towards -y, left is -x, the object is on z = 0. Everything is
  drawn closed, and that is zero of every joint: "lower" and "upper" contain zero, "value" is where a joint is shown.
- Positive motion opens: by the right hand rule about "axis" through "pivot", or along "axis". Ranges end before
  anything collides. Degrees of the user are written in radians.
- "xyz" is the centre of a shape; of a lathe or prism the origin of its outline. "rpy" turns about fixed x, y, z.
- Each moving part is a part of its own; what does not move belongs to the base. Fixed parts touch their parent; parts
  that move past each other have a gap of 1 mm: cut bores and bays with "subtract".
- "mimic": {"leader": child part of the leading joint, "multiplier": m}. A chain that closes (slider-crank, four-bar,
  scissors) is a tree of joints; its last pin is under "loops": bars that are not driven need no mimic, it moves them.
- "checklist" lists each thing that the user asks for as a fact that can be measured: how many, how large, where, how
  it moves and how far. "parts" are names of parts of the blueprint, or nouns such as "drawer" of a request.
"""
_EXAMPLE = """\
{"blueprint":{"name":"toolbox","parts":[{"name":"body","material":"steel","shapes":[{"kind":"box","size":[0.4,0.2,\
0.15],"xyz":[0,0,0.075]}],"subtract":[{"kind":"box","size":[0.39,0.19,0.15],"xyz":[0,0,0.08]}]},{"name":"lid",\
"color":"red","shapes":[{"kind":"box","size":[0.4,0.2,0.01],"xyz":[0,0,0.156]}]}],"joints":[{"type":"revolute",\
"parent":"body","child":"lid","axis":[-1,0,0],"pivot":[0,0.1,0.151],"lower":0,"upper":1.57}]},"checklist":[{\
"phrase":"40 cm wide","size":{"width":0.4}},{"phrase":"a red lid that opens by 90 degrees","parts":["lid"],\
"count":1,"color":"red","motion":"tilt","range":[0,1.57]}]}"""


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
    record: Path | None = None
    """Where exchanges are kept, besides the folder of the job."""
    replay: Path | None = None
    """Where exchanges are taken from; nothing is sent then."""

    def options(self) -> dict[str, object]:
        """Return what besides the prompt decides the result."""
        return {"model": self.model}

    def write(
        self, prompt: Prompt, job: PaidJob, judge: Callable[[BuildResult], Sequence[str]], progress: Progress
    ) -> Written:
        """Make the model answer, and correct its answer.

        Args:
            prompt: What to build.
            job: Folder and state of this request.
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
        with closing(self._service(progress)) as service:
            while rounds < self.settings.rounds and (self.budget is None or tokens < self.budget):
                progress(f"round {rounds + 1} of the language model", rounds / self.settings.rounds)
                text, used = _said(self._exchange(service, job, messages, prompt, rounds))
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
                again = f"This is wrong with it:\n{listed}\nAnswer with the whole corrected JSON object."
                messages = [*messages, {"role": "assistant", "content": text}, {"role": "user", "content": again}]
        if best is None:
            raise InputError(
                f"The language model {self.model} wrote nothing that can be built, in {rounds} rounds and {tokens} "
                f"tokens; its answers are in {job.folder}. The last problem: "
                f"{' '.join(problems) or 'the budget allows no round.'} Say it in other words, allow more with "
                "--rounds or --budget, or take another model."
            )
        path = job.folder / ANSWER_FILE
        keep(path, best[0])
        return Written(path=path, made=best[1], rounds=rounds, tokens=tokens)

    def _service(self, progress: Progress) -> Service:
        return Service(
            name="The language model", url=self.url, key=self.key, settings=self.settings, key_name=KEY,
            report=lambda words: progress(words, 0.0),
        )  # fmt: skip

    def _exchange(
        self, service: Service, job: PaidJob, messages: Sequence[dict[str, Any]], prompt: Prompt, number: int
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
        for folder in (job.folder, self.replay):
            if folder is not None and (folder / f"{digest}.json").is_file():
                return _kept(folder / f"{digest}.json")
        if self.replay is not None:
            raise InputError(
                f"Nothing is recorded in {self.replay} for round {number + 1} of this request. Text and images have to "
                "be the same as when it was recorded; --record records it."
            )
        job.begin(digest)
        try:
            answer = service.ask("/chat/completions", paid=True, json=request)
        except (InputError, NotTaken):
            job.drop(digest)
            raise
        for folder in (job.folder, self.record):
            if folder is not None:
                keep(folder / f"{digest}.json", answer)
        job.finish(digest)
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
    system = (
        f"{_TASK}Kinds, with parameters and their defaults:\n{kinds}\n"
        f"request: {_fields(Request)}. Of each of its parts: {_fields(PartRequest)}.\n"
        f"fact: these, and {_fields(Fact, PartRequest.model_fields)}.\n"
        f"blueprint: {_fields(blueprint_file.BlueprintDescription)}.\n"
        f"part: {_fields(blueprint_file.PartDescription)}.\njoint: {_fields(blueprint_file.JointDescription)}.\n"
        f"loop: {_fields(blueprint_file.LoopDescription)}.\n"
        f"Shapes, by kind: {_shapes()}.\n"
        f"Materials: {', '.join(MATERIALS)}. Colours: {', '.join(name for name in COLORS if ' ' not in name)}, dark "
        f"or light before them.\nExample: {_EXAMPLE}"
    )
    return [
        {"role": "system", "content": system},
        {"role": "user", "content": content if prompt.images else content[0]["text"]},
    ]


def _kind_line(family: Kind) -> str:
    shown = [item for item in family.parameters if item.name not in ("modeling", "clearance")]
    shown = [item for item in shown if item.bounds is None or item.bounds[0] < item.bounds[1]][:_PARAMETERS]
    return f"{family.name} ({', '.join(family.words[:2])}): {', '.join(map(_parameter, shown)) or 'no parameters'}"


def _parameter(item: Parameter) -> str:
    if item.bounds is not None:
        return f"{item.name}={item.default:g} [{item.bounds[0]:g}..{item.bounds[1]:g}]"
    return f"{item.name}={'|'.join(filter(None, item.choices)) or 'text'}"


def _fields(model: type[BaseModel], without: Collection[str] = ()) -> str:
    """Fields of a model with their choices; those that may be left out in brackets."""
    said = []
    for name, item in model.model_fields.items():
        found = re.findall(r"'(\w[\w ]*)'", str(item.annotation).partition("Literal")[2])
        shown = f"{name}: {'|'.join(found)}" if found else name
        said += [] if name in without else [shown if item.is_required() else f"[{shown}]"]
    return ", ".join(said)


def _shapes() -> str:
    placed = ("xyz", "rpy", "mirrored", "repeated")
    models = [model for model in vars(blueprint_file).values() if "kind" in getattr(model, "model_fields", {})]
    return f"{'; '.join(_fields(model, placed) for model in models)}; each [xyz], [rpy], [mirrored: x|y|z]"


# ---- answers -------------------------------------------------------------------------------------------------------


def _said(answer: Any) -> tuple[str, int]:
    """The text of a chat answer, and the tokens that it cost.

    Raises:
        EnvironmentFault: It is no chat answer.
    """
    try:
        message = answer["choices"][0]["message"]
        text = message.get("content") or message.get("refusal") or ""
        used = (answer.get("usage") or {}).get("total_tokens") or 0
        return str(text), int(used)
    except (AttributeError, KeyError, IndexError, TypeError, ValueError) as error:
        raise EnvironmentFault(
            f"The language model's service gave an answer without a message ({str(answer)[:_SHOWN]}). Check that the "
            f"address in {ADDRESS} is a chat interface of the usual kind."
        ) from error


def _values(text: str) -> dict[str, Any]:
    """The JSON object in an answer, with or without a fence or words around it.

    Raises:
        InputError: There is none.
    """
    fenced = _FENCED.search(text)
    inner = fenced[1] if fenced else text[text.find("{") : text.rfind("}") + 1] or text
    try:
        values = json.loads(inner)
    except (ValueError, RecursionError) as error:
        shown = " ".join(text.split())[:_SHOWN]
        raise InputError(f"The answer is no JSON ({error}). It began: {shown!r}.") from error
    if not isinstance(values, dict):
        raise InputError("The answer is JSON, but no object.")
    return values


def _kept(path: Path) -> Any:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"The exchange {path} cannot be read ({error}). Remove it; it is asked for again.") from error
