"""The fitted scorer: probabilities of the hypotheses of an edge, and what is said of weights that cannot be used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from benchmarks.fit.trees import recipe_key
from kinematify.contact.graph import pair
from kinematify.joints.choice.decide import edge_features
from kinematify.joints.choice.judge import judge
from kinematify.joints.choice.scorer import (
    OPENING_WEIGHTS,
    RIGID_WEIGHTS,
    TURNING_WEIGHTS,
    WEIGHTS,
    shipped_scorer,
)
from kinematify.joints.features.edge_scene import TreeScenes
from kinematify.joints.features.workspace import PartCache, point_cloud
from tests.joints.joint_scenes import CONFIG, evidence
from tests.objects import BUILDERS

if TYPE_CHECKING:
    from kinematify.joints.features.columns import Features
    from kinematify.joints.features.workspace import Cloud


def first_features(name: str) -> Features:
    """Of the first edge of a known object."""
    known = BUILDERS[name]()
    tree, graph, bearings = evidence(known)
    cache = PartCache(known.assembly, graph, samples=CONFIG.joints.samples, seed=0)
    edge = next(iter(tree.edges()))
    return edge_features(TreeScenes(cache, tree, CONFIG.joints).scene(edge, bearings.get(pair(*edge))))


def cloud_of(features: Features) -> Cloud:
    """The points that the scorer sees."""
    scene = features.scene
    return point_cloud(scene.cache, scene.parent, scene.child, scene.others, scene.frame.diagonal)


def test_probabilities_follow_the_hypotheses_in_any_order() -> None:
    features = first_features("drawer")
    hypotheses, measured, cloud = features.hypotheses, features.columns, cloud_of(features)
    likely = shipped_scorer().probabilities(hypotheses, measured, cloud)
    assert likely.sum() == pytest.approx(1.0)
    order = np.random.default_rng(0).permutation(len(likely))
    shuffled = {name: value[order] for name, value in measured.items()}
    again = shipped_scorer().probabilities(hypotheses.at(order), shuffled, cloud)
    np.testing.assert_allclose(again, likely[order], rtol=1e-5)


def test_what_is_not_finite_counts_as_not_known() -> None:
    features = first_features("drawer")
    hypotheses, measured, cloud = features.hypotheses, features.columns, cloud_of(features)
    broken = {**measured, "contact_radius": np.full(len(hypotheses), np.inf)}
    missing = {name: value for name, value in measured.items() if name != "contact_radius"}
    scorer = shipped_scorer()
    found = scorer.probabilities(hypotheses, broken, cloud)
    assert np.isfinite(found).all()
    np.testing.assert_array_equal(found, scorer.probabilities(hypotheses, missing, cloud))


def test_the_measurements_are_those_that_were_fitted() -> None:
    assert set(first_features("edge_door").columns) <= set(shipped_scorer().measurements)


@pytest.mark.parametrize("name", [WEIGHTS, RIGID_WEIGHTS, OPENING_WEIGHTS, TURNING_WEIGHTS])
def test_weights_read_nothing_that_is_measured_no_more(name: str) -> None:
    """Names of what went after a fit are in the provenance alone."""
    scorer = shipped_scorer(name)
    assert len(set(scorer.measurements)) == len(scorer.measurements)
    assert not {*scorer.provenance["retired"], "retired"} & set(scorer.measurements)


def test_the_weights_are_those_of_the_committed_recipe() -> None:
    """Another parameter, start or measurement without a new fit goes red; `benchmarks.fit` remakes the weights."""
    shipped = shipped_scorer()
    assert shipped.provenance["recipe"] == recipe_key(shipped.measurements)


def test_the_choice_is_the_first_alternative() -> None:
    judged = judge(first_features("edge_door"), CONFIG.joints.confidence)
    first = judged.alternatives(CONFIG.joints.alternatives)[0]
    np.testing.assert_array_equal(first.axis, judged.hypotheses.axes[judged.best])
    assert 0.0 < judged.confidence <= 1.0


def test_what_models_say_together_is_surer_than_their_mean() -> None:
    judged = judge(first_features("edge_door"), CONFIG.joints.confidence)
    kinds, axes, best = judged.hypotheses.kinds, judged.hypotheses.axes, judged.best
    agree = (kinds == kinds[best]) & (np.abs(axes @ axes[best]) > np.cos(np.radians(5.0)))
    assert 0.5 < judged.posterior[agree].sum() < judged.confidence
