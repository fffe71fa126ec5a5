"""Any mesh file becomes named triangle meshes in the file's world frame; every failure is one AssemblyError."""

from __future__ import annotations

import importlib
import logging
import warnings
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import AssemblyError, KinematifyError
from kinematify.robot.mesh_paths import CAD_SUFFIXES, GLTF_SUFFIXES, MESH_SUFFIXES

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.raw_mesh import RawMesh

# Without a handler of its own the logger of trimesh would write to the user's terminal; a program that sets up
# logging still hears it.
logging.getLogger("trimesh").addHandler(logging.NullHandler())

_UPRIGHT = {
    "x": "-z +y +x", "y": "+x -z +y", "z": "+x +y +z", "-x": "+z +y -x", "-y": "+x +z -y", "-z": "+x -y -z",
    "X_UP": "-y -z +x", "Y_UP": "+x -z +y",
}  # fmt: skip
"""Axis that points up, by its name or by that of COLLADA -> axes that become x, y and z."""


def to_z_up(up: str) -> FloatArray:
    """Return the rotation, shape (3, 3), that turns an axis to z: ``x``, ``-y``, ``X_UP``."""
    signs = [[int(f"{word[0]}1") * (word[1] == axis) for axis in "xyz"] for word in _UPRIGHT[up].split()]
    return np.array(signs, dtype=np.float64)


def read_meshes(path: Path, *, empty_ok: bool = False, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read a mesh file: one mesh per node of a scene, group of an OBJ, or object of a 3MF, transforms applied.

    COLLADA lengths are turned into metres by the unit that the file states, and its up axis is reported but ignored: so
    does RViz, in which robots are checked by eye (Pinocchio and yourdfpy ignore the unit too). Unreferenced vertices
    may remain.

    Args:
        path: A file with one of `MESH_SUFFIXES` or `CAD_SUFFIXES`.
        empty_ok: True returns a well-formed file without triangles as it is, perhaps as no mesh at all.
        appearance: Read materials, textures and colours too; what of them cannot be read is a note, not an error.

    Raises:
        AssemblyError: The file is missing, empty, truncated, of another format, or (unless `empty_ok`) holds no
            triangle.
        EnvironmentFault: It needs a package that is not installed: a STEP, or a compressed glTF.
    """
    if path.suffix.lower() not in (*MESH_SUFFIXES, *CAD_SUFFIXES):
        raise AssemblyError(
            f"The file {path} is not a mesh that can be read. Give one of {', '.join(MESH_SUFFIXES)}; convert other "
            "formats, for example with Blender."
        )
    if not path.is_file():
        raise AssemblyError(f"There is no mesh file {path}. Check the path.")
    meshes = _guarded(path, appearance=appearance)
    if not empty_ok and not any(len(mesh.faces) for mesh in meshes):
        raise AssemblyError(
            f"The file {path} holds no triangle (it may be empty, a point cloud, or a drawing). Give a file with a "
            "triangle mesh."
        )
    return meshes


def _guarded(path: Path, *, appearance: bool) -> tuple[RawMesh, ...]:
    """Run a reader; loaders of third parties fail in as many ways as there are broken files."""
    module, _, function = _READERS[path.suffix.lower()].partition(":")
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            meshes: tuple[RawMesh, ...] = getattr(importlib.import_module(module), function)(
                path, appearance=appearance
            )
            for mesh in meshes:
                if len(mesh.faces) and not 0 <= mesh.faces.min() <= mesh.faces.max() < len(mesh.vertices):
                    raise ValueError("a face refers to a vertex that the file does not hold")
    except MemoryError as error:
        raise AssemblyError(f"The mesh file {path} does not fit into memory. Simplify it first.") from error
    except KinematifyError:
        raise
    except Exception as error:
        reason = f"{error}".strip().partition("\n")[0][:200] or type(error).__name__
        raise AssemblyError(
            f"The file {path} cannot be read as a {path.suffix.lower()} mesh ({reason}). It may be truncated or of "
            "another format: export it again and check that it opens in a viewer."
        ) from error
    return meshes


_READERS = {
    ".obj": "kinematify.robot.obj_file:read_obj",
    **dict.fromkeys((".stl", ".ply", ".off"), "kinematify.robot.general_file:read_general"),
    ".3mf": "kinematify.robot.threemf_file:read_3mf",
    ".dae": "kinematify.robot.collada_file:read_collada",
    **dict.fromkeys(GLTF_SUFFIXES, "kinematify.robot.gltf_file:read_gltf"),
    **dict.fromkeys(CAD_SUFFIXES, "kinematify.robot.step_file:read_step"),
}
"""Function of every format, which loads when a file needs it."""
