"""Answers about joints: weighed, never obeyed; pictures that show the part; and a server that misbehaves."""

from __future__ import annotations

import base64
import io
import json
import threading
import time
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import trimesh
from PIL import Image

from kinematify import infer, load_assembly
from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.joints.candidate import JointCandidate
from kinematify.refinement.candidates import CandidateJoints, is_same
from kinematify.robot.joint_type import JointType
from kinematify.vision.ask import voter_record, with_types_first, with_votes
from kinematify.vision.client import ADDRESS, ChatOracle, oracle_of
from kinematify.vision.motion_options import look_alike, offered, shuffled
from kinematify.vision.pictures import joint_question
from kinematify.vision.question import FIXED, NONE, UNSURE, Answer, JointQuestion, read_answer
from kinematify.vision.screening import right_choices
from kinematify.vision.views import find_viewpoints
from kinematify.vision.votes import VoterRecord, choose_again, groups, posterior, prior, to_ask

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from kinematify.pipeline.inference import Inference

SMALL = {"view_pixels": 120, "least_pixels": 60}
BASE = load_config()
CONFIG = BASE.model_copy(update={"vision": BASE.vision.model_copy(update=SMALL)})
VISION = CONFIG.vision
X, Y, Z = np.eye(3)
STRONG, CHANCE = VoterRecord(right=10, asked=10), VoterRecord(right=1, asked=10)


def turning(axis: np.ndarray, pivot: tuple[float, float, float], score: float = 0.0) -> JointCandidate:
    return JointCandidate(kind=JointType.REVOLUTE, axis=axis, pivot=np.array(pivot), score=score, source="test")


def sliding(axis: np.ndarray, score: float = 0.0) -> JointCandidate:
    return JointCandidate(kind=JointType.PRISMATIC, axis=axis, pivot=np.zeros(3), score=score, source="test")


def box_with_lid(folder: Path, *, hinge: bool) -> Path:
    """A box with a lid on top; with `hinge` a pin and its knuckle say at which edge it turns."""
    body = trimesh.boolean.difference([
        trimesh.creation.box((0.4, 0.3, 0.2)),
        trimesh.creation.box((0.38, 0.28, 0.2)).apply_translation((0, 0, 0.01)),
    ])  # fmt: skip
    lid = trimesh.creation.box((0.4, 0.3, 0.012)).apply_translation((0, 0, 0.107))
    if hinge:
        turn = trimesh.transformations.rotation_matrix(np.pi / 2, (0, 1, 0))
        for x in (-0.12, 0.12):
            at = (x, 0.16, 0.101)
            bore = trimesh.creation.annulus(0.0055, 0.010, 0.04, sections=48).apply_transform(turn)
            pin = trimesh.creation.cylinder(0.005, 0.10, sections=48).apply_transform(turn)
            arm = trimesh.creation.box((0.02, 0.02, 0.01)).apply_translation((x + 0.04, 0.155, 0.103))
            body = trimesh.util.concatenate([body, bore.apply_translation(at)])
            lid = trimesh.util.concatenate([lid, pin.apply_translation(at), arm])
    folder.mkdir()
    body.export(folder / "body.obj")
    lid.export(folder / "lid.obj")
    return folder


def cabinet_of_twins(folder: Path) -> Path:
    """A body with two congruent doors side by side, their hinges unmarked."""
    body = trimesh.creation.box((0.8, 0.4, 0.6))
    doors = [trimesh.creation.box((0.36, 0.02, 0.56)).apply_translation((x, -0.2105, 0.0)) for x in (-0.19, 0.19)]
    folder.mkdir()
    body.export(folder / "body.obj")
    for name, door in zip(("left", "right"), doors, strict=True):
        door.export(folder / f"{name}.obj")
    return folder


@pytest.fixture(scope="module")
def doubtful(tmp_path_factory: pytest.TempPathFactory) -> Inference:
    folder = box_with_lid(tmp_path_factory.mktemp("doubtful") / "box", hinge=False)
    return sure_by(infer(load_assembly(folder), base="body", config=CONFIG), 0.5)


@pytest.fixture(scope="module")
def twins(tmp_path_factory: pytest.TempPathFactory) -> Inference:
    folder = cabinet_of_twins(tmp_path_factory.mktemp("twins") / "cabinet")
    return sure_by(infer(load_assembly(folder), base="body", config=CONFIG), 0.5)


def sure_by(inference: Inference, confidence: float) -> Inference:
    return replace(inference, joints=tuple(replace(joint, confidence=confidence) for joint in inference.joints))


