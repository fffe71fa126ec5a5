"""Pieces that nobody segmented become rigid parts, with how sure each is, and the file in which that is corrected."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.assembly.assemble import part_names
from kinematify.assembly.part import Assembly, Part
from kinematify.errors import AssemblyError, InputError
from kinematify.grouping.numbered_pieces import BODY, MOST_NUMBERS, evidence, few_numbers
from kinematify.grouping.pair_measurements import measure_pieces
from kinematify.grouping.piece_sets import Candidate, alike, measure_candidates, node_of_pieces, propose
from kinematify.joints.candidate import JointEstimate, JointType
from kinematify.joints.choice.scorer import MOVING_WEIGHTS, PIECES_WEIGHTS, shipped_scorer
from kinematify.robot.appearance import joined
from kinematify.robot.exact_faces import joined_faces
from kinematify.robot.vectors import as_one, lengths_of

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence
    from pathlib import Path

    from kinematify.config import GroupingConfig
    from kinematify.grouping.numbered_pieces import NamedPart
    from kinematify.joints.choice.scorer import Scorer
    from kinematify.robot.arrays import FloatArray, IntArray

GROUPS_FILE = "groups.json"
"""Beside the model of an unsegmented mesh: the pieces of every part."""
_SCHEMA = 1


@dataclass(frozen=True, kw_only=True)
class Group:
    """Pieces that are one rigid part."""

    name: str
    """Of the part: that of its largest piece."""
    pieces: tuple[str, ...]
    moves: float | None = None
    """How likely they are one moving part; None for what is left when all moving parts are found, and where the user
    said it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Grouping:
    """Rigid parts made of pieces."""

    assembly: Assembly
    """One part per group."""
    groups: tuple[Group, ...]
    """In the order of the parts."""
    rejected: tuple[Group, ...] = ()
    """The likeliest sets of pieces that were not taken for moving parts, the likeliest first."""
    doubtful: tuple[tuple[int, IntArray], ...] = ()
    """Groups with a piece of the body that may be of them: index of the group, and of this piece, with what rides on
    it, in `pieces`."""
    pieces: Assembly | None = None
    """What was grouped, where there are doubtful pieces."""

    @property
    def messages(self) -> tuple[str, ...]:
        """Return what was made of the pieces, one sentence each."""
        count = sum(len(group.pieces) for group in self.groups)
        doubtful = [_said(group) for group in self.groups if group.moves is not None and group.moves < _DOUBTFUL]
        said = [f"The mesh is not segmented: {count} pieces were grouped into {len(self.groups)} rigid parts."]
        if doubtful:
            said.append(f"Parts that may not move: {', '.join(doubtful[:_MOST_NAMED])}.")
        if self.rejected:
            said.append(
                f"Pieces that may move but were left fixed: {', '.join(map(_said, self.rejected[:_MOST_NAMED]))}."
            )
        said.append(
            "If a part is wrong, click its pieces in `kinematify view MESH`, show `kinematify question MESH` to a chat "
            f"that reads pictures, or edit {GROUPS_FILE} and give it with --groups."
        )
        return tuple(said)

    def record(self) -> dict[str, Any]:
        """The grouping as JSON values."""
        parts, rejected = (
            [{"name": group.name, "pieces": list(group.pieces), "moves": group.moves} for group in groups]
            for groups in (self.groups, self.rejected)
        )
        return {"schema": _SCHEMA, "parts": parts, "rejected": rejected}

    def to_json(self) -> str:
        """Return the text of the groups file."""
        return json.dumps(self.record(), indent=1) + "\n"


def stated_groups(record: dict[str, Any], key: str) -> tuple[Group, ...]:
    """The groups under `key`, ``parts`` or ``rejected``, of what `Grouping.record` made; none where nobody grouped."""
    stated = (record.get("groups") or {}).get(key, ())
    return tuple(Group(name=item["name"], pieces=tuple(item["pieces"]), moves=item["moves"]) for item in stated)


def _said(group: Group) -> str:
    count = len(group.pieces)
    return f"{group.name} ({count} pieces)" if count > 1 else group.name


