"""`import kinematify` and `kinematify --help` load nothing heavy; the public names are what is promised."""

from __future__ import annotations

import importlib
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import kinematify
from kinematify.cli.app import COMMANDS
from tests.places import ROOT

HEAVY = {
    "torch", "mujoco", "pybullet", "pinocchio", "coal", "fcl", "igl", "ompl", "trimesh", "scipy", "numpy", "pydantic",
    "networkx", "yourdfpy", "gymnasium", "matplotlib",
}  # fmt: skip


def loaded_after(code: str) -> set[str]:
    """Top-level packages that a fresh process holds after running `code`."""
    report = "import sys; print('\\nLOADED', *{name.partition('.')[0] for name in sys.modules})"
    words = [sys.executable, "-c", f"{code}\n{report}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return set(done.stdout.rsplit("LOADED", 1)[1].split())


def test_importing_the_package_loads_no_engine() -> None:
    loaded = loaded_after("import kinematify")
    assert "kinematify" in loaded
    assert loaded & HEAVY == set()


def test_the_import_check_can_fail() -> None:
    assert "numpy" in loaded_after("import kinematify; kinematify.Part") & HEAVY


def test_help_loads_no_engine() -> None:
    lines = [["--help"], ["--version"], *([command, "--help"] for command in COMMANDS)]
    loaded = loaded_after(
        "import sys; from kinematify.cli.app import run\n"
        f"for words in {lines}: assert run(words) == 0; assert not {HEAVY} & sys.modules.keys(), words"
    )
    assert "click" in loaded


def test_the_list_of_studies_loads_no_engine() -> None:
    loaded = loaded_after("from kinematify.cli.app import run; assert run(['bench', '--list']) == 0")
    assert "pydantic" in loaded
    assert loaded & {"torch", "mujoco", "pybullet", "pinocchio", "trimesh"} == set()


def test_inferring_loads_only_what_runs(tmp_path: Path) -> None:
    for name, z in (("plate", 0.0), ("lid", 1.0)):
        corners = [(x, y, z + h) for x in (0, 1) for y in (0, 1) for h in (0.0, 0.9)]
        faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
        (tmp_path / f"{name}.obj").write_text("".join("v {} {} {}\n".format(*corner) for corner in corners) + faces)
    words = ["infer", str(tmp_path), "-o", str(tmp_path / "out"), "--no-preview", "--no-validation"]
    loaded = loaded_after(f"from kinematify.cli.app import run; assert run({words!r}) == 0")
    assert "igl" in loaded
    assert loaded & {"torch", "mujoco", "pybullet", "pinocchio", "trimesh", "httpx"} == set()


def test_what_drives_a_validation_loads_no_geometry() -> None:
    """The stages do, in their server, which starts at the same time."""
    loaded = loaded_after("import kinematify.validation.run, kinematify.cli.validate")
    assert "numpy" in loaded
    assert loaded & {"scipy", "igl", "fcl", "mujoco", "pybullet", "pinocchio", "trimesh", "PIL"} == set()


def test_public_names_resolve_and_are_all_there_is() -> None:
    resolved = {name for name in kinematify.__all__ if getattr(kinematify, name) is not None}
    assert resolved == set(kinematify.__all__)
    assert set(kinematify._HOMES) | {"__version__"} == set(kinematify.__all__)
    assert set(kinematify.__all__) == set(dir(kinematify))


def test_each_public_name_is_the_object_of_its_home() -> None:
    for name, home in kinematify._HOMES.items():
        value = getattr(kinematify, name)
        if name in kinematify._PACKAGES:
            assert value is sys.modules[f"kinematify.{name}"]
            assert inspect.signature(value) == inspect.signature(getattr(importlib.import_module(home), name))
        else:
            assert value is getattr(sys.modules[home], name)


def test_unknown_names_raise_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'no_such_name'"):
        _ = kinematify.no_such_name  # type: ignore[attr-defined]


def test_every_public_name_is_in_the_reference() -> None:
    import kinematify

    documented = re.findall(r"^::: kinematify\.(\w+)$", (ROOT / "docs" / "api.md").read_text(), flags=re.MULTILINE)
    assert sorted(documented) == sorted(set(kinematify.__all__) - {"__version__"})
