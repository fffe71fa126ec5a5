"""What do the paper's rewards and its DW-CAVL find, and what is at fault where they do not?

Trees: the five rewards under `paper` (the base link is the part of highest degree, edges inside a cluster are
forbidden), `paper-base` (the base link is given, as in Algorithm 1) and `paper-open` (given, and nothing is forbidden);
pieces of cut parts are not joined. Contact strength is exp(-gap / tolerance), for the paper says "proximity" and gives
no formula, so that all parts that touch have nearly the same; *by area* it is the area of the contact beside the
largest one. A part hangs wrong where it touches another one no less than what carries it, be it for a gap in the true
joint or because both meet in that pose; the strengths are beside it. Gaps are exact, *by fields* they are the
smallest signed distance of surface samples in the field of the other part, as the paper has it.

Joints: on the true tree, DW-CAVL as printed and DW-CAVL+, in which a sample that has left the contact by more than
sigma_c costs no more the farther it gets, and samples of the contact count in L_coll as others do. J of the true joint
is beside J of the chosen one. Where a joint is wrong (type, or axis off by more than 10 deg), the *objective* is at
fault if the true joint costs more than the chosen one, else the *pool* if no candidate of the true type lies within 10
deg, else the *optimiser*. Signed distances from grids unless --sdf neural is asked for.

Whole: tree and joints of every configuration, and without MCTS (breadth-first search) or DW-CAVL (no anchor term), as
the paper's ablation has it. Types by the configuration's own rule, or by an oracle in place of the paper's
vision-language model, with a majority over clusters of congruent parts; one that errs is drawn five times. A joint
between wrong parts counts 90 deg; *matched* leaves those out.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from operator import itemgetter
from statistics import fmean
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from benchmarks.paper import ABLATION, TABLE_I, mean_over_robots
from benchmarks.paper_configurations import OWN, configured
from benchmarks.study import Options, Study, among, explained
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.evaluation.benchmark_job import erased_item, shown_parts
from kinematify.evaluation.datasets import CONDITIONS, BenchObject, Condition, find_objects, matching
from kinematify.evaluation.metrics import axis_angle
from kinematify.evaluation.result_record import grouped, table
from kinematify.evaluation.tree_metrics import parent_errors, tree_edit_distance
from kinematify.geometry.sampling import sample_surface
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.candidate import JointCandidate
from kinematify.pipeline.stages import find_trees
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.assembly.erasure import ErasedModel
    from kinematify.assembly.part import Assembly
    from kinematify.config import CavlConfig, Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.evaluation.result_record import Report
    from kinematify.paper.cavl import CavlScene

_BY_AREA, _BY_FIELDS = ", by area", ", by fields"
RULES = ("paper", "paper-base", "paper-open", f"paper-open{_BY_AREA}", f"paper-open{_BY_FIELDS}")
OBJECTIVES = {"DW-CAVL": "paper-open", "DW-CAVL+": "paper-plus"}
WRONG_DEG = 10.0
_SAMPLE = (
    "bottle_3763", "box_100141", "cabinet_40147", "dishwasher_11700", "door_9128", "drawer_cabinet_20279",
    "faucet_1466", "fridge_11178", "laptop_10040", "oven_7138", "trash_can_102181", "window_102906",
)  # fmt: skip
_PARTS = ("trees", "joints", "whole")
_POSES = ("rest", "random-0", "random-1", "random-2")


class PaperOptions(Options):
    """Which objects, in which poses."""

    parts: Annotated[tuple[str, ...], among(_PARTS)] = Field(_PARTS, description="Some of trees, joints, whole.")
    sets: Annotated[tuple[str, ...], among(("robots", "everyday"))] = Field(
        ("robots", "everyday"), description="Some of robots, everyday."
    )
    everyday: tuple[str, ...] = Field(_SAMPLE, description="Names or patterns of everyday objects; * for all.")
    objects: tuple[str, ...] = Field(("*",), description="Names or patterns of objects of these.")
    poses: Annotated[tuple[str, ...], among(_POSES)] = Field(_POSES, description="Poses of trees.")
    whole_poses: Annotated[tuple[str, ...], among(_POSES)] = Field(("rest",), description="Poses of whole objects.")
    seed: int = Field(0, description="Draws the errors of the oracles.")
    sdf: Literal["grid", "neural"] = Field("grid", description="Signed distances of the joints.")


@dataclass(frozen=True, kw_only=True)
class PosedObject:
    """One object in one pose."""

    item: BenchObject
    condition: Condition
    sdf: str
    seed: int


def measure(options: PaperOptions, work: Work) -> Measured:
    """Search the trees and infer whole objects in every pose, and judge the joints of the true tree at rest."""
    sets = {
        name: find_objects(name) if name == "robots" else matching(find_objects(name), options.everyday)
        for name in options.sets
    }
    chosen = {item.name for item in matching([item for found in sets.values() for item in found], options.objects)}
    items = [(name, item) for name, found in sets.items() for item in found if item.name in chosen]
    records: list[Record] = []
    poses_of = {"trees": options.poses, "joints": ("rest",), "whole": options.whole_poses}
    for part, function in (("trees", searched_trees), ("joints", judged_joints), ("whole", inferred_wholes)):
        if part not in options.parts:
            continue
        poses = [item for item in CONDITIONS if item.name in poses_of[part]]
        asked = {
            f"{part}, {item.name}, {pose.name}": PosedObject(
                item=item, condition=pose, sdf=options.sdf, seed=options.seed
            )
            for _, item in items
            for pose in poses
        }
        set_of = {item.name: name for name, item in items}
        for record in work.each(function, asked, timeout=7200.0).values():
            records += [{"part": part, "set": set_of[row["object"]], **row} for row in record["rows"]]
    return records, {}


def field_gaps(assembly: Assembly, config: Config) -> Callable[[Pair], float]:
    """Return the minimum bidirectional distance of a pair [m], 0 where a sample of one lies inside the other.

    Args:
        assembly: The parts, world frame.
        config: `sdf`, `contact.samples` and `seed` are used.
    """
    import torch  # noqa: PLC0415  # takes seconds, and exact gaps do without it

    from kinematify.paper.sdf import field_source  # noqa: PLC0415  # with torch

    field_of = field_source(assembly.parts, config.sdf, seed=config.seed)
    samples = [sample_surface(part, config.contact.samples, config.seed).points for part in assembly.parts]

    def gap(pair: Pair) -> float:
        a, b = pair
        both = ((samples[a], assembly.parts[b]), (samples[b], assembly.parts[a]))
        smallest = min(float(field_of(part).value(torch.from_numpy(points.copy())).min()) for points, part in both)
        return max(smallest, 0.0)

    return gap


def searched_trees(asked: PosedObject) -> Record:
    """The best tree of one object by each set of rules."""
    erased = erased_item(asked.item, asked.condition)
    assembly, true = shown_parts(erased), dict(enumerate(erased.truth.parents))
    root = erased.truth.parents.index(-1)
    base_config = load_config("paper")
    sdf = base_config.sdf.model_copy(update={"kind": asked.sdf})
    by_fields = field_gaps(assembly, base_config.model_copy(update={"sdf": sdf}))
    graphs = {
        "": _contacts(assembly, "proximity"),
        _BY_AREA: _contacts(assembly, "area"),
        _BY_FIELDS: _contacts(assembly, "proximity", by_fields),
    }
    rows = []
    for name in RULES:
        configuration, comma, by = name.partition(", ")
        config, graph = load_config(configuration), graphs[comma + by]
        base = root if config.topology.base_rule == "given" else None
        found = dict(enumerate(find_trees(assembly, graph, {}, config, base=base)[0].parents))
        rows.append({
            "object": asked.item.name,
            "pose": asked.condition.name,
            "rules": name,
            "ted": tree_edit_distance(true, found).value,
            "parents": parent_errors(true, found),
            "wrong": [
                _wrong_parent(assembly, graph, part, true[part], found[part])
                for part in true
                if true[part] != found[part]
            ],
        })  # fmt: skip
    return {"rows": rows}


def _wrong_parent(assembly: Assembly, graph: ContactGraph, part: int, true: int, found: int) -> str:
    """A part that hangs on another one than it should, with the strength of its contact with either."""

    def parent(index: int) -> str:
        edge = graph.by_pair.get((min(part, index), max(part, index)))
        held = "no contact" if edge is None else f"{edge.strength:.3f}"
        return "the base" if index < 0 else f"{assembly.names[index]} ({held})"

    return f"{assembly.names[part]} on {parent(found)}, in truth on {parent(true)}"


def inferred_wholes(asked: PosedObject) -> Record:
    """One object under every configuration."""
    erased = erased_item(asked.item, asked.condition)
    rows = configured(erased, asked.item, sdf=asked.sdf, seed=asked.seed)
    return {"rows": [{"object": asked.item.name, "pose": asked.condition.name, **row} for row in rows]}


def _contacts(assembly: Assembly, strength: str, gap_of: Callable[[Pair], float] | None = None) -> ContactGraph:
    config = load_config("paper")
    surfaces = part_surfaces(assembly, config=config.surface)
    contact = config.contact.model_copy(update={"strength": strength})
    return build_contact_graph(assembly, surfaces, config=contact, seed=config.seed, gap_of=gap_of)


def judged_joints(asked: PosedObject) -> Record:
    """Every joint of the true tree of one object by both objectives."""
    # torch takes seconds to import, and the trees do without it.
    from kinematify.paper.cavl import cavl_scene  # noqa: PLC0415
    from kinematify.paper.sdf import field_source  # noqa: PLC0415

    erased = erased_item(asked.item, asked.condition)
    assembly = shown_parts(erased)
    graph = _contacts(assembly, "proximity")
    base = load_config("paper")
    sdf = base.sdf.model_copy(update={"kind": asked.sdf})
    field_of = field_source(assembly.parts, sdf, seed=base.seed)
    samples = [sample_surface(part, base.joints.samples, base.seed) for part in assembly.parts]
    rows = []
    for name, config in ((name, load_config(file)) for name, file in OBJECTIVES.items()):
        for edge in _edges(erased):
            contact = graph.by_pair.get((min(edge), max(edge)))
            if contact is None:
                continue
            scene = cavl_scene(
                contact,
                parent=edge[0],
                child=edge[1],
                fields=lambda index: field_of(assembly.parts[index]),
                samples=samples,
                diagonal=assembly.diagonal,
                config=config.cavl,
            )
            rows.append({"object": asked.item.name, "objective": name, **_judged(scene, erased, edge, config.cavl)})
    return {"rows": rows}


def _edges(erased: ErasedModel) -> list[tuple[int, int]]:
    """Parent and child of the true joints between parts that have only one."""
    pairs = Counter((joint.parent, joint.child) for joint in erased.truth.joints)
    return [pair for pair, count in pairs.items() if count == 1]


def _judged(scene: CavlScene, erased: ErasedModel, edge: tuple[int, int], config: CavlConfig) -> Record:
    from kinematify.paper.cavl import rank_candidates  # noqa: PLC0415
    from kinematify.paper.joints import estimate_paper_joint, paper_candidates  # noqa: PLC0415

    true = next(joint for joint in erased.truth.joints if (joint.parent, joint.child) == edge)
    seed = load_config("paper").seed
    kind = JointType.PRISMATIC if true.kind is JointType.PRISMATIC else JointType.REVOLUTE
    chosen = estimate_paper_joint(scene, config, seed)[0]
    own = JointCandidate(kind=kind, axis=true.axis, pivot=true.pivot, score=0.0, source="truth")
    (judged,) = rank_candidates(scene.thinned(config.refine_points), [own], config)
    pool = [item for item in paper_candidates(scene.contact, scene.diagonal, config, seed) if item.kind is kind]
    angle = axis_angle(chosen.axis, true.axis)
    wrong = chosen.kind is not kind or angle > WRONG_DEG
    # The pivot's share of J is omitted: where on its line the true pivot stands is a convention.
    costs = {
        name: item.evidence["cavl_objective"] - config.pivot_weight * item.evidence["cavl_offset"]
        for name, item in (("true", judged), ("chosen", chosen))
    }
    near = any(axis_angle(item.axis, true.axis) < WRONG_DEG for item in pool)
    fault = "objective" if costs["true"] > costs["chosen"] else "optimiser" if near else "pool"
    return {
        "joint": true.name,
        "kind": str(kind),
        "chosen_kind": str(chosen.kind),
        "angle_deg": angle,
        "j_true": costs["true"],
        "j_chosen": costs["chosen"],
        "fault": fault if wrong else "",
    }


def report(found: Report[Record]) -> list[str]:
    """Trees by rules, joints by objective, and every wrong joint with what is at fault."""
    parts = grouped(found.records, by=itemgetter("part"))
    blocks = [explained(__doc__)]
    if "trees" in parts:
        titles = ("set", "rules", "objects and poses", "TED", "wrong parents", "TED 0")
        rows = [
            _tree_row(name, rules, records)
            for name, own in grouped(parts["trees"], by=itemgetter("set")).items()
            for rules, records in grouped(own, by=itemgetter("rules")).items()
        ]
        blocks += ["## Trees", table(titles, rows), "### Trees that are not right under `paper-open`"]
        wrong = [row for row in parts["trees"] if row["rules"] == "paper-open" and row["ted"] > 0]
        blocks.append(
            "\n".join(
                f"- {row['object']}, {row['pose']}: TED {row['ted']:g}; {'; '.join(row['wrong'])}" for row in wrong
            )
            or "None."
        )
    if "joints" in parts:
        heads = ("set", "objective", "joints", "axis angle [deg]", "types", "objective", "pool", "optimiser")
        rows = [
            _joint_row(name, objective, records)
            for name, own in grouped(parts["joints"], by=itemgetter("set")).items()
            for objective, records in grouped(own, by=itemgetter("objective")).items()
        ]
        own = ("chosen", "angle [deg]", "J(true)", "J(chosen)", "at fault")
        titles_of_joints = (
            "object", "joint", "true", *own, *(f"{title}, {list(OBJECTIVES)[1]}" for title in own),
        )  # fmt: skip
        by_joint = grouped(parts["joints"], by=itemgetter("object", "joint")).values()
        blocks += [
            "## Joints, the true tree given",
            "Axis angle: mean over an object's joints, then over objects. The last three columns count wrong joints.",
            table(heads, rows),
            "### J(true) and J(chosen) of every joint",
            table(titles_of_joints, [_judged_row(judged) for judged in by_joint]),
        ]
    if "whole" in parts:
        blocks += ["## Whole objects", *_wholes(parts["whole"])]
    return blocks


def _wholes(rows: Sequence[Record]) -> list[str]:
    """Full configurations by who gives the types, then the ablations beside the paper's own figures."""
    heads = ("set", "rules", "types by", "objects", "axis angle [deg]", "matched [deg]", "pivot [m]", "TED", "types")
    full = [row for row in rows if not row["without"]]
    own = [row for row in rows if row["types_by"] == OWN]
    wholes = [
        (name, rules, oracle, *_whole_figures(records))
        for name, found in grouped(full, by=itemgetter("set")).items()
        for (rules, oracle), records in grouped(found, by=itemgetter("rules", "types_by")).items()
    ]
    ablated = [
        (name, rules, without or "-", *_whole_figures(records))
        for name, found in grouped(own, by=itemgetter("set")).items()
        for (rules, without), records in grouped(found, by=itemgetter("rules", "without")).items()
    ]
    six, everyday = mean_over_robots(), TABLE_I["everyday"]
    printed = (
        f"The paper: robots {six.angle_deg:.1f} deg, {six.position_m:.2f} m, TED {six.ted:.2f}; everyday objects "
        f"{everyday.angle_deg:.1f} deg, {everyday.position_m:.2f} m, TED {everyday.ted:.2f}."
    )
    ablations = [
        f"{label}: " + ", ".join(f"{name} {row[0]:.1f} deg, TED {row[2]:.2f}" for name, row in figures.items())
        for label, figures in ABLATION.items()
    ]
    return [
        table(heads, wholes),
        printed,
        "### Without MCTS, without DW-CAVL",
        table((*heads[:2], "left out", *heads[3:]), ablated),
        f"The paper: {'; '.join(ablations)}.",
    ]