_DOUBTFUL = 0.7
_MOST_MEASURED = 300
"""Pieces whose pairs are judged before they are numbered; of more, small ones follow the nearest large one."""
_WHOLE_NODES = 3.0
"""Log odds by which a set of whole nodes is likelier than one of their pieces (results/grouping.md)."""
_LIKELY = 0.25
"""Rejected sets that are likelier than this are named."""
_MOST_NAMED = 8


@dataclass(frozen=True, kw_only=True, eq=False)
class PieceWeights:
    """Weights fitted to objects whose parts are known."""

    pairs: Scorer
    """Which two pieces are one part."""
    moving: Scorer
    """Which sets of pieces are one moving part."""


def shipped_weights() -> PieceWeights:
    """The weights that come with the package."""
    return PieceWeights(pairs=shipped_scorer(PIECES_WEIGHTS), moving=shipped_scorer(MOVING_WEIGHTS))


def group_pieces(
    assembly: Assembly,
    config: GroupingConfig,
    weights: PieceWeights | None = None,
    *,
    named: Sequence[NamedPart] = (),
    trust: float = 0.0,
) -> Grouping:
    """Decide which pieces are one rigid part.

    Args:
        assembly: Pieces, world frame, z up.
        config: How likely a moving part must be, and the size of crumbs.
        weights: Those that ship by default.
        named: Moving parts that somebody named.
        trust: What that is worth beside geometry, from 0 for nothing to 1: it is taken as it is.

    Raises:
        AssemblyError: All pieces are one part.
    """
    if trust >= 1.0:
        return _as_named(assembly, named)
    parts = assembly.parts
    owner = assign_fragments(parts, config.crumb * assembly.diagonal)
    kept = np.flatnonzero(owner == np.arange(len(parts)))
    if len(kept) < 2:
        raise one_part(assembly)
    weights = weights or shipped_weights()
    said = [frozenset(np.flatnonzero(np.isin(kept, part.pieces)).tolist()) for part in named if trust > 0.0]
    candidates, odds, pairs, of_pairs = judged([parts[k] for k in kept], weights, said)
    candidates, odds = alike(candidates, odds, [parts[k] for k in kept])
    node = node_of_pieces([assembly.original_names.get(parts[k].name, "") for k in kept], pairs)
    if node is not None:
        node_of_part = node[np.searchsorted(kept, owner)]
        nodes = joined_pieces(assembly, [np.flatnonzero(node_of_part == k) for k in np.unique(node)])
        sets, of_nodes, *_ = judged(nodes.parts, weights)
        best = dict(zip(candidates, odds, strict=True))
        for members, value in zip(sets, of_nodes + _WHOLE_NODES, strict=True):
            pieces = frozenset(np.flatnonzero(np.isin(node, list(members))).tolist())
            best[pieces] = max(value, best.get(pieces, value))
        candidates, odds = list(best), np.array(list(best.values()))
    source = np.full(len(candidates), -1)
    if said:
        added, source = evidence(
            candidates, said, [part.sure for part in named], np.array([parts[k].area for k in kept])
        )
        odds = odds + trust * added
    likely = 1.0 / (1.0 + np.exp(-odds))
    chosen, rejected = select(candidates, likely, config)
    if not chosen:
        raise one_part(assembly)
    label = np.full(len(parts), -1)
    for number, row in enumerate(chosen):
        label[kept[list(candidates[row])]] = number
    label = label[owner]
    indices = [np.flatnonzero(label == number) for number in range(-1, len(chosen))]
    moves = [None, *(round(float(likely[row]), 3) for row in chosen)]
    names = [None, *(named[source[row]].name if source[row] >= 0 else None for row in chosen)]
    if not len(indices[0]):
        indices, moves, names = indices[1:], moves[1:], names[1:]
    if len(indices) < 2:
        raise one_part(assembly)
    doubtful = {} if node is not None else _doubtful(label[kept], pairs, of_pairs)
    return replace(
        grouped_as(
            pieces_of(assembly),
            indices,
            moves=moves,
            names=[
                name or assembly.names[_main_piece(assembly, index)] for name, index in zip(names, indices, strict=True)
            ],
        ),
        doubtful=tuple((k + 1, np.flatnonzero(owner == kept[piece])) for k, piece in doubtful.items()),
        pieces=assembly if doubtful else None,
        rejected=tuple(
            _group(assembly, kept[sorted(candidates[row])], round(float(likely[row]), 3))
            for row in rejected
            if likely[row] > _LIKELY
        ),
    )


