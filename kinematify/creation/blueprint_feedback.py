"""Findings of a validation in the fields of a blueprint: what a language model can correct."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Iterable

    from kinematify.validation.finding import Finding

_MOST = 10  # findings at once
_ADVICE = {
    "KV203": 'Make its shapes smaller or larger, or give it another "material": its mass is unlikely.',
    "KV206": 'Its mass is unlikely beside that of the others: check the "size" of its shapes and its "material".',
    "KV225": 'Check "lower" and "upper" of the joint whose "child" it is.',
    "KV230": 'Check its "pivot" and those of its bars, their "axis", and "mimic", or leave "mimic" out of them.',
    "KV303": 'Place its shapes ("xyz") so that it touches or nearly touches its "parent".',
}
"""Warnings that a model can act on -> what to change."""


def in_blueprint_words(findings: Iterable[Finding]) -> list[str]:
    """Return what a validation found that a blueprint can correct, one line for each cause.

    Args:
        findings: Errors and warnings of the model; warnings that no field of a blueprint can change are left away.
    """
    lines: dict[tuple[str, str], str] = {}
    for item in findings:
        advice = _ADVICE.get(item.check, "")
        if item.severity is not Severity.ERROR and not advice:
            continue
        about = item.joint.removesuffix("_joint") if item.joint else item.link or ""
        subject = f'The joint whose "child" is "{about}": ' if item.joint else f'The part "{about}": ' if about else ""
        line = f"{subject}{item.message} {advice or _remedy(item, about)}".strip()
        lines.setdefault((item.check, about), line)
    return list(lines.values())[:_MOST]


def _remedy(item: Finding, about: str) -> str:
    """A remedy in the fields of a blueprint instead of those of URDF."""
    said = item.remedy
    for urdf, field in (
        ("<axis>", f'"axis" of the joint whose "child" is "{about}"'), ("<limit>", '"lower" and "upper"'),
        ("<origin>", '"pivot"'), ("<collision>", '"shapes"'), ("<inertial>", '"material"'), ("<mass>", '"material"'),
    ):  # fmt: skip
        said = said.replace(urdf, field)
    return said
