"""`kinematify fix`: other people's models, whose collision geometry jams their joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import pytest
from lxml import etree

from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.errors import OutputError
from kinematify.formats.fix import fix_urdf
from kinematify.generate.request import from_category
from kinematify.model.urdf import write_urdf
from kinematify.pipeline.generate import true_model

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.formats.fix import Fix


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cabinet whose collision geometry is its visual meshes, with a comment and a joint that has friction."""
    folder = tmp_path_factory.mktemp("given")
    path = write_urdf(true_model(from_category("cabinet", {}).build(seed=1), load_config()), folder)
    text = path.read_text("utf-8").replace("<robot ", "<!-- made by hand -->\n<robot ", 1)
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def fixed(given: Path, tmp_path_factory: pytest.TempPathFactory) -> Fix:
    return fix_urdf(given, tmp_path_factory.mktemp("other") / "fixed.urdf", load_config(), load_settings())


def overlaps(urdf: Path) -> int:
    model = mujoco.MjModel.from_xml_path(str(urdf))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return int((data.contact.dist[: data.ncon] < -1e-3).sum())


def test_what_overlapped_as_loaded_does_not_any_more(given: Path, fixed: Fix) -> None:
    assert overlaps(given) > 0
    assert overlaps(fixed.path) == 0


def test_nothing_else_changes(given: Path, fixed: Fix) -> None:
    def rest(path: Path) -> list[str]:
        root = etree.parse(str(path)).getroot()
        for tag in ("collision", "dynamics"):
            for element in list(root.iter(tag)):
                element.getparent().remove(element)
        for mesh in root.iter("mesh"):
            mesh.set("filename", str((path.parent / mesh.get("filename")).resolve()))
        return [etree.tostring(element).decode().strip() for element in root.iter("joint", "inertial", "visual")]

    def squeezed(texts: list[str]) -> list[str]:
        return ["".join(text.split()) for text in texts]

    assert squeezed(rest(fixed.path)) == squeezed(rest(given))
    assert "<!-- made by hand -->" in fixed.path.read_text("utf-8")


def test_it_says_what_it_changed(fixed: Fix) -> None:
    assert any("collision pieces instead of 1 shapes" in sentence for sentence in fixed.changes)
    assert any("friction" in sentence for sentence in fixed.changes)


def test_the_given_file_is_never_replaced(given: Path) -> None:
    with pytest.raises(OutputError, match="the model itself"):
        fix_urdf(given, given, load_config(), load_settings())
