"""One cause, one finding: which findings are reported under which other one, and what that makes of the report."""

from __future__ import annotations

import json
from graphlib import TopologicalSorter
from typing import TYPE_CHECKING

from lxml import etree

from kinematify.robot.read import read_robot
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, CheckResult, Observation, Severity, Status, Suppression
from kinematify.validation.formats.html import as_html
from kinematify.validation.formats.junit import as_junit
from kinematify.validation.formats.sarif import as_sarif
from kinematify.validation.run.conclusion import concluded
from kinematify.validation.run.report import ValidationReport

if TYPE_CHECKING:
    from pathlib import Path

ARM = """<robot name="arm">
  <link name="base"/><link name="cover"/><link name="shoulder"/><link name="wrist"/>
  <joint name="screwed" type="fixed"><parent link="base"/><child link="cover"/></joint>
  <joint name="turn" type="continuous"><parent link="base"/><child link="shoulder"/></joint>
  <joint name="roll" type="continuous"><parent link="shoulder"/><child link="wrist"/></joint>
</robot>"""
"""The cover is screwed to the base, the shoulder turns on it."""


def found(check: str, severity: Severity = Severity.WARNING, **about: object) -> CheckResult:
    """A check with one observation, which alone can become a finding."""
    engine = next(iter(CHECKS[check].engines), None)
    fields = {"check": check, "severity": severity, "cause": Cause.PHYSICS, "engine": engine, **about}
    seen = Observation(message=f"Found by {check}.", remedy="Repair it.", **fields)  # type: ignore[arg-type]
    return CheckResult(check=check, engine=engine, status=Status.FAIL, findings=(seen,))


def report_of(*results: CheckResult, folder: Path | None = None) -> ValidationReport:
    """A report with causes."""
    robot = None
    if folder is not None:
        (folder / "arm.urdf").write_text(ARM)
        robot = read_robot(folder / "arm.urdf", geometry="none")
    return ValidationReport(model="arm.urdf", checks=concluded(results, robot))


def test_no_check_is_the_cause_of_itself() -> None:
    graph = {name: set(entry.follows) - {name} for name, entry in CHECKS.items()}  # other engines follow the first
    assert {cause for causes in graph.values() for cause in causes} <= set(CHECKS)
    tuple(TopologicalSorter(graph).static_order())  # raises where there is a circle


def test_what_engines_say_of_a_pair_follows_from_what_the_file_has(tmp_path: Path) -> None:
    report = report_of(
        found("KV301", pair=("base", "wrist")),
        found("KV802", pair=("cover", "wrist")),  # the same two bodies by other links
        found("KV804", Severity.ERROR, joint="roll", pair=("base", "wrist")),
        found("KV802", pair=("shoulder", "wrist")),
        folder=tmp_path,
    )
    (cause, other) = report.groups
    assert (cause.finding.check, [item.check for item in cause.consequences]) == ("KV301", ["KV804", "KV802"])
    assert cause.finding.severity is Severity.ERROR, "a cause is as bad as the worst that follows from it"
    assert (other.finding.pair, other.consequences) == (("shoulder", "wrist"), ())
    assert report.verdict == "fail"


def test_a_note_explains_nothing_that_counts() -> None:
    report = report_of(found("KV312", Severity.NOTE, joint="turn"), found("KV311", joint="turn"))
    assert [len(item.consequences) for item in report.groups] == [0, 0]


def test_an_inertia_for_which_an_engine_refuses_the_file_is_the_cause_of_that() -> None:
    rounded, refused = found("KV205", Severity.NOTE, link="shoulder"), found("KV801", link="shoulder")
    (item,) = report_of(rounded, refused, found("KV806")).groups
    assert (item.finding.check, item.finding.severity) == ("KV205", Severity.WARNING)
    assert [finding.check for finding in item.consequences] == ["KV801", "KV806"]
    assert len(report_of(rounded, found("KV801", link="wrist")).groups) == 2


def test_causes_of_causes_are_the_ones_that_are_reported() -> None:
    pair = ("base", "wrist")
    report = report_of(found("KV301", pair=pair), found("KV802", pair=pair), found("KV804", joint="roll", pair=pair))
    (item,) = report.groups
    assert [finding.check for finding in item.consequences] == ["KV802", "KV804"]


def test_a_push_that_nothing_blocks_follows_from_what_shakes_the_engine() -> None:
    shaken = found("KV803", joint="roll", pair=("base", "wrist"))
    (item,) = report_of(shaken, found("KV804", joint="turn")).groups
    assert [finding.joint for finding in item.consequences] == ["turn"]
    assert len(report_of(shaken, found("KV804", joint="turn", pair=("base", "shoulder"))).groups) == 2


def test_accepting_a_cause_accepts_what_follows_from_it() -> None:
    pair = ("base", "wrist")
    results = (found("KV301", pair=pair), found("KV804", Severity.ERROR, joint="roll", pair=pair))
    accepted = concluded(results, None, rules=[Suppression(check="KV301", reason="a cable runs there")])
    report = ValidationReport(model="arm.urdf", checks=accepted)
    assert (report.verdict, {item.suppressed for item in report.findings}) == ("pass", {"a cable runs there"})
    only = concluded(results, None, rules=[Suppression(check="KV804", reason="it is never driven")])
    report = ValidationReport(model="arm.urdf", checks=only)
    assert report.verdict == "warn", "what is accepted makes its cause no worse"


def test_all_formats_tell_a_cause_once() -> None:
    pair = ("base", "wrist")
    report = report_of(found("KV301", pair=pair), found("KV804", Severity.ERROR, joint="roll", pair=pair))
    answer = json.loads(json.dumps(report.as_json()))
    assert [item["follows_from"] for item in answer["findings"]] == [None, 0]
    (result,) = json.loads(as_sarif([report]))["runs"][0]["results"]
    assert (result["ruleId"], result["level"]) == ("KV301", "error")
    assert result["message"]["text"].endswith("Follows from it: KV804 [mujoco].")
    suite = etree.fromstring(as_junit([report]).encode())
    assert suite.get("failures") == "1"
    assert "Follows from: Found by KV301." in suite.findtext(".//testcase[2]/system-out")
    page = as_html([report], {})
    assert page.count('class="finding ') == 1
    assert "Follows from it: KV804 [mujoco]" in page
