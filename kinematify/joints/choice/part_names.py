"""What the name of a part says of its joint: a drawer slides, a door turns, a foot is fixed.

Names that people give are words of their language, often with sides and numbers about them ("door_left", "Wheel.003").
They add a bounded term to what was measured; anonymous names ("part_007", "mesh12") say nothing. What the term may add
was set where names of installed packages' models and of real objects, left out of each other, are chosen best.
"""

from __future__ import annotations

import re

from kinematify.joints.measure.measurements import FIXED, SLIDE, TURN

_WORDS = {
    SLIDE: "drawer tray slider slide button key keycap piston plunger carriage cartridge telescope",
    TURN: (
        "door flap hatch wheel handwheel tire tyre caster knob dial crank propeller prop rotor fan blade turntable "
        "gate lever pedal valve tap faucet arm forearm upperarm elbow wrist shoulder hip knee thigh shin calf "
        "ankle screen visor rudder aileron elevator tailgate trunk bonnet hood thruster pulley gear roller "
        "drum needle pointer shutter"
    ),
    FIXED: (
        "foot feet shelf shelves label logo badge sticker glass pane trim bracket rivet bumper backboard skirting "
        "plinth mounting grille casing housing mirror headlight upholstery cushion"
    ),
}
_KIND_OF = {word: kind for kind, words in _WORDS.items() for word in words.split()}
_SILENT = frozenset(["handle", "grip", "frame", "hinge"])
_LEAST_END = 4
_TOKEN = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")


def kind_said(name: str) -> int | None:
    """FIXED, TURN or SLIDE where a word of the name says so, None where none does.

    The last word that says something decides, as in "oven door" and "drawer_2". Names with a word such as "handle"
    say nothing: those of doors turn, those of drawers are fixed.
    """
    said = None
    for token in _TOKEN.findall(name):
        word = token.lower()
        if word.removesuffix("s") in _SILENT:
            return None
        said = _said_of(word, otherwise=said)
    return said


def _said_of(word: str, *, otherwise: int | None) -> int | None:
    """Of a word, its singular, or what it ends with ("hingedoor")."""
    for form in (word, word.removesuffix("s")):
        if form in _KIND_OF:
            return _KIND_OF[form]
    ends = [known for known in _KIND_OF if len(known) >= _LEAST_END and word.endswith(known)]
    return _KIND_OF[max(ends, key=len)] if ends else otherwise
