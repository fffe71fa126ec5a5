"""Where the repository and the models for measuring lie."""

from __future__ import annotations

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BENCH = Path(os.environ.get("KINEMATIFY_BENCH", ROOT.parent / "shared" / "bench"))
"""Not part of the repository; tests that need it are skipped where it is absent."""
