"""What is said of a sentence: why it is refused, or what of it is not built."""

from __future__ import annotations

from kinematify.errors import InputError
from kinematify.generate.sentence import from_text


def said_of(text: str) -> str:
    """The refusal of a sentence, or the list of what is not built."""
    try:
        return "; ".join(from_text(text).made().not_built)
    except InputError as error:
        return str(error)
