"""Reports as machines read them: JSON, JUnit, SARIF and HTML, also with hostile names and numbers."""

from __future__ import annotations

import json
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.html import as_html
from kinematify.validation.formats.junit import as_junit
from kinematify.validation.formats.sarif import as_sarif
from kinematify.validation.run.report import Outcome, Unusable, as_json_text
from tests.reports import EVIL, add_checks, finding, full_report, report, result

UNUSABLE = Unusable(model="models/arm.xacro", message="It is xacro. Expand it first.")


@pytest.fixture(autouse=True)
def _checks(monkeypatch: pytest.MonkeyPatch) -> None:
    add_checks(monkeypatch)


def evil() -> Outcome:
    """A report in which every text that comes from a file is hostile."""
    bad = finding(message=EVIL, remedy=EVIL, joint=EVIL, link=EVIL, q={EVIL: 1.0}, suppressed=EVIL, unit=EVIL)
    worse = finding(message=EVIL, pair=(EVIL, EVIL), severity=Severity.NOTE)
    checks = (result(bad, worse, finding(message=EVIL)), result(status=Status.BLOCKED, reason=EVIL))
    return report(*checks, model=EVIL)


def test_json_of_several_models_is_a_line_each() -> None:
    lines = as_json_text([full_report(), UNUSABLE, full_report(model="b.urdf")]).splitlines()
    values = [json.loads(line) for line in lines]
    assert [value["model"] for value in values] == ["models/door.urdf", "models/arm.xacro", "b.urdf"]
    assert [value["verdict"] for value in values] == ["fail", "unusable", "fail"]
    assert values[1]["error"] == UNUSABLE.message
    assert {value["schema"] for value in values} == {2}


def suites(outcomes: list[Outcome]) -> Any:
    return etree.fromstring(as_junit(outcomes).encode("utf-8"))


def test_junit_has_a_suite_per_model_and_a_case_per_check_and_engine() -> None:
    root = suites([full_report(), UNUSABLE])
    assert [suite.get("name") for suite in root] == ["models/door.urdf", "models/arm.xacro"]
    cases = root[0].findall("testcase")
    assert len(cases) == 5
    assert cases[0].get("name") == "KV396 Doors & drawers of KV396"
    assert cases[2].get("name") == "KV896 Doors & drawers of KV896 [mujoco]"
    assert all(case.get("classname").startswith("models/door.urdf.") for case in cases)
    assert all(float(case.get("time")) == 0.25 for case in cases)


def test_junit_counts_are_those_of_its_cases() -> None:
    root = suites([full_report(), UNUSABLE])
    for element in (root, *root.findall("testsuite")):
        assert int(element.get("tests")) == len(list(element.iter("testcase")))
        for attribute, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
            assert int(element.get(attribute)) == len(list(element.iter(tag)))
    assert [root.get(key) for key in ("tests", "failures", "errors", "skipped")] == ["6", "1", "2", "2"]


def test_junit_tells_errors_as_failures_and_the_rest_as_output() -> None:
    case = suites([full_report()])[0].find("testcase")
    failure = case.find("failure")
    assert failure.get("message") == "The joint hinge_1 overlaps by 5 mm."
    assert failure.get("type") == "kinematics"
    assert "joint hinge_1; 5 mm, limit 1 mm; line 7" in failure.text
    assert "hinge_2" not in failure.text
    output = case.find("system-out").text
    assert "warning (physics)" in output
    assert "Suppressed: the seal is soft" in output


def test_junit_of_skipped_and_blocked_gives_the_reason() -> None:
    messages = [element.get("message") for element in suites([full_report()]).iter("skipped")]
    assert messages == ["skipped: it does not apply", "blocked: no mesh"]


@pytest.fixture
def sarif(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, Any]:
    monkeypatch.chdir(tmp_path)
    document: dict[str, Any] = json.loads(
        as_sarif([full_report(model=str(tmp_path / "models" / "a b.urdf")), UNUSABLE])
    )
    return document


def test_sarif_is_what_version_2_1_0_requires(sarif: dict[str, Any]) -> None:
    assert sarif["version"] == "2.1.0"
    assert sarif["$schema"].endswith("sarif-2.1.0.json")
    (run,) = sarif["runs"]
    driver = run["tool"]["driver"]
    assert set(driver) >= {"name", "rules", "version"}
    ids = [rule["id"] for rule in driver["rules"]]
    assert ids == sorted({result["ruleId"] for result in run["results"]})
    assert len(set(ids)) == len(ids)
    for rule in driver["rules"]:
        assert rule["shortDescription"]["text"]
        assert set(rule["help"]) == {"text", "markdown"}
        assert rule["defaultConfiguration"]["level"] in ("none", "note", "warning", "error")
    assert isinstance(run["invocations"][0]["executionSuccessful"], bool)


