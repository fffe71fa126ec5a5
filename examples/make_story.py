"""Write the second picture of the README: the bundled cabinet, inferred.

.venv/bin/python examples/make_story.py [FILE]
"""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image

from kinematify import infer, load_assembly, load_config
from kinematify.model.preview import render_story

HERE = Path(__file__).resolve().parent
WIDTH = 1600  # twice what the README shows [pixels]


def write_story(path: Path) -> None:
    """Infer the cabinet and draw its parts, the joints that were found, and the mechanism moved."""
    config = load_config()
    assembly = load_assembly(HERE / "cabinet", config=config.assembly)
    render_story(infer(assembly, config=config).model, path, config.preview)
    picture = Image.open(path).convert("RGB")
    picture.resize((WIDTH, round(WIDTH * picture.height / picture.width)), Image.Resampling.LANCZOS).save(
        path, optimize=True
    )


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE.parent / "docs" / "story.png"
    write_story(target)
    print(f"Wrote {target}.")
