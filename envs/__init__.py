"""Gymnasium environments around any object: `kinematify/OpenPart-v0` and `kinematify/DrawerPull-v0`.

``gymnasium.make("kinematify.envs:kinematify/OpenPart-v0", model="out/cabinet")`` needs no other import. Importing
this package registers the ids and loads no engine.
"""

from __future__ import annotations

from gymnasium.envs.registration import register

from kinematify.envs.tasks import EPISODE_STEPS, TASKS

OPEN_PART, DRAWER_PULL = "kinematify/OpenPart-v0", "kinematify/DrawerPull-v0"
OPEN_PART_SPARSE, DRAWER_PULL_SPARSE = "kinematify/OpenPart-Sparse-v0", "kinematify/DrawerPull-Sparse-v0"
IDS = (OPEN_PART, OPEN_PART_SPARSE, DRAWER_PULL, DRAWER_PULL_SPARSE)
"""All ids but those of tasks."""
TASK_IDS = {name: f"kinematify/{name}-v0" for name in TASKS}
"""Ids of `kinematify.envs.tasks.TASKS`."""


def _register() -> None:
    for env_id, reward in ((OPEN_PART, "dense"), (OPEN_PART_SPARSE, "sparse")):
        register(
            id=env_id,
            entry_point="kinematify.envs.open_part:make_open_part",
            vector_entry_point="kinematify.envs.vector:OpenPartVectorEnv",
            max_episode_steps=EPISODE_STEPS["open_part"],
            kwargs={"reward": reward},
        )
    for env_id, reward in ((DRAWER_PULL, "dense"), (DRAWER_PULL_SPARSE, "sparse")):
        register(
            id=env_id,
            entry_point="kinematify.envs.drawer_pull:make_drawer_pull",
            max_episode_steps=EPISODE_STEPS["drawer_pull"],
            kwargs={"reward": reward},
        )
    for name, env_id in TASK_IDS.items():
        register(
            id=env_id,
            entry_point="kinematify.envs.tasks:make_task",
            max_episode_steps=EPISODE_STEPS["open_part"],
            kwargs={"task": name},
        )


_register()
