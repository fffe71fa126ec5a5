"""Rays, cameras and pictures: what is drawn stands where projection says, in the colours that were asked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from examples.make_story import render_story
from kinematify.assembly.part import Assembly
from kinematify.config import load_config
from kinematify.contact.tree import KinematicTree
from kinematify.model.urdf import distinct_colors, link_colors, link_shades
from kinematify.render.model_picture import render_preview
from kinematify.render.model_scene import (
    GLYPH_COLORS,
    best_azimuth,
    joint_glyphs,
    opened_configuration,
    posed_meshes,
)
from kinematify.render.picture import PictureScene, PosedMesh, camera_for, render_scene
from kinematify.robot.appearance import linear_of, srgb_of
from kinematify.robot.joint_type import JointType
from tests.mechanisms import Mechanism, box, chain, door, drawer, flat_and_fixed, joint, knob
from tools.draw_gallery import draw_pair

CONFIG = load_config().preview.model_copy(update={"panel_width": 240, "panel_height": 220})
UP = np.array([0.0, 0.0, 1.0])


def hue_distance(image: np.ndarray, color: np.ndarray) -> np.ndarray:
    """Angle between the pixel colours and a colour as vectors from grey [rad]; large for grey pixels."""
    chroma = image - image.mean(axis=-1, keepdims=True)
    wanted = color - color.mean()
    size = np.linalg.norm(chroma, axis=-1)
    cosine = chroma @ wanted / np.maximum(size * np.linalg.norm(wanted), 1e-9)
    return np.where(size > 0.05, np.arccos(np.clip(cosine, -1, 1)), np.pi)


@pytest.mark.parametrize(
    ("build", "kind"), [(door, JointType.REVOLUTE), (drawer, JointType.PRISMATIC), (knob, JointType.CONTINUOUS)]
)
def test_axis_is_drawn_where_it_projects(build, kind):
    model = build().model()
    meshes = tuple(posed_meshes(model, {}, link_colors(model)).values())
    glyphs = joint_glyphs(model, {}, CONFIG)
    bare, drawn = PictureScene(meshes=meshes), PictureScene(meshes=meshes, glyphs=tuple(glyphs.values()))
    camera = camera_for([drawn], -0.4, CONFIG, size=(400, 360), margin=10)
    before = np.asarray(render_scene(bare, camera, CONFIG)) / 255.0
    after = np.asarray(render_scene(drawn, camera, CONFIG)) / 255.0
    item = model.joints[0]
    arrow = glyphs[item.name].vertices
    on_axis = model.link_by_name[item.child].T_world_link[:3, 3]
    if kind is JointType.PRISMATIC:
        on_axis = model.link_by_name[item.child].part.bounds.mean(axis=0)
    along = (arrow - on_axis) @ item.axis
    line = on_axis + np.linspace(along.min(), along.max(), 40)[2:-2, None] * item.axis
    pixels = camera.project(line)[0].astype(int)
    changed = np.abs(after - before)[pixels[:, 1], pixels[:, 0]].max(axis=1)
    assert (changed > 0.02).mean() > 0.9
    bright = hue_distance(after, GLYPH_COLORS[kind]) < 0.12
    assert bright.sum() > 10
    # Nothing changes far from the arrow.
    seen = camera.project(arrow)[0]
    low, high = np.floor(seen.min(axis=0)).astype(int) - 6, np.ceil(seen.max(axis=0)).astype(int) + 6  # with its rim
    outside = np.ones(after.shape[:2], dtype=bool)
    outside[max(low[1], 0) : high[1], max(low[0], 0) : high[0]] = False
    # But for single rays that graze an edge: the arrow changes in which order triangles are asked.
    assert (after[outside] != before[outside]).mean() < 1e-4
    np.testing.assert_allclose(after[outside], before[outside], atol=0.05)


def brown_chain():
    """Five links of one material."""
    mechanism = chain()
    parts = tuple(replace(part, color=(0.42, 0.26, 0.15)) for part in mechanism.assembly.parts)
    return replace(mechanism, assembly=replace(mechanism.assembly, parts=parts)).model()


def test_parts_of_one_material_get_shades_of_it_and_numbers(tmp_path):
    model = brown_chain()
    colors, shades = link_colors(model), link_shades(model)
    shown = np.array([srgb_of(shades[link.name] * linear_of(colors[link.name])) for link in model.links])
    neighbours = np.linalg.norm(np.diff(shown, axis=0), axis=1)
    assert neighbours.min() > 0.06
    assert not distinct_colors(shown), "five shades of one brown need numbers"
    render_preview(model, tmp_path / "numbered.png", CONFIG)
    image = np.asarray(Image.open(tmp_path / "numbered.png").convert("RGB"))
    render_preview(chain().model(), tmp_path / "colored.png", CONFIG)
    plain = np.asarray(Image.open(tmp_path / "colored.png").convert("RGB"))
    white = [(panels[46:200] == 255).all(axis=2).sum() for panels in (image, plain)]
    assert white[0] > white[1] + 2 * 5 * 150, "a white badge on every part in either panel"


def test_joints_open_in_the_picture():
    opened = opened_configuration(door().model(), CONFIG)["leaf_joint"]
    assert opened == pytest.approx(1.7), "the whole range"
    assert opened_configuration(drawer().model(), CONFIG)["drawer_joint"] == pytest.approx(0.35)
    assert opened_configuration(knob().model(), CONFIG)["knob_joint"] == pytest.approx(np.deg2rad(35))
    assert set(opened_configuration(flat_and_fixed().model(), CONFIG)) == {"flap_joint"}


@pytest.mark.parametrize(("axis", "post"), [((0, 1, 0), (0, 3, 1)), ((0, 0, 1), (0, 0.8, 1))], ids=["floor", "part"])
def test_what_would_go_through_the_floor_or_a_part_is_half_open_in_the_picture(axis, post):
    free = door()
    parts = (*free.assembly.parts, box("post", post, (0.2, 0.2, 2)))
    model = Mechanism(
        "door",
        Assembly(parts=parts, source="door"),
        KinematicTree(parents=(-1, 0, 0)),
        (joint(1, "revolute", axis, (0.06, 0.01, 0.3), (0.0, 1.7)), joint(2, "fixed", UP, post, (0.0, 0.0))),
    ).model()
    assert opened_configuration(model, CONFIG)["leaf_joint"] == pytest.approx(0.85)


def test_camera_stands_where_the_moving_part_is_seen():
    # The drawer's cabinet hides it from all sides but the front, which looks along (0.6, -0.8).
    back = box("cabinet", (0, 0.3, 0), (1, 0.02, 1))
    front = box("drawer", (0, 0.1, 0), (0.5, 0.1, 0.2))
    meshes = tuple(PosedMesh(vertices=p.vertices, faces=p.faces, color=np.full(3, 0.5)) for p in (front, back))
    azimuth = best_azimuth(drawer().model(), [PictureScene(meshes=meshes)], CONFIG)
    assert np.sin(azimuth) < -0.3


def test_preview_shows_every_part_at_rest_and_moved(tmp_path):
    model = chain().model()
    render_preview(model, tmp_path / "preview.png", CONFIG)
    image = np.asarray(Image.open(tmp_path / "preview.png").convert("RGB")) / 255.0
    panels = image[: int(0.7 * image.shape[0])]
    left, right = panels[:, : image.shape[1] // 2], panels[:, image.shape[1] // 2 :]
    assert np.abs(left[50:] - right[50:]).max(axis=2).mean() * 25 > 1  # more than 4 percent of the pixels differ
    for name, color in link_colors(model).items():
        if name == model.root:
            continue
        for panel in (left, right):
            assert (hue_distance(panel, color) < 0.12).sum() > 20, name


def test_a_pair_is_the_preview_without_words(tmp_path):
    model = door().model()
    render_preview(model, tmp_path / "preview.png", CONFIG)
    preview = np.asarray(Image.open(tmp_path / "preview.png").convert("RGB"))
    pair = np.asarray(draw_pair(model, CONFIG))
    assert pair.shape[0] < preview.shape[0]
    top = next(k for k in range(preview.shape[0]) if (preview[k : k + pair.shape[0]] == pair).all())
    assert top > 0


def test_story_has_three_panels_and_the_first_is_grey(tmp_path):
    model = door().model()
    render_story(model, tmp_path / "story.png", CONFIG)
    image = np.asarray(Image.open(tmp_path / "story.png").convert("RGB")) / 255.0
    first = image[: int(0.7 * image.shape[0]), : image.shape[1] // 3]
    assert np.ptp(first, axis=2).max() < 0.06
    assert (first.mean(axis=2) < 0.8).mean() > 0.05
