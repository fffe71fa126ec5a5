"""Blueprints as text: what they say is built exactly, and what they get wrong is reported by place."""

from __future__ import annotations

import copy
import json
import math

import numpy as np
import pytest
import trimesh
import yaml

from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.procedural import blueprint_file
from kinematify.generate.procedural.blueprint import ground_truth
from kinematify.generate.procedural.blueprint_file import described_blueprint, read_blueprint
from kinematify.generate.procedural.materials import MATERIALS
from kinematify.robot.joint_type import JointType

EXAMPLE = blueprint_file.__doc__.split("```yaml")[1].split("```")[0]


def toolbox(**changes):
    """The example of the documentation, with values put in at places such as ``parts.1.name``."""
    values = yaml.safe_load(EXAMPLE)
    for place, value in changes.items():
        *steps, last = (int(step) if step.isdigit() else step for step in place.split("."))
        inner = values
        for step in steps:
            inner = inner[step]
        inner[last] = value
    return values


def one_shape(shape, **more):
    base = {"name": "base", "shapes": [{"kind": "sphere", "radius": 0.1, "xyz": [0, 0, -5]}]}
    part = {"name": "part", "shapes": [shape], **more}
    joint = {"type": "continuous", "parent": "base", "child": "part"}
    return described_blueprint({"name": "one", "parts": [base, part], "joints": [joint]}).parts[1]


def test_the_example_is_built_as_it_says():
    built = described_blueprint(yaml.safe_load(EXAMPLE))
    body, lid = built.parts
    (joint,) = built.joints
    assert (body.name, lid.name, body.density) == ("body", "lid", MATERIALS["steel"].density)
    np.testing.assert_allclose(body.bounds, [[-0.2, -0.1, 0.0], [0.2, 0.1, 0.15]], atol=1e-12)
    assert joint.kind is JointType.REVOLUTE
    assert (joint.parent, joint.child, joint.lower, joint.upper) == ("body", "lid", 0.0, 1.9)
    raised = built.moved({"lid": math.pi / 2}).parts[1]
    assert raised.bounds[1, 2] > 0.34, "positive motion opens"


@pytest.mark.parametrize(
    ("shape", "size", "volume"),
    [
        ({"kind": "box", "size": [1, 2, 3]}, (1, 2, 3), 6.0),
        ({"kind": "rounded_box", "size": [1, 2, 3], "radius": 0.1}, (1, 2, 3), None),
        ({"kind": "cylinder", "radius": 1, "length": 3, "sides": 256}, (2, 2, 3), 3 * math.pi),
        ({"kind": "cylinder", "radius": 1, "length": 3, "axis": "x", "sides": 256}, (3, 2, 2), 3 * math.pi),
        ({"kind": "cylinder", "radius": 1, "length": 3, "axis": "y", "sides": 256}, (2, 3, 2), 3 * math.pi),
        ({"kind": "capsule", "radius": 1, "length": 3}, (2, 2, 5), None),
        ({"kind": "rod", "radius": 1, "ends": [[-1, 0, 0], [2, 0, 0]]}, (5, 2, 2), None),
        ({"kind": "box", "size": [1, 1, 1], "xyz": [2, 3, 0], "mirrored": ["x", "y"]}, (5, 7, 1), 4.0),
        ({"kind": "sphere", "radius": 1}, (2, 2, 2), None),
        ({"kind": "cone", "radius": 1, "length": 3, "sides": 256}, (2, 2, 3), math.pi),
        ({"kind": "tube", "radius": 1, "inner_radius": 0.5, "length": 2, "sides": 256}, (2, 2, 2), 1.5 * math.pi),
        ({"kind": "torus", "radius": 1, "wire_radius": 0.25}, (2.5, 2.5, 0.5), None),
        ({"kind": "prism", "outline": [[0, 0], [0, 2], [2, 0]], "length": 3}, (2, 2, 3), 6.0),
        ({"kind": "prism", "outline": [[0, 0], [2, 0], [0, 2]], "length": 3}, (2, 2, 3), 6.0),
        ({"kind": "lathe", "outline": [[0, 0], [1, 0], [0, 3]], "sides": 256}, (2, 2, 3), math.pi),
    ],
    ids=str,
)
def test_a_primitive_has_its_size_and_volume(shape, size, volume):
    part = one_shape(shape)
    mesh = trimesh.Trimesh(part.vertices, part.faces)
    assert mesh.is_volume
    np.testing.assert_allclose(np.ptp(part.bounds, axis=0), size, rtol=5e-3)
    assert mesh.volume <= np.prod(size) + 1e-9
    if volume is not None:
        assert mesh.volume == pytest.approx(volume, rel=1e-3)


