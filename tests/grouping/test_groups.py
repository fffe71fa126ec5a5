"""Pieces of a mesh that nobody segmented."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from kinematify.assembly.load import load_assembly
from kinematify.assembly.part import Assembly, Part
from kinematify.assembly.pieces import connected_sheets
from kinematify.config import load_config
from kinematify.errors import AssemblyError, InputError
from kinematify.grouping.groups import (
    Group,
    Grouping,
    confidence_of,
    fixed_merged,
    group_pieces,
    joined_pieces,
    read_groups,
    unsure,
    with_doubtful,
)
from kinematify.grouping.piece_sets import alike, node_of_pieces
from kinematify.joints.candidate import JointEstimate, JointType
from kinematify.pipeline.infer_assembly import infer
from kinematify.robot.raw_mesh import RawMesh
from tests.one_mesh import box, write_bin_with_lid, write_chest


@pytest.fixture
def bin_with_lid(tmp_path: Path) -> Path:
    path = tmp_path / "bin.ply"
    write_bin_with_lid(path)
    return path


def test_a_mesh_without_labels_is_pieces_unless_they_are_kept(bin_with_lid: Path) -> None:
    assert not load_assembly(bin_with_lid).segmented
    assert load_assembly(bin_with_lid, pieces="keep").segmented
    with pytest.raises(InputError, match="Choose one of auto, group, cut, keep"):
        load_assembly(bin_with_lid, pieces="some")


def test_every_piece_is_in_one_group_and_the_file_brings_the_groups_back(bin_with_lid: Path, tmp_path: Path) -> None:
    pieces = load_assembly(bin_with_lid)
    found = group_pieces(pieces, load_config().grouping)
    assert sorted(name for group in found.groups for name in group.pieces) == list(pieces.names)
    assert 2 <= len(found.groups) < len(pieces.names), "boards are joined"
    assert sum(len(part.faces) for part in found.assembly.parts) == sum(len(part.faces) for part in pieces.parts)
    path = tmp_path / "groups.json"
    path.write_text(found.to_json(), encoding="utf-8")
    again = read_groups(path, pieces)
    assert {group.pieces for group in again.groups} == {group.pieces for group in found.groups}


def test_a_group_whose_joint_says_fixed_is_merged_into_its_parent_unless_a_user_stated_it(bin_with_lid: Path) -> None:
    pieces = load_assembly(bin_with_lid)
    groups = tuple(
        Group(name=name, pieces=(name,), moves=moves)
        for name, moves in zip(pieces.names, (None, *[0.6] * 5, None), strict=True)
    )
    joints = [
        JointEstimate(
            parent=1 if child == 2 else 0,
            child=child,
            kind=JointType.PRISMATIC,
            axis=np.array([0.0, 0.0, 1.0]),
            pivot=np.zeros(3),
            lower=0.0,
            upper=1.0,
            confidence=0.5,
            evidence={"probability_fixed": 0.4 if child == 5 else 0.9},
        )
        for child in range(1, 7)
    ]
    config = load_config().grouping
    merged = fixed_merged(Grouping(assembly=pieces, groups=groups), joints, config)
    assert [len(group.pieces) for group in merged.groups] == [5, 1, 1], "what hangs on a merged one goes with it"
    assert [group.moves for group in merged.groups] == [None, 0.6, None]
    assert len(merged.rejected) == 4
    assert sum(len(part.faces) for part in merged.assembly.parts) == sum(len(part.faces) for part in pieces.parts)
    everything = [replace(joint, evidence={"probability_fixed": 0.9}) for joint in joints[:5]]
    alone = Grouping(assembly=joined_pieces(pieces, [np.array([6, 0]), np.arange(1, 6)]), groups=(groups[6], groups[1]))
    assert fixed_merged(alone, everything[:1], config) is alone, "something moves"
    doubtful = [replace(joint, confidence=0.41) for joint in joints]
    assert "No joint of the grouped mesh is sure" in unsure(merged, doubtful, config)[0]
    assert unsure(merged, [*doubtful, joints[0]], config) == ()
    stated = replace(merged, groups=tuple(replace(group, moves=None) for group in merged.groups))
    assert unsure(stated, doubtful, config) == (), "a user stated them"


def test_a_front_that_was_left_in_the_body_joins_its_drawer_because_the_joint_is_surer() -> None:
    boards = {
        "bottom": ((0.4, 0.5, 0.02), (0, 0, 0.01)),
        "top": ((0.4, 0.5, 0.02), (0, 0, 0.19)),
        "left": ((0.02, 0.5, 0.16), (-0.19, 0, 0.1)),
        "right": ((0.02, 0.5, 0.16), (0.19, 0, 0.1)),
        "back": ((0.36, 0.02, 0.16), (0, 0.24, 0.1)),
        "front": ((0.36, 0.02, 0.156), (0, -0.245, 0.1)),
        "tray": ((0.35, 0.45, 0.01), (0, -0.01, 0.03)),
        "tray_left": ((0.01, 0.45, 0.1), (-0.17, -0.01, 0.085)),
        "tray_right": ((0.01, 0.45, 0.1), (0.17, -0.01, 0.085)),
    }
    meshes = {name: box(*placed) for name, placed in boards.items()}
    parts = tuple(Part(name=name, vertices=mesh.vertices, faces=mesh.faces) for name, mesh in meshes.items())
    pieces, names = Assembly(parts=parts, source="drawer", segmented=False), tuple(boards)
    grouping = Grouping(
        assembly=joined_pieces(pieces, [np.arange(6), np.arange(6, 9)]),
        groups=(Group(name="bottom", pieces=names[:6]), Group(name="tray", pieces=names[6:], moves=0.6)),
        rejected=(Group(name="front", pieces=("front",), moves=0.4),),
        doubtful=((1, np.array([5])),),
        pieces=pieces,
    )
    found = infer(grouping)
    assert found.grouping is not None
    assert [set(group.pieces) for group in found.grouping.groups] == [set(names[:5]), set(names[5:])]
    assert found.grouping.rejected == (), "it is in a part now"
    assert [joint.kind for joint in found.joints] == [JointType.PRISMATIC]
    joint, config = found.joints[0], load_config().grouping
    assert confidence_of([joint], config) == {1: joint.confidence}
    assert confidence_of([replace(joint, evidence={"probability_fixed": 0.9})], config) == {}
    assert with_doubtful(grouping, []) is grouping


def test_equal_drawers_are_grouped_alike_and_equally_likely(tmp_path: Path) -> None:
    write_chest(tmp_path / "chest.ply")
    pieces = load_assembly(tmp_path / "chest.ply", up="z")
    drawers = [frozenset(range(start, start + 6)) for start in (5, 11, 17)]
    part_of_one = drawers[0] - {6}
    found = dict(zip(*alike([*drawers[:2], part_of_one], np.array([2.0, 0.0, 3.0]), pieces.parts), strict=True))
    assert [found[drawer] for drawer in drawers] == [1.0, 1.0, 1.0], (
        "one was not proposed, and another one was unlikely"
    )
    assert [found[drawer - {start + 1}] for drawer, start in zip(drawers, (5, 11, 17), strict=True)] == [3.0, 3.0, 3.0]
    grouping = group_pieces(pieces, load_config().grouping)
    moving = [group for group in grouping.groups if group.moves is not None]
    assert {group.pieces for group in moving} == {tuple(f"piece_{k:03d}" for k in sorted(drawer)) for drawer in drawers}
    assert len({group.moves for group in moving}) == 1


def test_nodes_that_hang_together_are_evidence_and_name_the_parts(bin_with_lid: Path, tmp_path: Path) -> None:
    pieces = trimesh.load_mesh(bin_with_lid).split(only_watertight=False)
    scene, path = trimesh.Scene(), tmp_path / "nodes.glb"
    for name, of_node in (("bin", [0, 1, 2, 3, 4]), ("top", [5, 6])):
        scene.add_geometry(trimesh.util.concatenate([pieces[k] for k in of_node]), node_name=name)
    scene.export(path)
    given = load_assembly(path, up="z", pieces="group")
    assert given.names == ("bin", "bin_2", "bin_3", "bin_4", "bin_5", "top", "top_2")
    found = group_pieces(given, load_config().grouping)
    assert {group.name: len(group.pieces) for group in found.groups} == {"bin": 5, "top": 2}
    assert set(found.assembly.names) == {"bin", "top"}


@pytest.mark.parametrize(
    ("names", "expected"),
    [("aabb", [0, 0, 1, 1]), ("abab", None), ("aaaa", None), ("abcd", None)],
    ids=["parts", "materials", "one node", "a node per piece"],
)
def test_nodes_whose_pieces_hang_apart_are_no_evidence(names: str, expected: list[int] | None) -> None:
    found = node_of_pieces(list(names), np.array([[0, 1], [1, 2], [2, 3]]))
    assert (None if found is None else found.tolist()) == expected


def test_a_groups_file_with_an_unknown_or_repeated_piece_is_refused(bin_with_lid: Path, tmp_path: Path) -> None:
    pieces, path = load_assembly(bin_with_lid), tmp_path / "groups.json"
    for named, said in ((["piece_000", "nothing"], "which is no piece"), (["piece_000", "piece_000"], "twice")):
        path.write_text(json.dumps({"parts": [{"pieces": named}]}), encoding="utf-8")
        with pytest.raises(InputError, match=said):
            read_groups(path, pieces)


def test_boxes_that_share_an_edge_are_two_sheets_and_coincident_faces_are_one() -> None:
    both = trimesh.util.concatenate([box((1, 1, 1), (0, 0, 0)), box((1, 1, 1), (1, 0, 1))])
    mesh = RawMesh(name="both", vertices=both.vertices, faces=both.faces)
    assert [len(sheet.faces) for sheet in connected_sheets(mesh, 1e-7)] == [12, 12]
    one = box((1, 1, 1), (0, 0, 0))
    doubled = RawMesh(name="double", vertices=one.vertices, faces=np.concatenate([one.faces, one.faces[:, ::-1]]))
    assert len(connected_sheets(doubled, 1e-7)) == 1


def test_a_door_drawn_on_one_surface_is_reported_and_cut_only_when_asked_for(tmp_path: Path) -> None:
    door = [box((0.8, 0.1, 0.8), (0, -0.5, 0)), box((0.2, 0.1, 0.3), (0.2, -0.57, 0))]
    one = trimesh.boolean.union([box((1, 1, 1), (0, 0, 0)), *door])
    path, ball = tmp_path / "one.ply", tmp_path / "ball.ply"
    one.export(path)
    trimesh.creation.icosphere().export(ball)
    with pytest.raises(AssemblyError, match=r"one surface.*inwards, around 0.8 x .* m \(\d+ faces.*--pieces cut"):
        load_assembly(path)
    pieces = load_assembly(path, pieces="cut")
    assert not pieces.segmented
    assert sorted(tuple(np.ptp(part.bounds, axis=0).round(2)) for part in pieces.parts)[-1] == (1.0, 1.0, 1.0)
    assert len(pieces.parts) == 3
    assert sum(len(part.faces) for part in pieces.parts) == len(one.faces)
    for asked in ("auto", "cut"):
        with pytest.raises(AssemblyError, match="1 usable part"):
            load_assembly(ball, pieces=asked)


def test_of_a_scene_on_a_floor_one_object_is_asked_for_and_the_floor_is_removed(
    bin_with_lid: Path, tmp_path: Path
) -> None:
    one = trimesh.load_mesh(bin_with_lid)
    other = one.copy().apply_translation((1.0, 0.1, 0.0))
    floor = box((3, 2, 0.02), (0.5, 0, -0.01))
    several, alone = tmp_path / "several.ply", tmp_path / "alone.ply"
    trimesh.util.concatenate([other, floor, one]).export(several)
    trimesh.util.concatenate([floor, one]).export(alone)
    with pytest.raises(
        AssemblyError, match=r"shows 2 objects on a floor.*--object N.*1: 7 pieces, 0.4 x 0.4 x 0.572 m"
    ):
        load_assembly(several)
    with pytest.raises(AssemblyError, match="has no object 3"):
        load_assembly(several, number=3)
    second = load_assembly(several, number=2)
    assert second.bounds[0, 0] == pytest.approx(0.8, abs=1e-6)
    assert any("the floor piece_" in text and "7 pieces of other objects" in text for text in second.warnings)
    assert [len(part.faces) for part in load_assembly(alone).parts] == [12] * 7
    assert len(load_assembly(bin_with_lid).parts) == 7, "its bottom is no floor"
