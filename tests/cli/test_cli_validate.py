"""`kinematify validate` from end to end: exit statuses, reports, several models, bad input and Ctrl-C."""

from __future__ import annotations

import json
import os
import pty
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from kinematify.cli.app import run
from kinematify.errors import DescriptionError
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Severity
from kinematify.validation.run.needs import keys
from kinematify.validation.run.report import ValidationReport
from kinematify.validation.run.suppression_file import load_suppressions
from tests.reports import add_checks, finding, full_report, report, result

CONTRACT, ISAAC = {"KV820", "KV821"}, {"KV113"}
USUAL = [check for check in CHECKS.values() if not check.id.startswith("KV7") and check.id not in CONTRACT | ISAAC]
USUAL_KEYS = keys(USUAL)
"""KV7 runs only with --task."""
INERTIAL = """<inertial><origin xyz="{x} 0 {z}"/><mass value="2"/>
      <inertia ixx="0.05" iyy="0.05" izz="0.08" ixy="0" ixz="0" iyz="0"/></inertial>"""
SHAPE = '<{tag}><origin xyz="{x} 0 {z}"/><geometry><box size="0.4 0.4 {high}"/></geometry></{tag}>'


def link(name: str, *, x: float, z: float, high: float) -> str:
    """A box with mass, 0.4 m wide."""
    shapes = "".join(SHAPE.format(tag=tag, x=x, z=z, high=high) for tag in ("visual", "collision"))
    return f'<link name="{name}">{INERTIAL.format(x=x, z=z)}{shapes}</link>'


CHEST = f"""<?xml version="1.0"?>
<robot name="chest">
  {link("body", x=0.0, z=0.2, high=0.4)}
  {link("lid", x=0.2, z=0.03, high=0.05)}
  <joint name="hinge" type="revolute">
    <parent link="body"/><child link="lid"/><origin xyz="-0.2 0 0.4"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="1.5" effort="20" velocity="2"/>
  </joint>
</robot>
"""


@pytest.fixture
def chest(tmp_path: Path) -> Path:
    file = tmp_path / "chest.urdf"
    file.write_text(CHEST)
    return file


