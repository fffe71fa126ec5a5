"""The pre-check of a URDF's text: every malformed file gets its own finding, with the joint or link and the line."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from kinematify.config.validation import load_settings
from kinematify.errors import DescriptionError
from kinematify.robot.read import read_robot
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import CheckResult, Finding, Severity, Status
from kinematify.validation.run.needs import Recorder, file
from kinematify.validation.stage import StageRequest

CLEAN = """\
<?xml version="1.0"?>
<robot name="box">
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry></visual>
  </link>
  <link name="lid">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="0 0 0.5"/><geometry><box size="1 1 0.1"/></geometry></visual>
    <collision><geometry><mesh filename="lid.obj" scale="1 1 1"/></geometry></collision>
  </link>
  <link name="knob">
    <visual><geometry><cylinder radius="0.1" length="0.1"/></geometry></visual>
  </link>
  <joint name="hinge" type="revolute">
    <origin xyz="0 0 0.5" rpy="0 0 0"/>
    <parent link="base"/>
    <child link="lid"/>
    <axis xyz="0 1 0"/>
    <limit lower="0" upper="1.5" effort="1" velocity="1"/>
  </joint>
  <joint name="turn" type="continuous">
    <parent link="lid"/>
    <child link="knob"/>
    <axis xyz="0 0 1"/>
    <mimic joint="hinge" multiplier="2"/>
  </joint>
</robot>
"""
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
SECOND_TREE = """\
  <link name="a"/><link name="b"/>
  <joint name="ab" type="fixed"><parent link="a"/><child link="b"/></joint>
