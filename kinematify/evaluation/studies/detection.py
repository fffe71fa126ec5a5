"""Plant faults in the benchmark's models and count which of them `kinematify validate` finds.

Writes results/validate_detection.{json,md}. A fault is found only if a warning or an error that the untouched model
does not have names the right joint or link and puts the right blame.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

from kinematify.evaluation.datasets import find_objects
from kinematify.evaluation.studies.mutants.base import UNTOUCHED, write_base
from kinematify.evaluation.studies.mutants.fault import Fault
from kinematify.evaluation.studies.mutants.outcome import judge
from kinematify.evaluation.studies.mutants.plan import FAULTS, write_mutants
from kinematify.evaluation.studies.mutants.tables import Row, write_tables
from kinematify.evaluation.studies.mutants.work import FILE_FAMILIES, MOTION_FAMILIES, code_version, validated


def main() -> None:
    """Run the whole benchmark, or go on where it was stopped."""
    arguments = _arguments()
    work = arguments.work.resolve()
    bases = {item.name: write_base(item, work) for item in find_objects(arguments.data)}
    print(f"{len(bases)} models in {work}")
    start = time.perf_counter()
    ledger = work / f"ledger-{code_version()}.jsonl"
    untouched = {}
    jobs = [(f"{name}: {UNTOUCHED}", str(base.urdf), MOTION_FAMILIES) for name, base in bases.items()]
    for result in validated(jobs, ledger, arguments.workers):
        name = result["name"].removesuffix(f": {UNTOUCHED}")
        untouched[name] = result
        print(f"{name}: {result['seconds']:.1f} s, {len(result['findings'])} findings", flush=True)
    clean = [base for name, base in bases.items() if not _has_errors(untouched[name])]
    faults = {fault.name: fault for fault in FAULTS if arguments.only in (None, _family(fault))}
    planned = write_mutants(clean, arguments.count, arguments.seed, list(faults.values()))
    mutants = {mutant.name: mutant for mutant in planned}
    print(f"{len(clean)} of {len(bases)} models are clean; {len(mutants)} mutants")
    jobs = [
        (name, mutant.urdf, MOTION_FAMILIES if faults[mutant.fault].kinematic else FILE_FAMILIES)
        for name, mutant in mutants.items()
    ]
    rows = []
    for number, result in enumerate(validated(jobs, ledger, arguments.workers), start=1):
        mutant = mutants[result["name"]]
        fault = faults[mutant.fault]
        outcome = judge(fault, mutant.planted, result["findings"], untouched[mutant.model]["findings"])
        rows.append(Row(mutant=mutant, fault=fault, outcome=outcome, seconds=result["seconds"]))
        if number % 20 == 0 or number == len(jobs):
            print(f"{number} of {len(jobs)}, {time.perf_counter() - start:.0f} s", flush=True)
    order = {name: index for index, name in enumerate(mutants)}
    rows.sort(key=lambda row: order[row.mutant.name])
    only = f" --only {arguments.only}" if arguments.only else ""
    command = f"python benchmarks/detection.py --count {arguments.count} --seed {arguments.seed}{only}"
    text = write_tables(rows, untouched, arguments.output, command=command)
    print(text)


def _has_errors(result: dict) -> bool:
    return any(fact["severity"] == "error" for fact in result["findings"])


def _family(fault: Fault) -> str:
    return "kinematic" if fault.kinematic else "file"


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder of models, the benchmark's if absent")
    parser.add_argument("--count", type=int, default=1080, help="mutants, rounded up to the same number of each kind")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", choices=("kinematic", "file"), help="faults of one family")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--work", type=Path, default=Path(tempfile.gettempdir()) / "kinematify-detection",
                        help="folder for the models; a stopped run goes on there")  # fmt: skip
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    return parser.parse_args()


if __name__ == "__main__":
    main()
