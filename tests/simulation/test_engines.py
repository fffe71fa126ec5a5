"""What every engine behind the protocol must answer alike, whichever it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from kinematify.config.validation import load_settings
from kinematify.errors import EnvironmentFault
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.read import read_robot
from kinematify.simulation.configurations import link_poses, pose_configurations
from kinematify.simulation.engines import ENGINES, EngineEntry, open_engine, require_engine
from kinematify.simulation.prepared import prepare
from kinematify.versions import package_versions
from tests.validation.engine_models import Box, Model, Part

INSTALLED = [name for name, entry in ENGINES.items() if package_versions([entry.package])[entry.package] != "missing"]


def crane() -> Model:
    """A column that turns with a sledge on its boom: both joints load each other."""
    column = Part(name="column", parent="base", kind="continuous", boxes=(), at=(0.0, 0.0, 1.0), axis=(0.0, 1.0, 0.0))
    sledge = Part(
        name="sledge", parent="column", kind="prismatic", boxes=(Box(size=(0.1, 0.1, 0.1)),), at=(0.5, 0.0, 0.0)
    )
    return Model(parts=(Part(name="base", boxes=(Box(size=(0.2, 0.2, 0.2)),)), column, sledge))


@pytest.mark.parametrize("name", INSTALLED)
def test_poses_inertia_and_weight_are_those_of_mechanics(tmp_path: Path, name: str) -> None:
    settings = load_settings()
    robot = read_robot(crane().write(tmp_path))
    prepared, mechanism = prepare(robot, tmp_path, settings.prepare), LeaderMechanism(robot=robot)
    model = open_engine(name, settings.engines, tmp_path / "log").load(prepared, mechanism)
    rows = pose_configurations(robot, settings.engines, seed=0)
    assert model.complete
    assert model.loaded.total_mass == pytest.approx(6.0)
    np.testing.assert_allclose(model.poses(rows.q), link_poses(robot, rows), atol=1e-6)
    if not ENGINES[name].runs:
        return
    seen = model.measure(rows.q[2:])
    turn, out = rows.q[2:].T
    np.testing.assert_allclose(np.diag(seen.inertia), [0.1 + 2.0 * (0.5 + out[0]) ** 2, 2.0], rtol=1e-5)
    weight = 2.0 * 9.81
    np.testing.assert_allclose(seen.gravity[:, 0], -weight * (0.5 + out) * np.cos(turn), atol=1e-3)
    np.testing.assert_allclose(seen.gravity[:, 1], -weight * np.sin(turn), atol=1e-3)


def test_engine_that_is_not_installed_is_reported_with_the_way_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    absent = EngineEntry(name="absent", title="Absent", package="no-such-engine", family="KV9")
    monkeypatch.setitem(ENGINES, "absent", absent)
    with pytest.raises(EnvironmentFault, match=r"Absent.*no-such-engine.*pip install kinematify"):
        require_engine("absent")


def test_families_of_ids_are_reported_apart() -> None:
    families = [entry.family for entry in ENGINES.values()]
    assert len(set(families)) == len(families)
