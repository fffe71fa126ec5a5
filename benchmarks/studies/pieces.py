"""What does `kinematify infer` make of a mesh that nobody segmented?

Objects of the benchmark are merged into one PLY (float32) and inferred from it alone. A predicted moving part, with
what is fixed to it, is matched with the true part of the highest IoU of their triangles, above .5 (the protocol of
S2O). *Parts* counts matches alone; M asks for the right type as well (continuous counts as revolute), MA for the axis
within 5 deg, MAO for the line of a turning joint within 10 % of the part's diagonal. All are F1: 2 * right / (true +
predicted). *Whole* objects have every moving part with MA and no other. PartNet objects never enter weights that ship,
and with --weights the category of every object is held out of the weights that group its pieces. With --nodes the
object is a GLB with a node per part, or per link, which has the name of its link; --pieces group regroups it. With
--answers only objects with a recorded answer to `kinematify question` are inferred, without and with it: those in
`benchmarks/answers` were given from picture and text alone, before truth was opened, to objects that had not been used
for the wording. *Named* are the parts of answers, *right* those whose pieces match a true moving part. A voter that is
right in a share of its parts has others of random pieces in their place, and its record.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import trimesh
from pydantic import Field
from scipy.spatial import cKDTree

from benchmarks.fit.corpora import may_be_fitted_to
from benchmarks.fit.pieces import HeldOut, category_of_piece
from benchmarks.study import Options, Study, explained
from kinematify.assembly.erasure import erase
from kinematify.assembly.load import load_assembly
from kinematify.assembly.part import Part
from kinematify.assembly.pieces import baked
from kinematify.config import load_config
from kinematify.errors import KinematifyError
from kinematify.evaluation.datasets import bench_folder, find_objects
from kinematify.evaluation.metrics import CLOSE_ANGLE, CLOSE_ORIGIN, axis_angle, axis_line_distance
from kinematify.evaluation.result_record import grouped, table
from kinematify.grouping.groups import group_pieces
from kinematify.grouping.numbered_pieces import NamedPart
from kinematify.pipeline.infer_assembly import infer
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics, rest_configuration, rigid_groups
from kinematify.vision.ask import PieceVote
from kinematify.vision.piece_question import piece_question
from kinematify.vision.votes import VoterRecord

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.assembly.erasure import ErasedModel
    from kinematify.assembly.part import Assembly
    from kinematify.assembly.truth import TrueJoint
    from kinematify.evaluation.datasets import BenchObject
    from kinematify.evaluation.result_record import Report
    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.vision.piece_question import PieceQuestion

_ENOUGH = 0.5
"""IoU of triangles above which two parts are the same."""
_KINDS = ("parts", "M", "MA", "MAO")


class PiecesOptions(Options):
    """Which objects, and with which weights."""

    data: tuple[str, ...] = Field(
        ("everyday", "everyday2", "articraft", "infinigen"), description="Sets of the benchmark folder, or folders."
    )
    most: int = Field(1000, ge=1, description="Objects of a set; of more, evenly drawn ones.")
    weights: str | None = Field(None, description="Folder of held-out weights that `benchmarks.fit.pieces` wrote.")
    pieces: Literal["auto", "keep", "group"] = Field("auto", description="As `infer` takes it.")
    nodes: Literal["none", "part", "link"] = Field("none", description="A node for each, in place of one mesh.")
    answers: tuple[str, ...] = Field((), description="JSON files of recorded answers by set/object.")
    voter: float | None = Field(None, ge=0.0, le=1.0, description="Share of parts of an answer that stay as they are.")
    seconds: float = Field(240.0, gt=0.0, description="Wall time for one object.")


@dataclass(frozen=True, kw_only=True)
class MergedObject:
    """One object to merge and infer."""

    item: BenchObject
    group: str
    weights: str | None
    pieces: str
    nodes: str
    answer: str | None = None
    voter: float | None = None


def measure(options: PiecesOptions, work: Work) -> Measured:
    """Merge every object and infer it."""
    folder = bench_folder()
    asked = {}
    answers: dict[str, Any] = {}
    for file in options.answers:
        answers |= json.loads(Path(file).read_text(encoding="utf-8"))
    for data in options.data:
        place = folder / data if (folder / data).is_dir() else Path(data)
        found = list(filter(_can_be_read, find_objects(place)))
        rows = np.linspace(0, len(found) - 1, min(options.most, len(found))).round().astype(int)
        for item in (found[row] for row in rows):
            name = f"{place.name}/{item.name}"
            case = MergedObject(
                item=item, group=place.name, weights=options.weights, pieces=options.pieces, nodes=options.nodes
            )
            if not answers:
                asked[name] = case
            elif name in answers:
                asked[name] = case
                said = json.dumps(answers[name])
                asked[f"{name}, asked"] = replace(case, group=f"{place.name}, asked", answer=said, voter=options.voter)

    def failed(name: str, failure: object) -> Record:
        return {**_facts(asked[name]), **_counts(erased_object(asked[name].item), None), "status": str(failure)}

    records = work.each(run_case, asked, timeout=options.seconds, reuse=10, failed=failed)
    return list(records.values()), {}


def _can_be_read(item: BenchObject) -> bool:
    """True if an object has a truth to compare with; one that has none is named, and the run goes on."""
    try:
        read_robot(item.urdf, geometry="none")
    except KinematifyError as error:
        sys.stderr.write(f"{item.name} is passed over: {error}\n")
        return False
    return True


def erased_object(item: BenchObject) -> ErasedModel:
    """The parts of an object at rest, parents first."""
    return erase(read_robot(item.urdf, geometry="shown"), shuffle=False)


def run_case(case: MergedObject) -> Record:
    """Merge one object, infer it and count what is right."""
    erased, category = erased_object(case.item), category_of_piece(case.item.category)
    started = time.process_time()
    found, status, pieces, named = None, "ok", 0, {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / ("object.ply" if case.nodes == "none" else "object.glb")
        write_merged(erased, path) if case.nodes == "none" else write_nodes(case.item, path, case.nodes)
        try:
            config = load_config()
            given = load_assembly(path, config=config.assembly, up="z", pieces=case.pieces)
            pieces = len(given.parts)
            if case.answer is not None:
                vote = _vote(case, piece_question(given, config))
                named = {"named": len(vote.answer.parts), "hit": _hits(erased, given, vote.answer.parts)}
                found = vote.applied(infer(vote.grouping(config), config=config, base=vote.base))
            elif not given.segmented:
                weights = None if case.weights is None else HeldOut(Path(case.weights)).weights_of(category)
                found = infer(group_pieces(given, config.grouping, weights), config=config)
            else:
                found = infer(given, config=config)
        except KinematifyError as error:
            status = str(error)
    seconds = time.process_time() - started
    facts = {**_facts(case), **named, "status": status, "pieces": pieces, "seconds": seconds}
    return {**facts, **_counts(erased, found)}


def _vote(case: MergedObject, question: PieceQuestion) -> PieceVote:
    """The recorded answer, or that of a voter who is right in a share of its parts only."""
    answer = question.read(case.answer or "")
    if case.voter is None:
        return PieceVote(voter="recorded", question=question, answer=answer)
    random = np.random.default_rng(list(case.item.name.encode()))
    order, taken, kept = random.permutation(len(question.pieces)).tolist(), set[int](), list[NamedPart]()
    for part in answer.parts:
        right = random.random() < case.voter
        pieces = [k for k in (part.pieces if right else question.pieces[order.pop()]).tolist() if k not in taken]
        taken |= {*pieces}
        if pieces:
            kept.append(replace(part, pieces=np.array(pieces), turns=part.turns if right else not part.turns))
    record = VoterRecord(right=round(10 * case.voter), asked=10)
    return PieceVote(voter="simulated", question=question, answer=replace(answer, parts=tuple(kept)), record=record)


def _hits(erased: ErasedModel, given: Assembly, named: Sequence[NamedPart]) -> int:
    """Number of named sets of pieces that are a true moving part, by IoU of triangles."""
    parts = [erased.parts[k] for k in sorted({joint.child for joint in erased.truth.joints})]
    centres = np.concatenate([part.vertices[part.faces].mean(axis=1) for part in given.parts])
    owner = np.repeat(np.arange(len(given.parts)), [len(part.faces) for part in given.parts])
    tree = cKDTree(centres)
    counts = np.array([
        np.bincount(owner[tree.query(part.vertices[part.faces].mean(axis=1))[1]], minlength=len(given.parts))
        for part in parts
    ])  # fmt: skip
    sizes, faces = counts.sum(axis=1), np.bincount(owner, minlength=len(given.parts))
    both = [counts[:, item.pieces].sum(axis=1) for item in named]
    either = [sizes + faces[item.pieces].sum() - one for item, one in zip(named, both, strict=True)]
    return sum(float((one / all_).max()) > _ENOUGH for one, all_ in zip(both, either, strict=True))


def write_merged(erased: ErasedModel, path: Path) -> None:
    """Write all parts as one mesh in single precision."""
    starts = np.cumsum([0, *(len(part.vertices) for part in erased.parts)])
    vertices = np.concatenate([part.vertices for part in erased.parts])
    faces = np.concatenate([part.faces + start for part, start in zip(erased.parts, starts, strict=False)])
    trimesh.Trimesh(vertices, faces, process=False).export(path)


def write_nodes(item: BenchObject, path: Path, nodes: str) -> None:
    """Write a GLB, z up, with a node per rigid part or per link, named after its first link."""
    robot, scene = read_robot(item.urdf, geometry="shown"), trimesh.Scene()
    poses = forward_kinematics(robot, rest_configuration(robot))
    for group in rigid_groups(robot):
        of_links = [replace(group, links=(link,)) for link in group.links if robot.link_by_name[link].has_geometry]
        for node in [group] if nodes == "part" and of_links else of_links:
            mesh = baked(robot, node, poses)
            shape = trimesh.Trimesh(mesh.vertices.astype(np.float32), mesh.faces, process=False)
            scene.add_geometry(shape, node_name=mesh.name)
    path.write_bytes(scene.export(file_type="glb"))  # type: ignore[no-untyped-call]


def _facts(case: MergedObject) -> Record:
    facts = json.loads((case.item.urdf.parent / "source.json").read_text(encoding="utf-8"))
    of_partnet = "partnet" in str(facts.get("license", "")).lower()
    group = "PartNet" if of_partnet else case.group
    group = f"{group}, asked" if case.answer is not None and of_partnet else group
    return {"object": case.item.name, "group": group, "category": case.item.category, "fits": may_be_fitted_to(facts)}


def _counts(erased: ErasedModel, found: Inference | None) -> Record:
    """True and predicted moving parts, and how many are right in each sense."""
    of_part: dict[int, list[TrueJoint]] = grouped(erased.truth.joints, by=lambda joint: joint.child)
    counts = {"true": len(of_part), "predicted": 0, **dict.fromkeys(_KINDS, 0), "whole": False, "bodies": []}
    if found is None:
        return counts
    bodies, joints = moving_bodies(found)
    counts["predicted"] = len(joints)
    overlap = _overlaps(erased.parts, found, bodies)
    counts["bodies"] = [_body(found, joint, overlap[list(of_part), child]) for child, joint in joints.items()]
    right = dict.fromkeys(_KINDS, 0)
    for part, true in of_part.items():
        best = int(np.argmax(overlap[part])) if overlap.shape[1] else -1
        if best < 0 or overlap[part, best] <= _ENOUGH or best not in joints:
            continue
        marks = [_marks(joint, joints[best], erased.parts[part]) for joint in true]
        for kind, met in zip(_KINDS, (True, *map(any, zip(*marks, strict=True))), strict=True):
            right[kind] += met
    whole = right["MA"] == counts["true"] == counts["predicted"]
    return {**counts, **right, "whole": whole}


def moving_bodies(found: Inference) -> tuple[IntArray, dict[int, JointEstimate]]:
    """Rigid body of every part, fixed joints fused, shape (n,), and the joint above each body that moves."""
    body = np.arange(len(found.assembly.parts))
    joint_of = {joint.child: joint for joint in found.joints}
    for parent, child in found.trees[0].edges():  # parents first
        if joint_of[child].kind is JointType.FIXED:
            body[child] = body[parent]
    return body, {child: joint for child, joint in joint_of.items() if joint.kind is not JointType.FIXED}


def _overlaps(parts: Sequence[Part], found: Inference, bodies: IntArray) -> FloatArray:
    """IoU of the triangles of every true part with every body, shape (parts, predicted parts)."""
    assembly = found.assembly
    shown = [assembly.originals.get(part.name, part) for part in assembly.parts]
    shown += [item.part for item in assembly.set_aside]
    body = [*bodies, *(bodies[assembly.names.index(item.nearest)] for item in assembly.set_aside)]
    centres = np.concatenate([part.vertices[part.faces].mean(axis=1) for part in shown])
    owner = np.repeat(body, [len(part.faces) for part in shown])
    tree = cKDTree(centres)
    counts = np.zeros((len(parts), len(bodies)))
    for row, part in enumerate(parts):
        nearest = tree.query(part.vertices[part.faces].mean(axis=1))[1]
        counts[row] = np.bincount(owner[nearest], minlength=len(bodies))
    union = counts.sum(axis=1, keepdims=True) + counts.sum(axis=0, keepdims=True) - counts
    return np.asarray(counts / np.maximum(union, 1.0))


def _body(found: Inference, joint: JointEstimate, overlap: FloatArray) -> Record:
    """How sure grouping and inference are of a body that moves, and how much of a true moving part it is."""
    group = None if found.grouping is None else found.grouping.groups[joint.child].moves
    return {
        "moves": group,
        "fixed": joint.evidence.get("probability_fixed"),
        "confidence": joint.confidence,
        "overlap": float(overlap.max(initial=0.0)),
    }


def _marks(true: TrueJoint, guess: JointEstimate, part: Part) -> tuple[bool, bool, bool]:
    """M, MA and MAO."""
    kind = true.kind.turns == guess.kind.turns
    axis = kind and axis_angle(true.axis, guess.axis) <= CLOSE_ANGLE
    if not axis or not true.kind.turns:
        return kind, axis, axis
    distance = axis_line_distance(
        true_axis=true.axis, true_pivot=true.pivot, axis=guess.axis, pivot=guess.pivot, near=part.centroid
    )
    return kind, axis, distance <= CLOSE_ORIGIN * part.diagonal


def report(found: Report[Record]) -> list[str]:
    """F1 of every set, and every object."""
    records = found.records
    sets = {
        **grouped(records, by=lambda record: str(record["group"])),
        **grouped(records, by=lambda record: f"**all{', asked' if 'named' in record else ''}**"),
    }
    named = [sum(record.get(key, 0) for record in records) for key in ("hit", "named")]
    rows = [_row(name, group) for name, group in sets.items()]
    kinds = tuple(f"F1 {kind}" for kind in _KINDS)
    columns = ("set", "objects", "move", "predicted", "precision", "recall", *kinds, "whole")
    held_out = found.header.configuration.get("weights") is not None
    seconds = [record["seconds"] for record in records if "seconds" in record]
    return [
        explained(__doc__),
        (
            f"Weights of the grouping: {'category held out' if held_out else 'those that ship'}. Precision and recall "
            f"are those of MA. Named parts that are right: {named[0]} of {named[1]}. "
            f"Processor time: median {np.median(seconds):.1f} s, longest {max(seconds):.1f} s."
        ),
        table(columns, rows),
        "## Objects",
        table(
            ("object", "set", "pieces", "move", "predicted", *_KINDS, "seconds", "status"),
            [
                (
                    r["object"], r["group"], str(r.get("pieces", "")), str(r["true"]), str(r["predicted"]),
                    *(str(r[kind]) for kind in _KINDS), f"{r.get('seconds', float('nan')):.1f}", r["status"][:60],
                )
                for r in records
            ],
        ),
    ]  # fmt: skip


def _row(name: str, records: Sequence[Record]) -> tuple[str, ...]:
    true, predicted = (sum(record[key] for record in records) for key in ("true", "predicted"))
    right = {kind: sum(record[kind] for record in records) for kind in _KINDS}
    whole = np.mean([record["whole"] for record in records])
    f1 = (f"{2 * right[kind] / max(true + predicted, 1):.2f}" for kind in _KINDS)
    of_axes = (f"{right['MA'] / max(count, 1):.2f}" for count in (predicted, true))
    return (name, str(len(records)), str(true), str(predicted), *of_axes, *f1, f"{whole:.0%}")


STUDY = Study(title="Meshes that nobody segmented", options=PiecesOptions, measure=measure, report=report)
