"""The base link of skeletons of boxes: arms, legs, hands, wheels, furniture."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.assembly.part import Part
from kinematify.geometry.part_stats import part_stats
from kinematify.paper.trees import base_by_degree
from kinematify.topology.base_link import base_probabilities
from tests.topology.topology_objects import Machine, X, Y, Z, box, graph_of


def arm(machine: Machine, start: int, foot: np.ndarray, side: np.ndarray, length: int = 5) -> int:
    """A chain of links that rises, then reaches to one side; returns the last link."""
    last, place = start, foot
    for k in range(length):
        step = Z if k < 2 else side
        size = 0.08 + 0.22 * np.abs(step) - 0.01 * k
        machine.add(place + 0.15 * step, size, last)
        last, place = len(machine.parts) - 1, place + 0.3 * step
    return last


def fingers(machine: Machine, palm: int, tip: np.ndarray) -> None:
    for sign in (-1, 1):
        machine.add(tip + sign * 0.03 * Y, (0.05, 0.01, 0.02), palm)


def serial_arm() -> Machine:
    machine = Machine()
    machine.add((0, 0, 0.1), (0.25, 0.25, 0.2))
    fingers(machine, arm(machine, 0, 0.2 * Z, X), np.array([0.95, 0, 0.8]))
    return machine


def legs(machine: Machine, trunk: int, corners: list[tuple[float, float]], top: float) -> None:
    for x, y in corners:
        hip = machine.add((x, y, top), (0.1, 0.08, 0.1), trunk)
        thigh = machine.add((x, y, 0.75 * top), (0.08, 0.06, 0.45 * top), hip)
        machine.add((x, y, 0.27 * top), (0.05, 0.05, 0.52 * top), thigh)


def quadruped(with_arm: bool = False) -> Machine:
    machine = Machine()
    machine.add((0, 0, 0.4), (0.6, 0.25, 0.15))
    legs(machine, 0, [(x, y) for x in (-0.25, 0.25) for y in (-0.2, 0.2)], 0.4)
    if with_arm:
        arm(machine, 0, np.array([0.2, 0, 0.48]), X)
    return machine


def hand() -> Machine:
    """Four fingers of three links on a palm, fingers up."""
    machine = Machine()
    machine.add((0, 0, 0.05), (0.03, 0.09, 0.1))
    for y in (-0.04, 0.0, 0.04):
        last = 0
        for k in range(3):
            last = machine.add((0, y, 0.115 + 0.035 * k), (0.018, 0.02, 0.034 - 0.002 * k), last)
    last = 0
    for k in range(3):
        last = machine.add((0, 0.06 + 0.035 * k, 0.03), (0.02, 0.034, 0.022 - 0.001 * k), last)
    return machine


def cabinet() -> Machine:
    """Doors with handles, a drawer, a knob."""
    machine = Machine()
    machine.add((0, 0, 0.5), (0.5, 0.8, 1.0))
    for sign in (-1, 1):
        door = machine.add((0.26, 0.2 * sign, 0.3), (0.02, 0.38, 0.58), 0)
        machine.add((0.28, 0.05 * sign, 0.3), (0.02, 0.02, 0.1), door)
    machine.add((0.05, 0, 0.8), (0.45, 0.7, 0.25), 0)
    return machine


MACHINES = {
    build.__name__: build
    for build in (
        serial_arm, quadruped, hand, cabinet,
    )
}  # fmt: skip
MACHINES["quadruped_with_arm"] = lambda: quadruped(with_arm=True)


@pytest.mark.parametrize("name", MACHINES)
def test_base_of_a_machine(name: str) -> None:
    machine = MACHINES[name]()
    likely = base_probabilities(machine.edges, machine.stats, machine.kind)
    assert likely.argmax() == 0, likely
    assert likely.shape == (len(machine.parts),)
    assert likely.sum() == pytest.approx(1.0)


def test_what_alone_stands_on_the_ground_is_the_base_however_small_it_is() -> None:
    """A globe: a small foot, and on it a ball that is twenty times as large."""
    machine = Machine()
    machine.add((0, 0, 0.02), (0.2, 0.2, 0.04))
    machine.add((0, 0, 0.4), (0.5, 0.5, 0.5), 0)
    assert base_probabilities(machine.edges, machine.stats, machine.kind).argmax() == 0


def test_degree_rule_takes_the_lowest_index_on_a_tie() -> None:
    graph = graph_of(4, {(0, 1): 0.1, (1, 2): 0.1, (2, 3): 0.1})
    assert base_by_degree(graph) == 1


def pitched(blade: Part) -> Part:
    """A box turned by 17 deg about x through its middle."""
    c, s = np.cos(0.3), np.sin(0.3)
    middle = blade.vertices.mean(axis=0)
    vertices = (blade.vertices - middle) @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]]) + middle
    return Part(name=blade.name, vertices=vertices, faces=blade.faces)


def ceiling_fan(*, pillar: bool = False) -> Machine:
    """A motor on a rod under the ceiling and wide, pitched blades below it; on request a pillar under them."""
    machine = Machine()
    machine.add((0, 0, 2.3), (0.2, 0.2, 0.4))
    machine.add((0, 0, 2.05), (1.2, 0.15, 0.01), 0)
    machine.parts[1] = pitched(machine.parts[1])
    if pillar:
        machine.add((0, 0, 1.0), (0.3, 0.3, 2.0), 1)
    return machine


@pytest.mark.parametrize(("pillar", "base"), [(False, 0), (True, 2)])
def test_what_hangs_has_its_base_at_the_ceiling_unless_something_stands(pillar: bool, base: int) -> None:
    machine = ceiling_fan(pillar=pillar)
    assert base_probabilities(machine.edges, machine.stats, machine.kind).argmax() == base


def test_blades_above_a_small_cap_are_no_foot() -> None:
    """The hull of a rotor is nearly level below, but only its cap touches the floor; a flat blade does lie on it."""
    cap, flat = box("cap", (0, 0, 0.0), (0.04, 0.04, 0.03)), box("blade", (0, 0, 0.015), (1.2, 0.15, 0.05))
    shares = []
    for blade in (flat, pitched(box("blade", (0, 0, 0.025), (1.2, 0.15, 0.01)))):
        rotor = Part(
            name="rotor",
            vertices=np.concatenate([blade.vertices, cap.vertices]),
            faces=np.concatenate([blade.faces, cap.faces + len(blade.vertices)]),
        )
        shares.append(part_stats(rotor).flat_bottom)
    assert shares[0] > 0.5
    assert shares[1] == 0.0
