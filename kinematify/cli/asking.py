"""Options of `kinematify infer` that ask a person or a vision-language model which parts move, and how."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.vision.ask import PieceVote
    from kinematify.vision.piece_question import PieceQuestion


def asking_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options `vlm` and `answer`."""
    command = click.option(
        "--answer",
        type=click.Path(path_type=Path),
        help="Which pieces are one moving part, as a person or a chat answered `kinematify question`.",
    )(command)
    return click.option(
        "--vlm",
        default="off",
        show_default=True,
        metavar="off|auto|URL",
        help="Ask a vision-language model the same: a chat interface, or that of KINEMATIFY_VLM_URL. One question an "
        "object, none where parts are given and no joint is doubtful.",
    )(command)


def ask_pieces(given: Assembly, vlm: str, answer: Path | None, settings: Config) -> PieceVote | None:
    """What is said of the pieces of an object, by a file or a model; None where nobody is asked.

    Raises:
        InputError: The answer cannot be read, or `vlm` is neither off, auto nor an address.
    """
    if answer is None and vlm == "off":
        return None
    from kinematify.vision.ask import PieceVote, ask_about_pieces
    from kinematify.vision.client import oracle_of
    from kinematify.vision.piece_question import piece_question, read_answer_file
    from kinematify.vision.screening import known_questions

    if answer is not None:
        question = piece_question(given, settings)
        return PieceVote(voter=str(answer), question=question, answer=read_answer_file(question, answer))
    oracle = oracle_of(vlm, settings.vision)
    if oracle is None:
        return None
    return ask_about_pieces(oracle, piece_question(given, settings), lambda: known_questions(settings))


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
