"""Opinions of the inference are notes until a fact agrees."""

from __future__ import annotations

from kinematify.validation.finding import Cause, CheckResult, Finding, Severity, Status
from kinematify.validation.run.opinions import demote_inference_findings


def failed(check: str, joint: str, severity: Severity = Severity.WARNING) -> CheckResult:
    finding = Finding(
        check=check, severity=severity, cause=Cause.KINEMATICS, message="It is off.", remedy="Mend it.", joint=joint
    )
    return CheckResult(check=check, engine=None, status=Status.FAIL, findings=(finding,))


def test_opinions_about_a_joint_are_one_note() -> None:
    line, kind = demote_inference_findings([failed("KV344", "hinge"), failed("KV345", "hinge", Severity.ERROR)])
    (note,) = line.findings
    assert (note.severity, note.joint) == (Severity.NOTE, "hinge")
    assert "KV345" in note.message
    assert kind.findings == ()
    assert (line.status, kind.status) == (Status.PASS, Status.PASS)


def test_an_error_of_fact_about_the_same_joint_lets_them_count() -> None:
    fact = failed("KV312", "hinge", Severity.ERROR)
    reported = demote_inference_findings([fact, failed("KV344", "hinge"), failed("KV344", "slide")])
    assert reported[0] == fact
    assert [finding.severity for result in reported[1:] for finding in result.findings] == [
        Severity.WARNING,
        Severity.NOTE,
    ]


def test_a_warning_is_no_proof() -> None:
    reported = demote_inference_findings([failed("KV311", "hinge"), failed("KV344", "hinge")])
    assert reported[1].findings[0].severity is Severity.NOTE


def test_a_fact_about_the_line_takes_the_place_of_the_opinions_about_it() -> None:
    fact = failed("KV349", "hinge")
    reported = demote_inference_findings(
        [fact, failed("KV342", "hinge"), failed("KV345", "hinge"), failed("KV342", "slide")]
    )
    assert reported[0] == fact
    assert [[(item.joint, item.severity) for item in result.findings] for result in reported[1:]] == [
        [],
        [("hinge", Severity.NOTE)],
        [("slide", Severity.NOTE)],
    ]
