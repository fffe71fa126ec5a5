"""Typed configuration: one class per stage, values in `configs/*.yaml` where each has its reason.

Lengths are fractions of the assembly's diagonal unless a field says otherwise, so that nothing depends on units.
A YAML file may name another one with `extends:` and then states only what differs.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from kinematify.errors import ConfigError

CONFIG_FOLDER = Path(__file__).resolve().parent / "configs"


class StageConfig(BaseModel):
    """Base of all stages: strict types, unknown keys and non-finite numbers refused, frozen."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, allow_inf_nan=False)


class AssemblyConfig(StageConfig):
    """Limits on what is accepted as input."""

    max_parts: int
    """More parts than this are refused."""
    max_faces: int
    """Faces of all parts together; more are refused."""
    max_part_faces: int
    """A part with more faces is simplified to this number for inference (output keeps the original)."""
    min_vertices: int
    """A part with fewer distinct vertices is set aside (paper III-B: too few vertices)."""
    min_extent: float
    """A part whose largest extent is below this fraction of the assembly's diagonal is set aside."""
    max_archive_bytes: int
    """Unpacked size of a ZIP [bytes]."""


class Config(StageConfig):
    """All stages."""

    name: str
    seed: int
    assembly: AssemblyConfig


def load_config(name_or_path: str | Path = "default", **overrides: Any) -> Config:
    """Load a shipped configuration by name (``default``, ``fast``, ``paper``) or any YAML file by path.

    Args:
        name_or_path: Name of a file in `kinematify/configs` without suffix, or a path.
        overrides: Top-level values that replace those of the file, e.g. ``seed=7``.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value has the wrong type.
    """
    values = _read_layers(_config_path(name_or_path), seen=())
    values.update(overrides)
    try:
        return Config.model_validate(values)
    except ValidationError as error:
        problems = "; ".join(f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
        raise ConfigError(
            f"The configuration {name_or_path} does not fit: {problems}. Compare it with default.yaml."
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
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
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
