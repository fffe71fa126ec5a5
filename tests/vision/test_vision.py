"""Votes on joints: added and bounded, never obeyed; and the client against a local server that misbehaves."""

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
from kinematify.assembly.part import Part
from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.joints.candidate import JointCandidate, JointEstimate
from kinematify.robot.joint_type import JointType
from kinematify.vision.answer import JointQuestion, JointVotes, Vote, read_answer
from kinematify.vision.client import ADDRESS, KEY, ChatOracle, oracle_of
from kinematify.vision.question import joint_question
from kinematify.vision.votes import chosen_anew, direction_of, side_of, standing, vote_gain, with_votes

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from kinematify.pipeline import Inference

CONFIG = load_config().vision
X, Y, Z = np.eye(3)


def panel() -> Part:
    """An upright door of 0.4 x 0.02 x 0.6 m around the origin."""
    box = trimesh.creation.box((0.4, 0.02, 0.6))
    return Part(name="door", vertices=np.array(box.vertices), faces=np.array(box.faces))


def turning(axis: np.ndarray, pivot: tuple[float, float, float], score: float = 0.0) -> JointCandidate:
    return JointCandidate(kind=JointType.REVOLUTE, axis=axis, pivot=np.array(pivot), score=score, source="test")


def sliding(axis: np.ndarray, score: float = 0.0) -> JointCandidate:
    return JointCandidate(kind=JointType.PRISMATIC, axis=axis, pivot=np.zeros(3), score=score, source="test")


def votes(kind: str = "", direction: str = "", side: str = "", confidence: float = 0.9) -> JointVotes:
    kinds, directions, sides = (Vote(choice=c, confidence=confidence) if c else None for c in (kind, direction, side))
    return JointVotes(kind=kinds, direction=directions, side=sides)


def test_directions_and_sides_are_those_of_somebody_in_front() -> None:
    assert [direction_of(axis, 30.0) for axis in (X, -Y, Z, np.array([0.0, 0.7, 0.7]))] == [
        "sideways", "depth", "vertical", None,
    ]  # fmt: skip
    sides = {
        "left": turning(Z, (-0.2, 0.01, 5.0)), "right": turning(Z, (0.19, 0.0, 0.0)),
        "top": turning(X, (0.0, 0.0, 0.3)), "bottom": turning(-X, (0.1, 0.0, -0.3)),
        "middle": turning(Z, (0.02, 0.0, 0.0)),
    }  # fmt: skip
    for name, candidate in sides.items():
        assert side_of(candidate, panel(), CONFIG.off_center) == name


def test_votes_favour_what_they_name_and_nothing_else() -> None:
    left, right, drawer = turning(Z, (-0.2, 0.0, 0.0)), turning(Z, (0.2, 0.0, 0.0)), sliding(Y)
    opinion = votes("revolute", "vertical", "right")

    def gain(candidate: JointCandidate, own: JointVotes, twins: Sequence[JointVotes] = ()) -> float:
        return vote_gain(candidate, own, twins, panel(), CONFIG)

    assert gain(right, opinion) > gain(left, opinion) > gain(drawer, opinion) == 0.0
    assert gain(left, votes("continuous")) == gain(left, votes("revolute")) > 0.0
    assert gain(right, votes("revolute", confidence=0.95)) > gain(right, votes("revolute", confidence=0.6))
    assert gain(right, JointVotes()) == 0.0
    assert gain(right, JointVotes(), [votes("revolute"), votes("revolute")]) > gain(
        right, JointVotes(), [votes("fixed")]
    )
    sure = votes("revolute", "vertical", "right", confidence=1.0)
    assert gain(right, sure) <= CONFIG.most


def test_vote_counts_the_log_odds_of_its_reliability_and_no_more() -> None:
    up = turning(Z, (0.0, 0.0, 0.0))
    gains = [vote_gain(up, votes(direction="vertical", confidence=c), (), panel(), CONFIG) for c in (0.8, 0.9, 0.99)]
    assert gains[0] == pytest.approx(np.log(0.8 / 0.1))
    assert gains[1] == pytest.approx(np.log(0.9 / 0.05))
    assert gains[2] == gains[1]  # who claims more is believed no more


