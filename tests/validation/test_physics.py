"""Declared physics: every slip that engines refuse or misread is found at its link or joint, and good models pass."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from pathlib import Path

import gymnasium
import pytest
import trimesh
from lxml import etree

from kinematify import validate
from kinematify.config.validation import load_settings
from kinematify.validation.checks import CHECKS, checks_of
from kinematify.validation.finding import Cause, CheckResult, Finding, Severity, Status
from kinematify.validation.run.needs import Recorder, meshes
from kinematify.validation.stage import StageRequest
from kinematify.versions import NO_WHEELS
from tests.validation.engine_models import Box, Model, Part

SETTINGS = load_settings()


def cabinet() -> Model:
    """A body of boards with a door and a drawer that carries a knob; masses and inertias are those of the boxes."""
    boards = (
        Box(size=(0.6, 0.5, 0.02), at=(0, 0, 0.01)),
        Box(size=(0.6, 0.5, 0.02), at=(0, 0, 0.79)),
        Box(size=(0.02, 0.5, 0.76), at=(-0.29, 0, 0.4)),
        Box(size=(0.02, 0.5, 0.76), at=(0.29, 0, 0.4)),
        Box(size=(0.56, 0.02, 0.76), at=(0, 0.24, 0.4)),
    )
    return Model(
        parts=(
            Part(name="body", boxes=boards, mass=12.0, inertia=(1.0, 1.0, 0.9), center=(0, 0.02, 0.4)),
            Part(
                name="door",
                parent="body",
                kind="revolute",
                at=(-0.28, -0.26, 0.6),
                axis=(0, 0, 1),
                limits=(-1.8, 0.0),
                boxes=(Box(size=(0.54, 0.02, 0.36), at=(0.27, 0, 0)),),
                mass=3.0,
                inertia=(0.0325, 0.1053, 0.073),
                center=(0.27, 0, 0),
            ),
            Part(
                name="drawer",
                parent="body",
                kind="prismatic",
                at=(0, -0.1, 0.2),
                axis=(0, -1, 0),
                limits=(0.0, 0.3),
                boxes=(Box(size=(0.5, 0.3, 0.2)),),
                mass=4.0,
                inertia=(0.043, 0.1, 0.11),
            ),
            Part(
                name="knob",
                parent="drawer",
                boxes=(Box(size=(0.03, 0.06, 0.03)),),
                at=(0, -0.18, 0),
                mass=0.05,
                inertia=(1.9e-5, 7.5e-6, 1.9e-5),
            ),
        )
    )


@pytest.fixture
def good(tmp_path: Path) -> Path:
    return cabinet().write(tmp_path)


def checked(urdf: Path) -> dict[str, CheckResult]:
    """What the asset stage tells of declared physics."""
    results: list[CheckResult] = []
    request = StageRequest(
        urdf=urdf,
        package_dirs=(),
        work=urdf.parent,
        settings=SETTINGS,
        selected=frozenset(CHECKS),
        deadline=time.process_time() + 60.0,
    )
    meshes(request, Recorder(results.append, request))
    return {result.check: result for result in results if result.check.startswith("KV2")}


def edited(urdf: Path, path: str, **attributes: str | None) -> Path:
    """Change attributes of the first element at an XPath; None removes one."""
    tree = etree.parse(urdf)
    (element, *_) = tree.xpath(path)
    for name, value in attributes.items():
        if value is None:
            element.attrib.pop(name)
        else:
            element.set(name, value)
    tree.write(urdf)
    return urdf


def removed(urdf: Path, path: str) -> Path:
    tree = etree.parse(urdf)
    for element in tree.xpath(path):
        element.getparent().remove(element)
    tree.write(urdf)
    return urdf


def counted(urdf: Path) -> list[Finding]:
    """Warnings and errors."""
    found = [finding for result in checked(urdf).values() for finding in result.findings]
    return [finding for finding in found if finding.severity is not Severity.NOTE]


def only(urdf: Path, check: str) -> Finding:
    """The one finding that counts, which must be of this check."""
    (finding,) = counted(urdf)
    assert finding.check == check
    assert finding.message
    assert finding.remedy
    return finding


def test_every_check_is_reported_once_and_a_good_model_passes(good: Path) -> None:
    results = checked(good)
    assert set(results) == {check.id for check in checks_of("KV2")}
    assert not counted(good)
    skipped = {name for name, result in results.items() if result.status is not Status.PASS}
    assert skipped == {"KV225", "KV230"}, "nothing mimics here, and no chain is closed"
    assert results["KV225"].reason


def test_without_readable_meshes_nothing_is_said_of_physics(tmp_path: Path) -> None:
    urdf = tmp_path / "model.urdf"
    (tmp_path / "part.obj").write_text("not a mesh")
    urdf.write_text(
        '<robot name="r"><link name="a"><visual><geometry><mesh filename="part.obj"/></geometry></visual></link>'
        "</robot>"
    )
    assert Status.FAIL not in {result.status for result in checked(urdf).values()}


# ---- masses --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("mass", ["-1", "0", "2e8"])
def test_a_bad_mass_is_an_error_at_its_link(good: Path, mass: str) -> None:
    found = counted(edited(good, "//link[@name='door']/inertial/mass", value=mass))
    assert {finding.link for finding in found} == {"door"}
    assert {finding.cause for finding in found} == {Cause.PHYSICS}
    assert Severity.ERROR in {finding.severity for finding in found}


def test_no_mass_on_a_part_of_a_body_that_has_one_is_less_bad(good: Path) -> None:
    (finding,) = checked(edited(good, "//link[@name='knob']/inertial/mass", value="0"))["KV202"].findings
    assert (finding.link, finding.severity) == ("knob", Severity.NOTE)


def test_a_frame_that_is_fixed_to_a_mass_needs_none(good: Path) -> None:
    removed(good, "//link[@name='knob']/*")
    assert not counted(good)


def test_a_moving_body_without_mass_is_a_warning_and_all_of_them_are_one(good: Path) -> None:
    finding = only(removed(good, "//link[@name='door']/inertial"), "KV201")
    assert (finding.link, finding.severity) == ("door", Severity.WARNING)
    (finding,) = (item for item in counted(removed(good, "//inertial")) if item.check == "KV201")
    assert "None of the 2" in finding.message


# ---- inertias ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("check", "attributes"),
    [
        ("KV204", {"ixx": "-0.03"}),
        ("KV204", {"ixx": "0", "iyy": "0", "izz": "0"}),
        ("KV204", {"ixy": "0.2"}),
        ("KV205", {"izz": "1.5"}),
    ],
)
def test_an_inertia_that_no_body_has_is_an_error_where_it_moves(good: Path, check: str, attributes: dict) -> None:
    found = counted(edited(good, "//link[@name='door']/inertial/inertia", **attributes))
    assert (found[0].check, found[0].link, found[0].severity) == (check, "door", Severity.ERROR)
    assert found[0].cause is Cause.PHYSICS


def test_an_inertia_in_the_base_harms_less(good: Path) -> None:
    finding = only(edited(good, "//link[@name='body']/inertial/inertia", ixx="-1"), "KV204")
    assert (finding.link, finding.severity) == ("body", Severity.WARNING)


def test_the_remedy_for_an_inertia_is_right(good: Path) -> None:
    finding = counted(edited(good, "//link[@name='door']/inertial/inertia", ixx="-0.03"))[0]
    expected = 3.0 / 12.0 * (0.02**2 + 0.36**2)
    assert f'<inertia ixx="{expected:.3g}"' in finding.remedy


@pytest.mark.parametrize(
    ("check", "attributes"),
    [
        ("KV204", {"ixx": "0", "iyy": "0", "izz": "0"}),
        ("KV204", {"ixx": "-1e-9"}),
        ("KV205", {"izz": "1e-3"}),
    ],
)
def test_an_inertia_that_a_fixed_joint_makes_up_for_is_a_note(good: Path, check: str, attributes: dict) -> None:
    urdf = edited(good, "//link[@name='knob']/inertial/inertia", **attributes)
    assert not [finding for finding in counted(urdf) if finding.check == check]
    (note,) = checked(urdf)[check].findings
    assert (note.link, note.severity) == ("knob", Severity.NOTE)


def test_fixed_links_without_a_sound_inertia_between_them_stay_an_error(good: Path) -> None:
    edited(good, "//link[@name='knob']/inertial/inertia", ixx="0", iyy="0", izz="0")
    edited(good, "//link[@name='knob']/inertial/mass", value="1e-9")
    found = counted(edited(good, "//link[@name='drawer']/inertial/inertia", ixx="0", iyy="0", izz="0"))
    assert {(item.check, item.link, item.severity) for item in found} >= {("KV204", "drawer", Severity.ERROR)}


def test_no_claim_about_an_engine_stands_where_none_was_asked(good: Path) -> None:
    edited(good, "//link[@name='door']/inertial/inertia", ixx="0", iyy="0", izz="0")
    edited(good, "//link[@name='drawer']/inertial/inertia", izz="5")
    found = [item for item in counted(good) if item.check in ("KV204", "KV205")]
    assert len(found) == 2
    assert not [item.message for item in found if "MuJoCo" in item.message]


def test_collision_geometry_beside_a_small_fixed_link_makes_no_file_fail(good: Path) -> None:
    edited(good, "//link[@name='knob']/collision/origin", xyz="0 -0.04 0")
    (finding,) = checked(good)["KV241"].findings
    assert (finding.link, finding.severity) == ("knob", Severity.WARNING)
    edited(good, "//link[@name='drawer']/collision/origin", xyz="0 -0.2 0")
    assert Severity.ERROR in {item.severity for item in checked(good)["KV241"].findings if item.link == "drawer"}


def test_rounding_in_an_inertia_is_a_note(good: Path) -> None:
    urdf = edited(good, "//link[@name='door']/inertial/inertia", ixx="0.033", iyy="0.107", izz="0.0735")
    assert not counted(urdf)
    assert [finding.severity for finding in checked(urdf)["KV205"].findings] == [Severity.NOTE]


def test_an_inertia_in_another_unit_does_not_fit_the_geometry(good: Path) -> None:
    values = {"ixx": "33", "iyy": "110", "izz": "80"}
    finding = only(edited(good, "//link[@name='door']/inertial/inertia", **values), "KV207")
    assert finding.link == "door"
    assert finding.value == pytest.approx(math.sqrt(110.0 / 3.0))


def test_one_inertia_for_links_of_different_size_is_a_placeholder(good: Path) -> None:
    for link in ("body", "door", "knob"):
        edited(good, f"//link[@name='{link}']/inertial/mass", value="2")
        edited(good, f"//link[@name='{link}']/inertial/inertia", ixx="0.01", iyy="0.01", izz="0.01")
    (finding,) = checked(good)["KV210"].findings
    assert (finding.link, finding.cause) == ("body", Cause.PHYSICS)
    assert "3 links" in finding.message
    edited(good, "//link[@name='knob']/inertial/inertia", izz="0.011")
    assert checked(good)["KV210"].findings == (), "two alike are a pair"


@pytest.mark.parametrize(("x", "severity"), [("0.27", None), ("0.75", Severity.WARNING), ("2.7", Severity.ERROR)])
def test_a_centre_of_mass_outside_the_geometry_is_found(good: Path, x: str, severity: Severity | None) -> None:
    found = counted(edited(good, "//link[@name='door']/inertial/origin", xyz=f"{x} 0 0"))
    centres = [finding for finding in found if finding.check == "KV208"]
    assert [finding.severity for finding in centres] == ([] if severity is None else [severity])
    assert {finding.link for finding in found} <= {"door"}


def test_a_sensor_that_is_not_modelled_may_weigh_a_gram_in_one_point(good: Path) -> None:
    removed(good, "//link[@name='knob']/visual | //link[@name='knob']/collision")
    edited(good, "//link[@name='knob']/inertial/mass", value="0.001")
    edited(good, "//link[@name='knob']/inertial/inertia", ixx="1e-12", iyy="1e-12", izz="1e-12")
    assert not counted(edited(good, "//link[@name='knob']/inertial/origin", xyz="0 -0.5 0"))
    edited(good, "//link[@name='knob']/inertial/mass", value="2.0")
    assert only(good, "KV208").link == "knob"  # half of the drawer's mass is no sensor


# ---- joints --------------------------------------------------------------------------------------------------------


def test_degrees_for_radians_are_an_error_at_the_joint(good: Path) -> None:
    finding = only(edited(good, "//joint[@name='door_joint']/limit", lower="-90", upper="90"), "KV220")
    assert (finding.joint, finding.severity, finding.cause) == ("door_joint", Severity.ERROR, Cause.KINEMATICS)
    assert "1.5708" in finding.remedy


@pytest.mark.parametrize(
    ("degrees", "severity"), [(350.0, None), (360.0, None), (400.0, None), (2000.0, Severity.ERROR)]
)
def test_wrists_may_turn_by_round_numbers_of_degrees(good: Path, degrees: float, severity: Severity | None) -> None:
    ends = {"lower": repr(-math.radians(degrees)), "upper": repr(math.radians(degrees))}
    found = counted(edited(good, "//joint[@name='door_joint']/limit", **ends))
    assert [finding.severity for finding in found] == ([] if severity is None else [severity])


@pytest.mark.parametrize("end", ["10", "9.42478", "9.42"])
def test_ends_of_ten_radians_or_some_half_turns_stand_for_no_limit(good: Path, end: str) -> None:
    urdf = edited(good, "//joint[@name='door_joint']/limit", lower=f"-{end}", upper=end)
    assert counted(urdf) == []
    (note,) = next(result.findings for result in checked(urdf).values() if result.check == "KV220")
    assert "continuous" in note.remedy


@pytest.mark.parametrize(("half", "severity"), [(4.0, Severity.NOTE), (5.2, Severity.WARNING)])
def test_a_small_range_in_degrees_may_be_that_of_a_wrist(good: Path, half: float, severity: Severity) -> None:
    edited(good, "//joint[@name='door_joint']/limit", lower=repr(-half - 0.007), upper=repr(half + 0.007))
    assert [item.severity for item in checked(good)["KV220"].findings] == [severity]


@pytest.mark.parametrize(("upper", "severity"), [("0.9", None), ("4", Severity.WARNING), ("300", Severity.ERROR)])
def test_slides_longer_than_the_model_are_found(good: Path, upper: str, severity: Severity | None) -> None:
    found = counted(edited(good, "//joint[@name='drawer_joint']/limit", upper=upper))
    assert [(item.check, item.severity) for item in found] == ([] if severity is None else [("KV220", severity)])


def test_an_empty_range_is_found(good: Path) -> None:
    finding = only(edited(good, "//joint[@name='drawer_joint']/limit", upper="0"), "KV221")
    assert finding.joint == "drawer_joint"


def test_a_range_without_zero_is_noted(good: Path) -> None:
    edited(good, "//joint[@name='drawer_joint']/limit", lower="0.1", upper="0.3")
    assert [item.joint for item in checked(good)["KV222"].findings] == ["drawer_joint"]
    assert not counted(good), "it is a note"


@pytest.mark.parametrize("attribute", ["effort", "velocity"])
@pytest.mark.parametrize("value", [None, "0", "-1"])
def test_a_joint_without_a_drive_is_named(good: Path, attribute: str, value: str | None) -> None:
    finding = only(edited(good, "//joint[@name='drawer_joint']/limit", **{attribute: value}), "KV223")
    assert (finding.joint, finding.cause) == ("drawer_joint", Cause.PHYSICS)
    assert attribute in finding.message


def test_negative_damping_is_an_error(good: Path) -> None:
    tree = etree.parse(good)
    etree.SubElement(tree.xpath("//joint[@name='door_joint']")[0], "dynamics", damping="-1", friction="0")
    tree.write(good)
    finding = only(good, "KV224")
    assert (finding.joint, finding.severity) == ("door_joint", Severity.ERROR)


@pytest.mark.parametrize(("multiplier", "expected"), [("0.1", []), ("1", ["KV225"]), ("0", ["KV225"])])
def test_a_follower_stays_within_its_limits(good: Path, multiplier: str, expected: list[str]) -> None:
    tree = etree.parse(good)
    (joint,) = tree.xpath("//joint[@name='drawer_joint']")
    etree.SubElement(joint, "mimic", joint="door_joint", multiplier=multiplier, offset="0.2")
    tree.write(good)
    assert [finding.check for finding in counted(good)] == expected


def test_weight_is_compared_with_effort(tmp_path: Path) -> None:
    arm = Part(
        name="arm",
        parent="base",
        kind="revolute",
        axis=(0, 1, 0),
        limits=(-1.5, 1.5),
        boxes=(Box(size=(1.0, 0.1, 0.1), at=(0.5, 0, 0)),),
        center=(0.5, 0, 0),
        mass=2.0,
        inertia=(0.01, 0.2, 0.2),
        effort=9.0,
    )
    base = Part(name="base", boxes=(Box(size=(0.1, 0.1, 0.1)),), inertia=(0.01, 0.01, 0.01))
    finding = only(Model(parts=(base, arm)).write(tmp_path), "KV226")
    assert finding.joint == "arm_joint"
    assert finding.value == pytest.approx(9.0 / (2.0 * 9.81 * 0.5), rel=0.02)


# ---- collision geometry --------------------------------------------------------------------------------------------


def test_one_link_without_collision_is_named_and_all_are_one_finding(good: Path) -> None:
    finding = only(removed(good, "//link[@name='drawer']/collision"), "KV240")
    assert (finding.link, finding.cause) == ("drawer", Cause.PHYSICS)
    finding = only(removed(good, "//collision"), "KV240")
    assert "None of the 3 bodies" in finding.message


@pytest.mark.parametrize(("shift", "severity"), [(0.001, None), (0.03, Severity.WARNING), (0.3, Severity.ERROR)])
def test_collision_geometry_beside_the_visual_one_is_found(good: Path, shift: float, severity: Severity | None) -> None:
    found = counted(edited(good, "//link[@name='door']/collision/origin", xyz=f"{0.27 + shift} 0 0"))
    offset = [(item.check, item.link, item.severity) for item in found]
    assert offset == ([] if severity is None else [("KV241", "door", severity)])


def test_coarse_collision_geometry_is_fine(good: Path) -> None:
    removed(good, "//link[@name='body']/collision[position()>1]")
    edited(good, "//link[@name='body']/collision/geometry/box", size="0.66 0.56 0.86")
    edited(good, "//link[@name='body']/collision/origin", xyz="0 0 0.4")
    assert not counted(good)


def test_a_hollow_collision_mesh_of_what_does_not_move_is_told(tmp_path: Path) -> None:
    ring = trimesh.creation.annulus(0.4, 0.5, 0.2)
    ring.export(tmp_path / "ring.stl")
    shape = '<geometry><mesh filename="ring.stl"/></geometry>'
    urdf = tmp_path / "model.urdf"
    urdf.write_text(
        f'<robot name="r"><link name="ring"><visual>{shape}</visual><collision>{shape}</collision></link></robot>'
    )
    (finding,) = checked(urdf)["KV242"].findings
    assert (finding.link, finding.severity) == ("ring", Severity.WARNING)
    assert finding.value == pytest.approx(0.25 / (0.25 - 0.16), rel=0.02)
    urdf.write_text(urdf.read_text().replace("<collision>", '<collision concave="yes">'))
    assert checked(urdf)["KV242"].findings == ()


def test_links_without_mass_that_are_fixed_to_others_are_told_with_what_pybullet_makes_of_them(good: Path) -> None:
    tree = etree.parse(good)
    robot = tree.getroot()
    for name in ("grip", "tip", "lens", "lamp"):
        robot.append(etree.fromstring(f'<link name="{name}"/>'))
        robot.append(
            etree.fromstring(f'<joint name="f_{name}" type="fixed"><parent link="door"/><child link="{name}"/></joint>')
        )
    tree.write(good)
    finding = only(good, "KV201")
    assert "Links without an <inertial> that are fixed to links with one: 4." in finding.message
    assert (
        "has 3 kg and gets 4 kg more: grip (a frame), tip (a frame), lens (a frame), lamp (a frame)." in finding.message
    )
    pybullet = pytest.importorskip("pybullet", reason=NO_WHEELS)
    client = pybullet.connect(pybullet.DIRECT)
    body = pybullet.loadURDF(str(good), physicsClientId=client)
    masses = {
        pybullet.getJointInfo(body, index, client)[12].decode(): pybullet.getDynamicsInfo(body, index, client)[0]
        for index in range(pybullet.getNumJoints(body, client))
    }
    pybullet.disconnect(client)
    assert [masses[name] for name in ("door", "grip", "tip", "lens", "lamp")] == [3.0, 1.0, 1.0, 1.0, 1.0]


# ---- left and right ------------------------------------------------------------------------------------------------


def beetle(tmp_path: Path, **odd: object) -> Path:
    """A body with four legs to each side that mirror each other; the third leg of the right is changed."""
    parts = [Part(name="body", boxes=(Box(size=(1.0, 0.2, 0.1)),), mass=5.0, inertia=(0.05, 0.4, 0.4))]
    for number in range(1, 5):
        for side, sign in (("left", 1.0), ("right", -1.0)):
            leg = Part(
                name=f"{side}_leg_{number}",
                parent="body",
                kind="revolute",
                at=(0.2 * number - 0.5, 0.12 * sign, 0.0),
                axis=(1.0, 0.0, 0.0),
                limits=(-0.2, 0.8) if sign > 0 else (-0.8, 0.2),
                boxes=(Box(size=(0.05, 0.3, 0.05), at=(0.0, 0.15 * sign, 0.0)),),
                mass=0.5,
                inertia=(4e-3, 3e-4, 4e-3),
                center=(0.0, 0.15 * sign, 0.0),
            )
            parts.append(replace(leg, **odd) if leg.name == "right_leg_3" else leg)  # type: ignore[arg-type]
    return Model(parts=tuple(parts)).write(tmp_path)


def test_sides_that_mirror_each_other_are_fine(tmp_path: Path) -> None:
    assert not checked(beetle(tmp_path))["KV227"].findings


@pytest.mark.parametrize(
    ("odd", "says"),
    [
        ({"mass": 5.0}, "mass"),
        ({"inertia": (4e-3, 3e-4, 4e-2)}, "principal moments"),
        ({"axis": (-1.0, 0.0, 0.0)}, "range"),
        ({"axis": (0.0, 1.0, 0.0)}, "axis"),
        ({"limits": (-0.2, 0.8)}, "range"),
    ],
)
def test_one_side_that_differs_is_named(odd: dict[str, object], says: str, tmp_path: Path) -> None:
    found = [item for item in checked(beetle(tmp_path, **odd))["KV227"].findings if f"differ in {says}" in item.message]
    (finding,) = found
    assert finding.pair == ("left_leg_3", "right_leg_3")
    assert "the other 3 pairs" in finding.message


def test_sides_that_differ_everywhere_are_a_style(tmp_path: Path) -> None:
    urdf = beetle(tmp_path)
    tree = etree.parse(urdf)
    for joint in tree.xpath("//joint[starts-with(@name, 'right')]/limit"):
        joint.set("effort", "99")
    tree.write(urdf)
    assert not checked(urdf)["KV227"].findings


# ---- parts of one shape --------------------------------------------------------------------------------------------


def hand(tmp_path: Path, **odd: object) -> Path:
    """A palm with four fingers of one shape, each of two phalanges; some values of the last one are changed."""
    parts = [Part(name="palm", boxes=(Box(size=(0.1, 0.02, 0.1)),), mass=0.5, inertia=(4e-4, 8e-4, 4e-4))]
    for number in range(4):
        for name, parent, at in (
            ("proximal", "palm", (0.025 * number - 0.04, 0.0, 0.05)),
            ("distal", f"proximal_{number}", (0.0, 0.0, 0.04)),
        ):
            part = Part(
                name=f"{name}_{number}",
                parent=parent,
                kind="revolute",
                at=at,
                axis=(1.0, 0.0, 0.0),
                limits=(-0.1, 1.6),
                boxes=(Box(size=(0.02, 0.015, 0.04), at=(0.0, 0.0, 0.02)),),
                mass=0.02,
                inertia=(3e-6, 3e-6, 1e-6),
                center=(0.0, 0.0, 0.02),
            )
            parts.append(replace(part, **odd) if part.name == "distal_3" else part)  # type: ignore[arg-type]
    return Model(parts=tuple(parts)).write(tmp_path)


@pytest.mark.parametrize(
    ("odd", "says"),
    [
        ({}, None),
        ({"mass": 0.2}, "mass"),
        ({"axis": (0.0, 1.0, 0.0)}, "axis"),
        ({"axis": (-1.0, 0.0, 0.0)}, "range"),
        ({"limits": (-0.1, 3.2)}, "range"),
    ],
)
def test_one_of_several_parts_of_one_shape_that_differs_is_named(
    odd: dict[str, object], says: str | None, tmp_path: Path
) -> None:
    found = checked(hand(tmp_path, **odd))["KV227"].findings
    assert [(item.pair, f"differ in {says}" in item.message) for item in found] == [
        (("distal_0", "distal_3"), True)
    ] * (says is not None)


def test_round_shapes_do_not_say_how_a_joint_stands_to_them() -> None:
    ant = Path(gymnasium.__file__).parent / "envs/mujoco/assets/ant.xml"
    report = validate(ant, checks=["KV227"], engines=[])
    (result,) = (item for item in report.checks if item.check == "KV227")
    assert result.status is Status.PASS


# ---- one digit -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("attribute", "text"), [("ixx", "0.325"), ("iyy", "0.01053"), ("izz", "73")])
def test_one_digit_too_many_is_named_with_the_entry(attribute: str, text: str, good: Path) -> None:
    edited(good, "//link[@name='door']/inertial/inertia", **{attribute: text})
    finding = next(item for item in counted(good) if item.link == "door")
    assert f'Write {attribute}="' in finding.remedy
    right = {"ixx": 0.0325, "iyy": 0.1053, "izz": 0.073}[attribute]
    assert f'{attribute}="{right:.6g}"' in finding.remedy


def test_what_several_powers_of_ten_would_repair_is_not_guessed(good: Path) -> None:
    edited(good, "//link[@name='door']/inertial/inertia", ixy="0.9")
    finding = next(item for item in counted(good) if item.link == "door")
    assert "power" not in finding.remedy
