"""Pages in a real browser: the model moves, tables sort and filter, links open their target, nothing is loaded."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.evaluation.nightly.comparison import Night, compare, counts
from kinematify.evaluation.nightly.night_pages import anchor, night_page, nights_page
from kinematify.evaluation.nightly.runs import Problem, Run
from kinematify.robot.read import read_robot
from kinematify.validation.formats.html import as_html
from kinematify.validation.formats.view_data import view_data
from tests.browser import opened, wait_until
from tests.reports import add_checks, full_report

if TYPE_CHECKING:
    from collections.abc import Iterator

_MODEL = "models/door.urdf"
_URDF = """<robot name="door">
<link name="frame"><visual><geometry><box size="1 0.1 2"/></geometry></visual></link>
<link name="door"><visual><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.04 1.8"/></geometry></visual></link>
<link name="latch"><visual><geometry><box size="0.1 0.02 0.02"/></geometry></visual></link>
<joint name="hinge_1" type="revolute"><parent link="frame"/><child link="door"/><origin xyz="-0.4 -0.1 0"/>
<axis xyz="0 0 -1"/><limit lower="0" upper="1.5" effort="1" velocity="1"/></joint>
<joint name="follow" type="prismatic"><parent link="door"/><child link="latch"/><origin xyz="0.8 -0.1 0"/>
<axis xyz="1 0 0"/><limit lower="0" upper="0.15" effort="1" velocity="1"/>
<mimic joint="hinge_1" multiplier="0.1"/></joint>
</robot>"""


_COLORS = {name: np.array([0.2, 0.4, 0.8]) for name in ("frame", "door", "latch")}
"""Of the bodies of the door, sRGB."""


@pytest.fixture(scope="module", autouse=True)
def _known_checks() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        add_checks(patch)
        yield


@pytest.fixture(scope="module")
def report_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("page")
    (folder / "door.urdf").write_text(_URDF)
    scene = view_data(read_robot(folder / "door.urdf", geometry="shown"), faces=1000, colors=_COLORS)
    page = folder / "report.html"
    page.write_text(as_html([full_report()], {}, {_MODEL: json.dumps(scene)}), encoding="utf-8")
    return page


def test_sliders_move_the_model_and_tables_filter_and_sort(report_page: Path) -> None:
    with opened(report_page.as_uri()) as (page, messages):
        page.wait_for_selector(".viewer[data-ready=yes]")
        canvas, slider = page.locator(".viewer canvas"), page.locator("input[data-joint=hinge_1]")
        assert page.locator(".viewer input[type=range]").count() == 1, "a follower has no slider"
        at_rest = canvas.screenshot()
        slider.focus()
        for _ in range(3):
            page.keyboard.press("PageUp")
        assert "deg" in page.locator(".sliders output").inner_text()
        assert page.locator(".sliders output").inner_text() != "0.0 deg"
        wait_until(page, lambda: canvas.screenshot() != at_rest)
        moved = canvas.screenshot()
        canvas.focus()
        page.keyboard.press("ArrowLeft")
        wait_until(page, lambda: canvas.screenshot() != moved)
        page.locator("button[data-play=hinge_1]").click()
        page.wait_for_selector("button[data-play=hinge_1][aria-pressed=true]")
        page.locator("button[data-reset]").click()
        assert page.locator(".sliders output").inner_text() == "0.0 deg"
        right, up, back = (np.array(axis) for axis in page.evaluate("viewers[0].axes()"))
        assert np.allclose(np.cross(right, up), back), "the picture is not mirrored"
        assert page.evaluate("viewers[0].poses()[2][3]") == pytest.approx(0.4, abs=1e-6)  # latch, by its leader
        cards = page.locator(".finding:visible").count()
        page.locator("input[name=severity][value=warning]").uncheck()
        assert 0 < page.locator(".finding:visible").count() < cards
        head = page.locator("#joints-0 th").first
        head.locator("button").press("Enter")
        assert head.get_attribute("aria-sort") == "ascending"
        assert messages == []
        page.emulate_media(media="print")
        assert not page.locator(".filters").is_visible()
        assert not page.locator(".viewer").is_visible()


def test_a_finding_is_shown_where_it_was_seen(report_page: Path) -> None:
    with opened(report_page.as_uri(), dark=True) as (page, messages):
        page.wait_for_selector(".viewer[data-ready=yes]")
        page.locator(".finding button[data-show]").first.click()
        assert page.evaluate("viewers[0].q.hinge_1") == pytest.approx(0.5)
        assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(20, 22, 26)"
        assert messages == []


AXIS = Problem(id="axis hinge", check="axis", severity="error", text="The axis is off by 40 deg.")


def runs(objects: int, night: int) -> tuple[Run, ...]:
    found = []
    for k in range(objects):
        values = {"angle_deg": 0.1 * k + 0.01 * night, "types": 1.0, "ted": 0.0, "root": 1.0, "limit_iou": 0.9}
        base = Run(
            scenario="s", content="c", object=f"object_{k:02d}", kind="everyday", what="accuracy", case="rest",
            status="ok", seconds=1.0 + k, values=values,
            problems=(AXIS,) if (k, night) == (3, 1) else (),
        )  # fmt: skip
        texts = tuple(
            Problem(id=f"KV34{n} joint hinge_{n}", check=f"KV34{n}", severity="warning", text="x" * 120)
            for n in range(5)
        )
        counted = {"errors": 0.0, "warnings": 5.0, "notes": 0.0}
        families = {"KV1": "pass", "KV3": "warn", "KV8": "skipped"}
        found += [replace(base, case=case) for case in ("rest", "random-0", "random-1", "random-2", "yaw37")]
        found += [
            replace(
                base, what="validation", case=case, status="warn", values=counted, problems=texts, families=families
            )
            for case in ("truth", "inferred")
        ]
    return tuple(found)


def nights(objects: int, count: int) -> list[Night]:
    found: list[Night] = []
    for number in range(count):
        done = runs(objects, number)
        last = found[-1] if found else None
        before = {run.place: [run] for run in last.runs} if last else {}
        changes = compare(done, before, same_machine=True)
        name = f"2026-01-{number + 1:02d}-abc"
        header = {
            "started": name, "commit": "abc", "dirty": False, "processor": "2 x none", "workers": 2,
            "objects": objects, "seconds": 60.0, "runs": len(done), "compared": last.name if last else None,
            "counts": counts(changes),
        }  # fmt: skip
        found.append(Night(name=name, header=header, runs=done, changes=changes))
    return found


def test_pages_of_nights(tmp_path: Path) -> None:
    history = nights(12, 2)
    for night in history:
        (tmp_path / night.name).mkdir()
        (tmp_path / night.name / "index.html").write_text(night_page(night), encoding="utf-8")
    (tmp_path / "index.html").write_text(nights_page(history), encoding="utf-8")
    problem = anchor("problem", "object_03", "accuracy", "rest", AXIS.id)
    with opened(f"{(tmp_path / history[1].name / 'index.html').as_uri()}#{problem}") as (page, messages):
        assert page.locator(f"#{problem}").is_visible(), "a link to a problem opens the section that holds it"
        assert page.evaluate("document.documentElement.scrollHeight") <= 4 * 800, "the night is folded"
        page.locator("details", has=page.locator("#accuracy")).locator("summary").first.click()
        rows = page.locator("#accuracy tbody tr:visible")
        everything = rows.count()
        page.locator("input[data-table=accuracy]").fill("object_03 yaw37")
        assert (everything, rows.count()) == (60, 1)
        page.locator("input[data-table=accuracy]").fill("")
        head = page.locator("#accuracy th", has_text="axis angle")
        head.locator("button").click()
        head.locator("button").click()
        assert page.locator("#accuracy tbody tr").first.inner_text().startswith("object_11")
        page.evaluate("dispatchEvent(new Event('beforeprint'))")
        assert page.locator("details:not([open])").count() == 0, "paper cannot be unfolded"
        page.goto((tmp_path / "index.html").as_uri())
        assert page.locator("#nights tbody tr").count() == 2
        assert messages == []


def test_names_are_escaped_in_the_pages_of_nights() -> None:
    (night,) = nights(2, 1)
    named = replace(night.runs[0], object="<img src=x onerror=alert(1)>", problems=(replace(AXIS, text="<b>"),))
    page = night_page(replace(night, name='"><script>', runs=(named,)))
    assert "<img" not in page
    assert "<b>" not in page
    assert '"><script>' not in page
    assert "&lt;img src=x" in page


@pytest.mark.parametrize("name", ["</script><script>document.title='x'</script>", '"><img src=x onerror=alert(1)>'])
def test_names_cannot_break_out_of_the_viewer(tmp_path: Path, name: str) -> None:
    (tmp_path / "door.urdf").write_text(_URDF)
    scene = view_data(read_robot(tmp_path / "door.urdf", geometry="shown"), faces=1000, colors=_COLORS)
    assert scene is not None
    scene["joints"][0]["name"] = name
    page = tmp_path / "report.html"
    page.write_text(as_html([full_report()], {}, {_MODEL: json.dumps(scene)}), encoding="utf-8")
    with opened(page.as_uri()) as (shown, messages):
        assert shown.title().startswith("kinematify validate")
        assert shown.locator("img[src=x]").count() == 0
        assert not [line for line in messages if line.startswith("request")]
