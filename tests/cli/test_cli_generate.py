"""`kinematify generate`: sentences, categories, corpora, and that the inference sees the parts alone."""

from __future__ import annotations

import json
import math
import shutil
from pathlib import Path

import numpy as np
import pytest

from kinematify.cli.app import run
from kinematify.cli.verdict import describe_briefly
from kinematify.creation.generated_model import GeneratedModel
from kinematify.generate.reader import read_sentence
from kinematify.robot.read import read_robot
from kinematify.validation.finding import Severity
from tests.reports import add_checks, finding, report, result

SENTENCE = "a cabinet with one door above two drawers, 60 cm wide"


@pytest.fixture(scope="module")
def generated(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict]:
    folder = tmp_path_factory.mktemp("generated")
    answer = folder / "answer.json"
    assert run(["generate", "--text", SENTENCE, "-o", str(folder / "cabinet"), "--infer", "--json", str(answer)]) == 0
    return folder / "cabinet", json.loads(answer.read_text())


def test_a_sentence_becomes_an_exact_model_its_parts_and_what_is_inferred_from_them(generated):
    out, answer = generated
    assert sorted(path.stem for path in (out / "parts").iterdir()) == ["body", "door_1", "drawer_1", "drawer_2"]
    assert {path.name for path in out.iterdir()} == {
        *("model.urdf", "meshes", "preview.png", "parts", "truth.json", "source.json", "inferred"),
        *("validation.json", "validation.html"),
    }
    assert {path.name for path in (out / "inferred").iterdir()} == {
        *("model.urdf", "meshes", "preview.png", "inference.json")
    }
    assert answer["category"] == "cabinet"
    assert answer["differences"] == answer["unread"] == []
    assert answer["accuracy"]["types_right"] == answer["accuracy"]["joints"] == 3
    assert answer["accuracy"]["largest_axis_angle_deg"] < 1.0


def test_the_model_is_validated(generated):
    out, answer = generated
    assert answer["validation"]["verdict"] in {"pass", "warn"}
    assert answer["validation"]["errors"] == []
    report = json.loads((out / "validation.json").read_text())
    assert report["verdict"] == answer["validation"]["verdict"]
    assert sum(check["status"] == "pass" for check in report["checks"]) > 50
    assert b"data:image/png" in (out / "validation.html").read_bytes()


def test_the_status_follows_the_verdict(tmp_path):
    made = read_sentence(SENTENCE).made()
    for judged, status in ((None, 0), (report(result(finding())), 1), (report(interrupted=True), 130)):
        found = GeneratedModel(out=tmp_path, made=made, model=None, inference=None, report=judged)
        assert found.exit_status == status


def test_the_short_verdict_tells_errors_in_full_and_counts_warnings(monkeypatch):
    add_checks(monkeypatch)
    warning = finding(severity=Severity.WARNING, message="It is tight.")
    said = " ".join(describe_briefly(report(result(finding(), warning, warning))).split())
    assert "FAIL" in said
    assert "overlaps by 5" in said
    assert "(2 times)" in said
    assert "tight" not in said


def test_the_truth_describes_the_same_object(generated):
    out, _ = generated
    truth = json.loads((out / "truth.json").read_text())
    described = read_robot(out / "model.urdf", geometry="shown")
    assert sorted(truth["part_names"]) == sorted(link.name for link in described.links)
    by_child = {joint.child: joint for joint in described.joints}
    for joint in truth["joints"]:
        named = by_child[truth["part_names"][joint["child"]]]
        assert named.kind.value == joint["kind"]
        np.testing.assert_allclose(named.axis, joint["axis"], atol=1e-9)
        unlimited = {"lower": -math.inf, "upper": math.inf}
        limits = [unlimited[end] if joint[end] is None else joint[end] for end in unlimited]
        assert [named.lower, named.upper] == pytest.approx(limits)


def test_the_inference_sees_nothing_but_the_parts(generated, tmp_path):
    out, _ = generated
    shutil.copytree(out / "parts", tmp_path / "parts")
    assert run(["infer", str(tmp_path / "parts"), "-o", str(tmp_path / "again"), "--no-preview"]) == 0
    folders = (out / "inferred", tmp_path / "again")
    one, two = (read_robot(folder / "model.urdf", geometry="shown") for folder in folders)
    for first, second in zip(one.joints, two.joints, strict=True):
        assert (first.name, first.kind, first.parent) == (second.name, second.kind, second.parent)
        np.testing.assert_allclose(first.axis, second.axis, atol=1e-9)


def test_a_category_takes_settings_and_a_seed(tmp_path, capsys):
    given = ["--category", "cabinet", "--set", "doors=0", "--set", "drawers=1", "--seed", "4"]
    command = ["generate", *given, "-o", str(tmp_path / "one"), "--no-preview", "--no-validation"]
    assert run(command) == 0
    assert "Not validated" in capsys.readouterr().out.splitlines()[-1]
    assert not list((tmp_path / "one").glob("validation.*"))
    assert len(read_robot(tmp_path / "one" / "model.urdf", geometry="none").joints) == 1
    assert run([*command, "--infer", "--force"]) == 0
    assert "Against the known joints: 1 of 1 types right" in capsys.readouterr().out.splitlines()[-1]


