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
from contextlib import closing
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kinematify.errors import EnvironmentFault, InputError
from kinematify.geometry.cut_cache import cache_folder
from kinematify.vision.answer import JointVotes, read_answer, schema

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.config import VisionConfig
    from kinematify.generate.providers.service import Service
    from kinematify.vision.answer import JointQuestion

ADDRESS, KEY, MODEL = "KINEMATIFY_VLM_URL", "KINEMATIFY_VLM_KEY", "KINEMATIFY_VLM_MODEL"
OFF, AUTO = "off", "auto"


@dataclass(frozen=True)
class ChatOracle:
    """Asks a model about joints, several at a time; what goes wrong with one is an abstention with its reason."""

    url: str
    model: str
    key: str
    config: VisionConfig
    cache: Path

    def ask(self, questions: Sequence[JointQuestion]) -> list[JointVotes]:
        """See `JointOracle`.

        Raises:
            InputError: The address cannot be used, or the key or the request is not accepted: no question would be
                answered.
        """
        from kinematify.generate.providers.service import Service  # noqa: PLC0415 - most calls ask nobody

        service = Service(name="The vision model", url=self.url, key=self.key, settings=self.config, key_name=KEY)
        with closing(service), ThreadPoolExecutor(self.config.concurrency) as pool:
            return list(pool.map(lambda question: self._votes(service, question), questions))

    def _votes(self, service: Service, question: JointQuestion) -> JointVotes:
        request = self._request(question)
        try:
            answer = self._cached(service, request)
        except EnvironmentFault as error:
            return JointVotes(note=str(error))
        return read_answer(answer, self.config.least_confidence)

    def _cached(self, service: Service, request: dict[str, Any]) -> Any:
        digest = hashlib.sha256(json.dumps([self.url, request], sort_keys=True).encode()).hexdigest()
        path = self.cache / f"{digest}.json"
        if path.is_file():
            try:
                return json.loads(path.read_text(encoding="utf-8"))
            except (OSError, ValueError):
                path.unlink(missing_ok=True)  # it was cut off
        answer = _content(service.ask("/chat/completions", json=request))
        if isinstance(answer, dict):
            self.cache.mkdir(parents=True, exist_ok=True)
            partly = path.with_suffix(f".{os.getpid()}")
            partly.write_text(json.dumps(answer), encoding="utf-8")
            partly.replace(path)
        return answer

    def _request(self, question: JointQuestion) -> dict[str, Any]:
        from kinematify.vision.question import PROMPT  # noqa: PLC0415 - it draws, and most calls ask nobody

        file = io.BytesIO()
        question.picture.save(file, format="PNG")
        picture = f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"
        content = [{"type": "text", "text": PROMPT}, {"type": "image_url", "image_url": {"url": picture}}]
        form = {"name": "joint", "strict": True, "schema": schema()}
        return {
            "model": self.model,
            "temperature": 0,
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


def _content(answer: Any) -> Any:
    """The JSON inside of a chat answer; None where there is none."""
    try:
        text = answer["choices"][0]["message"]["content"]
        return json.loads(text)
    except (KeyError, IndexError, TypeError, ValueError):
        return None
