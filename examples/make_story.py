"""Write the second picture of the README: the bundled cabinet, inferred.

.venv/bin/python examples/make_story.py [FILE]
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from kinematify import infer, load_assembly, load_config
from kinematify.render.model_picture import PreviewPanel, rest_and_moved, write_sheet
from kinematify.render.picture import PictureScene, PosedMesh

if TYPE_CHECKING:
    from kinematify.config import PreviewConfig
    from kinematify.model.kinematic_model import KinematicModel

HERE = Path(__file__).resolve().parent
_EXPLODED = 0.55  # of their distance from the centre parts move away: apart and still recognised as one object
WIDTH = 1600  # twice what the README shows [pixels]


UNSEGMENTED = np.array([0.74, 0.75, 0.77])  # anonymous parts are all the same grey


def render_story(model: KinematicModel, path: Path, config: PreviewConfig) -> None:
    """Write a PNG with three panels: the anonymous parts taken apart, the joints found, the mechanism moved.

    Args:
        model: What to show.
        path: PNG file to write.
        config: Size and quality.

    Raises:
        OSError: The file cannot be written.
    """
    rest, moved = rest_and_moved(model, config, ("the joints that were found", "the mechanism, moved"))
    loose = PreviewPanel("parts in, without names", _exploded(rest.scene))
    write_sheet(model, (loose, rest, moved), config, path)


def _exploded(scene: PictureScene) -> PictureScene:
    """Grey copies moved away from the middle of all, the farther off the more."""
    middles = np.array([mesh.vertices[mesh.faces.reshape(-1)].mean(axis=0) for mesh in scene.meshes])
    offsets = _EXPLODED * (middles - middles.mean(axis=0))
    return PictureScene(
        meshes=tuple(
            PosedMesh(vertices=mesh.vertices + offset, faces=mesh.faces, color=UNSEGMENTED)
            for mesh, offset in zip(scene.meshes, offsets, strict=True)
        )
    )


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
