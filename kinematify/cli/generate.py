"""`kinematify generate`: a sentence, category or blueprint becomes an exact model; an image parts, then a model."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import complete_categories, examples, preview_option, say, scale_option, validation_option
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from kinematify.creation.generated_model import GeneratedModel
    from kinematify.evaluation.metrics import ObjectScore
    from kinematify.generate.delivery import BuildResult

_WIDTH = 100
"""Characters of a line of --list."""


def _pairs(_context: click.Context, _parameter: click.Parameter, settings: tuple[str, ...]) -> dict[str, str] | None:
    """Fields of a request by their keys."""
    pairs = {}
    for setting in settings:
        key, sign, value = setting.partition("=")
        if not sign or not key:
            raise click.UsageError(f"The setting {setting!r} is not KEY=VALUE, e.g. --set drawers=3.")
        pairs[key.strip()] = value.strip()
    return pairs or None


@click.command(
    "generate",
    epilog=examples(
        'kinematify generate "a kitchen cabinet with two doors above three drawers, 80 cm wide" -o out/cabinet',
        "kinematify generate --category cabinet --set doors=2 --set drawer.color=red --set size.width=80cm -o out/c2",
        "kinematify generate --request oven.yaml -o out/oven",
        "kinematify generate --schema cabinet",
        'kinematify generate "a chest of drawers, half open" --seed 7 -o out/chest',
        "kinematify generate --blueprint toolbox.yaml -o out/toolbox",
        "kinematify generate --list",
        'kinematify generate "a cantilever toolbox" --source llm --budget 60000 -o out/box',
        "kinematify generate --image chair.png --source command --command 'partcrafter {image} {out}' -o out/chair",
    ),
)
@click.argument("words", nargs=-1, metavar="[SENTENCE]")
@click.option("--text", metavar="SENTENCE", help="What to build, in English: the same as SENTENCE.")
@click.option(
    "--category",
    metavar="NAME",
    shell_complete=complete_categories,
    help="What to build, by category; see --list.",
)
@click.option(
    "--set",
    "settings",
    multiple=True,
    callback=_pairs,
    metavar="KEY=VALUE",
    help="A field of the request: a parameter of the kind, size.width, door.color, door.range; repeatable.",
)
@click.option(
    "--request",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="What to build, as a typed request in YAML or JSON; --set goes before it.",
)
@click.option(
    "--schema",
    is_flag=False,
    flag_value="",
    metavar="[KIND]",
    help="Print the JSON schema of requests, with the parameters of KIND.",
)
@click.option("--nearest", is_flag=True, help="Take the nearest kind where the sentence names none that is known.")
@click.option(
    "--blueprint",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="What to build, as YAML or JSON: parts made of primitives, and joints.",
)
@click.option("--seed", type=int, help="Draw at random what is not asked for; default: the defaults of the category.")
@click.option("--list", "listing", is_flag=True, help="Show the categories, or the parameters of --category.")
@click.option(
    "--image",
    "images",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="A photo of the object, for --source; up to five views may be given.",
)
@click.option(
    "--source",
    type=click.Choice(["reader", "command", "llm"]),
    help="Who makes the object: the reader of sentences alone, your own program, or a language model (address in "
    "KINEMATIFY_LLM_URL). Default: the reader; the language model where words are left and the address is set.",
)
@click.option("--command", "program", metavar="WORDS", help="Your program, with {image}, {text}, {seed} and {out}.")
@click.option("--time-limit", type=click.FloatRange(min=1.0), metavar="SECONDS", help="Limit of the program or answer.")
@click.option(
    "--budget",
    type=click.FloatRange(min=0.0),
    metavar="TOKENS",
    help="Start no round of the language model after this number of tokens.",
)
@click.option("--rounds", type=click.IntRange(min=1), metavar="N", help="Most answers of the language model.")
@click.option(
    "--replay",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Use the answers in such a folder, OUT.job; send nothing.",
)
@click.option("--up", type=click.Choice(["auto", "y", "z"]), default="auto", help="Axis that points up in the parts.")
@scale_option
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Folder to write.")
@click.option("--strict", is_flag=True, help="Write nothing unless all is as asked for and every word was read.")
@click.option("--infer", "inferred", is_flag=True, help="Infer the joints from the parts alone, and compare.")
@click.option(
    "--config", default="default", show_default=True, metavar="NAME|FILE", help="Shipped or own configuration."
)
@click.option("--force", "overwrite", is_flag=True, help="Replace OUT if it is a model folder.")
@preview_option
@validation_option
@json_option
def command(*, words: tuple[str, ...], schema: str | None, listing: bool, json_to: str | None, **given: Any) -> int:
    """Build what a sentence, a request or a blueprint asks for, with its exact joints, and validate it.

    A request names a kind, its parameters, sizes, and facts about named parts: count, size, colour, material, side,
    range, opening; --schema shows all fields. A sentence fills as much of a request as it can. Words that it does not
    read are listed, and the object is measured against the request: what is not as asked is listed, and the command
    ends with 1; with --strict it writes nothing and ends with 2. An unknown kind, key or value ends with 2, and the
    message lists what there is.

    OUT becomes a model folder: model.urdf, meshes/, preview.png, the validation report (validation.html and
    validation.json), the exact joints (truth.json) and the parameters (source.json). parts/ holds one mesh per part,
    without joints. With --infer the joints are inferred from parts/ alone: inferred/ is that model, and the command
    prints how far it is from the exact one.

    The command also ends with 1 if the model has an error; see `kinematify validate`.

    Objects are built from a library of kinds. If KINEMATIFY_LLM_URL names a server, a sentence of which the reader
    leaves words, or whose kind it does not know, is sent there, which may cost money; --source reader, --seed and
    --nearest send nothing.

    A language model (llm) fills the request or draws a blueprint, and lists what the sentence asks for; the command
    measures that and sends back what does not hold. With --source command, another generator makes the parts from
    --image or --text, and the joints are inferred. Every answer is saved beside OUT (OUT.job): the same command resumes
    there, and no answer is paid for twice.
    """
    sentence, text, category, out = (" ".join(words), given["text"], given["category"], given["out"])
    if words and text is not None:
        raise click.UsageError(f'The sentence is given twice: "{sentence}" and --text "{text}". Remove one.')
    given["text"] = sentence or text
    if schema is not None or listing:
        _list(category if schema is None else schema or category, json_to, is_schema=schema is not None)
        return 0
    if out is None:
        raise click.UsageError("Give the folder of the result: -o FOLDER.")
    from kinematify.processes.start import ONE_THREAD, environment_variables

    with environment_variables(ONE_THREAD):  # several cost more than they gain, and NumPy reads them as it loads
        from kinematify.creation.generate_model import generate
    with progress_reporter() as progress:
        done = generate(**given, progress=progress)
    if write_answer(_as_answer(done), json_to):
        say("\n\n".join(block for block in _blocks(done) if block))
        if done.exit_status == ExitStatus.INTERRUPTED:
            click.echo("Interrupted. The model is complete, its validation is not.", err=True)
    return done.exit_status


def _as_answer(done: GeneratedModel) -> dict[str, Any]:
    """Everything as JSON values."""
    from kinematify.cli.inferred import validation_answer
    from kinematify.creation.generated_model import job_folder

    made, written, parts = done.made, done.written, done.parts
    answer: dict[str, Any] = {"schema": 1, "out": str(done.out), "validation": validation_answer(done.report)}
    if parts is not None:
        return {**answer, "job": str(job_folder(done.out)), "provenance": parts.provenance}
    assert made is not None
    score = _score(done)
    answer |= {
        "category": made.blueprint.family,
        "parameters": dict(made.blueprint.parameters),
        "request": made.facts.get("request"),
        "notes": list(made.notes),
        "differences": list(made.differences),
        "unread": list(made.unread),
        "accuracy": None if score is None else _accuracy(score),
    }
    if written is not None:
        answer["language_model"] = {
            "rounds": written.rounds, "tokens": written.tokens, "answer": str(written.path)
        }  # fmt: skip
    return answer


def _blocks(done: GeneratedModel) -> list[str]:
    """What is said, how well the joints were inferred last."""
    from kinematify.cli.inferred import describe, describe_files, describe_joints, describe_validation
    from kinematify.creation.generated_model import job_folder, not_as_asked
    from kinematify.generate.blueprint_files import INFERRED_FOLDER

    made, written, judged = done.made, done.written, describe_validation(done.report, done.out)
    if done.parts is not None and done.inference is not None:
        maker = done.parts.provenance
        words = (
            f"Parts of {maker['model']}, cost: {maker['cost']}. Terms: {maker['licence']}\n"
            f"{job_folder(done.out)}: everything that the generator made; the same request is not sent again"
        )
        return [words, describe(done.inference, done.out), judged]
    assert made is not None
    score = _score(done)
    by = ""
    if written is not None:
        how = "Drawn" if made.request is None else "Filled in"
        model = made.blueprint.parameters["model"]
        by = f"{how} by {model} in {written.rounds} rounds, {written.tokens} tokens: {written.path}"
    inferred = f"Inferred from the parts alone: {done.out / INFERRED_FOLDER / 'model.urdf'}\n"
    return [
        by,
        _read(made),
        f"Base: {done.model.root}\n\n{describe_joints(done.model.joints)}",
        "\n".join(describe_files(done.out)),
        judged,
        "" if score is None else inferred + _describe_score(score),
        not_as_asked(made),
    ]


def _score(done: GeneratedModel) -> ObjectScore | None:
    """Comparison of the inferred joints with those that the object was built with."""
    from kinematify.evaluation.metrics import score_blueprint

    return None if done.inference is None or done.made is None else score_blueprint(done.made.blueprint, done.inference)


def _read(made: BuildResult) -> str:
    """The request as it was read, for who wants to see whether that is what was meant."""
    if made.request is None:
        return "\n".join(made.notes)
    asked = made.request
    facts = [f"{name} {value}" for name, value in asked.parameters.items()]
    facts += [f"{name} {value:.3g} m" for name, value in asked.size.items()]
    for noun, part in asked.parts.items():
        said = part.model_dump(exclude_defaults=True)
        facts.append(f"{noun} ({', '.join(f'{name} {_shown(value)}' for name, value in said.items()) or 'any'})")
    return "\n".join([*made.notes, f"Request: {asked.kind}{': ' if facts else ''}{'; '.join(facts)}."])


def _shown(value: Any) -> str:
    return (
        ", ".join(map(_shown, value))
        if isinstance(value, tuple)
        else f"{value:.3g}"
        if isinstance(value, float)
        else str(value)
    )


def _accuracy(score: ObjectScore) -> dict[str, Any]:
    angles = [joint.angle_deg for joint in score.joints]
    return {
        "joints": len(angles),
        "types_right": sum(joint.type_right for joint in score.joints),
        "tree_edit_distance": score.ted.value,
        "mean_axis_angle_deg": sum(angles) / len(angles) if angles else None,
        "largest_axis_angle_deg": max(angles, default=None),
    }


def _describe_score(score: ObjectScore) -> str:
    facts = _accuracy(score)
    if not facts["joints"]:
        return "Against the known joints: there are none."
    return (
        f"Against the known joints: {facts['types_right']} of {facts['joints']} types right, axes off by "
        f"{facts['mean_axis_angle_deg']:.2f} deg on average and {facts['largest_axis_angle_deg']:.2f} deg at most, "
        f"tree {'exact' if facts['tree_edit_distance'] == 0 else 'off by ' + format(facts['tree_edit_distance'], 'g')}."
    )


def _categories() -> str:
    from kinematify.generate.registry import all_kinds

    rows = [
        (family.name, family.title, ", ".join(p.name for p in family.parameters)) for family in all_kinds().values()
    ]
    table = format_table(("category", "what it is", "parameters"), rows, width=_WIDTH)
    return f"{table}\n\nParameters with units and ranges: kinematify generate --list --category NAME"


def _list(category: str | None, json_to: str | None, *, is_schema: bool) -> None:
    if is_schema:
        from kinematify.generate.request import schema_of

        click.echo(json.dumps(schema_of(category), indent=1))
        return
    if write_answer(_listing(category), json_to):
        click.echo(_parameters(category) if category else _categories())


def _listing(category: str | None) -> dict[str, Any]:
    """Categories with their parameters, or one of them, as JSON values."""
    from kinematify.generate.registry import all_kinds
    from kinematify.generate.request import find_family

    families = [find_family(category)] if category else list(all_kinds().values())
    return {
        "schema": 1,
        "categories": [
            {
                "name": family.name,
                "title": family.title,
                "words": list(family.words),
                "parameters": [
                    {
                        "name": item.name,
                        "default": item.default,
                        "unit": item.unit or None,
                        "bounds": None if item.bounds is None else list(item.bounds),
                        "choices": [choice for choice in item.choices if choice],
                        "help": item.help,
                    }
                    for item in family.all_parameters
                ],
            }
            for family in families
        ],
    }


def _parameters(category: str) -> str:
    from kinematify.generate.procedural.parameter import PARAMETER_HEADINGS, parameter_rows
    from kinematify.generate.request import find_family

    family = find_family(category)
    table = format_table(PARAMETER_HEADINGS, parameter_rows(family.all_parameters))
    words = f"Also called: {', '.join(family.words)}."
    return f"{family.title}\n\n{table}\n\n{words}"
