"""The file that findings are about, and what of it is written into each of them when it is found."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from kinematify.robot.urdf_text import read_text
from kinematify.simulation.engines import ENGINES
from kinematify.validation.finding import Severity, is_unfinished

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from kinematify.robot.description import Description
    from kinematify.validation.finding import Observation

_ASKED = {"KV220": ("limit",), "KV801": ("limit",), "KV805": ("limit", "effort"), "KV226": ("effort",)}
"""What checks ask of a joint that a URDF has to state and the file may not."""


@dataclass(frozen=True, kw_only=True)
class DocumentCopy:
    """A copy, and what it does without."""

    path: Path
    lacking: frozenset[str] = frozenset()
    """Links that lack a shape or their mass, and joints that lack a number or are fixed."""
    joints: frozenset[str] = frozenset()
    """Joints that are fixed in it."""

    def doubts(self, finding: Observation) -> bool:
        """True if a finding on the copy may come of what it lacks."""
        return bool({finding.link, finding.joint, *(finding.pair or ())} & self.lacking)


@dataclass(frozen=True, kw_only=True)
class ValidatedFile:
    """A file as findings name it; it crosses a process border, so it holds plain data only."""

    lines: Mapping[tuple[str, str], int] = field(default_factory=dict)
    """Line that declares a link or joint, by ``link`` or ``joint`` and its name."""
    form: str | None = None
    """Name of its format; None for a URDF."""
    unstated: frozenset[tuple[str, str]] = frozenset()
    """What the file does not state of its joints, and a URDF has to (`Description.unstated`)."""
    native: bool = False
    """MuJoCo opens the file itself, and not the URDF that represents it."""
    copy: DocumentCopy | None = None
    """What is read in its place; None: it is read itself."""
    to_finish: str = ""
    """How a check is finished that time ran out for."""

    @classmethod
    def of(cls, description: Description) -> ValidatedFile:
        """Look up what every finding needs."""
        if description.form != "urdf":
            form, unstated = description.title, description.unstated
            return cls(lines=description.lines, form=form, unstated=unstated, native=description.native)
        robot = read_text(description.urdf).robot
        named = () if robot is None else (item for tag in ("link", "joint") for item in robot.iterfind(tag))
        return cls(lines={(str(item.tag), item.get("name") or ""): int(str(item.sourceline)) for item in named})

    def in_source(self, finding: Observation) -> Observation | None:
        """Return a finding as the user reads it; None if it is about the copy or the URDF, and not about the file."""
        if self.copy is not None and finding.engine is None and self.copy.doubts(finding):
            return None
        links = (finding.link, *(finding.pair or ()))
        named = [("joint", finding.joint or ""), *(("link", name or "") for name in links)]
        line = next((line for name in named if (line := self.lines.get(name))), None)
        if self.form is None:
            return replace(finding, line=finding.line or line)
        made_up = {(what, finding.joint) for what in _ASKED.get(finding.check, ())} & self.unstated
        if finding.check == "KV104" or made_up:
            return None  # KV104 is about the URDF's text
        if finding.check == "KV201" and self.form == "MJCF":
            return None  # MuJoCo compiles no body that moves without mass; links between joints of one body have none
        if finding.engine is None or (finding.engine == "mujoco" and self.native):
            return replace(finding, line=line)
        message = f"{finding.message} ({ENGINES[finding.engine].title} was given the URDF of the {self.form}.)"
        severity = Severity.NOTE if self.native else finding.severity  # nobody loads the file there
        return replace(finding, line=line, message=message, severity=severity)

    def reason(self, why: str | None) -> str | None:
        """Return the reason of a check with how to finish it, if time ran out for it."""
        return f"{why}; {self.to_finish}" if is_unfinished(why) else why
