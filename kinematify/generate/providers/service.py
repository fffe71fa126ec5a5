"""Requests to a web service: what it has not taken is sent again, what it may have taken is not."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import httpx

from kinematify.errors import EnvironmentFault, InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from kinematify.config import ServiceConfig

_TOO_MANY = 429
_LOCAL = "localhost", "127.0.0.1"
_EXCERPT = 200  # characters of an answer that is not understood


@dataclass
class Service:
    """One service with one key."""

    name: str
    url: str
    key: str = field(repr=False)
    settings: ServiceConfig
    key_name: str
    """Environment variable that holds the key, for messages."""
    report: Callable[[str], None] = lambda words: None
    """It gets the reason of each repeated request, and when it is sent."""

    def __post_init__(self) -> None:
        parts = urlsplit(self.url)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise InputError(f"{self.url!r} is no address of {self.name}. Give one like https://HOST/v1.")
        if parts.scheme != "https" and self.key and parts.hostname not in _LOCAL:
            raise InputError(
                f"The address {self.url} of {self.name} is not https, so that the key would be sent readably. Correct "
                "the address."
            )
        self._client = httpx.Client(
            timeout=httpx.Timeout(self.settings.answer_seconds),
            headers={"Authorization": f"Bearer {self.key}"} if self.key else {},
        )

    def close(self) -> None:
        """Close all connections."""
        self._client.close()

    def ask(self, path: str, **content: Any) -> Any:
        """Send a request until it is answered; again only where it has certainly not been taken.

        Args:
            path: Behind the address of the service.
            content: As `httpx.Client.post` takes it.

        Returns:
            The answer as JSON values.

        Raises:
            InputError: The key, the credit or the request is not accepted.
            EnvironmentFault: The service cannot be reached, is too busy or does not answer, or what it says is not
                usable.
        """
        fault = "no connection"
        for pause in self._pauses():
            least = 0.0
            try:
                answer = self._client.post(f"{self.url}{path}", **content)
            except (httpx.ConnectError, httpx.ConnectTimeout, httpx.PoolTimeout) as error:
                fault = str(error) or type(error).__name__
            except httpx.HTTPError as error:
                raise EnvironmentFault(
                    f"{self.name} was sent {path}, and no answer came ({error or type(error).__name__}). The same "
                    "command asks once more; --time-limit waits longer."
                ) from error
            else:
                status = answer.status_code
                if status < 400:
                    return self._json(answer)
                if status != _TOO_MANY and status < 500:
                    raise self._refusal(answer)
                fault, least = f"status {status}", _retry_after(answer)
            if pause is not None:
                seconds = max(pause, least)
                self.report(f"{self.name} did not take it ({fault}), once more in {seconds:.0f} s")
                time.sleep(seconds)
        raise EnvironmentFault(
            f"{self.name} does not answer {path} ({fault}) in {self.settings.tries} tries. Check the network, or call "
            "again later."
        )

    def _pauses(self) -> Iterator[float | None]:
        """The pause after each try [s]; None after the last one."""
        for attempt in range(self.settings.tries - 1):
            yield min(self.settings.first_pause * 2.0**attempt, self.settings.longest_pause)
        yield None

    def _json(self, answer: httpx.Response) -> Any:
        try:
            return answer.json()
        except ValueError as error:
            raise EnvironmentFault(
                f"{self.name} answered something that is no JSON: {self._excerpt(answer)}. Its interface may have "
                "changed."
            ) from error

    def _refusal(self, answer: httpx.Response) -> InputError:
        status = answer.status_code
        if status in (401, 403):
            return InputError(
                f"{self.name} does not accept the key (status {status}). Check the variable {self.key_name}."
            )
        if status == 402:
            return InputError(f"{self.name} says that there is not enough credit (status 402). Add credit.")
        return InputError(f"{self.name} refuses the request (status {status}): {self._excerpt(answer)}")

    def _excerpt(self, answer: httpx.Response) -> str:
        text = " ".join(answer.text.split())[:_EXCERPT]
        text = text.replace(self.key, "***") if self.key else text
        return text or "an empty answer"


def said(answer: Any) -> tuple[str, int]:
    """Return the text of a chat answer, and the tokens that it cost; 0 if the service does not count them.

    Raises:
        EnvironmentFault: It is no chat answer.
    """
    try:
        message = answer["choices"][0]["message"]
        text = message.get("content") or message.get("refusal") or ""
        return str(text), int((answer.get("usage") or {}).get("total_tokens") or 0)
    except (AttributeError, KeyError, IndexError, TypeError, ValueError) as error:
        raise EnvironmentFault(
            f"The service of the model gave an answer without a message ({str(answer)[:_EXCERPT]}). Check that its "
            "address is a chat interface of the usual kind."
        ) from error


def _retry_after(answer: httpx.Response) -> float:
    """Seconds that the service asks to wait; 0 if it does not say, a minute at most."""
    try:
        return min(60.0, max(0.0, float(answer.headers.get("Retry-After", "0"))))
    except ValueError:
        return 0.0
