"""Quality of a contact edge: bounded, rising with bearing and contact, lower across gaps."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kinematify.config import load_config
from kinematify.contact.graph import ContactEdge, ContactSamples
from kinematify.joints.hypotheses.bearing_line import BearingLine, EdgeBearing
from kinematify.joints.measure.quality import edge_quality

CONFIG = load_config().quality
UNIT = st.floats(0.0, 1.0)
NOTHING = ContactSamples(points=np.empty((0, 3)), normals=np.empty((0, 3)), distances=np.empty(0), areas=np.empty(0))


def quality(score: float | None, strength: float, *, bridge: bool = False) -> float:
    """Quality of an edge whose best bearing has this score; None: no bearing was fitted."""
    edge = ContactEdge(a=0, b=1, gap=0.0, strength=strength, samples_a=NOTHING, samples_b=NOTHING, bridge=bridge)
    bearing = None if score is None else EdgeBearing(a=0, b=1, centroid=np.zeros(3), lines=(line(score), line(0.0)))
    return edge_quality(edge, bearing, CONFIG)


def line(score: float) -> BearingLine:
    return BearingLine(
        axis=np.array([0.0, 0.0, 1.0]), pivot=np.zeros(3), score=score,
        surface_a=score, surface_b=score, circles_a=score, circles_b=score,
    )  # fmt: skip


@given(score=UNIT, strength=UNIT, bridge=st.booleans())
def test_quality_is_a_share(score: float, strength: float, bridge: bool) -> None:
    assert 0.0 <= quality(score, strength, bridge=bridge) <= 1.0


@given(scores=st.tuples(UNIT, UNIT), strength=UNIT)
def test_a_better_bearing_never_lowers_it(scores: tuple[float, float], strength: float) -> None:
    assert quality(min(scores), strength) <= quality(max(scores), strength) + 1e-12


@given(score=UNIT, strengths=st.tuples(UNIT, UNIT))
def test_a_larger_contact_never_lowers_it(score: float, strengths: tuple[float, float]) -> None:
    assert quality(score, min(strengths)) <= quality(score, max(strengths)) + 1e-12


@given(score=UNIT, strength=UNIT)
def test_a_gap_never_raises_it(score: float, strength: float) -> None:
    assert quality(score, strength, bridge=True) <= quality(score, strength)


@given(strength=UNIT)
def test_without_bearing_the_contact_alone_counts(strength: float) -> None:
    edge = ContactEdge(a=0, b=1, gap=0.0, strength=strength, samples_a=NOTHING, samples_b=NOTHING)
    flat = EdgeBearing(a=0, b=1, centroid=np.zeros(3), lines=())
    assert edge_quality(edge, flat, CONFIG) == quality(None, strength) == pytest.approx(quality(0.0, strength))
    assert quality(None, strength) == pytest.approx(CONFIG.contact_weight * strength**CONFIG.strength_power)


def test_half_of_the_full_quality_is_where_the_configuration_says() -> None:
    assert quality(CONFIG.half_score, 0.0) == pytest.approx(0.5)


def test_a_clear_bearing_outweighs_any_contact() -> None:
    assert quality(CONFIG.half_score, 0.0) > quality(None, 1.0)
