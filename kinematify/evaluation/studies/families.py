"""Validate every family of the generator: the models with their true joints, and those inferred from the parts alone.

Writes results/families.{json,md}. A stopped run goes on where it was stopped, and a later one runs again what a change
of the code or of a family can have changed.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.config.validation import load_settings
from kinematify.evaluation.studies.generated.job import run_job
from kinematify.evaluation.studies.generated.tables import write_tables
from kinematify.generate.procedural.families import FAMILIES
from kinematify.validation.environment import environment

if TYPE_CHECKING:
    from kinematify.evaluation.studies.generated.job import Result


def main() -> None:
    """Run the whole benchmark, or go on where it was stopped."""
    arguments = _arguments()
    families = arguments.families or list(FAMILIES)
    ledger = arguments.work / "ledger.jsonl"
    arguments.work.mkdir(parents=True, exist_ok=True)
    done = _read(ledger)
    # Seeds outside: what an early stop leaves says something of every family.
    wanted = [(family, seed) for seed in range(arguments.seeds) for family in families]
    start = time.perf_counter()
    if not arguments.tables_only:
        _run(wanted, done, ledger, arguments.workers)
    chosen = f" --families {' '.join(arguments.families)}" if arguments.families else ""
    results = [done[job] for job in wanted if job in done]
    facts = environment(load_settings(), seconds=time.perf_counter() - start, interrupted=len(results) < len(wanted))
    command = f"python benchmarks/families.py --seeds {arguments.seeds}{chosen}"
    print(write_tables(results, facts, arguments.output, command=command, wanted=len(wanted)))


def _run(wanted: list[tuple[str, int]], done: dict[tuple[str, int], Result], ledger: Path, workers: int) -> None:
    """Run the objects that have no result yet, or an old one; every result is kept at once."""
    start = time.perf_counter()
    # Not a pool of `multiprocessing`, whose processes must not start others, as validation does.
    context = multiprocessing.get_context("spawn")
    with ledger.open("a", encoding="utf-8") as file, ProcessPoolExecutor(workers, mp_context=context) as pool:
        futures = {pool.submit(run_job, *job, done[job]["key"] if job in done else None): job for job in wanted}
        for number, future in enumerate(as_completed(futures), start=1):
            result = future.result()
            if result is not None:
                done[futures[future]] = result
                file.write(json.dumps(result) + "\n")
                file.flush()
                _tell(result)
            if number % 20 == 0 or number == len(wanted):
                print(f"{number} of {len(wanted)}, {time.perf_counter() - start:.0f} s", flush=True)


def _tell(result: Result) -> None:
    for whose in ("truth", "inferred"):
        for error in result[whose]["errors"]:
            print(f"{result['family']} {result['seed']} {whose}: {error['check']} {error['where']}", flush=True)


def _read(ledger: Path) -> dict[tuple[str, int], Result]:
    if not ledger.is_file():
        return {}
    lines = [line for line in ledger.read_text(encoding="utf-8").splitlines() if line.endswith("}")]
    return {(result["family"], result["seed"]): result for result in map(json.loads, lines)}


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20, help="objects per family")
    parser.add_argument("--families", nargs="+", choices=list(FAMILIES), metavar="NAME", help="only these")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--work", type=Path, default=Path(tempfile.gettempdir()) / "kinematify-families",
                        help="folder for the results so far")  # fmt: skip
    parser.add_argument("--tables-only", action="store_true", help="write the tables of the results so far")
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    return parser.parse_args()


if __name__ == "__main__":
    main()
