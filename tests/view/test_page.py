"""The viewer's page in a browser: a candidate is chosen, kept, and found in the file; it fits a narrow window."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from kinematify.pipeline import infer, write_inference
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from tests.browser import opened
from tests.objects import BUILDERS
from tools.draw_view import keep_candidate

if TYPE_CHECKING:
    from pathlib import Path


def test_a_candidate_is_chosen_kept_and_found_in_the_file(tmp_path: Path) -> None:
    pytest.importorskip("viser", reason="viser is not installed")
    from kinematify.view.window import Window  # needs viser

    folder = tmp_path / "model"
    write_inference(infer(BUILDERS["edge_door"]().assembly), folder, preview=False)
    (joint,) = read_robot(folder / "model.urdf").joints
    window = Window(folder / "model.urdf", port=18140)
    window.run_aside()
    try:
        with opened(window.url, width=400) as (page, told):
            page.wait_for_selector("text=At rest", timeout=120_000)
            window.viewer.choose(joint.name)
            said = keep_candidate(page, joint.name, "fixed")
            assert f"--hint {joint.child}=fixed" in said
            assert page.evaluate("document.documentElement.scrollWidth") <= 400, "nothing hangs over the side"
            assert not [line for line in told if line.startswith("error")]
    finally:
        window.close()
    assert read_robot(folder / "model.urdf").joints[0].kind is JointType.FIXED
