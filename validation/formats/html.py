"""One HTML file that opens from disk: nothing is loaded from elsewhere, and without scripts all of it can be read."""

from __future__ import annotations

import base64
import json
import math
import struct
from typing import TYPE_CHECKING

from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, Severity
from kinematify.validation.formats.html_frame import badge, page, table, text
from kinematify.validation.formats.html_motion import show_button, viewer
from kinematify.validation.formats.report_content import (
    Table,
    block_of,
    check_table,
    family_table,
    is_pair_note,
    joint_table,
    number,
    pair_note_table,
    summary_words,
    title,
)
from kinematify.validation.run.outcome import Unusable, severity_counts

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.validation.finding import Finding
    from kinematify.validation.formats.report_content import FindingBlock
    from kinematify.validation.run.outcome import Outcome
    from kinematify.validation.run.report import ValidationReport
    from kinematify.validation.summary import PairSummary, PairTable

_COUNTS = ("", "", "number", "number", "number", "number", "number")
"""Classes of the columns of the table of families."""
_MATRIX_AT_MOST = 40
"""Bodies; a larger matrix is read by nobody."""
_OPEN_AT_MOST = 10
_CLEAR = "\N{MIDDLE DOT}"


def as_html(outcomes: Sequence[Outcome], pictures: Mapping[str, bytes], scenes: Mapping[str, str] | None = None) -> str:
    """Return the outcomes as a page.

    Args:
        outcomes: In the order of the models.
        pictures: PNG of a model, keyed by its path as given; may lack some.
        scenes: JSON of a model for the viewer in the page; likewise.
    """
    scenes = scenes or {}
    title_text = f"kinematify validate: {_headline(outcomes)}"
    body = [
        f"<h1>{text(title_text)}</h1>",
        _contents(outcomes) if len(outcomes) > 1 else "",
        _filters(outcomes),
        *(
            _section(index, outcome, pictures.get(outcome.model, b""), scenes.get(outcome.model, ""))
            for index, outcome in enumerate(outcomes)
        ),
        _explained(outcomes),
    ]
    return page(title_text, body, scripts=("viewer.js",) if scenes else ())


def _headline(outcomes: Sequence[Outcome]) -> str:
    if len(outcomes) == 1:
        return f"{outcomes[0].verdict}, {outcomes[0].model}"
    failed = sum(outcome.verdict in ("fail", "unusable") for outcome in outcomes)
    return f"{len(outcomes)} models, {failed} of them not good"


def _contents(outcomes: Sequence[Outcome]) -> str:
    rows = [
        (
            f'<a href="#model-{index}">{text(outcome.model)}</a>',
            badge(outcome.verdict),
            *(("", "", "") if isinstance(outcome, Unusable) else _counts(outcome)),
        )
        for index, outcome in enumerate(outcomes)
    ]
    return table(
        ("model", "verdict", "errors", "warnings", "notes"),
        rows,
        name="models",
        classes=("", "", "number", "number", "number"),
    )


def _counts(report: ValidationReport) -> tuple[str, ...]:
    counts = severity_counts(report)
    return tuple(str(counts.get(severity, 0)) for severity in Severity)


def _filters(outcomes: Sequence[Outcome]) -> str:
    """Boxes for the severities and causes that occur; nothing where there is nothing to choose."""
    findings = [finding for outcome in outcomes if not isinstance(outcome, Unusable) for finding in outcome.findings]
    if not findings:
        return ""
    severities = [item for item in Severity if any(finding.severity is item for finding in findings)]
    causes = [item for item in Cause if any(finding.cause is item for finding in findings)]
    boxes = [_box("severity", item.value) for item in severities] + [_box("cause", item.value) for item in causes]
    return f'<div class="filters">Show {"".join(boxes)}<span id="shown" class="faint"></span></div>'


def _box(kind: str, value: str) -> str:
    return f'<label><input type="checkbox" name="{kind}" value="{value}" checked> {value}</label>'


def _section(index: int, outcome: Outcome, picture: bytes, scene: str) -> str:
    heading = f'<h2 id="model-{index}">{badge(outcome.verdict)} {text(outcome.model)}</h2>'
    if isinstance(outcome, Unusable):
        return f"<section>{heading}<p>{text(outcome.message)}</p></section>"
    parts = [
        heading,
        f"<p>{text(outcome.as_loaded)}</p>" if outcome.as_loaded else "",
        f"<p>{text(summary_words(outcome))}</p>",
        "<h3>Findings</h3>",
        _findings(index, outcome, with_viewer=bool(scene)),
        viewer(index, scene),
        _picture(picture),
        _table("Families", family_table(outcome), f"families-{index}", _COUNTS),
        _table("Joints", joint_table(outcome), f"joints-{index}") if outcome.joints else "",
        _pair_matrix(index, outcome.pairs),
        _pairs(index, outcome),
        _checks(index, outcome),
        _environment(outcome),
    ]
    return "<section>" + "\n".join(part for part in parts if part) + "</section>"


