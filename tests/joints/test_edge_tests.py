"""What is asked of contacts before the tree: doors side by side do not hold each other."""

from __future__ import annotations

from kinematify.config import load_config
from kinematify.generate.procedural.solids import box
from kinematify.joints.features.pins import has_journal
from kinematify.joints.features.workspace import PartCache
from tests.joints.joint_scenes import evidence
from tests.known import known_object, turning

CONFIG = load_config()


def test_doors_side_by_side_do_not_hold_each_other() -> None:
    body = box((-0.4, 0.0, 0.0), (0.4, 0.4, 0.8)) - box((-0.38, -0.1, 0.02), (0.38, 0.38, 0.78))
    solids = {"body": body}
    for k, (left, right) in enumerate(((-0.39, -0.0005), (0.0005, 0.39))):
        solids[f"door_{k}"] = box((left, -0.02, 0.01), (right, 0.0, 0.79))
    joints = [turning("body", f"door_{k}", (0, 0, 1), (s * 0.39, 0, 0), (0, 1.5)) for k, s in enumerate((-1, 1))]
    known = known_object("doors", solids, *joints)
    _, graph, _ = evidence(known)
    cache = PartCache(known.assembly, graph, samples=500, seed=0)
    assert (1, 2) in graph.by_pair
    assert not any(has_journal(cache, pair, CONFIG.joints) for pair in graph.by_pair)