def test_a_primitive_is_turned_as_in_urdf_and_then_moved():
    part = one_shape({"kind": "box", "size": [1, 2, 3], "rpy": [math.pi / 2, 0, math.pi / 2], "xyz": [10, 20, 30]})
    np.testing.assert_allclose(np.ptp(part.bounds, axis=0), [3, 1, 2], atol=1e-9)
    np.testing.assert_allclose(part.bounds.mean(axis=0), [10, 20, 30], atol=1e-9)


def test_a_joint_with_a_value_is_shown_there_and_others_follow():
    values = toolbox()
    follower = {"name": "flap", "shapes": [{"kind": "box", "size": [0.1, 0.1, 0.01], "xyz": [0, 0, 0.5]}]}
    values["parts"].append(follower)
    values["joints"][0]["value"] = 0.5
    values["joints"].append(
        {"type": "prismatic", "parent": "lid", "child": "flap", "axis": [0, 0, 1], "lower": -1, "upper": 0,
         "mimic": {"leader": "lid", "multiplier": -0.2}}
    )  # fmt: skip
    built = described_blueprint(values)
    lid, flap = built.joints
    assert (lid.lower, lid.upper, lid.value) == (-0.5, pytest.approx(1.4), 0.5)
    assert (flap.lower, flap.upper, flap.value) == (pytest.approx(-0.9), pytest.approx(0.1), pytest.approx(-0.1))
    assert ground_truth(built).joints[1].mimic.joint == "lid_joint"
    model = true_model(built, load_config())
    assert model.robot.joint_by_name["flap_joint"].mimic.multiplier == -0.2


def test_a_loop_is_a_point_that_both_parts_keep():
    bar = {"shapes": [{"kind": "box", "size": [0.01, 0.01, 0.2], "xyz": [0, 0, 0.1]}]}
    values = {
        "name": "four_bar",
        "parts": [
            {"name": "base", "shapes": [{"kind": "box", "size": [0.3, 0.02, 0.01]}]},
            {"name": "left", **bar},
            {"name": "right", "shapes": [{**bar["shapes"][0], "xyz": [0.1, 0, 0.1]}]},
            {"name": "top", "shapes": [{"kind": "box", "size": [0.1, 0.01, 0.01], "xyz": [0.05, 0, 0.2]}]},
        ],
        "joints": [
            {"type": "revolute", "parent": "base", "child": "left", "axis": [0, 1, 0], "lower": 0, "upper": 1},
            {
                "type": "revolute", "parent": "base", "child": "right", "axis": [0, 1, 0], "pivot": [0.1, 0, 0],
                "lower": 0, "upper": 1, "mimic": {"leader": "left"},
            },
            {
                "type": "revolute", "parent": "left", "child": "top", "axis": [0, 1, 0], "pivot": [0, 0, 0.2],
                "lower": -1, "upper": 0, "mimic": {"leader": "left", "multiplier": -1},
            },
        ],
        "loops": [{"parts": ["right", "top"], "pivot": [0.1, 0, 0.2]}],
    }  # fmt: skip
    built = described_blueprint(values)
    (loop,) = built.moved({"left": 0.5}).loops
    np.testing.assert_allclose(loop.pivot, [0.1 + 0.2 * math.sin(0.5), 0.0, 0.2 * math.cos(0.5)], atol=1e-12)
    model = true_model(built, load_config())
    assert [item.links for item in model.loops] == [("right", "top")]
    for parts, message in ((["right", "roof"], "no part 'roof'"), (["top", "top"], "joins top to itself")):
        with pytest.raises(InputError, match=message):
            described_blueprint({**values, "loops": [{"parts": parts, "pivot": [0, 0, 0]}]})


def test_parts_and_joints_may_stand_in_any_order():
    values = toolbox()
    values["parts"].reverse()
    assert described_blueprint(values).root == "body"


def test_shapes_and_joints_may_list_their_first_fields():
    values = yaml.safe_load(EXAMPLE)
    box = {"box": [0.4, 0.2, 0.15], "xyz": [0, 0, 0.075]}
    values["parts"][0]["shapes"] = [box]
    values["joints"] = [{"revolute": ["body", "lid", 0, 1.9], "axis": "-x", "pivot": [0, 0.1, 0.151]}]
    one, other = described_blueprint(yaml.safe_load(EXAMPLE)), described_blueprint(values)
    np.testing.assert_array_equal(one.parts[0].vertices, other.parts[0].vertices)
    assert one.joints[0].axis.tolist() == other.joints[0].axis.tolist() == [-1, 0, 0]
    assert (one.joints[0].upper, one.joints[0].kind) == (other.joints[0].upper, other.joints[0].kind)
    ball = one_shape({"sphere": 0.2}).vertices
    np.testing.assert_array_equal(ball, one_shape({"kind": "sphere", "radius": 0.2}).vertices)
    with pytest.raises(InputError, match=r"parts.1.shapes.0: .*cylinder takes a list of radius, length, but it is 0.1"):
        one_shape({"cylinder": 0.1})


