"""Which packages are installed, and the command that installs what is missing."""

from __future__ import annotations

import importlib.util
import re
import shlex
import sys
from importlib.metadata import PackageNotFoundError, requires, version
from typing import TYPE_CHECKING

from kinematify.errors import EnvironmentFault

if TYPE_CHECKING:
    from collections.abc import Iterable

_MODULES = {"pin": "pinocchio", "usd-core": "pxr"}
"""Modules of distributions that have another name."""
NO_WHEELS = "PyBullet has no wheels for Python 3.12 and later: pip builds it, with a C++ compiler and in many minutes."
_REQUIREMENT = re.compile(r"([\w.-]+)(?:\[.*?\])?([^;]*)")


def package_versions(packages: Iterable[str]) -> dict[str, str]:
    """Return the installed version of each package, ``missing`` where it is not installed."""
    found = {}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "missing"
    return found


def is_installed(package: str) -> bool:
    """Return True if the module of a distribution can be found; it is not loaded."""
    return importlib.util.find_spec(_MODULES.get(package, package.replace("-", "_"))) is not None


def require(purpose: str, *packages: str) -> None:
    """Ask for packages that not every installation has, before any work is done.

    Args:
        purpose: What needs them, the subject of the message.
        packages: Names of distributions.

    Raises:
        EnvironmentFault: One is not installed; the message holds the command that installs it.
    """
    missing = [package for package in packages if not is_installed(package)]
    if missing:
        raise EnvironmentFault(not_installed(purpose, *missing))


def not_installed(purpose: str, *packages: str) -> str:
    """Return the message that something needs packages that are not installed, with the command that installs them."""
    note = f" {NO_WHEELS}" if "pybullet" in packages and sys.version_info >= (3, 12) else ""
    return f"{purpose} needs {' and '.join(packages)}, not installed here.{note} Run: {install_command(*packages)}"


def install_command(*packages: str, options: Iterable[str] = ()) -> str:
    """Return the command that installs packages for this Python, ready to be pasted into a shell.

    It names the packages and not an extra of Kinematify, so that it works with any index and after any installation.

    Args:
        packages: Names of distributions; the range that Kinematify declares is added.
        options: Of pip.
    """
    try:
        lines = requires("kinematify") or []
    except PackageNotFoundError:  # the sources alone are on the path
        lines = []
    ranges = {found[1]: found[2].strip() for found in map(_REQUIREMENT.match, reversed(lines)) if found}
    tool = [sys.executable, "-m", "pip"]
    if importlib.util.find_spec("pip") is None:  # uv makes environments without pip
        tool = ["uv", "pip"]
        options = ["--python", sys.executable, *options]
    return shlex.join([*tool, "install", *options, *(package + ranges.get(package, "") for package in packages)])
