"""`kinematify fix`: only what `validate` finds is changed, and the result works where it is written."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import mujoco
import pytest
import trimesh
from lxml import etree
from trimesh.creation import box

from kinematify.cli.app import run
from kinematify.errors import OutputError
from kinematify.refinement.joint_edits import JointEdits
from kinematify.refinement.repair import Fix, fix
from kinematify.refinement.urdf_editor import UrdfEditor
from kinematify.robot.mesh_paths import GLTF_SUFFIXES
from kinematify.robot.read import read_robot
from kinematify.simulation.engine import Unloadable
from kinematify.simulation.engines import DEFAULT_ENGINES, open_engine
from kinematify.simulation.world import OpenedFile
from kinematify.validation.finding import Cause, CheckResult, Finding, JointSummary, Severity, Status
from kinematify.validation.run.report import ValidationReport
from kinematify.versions import NO_WHEELS

pybullet = pytest.importorskip("pybullet", reason=NO_WHEELS)

WALLS = {  # a case that is open in front: extents and middle of each board
    "bottom": ((0.4, 0.5, 0.02), (0.0, 0.0, 0.01)),
    "top": ((0.4, 0.5, 0.02), (0.0, 0.0, 0.29)),
    "left": ((0.02, 0.5, 0.26), (-0.19, 0.0, 0.15)),
    "right": ((0.02, 0.5, 0.26), (0.19, 0.0, 0.15)),
    "back": ((0.36, 0.02, 0.26), (0.0, 0.24, 0.15)),
}
INERTIAL = (
    '<inertial><origin xyz="{0}"/><mass value="2"/>'
    '<inertia ixx="0.04" iyy="0.03" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>'
)
LIMIT = '<limit lower="-0.2" upper="0" effort="50" velocity="1"/>'


def refusals(urdf: Path, engines: Sequence[str]) -> dict[str, str]:
    """What engines say that do not open a file as it is."""
    found = {}
    for engine in engines:
        try:
            open_engine(engine, OpenedFile(urdf=urdf, root=""))
        except Unloadable as error:
            if not error.floats:
                found[engine] = str(error)
    return found


def board(extents: tuple[float, ...], middle: tuple[float, ...]) -> trimesh.Trimesh:
    mesh = box(extents)
    mesh.apply_translation(middle)
    return mesh


def shaped(geometry: str, origin: str = "0 0 0") -> str:
    return "".join(
        f'<{kind}><origin xyz="{origin}"/><geometry>{geometry}</geometry></{kind}>' for kind in ("visual", "collision")
    )


def cabinet(folder: Path, prefix: str, *, head: str = "", limits: str = LIMIT) -> Path:
    """A drawer in a case whose hull fills it, and a knob that nothing is wrong with; meshes in ``../meshes``."""
    (folder / "meshes").mkdir(parents=True)
    (folder / "urdf").mkdir()
    case = trimesh.util.concatenate([board(*sizes) for sizes in WALLS.values()])
    case.export(folder / "meshes" / "case.stl")
    board((0.34, 0.44, 0.2), (0.0, -0.02, 0.15)).export(folder / "meshes" / "drawer.stl")
    path = folder / "urdf" / "model.urdf"
    case_shape, drawer_shape = (
        shaped(f'<mesh filename="{prefix}"/>').replace("NAME", name) for name in ("case", "drawer")
    )
    knob_shape = shaped('<box size="0.2 0.2 0.04"/>', "0 0 0.021")
    path.write_text(
        f'<!-- made by hand -->\n<robot name="cabinet">{head}\n'
        f'  <link name="case">{INERTIAL.format("0 0.03 0.15")}{case_shape}</link>\n'
        f'  <link name="drawer"><!-- slides -->{INERTIAL.format("0 -0.02 0.15")}{drawer_shape}</link>\n'
        f'  <link name="knob">{INERTIAL.format("0 0 0.02")}{knob_shape}</link>\n'
        '  <joint name="slide" type="prismatic"><parent link="case"/><child link="drawer"/><axis xyz="0 1 0"/>'
        f"{limits}</joint>\n"
        '  <joint name="turn" type="revolute"><origin xyz="0 0 0.3"/><parent link="case"/><child link="knob"/>'
        '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="5" velocity="1"/></joint>\n</robot>\n',
        encoding="utf-8",
    )
    return path


def fixed(model: Path, out: Path, **options: bool) -> Fix:
    return fix(model, out, overwrite=True, workers=2, **options)


@pytest.fixture(scope="module")
def jammed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Fix]:
    """A file of which MuJoCo keeps visual meshes and looks for them in a folder, fixed into another folder."""
    folder = tmp_path_factory.mktemp("jammed")
    head = '<mujoco><compiler meshdir="../meshes/" discardvisual="false"/></mujoco>'
    model = cabinet(folder / "given", "../meshes/NAME.stl", head=head)
    return model, fixed(model, folder / "elsewhere" / "deep" / "fixed.urdf")


def texts(path: Path, *, without: tuple[str, ...] = ()) -> dict[str, str]:
    """XML of every link and joint, with files by their names alone."""
    found = {}
    for element in etree.parse(str(path)).getroot().iter("link", "joint"):
        for tag in without:
            for child in element.findall(tag):
                element.remove(child)
        for mesh in element.iter("mesh"):
            mesh.set("filename", Path(mesh.get("filename")).name)
        if element.get("name"):
            found[element.get("name")] = "".join(etree.tostring(element, encoding="unicode").split())
    return found


def test_only_links_with_a_finding_change(jammed: tuple[Path, Fix]) -> None:
    model, done = jammed
    before, after = texts(model), texts(done.path)
    assert {name for name in before if before[name] != after[name]} <= {"case", "drawer"} & done.named
    assert before["case"] != after["case"]
    bare = ("collision",)
    assert texts(model, without=bare) == texts(done.path, without=bare)  # no friction, damping or mass
    assert "<!-- made by hand -->" in done.path.read_text("utf-8")
    assert "<!-- slides -->" in done.path.read_text("utf-8")


@pytest.mark.parametrize("shape", ['<mesh filename="../meshes/block.stl"/>', '<box size="0.4 0.5 0.3"/>'])
def test_what_would_lose_more_than_a_share_or_is_a_primitive_keeps_its_collision(tmp_path: Path, shape: str) -> None:
    model = cabinet(tmp_path, "../meshes/NAME.stl")
    box((0.4, 0.5, 0.3)).export(tmp_path / "meshes" / "block.stl")  # the drawer is inside
    solid = f'<collision><origin xyz="0 0 0.15"/><geometry>{shape}</geometry></collision></link>'
    case, _, rest = model.read_text().partition("</collision></link>")
    model.write_text(case[: case.index("<collision>")] + solid + rest)
    done = fixed(model, tmp_path / "urdf" / "fixed.urdf")
    assert [text for text in done.left if text.startswith("case: its collision geometry is left as it is")]
    assert not done.written or texts(done.path)["case"] == texts(model)["case"]


def test_a_file_with_meshdir_opens_from_its_new_folder(jammed: tuple[Path, Fix]) -> None:
    model, done = jammed
    assert refusals(model, DEFAULT_ENGINES) == {}
    loaded = mujoco.MjModel.from_xml_path(str(done.path))
    assert {"case", "drawer"} <= {loaded.mesh(k).name for k in range(loaded.nmesh)}
    data = mujoco.MjData(loaded)
    mujoco.mj_forward(loaded, data)
    assert not (data.contact.dist[: data.ncon] < -1e-3).any()
    assert done.exit_status == 0
    assert done.removed == ()
    assert done.before.report.as_loaded.startswith("as loaded: MuJoCo 1 of 2")
    assert done.after.report.as_loaded.startswith("as loaded: MuJoCo 2 of 2")


def test_an_engine_that_opened_the_source_must_open_the_result(jammed: tuple[Path, Fix]) -> None:
    _, done = jammed
    lost = replace(done, after=replace(done.after, refusals={"mujoco": "no such file"}))
    assert lost.removed == ("mujoco",)
    assert lost.exit_status == 1
    assert done.regressions == {}
    swapped = replace(done, before=done.after, after=done.before)
    assert swapped.regressions == {"mujoco": (2, 1)}
    assert swapped.kept == {"mujoco": ("slide",)}
    assert swapped.exit_status == 1


@pytest.fixture(scope="module")
def packaged(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Fix]:
    """Packages, and two <limit> in a joint, fixed into another folder."""
    folder = tmp_path_factory.mktemp("packaged")
    two = f'{LIMIT}<limit effort="7" velocity="7"/>'
    model = cabinet(folder / "other_name", "package://furniture/meshes/NAME.stl", limits=two)
    (folder / "other_name" / "package.xml").write_text("<package><name>furniture</name></package>", encoding="utf-8")
    return model, fixed(model, folder / "out" / "fixed.urdf")


def test_packages_are_paths_that_hold_without_a_variable(packaged: tuple[Path, Fix]) -> None:
    model, done = packaged
    assert "mujoco" in refusals(model, DEFAULT_ENGINES)
    assert refusals(done.path, DEFAULT_ENGINES) == {}
    meshes = [mesh.get("filename") for mesh in etree.parse(str(done.path)).getroot().iter("mesh")]
    assert "../other_name/meshes/drawer.stl" in meshes
    assert all((done.path.parent / name).is_file() for name in meshes)
    client = pybullet.connect(pybullet.DIRECT)
    body = pybullet.loadURDF(str(done.path), physicsClientId=client)
    shown = {Path(shape[4].decode()).name for shape in pybullet.getVisualShapeData(body, physicsClientId=client)}
    pybullet.disconnect(client)
    assert {"case.stl", "drawer.stl"} <= shown


def test_of_two_limits_the_one_that_engines_read_stays(packaged: tuple[Path, Fix]) -> None:
    _, done = packaged
    (limit,) = next(joint for joint in etree.parse(str(done.path)).getroot().iter("joint")).findall("limit")
    assert dict(limit.attrib) == {"lower": "-0.2", "upper": "0", "effort": "50", "velocity": "1"}
    (sentence,) = (sentence for sentence in done.changes if sentence.startswith("slide: "))
    assert 'dropped <limit effort="7" velocity="7"/>' in sentence


def test_meshes_in_gltf_become_obj_with_their_colours(tmp_path: Path) -> None:
    lid = box((0.2, 0.2, 0.02))
    lid.visual.face_colors = (255, 0, 0, 255)
    lid.export(tmp_path / "lid.glb")
    shape = '<geometry><mesh filename="lid.glb" scale="2 1 1"/></geometry>'
    model = tmp_path / "model.urdf"
    model.write_text(
        f'<robot name="box"><link name="case">{INERTIAL.format("0 0 0")}</link>'
        f'<link name="lid">{INERTIAL.format("0 0 0")}<visual>{shape}</visual></link>'
        '<joint name="hinge" type="revolute"><parent link="case"/><child link="lid"/><axis xyz="0 0 1"/>'
        '<limit lower="0" upper="1" effort="50" velocity="1"/></joint></robot>',
        encoding="utf-8",
    )
    refused = refusals(model, ("pybullet",))
    assert ".glb" in refused["pybullet"]
    editor = UrdfEditor(model, tmp_path / "out" / "fixed.urdf")
    assert editor.export_obj({"visual": GLTF_SUFFIXES, "collision": GLTF_SUFFIXES}) == []
    out = editor.write()
    assert refusals(out, DEFAULT_ENGINES) == {}
    (visual,) = read_robot(out, geometry="shown", appearance=True).link_by_name["lid"].visuals
    assert visual.mesh.vertices.max(axis=0) == pytest.approx((0.2, 0.1, 0.01))
    assert "1 mesh as OBJ" in editor.changes[0]
    assert (tmp_path / "out" / "fixed_meshes" / "0_lid.mtl").is_file()


def test_collision_meshes_in_collada_become_obj_and_a_digit_too_many_goes(tmp_path: Path) -> None:
    box((0.4, 0.4, 0.02)).export(tmp_path / "lid.dae")
    shape = shaped('<mesh filename="lid.dae"/>')
    wrong = INERTIAL.format("0 0 0").replace('ixx="0.04" iyy="0.03" izz="0.05"', 'ixx="0.027" iyy="0.27" izz="0.053"')
    model = tmp_path / "model.urdf"
    model.write_text(
        f'<robot name="box"><link name="case">{INERTIAL.format("0 0 0")}</link>'
        f'<link name="lid">{wrong}{shape}</link>'
        '<joint name="hinge" type="revolute"><parent link="case"/><child link="lid"/><axis xyz="0 0 1"/>'
        '<limit lower="0" upper="1" effort="50" velocity="1"/></joint></robot>',
        encoding="utf-8",
    )
    assert "mujoco" in refusals(model, ("mujoco",))
    done = fixed(model, tmp_path / "out.urdf")
    assert refusals(done.path, DEFAULT_ENGINES) == {}
    lid = read_robot(done.path).link_by_name["lid"]
    assert [shape.file.suffix for shape in lid.collisions if shape.file] == [".obj"]
    assert lid.inertial is not None
    assert lid.inertial.tensor.diagonal() == pytest.approx((0.027, 0.027, 0.053))


def hinged(folder: Path, limit: str, *stops: float) -> Path:
    """A bar of 0.4 m that turns on a plate, and blocks that end its way, with their middles so far beside it [m]."""
    path = folder / "bar.urdf"
    blocks = "".join(shaped('<box size="0.1 0.1 0.1"/>', f"0.3 {stop} 0.071") for stop in stops)
    plate = shaped('<box size="1 1 0.02"/>') + blocks
    bar = shaped('<box size="0.4 0.04 0.04"/>', "0.2 0 0.021")
    path.write_text(
        f'<robot name="bar"><link name="plate">{INERTIAL.format("0 0 0")}{plate}</link>'
        f'<link name="bar">{INERTIAL.format("0.2 0 0.02")}{bar}</link>'
        '<joint name="hinge" type="revolute"><origin xyz="0 0 0.02"/><parent link="plate"/><child link="bar"/>'
        f'<axis xyz="0 0 1"/>{limit}</joint></robot>',
        encoding="utf-8",
    )
    return path


def test_swapped_limits_and_one_beyond_a_contact_are_changed_with_a_diff(tmp_path: Path) -> None:
    model = hinged(tmp_path, '<limit lower="1.5" upper="-1.5" effort="5" velocity="1"/>', 0.25)
    done = fixed(model, tmp_path / "out.urdf", kinematics=True)
    swapped, shortened = done.diffs
    assert "swapped" in swapped.title
    before, after = swapped.lines.splitlines()[-2:]
    assert before.startswith("-")
    assert '<limit lower="1.5" upper="-1.5"' in before
    assert after.startswith("+")
    assert '<limit lower="-1.5" upper="1.5"' in after
    assert "KV312" in shortened.title
    joint = read_robot(done.path).joint_by_name["hinge"]
    assert joint.lower == -1.5
    assert 0.3 < joint.upper < 0.8
    assert done.exit_status == 0


def test_a_range_in_whole_degrees_is_written_in_radians(tmp_path: Path) -> None:
    model = hinged(tmp_path, '<limit lower="0" upper="90" effort="5" velocity="1"/>', 5.0)
    assert any("needs --kinematics" in sentence for sentence in fixed(model, tmp_path / "no.urdf").left)
    done = fixed(model, tmp_path / "out.urdf", kinematics=True)
    (diff,) = done.diffs
    assert diff.title == "hinge: the range was in degrees (KV220)"
    joint = read_robot(done.path).joint_by_name["hinge"]
    assert (joint.lower, joint.upper) == pytest.approx((0.0, 1.570796), abs=1e-5)
    assert done.exit_status == 0


def test_a_limit_that_would_cripple_a_joint_is_left_with_the_reason(tmp_path: Path) -> None:
    model = hinged(tmp_path, '<limit lower="-1.5" upper="1.5" effort="5" velocity="1"/>', 0.09, -0.09)
    done = fixed(model, tmp_path / "out.urdf", kinematics=True)
    assert done.diffs == ()
    assert not done.path.exists(), "nothing is written where nothing is changed"
    assert any("of its range" in sentence for sentence in done.left)
    assert done.exit_status == 1, "KV310 of a joint that cannot leave most of its range is an error"


def test_an_axis_that_leads_into_the_parent_is_reversed(tmp_path: Path) -> None:
    model = hinged(tmp_path, '<limit lower="0" upper="1.5" effort="5" velocity="1"/>', 0.09)
    done = fixed(model, tmp_path / "out.urdf", kinematics=True)
    (reversed_axis,) = done.diffs
    assert "+" in reversed_axis.lines
    assert read_robot(done.path).joint_by_name["hinge"].axis.tolist() == [0.0, 0.0, -1.0]
    assert not any(finding.check == "KV310" for finding in done.after.report.counted)


def test_an_axis_that_the_file_omits_is_written(tmp_path: Path) -> None:
    model = hinged(tmp_path, '<limit lower="0" upper="1.5" effort="5" velocity="1"/>', 0.09)
    model.write_text(model.read_text(encoding="utf-8").replace('<axis xyz="0 0 1"/>', ""), encoding="utf-8")
    blocked = Finding(
        check="KV310", severity=Severity.ERROR, cause=Cause.KINEMATICS, message="", remedy="", joint="hinge"
    )
    report = ValidationReport(
        model="",
        checks=(CheckResult(check="KV310", engine=None, status=Status.FAIL, findings=(blocked,)),),
        joints=(JointSummary(joint="hinge", kind="revolute", declared_limits=(0.0, 1.5), free_travel=(-1.5, 0.0)),),
    )
    editor = UrdfEditor(model, tmp_path / "out.urdf")
    JointEdits(editor=editor).apply(report, read_robot(model))
    assert editor.diffs
    assert '<axis xyz="-1.0 0.0 0.0"/>' in editor.diffs[0].lines
    assert read_robot(editor.write()).joint_by_name["hinge"].axis.tolist() == [-1.0, 0.0, 0.0]


def test_without_kinematics_no_joint_changes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = hinged(tmp_path, '<limit lower="1.5" upper="-1.5" effort="5" velocity="1"/>', 0.25)
    assert run(["fix", str(model), "-o", str(tmp_path / "o.urdf"), "--json", "-"]) == 1
    answer = json.loads(capsys.readouterr().out)
    assert (answer["changes"], answer["diffs"], answer["after"]["errors"]) == ([], [], 1)
    assert "--kinematics" in answer["left"][0]


def test_what_cannot_be_used_ends_with_two(tmp_path: Path) -> None:
    (tmp_path / "no.urdf").write_text("<html/>", encoding="utf-8")
    assert run(["fix", str(tmp_path / "no.urdf"), "-o", str(tmp_path / "o.urdf")]) == 2


def test_the_given_file_is_never_replaced(tmp_path: Path) -> None:
    model = hinged(tmp_path, LIMIT, 0.25)
    with pytest.raises(OutputError, match="the model itself"):
        fixed(model, model)