@pytest.fixture
def answered(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Let the command meet the reports that a test gives by file name instead of running engines for minutes."""
    add_checks(monkeypatch)
    answers: dict[str, Any] = {}

    def answer(path: Path, **asked: Any) -> ValidationReport:
        answers["asked"] = asked
        what = answers[path.name]
        if isinstance(what, BaseException):
            raise what
        return report(*what.checks, model=str(path), interrupted=bool(what.environment["interrupted"]))

    monkeypatch.setattr("kinematify.validation.run.model_validation.run_checks", answer)
    return answers


@pytest.fixture(scope="module")
def real(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, subprocess.CompletedProcess[str]]:
    """One run of everything in a process of its own, with a report of each kind."""
    folder = tmp_path_factory.mktemp("validate")
    (folder / "chest.urdf").write_text(CHEST)
    reports = [f"--{name}={folder / 'report'}.{name}" for name in ("json", "junit", "sarif", "html")]
    words = [sys.executable, "-m", "kinematify", "validate", str(folder / "chest.urdf"), *reports]
    return folder, subprocess.run(words, capture_output=True, text=True, check=False, timeout=400)


def test_a_sound_chest_has_no_error(real: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    folder, done = real
    answer = json.loads((folder / "report.json").read_text())
    assert [f for f in answer["findings"] if f["severity"] == "error"] == []
    assert done.returncode == 0, done.stderr
    assert done.stdout.split()[0] in ("PASS", "WARN")
    assert "\x1b" not in done.stdout
    assert "Traceback" not in done.stderr


def test_every_check_is_in_every_report(real: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    folder, _ = real
    expected = USUAL_KEYS
    reported = json.loads((folder / "report.json").read_text())["checks"]
    assert tuple((check["check"], check["engine"]) for check in reported) == expected
    cases = list(etree.parse(folder / "report.junit").getroot().iter("testcase"))
    assert len(cases) == len(expected)
    assert json.loads((folder / "report.sarif").read_text())["runs"][0]["invocations"][0]["executionSuccessful"]


@pytest.mark.parametrize(
    ("severity", "expected"),
    [(Severity.ERROR, (1, "FAIL")), (Severity.WARNING, (0, "WARN")), (Severity.NOTE, (0, "PASS"))],
)
def test_only_errors_change_the_exit_status(
    answered: dict[str, Any],
    chest: Path,
    capsys: pytest.CaptureFixture[str],
    severity: Severity,
    expected: tuple[int, str],
) -> None:
    answered["chest.urdf"] = report(result(finding(severity=severity)))
    status = run(["validate", str(chest)])
    assert (status, capsys.readouterr().out.split()[0]) == expected


def test_everything_is_reported_when_it_is_asked_for(
    answered: dict[str, Any], chest: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    answered["chest.urdf"] = full_report()
    assert run(["validate", str(chest), "--all"]) == 1
    text = capsys.readouterr().out
    assert "2 errors, 1 warning, 1 note; 1 finding suppressed; 2 of 5 checks ran, 1 skipped, 2 blocked; 2.5 s" in text
    assert text.index("FAIL") < text.index("KV3 kinematics by geometry") < text.index("error KV396")
    for part in (
        "joint hinge_1; at hinge_1 0.5; 5 mm, limit 1 mm; line 7",
        "Remedy: Turn the axis of hinge_1.",
        "cause: physics",
        "Suppressed, does not count: the seal is soft",
        "skipped (KV396): it does not apply",
        "blocked (KV896): no mesh",
        "prismatic, axis (0, 0, 1), score 0.75",
        "0 to 90 deg",
    ):
        assert part in text, part


def test_a_report_begins_with_the_verdict_and_tells_what_counts(
    answered: dict[str, Any], chest: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    answered["chest.urdf"] = full_report()
    assert run(["validate", str(chest)]) == 1
    text = capsys.readouterr().out
    assert text.startswith("FAIL")
    assert len(text.splitlines()) <= 30
    for part in (
        "error KV396 Doors & drawers of KV396 jam",
        "Remedy: Turn the axis of hinge_1.",
        "warning KV396",
        "blocked (KV896): no mesh",
        "1 note: KV396.",
        "--all: notes",
    ):
        assert part in text, part
    for part in ("the seal is soft", "it does not apply", "They touch at rest", "free travel"):
        assert part not in text, part


def test_no_report_is_longer_than_it_may_be(
    answered: dict[str, Any], chest: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = [f"door {chr(97 + k % 26)}{chr(97 + k // 26)}" for k in range(200)]
    answered["chest.urdf"] = report(result(*(finding(message=f"The {name} jams.", joint=None) for name in names)))
    run(["validate", str(chest)])
    lines = capsys.readouterr().out.splitlines()
    assert 50 < len(lines) <= 60
    shown = sum(line.startswith("chest.urdf:7: error KV396") for line in lines)
    assert f"{200 - shown} more findings: --all lists them." in lines
    run(["validate", str(chest), "--all"])
    text = capsys.readouterr().out
    assert all(f"The {name} jams." in text for name in names)


def test_what_follows_from_a_finding_is_reported_under_it(
    answered: dict[str, Any], chest: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cause, code = finding(), "import mujoco\nmodel = mujoco.MjModel.from_xml_path('door.urdf')\nprint(model)"
    stops = [
        finding(check="KV896", engine="mujoco", message="It stops.", follows_from=cause, reproduction=code)
        for _ in range(2)
    ]
    answered["chest.urdf"] = report(result(cause), result(*stops, check="KV896", engine="mujoco"))
    run(["validate", str(chest)])
    text = capsys.readouterr().out
    assert ": 1 error, no warnings" in text.splitlines()[0]
    assert "Follows from it: KV896 [mujoco] 2 times." in text
    assert "To see it: mujoco.MjModel.from_xml_path('door.urdf') and what --all prints." in text
    assert "It stops." not in text
    run(["validate", str(chest), "--all"])
    text = capsys.readouterr().out
    assert "KV896 Doors & drawers of KV896 jam [mujoco]: It stops." in text
    assert "import mujoco" in text


def test_several_models_end_with_a_table_and_the_worst_status(
    answered: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    answered.update(
        {
            "a.urdf": report(result()),
            "b.urdf": full_report(),
            "c.urdf": DescriptionError("c.urdf is MJCF, not URDF. Convert it."),
        }
    )
    for name in ("a.urdf", "b.urdf", "c.urdf"):
        (tmp_path / name).write_text(CHEST)
    assert run(["validate", str(tmp_path), "--json", str(tmp_path / "r.json"), "--junit", str(tmp_path / "r.xml")]) == 2
    captured = capsys.readouterr()
    rows = [line.split() for line in captured.out.splitlines()[-3:]]
    assert [row[1] for row in rows] == ["pass", "fail", "unusable"]
    assert "c.urdf is MJCF, not URDF. Convert it." in captured.out
    assert "b.urdf (2 of 3): " not in captured.out
    values = [json.loads(line) for line in (tmp_path / "r.json").read_text().splitlines()]
    assert [value["verdict"] for value in values] == ["pass", "fail", "unusable"]
    assert etree.parse(tmp_path / "r.xml").getroot().get("errors") == "2"


def test_json_stands_alone_on_stdout(answered: dict[str, Any], chest: Path, capsys: pytest.CaptureFixture[str]) -> None:
    answered["chest.urdf"] = full_report()
    assert run(["validate", str(chest), "--json", "-"]) == 1
    assert json.loads(capsys.readouterr().out)["verdict"] == "fail"


def test_choices_reach_the_run(answered: dict[str, Any], chest: Path, tmp_path: Path) -> None:
    answered["chest.urdf"] = report(result())
    words = [
        "--checks",
        "kv396, KV8*",
        "--skip",
        "KV896",
        "--engines",
        "pybullet,mujoco",
        "--budget",
        "7",
        "--seed",
        "3",
    ]
    assert run(["validate", str(chest), *words, "--jobs", "1", "--package-dir", str(tmp_path)]) == 0
    asked = answered["asked"]
    assert asked["selected"] == {"KV396", *(check for check in CHECKS if check.startswith("KV8"))} - {
        "KV896",
        *CONTRACT,
    }
    assert asked["engines"] == ("mujoco", "pybullet")
    assert (asked["settings"].budget.seconds, asked["settings"].seed) == (7.0, 3)
    assert asked["workers"] == 1
    assert asked["package_dirs"] == (tmp_path,)
    assert run(["validate", str(chest), "--engines", "none"]) == 0
    assert answered["asked"]["engines"] == ()
    assert answered["asked"]["selected"] == set(CHECKS) - CONTRACT - ISAAC
    for option, left_out in (("--contract", ISAAC), ("--isaac", CONTRACT)):
        assert run(["validate", str(chest), option]) == 0
        assert answered["asked"]["selected"] == set(CHECKS) - left_out


def test_suppressions_reach_the_run_and_useless_ones_are_named(
    answered: dict[str, Any], chest: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    answered["chest.urdf"] = report(result())
    (tmp_path / "accepted.yaml").write_text("- {check: KV396, where: door, reason: soft seal}")
    assert run(["validate", str(chest), "--suppress", str(tmp_path / "accepted.yaml")]) == 0
    assert [rule.where for rule in answered["asked"]["suppressions"]] == ["door"]
    assert "cover no finding and can go: KV396 at door" in capsys.readouterr().err


def test_a_model_stays_quiet_with_the_rules_that_were_suggested_for_it(
    chest: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    accepted = str(tmp_path / "accepted.yaml")
    chest.write_text(
        CHEST.replace('upper="1.5"', 'upper="90"')
        .replace('name="lid"', 'name="lid[1]"')
        .replace('link="lid"', 'link="lid[1]"')
    )  # degrees, and a name that is a pattern
    words = ["validate", str(chest), "--engines", "none", "--checks", "KV1*,KV2*"]
    assert run([*words, "--suggest-accept", accepted]) == 1
    rules = load_suppressions(Path(accepted))
    assert {rule.check for rule in rules} >= {"KV220"}
    assert all(rule.reason.startswith("not judged yet: ") for rule in rules)
    capsys.readouterr()
    again = ["--suppress", accepted, "--suggest-accept", accepted, "--json", "-"]
    assert run([*words, *again]) == 0
    reported = json.loads(capsys.readouterr().out)
    assert reported["verdict"] == "pass"
    assert all(item["suppressed"] for item in reported["findings"] if item["severity"] != "note")
    assert load_suppressions(Path(accepted)) == rules, "rules that hold are kept, and there is nothing to add"
    chest.write_text(chest.read_text().replace('<mass value="2"/>', '<mass value="-2"/>', 1))
    assert run([*words, "--suppress", accepted]) == 1, "what is new counts"


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--checks", "KV395"], "no check 'KV395'. Checks have ids such as KV301. Did you mean"),
        (["--checks", "KV396", "--skip", "KV3*"], "leave no check"),
        (["--engines", "mujuco"], "--engines names 'mujuco'"),
        (["--budget", "0"], "--budget is 0.0"),
        (["--budget", "nan"], "--budget is nan"),
        (["--package-dir", "no/such"], "--package-dir no/such is no folder"),
        (["--config", "no-such"], "There is no configuration no-such"),
        (["--suppress", "no.yaml"], "suppression file no.yaml cannot be read"),
        (["--json", "no/such/r.json"], "there is no folder no/such"),
        (["--html", "."], "it is a folder"),
        (["--html", "same", "--sarif", "same"], "name the same file"),
        (["no-such.urdf"], "There is no file or folder no-such.urdf"),
    ],
)
def test_wrong_words_end_with_2_before_any_run(
    answered: dict[str, Any], chest: Path, capsys: pytest.CaptureFixture[str], words: list[str], text: str
) -> None:
    assert run(["validate", str(chest), *words]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert text in captured.err
    assert "asked" not in answered


def test_read_only_reports_are_noticed_before_the_run(
    answered: dict[str, Any],
    chest: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    report_file = tmp_path / "r.json"
    report_file.write_text("old")
    monkeypatch.setattr(
        os, "access", lambda path, mode: False
    )  # root, who runs this in a container, may write anything
    assert run(["validate", str(chest), "--json", str(report_file)]) == 2
    assert "it is read-only" in capsys.readouterr().err
    assert run(["validate", str(chest), "--json", str(tmp_path / "new.json")]) == 2
    assert "is read-only" in capsys.readouterr().err
    assert "asked" not in answered
    assert report_file.read_text() == "old"


@pytest.mark.parametrize(
    ("content", "text"),
    [
        (b"\x7fELF\x02\x01\x01\x00\x00", ""),
        (b'<mujoco model="m"><worldbody/></mujoco>', "no body"),
        (b'<robot xmlns:xacro="http://ros.org/wiki/xacro" name="x"><xacro:arm/></robot>', "xacro"),
    ],
    ids=["binary", "mjcf", "xacro"],
)
def test_what_is_no_urdf_ends_with_a_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes, text: str
) -> None:
    file = tmp_path / "model.urdf"
    file.write_bytes(content)
    assert run(["validate", str(file), "--json", str(tmp_path / "r.json")]) == 2
    message = capsys.readouterr().err
    assert text in message
    assert "Traceback" not in message
    assert json.loads((tmp_path / "r.json").read_text())["verdict"] == "unusable"


def test_errors_of_the_file_count_whatever_was_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "model.urdf"
    file.write_text(CHEST.replace('<box size="0.4 0.4 0.4"/>', '<mesh filename="none.stl"/>'))
    others = [check for check in CHECKS if not check.startswith("KV1")]
    words = ["--checks", others[0]] if others else []
    assert run(["validate", str(file), *words]) == 1
    assert "none.stl" in capsys.readouterr().out


def test_control_c_leaves_valid_partial_reports(tmp_path: Path) -> None:
    (tmp_path / "chest.urdf").write_text(CHEST)
    reports = [f"--{name}={tmp_path / 'r'}.{name}" for name in ("json", "junit", "sarif", "html")]
    process = subprocess.Popen(
        [sys.executable, "-m", "kinematify", "validate", str(tmp_path / "chest.urdf"), *reports],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stderr is not None
    assert "pre-check" in process.stderr.readline()
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to the whole group
    out, err = process.communicate(timeout=300)
    assert process.returncode == 130, err
    assert "Traceback" not in err
    assert "interrupted: partial" in out
    answer = json.loads((tmp_path / "r.json").read_text())
    assert answer["environment"]["interrupted"] is True
    assert len(answer["checks"]) == len(USUAL_KEYS)
    assert not json.loads((tmp_path / "r.sarif").read_text())["runs"][0]["invocations"][0]["executionSuccessful"]
    assert etree.parse(tmp_path / "r.junit").getroot().tag == "testsuites"
    assert "partial" in (tmp_path / "r.html").read_text()
    assert {path.name for path in tmp_path.iterdir()} == {"chest.urdf", "r.json", "r.junit", "r.sarif", "r.html"}


def test_interruption_of_the_second_model_keeps_the_first(
    answered: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("a.urdf", "b.urdf", "c.urdf"):
        (tmp_path / name).write_text(CHEST)
    answered.update({"a.urdf": report(result()), "b.urdf": KeyboardInterrupt()})
    assert run(["validate", str(tmp_path), "--json", str(tmp_path / "r.json")]) == 130
    assert json.loads((tmp_path / "r.json").read_text())["model"].endswith("a.urdf")
    assert "1 of 3 models" in capsys.readouterr().err


def test_python_works_in_a_plain_script(chest: Path) -> None:
    script = chest.with_name("script.py")
    script.write_text(
        "import kinematify\n"
        "print('started')\n"
        f"report = kinematify.validate({str(chest)!r}, engines=())\n"
        "assert isinstance(report, kinematify.ValidationReport)\n"
        "assert all(isinstance(finding, kinematify.Finding) for finding in report.findings)\n"
        "print(report.verdict)\n"
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False, timeout=400)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split()[0] == "started"
    assert done.stdout.split()[1:] in (["pass"], ["warn"])


@pytest.mark.parametrize(("variable", "colored"), [("", True), ("1", False)])
def test_colours_are_for_terminals_of_those_who_want_them(variable: str, colored: bool) -> None:
    code = "import click\nfrom kinematify.cli.options import say\nsay(click.style('FAIL', fg='red'))"
    ours, theirs = pty.openpty()
    words = [sys.executable, "-c", code]
    subprocess.run(words, stdout=theirs, check=True, timeout=300, env={**os.environ, "NO_COLOR": variable})
    os.close(theirs)
    shown = os.read(ours, 10_000).decode()
    os.close(ours)
    assert "FAIL" in shown
    assert ("\x1b[31m" in shown) is colored
