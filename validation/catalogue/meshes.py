"""KV15x: the mesh files."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check
from kinematify.validation.finding import Blame, Severity

CHECKS: tuple[Check, ...] = (
    Check(
        id="KV150",
        title="Mesh files can be read",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="Every mesh file that the URDF names opens, is complete, and its faces refer to vertices that it has.",
        matters=(
            "A truncated or lying mesh is dropped in silence by PyBullet, which also reads past the end of its arrays "
            "where a face of an OBJ refers to a vertex that is not there; MuJoCo refuses to load the model."
        ),
        remedy="Export the mesh again and check that it opens in a viewer.",
    ),
)
