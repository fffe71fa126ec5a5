"""Tables in YAML that are shipped with the package."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import yaml

if TYPE_CHECKING:
    from pathlib import Path

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast, where PyYAML was built with it


def read_table(path: Path) -> Any:
    """Return what a file of the package says: lists, mappings, texts and numbers."""
    return yaml.load(path.read_text(encoding="utf-8"), Loader=_LOADER)
