"""Train a policy that opens a part of an object, until it succeeds.

Install what it needs first: pip install '.[rl]' in a checkout, pip install 'kinematify[rl]' from an index.

python examples/train_policy.py                          # a chest of drawers that comes with the package
python examples/train_policy.py --model out/cabinet      # a folder that kinematify infer or generate has written
"""

from __future__ import annotations

import argparse

import gymnasium
import numpy as np

from kinematify.versions import require

require("Training", "stable-baselines3")

from stable_baselines3 import PPO  # noqa: E402
from stable_baselines3.common.env_util import make_vec_env  # noqa: E402

OPEN_PART = "kinematify.envs:kinematify/OpenPart-v0"


def evaluate(policy: PPO, keywords: dict[str, object], seeds: range) -> tuple[float, float]:
    """Share of episodes that end open and at rest, and the mean return."""
    env = gymnasium.make(OPEN_PART, **keywords)
    ends, returns = [], []
    for seed in seeds:
        observation, _ = env.reset(seed=seed)
        over, total = False, 0.0
        while not over:
            action, _ = policy.predict(observation, deterministic=True)
            observation, reward, terminated, truncated, info = env.step(action)
            total += float(reward)
            over = terminated or truncated
        ends.append(info["is_success"])
        returns.append(total)
    env.close()
    return float(np.mean(ends)), float(np.mean(returns))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", default="bundled:drawers")
    parser.add_argument("--joint", default="auto")
    parser.add_argument("--rounds", type=int, default=30)
    parser.add_argument("-o", "--output", default="policy.zip")
    arguments = parser.parse_args()
    # The hand is a spring that the policy moves: with forces, the noise of exploration overcomes the friction of small
    # joints, and the mean action, which is what remains after training, does not.
    keywords = {"model": arguments.model, "joint": arguments.joint, "control": "position", "randomize": True}
    envs = make_vec_env(lambda: gymnasium.make(OPEN_PART, **keywords), n_envs=8, seed=0)
    policy = PPO("MlpPolicy", envs, n_steps=256, batch_size=128, gamma=0.97, learning_rate=1e-3, device="cpu", seed=0)
    for _ in range(arguments.rounds):
        policy.learn(2048, reset_num_timesteps=False)
        rate, gained = evaluate(policy, keywords, range(1000, 1020))
        print(f"{policy.num_timesteps:6d} steps: return {gained:7.2f}, success {rate:.0%} of 20 episodes", flush=True)
        if rate >= 0.95:
            break
    policy.save(arguments.output)