def test_the_categories_and_their_parameters_are_listed(capsys):
    assert run(["generate", "--list", "--json", "-"]) == 0
    stated = json.loads(capsys.readouterr().out)
    (cabinet,) = [item for item in stated["categories"] if "wardrobe" in item["words"]]
    assert next(item["bounds"] for item in cabinet["parameters"] if item["unit"] == "m") == [0.1, 5.0]
    assert run(["generate", "--list"]) == 0
    assert "serial_arm" in capsys.readouterr().out
    assert run(["generate", "--list", "--category", "cabinet"]) == 0
    assert "0.1 to 5 m" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--text", ""], "empty"),
        (["--text", "a flying carpet"], "No kind of object is called"),
        (["--category", "cabnet"], "Did you mean cabinet"),
        (["--category", "cabinet", "--set", "drawer=2"], "Did you mean drawers"),
        (["--category", "cabinet", "--set", "drawers=500"], "from 0 to 40"),
        (["--category", "cabinet", "--set", "drawers"], "KEY=VALUE"),
        (["--strict", "--text", "a cabinet with a projector"], "Words not read: 'projector'"),
        (
            ["--text", "a cabinet", "--category", "cabinet"],
            "Give one of a sentence, --category, --request,",
        ),
        ([], "Give one of a sentence, --category, --request,"),
    ],
)
def test_bad_requests_end_with_status_two_and_a_reason(arguments, reason, tmp_path, capsys):
    assert run(["generate", *arguments, "-o", str(tmp_path / "out")]) == 2
    assert reason in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_sentence_needs_no_option(tmp_path, capsys):
    plain = ["--no-validation", "--no-preview", "-o"]
    assert run(["generate", "a", "garage", "door", *plain, str(tmp_path / "words")]) == 0
    assert run(["generate", "--text", "a garage door", *plain, str(tmp_path / "option")]) == 0
    files = [(tmp_path / folder / "model.urdf").read_bytes() for folder in ("words", "option")]
    assert files[0] == files[1]
    capsys.readouterr()
    assert run(["generate", "a door", "--text", "a gate", *plain, str(tmp_path / "both")]) == 2
    assert 'given twice: "a door" and --text "a gate"' in capsys.readouterr().err
    assert not (tmp_path / "both").exists()


def test_what_is_not_as_asked_and_words_that_were_not_read_are_listed_last_and_in_the_answer(tmp_path, capsys):
    out, answer = tmp_path / "out", tmp_path / "answer.json"
    command = [
        "generate",
        "--text",
        "an office chair on nine casters and a projector",
        "-o",
        str(out),
        "--json",
        str(answer),
    ]
    assert run([*command, "--no-validation", "--no-preview"]) == 1
    said = ["Not as asked: caster: 9 asked for, there are 5", "Words not read: 'projector'"]
    assert capsys.readouterr().out.splitlines()[-2:] == said
    assert json.loads(answer.read_text())["differences"] == [said[0].partition(": ")[2]]
    assert json.loads((out / "source.json").read_text())["request"]["kind"] == "office_chair"


def test_without_a_place_for_the_result_it_says_so(capsys):
    assert run(["generate", "--text", "a cabinet"]) == 2
    assert "-o" in capsys.readouterr().err


def test_a_blueprint_is_built_as_it_says(tmp_path):
    page = Path(__file__, "../../../docs/generate.md").resolve().read_text(encoding="utf-8")
    (tmp_path / "toolbox.yaml").write_text(page.split("```yaml")[1].split("```")[0])
    out = tmp_path / "toolbox"
    assert run(["generate", "--blueprint", str(tmp_path / "toolbox.yaml"), "-o", str(out), "--no-preview"]) == 0
    (joint,) = read_robot(out / "model.urdf").joints
    assert (joint.parent, joint.child, joint.upper) == ("body", "lid", 1.9)
    assert json.loads((out / "validation.json").read_text())["verdict"] in {"pass", "warn"}


@pytest.mark.parametrize(
    "more", [["--text", "a box"], ["--category", "box"], ["--seed", "3"], ["--set", "a=b"]], ids=str
)
def test_a_blueprint_goes_with_nothing_else_that_says_what_to_build(more, tmp_path):
    assert run(["generate", "--blueprint", str(tmp_path / "a.yaml"), "-o", str(tmp_path / "out"), *more]) == 2


def test_a_blueprint_that_cannot_be_built_leaves_nothing_behind(tmp_path, capsys):
    (tmp_path / "bad.yaml").write_text("name: bad\nparts: []\njoints: []\n")
    assert run(["generate", "--blueprint", str(tmp_path / "bad.yaml"), "-o", str(tmp_path / "out")]) == 2
    assert "parts: " in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
