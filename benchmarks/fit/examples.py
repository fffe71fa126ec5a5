"""Examples for the fit: every hypothesis of every true edge of an object, measured, and how right each one is."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.contact.build_graph import build_contact_graph
from kinematify.contact.graph import pair
from kinematify.contact.tree import KinematicTree
from kinematify.evaluation.metrics import opening_sign
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_fit import fit_bearings
from kinematify.joints.candidate import ELSEWHERE, FIXED, SLIDE, TURN, Hypotheses, JointType
from kinematify.joints.choice.decide import edge_features
from kinematify.joints.choice.judge import rightness
from kinematify.joints.choice.opening import measure_sides
from kinematify.joints.features.edge_scene import TreeScenes
from kinematify.joints.features.workspace import Cloud, PartCache, point_cloud

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.assembly.part import Assembly
    from kinematify.assembly.truth import GroundTruth, TrueJoint
    from kinematify.config import Config
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.joints.features.measurements import Values
    from kinematify.robot.arrays import FloatArray, IntArray

_WHOLE_TURN = 2.0 * np.pi - 0.1  # [rad]


@dataclass(frozen=True, kw_only=True, eq=False)
class Example:
    """One true edge."""

    object: str
    category: str
    origin: str
    """Of which corpus the object is."""
    source: str
    """Whose work it is: the data set, package or generator."""
    fits: bool
    """It may enter weights that ship; objects whose licence is for research alone judge."""
    hypotheses: Hypotheses
    size: float
    """Diagonal of the child [m]."""
    measured: Mapping[str, FloatArray]
    """Shape (h,) each."""
    groups: Mapping[str, Sequence[str]]
    """Names of the measurements by the group that measures them, with `CUES` and `VERDICTS`."""
    right: FloatArray
    """How right each hypothesis is, in [0, 1], shape (h,)."""
    angles: FloatArray
    """Between each axis and that of the true joint which it fits best [deg]; 90 for fixed, shape (h,)."""
    types_right: IntArray
    """1 where the type is that of this joint, shape (h,)."""
    cloud: Cloud
    """Points of both parts and around them."""
    by_cues: int
    """Position of what the weighted cues alone would choose."""
    alike: int
    """The same number for edges of an object that are alike (`AlikeParts.edges`)."""
    broken: bool = False
    """The object has pieces broken off; such edges teach what is fixed, not which joint is right."""
    sides: Mapping[str, FloatArray] = field(default_factory=dict)
    """What is measured towards either side of the true turn (`measure_sides`), the one that opens first, shape (2,)
    each; empty where the joint slides, goes both ways or is a link in series."""
    is_continuous: bool | None = None
    """The true joint turns by a whole turn or without end; None where it does not turn."""
    spare: bool = False
    """Its category has enough objects to fit to without this one, which only judges."""

    @property
    def teaches(self) -> bool:
        """Weights are fitted to it."""
        return self.fits and not self.spare

    @property
    def kinds(self) -> IntArray:
        """FIXED, TURN or SLIDE, shape (h,)."""
        return self.hypotheses.kinds

    @property
    def target(self) -> FloatArray:
        """Probabilities that the scorer should give, sum 1, shape (h,)."""
        return self.right / max(float(self.right.sum()), 1e-12)


def examples_of(
    assembly: Assembly,
    truth: GroundTruth,
    config: Config,
    *,
    category: str,
    origin: str,
    source: str,
    fits: bool,
    broken: bool = False,
) -> list[Example]:
    """Measure all hypotheses of the edges of the true tree of an object.

    Of an object with pieces broken off, the edges above and below the pieces' parents alone: others are as they were.

    Args:
        assembly: The parts, in the order of the truth.
        truth: Exact joints, world frame.
        config: Of the inference.
        category: Of the object.
        origin: Of which corpus it is.
        source: Whose work it is.
        fits: See `Example`.
        broken: See `Example`.
    """
    lessened = {joint.parent for joint in truth.joints if joint.kind is JointType.FIXED}
    surfaces = part_surfaces(assembly, config=config.surface)
    graph = build_contact_graph(assembly, surfaces, config=config.contact, seed=config.seed)
    bearings = fit_bearings(assembly, surfaces, graph, config=config.bearing, seed=config.seed)
    tree = KinematicTree(parents=tuple(truth.parents))
    cache = PartCache(assembly, graph, samples=config.joints.samples, seed=config.seed)
    whole = TreeScenes(cache, tree, config.joints)
    alike = graph.alike.edges(tree)
    found = []
    for edge in tree.edges():
        joints = [joint for joint in truth.joints if (joint.parent, joint.child) == edge]
        if not joints or (broken and joints[0].kind is not JointType.FIXED and edge[1] not in lessened):
            continue
        features = edge_features(whole.scene(edge, bearings.get(pair(*edge))))
        hypotheses, size = features.hypotheses, features.scene.frame.diagonal
        near = cache.samples(edge[1]).points.mean(axis=0)
        judged = [_rightness(hypotheses, joint, near, size) for joint in joints]
        best = np.argmax([right + 1e-3 * same for right, _, same in judged], axis=0)
        rows = np.arange(len(hypotheses))
        right, angles, same = (np.array([item[k] for item in judged])[best, rows] for k in range(3))
        found.append(
            Example(
                object=assembly.source,
                category=category,
                origin=origin,
                source=source,
                fits=fits,
                hypotheses=hypotheses,
                size=size,
                measured=features.columns,
                groups={group: tuple(values) for group, values in features.groups.items()},
                right=right,
                angles=angles,
                types_right=same.astype(np.int64),
                cloud=point_cloud(cache, *edge, features.scene.others, size),
                by_cues=features.by_cues,
                alike=next(number for number, group in enumerate(alike) if edge in group),
                broken=broken,
                sides={} if broken else _sides(features.scene, joints[0]),
                is_continuous=joints[0].upper - joints[0].lower > _WHOLE_TURN if joints[0].kind.turns else None,
            )
        )
    return found


def _sides(scene: JointScene, joint: TrueJoint) -> Values:
    """See `Example.sides`."""
    opens = opening_sign(joint.lower + joint.value, joint.upper + joint.value)
    if opens == 0 or joint.kind is not JointType.REVOLUTE or scene.serial:
        return {}
    return measure_sides(scene, opens * joint.axis, joint.pivot)


def _rightness(
    h: Hypotheses, joint: TrueJoint, near: FloatArray, size: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """How right each hypothesis is, its angle to the true axis [deg], and 1 where the type is right, (h,) each."""
    kind = TURN if joint.kind.turns else SLIDE if joint.kind is JointType.PRISMATIC else FIXED
    same = (h.kinds == kind).astype(np.float64)
    if kind == FIXED:
        return same, np.where(h.kinds == FIXED, 0.0, 90.0), same
    angles = np.degrees(np.arccos(np.clip(np.abs(h.axes @ joint.axis), 0.0, 1.0)))
    right = same * rightness(angles, np.zeros(len(h)))
    if kind == TURN:
        foot = joint.pivot + joint.axis * float((near - joint.pivot) @ joint.axis)
        apart = np.linalg.norm(np.cross(foot - h.pivots, h.axes), axis=1) / size
        # The far term says which line is nearer where none is near.
        right = same * rightness(angles, apart) + 1e-3 * right * np.exp(-((apart / 0.3) ** 2))
    return right, angles, same


# ---- files ---------------------------------------------------------------------------------------------------------


def write_examples(path: Path, examples: Sequence[Example]) -> None:
    """Write the examples of one object; the file appears whole or not at all."""
    arrays: dict[str, Any] = {}
    facts: list[dict[str, Any]] = []
    for k, example in enumerate(examples):
        names = sorted(example.measured)
        arrays[f"values_{k}"] = np.array([example.measured[name] for name in names], dtype=np.float32)
        labels = (example.kinds, example.right, example.angles, example.types_right)
        arrays[f"sides_{k}"] = np.array([example.sides[name] for name in sorted(example.sides)], dtype=np.float32)
        arrays |= {f"cloud_{name}_{k}": np.asarray(value, np.float32) for name, value in vars(example.cloud).items()}
        arrays[f"labels_{k}"] = np.column_stack([*labels, example.hypotheses.axes, example.hypotheses.pivots])
        facts.append(
            {
                "object": example.object,
                "category": example.category,
                "origin": example.origin,
                "source": example.source,
                "fits": example.fits,
                "broken": example.broken,
                "by_cues": example.by_cues,
                "size": example.size,
                "groups": example.groups,
                "alike": example.alike,
                "is_continuous": example.is_continuous,
                "sources": example.hypotheses.sources.tolist(),
                "names": names,
                "side_names": sorted(example.sides),
            }
        )
    aside = path.with_suffix(".part.npz")
    np.savez_compressed(aside, facts=json.dumps(facts), **arrays)
    aside.replace(path)


def read_examples(path: Path) -> list[Example]:
    """Read what `write_examples` wrote."""
    found = []
    with np.load(path) as stored:
        for k, facts in enumerate(json.loads(str(stored["facts"]))):
            table = stored[f"labels_{k}"]
            kinds, right, angles, same = table[:, :4].T
            hypotheses = Hypotheses(
                kinds=kinds.astype(np.int64),
                axes=table[:, 4:7],
                pivots=table[:, 7:],
                places=np.full(len(table), ELSEWHERE),
                sources=np.array(facts.pop("sources")),
            )
            measured = dict(zip(facts.pop("names"), stored[f"values_{k}"], strict=True))
            sides = dict(zip(facts.pop("side_names"), stored[f"sides_{k}"], strict=True))
            cloud = {field.name: stored[f"cloud_{field.name}_{k}"] for field in fields(Cloud)}
            found.append(
                Example(
                    **facts,
                    hypotheses=hypotheses,
                    right=right,
                    angles=angles,
                    types_right=same.astype(np.int64),
                    cloud=Cloud(**cloud | {"labels": cloud["labels"].astype(np.int64), "unit": float(cloud["unit"])}),
                    measured=measured,
                    sides=sides,
                )
            )
    return found


def content_key(*facts: object) -> str:
    """Name of a file of examples: equal only where nothing has changed that they depend on."""
    return hashlib.sha256(json.dumps(facts, sort_keys=True, default=str).encode()).hexdigest()[:20]
