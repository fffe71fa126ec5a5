"""Raw meshes become an assembly: welded and named, degenerate and double ones set aside, heavy ones thinned."""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING, Any

import fast_simplification
import igl
import numpy as np
from scipy.spatial import cKDTree

from kinematify.assembly.part import Assembly, ExcludedPart, Part
from kinematify.errors import AssemblyError
from kinematify.robot.appearance import MAX_MATERIALS
from kinematify.robot.densities import density_of
from kinematify.robot.vectors import lengths_of, referenced
from kinematify.robot.weld import snapped, weld, welded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import AssemblyConfig
    from kinematify.robot.appearance import Appearance
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.raw_mesh import RawMesh

    _Aside = list[tuple[Part, str]]
    """Parts that do not take part, with the reason."""


_LONGEST = 64
"""Characters; names go into file names, and engines have crashed on long ones."""
_RESERVED = ("world",)
"""MuJoCo, Gazebo and URDF tools give this name to the fixed frame."""


def part_names(originals: Sequence[str]) -> tuple[str, ...]:
    """Return unique names of ASCII letters, digits, ``_``, ``-`` and ``.``, as near to the originals as possible.

    Names that clash get a number: the first keeps its name. Upper and lower case count as equal, because the names
    become file names.

    Args:
        originals: What the input calls the parts, in order.
    """
    taken: set[str] = set()
    names = []
    for original in originals:
        wanted = _plain(original)
        name, count = wanted, 1
        while name.casefold() in taken:
            count += 1
            name = f"{wanted}_{count}"
        taken.add(name.casefold())
        names.append(name)
    return tuple(names)


def _plain(original: str) -> str:
    # Decomposed, an accented letter is a plain one and a mark, and the mark goes.
    letters = "".join(c for c in unicodedata.normalize("NFKD", original) if not unicodedata.combining(c))
    name = re.sub(r"[^A-Za-z0-9_.-]+", "_", letters).strip("_.-")[:_LONGEST]
    if not name:
        return "part"
    return f"{name}_part" if name.casefold() in _RESERVED else name


def natural_key(name: str) -> tuple[tuple[int, int, str], ...]:
    """Return a sorting key under which ``part_10`` comes after ``part_9``."""
    words = re.split(r"(\d+)", name)
    return tuple((0, int(word), word) if word.isdecimal() else (1, 0, word) for word in words)


_MANY_TIMES, _CELLS = 10, 400
"""A part of so many times the faces that it may have is first thinned out on a grid of cells along its diagonal."""
_PROBES = 200
"""Vertices of a set-aside mesh that are looked at to find the part nearest to it."""


def assemble(
    meshes: Sequence[RawMesh], *, source: str, config: AssemblyConfig, warnings: Sequence[str] = ()
) -> Assembly:
    """Turn one mesh per part into an assembly.

    Args:
        meshes: World frame, z up [m], in the order that the parts shall have; names as in the input.
        source: What the user gave, for messages and the record.
        config: Limits and tolerances.
        warnings: What is known to be odd already.

    Raises:
        AssemblyError: Too many parts or faces, a coordinate that is not finite, or fewer than two usable parts.
    """
    _check_counts(meshes, source, config)
    names = part_names([mesh.name for mesh in meshes])
    for mesh in meshes:
        check_finite(mesh, source)
    parts = [_welded_part(mesh, name, config) for mesh, name in zip(meshes, names, strict=True)]
    kept, aside = _without_degenerate(parts, source, config)
    doubles = _take_duplicates(kept, aside, config)
    if len(kept) < 2:
        raise AssemblyError(_too_few(source, kept, aside))
    thin, originals = _thinned(kept, config)
    return Assembly(
        parts=tuple(thin),
        source=source,
        set_aside=tuple(ExcludedPart(part=part, reason=reason, nearest=_nearest(part, kept)) for part, reason in aside),
        original_names=dict(zip(names, (mesh.name for mesh in meshes), strict=True)),
        warnings=(*warnings, *report_materials(meshes, names), *doubles, *_thinning_warnings(thin, originals)),
        originals=originals,
    )


