"""What several tests of the environments need: ids, a hand-written policy, a model of two boxes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

OPEN_PART = "kinematify.envs:kinematify/OpenPart-v0"


def steady(observation: np.ndarray, speed: float = 0.5, gain: float = 1.0) -> np.ndarray:
    """Push along the way out at `speed` [ways/s] until 94 % are open, then brake."""
    wanted = speed if observation[0] < 0.94 else 0.0
    action = np.clip((wanted - observation[16]) * gain, -1.0, 1.0) * observation[54:57]
    return np.asarray(action, dtype=np.float32)


def run(env: Any, policy: Any, *, seed: int, options: dict[str, Any] | None = None) -> tuple[float, dict[str, Any]]:
    """Return and last info of an episode."""
    observation, info = env.reset(seed=seed, options=options)
    total, over = 0.0, False
    while not over:
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        total, over = total + reward, terminated or truncated
    return total, info


def documented_rows(cls: type) -> list[tuple[int, int, float, float]]:
    """First and last index, lowest and highest of every row of the table of observations."""
    text = (cls.__doc__ or "").split("## Observation space")[1].split("## Reward")[0]
    rows = re.findall(
        r"^ *\| (\d+)(?: to (\d+))? \| .* \| (-?[\d.]+) \| (-?[\d.]+) \| \S+ \|$", text, flags=re.MULTILINE
    )
    return [(int(a), int(b or a), float(low), float(high)) for a, b, low, high in rows]


def write_slider(path: Path, *, kind: str = "prismatic", thick: float = 0.02, extra: str = "") -> Path:
    """A box in front of another one, with a joint between them."""
    path.write_text(
        f"""<robot name="slider">
  <link name="body">
    <inertial><mass value="5"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size="0.4 0.3 0.2"/></geometry></visual>
    <collision><geometry><box size="0.4 0.3 0.2"/></geometry></collision></link>
  <link name="front">
    <inertial><mass value="2"/><inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size="0.4 {thick} 0.2"/></geometry></visual>
    <collision><geometry><box size="0.4 {thick} 0.2"/></geometry></collision></link>
  <joint name="front_slide" type="{kind}">
    <parent link="body"/><child link="front"/><origin xyz="0 {-0.152 - thick / 2} 0"/>
    <axis xyz="0 -1 0"/><limit lower="0" upper="0.25" effort="50" velocity="1"/>
    <dynamics damping="4" friction="1"/></joint>
  {extra}
</robot>
""",
        encoding="utf-8",
    )
    return path
