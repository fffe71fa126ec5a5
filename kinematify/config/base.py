"""What every configuration shares: strict types, and YAML files that may extend each other."""

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


def load_values(name_or_path: str | Path) -> dict[str, Any]:
    """Read a YAML file, shipped or not, with what it extends.

    Raises:
        ConfigError: The name is unknown or the YAML is malformed.
    """
    return _read_layers(_config_path(name_or_path), seen=())


def validated(stage: type[_Stage], values: dict[str, Any], name_or_path: str | Path) -> _Stage:
    """Make a configuration from values.

    Raises:
        ConfigError: A value is missing, unknown or of the wrong type.
    """
    try:
        return stage.model_validate(values)
    except ValidationError as error:
        problems = "; ".join(f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
        raise ConfigError(
            f"The configuration {name_or_path} does not fit: {problems}. "
            f"Compare it with the fields of {stage.__module__}.{stage.__name__}."
        ) from error


def _config_path(name_or_path: str | Path) -> Path:
    shipped = CONFIG_FOLDER / f"{name_or_path}.yaml"
    if shipped.is_file():
        return shipped
    path = Path(name_or_path)
    if path.is_file():
        return path
    known = ", ".join(sorted(p.stem for p in CONFIG_FOLDER.glob("*.yaml")))
    raise ConfigError(f"There is no configuration {name_or_path}. Give one of {known}, or the path of a YAML file.")


def _read_layers(path: Path, seen: tuple[Path, ...]) -> dict[str, Any]:
    if path in seen:
        raise ConfigError(f"The configuration {path} extends itself through {', '.join(map(str, seen))}.")
    try:
        values = yaml.load(path.read_text(encoding="utf-8"), Loader=_LOADER)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise ConfigError(f"The configuration {path} cannot be read as YAML: {error}.") from error
    if not isinstance(values, dict):
        raise ConfigError(f"The configuration {path} must hold `key: value` lines, like default.yaml.")
    parent = values.pop("extends", None)
    if parent is None:
        return values
    return _merge(_read_layers(_config_path(parent), (*seen, path)), values)


def _merge(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    merged = dict(base)
    for key, value in changes.items():
        both_maps = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = _merge(merged[key], value) if both_maps else value
    return merged
