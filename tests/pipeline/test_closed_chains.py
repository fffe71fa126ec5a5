"""A linkage that closes: the pin that the tree leaves out becomes a loop joint, and the chain moves as one."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.cli.inferred import describe
from kinematify.pipeline.linkages import SharedAxis, close_chains
from kinematify.robot.linkage import loop_gaps
from kinematify.robot.read import read_robot
from tests.inferred import inferred, write_inferred

if TYPE_CHECKING:
    from pathlib import Path


def test_the_pin_that_was_cut_is_reported_with_the_chain_and_the_reason(tmp_path: Path) -> None:
    (chain,) = inferred("four_bars").closed_chains
    assert len(chain.joints) == 3, "four pins, of which one was cut"
    assert abs(float(chain.line.axis[2])) > 0.999
    assert chain.opening.distance > 0.02
    messages = describe(inferred("four_bars"), tmp_path)
    assert f"Closed chain: {chain.description}" in messages
    assert all(part in chain.description for part in chain.parts)


def test_what_does_not_close_is_not_reported() -> None:
    assert inferred("edge_door").closed_chains == ()


def test_the_model_has_the_loop_and_one_range_and_its_pin_stays_closed(tmp_path: Path) -> None:
    """The four bars are a parallelogram: the bars follow by <mimic>, and what is written holds what was inferred."""
    folder = write_inferred("four_bars", tmp_path / "model")
    record = json.loads((folder / "inference.json").read_text())
    (item,) = record["closed_chains"]
    robot = read_robot(folder / "model.urdf")
    (loop,) = robot.loops
    assert (item["loop"], item["by"]) == (loop.name, "mimic")
    assert sorted(loop.links) == sorted(item["parts"])
    (driver,) = robot.leaders
    assert driver.name == item["driver"]
    assert [joint.upper - joint.lower for joint in robot.joints] == pytest.approx([driver.upper - driver.lower] * 3)
    crank, rocker = (robot.joint_by_name[f"{name}_joint"] for name in ("crank", "rocker"))
    assert float(crank.axis @ rocker.axis) > 0.0, "congruent arms turn the same way"
    assert (crank.lower, crank.upper) == pytest.approx((rocker.lower, rocker.upper))
    for value in np.linspace(driver.lower, driver.upper, 9):
        assert loop_gaps(robot, {driver.name: float(value)})[loop.name] < 5e-4 * inferred("four_bars").assembly.diagonal


def test_a_pin_that_would_leave_no_motion_is_reported_and_not_written() -> None:
    """A bar between ground and rocker is a rigid triangle."""
    model = inferred("four_bars").model
    free = replace(model, loops=(), joints=tuple(replace(joint, mimic=None, closure=None) for joint in model.joints))
    up, at = np.array([0.0, 0.0, 1.0]), np.array([0.05, 0.03, 0.0])
    pins = [SharedAxis(links=("ground", "coupler"), axis=up, pivot=at + 0.02)]
    pins += [SharedAxis(links=("rocker", "coupler"), axis=up, pivot=np.array([0.1, 0.06, 0.02])), pins[0]]
    closed, closings = close_chains(free, pins[1:], {link.name: k for k, link in enumerate(free.links)}, 0.2)
    assert [closing.loop is None for closing in closings] == [False, True]
    assert len(closed.loops) == 1
