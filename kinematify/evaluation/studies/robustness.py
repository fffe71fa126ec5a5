"""Validate corrupted models and count how the runs end: each must end in time with a report or a refusal.

Writes results/validate_robustness.{json,md}. A stopped run goes on where it was stopped.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path

from kinematify.evaluation.studies.corruption.bases import all_bases
from kinematify.evaluation.studies.corruption.cases import kinds_of
from kinematify.evaluation.studies.corruption.runner import Plan, hurried, run_cases
from kinematify.evaluation.studies.corruption.tables import BAD, write_tables
from kinematify.validation.catalogue import CATALOGUE
from kinematify.validation.environment import environment


def main() -> None:
    """Run the whole benchmark, or go on where it was stopped."""
    arguments = _arguments()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    bases = all_bases(work / "bases", arguments.data)
    print(f"{len(bases)} valid models in {work}")
    selected = frozenset(check for check in CATALOGUE if check.startswith(tuple(arguments.checks)))
    plan = Plan(seed=arguments.seed, bases=tuple(bases), settings=hurried(arguments.seconds), selected=selected)
    ledger = work / f"ledger-{arguments.seed}.jsonl"
    if arguments.fresh:
        ledger.unlink(missing_ok=True)
    wanted = arguments.cases or range(arguments.count)
    done = {number: result for number, result in _read(ledger).items() if number in set(wanted)}
    left = [number for number in wanted if number not in done]
    kinds = kinds_of(max(wanted) + 1)
    start = time.perf_counter()
    with ledger.open("a", encoding="utf-8") as file:
        for result in run_cases(left, plan, arguments.workers):
            result.setdefault("kind", kinds[result["number"]])
            result.setdefault("base", "?")
            done[result["number"]] = result
            file.write(json.dumps(result) + "\n")
            file.flush()
            _tell(result, len(done), len(wanted), time.perf_counter() - start)
    command = f"python benchmarks/robustness.py --count {len(done)} --seed {arguments.seed}"
    seconds = sum(result["seconds"] for result in done.values())
    facts = environment(plan.settings, seconds=seconds, interrupted=False)
    print(write_tables([done[number] for number in sorted(done)], facts, arguments.output, command=command))


def _tell(result: dict, count: int, total: int, seconds: float) -> None:
    if result["outcome"] in BAD or result.get("unexplained"):
        print(f"case {result['number']} ({result['kind']}, {result['base']}): {result['outcome']} {result['message']} "
              f"{result.get('unexplained', '')}", flush=True)  # fmt: skip
    if count % 25 == 0 or count == total:
        print(f"{count} of {total}, {seconds:.0f} s", flush=True)


def _read(ledger: Path) -> dict[int, dict]:
    if not ledger.is_file():
        return {}
    lines = ledger.read_text(encoding="utf-8").splitlines()
    return {result["number"]: result for result in map(json.loads, (line for line in lines if line.endswith("}")))}


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder of models, the benchmark's if absent")
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--cases", type=int, nargs="+", help="numbers of single cases to run instead")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=60.0, help="time budget of one run")
    parser.add_argument("--checks", nargs="+", default=["KV"], help="beginnings of the ids of checks, all if absent")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--fresh", action="store_true", help="forget the results of earlier runs")
    parser.add_argument("--work", type=Path, default=Path(tempfile.gettempdir()) / "kinematify-robustness",
                        help="folder for the models and results so far")  # fmt: skip
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    return parser.parse_args()


if __name__ == "__main__":
    main()
