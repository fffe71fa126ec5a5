"""`kinematify generate`: a sentence, category or blueprint becomes an exact model; an image parts, then a model."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import complete_categories, examples, say, scale_option
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus, InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.cli.progress import Reporter
    from kinematify.generate.delivery import BuildResult

_WIDTH = 100
"""Characters of a line of --list."""


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
        "kinematify generate --image robot.jpg --source rodin --budget 2 -o out/robot",
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
    metavar="KEY=VALUE",
    help="A field of the request: a parameter of the kind, size.width, door.color, door.range; repeatable.",
)
@click.option(
    "--request",
    "request_file",
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
    type=click.Choice(["rodin", "command", "llm"]),
    help="Who makes the object: a web service (rodin; key in RODIN_API_KEY), your own program (command), or a language "
    "model that writes a blueprint (llm; address in KINEMATIFY_LLM_URL).",
)
@click.option("--command", "program", metavar="WORDS", help="Your program, with {image}, {text}, {seed} and {out}.")
@click.option("--time-limit", type=click.FloatRange(min=1.0), metavar="SECONDS", help="Limit of the program or job.")
@click.option(
    "--budget",
    type=click.FloatRange(min=0.0),
    metavar="CREDITS",
    help="Refuse a job that is expected to cost more; for llm, start no round after this number of tokens.",
)
@click.option("--rounds", type=click.IntRange(min=1), metavar="N", help="Most answers of the language model.")
@click.option(
    "--record", type=click.Path(path_type=Path), metavar="DIR", help="Save what the source makes, for --replay."
)
@click.option("--replay", type=click.Path(path_type=Path), metavar="DIR", help="Use what was recorded; send nothing.")
@click.option("--resend", is_flag=True, help="Repeat steps that failed or have no recorded answer.")
@click.option("--up", type=click.Choice(["auto", "y", "z"]), default="auto", help="Axis that points up in the parts.")
@scale_option
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Folder to write.")
@click.option("--strict", is_flag=True, help="Write nothing unless all is as asked for and every word was read.")
@click.option("--infer", "inferred", is_flag=True, help="Infer the joints from the parts alone, and compare.")
@click.option(
    "--config", default="default", show_default=True, metavar="NAME|FILE", help="Shipped or own configuration."
)
@click.option("--force", is_flag=True, help="Replace OUT if it is a model folder.")
@click.option("--no-preview", is_flag=True, help="Write no picture.")
@click.option("--no-validation", is_flag=True, help="Skip the validation, which takes most of the time.")
@json_option
def command(**given: Any) -> int:
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

    Without --source nothing is downloaded: objects are built from a library of kinds.

    With --source, another generator makes the parts from --image or --text, and the joints are inferred. A language
    model (llm) fills the request or draws a blueprint, and lists what the sentence asks for; the command measures that
    and sends back what does not hold. The job is saved beside OUT (OUT.job): the same command resumes it, and no step
    is paid for twice.
    """
    words, text, category, out, source = (given[name] for name in ("words", "text", "category", "out", "source"))
    if words and text is not None:
        raise click.UsageError(f'The sentence is given twice: "{" ".join(words)}" and --text "{text}". Remove one.')
    given["text"] = text = " ".join(words) or text
    schema = given["schema"]
    if schema is not None or given["listing"]:
        _list(category if schema is None else schema or category, given["json_to"], is_schema=schema is not None)
        return 0
    _check(given)
    from kinematify.config import load_config
    from kinematify.processes.lock import writing

    out = _needed(out)
    config = load_config(given["config"])
    if source in ("rodin", "command"):
        from kinematify.cli.provided import model_of_parts

        with writing(out), progress_reporter() as progress:
            status, answer, said = model_of_parts(given, out, config, progress)
        return _ended(status, answer, given["json_to"], lambda: say(said))
    from kinematify.processes.start import ONE_THREAD, environment_variables

    with environment_variables(ONE_THREAD):  # several cost more than they gain, and NumPy reads them as it loads
        from kinematify.cli.generation import write_generated
    ready = None if source is not None else _builder(given)
    by: list[Any] = []

    def build(progress: Reporter) -> BuildResult:
        if ready is not None:
            return ready()
        from kinematify.cli.provided import model_asked, written_by

        model = model_asked(given, config)
        by[:] = [model, written_by(model, given, out, config, progress)]
        return cast("BuildResult", by[1].made)

    with writing(out), progress_reporter() as progress:
        found = write_generated(
            build, out, preview=not given["no_preview"], validated=not given["no_validation"],
            inferred=given["inferred"], config=config, strict=given["strict"], overwrite=given["force"],
            progress=progress,
        )  # fmt: skip
    answer = found.as_json()
    if by:
        written = by[1]
        answer["language_model"] = {
            "rounds": written.rounds, "tokens": written.tokens, "answer": str(written.path)
        }  # fmt: skip

    def print_text() -> None:
        if by:
            from kinematify.cli.provided import say_written

            say_written(*by)
        found.print()

    return _ended(found.exit_status, answer, given["json_to"], print_text)