def _as_named(assembly: Assembly, named: Sequence[NamedPart]) -> Grouping:
    """The grouping that somebody stated, the body first."""
    if not named:
        raise one_part(assembly)
    label = np.zeros(len(assembly.parts), dtype=np.int64)
    for number, part in enumerate(named, 1):
        label[part.pieces] = number
    indices = [np.flatnonzero(label == number) for number in range(len(named) + 1)]
    return grouped_as(pieces_of(assembly), indices, names=[BODY, *(part.name for part in named)])


def numbered_pieces(assembly: Assembly, config: GroupingConfig) -> tuple[IntArray, ...]:
    """Indices of the pieces that have one number, by falling area, 60 numbers at most; crumbs follow their piece.

    Args:
        assembly: The pieces.
        config: Size of crumbs.
    """
    parts = assembly.parts
    owner = assign_fragments(parts, config.crumb * assembly.diagonal)
    kept = np.unique(owner)
    number, areas = np.arange(len(kept)), np.array([parts[k].area for k in kept])
    if len(kept) > MOST_NUMBERS:
        pairs, odds = np.empty((0, 2), dtype=np.int64), np.empty(0)
        if len(kept) <= _MOST_MEASURED:
            measured = measure_pieces([parts[k] for k in kept])
            pairs, odds = measured.pairs, odds_of(shipped_weights().pairs, measured.columns, measured.names)
        number = few_numbers(areas, np.array([parts[k].bounds.mean(axis=0) for k in kept]), pairs, odds)
    of_part = number[np.searchsorted(kept, owner)]
    total = np.bincount(number, areas)
    order = sorted(set(number.tolist()), key=lambda k: (-round(total[k] / areas.sum(), 9), k))
    return tuple(np.flatnonzero(of_part == k) for k in order)


def _doubtful(label: IntArray, pairs: IntArray, odds: FloatArray) -> dict[int, int]:
    """The piece of the body that is likeliest one with each chosen set, where that is likelier than not; by the set.

    Args:
        label: Number of the set of every piece, -1 for the body, shape (n,).
        pairs: Neighbours, shape (m, 2).
        odds: Log odds that they are rigidly one, shape (m,).
    """
    found: dict[int, int] = {}
    for row in np.argsort(-odds, kind="stable").tolist():
        piece, other = sorted(pairs[row].tolist(), key=lambda k: int(label[k]))
        own = int(label[other])
        if odds[row] > 0.0 and label[piece] < 0 <= own and own not in found and piece not in found.values():
            found[own] = piece
    return {} if len(found) == int((label < 0).sum()) else found


def pieces_of(assembly: Assembly) -> Grouping:
    """Return the grouping in which every part is a piece of its own."""
    return Grouping(assembly=assembly, groups=tuple(Group(name=name, pieces=(name,)) for name in assembly.names))


def grouped_as(
    grouping: Grouping,
    indices: Sequence[IntArray],
    *,
    names: Sequence[str] | None = None,
    moves: Sequence[float | None] | None = None,
) -> Grouping:
    """Return the grouping with parts that are joined or named otherwise.

    Args:
        grouping: Groups in the order of the parts.
        indices: The parts that become each part.
        names: Of the new parts; without them each has that of its largest one.
        moves: How likely each moves; without them that of a part that stays alone.
    """
    found = joined_pieces(grouping.assembly, indices, names)
    moves = moves or [grouping.groups[index[0]].moves if len(index) == 1 else None for index in indices]
    groups = [
        Group(name=name, pieces=tuple(piece for k in index for piece in grouping.groups[k].pieces), moves=likely)
        for name, index, likely in zip(found.names, indices, moves, strict=True)
    ]
    return replace(grouping, assembly=found, groups=tuple(groups))


