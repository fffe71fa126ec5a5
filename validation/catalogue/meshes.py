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
        verifies=(
            "Every mesh file that the URDF names opens, is complete, not larger than `max_mesh_bytes`, and its "
            "faces refer to vertices that it has."
        ),
        matters=(
            "A truncated or lying mesh is dropped in silence by PyBullet, which also reads past the end of its "
            "arrays where a face of an OBJ refers to a vertex that is not there; MuJoCo refuses to load the "
            "model."
        ),
        remedy="Export the mesh again and check that it opens in a viewer.",
    ),
    Check(
        id="KV151",
        title="Mesh coordinates are finite",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="Every coordinate is a finite number of at most `max_number`.",
        matters="PyBullet takes NaN without a word, and the state of the simulation becomes NaN with it.",
        remedy="Export the mesh again; a file that was cut or changed on the way has such numbers.",
    ),
    Check(
        id="KV152",
        title="Triangle counts",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies=(
            "All meshes together have at most `max_faces` triangles; a single mesh with more than `stl_faces` is "
            "a warning."
        ),
        matters=(
            "MuJoCo refuses an STL with more than 200,000 triangles; collision checks of scans with millions take "
            "hours."
        ),
        remedy="Reduce the mesh, or split it.",
    ),
    Check(
        id="KV153",
        title="Meshes have a thickness",
        severity=Severity.WARNING,
        blame=Blame.ASSET,
        verifies="No mesh is thinner than `flat` times its diagonal; for meshes that are only seen it is a note.",
        matters="MuJoCo cannot make a hull of a flat mesh, and nothing rests on it safely.",
        remedy="Give it a thickness, or use a thin box for the collision.",
    ),
    Check(
        id="KV154",
        title="Triangles have an area",
        severity=Severity.WARNING,
        blame=Blame.ASSET,
        verifies=(
            "At most `degenerate_share` of the triangles of a mesh have no area; for meshes that are only seen it "
            "is a note."
        ),
        matters="Normals of such triangles are noise, and so are masses and contacts computed from them.",
        remedy="Merge doubled vertices and delete degenerate faces.",
    ),
    Check(
        id="KV155",
        title="Meshes are closed",
        severity=Severity.NOTE,
        blame=Blame.ASSET,
        verifies="Mesh files that do not enclose a volume are counted.",
        matters="Volumes, masses and signed distances of open meshes are estimates.",
        remedy="Close the holes if masses are to be computed from the meshes.",
    ),
    Check(
        id="KV156",
        title="Triangles face outward",
        severity=Severity.WARNING,
        blame=Blame.ASSET,
        verifies=(
            "No closed collision mesh is inside out. Edges at which triangles face opposite sides, or with more "
            "than two triangles, are counted in a note."
        ),
        matters="A mesh that is inside out has a negative volume, which MuJoCo refuses; some viewers show it hollow.",
        remedy="Flip the normals and split surfaces that share edges.",
    ),
    Check(
        id="KV157",
        title="Links are in the same unit",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies=(
            "No link is more than `oversize` times as large as the largest other one, none with a mesh file "
            "`undersize` times smaller; no link stands further from its parent than `apart` times the sizes of "
            "both (blamed on the joint)."
        ),
        matters=(
            "A mesh in millimetres beside others in metres is the most frequent mistake of exporters; so are "
            "origins that were not converted."
        ),
        remedy="Write the factor to metres as the scale of the mesh, and origins in metres.",
    ),
    Check(
        id="KV158",
        title="The model has a plausible size",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies=(
            "The diagonal of the model at zero lies between `small` and `large`; above `huge` it is an error if the "
            "model has joints that move, and so is a largest link below `tiny`."
        ),
        matters=(
            "Gravity, friction and contact parameters of engines are made for metres: a cabinet of 2 km falls in "
            "slow motion."
        ),
        remedy="Convert all meshes and origins to metres.",
    ),
    Check(
        id="KV159",
        title="Units and axes that files state",
        severity=Severity.NOTE,
        blame=Blame.ASSET,
        verifies=(
            "Meshes that state a unit or an up axis of their own are named, because readers differ in whether "
            "they heed it."
        ),
        matters="The same file has another size or lies on its side in another simulator.",
        remedy="Export OBJ or STL in metres with z up.",
    ),
)