def _table(heading: str, content: Table, name: str, classes: Sequence[str] = ()) -> str:
    return f"<h3>{heading}</h3>{_plain_table(content, name, classes)}"


def _plain_table(content: Table, name: str, classes: Sequence[str] = ()) -> str:
    return table(content.headings, [tuple(map(text, row)) for row in content.rows], name=name, classes=classes)


def _picture(png: bytes) -> str:
    if not png:
        return ""
    data = base64.b64encode(png).decode("ascii")
    return (
        f'<img class="picture" alt="The model at rest, and with every joint moved"{_extent(png)} '
        f'src="data:image/png;base64,{data}">'
    )


def _extent(png: bytes) -> str:
    """Width and height as attributes, so that the page does not jump when the picture is there."""
    if len(png) < _PNG_SIZES.stop:
        return ""
    width, height = struct.unpack(">II", png[_PNG_SIZES])
    return f' width="{width}" height="{height}"'


_PNG_SIZES = slice(16, 24)
"""Where the first chunk of a PNG has width and height."""


def _findings(index: int, report: ValidationReport, *, with_viewer: bool) -> str:
    groups = [item for item in report.groups if not is_pair_note(item)]
    cards = (
        _finding(
            block_of([item]), f"finding-{index}-{k + 1}", _shown(index, report, item.finding) if with_viewer else ""
        )
        for k, item in enumerate(groups)
    )
    return "".join(cards) or "<p>None.</p>"


def _shown(index: int, report: ValidationReport, finding: Finding) -> str:
    """A button that shows where a finding was seen; empty if it names no place."""
    links = [*(finding.pair or ()), *([finding.link] if finding.link else [])]
    joints = {joint.joint for joint in report.joints}
    joint = finding.joint if finding.joint in joints and not links else None
    q = {name: value for name, value in (finding.q or {}).items() if name in joints and math.isfinite(value)}
    return f"<p>{show_button(index, q, links, 'Show in 3-D', joint)}</p>" if links or q or joint else ""


def _finding(block: FindingBlock, anchor: str, button: str) -> str:
    (finding,) = block.findings
    severity = block.severity.value
    return (
        f'<div id="{anchor}" class="finding {severity}{" suppressed" if block.suppressed else ""}" '
        f'data-severity="{severity}" data-cause="{finding.cause.value}">'
        f'<p><strong>{severity} <a href="#check-{finding.check}">{text(block.title)}</a></strong> {block.cause} '
        f'<a class="faint" href="#{anchor}" aria-label="Link to this finding">#</a></p>'
        + (f'<p class="faint">{text(block.facts)}</p>' if block.facts else "")
        + f"<p>{text(block.message)}</p><p>{text(block.remedy)}</p>"
        + _code(block.code)
        + (f"<p>{text(block.suppressed)}</p>" if block.suppressed else "")
        + _consequences(block)
        + button
        + "</div>"
    )


def _consequences(block: FindingBlock) -> str:
    """Return what follows from a finding, folded up; nothing if nothing does."""
    items = "".join(
        f'<li><a href="#check-{item.check}">{text(title(item))}</a>: {text(item.message)}'
        f"{_code(item.reproduction or '')}</li>"
        for item in block.consequences
    )
    return f"<details><summary>{text(block.follows)}</summary><ul>{items}</ul></details>" if items else ""


def _code(code: str) -> str:
    return f"<pre>{text(code)}</pre>" if code else ""


def _pair_matrix(index: int, pairs: PairTable | None) -> str:
    """Which bodies meet which: a matrix for the eye, and a table with the reason of every pair; empty without any."""
    if pairs is None or len(pairs.bodies) < 2:
        return ""
    rest = len(pairs.bodies) * (len(pairs.bodies) - 1) // 2 - len(pairs.pairs)
    opened = " open" if len(pairs.bodies) <= _OPEN_AT_MOST else ""
    inner = (_pair_grid(index, pairs) if len(pairs.bodies) <= _MATRIX_AT_MOST else "") + _pair_table(index, pairs.pairs)
    words = f"{len(pairs.pairs)} touch at rest or meet, {rest} stay clear in all that was looked at"
    return f"<details{opened}><summary>Pairs of bodies: {words}</summary>{inner}</details>"


