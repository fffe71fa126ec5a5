"""The file of accepted findings: what it may hold, what it must, and which rules are of no use any more."""

from __future__ import annotations

from pathlib import Path

import pytest

from kinematify.errors import InputError
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Suppression
from kinematify.validation.run.conclusion import concluded
from kinematify.validation.run.suppression_file import load_suppressions, unused_suppressions
from tests.reports import add_checks, finding, report, result


@pytest.fixture(autouse=True)
def _checks(monkeypatch: pytest.MonkeyPatch) -> None:
    add_checks(monkeypatch)


def written(folder: Path, text: str) -> Path:
    file = folder / "accepted.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_rules_are_read_as_written(tmp_path: Path) -> None:
    text = "- {check: kv396, where: 'hinge_*', reason: soft seal}\n- {check: 'KV8*', reason: ' later '}\n"
    assert load_suppressions(written(tmp_path, text)) == (
        Suppression(check="KV396", where="hinge_*", reason="soft seal"),
        Suppression(check="KV8*", where="*", reason="later"),
    )


@pytest.mark.parametrize("text", ["", "# nothing yet\n", "[]"])
def test_a_file_without_rules_is_fine(tmp_path: Path, text: str) -> None:
    assert load_suppressions(written(tmp_path, text)) == ()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("- {check: KV396, where: door}", "Rule 1 of .* has no reason"),
        ("- {check: KV396, reason: ''}", "Rule 1 of .* has '' as its reason"),
        ("- {check: KV396, reason: soft}\n- {reason: soft}", "Rule 2 of .* has no check"),
        ("- {check: KV395, reason: soft}", "no check 'KV395'.*KV396"),
        ("- {check: 'KX*', reason: soft}", r"no check 'KX\*'"),
        ("- {check: KV396, where: 3, reason: soft}", "has 3 as its where"),
        ("- {check: KV396, joint: door, reason: soft}", "unknown key joint"),
        ("check: KV396\nreason: soft", "a list of rules, not a mapping"),
        ("- KV396", "Rule 1 of .* is a word"),
        ("- {check: KV396, reason: [", "cannot be read as YAML"),
        ("\x00", "cannot be read as YAML"),
    ],
)
def test_malformed_rules_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        load_suppressions(written(tmp_path, text))


def test_unreadable_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        load_suppressions(tmp_path / "none.yaml")
    with pytest.raises(InputError, match="Is a directory"):
        load_suppressions(tmp_path)
    (tmp_path / "latin.yaml").write_bytes(b"- \xff\xfe\xff")
    with pytest.raises(InputError, match="cannot be read as YAML"):
        load_suppressions(tmp_path / "latin.yaml")


def test_suppressed_errors_do_not_count_but_stay(tmp_path: Path) -> None:
    rules = load_suppressions(written(tmp_path, "- {check: KV396, where: hinge_1, reason: soft seal}"))
    before = report(result(finding()))
    after = report(*concluded(before.checks, None, rules=rules))
    assert (before.verdict, after.verdict) == ("fail", "pass")
    assert [item.suppressed for item in after.findings] == ["soft seal"]


def test_rules_that_cover_nothing_are_named() -> None:
    used = Suppression(check="KV3*", where="hinge_1", reason="soft")
    unused = Suppression(check="KV396", where="hinge_2", reason="soft")
    assert unused_suppressions([used, unused], [report(), report(result(finding()))]) == (unused,)


@pytest.mark.parametrize("gone", ["KV405", "KV144", "KV155", "KV209", "KV304", "KV340", "KV350"])
def test_a_rule_for_a_check_of_an_earlier_release_is_no_error(tmp_path: Path, gone: str) -> None:
    (rule,) = load_suppressions(written(tmp_path, f"- {{check: {gone}, reason: soft seal}}"))
    assert rule.check == gone
    assert gone not in CHECKS
