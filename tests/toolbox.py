"""A box on which two trays swing aside, each on a parallelogram of two arms: what closes chains is tried on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kinematify.generate.procedural.blueprint_file import described_blueprint

if TYPE_CHECKING:
    from kinematify.generate.procedural.blueprint import Blueprint


def toolbox() -> Blueprint:
    """A toolbox with two cantilever trays, one to each side."""
    parts: list[dict[str, Any]] = [
        {"name": "body", "material": "steel", "shapes": [{"kind": "box", "size": [0.4, 0.2, 0.1], "xyz": [0, 0, 0.05]}]}
    ]
    joints: list[dict[str, Any]] = []
    loops = []
    for k, side in ((1, -1), (2, 1)):
        tray = f"cantilever_tray_{k}"
        shape = {"kind": "box", "size": [0.3, 0.08, 0.04], "xyz": [0, side * 0.06, 0.17]}
        parts.append({"name": tray, "material": "steel", "shapes": [shape]})
        pivots = [(x, side * 0.104, 0.05) for x in (-0.1, 0.1)]
        for n, (x, y, z) in enumerate(pivots, start=1):
            bar = {"kind": "box", "size": [0.02, 0.006, 0.12], "xyz": [x, y, z + 0.06]}
            parts.append({"name": f"{tray}_arm_{n}", "material": "steel", "shapes": [bar]})
            turn = {"type": "revolute", "axis": [0, 1, 0], "lower": 0, "upper": 1.0}
            follows = {} if n == 1 else {"mimic": {"leader": f"{tray}_arm_1", "multiplier": 1}}
            joints.append({**turn, "parent": "body", "child": f"{tray}_arm_{n}", "pivot": [x, y, z], **follows})
        pin = [[x, y, z + 0.12] for x, y, z in pivots]
        joints.append(
            {
                "type": "revolute", "parent": f"{tray}_arm_1", "child": tray, "axis": [0, 1, 0], "pivot": pin[0],
                "lower": -1.0, "upper": 0, "mimic": {"leader": f"{tray}_arm_1", "multiplier": -1},
            }
        )  # fmt: skip
        loops.append({"parts": [f"{tray}_arm_2", tray], "pivot": pin[1]})
    return described_blueprint({"name": "toolbox", "parts": parts, "joints": joints, "loops": loops})
