"""Goldens of what others rely on: help, exit statuses with messages, schemas, public names, checks, configurations."""

from __future__ import annotations

import inspect
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import kinematify
from benchmarks.goldens.values import made, plain, shape_of
from kinematify.cli.app import cli
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.described import ObjectDescription
from kinematify.generate.registry import build
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.record import write_inference
from kinematify.validation.checks import CHECKS
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Iterator

    from benchmarks.goldens.values import Values

    _Golden = tuple[str, Any, Any]
    """Name, how it is worded and what is meant; None where there is no such golden."""

_WIDTH = 100
_CONFIGURATIONS = ("default", "evidence", "paper", "paper-base", "paper-open", "paper-plus")
_COMMANDS = (
    "--version", "no-such-command", "generate --list", "generate --category no -o out",
    "generate --text a_purple_idea -o out", "generate --category cabinet --set width=99 -o out",
    "infer missing -o out", "infer model -o model", "refine missing", "erase missing.urdf -o out",
    "validate missing.urdf",
    "validate model/model.urdf --engines none", "validate zero_axis.urdf --engines none",
    "validate model/model.urdf --engines unreal", "validate model/model.urdf --checks KV999",
    "validate model/model.urdf --skip KV*", "explain KV301", "explain KV999", "explain --list",
    "fix missing.urdf -o out", "fix zero_axis.urdf -o fixed.urdf", "export missing.urdf --to mjcf -o out.xml",
    "export model/model.urdf --to mjcf -o model.xml", "export model/model.urdf --to docx -o model.docx",
    "view missing.urdf", "batch missing -o out", "bench no-such-study", "bench detection --seed no",
    "nightly --no-such-option",
)  # fmt: skip
"""Words of commands that are run beside a good model and one whose axis is zero; `_` represents a space."""
_TIMES = re.compile(r"^\[ *\d+\.\d s,.*\n|; \d+\.\d s$", re.MULTILINE)
"""What is printed of progress, and how long a command took."""
_ANNOTATIONS = ("title", "description")
"""What a schema says that no file depends on."""


def surface_items(sample: bool) -> tuple[dict[str, Any], dict[str, str]]:
    """All of it, always."""
    return {name: name for name in _MAKERS}, {}


def surface_values(name: str) -> dict[str, Values]:
    """One kind of it; how click and pydantic word it is exact, since their versions are part of the platform."""
    goldens = list(_MAKERS[name]())
    return made(
        exact={thing: worded for thing, worded, _ in goldens if worded is not None},
        portable={thing: meant for thing, _, meant in goldens if meant is not None},
    )


def _help() -> Iterator[_Golden]:
    yield from _help_of(cli, "kinematify", None)


def _help_of(command: click.Command, name: str, parent: click.Context | None) -> Iterator[_Golden]:
    with click.Context(command, parent=parent, info_name=name.rsplit(maxsplit=1)[-1], terminal_width=_WIDTH) as context:
        options = [[*item.opts, *item.secondary_opts, str(getattr(item, "help", ""))] for item in command.params]
        yield name, command.get_help(context), {"help": command.help, "options": options}
        if isinstance(command, click.Group):
            for word in command.list_commands(context):
                if (inner := command.get_command(context, word)) is not None:
                    yield from _help_of(inner, f"{name} {word}", context)


def _statuses() -> Iterator[_Golden]:
    with tempfile.TemporaryDirectory(prefix="kinematify-") as name:
        folder = Path(name)
        write_blueprint(build("cabinet"), folder / "model", load_config())
        text = (folder / "model" / "model.urdf").read_text("utf-8")
        axis = next(line for line in text.splitlines() if "<axis" in line)
        (folder / "zero_axis.urdf").write_text(
            text.replace(axis, '<axis xyz="0 0 0"/>').replace('filename="', 'filename="model/'), "utf-8"
        )
        for words in _COMMANDS:
            yield words, *_ran([word.replace("_", " ") if "idea" in word else word for word in words.split()], folder)


def _ran(words: list[str], folder: Path) -> tuple[Any, Any]:
    run = subprocess.run(
        [sys.executable, "-m", "kinematify", *words],
        cwd=folder,
        env={**os.environ, "COLUMNS": str(_WIDTH), "PYTHONPATH": str(Path(kinematify.__file__).parents[1])},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    return [_TIMES.sub("", text.replace(str(folder), "")) for text in (run.stdout, run.stderr)], run.returncode


def _schemas() -> Iterator[_Golden]:
    for name, model in (
        ("configuration", type(load_config())),
        ("settings of a validation", type(load_settings())),
        ("described object", ObjectDescription),
    ):
        yield name, _without_annotations(model.model_json_schema()), None
    with tempfile.TemporaryDirectory(prefix="kinematify-") as name:
        folder = Path(name)
        blueprint = build("cabinet")
        write_blueprint(blueprint, folder, load_config())
        write_inference(infer(blueprint.assembly), folder / "out", preview=False)
        report = validate(folder / "model.urdf", engines=(), workers=1).as_json()
        report["checks"] = [{**check, "measured": {}} for check in report["checks"]]
        yield "report of a validation", None, shape_of(report)
        for file in ("truth.json", "source.json", "out/inference.json"):
            yield file, None, shape_of(json.loads((folder / file).read_text("utf-8")))


def _without_annotations(schema: Any) -> Any:
    if isinstance(schema, list):
        return [_without_annotations(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    texts = {key for key in _ANNOTATIONS if isinstance(schema.get(key), str)}  # a field may be called so
    return {key: _without_annotations(value) for key, value in schema.items() if key not in texts}


def _public() -> Iterator[_Golden]:
    from kinematify import envs  # noqa: PLC0415 - Gymnasium, which nothing else here needs

    for name in kinematify.__all__:
        thing = getattr(kinematify, name)
        if inspect.isclass(thing):
            fields = getattr(thing, "__dataclass_fields__", {})
            members = {word for word in (*dir(thing), *fields) if not word.startswith("_")}
            is_error = issubclass(thing, Exception)
            yield name, None, {"signature": "" if is_error else _signature(thing), "members": sorted(members)}
        else:
            yield name, None, _signature(thing) if callable(thing) else str(thing)
    yield "environments", None, sorted((*envs.IDS, *envs.TASK_IDS.values()))


def _signature(thing: Any) -> str:
    """Names and defaults of parameters; annotations name types that may move."""
    parameters = inspect.signature(thing).parameters.values()
    return ", ".join(
        f"{item.kind.name} {item.name}" + ("" if item.default is item.empty else f" = {item.default!r}"[:80])
        for item in parameters
    )


def _checks() -> Iterator[_Golden]:
    for name, check in CHECKS.items():
        yield name, None, plain([check.title, check.fails, check.engines])


def _configurations() -> Iterator[_Golden]:
    for name in _CONFIGURATIONS:
        yield name, None, load_config(name).model_dump(mode="json")
    yield "validation", None, load_settings().model_dump(mode="json")


_MAKERS = {
    "help": _help,
    "exit statuses": _statuses,
    "schemas": _schemas,
    "public names": _public,
    "checks": _checks,
    "configurations": _configurations,
}
