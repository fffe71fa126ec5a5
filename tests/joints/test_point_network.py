"""The network that looks at points: what it reads, and that it answers as the one that was fitted."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from benchmarks.fit.point_network import unfitted_model, written
from kinematify.joints.candidate import ELSEWHERE, FIXED, SLIDE, TURN, Hypotheses
from kinematify.joints.choice.point_network import point_inputs
from kinematify.joints.features.workspace import CARRIED, CHILD, OTHER, PARENT, Cloud


def some_cloud(seed: int, *, others: bool = True) -> Cloud:
    """Random points of all parts."""
    rng = np.random.default_rng(seed)
    labels = np.repeat([CHILD, PARENT, OTHER, CARRIED] if others else [CHILD, PARENT], 12)
    normals = rng.normal(size=(len(labels), 3))
    return Cloud(
        points=rng.normal(size=(len(labels), 3)),
        normals=normals / np.linalg.norm(normals, axis=1)[:, None],
        gaps=rng.uniform(0.0, 0.5, len(labels)),
        labels=labels,
        centre=rng.normal(size=3),
        parent_centre=rng.normal(size=3),
        unit=1.3,
        sizes=np.array([-0.4, -0.9]),
    )


def some_hypotheses(seed: int) -> Hypotheses:
    """Fixed, turns and slides about random lines."""
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(9, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    axes[0] = 0.0
    kinds = np.array([FIXED, *[TURN] * 5, *[SLIDE] * 3])
    return Hypotheses(
        kinds=kinds, axes=axes, pivots=rng.normal(size=(9, 3)), places=np.full(9, ELSEWHERE), sources=np.full(9, "any")
    )


MOVING = np.arange(1, 9)


@pytest.mark.parametrize("others", [True, False])
def test_arrays_say_what_the_fitted_network_says(others: bool) -> None:
    torch.manual_seed(0)
    models = [unfitted_model().eval() for _ in range(2)]
    cloud, hypotheses = some_cloud(4, others=others), some_hypotheses(5)
    points, lines = map(torch.from_numpy, point_inputs(cloud, hypotheses, MOVING))
    with torch.no_grad():
        edge, counts = torch.zeros(8, dtype=torch.long), (12, 12, 24)
        if not others:  # the rest is filled up with points of the child, which count for nothing
            points, counts = torch.cat([points, points[:, :1]], dim=1), (12, 12, 1)
        scores = torch.stack([model(points, lines, edge, counts) for model in models])
    wanted = torch.log_softmax(scores, dim=1).mean(dim=0).numpy()
    found = written(models).log_probabilities(cloud, hypotheses)
    assert found[0] == -np.inf
    np.testing.assert_allclose(found[1:], wanted, atol=5e-3)  # written with half the digits
