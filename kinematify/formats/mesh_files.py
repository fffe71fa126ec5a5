"""Meshes beside a file that names them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.formats.content import Shape


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
        with (self.folder / name).open("w", encoding="ascii") as file:
            file.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in shape.vertices.tolist())
            file.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in shape.faces.tolist())
        return name
