"""KV15x: every mesh file by itself, then the sizes of the model as a whole."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import DescriptionError
from kinematify.robot.read import read_parsed
from kinematify.robot.urdf_geometry import geometry_source
from kinematify.robot.urdf_text import parse_description
from kinematify.validation.asset.mesh_files import open_mesh_files, worst_coordinate
from kinematify.validation.asset.mesh_quality import surface_quality
from kinematify.validation.asset.units import check_model_size, check_unit_slips
from kinematify.validation.finding import Blame, Severity

if TYPE_CHECKING:
    from lxml.etree import _Element

    from kinematify.config.validation import FileSettings
    from kinematify.robot.declared import DeclaredModel
    from kinematify.robot.urdf_geometry import GeometrySource
    from kinematify.validation.asset.mesh_files import MeshFile
    from kinematify.validation.asset.mesh_quality import SurfaceQuality
    from kinematify.validation.stage import OpenCheck, Recorder, StageRequest

    Measured = list[tuple[MeshFile, SurfaceQuality]]


def check_mesh_files(request: StageRequest, recorder: Recorder) -> DeclaredModel | None:
    """Tell KV150 to KV159 and return the model, or None where a mesh keeps it from being read.

    Args:
        request: Names the document, which has passed the pre-check.
        recorder: Told every check; the later ones are blocked where a mesh cannot be used.
    """
    settings = request.settings.file
    robot = parse_description(request.urdf)
    source = geometry_source(request.urdf, request.package_dirs)
    files: tuple[MeshFile, ...] = ()
    model: DeclaredModel | None = None
    with recorder.check("KV150") as check:
        files = open_mesh_files(robot, source, settings)
        _tell_unreadable(check, files)
        if not check.findings:
            model = _read(robot, request, source, check)
    with recorder.check("KV151") as check:
        _tell_wild_coordinates(check, files, settings)
        model = None if check.findings else model
    with recorder.check("KV152") as check:
        too_many = _tell_counts(check, files, settings)
        model = None if too_many else model
    if model is None:
        _block_rest(recorder)
    else:
        _check_usable(files, model, request, recorder)
    return model


def _read(robot: _Element, request: StageRequest, source: GeometrySource, check: OpenCheck) -> DeclaredModel | None:
    try:
        with np.errstate(all="ignore"):  # what is not finite is told by the next check
            return read_parsed(robot, request.urdf, source)
    except DescriptionError as error:
        check.find(str(error), "Mend what the message names.")
        return None


def _block_rest(recorder: Recorder) -> None:
    for name in ("KV153", "KV154", "KV155", "KV156", "KV157", "KV158", "KV159"):
        with recorder.check(name) as check:
            check.block("a mesh cannot be used")


def _check_usable(files: tuple[MeshFile, ...], model: DeclaredModel, request: StageRequest, recorder: Recorder) -> None:
    """Tell the checks that need readable meshes."""
    settings = request.settings.file
    measured: Measured = []
    if recorder.wants("KV153", "KV154", "KV155", "KV156"):
        measured = [(file, surface_quality(file.mesh)) for file in files if file.mesh is not None]
    for name, tell in (("KV153", _tell_flat), ("KV154", _tell_degenerate), ("KV156", _tell_winding)):
        with recorder.check(name) as check:
            tell(check, measured, settings)
    with recorder.check("KV155") as check:
        _tell_open(check, measured)
    with recorder.check("KV157") as check:
        check_unit_slips(model, settings, check)
    with recorder.check("KV158") as check:
        check_model_size(model, settings, check)
    with recorder.check("KV159") as check:
        _tell_units(check, files)


def _tell_unreadable(check: OpenCheck, files: tuple[MeshFile, ...]) -> None:
    for file in files:
        if file.mesh is None:
            check.find(
                f"The mesh {file.called} cannot be used. {file.fault}",
                "Export it again and check that it opens in a viewer.",
                link=file.first.link,
                line=file.first.line,
            )


def _tell_wild_coordinates(check: OpenCheck, files: tuple[MeshFile, ...], settings: FileSettings) -> None:
    for file in files:
        worst = 0.0 if file.mesh is None else worst_coordinate(file.mesh)
        if not worst <= settings.max_number:
            check.find(
                f"The mesh {file.called} has a coordinate of {worst:g}; expected finite numbers up to "
                f"{settings.max_number:g}.",
                "Export it again; a file that was cut or changed on the way has such numbers.",
                link=file.first.link,
                line=file.first.line,
                value=worst,
                limit=settings.max_number,
            )


def _tell_counts(check: OpenCheck, files: tuple[MeshFile, ...], settings: FileSettings) -> bool:
    """True if there are too many triangles to go on."""
    counts = [0 if file.mesh is None else len(file.mesh.faces) for file in files]
    total = sum(counts)
    check.measured["faces"] = total
    for file, count in zip(files, counts, strict=True):
        if count > settings.stl_faces:
            check.find(
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
        check.find(
            f"The meshes have {total} triangles together; at most {settings.max_faces} are checked.",
            "Reduce the meshes to what collisions need; 20,000 triangles per link are plenty.",
            value=total,
            limit=settings.max_faces,
        )
    return total > settings.max_faces


def _tell_flat(check: OpenCheck, measured: Measured, settings: FileSettings) -> None:
    for file, quality in measured:
        if quality.thickness <= settings.flat * quality.diagonal:
            check.find(
                f"The mesh {file.called} is flat: {quality.thickness:.2g} thick over a diagonal of "
                f"{quality.diagonal:.3g}. MuJoCo cannot make a hull of it.",
                "Give it a thickness, or use a thin box for the collision.",
                severity=None if file.collides else Severity.NOTE,
                blame=Blame.PHYSICS if file.collides else None,
                link=file.first.link,
                line=file.first.line,
                value=quality.thickness,
                limit=settings.flat * quality.diagonal,
            )


def _tell_degenerate(check: OpenCheck, measured: Measured, settings: FileSettings) -> None:
    check.measured["degenerate_faces"] = sum(quality.degenerate for _, quality in measured)
    for file, quality in measured:
        share = quality.degenerate / quality.faces
        if share > settings.degenerate_share:
            check.find(
                f"{quality.degenerate} of the {quality.faces} triangles of the mesh {file.called} have no area.",
                "Merge doubled vertices and delete degenerate faces, for example in MeshLab.",
                severity=None if file.collides else Severity.NOTE,
                link=file.first.link,
                line=file.first.line,
                value=share,
                limit=settings.degenerate_share,
            )


def _tell_open(check: OpenCheck, measured: Measured) -> None:
    """One note for all: most meshes of everyday objects are open, and nothing here depends on it."""
    open_files = [(file, quality) for file, quality in measured if not quality.closed]
    check.measured["open_meshes"] = len(open_files)
    if open_files:
        file, quality = max(open_files, key=lambda item: item[1].open_edges)
        check.find(
            f"{len(open_files)} of {len(measured)} mesh files do not enclose a volume; the mesh {file.called} has "
            f"{quality.open_edges} open edges. Volumes and masses computed from them are estimates.",
            "Close the holes if masses are to be computed from the meshes.",
            link=file.first.link,
            line=file.first.line,
            value=quality.open_edges,
            limit=0,
        )


def _tell_winding(check: OpenCheck, measured: Measured, settings: FileSettings) -> None:
    """Inside out counts for collisions; opposed and branched edges are one note for all."""
    torn = [(file, q) for file, q in measured if q.opposed_edges + q.branched_edges]
    check.measured["torn_meshes"] = len(torn)
    for file, quality in measured:
        solid = quality.closed and quality.thickness > settings.flat * quality.diagonal
        if solid and not quality.opposed_edges and quality.volume < 0.0:
            check.find(
                f"The mesh {file.called} is inside out: its triangles face inward.",
                "Flip the normals.",
                severity=None if file.collides else Severity.NOTE,
                link=file.first.link,
                line=file.first.line,
            )
    if torn:
        file, quality = max(torn, key=lambda item: item[1].opposed_edges + item[1].branched_edges)
        check.find(
            f"{len(torn)} of {len(measured)} mesh files are no clean surfaces; the mesh {file.called} has "
            f"{quality.opposed_edges} edges at which triangles face opposite sides and {quality.branched_edges} with "
            "more than two triangles.",
            "Make the faces point outward and split surfaces that share edges, if masses are to be computed from them.",
            severity=Severity.NOTE,
            link=file.first.link,
            line=file.first.line,
            value=quality.opposed_edges + quality.branched_edges,
            limit=0,
        )


def _tell_units(check: OpenCheck, files: tuple[MeshFile, ...]) -> None:
    for file in files:
        if file.units:
            check.find(
                f"The mesh {file.called} states the unit {', '.join(sorted(file.units))}, which URDF readers ignore: "
                "its numbers are taken for metres.",
                "Write the factor to metres as its scale, or export it in metres.",
                link=file.first.link,
                line=file.first.line,
            )
    collada = [file for file in files if file.path.suffix.lower() == ".dae"]
    if collada:
        check.find(
            f"COLLADA meshes: {len(collada)}. Readers differ in whether they heed the unit and the up axis that these "
            "state; here the unit is heeded and the up axis is not, as in RViz.",
            "Export OBJ or STL in metres with z up to be sure.",
            link=collada[0].first.link,
            line=collada[0].first.line,
            value=len(collada),
        )
