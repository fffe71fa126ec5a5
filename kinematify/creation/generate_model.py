"""`kinematify.generate`: from a request to a model folder with its verdict."""

from __future__ import annotations

import os
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from kinematify.config import load_config
from kinematify.config.services import ADDRESS
from kinematify.creation.generated_model import GeneratedModel, not_as_asked
from kinematify.errors import InputError, KinematifyError
from kinematify.generate.blueprint_files import INFERRED_FOLDER, PARTS_FOLDER, write_blueprint, write_parts
from kinematify.generate.delivery import BuildResult, deliver
from kinematify.generate.request import read_request, request_of, with_settings
from kinematify.model.output import PREVIEW_FILE, check_output, write_model_folder
from kinematify.processes.lock import writing

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.config import Config
    from kinematify.generate.providers.language_model import Written
    from kinematify.model.kinematic_model import KinematicModel

    Progress = Callable[[str, float], None]

_INFERRED, _WRITTEN = 0.4, 0.6
"""Shares of the time at which these are done, for five joints that are inferred."""
_SOURCES = ("command", "llm")
_TAKEN_BY: dict[str, tuple[str | None, ...]] = {
    "--category": (None,),
    "--set": (None,),
    "--request": (None,),
    "--blueprint": (None,),
    "--nearest": (None,),
    "--infer": (None, "llm"),
    "--seed": (None, "command"),
    "--image": _SOURCES,
    "--command": ("command",),
    "--time-limit": _SOURCES,
    "--budget": ("llm",),
    "--rounds": ("llm",),
    "--replay": ("llm",),
}
"""Options -> the sources that take them; None is the library."""