class Says:
    """Somebody who picks the option that a function likes, or a word."""

    name, at_once = "a test", 2

    def __init__(self, picks: Callable[[JointCandidate], bool] | str) -> None:
        self.picks, self.seen, self.confidence = picks, list[JointQuestion](), 0.9

    def ask(self, questions: Sequence[JointQuestion]) -> list[Answer]:
        self.seen += questions
        return [
            Answer(choice=self._choice(question), confidence=self.confidence, reason="so it is")
            for question in questions
        ]

    def _choice(self, question: JointQuestion) -> str:
        if isinstance(self.picks, str):
            return self.picks
        return next((str(n) for n, item in enumerate(question.options, 1) if self.picks(item)), UNSURE)


def sure(number: int) -> Answer:
    return Answer(choice=str(number), confidence=0.9)


def other_motion(inference: Inference) -> JointCandidate:
    """The best option that was not chosen."""
    joint = inference.joints[0]
    options = offered(joint, inference.assembly.parts[joint.child], VISION)
    return next(item for item in options if not is_same(joint, item))


def test_options_are_distinct_of_both_types_and_in_no_telling_order(doubtful: Inference) -> None:
    joint = doubtful.joints[0]
    part = doubtful.assembly.parts[joint.child]
    options = offered(joint, part, VISION)
    assert 4 <= len(options) <= VISION.options
    assert is_same(joint, options[0])
    assert {item.kind.turns for item in options} == {True, False}
    for k, one in enumerate(options):
        assert not any(look_alike(one, other, part.diagonal, VISION) for other in options[k + 1 :])
    firsts = {int(np.flatnonzero([a is options[0] for a in shuffled(options, key)])[0]) for key in "abcdefgh"}
    assert len(firsts) > 2
    assert shuffled(options, "a") == shuffled(options, "a")


def test_an_answer_weighs_what_the_record_says_and_how_sure_geometry_is(doubtful: Inference) -> None:
    joint = doubtful.joints[0]
    options = offered(joint, doubtful.assembly.parts[joint.child], VISION)
    named = np.zeros(len(options) + 2, dtype=bool)
    named[1] = True

    def best(confidence: float, record: VoterRecord) -> int:
        before = prior(replace(joint, confidence=confidence), options, VISION)
        assert before.sum() == pytest.approx(1.0)
        assert before[0] == pytest.approx(min(confidence, VISION.surest))
        return int(np.argmax(posterior(before, named, record.reliability(VISION))))

    assert [best(0.5, STRONG), best(0.95, STRONG), best(0.5, CHANCE)] == [1, 0, 0]
    assert VoterRecord(right=40, asked=40).reliability(VISION) == VISION.reliability  # no more than was measured
    assert STRONG.reliability(VISION) < 0.82  # ten of ten may be luck
    before = prior(joint, options, VISION)
    assert posterior(before, named, CHANCE.reliability(VISION)) == pytest.approx(before)
    log_odds = np.diff(np.log(posterior(before, named, 0.8)[:2])) - np.diff(np.log(before[:2]))
    assert log_odds[0] == pytest.approx(np.log(0.8 * (len(options)) / 0.2))


def test_a_right_answer_changes_joint_confidence_and_record(doubtful: Inference) -> None:
    wanted = other_motion(doubtful)
    after, voting = with_votes(doubtful, Says(lambda item: item is wanted or is_like(item, wanted)), STRONG)
    found = after.joints[0]
    assert is_same(found, wanted)
    assert voting.results[0].changed
    assert found.confidence == pytest.approx(voting.results[0].confidence[1])
    assert found.confidence > 0.5
    assert not after.doubtful
    assert after.vision is not None
    reported = json.loads(json.dumps(after.vision))["joints"][0]
    assert (reported["child"], reported["reason"], len(reported["options"])) == (
        "lid",
        "so it is",
        len(voting.results[0].options),
    )


def is_like(one: JointCandidate, other: JointCandidate) -> bool:
    return one.kind == other.kind and np.allclose(one.axis, other.axis) and np.allclose(one.pivot, other.pivot)


def test_slides_fixed_joints_and_none_of_these_count(doubtful: Inference) -> None:
    slide, voting = with_votes(sure_by(doubtful, 0.3), Says(lambda item: not item.kind.turns), STRONG)
    assert slide.joints[0].kind is JointType.PRISMATIC
    assert voting.results[0].answer.choice.isdecimal()
    fixed, _ = with_votes(sure_by(doubtful, 0.2), Says(FIXED), VoterRecord(right=99, asked=99))
    assert fixed.joints[0].kind is JointType.FIXED
    freed, _ = with_votes(sure_by(fixed, 0.4), Says(lambda item: item.kind.turns), STRONG)
    assert freed.joints[0].kind.turns
    assert freed.joints[0].upper > freed.joints[0].lower
    doubted, _ = with_votes(doubtful, Says(NONE), STRONG)
    assert is_same(doubtful.joints[0], doubted.joints[0].alternatives[0])
    assert doubted.joints[0].confidence < doubtful.joints[0].confidence
    agreed, _ = with_votes(doubtful, Says(lambda item: is_same(doubtful.joints[0], item)), STRONG)
    assert agreed.joints[0].confidence > 0.9


