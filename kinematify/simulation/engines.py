"""The engines that Kinematify knows, by the names that users write."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from kinematify.errors import EnvironmentFault
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.config.validation import EngineSettings
    from kinematify.simulation.engine import Engine, WorldEngine
    from kinematify.simulation.raw_model import RawEngineModel
    from kinematify.simulation.world import EngineWorld, WorldSpec


@dataclass(frozen=True, kw_only=True)
class EngineEntry:
    """What is known of an engine without loading it."""

    name: str
    """As users write it; ``kinematify.simulation.NAME_engine`` holds the class ``NameEngine``, an `Engine`."""
    title: str
    """As it is written in messages."""
    package: str
    """Distribution that brings it."""
    extra: str | None = None
    """Extra of Kinematify that installs it; None: every installation has it."""
    family: str
    """First characters of the ids of its checks of the prepared model."""
    runs: bool = True
    """False: it only computes; it sees no contacts and never runs."""
    prepared: bool = True
    """False: it loads raw files only, and has no checks but KV8xx."""
    most_joints: int | None = None
    """Larger models are not given to it."""
    inflation: float = 0.0
    """By which it makes meshes thicker [m]."""
    keeps_energy: bool = True
    """False: its integrator gains energy with its usual step, so energy is looked at with smaller ones."""
    stops_late: bool = False
    """True: a joint is stopped one step after it has passed its limit, and left where it is then."""
    contact_flag: str | None = None
    """Of its loader: without it links of one file pass through each other; None: they collide by default."""
    holds: tuple[str, ...] = ()
    """What may connect a hand with a part (values of `kinematify.manipulation.plan_request.Hold`) where plans are
    executed and environments run in it: its class is a `WorldEngine`."""
    prints_when_loaded: bool = False
    """True: it may be loaded only where what is printed goes to a file."""

    @property
    def module(self) -> str:
        """Name of its module."""
        return f"kinematify.simulation.{self.name}_engine"


_ENTRIES = (
    EngineEntry(name="mujoco", title="MuJoCo", package="mujoco", family="KV4", holds=("weld", "contact")),
    EngineEntry(
        name="pybullet",
        title="PyBullet",
        package="pybullet",
        family="KV5",
        most_joints=120,  # its tables end at 128 degrees of freedom per body; larger models overwrite its memory
        inflation=1e-3,
        keeps_energy=False,
        stops_late=True,
        contact_flag="URDF_USE_SELF_COLLISION",
        holds=("weld",),  # its hulls slip out of fingers that hold by friction
        prints_when_loaded=True,
    ),
    EngineEntry(name="drake", title="Drake", package="drake", extra="drake", family="KV9"),
    EngineEntry(name="pinocchio", title="Pinocchio", package="pin", family="KV6", runs=False),
    EngineEntry(name="newton", title="Newton", package="newton", extra="newton", family="", prepared=False),
)
ENGINES = {entry.name: entry for entry in _ENTRIES}
"""Keyed by name."""
DEFAULT_ENGINES = tuple(name for name, engine in ENGINES.items() if engine.extra is None)
"""Engines that every installation has; FCL and the exact geometry are always there."""


def engines_that_hold(hold: str) -> tuple[str, ...]:
    """Names of the engines that execute plans with a hand that holds so (`EngineEntry.holds`)."""
    return tuple(name for name, engine in ENGINES.items() if hold in engine.holds)


def require_engine(name: str) -> None:
    """Ask for an engine before any work is done.

    Raises:
        EnvironmentFault: It is not installed.
    """
    engine = ENGINES[name]
    if package_versions((engine.package,))[engine.package] == "missing":
        raise EnvironmentFault(_missing(engine, f"the package {engine.package} is not installed"))


def _missing(engine: EngineEntry, why: str) -> str:
    install = f'pip install "kinematify[{engine.extra}]"' if engine.extra else "pip install kinematify"
    return f"{engine.title} was asked for and cannot be loaded: {why}. Install it: {install}"


def open_engine(name: str, settings: EngineSettings, log: Path) -> Engine:
    """Load an engine's library.

    Args:
        name: Of `ENGINES`.
        settings: Time step, servos and how long it runs.
        log: File that this process prints into, where an engine speaks by printing.

    Raises:
        EnvironmentFault: It is not installed.
    """
    return _class_of(name)(settings, log)


def open_world(name: str, spec: WorldSpec) -> EngineWorld:
    """Build a world that runs.

    Args:
        name: Of an engine with `EngineEntry.holds`.
        spec: What is in it.

    Raises:
        EnvironmentFault: The engine is not installed.
        Refused: It cannot load a model.
    """
    return cast("type[WorldEngine]", _class_of(name)).open_world(spec)


def load_file(name: str, urdf: Path, root: str, package_dirs: Sequence[Path] = ()) -> RawEngineModel:
    """Load a file into an engine as users do, with the engine's own defaults.

    Args:
        name: Of `ENGINES`; what runs gives a `RunningFile`.
        urdf: The file.
        root: Name of its first link.
        package_dirs: Where packages lie, for engines that look for them.

    Raises:
        EnvironmentFault: The engine is not installed.
        Unloadable: The engine does not open the file.
    """
    return _class_of(name).load_raw(urdf, root, package_dirs)


def _class_of(name: str) -> type[Engine]:
    """The class of an engine; its library is imported here, one in a process."""
    try:
        module = importlib.import_module(ENGINES[name].module)
    except ImportError as error:
        raise EnvironmentFault(_missing(ENGINES[name], str(error))) from error
    return cast("type[Engine]", getattr(module, f"{name.capitalize()}Engine"))
