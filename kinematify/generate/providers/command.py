"""A program of the user's own as a generator: any local model that can be called with an image and a folder."""

from __future__ import annotations

import json
import os
import shlex
import signal
import string
import subprocess
import time
from contextlib import suppress
from typing import TYPE_CHECKING

from kinematify.errors import EnvironmentFault, InputError
from kinematify.generate.providers.job import keep
from kinematify.generate.providers.source import Generated, found_parts

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.generate.providers.source import Progress, Prompt

LOG_FILE = "command.log"
OUTPUT_FOLDER = "made"
FIELDS = ("image", "text", "seed", "out")
DONE_FILE = "seconds.json"
_POLL = 0.1  # between looks at the program [s]
_GRACE = 5.0  # from the polite end to the other one [s]
_LAST_LINES = 6


def run_command(template: str, limit: float, prompt: Prompt, job: Path, progress: Progress) -> Generated:
    """Run a command line with ``{image}``, ``{text}``, ``{seed}`` and ``{out}`` filled in, unless the same job has.

    No shell is involved.

    Args:
        template: The command line.
        limit: How long it may run [s].
        prompt: What to build.
        job: Folder of this request; everything that is made stays in it.
        progress: Called with what is being done and the share that is done.

    Raises:
        InputError: The command line cannot be used.
        EnvironmentFault: The program failed, or left no mesh.
    """
    arguments = filled(template, prompt, job / OUTPUT_FOLDER)
    done = job / DONE_FILE
    seconds = json.loads(done.read_text()) if done.is_file() else _ran(arguments, limit, job, progress)
    path, labels = found_parts(job / OUTPUT_FOLDER)
    keep(done, seconds)
    return Generated(
        path=path,
        labels=labels,
        provenance={
            "provider": "command",
            "model": arguments[0],
            "text": prompt.text,
            "images": [image.name for image in prompt.images],
            "seed": prompt.seed,
            "licence": "That of the program and its weights.",
            "cost": f"{seconds:.0f} s of this machine",
            "details": {"command": template},
        },
    )


def _ran(arguments: list[str], limit: float, folder: Path, progress: Progress) -> float:
    """Return how long the program ran [s]."""
    log, out, name = folder / LOG_FILE, folder / OUTPUT_FOLDER, arguments[0]
    out.mkdir(exist_ok=True)
    start = time.monotonic()
    with log.open("wb") as file:
        try:
            program = subprocess.Popen(
                arguments, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT, start_new_session=True
            )
        except OSError as error:
            raise InputError(f"The program {name!r} cannot be started: {error.strerror}. Check --command.") from error
        try:
            while (status := program.poll()) is None and (spent := time.monotonic() - start) <= limit:
                progress(f"{name} has run for {spent:.0f} s", min(0.95, spent / limit))
                time.sleep(_POLL)
        finally:
            _stop(program)
    if status is None:
        raise EnvironmentFault(
            f"The program {name!r} was stopped after {limit:.0f} s. Give it more with --time-limit. {_end_of(log)}"
        )
    if status != 0:
        raise EnvironmentFault(f"The program {name!r} ended with status {status}. {_end_of(log)}")
    return time.monotonic() - start


def filled(template: str, prompt: Prompt, out: Path) -> list[str]:
    """Fill a command line in, word by word: what is filled in is never split or interpreted.

    Raises:
        InputError: It is empty, has unknown fields, or lacks what the prompt holds.
    """
    try:
        words = shlex.split(template)
        fields = [name for word in words for _, name, _, _ in string.Formatter().parse(word) if name is not None]
    except ValueError as error:
        raise InputError(f"The command {template!r} cannot be read: {error}. Check its quotes and braces.") from error
    if not words:
        raise InputError("The command is empty. Give --command 'program {image} {out}'.")
    unknown = sorted(set(fields) - set(FIELDS))
    if unknown or "out" not in fields:
        problem = f"has unknown fields {', '.join(unknown)}" if unknown else "does not say where to write"
        raise InputError(
            f"The command {template!r} {problem}. The fields are {{image}}, {{text}}, {{seed}} and {{out}}."
        )
    for name, given in (("image", bool(prompt.images)), ("text", prompt.text is not None)):
        if name in fields and not given:
            raise InputError(f"The command needs {{{name}}}, which was not given. Give --{name}.")
    image = str(prompt.images[0]) if prompt.images else ""
    values = {"image": image, "text": prompt.text or "", "seed": str(prompt.seed), "out": str(out)}
    return [word.format(**values) for word in words]


def _stop(program: subprocess.Popen[bytes]) -> None:
    """End a program and everything that it started."""
    if program.poll() is not None:
        return
    for number in (signal.SIGTERM, signal.SIGKILL):
        with suppress(ProcessLookupError):
            os.killpg(program.pid, number)
        with suppress(subprocess.TimeoutExpired):
            program.wait(_GRACE)
            return


def _end_of(log: Path) -> str:
    """The last lines of a log that may hold anything."""
    text = log.read_bytes()[-20_000:].decode("utf-8", errors="replace")
    clean = "".join(letter if letter.isprintable() or letter == "\n" else "?" for letter in text)
    lines = [line.strip() for line in clean.splitlines() if line.strip()][-_LAST_LINES:]
    said = f"End of its output: {' | '.join(line[:200] for line in lines)}." if lines else "It printed nothing."
    return f"{said} Its output: {log}"