def _whole_figures(records: Sequence[Record]) -> tuple[str, ...]:
    """Means over objects and poses, each with all its joints."""

    def mean(name: str, form: str) -> str:
        values = [row[name] for row in records if row[name] is not None]
        return format(fmean(values), form) if values else "-"

    return (
        str(len(records)),
        mean("angle_deg", ".1f"),
        mean("angle_matched_deg", ".1f"),
        mean("pivot_m", ".2f"),
        mean("ted", ".2f"),
        mean("types", ".1%"),
    )


def _tree_row(name: str, rules: str, records: Sequence[Record]) -> tuple[str, ...]:
    return (
        name,
        rules,
        str(len(records)),
        f"{fmean(row['ted'] for row in records):.2f}",
        str(sum(row["parents"] for row in records)),
        f"{sum(row['ted'] == 0 for row in records)} of {len(records)}",
    )


def _joint_row(name: str, objective: str, records: Sequence[Record]) -> tuple[str, ...]:
    objects = grouped(records, by=itemgetter("object")).values()
    faults = Counter(row["fault"] for row in records)
    return (
        name,
        objective,
        str(len(records)),
        f"{fmean(fmean(row['angle_deg'] for row in rows) for rows in objects):.1f}",
        f"{fmean(row['kind'] == row['chosen_kind'] for row in records):.1%}",
        *(str(faults[fault]) for fault in ("objective", "pool", "optimiser")),
    )


def _judged_row(judged: Sequence[Record]) -> tuple[str, ...]:
    """One joint by either objective."""
    cells = [
        (
            row["chosen_kind"],
            f"{row['angle_deg']:.1f}",
            f"{row['j_true']:.3g}",
            f"{row['j_chosen']:.3g}",
            row["fault"] or "-",
        )
        for row in judged
    ]
    return judged[0]["object"], judged[0]["joint"], judged[0]["kind"], *(text for row in cells for text in row)


STUDY = Study(title="The paper's rewards and DW-CAVL", options=PaperOptions, measure=measure, report=report)