def with_doubtful(grouping: Grouping, chosen: Collection[int]) -> Grouping:
    """The grouping in which some groups have their doubtful pieces, which the body loses.

    Args:
        grouping: Groups in the order of their parts, the body first.
        chosen: Indices of these groups.
    """
    if grouping.pieces is None or not chosen:
        return grouping
    index = {name: k for k, name in enumerate(grouping.pieces.names)}
    label = np.empty(len(index), dtype=np.int64)
    for number, group in enumerate(grouping.groups):
        label[[index[name] for name in group.pieces]] = number
    for number, more in grouping.doubtful:
        if number in chosen:
            label[more] = number
    indices = [np.flatnonzero(label == number) for number in range(len(grouping.groups))]
    joined = {grouping.pieces.names[k] for number, more in grouping.doubtful if number in chosen for k in more}
    found = grouped_as(pieces_of(grouping.pieces), indices, moves=[group.moves for group in grouping.groups])
    rejected = tuple(group for group in grouping.rejected if joined.isdisjoint(group.pieces))
    return replace(grouping, assembly=found.assembly, groups=found.groups, rejected=rejected)


def confidence_of(joints: Sequence[JointEstimate], config: GroupingConfig) -> dict[int, float]:
    """Confidence of the joints that move and that are not likelier fixed, by child."""
    return {
        joint.child: joint.confidence
        for joint in joints
        if joint.kind is not JointType.FIXED and joint.evidence.get("probability_fixed", 0.0) <= config.fixed
    }


def judged(
    parts: Sequence[Part], weights: PieceWeights, said: Sequence[Candidate] = ()
) -> tuple[list[Candidate], FloatArray, IntArray, FloatArray]:
    """Sets of pieces that may be a moving part, their log odds, shape (c,); neighbours, shape (m, 2), and theirs.

    Sets that somebody named are judged beside those that geometry proposes.
    """
    measured = measure_pieces(parts)
    odds = odds_of(weights.pairs, measured.columns, measured.names)
    own = (item for item in said if 0 < len(item) < len(parts))
    candidates = list(dict.fromkeys((*propose(measured, odds), *own)))
    if not candidates:
        return [], np.empty(0), measured.pairs, odds
    areas = np.array([part.area for part in parts])
    columns, names = measure_candidates(measured, odds, areas, candidates)
    return candidates, odds_of(weights.moving, columns, names), measured.pairs, odds


def odds_of(scorer: Scorer, columns: FloatArray, names: tuple[str, ...]) -> FloatArray:
    """Log odds that fitted trees give to rows of named columns, shape (n,)."""
    place = [names.index(name) for name in scorer.measurements]
    return scorer.sums(columns[:, place].astype(np.float32)).astype(np.float64)


def select(candidates: Sequence[Candidate], likely: FloatArray, config: GroupingConfig) -> tuple[list[int], list[int]]:
    """Disjoint candidates that move, and the likeliest others that are disjoint from them; each the likeliest first.

    Those move that together have the most probability above the least one that a moving part must have: a packing of
    sets by an integer programme, so that one wide set does not displace two narrow ones that are as likely.

    Args:
        candidates: Sets of pieces.
        likely: How likely each is a moving part, shape (c,).
        config: How likely a set must be, absolutely and beside the likeliest one.
    """
    order = np.argsort(-likely, kind="stable")
    least = max(config.threshold, config.share * float(likely.max(initial=0.0)))
    able = [row for row in order.tolist() if likely[row] > least]
    chosen = able[:1]
    if len(able) > 1:
        member = np.array([[piece in candidates[row] for row in able] for piece in set().union(*candidates)])
        from scipy.optimize import Bounds, LinearConstraint, milp  # noqa: PLC0415  # only grouping needs it

        packing = LinearConstraint(member.astype(np.float64), ub=1.0)
        found = milp(least - likely[able], constraints=packing, integrality=1, bounds=Bounds(0.0, 1.0))
        chosen = [row for row, taken in zip(able, found.x, strict=True) if taken > 0.5]
    taken, rejected = set[int]().union(*(candidates[row] for row in chosen)), list[int]()
    for row in order.tolist():
        if taken.isdisjoint(candidates[row]):
            taken |= candidates[row]
            rejected.append(row)
    return chosen, rejected


