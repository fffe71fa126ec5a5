"""Meshes beside a file that names them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from kinematify.robot.obj_file import OBJ_DIGITS, write_obj

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.robot import Shape


class MeshFiles:
    """A folder beside the exported file; every mesh is written once, under a name of its own."""

    def __init__(self, out: Path) -> None:
        """Create the folder ``<stem>_meshes`` beside `out`.

        Raises:
            OSError: It cannot be created.
        """
        self.folder = out.parent / f"{out.stem}_meshes"
        self.folder.mkdir(exist_ok=True)
        self._count = 0

    def write(self, shape: Shape, link: str) -> str:
        """Write a mesh in its link's frame and return its file name."""
        name = f"{self._count:03d}_{re.sub(r'[^A-Za-z0-9_-]', '_', link)[:60]}.obj"
        self._count += 1
        write_obj(self.folder / name, shape.mesh.vertices, shape.mesh.faces, OBJ_DIGITS)
        return name
