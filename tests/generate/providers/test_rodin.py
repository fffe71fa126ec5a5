"""The client of the paid generator against a server of ours: failures have messages, and nothing is paid twice."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from typing import TYPE_CHECKING

import numpy as np
import pytest
import trimesh
from PIL import Image

from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.errors import EnvironmentFault, InputError, OutputError
from kinematify.generate.providers.job import open_job
from kinematify.generate.providers.rodin import ADDRESS, KEY, RodinSource
from kinematify.generate.providers.source import check_prompt
from tests.generate.providers.rodin_server import KEY as SECRET
from tests.generate.providers.rodin_server import RodinServer

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from kinematify.generate.providers.source import Generated

QUICK = {"first_pause": 0.01, "longest_pause": 0.02, "tries": 3, "answer_seconds": 2.0, "job_seconds": 0.5}


def box_with_lid() -> bytes:
    """Two parts as one GLB: an open box of five boards in one mesh, and a lid above it."""
    boards = [
        ((0.4, 0.3, 0.01), (0, 0, 0)), ((0.01, 0.3, 0.2), (-0.195, 0, 0.1)), ((0.01, 0.3, 0.2), (0.195, 0, 0.1)),
        ((0.4, 0.01, 0.2), (0, -0.145, 0.1)), ((0.4, 0.01, 0.2), (0, 0.145, 0.1)),
    ]  # fmt: skip
    body = trimesh.util.concatenate([trimesh.creation.box(size).apply_translation(at) for size, at in boards])
    lid = trimesh.creation.box((0.4, 0.3, 0.01)).apply_translation((0, 0, 0.206))
    scene = trimesh.Scene()
    turn = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])
    for name, mesh in (("body", body), ("lid", lid)):
        scene.add_geometry(mesh.apply_transform(turn), node_name=name, geom_name=name)
    return bytes(scene.export(file_type="glb"))


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[RodinServer]:
    found = RodinServer({"base.glb": box_with_lid()})
    monkeypatch.setenv(KEY, SECRET)
    monkeypatch.setenv(ADDRESS, found.url)
    yield found
    found.close()


def generate(
    folder: Path, *, budget: float | None = None, resend: bool = False, said: list[str] | None = None
) -> Generated:
    settings = load_config().sources.rodin.model_copy(update=QUICK)
    source = RodinSource(settings, budget)
    prompt = check_prompt("a box with a lid", (), seed=3)
    with open_job(folder, source.name, prompt.digest(source.options())) as job:
        if resend:
            job.resend()
        return source.generate(prompt, job, lambda stage, done: None if said is None else said.append(stage))


def test_text_becomes_parts_with_their_provenance_and_the_key_is_written_nowhere(
    server: RodinServer, tmp_path: Path
) -> None:
    made = generate(tmp_path / "job")
    assert made.path.name == "base.glb"
    assert made.path.read_bytes() == box_with_lid()
    facts = made.provenance
    assert (facts.text, facts.seed, facts.details["parts"]) == ("a box with a lid", 3, "bang-1")
    assert "credits" in str(facts.cost)
    assert b"a box with a lid" in server.bodies[0]
    assert b"rodin-1" in server.bodies[2]  # the parts are those of the shape
    assert server.keys_at_links == [None]
    for file in (tmp_path / "job").rglob("*"):
        if file.is_file():
            assert SECRET.encode() not in file.read_bytes()


def test_same_request_is_never_sent_again(server: RodinServer, tmp_path: Path) -> None:
    generate(tmp_path / "job")
    before = server.requests.copy()
    generate(tmp_path / "job")
    assert server.requests == before


@pytest.mark.parametrize(("status", "said"), [(401, KEY), (402, "credit"), (422, "refuses"), (403, KEY)])
def test_refusals_cost_nothing_and_can_be_mended(server: RodinServer, tmp_path: Path, status: int, said: str) -> None:
    server.faults["/rodin"] = [status]
    with pytest.raises(InputError, match=said) as caught:
        generate(tmp_path / "job")
    assert SECRET not in str(caught.value)
    assert generate(tmp_path / "job").path.is_file()
    assert server.paid == {"/rodin": 1, "/bang": 1}


def test_too_many_requests_are_waited_for(server: RodinServer, tmp_path: Path) -> None:
    server.faults["/rodin"] = [429, 503]
    server.faults["/status"] = [429]
    said: list[str] = []
    generate(tmp_path / "job", said=said)
    assert server.paid == {"/rodin": 1, "/bang": 1}
    assert sum("once more in" in words for words in said) == 3


def test_service_that_stays_busy_took_nothing(server: RodinServer, tmp_path: Path) -> None:
    server.faults["/rodin"] = [429, 429, 429]
    with pytest.raises(EnvironmentFault, match="nothing was paid"):
        generate(tmp_path / "job")
    generate(tmp_path / "job")
    assert server.paid == {"/rodin": 1, "/bang": 1}


@pytest.mark.parametrize("fault", ["drop", 500, "garbage", "odd"])
def test_what_may_have_been_paid_is_not_sent_again_unless_asked(
    server: RodinServer, tmp_path: Path, fault: str | int
) -> None:
    server.faults["/bang"] = [fault]
    with pytest.raises(EnvironmentFault):
        generate(tmp_path / "job")
    sent = server.requests["/bang"]
    with pytest.raises(EnvironmentFault, match="--resend"):
        generate(tmp_path / "job")
    assert server.requests["/bang"] == sent
    generate(tmp_path / "job", resend=True)
    assert server.paid["/rodin"] == 1
    assert server.requests["/bang"] == sent + 1


@pytest.mark.parametrize("fault", [500, "drop", "garbage"])
def test_questions_that_cost_nothing_are_asked_again(server: RodinServer, tmp_path: Path, fault: str | int) -> None:
    server.faults["/status"] = [fault]
    if fault == "garbage":
        with pytest.raises(EnvironmentFault, match="no JSON"):
            generate(tmp_path / "job")
    generate(tmp_path / "job")
    assert server.paid == {"/rodin": 1, "/bang": 1}


def test_failed_job_is_said_and_is_not_paid_for_again_by_itself(server: RodinServer, tmp_path: Path) -> None:
    server.faults["/status"] = ["failed"]
    for _ in range(2):
        with pytest.raises(EnvironmentFault, match="--resend"):
            generate(tmp_path / "job")
    assert server.paid == {"/rodin": 1}
    generate(tmp_path / "job", resend=True)
    assert server.paid == {"/rodin": 2, "/bang": 1}


def test_slow_job_goes_on_in_the_next_call(server: RodinServer, tmp_path: Path) -> None:
    server.faults["/status"] = ["waiting"] * 60
    with pytest.raises(EnvironmentFault, match="is not done"):
        generate(tmp_path / "job")
    server.faults.clear()
    generate(tmp_path / "job")
    assert server.paid == {"/rodin": 1, "/bang": 1}


def test_truncated_file_and_expired_link_are_fetched_again(server: RodinServer, tmp_path: Path) -> None:
    server.faults["link"] = ["cut", 403]
    server.faults["/download"] = ["empty"]
    made = generate(tmp_path / "job")
    assert made.path.read_bytes() == box_with_lid()
    assert server.requests["link"] == 3
    assert server.requests["/download"] == 3
    assert not list((tmp_path / "job").rglob("*.partly"))


def test_file_that_stays_truncated_is_never_taken(server: RodinServer, tmp_path: Path) -> None:
    server.faults["link"] = ["cut"] * 3
    with pytest.raises(EnvironmentFault, match="pays nothing"):
        generate(tmp_path / "job")
    assert not list((tmp_path / "job").rglob("*.glb"))
    assert generate(tmp_path / "job").path.is_file()
    assert server.paid == {"/rodin": 1, "/bang": 1}


def test_several_files_are_the_parts_of_one_object(server: RodinServer, tmp_path: Path) -> None:
    lid = bytes(trimesh.creation.box((1, 1, 0.1)).export(file_type="stl"))
    server.files = {"../../part_1.stl": lid, "part_2.stl": lid, "preview.png": b"\x89PNG"}  # and nothing leaves the job
    made = generate(tmp_path / "job")
    assert made.path.is_dir()
    assert sorted(path.name for path in made.path.glob("*.stl")) == ["part_1.stl", "part_2.stl"]


def test_budget_is_asked_before_anything_is_sent(server: RodinServer, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="Nothing was sent"):
        generate(tmp_path / "job", budget=0.6)
    assert not server.requests
    assert generate(tmp_path / "job", budget=1.0).path.is_file()


def test_key_is_needed_and_sent_to_encrypted_addresses_only(
    server: RodinServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(ADDRESS, "http://example.com/api")
    with pytest.raises(InputError, match="https"):
        generate(tmp_path / "job")
    monkeypatch.delenv(KEY)
    with pytest.raises(InputError, match=KEY):
        generate(tmp_path / "job")
    assert not server.requests


def test_no_network_is_said(server: RodinServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    del server
    monkeypatch.setenv(ADDRESS, "http://127.0.0.1:9/api")
    with pytest.raises(EnvironmentFault, match="nothing was paid"):
        generate(tmp_path / "job")


def test_job_of_another_request_or_another_process_is_left_alone(server: RodinServer, tmp_path: Path) -> None:
    generate(tmp_path / "job")
    with pytest.raises(InputError, match="another request"), open_job(tmp_path / "job", "rodin", "other"):
        pass
    again = open_job(tmp_path / "two", "rodin", "x")
    with open_job(tmp_path / "two", "rodin", "x"), pytest.raises(OutputError, match="Another process"), again:
        pass
    (tmp_path / "two" / "job.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="no state"), open_job(tmp_path / "two", "rodin", "x"):
        pass
    assert server.paid == {"/rodin": 1, "/bang": 1}


def test_killed_client_resumes_and_pays_once(server: RodinServer, tmp_path: Path) -> None:
    """A process of its own is killed while it waits for the shape; the next one goes on."""
    server.faults["/status"] = ["waiting"] * 10_000
    words = ["generate", "--text", "a box with a lid", "--source", "rodin", "--no-validation", "-o"]
    command = [sys.executable, "-m", "kinematify", *words, str(tmp_path / "box")]
    client = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=os.environ.copy())
    deadline = time.monotonic() + 60.0
    while not server.requests["/status"] and time.monotonic() < deadline:
        time.sleep(0.02)
    client.send_signal(signal.SIGKILL)
    client.wait()
    assert server.paid == {"/rodin": 1}
    server.faults.clear()
    assert run([*words, str(tmp_path / "box")]) == 0
    assert server.paid == {"/rodin": 1, "/bang": 1}
    record = json.loads((tmp_path / "box" / "inference.json").read_text(encoding="utf-8"))
    assert record["provenance"]["provider"] == "Hyper3D Rodin + BANG"
    assert {part["name"] for part in record["parts"]} == {"body", "lid"}
    assert SECRET not in (tmp_path / "box" / "inference.json").read_text(encoding="utf-8")


def test_a_finished_job_answers_without_key_and_network(
    server: RodinServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    image = tmp_path / "box.png"
    Image.new("RGB", (64, 64), "red").save(image)
    words = ["generate", "--image", str(image), "--source", "rodin", "--no-validation", "--no-preview"]
    assert run([*words, "-o", str(tmp_path / "first")]) == 0
    assert image.read_bytes() in server.bodies[0]
    before = server.requests.copy()
    monkeypatch.delenv(KEY)
    shutil.copytree(tmp_path / "first.job", tmp_path / "second.job")
    assert run([*words, "-o", str(tmp_path / "second")]) == 0
    assert server.requests == before
    urdfs = [(tmp_path / name / "model.urdf").read_text(encoding="utf-8") for name in ("first", "second")]
    assert urdfs[0] == urdfs[1]
    capsys.readouterr()
    assert run([*words, "--seed", "9", "-o", str(tmp_path / "third")]) == 2
    assert KEY in capsys.readouterr().err
