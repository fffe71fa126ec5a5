"""KV150 to KV159 but the sizes: every mesh file by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.check import CauseScope, check
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.validation.asset.mesh_look import MeshContext
    from kinematify.validation.check import OpenCheck


@check(
    "KV150",
    title="Mesh files can be read",
    fails="A mesh file cannot be read",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    follows={"KV142": CauseScope.BODY},
    guard=True,
)
def unreadable(result: OpenCheck, look: MeshContext) -> None:
    """Every mesh file that the URDF names opens, is complete, not larger than `max_mesh_bytes`, and its faces refer to
    vertices that it has; for a mesh that is only seen it is a warning. All else is checked without it.

    Why it matters: A truncated or lying mesh is dropped in silence by PyBullet, which also reads past the end of
    its arrays where a face of an OBJ refers to a vertex that is not there; MuJoCo refuses to load the model.

    Remedy: Export the mesh again and check that it opens in a viewer.
    """
    for file in look.files:
        if file.mesh is None:
            result.find(
                f"The mesh {file.called} cannot be used. {file.fault}",
                "Export it again and check that it opens in a viewer; `kinematify fix` leaves it out.",
                severity=None if file.collides else Severity.WARNING,
                link=file.first.link,
                line=file.first.line,
                harmless=True,
            )
    if look.fault is not None:
        result.find(look.fault, "Fix what the message names.")


@check(
    "KV151",
    title="Mesh coordinates are finite",
    fails="Mesh coordinates are not finite",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    guard=True,
)
def wild_coordinates(result: OpenCheck, look: MeshContext) -> None:
    """Every coordinate is a finite number of at most `max_number`.

    Why it matters: PyBullet takes NaN without a word, and the state of the simulation becomes NaN with it.

    Remedy: Export the mesh again; a file that was cut or changed on the way has such numbers.
    """
    for file in look.files:
        worst = file.worst_coordinate
        if not worst <= look.settings.max_number:
            result.find(
                f"The mesh {file.called} has a coordinate of {worst:g}; expected finite numbers up to "
                f"{look.settings.max_number:g}.",
                "Export it again; a file that was cut or changed on the way has such numbers.",
                link=file.first.link,
                line=file.first.line,
                value=worst,
                limit=look.settings.max_number,
            )


@check(
    "KV152",
    title="Meshes have a usable number of triangles",
    fails="A mesh has too few or too many triangles",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    guard=True,
)
def triangle_counts(result: OpenCheck, look: MeshContext) -> None:
    """All meshes together have at most `max_faces` triangles; a single mesh with more than `stl_faces` is a warning.

    Why it matters: MuJoCo refuses an STL with more than 200,000 triangles; collision checks of scans with millions
    take hours.

    Remedy: Reduce the mesh, or split it.
    """
    settings = look.settings
    counts = [0 if file.mesh is None else len(file.mesh.faces) for file in look.files]
    total = sum(counts)
    result.measured["faces"] = total
    for file, count in zip(look.files, counts, strict=True):
        if count > settings.stl_faces:
            result.find(
                f"The mesh {file.called} has {count} triangles; MuJoCo reads at most {settings.stl_faces} from an STL, "
                "and collisions take long with so many.",
                "Reduce it (for example with MeshLab or Blender), or split it into several meshes.",
                severity=Severity.WARNING,
                link=file.first.link,
                line=file.first.line,
                value=count,
                limit=settings.stl_faces,
            )
    if total > settings.max_faces:
        result.find(
            f"The meshes have {total} triangles together; at most {settings.max_faces} are checked.",
            "Reduce the meshes to what collisions need; 20,000 triangles per link are plenty.",
            value=total,
            limit=settings.max_faces,
        )


@check("KV153", title="Meshes have a thickness", fails="A mesh is flat", severity=Severity.WARNING, cause=Cause.ASSET)
def flat_meshes(result: OpenCheck, look: MeshContext) -> None:
    """No mesh is thinner than `flat` times its diagonal; for meshes that are only seen it is a note.

    Why it matters: MuJoCo cannot make a hull of a flat mesh, and nothing rests on it safely.

    Remedy: Give it a thickness, or use a thin box for the collision.
    """
    for file, quality in look.measured:
        if quality.thickness <= look.settings.flat * quality.diagonal:
            result.find(
                f"The mesh {file.called} is flat: {quality.thickness:.2g} thick over a diagonal of "
                f"{quality.diagonal:.3g}. MuJoCo cannot make a hull of it.",
                "Give it a thickness, or use a thin box for the collision.",
                severity=None if file.collides else Severity.NOTE,
                cause=Cause.PHYSICS if file.collides else None,
                link=file.first.link,
                line=file.first.line,
                value=quality.thickness,
                limit=look.settings.flat * quality.diagonal,
            )


@check(
    "KV156",
    title="Triangles face outward",
    fails="Triangles face inward",
    severity=Severity.WARNING,
    cause=Cause.ASSET,
)
def inward_faces(result: OpenCheck, look: MeshContext) -> None:
    """No closed collision mesh is inside out; triangles with a twin that faces the other side make sheets that are seen
    from both, and have no inside.

    Why it matters: A mesh that is inside out has a negative volume, which MuJoCo refuses; some viewers show it
    hollow.

    Remedy: Flip the normals.
    """
    for file, quality in look.measured:
        solid = quality.closed and quality.thickness > look.settings.flat * quality.diagonal
        solid &= quality.twins < quality.faces - quality.degenerate
        if solid and not quality.opposed_edges and quality.volume < 0.0:
            result.find(
                f"The mesh {file.called} is inside out: its triangles face inward.",
                "Flip the normals.",
                severity=None if file.collides else Severity.NOTE,
                link=file.first.link,
                line=file.first.line,
            )


@check(
    "KV159",
    title="Meshes stand upright in every reader",
    fails="Meshes lie on their side where readers ignore their up axis",
    severity=Severity.WARNING,
    cause=Cause.ASSET,
)
def lying_meshes(result: OpenCheck, look: MeshContext) -> None:
    """The links of the model meet without the up axis that COLLADA meshes state. Where they meet only with it, all
    later checks apply it.

    Why it matters: The same file lies on its side in another simulator.

    Remedy: Export OBJ or STL with z up.
    """
    reading = look.model.up_axis
    if reading is not None and reading.respected:
        lying = [file for file in look.files if file.mesh is not None and file.mesh.up]
        result.find(
            f"{len(lying)} COLLADA meshes, such as {lying[0].called}, state an up axis other than z, and the links "
            f"meet only if it is applied: gaps of {reading.gap_ignored * 1e3:.3g} mm on average close to "
            f"{reading.gap_respected * 1e3:.3g} mm. It is applied here; RViz and others ignore it.",
            "Export these meshes with z up.",
            link=lying[0].first.link,
            line=lying[0].first.line,
            value=reading.gap_ignored,
            limit=reading.gap_respected,
            unit="m",
        )
