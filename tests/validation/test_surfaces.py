"""Whether declared surfaces meet where the convex pieces that stand in for them do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.solids import box
from kinematify.geometry.scene import read_scene
from kinematify.model.urdf import write_urdf
from kinematify.pipeline.blueprint_files import true_model
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.read import read_robot
from kinematify.validation.finding import Cause, Severity
from kinematify.validation.geometry.surfaces import surfaces_meet
from kinematify.validation.run import validate
from tests.known import known_object, sliding
from tests.validation.planted import write

GEOMETRY = load_settings().geometry


@pytest.fixture(scope="module")
def slit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A bar with a knob that runs down a slit of a millimetre of play in a wall, 60 mm long."""
    wall = box((-0.1, 0.0, 0.0), (0.1, 0.012, 0.2)) - box((-0.005, -1.0, 0.03), (0.005, 1.0, 0.12))
    bar = box((-0.004, -0.03, 0.1), (0.004, 0.04, 0.11))
    known = known_object(
        "slit", {"wall": wall, "bar": bar}, sliding("wall", "bar", (0, 0, -1), (0, 0, 0.1), (0.0, 0.06))
    )
    return write(known, tmp_path_factory.mktemp("slit"))


@pytest.mark.parametrize(("depth", "meet"), [(0.06, False), (0.1, True)])
def test_a_bar_is_stopped_by_the_end_of_its_slit_alone(slit: Path, depth: float, meet: bool) -> None:
    model = read_robot(slit)
    rows = np.linspace(0.0, depth, 20)[:, None]
    assert LeaderMechanism(robot=model).rest == 0.0
    assert surfaces_meet(read_scene(model, GEOMETRY), ("wall", "bar"), rows, tolerance=0.001) is meet


def test_without_surfaces_the_pieces_have_the_last_word(slit: Path) -> None:
    bare = read_scene(read_robot(slit, geometry="none"), GEOMETRY)
    assert surfaces_meet(bare, ("wall", "bar"), np.zeros((2, 1)), tolerance=0.001)


def test_a_lever_that_only_pieces_stop_is_no_error(tmp_path: Path) -> None:
    """Pieces within 2 % of its size close the slits of this toaster."""
    toaster = build(FAMILIES["toaster"], {}, seed=6, name="toaster")
    write_urdf(true_model(toaster, load_config()), tmp_path)
    report = validate(tmp_path / "model.urdf", workers=1)
    assert not [item for item in report.counted if item.severity is Severity.ERROR]
    stopped = [item for item in report.counted if item.check == "KV405"]
    assert stopped
    assert all("declared surfaces stay clear" in item.message for item in stopped)
    assert {item.cause for item in stopped} == {Cause.PHYSICS}
