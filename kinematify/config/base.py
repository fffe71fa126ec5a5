"""Base of every configuration: strict types, and YAML files that may extend each other."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from kinematify.errors import ConfigError

CONFIG_FOLDER = Path(__file__).resolve().parent.parent / "configs"

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast, where PyYAML was built with it


class StageConfig(BaseModel):
    """Base of all stages: strict types, unknown keys and non-finite numbers refused, frozen."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, allow_inf_nan=False, defer_build=True)


def section() -> Any:
    """Default of a field that is a stage itself: its own defaults, made by the validator of the whole."""
    return Field(default_factory=dict, validate_default=True)


_Stage = TypeVar("_Stage", bound=StageConfig)


def load(stage: type[_Stage], given: str | Path | _Stage, **overrides: Any) -> _Stage:
    """Make a stage from its defaults and what a YAML file, with those that it extends, states in their place.

    Args:
        stage: Class of the stage.
        given: Default `name` of the stage, for its defaults as they are; a shipped file's name; a path; or the stage.
        overrides: Values that replace those of the file, but for None.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value is missing, unknown or of the wrong type.
    """
    changes = {name: value for name, value in overrides.items() if value is not None}
    if isinstance(given, stage):
        return given.model_copy(update=changes)
    field = stage.model_fields.get("name")
    defaults = field.default if field else None
    values = {**_read_layers(str(given), defaults, seen=()), **changes}
    try:
        return stage.model_validate(values)
    except ValidationError as error:
        problems = "; ".join(f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
        raise ConfigError(
            f"The configuration {given} does not fit: {problems}. "
            f"Compare it with the fields of {stage.__module__}.{stage.__name__}."
        ) from error


def _read_layers(name_or_path: str | Path, defaults: str | None, seen: tuple[Path, ...]) -> dict[str, Any]:
    if str(name_or_path) == defaults:
        return {}
    path = _config_path(name_or_path, defaults)
    if path in seen:
        raise ConfigError(f"The configuration {path} extends itself through {', '.join(map(str, seen))}.")
    try:
        values = yaml.load(path.read_text(encoding="utf-8"), Loader=_LOADER)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise ConfigError(f"The configuration {path} cannot be read as YAML: {error}.") from error
    if not isinstance(values, dict):
        raise ConfigError(f"The configuration {path} must hold `key: value` lines, like paper.yaml.")
    parent = values.pop("extends", None)
    return values if parent is None else _merge(_read_layers(parent, defaults, (*seen, path)), values)


def _config_path(name_or_path: str | Path, defaults: str | None) -> Path:
    shipped = CONFIG_FOLDER / f"{name_or_path}.yaml"
    if shipped.is_file():
        return shipped
    path = Path(name_or_path)
    if path.is_file():
        return path
    names = {p.stem for p in CONFIG_FOLDER.glob("*.yaml")} | ({defaults} if defaults else set())
    known = ", ".join(sorted(names))
    raise ConfigError(f"There is no configuration {name_or_path}. Give one of {known}, or the path of a YAML file.")


def _merge(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    merged = dict(base)
    for key, value in changes.items():
        both_maps = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = _merge(merged[key], value) if both_maps else value
    return merged
