"""`python -m tools.draw_gallery DIR`: a page with all that the generator knows, with pictures at rest and moved."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.config import load_config
from kinematify.errors import OutputError
from kinematify.generate.described import known_families
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import COMMON, build
from kinematify.generate.procedural.parameter import PARAMETER_HEADINGS, parameter_rows
from kinematify.generate.sentence import from_text
from kinematify.model.preview import draw_pair, draw_steps
from kinematify.model.scene import moving_joints
from kinematify.pipeline.generate import true_model
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.config import PreviewConfig
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.parameter import Parameter
    from kinematify.model.kinematic_model import KinematicModel

SENTENCES = (
    "a walnut tool cart with four casters, a push handle, three drawers, a glass door, a turntable and brass handles",
    "a red toolbox with two cantilever trays and a carrying handle",
    "a green scissor lift on four wheels",
    "a dark red pickup truck",
    "a control box with a crank, a gauge needle and nine buttons",
    "an oak cabinet with two glass doors and three drawers and golden handles",
    "a pine folding table with four legs",
    "a white refrigerator with two doors and two drawers",
    "a yellow mobile robot with four wheels and an arm",
    "a blue crate with a lid and a carrying handle",
    "an oak cabinet with a glass sliding door on the left and two drawers",
    "a steel workbench with four drawers and a crank on the right side",
    "a grey control panel with twelve red buttons, two levers and three dials",
    "a copper drum with a lid and a black hand wheel",
    "a column with a folding arm and a black hand wheel",
    "an orange car with four wheels and two doors",
    "a walnut tv stand with two flaps and two drawers",
    "a black printer with a scanner lid and two white paper trays",
    "a green trolley with four casters, a push handle and a glass lid",
    "an oak table with a drawer and a white turntable",
    "a pine wardrobe with three mirror doors and two drawers",
    "a vending machine with a glass door, six yellow buttons and a flap",
    "a platform with four black wheels and a telescopic mast",
    "a blue filing cabinet with four drawers, four casters and chrome handles",
    "a cabinet with three brass hooks, a door and a pedal",
    "a steel pedestal with a gripper",
    "a grey housing with two black fans and a red lever",
    "a doorway with two walnut doors and brass handles",
    "a turquoise locker with two doors and six hooks",
    "a purple toy truck with six wheels and a tailgate",
)
"""What is shown of composed objects."""
PAGE = "gallery.md"
PICTURES = "gallery"
OPENING = "opening.webp"
"""Moving picture of the first sentence's object, opened joint by joint."""
_STEP_MS = 900
_PANEL = {"panel_width": 420, "panel_height": 360, "openness_rays": 6}  # two fill a page, in seconds
_LARGE_PANEL = {"panel_width": 600, "panel_height": 500}
_QUALITY = 82  # of WebP: 5 to 30 kB each, and no blocks beside thin arrows
_SEEDS = range(8)  # enough to meet the usual numbers of joints
_BAR = r"\|"  # in a cell of a Markdown table


def write_gallery(
    folder: Path,
    families: Mapping[str, Family],
    sentences: Sequence[str],
    described: Mapping[str, Family],
    *,
    command: str,
    progress: Callable[[str, float], None],
) -> Path:
    """Write the page and its pictures; what an earlier call wrote is replaced.

    Args:
        folder: Gets ``gallery.md`` and ``gallery/`` with a WebP per sentence, family and described object, and one
            that moves.
        families: What to show, in this order.
        sentences: Each becomes a picture, before the families.
        described: What files describe: each a picture with its words, behind the sentences.
        command: What the reader types to make the page again.
        progress: Told the family and the share done.

    Returns:
        The page.

    Raises:
        OutputError: The folder cannot be written.
    """
    config = load_config()
    config = config.model_copy(update={"preview": config.preview.model_copy(update=_PANEL)})
    sections = []

    def draw(blueprint: Blueprint, name: str) -> None:
        picture = draw_pair(true_model(blueprint, config), config.preview)
        picture.save(folder / PICTURES / f"{name}.webp", quality=_QUALITY, method=6)

    pictures = len(sentences) + len(described) + len(families)
    try:
        (folder / PICTURES).mkdir(parents=True, exist_ok=True)
        for number, sentence in enumerate(sentences):
            progress(sentence, number / pictures)
            blueprint = from_text(sentence).build()
            draw(blueprint, f"composed_{number + 1}")
            if number == 0:
                _draw_opening(true_model(blueprint, config), folder / PICTURES / OPENING, config.preview)
        for number, (name, family) in enumerate({**described, **families}.items()):
            progress(name, (len(sentences) + number) / pictures)
            blueprint = build(family, {})
            draw(blueprint, name)
            if name in families:
                sections.append(_section(family, blueprint))
        page = folder / PAGE
        page.write_text("\n".join([_head(families, sentences, described, command), *sections]), encoding="utf-8")
    except OSError as error:
        raise OutputError(
            f"The gallery cannot be written to {folder} ({error.strerror or error}). Give a folder that you may write "
            "to, on a disk with space."
        ) from error
    return page


