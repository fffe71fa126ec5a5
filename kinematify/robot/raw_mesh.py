"""A mesh as a file holds it: what every reader of meshes returns."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.appearance import joined
from kinematify.robot.exact_faces import ExactFaces, joined_faces
from kinematify.robot.vectors import as_one
from kinematify.robot.weld import without_unused

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.appearance import Appearance
    from kinematify.robot.arrays import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class RawMesh:
    """A triangle mesh as it is in a file, not yet checked."""

    name: str
    """Name of the node, group or object; empty where the file names none."""
    vertices: FloatArray
    """File's world frame and unit, shape (V, 3); may hold anything, NaN included."""
    faces: IntArray
    """Shape (F, 3); every index is below V."""
    unit: str = ""
    """Unit that the file states, where it is neither metres nor converted to them."""
    up: str = ""
    """``X_UP`` or ``Y_UP`` if the file states such an axis, which was not respected."""
    appearance: Appearance | None = None
    """Of the faces; None where the file states no material and no colours, and where it was not asked for."""
    exact: ExactFaces | None = None
    """Cylinders and planes in the frame of the vertices, of this mesh and of what it was cut from; None where the file
    states none."""
    holders: tuple[tuple[int, str], ...] = ()
    """Nodes or groups that hold it, from the outermost to its own: a number of the node in the file, and its name."""
    notes: tuple[str, ...] = ()
    """What the file holds beside this mesh and is not read, one clause each."""

    def of_faces(self, index: IntArray) -> RawMesh:
        """Return the mesh of some faces, in the order of their indices, shape (n,)."""
        appearance = None if self.appearance is None else self.appearance.of_faces(index)
        return replace(self, faces=self.faces[index], appearance=appearance)

    def moved(self, linear: FloatArray, offset: FloatArray | None = None) -> RawMesh:
        """Return the mesh after p -> linear @ p + offset, shapes (3, 3) and (3,); its faces keep their order."""
        exact = None if self.exact is None else self.exact.moved(linear, np.zeros(3) if offset is None else offset)
        turned = self.vertices @ linear.T
        return replace(self, vertices=turned if offset is None else turned + offset, exact=exact)

    def placed(self, T_world_node: FloatArray) -> RawMesh:
        """Return the mesh of a node in the world, shape (4, 4); what is mirrored is not turned inside out."""
        if np.array_equal(T_world_node, np.eye(4)):
            return self  # formats without nodes can hold millions of vertices: no copy
        moved = self.moved(T_world_node[:3, :3], T_world_node[:3, 3])
        if np.linalg.det(T_world_node[:3, :3]) >= 0:
            return moved
        appearance = None if self.appearance is None else self.appearance.mirrored()
        return replace(moved, faces=self.faces[:, [0, 2, 1]], appearance=appearance)


def compacted(mesh: RawMesh) -> RawMesh:
    """Return the mesh without vertices that no face uses."""
    vertices, faces = without_unused(mesh.vertices, mesh.faces)
    return replace(mesh, vertices=vertices, faces=faces)


def merged(meshes: Sequence[RawMesh], name: str) -> RawMesh:
    """Return all `meshes` as one."""
    vertices, faces = as_one((mesh.vertices, mesh.faces) for mesh in meshes)
    first = meshes[0]
    return RawMesh(
        name=name,
        vertices=vertices,
        faces=faces,
        unit=first.unit,
        up=first.up,
        appearance=joined([mesh.appearance for mesh in meshes], [len(mesh.faces) for mesh in meshes]),
        exact=joined_faces([mesh.exact for mesh in meshes]),
        notes=tuple(dict.fromkeys(note for mesh in meshes for note in mesh.notes)),
    )