def fixed_merged(grouping: Grouping, joints: Sequence[JointEstimate], config: GroupingConfig) -> Grouping:
    """Merge every group that is likelier fixed to its parent than not into that parent; one that moves is kept.

    Args:
        grouping: The groups; those that a user stated are left alone.
        joints: Inferred between them, parents first.
        config: How likely a group must be fixed.
    """
    groups, owner = grouping.groups, np.arange(len(grouping.groups))
    for joint in joints:
        likely = joint.evidence.get("probability_fixed", 0.0)
        if groups[joint.child].moves is not None and likely > config.fixed:
            owner[joint.child] = owner[joint.parent]
    kept = np.unique(owner)
    if not 1 < len(kept) < len(groups):
        return grouping
    indices = [np.flatnonzero(owner == k) for k in kept]
    gone = [group for group, k in zip(groups, owner, strict=True) if groups[k] is not group]
    return replace(
        grouped_as(grouping, indices, moves=[groups[k].moves for k in kept]),
        rejected=(*sorted(gone, key=lambda group: -(group.moves or 0.0)), *grouping.rejected),
        doubtful=(),
        pieces=None,
    )


def unsure(grouping: Grouping, joints: Sequence[JointEstimate], config: GroupingConfig) -> tuple[str, ...]:
    """A warning where no joint of a mesh that was grouped here is sure: held out, no such object had a right joint.

    Args:
        grouping: The groups; where a user stated them, there is no warning.
        joints: Inferred between them.
        config: How sure the surest one must be.
    """
    surest = max((joint.confidence for joint in joints if joint.kind is not JointType.FIXED), default=0.0)
    if surest >= config.sure or all(group.moves is None for group in grouping.groups):
        return ()
    said = (
        "No joint of the grouped mesh is sure. The object may be rigid, or its parts may not consist of whole pieces: "
        f"edit {GROUPS_FILE}, or give --labels."
    )
    return (said,)


def assign_fragments(parts: Sequence[Part], size: float) -> IntArray:
    """Piece that each piece rides on: itself, or the nearest larger one where its diagonal is below `size` [m].

    Args:
        parts: The pieces.
        size: Screws, letters and slivers are smaller.
    """
    owner = np.arange(len(parts))
    diagonals = np.array([part.diagonal for part in parts])
    large = np.flatnonzero(diagonals >= size).tolist()
    if not large:
        return np.full(len(parts), int(diagonals.argmax()))
    low = np.array([parts[k].bounds[0] for k in large])
    high = np.array([parts[k].bounds[1] for k in large])
    for k in np.flatnonzero(diagonals < size).tolist():
        middle = parts[k].bounds.mean(axis=0)
        gaps = lengths_of(np.maximum(np.maximum(low - middle, middle - high), 0.0))
        near = np.flatnonzero(gaps <= gaps.min() + size).tolist()
        reach = [float(lengths_of(parts[large[n]].vertices - middle).min()) for n in near]
        owner[k] = large[near[int(np.argmin(reach))]]
    return owner


def _group(assembly: Assembly, index: IntArray, moves: float | None) -> Group:
    return Group(
        name=assembly.names[_main_piece(assembly, index)], pieces=tuple(assembly.names[k] for k in index), moves=moves
    )


def one_part(assembly: Assembly) -> AssemblyError:
    """The error for a mesh of which no part moves."""
    return AssemblyError(
        f"The {len(assembly.parts)} pieces of {assembly.source} look like one rigid part. If parts of it move, give "
        "--groups or --labels, --pieces cut if they are drawn on its surface, or --pieces keep if every piece is one."
    )


