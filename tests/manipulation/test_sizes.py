"""Real sizes by category, and copies of objects at another size."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from kinematify.errors import InputError
from kinematify.manipulation.real_size import category_of, is_normalised, sizing, write_scaled
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics


def box_of(extent: float, *, stands: bool = True) -> np.ndarray:
    """Box of a cube that stands on the floor or is centred at the origin."""
    low = -0.5 * extent
    return np.array([[low, low, 0.0 if stands else low], [-low, -low, extent if stands else -low]])


@pytest.mark.parametrize(
    ("path", "name", "category"),
    [
        ("out/model.urdf", "drawer_cabinet_17", "drawer cabinet"),
        ("everyday/washing_machine_103480/model.urdf", "partnet", "washing machine"),
        ("cabinets/model.urdf", "robot", "cabinet"),
        ("x/MicroWave.urdf", "robot", None),
        ("x/microwaves.urdf", "robot", "microwave"),
        ("x/KitchenPot.urdf", "robot", "kitchen pot"),
        ("x/model.urdf", "safety", None),
        ("x/model.urdf", "", None),
    ],
)
def test_categories_are_whole_words(path: str, name: str, category: str | None) -> None:
    assert category_of(Path("/nowhere/at/all") / path, name) == category


def test_unit_shapes_are_brought_to_their_real_size() -> None:
    box = box_of(1.2, stands=False)
    assert is_normalised(box)
    assert not is_normalised(box_of(1.2))
    assert 1.2 * sizing(Path("/a/b/c.urdf"), "stapler", box)[0] == pytest.approx(0.16)
    assert "normalised" in sizing(Path("/a/b/c.urdf"), "cabinet", box)[1]


@pytest.mark.parametrize("scale", [0.0, -1.0, float("inf"), float("nan")])
def test_a_scale_must_be_a_factor(scale: float) -> None:
    with pytest.raises(InputError, match="--scale"):
        sizing(Path("/a/b/c.urdf"), "cabinet", box_of(1.0), scale=scale)


LINKAGE = """<robot name="r">
<link name="a"><inertial><origin xyz="0.1 0 0"/><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><origin xyz="0 0.2 0"/><geometry><cylinder radius="0.1" length="0.4"/></geometry></visual></link>
<link name="b"><visual><geometry><sphere radius="0.2"/></geometry></visual></link>
<link name="c"><visual><geometry><box size="0.1 0.2 0.3"/></geometry></visual></link>
<joint name="turn" type="revolute"><parent link="a"/><child link="b"/><origin xyz="1 0 0" rpy="0 0 1"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="0 0 0.5"/>
<axis xyz="1 0 0"/><limit lower="0" upper="0.4" effort="1" velocity="1"/>
<mimic joint="turn" multiplier="0.3" offset="0.1"/>
</joint></robot>"""


def test_a_scaled_copy_moves_like_the_original(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text(LINKAGE)
    write_scaled(tmp_path / "r.urdf", 0.25, tmp_path / "s.urdf")
    first, second = (read_robot(tmp_path / f"{name}.urdf") for name in ("r", "s"))
    for angle in (-0.7, 0.0, 0.9):
        here, there = (forward_kinematics(model, {"turn": angle}) for model in (first, second))
        for link in here:
            assert there[link][:3, 3] == pytest.approx(0.25 * here[link][:3, 3])
            assert there[link][:3, :3] == pytest.approx(here[link][:3, :3])
    assert second.joint_by_name["slide"].upper == pytest.approx(0.1)
    assert second.joint_by_name["turn"].upper == pytest.approx(1.0)
    inertial = second.link_by_name["a"].inertial
    assert inertial is not None
    assert inertial.mass == pytest.approx(2.0 / 64.0)
    assert inertial.tensor[0, 0] == pytest.approx(0.1 / 1024.0)
    for link in ("a", "b", "c"):
        one, other = (model.link_by_name[link].visuals[0].mesh.vertices for model in (first, second))
        assert other == pytest.approx(0.25 * one, abs=1e-12)
