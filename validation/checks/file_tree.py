"""KV120 to KV128: one tree of links, and mimic joints that end at a leader."""

from __future__ import annotations

import difflib
from collections import defaultdict
from typing import TYPE_CHECKING

from kinematify.robot.urdf_numbers import line_of
from kinematify.validation.check import check
from kinematify.validation.document import shown
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from lxml.etree import _Element

    from kinematify.robot.urdf_numbers import JointElement
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.document import Urdf

_SHOWN = 8


@check("KV120", title="There are links", fails="There is no link", severity=Severity.ERROR, cause=Cause.ASSET)
def no_links(result: OpenCheck, urdf: Urdf) -> None:
    """The <robot> has at least one <link>.

    Why it matters: An empty model proves nothing.

    Remedy: Give a URDF with at least one link.
    """
    if not urdf.links:
        result.find(
            "The file holds no link, so there is nothing to move and nothing to look at.",
            "Give a URDF with at least one link.",
            line=line_of(urdf.robot),
        )


@check(
    "KV121",
    title="Parents and children exist",
    fails="A parent or child does not exist",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def dangling_ends(result: OpenCheck, urdf: Urdf) -> None:
    """Every joint names a parent and a child, and both are links of the file.

    Why it matters: Readers stop, or drop the joint with all that hangs on it.

    Remedy: Correct the name of the link.
    """
    known = set(urdf.link_names)
    for joint in urdf.joints:
        for tag, link in (("parent", joint.parent), ("child", joint.child)):
            if not link:
                result.find(
                    f"The joint {joint.name} names no {tag} link.",
                    f'Add <{tag} link="..."/>.',
                    joint=joint.name,
                    line=line_of(joint.element),
                )
            elif link not in known:
                result.find(
                    f"The {tag} of the joint {joint.name} is the link {shown(link)}, which is not there.",
                    _suggestion(link, known, "link"),
                    joint=joint.name,
                    line=_line(joint, tag),
                )


@check(
    "KV122",
    title="Parent and child differ",
    fails="A joint joins a link to itself",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def self_joined(result: OpenCheck, urdf: Urdf) -> None:
    """No joint joins a link to itself.

    Why it matters: PyBullet crashes with such a joint.

    Remedy: Name two different links.
    """
    for joint in urdf.joints:
        if joint.parent and joint.parent == joint.child:
            result.find(
                f"The joint {joint.name} joins the link {joint.child} to itself; PyBullet crashes with this.",
                "Name two different links.",
                joint=joint.name,
                link=joint.child,
                line=_line(joint, "child"),
            )


@check(
    "KV123",
    title="Each link has one parent",
    fails="A link has two parents",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def second_parents(result: OpenCheck, urdf: Urdf) -> None:
    """No link is the child of two joints.

    Why it matters: A URDF is a tree; readers keep one of the joints, not always the same.

    Remedy: Cut one of the joints.
    """
    carriers: dict[str, list[JointElement]] = defaultdict(list)
    for edge in urdf.edges:
        carriers[edge.child].append(edge)
    for link, joints in carriers.items():
        if len(joints) > 1:
            names = ", ".join(joint.name for joint in joints[:_SHOWN])
            result.find(
                f"The link {link} hangs on {len(joints)} joints ({names}); in a URDF a link has one parent.",
                "Cut all but one of them. Closed chains need a constraint of the simulator beside the URDF.",
                joint=joints[1].name,
                link=link,
                value=len(joints),
                limit=1,
                line=_line(joints[1], "child"),
            )


@check(
    "KV124", title="No circle of links", fails="Links form a circle", severity=Severity.ERROR, cause=Cause.KINEMATICS
)
def cycles(result: OpenCheck, urdf: Urdf) -> None:
    """Following joints downward never leads back to a link above.

    Why it matters: Readers without a guard never end; the others refuse the file.

    Remedy: Cut the joint that closes the circle, or correct its parent.
    """
    for joint, way in _closing_joints(urdf):
        links = " -> ".join(way[:_SHOWN] + (["..."] if len(way) > _SHOWN else []) + [joint.child])
        result.find(
            f"The joint {joint.name} closes a circle of links: {links}.",
            "A URDF is a tree: cut the joint, or correct its parent or child.",
            joint=joint.name,
            line=line_of(joint.element),
        )


def _closing_joints(urdf: Urdf) -> Iterator[tuple[JointElement, list[str]]]:
    """Joints from a link to one above it, with the links from there down; depth first, without recursion."""
    done: set[str] = set()
    for start in (*urdf.roots, *urdf.link_names):
        if start in done:
            continue
        way, places, waiting = [start], {start: 0}, [iter(urdf.below.get(start, ()))]
        while waiting:
            joint = next(waiting[-1], None)
            if joint is None:
                waiting.pop()
                done.add(way[-1])
                del places[way.pop()]
            elif joint.child in places:
                yield joint, way[places[joint.child] :]
            elif joint.child not in done:
                places[joint.child] = len(way)
                way.append(joint.child)
                waiting.append(iter(urdf.below.get(joint.child, ())))


@check(
    "KV125",
    title="There is one root",
    fails="There is more than one root",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def second_roots(result: OpenCheck, urdf: Urdf) -> None:
    """One link carries all others.

    Why it matters: PyBullet crashes with two roots; MuJoCo welds the second to the world without a word.

    Remedy: Join the second root to the rest by a fixed joint, or split the file.
    """
    # links without any joint have a check of their own
    roots = [root for root in urdf.roots if root in urdf.below]
    if not roots and urdf.edges:
        result.find(
            "Every link hangs on a joint, so there is no root.",
            "Cut the joint above the link that is to stand still.",
        )
    sizes = {root: len(urdf.depths([root])) for root in roots[: _SHOWN * 8]}
    largest = max(sizes, key=lambda root: sizes[root], default="")
    for root in roots:
        if root != largest:
            count = sizes.get(root, 1)
            result.find(
                f"The link {root} is a second root beside {largest}: its tree has {count} links. PyBullet "
                "crashes with two roots.",
                "Join it to the rest by a joint (a fixed one if it does not move), or split the file.",
                link=root,
                line=_line_of_link(urdf, root),
            )


@check(
    "KV126", title="No link is isolated", fails="A link is isolated", severity=Severity.ERROR, cause=Cause.KINEMATICS
)
def isolated_links(result: OpenCheck, urdf: Urdf) -> None:
    """Every link hangs on a joint or carries one, unless it is the only link.

    Why it matters: It is a second root: it stays behind when the model moves, or crashes the engine.

    Remedy: Join it by a joint, or delete it.
    """
    if len(set(urdf.link_names)) < 2:
        return
    for link in urdf.roots:
        if link not in urdf.below:
            result.find(
                f"The link {link} hangs on no joint and carries none.",
                "Join it to the rest by a joint (a fixed one if it does not move), or delete it.",
                link=link,
                line=_line_of_link(urdf, link),
            )


@check(
    "KV127",
    title="Leaders of mimic joints move",
    fails="The leader of a mimic joint does not exist, or is fixed",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def dangling_mimics(result: OpenCheck, urdf: Urdf) -> None:
    """Every <mimic> names a joint of the file that is not fixed.

    Why it matters: Most loaders accept such a leader in silence, and the joint then moves freely or not at all; MuJoCo
    refuses the file.

    Remedy: Correct the name of the leader, or delete the <mimic>.
    """
    known = {joint.name: joint.element.get("type") for joint in urdf.joints if joint.name}
    for joint, mimic in _followers(urdf):
        leader = mimic.get("joint") or ""
        if leader not in known:
            result.find(
                f"The joint {joint.name} mimics {shown(leader) if leader else 'no joint'}, which is not there.",
                _suggestion(leader, known, "joint"),
                joint=joint.name,
                line=line_of(mimic),
            )
        elif known[leader] == "fixed" and joint.element.get("type") != "fixed":
            result.find(
                f"The joint {joint.name} mimics {leader}, which is fixed, so that it cannot follow.",
                "Name a joint that moves, or delete the <mimic>.",
                joint=joint.name,
                line=line_of(mimic),
            )


@check(
    "KV128",
    title="Mimic joints follow a leader",
    fails="Mimic joints follow each other in a circle",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def mimic_circles(result: OpenCheck, urdf: Urdf) -> None:
    """Followers do not follow each other in a circle, nor in chains of more than `max_mimic_chain`; a follower of a
    follower is a warning.

    Why it matters: A circle has no value that is right; readers without a guard never end.

    Remedy: Let one of them lead, and let the others name it.
    """
    follows = {joint.name: mimic.get("joint") or "" for joint, mimic in _followers(urdf)}
    lines = {joint.name: line_of(mimic) for joint, mimic in _followers(urdf)}
    settled: dict[str, int] = {}
    for start in follows:
        way: dict[str, int] = {}
        name = start
        while name in follows and name not in settled and name not in way:
            way[name] = len(way)
            name = follows[name]
        if name in way:
            circle = list(way)[way[name] :]
            result.find(
                f"The mimic joints {' -> '.join([*circle[:_SHOWN], name])} follow each other in a circle.",
                "Let one of them lead: delete its <mimic>.",
                joint=circle[-1],
                line=lines[circle[-1]],
            )
        below = settled.get(name, 0)
        for place, member in enumerate(reversed(way)):
            settled[member] = below + place + 1
        if settled[start] > urdf.settings.max_mimic_chain and name not in way:
            result.find(
                f"The joint {start} follows a chain of {settled[start]} mimic joints.",
                "Let every follower name the first leader, with the product of the multipliers.",
                joint=start,
                value=settled[start],
                limit=urdf.settings.max_mimic_chain,
                line=lines[start],
            )
    _chained(result, follows, lines)


def _chained(result: OpenCheck, follows: dict[str, str], lines: dict[str, int]) -> None:
    """Followers of followers, which most readers resolve wrongly."""
    for follower, leader in follows.items():
        if leader in follows and follows[leader] != follower and leader != follower:
            result.find(
                f"The joint {follower} mimics {leader}, which mimics {follows[leader]}.",
                f"Let it mimic {follows[leader]} directly, with the product of the multipliers.",
                severity=Severity.WARNING,
                joint=follower,
                line=lines[follower],
            )


def _followers(urdf: Urdf) -> Iterator[tuple[JointElement, _Element]]:
    for joint in urdf.joints:
        mimic = joint.element.find("mimic")
        if mimic is not None:
            yield joint, mimic


def _suggestion(name: str, known: Collection[str], what: str) -> str:
    near = difflib.get_close_matches(name, sorted(known)[:1000], n=1)
    return f"Did you mean {near[0]}?" if near else f"Correct the name, or add the {what}."


def _line(joint: JointElement, tag: str) -> int:
    end = joint.element.find(tag)
    return line_of(joint.element if end is None else end)


def _line_of_link(urdf: Urdf, name: str) -> int:
    return line_of(next(link for link in urdf.links if link.get("name") == name))
