"""The other half of the fitted choice: a small network that sees all hypotheses of an edge at once.

Every hypothesis is embedded on its own; the mean and the greatest of what all of them say stand beside it when it is
scored (deep sets, Zaheer et al. 2017). It is asked twice, with what the weighted cues say and without, and several
networks that began elsewhere are averaged, all in log probability. Evaluated in numpy; what fitted it is not needed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import log_softmax

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Scale:
    """What the network reads of the columns: each spread evenly over [-1, 1], and which are missing."""

    knots: NDArray[Any]
    """Quantiles of each column, ascending and each once, then the last one repeated, shape (f, k)."""
    counts: IntArray
    """How many of them are a column's own; below two, nothing is read of it, shape (f,)."""
    missing: IntArray
    """Columns of which it is told whether they are missing, shape (m,)."""

    def inputs(self, columns: NDArray[Any]) -> FloatArray:
        """Columns (n, f) as inputs (n, f + m); what is missing is 0, the middle."""
        spread = np.zeros(columns.shape)
        for k in np.flatnonzero(self.counts > 1):
            places = np.minimum(-1.0 + 2.0 * np.arange(self.knots.shape[1]) / (self.counts[k] - 1), 1.0)
            spread[:, k] = np.interp(columns[:, k], self.knots[k], places)
        absent = ~np.isfinite(columns)
        spread[absent] = 0.0
        return np.concatenate([spread, absent[:, self.missing]], axis=1)


@dataclass(frozen=True, kw_only=True, eq=False)
class Network:
    """Networks of one shape in arrays; s of them, n inputs, h hidden values, g that are shared among hypotheses."""

    scale: Scale
    verdicts: NDArray[np.bool_]
    """Inputs that are hidden when it is asked without what the weighted cues say, shape (n,)."""
    embed: FloatArray
    """Shape (s, n, h)."""
    embed_bias: FloatArray
    """Shape (s, h)."""
    share: FloatArray
    """Shape (s, h, g)."""
    share_bias: FloatArray
    """Shape (s, g)."""
    compare: FloatArray
    """Shape (s, h + 2 g, h)."""
    compare_bias: FloatArray
    """Shape (s, h)."""
    score: FloatArray
    """Shape (s, h)."""

    def log_probabilities(self, columns: NDArray[Any]) -> FloatArray:
        """Mean log probability of each hypothesis of an edge, from its columns (h, f), shape (h,)."""
        told = self.scale.inputs(columns)
        untold = np.where(self.verdicts, 0.0, told)
        asked = np.stack([told, untold])[:, None]
        own = swish(asked @ self.embed + self.embed_bias[:, None])
        shared = own @ self.share + self.share_bias[:, None]
        of_all = np.concatenate([shared.mean(axis=2), shared.max(axis=2)], axis=2)[:, :, None]
        beside = np.broadcast_to(of_all, (*own.shape[:3], of_all.shape[3]))
        compared = swish(np.concatenate([own, beside], axis=3) @ self.compare + self.compare_bias[:, None])
        scores = np.einsum("psnh,sh->psn", compared, self.score)
        return np.asarray(log_softmax(scores, axis=2).mean(axis=(0, 1)))


def swish(values: FloatArray) -> FloatArray:
    """The activation x / (1 + exp(-x)) (Elfwing et al. 2018)."""
    return np.asarray(values / (1.0 + np.exp(-values)))
