"""The SRDF beside a file: what it names is checked, and what it leaves out is not reported."""

from __future__ import annotations

from pathlib import Path

import pytest

from kinematify.validation.finding import Finding, Severity
from kinematify.validation.run import validate
from kinematify.validation.run.report import ValidationReport
from tests.validation.engine_models import Box, Model, Part

GOOD = """<robot name="model">
  <group name="arm"><chain base_link="base" tip_link="near"/></group>
  <group_state name="home" group="arm"><joint name="near_joint" value="0.1"/></group_state>
  <virtual_joint name="world_joint" type="fixed" parent_frame="world" child_link="base"/>
  <disable_collisions link1="near" link2="far" reason="{reason}"/>
</robot>"""


def folded(tmp_path: Path, text: str | None, *, apart: float) -> Path:
    """Two blocks that slide on a beam, so far apart at rest that they meet on the way."""
    beam = Part(name="base", boxes=(Box(size=(1.0, 0.1, 0.1)),))
    slide = {"parent": "base", "kind": "prismatic", "axis": (1.0, 0.0, 0.0), "boxes": (Box(size=(0.1, 0.1, 0.1)),)}
    parts = (
        beam,
        Part(name="near", at=(-0.5 * apart, 0.0, 0.1), limits=(0.0, 0.4), **slide),  # type: ignore[arg-type]
        Part(name="far", at=(0.5 * apart, 0.0, 0.1), limits=(0.0, 0.1), **slide),  # type: ignore[arg-type]
    )
    urdf = Model(parts=parts).write(tmp_path)
    if text is not None:
        urdf.with_suffix(".srdf").write_text(text)
    return urdf


def looked(urdf: Path) -> ValidationReport:
    return validate(urdf, engines=(), selected={"KV145", "KV301", "KV305", "KV311"}, workers=1)


def counted(urdf: Path) -> list[Finding]:
    return [item for item in looked(urdf).findings if item.severity is not Severity.NOTE]


def test_what_it_names_rightly_is_fine(tmp_path: Path) -> None:
    report = looked(folded(tmp_path, GOOD.format(reason="Never"), apart=0.6))
    assert not [item.message for item in report.findings if item.check == "KV145"]
    assert {item.status for item in report.checks if item.check == "KV145"} == {"pass"}


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('tip_link="near"', 'tip_link="nearer"', "nearer"),
        ('<joint name="near_joint"', '<joint name="elbow"', "elbow"),
        ('group="arm"', 'group="hand"', "hand"),
        ('value="0.1"', 'value="0.7"', "outside of its range"),
    ],
)
def test_what_is_not_there_is_named(old: str, new: str, says: str, tmp_path: Path) -> None:
    assert old in GOOD
    (finding,) = counted(folded(tmp_path, GOOD.format(reason="Default").replace(old, new), apart=0.6))
    assert finding.check == "KV145"
    assert says in finding.message


@pytest.mark.parametrize("reason", ["Never", "Adjacent"])
def test_a_pair_that_meets_is_left_out_for_a_true_reason(reason: str, tmp_path: Path) -> None:
    (finding,) = counted(folded(tmp_path, GOOD.format(reason=reason), apart=0.3))
    assert (finding.check, finding.pair) == ("KV305", ("near", "far"))


def test_a_pair_that_it_leaves_out_is_no_fault(tmp_path: Path) -> None:
    assert {item.check for item in counted(folded(tmp_path, None, apart=0.05))} >= {"KV301"}
    assert not counted(folded(tmp_path, GOOD.format(reason="Default"), apart=0.05))
