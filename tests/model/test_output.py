"""A model folder is there whole or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from kinematify.errors import OutputError
from kinematify.model.output import write_model_folder


def fill(folder: Path, text: str = "new") -> None:
    (folder / "meshes").mkdir()
    (folder / "meshes" / "a.obj").write_text(text)
    (folder / "model.urdf").write_text(text)
    (folder / "inference.json").write_text("{}")


def files(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


WHOLE = ["inference.json", "meshes", "meshes/a.obj", "model.urdf"]


def test_nothing_is_seen_before_the_end(tmp_path):
    def look(folder: Path) -> None:
        assert not (tmp_path / "out").exists()
        assert folder.name.startswith(".")
        fill(folder)

    write_model_folder(tmp_path / "out", look, overwrite=False)
    assert files(tmp_path / "out") == WHOLE


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError("broken"), SystemExit(3)])
def test_failure_leaves_nothing(tmp_path, error):
    def fail(folder: Path) -> None:
        fill(folder)
        raise error

    with pytest.raises(type(error) if isinstance(error, BaseException) else error):
        write_model_folder(tmp_path / "new" / "out", fail, overwrite=False)
    assert files(tmp_path) == []


def test_failure_keeps_the_old_model(tmp_path):
    out = tmp_path / "out"
    write_model_folder(out, lambda folder: fill(folder, "old"), overwrite=False)

    def fail(folder: Path) -> None:
        fill(folder)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_model_folder(out, fail, overwrite=True)
    assert (out / "model.urdf").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_full_disk_is_an_output_error(tmp_path):
    def fail(folder: Path) -> None:
        raise OSError(28, "No space left on device")

    with pytest.raises(OutputError, match="No space left on device"):
        write_model_folder(tmp_path / "out", fail, overwrite=False)
    assert files(tmp_path) == []


def test_existing_folder_needs_force(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    with pytest.raises(OutputError, match="--force"):
        write_model_folder(out, fill, overwrite=False)
    write_model_folder(out, fill, overwrite=True)
    write_model_folder(out, lambda folder: fill(folder, "newer"), overwrite=True)
    assert (out / "model.urdf").read_text() == "newer"
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_force_spares_what_is_not_ours(tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "model.urdf").write_text("mine")
    with pytest.raises(OutputError, match="not a model folder"):
        write_model_folder(tmp_path / "thesis", fill, overwrite=True)
    (tmp_path / "file").write_text("mine")
    with pytest.raises(OutputError, match="not a folder"):
        write_model_folder(tmp_path / "file", fill, overwrite=True)
    assert files(tmp_path) == ["file", "thesis", "thesis/model.urdf"]


def test_place_that_cannot_be_written():
    # Holds for root, too: the kernel makes no folder there.
    with pytest.raises(OutputError, match="change its permissions"):
        write_model_folder(Path("/proc/kinematify/out"), fill, overwrite=False)
