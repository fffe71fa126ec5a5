"""Ways of modelling and random mechanisms: the joints stay exact, whatever is drawn of the parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from benchmarks.fit.chains import chain
from benchmarks.fit.composed import compose
from benchmarks.fit.modelling import WAYS, augment
from kinematify.generate.registry import build

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.generate.procedural.blueprint import Blueprint


@pytest.mark.parametrize("way", sorted(WAYS))
def test_every_way_keeps_the_joints_and_leaves_parts(way: str) -> None:
    drawn = build("cabinet", seed=1)
    changed = augment(drawn, way, rng=np.random.default_rng(0))
    assert changed.joints == drawn.joints
    assert [part.name for part in changed.parts] == [part.name for part in drawn.parts]
    assert all(len(part.faces) for part in changed.parts)
    same = all(a is b for a, b in zip(drawn.parts, changed.parts, strict=True))
    assert same is (way == "as_drawn")


@pytest.mark.parametrize("build_one", [compose, chain])
def test_random_mechanisms_follow_their_seed(build_one: Callable[[int], Blueprint]) -> None:
    for seed in range(20):
        first, second = build_one(seed), build_one(seed)
        assert first.joints
        assert all(len(part.faces) for part in first.parts)
        for a, b in zip(first.parts, second.parts, strict=True):
            np.testing.assert_array_equal(a.vertices, b.vertices)


def test_links_of_chains_hang_on_links_or_on_the_body() -> None:
    parents = [{joint.parent.split("_")[0] for joint in chain(seed).joints} for seed in range(20)]
    assert all("body" in some for some in parents)
    assert sum("link" in some for some in parents) > 10
