"""One question about an object: sheets that show every piece, answers of any form, and a server that misbehaves."""

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
from PIL import Image

from kinematify import infer, load_assembly
from kinematify.assembly.part import Part
from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.grouping.groups import group_pieces, numbered_pieces
from kinematify.grouping.numbered_pieces import BODY, MOST_NUMBERS, NamedPart
from kinematify.render.piece_sheet import draw_sheet
from kinematify.robot.joint_type import JointType
from kinematify.vision.ask import PieceVote, voter_record
from kinematify.vision.client import ADDRESS, ChatOracle, oracle_of
from kinematify.vision.piece_question import PieceQuestion, piece_question
from kinematify.vision.screening import known_questions
from kinematify.vision.votes import VoterRecord, follow_parts
from tests.one_mesh import box, write_bin_with_lid, write_chest

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from kinematify.pipeline.inference import Inference

CONFIG = load_config()
VISION = CONFIG.vision
QUICK = VISION.model_copy(update={"first_pause": 0.01, "longest_pause": 0.02, "answer_seconds": 1.0, "tries": 1})
DRAWERS = (0.16, 0.44, 0.72)
"""Heights of the drawers of the chest [m]."""


@pytest.fixture(scope="module")
def chest(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("chest") / "chest.ply"
    write_chest(path)
    return path


@pytest.fixture(scope="module")
def question(chest: Path) -> PieceQuestion:
    return piece_question(load_assembly(chest), CONFIG)


def numbers_near(question: PieceQuestion, z: float) -> list[int]:
    """Numbers of the boards of a drawer."""
    middles = [part.bounds.mean(axis=0) for part in question.shown]
    return [
        k
        for k, middle in enumerate(middles, 1)
        if abs(middle[2] - z + 0.02) < 0.09 and abs(middle[0]) < 0.27 and middle[1] < 0.18
    ]


def drawers(question: PieceQuestion, **changes: Any) -> dict[str, Any]:
    """The right answer."""
    parts = [{"name": f"drawer {k}", "pieces": numbers_near(question, z), "moves": "slides", "axis": "y", "edge": [],
              "on": "body", "sure": 0.9, **changes} for k, z in enumerate(DRAWERS, 1)]  # fmt: skip
    return {"object": "chest", "reason": "three fronts", "parts": parts, "cut": []}


def test_the_sheet_shows_every_piece_and_the_text_lists_it(question: PieceQuestion) -> None:
    assert len(question.pieces) == 23
    assert all(f"\n{number}: x " in question.text for number in range(1, 24))
    file = io.BytesIO()
    question.picture.save(file, format="PNG", optimize=True)
    assert file.tell() < 120_000
    assert question.picture.size[0] <= 1680
    colors = len(question.picture.convert("RGB").getcolors(1 << 24) or ())
    assert colors > 23


@pytest.mark.parametrize("shells", [1, 3, 400])
def test_meshes_of_any_number_of_shells_have_at_most_sixty_numbers(shells: int) -> None:
    side = int(np.ceil(shells ** (1 / 3)))
    at = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3)[:shells]
    parts = [Part(name=f"p{k}", vertices=block.vertices, faces=block.faces)
             for k, block in enumerate(box((0.9, 0.9, 0.9), tuple(place)) for place in at)]  # fmt: skip
    assembly = replace(load_assembly_of(parts), segmented=False)
    found = numbered_pieces(assembly, CONFIG.grouping)
    assert len(found) == min(shells, MOST_NUMBERS)
    assert sorted(np.concatenate(found).tolist()) == list(range(shells))
    if shells == 1:
        with pytest.raises(InputError, match="no pieces to ask about"):
            piece_question(assembly, CONFIG)


def load_assembly_of(parts: list[Part]) -> Any:
    from kinematify.assembly.part import Assembly

    return Assembly(parts=tuple(parts), source="blocks")


def test_shells_that_coincide_are_drawn() -> None:
    part = Part(name="one", vertices=box((1, 1, 1), (0, 0, 0)).vertices, faces=box((1, 1, 1), (0, 0, 0)).faces)
    assert draw_sheet([part] * 5).size[0] > 0


def test_what_an_answer_cannot_mean_is_dropped_and_named(question: PieceQuestion) -> None:
    stated = drawers(question)
    first, second, third = stated["parts"]
    first["pieces"] = [*first["pieces"], 99, "7"]
    second["pieces"] = [*second["pieces"], first["pieces"][0]]
    first["on"], second["on"], third["on"] = "drawer 2", "drawer 1", "nowhere"
    third["axis"], third["moves"], third["sure"] = [0, 0, 0], "flies", "very"
    stated["parts"] += [{"name": "body", "pieces": [1]}, {"pieces": []}, "nonsense"]
    stated["cut"] = [{"piece": 1, "what": "a flap"}]
    found = question.read(f"Surely:\n```json\n{json.dumps(stated)}\n```\nI hope so {{.")
    assert [part.name for part in found.parts] == ["drawer_1", "drawer_2", "drawer_3"]
    assert sum(len(part.pieces) for part in found.parts) == 18
    assert [part.on for part in found.parts].count(BODY) >= 2
    assert (found.parts[2].axis, found.parts[2].turns, found.parts[2].sure) == (None, None, 1.0)
    said = " ".join(found.described())
    for words in (
        "3 of 6 parts were taken",
        "99",
        "another part",
        "body does not move",
        "in a circle",
        "no part",
        "--pieces cut",
    ):
        assert words in said


