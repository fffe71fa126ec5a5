"""Requests to a web service that takes money: what may be repeated is, what may have been paid is not."""

from __future__ import annotations

import ipaddress
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import httpx

from kinematify.errors import EnvironmentFault, InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from kinematify.config import ServiceConfig

_TOO_MANY, _BUSY = 429, 503
_LINK_GONE = (401, 403, 404, 410)
_EXCERPT = 200  # characters of an answer that is not understood
_CHUNK = 1 << 20


class NotTaken(EnvironmentFault):
    """The service has certainly not taken a request: nothing was paid."""


class LinkExpired(EnvironmentFault):
    """A file is not, or no longer, at its address."""


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
    """Told why it is asked again, and when."""

    def __post_init__(self) -> None:
        parts = urlsplit(self.url)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise InputError(f"{self.url!r} is no address of {self.name}. Give one like https://HOST/v1.")
        if parts.scheme != "https" and self.key and not _is_local(parts.hostname):
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
        """Send what costs nothing, again and again until it is answered; returns the answer as JSON values.

        Raises:
            InputError: The key or the request is not accepted.
            EnvironmentFault: There is no usable answer.
        """
        fault: Exception | None = None
        for pause in self._pauses():
            try:
                answer = self._client.post(f"{self.url}{path}", **content)
            except httpx.HTTPError as error:
                fault = error
                self._rest(_words(error), pause)
                continue
            if answer.status_code < 400:
                return self._json(answer)
            if answer.status_code != _TOO_MANY and answer.status_code < 500:
                raise self._refusal(answer)
            fault = EnvironmentFault(f"status {answer.status_code}")
            self._rest(str(fault), pause, _retry_after(answer))
        raise EnvironmentFault(
            f"{self.name} does not answer {path} ({_words(fault)}) after {self.settings.tries} tries. Check the "
            "network and the state of the service; the same call goes on where this one stopped."
        ) from fault

    def pay(self, path: str, **content: Any) -> Any:
        """Send what costs money: repeated only where the service has certainly not taken it.

        Raises:
            InputError: The key, the credit or the request is not accepted; nothing was paid.
            NotTaken: The service could not be reached, or was too busy; nothing was paid.
            EnvironmentFault: It may have been paid.
        """
        fault = "no connection"
        for pause in self._pauses():
            try:
                answer = self._client.post(f"{self.url}{path}", **content)
            except (httpx.ConnectError, httpx.ConnectTimeout, httpx.PoolTimeout) as error:
                fault = _words(error)
                self._rest(fault, pause)
                continue
            except httpx.HTTPError as error:
                raise EnvironmentFault(
                    f"{self.name} was sent {path}, and no answer came ({_words(error)}): it may have been paid. Look "
                    "at its list of jobs; --resend sends it once more."
                ) from error
            if answer.status_code in (_TOO_MANY, _BUSY):
                fault = f"status {answer.status_code}, too many requests"
                self._rest(fault, pause, _retry_after(answer))
                continue
            if answer.status_code >= 500:
                raise EnvironmentFault(
                    f"{self.name} answered {path} with status {answer.status_code}: it may have been paid. Look at its "
                    "list of jobs; --resend sends it once more."
                )
            if answer.status_code >= 400:
                raise self._refusal(answer)
            return self._json(answer)
        raise NotTaken(
            f"{self.name} has not taken {path} ({fault}) in {self.settings.tries} tries; nothing was paid. Check "
            "the network, or call again later."
        )

    def fetch(self, url: str, out: Path) -> None:
        """Fetch a file whole or not at all; the key is not sent to where it lies.

        Raises:
            LinkExpired: The link is not valid any more.
            EnvironmentFault: The file is too large, or stays incomplete.
        """
        partly, fault = out.with_name(f"{out.name}.partly"), "nothing"
        for pause in self._pauses():
            try:
                with httpx.stream("GET", url, timeout=self.settings.answer_seconds, follow_redirects=True) as answer:
                    if answer.status_code in _LINK_GONE:
                        raise LinkExpired(f"The link to {out.name} has expired (status {answer.status_code}).")
                    answer.raise_for_status()
                    size = self._saved(answer, partly)
            except httpx.HTTPError as error:
                fault = _words(error)
                self._rest(fault, pause)
                continue
            if problem := _incomplete(partly, size):
                fault = problem
                self._rest(fault, pause)
                continue
            partly.replace(out)
            return
        partly.unlink(missing_ok=True)
        raise EnvironmentFault(
            f"The file {out.name} of {self.name} could not be fetched whole in {self.settings.tries} tries ({fault}). "
            "Check the network; the same call fetches it again and pays nothing."
        )

    def _saved(self, answer: httpx.Response, partly: Path) -> int:
        size = 0
        with partly.open("wb") as file:
            for chunk in answer.iter_bytes(_CHUNK):
                size += len(chunk)
                if size > self.settings.most_bytes:
                    raise EnvironmentFault(
                        f"A file of {self.name} has more than {self.settings.most_bytes} bytes and was not fetched. "
                        "Raise sources.rodin.most_bytes if that is meant."
                    )
                file.write(chunk)
        return size

    def _pauses(self) -> Iterator[float | None]:
        """The pause after each try [s]; None after the last one."""
        for attempt in range(self.settings.tries - 1):
            yield min(self.settings.first_pause * 2.0**attempt, self.settings.longest_pause)
        yield None

    def _rest(self, fault: str, pause: float | None, least: float = 0.0) -> None:
        """Wait before the next try, and say so; `least` is what the service asks for [s]."""
        if pause is None:
            return
        seconds = max(pause, least)
        self.report(f"{self.name} did not take it ({fault}), once more in {seconds:.0f} s")
        time.sleep(seconds)

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
            return InputError(
                f"{self.name} says that there is not enough credit (status 402). Nothing was paid; add credit."
            )
        return InputError(f"{self.name} refuses the request (status {status}): {self._excerpt(answer)}")

    def _excerpt(self, answer: httpx.Response) -> str:
        text = " ".join(answer.text.split())[:_EXCERPT]
        text = text.replace(self.key, "***") if self.key else text
        return text or "an empty answer"


def _is_local(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _retry_after(answer: httpx.Response) -> float:
    """Seconds that the service asks to wait; 0 if it does not say, a minute at most."""
    try:
        return min(60.0, max(0.0, float(answer.headers.get("Retry-After", "0"))))
    except ValueError:
        return 0.0


def _words(error: Exception | None) -> str:
    return str(error) or type(error).__name__


def _incomplete(path: Path, size: int) -> str | None:
    """Return what is missing of a file; a GLB says how long it is."""
    if not size:
        return "it is empty"
    with path.open("rb") as file:
        head = file.read(12)
    if head[:4] == b"glTF" and len(head) == 12 and int.from_bytes(head[8:12], "little") != size:
        return f"{size} of {int.from_bytes(head[8:12], 'little')} bytes"
    return None
