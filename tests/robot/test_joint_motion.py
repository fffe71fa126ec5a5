"""Motions of joints: laws of rigid motions, and agreement with an independent library."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Joint


@pytest.mark.parametrize(
    ("end", "endless"),
    [
        (math.inf, True),
        (10.0, True),
        (9.42478, True),
        (8 * math.pi, True),
        (2 * math.pi, False),
        (355.0, False),
        (3.49, False),
    ],
)
def test_a_hinge_is_endless_where_its_limits_say_that_there_are_none(end: float, endless: bool) -> None:
    joint = Joint(
        name="a", kind=JointType.REVOLUTE, parent="b", child="c", T_parent_child=np.eye(4), lower=-end, upper=end
    )
    assert joint.endless is endless
    assert replace(joint, lower=0.0).endless is False
    assert replace(joint, kind=JointType.PRISMATIC).endless is False
