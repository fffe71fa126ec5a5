"""KV330 and KV331: joints that get in each other's way; notes, for planners and people keep them apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.finding import Severity
from kinematify.validation.geometry.remark import Remark, configuration, in_document_order, joint_value

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.geometry.scene import Scene
    from kinematify.geometry.together import Configurations, JointPair


def in_each_others_way(scene: Scene, found: Sequence[JointPair]) -> Iterator[Remark]:
    """KV330: the pairs of joints that meet most often, one note each, and how many more there are."""
    ranked = sorted(found, key=lambda item: -item.share)
    for item in ranked[: scene.settings.listed]:
        first, second = in_document_order(scene, item.pair)
        travels = [scene.travels[leader] for leader in item.leaders]
        where = " and ".join(
            f"{travel.joint} at {joint_value(value, turns=travel.turns)}"
            for travel, value in zip(travels, item.values, strict=True)
        )
        yield Remark(
            message=f"{first} and {second} meet in {item.share:.0%} of the combinations of these two joints, though "
            f"neither of them alone brings them together: for example {where}.",
            remedy="Nothing to do; a planner must keep them apart.",
            severity=Severity.NOTE,
            joint=travels[0].joint,
            pair=(first, second),
            q=configuration(scene, dict(zip(item.leaders, item.values, strict=True))),
            value=item.share,
        )
    if len(ranked) > scene.settings.listed:
        more = len(ranked) - scene.settings.listed
        yield Remark(
            message=f"{more} more pairs of bodies meet when two joints move.",
            remedy="Nothing to do.",
            severity=Severity.NOTE,
        )


def free_configurations(scene: Scene, random: Configurations) -> Iterator[Remark]:
    """KV331: how much of the space of all joints is free, and which pair takes most of it."""
    hit = random.meeting.any(axis=1)
    if not hit.any():
        return
    share = random.meeting.mean(axis=0)
    column = int(share.argmax())
    first, second = in_document_order(scene, scene.pairs[column])
    row = int(random.meeting[:, column].argmax())
    none = bool(hit.all())
    yield Remark(
        message=f"{(~hit).sum()} of {hit.size} quasi-random configurations are free of self-collision; most often, in "
        f"{share[column]:.0%}, {first} and {second} meet.",
        remedy="A model that can hardly move without self-collision has wrong limits or a wrong parent."
        if none
        else "Nothing to do; planners must check self-collision.",
        severity=Severity.WARNING if none else Severity.NOTE,
        pair=(first, second),
        q=configuration(scene, dict(enumerate(random.rows[row].tolist()))),
        value=float((~hit).mean()),
    )
