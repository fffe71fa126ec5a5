"""What a fault is: how it is planted, and what a finding must say to have found it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from lxml.etree import _Element

    from kinematify.robot.robot import Joint, Link, Robot
    from kinematify.validation.finding import Blame


@dataclass(frozen=True, kw_only=True)
class Planted:
    """Where a fault was planted."""

    how: str
    """What was done, with numbers."""
    joint: str | None
    """Joint that must be named, or the joint that carries the link."""
    links: tuple[str, ...]
    """Links of which one may be named instead; empty where the whole model is wrong and any name is right."""


JointPlanter = Callable[["_Element", "Joint", "Robot", "np.random.Generator"], Planted | None]
"""Changes the robot element in place; None where the fault would change nothing, so that there is none."""
LinkPlanter = Callable[["_Element", "Link", "Robot", "np.random.Generator"], Planted | None]


@dataclass(frozen=True, kw_only=True)
class Fault:
    """A kind of fault."""

    name: str
    kinematic: bool
    """A motion is wrong; otherwise the file is."""
    blames: frozenset[Blame]
    """A finding must put one of these."""
    plant_joint: JointPlanter | None = None
    plant_link: LinkPlanter | None = None