def test_yaml_and_json_say_the_same(tmp_path):
    (tmp_path / "a.yaml").write_text(EXAMPLE)
    (tmp_path / "a.json").write_text(json.dumps(yaml.safe_load(EXAMPLE)))
    one, two = (read_blueprint(tmp_path / name) for name in ("a.yaml", "a.json"))
    for left, right in zip(one.parts, two.parts, strict=True):
        np.testing.assert_array_equal(left.vertices, right.vertices)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"parts.1.shapes.0.size": [0.4, -0.2, 0.01]}, r"parts\.1\.shapes\.0\.box\.size\.1: .*greater than 0"),
        ({"parts.1.shapes.0.size": [0.4, math.nan, 0.01]}, "finite"),
        ({"parts.1.shapes.0.size": [0.4, 2000.0, 0.01]}, "less than or equal to 1000"),
        ({"parts.1.shapes.0.bevel": 1}, r"bevel: Extra inputs are not permitted"),
        ({"parts.1.shapes.0.kind": "blob"}, "blob"),
        ({"parts.1.shapes": []}, "at least 1"),
        ({"parts.1.name": "Body"}, "several parts are named body"),
        ({"parts.1.name": "a lid"}, "'a lid' is no name"),
        ({"parts.1.material": "stell"}, "no material 'stell'; did you mean steel"),
        ({"parts.1.color": "rde"}, "no color 'rde'; did you mean red"),
        ({"parts.1.color": [255, 0, 0]}, "from 0 to 1"),
        ({"parts.0.subtract": [{"kind": "box", "size": [9, 9, 9]}]}, "Nothing is left of the part body"),
        ({"joints": []}, "no joint carries body and lid"),
        ({"joints.0.child": "ild"}, "no part 'ild'; did you mean lid"),
        ({"joints.0.child": "body"}, "round in a circle: body on body"),
        ({"joints.0.axis": [0, 0, 0]}, "the axis has no length"),
        ({"joints.0.upper": None}, "needs lower and upper"),
        ({"joints.0.upper": -1.0}, "lower 0 is not less than upper -1"),
        ({"joints.0.value": 2.0}, "the value 2 is not from 0 to 1.9"),
        ({"joints.0.type": "continuous"}, "a continuous joint has no limits"),
        ({"joints.0.type": "ball"}, "'revolute', 'continuous', 'prismatic' or 'fixed'"),
        ({"joints.0.mimic": {"leader": "lid"}}, "no joint that moves by itself"),
        ({"comment": "x"}, "comment: Extra inputs are not permitted"),
    ],
    ids=str,
)
def test_what_does_not_fit_is_named(changes, message):
    with pytest.raises(InputError, match=message):
        described_blueprint(toolbox(**changes))


def test_circles_second_parents_and_too_many_parts_are_refused():
    values = toolbox()
    values["joints"].append({**values["joints"][0], "parent": "lid", "child": "body"})
    with pytest.raises(InputError, match="round in a circle"):
        described_blueprint(values)
    values = toolbox()
    values["joints"].append(values["joints"][0])
    with pytest.raises(InputError, match="several joints carry lid"):
        described_blueprint(values)
    values = toolbox()
    values["parts"] = [{**copy.deepcopy(values["parts"][0]), "name": f"p{k}"} for k in range(500)]
    with pytest.raises(InputError, match="at most 200"):
        described_blueprint(values)


@pytest.mark.parametrize("values", [None, [], "text", 3, {}, {"name": "x"}, {"parts": {}, "joints": {}}], ids=str)
def test_what_is_no_description_at_all_is_refused(values):
    with pytest.raises(InputError, match="cannot be built"):
        described_blueprint(values)


@pytest.mark.parametrize("text", ["{", "a: [", "\0", "a: &a [*a]", "!!python/object:os.system {}", "[" * 100_000])
@pytest.mark.parametrize("name", ["bad.yaml", "bad.json"])
def test_files_that_are_no_blueprints_are_refused(tmp_path, text, name):
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError):
        read_blueprint(tmp_path / name)


def test_a_missing_file_is_refused_by_name(tmp_path):
    with pytest.raises(InputError, match=r"none\.yaml"):
        read_blueprint(tmp_path / "none.yaml")
