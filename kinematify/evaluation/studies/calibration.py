"""Measure how far the confidence of joints can be believed: results/calibration.{json,md,png}.

Objects are generated from a seed that nothing was fitted on, their joints are inferred from the parts alone, and what
was said of each joint is compared with whether it was right. A stopped run goes on where it was stopped.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from pathlib import Path

from kinematify.evaluation.calibration import judged_joints, write_calibration
from kinematify.evaluation.run import BenchmarkRequest, run_benchmark
from kinematify.pipeline.corpus import write_corpus

HELD_OUT = 1213
"""Seed of the objects; those on which the confidence was fitted had 5417, those looked at meanwhile 909."""


def main() -> None:
    """Write the objects, infer them and compare."""
    arguments = _arguments()
    corpus = arguments.work / f"corpus-{arguments.seed}-{arguments.count}"
    write_corpus(corpus, arguments.count, seed=arguments.seed, progress=_tell, workers=arguments.workers)
    request = BenchmarkRequest(
        data=corpus,
        conditions=tuple(arguments.conditions.split(",")),
        work_folder=arguments.work,
        workers=arguments.workers,
        timeout=300.0,
    )
    report = run_benchmark(request, _tell)
    header = {**report.header, "corpus_seed": arguments.seed, "command": _command(arguments)}
    for path in write_calibration(judged_joints(report.results), header, arguments.output, name=arguments.name):
        print(path)


def _tell(what: str, share: float) -> None:
    print(f"{share:4.0%} {what}", flush=True)


def _command(arguments: argparse.Namespace) -> str:
    return f"python benchmarks/calibration.py --count {arguments.count} --seed {arguments.seed}"


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=180, help="objects")
    parser.add_argument("--seed", type=int, default=HELD_OUT)
    parser.add_argument("--conditions", default="rest", help="poses, separated by commas")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--work", type=Path, default=Path(tempfile.gettempdir()) / "kinematify-calibration")
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    parser.add_argument("--name", default="calibration", help="of the files")
    return parser.parse_args()


if __name__ == "__main__":
    main()
