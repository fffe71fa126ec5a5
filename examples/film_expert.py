"""Film the hand-written policy of DrawerPull: docs/drawer_pull.gif, or what -o names."""

from __future__ import annotations

import argparse

import gymnasium
from PIL import Image

from kinematify.envs.demonstrations import expert_for

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--model", default="bundled:drawers")
    parser.add_argument("-o", "--output", default="docs/drawer_pull.gif")
    arguments = parser.parse_args()
    env = gymnasium.make(
        "kinematify.envs:kinematify/DrawerPull-v0", model=arguments.model, render_mode="rgb_array",
        terminate_on_success=True,
    )  # fmt: skip
    policy = expert_for(env)
    observation, _ = env.reset(seed=0)
    policy.begin()
    pictures, over = [env.render()], False
    while not over:
        observation, _, terminated, truncated, _ = env.step(policy.act(observation))
        over = terminated or truncated
        pictures.append(env.render())
    env.close()
    frames = [Image.fromarray(picture).quantize(48) for picture in [*pictures[::3], *[pictures[-1]] * 5]]
    frames[0].save(arguments.output, save_all=True, append_images=frames[1:], duration=100, loop=0)
