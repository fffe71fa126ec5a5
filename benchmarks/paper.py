"""Results that the paper reports (Table I and the ablation table), printed beside ours, and its ablations."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import fmean

from kinematify.evaluation.run_benchmark import DEFAULT_VARIANTS, Variant


@dataclass(frozen=True, kw_only=True)
class PaperRow:
    """One column of the paper's tables."""

    label: str
    dof: str
    """Degrees of freedom as the paper counts them."""
    angle_deg: float
    """Axis angle error [deg]."""
    position_m: float
    """Axis position error, point to point [m]."""
    ted: float
    """Tree edit distance."""


TABLE_I = {
    "everyday": PaperRow(label="Everyday objects", dof="1-8", angle_deg=2.92, position_m=0.23, ted=0.13),
    "ur10e": PaperRow(label="UR10e", dof="6", angle_deg=5.34, position_m=0.27, ted=1.03),
    "panda": PaperRow(label="Franka Panda", dof="7", angle_deg=10.42, position_m=0.15, ted=0.89),
    "go2": PaperRow(label="Unitree Go2", dof="12", angle_deg=9.97, position_m=0.30, ted=1.97),
    "fetch": PaperRow(label="Fetch", dof="13", angle_deg=23.10, position_m=0.71, ted=1.78),
    "allegro": PaperRow(label="Allegro", dof="16", angle_deg=31.39, position_m=0.21, ted=1.22),
    "h1": PaperRow(label="Unitree H1", dof="19", angle_deg=29.31, position_m=0.68, ted=2.23),
}
"""The paper's own method, keyed by the object's name; `everyday` is its mean over everyday objects."""

ABLATION = {
    "paper": {
        "everyday": (2.92, 0.23, 0.13),
        "fetch": (23.10, 0.71, 1.78),
        "panda": (10.42, 0.15, 0.89),
    },
    "paper without MCTS": {
        "everyday": (4.32, 0.59, 0.39),
        "fetch": (28.30, 0.97, 3.32),
        "panda": (10.92, 0.30, 2.97),
    },
    "paper without DW-CAVL": {
        "everyday": (13.94, 1.34, 0.14),
        "fetch": (42.30, 1.82, 1.93),
        "panda": (29.39, 0.97, 0.98),
    },
}
"""Variant -> object -> (axis angle [deg], axis position [m], tree edit distance)."""


def mean_over_robots() -> PaperRow:
    """Return the mean of the paper's six robots; its own `Mean` column counts the everyday objects as a seventh."""
    rows = [row for name, row in TABLE_I.items() if name != "everyday"]
    return PaperRow(
        label="six robots",
        dof="6-19",
        angle_deg=fmean(row.angle_deg for row in rows),
        position_m=fmean(row.position_m for row in rows),
        ted=fmean(row.ted for row in rows),
    )


PAPER_VARIANTS = (
    Variant(label="paper", config="paper"),
    Variant(label="paper without MCTS", config="paper", changes={"topology.mode": "bfs"}),
    Variant(
        label="paper without DW-CAVL",
        config="paper",
        changes={"cavl.consistency_weight": 0.0, "cavl.pivot_weight": 0.0},
    ),
)
"""The paper as written and its two ablations: breadth-first search for the tree, and no anchor term."""
DEFAULT_ABLATION = (
    *DEFAULT_VARIANTS,
    Variant(label="default without MCTS", config="default", changes={"topology.mode": "bfs"}),
    Variant(label="default with DW-CAVL", config="default", changes={"joints.method": "cavl"}),
)
"""The same questions asked of the default, which has no DW-CAVL: with it in place of all evidence on joints."""
