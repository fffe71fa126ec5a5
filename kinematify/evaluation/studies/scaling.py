"""Measure how inference time grows with the number of parts: results/scaling.{json,md,png}."""

from __future__ import annotations

import argparse
from pathlib import Path

from kinematify.config import load_config
from kinematify.evaluation.scaling import SIZES, measure_scaling, write_scaling
from kinematify.pipeline import infer

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--config", default="default")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    arguments = parser.parse_args()
    report = measure_scaling(load_config(arguments.config), infer, arguments.sizes)
    for point in report.points:
        print(f"{point.parts:4d} parts  {point.seconds:7.2f} s  {point.pairs_right}/{point.parts - 1} pairs")
    print(f"exponent {report.exponent:.2f}")
    write_scaling(report, arguments.output)
