"""Drawn objects: each is built by any hand, and by a careful one so that every joint moves freely through its range."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold, OpType

from benchmarks.fit.drawn import DRAWN, drawn_object
from kinematify.generate.procedural.builder import CAREFUL
from kinematify.robot.joint_type import JointType
from tests.known import carried, solid_of

_MORE = 1e-3
"""Of the smaller body: what two may share more than where they are drawn. Circles are polygons."""


def sound_solid(part):
    solid = solid_of(part)
    assert solid.status().name == "NoError", part.name
    assert solid.volume() > 0.0, part.name
    return solid


def chained(blueprint):
    """Parts that loop joints hold, with all that carries them: none of them moves alone."""
    above = {joint.child: joint.parent for joint in blueprint.joints}
    found = set()
    for loop in blueprint.loops:
        links = loop.one, loop.other
        while links := tuple(name for name in links if name in above):
            found.update(links)
            links = tuple(above[name] for name in links)
    return found


def blocked(blueprint):
    """Pairs of a moving part and another one that share more room somewhere on the way than at the start.

    Two parts of a closed chain are no such pair: the chain moves as one, and its joints cannot be moved singly.
    """
    solids = {part.name: sound_solid(part) for part in blueprint.parts}
    chain = chained(blueprint)
    found = set()
    for joint in blueprint.joints:
        moving = carried(blueprint, joint.child)
        body = Manifold.batch_boolean([solids[name] for name in sorted(moving)], OpType.Add)
        values = np.linspace(max(joint.lower, -np.pi), min(joint.upper, np.pi), 6)
        moved = [body.transform(joint.motion(float(value))[:3]) for value in values]
        for name in set(solids) - moving - (chain if joint.child in chain else set()):
            other = solids[name]
            shared = (body ^ other).volume() + _MORE * min(body.volume(), other.volume())
            if any((placed ^ other).volume() > shared for placed in moved):
                found.add((joint.child, name))
    return found


@pytest.mark.parametrize("name", DRAWN[::8])
def test_what_a_careful_hand_draws_moves_freely(name):
    blueprint = drawn_object(name, 0, CAREFUL)
    shut = blocked(blueprint)
    if shut:  # a rack may need its door open, a seat its lid up
        ends = {joint.child: joint.upper for joint in blueprint.joints if np.isfinite(joint.upper)}
        shut &= blocked(blueprint.moved(ends))
    assert not shut


@pytest.mark.parametrize("name", DRAWN[::8])
def test_any_hand_draws_it_and_a_seed_draws_the_same_again(name):
    one, again, other = drawn_object(name, 7), drawn_object(name, 7), drawn_object(name, 8)
    for left, right in zip(one.parts, again.parts, strict=True):
        np.testing.assert_array_equal(left.vertices, right.vertices)
    assert any(joint.kind is not JointType.FIXED for joint in one.joints)
    assert any(
        left.vertices.shape != right.vertices.shape or not np.allclose(left.vertices, right.vertices)
        for left, right in zip(one.parts, other.parts, strict=False)
    )


def test_a_mirror_keeps_what_opens():
    """Seen in a mirror a leaf still swings outward: its motion is the mirror image of the motion."""
    blueprints = [drawn_object("wardrobe", seed, CAREFUL) for seed in range(8)]
    for blueprint in blueprints:
        body = blueprint.parts[0].bounds
        for joint in blueprint.joints:
            opened = blueprint.moved({joint.child: 0.5 * joint.upper})
            child = next(part for part in opened.parts if part.name == joint.child)
            outside = np.maximum(body[0] - child.bounds[0], child.bounds[1] - body[1]).max()
            assert outside > 0.05, (blueprint.name, joint.child)