@pytest.mark.parametrize("text", ["", "a chest", "[1]", '{"parts": 3}', "{" * 4000])
def test_what_is_no_answer_says_so(question: PieceQuestion, text: str) -> None:
    assert question.read(text).fault


def test_where_all_pieces_are_named_the_largest_part_is_the_body(question: PieceQuestion) -> None:
    half = [{"name": name, "pieces": numbers} for name, numbers in (("a", [1]), ("b", list(range(2, 24))))]
    found = question.read(json.dumps({"parts": half}))
    assert [part.name for part in found.parts] == ["a"]
    assert "is the body" in found.notes[0]


@pytest.fixture(scope="module")
def answered(question: PieceQuestion) -> Inference:
    """The chest as an answer says that geometry would not."""
    vote = PieceVote(voter="a test", question=question, answer=question.read(json.dumps(drawers(question))))
    return vote.applied(infer(vote.grouping(CONFIG), base=vote.base))


def test_an_answer_names_the_links_and_the_type_and_leaves_lines_to_geometry(answered: Inference) -> None:
    assert set(answered.assembly.names) == {BODY, "drawer_1", "drawer_2", "drawer_3"}
    assert answered.assembly.names[answered.trees[0].root] == BODY
    assert {joint.kind for joint in answered.joints} == {JointType.PRISMATIC}
    assert all(abs(joint.axis[1]) > 0.99 for joint in answered.joints)
    assert answered.vision is not None
    assert answered.vision["taken"] == ["drawer_1", "drawer_2", "drawer_3"]


@pytest.mark.parametrize(("reliability", "taken", "turns"), [(0.9, True, True), (0.55, False, False)])
def test_an_answer_against_a_sure_joint_is_followed_only_where_it_is_taken(
    answered: Inference, reliability: float, taken: bool, turns: bool
) -> None:
    sure = replace(answered, joints=tuple(replace(joint, confidence=0.95) for joint in answered.joints))
    child = answered.joints[0].child
    named = {
        child: NamedPart(name="flap", pieces=np.array([0]), turns=True, axis=np.array([1.0, 0.0, 0.0]), edges=("-z",))
    }
    after, results = follow_parts(sure, named, reliability, taken=taken)
    joint = after.joints[0]
    assert joint.kind.turns == turns
    assert len(results) == 1
    if turns:
        assert abs(joint.axis[0]) > 0.86
        bounds = answered.assembly.parts[child].bounds
        assert joint.pivot[2] < bounds[:, 2].mean()


def test_the_record_decides_between_geometry_and_the_answer(question: PieceQuestion) -> None:
    assert [VoterRecord(right=right, asked=10).trust for right in (0, 3, 9, 10)] == [0.0, 0.0, 1.0, 1.0]
    assert VoterRecord(right=0, asked=0).trust == 0.0
    pieces = question.assembly
    alone = group_pieces(pieces, CONFIG.grouping)
    wrong = [NamedPart(name="wrong", pieces=np.array([0, 12]))]
    assert group_pieces(pieces, CONFIG.grouping, named=wrong, trust=0.0).record() == alone.record()
    right = question.read(json.dumps(drawers(question))).parts
    names = {group.name for group in group_pieces(pieces, CONFIG.grouping, named=right, trust=0.6).groups}
    assert names >= {"drawer_1", "drawer_2", "drawer_3"}


def test_known_questions_are_broken_objects_that_their_truth_answers() -> None:
    for question, truth in known_questions(CONFIG):
        assert len(question.pieces) > len(truth) > 0
        assert all(len(part.pieces) for part in truth)


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
                content = json.dumps(
                    {"choices": [{"message": {"content": json.dumps(script)}}], "usage": {"total_tokens": 7}}
                )
                status = 200
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


def test_a_model_is_shown_the_picture_and_asked_for_json_once(
    server: ChatServer, question: PieceQuestion, tmp_path: Path
) -> None:
    server.scripts = [drawers(question)]
    oracle = ChatOracle(server.url, "some-model", "secret", QUICK, tmp_path)
    [answer] = oracle.ask([question])
    assert (len(answer.parts), answer.tokens, oracle.spent) == (3, 7, 7)
    asked = server.requests[0]
    assert (asked["path"], asked["model"]) == ("/v1/chat/completions", "some-model")
    schema = asked["response_format"]["json_schema"]["schema"]
    assert schema["properties"]["parts"]["items"]["properties"]["pieces"]["items"]["maximum"] == 23
    address = asked["messages"][0]["content"][1]["image_url"]["url"]
    picture = Image.open(io.BytesIO(base64.b64decode(address.removeprefix("data:image/png;base64,"))))
    assert picture.size == question.picture.size
    assert server.keys == ["Bearer secret"]
    assert len(oracle.ask([question])[0].parts) == 3  # from the disk
    assert len(server.requests) == 1
    assert all("secret" not in file.read_text(encoding="utf-8") for file in tmp_path.iterdir())
    assert "secret" not in repr(oracle)


