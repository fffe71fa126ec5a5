"""The file that engines are given: the joints and masses of the original, and collision geometry that stays hollow."""

from __future__ import annotations

from pathlib import Path

import igl
import mujoco
import numpy as np
import pytest
import trimesh
from manifold3d import Manifold
from trimesh.transformations import euler_matrix

from kinematify.config import load_config
from kinematify.config.validation import ValidationSettings, load_settings
from kinematify.geometry.convex import ConvexPiece, surface_points
from kinematify.geometry.cut import Concave, CutSurface, cut_worst_first
from kinematify.geometry.cut_cache import cache_folder, convex_chunks
from kinematify.model.collision_pieces import Method, Pieces, decomposed
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.simulation.prepared import prepare
from tests.engines import READERS

SETTINGS = load_settings()


@pytest.fixture(autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of its own for each test."""
    folder = tmp_path_factory.mktemp("cache")
    monkeypatch.setenv("XDG_CACHE_HOME", str(folder))
    return folder


def changed(**prepare: float) -> ValidationSettings:
    """The settings with some of this stage replaced."""
    return SETTINGS.model_copy(update={"prepare": SETTINGS.prepare.model_copy(update=prepare)})


def prepared(urdf: Path, settings: ValidationSettings = SETTINGS) -> Path:
    """What is written."""
    work = urdf.parent / "work"
    work.mkdir(exist_ok=True)
    return prepare(read_robot(urdf), work, settings.prepare)


def cut(urdf: Path, settings: ValidationSettings = SETTINGS) -> list[Pieces]:
    """The pieces of each link."""
    return list(decomposed(read_robot(urdf), settings.prepare).values())


def masses(urdf: Path) -> dict[str, float]:
    """Mass of each link that is written."""
    return {link.name: link.inertial.mass for link in read_robot(urdf).links if link.inertial is not None}


def link(name: str, inside: str) -> str:
    return f'<link name="{name}">{inside}</link>\n'


def mesh(name: str, tag: str = "collision", extra: str = "") -> str:
    return f'<{tag}><geometry><mesh filename="{name}" {extra}/></geometry></{tag}>'


INERTIAL = '<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
BOX = '<collision><geometry><box size="0.1 0.2 0.3"/></geometry></collision>'


def written(folder: Path, *links: str, joints: str = "") -> Path:
    urdf = folder / "model.urdf"
    urdf.write_text(f'<robot name="{"long" * 400}">{"".join(links)}{joints}</robot>')
    return urdf


def joint(name: str, parent: str, child: str, kind: str = "revolute", inside: str = "") -> str:
    limit = '<limit lower="-1" upper="2" effort="5" velocity="3"/>' if kind != "fixed" else ""
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{limit}{inside}</joint>'


# ---- the file --------------------------------------------------------------------------------------------------------


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    """A base with a hinge, a slide below it that mimics, a frame, primitives and a scaled, mirrored mesh."""
    trimesh.creation.icosphere(radius=50.0).export(tmp_path / "ball.stl")
    origin = '<origin xyz="0.1 -0.2 0.3" rpy="0.4 1.5707963267948966 -0.7"/>'
    return written(
        tmp_path,
        link("base", INERTIAL + BOX),
        link("arm", mesh("ball.stl", "visual", 'scale="0.001 -0.001 0.001"')),
        link("tip", INERTIAL + '<collision><geometry><cylinder radius="0.1" length="0.2"/></geometry></collision>'),
        link("frame", ""),
        joints=joint("hinge", "base", "arm", inside=f'{origin}<axis xyz="0 0.6 0.8"/>')
        + joint("slide", "arm", "tip", "prismatic", inside='<mimic joint="hinge" multiplier="0.5" offset="0.1"/>')
        + joint("mount", "tip", "frame", "fixed"),
    )


def test_every_engine_reads_the_joints_and_poses_of_the_original(machine: Path) -> None:
    urdf = prepared(machine)
    poses = forward_kinematics(read_robot(machine), {"hinge": 0.7})
    q = {"hinge": 0.7, "slide": 0.45}  # which follows the hinge
    for read in READERS.values():
        reading = read(urdf, q)
        assert set(reading.joints) == set(q)
        np.testing.assert_allclose(reading.joints["hinge"].limits, (-1.0, 2.0))
        for name in ("arm", "tip"):
            np.testing.assert_allclose(reading.poses[name][:3, 3], poses[name][:3, 3], atol=1e-5)


def test_masses_are_made_up_where_there_are_none(machine: Path) -> None:
    mass = masses(prepared(machine))
    assert mass["base"] == mass["tip"] == 2.0
    assert mass["frame"] < 1e-5, "it adds nothing to the body that it is fixed to"
    shell = load_config().model.wall_weight * 4.0 * np.pi * 0.05**2  # a solid ball of water would weigh more
    assert mass["arm"] == pytest.approx(shell, rel=0.02)


def test_missing_drives_are_made_up(tmp_path: Path) -> None:
    text = joint("hinge", "a", "b").replace('effort="5"', 'effort="0"')
    record = prepared(written(tmp_path, link("a", INERTIAL + BOX), link("b", INERTIAL + BOX), joints=text))
    assert f'effort="{SETTINGS.prepare.effort}"' in record.read_text()


def test_a_body_without_mass_and_geometry_weighs_little(tmp_path: Path) -> None:
    links = (link("a", INERTIAL + BOX), link("b", ""), link("c", INERTIAL + BOX))
    record = prepared(written(tmp_path, *links, joints=joint("one", "a", "b") + joint("two", "b", "c")))
    assert masses(record)["b"] == SETTINGS.prepare.dummy_mass
    mujoco.MjModel.from_xml_path(str(record))  # refuses bodies without mass


def test_no_line_is_long_and_mesh_names_are_unique(tmp_path: Path) -> None:
    trimesh.creation.box((1, 1, 1)).export(tmp_path / "part.stl")
    record = prepared(written(tmp_path, link("a", mesh("part.stl") * 3)))
    text = record.read_text()
    assert max(map(len, text.splitlines())) < 1000
    assert text.count("part") == 0
    assert len(list((tmp_path / "work" / "prepared_meshes").glob("*.obj"))) == 3


@pytest.mark.parametrize("ratio", [0.9, 1.005, 1.3])
def test_moments_are_lifted_to_what_mujoco_takes(ratio: float, tmp_path: Path) -> None:
    moments = np.array([0.02, 0.05, 0.07 * ratio])
    axes = euler_matrix(0.3, 0.8, -1.1)[:3, :3]
    tensor = axes @ np.diag(moments) @ axes.T
    keys = {"ixx": (0, 0), "iyy": (1, 1), "izz": (2, 2), "ixy": (0, 1), "ixz": (0, 2), "iyz": (1, 2)}
    text = " ".join(
        f'{key}="{tensor[place]!r}"'.replace("np.float64(", "").replace(")", "") for key, place in keys.items()
    )
    inertial = f'<inertial><mass value="1"/><inertia {text}/></inertial>'
    urdf = written(tmp_path, link("a", INERTIAL + BOX), link("b", inertial + BOX), joints=joint("hinge", "a", "b"))
    record = prepared(urdf)
    model = mujoco.MjModel.from_xml_path(str(record))
    np.testing.assert_allclose(np.sort(model.body_inertia[-1]), moments, rtol=1e-6 + 1.2 * max(0.0, ratio - 1.0) * 4)


# ---- pieces ----------------------------------------------------------------------------------------------------------


def solid(shape: Manifold) -> CutSurface:
    data = shape.to_mesh()
    return CutSurface(np.array(data.vert_properties[:, :3], dtype=float), np.array(data.tri_verts, dtype=np.int64))


def board(size: tuple[float, float, float], at: tuple[float, float, float]) -> Manifold:
    return Manifold.cube(list(size), True).translate(list(at))


def carcass() -> CutSurface:
    """A cabinet in one closed mesh, open in front, with a shelf."""
    inside = board((0.96, 1.0, 0.96), (0, -0.04, 0))
    return solid(board((1, 1, 1), (0, 0, 0)) - inside + board((1, 0.96, 0.04), (0, -0.02, 0.1)))


def chest() -> CutSurface:
    """A carcass in one closed mesh with six compartments: no single cut makes the largest hollow smaller."""
    shape = board((1, 0.5, 1.2), (0, 0, 0))
    for x in (-0.245, 0.245):
        for z in (-0.385, 0.0, 0.385):
            shape -= board((0.45, 0.5, 0.345), (x, -0.02, z))
    return solid(shape)


def frame() -> CutSurface:
    """A ring of four bars: no single cut makes it less concave."""
    return solid(board((1, 0.05, 1), (0, 0, 0)) - board((0.8, 0.1, 0.8), (0, 0, 0)))


def shell() -> CutSurface:
    """A tray of five sheets without thickness."""
    box = trimesh.creation.box((1.0, 0.6, 0.3))
    kept = box.triangles_center[:, 2] < 0.14
    return CutSurface(np.asarray(box.vertices), np.asarray(box.faces)[kept])


def bowl() -> CutSurface:
    """Half a hollow ball with many faces."""
    ball = Manifold.sphere(0.5, 96) - Manifold.sphere(0.42, 96)
    return solid(ball - board((2, 2, 1), (0, 0, 0.5)))


def cuts(surface: CutSurface, most: int = 48, tolerance: float = 0.03) -> list[ConvexPiece]:
    body = Concave(surface=surface, tolerance=tolerance, thickness=1e-3)
    return [chunk.piece for chunk in cut_worst_first([body], most)[0]]


def pieces_of(surface: CutSurface) -> list[ConvexPiece]:
    body = Concave(surface=surface, tolerance=0.03, thickness=1e-3)
    return [chunk.piece for chunk in convex_chunks([body], 48)[0]]


def distance(pieces: list[ConvexPiece], points: np.ndarray) -> np.ndarray:
    """Signed distance from the pieces together, a little too small outside near edges."""
    found = []
    for piece in pieces:
        a, b, c = (piece.vertices[piece.faces[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        found.append((points @ normals.T - np.einsum("ij,ij->i", a, normals)).max(axis=1))
    return np.min(found, axis=0)


def test_boards_of_furniture_come_out_exact() -> None:
    pieces = cuts(carcass())
    assert len(pieces) == 7
    inside = np.random.default_rng(0).uniform((-0.47, -0.49, -0.47), (0.47, 0.45, 0.07), (500, 3))
    assert distance(pieces, inside).min() > -1e-6, "nothing fills the room below the shelf"
    assert sum(piece.volume for piece in pieces) == pytest.approx(1 - 0.96 * 0.96 * 0.96 + 0.96 * 0.92 * 0.04, rel=0.02)


def test_a_chest_of_many_compartments_is_taken_apart_board_by_board() -> None:
    surface = chest()
    pieces = pieces_of(surface)
    assert len(pieces) <= 16
    middles = [(x, 0.0, z) for x in (-0.245, 0.245) for z in (-0.385, 0.0, 0.385)]
    assert distance(pieces, np.array(middles)).min() > 0.15, "all compartments are free"
    assert sum(piece.volume for piece in pieces) == pytest.approx(1.2 * 0.5 - 6 * 0.45 * 0.48 * 0.345, rel=0.02)


@pytest.mark.parametrize("make", [carcass, frame, shell, bowl])
def test_pieces_cover_the_surface_and_leave_hollows_free(make) -> None:
    surface = make()
    pieces = pieces_of(surface)
    on_surface = surface_points(surface.vertices, surface.faces, 2000)
    assert distance(pieces, on_surface).max() < 0.03  # many faces are simplified first
    body = Concave(surface=surface, tolerance=0.03, thickness=1e-3)
    whole = body.chunk(body.triangles).gap
    assert whole > 0.1
    probes = np.random.default_rng(1).uniform(surface.vertices.min(axis=0), surface.vertices.max(axis=0), (3000, 3))
    squared, _, _ = igl.point_mesh_squared_distance(probes, surface.vertices, surface.faces)
    inside = distance(pieces, probes) < 0.0
    if surface.closed:
        inside &= np.abs(igl.fast_winding_number(surface.vertices, surface.faces, probes)) < 0.5
    assert np.sqrt(squared[inside]).max(initial=0.0) < 0.06


# ---- whole models ----------------------------------------------------------------------------------------------------


def tray(folder: Path) -> Path:
    """A link with a hollow mesh, and one with a convex one."""
    surface = carcass()
    trimesh.Trimesh(surface.vertices, surface.faces, process=False).export(folder / "body.stl")
    trimesh.creation.box((0.5, 0.5, 0.5)).export(folder / "block.stl")
    bodies = link("body", INERTIAL + mesh("body.stl")), link("block", INERTIAL + mesh("block.stl"))
    return written(folder, *bodies, joints=joint("hinge", "body", "block"))


def test_boxes_in_one_mesh_are_components(tmp_path: Path) -> None:
    boxes = [trimesh.creation.box((0.1, 0.1, 1.0)).apply_translation((x, 0, 0)) for x in (0.0, 1.0, 2.0)]
    trimesh.util.concatenate(boxes).export(tmp_path / "legs.stl")
    (legs,) = cut(written(tmp_path, link("legs", mesh("legs.stl"))))
    assert (legs.method, len(legs.convex)) == (Method.COMPONENTS, 3)


def test_many_components_are_bounded(tmp_path: Path) -> None:
    random = np.random.default_rng(0)
    screws = [trimesh.creation.box((0.02,) * 3).apply_translation(random.uniform(size=3)) for _ in range(120)]
    trimesh.util.concatenate(screws).export(tmp_path / "screws.stl")
    (plate,) = cut(written(tmp_path, link("plate", mesh("screws.stl"))))
    settings = SETTINGS.prepare
    assert settings.most_components < len(plate.convex) <= settings.most_components + settings.cuts + 1


def test_the_second_run_takes_the_pieces_from_the_cache(tmp_path: Path, cache: Path) -> None:
    urdf = tray(tmp_path)
    first = [item.gap for item in cut(urdf)]
    (file,) = cache_folder().iterdir()
    assert cache in file.parents
    with np.load(file) as stored:
        arrays = dict(stored)
    np.savez(file, **{**arrays, "vertices": arrays["vertices"] + 1.0})  # to see that it is read
    assert cut(urdf)[0].gap > 0.5
    file.write_bytes(file.read_bytes()[:100])
    assert [item.gap for item in cut(urdf)] == first, "a damaged file is not used"
    file.unlink()
    assert [item.gap for item in cut(urdf, changed(cached_files=0))] == first
    assert not list(cache_folder().iterdir())


def test_a_cache_that_cannot_be_written_costs_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    occupied = tmp_path / "file"
    occupied.write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(occupied))
    assert cut(tray(tmp_path))[0].method is Method.CUT