def _check_counts(meshes: Sequence[RawMesh], source: str, config: AssemblyConfig) -> None:
    if len(meshes) > config.max_parts:
        raise AssemblyError(
            f"The input {source} consists of {len(meshes)} parts; at most {config.max_parts} are accepted "
            "(assembly.max_parts). If these are loose triangles or screws of one rigid body, join them before, or "
            "label the faces with --labels."
        )
    faces = sum(len(mesh.faces) for mesh in meshes)
    if faces > config.max_faces:
        raise AssemblyError(
            f"The input {source} has {faces} triangles; at most {config.max_faces} are accepted (assembly.max_faces). "
            "Simplify the meshes first."
        )


def check_finite(mesh: RawMesh, source: str) -> None:
    """Refuse a mesh with a triangle that has a corner at no finite place.

    Raises:
        AssemblyError: There is one; the message names the mesh.
    """
    bad = int((~np.isfinite(referenced(mesh.vertices, mesh.faces)).all(axis=1)).sum())
    if bad:
        raise AssemblyError(
            f"The part {mesh.name!r} of {source} has {bad} vertices whose coordinates are not finite numbers (NaN or "
            "infinite). Repair the mesh, or export it again."
        )


def _welded_part(mesh: RawMesh, name: str, config: AssemblyConfig) -> Part:
    vertices, faces, kept = weld(mesh.vertices, mesh.faces, config.weld)
    if len(faces):
        appearance = None if mesh.appearance is None else mesh.appearance.of_faces(kept).with_few_materials()
        looks = _looks(vertices, faces, appearance)
        density = None if appearance is None else density_of(appearance, vertices[faces])
        return Part(name=name, vertices=vertices, faces=faces, exact=mesh.exact, density=density, **looks)
    # Nothing has area: kept as it was given, so that the user finds it in the output.
    finite = mesh.vertices if np.isfinite(mesh.vertices).all() else mesh.vertices[:0]
    return Part(name=name, vertices=finite, faces=mesh.faces)


def _looks(vertices: FloatArray, faces: IntArray, appearance: Appearance | None) -> dict[str, Any]:
    """Colour and appearance of a part; the latter only where it says more than the colour."""
    if appearance is None:
        return {}
    *color, opacity = appearance.mean_color(vertices, faces)
    one_color = len(appearance.materials) == 1 and not appearance.is_textured and opacity == 1.0
    return {"color": tuple(color), "appearance": None if one_color else appearance}


def report_materials(meshes: Sequence[RawMesh], names: Sequence[str]) -> list[str]:
    """Return what of the materials is lost."""
    notes = dict.fromkeys(note for mesh in meshes if mesh.appearance for note in mesh.appearance.notes)
    warnings = [f"Not all colours are those of the input: {'; '.join([*notes][:8])}."] if notes else []
    many = [
        name
        for mesh, name in zip(meshes, names, strict=True)
        if mesh.appearance and len(np.unique(mesh.appearance.material_of_face)) > MAX_MATERIALS
    ]
    if many:
        warnings.append(
            f"Parts of more than {MAX_MATERIALS} materials keep {MAX_MATERIALS} colours that are near, without "
            f"textures: {', '.join(many[:8])}."
        )
    return warnings


def _without_degenerate(parts: Sequence[Part], source: str, config: AssemblyConfig) -> tuple[list[Part], _Aside]:
    solid = [part for part in parts if len(part.faces) and part.area > 0.0]
    if not solid:
        raise AssemblyError(f"No part of {source} has a triangle with area. Give meshes with surfaces.")
    diagonal = Assembly(parts=tuple(solid), source=source).diagonal
    reasons = [(part, _degenerate_reason(part, diagonal, config)) for part in parts]
    return [part for part, reason in reasons if not reason], [item for item in reasons if item[1]]


def _degenerate_reason(part: Part, diagonal: float, config: AssemblyConfig) -> str:
    """Why a part cannot take part in the inference; empty if it can."""
    if not len(part.faces):
        return "It holds no triangle."
    if part.area == 0.0:
        return "Its surface has no area."
    distinct = len(referenced(part.vertices, part.faces))
    if distinct < config.min_vertices:
        return f"It has {distinct} distinct vertices; {config.min_vertices} are needed."
    extent = float(np.ptp(part.bounds, axis=0).max())
    if extent < config.min_extent * diagonal:
        return f"Its largest extent is {extent:.3g} m, below {config.min_extent:g} of the assembly's diagonal."
    return ""


