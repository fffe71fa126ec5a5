"""Options of `kinematify infer` that ask a vision-language model about joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from kinematify.pipeline.inference import Inference

    Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Asking:
    """Who is asked, and about what."""

    vlm: str
    everything: bool
    types_first: bool


def asking_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options; they reach the command as `asking`, a dictionary of the fields of `Asking`."""
    options = (
        click.option(
            "--vlm",
            default="off",
            show_default=True,
            metavar="off|auto|URL",
            help="Ask a vision-language model about doubtful joints: a chat interface, or that of KINEMATIFY_VLM_URL.",
        ),
        click.option("--vlm-all", is_flag=True, help="Ask about all joints, without a budget."),
        click.option(
            "--vlm-first", is_flag=True, help="Ask for the types alone, before axes are chosen, as the paper does."
        ),
    )
    for option in reversed(options):
        command = option(command)
    return command


def with_answers(
    inference: Inference, asking: Asking, known: Collection[str], progress: Progress
) -> tuple[Inference, str, int]:
    """The joints chosen again with answers, what is to be printed of them, and the exit status that they ask for.

    Args:
        inference: What geometry says.
        asking: Who is asked.
        known: Parts that the user has given hints on.
        progress: Is given what is going on.

    Raises:
        InputError: `--vlm` is neither off, auto nor an address.
    """
    from kinematify.vision.client import oracle_of

    oracle = oracle_of(asking.vlm, inference.config.vision)
    if oracle is None:
        return inference, "", 0
    progress("asking a vision model about the joints")
    from kinematify.config import load_config
    from kinematify.vision.ask import Voting, voter_record, with_types_first, with_votes
    from kinematify.vision.screening import screening_questions
    from kinematify.vision.votes import to_ask

    if asking.types_first or inference.config.vision.first:
        inference, voting = with_types_first(inference, oracle)
    elif not to_ask(inference, everything=asking.everything, known=known)[0]:
        voting = Voting(voter=oracle.name, answers={})
    else:
        progress("asking a vision model about known objects, once for each model")
        record = voter_record(oracle, lambda: screening_questions(load_config()))
        progress("asking a vision model about the joints")
        inference, voting = with_votes(inference, oracle, record, everything=asking.everything, known=known)
    return inference, voting.described(), 0 if voting.reached else int(ExitStatus.FAULT)
