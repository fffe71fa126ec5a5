"""Collision pieces of meshes as people have them: open, flat, inverted, crossing themselves, tiny, one in another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np
import pytest
import trimesh
from trimesh.creation import box

from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.refinement.urdf_editor import UrdfEditor
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from kinematify.model.collision import FittedCollision

LIMIT = 0.2
WALLS = {  # a case that is open in front: extents and middle of each board
    "bottom": ((0.4, 0.5, 0.02), (0.0, 0.0, 0.01)),
    "top": ((0.4, 0.5, 0.02), (0.0, 0.0, 0.29)),
    "left": ((0.02, 0.5, 0.26), (-0.19, 0.0, 0.15)),
    "right": ((0.02, 0.5, 0.26), (0.19, 0.0, 0.15)),
    "back": ((0.36, 0.02, 0.26), (0.0, 0.24, 0.15)),
}


def board(extents: tuple[float, ...], middle: tuple[float, ...]) -> trimesh.Trimesh:
    mesh = box(extents)
    mesh.apply_translation(middle)
    return mesh


def drawer() -> trimesh.Trimesh:
    return board((0.34, 0.44, 0.2), (0.0, -0.02, 0.15))


def opened() -> trimesh.Trimesh:
    mesh = drawer()
    mesh.update_faces(mesh.face_normals[:, 2] < 0.5)
    return mesh


def inverted() -> trimesh.Trimesh:
    mesh = drawer()
    mesh.invert()
    return mesh


def crossing() -> trimesh.Trimesh:
    return trimesh.util.concatenate([drawer(), board((0.3, 0.3, 0.22), (0.0, 0.0, 0.15))])


def sheet() -> trimesh.Trimesh:
    corners = [(-0.15, -0.2, 0.15), (0.15, -0.2, 0.15), (0.15, 0.2, 0.15), (-0.15, 0.2, 0.15)]
    return trimesh.Trimesh(corners, [(0, 1, 2), (0, 2, 3)], process=False)


def tiny() -> trimesh.Trimesh:
    return board((1e-3, 1e-3, 1e-3), (0.0, -0.1, 0.15))


def write(folder: Path, moving: trimesh.Trimesh, *boards: trimesh.Trimesh) -> Path:
    """A case, with more boards, and what slides out of it, towards -y; written whatever it looks like."""
    case = trimesh.util.concatenate([*(board(*sizes) for sizes in WALLS.values()), *boards])
    shapes = {}
    for name, mesh in (("case", case), ("slider", moving)):
        mesh.export(folder / f"{name}.stl")
        shapes[name] = "".join(
            f'<{kind}><geometry><mesh filename="{name}.stl"/></geometry></{kind}>' for kind in ("visual", "collision")
        )
    path = folder / "model.urdf"
    path.write_text(
        f'<robot name="rough"><link name="case">{shapes["case"]}</link><link name="slider">{shapes["slider"]}</link>'
        '<joint name="slide" type="prismatic"><parent link="case"/><child link="slider"/><axis xyz="0 1 0"/>'
        f'<limit lower="{-LIMIT}" upper="0" effort="50" velocity="1"/></joint></robot>',
        encoding="utf-8",
    )
    return path


def carved(folder: Path, moving: trimesh.Trimesh, *boards: trimesh.Trimesh) -> tuple[Path, FittedCollision]:
    """The file with collision pieces, and what is known of them."""
    path = write(folder, moving, *boards)
    editor, robot = UrdfEditor(path, folder / "out" / "fixed.urdf"), read_robot(path)
    fitted = editor.carve(robot, frozenset(robot.link_by_name), load_config(), load_settings())
    return editor.write(), fitted


def reached(urdf: Path) -> tuple[float, float]:
    """How deep anything is in the other at rest, and how far 30 N pull the slider out, in plain MuJoCo [m]."""
    model = mujoco.MjModel.from_xml_path(str(urdf))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    deep = -min((contact.dist for contact in data.contact), default=0.0)
    for _ in range(3000):
        data.qfrc_applied[0] = -30.0
        mujoco.mj_step(model, data)
    return float(deep), float(data.qpos[0])


def fine() -> trimesh.Trimesh:
    mesh = drawer()
    for _ in range(7):
        mesh = mesh.subdivide()
    return mesh


def test_a_surface_of_too_many_triangles_is_thinned_out_and_reported(tmp_path: Path) -> None:
    path, fitted = carved(tmp_path, fine())
    assert [item.link for item in fitted.links if item.thinned > 0.0] == ["slider"]
    assert reached(path)[1] < -0.95 * LIMIT
    slider = read_robot(path).link_by_name["slider"]
    low, high = (
        end(np.concatenate([shape.mesh.vertices for shape in slider.collisions]), axis=0) for end in (np.min, np.max)
    )
    assert high - low == pytest.approx([0.34, 0.44, 0.2], abs=0.012)


@pytest.mark.parametrize("build", [drawer, opened, inverted, crossing, sheet, tiny])
def test_rough_parts_collide_and_slide_in_plain_mujoco(build: Callable[[], trimesh.Trimesh], tmp_path: Path) -> None:
    path, _ = carved(tmp_path, build())
    model = mujoco.MjModel.from_xml_path(str(path))
    assert (np.bincount(model.geom_bodyid, minlength=model.nbody) > 0).all(), "no link without collision geometry"
    deep, value = reached(path)
    assert deep < 1e-3
    assert value < -0.95 * LIMIT


def test_what_has_to_pass_through_another_is_reported_and_left(tmp_path: Path) -> None:
    front = board((0.36, 0.02, 0.26), (0.0, -0.3, 0.15))
    path, fitted = carved(tmp_path, drawer(), front)
    (blocked,) = fitted.blocked
    assert set(blocked.links) == {"case", "slider"}
    model = mujoco.MjModel.from_xml_path(str(path))
    assert (np.bincount(model.geom_bodyid, minlength=model.nbody) > 0).all()


def test_what_stands_inside_of_another_keeps_its_pieces(tmp_path: Path) -> None:
    path, _ = carved(tmp_path, board((0.1, 0.1, 0.01), (0.0, 0.0, 0.01)))  # in the middle of the bottom
    model = mujoco.MjModel.from_xml_path(str(path))
    assert (np.bincount(model.geom_bodyid, minlength=model.nbody) > 0).all()
    assert all(link.collisions for link in read_robot(path).links)


def test_a_link_that_is_not_asked_for_stays_and_the_other_is_carved_clear_of_it(tmp_path: Path) -> None:
    path = write(tmp_path, drawer())
    editor, robot = UrdfEditor(path, tmp_path / "out" / "fixed.urdf"), read_robot(path)
    editor.carve(robot, frozenset({"case"}), load_config(), load_settings())
    fixed = editor.write()
    slider = read_robot(fixed).link_by_name["slider"]
    assert [shape.file.resolve() for shape in slider.collisions if shape.file] == [tmp_path / "slider.stl"]
    deep, value = reached(fixed)
    assert deep < 1e-3
    assert value < -0.95 * LIMIT
