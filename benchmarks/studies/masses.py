"""Do generated objects weigh what such things weigh?

Each object is built from its name with the default size and material, and its mass is compared with the range that
things sold under that name have. A part that a hand cannot lift is written lighter, so that it moves; both masses must
be near. The ranges are common knowledge (data sheets of shops and makers), written before anything was measured.
*Right* is within a factor of two of the range.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from benchmarks.study import Options, Study, explained
from kinematify.config import load_config
from kinematify.evaluation.result_record import table
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.sentence import from_text
from kinematify.model.dynamics import with_dynamics
from kinematify.model.urdf import model_robot

if TYPE_CHECKING:
    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report

RANGES = {
    "wheelbarrow": (10.0, 20.0),
    "garage door": (50.0, 120.0),
    "laptop": (1.2, 3.0),
    "microwave": (10.0, 18.0),
    "fridge": (50.0, 110.0),
    "dishwasher": (30.0, 55.0),
    "washing machine": (60.0, 90.0),
    "oven": (30.0, 60.0),
    "toaster": (1.0, 3.0),
    "kettle": (0.7, 1.5),
    "office chair": (8.0, 20.0),
    "stapler": (0.15, 0.5),
    "pair of scissors": (0.05, 0.25),
    "pair of pliers": (0.15, 0.45),
    "desk lamp": (1.0, 3.0),
    "safe": (10.0, 60.0),
    "toilet": (20.0, 45.0),
    "suitcase": (2.5, 5.0),
    "ladder": (5.0, 15.0),
    "toolbox": (1.5, 6.0),
    "mailbox": (1.0, 6.0),
    "filing cabinet": (20.0, 50.0),
    "chest of drawers": (25.0, 60.0),
    "wardrobe": (50.0, 130.0),
    "piano": (180.0, 300.0),
    "trash can": (0.8, 6.0),
    "wheelchair": (12.0, 20.0),
    "shopping cart": (15.0, 30.0),
    "ironing board": (4.0, 9.0),
    "vise": (4.0, 15.0),
}
"""Mass of such things [kg]."""


class MassesOptions(Options):
    """Nothing to choose."""


def measure(options: MassesOptions, work: Work) -> Measured:
    """Build every object and weigh it."""
    del options, work
    records = [weighed(name) for name in RANGES]
    return records, {"right": sum(record["right"] for record in records), "objects": len(records)}


def weighed(name: str) -> Record:
    """Mass of an object [kg] as its geometry has it and as it is written, and whether both are near its range."""
    built, config = from_text(f"a {name}").build(), load_config()
    shaped = model_robot(true_model(built, config))
    shape, mass = (
        sum(link.inertial.mass for link in robot.links if link.inertial is not None)
        for robot in (shaped, with_dynamics(shaped, config.dynamics))
    )
    low, high = RANGES[name]
    right = all(0.5 * low <= found <= 2.0 * high for found in (shape, mass))
    return {"name": name, "shape": shape, "mass": mass, "low": low, "high": high, "right": right}


def report(found: Report[Record]) -> list[str]:
    """Every object, its masses and its range."""
    rows = [
        (
            r["name"], f"{r['shape']:.3g}", f"{r['mass']:.3g}", f"{r['low']:g} to {r['high']:g}",
            "yes" if r["right"] else "**no**",
        )
        for r in found.records
    ]  # fmt: skip
    summary = found.summary
    return [
        f"{summary['right']} of {summary['objects']} are right. " + explained(__doc__),
        table(("object", "by its geometry [kg]", "as written [kg]", "such things weigh [kg]", "right"), rows),
    ]


STUDY = Study(title="Masses of generated objects", options=MassesOptions, measure=measure, report=report)
