"""A file of findings that the user accepts, each with a reason.

- check: KV302
  where: door_left
  reason: the rubber seal is pressed when the door is shut
"""

from __future__ import annotations

import math
import re
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

import yaml

from kinematify.errors import InputError
from kinematify.validation.checks import CHECKS, find_check
from kinematify.validation.finding import Severity, Suppression

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.validation.run.report import ValidationReport

_KEYS = ("check", "where", "reason")
_HEAD = "# Findings that do not count. Fix the model where one is right; where it is not, write why as its reason.\n"
_SPECIAL = re.compile(r"([\[*?])")
"""Characters of names that mean something in a pattern."""
_REMOVED = re.compile(r"KV([4569]\d\d|14[34]|15[45]|209|24[34]|304|33[12]|34[0123567]|350)$")
"""Checks of earlier releases: a rule that names one covers nothing, and is listed as such."""
_FORM = "Each rule is `- check: KV302`, `where: NAME` (joint or link, * if omitted) and `reason: WHY`."


def load_suppressions(path: Path) -> tuple[Suppression, ...]:
    """Read the rules of a YAML file.

    Raises:
        InputError: The file cannot be read, a rule is malformed, has no reason, or names no known check.
    """
    rules = _parsed(path)
    if rules is None:
        return ()
    if not isinstance(rules, list):
        raise InputError(f"The suppression file {path} must hold a list of rules, not {_kind(rules)}. {_FORM}")
    return tuple(_rule(rule, f"Rule {number} of {path}") for number, rule in enumerate(rules, start=1))


def unused_suppressions(rules: Sequence[Suppression], reports: Sequence[ValidationReport]) -> tuple[Suppression, ...]:
    """Return the rules that cover no finding of any report: what they were made for is gone, or misspelt."""
    findings = [finding for report in reports for finding in report.findings]
    return tuple(rule for rule in rules if not any(rule.covers(finding) for finding in findings))


def suggested_suppressions(reports: Sequence[ValidationReport]) -> tuple[Suppression, ...]:
    """Return rules that accept every error and warning that counts, each once, where it was found.

    Their reason is what was found: a person has still to judge it. The same in another place counts as before.
    """
    rules: dict[tuple[str, str], Suppression] = {}
    for report in reports:
        for finding in report.counted:
            if finding.severity is not Severity.NOTE:
                place = finding.joint or finding.link or (finding.pair[0] if finding.pair else None)
                where = "*" if place is None else _SPECIAL.sub(r"[\1]", place)
                reason = f"not judged yet: {finding.message}"
                rules.setdefault((finding.check, where), Suppression(check=finding.check, where=where, reason=reason))
    return tuple(rules.values())


def suppressions_text(rules: Sequence[Suppression]) -> str:
    """Return rules as the text of a file that `load_suppressions` reads."""
    listed = [{"check": rule.check, "where": rule.where, "reason": rule.reason} for rule in rules]
    return _HEAD + (yaml.safe_dump(listed, sort_keys=False, allow_unicode=True, width=math.inf) if listed else "")


def _parsed(path: Path) -> Any:
    try:
        return yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"The suppression file {path} cannot be read: {error.strerror}. Check the path.") from error
    except (UnicodeDecodeError, yaml.YAMLError, RecursionError) as error:
        problem = " ".join(str(error).split())
        raise InputError(f"The suppression file {path} cannot be read as YAML: {problem}. {_FORM}") from error


def _rule(rule: Any, name: str) -> Suppression:
    if not isinstance(rule, dict):
        raise InputError(f"{name} is {_kind(rule)}. {_FORM}")
    unknown = [str(key) for key in rule if key not in _KEYS]
    if unknown:
        raise InputError(f"{name} has the unknown key {unknown[0]}. {_FORM}")
    check, reason = (_text(rule, key, name) for key in ("check", "reason"))
    where = _text(rule, "where", name) if "where" in rule else "*"
    kept = check.strip().upper() if _REMOVED.match(check.strip().upper()) else known_pattern(check)
    return Suppression(check=kept, reason=reason, where=where)


def known_pattern(pattern: str) -> str:
    """Return an id or a glob of ids as the registry writes it.

    Raises:
        InputError: No check matches; the message names the nearest.
    """
    wanted = pattern.strip().upper()
    if not any(fnmatchcase(check, wanted) for check in CHECKS):
        return find_check(wanted).id
    return wanted


def _text(rule: dict[str, Any], key: str, name: str) -> str:
    value = rule.get(key)
    if not isinstance(value, str) or not value.strip():
        given = f"has no {key}" if value is None else f"has {value!r} as its {key}, where words in quotes are expected"
        raise InputError(f"{name} {given}. {_FORM}")
    return value.strip()


def _kind(value: Any) -> str:
    names = {dict: "a mapping", list: "a list", str: "a word", int: "a number", float: "a number", bool: "a word"}
    return names.get(type(value), "nothing" if value is None else f"a {type(value).__name__}")
