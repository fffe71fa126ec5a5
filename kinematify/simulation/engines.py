"""The engines that Kinematify knows, by the names that users write."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import EnvironmentFault
from kinematify.versions import is_installed, not_installed, require

if TYPE_CHECKING:
    from types import ModuleType

    from kinematify.simulation.engine import Engine
    from kinematify.simulation.world import OpenedFile, WorldSpec


@dataclass(frozen=True, kw_only=True)
class EngineEntry:
    """Entry of an engine, known without loading it."""

    name: str
    """As users write it."""
    title: str
    """As it is written in messages."""
    packages: tuple[str, ...]
    """Distributions that bring what its module imports; not every installation has them."""
    runs: bool = True
    """False: it only computes; it sees no contacts and never runs."""
    contact_flag: str | None = None
    """Of its loader: without it links of one file pass through each other; None: they collide by default."""
    holds: tuple[str, ...] = ()
    """What may connect a hand with a part (values of `kinematify.manipulation.plan_request.Hold`) where plans are
    executed and environments run in it."""
    floor: bool = False
    """It sets a file on a floor (`OpenedFile.on_floor`)."""
    prints_when_loaded: bool = False
    """True: it may be loaded only where what is printed goes to a file."""

    in_module: str | None = None
    """Has its class as `ENGINE`; None: ``kinematify.simulation.NAME_engine``."""

    @property
    def module(self) -> str:
        """Name of its module."""
        return self.in_module or f"kinematify.simulation.{self.name}_engine"


_ENTRIES = (
    EngineEntry(name="mujoco", title="MuJoCo", packages=("mujoco",), holds=("weld", "contact"), floor=True),
    EngineEntry(
        name="pybullet",
        title="PyBullet",
        packages=("pybullet",),
        contact_flag="URDF_USE_SELF_COLLISION",
        holds=("weld",),  # its hulls slip out of fingers that hold by friction
        prints_when_loaded=True,
    ),
    EngineEntry(name="pinocchio", title="Pinocchio", packages=("pin", "coal"), runs=False),
)
ENGINES = {entry.name: entry for entry in _ENTRIES}
"""Keyed by name."""
DEFAULT_ENGINES = tuple(name for name, engine in ENGINES.items() if all(map(is_installed, engine.packages)))
"""Engines that run unless others are asked for: those that are installed."""


def engines_that_hold(hold: str) -> tuple[str, ...]:
    """Names of the engines that execute plans with a hand that holds so (`EngineEntry.holds`)."""
    return tuple(name for name, engine in ENGINES.items() if hold in engine.holds)


def require_engine(name: str) -> None:
    """Ask for an engine before any work is done.

    Raises:
        EnvironmentFault: It is not installed.
    """
    require(ENGINES[name].title, *ENGINES[name].packages)


def why_not_run(name: str) -> str:
    """Return the reason why an engine that was not among the chosen ones has no results."""
    if name in DEFAULT_ENGINES:
        return "the engine was not asked for"
    return not_installed(f"{ENGINES[name].title} did not run: it", *ENGINES[name].packages)


def open_engine(name: str, content: OpenedFile | WorldSpec) -> Engine:
    """Open a file or a world in an engine.

    Args:
        name: Of `ENGINES`; of a world one with `EngineEntry.holds`, of a file on a floor one with `EngineEntry.floor`.
        content: What is in it.

    Raises:
        EnvironmentFault: The engine is not installed.
        Unloadable: The engine does not open the file, or cannot load a model.
    """
    opened: Engine = _module_of(name).ENGINE(content)
    return opened


def _module_of(name: str) -> ModuleType:
    """The module of an engine; its library is imported here, one in a process."""
    try:
        return importlib.import_module(ENGINES[name].module)
    except ImportError as error:
        engine = ENGINES[name]
        raise EnvironmentFault(f"{not_installed(engine.title, *engine.packages)} ({error})") from error
