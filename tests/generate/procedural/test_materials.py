"""Materials: what has a name of its own looks like no other, and a request for it changes the look."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from kinematify.generate.procedural.materials import MATERIALS
from kinematify.generate.reader import read_sentence
from kinematify.generate.registry import build

WOODS = ("oak", "pine", "beech", "birch", "teak", "cherry", "mahogany", "walnut", "ebony")
METALS = ("steel", "iron", "aluminium", "brass", "bronze", "copper", "chrome")


@pytest.mark.parametrize("names", [WOODS, METALS])
def test_woods_and_metals_do_not_look_alike(names):
    for one, other in combinations(names, 2):
        apart = np.linalg.norm(np.subtract(MATERIALS[one].color, MATERIALS[other].color))
        assert apart > 0.07, f"{one} looks like {other}"


@pytest.mark.parametrize(
    ("text", "material", "color"),
    [
        ("a grandfather clock, mahogany", "mahogany", None),
        ("a pepper mill in dark wood", "walnut", None),
        ("a bronze bell", "bronze", None),
        ("an aluminum step ladder", "aluminium", None),
        ("a cherry red bicycle", None, "dark red"),
    ],
)
def test_a_named_material_is_read(text, material, color):
    parameters = read_sentence(text).request.parameters
    assert (parameters.get("material"), parameters.get("color")) == (material, color)


@pytest.mark.parametrize("name", [*WOODS, "bronze"])
def test_a_request_for_a_material_changes_the_look(name):
    mill = build("pepper_mill", {"material": name}).parts[0]
    assert mill.color == MATERIALS[name].color
    assert mill.density == MATERIALS[name].density
    assert mill.color != build("pepper_mill", {"material": "wood"}).parts[0].color
