"""A typed request is filled exactly, built, and measured."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from kinematify.cli.app import run
from kinematify.errors import InputError
from kinematify.generate.delivery import closed, deliver, part_faults
from kinematify.generate.procedural.clearance import solid_of
from kinematify.generate.procedural.materials import COLORS
from kinematify.generate.registry import build
from kinematify.generate.request import request_of, schema_of, with_settings
from kinematify.robot.joint_type import JointType


def test_a_request_is_built_as_it_says():
    values = {
        "kind": "cabinet",
        "parameters": {"layout": "door / 2*drawer", "doors": 1, "drawers": 2},
        "size": {"width": "60 cm", "height": 1.1},
        "parts": {
            "door": {"count": 1, "row": 1, "material": "glass", "range": "0 to 80 deg", "open": "30 deg"},
            "drawer": {"count": 2, "row": 2, "motion": "slide"},
            "lower drawer": {"color": "red", "open": 0.5},
        },
    }
    made = deliver(request_of(values))
    assert made.differences == ()
    parts, joints = {part.name: part for part in made.blueprint.parts}, made.blueprint.joint_above
    np.testing.assert_allclose(np.ptp(closed(made.blueprint).parts[0].bounds, axis=0)[[0, 2]], (0.6, 1.1), rtol=0.02)
    assert parts["door_1"].appearance.materials[0].name == "glass"
    assert joints["door_1"].value == pytest.approx(math.radians(30))
    assert joints["door_1"].upper + joints["door_1"].value == pytest.approx(math.radians(80))
    assert [parts[name].color == COLORS["red"] for name in ("drawer_1", "drawer_2")] == [False, True]


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"drawer": "2"}, "Did you mean drawers"),
        ({"drawers": "500"}, "from 0 to 40"),
        ({"size.widht": "1 m"}, "'width'"),
        ({"door.color": "mauve"}, "turquoise"),
        ({"door.range": "wide"}, "-30 to 90 deg"),
        ({"door.range": "0 to 12 cm", "door.motion": "hinge"}, "is of what slides, not hinge"),
        ({"door.count": "many"}, "count"),
        ({"size.width": "-3"}, "greater than 0"),
    ],
)
def test_a_value_that_does_not_fit_is_refused_with_what_is_allowed(settings, reason):
    with pytest.raises(InputError) as caught:
        request_of(with_settings({"kind": "cabinet"}, settings))
    assert reason in str(caught.value)


def test_what_the_object_cannot_do_is_a_difference_each():
    values = {
        "kind": "pan_tilt_camera",
        "parts": {"fork": {"motion": "pan", "range": "-90 to 90 deg"}, "camera": {"motion": "pan"}},
    }
    listed = deliver(request_of(values)).differences
    assert listed == ("camera: pan was asked for, it is revolute",), "a level axis does not pan"
    far = deliver(request_of({"kind": "laptop", "parts": {"screen": {"range": "0 to 400 deg"}}}))
    assert "screen: range 0 to 400 deg was asked for" in far.differences[0]


def test_the_unit_of_a_range_says_how_a_part_moves():
    values = with_settings({"kind": "cabinet"}, {"drawer.range": "0 to 12 cm", "door.range": "0 to 60 deg"})
    made = deliver(request_of(values))
    assert made.differences == ()
    reach = {joint.child: joint.upper for joint in made.blueprint.joints}
    assert [reach["drawer_1"], reach["door_1"]] == pytest.approx([0.12, math.pi / 3])
    values = with_settings({"kind": "cabinet"}, {"door.range": "0 to 12 cm"})
    assert deliver(request_of(values)).differences == ("door: slide was asked for, it is revolute",)


def test_a_range_is_asked_of_every_part_of_that_name():
    request = request_of(with_settings({"kind": "cabinet"}, {"doors": 2, "door.range": "0 to 90 deg"}))
    made = deliver(request)
    assert made.differences == ()
    joints = made.blueprint.joints
    shorter = [replace(joint, upper=0.5) if joint.child == "door_2" else joint for joint in joints]
    blueprint = replace(made.blueprint, joints=tuple(shorter))
    names = ["door_1", "door_2"]
    (fault,) = part_faults(request.family, blueprint, "door", names, request.parts["door"])
    assert fault.startswith("range 0 to 90 deg was asked for")


def test_one_joint_does_not_serve_two_requests():
    (line,) = deliver(request_of({"kind": "laptop", "parts": {"screen": {}, "lid": {}}})).differences
    assert "it is the same as the screen" in line


def test_a_size_without_a_parameter_scales_the_whole_and_its_ways():
    usual, large = (deliver(request_of({"kind": "syringe", **more})) for more in ({}, {"size": {"length": 0.3}}))
    assert large.differences == ()
    factor = 0.3 / np.ptp(closed(usual.blueprint).assembly.bounds, axis=0).max()
    ways = [
        max(joint.upper for joint in made.blueprint.joints if joint.kind is JointType.PRISMATIC)
        for made in (usual, large)
    ]
    assert ways[1] == pytest.approx(factor * ways[0])


def test_a_mirror_keeps_the_object_and_swaps_its_sides():
    made = build("winch")
    flipped = made.scaled(1.0, mirrored=True)
    assert [solid_of(part).volume() for part in flipped.parts] == pytest.approx(
        [solid_of(part).volume() for part in made.parts]
    )
    there = flipped.moved({made.joints[0].child: 0.5}).parts[-1].vertices
    np.testing.assert_allclose(
        there * (-1, 1, 1), made.moved({made.joints[0].child: 0.5}).parts[-1].vertices, atol=1e-9
    )
    for side in ("left", "right"):
        assert deliver(request_of({"kind": "winch", "parts": {"crank": {"side": side}}})).differences == ()


def test_the_schema_says_what_a_kind_takes():
    stated = schema_of("cabinet")["properties"]["parameters"]["properties"]
    assert (stated["width"]["minimum"], stated["width"]["maximum"]) == (0.1, 5.0)
    assert "knob" in stated["handle"]["enum"]
    assert "parts" in schema_of(None)["properties"]


def test_a_file_and_settings_make_one_request_and_a_part_that_is_not_there_is_an_error(tmp_path, capsys):
    (tmp_path / "oven.yaml").write_text("kind: oven\nparameters: {knobs: 5}\nparts: {door: {open: 45 deg}}\n")
    command = ["generate", "--request", str(tmp_path / "oven.yaml"), "--no-validation", "--no-preview"]
    assert run([*command, "--set", "knob.color=red", "-o", str(tmp_path / "oven")]) == 0
    said = json.loads((tmp_path / "oven" / "source.json").read_text())
    assert said["parameters"]["knobs"] == 5
    assert said["request"]["parts"]["knob"] == {"color": "red"}
    capsys.readouterr()
    assert run([*command, "--set", "drawer.color=red", "-o", str(tmp_path / "none")]) == 2
    assert "drawer: a kitchen stove" in capsys.readouterr().err.lower() or not (tmp_path / "none").exists()
