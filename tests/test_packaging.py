"""Wheel, sdist and editable install all bring the packages behind the symlinks and their data files."""

from __future__ import annotations

import ast
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

import kinematify
from kinematify.cli.doctor import MODULES
from tests.places import ROOT

SOURCES = (
    "pyproject.toml",
    "README.md",
    "LICENSE",
    "benchmarks",
    "kinematify",
    "validation",
    "envs",
    "configs",
    "skills",
)
INSTALLED = """
from importlib import resources, util
for name in ("", ".validation", ".envs", ".configs", ".assembly", ".model"):
    print(util.find_spec("kinematify" + name).name)  # found, not imported: envs registers itself with gymnasium
data = resources.files("kinematify.configs")
print(*sorted(entry.name for entry in data.iterdir() if entry.name.endswith(".yaml")))
print(resources.files("kinematify").joinpath("py.typed").is_file())
print(resources.files("kinematify").joinpath("skills", "kinematify", "SKILL.md").is_file())
print(resources.files("kinematify.validation.formats").joinpath("assets", "viewer.js").is_file())
"""


def call(*words: str | Path, cwd: Path, path: str | None = None) -> str:
    """Run a command in `cwd`; its stdout. `path` becomes PYTHONPATH."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    if path is not None:
        environment["PYTHONPATH"] = path
    done = subprocess.run([*map(str, words)], cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of what is packaged, so that no build folder appears in the repository."""
    target = tmp_path_factory.mktemp("tree")
    for name in SOURCES:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, target / name, symlinks=True, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, target / name)
    return target


def empty_environment(folder: Path) -> Path:
    """Make an environment without any package, not even pip; its interpreter."""
    call(sys.executable, "-m", "venv", "--without-pip", folder, cwd=folder.parent)
    return folder / "bin" / "python"


def assert_complete(python: Path, cwd: Path) -> None:
    """All packages and data files are importable from a folder that is not the repository."""
    lines = call(python, "-c", INSTALLED, cwd=cwd).splitlines()
    names = ["kinematify" + name for name in ("", ".validation", ".envs", ".configs", ".assembly", ".model")]
    shipped = sorted(path.name for path in (ROOT / "configs").glob("*.yaml"))
    assert lines == [*names, " ".join(shipped), "True", "True", "True"]


def assert_bench_explains(python: Path, cwd: Path) -> None:
    """No wheel brings `benchmarks/`: whatever needs it ends with 2 and one message, and measures nothing."""
    environment = {**os.environ, "PYTHONPATH": sysconfig.get_path("purelib")}
    for line in ("bench --list", "bench detection", "bench . --degrade all"):
        done = subprocess.run(
            [python, "-m", "kinematify", *line.split()], cwd=cwd, env=environment, capture_output=True, text=True,
            check=False,
        )  # fmt: skip
        assert (done.returncode, done.stdout) == (2, "")
        assert "needs the folder benchmarks/" in done.stderr
        assert done.stderr.count("Error") == 1


def test_wheel_is_complete(tree: Path, tmp_path: Path) -> None:
    """Through the sdist; `.ci/smoke` installs one that is built from the tree."""
    call(sys.executable, "-m", "build", "--no-isolation", "--outdir", tmp_path, tree, cwd=tmp_path)
    (wheel,) = tmp_path.glob("*.whl")
    assert len(list(tmp_path.glob("*.tar.gz"))) == 1
    python = empty_environment(tmp_path / "env")
    call(sys.executable, "-m", "pip", "--python", python, "install", "-q", "--no-deps", wheel, cwd=tmp_path)
    assert_complete(python, tmp_path)
    assert (tmp_path / "env" / "bin" / "kinematify").is_file()
    assert_bench_explains(python, tmp_path)


def requirement_name(line: str) -> str:
    """Distribution name of a requirement."""
    return re.split(r"[\[<>=!~ ]", line, maxsplit=1)[0]


def normalised(name: str) -> str:
    """Spelling of a distribution name under which it can be compared."""
    return name.lower().replace("_", "-")


def declared(extra: str | None = None) -> set[str]:
    """Names of the distributions that pyproject.toml asks for."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    lines = project["optional-dependencies"][extra] if extra else project["dependencies"]
    return {requirement_name(line) for line in lines}


def test_the_doctor_knows_every_declared_package() -> None:
    extras = ("bench", "cad", "cloud", "formats", "mcp", "paper", "pinocchio", "ray", "usd")
    assert set(MODULES) == declared().union(*map(declared, extras))


def test_every_import_of_the_package_is_declared() -> None:
    providers = {module: {normalised(name) for name in names} for module, names in packages_distributions().items()}
    providers |= {"pinocchio": {"pin"}, "coal": {"coal"}}  # they live behind a .pth file, which the metadata ignores
    providers |= {"manifold3d": {"manifold3d"}}  # a bare extension module, which the metadata does not list
    extras = (None, "bench", "fit", "formats", "mcp", "paper", "pinocchio", "ray", "rl", "usd")
    allowed = {normalised(name) for extra in extras for name in declared(extra)}
    missing = set()
    for folder, _, files in os.walk(ROOT / "kinematify", followlinks=True):
        for path in (Path(folder, file) for file in files if file.endswith(".py")):
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
                names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
                for top in {name.partition(".")[0] for name in names} - sys.stdlib_module_names - {"kinematify"}:
                    if not providers.get(top, {normalised(top)}) & allowed:  # an extra that is absent: by its name
                        missing.add(f"{path.relative_to(ROOT)}: {top}")
    assert missing == set()


def test_version_and_changelog_agree() -> None:
    versions = re.findall(r"^## \[(.+?)\]", (ROOT / "CHANGELOG.md").read_text("utf-8"), flags=re.MULTILINE)
    assert versions[0] == kinematify.__version__
    assert versions == sorted(versions, key=lambda text: [int(n) for n in text.split(".")], reverse=True)
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    assert re.search(rf"^version: {re.escape(kinematify.__version__)}$", citation, flags=re.MULTILINE)
