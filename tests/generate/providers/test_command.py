"""Programs of the user's own as generators, those that misbehave included, and prompts that are refused."""

from __future__ import annotations

import json
import shlex
import sys
import time
from typing import TYPE_CHECKING

import numpy as np
import pytest
import trimesh
from PIL import Image

from kinematify.cli.app import run
from kinematify.errors import EnvironmentFault, InputError
from kinematify.generate.providers.command import LOG_FILE, filled, run_command
from kinematify.generate.providers.job import open_job
from kinematify.generate.providers.source import MOST_WORDS, check_prompt

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.generate.providers.source import Generated


def program(body: str) -> str:
    """A command line that runs Python with the image and the folder as arguments."""
    lines = "import sys, time, pathlib\nimage, out = sys.argv[1], pathlib.Path(sys.argv[2])\n"
    text = shlex.quote(lines + body).replace("{", "{{").replace("}", "}}")
    return f"{shlex.quote(sys.executable)} -c {text} {{image}} {{out}}"


TWO_BOXES = """
def box(path, low, high):
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (low, high)]
    faces = [(1,2,4),(1,4,3),(5,7,8),(5,8,6),(1,5,6),(1,6,2),(3,4,8),(3,8,7),(1,3,7),(1,7,5),(2,6,8),(2,8,4)]
    text = ''.join('v %g %g %g\\n' % c for c in corners) + ''.join('f %d %d %d\\n' % f for f in faces)
    path.write_text(text)
box(out / 'base.obj', 0, 0.5)
box(out / 'top.obj', 0.502, 0.6)
"""


@pytest.fixture
def image(tmp_path: Path) -> Path:
    path = tmp_path / "a photo; rm -rf.png"
    Image.new("RGB", (64, 48), "green").save(path)
    return path


def generate(folder: Path, template: str, image: Path, limit: float = 20.0) -> Generated:
    prompt = check_prompt(None, (image,), seed=1)
    with open_job(folder, "command", prompt.digest({"command": template})):
        return run_command(template, limit, prompt, folder, lambda stage, done: None)


def test_program_makes_parts_and_runs_once(tmp_path: Path, image: Path) -> None:
    template = program(TWO_BOXES + "print('made', image)\n")
    made = generate(tmp_path / "job", template, image)
    assert sorted(path.name for path in made.path.iterdir()) == ["base.obj", "top.obj"]
    assert made.provenance["images"] == [image.name]
    log = (tmp_path / "job" / LOG_FILE).read_text(encoding="utf-8")
    assert str(image) in log  # one word, whatever its letters
    (tmp_path / "job" / LOG_FILE).unlink()
    generate(tmp_path / "job", template, image)
    assert not (tmp_path / "job" / LOG_FILE).exists()


def test_image_becomes_a_model_on_the_command_line(tmp_path: Path, image: Path) -> None:
    words = ["generate", "--image", str(image), "--source", "command", "--command", program(TWO_BOXES)]
    assert run([*words, "--no-validation", "--no-preview", "-o", str(tmp_path / "model")]) == 0
    record = json.loads((tmp_path / "model" / "inference.json").read_text(encoding="utf-8"))
    assert record["provenance"]["provider"] == "command"
    assert (tmp_path / "model" / "model.urdf").is_file()


def test_mesh_with_labels_is_one_object(tmp_path: Path, image: Path) -> None:
    boxes = trimesh.util.concatenate(
        [trimesh.creation.box((1, 1, 1)), trimesh.creation.box((1, 1, 0.2)).apply_translation((0, 0, 0.6))]
    )
    boxes.export(tmp_path / "whole.ply")
    np.save(tmp_path / "labels.npy", np.repeat([0, 1], 12))
    copy = f"import shutil\nfor name in ('whole.ply', 'labels.npy'): shutil.copy({str(tmp_path)!r} + '/' + name, out)\n"
    made = generate(tmp_path / "job", program(copy), image)
    assert made.path.name == "whole.ply"
    assert made.labels is not None
    assert made.labels.name == "labels.npy"


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("print('no GPU here'); sys.exit(7)", "status 7.*no GPU here"),
        ("sys.stdout.buffer.write(bytes(range(256)) * 50); sys.exit(1)", "status 1"),
        ("(out / 'notes.txt').write_text('x')", "left no mesh.*notes.txt"),
        ("(out / 'part.obj').write_text('')", "left no mesh"),
    ],
)
def test_program_that_fails_is_reported_with_what_it_said(tmp_path: Path, image: Path, body: str, said: str) -> None:
    with pytest.raises(EnvironmentFault, match=said) as caught:
        generate(tmp_path / "job", program(body), image)
    assert str(caught.value).isprintable()


