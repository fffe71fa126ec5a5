"""`kinematify generate`: a sentence or a category becomes parts with exact joints, and the model inferred from them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.help import examples
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.benchmark.metrics import ObjectScore
    from kinematify.sources.procedural.request import Request


@click.command(
    "generate",
    short_help="A sentence -> parts with exact joints -> a model, offline.",
    epilog=examples(
        'kinematify generate --text "a kitchen cabinet with two doors above three drawers, 80 cm wide" -o out/cabinet',
        "kinematify generate --category cabinet --set doors=2 --set drawers=3 --set handle=knob -o out/c2",
        'kinematify generate --text "a chest of drawers, half open" --seed 7 -o out/chest',
        "kinematify generate --list",
        "kinematify generate --list --category cabinet",
        "kinematify generate --corpus 100 --seed 1 -o corpus",
    ),
)
@click.option("--text", metavar="SENTENCE", help="What to build, in English.")
@click.option("--category", metavar="NAME", help="What to build, by category; see --list.")
@click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help="A parameter of the category, repeatable.")
@click.option("--corpus", type=click.IntRange(min=1), metavar="N", help="N objects of all categories, as a benchmark.")
@click.option("--seed", type=int, help="Draw what is not asked for; without it the defaults are taken.")
@click.option("--list", "listing", is_flag=True, help="Show the categories, or the parameters of --category.")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Folder to make.")
@click.option("--force", is_flag=True, help="Replace OUT if it is a model folder.")
@click.option("--no-preview", is_flag=True, help="Write no picture.")
@json_option
def command(
    *,
    text: str | None,
    category: str | None,
    settings: tuple[str, ...],
    corpus: int | None,
    seed: int | None,
    listing: bool,
    out: Path | None,
    force: bool,
    no_preview: bool,
    json_to: str | None,
) -> None:
    """Build an object whose joints are known, infer them again from its parts alone, and say how well that went.

    OUT becomes a model folder: model.urdf as it was inferred, meshes/, inference.json and preview.png; parts/ holds
    what the inference saw, one mesh per part, and truth/ the exact model, which it never opens.

    Nothing is downloaded: objects are put together from boards, hinges, slides and bearings by rules.
    """
    from kinematify.sources.procedural.request import from_category, from_text

    if listing:
        click.echo(_parameters(category) if category else _categories())
        return
    if corpus is not None:
        _write_corpus(corpus, seed or 0, _needed(out), text or category)
        return
    if (text is None) == (category is None):
        raise click.UsageError("Give either --text or --category (or --corpus, or --list to see what there is).")
    if settings and text is not None:
        raise click.UsageError("--set belongs to --category. Say it in the text, or name the category instead.")
    request = from_text(text) if text is not None else from_category(category or "", _pairs(settings))
    answer = _generate(request, seed, _needed(out), force=force, preview=not no_preview, quiet=json_to == "-")
    if json_to:
        write_answer(answer, json_to)


def _needed(out: Path | None) -> Path:
    if out is None:
        raise click.UsageError("Say where the result goes: -o FOLDER.")
    return out


def _pairs(settings: Sequence[str]) -> dict[str, str]:
    pairs = {}
    for setting in settings:
        key, sign, value = setting.partition("=")
        if not sign or not key:
            raise click.UsageError(f"The setting {setting!r} is not KEY=VALUE, e.g. --set drawers=3.")
        pairs[key.strip()] = value.strip()
    return pairs


def _generate(
    request: Request, seed: int | None, out: Path, *, force: bool, preview: bool, quiet: bool
) -> dict[str, Any]:
    from kinematify.benchmark.metrics import score_object
    from kinematify.benchmark.prediction import prediction_of
    from kinematify.cli.infer import describe
    from kinematify.config import load_config
    from kinematify.model.output import check_output, write_model_folder
    from kinematify.pipeline import infer
    from kinematify.pipeline.generate import PARTS_FOLDER, TRUTH_FOLDER, write_parts, write_truth
    from kinematify.pipeline.record import write_inference_files
    from kinematify.sources.procedural.truth import ground_truth

    check_output(out, overwrite=force)
    blueprint = request.build(seed=seed)
    config = load_config()
    with progress_reporter() as progress:
        inference = infer(blueprint.assembly, config=config, progress=progress)
        progress("writing the model", 1.0)

        def write(folder: Path) -> None:
            write_inference_files(inference, folder, preview=preview)
            write_parts(blueprint, folder / PARTS_FOLDER)
            write_truth(blueprint, folder / TRUTH_FOLDER, config)

        write_model_folder(out, write, overwrite=force)
    truth = ground_truth(blueprint)
    index = {name: k for k, name in enumerate(truth.part_names)}
    score = score_object(
        truth,
        prediction_of(inference.trees[0], inference.joints, inference.assembly.names, index),
        centroids=[part.centroid for part in blueprint.parts],
        diagonal=blueprint.assembly.diagonal,
    )
    if not quiet:
        click.echo("\n".join([*_say_understood(request), describe(inference, out), "", _say_score(score)]))
    return {
        "schema": 1,
        "out": str(out),
        "category": request.family,
        "parameters": dict(blueprint.parameters),
        "understood": list(request.understood),
        "ignored": list(request.ignored),
        "accuracy": _accuracy(score),
    }


def _say_understood(request: Request) -> list[str]:
    lines = [f"Understood: {', '.join(request.understood)}."] if request.understood else []
    if request.ignored:
        lines.append(f"Not understood, and left out: {', '.join(request.ignored)}.")
    return [*lines, ""] if lines else []


def _accuracy(score: ObjectScore) -> dict[str, Any]:
    angles = [joint.angle_deg for joint in score.joints]
    return {
        "joints": len(angles),
        "types_right": sum(joint.type_right for joint in score.joints),
        "tree_edit_distance": score.ted.value,
        "mean_axis_angle_deg": sum(angles) / len(angles) if angles else None,
        "largest_axis_angle_deg": max(angles, default=None),
    }


def _say_score(score: ObjectScore) -> str:
    facts = _accuracy(score)
    if not facts["joints"]:
        return "Against the known joints: there are none."
    return (
        f"Against the known joints: {facts['types_right']} of {facts['joints']} types right, axes off by "
        f"{facts['mean_axis_angle_deg']:.2f} deg on average and {facts['largest_axis_angle_deg']:.2f} deg at most, "
        f"tree {'exact' if facts['tree_edit_distance'] == 0 else 'off by ' + format(facts['tree_edit_distance'], 'g')}."
    )


def _categories() -> str:
    from kinematify.sources.procedural.families import FAMILIES

    rows = [(family.name, family.title, ", ".join(p.name for p in family.parameters)) for family in FAMILIES.values()]
    return format_table(("category", "what it is", "parameters"), rows)


def _parameters(category: str) -> str:
    from kinematify.sources.procedural.request import find_family

    family = find_family(category)
    rows = []
    for parameter in family.all_parameters:
        values = ", ".join(choice for choice in parameter.choices if choice)
        if parameter.bounds is not None:
            values = f"{parameter.bounds[0]:g} to {parameter.bounds[1]:g} {parameter.unit}".rstrip()
        rows.append((parameter.name, str(parameter.default), values, parameter.help))
    words = f"Also called: {', '.join(family.words)}."
    return f"{family.title}\n\n{format_table(('parameter', 'default', 'values', 'what it is'), rows)}\n\n{words}"


def _write_corpus(count: int, seed: int, out: Path, only: str | None) -> None:
    from kinematify.pipeline.corpus import write_corpus

    if only is not None:
        raise click.UsageError("--corpus takes all categories; leave out --text and --category.")
    with progress_reporter() as progress:
        manifest = write_corpus(out, count, seed=seed, progress=progress)
    click.echo(f"{count} objects: {manifest}\nNext: kinematify bench {out} -o results --name corpus")
