"""`python -m tools.draw_gallery DIR`: a page with all that the generator knows, with pictures at rest and moved."""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PIL import Image

from kinematify.config import load_config
from kinematify.errors import OutputError
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.library.kind import COMMON
from kinematify.generate.procedural.parameter import PARAMETER_HEADINGS, parameter_rows
from kinematify.generate.reader import read_sentence
from kinematify.generate.registry import FAMILIES, all_kinds, build
from kinematify.render.model_picture import MARGIN, draw_panels, panel_size, rest_and_moved, scene_of
from kinematify.render.model_scene import best_azimuth, joint_glyphs, moving_joints, opened_configuration
from kinematify.render.picture import camera_for, render_scene, row_of
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.config import PreviewConfig
    from kinematify.generate.library.kind import Kind
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.model.kinematic_model import KinematicModel

SENTENCES = (
    "an oak cabinet with two glass doors above three drawers and brass knobs",
    "a red fridge with two doors, 1.6 m high",
    "a robot arm with seven joints and a three finger gripper",
    "a white dresser with six drawers in two columns",
    "an office chair on six castors",
    "a walnut desk with three drawers, 1.5 m wide",
    "a window with two sliding sashes, 1.6 m wide",
    "a blue bicycle, 1.1 m high",
)
"""What is shown of sentences."""
SHOWN = (
    "bicycle", "forklift", "helicopter", "motorcycle", "tractor", "stroller",
    "hospital_bed", "microscope", "wheelchair", "c_arm", "pipette", "infant_incubator",
    "piano", "grand_piano", "guitar", "trumpet", "ferris_wheel", "claw_machine",
    "garage_door", "dutch_door", "turnstile", "drawbridge", "toggle_clamp", "drill_press",
    "air_fryer", "toaster_oven", "stand_mixer", "moka_pot", "ironing_board", "shower_cabin",
    "crank_slider", "geneva_drive", "scotch_yoke", "scissor_lift", "planetary_gear", "worm_gear",
)  # fmt: skip
"""What is shown of the objects that files describe; there are hundreds."""
PAGE = "gallery.md"
PICTURES = "gallery"
OPENING = "opening.webp"
"""Moving picture of the first sentence's object, opened joint by joint."""
_STEP_MS = 900
_PANEL = {"panel_width": 420, "panel_height": 360, "openness_rays": 6}  # two fill a page, in seconds
_LARGE_PANEL = {"panel_width": 600, "panel_height": 500}
_QUALITY = 82  # of WebP: 5 to 30 kB each, and no blocks beside thin arrows
_COLUMNS = 4  # of a table of pictures
_BAR = r"\|"  # in a cell of a Markdown table


def write_gallery(
    folder: Path,
    families: Mapping[str, Kind],
    sentences: Sequence[str],
    described: Mapping[str, Kind],
    *,
    command: str,
    progress: Callable[[str, float], None],
) -> Path:
    """Write the page and its pictures; what an earlier call wrote is replaced.

    Args:
        folder: Gets ``gallery.md`` and ``gallery/`` with a WebP per sentence, family and described object, and one
            that moves.
        families: Each a picture and a row of what may be asked of it, in this order.
        sentences: Each becomes a picture.
        described: The same of objects that files describe.
        command: What the reader types to make the page again.
        progress: Called with the name of a picture and the share done.

    Returns:
        The page.

    Raises:
        OutputError: The folder cannot be written.
    """
    config = load_config()
    config = config.model_copy(update={"preview": config.preview.model_copy(update=_PANEL)})
    requests = [(f"sentence_{k}", text, partial(_said, text)) for k, text in enumerate(sentences, start=1)]
    requests += [(name, name, partial(build, family, {})) for name, family in {**families, **described}.items()]
    try:
        (folder / PICTURES).mkdir(parents=True, exist_ok=True)
        for number, (name, shown, make) in enumerate(requests):
            progress(shown, number / len(requests))
            model = true_model(make(), config)
            picture = draw_pair(model, config.preview)
            picture.save(folder / PICTURES / f"{name}.webp", quality=_QUALITY, method=6)
            if name == "sentence_1":
                _draw_opening(model, folder / PICTURES / OPENING, config.preview)
        page = folder / PAGE
        page.write_text(_page(families, sentences, described, command), encoding="utf-8")
    except OSError as error:
        raise OutputError(
            f"The gallery cannot be written to {folder} ({error.strerror or error}). Give a writable folder "
            "on a disk with space."
        ) from error
    return page


def draw_pair(model: KinematicModel, config: PreviewConfig) -> Image.Image:
    """Return the two panels of a preview without captions and legend, for pages that say in words what is seen.

    Args:
        model: What to show.
        config: Size and quality.
    """
    panels = rest_and_moved(model, config, ("", ""))
    _, images = draw_panels(model, panels, config)
    return row_of(images)


