"""Where another part could be the base link: confidence of the joints, and what the user reads."""

from __future__ import annotations

import pytest

import kinematify
from kinematify.config import load_config
from kinematify.contact.graph import pair
from kinematify.generate.procedural.solids import box
from kinematify.pipeline.stages import choose_joints
from tests.inferred import inferred
from tests.known import known_object

DOUBT = load_config().topology.base_doubt


@pytest.mark.parametrize("name", ["drawer", "nested_drawer", "cabinet"])
def test_the_confidence_of_a_joint_falls_by_that_of_a_base_beyond_its_part(name: str) -> None:
    """What hangs on what is right if the edge is, and if the base is not the part or what that carries."""
    found = inferred(name)
    tree = found.trees[0]
    alone = choose_joints(found.assembly, found.graph, tree, found.bearings, found.config)
    assert sum(tree.standing) == pytest.approx(1.0)
    for joint, before in zip(found.joints, alone, strict=True):
        beyond = {joint.child}
        while len(more := beyond | {part for part, parent in enumerate(tree.parents) if parent in beyond}) > len(
            beyond
        ):
            beyond = more
        likely = tree.likely.get(pair(joint.parent, joint.child), 1.0)
        right = likely * (1.0 - sum(tree.standing[part] for part in beyond))
        assert joint.confidence == pytest.approx(before.confidence * right)
        assert joint.evidence["parent_likely"] == pytest.approx(right)


def test_a_doubtful_base_is_said_with_its_rivals_and_how_likely_each_is() -> None:
    """Of two equal boards on one hinge nothing says which one is held."""
    boards = {"one": box((0.0, 0.0, 0.0), (0.3, 0.2, 0.01)), "other": box((0.0, 0.2005, 0.0), (0.3, 0.4005, 0.01))}
    found = kinematify.infer(known_object("boards", boards).assembly)
    standing = dict(zip(found.assembly.names, found.trees[0].standing, strict=True))
    assert standing["one"] == pytest.approx(standing["other"]) == pytest.approx(0.5)
    (said,) = (warning for warning in found.warnings if "base link is not certain" in warning)
    assert "one (50%) or other (50%)" in said
    assert "--base" in said
    assert found.joints[0].confidence <= 0.5


def test_a_base_beyond_doubt_is_not_said() -> None:
    found = inferred("knob")
    assert sorted(found.trees[0].standing)[-2] < DOUBT
    assert not [warning for warning in found.warnings if "base link" in warning]
