"""A linkage that closes: the joint that the tree leaves out is told in result, record, summary and viewer."""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.cli.inferred import describe
from kinematify.pipeline import Inference, infer, write_inference
from kinematify.robot.read import read_robot
from kinematify.view.record import shown_with
from kinematify.view.scene import ViewScene
from tests.household import edge_door, four_bars

if TYPE_CHECKING:
    from pathlib import Path


@cache
def inferred() -> Inference:
    return infer(four_bars().assembly)


def test_the_pin_that_was_cut_is_told_with_the_chain_and_the_reason(tmp_path: Path) -> None:
    (chain,) = inferred().closed_chains
    assert len(chain.joints) == 3, "four pins, of which one was cut"
    assert abs(float(chain.line.axis[2])) > 0.999
    assert chain.opening.distance > 0.02
    assert chain.rival is None or chain.rival <= chain.reward
    told = describe(inferred(), tmp_path)
    assert f"Closed chain: {chain.told}" in told
    assert all(part in chain.told for part in chain.parts)


def test_what_does_not_close_is_not_told() -> None:
    assert infer(edge_door().assembly).closed_chains == ()


def test_the_record_has_it_and_the_viewer_draws_a_dashed_line(tmp_path: Path) -> None:
    folder = tmp_path / "model"
    write_inference(inferred(), folder, preview=False)
    record = json.loads((folder / "inference.json").read_text())
    (item,) = record["closed_chains"]
    assert sorted(item["parts"]) == sorted(inferred().closed_chains[0].parts)
    assert record["doubtful_below"] == 0.5
    scene = ViewScene(read_robot(folder / "model.urdf"))
    (chain,) = shown_with(scene, folder / "inference.json").chains
    at_rest, moved = (
        chain.dashes(scene.poses({item["opened_by"]: value}), scene.size)[-1, 1]
        - chain.dashes(scene.poses({item["opened_by"]: value}), scene.size)[-9, 0]
        for value in (0.0, 0.4)
    )
    assert np.linalg.norm(at_rest) == pytest.approx(0.0, abs=1e-6), "the pin is closed at rest"
    assert np.linalg.norm(moved) > 0.01, "and its ends come apart"