def _pair_grid(index: int, pairs: PairTable) -> str:
    known = {frozenset(item.pair): item for item in pairs.pairs}
    head = "".join(f'<th scope="col" title="{text(body)}">{k + 1}</th>' for k, body in enumerate(pairs.bodies))
    rows = "".join(
        f'<tr><th scope="row">{k + 1} {text(body)}</th>'
        + "".join(_pair_cell(body, other, known.get(frozenset((body, other)))) for other in pairs.bodies)
        + "</tr>"
        for k, body in enumerate(pairs.bodies)
    )
    body_rows = f"<thead><tr><th></th>{head}</tr></thead><tbody>{rows}</tbody>"
    return (
        '<div class="scroll" tabindex="0" role="region" aria-label="Matrix of pairs">'
        f'<table id="matrix-{index}"><caption>{_PAIR_LETTERS}</caption>{body_rows}</table></div>'
    )


_PAIR_LETTERS = (
    "J: joined and in contact at rest; R: in contact at rest; A: in contact nearly always; M: meet while a joint "
    f"moves; {_CLEAR}: stay clear."
)


def _pair_cell(body: str, other: str, item: PairSummary | None) -> str:
    if body == other:
        return "<td></td>"
    if item is None:
        return f'<td class="faint">{_CLEAR}</td>'
    letter = _pair_letter(item)
    state = ' class="fail"' if item.meets else ""
    return f'<td{state} title="{text(f"{body} - {other}: {_pair_reason(item)}")}">{letter}</td>'


def _pair_letter(item: PairSummary) -> str:
    first = "" if item.reason is None else {"joined": "J", "in contact at": "R"}.get(_reason_kind(item.reason), "A")
    return first + ("M" if item.meets else "")


def _reason_kind(reason: str) -> str:
    return next((start for start in ("joined", "in contact at") if reason.startswith(start)), "")


def _pair_reason(item: PairSummary) -> str:
    met = [f"meet while {joint} moves, from {number(value)}" for joint, value, _ in item.meets]
    return "; ".join([*([item.reason] if item.reason else []), *met])


def _pair_table(index: int, pairs: Sequence[PairSummary]) -> str:
    if not pairs:
        return ""
    rows = [
        (
            text(" - ".join(item.pair)),
            text(_pair_reason(item)),
            number(1e3 * item.at_rest),
            number(1e3 * item.tolerated),
            number(1e3 * max((depth for _, _, depth in item.meets), default=0.0)),
            show_button(index, {joint: value for joint, value, _ in item.meets[:1]}, item.pair, "Show"),
        )
        for item in pairs
    ]
    headings = ("pair", "reason", "at rest [mm]", "tolerated [mm]", "deeper on the way [mm]", "in 3-D")
    return table(headings, rows, name=f"pair-reasons-{index}", classes=("", "", "number", "number", "number", ""))


def _pairs(index: int, report: ValidationReport) -> str:
    """Notes about pairs, folded up; nothing if there are none."""
    content = pair_note_table(report)
    if not content.rows:
        return ""
    inner = _plain_table(content, f"pairs-{index}")
    return (
        f"<details><summary>{len(content.rows)} notes on pairs, such as why they may touch</summary>{inner}</details>"
    )


def _checks(index: int, report: ValidationReport) -> str:
    inner = _plain_table(check_table(report), f"checks-{index}", ("", "state", "number", ""))
    return f"<details><summary>All {len(report.checks)} checks</summary>{inner}</details>"


def _explained(outcomes: Sequence[Outcome]) -> str:
    """Return what each check looks at of which a finding is shown."""
    found = {f.check for outcome in outcomes if not isinstance(outcome, Unusable) for f in outcome.findings}
    checks = [CHECKS[name] for name in sorted(found)]
    if not checks:
        return ""
    parts = (
        f'<details id="check-{check.id}"><summary>{check.id} {text(check.fails)}</summary><p>{text(check.verifies)}</p>'
        f"<p>{text(check.matters)}</p><p>Remedy: {text(check.remedy)}</p></details>"
        for check in checks
    )
    return f"<section><h2>What these checks look at</h2>{''.join(parts)}</section>"


def _environment(report: ValidationReport) -> str:
    facts = json.dumps(report.as_json()["environment"], indent=2)
    return f"<details><summary>Environment and settings</summary><pre>{text(facts)}</pre></details>"
