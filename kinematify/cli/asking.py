"""Options of `kinematify infer` that ask a vision-language model, or a person, about joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from kinematify.pipeline import Inference
    from kinematify.refinement.hints import Hint
    from kinematify.vision.ask import Voting
    from kinematify.vision.client import ChatOracle
    from kinematify.vision.votes import AnsweredMotion

    Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Asking:
    """Who is asked, and about what."""

    vlm: str
    everything: bool
    types_first: bool
    person: bool


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
        click.option(
            "--ask", is_flag=True, help="Show the questions as a page in a browser; your answers are kept as hints."
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
        UsageError: Both a model and a person are to be asked.
    """
    if asking.person and asking.vlm not in ("off", "auto"):
        raise click.UsageError("Both --ask and --vlm are given. Leave one out.")
    if asking.person:
        return (*_told_by_person(inference, asking, known), 0)
    from kinematify.vision.client import oracle_of

    oracle = oracle_of(asking.vlm, inference.config.vision)
    if oracle is None:
        return inference, "", 0
    progress("asking a vision model about the joints")
    inference, voting = _voted(inference, oracle, asking, known, progress)
    return inference, voting.described(), 0 if voting.reached else int(ExitStatus.FAULT)


def _voted(
    inference: Inference, oracle: ChatOracle, asking: Asking, known: Collection[str], progress: Progress
) -> tuple[Inference, Voting]:
    from kinematify.vision.ask import Voting, voter_record, with_types_first, with_votes
    from kinematify.vision.votes import to_ask

    if asking.types_first or inference.config.vision.first:
        return with_types_first(inference, oracle)
    if not to_ask(inference, everything=asking.everything, known=known)[0]:
        return inference, Voting(voter=oracle.name, answers={})
    from kinematify.config import load_config
    from kinematify.vision.screening import screening_questions

    progress("asking a vision model about known objects, once for each model")
    record = voter_record(oracle, lambda: screening_questions(load_config()))
    progress("asking a vision model about the joints")
    return with_votes(inference, oracle, record, everything=asking.everything, known=known)


def _told_by_person(inference: Inference, asking: Asking, known: Collection[str]) -> tuple[Inference, str]:
    from kinematify.refinement.hints import with_hints
    from kinematify.vision.ask import motions_told
    from kinematify.vision.page import QuestionPage

    page = QuestionPage(said=lambda url: click.echo(f"Questions about the joints: {url}", err=True))
    told, voting = motions_told(inference, page, everything=asking.everything, known=known)
    hints = [_hint(inference, item) for item in told]
    words = [voting.described().replace(" and changed 0 joints", "")]
    words += [f"Kept as hints: {' '.join(text for hint in hints for text in hint.texts)}"] if hints else []
    return (with_hints(inference, hints) if hints else inference), "\n".join(words)


def _hint(inference: Inference, told: AnsweredMotion) -> Hint:
    from kinematify.robot.joint_type import JointType
    from kinematify.view.alternatives import JointAlternative
    from kinematify.view.keep import hint_of

    names = inference.assembly.names
    before = next(joint.kind for joint in inference.joints if names[joint.child] == told.child)
    motion = told.motion
    if motion is None:
        motion_kind, axis, pivot = JointType.FIXED, inference.joints[0].axis, inference.joints[0].pivot
    else:
        motion_kind, axis, pivot = motion.kind, motion.axis, motion.pivot
    return hint_of(told.child, JointAlternative(kind=motion_kind, axis=axis, pivot=pivot), before)
