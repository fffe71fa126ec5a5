"""A vision-language model behind the chat interface that hosted services and local servers share.

Answers are kept on disk by what was asked, so that the same question is paid for once; the key is never among them.
"""

from __future__ import annotations

import base64
import hashlib
import io
import json
import os
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from kinematify.errors import EnvironmentFault, InputError, OutputError
from kinematify.geometry.cut_cache import cache_folder
from kinematify.vision.piece_question import PieceAnswer

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.config import VisionConfig
    from kinematify.generate.providers.service import Service
    from kinematify.vision.piece_question import PieceQuestion

ADDRESS, KEY, MODEL = "KINEMATIFY_VLM_URL", "KINEMATIFY_VLM_KEY", "KINEMATIFY_VLM_MODEL"
OFF, AUTO = "off", "auto"


@dataclass
class ChatOracle:
    """Asks a model, several at a time; what goes wrong counts as unsure, with its reason.

    A service that refuses one question, or does not answer it in time, is not asked any further.
    """

    url: str
    model: str
    key: str = field(repr=False)
    config: VisionConfig
    cache: Path
    fault: str = ""
    """Why the service is not asked any further."""
    spent: int = 0
    """Tokens of answers that were not in the cache."""

    @property
    def name(self) -> str:
        """Name of the model and where it is, for the record."""
        return f"{self.model} at {self.url}"

    @property
    def record_path(self) -> Path:
        """Where its record is kept."""
        return self.cache / f"record-{hashlib.sha256(self.name.encode()).hexdigest()[:16]}.json"

    def ask(self, questions: Sequence[PieceQuestion]) -> list[PieceAnswer]:
        """Return the answer to each question, in their order."""
        from kinematify.generate.providers.service import Service  # noqa: PLC0415 - most calls ask nobody

        try:
            service = Service(name="The vision model", url=self.url, key=self.key, settings=self.config, key_name=KEY)
        except InputError as error:
            self.fault = str(error)
            return [PieceAnswer(fault=self.fault)] * len(questions)
        with closing(service), ThreadPoolExecutor(self.config.concurrency) as pool:
            return list(pool.map(lambda question: self._answer(service, question), questions))

    def _answer(self, service: Service, question: PieceQuestion) -> PieceAnswer:
        from kinematify.generate.providers.service import said as read_answer  # noqa: PLC0415

        request = self._request(question)
        digest = hashlib.sha256(json.dumps([self.url, request], sort_keys=True).encode()).hexdigest()
        path = self.cache / f"{digest}.json"
        said = read_kept(path)
        if said is None and self.spent >= self.config.tokens:
            self.fault = f"the budget of {self.config.tokens} tokens (vision.tokens) is spent"
        if said is None and self.fault:
            return PieceAnswer(fault=self.fault)
        if said is None:
            try:
                text, tokens = read_answer(service.ask("/chat/completions", json=request))
                said, self.spent = {"text": text, "tokens": tokens}, self.spent + tokens
            except (EnvironmentFault, InputError) as error:
                self.fault = str(error)
                return PieceAnswer(fault=self.fault)
        answer = question.read(str(said.get("text")), int(said.get("tokens") or 0))
        if not answer.fault:
            write_kept(path, said)
        return answer

    def _request(self, question: PieceQuestion) -> dict[str, Any]:
        file = io.BytesIO()
        question.picture.save(file, format="PNG")
        picture = f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"
        content = [{"type": "text", "text": question.text}, {"type": "image_url", "image_url": {"url": picture}}]
        form = {"name": "answer", "strict": True, "schema": question.schema()}
        return {
            "model": self.model,
            "temperature": 0,
            "max_tokens": self.config.answer_tokens,
            "messages": [{"role": "user", "content": content}],
            "response_format": {"type": "json_schema", "json_schema": form},
        }


def oracle_of(choice: str, config: VisionConfig) -> ChatOracle | None:
    """The model that `--vlm` names: none for ``off``, that of the environment for ``auto``, else an address.

    Raises:
        InputError: It is neither.
    """
    if choice == OFF:
        return None
    url = os.environ.get(ADDRESS, "").strip() if choice == AUTO else choice
    if choice == AUTO and not url:
        return None
    if not url.startswith(("http://", "https://")):
        raise InputError(
            f"--vlm {choice!r} is neither off, auto nor an address. Give the beginning of a chat interface, e.g. "
            f"http://localhost:8000/v1; auto takes it from the variable {ADDRESS}."
        )
    model = os.environ.get(MODEL, "").strip() or config.model
    key = os.environ.get(KEY, "").strip()
    return ChatOracle(url.rstrip("/"), model, key, config, cache_folder().parent / "vlm")


def read_kept(path: Path) -> dict[str, Any] | None:
    """JSON values from the cache; None where there are none, or they were cut off."""
    try:
        kept = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return kept if isinstance(kept, dict) else None


def write_kept(path: Path, said: dict[str, Any]) -> None:
    """Keep JSON values in the cache, whole or not at all; without a cache the same is paid for again."""
    from kinematify.generate.providers.job import keep  # noqa: PLC0415 - most calls keep nothing

    with suppress(OutputError):
        keep(path, said)