def joined_pieces(assembly: Assembly, groups: Sequence[IntArray], names: Sequence[str] | None = None) -> Assembly:
    """The assembly with each group of pieces as one part, named after its largest piece or as `names` say."""
    wanted = names or [assembly.names[_main_piece(assembly, group)] for group in groups]
    own = part_names(wanted)
    parts = tuple(
        _joined([assembly.parts[k] for k in group], name, assembly.parts[_main_piece(assembly, group)])
        for group, name in zip(groups, own, strict=True)
    )
    originals = {}
    for part, group in zip(parts, groups, strict=True):
        if any(assembly.names[k] in assembly.originals for k in group):
            whole = [assembly.originals.get(assembly.names[k], assembly.parts[k]) for k in group]
            originals[part.name] = _joined(whole, part.name, part)
    into = {assembly.names[k]: part.name for part, group in zip(parts, groups, strict=True) for k in group}
    return replace(
        assembly,
        parts=parts,
        set_aside=tuple(replace(item, nearest=into[item.nearest]) for item in assembly.set_aside),
        originals=originals,
        segmented=True,
        original_names={**dict(zip(own, names or own, strict=True)), **assembly.original_names},
    )


def _main_piece(assembly: Assembly, group: IntArray) -> int:
    """The largest piece, or the first one of its node: that one has the name of the node."""
    largest = int(max(group, key=lambda k: (assembly.parts[k].area, -k)))
    node = assembly.original_names.get(assembly.names[largest])
    return next((int(k) for k in group if assembly.names[k] == node), largest)


def _joined(pieces: Sequence[Part], name: str, main: Part) -> Part:
    if len(pieces) == 1:
        return replace(pieces[0], name=name)
    vertices, faces = as_one((piece.vertices, piece.faces) for piece in pieces)
    return Part(
        name=name,
        vertices=vertices,
        faces=faces,
        color=main.color,
        appearance=joined([piece.appearance for piece in pieces], [len(piece.faces) for piece in pieces]),
        density=main.density,
        exact=joined_faces([piece.exact for piece in pieces]),
    )


# ---- the file ------------------------------------------------------------------------------------------------------


def read_groups(path: Path, assembly: Assembly) -> Grouping:
    """Group pieces as a groups file says; pieces that it does not name are parts of their own.

    Args:
        path: What `Grouping.to_json` wrote, perhaps edited: ``{"parts": [{"name": ..., "pieces": [...]}]}``; the
            names become those of the links.
        assembly: The pieces.

    Raises:
        InputError: The file cannot be read, or names a piece twice or one that does not exist.
    """
    try:
        stated = json.loads(path.read_text(encoding="utf-8"))
        groups = [tuple(map(str, part["pieces"])) for part in stated["parts"] if part["pieces"]]
        given = {group[0]: part.get("name") for part in stated["parts"] if (group := part["pieces"])}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(
            f"The groups {path} cannot be read ({error!r}). Expected is JSON as in the {GROUPS_FILE} of a model: "
            '{"parts": [{"pieces": ["piece_000", "piece_004"]}]}.'
        ) from error
    index = {name: k for k, name in enumerate(assembly.names)}
    names = [name for group in groups for name in group]
    unknown = [name for name in dict.fromkeys(names) if name not in index]
    twice = [name for name in dict.fromkeys(names) if names.count(name) > 1]
    if unknown or twice:
        wrong = f"names {unknown[0]}, which is no piece" if unknown else f"names {twice[0]} twice"
        raise InputError(
            f"The file {path} {wrong} of {assembly.source}. It has {len(index)} pieces, from {assembly.names[0]} to "
            f"{assembly.names[-1]}; each belongs to one part. Give the --pieces with which the file was made."
        )
    groups += [(name,) for name in assembly.names if name not in set(names)]
    groups.sort(key=lambda group: min(index[name] for name in group))
    if len(groups) < 2:
        raise one_part(assembly)
    indices = [np.array(sorted(index[name] for name in group)) for group in groups]
    named = [
        str(given.get(group[0]) or assembly.names[_main_piece(assembly, k)])
        for group, k in zip(groups, indices, strict=True)
    ]
    return grouped_as(pieces_of(assembly), indices, names=named)
