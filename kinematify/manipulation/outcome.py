"""What may become of a plan, and what holds the part when it is executed."""

from __future__ import annotations

from enum import StrEnum


class Failure(StrEnum):
    """At which step a plan ended; nothing failed where it is None."""

    NO_WAY = "no way"
    """The joint moves nothing, or hardly at all."""
    NO_GRASP = "no grasp"
    NO_REACH = "no reach"
    """No place from which the arm's kinematics reach the grasp."""
    NO_PATH = "no path"
    """The grasp is reached, but no way free of collisions leads there."""
    STOPS = "stops"
    """The arm does not get far enough."""
    COVERED = "covered"
    """Another part of the object is in the way, and opening that one first does not help or fails."""
    JAMS = "jams"
    """The part runs into what no other joint can move away."""


class Hold(StrEnum):
    """What connects the hand with the part."""

    WELD = "weld"
    """They are fixed to each other once the fingers have arrived."""
    CONTACT = "contact"
    """Fingers that close, and friction."""