def test_a_voter_at_chance_and_an_abstention_change_nothing(doubtful: Inference) -> None:
    unsure = Says(FIXED)
    unsure.confidence = VISION.least_confidence - 0.1
    picks = Says(lambda item: is_like(item, other_motion(doubtful)))
    for oracle, record in ((picks, CHANCE), (Says(UNSURE), STRONG), (unsure, STRONG)):
        after, voting = with_votes(doubtful, oracle, record)
        assert after.joints[0].confidence == pytest.approx(doubtful.joints[0].confidence)
        assert not voting.results[0].changed


def test_congruent_parts_are_asked_once_and_move_alike(twins: Inference) -> None:
    assert groups(twins) == [(0, 1)]
    assert to_ask(twins) == ([0], [])
    oracle = Says(lambda item: item.kind.turns and abs(float(item.axis @ X)) > 0.99)
    after, voting = with_votes(sure_by(twins, 0.3), oracle, STRONG)
    assert len(oracle.seen) == 1
    assert [result.asked for result in voting.results] == [True, False]
    assert all(joint.kind.turns and abs(float(joint.axis @ X)) > 0.99 for joint in after.joints)


def test_congruent_parts_that_are_answered_differently_count_as_unsure(twins: Inference) -> None:
    shown = {k: offered(joint, twins.assembly.parts[joint.child], VISION) for k, joint in enumerate(twins.joints)}
    turn = next(n for n, item in enumerate(shown[0], 1) if item.kind.turns)
    slide = next(n for n, item in enumerate(shown[1], 1) if not item.kind.turns)
    after, results = choose_again(twins, {0: sure(turn), 1: sure(slide)}, shown, 0.9)
    assert [result.answer.choice for result in results] == [UNSURE, UNSURE]
    assert "answered differently" in results[0].answer.fault
    assert [joint.kind for joint in after.joints] == [joint.kind for joint in twins.joints]


def test_only_doubtful_joints_are_asked_about_within_a_budget(doubtful: Inference) -> None:
    assert to_ask(sure_by(doubtful, 0.95)) == ([], [])
    assert to_ask(sure_by(doubtful, 0.95), everything=True) == ([0], [])
    assert to_ask(doubtful, known=["lid"]) == ([], [])
    ten = replace(doubtful, joints=doubtful.joints * 10)
    assert [len(part) for part in to_ask(ten)] == [4, 6]


def test_pictures_show_the_part_its_options_and_no_name(doubtful: Inference) -> None:
    maker = CandidateJoints(doubtful.assembly, doubtful.graph, doubtful.bearings, doubtful.config)
    question = joint_question(doubtful, 0, maker)
    assert question is not None
    assert question.pixels >= VISION.least_pixels
    assert question.picture.size == (360, 3 * 144)
    pixels = np.asarray(question.picture).astype(int)
    red = (pixels[..., 0] > 120) & (pixels[..., 1] < 90) & (pixels[..., 2] < 90)
    green = (pixels[..., 1] > pixels[..., 0] + 40) & (pixels[..., 1] > pixels[..., 2] + 30)
    for row, column in ((0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0)):
        tile = np.s_[144 * row + 24 : 144 * (row + 1), 120 * column : 120 * (column + 1)]
        assert red[tile].sum() > 60
        assert (green[tile].sum() > 10) == (row > 0)
    assert " lid" not in question.text
    assert question.choices == (*map(str, range(1, len(question.options) + 1)), FIXED, NONE, UNSURE)
    unseen = doubtful.config.model_copy(update={"vision": VISION.model_copy(update={"least_pixels": 10**6})})
    after, voting = with_votes(replace(doubtful, config=unseen), Says(FIXED), STRONG)
    assert voting.not_shown == ("lid",)  # nobody is asked about what cannot be shown
    assert after.joints == doubtful.joints


