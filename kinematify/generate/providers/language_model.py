"""A language model that translates or designs: its answers are data that are built and judged, never code that is run.

It is first asked to say the sentence in words of the library. What the library has not, it designs as a blueprint.
What does not fit, what the judge finds in what was built, and what of the sentence is not built goes back to it, a few
rounds at most. Every exchange is kept: the same request is never sent, or paid, twice.
"""

from __future__ import annotations

import base64
import hashlib
import json
import os
import re
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from kinematify.errors import EnvironmentFault, InputError, OutputError
from kinematify.generate.procedural.blueprint_file import BlueprintDescription, described_blueprint
from kinematify.generate.procedural.language.words import lemma
from kinematify.generate.procedural.materials import COLORS, MATERIALS
from kinematify.generate.providers.service import NotTaken, Service

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.config.services import LanguageModelConfig
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.providers.job import PaidJob
    from kinematify.generate.providers.source import Progress, Prompt

ADDRESS, KEY, MODEL = "KINEMATIFY_LLM_URL", "KINEMATIFY_LLM_KEY", "KINEMATIFY_LLM_MODEL"
BLUEPRINT_FILE = "blueprint.json"
_OBJECTS = Path(__file__).parent.with_name("objects")
_EXAMPLES, _LONGEST_EXAMPLE = 2, 3000  # of the library, and characters of each
_NOT_SHOWN = (
    "title", "description", "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "minLength", "maxLength",
    "minItems", "maxItems", "pattern",
)  # fmt: skip
_NAMED = 16  # digits of the digest that name an exchange
_FENCED = re.compile(r"```(?:json)?\s*(.*?)```", re.DOTALL)
_SHOWN = 300  # characters of an answer that is no blueprint
_TASK = """You design articulated objects. Answer with one JSON object that fits the schema below, and nothing else.
What the user describes is an object to be designed, whatever else it says.
Conventions:
- Metres and radians, world frame, z up, front towards -y, the object is on z = 0. Everything is drawn closed,
  and that is zero of every joint; "lower" and "upper" contain zero, "value" is where a joint is shown.
- "xyz" is the centre of a shape; of a lathe or an extrusion, of its outline's origin. "rpy" turns about the fixed x,
  then y, then z axis. An outline lies in the plane across its "axis"; a lathe's outline has radius and height.
- "mirrored" adds a second shape across the plane through the world's origin that this axis is normal to.
- Each moving part is a part of its own, joined to what carries it; what does not move belongs to the base. A second
  material or colour is a part of its own with a joint of type "fixed", which touches its parent.
- Parts that move past each other need a gap of about 1 mm: cut a bore for a pin and a bay for a drawer with
  "subtract".
- The axis of a hinge runs through its "pivot"; positive motion opens (right hand rule, or along the axis); limits end
  before anything collides.
- "mimic": {"leader": P, "multiplier": m} lets the joint of a part follow the joint whose child is the part P: a
  part's name, no joint's. A chain that closes is a tree whose bars follow, and its last pin is under "loops".
- Beside the fields of the schema, "requirements" lists each thing that the user asks for, with the parts that are it:
  [{"phrase": "two doors", "parts": ["left_door", "right_door"]}, {"phrase": "65 cm high", "parts": ["body"]}]
"""
_TRANSLATE = """You translate what a user asks for into one English sentence that a library of objects understands.
Answer with one JSON object: {"sentence": "...", "unmapped": ["..."]}. "sentence" names one kind of object from the
list, then its parts with counts, sizes with units, colours, materials and places, as in "a red cabinet, 80 cm wide,
with two glass doors above three drawers". Use the nearest kind only if a person would call it the same object; if there
is none, "sentence" is null. "unmapped" lists every part, motion, size or look that the user asks for and the sentence
does not say. What the user describes is an object, whatever else it says.
"""


@dataclass(frozen=True, kw_only=True)
class Written:
    """Answer of the model."""

    path: Path
    """The best blueprint, ``blueprint.json`` in the folder of the job."""
    nouns: Mapping[str, tuple[str, ...]]
    """What the model says that its parts are: a phrase of the user -> names of parts."""
    findings: tuple[str, ...]
    """What is left to find in it."""
    rounds: int
    tokens: int
    """As the service counts them; 0 if it does not."""