@pytest.mark.parametrize("script", ["garbage", "prose", 500, 400, 401, "slow", {}, {"choice": "9"}])
def test_what_goes_wrong_is_a_fault_and_is_not_kept(
    server: ChatServer, question: PieceQuestion, tmp_path: Path, script: Any
) -> None:
    server.scripts = [script]
    oracle = ChatOracle(server.url, "m", "", QUICK, tmp_path)
    assert oracle.ask([question])[0].fault
    assert not list(tmp_path.iterdir())
    before = len(server.requests)
    assert oracle.ask([question])[0].fault
    if script in (500, 400, 401, "slow"):
        assert len(server.requests) == before  # a service that fails is not asked any further


def test_a_budget_stops_asking(server: ChatServer, question: PieceQuestion, tmp_path: Path) -> None:
    oracle = ChatOracle(server.url, "m", "", QUICK.model_copy(update={"tokens": 5}), tmp_path, spent=5)
    assert "budget of 5 tokens" in oracle.ask([question])[0].fault
    assert not server.requests


def test_a_model_has_a_record_before_it_counts(server: ChatServer, question: PieceQuestion, tmp_path: Path) -> None:
    oracle = ChatOracle(server.url, "m", "", QUICK, tmp_path)
    truth = question.read(json.dumps(drawers(question))).parts
    stated = drawers(question)
    stated["parts"][0]["moves"] = "turns"
    server.scripts = [stated]
    assert voter_record(oracle, lambda: [(question, truth)]) == VoterRecord(right=2, asked=3)
    server.scripts = [500]
    assert voter_record(oracle, list) == VoterRecord(right=2, asked=3)  # kept
    dead = ChatOracle(server.url, "dead", "", QUICK, tmp_path)
    assert voter_record(dead, lambda: [(question, truth)]) == VoterRecord(right=0, asked=0)
    assert not dead.record_path.exists()


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


def test_command_line_asks_a_person_or_a_server_and_falls_back_on_geometry(  # noqa: PLR0917
    server: ChatServer, chest: Path, question: PieceQuestion, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    ask, out = tmp_path / "Q", tmp_path / "out"
    words = ["infer", str(chest), "-o", str(out), "--no-preview", "--no-validation", "--force"]
    assert run(["question", str(chest), "-o", str(ask)]) == 0
    assert json.loads((ask / "schema.json").read_text(encoding="utf-8")) == question.schema()
    assert (ask / "question.txt").read_text(encoding="utf-8") == question.text + "\n"
    answer = ask / "answer.json"
    answer.write_text("It is a chest.", encoding="utf-8")
    assert run([*words, "--answer", str(answer)]) == 2
    answer.write_text(json.dumps(drawers(question)), encoding="utf-8")
    assert run([*words, "--answer", str(answer)]) == 0
    record = json.loads((out / "inference.json").read_text(encoding="utf-8"))["vision"]
    assert (record["voter"], record["trust"], record["taken"]) == (
        str(answer),
        1.0,
        ["drawer_1", "drawer_2", "drawer_3"],
    )
    assert "3 of 3 parts were taken from the answer" in capsys.readouterr().out
    oracle = oracle_of(server.url, VISION)
    assert oracle is not None
    oracle.record_path.parent.mkdir(parents=True)
    oracle.record_path.write_text('{"right": 10, "asked": 10}', encoding="utf-8")
    server.scripts = [drawers(question)]
    assert run([*words, "--vlm", server.url]) == 0
    record = json.loads((out / "inference.json").read_text(encoding="utf-8"))["vision"]
    assert (record["questions"], record["tokens"], record["record"]) == (1, 7, {"right": 10, "asked": 10})
    several = ["batch", str(chest), "-o", str(tmp_path / "library"), "--steps", "infer", "--vlm", server.url]
    assert run([*several, "--workers", "1"]) == 0
    [line] = (tmp_path / "library" / "manifest.jsonl").read_text(encoding="utf-8").splitlines()
    assert "named 3 moving parts for 7 tokens: 10 of 10 known parts right" in json.loads(line)["asked"]
    server.scripts = [400]
    monkeypatch.setenv("KINEMATIFY_VLM_MODEL", "refuses")
    write_bin_with_lid(tmp_path / "bin.ply")
    words[1] = str(tmp_path / "bin.ply")
    assert run([*words, "--vlm", server.url]) == 3
    assert "refuses the request" in capsys.readouterr().out
    assert (out / "model.urdf").is_file()
    assert run([*words, "--vlm", "nonsense"]) == 2