def generate(
    text: str | None = None,
    out: str | Path | None = None,
    *,
    category: str | None = None,
    settings: Mapping[str, str | float] | None = None,
    request: str | Path | None = None,
    nearest: bool = False,
    blueprint: str | Path | None = None,
    seed: int | None = None,
    images: Sequence[str | Path] = (),
    source: Literal["reader", "command", "llm"] | None = None,
    program: str | None = None,
    time_limit: float | None = None,
    budget: float | None = None,
    rounds: int | None = None,
    replay: str | Path | None = None,
    up: str = "auto",
    scale: float | None = None,
    strict: bool = False,
    inferred: bool = False,
    config: str | Path | Config = "default",
    overwrite: bool = False,
    preview: bool = True,
    validation: bool = True,
    progress: Progress | None = None,
) -> GeneratedModel:
    """Write the model folder of an object that is described, with its exact joints, and validate it.

    Args:
        text: What to build, in English, e.g. ``a cabinet with two doors``.
        out: Folder to make; it appears whole or not at all.
        category: What to build, by the name of its kind.
        settings: Fields of the request, e.g. ``{"doors": 2, "size.width": "80cm"}``.
        request: What to build, a request in YAML or JSON.
        nearest: Take the nearest kind where the sentence names none that is known.
        blueprint: What to build, parts and joints in YAML or JSON.
        seed: Draws what is not asked for; the usual values if absent.
        images: Photos of the object, for `source`.
        source: Who makes the object: a program, a language model, or the reader of sentences alone. If absent: the
            reader, and where it does not read all of a sentence, a language model whose address is set.
        program: Its words, for the source ``command``, with ``{image}``, ``{text}``, ``{seed}`` and ``{out}``.
        time_limit: Of the program or an answer [s].
        budget: Number of tokens after which no round of the language model starts.
        rounds: Most answers of the language model.
        replay: Folder with answers of the language model to use, ``OUT.job``; nothing is sent.
        up: Axis that points up in the parts of a source.
        scale: Metres per unit of them.
        strict: Write nothing unless all is as asked for and every word was read.
        inferred: Infer the joints from the parts alone, too.
        config: All stages: a shipped name, a file or the configuration.
        overwrite: Replace an earlier model folder.
        preview: Draw a picture.
        validation: Validate the model, and write the report into the folder.
        progress: Called with the stage and the share done.

    Raises:
        InputError: What is asked for cannot be read or built, or options do not go together.
        EnvironmentFault: The source failed; the same call goes on where it stopped.
        OutputError: `out` exists and must not be replaced, or cannot be written.
    """
    given = {
        "--category": category, "--set": settings, "--request": request, "--blueprint": blueprint,
        "--nearest": nearest, "--infer": inferred, "--seed": seed, "--image": images, "--command": program,
        "--time-limit": time_limit, "--budget": budget, "--rounds": rounds, "--replay": replay,
    }  # fmt: skip
    has_model = replay is not None or bool(os.environ.get(ADDRESS, "").strip())
    may_ask = has_model and source is None and text is not None and not nearest and seed is None
    _check(text, source, {name: value for name, value in given.items() if value not in (None, (), False)}, may_ask)
    if source in (None, "reader") and strict and text is None:
        raise InputError("--strict belongs to a sentence. Remove it.")
    if out is None:
        raise InputError("Give the folder of the result: -o FOLDER.")
    place, chosen, report = Path(out), load_config(config), progress or (lambda stage, share: None)
    writer = partial(
        _written, out=place, config=chosen, strict=strict, inferred=inferred, overwrite=overwrite, preview=preview,
        validation=validation, progress=report,
    )  # fmt: skip
    with writing(place):
        check_output(place, overwrite=overwrite)
        read: BuildResult | InputError | None = None
        if source in (None, "reader"):
            try:
                read = _built(text, category, settings or {}, request, blueprint, nearest=nearest, seed=seed)
            except InputError as error:
                if not may_ask:
                    raise
                read = error
            if isinstance(read, BuildResult) and not (may_ask and read.unread):
                return writer(read)
        from kinematify.creation.other_sources import made_parts, written_blueprint  # noqa: PLC0415 - slow
        from kinematify.generate.providers.source import check_prompt  # noqa: PLC0415 - opens pictures

        prompt = check_prompt(text, tuple(map(Path, images)), seed=seed or 0)
        if source == "command":
            return made_parts(
                prompt, place, chosen, report, program=program, time_limit=time_limit, up=up, scale=scale,
                overwrite=overwrite, preview=preview, validation=validation,
            )  # fmt: skip
        try:
            answered = written_blueprint(
                prompt, place, chosen, report, rounds=rounds, time_limit=time_limit, budget=budget,
                replay=replay and Path(replay), validation=validation,
            )  # fmt: skip
        except KinematifyError as error:
            if isinstance(read, BuildResult):
                note = f"The language model was asked for what was not read, in vain: {error}"
                return writer(replace(read, notes=(*read.notes, note)))
            raise (error if read is None else type(error)(f"{read} A language model was asked: {error}")) from error
        if read is not None:
            why = f"not read: {', '.join(dict.fromkeys(read.unread))}" if isinstance(read, BuildResult) else str(read)
            note = f"The language model was asked ({why.rstrip('.')})."
            answered = replace(answered, made=replace(answered.made, notes=(*answered.made.notes, note)))
        return writer(answered.made, written=answered)


def _check(text: str | None, source: str | None, given: Mapping[str, Any], may_ask: bool) -> None:
    """Refuse options that do not go together."""
    maker = None if source == "reader" else source
    for option in given:
        takers = _TAKEN_BY[option]
        if maker not in takers and not (may_ask and "llm" in takers and option != "--image"):
            wanted = f"--source {' or '.join(filter(None, takers))}" if takers != (None,) else "no --source"
            if source is None:
                raise InputError(f"{option} needs {wanted}. Give it as well.")
            raise InputError(f"{option} cannot be combined with --source {source}; it needs {wanted}.")
    if maker is not None:
        return
    ways = ("--category", "--request", "--blueprint")
    if (text is not None) + sum(way in given for way in ways) != 1:
        raise InputError(f"Give one of a sentence, {', '.join(ways)} (or --list for all).")
    if "--blueprint" in given and given.keys() & {"--set", "--seed"}:
        raise InputError("--set and --seed have no effect on a --blueprint. Remove them.")
    if "--set" in given and text is not None:
        raise InputError("--set belongs to --category and --request. Put the value into the sentence.")
    if "--nearest" in given and text is None:
        raise InputError("--nearest belongs to a sentence. Remove it.")