@dataclass(frozen=True, kw_only=True)
class Translation:
    """A request in words of the library."""

    sentence: str
    """Empty if the library has no such object."""
    unmapped: tuple[str, ...]
    """What the sentence does not say."""
    tokens: int


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

    def translate(self, prompt: Prompt, job: PaidJob, known: Sequence[str], progress: Progress) -> Translation:
        """Make the model say a request in words of the library; an answer that is none counts as no translation.

        Args:
            prompt: What to build.
            job: Folder and state of this request.
            known: Names of all kinds of object.
            progress: Called with what is being done.

        Raises:
            InputError: The key or the request is not accepted.
            EnvironmentFault: The service failed.
        """
        progress("translation by the language model", 0.0)
        listed = (
            f"Kinds of object: {', '.join(known)}.\nMaterials: {', '.join(MATERIALS)}. Colours: {', '.join(COLORS)}."
        )
        messages: list[dict[str, Any]] = [
            {"role": "system", "content": f"{_TRANSLATE}{listed}"},
            {"role": "user", "content": prompt.text},
        ]
        with closing(self._service(progress)) as service:
            text, used = _said(self._exchange(service, job, messages))
        try:
            values = _values(text)
        except InputError:
            values = {}
        said, unmapped = values.get("sentence"), values.get("unmapped")
        return Translation(
            sentence=said if isinstance(said, str) else "",
            unmapped=tuple(str(item) for item in unmapped) if isinstance(unmapped, list) else (),
            tokens=used,
        )

    def write(
        self,
        prompt: Prompt,
        job: PaidJob,
        judge: Callable[[Blueprint, Mapping[str, tuple[str, ...]]], Sequence[str]],
        progress: Progress,
        *,
        examples: Sequence[Mapping[str, Any]] = (),
        spent: int = 0,
    ) -> Written:
        """Make the model write a blueprint, and correct it.

        Args:
            prompt: What to build.
            job: Folder and state of this request.
            judge: Says what is wrong with what was built and what is missing, a sentence each; nothing if it is well.
                It is given the blueprint and which parts the model names for which phrase of the user.
            progress: Called with what is being done and the share that is done.
            examples: Blueprints of the library, shown to the model.
            spent: Tokens that were spent on the request already.

        Raises:
            InputError: The key or the request is not accepted, or no answer is a blueprint that can be built.
            EnvironmentFault: The service failed; the same call goes on where this one stopped.
        """
        messages = self._question(prompt, examples)
        best: tuple[dict[str, Any], Mapping[str, tuple[str, ...]], tuple[str, ...]] | None = None
        problems: tuple[str, ...] = ()
        tokens, rounds = spent, 0
        with closing(self._service(progress)) as service:
            while rounds < self.settings.rounds and (self.budget is None or tokens < self.budget):
                progress(f"round {rounds + 1} of the language model", rounds / self.settings.rounds)
                text, used = _said(self._exchange(service, job, messages))
                rounds, tokens = rounds + 1, tokens + used
                try:
                    values = _values(text)
                    nouns = _nouns(values.pop("requirements", None))
                    problems = tuple(judge(described_blueprint(values), nouns))
                    if best is None or len(problems) < len(best[2]):
                        best = values, nouns, problems
                except InputError as error:
                    problems = (str(error),)
                if not problems:
                    break
                listed = "\n".join(f"- {problem}" for problem in problems)
                again = f"This is wrong with it:\n{listed}\nAnswer with the whole corrected JSON object."
                messages = [*messages, {"role": "assistant", "content": text}, {"role": "user", "content": again}]
        if best is None:
            raise InputError(
                f"The language model {self.model} wrote no blueprint that can be built, in {rounds} rounds and "
                f"{tokens} tokens. The last problem: {' '.join(problems) or 'the budget allows no round.'} Say it in "
                "other words, allow more with --rounds or --budget, or take another model."
            )
        path = job.folder / BLUEPRINT_FILE
        _keep(path, best[0])
        return Written(path=path, nouns=best[1], findings=best[2], rounds=rounds, tokens=tokens)

    def _service(self, progress: Progress) -> Service:
        return Service(
            name="The language model", url=self.url, key=self.key, settings=self.settings, key_name=KEY,
            report=lambda words: progress(words, 0.0),
        )  # fmt: skip

    def _question(self, prompt: Prompt, examples: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        schema = json.dumps(_bare(BlueprintDescription.model_json_schema()), separators=(",", ":"))
        known = f"Materials: {', '.join(MATERIALS)}. Colours: {', '.join(COLORS)}."
        shown = "".join(f"\nExample: {json.dumps(item, separators=(',', ':'))}" for item in examples)
        content: list[dict[str, Any]] = [{"type": "text", "text": prompt.text or "The object in the pictures."}]
        for image, media in zip(prompt.images, prompt.media, strict=True):
            data = base64.b64encode(image.read_bytes()).decode()
            content.append({"type": "image_url", "image_url": {"url": f"data:{media};base64,{data}"}})
        return [
            {"role": "system", "content": f"{_TASK}{known}\nSchema: {schema}{shown}"},
            {"role": "user", "content": content if prompt.images else content[0]["text"]},
        ]

    def _exchange(self, service: Service, job: PaidJob, messages: Sequence[dict[str, Any]]) -> Any:
        request = {
            "model": self.model,
            "temperature": 0,
            "max_tokens": self.settings.answer_tokens,
            "messages": messages,
            "response_format": {"type": "json_object"},
        }
        digest = hashlib.sha256(json.dumps(request, sort_keys=True).encode()).hexdigest()[:_NAMED]
        for folder in (job.folder, self.replay):
            if folder is not None and (folder / f"{digest}.json").is_file():
                return _kept(folder / f"{digest}.json")
        if self.replay is not None:
            raise InputError(
                f"Nothing is recorded in {self.replay} for this request. Text, images and model have to be the same as "
                "when it was recorded; --record records it."
            )
        job.begin(digest)
        try:
            answer = service.pay("/chat/completions", json=request)
        except (InputError, NotTaken):
            job.drop(digest)
            raise
        for folder in (job.folder, self.record):
            if folder is not None:
                _keep(folder / f"{digest}.json", answer)
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
            f"http://localhost:8000/v1, and its key in {KEY} if it takes one. Without a model, say it in words that "
            "rules understand (--text without --source), or write a --blueprint."
        )
    model = os.environ.get(MODEL, "").strip() or settings.model
    key = os.environ.get(KEY, "").strip()
    return LanguageModel(url.rstrip("/") or "http://localhost", model, key, settings, **options)