def _ended(status: int, answer: dict[str, Any], json_to: str | None, print_text: Callable[[], None]) -> int:
    """Write the answer, print the words unless a machine reads stdout, and return the exit status."""
    if write_answer(answer, json_to):
        print_text()
        if status == ExitStatus.INTERRUPTED:
            click.echo("Interrupted. The model is complete, its validation is not.", err=True)
    return status


def _builder(given: dict[str, Any]) -> Callable[[], BuildResult]:
    """Read what the options ask for, and return what builds it.

    Raises:
        InputError: It cannot be read; building raises it where a parameter is out of its bounds.
    """
    text, file = given["text"], given["request_file"]
    if given["blueprint"] is not None:
        from kinematify.generate.delivery import BuildResult
        from kinematify.generate.procedural.blueprint_file import read_blueprint

        return partial(BuildResult, blueprint=read_blueprint(given["blueprint"]))
    if text is not None:
        from kinematify.generate.reader import read_sentence

        return partial(read_sentence(text, nearest=given["nearest"]).made, seed=given["seed"])
    from kinematify.generate.delivery import deliver
    from kinematify.generate.request import read_request, request_of, with_settings

    values = {"kind": given["category"]} if file is None else read_request(file)
    source = "request" if file is None else f"request {file}"
    request = request_of(with_settings(values, _pairs(given["settings"])), source=source)

    def build() -> BuildResult:
        made = deliver(request, seed=given["seed"])
        if made.missing:  # a sentence may name what is not there; a request says exactly what is
            raise InputError(f"{made.differences[0][0].upper()}{made.differences[0][1:]}.")
        return made

    return build


_SOURCES = ("rodin", "command", "llm")
_TAKEN_BY: dict[str, tuple[str, tuple[str | None, ...]]] = {
    "--category": ("category", (None,)),
    "--set": ("settings", (None,)),
    "--request": ("request_file", (None,)),
    "--blueprint": ("blueprint", (None,)),
    "--nearest": ("nearest", (None,)),
    "--infer": ("inferred", (None, "llm")),
    "--seed": ("seed", (None, "rodin", "command")),
    "--image": ("images", _SOURCES),
    "--command": ("program", ("command",)),
    "--time-limit": ("time_limit", _SOURCES),
    "--budget": ("budget", ("rodin", "llm")),
    "--rounds": ("rounds", ("llm",)),
    "--record": ("record", _SOURCES),
    "--replay": ("replay", _SOURCES),
    "--resend": ("resend", _SOURCES),
}
"""Options -> names of their values, and the sources that take them; None is the library."""


def _check(given: dict[str, Any]) -> None:
    """Refuse options that do not go together."""
    text, settings, source = given["text"], given["settings"], given["source"]
    for option, (name, takers) in _TAKEN_BY.items():
        if given[name] not in (None, (), False) and source not in takers:
            wanted = f"--source {' or '.join(filter(None, takers))}" if takers != (None,) else "no --source"
            if source is None:
                raise click.UsageError(f"{option} needs {wanted}. Give it as well.")
            raise click.UsageError(f"{option} cannot be combined with --source {source}; it needs {wanted}.")
    if given["record"] is not None and given["replay"] is not None:
        raise click.UsageError("--record and --replay exclude each other.")
    if source is not None:
        return
    asked = {"a sentence": "text", "--category": "category", "--request": "request_file", "--blueprint": "blueprint"}
    if sum(given[name] is not None for name in asked.values()) != 1:
        raise click.UsageError(f"Give one of {', '.join(asked)} (or --list for all).")
    if given["blueprint"] is not None and (settings or given["seed"] is not None):
        raise click.UsageError("--set and --seed have no effect on a --blueprint. Remove them.")
    if settings and text is not None:
        raise click.UsageError("--set belongs to --category and --request. Put the value into the sentence.")
    for name in ("nearest", "strict"):
        if given[name] and text is None:
            raise click.UsageError(f"--{name} belongs to a sentence. Remove it.")


def _needed(out: Path | None) -> Path:
    if out is None:
        raise click.UsageError("Give the folder of the result: -o FOLDER.")
    return out


def _pairs(settings: Sequence[str]) -> dict[str, str]:
    pairs = {}
    for setting in settings:
        key, sign, value = setting.partition("=")
        if not sign or not key:
            raise click.UsageError(f"The setting {setting!r} is not KEY=VALUE, e.g. --set drawers=3.")
        pairs[key.strip()] = value.strip()
    return pairs


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
