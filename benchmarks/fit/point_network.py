"""The fit of the network that looks at points, in torch, written as arrays that need none."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.fit.network import log_probabilities_of
from kinematify.joints.candidate import FIXED
from kinematify.joints.choice.point_network import (
    LINE_INPUTS,
    POINT_INPUTS,
    PointNetwork,
    point_groups,
    point_inputs,
)
from kinematify.joints.features.workspace import CHILD

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from torch import Tensor, nn

    from benchmarks.fit.examples import Example
    from kinematify.joints.features.workspace import Cloud
    from kinematify.robot.arrays import FloatArray

PARAMETERS = {
    "points": 64,
    "pooled": 96,
    "hidden": 96,
    "shared": 24,
    "dropout": 0.2,
    "of_child": 48,  # points of one edge at a time
    "of_parent": 36,
    "of_others": 16,
    "right": 5,  # hypotheses of one edge at a time
    "wrong": 9,
    "jitter": 0.004,  # of the child's diagonal
    "epochs": 16,
    "batch": 16,  # edges
    "learning_rate": 2e-3,
    "weight_decay": 0.02,
}


def fit_points(examples: Sequence[Example], weights: FloatArray, *, seeds: Sequence[int]) -> PointNetwork:
    """Fit networks to the points of edges, listwise, with AdamW (Loshchilov and Hutter 2019) and dropout.

    Args:
        examples: Edges with points; those without a right joint that moves teach nothing.
        weights: Of the examples, shape (n,).
        seeds: One network each.
    """
    usable = [k for k, item in enumerate(examples) if item.right[item.kinds != FIXED].sum() > 1e-3]
    models = [_fitted([examples[k] for k in usable], weights[usable], seed=seed) for seed in seeds]
    return written(models)


def written(models: Sequence[nn.Module]) -> PointNetwork:
    """Networks as arrays that are evaluated without torch."""
    layers = [{name: value.detach().numpy() for name, value in model.named_parameters()} for model in models]

    def stacked(name: str) -> NDArray[Any]:
        """One array of a layer of all networks, in the precision in which it is written."""
        return np.stack([layer[name].T for layer in layers]).astype(np.float16).astype(np.float32)

    names = ("first", "second", "third", "embed", "share", "compare")
    arrays = {name: stacked(f"{name}.weight") for name in names}
    arrays |= {f"{name}_bias": stacked(f"{name}.bias") for name in names}
    return PointNetwork(**arrays, score=stacked("score.weight")[:, :, 0])


def _fitted(examples: Sequence[Example], weights: FloatArray, *, seed: int) -> nn.Module:
    import torch  # noqa: PLC0415 - seconds of start-up that only the fit needs

    torch.manual_seed(seed)
    rng = np.random.default_rng(seed)
    model = unfitted_model()
    batch, rate = int(PARAMETERS["batch"]), PARAMETERS["learning_rate"]
    steps = int(PARAMETERS["epochs"]) * -(-len(examples) // batch)
    optimiser = torch.optim.AdamW(model.parameters(), lr=rate, weight_decay=PARAMETERS["weight_decay"])
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, rate, total_steps=steps, pct_start=0.15)
    for _ in range(int(PARAMETERS["epochs"])):
        order = rng.permutation(len(examples))
        for start in range(0, len(order), batch):
            some = order[start : start + batch]
            drawn = [_drawn(examples[k], rng) for k in some]
            points, lines, aims = (
                torch.from_numpy(np.concatenate([item[part] for item in drawn])) for part in range(3)
            )
            edge = torch.from_numpy(np.repeat(np.arange(len(some)), [len(item[2]) for item in drawn]))
            share = torch.from_numpy(weights[some].astype(np.float32))[edge]
            logs = log_probabilities_of(model(points, lines, edge, _counts()), edge, len(some))
            loss = -(aims * logs * share).sum() / len(some)
            optimiser.zero_grad()
            loss.backward()  # type: ignore[no-untyped-call] # torch has no types there
            torch.nn.utils.clip_grad_norm_(model.parameters(), 2.0)
            optimiser.step()
            schedule.step()
    return model.eval()


def _drawn(example: Example, rng: np.random.Generator) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Some points, moved a little, as some hypotheses of an edge have them, of their lines, and how right each is."""
    moving = np.flatnonzero(example.kinds != FIXED)
    best = moving[np.argsort(-example.right[moving], kind="stable")][: int(PARAMETERS["right"])]
    best = best[example.right[best] > 1e-3]
    rows = np.concatenate([best, rng.permutation(np.setdiff1d(moving, best))[: int(PARAMETERS["wrong"])]])
    points, lines = point_inputs(_thinned(example.cloud, rng), example.hypotheses, rows)
    right = example.right[rows]
    return points, lines, (right / right.sum()).astype(np.float32)


