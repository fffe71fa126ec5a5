"""Reports that the pages quote are made by a command."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.validation.engine_models import cabinet
from tools.quote_reports import PAGE, quoted, rewritten

if TYPE_CHECKING:
    from pathlib import Path


def test_the_page_quotes_three_models() -> None:
    assert len(quoted(PAGE.read_text("utf-8"))) == 3


def test_a_quoted_report_is_made_anew_without_the_folder(tmp_path: Path) -> None:
    (tmp_path / "shelf").mkdir()
    cabinet().with_part("drawer", axis=(-1.0, 0.0, 0.0)).write(tmp_path / "shelf")
    page = rewritten("Before\n```text\nPASS  shelf/model.urdf: old\n```\nafter", str(tmp_path))
    assert page.startswith("Before\n```text\nFAIL  shelf/model.urdf: ")
    assert page.endswith("\n```\nafter")
    assert "KV310" in page
    assert str(tmp_path) not in page


def test_a_model_that_is_not_there_stops_it(tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match=r"shelf/model\.urdf"):
        rewritten("```text\nPASS  shelf/model.urdf: old\n```", str(tmp_path))