def test_voter_that_is_right_as_often_as_the_geometry_changes_nothing_alone() -> None:
    chosen, other = turning(Z, (0.0, 0.0, 0.0)), turning(X, (0.0, 0.0, 0.0))
    joint = estimate(chosen, other)

    def lead(own: JointVotes, twins: Sequence[JointVotes] = ()) -> float:
        here, there = (standing(c, joint, CONFIG) + vote_gain(c, own, twins, panel(), CONFIG) for c in (chosen, other))
        return here - there

    assert lead(JointVotes()) == CONFIG.chosen_lead
    assert lead(votes(direction="sideways", confidence=0.8)) > 0.0 > lead(votes(direction="sideways", confidence=0.9))
    twins = [votes(direction="vertical"), votes(direction="vertical")]
    assert lead(votes(direction="sideways", confidence=0.9), twins) > 0.0  # an outlier among twins is corrected


def estimate(*candidates: JointCandidate) -> JointEstimate:
    best = candidates[0]
    return JointEstimate(
        parent=0, child=1, kind=best.kind, axis=best.axis, pivot=best.pivot, lower=0.0, upper=1.0, confidence=0.5,
        alternatives=candidates,
    )  # fmt: skip


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


@pytest.fixture(scope="module")
def clear(tmp_path_factory: pytest.TempPathFactory) -> Inference:
    return infer(load_assembly(box_with_lid(tmp_path_factory.mktemp("clear") / "box", hinge=True)), base="body")


@pytest.fixture(scope="module")
def doubtful(tmp_path_factory: pytest.TempPathFactory) -> Inference:
    return infer(load_assembly(box_with_lid(tmp_path_factory.mktemp("doubtful") / "box", hinge=False)), base="body")


class Says:
    """An oracle with one opinion on everything."""

    def __init__(self, opinion: JointVotes) -> None:
        self.opinion, self.seen = opinion, list[JointQuestion]()

    def ask(self, questions: Sequence[JointQuestion]) -> list[JointVotes]:
        self.seen += questions
        return [self.opinion] * len(questions)


def test_wrong_votes_do_not_overrule_clear_geometry(clear: Inference) -> None:
    before = clear.joints[0]
    assert before.kind.turns
    after, heard = with_votes(clear, Says(votes("prismatic", "depth", "left", confidence=1.0)))
    assert not heard[0].changed
    assert after.joints[0] is before


def test_right_votes_decide_where_the_geometry_does_not(doubtful: Inference) -> None:
    lines = {(c.kind.turns, direction_of(c.axis, 30.0)) for c in doubtful.joints[0].alternatives}
    assert (True, "sideways") in lines
    after, _ = with_votes(doubtful, Says(votes("revolute", "sideways", "back", confidence=1.0)))
    found = after.joints[0]
    assert found.kind.turns
    assert abs(float(found.axis @ X)) > 0.99
    assert side_of(turning(found.axis, tuple(found.pivot)), after.assembly.parts[found.child], 0.2) == "back"
    assert found.upper > found.lower  # it has a range of its own


def test_question_shows_the_moving_part_in_red(doubtful: Inference) -> None:
    oracle = Says(JointVotes(note="it abstains"))
    after, heard = with_votes(doubtful, oracle)
    assert after.joints == doubtful.joints
    assert heard[0].votes.note == "it abstains"
    picture = np.asarray(oracle.seen[0].picture).astype(int)
    red = (picture[..., 0] > 120) & (picture[..., 1] < 90) & (picture[..., 2] < 90)
    half = picture.shape[0] // 2
    for rows, columns in (
        (slice(half), slice(half)),
        (slice(half, None), slice(half)),
        (slice(half, None), slice(half, None)),
    ):
        assert red[rows, columns].sum() > 200
    assert oracle.seen[0].child == "lid"


def test_answers_of_any_form_are_votes_or_abstentions() -> None:
    whole = {
        "name": "lid", "type": {"choice": "revolute", "confidence": 0.8},
        "axis_direction": {"choice": "unsure", "confidence": 0.9}, "hinge_side": {"choice": "back", "confidence": 0.4},
    }  # fmt: skip
    found = read_answer(whole, 0.5)
    assert found.kind == Vote(choice="revolute", confidence=0.8)
    assert found.direction is None
    assert found.side is None  # not sure enough
    for odd in (None, [], "text", {}, {"type": "revolute"}, {"type": {"choice": "wobbly", "confidence": 0.9}},
                {"type": {"choice": "revolute", "confidence": 7}}, {"type": {"choice": "fixed", "confidence": True}},
                {"type": {"choice": "fixed", "confidence": "high"}}):  # fmt: skip
        assert read_answer(odd, 0.5).kind is None
        assert read_answer(odd, 0.5).note


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


