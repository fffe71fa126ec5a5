"""Files in MuJoCo, parsed so that worlds can be compiled from them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
from lxml import etree

from kinematify.simulation.configurations import GRAVITY, PIN_SOLIMP, PIN_SOLREF
from kinematify.simulation.engine_file import Unloadable

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from kinematify.robot.mechanism import LeaderMechanism

_RESERVED = "world"
"""MuJoCo's name of the outside; a link of this name is loaded under another one."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ParsedModel:
    """A parsed file, from which variants are compiled."""

    spec: mujoco.MjSpec
    names: tuple[str, ...]
    """Names of the links in the document's order, as MuJoCo knows them."""
    mechanism: LeaderMechanism
    step: float
    """Time step [s]."""


def parse(urdf: Path, mechanism: LeaderMechanism, *, step: float) -> ParsedModel:
    """Parse a file.

    Raises:
        Unloadable: MuJoCo cannot.
    """
    robot = etree.parse(str(urdf)).getroot()
    stand_in = _free_name(mechanism.links)
    for element in robot.iter("link", "parent", "child"):
        key = "name" if element.tag == "link" else "link"
        if element.get(key) == _RESERVED:
            element.set(key, stand_in)
    try:
        spec = mujoco.MjSpec.from_string(etree.tostring(robot, encoding="unicode", pretty_print=True))
    except ValueError as error:
        raise Unloadable(_sentence(error)) from error
    spec.modelfiledir = str(urdf.parent)
    spec.compiler.fusestatic = False
    set_options(spec, step)
    # Contacts between a body and its parent count; what is there from the start is allowed pair by pair.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_FILTERPARENT.value
    for number, geom in enumerate(spec.geoms):
        geom.name = f"kinematify geom {number}"
    names = tuple(stand_in if name == _RESERVED else name for name in mechanism.links)
    _close_loops(spec, names, mechanism)
    return ParsedModel(spec=spec, names=names, mechanism=mechanism, step=step)


def _close_loops(spec: mujoco.MjSpec, names: tuple[str, ...], mechanism: LeaderMechanism) -> None:
    """Hold both ends of every loop together, which MuJoCo does not read in a URDF."""
    for loop in mechanism.robot.loops:
        first, second = (names[mechanism.links.index(link)] for link in loop.links)
        pin = spec.add_equality(
            name=loop.name, type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_BODY, name1=first, name2=second
        )
        pin.data[:3] = loop.points[0]
        pin.solref[:2], pin.solimp[:3] = PIN_SOLREF, PIN_SOLIMP


def set_options(spec: mujoco.MjSpec, step: float) -> None:
    """Set a time step [s], and the options that everything shares."""
    spec.option.timestep = step
    spec.option.gravity = [0.0, 0.0, -GRAVITY]
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # MuJoCo 4.0.0 factorises sparse systems wrongly in rare cases; 4.0.1 does not.
    spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE


def _free_name(names: Iterable[str]) -> str:
    name = f"{_RESERVED} link"
    while name in names:
        name += "_"
    return name


def _sentence(error: Exception) -> str:
    return " ".join(str(error).split())
