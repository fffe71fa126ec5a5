"""The gallery shows every family: pictures that can be opened and are small, and a page whose links lead somewhere."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kinematify.errors import OutputError
from kinematify.generate.described import known_families
from kinematify.generate.procedural.families import FAMILIES
from tests.places import ROOT
from tools.draw_gallery import OPENING, PICTURES, SENTENCES, pictured, write_gallery

DOCS = ROOT / "docs"
LARGEST, LARGEST_IN_ALL = 60_000, 4_000_000  # bytes
TOLD = ("a cart with two wheels and a drawer",)


def pictures_of(page: str) -> dict[str, str]:
    """Picture of each section of a page, by its heading."""
    return dict(re.findall(r"^## (\w+)\n\n!\[[^\]]+\]\(([^)]+)\)$", page, flags=re.MULTILINE))


def told_of(page: str) -> dict[str, str]:
    """Picture of each sentence of a page."""
    return {
        text: link for text, link, under in re.findall(r"!\[([^\]]+)\]\(([^)]+)\)<br>([^|]+) \|", page) if text == under
    }


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("gallery")
    shown = {name: FAMILIES[name] for name in ("gripper", "laptop")}
    described = {"seesaw": known_families()["seesaw"]}
    return write_gallery(folder, shown, TOLD, described, command="make it", progress=lambda name, done: None)


def test_each_family_has_a_section_with_its_words_and_parameters(made):
    page = made.read_text("utf-8")
    assert list(pictures_of(page)) == ["gripper", "laptop"]
    assert "Made by `make it`." in page
    assert ", ".join(FAMILIES["laptop"].words) in page
    for family in (FAMILIES["gripper"], FAMILIES["laptop"]):
        for parameter in family.all_parameters:
            assert f"| {parameter.name} | " in page
    assert re.search(r"Joints: 1 revolute \(1\)\.", page)


def test_pictures_are_small_and_show_two_states(made):
    page = made.read_text("utf-8")
    assert list(told_of(page)) == [*TOLD, f"a {', '.join(known_families()['seesaw'].words[:4])}"]
    for link in [*pictures_of(page).values(), *told_of(page).values()]:
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
    assert len(frames) == 3, "at rest, the drawer, both wheels"
    assert all(np.abs(after - before).max(axis=2).mean() > 0.5 for before, after in pairwise(frames))


def test_a_folder_that_cannot_be_written_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        write_gallery(tmp_path / "file", {}, (), {}, command="", progress=lambda name, done: None)


def test_the_committed_page_shows_every_family():
    page = (DOCS / "gallery.md").read_text("utf-8")
    pictures = pictures_of(page)
    assert list(pictures) == list(FAMILIES), "run: python -m tools.draw_gallery docs"
    told = told_of(page)
    assert tuple(told)[: len(SENTENCES)] == SENTENCES
    described = list(pictured())
    assert [Path(link).stem for link in told.values()][len(SENTENCES) :] == described
    assert len(SENTENCES) >= 30
    pictures |= told
    sizes = {name: (DOCS / link).stat().st_size for name, link in pictures.items()}
    assert max(sizes.values()) <= LARGEST
    assert sum(sizes.values()) <= LARGEST_IN_ALL
    assert set((DOCS / "gallery").iterdir()) == {
        DOCS / PICTURES / OPENING,
        *(DOCS / link for link in pictures.values()),
    }