def test_a_hidden_part_is_shown_through_the_others(tmp_path: Path) -> None:
    folder = tmp_path / "box"
    folder.mkdir()
    trimesh.creation.box((0.4, 0.4, 0.4)).export(folder / "shell.obj")
    trimesh.creation.box((0.1, 0.1, 0.1)).export(folder / "inside.obj")
    assembly = load_assembly(folder)
    assert find_viewpoints(assembly, assembly.names.index("inside"), (), VISION).see_through
    assert not find_viewpoints(assembly, assembly.names.index("shell"), (), VISION).see_through


CHOICES = ("1", "2", FIXED, NONE, UNSURE)


@pytest.mark.parametrize(
    ("text", "choice"),
    [
        ('{"reason": "a lid", "choice": "2", "confidence": 0.8}', "2"),
        ('Well {it} is a lid.\n```json\n{"choice": 2, "confidence": "high"}\n``` I hope.', "2"),
        ('{"choice": "Fixed", "confidence": 7}', FIXED),
        ('{"choice": "7", "confidence": 1}', ""),
        ('{"choice": "ninguna de estas", "confidence": 1}', ""),
        ('{"choice": true}', ""),
        ('{"choice": ["1"]}', ""),
        ("It is a lid, I think.", ""),
        ("[1, 2]", ""),
        ("{" * 5000, ""),
        ("", ""),
    ],
)
def test_an_answer_of_any_form_is_a_choice_or_unsure_with_a_reason(text: str, choice: str) -> None:
    found = read_answer(text, CHOICES)
    assert found.choice == (choice or UNSURE)
    assert bool(found.fault) == (not choice)


class ChatServer:
    """Answers every question with the next of its scripts; the last one stays."""

    def __init__(self) -> None:
        self.scripts: list[Any] = [{}]
        self.requests: list[dict[str, Any]] = []
        self.keys: list[str | None] = []
        server = self

        class Handler(BaseHTTPRequestHandler):
            def log_message(self, *_: Any) -> None:
                """Say nothing."""

            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers["Content-Length"]))
                server.requests.append({"path": self.path, **json.loads(body)})
                server.keys.append(self.headers.get("Authorization"))
                script = server.scripts.pop(0) if len(server.scripts) > 1 else server.scripts[0]
                status, content = 200, json.dumps({"choices": [{"message": {"content": json.dumps(script)}}]})
                if isinstance(script, int):
                    status, content = script, "no"
                elif script == "garbage":
                    content = "<html>"
                elif script == "prose":
                    content = json.dumps({"choices": [{"message": {"content": "It is a lid, I think."}}]})
                elif script == "slow":
                    time.sleep(3.0)
                self.send_response(status)
                self.send_header("Content-Length", str(len(content)))
                self.end_headers()
                self.wfile.write(content.encode())

        self.http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.http.daemon_threads = True
        threading.Thread(target=self.http.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self.http.server_port}/v1"


@pytest.fixture
def server() -> Iterator[ChatServer]:
    found = ChatServer()
    yield found
    found.http.shutdown()
    found.http.server_close()


QUICK = VISION.model_copy(update={"first_pause": 0.01, "longest_pause": 0.02, "answer_seconds": 1.0, "tries": 1})
GOOD = {"reason": "a lid", "choice": "1", "confidence": 0.9}


def question() -> JointQuestion:
    options = (turning(X, (0.0, 0.1, 0.0)), sliding(Z))
    return JointQuestion(
        parent="body", child="lid", options=options, picture=Image.new("RGB", (8, 8), "red"), pixels=500
    )


def test_model_is_shown_the_picture_and_asked_for_json_once(server: ChatServer, tmp_path: Path) -> None:
    server.scripts = [GOOD]
    oracle = ChatOracle(server.url, "some-model", "secret", QUICK, tmp_path)
    assert oracle.ask([question()])[0] == Answer(choice="1", confidence=0.9, reason="a lid")
    asked = server.requests[0]
    assert (asked["path"], asked["model"]) == ("/v1/chat/completions", "some-model")
    schema = asked["response_format"]["json_schema"]["schema"]
    assert schema["properties"]["choice"]["enum"] == list(CHOICES)
    address = asked["messages"][0]["content"][1]["image_url"]["url"]
    picture = Image.open(io.BytesIO(base64.b64decode(address.removeprefix("data:image/png;base64,"))))
    assert picture.getpixel((4, 4)) == (255, 0, 0)
    assert server.keys == ["Bearer secret"]
    assert oracle.ask([question()])[0].choice == "1"  # from the disk
    assert len(server.requests) == 1
    assert all("secret" not in file.read_text(encoding="utf-8") for file in tmp_path.iterdir())
    assert "secret" not in repr(oracle)


