"""KV120 to KV128: one tree of links, and mimic joints that end at a leader."""

from __future__ import annotations

import difflib
from collections import defaultdict
from typing import TYPE_CHECKING

from kinematify.validation.finding import Severity
from kinematify.validation.precheck.problem import Problem, line_of, shown

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from lxml.etree import _Element

    from kinematify.robot.urdf_document import JointElement
    from kinematify.validation.precheck.urdf import Urdf

_SHOWN = 8


def no_links(urdf: Urdf) -> Iterator[Problem]:
    """KV120."""
    if not urdf.links:
        yield Problem(
            message="The file holds no link, so there is nothing to move and nothing to look at.",
            remedy="Give a URDF with at least one link.",
            line=line_of(urdf.robot),
        )


def dangling_ends(urdf: Urdf) -> Iterator[Problem]:
    """KV121."""
    known = set(urdf.link_names)
    for joint in urdf.joints:
        for tag, link in (("parent", joint.parent), ("child", joint.child)):
            if not link:
                yield Problem(
                    message=f"The joint {joint.name} names no {tag} link.",
                    remedy=f'Add <{tag} link="..."/>.',
                    joint=joint.name,
                    line=line_of(joint.element),
                )
            elif link not in known:
                yield Problem(
                    message=f"The {tag} of the joint {joint.name} is the link {shown(link)}, which is not there.",
                    remedy=_suggestion(link, known, "link"),
                    joint=joint.name,
                    line=_line(joint, tag),
                )


def self_joined(urdf: Urdf) -> Iterator[Problem]:
    """KV122."""
    for joint in urdf.joints:
        if joint.parent and joint.parent == joint.child:
            yield Problem(
                message=f"The joint {joint.name} joins the link {joint.child} to itself; PyBullet crashes with this.",
                remedy="Name two different links.",
                joint=joint.name,
                link=joint.child,
                line=_line(joint, "child"),
            )


def second_parents(urdf: Urdf) -> Iterator[Problem]:
    """KV123."""
    carriers: dict[str, list[JointElement]] = defaultdict(list)
    for edge in urdf.edges:
        carriers[edge.child].append(edge)
    for link, joints in carriers.items():
        if len(joints) > 1:
            names = ", ".join(joint.name for joint in joints[:_SHOWN])
            yield Problem(
                message=f"The link {link} hangs on {len(joints)} joints ({names}); in a URDF a link has one parent.",
                remedy="Cut all but one of them. Closed chains need a constraint of the simulator beside the URDF.",
                joint=joints[1].name,
                link=link,
                value=len(joints),
                limit=1,
                line=_line(joints[1], "child"),
            )


def cycles(urdf: Urdf) -> Iterator[Problem]:
    """KV124: joints that lead back to a link above them."""
    for joint, way in _closing_joints(urdf):
        links = " -> ".join(way[:_SHOWN] + (["..."] if len(way) > _SHOWN else []) + [joint.child])
        yield Problem(
            message=f"The joint {joint.name} closes a circle of links: {links}.",
            remedy="A URDF is a tree: cut the joint, or correct its parent or child.",
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


def second_roots(urdf: Urdf) -> Iterator[Problem]:
    """KV125: trees beside the largest one; links without any joint have a check of their own."""
    roots = [root for root in urdf.roots if root in urdf.below]
    if not roots and urdf.edges:
        yield Problem(
            message="Every link hangs on a joint, so there is no root.",
            remedy="Cut the joint above the link that is to stand still.",
        )
    sizes = {root: len(urdf.depths([root])) for root in roots[: _SHOWN * 8]}
    largest = max(sizes, key=lambda root: sizes[root], default="")
    for root in roots:
        if root != largest:
            count = sizes.get(root, 1)
            yield Problem(
                message=f"The link {root} is a second root beside {largest}: its tree has {count} links. PyBullet "
                "crashes with two roots.",
                remedy="Join it to the rest by a joint (a fixed one if it does not move), or split the file.",
                link=root,
                line=_line_of_link(urdf, root),
            )


def isolated_links(urdf: Urdf) -> Iterator[Problem]:
    """KV126."""
    if len(set(urdf.link_names)) < 2:
        return
    for link in urdf.roots:
        if link not in urdf.below:
            yield Problem(
                message=f"The link {link} hangs on no joint and carries none.",
                remedy="Join it to the rest by a joint (a fixed one if it does not move), or delete it.",
                link=link,
                line=_line_of_link(urdf, link),
            )


def dangling_mimics(urdf: Urdf) -> Iterator[Problem]:
    """KV127."""
    known = {joint.name for joint in urdf.joints if joint.name}
    for joint, mimic in _followers(urdf):
        leader = mimic.get("joint") or ""
        if leader not in known:
            yield Problem(
                message=f"The joint {joint.name} mimics {shown(leader) if leader else 'no joint'}, which is not there.",
                remedy=_suggestion(leader, known, "joint"),
                joint=joint.name,
                line=line_of(mimic),
            )


def mimic_circles(urdf: Urdf) -> Iterator[Problem]:
    """KV128: circles, and chains so long that they can only be a mistake."""
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
            yield Problem(
                message=f"The mimic joints {' -> '.join([*circle[:_SHOWN], name])} follow each other in a circle.",
                remedy="Let one of them lead: delete its <mimic>.",
                joint=circle[-1],
                line=lines[circle[-1]],
            )
        below = settled.get(name, 0)
        for place, member in enumerate(reversed(way)):
            settled[member] = below + place + 1
        if settled[start] > urdf.settings.max_mimic_chain and name not in way:
            yield Problem(
                message=f"The joint {start} follows a chain of {settled[start]} mimic joints.",
                remedy="Let every follower name the first leader, with the product of the multipliers.",
                joint=start,
                value=settled[start],
                limit=urdf.settings.max_mimic_chain,
                line=lines[start],
            )
    yield from _chained(follows, lines)


def _chained(follows: dict[str, str], lines: dict[str, int]) -> Iterator[Problem]:
    """Followers of followers, which most readers resolve wrongly."""
    for follower, leader in follows.items():
        if leader in follows and follows[leader] != follower and leader != follower:
            yield Problem(
                message=f"The joint {follower} mimics {leader}, which mimics {follows[leader]}.",
                remedy=f"Let it mimic {follows[leader]} directly, with the product of the multipliers.",
                severity=Severity.WARNING,
                joint=follower,
                line=lines[follower],
            )


PROBES = {
    "KV120": no_links,
    "KV121": dangling_ends,
    "KV122": self_joined,
    "KV123": second_parents,
    "KV124": cycles,
    "KV125": second_roots,
    "KV126": isolated_links,
    "KV127": dangling_mimics,
    "KV128": mimic_circles,
}


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
