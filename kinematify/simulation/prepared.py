"""What the engine stages load and what was changed to make it loadable: `prepared.urdf` and `prepared.json`."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from kinematify.model.collision_pieces import Method

if TYPE_CHECKING:
    from pathlib import Path

URDF_FILE = "prepared.urdf"
RECORD_FILE = "prepared.json"


@dataclass(frozen=True, kw_only=True)
class PreparedLink:
    """A link as the engines get it."""

    link: str
    method: Method
    """The most work that one of its shapes needed."""
    from_visual: bool
    """True if the file declares no collision geometry and the visual one stands in for it."""
    pieces: int
    """Convex pieces and primitives."""
    gap: float
    """How far the pieces reach beyond the declared surface at most [m]."""
    volume_error: float | None
    """Volume of the pieces over that of the declared geometry, less one; None where a mesh encloses none."""
    mass: float
    """[kg]."""
    mass_added: bool
    """True if the file has no mass that engines can use; `mass` is then made up."""
    inertia_added: bool
    """True if the file has no inertia that engines can use, or one that had to be changed by more than rounding."""

    @property
    def filled(self) -> bool:
        """True if one of its pieces is the hull of a concave mesh, in whose hollows others may rightly be."""
        return self.method is Method.HULL


@dataclass(frozen=True, kw_only=True)
class Prepared:
    """The record of `prepared.urdf`. Links and joints have the names, frames, axes and limits of the original."""

    urdf: Path
    """Absolute; mesh paths in it are absolute too."""
    links: tuple[PreparedLink, ...]
    """In the order of the document."""
    drives_added: tuple[str, ...]
    """Joints whose effort or velocity the file does not state or has at zero or below; both are made up then."""

    @cached_property
    def link_by_name(self) -> dict[str, PreparedLink]:
        """Links keyed by name."""
        return {link.link: link for link in self.links}

    @property
    def total_mass(self) -> float:
        """[kg]."""
        return sum(link.mass for link in self.links)


def write_record(prepared: Prepared, work: Path) -> None:
    """Write `prepared.json`."""
    record = {"links": [asdict(link) for link in prepared.links], "drives_added": list(prepared.drives_added)}
    (work / RECORD_FILE).write_text(json.dumps(record, indent=1), encoding="utf-8")


def load_prepared(work: Path) -> Prepared:
    """Return what the stage `prepare` left in the folder of the run.

    Raises:
        OSError: It left nothing.
    """
    record = json.loads((work / RECORD_FILE).read_text(encoding="utf-8"))
    return Prepared(
        urdf=work / URDF_FILE,
        links=tuple(PreparedLink(**{**link, "method": Method(link["method"])}) for link in record["links"]),
        drives_added=tuple(record["drives_added"]),
    )
