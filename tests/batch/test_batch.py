"""`kinematify batch`: what is unreadable, killed, full or interrupted costs no other object, and no record."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import trimesh

from benchmarks.studies.batch import Killed, killed_run, workers_of
from kinematify.batch.batch_inputs import find_sources
from kinematify.cli.app import run
from tests.batch.assets import kill, manifest_lines, wait_for, write_assets, write_knob
from tests.one_mesh import bin_with_lid, box

INFER = ("--steps", "infer", "--up", "z")


def batch(*words: str | Path) -> int:
    return run(["batch", *map(str, words)])


def started(*words: str | Path) -> subprocess.Popen[str]:
    """The command in a process of its own."""
    line = [sys.executable, "-m", "kinematify", "batch", *map(str, words)]
    return subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def by_object(out: Path) -> dict[str, dict[str, object]]:
    lines = manifest_lines(out)
    records = {str(line["object"]): line for line in lines}
    assert len(records) == len(lines)
    return records


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with assets, good and bad, and the output of a run over them."""
    folder = tmp_path_factory.mktemp("batch")
    write_assets(folder / "assets", 2)
    write_knob(folder / "assets" / "deep" / "knob_0.glb", 5)
    (folder / "assets" / "broken.glb").write_bytes(b"glTF\x02")
    (folder / "assets" / "dangling.glb").symlink_to(folder / "nowhere.glb")
    assert batch(folder / "assets/**/*.glb", "-o", folder / "out", "--up", "z", "--steps", "infer,validate,export") == 1
    return folder


def test_meshes_that_nobody_segmented_are_grouped_and_one_of_several_objects_is_reported(tmp_path: Path) -> None:
    boards, lid = bin_with_lid()
    one = trimesh.util.concatenate([*boards, *lid])
    (tmp_path / "assets").mkdir()
    one.export(tmp_path / "assets" / "bin.ply")
    scene = [box((3, 2, 0.02), (0.5, 0, -0.01)), one, one.copy().apply_translation((1, 0, 0))]
    trimesh.util.concatenate(scene).export(tmp_path / "assets" / "two.ply")
    nodes = trimesh.Scene()
    for name, pieces in (("wood", [*boards, lid[0]]), ("metal", lid[1:])):
        nodes.add_geometry(trimesh.util.concatenate(pieces), node_name=name)
    nodes.export(tmp_path / "assets" / "materials.glb")
    asked = ("--pieces", "group", *INFER)
    assert batch(tmp_path / "assets/*.*", "-o", tmp_path / "out", *asked) == 1
    records = by_object(tmp_path / "out")
    assert records["bin"]["status"] == "ok"
    assert 2 <= int(str(records["bin"]["parts"])) < 7
    assert records["materials"]["parts"] == records["bin"]["parts"], "nodes named by material are no parts"
    assert records["two"]["status"] == "unusable"
    assert "shows 2 objects on a floor" in str(records["two"]["error"])


def test_what_is_unreadable_is_recorded_among_the_good_ones(done: Path) -> None:
    records = by_object(done / "out")
    assert {name: record["status"] for name, record in records.items()} == {
        "knob_0": "ok", "knob_1": "ok", "deep-knob_0": "ok", "broken": "unusable", "dangling": "unusable",
    }  # fmt: skip
    assert "dangling.glb cannot be read: No such file or directory" in str(records["dangling"]["error"])
    good = records["knob_0"]
    assert (good["parts"], good["joints"]) == (2, 1)
    assert good["verdict"] in ("pass", "warn")
    assert float(str(good["peak_mb"])) > 50.0


def test_a_finished_object_has_a_folder_of_its_own_and_nothing_is_left_beside_them(done: Path) -> None:
    folder = done / "out" / "objects" / "deep-knob_0"
    assert {path.name for path in folder.iterdir()} >= {"model.urdf", "inference.json", "validation.json", "model.xml"}
    assert json.loads((folder / "validation.json").read_text())["model"] == str(folder / "model.urdf")
    assert {path.name for path in (done / "out").iterdir()} == {
        "objects", "manifest.jsonl", "index.html", ".manifest.jsonl.lock",
    }  # fmt: skip
    assert "deep-knob_0" in (done / "out" / "index.html").read_text()


