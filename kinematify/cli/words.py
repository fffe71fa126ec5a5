"""Options that are a list of known words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from collections.abc import Sequence


def words_of(given: str, known: Sequence[str], option: str) -> tuple[str, ...]:
    """The words of a list, in the order in which they are known; all of them for ``all``.

    Raises:
        click.UsageError: A word is unknown.
    """
    if given == "all":
        return tuple(known)
    words = [word.strip() for word in given.split(",")]
    unknown = [word for word in words if word not in known]
    if unknown:
        raise click.UsageError(f"{option} names {unknown[0]!r}. Known are all, {', '.join(known)}.")
    return tuple(word for word in known if word in words)
