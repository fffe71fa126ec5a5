"""Looking at a model never writes it: only "Keep this" and "Undo" do, whatever else is clicked or set."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

import pytest

from kinematify.pipeline.record import write_inference
from kinematify.refinement.hints import parse_hints, with_hints
from kinematify.robot.read import read_robot
from tests.inferred import inferred
from tests.view.pages import limited, served

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


def hashes(folder: Path) -> dict[Path, str]:
    return {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.rglob("*") if path.is_file()}


def other_values(widget: Any) -> Iterator[Any]:
    """Values that a program can set on a widget."""
    if hasattr(widget, "options"):
        yield from widget.options
    elif hasattr(widget, "min"):
        ends = widget.min, widget.max
        yield from [ends] if isinstance(widget.value, tuple) else ends
    elif isinstance(widget.value, bool):
        yield not widget.value
    elif isinstance(widget.value, str):
        yield "another"


@pytest.mark.parametrize(("number", "name"), [(0, "toilet"), (1, "nested_drawer"), (2, "universal_joint")])
def test_clicks_and_widgets_that_the_program_sets_change_no_byte(number: int, name: str, tmp_path: Path) -> None:
    folder = tmp_path / "model"
    found = inferred(name)
    names, tree = found.assembly.names, found.trees[0]
    leaf = next(child for _, child in reversed(list(tree.edges())))
    other = next(part for part in names if part not in (names[leaf], names[tree.parents[leaf]]))
    corrected = with_hints(found, parse_hints([f"{names[leaf]}:parent={other}"], names))
    write_inference(corrected, folder, preview=False)
    before = hashes(folder)
    with served(folder, 18200 + number) as window:
        viewer = window.viewer
        for part in [*reversed(viewer.parts), *viewer.parts]:
            viewer.click(part)
            assert hashes(folder) == before, part
            for widget in list(window.server.gui._gui_input_handle_from_uuid.values()):
                for value in () if "Button" in type(widget).__name__ else other_values(widget):
                    widget.value = value
        assert viewer.keep() is None, "nothing waits that no person chose"
        moving = list(viewer.values)[-1]
        joint = read_robot(folder / "model.urdf").joint_by_name[moving]
        viewer.click(joint.child)
        for look in (
            *(lambda part=part: viewer.state("parent", part) for part in names),
            lambda: viewer.try_candidate(moving, 1),
            viewer.set_by_hand,
            lambda: limited(viewer, (-5.0, 20.0)),
            viewer.show_as_in_file,
        ):
            look()
            assert hashes(folder) == before
        assert viewer.keep() is None
    assert hashes(folder) == before
