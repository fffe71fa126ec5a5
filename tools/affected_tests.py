"""Print the test files of what changed since a branch or commit: `python -m tools.affected_tests main`.

Those are the files that import a changed module, or a module of the same package that depends on it. What lies further
away, where nearly everything depends on everything, is for `make test`.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from tools.imports import ROOT, import_graph, modules


def changed_files(base: str) -> list[Path]:
    """Files that differ from where this branch left `base`, those that are not committed yet included."""
    start = _git("merge-base", base, "HEAD").strip()
    names = _git("diff", "--name-only", start) + _git("ls-files", "--others", "--exclude-standard")
    return [ROOT / name for name in names.splitlines()]


def _git(*words: str) -> str:
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"git {' '.join(words)} failed: {done.stderr.strip()}")
    return done.stdout


def affected_tests(changed: list[Path]) -> list[Path]:
    """Test files near the changed files; one that is not Python counts as the modules that own or name it."""
    resolved = {path.resolve() for path in changed}
    touched = {name for name, path in modules().items() if path.resolve() in resolved}
    data = [path for path in resolved if path.suffix != ".py"]
    touched |= {name for name, path in modules().items() if any(_has(path, file) for file in data)}
    reached = _with_dependents_in_package(touched)
    near = {name for name, imports in import_graph().items() if name.startswith("tests.") and imports & reached}
    tests = _with_dependents_in_package(reached | near)
    return sorted(modules()[name] for name in tests if name.rpartition(".")[2].startswith("test_"))


def _has(module: Path, file: Path) -> bool:
    """Whether a file that is not Python lies in the package of a module or is named in it."""
    if module.name == "__init__.py" and module.resolve().parent in file.parents:
        return True
    return f"{file.name}" in module.read_text("utf-8")


def _with_dependents_in_package(names: set[str]) -> set[str]:
    grown = names | {
        name
        for name, imports in import_graph().items()
        if any(_package(imported) == _package(name) for imported in imports & names)
    }
    return grown if grown == names else _with_dependents_in_package(grown)


def _package(module: str) -> str:
    """`joints` for all below `kinematify.joints`, `tests.joints` for its tests; `configs` are values of `config`."""
    top, _, rest = module.partition(".")
    first = rest.split(".")[0]
    return {"kinematify": "config" if first == "configs" else first}.get(top, module.rpartition(".")[0])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("base", help="commit or branch that the change started from")
    found = affected_tests(changed_files(parser.parse_args().base))
    sys.stdout.writelines(f"{path.relative_to(ROOT)}\n" for path in found)
