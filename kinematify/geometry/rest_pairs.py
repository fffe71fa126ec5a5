"""Every pair at rest: how deep, how far apart, and what later checks may therefore ignore, with the reason."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import TYPE_CHECKING

from kinematify.geometry.overlap import OverlapQueries
from kinematify.geometry.scene import relative

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from kinematify.geometry.scene import Pair, Scene
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True)
class AtRest:
    """Two bodies at rest."""

    pair: Pair
    joined: bool
    collide: bool
    """FCL's verdict on the surfaces."""
    depth: float
    """Deepest point in a closed shell [m]."""
    contained: bool
    """One body is inside the other one, and their surfaces do not meet."""


def overlapping_links(scene: Scene) -> tuple[tuple[str, str], ...]:
    """Pairs of links with geometry whose bodies are in each other at rest: engines would drive them apart."""
    allowance = DepthAllowance(scene, OverlapQueries(scene))
    pairs = [pair for pair, rest in allowance.pairs.items() if rest.collide or rest.contained]
    shown = [[name for name in body.links if scene.model.link_by_name[name].has_geometry] for body in scene.bodies]
    return tuple((first, second) for a, b in sorted(pairs) for first in shown[a] for second in shown[b])


class DepthAllowance:
    """Depth of each pair at rest, and the extra depth that is allowed."""

    def __init__(self, scene: Scene, overlap: OverlapQueries) -> None:
        """Keep the scene; pairs are measured when first asked for."""
        self._scene, self._overlap = scene, overlap
        self.at_rest = cache(self._at_rest)
        """Depth of a pair at rest [m]."""

    @cached_property
    def pairs(self) -> Mapping[Pair, AtRest]:
        """All pairs whose boxes meet, and all neighbours."""
        found = {pair: self._measure(pair) for pair in self._scene.pairs}
        return {pair: rest for pair, rest in found.items() if rest is not None}

    def _at_rest(self, pair: Pair) -> float:
        return float(self._overlap.depth(pair, relative(self._scene.at_rest[None], pair))[0])

    def gap(self, pair: Pair) -> float:
        """Distance of a pair at rest [m]; 0 where they collide or one is in the solid of the other."""
        return self._overlap.gap(pair, relative(self._scene.at_rest[None], pair)[0])

    def hovers(self, pair: Pair, limit: float) -> bool:
        """True if a pair is farther apart than `limit` at rest [m]."""
        T = relative(self._scene.at_rest[None], pair)[0]
        return not self._overlap.near(pair, T, limit) and self._overlap.gap(pair, T) > limit

    def joined(self, pair: Pair) -> bool:
        """True if only joints stand between the two bodies."""
        return pair in self._scene.connection_of

    def tolerance(self, pair: Pair) -> float:
        """Return how much deeper than at rest a pair may get [m]."""
        settings = self._scene.settings
        part = min(solid.size for solid in self._overlap.solids(pair))
        return min(settings.tolerance * self._scene.size, settings.part_tolerance * part)

    def meeting(self, placed: FloatArray) -> Iterator[tuple[Pair, float, bool]]:
        """Pairs that meet in a configuration, how deep [m], and whether that is no deeper than at rest or in a bearing.

        Args:
            placed: Pose of every body, shape (B, 4, 4).
        """
        for pair in self._scene.pairs:
            T = relative(placed[None], pair)
            if self._overlap.collide(pair, T)[0] or self._overlap.may_contain(pair, T)[0]:
                depth = float(self._overlap.depth(pair, T)[0])
                yield pair, depth, depth <= self.at_rest(pair) + self.tolerance(pair)

    def _measure(self, pair: Pair) -> AtRest | None:
        T = relative(self._scene.at_rest[None], pair)
        joined = self.joined(pair)
        collide = bool(self._overlap.collide(pair, T)[0])
        near = collide or bool(self._overlap.may_contain(pair, T)[0])
        if not (near or joined):
            return None
        depth = self.at_rest(pair) if near else 0.0
        contained = not collide and depth > 0.0
        return AtRest(pair=pair, joined=joined, collide=collide, depth=depth, contained=contained)
