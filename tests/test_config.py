"""Settings stand once: value, reason and meaning in their class, and only what differs in YAML."""

import ast
from itertools import pairwise
from pathlib import Path

import pytest

from kinematify.config import CONFIG_FOLDER, Config, StageConfig, load_config
from kinematify.config.nightly_settings import NightlySettings, load_nightly
from kinematify.config.validation import ValidationSettings, load_settings
from kinematify.errors import ConfigError
from tests.places import ROOT

MODULES = [
    *sorted((ROOT / "kinematify" / "config").glob("*.py")),
]


def written(folder: Path, text: str) -> Path:
    path = folder / "mine.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def fields_without_meaning(module: Path) -> list[str]:
    """Fields with no docstring below; a stage within a stage has that of its class, a new default the old meaning."""
    found = []
    for stage in ast.parse(module.read_text(encoding="utf-8")).body:
        if not isinstance(stage, ast.ClassDef) or ast.unparse(stage.bases[0]) == "ServiceConfig":
            continue
        for field, following in pairwise([*stage.body, None]):
            is_field = isinstance(field, ast.AnnAssign) and ast.unparse(field.value or field.target) != "section()"
            has_meaning = isinstance(following, ast.Expr) and isinstance(following.value, ast.Constant)
            if is_field and not has_meaning:
                found.append(f"{stage.name}.{ast.unparse(field.target)}")
    return found


@pytest.mark.parametrize("module", MODULES, ids=lambda module: f"{module.parent.name}/{module.stem}")
def test_every_field_says_what_it_is(module: Path) -> None:
    assert fields_without_meaning(module) == []


@pytest.mark.parametrize("stage", [Config, ValidationSettings, NightlySettings])
def test_every_field_has_its_value_in_its_class(stage: type[StageConfig]) -> None:
    def check(values: StageConfig) -> None:
        again = type(values).model_validate(values.model_dump())  # defaults have the types that are declared
        assert again.model_dump_json() == values.model_dump_json()
        for name in type(values).model_fields:
            if isinstance(value := getattr(values, name), StageConfig):
                check(value)

    check(stage())


def test_no_shipped_file_repeats_the_defaults() -> None:
    shipped = {path.stem for path in CONFIG_FOLDER.glob("*.yaml")}
    assert not shipped & {"default", "validation", "envs", "nightly"}
    assert load_config() == Config() == load_config("default")
    assert load_settings("validation") == ValidationSettings()
    assert load_nightly("nightly") == NightlySettings()


@pytest.mark.parametrize("first", ["extends: default\n", ""], ids=["extends", "alone"])
def test_a_file_states_only_what_differs(first: str, tmp_path: Path) -> None:
    mine = load_config(written(tmp_path, first + "name: mine\njoints: {guide: {kept: 0.5}}\n"))
    usual = load_config().joints.guide
    assert mine.name == "mine"
    assert mine.joints.guide == usual.model_copy(update={"kept": 0.5})
    assert mine.joints.limits == load_config().joints.limits
    assert usual.kept != 0.5


def test_files_extend_each_other(tmp_path: Path) -> None:
    mine = load_config(written(tmp_path, "extends: paper-open\ntopology: {weights: {sym: 2.0}}\n"))
    paper = load_config("paper").topology.weights
    assert mine.topology.weights == paper.model_copy(update={"sym": 2.0})
    assert mine.topology.base_rule == load_config("paper-base").topology.base_rule == "given"
    assert load_settings(written(tmp_path, "extends: validation\nbudget: {seconds: 9.0}\n")).budget.seconds == 9.0


def test_values_of_one_configuration_are_its_own() -> None:
    load_config().cavl.travels.clear()
    assert load_config().cavl.travels


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("joints: {guide: {kept: much}}", r"joints\.guide\.kept: .*number.* fields of kinematify\.config\.Config\."),
        ("joints: {knid: {}}", r"joints\.knid: Extra inputs"),
        ("joints: {guide: {kept: .nan}}", r"joints\.guide\.kept: .*finite"),
        ("joints:", r"joints: Input should be"),
        ("extends: validation", "no configuration validation. Give one of default, evidence, paper,"),
        ("extends: mine", "no configuration mine"),
        ("- joints", "must hold `key: value` lines"),
    ],
)
def test_what_does_not_fit_is_refused(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=message):
        load_config(written(tmp_path, text))


def test_a_file_that_extends_itself_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    with pytest.raises(ConfigError, match="extends itself"):
        load_config(written(tmp_path, f"extends: {path}"))


def test_settings_of_another_kind_are_refused() -> None:
    with pytest.raises(ConfigError, match="no configuration default"):
        load_settings("default")
    with pytest.raises(ConfigError, match="no configuration default"):
        load_settings("paper")
