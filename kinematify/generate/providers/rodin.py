"""A shape from Rodin, its parts from BANG, fetched as files: three steps, each of which is resumed and none paid twice.

Interface as of public clients of the service: ``/rodin`` and ``/bang`` take a job, ``/status`` tells how it stands,
``/download`` lists links that expire after minutes.
"""

from __future__ import annotations

import os
import re
import time
from contextlib import closing
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kinematify.errors import EnvironmentFault, InputError
from kinematify.generate.providers.job import ACCEPTED, DONE, FAILED
from kinematify.generate.providers.service import LinkExpired, NotTaken, Service
from kinematify.generate.providers.source import Generated, Provenance, found_parts

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config import RodinConfig
    from kinematify.generate.providers.job import PaidJob
    from kinematify.generate.providers.source import Progress, Prompt

KEY, ADDRESS = "RODIN_API_KEY", "RODIN_API_URL"
OUTPUT_FOLDER = "made"
_SHAPE, _PARTS, _FILES = "shape", "parts", "files"
_LARGEST_SEED = 65_536
_OVER = {"Done": DONE, "Failed": FAILED}
_SHARES = {_SHAPE: (0.0, 0.5), _PARTS: (0.5, 0.9), _FILES: (0.9, 1.0)}


@dataclass(frozen=True)
class RodinSource:
    """Images or a sentence to parts, for credits."""

    settings: RodinConfig
    budget: float | None = None
    """Credits that may be spent; no bound if None."""
    name: str = "rodin"

    def options(self) -> dict[str, object]:
        """Return what the service is sent besides the prompt."""
        chosen = self.settings
        return {
            "tier": chosen.tier,
            "mesh_mode": chosen.mesh_mode,
            "material": chosen.material,
            "strength": chosen.strength,
        }

    def generate(self, prompt: Prompt, job: PaidJob, progress: Progress) -> Generated:
        """Implement `PartSource`."""
        out = job.folder / OUTPUT_FOLDER
        if job.state(_FILES) != DONE:
            self._check_budget(job)
            with closing(_service(self.settings)) as service:
                _RodinRun(service, self.settings, prompt, job, progress).all(out)
        path, labels = found_parts(out)
        shape, parts = job.facts(_SHAPE), job.facts(_PARTS)
        return Generated(
            path=path,
            labels=labels,
            provenance=Provenance(
                provider="Hyper3D Rodin + BANG",
                model=self.settings.tier,
                text=prompt.text,
                images=tuple(image.name for image in prompt.images),
                seed=prompt.seed,
                licence="The terms of Hyper3D for the account that made it.",
                cost=f"about {self.settings.shape_credits + self.settings.parts_credits:g} credits",
                details={**self.options(), "shape": shape.get("uuid"), "parts": parts.get("uuid")},
            ),
        )

    def _check_budget(self, job: PaidJob) -> None:
        costs = {_SHAPE: self.settings.shape_credits, _PARTS: self.settings.parts_credits}
        ahead = sum(cost for step, cost in costs.items() if job.state(step) not in (ACCEPTED, DONE))
        if self.budget is not None and ahead > self.budget:
            raise InputError(
                f"The steps that are left are expected to cost {ahead:g} credits, and --budget allows {self.budget:g}. "
                "Nothing was sent."
            )


def _service(settings: RodinConfig) -> Service:
    key = os.environ.get(KEY, "").strip()
    if not key:
        raise InputError(
            f"Rodin needs a key. Set the variable {KEY} to it; it is never written anywhere. Without a key, "
            "--source command runs a model of your own, and --text without --source builds objects offline."
        )
    address = os.environ.get(ADDRESS, "").strip() or settings.url
    return Service(name="Rodin", url=address.rstrip("/"), key=key, settings=settings, key_name=KEY)