RIGHT = {
    "name": "lid", "type": {"choice": "revolute", "confidence": 0.9},
    "axis_direction": {"choice": "sideways", "confidence": 0.9}, "hinge_side": {"choice": "back", "confidence": 0.9},
}  # fmt: skip
QUICK = CONFIG.model_copy(update={"first_pause": 0.01, "longest_pause": 0.02, "answer_seconds": 1.0, "tries": 2})


def question() -> JointQuestion:
    return JointQuestion(parent="body", child="lid", picture=Image.new("RGB", (8, 8), "red"))


def test_model_is_shown_the_picture_and_asked_for_json_once(server: ChatServer, tmp_path: Path) -> None:
    server.scripts = [RIGHT]
    oracle = ChatOracle(server.url, "some-model", "secret", QUICK, tmp_path)
    assert oracle.ask([question()])[0].direction == Vote(choice="sideways", confidence=0.9)
    asked = server.requests[0]
    assert (asked["path"], asked["model"]) == ("/v1/chat/completions", "some-model")
    assert asked["response_format"]["json_schema"]["schema"]["required"] == [
        "name", "type", "axis_direction", "hinge_side",
    ]  # fmt: skip
    address = asked["messages"][0]["content"][1]["image_url"]["url"]
    picture = Image.open(io.BytesIO(base64.b64decode(address.removeprefix("data:image/png;base64,"))))
    assert picture.getpixel((4, 4)) == (255, 0, 0)
    assert server.keys == ["Bearer secret"]
    assert oracle.ask([question()])[0].kind is not None  # from the disk
    assert len(server.requests) == 1
    assert all("secret" not in file.read_text(encoding="utf-8") for file in tmp_path.iterdir())


@pytest.mark.parametrize("script", ["garbage", "prose", 500, "slow", {}, {"type": 3}])
def test_what_goes_wrong_is_an_abstention_and_is_not_kept(server: ChatServer, tmp_path: Path, script: Any) -> None:
    server.scripts = [script]
    oracle = ChatOracle(server.url, "m", "", QUICK, tmp_path)
    found = oracle.ask([question()])[0]
    assert found.kind is None
    assert found.note
    if not isinstance(script, dict):
        assert not list(tmp_path.iterdir())


def test_busy_server_is_asked_again_and_a_wrong_key_is_said(server: ChatServer, tmp_path: Path) -> None:
    server.scripts = [429, RIGHT]
    oracle = ChatOracle(server.url, "m", "", QUICK, tmp_path)
    assert oracle.ask([question()])[0].kind is not None
    server.scripts = [401]
    with pytest.raises(InputError, match=KEY):
        replace(oracle, model="other").ask([question()])


def test_address_comes_from_the_option_or_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(ADDRESS, raising=False)
    assert oracle_of("off", CONFIG) is None
    assert oracle_of("auto", CONFIG) is None
    monkeypatch.setenv(ADDRESS, "http://localhost:1/v1/")
    found = oracle_of("auto", CONFIG)
    assert found is not None
    assert found.url == "http://localhost:1/v1"
    with pytest.raises(InputError, match="neither off, auto nor an address"):
        oracle_of("gpt", CONFIG)


def test_command_line_tells_what_was_heard(
    server: ChatServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    server.scripts = [RIGHT]
    folder = box_with_lid(tmp_path / "box", hinge=False)
    words = ["infer", str(folder), "-o", str(tmp_path / "out"), "--base", "body", "--no-preview"]
    assert run([*words, "--vlm", server.url]) == 0
    assert "answered 1 of 1 questions" in capsys.readouterr().out
    assert run([*words, "--force", "--vlm", "nonsense"]) == 2


def test_votes_on_twins_count_for_each_other(doubtful: Inference) -> None:
    """The same inference with votes keyed by joint: what is not voted on stays as it is."""
    after, heard = chosen_anew(doubtful, {})
    assert after.joints == doubtful.joints
    assert heard == []
    assert joint_question(
        doubtful.assembly, doubtful.joints[0].parent, doubtful.joints[0].child, config=CONFIG,
        preview=doubtful.config.preview,
    ).parent == "body"  # fmt: skip
