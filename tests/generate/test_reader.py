"""Sentences fill a request; what is not read is listed, and nothing is invented."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematify.errors import InputError
from kinematify.generate.reader import read_sentence

QUARTER, EIGHTH = math.pi / 2, math.pi / 4


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Make me a cupboard, please", {"kind": "cabinet"}),
        ("a kitchen cabinet with two doors above three drawers, 80 cm wide",
         {"parameters": {"shelves": 0, "layout": "2*door / 3*drawer"}, "size": {"width": 0.8}}),
        ("cupboard with a door on the left and three drawers on the right",
         {"parameters.layout": "(door) | (3*drawer)"}),
        ("a dresser with six drawers in two columns", {"parameters.layout": " / ".join(["(drawer | drawer)"] * 3)}),
        ("an oak 6-drawer dresser", {"parameters.material": "oak", "parts.drawer.count": 6}),
        ("a box, 40 x 30 x 20 cm", {"size": {"width": 0.4, "depth": 0.3, "height": 0.2}}),
        ("a grey wardrobe 2 metres high with three mirrored doors",
         {"size": {"height": 2.0}, "parts.door.material": "mirror"}),
        ("a cupboard with two mirror doors", {"parts.door.material": "mirror"}),
        ("a dresser with two small drawers in the top row and three wide drawers below, the bottom one half open",
         {"parts.drawer.count": 5, "parts.bottom drawer.open": 0.5}),
        ("a wardrobe, 6 ft 6 in tall", {"size": pytest.approx({"height": 1.9812})}),
        ("a wardrobe, 6 ft 6 high", {"size": pytest.approx({"height": 1.9812})}),
        ("a laptop opened by 90 degrees", {"parts.hinge.open": (QUARTER, "rad")}),
        ("a safe with its door half open", {"parts.door.open": 0.5}),
        ("a paper cutter with an arm that swings up by 45 degrees", {"parts.arm.range": (0.0, EIGHTH)}),
        ("a tricycle whose handlebar turns 45 degrees to either side", {"parts.handlebar.range": (-EIGHTH, EIGHTH)}),
        ("a pan tilt camera whose tilt goes -45 to 90 deg", {"parts.tilt.range": (-EIGHTH, QUARTER)}),
        ("a cabinet with red doors and brass knobs",
         {"parts.knob.material": "brass", "parts.door.color": "red"}),
        ("a pair of scissors", {"kind": "scissors", "parts": {}}),
        ("a pepper mill in dark walnut", {"parameters.material": "walnut"}),
        ("a sideboard 160 cm wide, 45 deep and 75 high", {"size": {"width": 1.6, "depth": 0.45, "height": 0.75}}),
        ("an excavator whose cab rotates 360 degrees on its tracks", {"parts.cab.range": (0.0, 4 * QUARTER)}),
        ("a piano with a lid hinged at the back", {"parts.lid.hinge": "back"}),
        ("a toolbox, 18 in long", {"size": {"length": 0.4572}}),
        ("a cabinet with a row of two drawers above a door",
         {"parameters.layout": "(drawer | drawer) / door", "parts.door.row": 2}),
        ("a dresser with three drawers in a row", {"parameters.layout": "(drawer | drawer | drawer)"}),
        ("a cupboard with two drawers in the top row", {"parts.drawer.side": "top"}),
        ("a microwave with a door hinged along the left edge", {"parts.door.hinge": "left", "parameters": {}}),
        ("a dollhouse style doll's cupboard", {"kind": "cabinet"}),
        ("We are looking for a fridge with two doors", {"kind": "fridge", "parts.door.count": 2}),
        ("For our lab we need a cabinet whose door slides", {"kind": "cabinet", "parts.door.motion": "slide"}),
        ("Something pretty for the hall: a cabinet with two doors", {"kind": "cabinet"}),
    ],
)  # fmt: skip
def test_a_sentence_fills_a_request(text, expected):
    stated = read_sentence(text).request.model_dump()
    for path, wanted in expected.items():
        found = stated
        for step in path.split("."):
            found = found[step]
        assert found == pytest.approx(wanted) if isinstance(wanted, float | tuple) else found == wanted, path


@pytest.mark.parametrize(
    ("text", "unread"),
    [
        ("a cabinet that sings", ["sings"]),
        ("a filing cabinet with four drawers, the second one from the top red", []),
        ("a filing cabinet with four drawers, the middle one red", ["the middle one red"]),
        ("a rocking cupboard", ["rocking"]),
        ("a modern cupboard for my grandmother", []),
        ("a standing desk that goes up and down", []),
        ("a washing machine with one knob on the panel", []),
        ("a safe with a door that swings open 30 cm", ["swings open 30 cm"]),
        ("a robot arm with a reach of 80 cm", ["reach of 80 cm"]),
        ("an excavator with a cab that turns all the way round", []),
        ("an office chair whose seat lifts 8 cm", []),
    ],
)
def test_words_that_are_not_read_are_listed_and_never_as_something_that_lacks(text, unread):
    made = read_sentence(text).made()
    assert [words.removeprefix("a ") for words in made.unread] == [words.removeprefix("a ") for words in unread]
    assert not made.differences
    assert made.is_complete is not bool(unread)


def test_what_was_asked_for_and_is_otherwise_is_listed():
    assert read_sentence("an office chair on nine castors").made().differences == ("caster: 9 asked for, there are 5",)
    assert read_sentence("a folding table, a round oak top").made().differences == ("top: not round",)
    assert not read_sentence("a piano stool, the seat rises from 48 to 90 cm").made().is_complete
    assert read_sentence("a desk lamp in dark pine").made().unread == ("dark",)


@pytest.mark.parametrize(
    ("text", "unread"),
    [
        ("a laptop with 3 drawers", ("3 drawers",)),
        ("a laptop with two screens", ("two screens",)),
        ("a folding wheelchair", ("folding",)),
        ("a hand-cranked music box", ()),
        ("a table with a blue and white striped top", ("blue and white striped top",)),
        ("a corner cupboard", ("corner",)),
        ("a cabinet with a clock and a bell, eleven red figures", ("clock and a bell, eleven red figures",)),
        ("a cabinet with two doors, and the rest shut", ()),
        ("a two-door wardrobe with a drawer below each door", ("below each",)),
        ("an office swivel chair, 12 cm", ("12 cm",)),
        ("a robot vacuum, round, 33 cm across", ()),
        ("a garage door, 2.4 m wide by 2.1 m high", ()),
        ("a filing cabinet, like they have in offices", ()),
        ("a laptop like the ones in offices with two screens", ("two screens",)),
        ("a desk with an oak base", ("oak base",)),
    ],
)
def test_what_no_part_is_known_of_is_quoted_and_not_said_to_lack(text, unread):
    made = read_sentence(text).made()
    assert made.unread == unread
    assert not made.differences


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("hi can u do a bicycle", "bicycle"),
        ("We run a bakery and want a cake stand", "cake_stand"),
        ("My son is four and digger mad: a toy excavator, 30 cm long", "excavator"),
        ("Looking for a rowing machine, 2 m long", "rowing_machine"),
        ("a hexapod walking robot", "hexapod"),
    ],
)
def test_the_kind_is_found_behind_what_somebody_says_of_himself(text, kind):
    made = read_sentence(text).made()
    assert made.request.kind == kind
    assert made.is_complete


def test_two_sizes_are_those_that_fit_the_proportions_of_the_kind():
    assert read_sentence("a hospital bed, 2.1 m x 0.9 m").request.size == {"depth": 2.1, "width": 0.9}
    assert read_sentence("a desk 1.4 m x 0.7 m").request.size == {"width": 1.4, "depth": 0.7}
    assert "row" not in read_sentence("a fridge freezer 1.8 m tall, freezer below").request.size
    fan = read_sentence("a tower fan that oscillates 60 degrees either side").request
    assert fan.parts["hinge"].range == pytest.approx((-QUARTER * 2 / 3, QUARTER * 2 / 3))


def test_a_word_that_is_two_letters_off_is_no_slip_of_the_pen():
    for text in ("a grey dumpster", "a spiral staircase"):
        with pytest.raises(InputError, match="No kind of object is called"):
            read_sentence(text)


def test_a_way_in_metres_is_that_of_the_slide_below_what_turns():
    made = read_sentence("an office chair with a seat that rises by 8 cm").made()
    (lift,) = (joint for joint in made.blueprint.joints if joint.child == "lift")
    assert made.is_complete
    assert lift.upper == pytest.approx(0.08)
    far = read_sentence("an office chair with a seat that rises by 3 m").made().differences
    assert far
    assert far[0].startswith("seat: range 0 to 3 m was asked for, it is 0 to 0.")


@pytest.mark.parametrize(("line", "holds"), [("row", True), ("column", False)])
def test_a_row_is_measured_on_the_object(line, holds):
    for text in (f"an oven with five knobs in a {line}", f"a stove with a {line} of four knobs"):
        listed = read_sentence(text).made().differences
        assert (listed == ()) is holds
        assert holds or "columns and rows are not 1 and" in listed[0]


@pytest.mark.parametrize(
    ("text", "unread"),
    [
        ("a garden stapler", "garden"),  # the name of another kind
        ("a stapler and a lamp", "stapler"),
        ("a cabinet with a vertical drawer", "vertical"),
        ("a cabinet with two doors, the handle up", "up"),
        ("a cabinet with sixteen flurbs", "sixteen flurbs"),
        ("a bar stool that swivels and goes up and down", "goes up and down"),
        ("a safe whose door is open and closed", "closed"),
        ("a cabinet whose two doors open together", "together"),
        ("an excavator whose boom, stick and bucket each move", "each"),
        ("a piano stool, the seat rises from 48 to 90 cm", "from 48 to 90 cm"),
        ("a cabinet with two doors, and five black", "five black"),
        ("a cantilever sewing box with two carrying handles", "two carrying handles"),
        ("a piano stool painted like a ladybird", "like a ladybird"),
    ],
)
def test_a_word_that_no_field_took_is_listed(text, unread):
    assert unread in " ".join(read_sentence(text).made().unread)


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        ("a window with two sashes that open outward", True),
        ("a window with two sashes that open inward", False),
        ("a room door that swings inward", False),
        ("a dishwasher whose door folds down", True),
        ("a dishwasher whose door folds up", False),
        ("a toolbox with a lid that opens up", True),
        ("a cabinet with a drawer that slides out", True),
        ("a tricycle with two wheels in front", False),
        ("a trailer with a jockey wheel", True),
        ("an industrial stapler", False),
        ("a tiny cabinet", False),
    ],
)
def test_directions_extents_and_one_for_each_are_measured(text, holds):
    assert read_sentence(text).made().is_complete is holds


@pytest.mark.parametrize(
    ("text", "size"),
    [
        ("a fridge of 180 cm", {"height": 1.8}),
        ("a 2 m table", {"width": 2.0}),
        ("a 4 m van", {"length": 4.0}),
        ("an air conditioner of 70 cm", {"width": 0.7}),
        ("a 1.8 m fridge, 70 cm wide", {"height": 1.8, "width": 0.7}),
    ],
)
def test_a_bare_size_is_the_largest_of_the_kind(text, size):
    sentence = read_sentence(text)
    assert sentence.request.size == pytest.approx(size)
    assert sentence.made().is_complete


def test_without_handles_is_without_handles():
    made = read_sentence("a cupboard without handles, three doors").made()
    assert made.is_complete
    assert made.blueprint.parameters["handle"] == "none"


@pytest.mark.parametrize(
    ("text", "number", "words"),
    [
        ("a fridge whose top half is open", 0, "top half is open"),
        ("a stove with the left door open", 0, "left door open"),
        ("a cabinet with four doors in two rows, the left door open", 0, "which one is to be open"),
        ("a cabinet with four doors in two rows, the left ones open", 2, ""),
        ("a dresser with six drawers in two columns, the top left drawer open", 1, ""),
        ("a dresser with the top drawer half open", 1, ""),
        ("a fridge whose upper door is open", 1, ""),
        ("a mailbox with a red flag, raised", 0, ""),
        ("a mailbox with the flag down", 1, ""),
    ],
)
def test_what_is_open_is_one_part_or_listed(text, number, words):
    made = read_sentence(text).made()
    assert sum(joint.value > 0.0 for joint in made.blueprint.joints) == number
    assert words in "; ".join([*made.differences, *made.unread])
    assert made.is_complete is not bool(words)


@pytest.mark.parametrize(("text", "part"), [("a ferris wheel", "wheel"), ("a windmill", "sails")])
def test_a_diameter_is_that_of_what_is_round(text, part):
    made = read_sentence(f"{text}, 3 m in diameter").made()
    assert made.is_complete
    (turned,) = (item for item in made.blueprint.parts if item.name == part)
    assert np.ptp(turned.bounds, axis=0).max() == pytest.approx(3.0, rel=0.02)


@pytest.mark.parametrize(
    ("text", "part", "look"), [("brass telescope", "tube", "brass"), ("copper bread bin", "lid", "copper")]
)
def test_the_look_of_the_whole_is_on_what_is_most_of_the_surface(text, part, look):
    made = read_sentence(text).made()
    painted = next(item for item in made.blueprint.parts if item.name == part)
    assert painted.appearance.materials[0].name == look


def test_a_slip_of_the_pen_is_repaired_with_a_word():
    assert read_sentence("a cabnet").notes == ["Read 'cabnet' as 'cabinet'."]
    assert read_sentence("a bycicle").notes == ["Read 'bycicle' as 'bicycle'."]


def test_sizes_toys_and_shares_of_parts_are_read_as_they_are_written():
    assert read_sentence("a desk 1400x700mm").request.size["width"] == pytest.approx(1.4)
    assert read_sentence("a dump truck toy, yellow").request.kind == "dump_truck"
    assert read_sentence("a toy excavator").made().differences[-1].startswith("toy: it is ")
    gate = read_sentence("a garden gate, two leaves, seven vertical pickets per leaf")
    assert gate.request.parts["leaf"].count == 2
    assert gate.made().unread
    assert read_sentence("a built-in oven").request.kind == "oven"
    assert "88" in "; ".join(read_sentence("a piano with 88 keys").made().differences)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "empty"),
        ("шкаф с двумя дверями", "not English"),
        ("word " * 300, "300 words"),
        ("a flying carpet", "No kind of object is called 'flying carpet'. The nearest are"),
        ("a cabinet with -3 drawers", "negative"),
        ("a cabinet with 10000000 doors", "less than or equal to"),
        ("a wardrobe, 0 m high", "greater than 0"),
        ("a four-door cabinet with three doors", "4 and 3 of 'door'"),
        ("a two-wheeled sack truck with five wheels", "2 and 5 of 'wheel'"),
        ("a parcel tape gun", "tape dispenser"),
        ("a butcher's flywheel slicer", "bread slicer or meat slicer"),
        ("a cabinet 80 cm wide, 1.2 m wide", "0.8 m and 1.2 m"),
        ("a wardrobe without doors whose door is red", "no door"),
    ],
)
def test_what_cannot_be_is_refused(text, reason):
    with pytest.raises(InputError) as caught:
        read_sentence(text)
    assert reason in str(caught.value)


def test_the_nearest_kind_is_taken_on_request_and_said():
    made = read_sentence("a hovercraft bicycle rack, 2 m long", nearest=True).made()
    assert made.request.instead_of == "hovercraft bicycle rack"
    assert "built is the nearest" in made.notes[0]
    assert made.facts["request"]["instead_of"]


def test_a_motion_that_goes_anywhere_does_not_hang_the_reader():
    read = read_sentence("overbed table, the top goes anywhere between 70 and 110 cm high")
    assert read.request.kind == "overbed_table"
    assert read.made().unread == ("goes anywhere between 70 and 110 cm",)