"""
SETTINGS = load_settings()


def check_text(folder: Path, text: str | bytes, *, name: str = "model.urdf") -> tuple[bool, list[CheckResult]]:
    """Write a document with its mesh and run the pre-check."""
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    (folder / "lid.obj").write_text(TETRAHEDRON)
    return check_path(path)


def check_path(path: Path, package_dirs: tuple[Path, ...] = ()) -> tuple[bool, list[CheckResult]]:
    results: list[CheckResult] = []
    request = StageRequest(
        urdf=path,
        package_dirs=package_dirs,
        work=path.parent,
        settings=SETTINGS,
        selected=frozenset(CHECKS),
        deadline=time.process_time() + 60.0,
    )
    return file(request, Recorder(results.append, request)), results


def findings(results: list[CheckResult], *, notes: bool = False) -> list[Finding]:
    assert not [result.reason for result in results if result.status is Status.BLOCKED]
    return [f for result in results for f in result.findings if notes or f.severity is not Severity.NOTE]


def test_a_clean_file_passes_every_check_once(tmp_path: Path) -> None:
    usable, results = check_text(tmp_path, CLEAN)
    assert usable
    assert sorted(result.check for result in results) == [check for check in CHECKS if check < "KV15"]
    assert findings(results, notes=True) == []


FAULTS = {
    # what is replaced, by what, check, joint, link, line, and whether later stages may read it
    "isolated": ("</robot>", '<link name="alone"/></robot>', "KV126", None, "alone", 27, False),
    "second root": ('  <joint name="hinge"', SECOND_TREE + '  <joint name="hinge"', "KV125", None, "a", 14, False),
    "self-joined": ('<child link="knob"/>', '<child link="lid"/>', "KV122", "turn", "lid", 23, False),
    "cycle": (
        "</robot>",
        '<joint name="back" type="fixed"><parent link="knob"/><child link="lid"/></joint></robot>',
        "KV124", "back", None, 27, False,
    ),
    "second parent": (
        "</robot>",
        '<joint name="too" type="fixed"><parent link="base"/><child link="knob"/></joint></robot>',
        "KV123", "too", "knob", 27, False,
    ),
    "dangling parent": ('<parent link="lid"/>', '<parent link="lit"/>', "KV121", "turn", None, 22, False),
    "no child": ('<child link="knob"/>', "", "KV121", "turn", None, 21, False),
    "dangling mimic": ('<mimic joint="hinge"', '<mimic joint="hing"', "KV127", "turn", None, 25, False),
    "mimic of a fixed joint": ('type="revolute"', 'type="fixed"', "KV127", "turn", None, 25, False),
    "self mimic": ('<mimic joint="hinge"', '<mimic joint="turn"', "KV128", "turn", None, 25, False),
    "duplicate link": ("</robot>", '<link name="lid"/></robot>', "KV111", None, "lid", 27, False),
    "duplicate joint": ('name="turn"', 'name="hinge"', "KV111", "hinge", None, 21, False),
    "no link name": ('<link name="knob">', "<link>", "KV110", None, None, 11, False),
    "no robot name": ('<robot name="box">', "<robot>", "KV110", None, None, 2, True),
    "name with a slash": ('name="turn"', 'name="a/b"', "KV112", "a/b", None, 21, True),
    "unknown type": ('type="revolute"', 'type="hinge"', "KV130", "hinge", None, 14, False),
    "no type": (' type="revolute"', "", "KV130", "hinge", None, 14, False),
    "floating below geometry": ('type="continuous"', 'type="floating"', "KV131", "turn", None, 21, False),
    "NaN axis": ('<axis xyz="0 1 0"/>', '<axis xyz="0 nan 0"/>', "KV132", "hinge", None, 18, False),
    "infinite mass": ('<mass value="1"/>', '<mass value="1e999"/>', "KV132", None, "lid", 7, False),
    "two numbers": ('xyz="0 0 0.5" rpy', 'xyz="0 0.5" rpy', "KV132", "hinge", None, 15, False),
    "decimal comma": ('upper="1.5"', 'upper="1,5"', "KV132", "hinge", None, 19, False),
    "numbers of Python": ('upper="1.5"', 'upper="1_5"', "KV132", "hinge", None, 19, False),
    "empty effort": ('effort="1"', 'effort=""', "KV132", "hinge", None, 19, False),
    "NaN size": ('radius="0.1"', 'radius="NaN"', "KV132", None, "knob", 12, False),
    "huge origin": ('xyz="0 0 0.5" rpy', 'xyz="0 0 1e308" rpy', "KV133", "hinge", None, 15, False),
    "huge limit": ('upper="1.5"', 'upper="1e16"', "KV133", "hinge", None, 19, False),
    "degrees": ('rpy="0 0 0"', 'rpy="0 0 90"', "KV133", "hinge", None, 15, True),
    "zero axis": ('<axis xyz="0 1 0"/>', '<axis xyz="0 0 0"/>', "KV134", "hinge", None, 18, False),
    "long axis": ('<axis xyz="0 1 0"/>', '<axis xyz="0 2 0"/>', "KV135", "hinge", None, 18, True),
    "hinge without limit": (
        '<limit lower="0" upper="1.5" effort="1" velocity="1"/>',
        "",
        "KV136", "hinge", None, 14, True,
    ),
    "slide without limit": ('type="continuous"', 'type="prismatic"', "KV136", "turn", None, 21, False),
    "empty limit": ('lower="0" upper="1.5" ', "", "KV136", "hinge", None, 19, True),
    "swapped limits": ('lower="0" upper="1.5"', 'lower="1.5" upper="0"', "KV137", "hinge", None, 19, False),
    "negative box": ('size="1 1 0.1"', 'size="1 -1 0.1"', "KV138", None, "lid", 8, False),
    "zero radius": ('radius="0.1"', 'radius="0"', "KV138", None, "knob", 12, True),
    "zero scale": ('scale="1 1 1"', 'scale="0 1 1"', "KV139", None, "lid", 9, False),
    "no geometry": ('<geometry><box size="1 1 1"/></geometry>', "", "KV140", None, "base", 4, True),
    "two shapes": ('<box size="1 1 1"/>', '<box size="1 1 1"/><sphere radius="1"/>', "KV140", None, "base", 4, True),
    "unknown shape": ('<box size="1 1 1"/>', '<cone size="1 1 1"/>', "KV140", None, "base", 4, True),
    "no size": ('<box size="1 1 1"/>', "<box/>", "KV140", None, "base", 4, True),
    "no file name": ('filename="lid.obj" ', "", "KV140", None, "lid", 9, True),
    "missing mesh": ("lid.obj", "led.obj", "KV141", None, "lid", 9, True),
    "package": ("lid.obj", "package://far/top.obj", "KV141", None, "lid", 9, True),
    "windows drive": ("lid.obj", "C:\\models\\lid.obj", "KV141", None, "lid", 9, True),
    "no mesh format": ("lid.obj", "model.urdf", "KV142", None, "lid", 9, True),
    "entity bomb": (
        '<robot name="box">',
        '<!DOCTYPE robot [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]><robot name="box">',
        "KV102", None, None, 2, False,
    ),
    "truncated": ("</robot>\n", "", "KV101", None, None, 27, False),
    "unclosed tag": ('<parent link="base"/>', '<parent link="base">', "KV101", None, None, 20, False),
    "two axes": ('<axis xyz="0 1 0"/>', '<axis xyz="0 1 0"/><axis xyz="1 0 0"/>', "KV105", "hinge", None, 18, True),
    "joint in a link": (
        '<link name="knob">',
        '<link name="knob"><joint name="lost" type="fixed"/>',
        "KV105", None, "knob", 11, True,
    ),
    "tag in capitals": (
        '<limit lower="0" upper="1.5" effort="1" velocity="1"/>',
        '<Limit lower="0" upper="1.5"/>',
        "KV106", None, None, 19, True,
    ),
    "long line": ("</robot>", " " * 9000 + "</robot>", "KV104", None, None, 27, True),
    "long name": ('<robot name="box">', f'<robot name="{"b" * 1100}">', "KV104", None, None, 2, True),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found_where_it_is(fault: str, tmp_path: Path) -> None:
    old, new, check, joint, link, line, readable = FAULTS[fault]
    assert CLEAN.count(old) >= 1
    usable, results = check_text(tmp_path, CLEAN.replace(old, new, 1))
    matching = [f for f in findings(results) if f.check == check]
    assert matching, [f.message for f in findings(results)]
    found = matching[0]
    assert (found.joint, found.link, found.line) == (joint, link, line), found
    assert usable is readable
    assert len(found.message) > 20
    assert len(found.remedy) > 10


@pytest.mark.parametrize("fault", [name for name, row in FAULTS.items() if row[-1]])
def test_what_is_let_pass_can_be_read(fault: str, tmp_path: Path) -> None:
    old, new, *_ = FAULTS[fault]
    check_text(tmp_path, CLEAN.replace(old, new, 1))
    assert len(read_robot(tmp_path / "model.urdf").links) == 3


def test_all_problems_are_reported_at_once(tmp_path: Path) -> None:
    names = ("zero axis", "swapped limits", "dangling mimic", "zero radius", "missing mesh", "infinite mass")
    text = CLEAN
    for name in names:
        text = text.replace(*FAULTS[name][:2], 1)
    _, results = check_text(tmp_path, text)
    assert {f.check for f in findings(results)} == {FAULTS[name][2] for name in names}


def test_limits_of_a_hinge_without_an_end_are_only_a_note(tmp_path: Path) -> None:
    usable, results = check_text(tmp_path, CLEAN.replace('lower="0" upper="1.5"', 'lower="-1e16" upper="1e16"', 1))
    assert usable
    assert [(f.check, f.joint, f.line) for f in findings(results, notes=True)] == [("KV133", "hinge", 19)]


def test_a_floating_joint_above_everything_is_only_a_note(tmp_path: Path) -> None:
    free = '<link name="world"/><joint name="free" type="floating"><parent link="world"/><child link="base"/></joint>'
    usable, results = check_text(tmp_path, CLEAN.replace("</robot>", free + "</robot>"))
    assert usable
    assert [(f.check, f.joint) for f in findings(results, notes=True)] == [("KV131", "free")]


def test_names_and_order_of_joints_that_isaac_sim_changes_are_listed(tmp_path: Path) -> None:
    more = """<link name="leaf-1"/><link name="leaf.1"/><link name="2nd"/>
      <joint name="swing" type="continuous"><parent link="base"/><child link="leaf-1"/></joint>
      <joint name="pinned" type="fixed"><parent link="base"/><child link="leaf.1"/></joint>
      <joint name="held" type="fixed"><parent link="base"/><child link="2nd"/></joint></robot>"""
    _, results = check_text(tmp_path, CLEAN.replace("</robot>", more))
    names, order = next(result.findings for result in results if result.check == "KV113")
    assert names.severity is Severity.WARNING
    assert "3 names of links, such as 'leaf-1' to leaf_1; 1 then name others too" in names.message
    assert "hinge, swing, turn" in order.message, "breadth first; the file goes on with what hangs on the lid"


def test_a_circle_of_mimic_joints_names_all_of_them(tmp_path: Path) -> None:
    text = CLEAN.replace('velocity="1"/>', 'velocity="1"/><mimic joint="turn"/>', 1)
    usable, results = check_text(tmp_path, text)
    assert not usable
    (found,) = [f for f in findings(results) if f.severity is Severity.ERROR]
    assert found.check == "KV128"
    assert "hinge" in found.message
    assert "turn" in found.message


@pytest.mark.parametrize("links", [300, 20_000])
def test_chains_that_engines_cannot_bear_are_refused_quickly(links: int, tmp_path: Path) -> None:
    parts = [f'<link name="l{k}"/>' for k in range(links)]
    parts += [
        f'<joint name="j{k}" type="fixed"><parent link="l{k}"/><child link="l{k + 1}"/></joint>'
        for k in range(links - 1)
    ]
    usable, results = check_text(tmp_path, "<robot name='chain'>" + "\n".join(parts) + "</robot>")
    assert not usable
    assert {f.check for f in findings(results)} == {"KV103"}


def test_a_thousand_faults_of_a_kind_are_cut_short(tmp_path: Path) -> None:
    bad = "".join(f'<joint name="j{k}" type="odd"/>\n' for k in range(900))
    _, results = check_text(tmp_path, CLEAN.replace("</robot>", bad + "</robot>"))
    types = next(result for result in results if result.check == "KV130")
    assert len(types.findings) == 50
    assert types.measured["not_listed"] == 850


def test_the_remedy_for_a_package_names_it_and_the_option(tmp_path: Path) -> None:
    _, results = check_text(tmp_path, CLEAN.replace("lid.obj", "package://far/top.obj"))
    (found,) = findings(results)
    assert "far" in found.remedy
    assert "--package-dir" in found.remedy
    (tmp_path / "elsewhere" / "far").mkdir(parents=True)
    (tmp_path / "elsewhere" / "far" / "top.obj").write_text(TETRAHEDRON)
    assert check_path(tmp_path / "model.urdf", (tmp_path / "elsewhere",))[0]


FOREIGN = {
    "empty": (b"", "empty"),
    "binary": (bytes(range(256)) * 20, "binary"),
    "glb": (b"glTF\x02\x00\x00\x00", "GLB"),
    "picture": (b"\x89PNG\r\n\x1a\n", "picture"),
    "srdf": (b'<robot name="a"><disable_collisions link1="a" link2="b"/></robot>', "SRDF"),
    "web page": (b"<html><body/></html>", "web page"),
    "json": (b'{"links": []}', "no XML"),
    "other xml": (b"<svg/>", "<svg>"),
}


@pytest.mark.parametrize("kind", FOREIGN)
def test_what_is_no_urdf_is_refused_with_a_reason(kind: str, tmp_path: Path) -> None:
    content, words = FOREIGN[kind]
    with pytest.raises(DescriptionError, match=words):
        check_text(tmp_path, content)


def test_paths_that_lead_to_no_file_are_refused_with_a_hint(tmp_path: Path) -> None:
    check_text(tmp_path, CLEAN)
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    (tmp_path / "gone").symlink_to(tmp_path / "nowhere")
    os.mkfifo(tmp_path / "pipe")
    for name, words in (
        ("modle.urdf", "Did you mean .*model.urdf"),
        (".", "is a folder.*model.urdf"),
        ("loop", "symbolic links"),
        ("gone", "leads nowhere"),
        ("pipe", "neither a file nor a folder"),
    ):
        with pytest.raises(DescriptionError, match=words):
            check_path(tmp_path / name)


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may read every file")
def test_a_file_that_may_not_be_read_is_refused(tmp_path: Path) -> None:
    check_text(tmp_path, CLEAN)
    (tmp_path / "model.urdf").chmod(0)
    with pytest.raises(DescriptionError, match="who may read"):
        check_path(tmp_path / "model.urdf")


def test_the_other_encodings_of_xml_are_read(tmp_path: Path) -> None:
    text = CLEAN.replace('<?xml version="1.0"?>', '<?xml version="1.0" encoding="utf-16"?>')
    assert check_text(tmp_path, text.encode("utf-16"))[0]
