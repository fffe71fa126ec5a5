"""Names of kinds: what is another object than a kind draws is no name of it, and no two kinds have one name."""

from __future__ import annotations

from collections import Counter

import pytest

from kinematify.generate.kind_search import key_of, kind_called
from kinematify.generate.registry import all_kinds

OTHER_THINGS = """
library cart, hotel cart, hospital cart, ice cream cart, luggage cart, airline trolley, milling machine, laser
cutter, dog, stone oven, dining table, conference table, guitar case, picnic basket, hat box, thermostat,
walkie talkie, wastebasket, deck chair, poultry shears, hedge shears, pincers, spider, toothpaste tube, baby
bottle, mop bucket, backhoe, monkey wrench, dinner bell, pottery wheel, trebuchet, hair clip, gateleg table,
fire ladder, potato ricer, lint roller, headset, litter tray, shoe rack, stretcher, saucepan, cookie tin,
mason jar, water dispenser, shock absorber, slow cooker, cake dome, bathroom scale, dropper, massage table,
marionette, camcorder, clavichord, conveyor belt, vespa, transistor radio, microphone, music stand, hanging
chair, webcam, dartboard, swiss army knife, barber chair, gramophone, couch, doctor bag, ski lift, carpet
sweeper, lorry, food truck, monorail, gas grill, watermill, picnic table, power supply, dog house
"""


@pytest.mark.parametrize("name", " ".join(OTHER_THINGS.split()).split(", "))
def test_another_object_has_no_kind(name):
    assert kind_called(key_of(name)) is None


def test_no_two_kinds_have_one_name():
    names = Counter(name for kind in all_kinds().values() for name in {key_of(word) for word in kind.words})
    assert [name for name, count in names.items() if count > 1] == []