def _take_duplicates(kept: list[Part], aside: _Aside, config: AssemblyConfig) -> list[str]:
    """Set aside every part that is in the place of an earlier one of the same shape; a warning for each."""
    tolerance = config.duplicate * Assembly(parts=tuple(kept), source="").diagonal if kept else 0.0
    warnings = []
    corners: FloatArray = np.array([part.bounds.reshape(-1) for part in kept])
    rows: list[int] = []
    for k, part in enumerate(parts := [*kept]):
        near = np.abs(corners[rows] - corners[k]).max(axis=1, initial=0.0) <= tolerance
        twin = next(
            (parts[rows[i]] for i in np.flatnonzero(near) if _same_vertices(parts[rows[i]], part, tolerance)), None
        )
        if twin is None:
            rows.append(k)
        else:
            aside.append((part, f"It is the same mesh at the same place as {twin.name}."))
            warnings.append(f"The part {part.name} is {twin.name} once more; only {twin.name} is used.")
    kept[:] = [parts[k] for k in rows]
    return warnings


def _same_vertices(one: Part, other: Part, tolerance: float) -> bool:
    if len(one.vertices) != len(other.vertices):
        return False
    pairs = ((one.vertices, other.vertices), (other.vertices, one.vertices))
    return all(cKDTree(a).query(b)[0].max() <= tolerance for a, b in pairs)


def _too_few(source: str, kept: Sequence[Part], aside: _Aside) -> str:
    reasons = "".join(f" {part.name}: {reason}" for part, reason in aside[:8])
    return (
        f"The input {source} has {len(kept)} usable part, but a mechanism needs at least two.{reasons} Give one "
        "mesh per rigid part; one mesh that holds several needs --labels, or pieces that do not share vertices."
    )


def _nearest(part: Part, kept: Sequence[Part]) -> str:
    """Name of the part whose surface comes nearest; of the largest where there is nothing to measure from."""
    if not len(part.vertices):
        return max(kept, key=lambda other: other.area).name
    probes = part.vertices[np.linspace(0, len(part.vertices) - 1, _PROBES).round().astype(int)]
    gaps = [_box_gap(probes, other.bounds) for other in kept]
    best, name = np.inf, ""
    for k in np.argsort(gaps, kind="stable"):
        if gaps[k] >= best:
            break
        distance = _mean_distance(probes, kept[k])
        if distance < best:
            best, name = distance, kept[k].name
    return name


def _box_gap(points: FloatArray, bounds: FloatArray) -> float:
    """Mean distance of points to a box, which is no more than that to the surface inside it."""
    outside = np.maximum(np.maximum(bounds[0] - points, points - bounds[1]), 0.0)
    return float(lengths_of(outside).mean())


def _mean_distance(points: FloatArray, part: Part) -> float:
    squared = igl.point_mesh_squared_distance(np.ascontiguousarray(points), part.vertices, part.faces)[0]
    return float(np.sqrt(squared).mean())


def _thinned(parts: Sequence[Part], config: AssemblyConfig) -> tuple[list[Part], dict[str, Part]]:
    """The parts with few enough faces, and the full mesh of every part that had too many."""
    heavy = {part.name: part for part in parts if len(part.faces) > config.max_part_faces}
    return [simplified(part, config) if part.name in heavy else part for part in parts], heavy


def simplified(part: Part, config: AssemblyConfig) -> Part:
    """Return a part of about `config.max_part_faces` faces with nearly the same surface."""
    vertices, faces = part.vertices, part.faces
    if len(faces) > _MANY_TIMES * config.max_part_faces:  # it takes half a kilobyte for each
        vertices, faces = snapped(vertices, faces, _CELLS)
    # Its binding refuses read-only arrays.
    vertices, faces = fast_simplification.simplify(vertices.copy(), faces.copy(), target_count=config.max_part_faces)
    vertices, faces = welded(np.asarray(vertices, dtype=np.float64), faces.astype(np.int64), config.weld)
    return Part(name=part.name, vertices=vertices, faces=faces, color=part.color, exact=part.exact)


def _thinning_warnings(thin: Sequence[Part], originals: dict[str, Part]) -> list[str]:
    return [
        f"The part {part.name} has {len(originals[part.name].faces)} triangles; the inference uses a simplified mesh "
        f"of {len(part.faces)}, the output keeps all."
        for part in thin
        if part.name in originals
    ]
