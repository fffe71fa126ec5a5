"""A language model writes blueprints, against a local server that behaves well, badly, slowly, and not at all."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from PIL import Image

from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.errors import EnvironmentFault, InputError, OutputError
from kinematify.generate.procedural.blueprint_file import described_blueprint
from kinematify.generate.providers.job import open_job
from kinematify.generate.providers.judge_blueprint import drawn_findings
from kinematify.generate.providers.language_model import (
    ADDRESS,
    EXAMPLES,
    KEY,
    MODEL,
    LanguageModel,
    built_answer,
    language_model,
)
from kinematify.generate.providers.source import check_prompt
from kinematify.robot.read import read_robot
from tests.generate.providers import chat_server
from tests.generate.providers.chat_server import ChatServer
from tests.places import BENCH

if TYPE_CHECKING:
    from collections.abc import Iterator

SETTINGS = load_config().sources.language_model.model_copy(
    update={"first_pause": 0.01, "longest_pause": 0.02, "tries": 2, "answer_seconds": 10.0}
)
TEXT = "a box with a lid"
ANSWERS = Path(__file__).with_name("answers")


CHECKLIST = [{"phrase": "a lid", "parts": ["lid"], "count": 1, "motion": "hinge"}]


def lidded(axis: float = -1.0, checklist: object = CHECKLIST, **more: object) -> str:
    """A box with a lid; it opens with the axis as it is, and into the box with the other one."""
    shape = {"kind": "box", "size": [0.4, 0.3, 0.2], "xyz": [0, 0, 0.1]}
    body = {"name": "body", "shapes": [shape], "material": "wood"}
    lid = {"name": "lid", "shapes": [{"kind": "box", "size": [0.4, 0.3, 0.02], "xyz": [0, 0, 0.211]}]}
    joint = {"type": "revolute", "parent": "body", "child": "lid", "axis": [axis, 0, 0], "pivot": [0, 0.15, 0.2005]}
    joint |= {"lower": 0, "upper": 1.5}
    blueprint = {"name": "box", "parts": [body, lid], "joints": [joint], **more}
    return json.dumps({"blueprint": blueprint, "checklist": checklist})


@pytest.fixture
def server() -> Iterator[ChatServer]:
    made = ChatServer(lidded())
    yield made
    made.close()


def model_at(server: ChatServer, **options: object) -> LanguageModel:
    return LanguageModel(server.url, "tester", chat_server.KEY, SETTINGS, **options)


def written(model: LanguageModel, folder: Path, judge=lambda *_: (), images: tuple[Path, ...] = (), text=TEXT):
    prompt = check_prompt(text, images, seed=0)
    with open_job(folder, "llm", prompt.digest(model.options())):
        return model.write(prompt, folder, judge, lambda *_: None)


def test_what_the_model_writes_is_built_and_judged(server, tmp_path):
    judged = []
    found = written(model_at(server), tmp_path, lambda made: judged.append(made) or ())
    assert [part.name for part in found.made.blueprint.parts] == ["body", "lid"]
    assert [made.blueprint.root for made in judged] == ["body"]
    assert (found.rounds, found.tokens, found.made.differences) == (1, 1000, ())
    system, user = server.requests[0]["messages"]
    assert "rounded_box" in system["content"], "it is given the shapes"
    kind = next(line for line in system["content"].splitlines() if line.startswith("box (box, chest box): "))
    assert "width=0.3 m [0.06 to 2 m]" in kind, "and kinds that are near, with their parameters"
    assert "parts: 1 body, 1 lid tilt 0 to " in kind, "and their parts, with how they move"
    assert "[open] (How far they" in system["content"], "and no unit as if it were a value"
    assert "outline (Corners radius, height [m]; either sense)" in system["content"], "and what fields mean"
    assert len(system["content"]) < 4 * 6000, "and no more than 6,000 tokens"
    assert user["content"] == TEXT


def test_a_request_is_filled_and_its_checklist_is_measured(server, tmp_path):
    request = {"kind": "cabinet", "parameters": {"doors": 2, "drawers": 0}}
    facts = [{"phrase": "a drawer", "parts": ["drawer"]}, {"phrase": "two doors", "parts": ["door"], "count": 2}]
    server.script = [json.dumps({"request": request, "checklist": facts})]
    found = written(model_at(server), tmp_path)
    assert found.made.request.kind == "cabinet"
    assert found.made.differences == ("'a drawer': no part is called drawer; there are body and door",)
    assert "no part is called drawer" in server.requests[1]["messages"][-1]["content"]


@pytest.mark.parametrize("answer", EXAMPLES.splitlines())
def test_the_examples_of_the_prompt_hold(answer):
    made = built_answer(json.loads(answer))
    assert made.differences == ()
    assert made.request or drawn_findings(made.blueprint) == []


LID = {"phrase": "a lid", "parts": ["lid"]}


@pytest.mark.parametrize(
    ("fact", "fault"),
    [
        ({"open": "60 deg"}, ""),
        ({"open": "1.0472 rad"}, ""),
        ({"open": 0.6667}, ""),
        ({"open": 0.5}, "open 45 deg was asked for, it is at 60 deg; its range is 0 to 90 deg"),
        ({"open": 1.0472}, "open: Value error, 1.0472 is no opening: a plain number is a share of the way"),
        ({"open": {"rad": 1.0}}, "{'rad': 1.0} is no opening"),
        ({"range": "0 to 90 deg"}, ""),
        ({"color": "red"}, ""),
        ({"color": "blue"}, "blue was asked for, it is red plastic"),
        ({"parts": ["body"], "material": "wood"}, ""),
        ({"parts": ["body"], "material": "metal"}, "metal was asked for, it is wood"),
        ({"parts": [], "material": "wood"}, ""),
        ({"parts": [], "color": "red"}, "red was asked for, it is wood"),
        ({"parts": [], "size": {"height": 0.221}}, ""),
        ({"parts": [], "size": {"height": 0.5, "width": 0.4}}, "height: 0.5 m was asked for, it is 0.221 m"),
        ({"parts": [], "size": {"height": 0.501}, "extended": True}, ""),
        ({"relation": "above", "to": ["body"]}, ""),
        ({"relation": "below", "to": ["body"]}, "lid: not below body"),
        ({"relation": "inside", "to": ["body"]}, "lid: not inside body"),
        ({"parts": ["body"], "relation": "inside", "to": ["body"]}, ""),
        ({"parts": ["body"], "motion": "fixed"}, ""),
        ({"motion": "fixed"}, "fixed was asked for, it is revolute"),
        ({"relation": "between", "to": ["body", "door"]}, "lid: not between body"),
        ({"relation": "above", "to": ["roof"]}, "lid: not above roof, which is no part"),
    ],
    ids=str,
)
def test_facts_are_measured_and_say_what_is_there(fact, fault):
    values = json.loads(lidded())
    values["blueprint"]["parts"][1]["color"] = "red"
    values["blueprint"]["joints"][0] |= {"upper": 1.570796, "value": 1.0472}
    try:
        found = built_answer({**values, "checklist": [{**LID, **fact}]}).differences
    except InputError as error:
        found = (str(error),)
    assert fault in "".join(found)
    assert bool(found) == bool(fault)


def test_a_fact_of_how_far_may_stand_beside_one_of_how():
    """Two facts of the same motion without a range may be two motions that one joint serves."""
    how, far = {**LID, "motion": "hinge"}, {**LID, "phrase": "by 86 degrees", "range": [0, 1.5]}
    assert built_answer(json.loads(lidded(checklist=[how, far]))).differences == ()
    (fault,) = built_answer(json.loads(lidded(checklist=[how, {**how, "phrase": "a flap"}]))).differences
    assert "'a flap': lid already serves 'a lid'" in fault


def test_what_drives_what_is_measured():
    """A knob that is fixed to a lid moves with it; a pedal does where its joint follows that of the lid."""
    values = json.loads(lidded())
    for name, x in (("knob", 0.0), ("pedal", 0.5)):
        shape = {"kind": "box", "size": [0.02, 0.02, 0.02], "xyz": [x, 0, 0.3]}
        values["blueprint"]["parts"].append({"name": name, "shapes": [shape]})
    fixed, hinge = {"type": "fixed", "parent": "lid", "child": "knob"}, values["blueprint"]["joints"][0]
    for mimic, holds in (({}, False), ({"mimic": {"leader": "lid", "multiplier": 0.5}}, True)):
        values["blueprint"]["joints"] = [hinge, fixed, {**hinge, "child": "pedal", **mimic}]
        for other, right in (("knob", True), ("pedal", holds), ("body", False)):
            fact = {"phrase": f"with the {other}", "parts": ["lid"], "relation": "coupled to", "to": [other]}
            assert (built_answer({**values, "checklist": [fact]}).differences == ()) is right, other


def test_values_of_joints_are_those_of_the_blueprint():
    """A lid that is shown half a radian open turns into its box half a radian beyond the closed pose."""
    values = json.loads(lidded(axis=1.0))["blueprint"]
    values["joints"][0] |= {"lower": -1, "upper": 1, "value": -0.5}
    lines = drawn_findings(described_blueprint(values))
    assert any('With the joint of "lid" at 0.5 rad, "body" and "lid"' in line for line in lines), lines


def test_the_diameter_of_a_rotor_is_that_of_its_circle():
    """Five blades are a rotor whose box is 5 % smaller than its circle."""
    values = json.loads(lidded())
    blades = {"kind": "box", "size": [0.5, 0.05, 0.01], "xyz": [0.25, 0, 0.3], "repeated": {"count": 5}}
    rotor = {"type": "continuous", "parent": "body", "child": "rotor", "axis": [0, 0, 1], "pivot": [0, 0, 0.3]}
    values["blueprint"]["parts"][1] = {"name": "rotor", "shapes": [blades]}
    values["blueprint"]["joints"] = [rotor]
    for parts in ([], ["rotor"]):
        for size, holds in ((1.0, True), (0.951, bool(parts))):
            fact = {"phrase": "1 m", "parts": parts, "size": {"diameter": size}}
            assert (built_answer({**values, "checklist": [fact]}).differences == ()) is holds


def test_words_and_a_fence_about_the_answer_do_no_harm(server, tmp_path):
    server.script = [f"Here it is:\n```json\n{lidded()}\n```\nEnjoy!"]
    assert written(model_at(server), tmp_path / "fence").rounds == 1
    server.script = [f"Here it is: {lidded()} Enjoy!"]
    assert written(model_at(server), tmp_path / "words").rounds == 1


def test_what_is_wrong_goes_back_until_nothing_is(server, tmp_path):
    server.script = ["It is a box.", lidded(axis=0.0), lidded()]
    assert written(model_at(server), tmp_path).rounds == 3
    reported = [request["messages"][-1]["content"] for request in server.requests[1:]]
    assert "no JSON" in reported[0]
    assert "joints.0.axis" in reported[1]


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (lidded(colour="red"), "colour: Extra inputs"),
        (lidded(checklist=None), 'no "checklist"'),
        (lidded(checklist=[{"phrase": "a lid", "motion": "hops"}]), "motion"),
        (lidded()[:-40], "no JSON"),
        ('{"request": {"kind": "hovercraft"}, "checklist": [{"phrase": "it"}]}', "no kind 'hovercraft'"),
        ('{"checklist": [{"phrase": "it"}]}', 'neither a "request" nor a "blueprint"'),
    ],
)
def test_what_does_not_fit_is_named(server, tmp_path, answer, said):
    server.script = [answer, lidded()]
    assert written(model_at(server), tmp_path).rounds == 2
    assert said in server.requests[1]["messages"][-1]["content"]


def test_the_best_of_all_rounds_is_kept(server, tmp_path):
    server.script = [lidded(name="one"), lidded(name="two"), "nothing more"]
    findings = {"one": ("a", "b"), "two": ("c",)}
    found = written(model_at(server), tmp_path, lambda made: findings[made.blueprint.name])
    assert found.made.blueprint.name == "two"
    assert found.made.differences == ("c",)
    assert found.rounds == SETTINGS.rounds == 3


def test_the_budget_ends_the_rounds(server, tmp_path):
    found = written(model_at(server, budget=1500.0), tmp_path, lambda *_: ("never good",))
    assert (found.rounds, found.tokens) == (2, 2000)


@pytest.mark.parametrize(
    ("line", "error", "message"),
    [
        ("I cannot do that.", InputError, "wrote nothing that can be built"),
        ("refusal", InputError, "I do not design such things"),
        ("[1, 2]", InputError, "no object"),
        ("[" * 100_000, InputError, "no JSON"),
        ('{"request": {"kind": "cab', InputError, "no JSON"),
        ("odd", EnvironmentFault, "without a message"),
        (400, InputError, "refuses the request"),
        (402, InputError, "not enough credit"),
        (429, EnvironmentFault, "in 2 tries"),
        (500, EnvironmentFault, "in 2 tries"),
        ("drop", EnvironmentFault, "no answer came"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_bad_answers_end_with_a_clear_error(server, tmp_path, line, error, message):
    server.script = [line]
    with pytest.raises(error, match=message):
        written(model_at(server), tmp_path)


def test_a_slow_service_is_not_waited_for_for_ever(server, tmp_path):
    server.script = ["slow"]
    hasty = SETTINGS.model_copy(update={"answer_seconds": 0.2})
    with pytest.raises(EnvironmentFault, match="no answer came"):
        written(LanguageModel(server.url, "tester", chat_server.KEY, hasty), tmp_path)


def test_a_question_without_an_answer_is_sent_again_by_the_same_command(server, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv(ADDRESS, server.url)
    monkeypatch.setenv(KEY, chat_server.KEY)
    server.script = ["drop", lidded()]
    words = ["generate", "--text", TEXT, "--source", "llm", "--no-preview", "--no-validation"]
    words += ["-o", str(tmp_path / "a")]
    assert run(words) == 3
    assert "The same command asks once more" in capsys.readouterr().err
    assert len(server.requests) == 1
    assert run(words) == 0
    assert len(server.requests) == 2


def test_a_busy_service_is_asked_again(server, tmp_path):
    server.script = [503, lidded()]
    assert written(model_at(server), tmp_path).rounds == 1
    assert len(server.requests) == 2


def test_the_job_of_another_request_or_another_process_is_left_alone(tmp_path):
    again = open_job(tmp_path, "llm", "x")
    with open_job(tmp_path, "llm", "x"), pytest.raises(OutputError, match="Another process"), again:
        pass
    with pytest.raises(InputError, match="another request"), open_job(tmp_path, "llm", "other"):
        pass
    (tmp_path / "job.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="no state"), open_job(tmp_path, "llm", "x"):
        pass


def test_no_service_at_all(server, tmp_path):
    model = model_at(server)
    server.close()
    with pytest.raises(EnvironmentFault, match="Check the network"):
        written(model, tmp_path)


def test_a_wrong_key_is_said_and_never_shown(server, tmp_path):
    model = LanguageModel(server.url, "tester", "another-key", SETTINGS)
    with pytest.raises(InputError, match=KEY) as caught:
        written(model, tmp_path)
    assert "another-key" not in str(caught.value)


def test_the_same_request_is_sent_once(server, tmp_path):
    for _ in range(2):
        written(model_at(server), tmp_path)
    assert len(server.requests) == 1


def test_a_recording_answers_without_a_service(server, tmp_path):
    written(model_at(server), tmp_path / "tape")
    server.close()
    model = model_at(server, replay=tmp_path / "tape")
    assert written(model, tmp_path / "two").rounds == 1
    assert chat_server.KEY not in "".join(path.read_text() for path in (tmp_path / "tape").glob("*.json"))
    with pytest.raises(InputError, match="Nothing is recorded"):
        written(model, tmp_path / "three", lambda *_: ("not good",))


@pytest.mark.parametrize("text", (ANSWERS / "sentences.txt").read_text(encoding="utf-8").splitlines())
def test_answers_of_an_engineer_hold_in_the_first_round(text, tmp_path):
    """An engineer of this project stood in for a strong model on 2026-11-29, with the prompt alone before him."""
    model = LanguageModel("http://localhost", "engineer", "", SETTINGS, replay=ANSWERS)
    found = written(model, tmp_path, lambda made: () if made.request else drawn_findings(made.blueprint), text=text)
    assert (found.rounds, found.made.differences) == (1, ())


def test_pictures_are_sent_as_they_are(server, tmp_path):
    picture = tmp_path / "box.png"
    Image.new("RGB", (64, 64), "red").save(picture)
    written(model_at(server), tmp_path / "job", images=(picture,))
    kind, url = server.requests[0]["messages"][1]["content"][1].values()
    assert kind == "image_url"
    assert base64.b64decode(url["url"].partition(",")[2]) == picture.read_bytes()


def test_the_environment_names_the_service(monkeypatch):
    for name, value in ((ADDRESS, " http://localhost:1/v1/ "), (KEY, "k"), (MODEL, "m")):
        monkeypatch.setenv(name, value)
    found = language_model(SETTINGS)
    assert (found.url, found.key, found.model) == ("http://localhost:1/v1", "k", "m")
    monkeypatch.delenv(ADDRESS)
    with pytest.raises(InputError, match=ADDRESS):
        language_model(SETTINGS)


def test_what_the_validation_finds_is_mended(server, tmp_path, monkeypatch):
    """The first lid turns into its box; the second one opens."""
    monkeypatch.setenv(ADDRESS, server.url)
    monkeypatch.setenv(KEY, chat_server.KEY)
    server.script = [lidded(axis=1.0), lidded()]
    out, answer = tmp_path / "box", tmp_path / "answer.json"
    command = ["generate", "--text", TEXT, "--source", "llm", "-o", str(out), "--no-preview", "--json", str(answer)]
    assert run(command) == 0
    reported = server.requests[1]["messages"][-1]["content"]
    assert '"axis"' in reported
    assert "<axis>" not in reported
    facts = json.loads(answer.read_text())
    assert facts["language_model"]["rounds"] == 2
    assert facts["validation"]["errors"] == []
    assert read_robot(out / "model.urdf").joints[0].axis[0] == -1.0
    assert json.loads((out / "source.json").read_text())["parameters"]["source"] == "llm"


def test_what_is_left_is_listed_and_ends_with_one(server, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv(ADDRESS, server.url)
    monkeypatch.setenv(KEY, chat_server.KEY)
    server.script = [lidded(checklist=[*CHECKLIST, {"phrase": "a coat hook", "parts": ["hook"]}])]
    command = ["generate", "--source", "llm", "--no-preview", "--no-validation", "--rounds", "2"]
    assert run([*command, "-o", str(tmp_path / "a"), "--text", "a widget with a lid and a coat hook"]) == 1
    assert capsys.readouterr().out.splitlines()[-1] == (
        "Not as asked: 'a coat hook': no part is called hook; there are body and lid"
    )
    assert (tmp_path / "a" / "model.urdf").exists()


def made_at(folder: Path, *more: str) -> int:
    command = ["generate", *more, "--no-validation", "--no-preview"]
    return run([*command, "-o", str(folder / f"made_{len(list(folder.iterdir()))}")])


def test_a_model_whose_address_is_set_gets_what_the_reader_leaves(server, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv(ADDRESS, server.url)
    monkeypatch.setenv(KEY, chat_server.KEY)
    assert made_at(tmp_path, TEXT) == 0
    assert made_at(tmp_path, "a frobnicated box with a lid", "--source", "reader") == 1
    assert made_at(tmp_path, "a frobnicated box with a lid", "--seed", "1") == 1
    assert server.requests == []
    capsys.readouterr()
    assert made_at(tmp_path, "a frobnicated box with a lid") == 0
    said = capsys.readouterr().out
    assert "The language model was asked (not read: frobnicated)." in said
    assert "Drawn by" in said
    assert len(server.requests) == 1
    assert made_at(tmp_path, "a quux with a lid", "--rounds", "1") == 0
    assert "The language model was asked (" in capsys.readouterr().out


def test_a_model_that_fails_loses_nothing_that_was_read(server, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv(ADDRESS, server.url)
    monkeypatch.setenv(KEY, "another key")
    assert made_at(tmp_path, "a frobnicated box with a lid") == 1
    said = capsys.readouterr().out
    assert "in vain: The language model does not accept the key" in said
    assert "Words not read: 'frobnicated'" in said
    assert made_at(tmp_path, "a quux with a lid") == 2
    assert "A language model was asked: The language model does not accept the key" in capsys.readouterr().err


RECORDED = BENCH.parent / "recorded" / "blueprints"
NOTICED = {
    "b1": [{"phrase": "a small vent each", "parts": ["vent"], "count": 2}],
    "b2": [{"phrase": "two doors", "parts": ["door"], "count": 2}],
    "b3": [{"phrase": "65 cm high", "size": {"height": 0.65}}],
}


@pytest.mark.skipif(not RECORDED.is_dir(), reason="the recorded answers of 2026-11-23 are not there")
def test_facts_that_a_recorded_answer_does_not_honour_are_noticed():
    """Blueprints of a strong general model, recorded on 2026-11-23; the facts are of today."""
    for name, facts in NOTICED.items():
        drawn = json.loads((RECORDED / f"{name}.json").read_text())["blueprint"]
        (fault,) = built_answer({"blueprint": drawn, "checklist": facts}).differences
        assert facts[0]["phrase"] in fault


@pytest.mark.skipif(not RECORDED.is_dir(), reason="the recorded answers of 2026-11-23 are not there")
@pytest.mark.parametrize(("name", "words"), [("e2", "away from its parent"), ("e3", "deep in each other")])
def test_flaws_of_recorded_answers_are_found_before_anything_is_carved(name, words):
    answer = json.loads((RECORDED / f"{name}.json").read_text())
    assert any(words in line for line in drawn_findings(described_blueprint(answer["blueprint"])))


@pytest.mark.parametrize("more", [["--seed", "1"], ["--command", "x"], ["--infer", "--category", "box"]], ids=str)
def test_options_that_mean_nothing_to_a_model_are_refused(more, tmp_path):
    assert run(["generate", "--text", TEXT, "--source", "llm", "-o", str(tmp_path / "out"), *more]) == 2