def test_sarif_results_point_to_rule_file_and_line(sarif: dict[str, Any]) -> None:
    (run,) = sarif["runs"]
    assert len(run["results"]) == 5
    for item in run["results"]:
        assert item["level"] in ("note", "warning", "error")
        assert item["message"]["text"]
        place = item["locations"][0]["physicalLocation"]
        assert place["artifactLocation"]["uri"] == "models/a%20b.urdf"
        assert place["region"]["startLine"] >= 1
        assert all(isinstance(value, str) for value in item["partialFingerprints"].values())
    first = run["results"][0]
    assert first["locations"][0]["physicalLocation"]["region"]["startLine"] == 7


def test_sarif_marks_what_is_suppressed_and_only_that(sarif: dict[str, Any]) -> None:
    marked = [item["suppressions"] for item in sarif["runs"][0]["results"] if "suppressions" in item]
    assert marked == [[{"kind": "external", "justification": "the seal is soft"}]]


def test_sarif_fingerprints_survive_other_numbers() -> None:
    def prints(**changes: object) -> list[str]:
        run = json.loads(as_sarif([report(result(finding(**changes)))]))["runs"][0]
        return [item["partialFingerprints"]["kinematify/v1"] for item in run["results"]]

    assert prints() == prints(value=7.0, message="The joint hinge_1 overlaps by 7 mm.", line=9)
    assert prints() != prints(joint="hinge_2")


def test_sarif_says_what_did_not_run(sarif: dict[str, Any]) -> None:
    invocation = sarif["runs"][0]["invocations"][0]
    reported = invocation["toolExecutionNotifications"]
    assert {item["descriptor"]["id"] for item in reported} == {"skipped", "blocked", "unusable-input"}
    assert invocation["executionSuccessful"] is False
    assert json.loads(as_sarif([full_report()]))["runs"][0]["invocations"][0]["executionSuccessful"] is True


class Page(HTMLParser):
    """Tags, their attributes and the text of a page; an unclosed or crossed tag is an error."""

    VOID = ("meta", "img", "input", "br")

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data

    def of_class(self, name: str) -> list[dict[str, str | None]]:
        return [attributes for _, attributes in self.tags if name in (attributes.get("class") or "").split()]


def test_html_loads_nothing_from_elsewhere() -> None:
    page = Page(as_html([full_report(), UNUSABLE], {"models/door.urdf": b"\x89PNG"}))
    sources = [value for _, attributes in page.tags for key, value in attributes.items() if key in ("src", "href")]
    assert [source for source in sources if not str(source).startswith(("data:image/png;base64,", "#"))] == []
    assert sum(tag == "img" for tag, _ in page.tags) == 1
    assert not {"link", "iframe", "object"} & {tag for tag, _ in page.tags}
    policies = [a["content"] for tag, a in page.tags if a.get("http-equiv") == "Content-Security-Policy"]
    assert str(policies[0]).startswith("default-src 'none'")
    assert "prefers-color-scheme: dark" in page.text
    assert any(attributes.get("name") == "viewport" for _, attributes in page.tags)


def test_html_has_every_finding_once_and_filters_for_it() -> None:
    model = full_report()
    page = Page(as_html([model], {}))
    cards = page.of_class("finding")
    assert len(cards) == len(model.findings)
    assert "They touch at rest." in page.text
    offered = {(a["name"], a["value"]) for tag, a in page.tags if tag == "input"}
    assert {("severity", str(card["data-severity"])) for card in cards} <= offered
    assert {("cause", str(card["data-cause"])) for card in cards} <= offered
    assert len(page.of_class("suppressed")) == 1


def test_html_shows_joints_families_checks_and_environment() -> None:
    text = Page(as_html([full_report()], {})).text
    for part in (
        "0 to 180 deg",
        "0 to 90 deg",
        "prismatic",
        "KV3 kinematics by geometry",
        "it does not apply",
        "1.2.3",
    ):
        assert part in text
    assert "deepest NaN" in text


@pytest.mark.parametrize("outcomes", [[], [report()], [UNUSABLE], [report(), UNUSABLE]], ids=len)
def test_all_formats_take_reports_without_anything(outcomes: list[Outcome]) -> None:
    Page(as_html(outcomes, {}))
    assert suites(outcomes).get("failures") == "0"
    assert len(json.loads(as_sarif(outcomes))["runs"]) == 1
    as_json_text(outcomes)


def test_hostile_text_harms_no_format() -> None:
    page = Page(as_html([evil(), Unusable(model=EVIL, message=EVIL)], {}))
    assert not any(tag == "b" for tag, _ in page.tags)
    assert "<b>&\"'" in page.text
    assert "\x1b" not in page.text
    root = suites([evil(), Unusable(model=EVIL, message=EVIL)])
    assert root.find(".//b") is None
    assert root[0].get("name").startswith("<b>&\"'")
    document = json.loads(as_sarif([evil()]))
    assert document["runs"][0]["results"][0]["message"]["text"].startswith("<b>&\"'")
    assert json.loads(as_json_text([evil()]))["model"] == EVIL
    for text in (as_html([evil()], {}), as_junit([evil()]), as_sarif([evil()]), as_json_text([evil()])):
        assert text.encode("utf-8")
