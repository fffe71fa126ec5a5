"""Which runs of two nights may be compared: the hash of all that they depend on besides the code under test.

The values of the inference's own configuration are part of the method: tuning them is what a night judges, and must
not start a new series behind which a regression hides. Its name is part of the scenario; so are the thresholds of the
validation, since they say what is wrong.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.manipulation.request import PULL

if TYPE_CHECKING:
    from kinematify.config.validation import ValidationSettings
    from kinematify.evaluation.datasets import BenchObject, Condition
    from kinematify.evaluation.nightly.settings import NightlySettings

PULLED = "pulled"
"""Source of a validation in which an arm opens the published model."""
_JUDGES = ("problem_angle", "problem_line", "problem_limits")
"""Settings that say from when on a joint is wrong."""


def accuracy_scenario(item: BenchObject, condition: Condition, settings: NightlySettings) -> str:
    """Hash of an object in a condition."""
    return digest(
        {
            "version": settings.version,
            "content": item.content_hash,
            "gripper": item.gripper_joints,
            "condition": asdict(condition),
            "config": Path(settings.infer_config).stem,
            "judges": {name: getattr(settings, name) for name in _JUDGES},
        }
    )


def validation_scenario(
    item: BenchObject, source: str, settings: NightlySettings, thresholds: ValidationSettings
) -> str:
    """Hash of a model of an object under the thresholds of the validation."""
    return digest(
        {
            "version": settings.version,
            "content": item.content_hash,
            "source": source,
            "config": Path(settings.infer_config).stem if source == "inferred" else None,
            "engines": list(settings.engines),
            "checks": [f"{PULL} within {settings.pull_budget:g} s"] if source == PULLED else list(settings.checks),
            "thresholds": thresholds.model_dump(mode="json"),
        }
    )


def digest(facts: Any) -> str:
    """Twelve characters that stand for plain values."""
    return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()[:12]
