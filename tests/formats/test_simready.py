"""NVIDIA's validator (usd-validation-nvidia with the rules of SimReady Foundation) reads three exports."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from kinematify import export, infer
from kinematify.config import load_config
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.registry import build
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model
from kinematify.validation.checks import CHECKS

validator = pytest.importorskip("usd_validation_nvidia", reason="pip install usd-validation-nvidia")
pytest.importorskip("simready.foundation.tier_core", reason="pip install simready-foundation-tier-core")

_DOCS = Path(__file__).parents[2] / "docs" / "formats.md"


def documented() -> set[str]:
    """Rules that docs/formats.md lists as layout, taste, or not to be run without Kit."""
    section = _DOCS.read_text(encoding="utf-8").split("## What NVIDIA's validator says of the USD")[1]
    return set(re.findall(r"`([A-Z]\w+)`", section.split("\n## ")[0]))


@pytest.mark.parametrize("name", ["drawer", "robot", "inferred"])
def test_only_what_the_docs_list_is_left(tmp_path: Path, name: str) -> None:
    given = ("gripper", {}) if name == "robot" else ("cabinet", {"drawers": 1, "doors": 0})
    (tmp_path / "model").mkdir()
    (tmp_path / "asset").mkdir()
    built = build(*given, seed=0)
    config = load_config()
    model = infer(built.assembly, config=config).model if name == "inferred" else true_model(built, config)
    urdf = write_model(simulable_model(model, config).robot, tmp_path / "model")
    file = export(urdf, "usd", tmp_path / "asset" / "model.usdc").path
    assert not found(file)


def found(file: Path) -> dict[str, str]:
    engine = validator.ValidationEngine(init_rules=True)
    listed = [rule for rule in engine.initialized_rules if rule.__name__ in documented()]
    assert {rule.__name__ for rule in listed} == documented(), "the docs list a rule that does not exist"
    for rule in listed:
        engine.disable_rule(rule)
    assert len(engine.initialized_rules) - len(listed) > 80
    issues = engine.validate(str(file)).issues()
    return {issue.rule.__name__: issue.message for issue in issues if issue.severity.name != "INFO"}


def test_rules_that_need_kit_are_answered_by_checks_that_exist() -> None:
    section = _DOCS.read_text(encoding="utf-8").split("## Rules of NVIDIA's SimReady Foundation")[1]
    named = set(re.findall(r"KV\d{3}", section.split("\n## ")[0]))
    assert named
    assert named <= set(CHECKS)
