"""`kinematify question`: what a person or a chat is shown of a mesh of pieces, to name the parts that move."""

from __future__ import annotations

import json
from pathlib import Path

import click

from kinematify.cli.options import examples, pieces_option, scale_option, up_option
from kinematify.errors import OutputError


@click.command(
    "question",
    epilog=examples(
        "kinematify question whole.glb -o Q",
        "kinematify question scan.stl -o Q --up y --scale 0.001",
    ),
)
@click.argument("mesh", type=click.Path(path_type=Path))
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), help="Folder for the three files.")
@up_option
@scale_option
@pieces_option
def command(*, mesh: Path, out: Path, up: str, scale: float | None, pieces: str) -> None:
    """Write sheet.png, question.txt and schema.json of MESH, an object that nobody segmented, into OUT.

    Give picture and text to any chat that reads pictures, or look yourself, and save the answer as OUT/answer.json;
    text around the JSON does no harm. `kinematify infer MESH --answer OUT/answer.json` with the same options makes the
    model; `infer MESH --vlm URL` asks a model by itself.
    """
    from kinematify.vision.piece_question import asked_question, infer_command

    question = asked_question(mesh, up, scale, pieces)
    try:
        out.mkdir(parents=True, exist_ok=True)
        question.picture.save(out / "sheet.png", optimize=True)
        (out / "question.txt").write_text(question.text + "\n", encoding="utf-8")
        (out / "schema.json").write_text(json.dumps(question.schema(), indent=1) + "\n", encoding="utf-8")
    except OSError as error:
        raise OutputError(f"The question cannot be written to {out} ({error}). Give another folder with -o.") from error
    click.echo(f"{len(question.pieces)} numbered pieces: {out / 'sheet.png'}, question.txt and schema.json beside it.")
    click.echo(f"Next: save the answer as answer.json there, then {infer_command(mesh, out / 'answer.json')} "
               "(with the same --up, --scale and --pieces).")  # fmt: skip