def _built(
    text: str | None,
    category: str | None,
    settings: Mapping[str, Any],
    request: str | Path | None,
    blueprint: str | Path | None,
    *,
    nearest: bool,
    seed: int | None,
) -> BuildResult:
    """Build what is asked for from the library."""
    if blueprint is not None:
        from kinematify.generate.procedural.blueprint_file import read_blueprint  # noqa: PLC0415 - its schema is slow

        return BuildResult(blueprint=read_blueprint(Path(blueprint)))
    if text is not None:
        from kinematify.generate.reader import read_sentence  # noqa: PLC0415 - its words are slow

        return read_sentence(text, nearest=nearest).made(seed=seed)
    values = {"kind": category} if request is None else read_request(Path(request))
    source = "request" if request is None else f"request {request}"
    made = deliver(
        request_of(with_settings(values, {key: str(value) for key, value in settings.items()}), source=source),
        seed=seed,
    )
    if made.missing:  # a sentence may name what is not there; a request says exactly what is
        raise InputError(f"{made.differences[0][0].upper()}{made.differences[0][1:]}.")
    return made


def _written(
    made: BuildResult,
    *,
    out: Path,
    config: Config,
    strict: bool,
    inferred: bool,
    overwrite: bool,
    preview: bool,
    validation: bool,
    progress: Progress,
    written: Written | None = None,
) -> GeneratedModel:
    """Write an object with its exact joints and validate that; infer them from its parts if asked to."""
    if strict and not made.is_complete:
        raise InputError(f"{not_as_asked(made)}\nNothing is written; without --strict the rest is built.")
    if validation:
        from kinematify.simulation.engines import DEFAULT_ENGINES  # noqa: PLC0415
        from kinematify.validation.isolation import start_server  # noqa: PLC0415
        from kinematify.validation.run.needs import stages_of  # noqa: PLC0415

        start_server(stages_of(DEFAULT_ENGINES))  # its imports take a second, on another core than the inference
    blueprint, inference = made.blueprint, None
    if inferred:
        from kinematify.pipeline.infer_assembly import infer  # noqa: PLC0415

        inference = infer(
            blueprint.assembly, config=config, progress=lambda stage, done: progress(stage, _INFERRED * done)
        )
    models: list[KinematicModel] = []

    def write(folder: Path) -> None:
        share = _WRITTEN - _INFERRED
        progress("cutting the collision geometry", _INFERRED)
        models.append(write_blueprint(blueprint, folder, config, facts=made.facts))
        write_parts(blueprint, folder / PARTS_FOLDER)
        if preview:
            from kinematify.render.model_picture import render_preview  # noqa: PLC0415

            progress("drawing the picture", _INFERRED + 0.4 * share)
            render_preview(models[0], folder / PREVIEW_FILE, config.preview)
        if inference is not None:
            from kinematify.pipeline.record import write_inference_files  # noqa: PLC0415

            (folder / INFERRED_FOLDER).mkdir()
            write_inference_files(
                inference, folder / INFERRED_FOLDER, preview=preview,
                progress=lambda stage, done: progress(
                    f"the inferred model: {stage}", _INFERRED + share * (0.6 + 0.4 * done)
                ),
            )  # fmt: skip

    write_model_folder(out, write, overwrite=overwrite)
    report = None
    if validation:
        from kinematify.validation.formats.report_files import report_on  # noqa: PLC0415

        report = report_on(out, progress, _WRITTEN)
    return GeneratedModel(out=out, made=made, model=models[0], inference=inference, report=report, written=written)