@dataclass(frozen=True)
class _RodinRun:
    """One call."""

    service: Service
    settings: RodinConfig
    prompt: Prompt
    job: PaidJob
    progress: Progress

    def all(self, out: Path) -> None:
        """Go through the steps that are not done."""
        self._step(_SHAPE, "/rodin", self._shape_request)
        self._step(_PARTS, "/bang", self._parts_request)
        self._fetch(out)

    def _step(self, step: str, path: str, request: Any) -> None:
        if self.job.state(step) == FAILED:
            raise EnvironmentFault(
                f"Rodin failed at the {step} earlier: {self.job.facts(step).get('reason')}. Call again with "
                "--resend to try once more, which may cost credits again, or change the prompt."
            )
        if self.job.state(step) not in (ACCEPTED, DONE):
            self._submit(step, path, request())
        if self.job.state(step) == ACCEPTED:
            self._wait(step)

    def _submit(self, step: str, path: str, content: dict[str, Any]) -> None:
        self._tell(step, f"asking Rodin for the {step}", 0.0)
        self.job.begin(step)
        try:
            answer = self.service.pay(path, **content)
        except (InputError, NotTaken):
            self.job.drop(step)
            raise
        uuid, key = _at(answer, "uuid"), _at(answer, "jobs", "subscription_key")
        if not uuid or not key:
            raise EnvironmentFault(
                f"Rodin answered {path} without the identifiers of a job: it may have been paid. Its interface "
                f"may have changed; look at its list of jobs. Answer: {str(answer)[:200]}"
            )
        self.job.accept(step, uuid=uuid, subscription_key=key)

    def _wait(self, step: str) -> None:
        start, pause = time.monotonic(), self.settings.first_pause
        while True:
            answer = self.service.ask("/status", json={"subscription_key": self.job.facts(step)["subscription_key"]})
            states = [str(item.get("status")) for item in _at(answer, "jobs") or () if isinstance(item, dict)]
            if not states:
                raise EnvironmentFault(f"Rodin reports no state of the {step}: {str(answer)[:200]}. Call again later.")
            if "Failed" in states:
                self.job.fail(step, "the service reports a failure")
                raise EnvironmentFault(
                    f"Rodin failed at the {step}. Its page shows why and whether it was charged; --resend tries again."
                )
            if all(_OVER.get(state) == DONE for state in states):
                self.job.finish(step)
                return
            spent = time.monotonic() - start
            if spent > self.settings.job_seconds:
                raise EnvironmentFault(
                    f"The {step} is not done after {spent:.0f} s ({', '.join(states)}). It goes on at the service; the "
                    "same call waits for it again and pays nothing."
                )
            self._tell(step, f"Rodin works on the {step}, {spent:.0f} s so far", min(0.95, spent / 300.0))
            time.sleep(pause)
            pause = min(2.0 * pause, self.settings.longest_pause)

    def _fetch(self, out: Path) -> None:
        """Fetch all files; links are asked for again when they have expired."""
        self._tell(_FILES, "fetching the parts", 0.0)
        for _ in range(self.settings.tries):
            listed = self._listed()
            try:
                out.mkdir(exist_ok=True)
                for name, url in listed:
                    if not (out / name).is_file():
                        self.service.fetch(url, out / name)
            except LinkExpired:
                continue
            self.job.finish(_FILES, names=[name for name, _ in listed])
            return
        raise EnvironmentFault(
            f"The links of Rodin had expired each of {self.settings.tries} times. Check this machine's clock; the same "
            "call asks for new ones and pays nothing."
        )

    def _listed(self) -> list[tuple[str, str]]:
        pause = self.settings.first_pause
        for _ in range(self.settings.tries):
            answer = self.service.ask("/download", json={"task_uuid": self.job.facts(_PARTS)["uuid"]})
            listed = _at(answer, "list")
            if isinstance(listed, list) and listed:
                return _named(listed)
            time.sleep(pause)  # a list may be empty for moments after the job is done
            pause = min(2.0 * pause, self.settings.longest_pause)
        raise EnvironmentFault("Rodin lists no files for a job that is done. Call again later; it pays nothing.")

    def _shape_request(self) -> dict[str, Any]:
        fields = {
            "tier": self.settings.tier,
            "mesh_mode": self.settings.mesh_mode,
            "material": self.settings.material,
            "geometry_file_format": "glb",
            "seed": str(self.prompt.seed % _LARGEST_SEED),
        }
        if self.prompt.text is not None:
            fields["prompt"] = self.prompt.text
        images = [
            ("images", (image.name, image.read_bytes(), media))
            for image, media in zip(self.prompt.images, self.prompt.media, strict=True)
        ]
        # Without images the fields go as parts of a form all the same.
        return {"files": [*images, *((name, (None, value)) for name, value in fields.items())]}

    def _parts_request(self) -> dict[str, Any]:
        fields = {
            "asset_id": str(self.job.facts(_SHAPE)["uuid"]),
            "strength": str(self.settings.strength),
            "geometry_file_format": "glb",
            "material": self.settings.material,
        }
        return {"files": [(name, (None, value)) for name, value in fields.items()]}

    def _tell(self, step: str, words: str, share: float) -> None:
        low, high = _SHARES[step]
        done = low + share * (high - low)
        self.service.report = lambda why: self.progress(why, done)
        self.progress(words, done)


def _at(answer: Any, *keys: str) -> Any:
    """A value inside an answer whose form is not ours; None where it is not there."""
    for key in keys:
        answer = answer.get(key) if isinstance(answer, dict) else None
    return answer


def _named(listed: list[Any]) -> list[tuple[str, str]]:
    """Safe, distinct file names and their links."""
    found: dict[str, str] = {}
    for item in listed:
        name, url = _at(item, "name"), _at(item, "url")
        if not isinstance(name, str) or not isinstance(url, str) or not url.startswith(("https://", "http://")):
            raise EnvironmentFault(f"Rodin lists a file without name or link: {str(item)[:200]}. Call again later.")
        safe = re.sub(r"[^A-Za-z0-9._-]", "_", name.rsplit("/", maxsplit=1)[-1]).lstrip(".") or "file"
        while safe in found:
            safe = f"_{safe}"
        found[safe] = url
    return list(found.items())
