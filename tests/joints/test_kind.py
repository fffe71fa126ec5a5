"""Types of joints on known objects."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kinematify import infer
from kinematify.generate.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.generate.sentence import from_text
from kinematify.joints.features.edge_scene import joint_scene, part_frames
from kinematify.joints.features.type_cues import WEIGHTS, type_cues, type_odds
from kinematify.joints.features.workspace import PartCache
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import (
    CONFIG,
    estimates_of,
    evidence,
    infer_joints,
    ranked_slides,
    ranked_turns,
    scene_of,
)
from tests.known import known_object, sliding, turning
from tests.objects import BUILDERS
from tests.robots import parallel_gripper


@pytest.mark.parametrize(
    "name",
    [
        "edge_door",
        "drawer",
        "nested_drawer",
        "knob",
        "sliding_lid",
        "laptop",
        "button",
        "square_lift",
        "round_lift",
        "parallel_gripper",
        "serial_arm",
        "wheel",
    ],
)
def test_types_of_known_objects(name: str) -> None:
    known = BUILDERS[name]()
    estimates = estimates_of(name)
    for joint in known.joints:
        found = estimates[joint.child].kind
        assert found.turns == joint.kind.turns, joint.child
        assert (found is JointType.PRISMATIC) == (joint.kind is JointType.PRISMATIC), joint.child


@pytest.mark.parametrize("seed", range(6))
def test_a_drawer_behind_the_whole_front_of_a_cabinet_slides(seed: int) -> None:
    """Half as deep as its front is high: no door, for it is inside its body."""
    inference = infer(from_text("a cabinet with one drawer").build(seed=seed).assembly)
    assert [joint.kind for joint in inference.joints] == [JointType.PRISMATIC]


def test_a_gantry_slides_on_its_rails() -> None:
    """Its bridge and its ram are thin as doors are, but rails hold them."""
    inference = infer(build(FAMILIES["gantry"], {}, seed=0).assembly)
    assert [joint.kind for joint in inference.joints] == [JointType.PRISMATIC] * 3


def test_bars_in_short_sleeves_slide_in_machines() -> None:
    """The ram of a coarse gantry and the spline of an arm: their rails are faint, but nothing about them is round."""
    for family, child, style in (("gantry", "ram", "coarse"), ("scara", "spindle", "remeshed")):
        blueprint = build(FAMILIES[family], {"style": style}, seed=0)
        names = [part.name for part in blueprint.assembly.parts]
        found = {names[item.child]: item.kind for item in infer(blueprint.assembly).joints}
        assert found[child] is JointType.PRISMATIC, family


def test_a_block_on_two_ropes_slides() -> None:
    frame = box((-0.05, -0.02, 0.5), (0.05, 0.02, 0.52)) + box((-0.05, -0.02, -0.02), (0.05, 0.02, 0.0))
    block = box((-0.03, -0.015, 0.4), (0.03, 0.015, 0.45))
    for x in (-0.02, 0.02):
        frame += cylinder(0.004, (x, 0, 0), (x, 0, 0.5))
        block -= cylinder(0.0045, (x, 0, 0), (x, 0, 1.0))
    hook = cylinder(0.004, (0, 0.005, 0.36), (0, 0.005, 0.401)) + box((-0.02, 0, 0.35), (0.02, 0.01, 0.362))
    joint = sliding("frame", "block", (0, 0, -1), (0, 0, 0.4), (0.0, 0.3))
    found = infer_joints(known_object("hoist", {"frame": frame, "block": block + hook}, joint))["block"]
    assert found.kind is JointType.PRISMATIC


@pytest.mark.parametrize(("score", "is_round"), [(0.005, False), (0.05, True)])
def test_a_finger_whose_rail_has_faded_is_hinged_only_if_its_contact_is_round(score: float, is_round: bool) -> None:
    known = parallel_gripper()
    tree, graph, bearings = evidence(known)
    cache = PartCache(known.assembly, graph, samples=CONFIG.joints.samples, seed=0)
    frames = part_frames(cache, tree, CONFIG.joints)
    edge = (known.index["palm"], known.index["right_finger"])
    found = bearings[edge]
    assert found.rail is not None
    faded = replace(found, lines=(replace(found.lines[0], score=score),), rail=replace(found.rail, score=1e-4))
    scene = joint_scene(cache, tree, frames, edge, faded, config=CONFIG.joints)
    assert scene.is_round is is_round


@pytest.mark.parametrize(("lead", "slides"), [(2.0, False), (4.6, True)])
def test_a_rail_that_leads_the_best_line_fourfold_guides(lead: float, slides: bool) -> None:
    known = BUILDERS["square_lift"]()
    tree, graph, bearings = evidence(known)
    cache = PartCache(known.assembly, graph, samples=CONFIG.joints.samples, seed=0)
    edge = next(iter(tree.edges()))
    found = bearings[edge]
    assert found.rail is not None
    rough = replace(found, lines=(replace(found.lines[0], score=found.rail.score / lead),))
    scene = joint_scene(cache, tree, part_frames(cache, tree, CONFIG.joints), edge, rough, config=CONFIG.joints)
    assert (scene.prismatic_score == 1.0) == slides


@pytest.mark.parametrize(("turn", "travel", "guides"), [(3.0, 0.25, False), (3.0, 1.0, True), (0.1, 0.25, True)])
def test_a_rail_along_which_little_moves_guides_only_what_cannot_turn(turn: float, travel: float, guides: bool) -> None:
    known = BUILDERS["square_lift"]()
    scene = replace(scene_of(known, known.joints[0].child), mechanism=1.0)
    assert scene.prismatic_score == 1.0
    turns, slides = ranked_turns(scene), ranked_slides(scene)
    turns = replace(turns, free_parent=np.full_like(turns.free_parent, turn))
    slides = replace(slides, cues={**slides.cues, "travel_parent": np.full(len(slides.axes), travel)})
    assert scene.bearing is not None
    assert scene.bearing.rail is not None
    across = np.roll(scene.bearing.rail.axis, 1)  # a pin along the rail is another matter
    across = replace(scene.bearing.lines[0], axis=across)
    scene = replace(scene, bearing=replace(scene.bearing, lines=(across,)))
    assert type_cues(scene, turns, slides, CONFIG.joints)["rail"] == float(guides)


@pytest.mark.parametrize(("room", "pressed"), [(0.004, True), (0.0008, False)])
def test_a_round_plug_with_room_behind_it_is_pressed_and_one_that_bottoms_out_turns(room: float, pressed: bool) -> None:
    body = box((-0.2, 0, 0), (0.2, 0.1, 0.1)) - cylinder(0.0103, (0, -1, 0.05), (0, 0.02, 0.05))
    plug = cylinder(0.01, (0, -0.006, 0.05), (0, 0.02 - room, 0.05))
    joint = sliding("body", "plug", (0, 1, 0), (0, 0, 0.05), (0.0, 0.003))
    estimate = infer_joints(known_object("panel", {"body": body, "plug": plug}, joint))["plug"]
    assert (estimate.kind is JointType.PRISMATIC) is pressed
    assert abs(float(estimate.axis[1])) > 0.999


def test_evidence_moves_the_odds_the_stated_way() -> None:
    known = BUILDERS["edge_door"]()
    scene = scene_of(known, known.joints[0].child)
    cues = type_cues(scene, ranked_turns(scene), ranked_slides(scene), CONFIG.joints)
    assert set(cues) == set(WEIGHTS)
    assert cues["keyed"] == 0.0
    assert type_odds(cues) < 0.0
    assert type_odds({**cues, "keyed": 1.0}) == pytest.approx(type_odds(cues) + WEIGHTS["keyed"])


@pytest.mark.parametrize(("depth", "slides"), [(0.2, True), (0.03, False)])
def test_a_rod_deep_in_a_tube_is_drawn_out_and_a_short_one_turns(depth: float, slides: bool) -> None:
    """The rod of a gas spring and a shaft with its seat: round, loose, alike but for how deep they are held."""
    tube = cylinder(0.026, (0, 0, 0), (0, 0, 0.25)) - cylinder(0.0145, (0, 0, 0.249 - depth), (0, 0, 1))
    rod = cylinder(0.014, (0, 0, 0.25 - depth), (0, 0, 0.27)) + cylinder(0.06, (0, 0, 0.26), (0, 0, 0.28))
    joint = sliding("tube", "rod", (0, 0, 1), (0, 0, 0), (0.0, 0.1))
    estimate = infer_joints(known_object("spring", {"tube": tube, "rod": rod}, joint))["rod"]
    assert (estimate.kind is JointType.PRISMATIC) is slides
    assert abs(float(estimate.axis[2])) > 0.999


@pytest.mark.parametrize(("depth", "slides"), [(0.08, True), (0.004, False)])
def test_a_plate_deep_in_a_shaft_travels_and_a_flush_one_is_a_lid(depth: float, slides: bool) -> None:
    shaft = box((-0.08, -0.15, 0), (0.08, 0.15, 0.2)) - box((-0.05, -0.12, 0.02), (0.05, 0.12, 1.0))
    top = 0.2 - depth
    plate = box((-0.0497, -0.1197, top - 0.006), (0.0497, 0.1197, top))
    joint = sliding("body", "plate", (0, 0, 1), (0, 0, top), (-0.1, 0.0))
    estimate = infer_joints(known_object("shaft", {"body": shaft, "plate": plate}, joint))["plate"]
    assert (estimate.kind is JointType.PRISMATIC) is slides
    if slides:
        assert abs(float(estimate.axis[2])) > 0.999


def test_a_round_flap_in_pins_across_its_mouth_swings() -> None:
    bin_ = cylinder(0.15, (0, 0, 0), (0, 0, 0.4)) - cylinder(0.146, (0, 0, 0.004), (0, 0, 1.0))
    bin_ -= cylinder(0.0045, (-1, 0, 0.36), (1, 0, 0.36))
    flap = cylinder(0.14, (0, 0, 0.357), (0, 0, 0.363))
    for side in (-1, 1):
        flap += cylinder(0.004, (0.139 * side, 0, 0.36), (0.146 * side, 0, 0.36))
        flap += cylinder(0.004, (0.146 * side, 0, 0.36), (0.15 * side, 0, 0.36), segments=24)
    joint = turning("bin", "flap", (1, 0, 0), (0, 0, 0.36), (-1.0, 1.0))
    estimate = infer_joints(known_object("bin", {"bin": bin_, "flap": flap}, joint))["flap"]
    assert estimate.kind.turns
    assert abs(float(estimate.axis[0])) > 0.999
