"""KV145 and KV305: the SRDF beside the file, whether it names what is there and is right about pairs of links."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.robot.urdf_numbers import line_of
from kinematify.validation.check import check
from kinematify.validation.checks.shared import configuration, joints_move
from kinematify.validation.document import finite_numbers
from kinematify.validation.finding import Cause, Severity, not_finished

if TYPE_CHECKING:
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.document import Urdf
    from kinematify.validation.geometry.look import GeometryContext

_NAMED: dict[str, dict[str, tuple[str, ...]]] = {
    "link": {
        "link": ("name",),
        "chain": ("base_link", "tip_link"),
        "disable_collisions": ("link1", "link2"),
        "end_effector": ("parent_link",),
        "virtual_joint": ("child_link",),
    },
    "joint": {"joint": ("name",), "passive_joint": ("name",)},
    "group": {"group_state": ("group",), "end_effector": ("group", "parent_group"), "group": ("name",)},
}
"""Attributes that name a thing of a kind, by element."""
_SHOWN = 6
_SLACK = 1e-3
"""What rounding leaves of a value at a limit [rad or m]."""


@check(
    "KV145",
    title="The SRDF names what is there",
    fails="The SRDF names what is not there",
    severity=Severity.WARNING,
    cause=Cause.ASSET,
    needs=(lambda urdf: None if urdf.srdf else "no SRDF lies beside the file",),
)
def unknown_names(result: OpenCheck, urdf: Urdf) -> None:
    """Links, joints and groups that the SRDF beside the file names are there (in its folder, srdf or config beside it,
    of its name or of its robot's), and its states are within the limits of their joints.

    Why it matters: Planners skip a group, or check pairs that were meant to be skipped, with a line in a log.

    Remedy: Write the names of the URDF, and values within the limits.
    """
    assert urdf.srdf is not None
    robot, path = urdf.srdf.robot, urdf.srdf.path
    virtual = {item.get("name") for item in robot.iterfind("virtual_joint")}
    known: dict[str, set[str | None]] = {
        "link": {*urdf.link_names},
        "joint": {joint.name for joint in urdf.joints}
        | virtual
        | {"root_joint"},  # as Pinocchio calls the one above the root
        "group": {item.get("name") for item in robot.iterfind("group")},
    }
    for kind, places in _NAMED.items():
        used = [(item.get(key), item) for tag, keys in places.items() for item in robot.iter(tag) for key in keys]
        absent = dict.fromkeys(name for name, item in used if name is not None and name not in known[kind])
        if absent:
            listed = ", ".join([*absent][:_SHOWN])
            result.find(
                f"{path.name} names {kind}s that {'it' if kind == 'group' else 'the URDF'} does not have: {listed} "
                f"({len(absent)} in all).",
                f"Write names of {kind}s that are there.",
            )
    limits = {joint.name: joint.element.find("limit") for joint in urdf.joints}
    for item in robot.iterfind("group_state/joint"):
        limit = limits.get(item.get("name", ""))
        ends = [] if limit is None else finite_numbers(f"{limit.get('lower', 0)} {limit.get('upper', 0)}") or []
        values = finite_numbers(item.get("value", "")) or []
        if len(ends) != 2 or len(values) != 1 or ends[0] >= ends[1]:
            continue
        if not ends[0] - _SLACK <= values[0] <= ends[1] + _SLACK:
            result.find(
                f"A state of {path.name} has {item.get('name')} at {values[0]:g}, outside of its range "
                f"{ends[0]:g} to {ends[1]:g} (line {line_of(item)}).",
                "Write a value within the limits, or correct the limits.",
                joint=item.get("name"),
            )


@check(
    "KV305",
    title="The SRDF is right about pairs that never meet",
    fails="The SRDF leaves out pairs that do meet",
    severity=Severity.WARNING,
    cause=Cause.ASSET,
    needs=(
        joints_move,
        lambda look: None if look.disabled else "no SRDF beside the file leaves a pair out",
        lambda look: not_finished("time ran out before it") if look.random is None else None,
    ),
)
def wrong_reasons(result: OpenCheck, look: GeometryContext) -> None:
    """Pairs that the SRDF leaves out as pairs that never meet (`reason="Never"`), or as neighbours (`"Adjacent"`)
    though other bodies are between them, do not meet in one of geometry.random_rows quasi-random configurations. Of
    pairs that it leaves out, overlaps at rest (KV301, KV302) are notes, and meetings (KV311) are not mentioned.

    Why it matters: A planner drives the two through each other.

    Remedy: Delete the line, or correct the collision geometry of the two.
    """
    assert look.random is not None
    rows = look.random.rows
    for pair, hits in zip(look.scene.pairs, look.random.meeting.T, strict=True):
        values = dict(enumerate(rows[hits.argmax()].tolist()))
        links = look.links_at(pair, values) if hits.any() else ("", "")
        reason = look.disabled.get(frozenset(links))
        if reason == "Never" or (reason == "Adjacent" and pair not in look.scene.connection_of):
            result.find(
                f"The SRDF leaves out {links[0]} and {links[1]} (reason {reason!r}); they meet in {hits.sum()} of "
                f"{len(rows)} quasi-random configurations.",
                "Delete its disable_collisions of the two, or correct their collision geometry.",
                pair=links,
                q=configuration(look.scene, values),
            )
