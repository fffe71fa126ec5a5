"""STEP files: OpenCASCADE turns their surfaces into triangles and keeps the exact cylinders and planes."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.robot.gltf_file import read_gltf
from kinematify.versions import require

if TYPE_CHECKING:
    from kinematify.robot.raw_mesh import RawMesh

_TURN = 0.2
"""Angle between neighbouring triangles of a round face at most [rad]: 32 around a circle."""
_SAG = 0.01
"""Distance of triangles from a curved face, as a share of the length of its edges."""
_CONVERT = """
import cascadio, sys
sys.exit(cascadio.step_to_glb(sys.argv[1], sys.argv[2], tol_linear=float(sys.argv[3]), tol_angular=float(sys.argv[4]),
                              tol_relative=True, include_brep=True, brep_types={"cylinder", "plane"}))
"""
_NUMBERED = re.compile(r"(NAUO|=>\[|NEXT_ASSEMBLY_USAGE)[\d:\]]*", re.IGNORECASE)
"""Names that CAD programs give to instances which nobody named."""
_CONTROLS = re.compile(r"\x1b\[[\d;]*m|\*")


def read_step(path: Path, *, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read the instances of parts of a STEP file [m], whatever its unit is.

    Args:
        path: A ``.step`` or ``.stp``.
        appearance: Read colours too.

    Raises:
        EnvironmentFault: cascadio is not installed.
        ValueError: The file cannot be converted.
    """
    require(f"Reading {path} (or export it as GLB from the CAD program)", "cascadio")
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        converted = Path(folder) / "converted.glb"
        # In a process of its own: OpenCASCADE writes to the terminal, and broken files have crashed it.
        run = subprocess.run(
            [sys.executable, "-c", _CONVERT, str(path), str(converted), str(_SAG), str(_TURN)],
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
        )
        if run.returncode or not converted.is_file():
            raise ValueError(_reason(run.stdout + run.stderr))
        return read_gltf(converted, appearance=appearance, unnamed=_NUMBERED)


def _reason(output: str) -> str:
    lines = [_CONTROLS.sub("", line).strip() for line in output.splitlines()]
    return next((line for line in lines if "ERR" in line), "the converter gave no reason")
