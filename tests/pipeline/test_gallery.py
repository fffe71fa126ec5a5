"""The gallery shows every family: pictures that can be opened and are small, and a page whose links lead somewhere."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kinematify.errors import OutputError
from kinematify.generate.registry import FAMILIES, all_kinds
from tests.places import ROOT
from tools.draw_gallery import OPENING, PICTURES, SENTENCES, SHOWN, write_gallery

DOCS = ROOT / "docs"
LARGEST, LARGEST_IN_ALL = 60_000, 3_000_000  # bytes
MOST_PICTURES, MOST_LINES = 100, 350
TOLD = ("a cabinet with two doors and a drawer",)


def pictures_of(page: str) -> dict[str, str]:
    """What is said of each picture of a page, by its link."""
    return dict(re.findall(r"!\[[^\]]+\]\(([^)]+)\)<br>([^|]+) \|", page))


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("gallery")
    shown = {name: all_kinds()[name] for name in ("gripper", "laptop")}
    described = {"seesaw": all_kinds()["seesaw"]}
    return write_gallery(folder, shown, TOLD, described, command="make it", progress=lambda name, done: None)


def test_each_family_has_a_picture_a_row_and_its_parameters(made):
    page = made.read_text("utf-8")
    said = [f"`{name}`: {all_kinds()[name].title}" for name in ("gripper", "laptop")]
    seesaw = f"`seesaw`: {', '.join(all_kinds()['seesaw'].words[:2])}"
    assert list(pictures_of(page).values()) == [*TOLD, *said, seesaw]
    assert "Made by `make it`." in page
    for family in (all_kinds()["gripper"], all_kinds()["laptop"]):
        row = next(line for line in page.splitlines() if line.startswith(f"| `{family.name}` |"))
        assert all(f"`{parameter.name}`" in row for parameter in family.parameters)
    assert all(item.title in page for name, item in all_kinds().items() if name not in FAMILIES)


def test_pictures_are_small_and_show_two_states(made):
    for link in pictures_of(made.read_text("utf-8")):
        picture = made.parent / link
        assert picture.stat().st_size <= LARGEST
        image = np.asarray(Image.open(picture).convert("RGB")).astype(float)
        half = image.shape[1] // 2
        assert image.std() > 5.0
        assert np.abs(image[:, :half] - image[:, half : 2 * half]).max(axis=2).mean() > 2.0


def test_the_first_object_is_opened_joint_by_joint(made):
    with Image.open(made.parent / PICTURES / OPENING) as moving:
        frames = []
        for k in range(moving.n_frames):
            moving.seek(k)
            frames.append(np.asarray(moving.convert("RGB")).astype(float))
    assert len(frames) >= 3, "at rest, and after each group of joints"
    assert all(np.abs(after - before).max(axis=2).mean() > 0.5 for before, after in pairwise(frames))


def test_a_folder_that_cannot_be_written_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        write_gallery(tmp_path / "file", {}, (), {}, command="", progress=lambda name, done: None)


def test_the_committed_page_shows_every_family_and_names_every_kind():
    page = (DOCS / "gallery.md").read_text("utf-8")
    assert len(page.splitlines()) <= MOST_LINES
    links = [DOCS / link for link in pictures_of(page)]
    assert [link.stem for link in links[len(SENTENCES) :]] == [*FAMILIES, *SHOWN], "run: make pictures"
    assert tuple(pictures_of(page).values())[: len(SENTENCES)] == SENTENCES
    missing = [item.title for item in all_kinds().values() if item.title not in page]
    assert not missing, "run: make pictures"
    sizes = [link.stat().st_size for link in links]
    assert len(links) < MOST_PICTURES
    assert max(sizes) <= LARGEST
    assert sum(sizes) <= LARGEST_IN_ALL
    assert set((DOCS / "gallery").iterdir()) == {DOCS / PICTURES / OPENING, *links}