def _thinned(cloud: Cloud, rng: np.random.Generator) -> Cloud:
    """Some of the points, each moved a little."""
    groups = [
        rng.choice(group, count, replace=len(group) < count) if len(group) else np.empty(0, dtype=np.int64)
        for group, count in zip(point_groups(cloud.labels), _counts(), strict=True)
    ]
    if not len(groups[2]):  # all edges of a batch have as many points
        groups[2] = groups[0][: _counts()[2]]
    index = np.concatenate(groups)
    moved = rng.normal(0.0, PARAMETERS["jitter"] * cloud.unit, (len(index), 3))
    return replace(
        cloud,
        points=cloud.points[index] + moved,
        normals=cloud.normals[index],
        gaps=cloud.gaps[index],
        labels=cloud.labels[index],
    )


def _counts() -> tuple[int, int, int]:
    """Points of the child, of the parent and of the rest that are looked at together."""
    return int(PARAMETERS["of_child"]), int(PARAMETERS["of_parent"]), int(PARAMETERS["of_others"])


def unfitted_model() -> nn.Module:
    """Each point embedded, pooled by whose it is, and the hypothesis scored beside the others of its edge."""
    import torch  # noqa: PLC0415 - as above
    from torch import nn  # noqa: PLC0415

    width, pooled, hidden, shared = (int(PARAMETERS[name]) for name in ("points", "pooled", "hidden", "shared"))

    class PointScores(nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.first = nn.Linear(POINT_INPUTS, width)
            self.second = nn.Linear(width, width)
            self.third = nn.Linear(width, pooled)
            self.embed = nn.Linear(6 * pooled + LINE_INPUTS, hidden)
            self.share = nn.Linear(hidden, shared)
            self.compare = nn.Linear(hidden + 2 * shared, hidden)
            self.score = nn.Linear(hidden, 1, bias=False)  # a bias would be the same for all hypotheses
            self.drop = nn.Dropout(PARAMETERS["dropout"])
            self.swish = nn.SiLU()

        def forward(self, points: Tensor, lines: Tensor, edge: Tensor, counts: Sequence[int]) -> Tensor:
            edges = int(edge[-1]) + 1
            said = self.third(self.swish(self.second(self.swish(self.first(points)))))
            pools = []
            for some in torch.split(said, list(counts), dim=1):
                pools += [some.mean(dim=1), some.amax(dim=1)]
            alone = points[:, -1, -4 + CHILD] == 1.0  # nothing is around: what stands there only fills the batch
            pools[4:] = [pool.masked_fill(alone[:, None], 0.0) for pool in pools[4:]]
            own = self.drop(self.swish(self.embed(torch.cat([*pools, lines], dim=1))))
            shared_by = self.share(own)
            mean = torch.zeros(edges, shared).index_add(0, edge, shared_by)
            mean = mean / torch.bincount(edge, minlength=edges)[:, None]
            rows = edge[:, None].expand_as(shared_by)
            most = torch.full((edges, shared), -torch.inf).scatter_reduce(0, rows, shared_by, "amax")
            compared = self.swish(self.compare(torch.cat([own, mean[edge], most[edge]], dim=1)))
            scores: Tensor = self.score(self.drop(compared))[:, 0]
            return scores

    return PointScores()
