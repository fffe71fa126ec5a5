"""Grasps are found from geometry: handles, knobs and rims, and nothing where there is nothing."""

from __future__ import annotations

from pathlib import Path

import fcl
import numpy as np
import pytest

from kinematify.errors import InputError
from kinematify.geometry.scene import read_scene
from kinematify.manipulation.grasp import search_grasps
from kinematify.robot.read import read_robot
from tests.manipulation import furniture

PLAIN = """<robot name="thing">
<link name="body">{body}</link>
<link name="part">{part}</link>
<joint name="j" type="{kind}"><origin xyz="{at}"/><parent link="body"/><child link="part"/>
<axis xyz="{axis}"/><limit lower="0" upper="{upper}" effort="1" velocity="1"/></joint>
</robot>"""


def write(
    path: Path,
    part: str,
    *,
    kind: str = "prismatic",
    at: str = "0 0 0",
    axis: str = "-1 0 0",
    upper: float = 0.2,
    body: str = "",
) -> Path:
    """An object of two links."""
    body = body or furniture.box((0.3, 0.4, 0.6), (0.16, 0.0, 0.3))
    path.write_text(PLAIN.format(body=body, part=part, kind=kind, at=at, axis=axis, upper=upper))
    return path


def test_a_drawer_is_held_at_its_bar_from_the_front(tmp_path: Path) -> None:
    grasps = furniture.grasps(furniture.write_drawer_cabinet(tmp_path / "c.urdf"), "slide")
    best = grasps[0]
    assert best.kind == "handle"
    assert best.T_link_grasp[0, 3] == pytest.approx(-0.255, abs=0.02)
    assert best.T_link_grasp[2, 3] == pytest.approx(0.02, abs=0.01)
    assert best.T_link_grasp[:3, 2] @ [1, 0, 0] > 0.7
    assert abs(best.T_link_grasp[:3, 1] @ [0, 0, 1]) > 0.7
    assert best.width == pytest.approx(0.012, abs=1e-3)


def test_fingers_and_what_they_hold_are_where_they_should_be(tmp_path: Path) -> None:
    """Both pads stand beside the part, and a box between them meets it."""
    urdf = furniture.write_drawer_cabinet(tmp_path / "c.urdf")
    scene = read_scene(read_robot(urdf), furniture.SETTINGS.geometry)
    body = next(b for b in scene.bodies if b.name == "part_7").solid
    tree = fcl.CollisionObject(body.tree, fcl.Transform(body.middle / scene.unit))

    def meets(T: np.ndarray, size: list[float], at: list[float]) -> bool:
        place = (T[:3, :3] @ np.array(at) + T[:3, 3]) / scene.unit
        shape = fcl.CollisionObject(fcl.Box(*(np.array(size) / scene.unit)), fcl.Transform(T[:3, :3], place))
        return fcl.collide(tree, shape, fcl.CollisionRequest(), fcl.CollisionResult()) > 0

    for grasp in furniture.grasps(urdf, "slide"):
        for side in (-1.0, 1.0):
            outward = side * (0.5 * grasp.spread + 0.006)
            assert not meets(grasp.T_link_grasp, [0.018, 0.01, 0.05], [0.0, outward, -0.015])
        assert meets(grasp.T_link_grasp, [0.02, grasp.spread, 0.02], [0.0, 0.0, 0.0])


def test_a_flush_front_offers_nothing_and_says_why(tmp_path: Path) -> None:
    urdf = write(tmp_path / "c.urdf", furniture.box((0.02, 0.39, 0.59), (0.0, 0.0, 0.3)))
    scene = read_scene(read_robot(urdf), furniture.SETTINGS.geometry)
    grasps, reason = search_grasps(scene, "j", 0.1)
    assert not grasps
    assert reason


def test_a_part_inside_a_closed_box_is_not_seen(tmp_path: Path) -> None:
    body = "".join(
        furniture.box(size, at)
        for size, at in [
            ((0.02, 0.4, 0.4), (-0.2, 0, 0)), ((0.02, 0.4, 0.4), (0.2, 0, 0)),
            ((0.42, 0.02, 0.4), (0, -0.2, 0)), ((0.42, 0.02, 0.4), (0, 0.2, 0)),
            ((0.42, 0.42, 0.02), (0, 0, -0.2)), ((0.42, 0.42, 0.02), (0, 0, 0.2)),
        ]
    )  # fmt: skip
    urdf = write(tmp_path / "c.urdf", furniture.box((0.03, 0.03, 0.03), (0, 0, 0)), body=body)
    scene = read_scene(read_robot(urdf), furniture.SETTINGS.geometry)
    grasps, reason = search_grasps(scene, "j", 0.1)
    assert not grasps
    assert "outside" in reason


def test_a_knob_is_turned_by_the_width_of_the_grasp(tmp_path: Path) -> None:
    knob = (
        '<visual><origin xyz="-0.015 0 0" rpy="0 1.5708 0"/>'
        '<geometry><cylinder radius="0.02" length="0.03"/></geometry></visual>'
    )
    urdf = write(tmp_path / "c.urdf", knob, kind="revolute", at="0 0 0.4", axis="1 0 0", upper=2.0)
    grasps = furniture.grasps(urdf, "j")
    assert grasps[0].kind == "knob"
    along = [g for g in grasps if g.T_link_grasp[:3, 2] @ [1, 0, 0] > 0.9]
    assert along
    assert max(g.lever for g in along) == pytest.approx(0.02, abs=0.006)


def test_a_lid_is_held_at_its_rim(tmp_path: Path) -> None:
    body = furniture.box((0.3, 0.3, 0.2), (0.0, 0.0, 0.1))
    urdf = write(
        tmp_path / "c.urdf", furniture.box((0.36, 0.3, 0.02), (0.15, 0.0, 0.0)), kind="revolute", at="-0.15 0 0.211",
        axis="0 -1 0", upper=1.5, body=body,
    )  # fmt: skip
    grasps = furniture.grasps(urdf, "j")
    rims = [grasp for grasp in grasps if grasp.kind == "rim"]
    assert len(rims) > 0.5 * len(grasps)  # corners are cut off on the other side
    assert all(grasp.lever > 0.3 for grasp in rims[:10])


def test_a_point_of_the_user_wins(tmp_path: Path) -> None:
    urdf = furniture.write_drawer_cabinet(tmp_path / "c.urdf")
    point = np.array([-0.255, 0.05, 0.47])
    for grasp in furniture.grasps(urdf, "slide", point=point):
        assert np.linalg.norm(grasp.T_link_grasp[:3, 3] + [0.0, 0.0, 0.45] - point) < 0.06


def test_a_point_in_the_air_and_unknown_joints_are_refused(tmp_path: Path) -> None:
    urdf = furniture.write_drawer_cabinet(tmp_path / "c.urdf")
    with pytest.raises(InputError, match="from what slide moves"):
        furniture.grasps(urdf, "slide", point=np.array([-1.0, 0.0, 0.5]))
    with pytest.raises(InputError, match="no joint 'lid'"):
        furniture.grasps(urdf, "lid")