@pytest.mark.parametrize("script", ["garbage", "prose", 500, 400, 401, "slow", {}, {"choice": "9"}])
def test_what_goes_wrong_counts_as_unsure_and_is_not_kept(server: ChatServer, tmp_path: Path, script: Any) -> None:
    server.scripts = [script]
    oracle = ChatOracle(server.url, "m", "", QUICK, tmp_path)
    found = oracle.ask([question()])[0]
    assert (found.choice, bool(found.fault)) == (UNSURE, True)
    assert not list(tmp_path.iterdir())
    before = len(server.requests)
    again = oracle.ask([question(), question()])
    assert [answer.choice for answer in again] == [UNSURE, UNSURE]
    if script in (500, 400, 401, "slow"):
        assert len(server.requests) == before  # a service that fails is not asked any further


def test_a_model_has_a_record_before_it_counts(server: ChatServer, tmp_path: Path) -> None:
    oracle = ChatOracle(server.url, "m", "", QUICK, tmp_path)
    server.scripts = [GOOD, {**GOOD, "choice": UNSURE}, GOOD]
    single = replace(oracle, config=QUICK.model_copy(update={"concurrency": 1}))
    known = [(replace(question(), picture=Image.new("RGB", (8, 8), (k, 0, 0))), frozenset({"1"})) for k in range(3)]
    assert voter_record(single, lambda: known) == VoterRecord(right=2, asked=2)
    server.scripts = [500]
    assert voter_record(oracle, list) == VoterRecord(right=2, asked=2)  # kept
    dead = ChatOracle(server.url, "dead", "", QUICK, tmp_path)
    assert voter_record(dead, lambda: known) == VoterRecord(right=0, asked=0)
    assert not dead.record_path.exists()


def test_right_choices_are_those_of_the_true_joint() -> None:
    options = (turning(X, (0.0, 0.1, 0.0)), sliding(X), turning(X, (0.0, -0.1, 0.0)), turning(Z, (0.0, 0.1, 0.0)))
    assert right_choices(options, turning(-X, (0.3, 0.1, 0.0)), 1.0) == {"1"}  # type: ignore[arg-type]


def test_types_come_first_in_the_order_of_the_paper(twins: Inference) -> None:
    assert load_config("paper").vision.first
    oracle = Says("slides")
    after, voting = with_types_first(twins, oracle)
    assert len(oracle.seen) == 2  # every joint, and no options
    assert all(item.choices == ("turns", "slides", FIXED, UNSURE) for item in oracle.seen)
    assert [joint.kind for joint in after.joints] == [JointType.PRISMATIC] * 2
    assert after.vision is not None
    assert voting.reached


def test_address_comes_from_the_option_or_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(ADDRESS, raising=False)
    assert oracle_of("off", VISION) is None
    assert oracle_of("auto", VISION) is None
    monkeypatch.setenv(ADDRESS, "http://localhost:1/v1/")
    found = oracle_of("auto", VISION)
    assert found is not None
    assert found.url == "http://localhost:1/v1"
    with pytest.raises(InputError, match="neither off, auto nor an address"):
        oracle_of("gpt", VISION)


def infer_box(folder: Path, *words: str) -> int:
    return run(["infer", str(folder / "box"), "-o", str(folder / "out"), "--base", "body", "--no-preview",
                "--no-validation", "--force", *words])  # fmt: skip


def test_command_line_reports_answers_and_writes_what_geometry_says_without_any(
    server: ChatServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    box_with_lid(tmp_path / "box", hinge=False)
    oracle = oracle_of(server.url, VISION)
    assert oracle is not None
    oracle.record_path.parent.mkdir(parents=True)
    oracle.record_path.write_text('{"right": 10, "asked": 10}', encoding="utf-8")
    server.scripts = [GOOD]
    assert infer_box(tmp_path, "--vlm", server.url, "--vlm-all") == 0
    assert "answered 1 of 1 questions" in capsys.readouterr().out
    record = json.loads((tmp_path / "out" / "inference.json").read_text(encoding="utf-8"))
    assert record["vision"]["joints"][0]["choice"] == "1"
    assert record["vision"]["record"] == {"right": 10, "asked": 10}
    server.scripts = [400]
    monkeypatch.setenv("KINEMATIFY_VLM_MODEL", "refuses")
    assert infer_box(tmp_path, "--vlm", server.url, "--vlm-first") == 3
    assert "refuses the request" in capsys.readouterr().out
    record = json.loads((tmp_path / "out" / "inference.json").read_text(encoding="utf-8"))
    assert record["vision"]["joints"][0]["choice"] == UNSURE
    assert infer_box(tmp_path, "--vlm", "nonsense") == 2
