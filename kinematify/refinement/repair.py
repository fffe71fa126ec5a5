"""Other people's URDFs repaired where `validate` found something: only what a finding names is changed.

The file is validated, what can be repaired is, and the result is validated and loaded raw again: some findings show
only when others are gone. What is not repaired is listed with the reason.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.errors import DescriptionError, ExitStatus
from kinematify.model.collision import collides_as_it_is
from kinematify.model.output import check_file, urdf_of
from kinematify.refinement.joint_edits import JointEdits
from kinematify.refinement.urdf_editor import UrdfEditor, xml_of
from kinematify.robot.mesh_paths import GLTF_SUFFIXES
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Robot
from kinematify.simulation.engines import ENGINES
from kinematify.validation.checks.as_loaded import STILL
from kinematify.validation.finding import Cause, Severity, Status
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from lxml.etree import _Element

    from kinematify.config import Config
    from kinematify.config.validation import ValidationSettings
    from kinematify.refinement.urdf_editor import Diff
    from kinematify.robot.robot import Link
    from kinematify.validation.finding import Finding
    from kinematify.validation.run.report import ValidationReport

_ROUNDS = 2
"""Looks at the result at most: what a broken file hides, and pieces that still meet, are seen in the first."""
_CARVED = ("KV301", "KV302", "KV310", "KV311", "KV312", "KV802", "KV804")
"""Findings about collision geometry, if they blame physics and name two links."""
_MOST_CUT = 0.05
"""Share of the volume of collision geometry that a repair may cut away."""
_BESIDE = "KV241"
"""Collision geometry is beside what is seen."""
_MASSLESS = "KV201"
"""A body that moves has no mass: engines differ in what they take, and a guess may be worse than theirs."""
_WEIGHED = ("KV202", "KV204", "KV205", "KV207")
"""Findings about a mass or an inertia that no engine can use, or that one digit too many explains."""
_CENTER = "KV208"
_REPEATED = "KV105"
_QUATERNION = "KV107"
_SHAPELESS = ("KV140", "KV141", "KV142", "KV150")
"""Elements without geometry that can be read."""
_FORMAT = re.compile(r"\.(?:glb|gltf)\b", re.IGNORECASE)
"""In what an engine says of a file that it does not open."""
_COLLADA = (".dae",)
"""MuJoCo reads none; of visual geometry it reads nothing."""
_ONCE = {
    "joint": ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "safety_controller", "calibration"),
    "link": ("inertial",),
    "inertial": ("origin", "mass", "inertia"),
    "visual": ("origin", "material"),
    "collision": ("origin",),
}
"""What an element has once."""
_KINEMATICS = ("KV134", "KV137", "KV220", "KV310", "KV312")
"""Findings that `JointEdits` looks at."""


@dataclass(frozen=True, kw_only=True)
class ModelSnapshot:
    """A file as `validate` and the engines see it."""

    report: ValidationReport
    refusals: Mapping[str, str]
    """What engines say that do not open the file as it is, by engine."""

    @property
    def errors(self) -> int:
        """Return how many there are that follow from no other finding."""
        return self._count(Severity.ERROR)

    @property
    def warnings(self) -> int:
        """The same of warnings."""
        return self._count(Severity.WARNING)

    @property
    def moving(self) -> dict[str, int]:
        """Return how many joints a hand moves in the file as it is, by engine."""
        found = [check for check in self.report.checks if check.check == "KV804" and "right" in check.measured]
        return {check.engine: int(check.measured["right"]) for check in found if check.engine is not None}

    @property
    def still(self) -> dict[str, frozenset[str]]:
        """Joints that nothing moves in the file as it is, by engine."""
        return {
            check.engine: frozenset(name.removeprefix(STILL) for name in check.measured if name.startswith(STILL))
            for check in self.report.checks
            if check.check == "KV804" and check.engine is not None
        }

    @property
    def open(self) -> list[Finding]:
        """Errors and warnings that follow from no other finding and are not suppressed."""
        found = [group.finding for group in self.report.groups]
        return [item for item in found if item.severity is not Severity.NOTE and item.suppressed is None]

    def _count(self, severity: Severity) -> int:
        return sum(item.severity is severity for item in self.open)

    def as_json(self) -> dict[str, Any]:
        """As JSON values."""
        return {
            "verdict": self.report.verdict,
            "errors": self.errors,
            "warnings": self.warnings,
            "as_loaded": self.report.as_loaded or None,
            "refused_by": dict(self.refusals),
        }


@dataclass(frozen=True, kw_only=True)
class Fix:
    """A file that was written."""

    path: Path
    changes: tuple[str, ...]
    """What is other than in the given file, one sentence each."""
    diffs: tuple[Diff, ...]
    """Changes of joints."""
    left: tuple[str, ...]
    """What was found and not repaired, with the reason."""
    named: frozenset[str]
    """Links and joints that a finding or note names of a look that was repaired."""
    before: ModelSnapshot
    after: ModelSnapshot

    @property
    def written(self) -> bool:
        """False where there was nothing to change, so that no file was written."""
        return self.after is not self.before

    @property
    def summary(self) -> str:
        """What was repaired, and what needs which option, in one line."""
        done = len(self.changes) + len(self.diffs)
        needs = {option: sum(f"needs {option}" in text for text in self.left) for option in ("--kinematics", "--all")}
        needs["no safe fix"] = len(self.left) - sum(needs.values())
        left = ", ".join(f"{count} ({what})" for what, count in needs.items() if count)
        return f"Repaired: {done or 'nothing'}. Not repaired: {left or 'nothing'}."

    @property
    def removed(self) -> tuple[str, ...]:
        """Engines that open the given file and not the result."""
        return tuple(engine for engine in self.after.refusals if engine not in self.before.refusals)

    @property
    def regressions(self) -> dict[str, tuple[int, int]]:
        """Engines in which fewer joints move than before, with how many did and do."""
        now = self.after.moving
        return {name: (was, now[name]) for name, was in self.before.moving.items() if now.get(name, was) < was}

    @property
    def kept(self) -> dict[str, tuple[str, ...]]:
        """Joints that moved before and do not in the result, by engine of `fewer`."""
        was, now = self.before.still, self.after.still
        return {name: tuple(sorted(now[name] - was[name])) for name in self.regressions}

    @property
    def exit_status(self) -> int:
        """1 if an error stays, an engine is lost, or fewer joints move in one, else 0."""
        failed = self.removed or self.regressions or self.after.report.verdict == "fail"
        return ExitStatus.FAILURES if failed else ExitStatus.FINE

    def as_json(self) -> dict[str, Any]:
        """As JSON values."""
        return {
            "path": str(self.path) if self.written else None,
            "changes": list(self.changes),
            "diffs": [{"title": diff.title, "lines": diff.lines} for diff in self.diffs],
            "left": list(self.left),
            "named": sorted(self.named),
            "before": self.before.as_json(),
            "after": self.after.as_json(),
            "lost": list(self.removed),
            "fewer": {name: list(counts) for name, counts in self.regressions.items()},
            "held": {name: list(joints) for name, joints in self.kept.items()},
        }


def fix(
    model: str | Path,
    out: str | Path,
    *,
    package_dirs: Sequence[Path] = (),
    arguments: Mapping[str, str] | None = None,
    overwrite: bool = False,
    everything: bool = False,
    kinematics: bool = False,
    config: Config | None = None,
    settings: ValidationSettings | None = None,
    workers: int | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> Fix:
    """Write a URDF in which what `validate` finds is repaired, as far as the repair is certain.

    Where there is nothing to change, no file is written.

    Args:
        model: URDF, xacro, MJCF, SDF or USD file, or a model folder; it is not changed.
        out: File to write; collision meshes are in a folder beside it.
        package_dirs: Folders in which ``package://`` names are looked up.
        arguments: Of a xacro.
        overwrite: Replace `out` if it exists.
        everything: Give all links collision pieces, and all that weigh nothing a mass, findings or not.
        kinematics: Change joints, too.
        config: Clearance of collision pieces; the default one if absent.
        settings: Of the checks; the shipped ones if absent.
        workers: Processes at a time, as for `validate`.
        progress: Called with the stage that ended and the fraction done.

    Raises:
        InputError: `model` cannot be read; `out` is `model`.
        OutputError: `out` exists and must not be replaced, or cannot be written.
    """
    out, settings = Path(out), settings or load_settings()
    check_file(out, overwrite=overwrite)
    model = urdf_of(Path(model), package_dirs, arguments)
    editor = UrdfEditor(model, out, package_dirs)

    def look(path: Path, part: int) -> ModelSnapshot:
        def tell(stage: str, fraction: float) -> None:
            if progress is not None:
                progress(f"{path.name}: {stage}", (part + fraction) / (_ROUNDS + 1))

        report = validate(path, package_dirs=package_dirs, settings=settings, workers=workers, progress=tell)
        return ModelSnapshot(report=report, refusals=_refusals(report))

    before = look(model, 0)
    joints = JointEdits(editor=editor) if kinematics else None
    repairs = _Repairs(
        editor=editor, config=config or load_config(), settings=settings, everything=everything, joints=joints
    )
    gltf = GLTF_SUFFIXES if any(map(_FORMAT.search, before.refusals.values())) else ()
    unread = editor.export_obj(
        {"visual": gltf, "collision": (*gltf, *(_COLLADA if "mujoco" in before.refusals else ()))}
    )
    after, place = before, model
    for part in range(1, _ROUNDS + 1):
        nothing = not repairs.apply(after.report, place, package_dirs)
        if nothing and (part > 1 or not (editor.changes or before.refusals)):
            break
        after, place = look(editor.write(), part), out
    return Fix(
        path=out,
        changes=tuple(editor.changes),
        diffs=tuple(editor.diffs),
        left=(*unread, *repairs.remarks, *_left(after, repairs, kinematics=kinematics)),
        named=frozenset(repairs.named),
        before=before,
        after=after,
    )


def _refusals(report: ValidationReport) -> dict[str, str]:
    """What engines say that do not open the file as it is, or why they were not asked, by engine."""
    found: dict[str, str] = {}
    for check in report.checks:
        if check.check == "KV801" and check.engine is not None:
            said = [item.message for item in check.findings if item.joint is None]
            if check.status not in (Status.PASS, Status.FAIL):
                said = [check.reason or ""]
            if said:
                found[check.engine] = said[0]
    return found


class _Repairs:
    """Repairs done to an editor, so that nothing is tried twice."""

    def __init__(
        self,
        *,
        editor: UrdfEditor,
        config: Config,
        settings: ValidationSettings,
        everything: bool,
        joints: JointEdits | None,
    ) -> None:
        self._editor, self._config, self._settings = editor, config, settings
        self._everything = everything
        self._given: dict[str, Link] = {}
        self._carved: frozenset[str] = frozenset()
        self._weighed: set[str] = set()
        self.named: set[str] = set()
        self.joints = joints
        self.remarks: list[str] = []

    def apply(self, report: ValidationReport, path: Path, package_dirs: Sequence[Path]) -> bool:
        """Repair what a report finds in the editor as it was written to `path`; False if there is nothing to do."""
        editor = self._editor
        done = len(editor.changes) + len(editor.diffs)
        self.named |= {name for item in report.counted for name in (item.joint, item.link, *(item.pair or ())) if name}
        found = [finding for finding in report.counted if finding.severity is not Severity.NOTE]
        for element in self._repeated(found):
            _keep_first(editor, element)
        if any(finding.check == _QUATERNION for finding in found):
            editor.write_rpy()
        if any(finding.check in _SHAPELESS for finding in found):
            editor.settle_shapes()
        try:
            robot = read_robot(path, package_dirs=package_dirs)
        except DescriptionError:
            robot = None
        if self.joints is not None:
            self.joints.apply(report, robot)
        if robot is not None:
            self._weigh(robot, found)
            self._carve(robot, found)
        return len(editor.changes) + len(editor.diffs) > done

    def _repeated(self, found: Sequence[Finding]) -> Iterator[_Element]:
        for finding in found:
            if finding.check == _REPEATED:
                if finding.joint is not None:
                    yield self._editor.joint(finding.joint)
                elif finding.link is not None:
                    yield from self._editor.link(finding.link).iter("link", "inertial", "visual", "collision")

    def _weigh(self, robot: Robot, found: Sequence[Finding]) -> None:
        prepare = self._settings.prepare
        solid = {link.name for link in robot.links if link.has_geometry}
        names = solid if self._everything else _to_weigh(found)
        new = [link.name for link in robot.links if link.name in names - self._weighed]
        self._weighed |= set(self._editor.set_inertia(robot, new, prepare))
        off = {item.link for item in found if item.check == _CENTER and item.severity is Severity.ERROR and item.link}
        for name in sorted(off - self._weighed):
            self._editor.center(robot, name, prepare)
        self._weighed |= off

    def _carve(self, robot: Robot, found: Sequence[Finding]) -> None:
        """Give links collision pieces, as long as that cuts no more of them away than `_MOST_CUT`."""
        beside = {finding.link for finding in found if finding.check == _BESIDE and finding.link}
        for link in robot.links:  # as given: pieces are never made of pieces
            seen = link.name in beside and link.visuals
            self._given.setdefault(link.name, replace(link, collisions=()) if seen else link)
        names = frozenset(self._to_carve(robot, found, beside)) | self._carved
        if names != self._carved:
            self._carved = names
            links = tuple(self._given[link.name] if link.name in names else link for link in robot.links)
            primitive = {link.name for link in links if any(shape.kind != "mesh" for shape in link.collisions)}
            allowed, most = (names, 1.0) if self._everything else (names - primitive, _MOST_CUT)
            carved = self._editor.carve(replace(robot, links=links), allowed, self._config, self._settings, most)
            whole = names - {item.link for item in carved.links if item.link in allowed and item.carved <= most}
            self.remarks = [
                f"{name}: its collision geometry is left as it is: to leave the motion free, more than {_MOST_CUT:.0%} "
                "of it would be cut away, or a primitive replaced by pieces"
                for name in sorted(whole)
            ] + [
                f"{item.link}: its surface has so many triangles that its pieces follow a grid, "
                f"{item.thinned * 1e3:.2g} mm off at most"
                for item in carved.links
                if item.thinned
            ]

    def _to_carve(self, robot: Robot, found: Sequence[Finding], beside: set[str]) -> Iterator[str]:
        """Yield, of two links that meet, those whose shapes engines take for others; both where neither is."""
        if self._everything:
            yield from (link.name for link in robot.links if link.has_geometry)
            return
        for finding in found:
            if finding.check not in _CARVED or finding.cause is not Cause.PHYSICS or finding.pair is None:
                continue
            if _only_under_a_flag(finding):
                continue
            pair = [name for name in finding.pair if robot.link_by_name[name].collisions]
            alone = {name: Robot(name=name, links=(robot.link_by_name[name],), joints=()) for name in pair}
            rough = [name for name in pair if name in beside or not collides_as_it_is(alone[name])]
            yield from pair if self._carved.issuperset(rough) else rough


def _only_under_a_flag(finding: Finding) -> bool:
    """True if plain loading does not show it."""
    return finding.check.startswith("KV8") and finding.engine is not None and bool(ENGINES[finding.engine].contact_flag)


def _to_weigh(found: Sequence[Finding]) -> set[str]:
    """Links whose mass or inertia no engine can use."""
    return {
        item.link
        for item in found
        if item.link is not None
        and item.check in _WEIGHED
        and (item.check != "KV202" or item.severity is Severity.ERROR)  # a mass of zero may be meant
    }


def _keep_first(editor: UrdfEditor, element: _Element) -> None:
    """Drop repeated elements: PyBullet, Pinocchio and ROS read the first one, MuJoCo refuses the file."""
    owner = element if element.tag in ("link", "joint") else element.getparent()
    for tag in _ONCE[str(element.tag)]:
        for other in element.findall(tag)[1:]:
            element.remove(other)
            editor.say(
                f"{'' if owner is None else owner.get('name')}: of two <{tag}> the first stays, which PyBullet and "
                f"Pinocchio read; dropped {xml_of(other)}"
            )


def _left(after: ModelSnapshot, repairs: _Repairs, *, kinematics: bool) -> list[str]:
    """Findings of the result, those of one check together, each with the reason why it stays."""
    said = []
    for (check, severity, engine), group in groupby(after.open, lambda item: (item.check, item.severity, item.engine)):
        first, *more = group
        title = "" if engine is None else f" [{engine}]"
        also = f" (and {len(more)} more)" if more else ""
        said.append(
            f"{severity.value} {check}{title}: {first.message}{also} {_reason(first, repairs, kinematics=kinematics)}"
        )
    return said


def _reason(finding: Finding, repairs: _Repairs, *, kinematics: bool) -> str:
    joint = finding.joint or ""
    if repairs.joints is not None and joint in repairs.joints.left:
        return f"Not repaired: {repairs.joints.left[joint]}."
    if finding.check in _KINEMATICS and finding.cause is Cause.KINEMATICS and not kinematics:
        return "Not repaired: needs --kinematics, which changes joints."
    if finding.check == _MASSLESS:
        return "Not repaired: needs --all, which writes the mass of the geometry."
    if finding.check in _CARVED and _only_under_a_flag(finding):
        return "Not repaired: needs --all, which carves all links; plain loading does not show it."
    if finding.check in _CARVED and finding.cause is Cause.PHYSICS:
        return "Not repaired: the pieces cannot be carved further."
    return f"Not repaired: no safe fix is known. {finding.remedy}"