def _draw_opening(model: KinematicModel, path: Path, config: PreviewConfig) -> None:
    """Open one joint after the other, then turn all that turns without end at once."""
    moving = moving_joints(model)
    endless = [joint.name for joint in moving if joint.kind is JointType.CONTINUOUS]
    groups = [[joint.name] for joint in moving if joint.name not in endless]
    larger = config.model_copy(update=_LARGE_PANEL)
    first, *others = draw_steps(model, [*groups, *([endless] if endless else [])], larger)
    first.save(path, save_all=True, append_images=others, duration=_STEP_MS, loop=0, quality=_QUALITY, method=6)


def _head(
    families: Mapping[str, Family], sentences: Sequence[str], described: Mapping[str, Family], command: str
) -> str:
    composed = {f"composed_{number}": text for number, text in enumerate(sentences, start=1)}
    asked = {name: f"a {', '.join(family.words[:4])}" for name, family in described.items()}
    return f"""# Gallery

Made by `{command}`. All pictures show an object at rest and with every joint moved. Red arrows turn, blue ones slide.

## From a sentence

A sentence names an object of a family and its properties, or mechanisms that are composed on a body. A sentence with a
word that is not understood is refused. Words that have no effect on shape or motion are reported.

{_pictures(composed, 2)}

## Objects that files describe

Each of these {len(described)} has a file of its own in `kinematify/generate/objects/`: parts made of primitives,
the joints between them, and words. A sentence may use any of the words, count the parts, and name colour, material,
size and how far it is open. The first words are under each picture.
`kinematify generate --list` names the others, which are built in steps and have no picture here.

{_pictures(asked, 3)}

## Families

The {len(families)} families of `kinematify generate`, each with its defaults. A sentence (`--text`) may use any
of the words and say any of the parameters; `--category NAME --set KEY=VALUE` sets them, and
`--seed N` draws those that are not given. The joints are those of the object shown; in brackets is the range over
{len(_SEEDS)} seeds.

{", ".join(f"[{name}](#{name})" for name in families)}

Every family has these parameters:

{_table(COMMON)}
"""


def _pictures(told: Mapping[str, str], columns: int) -> str:
    """A table of pictures, by name, each above what is said."""
    cells = [f"![{text}]({PICTURES}/{name}.webp)<br>{text}" for name, text in told.items()]
    rows = [cells[k : k + columns] for k in range(0, len(cells), columns)]
    head = (("",) * columns, ("---",) * columns)
    return "\n".join(f"| {' | '.join(row)} |" for row in (*head, *rows))


def _section(family: Family, blueprint: Blueprint) -> str:
    return f"""## {family.name}

![{family.title}, at rest and with every joint moved]({PICTURES}/{family.name}.webp)

{_sentence(family.title)}. Words: {", ".join(family.words)}. {_joints(family, blueprint)}

{_table(family.parameters)}
"""


def _sentence(words: str) -> str:
    return words[:1].upper() + words[1:]


def _joints(family: Family, blueprint: Blueprint) -> str:
    kinds = Counter(joint.kind for joint in blueprint.joints)
    shown = ", ".join(f"{number} {kind.value}" for kind, number in kinds.items())
    counts = [len(build(family, {}, seed=seed).joints) for seed in _SEEDS]
    few, many = min(counts), max(counts)
    return f"Joints: {shown} ({few if few == many else f'{few} to {many}'})."


def _table(parameters: Sequence[Parameter]) -> str:
    rows = [PARAMETER_HEADINGS, ("---",) * len(PARAMETER_HEADINGS), *parameter_rows(parameters)]
    return "\n".join(f"| {' | '.join(cell.replace('|', _BAR) for cell in row)} |" for row in rows)


def pictured() -> dict[str, Family]:
    """The objects with a file of their own; those that are built in steps would be hundreds of pictures more."""
    return {
        name: family
        for name, family in known_families().items()
        if name not in FAMILIES and all(parameter.name != "modeling" for parameter in family.all_parameters)
    }


def main() -> None:
    """Draw the page of all sentences, objects with a file of their own, and families."""
    folder = Path(sys.argv[1])
    described = pictured()
    command = f"python -m tools.draw_gallery {folder.as_posix()}"

    def told(name: str, done: float) -> None:
        sys.stderr.write(f"{done:4.0%} {name}\n")

    sys.stdout.write(f"{write_gallery(folder, FAMILIES, SENTENCES, described, command=command, progress=told)}\n")


if __name__ == "__main__":
    main()