def draw_steps(model: KinematicModel, groups: Sequence[Sequence[str]], config: PreviewConfig) -> list[Image.Image]:
    """Return one picture of the model at rest and one more after each group of joints, which has then been moved too.

    Args:
        model: What to show.
        groups: Names of joints; each group is moved at once and shown with its arrows.
        config: Size and quality.
    """
    opened = opened_configuration(model, config)
    scenes = [replace(scene_of(model, {}, config), glyphs=())]
    q: dict[str, float] = {}
    for group in groups:
        q |= {name: opened[name] for name in group}
        arrows = joint_glyphs(model, q, config)
        scenes.append(replace(scene_of(model, q, config), glyphs=tuple(arrows[name] for name in group)))
    azimuth = best_azimuth(model, [scenes[0], scenes[-1]], config)
    size = panel_size([scenes], azimuth, config)
    camera = camera_for(scenes, azimuth, config, size=size, margin=MARGIN)
    return [render_scene(scene, camera, config) for scene in scenes]


def _said(text: str) -> Blueprint:
    return read_sentence(text).made().blueprint


def _draw_opening(model: KinematicModel, path: Path, config: PreviewConfig) -> None:
    """Open one joint after the other, then turn all that turns without end at once."""
    moving = moving_joints(model)
    endless = [joint.name for joint in moving if joint.kind is JointType.CONTINUOUS]
    groups = [[joint.name] for joint in moving if joint.name not in endless]
    larger = config.model_copy(update=_LARGE_PANEL)
    first, *others = draw_steps(model, [*groups, *([endless] if endless else [])], larger)
    first.save(path, save_all=True, append_images=others, duration=_STEP_MS, loop=0, quality=_QUALITY, method=6)


def _page(families: Mapping[str, Kind], sentences: Sequence[str], described: Mapping[str, Kind], command: str) -> str:
    said = {f"sentence_{number}": text for number, text in enumerate(sentences, start=1)}
    return f"""# Gallery

Made by `{command}`. Each picture shows an object at rest and with every joint moved. Red arrows turn, blue ones slide.

## From a sentence

A sentence names a kind of object, its sizes, its parts and their looks; see [Objects from words and data](generate.md).

{_pictures(said)}

## Families

Objects with many parameters. A sentence may say any of them; `--category NAME --set KEY=VALUE` sets them,
`--seed N` draws those that are not given, and `kinematify generate --list --category NAME` shows defaults, ranges and
units.

{_pictures({name: f"`{name}`: {family.title}" for name, family in families.items()})}

{_table(("family", "words", "parameters"), [_row(name, family) for name, family in families.items()])}

Every object has these parameters, too:

{_table(PARAMETER_HEADINGS, parameter_rows(COMMON))}

## Objects that files describe

Some of the objects whose parts, joints, parameters and words are in `kinematify/generate/kinds/`.

{_pictures({name: f"`{name}`: {', '.join(family.words[:2])}" for name, family in described.items()})}

## All kinds

A sentence may use any of these names, and each has more words. Objects of a file of their own come last.

{_kinds()}
"""


def _pictures(shown: Mapping[str, str]) -> str:
    """A table of pictures, by name, each above what is said of it."""
    cells = [f"![{text.replace('`', '')}]({PICTURES}/{name}.webp)<br>{text}" for name, text in shown.items()]
    cells += [""] * (-len(cells) % _COLUMNS)
    rows = [tuple(cells[k : k + _COLUMNS]) for k in range(0, len(cells), _COLUMNS)]
    return _table(("",) * _COLUMNS, rows)


def _row(name: str, family: Kind) -> tuple[str, ...]:
    asked = ", ".join(f"`{parameter.name}`" for parameter in family.parameters)
    return f"`{name}`", ", ".join(family.words[:5]), asked


def _kinds() -> str:
    """The title of every kind of the library, a line per module."""
    found: dict[str, list[str]] = {}
    for item in (item for name, item in all_kinds().items() if name not in FAMILIES):
        found.setdefault(item.module or "others", []).append(item.title)
    lines = [(name, ", ".join(sorted(titles))) for name, titles in sorted(found.items()) if name != "others"]
    return _table(("kinds", "objects"), [*lines, ("others", ", ".join(sorted(found["others"])))])


def _table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [headings, ("---",) * len(headings), *rows]
    return "\n".join(f"| {' | '.join(cell.replace('|', _BAR) for cell in line)} |" for line in lines)


def main() -> None:
    """Draw the page of all sentences, families and some of the objects that files describe."""
    folder = Path(sys.argv[1])
    families, described = ({name: all_kinds()[name] for name in names} for names in (FAMILIES, SHOWN))
    command = f"python -m tools.draw_gallery {folder.as_posix()}"

    def show(name: str, done: float) -> None:
        sys.stderr.write(f"{done:4.0%} {name}\n")

    sys.stdout.write(f"{write_gallery(folder, families, SENTENCES, described, command=command, progress=show)}\n")


if __name__ == "__main__":
    main()