def test_a_run_is_not_touched_unless_asked_for(done: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert batch(done / "assets/**/*.glb", "-o", done / "out", *INFER) == 2
    assert "holds a run with 5 objects. Go on with --resume" in capsys.readouterr().err


def test_what_has_not_changed_is_not_converted_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assets = write_assets(tmp_path / "assets", 2)
    command = (tmp_path / "assets/*.glb", "-o", tmp_path / "out", *INFER, "--json", "-")

    def new(*more: str) -> int:
        capsys.readouterr()
        assert batch(*command, *more) == 0
        return int(json.loads(capsys.readouterr().out)["new"])

    assert (new(), new("--resume")) == (2, 0)
    write_knob(assets[1], 7)
    assert new("--resume") == 1
    assert new("--resume", "--seed", "4") == 2
    assert len(by_object(tmp_path / "out")) == 2


def test_equal_names_stay_apart(tmp_path: Path) -> None:
    first, second = write_knob(tmp_path / "a" / "knob.glb", 0), write_knob(tmp_path / "b" / "knob.glb", 1)
    assert batch(first, second, "-o", tmp_path / "out", *INFER) == 0
    names = sorted(by_object(tmp_path / "out"))
    assert [name.rpartition("-")[0] for name in names] == ["knob", "knob"]
    assert sorted(path.name for path in (tmp_path / "out" / "objects").iterdir()) == names


def write_boxes(folder: Path, boxes: list[tuple[tuple[float, float, float], tuple[float, float, float]]]) -> None:
    """A file for each box, given by size and centre."""
    folder.mkdir(parents=True)
    for number, (size, centre) in enumerate(boxes):
        box(size, centre).export(folder / f"box_{number}.stl")


def test_a_folder_of_objects_is_told_from_one_of_parts(tmp_path: Path) -> None:
    def found(*patterns: Path, besides: Path | None = None) -> list[str]:
        return [source.name for source in find_sources(list(map(str, patterns)), besides=besides and str(besides))]

    drawers = [((0.4, 0.5, 0.19), (0.0, 0.0, 0.1 + 0.2 * k)) for k in range(4)]
    write_boxes(tmp_path / "chest", [((0.5, 0.5, 0.9), (0.0, 0.0, 0.45)), *drawers])
    assert found(tmp_path / "chest") == ["chest"], "drawers stand in the carcass, and not in each other"
    sizes = [(0.5, 0.4, 0.3), (0.1, 0.1, 0.1), (1.0, 0.4, 2.0), (0.3, 0.6, 0.0)]
    write_boxes(tmp_path / "assets" / "boxes", [(size, (0.0, 0.0, 0.5 * size[2])) for size in sizes])
    (tmp_path / "assets" / "boxes" / "broken.stl").write_bytes(b"solid")
    assert found(tmp_path / "assets" / "boxes") == ["box_0", "box_1", "box_2", "box_3", "broken"]
    write_assets(tmp_path / "assets" / "knobs", 2)
    knobs = ["knobs-knob_0", "knobs-knob_1"]
    assert found(tmp_path / "assets") == [*(f"boxes-box_{k}" for k in range(4)), "boxes-broken", *knobs], "with nodes"
    assert found(tmp_path / "assets", besides=tmp_path / "assets" / "boxes") == knobs
    assert found(tmp_path / "*")[-1] == "chest", "a pattern names objects of a folder alike"
    (tmp_path / "chest" / "model.urdf").write_text("<robot/>")
    assert found(tmp_path / "chest") == ["model"]
    write_boxes(tmp_path / "two", [((0.4, 0.4, 0.4), (0.0, 0.0, 0.2)), ((0.3, 0.3, 0.3), (0.0, 0.0, 0.2))])
    assert found(tmp_path / "two") == ["two"], "two boxes may be a drawer in its carcass"


def test_shares_are_disjoint_and_complete(tmp_path: Path) -> None:
    write_assets(tmp_path / "assets", 3)
    for number in (1, 2):
        words = ("--shard", f"{number}/2", "--json", str(tmp_path / "answer.json"))
        assert batch(tmp_path / "assets/*.glb", "-o", tmp_path / "out", *INFER, *words) == 0
    found = [line["object"] for n in (1, 2) for line in manifest_lines(tmp_path / "out", f"manifest-{n}-of-2.jsonl")]
    assert sorted(found) == [f"knob_{number}" for number in range(3)]
    page = (tmp_path / "out" / "index.html").read_text()
    assert all(f"knob_{number}" in page for number in range(3))


def test_time_that_ran_out_is_recorded_and_tried_again_if_asked(tmp_path: Path) -> None:
    write_assets(tmp_path / "assets", 1)
    command = (tmp_path / "assets/*.glb", "-o", tmp_path / "out", *INFER)
    assert batch(*command, "--timeout", "0.01") == 1
    assert by_object(tmp_path / "out")["knob_0"]["status"] == "timeout"
    assert batch(*command, "--resume") == 1
    assert batch(*command, "--resume", "--retry") == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("nothing/*.glb",), r"nothing/\*.glb matches no file"),
        (("--steps", "infer,paint"), "--steps names 'paint'"),
        (("--steps", "refine"), "has nothing to work on"),
        (("--to", "dae"), "--to names 'dae'"),
        (("--shard", "3/2"), "3/2 is no share"),
        (("--retry",), "--retry belongs to --resume"),
        (("--address", "auto"), "--address belongs to --engine ray"),
    ],
)
def test_what_cannot_be_done_is_said_at_once(
    words: tuple[str, ...], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_assets(tmp_path / "assets", 1)
    assert batch(tmp_path / "assets/*.glb", "-o", tmp_path / "out", *words) == 2
    assert re.search(said, capsys.readouterr().err)


def test_ctrl_c_ends_the_workers_and_keeps_what_is_known(tmp_path: Path) -> None:
    write_assets(tmp_path / "assets", 4)
    words = (tmp_path / "assets/*.glb", "-o", tmp_path / "out", *INFER)
    command = started(*words, "--workers", "1")
    wait_for(tmp_path / "out" / "manifest.jsonl")
    workers = workers_of(command.pid)
    command.send_signal(signal.SIGINT)
    _, said = command.communicate(timeout=300.0)
    assert command.returncode == 130
    assert "objects are left. Go on with --resume" in said
    assert workers
    assert not any(Path(f"/proc/{worker}").exists() for worker in workers)
    ended = len(by_object(tmp_path / "out"))
    assert 1 <= ended < 4
    assert not list((tmp_path / "out").glob(".unfinished*"))
    assert batch(*words, "--resume") == 0
    assert len(by_object(tmp_path / "out")) == 4


def test_two_runs_do_not_write_one_output(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_assets(tmp_path / "assets", 8)
    words = (tmp_path / "assets/*.glb", "-o", tmp_path / "out", *INFER)
    command = started(*words, "--workers", "1")
    wait_for(tmp_path / "out" / "manifest.jsonl")
    try:
        assert batch(*words, "--resume") == 2
        assert "is being written by process" in capsys.readouterr().err
    finally:
        command.terminate()
        command.communicate(timeout=300.0)
    assert command.returncode == 130, "schedulers stop jobs by SIGTERM"


def test_an_object_that_costs_every_worker_is_set_aside(tmp_path: Path) -> None:
    write_assets(tmp_path / "assets", 1)
    command = started(tmp_path / "assets/*.glb", "-o", tmp_path / "out", *INFER)
    deadline = time.monotonic() + 300.0
    while command.poll() is None and time.monotonic() < deadline:
        for worker in workers_of(command.pid):
            kill(worker)
    command.communicate(timeout=300.0)
    assert command.returncode == 1
    record = by_object(tmp_path / "out")["knob_0"]
    assert (record["status"], record["error"]) == ("crash", "the worker ended with SIGKILL, the last of 3 that it cost")


def test_nothing_is_lost_or_doubled_when_workers_and_the_driver_are_killed(tmp_path: Path) -> None:
    write_assets(tmp_path / "assets", 8)
    asked = Killed(pattern=str(tmp_path / "assets/*.glb"), steps="infer", objects=8, workers=2, every=4.0, drivers=2)
    found = killed_run(asked)
    assert (found["lost"], found["doubled"]) == (0, 0)
    assert set(found["status"]) <= {"ok", "crash"}, "on a busy machine three kills can hit one object"
    assert found["workers_killed"] > 0
    assert found["drivers_killed"] == 2


def test_a_killed_driver_takes_its_workers_with_it_and_what_it_left_is_cleared(tmp_path: Path) -> None:
    write_assets(tmp_path / "assets", 3)
    words = (tmp_path / "assets/*.glb", "-o", tmp_path / "out", *INFER)
    command = started(*words)
    wait_for(tmp_path / "out" / "manifest.jsonl")
    workers = workers_of(command.pid)
    command.kill()
    command.communicate()
    deadline = time.monotonic() + 300.0
    while any(Path(f"/proc/{worker}").exists() for worker in workers) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert workers
    assert not any(Path(f"/proc/{worker}").exists() for worker in workers)
    assert list((tmp_path / "out").glob(".unfinished*"))
    assert batch(*words, "--resume") == 0
    assert not list((tmp_path / "out").glob(".unfinished*"))
    assert {path.name for path in (tmp_path / "out" / "objects").iterdir()} == set(by_object(tmp_path / "out"))
