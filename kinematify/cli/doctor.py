"""`kinematify doctor`: what is installed, what is missing, and how to install it."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import click

from kinematify import __version__
from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import examples
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus
from kinematify.versions import NO_WHEELS, install_command

if TYPE_CHECKING:
    from packaging.requirements import Requirement

MODULES = {
    "numpy": ("numpy", "arrays"),
    "scipy": ("scipy", "spatial search, optimisation"),
    "torch": ("torch", "`--config paper`"),
    "networkx": ("networkx", "graphs"),
    "trimesh": ("trimesh", "reading meshes"),
    "libigl": ("igl", "exact distances, winding numbers"),
    "python-fcl": ("fcl", "distances between meshes"),
    "embreex": ("embreex", "ray casting"),
    "fast-simplification": ("fast_simplification", "simplifying large meshes"),
    "manifold3d": ("manifold3d", "solids of the built-in generator"),
    "pydantic": ("pydantic", "configuration"),
    "PyYAML": ("yaml", "configuration"),
    "jinja2": ("jinja2", "pages of reports"),
    "lxml": ("lxml.etree", "URDF"),
    "pycollada": ("collada", "DAE meshes"),
    "pillow": ("PIL.Image", "pictures"),
    "usd-core": ("pxr.Usd", "export to USD"),
    "httpx": ("httpx", "generators behind a web service"),
    "mujoco": ("mujoco", "engine"),
    "pybullet": ("pybullet", "engine"),
    "pin": ("pinocchio", "engine"),
    "coal": ("coal", "engine"),
    "ompl": ("ompl.base", "motion planning"),
    "gymnasium": ("gymnasium", "environments"),
    "click": ("click", "command line"),
    "rich": ("rich", "command line"),
    "packaging": ("packaging", "this command"),
    "lib3mf": ("lib3mf", "3MF files"),
    "xacro": ("xacro", "xacro files"),
    "mcp": ("mcp", "tools for coding agents, kinematify mcp"),
    "DracoPy": ("DracoPy", "glTF files compressed with Draco"),
    "meshopt": ("meshopt", "glTF files compressed with meshoptimizer"),
    "cascadio": ("cascadio", "STEP files"),
    "viser": ("viser", "viewer in the browser"),
    "example-robot-data": ("", "robots for `kinematify bench pip`"),
    "matplotlib": ("matplotlib", "plots of the benchmark"),
    "playwright": ("playwright", "pages measured in a browser"),
    "fsspec": ("fsspec", "paths and URLs of `kinematify batch`"),
    "s3fs": ("s3fs", "`kinematify batch` from and to s3://"),
    "ray": ("ray", "`kinematify batch` on a cluster"),
}
"""Distribution -> module that proves that it works (empty: data only), and what it is for."""

IMPORT_SECONDS = 60.0
"""An engine that takes longer than this to import counts as broken [s]."""


@dataclass(frozen=True, kw_only=True)
class PackageState:
    """State of one package."""

    package: str
    purpose: str
    wanted: str
    """Version range that was tested."""
    installed: str | None
    state: str
    """``ok``, ``missing``, ``version`` (outside the tested range) or ``broken`` (does not import)."""
    optional: bool
    """True if only an extra needs it, or this Python has no wheel of it."""
    problem: str | None = None
    """Last line that the failing import printed, or why the package is not simply installed."""

    @property
    def remedy(self) -> str | None:
        """The command that fixes it, None if nothing is wrong."""
        if self.state == "ok":
            return None
        force = ("--force-reinstall", "--no-deps") if self.state == "broken" else ()
        return install_command(self.package, options=force)


@click.command(
    "doctor",
    epilog=examples("kinematify doctor", "kinematify doctor --json - | python -m json.tool"),
)
@json_option
def command(json_to: str | None) -> int:
    """Check every package that Kinematify needs, by importing each in a process of its own.

    Ends with 0 if all that is required works, else with 3. Packages of extras may be missing.
    """
    findings = examine_packages()
    failed = [finding for finding in findings if finding.state != "ok" and not finding.optional]
    if write_answer(_as_answer(findings), json_to):
        click.echo(_describe(findings))
    return ExitStatus.FAULT if failed else 0


def examine_packages() -> tuple[PackageState, ...]:
    """Compare what is installed with what this version of Kinematify declares, and try every import."""
    from concurrent.futures import ThreadPoolExecutor

    requirements = _declared_requirements()
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        return tuple(pool.map(_examine, requirements))


def _declared_requirements() -> list[Requirement]:
    from importlib.metadata import requires

    from packaging.requirements import Requirement

    declared = {found.name: found for found in map(Requirement, reversed(requires("kinematify") or ()))}
    return [declared[name] for name in MODULES if name in declared]


def _examine(requirement: Requirement) -> PackageState:
    module, purpose = MODULES[requirement.name]
    installed = _installed_version(requirement.name)
    problem = _import_problem(module) if installed and module else None
    state = _judge(requirement, installed, problem)
    optional = requirement.marker is not None and not requirement.marker.evaluate({"extra": ""})
    if requirement.name == "pybullet" and state == "missing" and optional:
        problem = NO_WHEELS
    return PackageState(
        package=requirement.name,
        purpose=purpose,
        wanted=",".join(sorted(map(str, requirement.specifier), reverse=True)),
        installed=installed,
        state=state,
        optional=optional,
        problem=problem,
    )


def _judge(requirement: Requirement, installed: str | None, problem: str | None) -> str:
    if installed is None:
        return "missing"
    if problem is not None:
        return "broken"
    return "ok" if requirement.specifier.contains(installed, prereleases=True) else "version"


def _installed_version(package: str) -> str | None:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _import_problem(module: str) -> str | None:
    """Import in a fresh process: a broken binary may end its process or hang, and engines print as they like."""
    words = [sys.executable, "-c", f"import {module}"]
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=IMPORT_SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return f"importing {module} took more than {IMPORT_SECONDS:.0f} s"
    if done.returncode == 0:
        return None
    lines = done.stderr.strip().splitlines()
    return lines[-1] if lines else f"importing {module} ended with status {done.returncode}"


def _system() -> dict[str, str]:
    return {
        "kinematify": __version__,
        "python": platform.python_version(),
        "executable": sys.executable,
        "platform": platform.platform(),
        "cores": str(os.cpu_count()),
    }


def _as_answer(findings: tuple[PackageState, ...]) -> dict[str, Any]:
    packages = [{**asdict(finding), "remedy": finding.remedy} for finding in findings]
    return {"schema": 1, "system": _system(), "packages": packages}


def _describe(findings: tuple[PackageState, ...]) -> str:
    rows = [
        (finding.package, finding.installed or "-", finding.wanted, _describe_state(finding), finding.purpose)
        for finding in findings
    ]
    system = "\n".join(f"{key:<11} {value}" for key, value in _system().items())
    table = format_table(("package", "installed", "tested range", "state", "what for"), rows)
    return f"{system}\n\n{table}\n\n{_describe_remedies(findings)}"


def _describe_state(finding: PackageState) -> str:
    return "missing (optional)" if finding.optional and finding.state == "missing" else finding.state


def _describe_remedies(findings: tuple[PackageState, ...]) -> str:
    lines = []
    for finding in findings:
        if finding.remedy:
            reason = f": {finding.problem}" if finding.problem else ""
            lines += [f"{finding.package} ({_describe_state(finding)}){reason}", f"    {finding.remedy}"]
    return "\n".join(lines) if lines else "Everything works."
