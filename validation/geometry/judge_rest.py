"""KV301 to KV304: what the model looks like at rest, and which overlaps are tolerated from then on."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.rest import Reason
from kinematify.validation.finding import Blame, Severity
from kinematify.validation.geometry.remark import SLIMMER, UNSEEN, Remark, configuration, in_document_order, length
from kinematify.validation.report import PairSummary, PairTable

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from kinematify.geometry.overlap import Overlap
    from kinematify.geometry.rest import Allowance, AtRest
    from kinematify.geometry.scene import Pair, Scene
    from kinematify.geometry.sweep import JointSweep
    from kinematify.geometry.together import Configurations


def strangers(scene: Scene, allowance: Allowance, visible: Allowance | None) -> Iterator[Remark]:
    """KV301: bodies that no joint joins, in one another at rest."""
    limit = scene.settings.rest_overlap * scene.size
    for rest in allowance.pairs.values():
        if not rest.joined and rest.depth > limit:
            message = f"{_how(scene, rest)} at rest, and no joint joins them."
            yield _overlapping(scene, rest, limit, message, seen=_seen(visible, rest))


def neighbours(scene: Scene, overlap: Overlap, allowance: Allowance, visible: Allowance | None) -> Iterator[Remark]:
    """KV302: parent and child in one another at rest."""
    for rest in allowance.pairs.values():
        limit = scene.settings.rest_joined * min(solid.size for solid in overlap.solids(rest.pair))
        if rest.joined and rest.depth > limit:
            joint = scene.connection_of[rest.pair].joints[-1]
            message = f"{_how(scene, rest)} at rest; the joint {joint} joins them."
            yield _overlapping(scene, rest, limit, message, joint=joint, seen=_seen(visible, rest))


def _seen(visible: Allowance | None, rest: AtRest) -> float:
    """How deep the visible geometry is in each other [m]."""
    return rest.depth if visible is None else visible.at_rest(rest.pair)


def _how(scene: Scene, rest: AtRest) -> str:
    first, second = in_document_order(scene, rest.pair)
    if rest.contained:
        return f"One of {first} and {second} is inside the other one, {length(rest.depth)} deep,"
    return f"{first} and {second} overlap by {length(rest.depth)}"


def _overlapping(
    scene: Scene, rest: AtRest, limit: float, message: str, *, joint: str | None = None, seen: float
) -> Remark:
    unseen = seen <= limit
    wrong = joint is None and min(rest.depth, seen) > scene.settings.wrong * scene.size
    return Remark(
        message=f"{message} {UNSEEN}" if unseen else message,
        remedy=SLIMMER
        if unseen
        else "Correct the mesh or its <origin>, or cut the parts so that they only touch; the overlap is tolerated "
        "in all later checks.",
        blame=Blame.PHYSICS if unseen else None,
        severity=Severity.ERROR if wrong else Severity.WARNING,
        joint=joint,
        pair=in_document_order(scene, rest.pair),
        q=configuration(scene, {}),
        value=rest.depth,
        limit=limit,
        unit="m",
    )


def hovering(scene: Scene, allowance: Allowance) -> Iterator[Remark]:
    """KV303: a part that does not touch what carries it."""
    limit = scene.settings.hover * scene.size
    for connection in scene.connections:
        if allowance.hovers(connection.pair, limit):
            gap = allowance.gap(connection.pair)
            parent, child = scene.bodies[connection.parent].name, scene.bodies[connection.child].name
            yield Remark(
                message=f"{child} is {length(gap)} away from {parent}, on which the joint {connection.joints[-1]} "
                "hangs it: nothing is seen to carry it.",
                remedy="Check the joint's <parent> and <origin>; if the bearing is not modelled, accept it.",
                joint=connection.joints[-1],
                pair=in_document_order(scene, connection.pair),
                q=configuration(scene, {}),
                value=gap,
                limit=limit,
                unit="m",
            )


def allowed_pairs(scene: Scene, allowance: Allowance, random: Configurations | None) -> dict[Pair, Reason]:
    """Return pairs whose contact later checks do not count, with the reason."""
    reasons = {
        pair: Reason.ADJACENT if rest.joined else Reason.AT_REST
        for pair, rest in allowance.pairs.items()
        if rest.collide or rest.depth > 0.0
    }
    if random is not None:
        share = random.touching.mean(axis=0)
        for column in np.flatnonzero(share > scene.settings.always).tolist():
            reasons.setdefault(scene.pairs[column], Reason.ALWAYS)
    return reasons


def allowed_table(scene: Scene, allowance: Allowance, reasons: dict[Pair, Reason]) -> Iterator[Remark]:
    """KV304: one note per reason, one for links that are fixed together, one for stand-ins."""
    by_reason: dict[Reason, list[Pair]] = defaultdict(list)
    for pair, reason in reasons.items():
        by_reason[reason].append(pair)
    for reason, pairs in by_reason.items():
        pairs.sort(key=allowance.at_rest, reverse=True)
        yield _note(
            f"Pairs that are {reason.value} ({len(pairs)}); this much overlap is tolerated, and more is reported: "
            + _listed([_tolerated(scene, allowance, pair) for pair in pairs], scene.settings.listed),
            "Nothing to do; the table says what later checks do not report.",
        )
    links = scene.model.link_by_name
    solid = [[name for name in body.links if links[name].has_geometry] for body in scene.bodies]
    fixed = [names for names in solid if len(names) > 1]
    if fixed:
        yield _note(
            "Links that fixed joints hold together are one body and not held against each other: "
            + _listed([", ".join(names) for names in fixed], scene.settings.listed, sign="; "),
            "Nothing to do.",
        )
    if scene.stand_ins:
        yield _note(
            f"{len(scene.stand_ins)} links have no collision geometry; their visual geometry is judged instead: "
            + _listed(list(scene.stand_ins), scene.settings.listed),
            "Write <collision> elements; engines see nothing there.",
        )


def pair_table(
    scene: Scene, allowance: Allowance, reasons: Mapping[Pair, Reason], sweeps: Sequence[JointSweep]
) -> PairTable:
    """Return what is known of every pair that touches at rest or meets while one joint moves."""
    meets: dict[Pair, list[tuple[str, float, float]]] = defaultdict(list)
    for sweep in sweeps:
        for meeting in (meeting for side in sweep.sides for meeting in side.meetings if meeting.inside):
            meets[meeting.pair].append((sweep.travel.joint, meeting.first, meeting.depth))
    return PairTable(
        bodies=tuple(body.name for body in scene.bodies),
        pairs=tuple(
            PairSummary(
                pair=in_document_order(scene, pair),
                reason=reasons[pair].value if pair in reasons else None,
                at_rest=allowance.at_rest(pair),
                tolerated=allowance.at_rest(pair) + allowance.tolerance(pair),
                meets=tuple(meets.get(pair, ())),
            )
            for pair in sorted({*reasons, *meets})
        ),
    )


def _tolerated(scene: Scene, allowance: Allowance, pair: Pair) -> str:
    first, second = in_document_order(scene, pair)
    return f"{first} - {second} ({length(allowance.at_rest(pair) + allowance.tolerance(pair))})"


def _note(message: str, remedy: str) -> Remark:
    return Remark(message=message + ".", remedy=remedy, severity=Severity.NOTE)


def _listed(names: list[str], most: int, sign: str = ", ") -> str:
    """The first names, and how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return sign.join(names[:most]) + more
