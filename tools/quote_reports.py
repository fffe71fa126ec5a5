"""Write the reports that docs/validate.md quotes again: `python -m tools.quote_reports FOLDER`, of NAME/model.urdf."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from tools.imports import ROOT

PAGE = ROOT / "docs" / "validate.md"
_WRAPPED = "\n  and what --all prints."
"""Fits on the line once the folder has left the path in it."""
_QUOTED = re.compile(r"```text\n(?:PASS|WARN|FAIL)  (\S+/model\.urdf):.*?\n```", re.DOTALL)


def quoted(page: str) -> tuple[str, ...]:
    """Models whose reports a page quotes."""
    return tuple(match[1] for match in _QUOTED.finditer(page))


def rewritten(page: str, folder: str) -> str:
    """The page with every report made again, but for its last paragraph, which is always the same."""

    def report(match: re.Match[str]) -> str:
        command = [sys.executable, "-m", "kinematify", "validate", match[1]]
        run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if not run.stdout:
            raise SystemExit(f"kinematify validate {match[1]} in {folder} says: {run.stderr}")
        report = run.stdout.strip().rpartition("\n\n")[0].replace(f"{Path(folder).absolute()}{os.sep}", "")
        return "\n".join(["```text", report.replace(_WRAPPED, _WRAPPED.replace("\n ", "")), "```"])

    return _QUOTED.sub(report, page)


if __name__ == "__main__":
    PAGE.write_text(rewritten(PAGE.read_text("utf-8"), sys.argv[1]), "utf-8")
