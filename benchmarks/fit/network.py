"""The fit of the network that scores hypotheses beside the trees, in torch, written as arrays that need none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.joints.choice.point_network import Network, Scale

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from torch import Tensor, nn

    from kinematify.robot.arrays import FloatArray, IntArray

PARAMETERS = {
    "knots": 33,
    "hidden": 48,
    "shared": 24,
    "input_dropout": 0.1,
    "dropout": 0.3,
    "verdict_dropout": 0.5,  # share of the edges of which it does not see the weighted cues
    "epochs": 14,
    "batch": 64,  # edges
    "learning_rate": 2e-3,
    "weight_decay": 0.02,
}
_RARE = 0.01  # share of rows from which on an input shows where a column is missing


def fit_network(
    columns: NDArray[Any],
    starts: IntArray,
    target: FloatArray,
    weights: FloatArray,
    verdicts: NDArray[np.bool_],
    *,
    seeds: Sequence[int],
) -> Network:
    """Fit networks to edges, listwise, with AdamW (Loshchilov and Hutter 2019) and dropout (Srivastava et al. 2014).

    Args:
        columns: What is measured of every hypothesis of every edge, shape (rows, f).
        starts: First row of each edge, and the number of rows, shape (edges + 1,).
        target: Probabilities that are right, sum 1 within each edge, shape (rows,).
        weights: Of the edges, mean 1, shape (edges,).
        verdicts: Columns that say what the weighted cues say, shape (f,).
        seeds: One network each.
    """
    scale = scale_of(columns)
    inputs = scale.inputs(columns).astype(np.float32)
    hidden = np.concatenate([verdicts, np.zeros(len(scale.missing), dtype=bool)])
    models = [_fitted(inputs, starts, target, weights, hidden, seed=seed) for seed in seeds]
    layers = [{name: value.detach().numpy() for name, value in model.named_parameters()} for model in models]

    def stacked(name: str) -> NDArray[Any]:
        """One array of a layer of all networks, in the precision in which it is written."""
        return np.stack([layer[name].T for layer in layers]).astype(np.float16).astype(np.float32)

    return Network(
        scale=scale,
        embed=stacked("embed.weight"),
        embed_bias=stacked("embed.bias"),
        share=stacked("share.weight"),
        share_bias=stacked("share.bias"),
        compare=stacked("compare.weight"),
        compare_bias=stacked("compare.bias"),
        score=stacked("score.weight")[:, :, 0],
    )


def scale_of(columns: NDArray[Any]) -> Scale:
    """How columns (rows, f) are spread, and which have an input that shows where they are missing; alike ones once."""
    count = int(PARAMETERS["knots"])
    knots = np.zeros((columns.shape[1], count), dtype=np.float32)
    counts = np.zeros(columns.shape[1], dtype=np.int64)
    for k, column in enumerate(columns.T):
        known = column[np.isfinite(column)]
        if len(known):
            own = np.unique(np.quantile(known, np.linspace(0.0, 1.0, count)).astype(np.float32))
            counts[k] = len(own)
            knots[k] = np.concatenate([own, np.full(count - len(own), own[-1])])
    absent = ~np.isfinite(columns)
    alike = {absent[:, k].tobytes(): k for k in np.flatnonzero(absent.mean(axis=0) > _RARE)[::-1]}
    return Scale(knots=knots, counts=counts, missing=np.sort(np.fromiter(alike.values(), dtype=np.int64)))


def _fitted(
    inputs: NDArray[Any],
    starts: IntArray,
    target: FloatArray,
    weights: FloatArray,
    hidden: NDArray[np.bool_],
    *,
    seed: int,
) -> nn.Module:
    import torch  # noqa: PLC0415 - seconds of start-up that only the fit needs

    torch.manual_seed(seed)
    rng = np.random.default_rng(seed)
    every, aims = torch.from_numpy(inputs), torch.from_numpy(target.astype(np.float32))
    visible = torch.from_numpy((~hidden).astype(np.float32))
    model = _model(inputs.shape[1])
    edges, batch = len(starts) - 1, int(PARAMETERS["batch"])
    steps = int(PARAMETERS["epochs"]) * -(-edges // batch)
    rate = PARAMETERS["learning_rate"]
    optimizer = torch.optim.AdamW(model.parameters(), lr=rate, weight_decay=PARAMETERS["weight_decay"])
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, rate, total_steps=steps, pct_start=0.1)
    for _ in range(int(PARAMETERS["epochs"])):
        order = rng.permutation(edges)
        for chosen in (order[k : k + batch] for k in range(0, edges, batch)):
            rows = np.concatenate([np.arange(starts[k], starts[k + 1]) for k in chosen])
            edge = torch.from_numpy(np.repeat(np.arange(len(chosen)), np.diff(starts)[chosen]))
            blind = torch.from_numpy(rng.random(len(chosen)) < PARAMETERS["verdict_dropout"])[edge]
            seen = torch.where(blind[:, None], every[rows] * visible, every[rows])
            logs = log_probabilities_of(model(seen, edge, len(chosen)), edge, len(chosen))
            weighed = torch.from_numpy(weights[chosen].astype(np.float32))[edge] * aims[rows] * logs
            loss = -weighed.sum() / len(chosen)
            optimizer.zero_grad()
            loss.backward()  # type: ignore[no-untyped-call] # torch has no types there
            optimizer.step()
            schedule.step()
    return model


def _model(inputs: int) -> nn.Module:
    """The network of `Network`, for hypotheses (rows, inputs) of several edges at once."""
    import torch  # noqa: PLC0415 - as above
    from torch import nn  # noqa: PLC0415

    hidden, shared = int(PARAMETERS["hidden"]), int(PARAMETERS["shared"])

    class NetworkScores(nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.embed = nn.Linear(inputs, hidden)
            self.share = nn.Linear(hidden, shared)
            self.compare = nn.Linear(hidden + 2 * shared, hidden)
            self.score = nn.Linear(hidden, 1, bias=False)  # a bias would be the same for all hypotheses
            self.drop_inputs = nn.Dropout(PARAMETERS["input_dropout"])
            self.drop = nn.Dropout(PARAMETERS["dropout"])
            self.swish = nn.SiLU()

        def forward(self, rows: Tensor, edge: Tensor, edges: int) -> Tensor:
            own = self.drop(self.swish(self.embed(self.drop_inputs(rows))))
            said = self.share(own)
            mean = torch.zeros(edges, shared).index_add(0, edge, said) / torch.bincount(edge, minlength=edges)[:, None]
            most = torch.full((edges, shared), -torch.inf).scatter_reduce(
                0, edge[:, None].expand_as(said), said, "amax"
            )
            compared = self.swish(self.compare(torch.cat([own, mean[edge], most[edge]], dim=1)))
            scores: Tensor = self.score(self.drop(compared))[:, 0]
            return scores

    return NetworkScores()


def log_probabilities_of(scores: Tensor, edge: Tensor, edges: int) -> Tensor:
    """Within each edge, shape (rows,)."""
    import torch  # noqa: PLC0415 - as above

    most = torch.full((edges,), -torch.inf).scatter_reduce(0, edge, scores.detach(), "amax")
    shifted = scores - most[edge]
    return shifted - torch.zeros(edges).index_add(0, edge, shifted.exp()).log()[edge]
