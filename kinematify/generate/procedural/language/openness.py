"""Opening of an object: a share, an angle or a distance."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.language.sizes import angle_at, length_at

if TYPE_CHECKING:
    from kinematify.generate.procedural.language.words import Words

FRACTIONS = {
    "half": 0.5, "halfway": 0.5, "quarter": 0.25, "quarters": 0.25, "third": 1.0 / 3.0, "thirds": 1.0 / 3.0,
    "all": 1.0, "slightly": 0.15, "partly": 0.4, "partially": 0.4, "fully": 1.0, "completely": 1.0, "wide": 1.0,
}  # fmt: skip
"""Words for a share of the way."""
PULLED = ("pulled", "pushed", "swung", "slid", "pull")
"""With or without `out` they are as good as opened."""
NOT_A_STATE = ("shelf", "shelves", "compartment", "compartments", "front", "field", "top")
"""An open shelf is no state."""
_TO = ("by", "to", "at", "about", "up", "an", "angle", "of", "through", "over")


def share_at(words: Words, k: int) -> tuple[float, int] | None:
    """A share at word k and the word behind it: `30 %`, `two thirds`, `half`."""
    number, after = words.number(k), words.text(k + 1)
    percent = after in ("%", "percent") or (after, words.text(k + 2)) == ("per", "cent")
    if number is not None and percent:
        return number / 100.0, k + (3 if after == "per" else 2)
    if number is not None and after in ("third", "thirds", "quarter", "quarters"):
        return number * FRACTIONS[after], k + 2
    if words.text(k) in FRACTIONS:
        return FRACTIONS[words.text(k)], k + 1
    return None


def measured_at(words: Words, k: int) -> tuple[str, float, int] | None:
    """``share``, ``angle`` [rad] or ``distance`` [m] at word k, how much, and the word behind it."""
    for how, measured in (("angle", angle_at), ("distance", length_at), ("share", share_at)):
        if found := measured(words, k):
            return how, *found
    return None


def amount_at(words: Words, k: int) -> tuple[str, float, int] | None:
    """The same behind `open`: `by 30 degrees`."""
    while words.text(k) in _TO:
        k += 1
    return measured_at(words, k)