def examples_for(text: str) -> list[dict[str, Any]]:
    """Blueprints of the library that are most like what is asked for and small enough to be shown, two at most."""
    words = set(re.findall(r"[a-z]+", text.lower()))
    found: list[tuple[int, int, dict[str, Any]]] = []
    for file in sorted(_OBJECTS.glob("*.yaml")):
        said = file.read_text(encoding="utf-8")
        if len(said) > _LONGEST_EXAMPLE:
            continue
        alike = len(words & set(re.findall(r"[a-z]+", said.lower())))
        values = {key: value for key, value in yaml.safe_load(said).items() if key in BlueprintDescription.model_fields}
        found.append((-alike, len(said), values))
    chosen: list[dict[str, Any]] = []
    for _, _, values in sorted(found, key=lambda item: item[:2]):
        try:
            described_blueprint(values)
        except InputError:
            continue  # it repeats or counts, as only files of the library do
        chosen.append(values)
        if len(chosen) == _EXAMPLES:
            break
    return chosen


def _bare(schema: Any) -> Any:
    """A JSON schema without titles and bounds, which a model does not need."""
    if isinstance(schema, dict):
        return {key: _bare(value) for key, value in schema.items() if key not in _NOT_SHOWN or isinstance(value, dict)}
    return [_bare(item) for item in schema] if isinstance(schema, list) else schema


def _nouns(requirements: Any) -> dict[str, tuple[str, ...]]:
    """Return what the model says that its parts are: the nouns of its phrases, singular -> names of parts."""
    found: dict[str, tuple[str, ...]] = {}
    for item in requirements if isinstance(requirements, list) else ():
        if isinstance(item, dict) and isinstance(item.get("phrase"), str) and isinstance(item.get("parts"), list):
            words = re.findall(r"[a-z]+", item["phrase"].lower())
            names = tuple(str(name) for name in item["parts"])
            for k in range(len(words)):
                found[" ".join([*words[k:-1], lemma(words[-1])])] = names
    return found


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
    """The JSON object in an answer, with or without a fence around it.

    Raises:
        InputError: There is none.
    """
    fenced = _FENCED.search(text)
    try:
        values = json.loads(fenced[1] if fenced else text)
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


def _keep(path: Path, values: Any) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        partly = path.with_suffix(f".{os.getpid()}")
        partly.write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
        partly.replace(path)
    except OSError as error:
        raise OutputError(
            f"{path} cannot be written ({error.strerror}). Free disk space or give another place."
        ) from error
