"""The meshes of a robot as files in a folder beside its description."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.robot import Shape

if TYPE_CHECKING:
    from collections.abc import Collection

    from kinematify.robot.appearance import Surface, Texture
    from kinematify.robot.robot import Link


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
        self._textures: dict[Texture, str] = {}

    def write(self, shape: Shape, link: str) -> str:
        """Write a mesh in its link's frame, with its materials beside it, and return its file name."""
        name = self._name(link, "obj")
        look = shape.mesh.appearance if shape.mesh.is_dressed else None
        write_obj(self.folder / name, shape.mesh.vertices, shape.mesh.faces, OBJ_DIGITS, look)
        return name

    def write_surface(self, surface: Surface, link: str) -> str:
        """Write the faces of one material, with their places in its texture but without the material."""
        name = self._name(link, "obj")
        write_obj(self.folder / name, surface.vertices, surface.faces, OBJ_DIGITS, uv=surface.uv)
        return name

    def write_texture(self, texture: Texture) -> str:
        """Write a picture once and return its file name."""
        if texture not in self._textures:
            self._textures[texture] = self._name("texture", "png")
            from kinematify.robot.material_files import write_texture  # noqa: PLC0415  # opens pictures

            write_texture(self.folder / self._textures[texture], texture)
        return self._textures[texture]

    def _name(self, link: str, suffix: str) -> str:
        name = f"{self._count:03d}_{re.sub(r'[^A-Za-z0-9_-]', '_', link)[:60]}.{suffix}"
        self._count += 1
        return name


def with_files(link: Link, meshes: MeshFiles, kinds: Collection[str] = ("mesh",)) -> Link:
    """Return a link whose shapes of some kinds are meshes in files, in the frame of the link."""

    def written(shape: Shape) -> Shape:
        if shape.kind not in kinds:
            return shape
        return Shape(
            mesh=shape.mesh, file=Path(meshes.folder.name, meshes.write(shape, link.name)), color=shape.plain_color
        )

    return replace(link, visuals=tuple(map(written, link.visuals)), collisions=tuple(map(written, link.collisions)))
