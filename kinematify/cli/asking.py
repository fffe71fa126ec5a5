"""Questions to a person or a vision-language model: which pieces move together, and how."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from kinematify.vision.piece_question import PieceQuestion


vlm_option = click.option(
    "--vlm",
    default="off",
    show_default=True,
    metavar="off|auto|URL",
    help="Ask a vision-language model which pieces move together, and how: a chat interface, or that of "
    "KINEMATIFY_VLM_URL. One question an object, none where parts are given and no joint is doubtful.",
)


def asked_question(mesh: Path, up: str, scale: float | None, pieces: str) -> PieceQuestion:
    """The question about a mesh that nobody segmented.

    Raises:
        InputError: It cannot be read, or is one piece.
    """
    from kinematify.assembly.load import load_assembly
    from kinematify.config import load_config
    from kinematify.vision.piece_question import piece_question

    settings = load_config()
    return piece_question(load_assembly(mesh, config=settings.assembly, up=up, scale=scale, pieces=pieces), settings)


def infer_command(mesh: Path, answer: Path) -> str:
    """The command that makes a model of a mesh and an answer."""
    return shlex.join(["kinematify", "infer", str(mesh), "--answer", str(answer), "-o", "OUT"])