def test_program_that_never_ends_is_stopped_with_its_children(tmp_path: Path, image: Path) -> None:
    marker = tmp_path / "alive"
    child = f"import time\\nwhile True: open({str(marker)!r}, 'a').write('x'); time.sleep(0.05)"
    body = f"import subprocess\nsubprocess.Popen([sys.executable, '-c', \"{child}\"])\ntime.sleep(600)"
    with pytest.raises(EnvironmentFault, match="--time-limit"):
        generate(tmp_path / "job", program(body), image, limit=1.5)
    size = marker.stat().st_size
    assert size
    time.sleep(0.4)
    assert marker.stat().st_size == size


@pytest.mark.parametrize(
    ("template", "said"),
    [
        ("", "empty"),
        ("tool {image}", "where to write"),
        ("tool {picture} {out}", "unknown fields picture"),
        ("tool 'unclosed {out}", "quotes"),
        ("tool {text} {out}", "--text"),
        ("surely-no-such-program {image} {out}", "cannot be started"),
    ],
)
def test_commands_that_cannot_run_are_refused(tmp_path: Path, image: Path, template: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        generate(tmp_path / "job", template, image)


def test_what_is_filled_in_stays_one_word(tmp_path: Path) -> None:
    prompt = check_prompt("a chair; {image} $(reboot) 'x", (), seed=4)
    words = filled("make --prompt {text} --seed={seed} -o {out}", prompt, tmp_path)
    assert words == ["make", "--prompt", "a chair; {image} $(reboot) 'x", "--seed=4", "-o", str(tmp_path)]


def test_prompts_that_make_no_sense_are_refused(tmp_path: Path) -> None:
    good = tmp_path / "good.png"
    Image.effect_noise((80, 80), 50.0).save(good)
    cut, text, small, film = (tmp_path / name for name in ("cut.png", "text.png", "small.png", "film.webp"))
    cut.write_bytes(good.read_bytes()[:2000])
    text.write_text("not an image", encoding="utf-8")
    Image.new("RGB", (4, 4)).save(small)
    frames = [Image.effect_noise((40, 40), 20.0 * k + 10.0) for k in range(3)]
    frames[0].save(film, save_all=True, append_images=frames[1:])
    Image.new("RGB", (50, 50)).save(tmp_path / "old.bmp")
    cases: list[tuple[str | None, tuple[Path, ...], str]] = [
        (None, (), "neither a text nor an image"),
        ("  \n ", (), "empty"),
        ("word " * MOST_WORDS, (), "characters"),
        (None, (tmp_path / "none.png",), "no image"),
        (None, (cut,), "to its end"),
        (None, (text,), "is no image"),
        (None, (small,), "4 x 4"),
        (None, (film,), "animation"),
        (None, (tmp_path / "old.bmp",), "PNG, JPEG or WebP"),
        (None, (good,) * 6, "at most 5"),
    ]
    for words, images, said in cases:
        with pytest.raises(InputError, match=said):
            check_prompt(words, images, seed=0)
    assert check_prompt(None, (good,), seed=0).media == ("image/png",)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--image", "x.png"], "--image needs --source"),
        (["--text", "a box", "--budget", "3"], "needs --source llm"),
        (["--source", "command", "--text", "a box"], "needs --command"),
        (["--source", "llm", "--text", "a box", "--command", "x {out}"], "--source command"),
        (["--source", "command", "--category", "cabinet"], "cannot be combined with --source command"),
        (["--source", "command", "--text", "a box", "--rounds", "2"], "it needs --source llm"),
    ],
)
def test_options_that_do_not_go_together_end_with_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    assert run(["generate", *words, "-o", str(tmp_path / "model")]) == 2
    assert said in " ".join(capsys.readouterr().err.split())
