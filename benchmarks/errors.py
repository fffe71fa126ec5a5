"""The worst joints of a benchmark, in pictures and words: truth beside prediction, and what the errors have in common.

The objects concerned are inferred once more, so that the pictures show what the present code answers.
"""

from __future__ import annotations

import shutil
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from benchmarks.tables import CLOSE_LINE, is_right
from kinematify.errors import OutputError
from kinematify.evaluation.benchmark_job import CLEAN, degraded, erased_item, shown_parts
from kinematify.evaluation.metrics import CLOSE_ANGLE, axis_angle
from kinematify.evaluation.result_record import document, replace_text
from kinematify.evaluation.run_benchmark import jobs_of
from kinematify.model.picture_scene import GLYPH_COLORS, camera_for, sliding_arrow, turning_arrow
from kinematify.pipeline.infer_assembly import infer
from kinematify.render.picture import BACKGROUND, PictureScene, PosedMesh, render_scene
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import joint_motion

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from pathlib import Path

    from kinematify.assembly.part import Assembly, Part
    from kinematify.assembly.truth import TrueJoint
    from kinematify.config import PreviewConfig
    from kinematify.evaluation.benchmark_job import Job, JobResult
    from kinematify.evaluation.metrics import JointScore
    from kinematify.evaluation.result_record import Report
    from kinematify.evaluation.run_benchmark import BenchmarkRequest
    from kinematify.joints.candidate import JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.arrays import FloatArray

_CHILD, _PARENT, _REST = np.array([0.95, 0.62, 0.16]), np.array([0.56, 0.68, 0.88]), np.array([0.84, 0.84, 0.85])
_SIZE = (300, 260)  # [pixels] of a panel
_CAPTION, _MARGIN = 20, 14  # [pixels]
_INK = (45, 50, 60)
_MOVED_TURN, _MOVED_SLIDE = np.deg2rad(40.0), 0.2  # at most; slides in diagonals
_ARROW_RADIUS = 0.009  # of the diagonal: seen in a small panel


@dataclass(frozen=True, kw_only=True, eq=False)
class ShownJoint:
    """A joint as it is drawn, world frame."""

    parents: Mapping[int, int]
    """Part -> parent part, -1 for the root."""
    child: int
    kind: JointType
    axis: FloatArray
    """Unit direction, shape (3,)."""
    pivot: FloatArray
    """[m], shape (3,)."""
    lower: float
    upper: float


def draw_error(
    parts: Sequence[Part], truth: ShownJoint, guess: ShownJoint | None, captions: tuple[str, str], config: PreviewConfig
) -> Image.Image:
    """Draw the joint as it is and as it was said to be; the moving part is orange, the one that it hangs on blue.

    Args:
        parts: In the pose that was shown.
        truth: The true joint.
        guess: The one that was inferred above the same part; None where the part was taken for the base.
        captions: Above the two panels.
        config: Quality.
    """
    diagonal = float(np.linalg.norm(np.ptp(np.concatenate([part.bounds for part in parts]), axis=0)))
    scenes = [_scene(parts, joint, truth.child, diagonal) for joint in (truth, guess)]
    azimuth = _best_azimuth(scenes, truth, config)
    camera = camera_for(scenes, azimuth, config, size=_SIZE, margin=_MARGIN)
    sheet = Image.new("RGB", (2 * _SIZE[0], _SIZE[1] + _CAPTION), tuple(np.round(BACKGROUND * 255).astype(int)))
    draw = ImageDraw.Draw(sheet)
    for index, (scene, caption) in enumerate(zip(scenes, captions, strict=True)):
        sheet.paste(render_scene(scene, camera, config), (index * _SIZE[0], _CAPTION))
        place = (index * _SIZE[0] + _SIZE[0] // 2, _CAPTION // 2 + 2)
        draw.text(place, caption, fill=_INK, font=ImageFont.load_default(13), anchor="mm")
    return sheet


def _scene(parts: Sequence[Part], joint: ShownJoint | None, child: int, diagonal: float) -> PictureScene:
    moved = set() if joint is None else _subtree(joint.parents, joint.child)
    parent = -1 if joint is None else joint.parents.get(joint.child, -1)
    T_moved = np.eye(4) if joint is None else _motion(joint, diagonal)
    meshes = []
    for index in sorted(range(len(parts)), key=lambda index: index != child):  # the moving part first
        part = parts[index]
        vertices = part.vertices @ T_moved[:3, :3].T + T_moved[:3, 3] if index in moved else part.vertices
        color = _CHILD if index == child else _PARENT if index == parent else _REST
        meshes.append(PosedMesh(vertices=vertices, faces=part.faces, color=color))
    arrows = () if joint is None or joint.kind is JointType.FIXED else (_arrow(parts[child], joint, T_moved, diagonal),)
    return PictureScene(meshes=tuple(meshes), glyphs=arrows)


def _subtree(parents: Mapping[int, int], top: int) -> set[int]:
    """A part with all that hangs on it."""
    found = {top}
    while more := {part for part, above in parents.items() if above in found and part not in found}:
        found |= more
    return found


def _motion(joint: ShownJoint, diagonal: float) -> FloatArray:
    """How the joint moves its part, shape (4, 4): towards the larger limit, by as much as a picture needs."""
    end = joint.upper if joint.upper >= -joint.lower else joint.lower
    most = _MOVED_TURN if joint.kind.turns else _MOVED_SLIDE * diagonal
    return joint_motion(joint.kind, joint.axis, joint.pivot, float(np.clip(end, -most, most)))


def _arrow(part: Part, joint: ShownJoint, T_moved: FloatArray, diagonal: float) -> PosedMesh:
    used = part.vertices[part.faces.reshape(-1)]
    along = (used - joint.pivot) @ joint.axis
    low, high = float(along.min()), float(along.max())
    length = float(np.clip(1.15 * (high - low), 0.25 * diagonal, 0.8 * diagonal))
    if joint.kind is JointType.PRISMATIC:
        middle = 0.5 * (used.min(axis=0) + used.max(axis=0))
        vertices, faces = sliding_arrow(middle, joint.axis, length, _ARROW_RADIUS * diagonal)
    else:
        center = joint.pivot + 0.5 * (low + high) * joint.axis
        sweep = float(np.deg2rad(250.0))
        vertices, faces = turning_arrow(center, joint.axis, length, _ARROW_RADIUS * diagonal, sweep)
    moved = vertices @ T_moved[:3, :3].T + T_moved[:3, 3]
    return PosedMesh(vertices=moved, faces=faces, color=GLYPH_COLORS[joint.kind])


def _best_azimuth(scenes: Sequence[PictureScene], truth: ShownJoint, config: PreviewConfig) -> float:
    """The side from which the part is seen best in both scenes, and the true axis is not seen end on [rad]."""

    def worth(azimuth: float) -> float:
        probe = camera_for(scenes, azimuth, config, size=(config.probe_pixels, config.probe_pixels), margin=2.0)
        seen = sum(float(np.sqrt(scene.visible_pixels(probe)[0])) for scene in scenes)
        return seen * (0.6 + 0.4 * float(np.sqrt(1.0 - min(abs(float(truth.axis @ probe.forward)), 1.0) ** 2)))

    step = 2.0 * np.pi / config.azimuths
    return max((step * (index + 0.66) for index in range(config.azimuths)), key=worth)


_PREVIEW = {"openness_rays": 6, "probe_pixels": 60, "azimuths": 10}  # small pictures, in a second each
_QUALITY = 72  # of WebP: about 10 kB each
_DOUBTFUL = 0.5


@dataclass(frozen=True, kw_only=True)
class WrongJoint:
    """A joint in the run in which it is worst."""

    run: JobResult
    joint: JointScore
    runs: int
    """In how many runs of its object it is wrong."""
    of: int
    """Runs of its object."""


def wrong_joints(results: Iterable[JobResult]) -> list[WrongJoint]:
    """Every joint that is wrong in some run, the worst first.

    Worst is what hangs on the wrong part, then the wrong type, then the larger angle, then the farther line.
    """
    groups: dict[tuple[str, str, str, str], list[tuple[JobResult, JointScore]]] = {}
    for result in results:
        for joint in result.score.joints if result.score is not None else ():
            groups.setdefault((result.object, joint.joint, result.variant, result.input), []).append((result, joint))
    found = []
    for group in groups.values():
        wrong = [(run, joint) for run, joint in group if not is_right(joint, _diagonal(run))]
        if wrong:
            run, joint = max(wrong, key=lambda pair: _badness(*pair))
            found.append(WrongJoint(run=run, joint=joint, runs=len(wrong), of=len(group)))
    return sorted(found, key=lambda item: (_badness(item.run, item.joint), item.run.object), reverse=True)


def write_error_gallery(
    report: Report[JobResult],
    request: BenchmarkRequest,
    folder: Path,
    *,
    name: str,
    count: int,
    progress: Callable[[str, float], None] | None = None,
) -> Path:
    """Write ``<name>.md`` with a picture per joint below ``<name>/``; what an earlier call wrote is replaced.

    Args:
        report: What `run_benchmark` returned.
        request: What it was asked for.
        folder: Made if need be.
        name: Of the page.
        count: How many joints are shown.
        progress: Called with the object and the share done.

    Raises:
        OutputError: The folder cannot be written.
    """
    wrong = wrong_joints(report.records)
    jobs = {(job.item.name, job.condition.name, job.variant, job.input): job for job in jobs_of(request)}
    pictures = folder / name
    try:
        shutil.rmtree(pictures, ignore_errors=True)
        pictures.mkdir(parents=True)
        seen: dict[tuple[str, ...], _Seen] = {}
        sections = []
        for number, item in enumerate(wrong[:count], start=1):
            if progress is not None:
                progress(f"picture of {item.run.object}, {item.joint.joint}", (number - 1) / count)
            key = (item.run.object, item.run.condition, item.run.variant, item.run.input)
            if key not in seen:
                seen[key] = _seen(jobs[key])
            sections.append(_section(item, seen[key], number, pictures))
        page = folder / f"{name}.md"
        title = f"{name}: the worst {min(count, len(wrong))} of {len(wrong)} wrong joints"
        replace_text(page, document(report.header, title, [*_blocks(report, wrong), *sections]))
    except OSError as error:
        raise OutputError(
            f"The gallery of errors cannot be written to {folder}: {error}. Give a folder that can be written."
        ) from error
    return page


def _diagonal(run: JobResult) -> float:
    return 1.0 if run.score is None else run.score.diagonal


def _badness(run: JobResult, joint: JointScore) -> tuple[bool, bool, float, float]:
    line = 0.0 if joint.line_m is None else joint.line_m / _diagonal(run)
    return not joint.matched, not joint.type_right, round(joint.angle_deg, 1), line


def _fault(run: JobResult, joint: JointScore) -> str:
    """The largest fault of a joint, in a word or two."""
    if not joint.matched:
        return "wrong parent"
    if not joint.type_right:
        return f"{joint.predicted_kind} instead of {joint.kind}"
    if joint.angle_deg > CLOSE_ANGLE:
        return "axis points elsewhere"
    return "axis runs elsewhere"


# ---- one joint -----------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True, eq=False)
class _Seen:
    """A job that was inferred again."""

    job: Job
    inference: Inference
    truth: Mapping[str, TrueJoint]
    parents: Mapping[int, int]
    """Of the truth, by index of `inference.assembly`."""
    index: Mapping[int, int]
    """Part of the truth -> part of the inference."""


def _seen(job: Job) -> _Seen:
    erased = erased_item(job.item, job.condition)
    assembly = shown_parts(erased)
    given = degraded(job, assembly)
    inference = infer(assembly if given is None else given.assembly, config=job.config)
    place = {name: index for index, name in enumerate(inference.assembly.names)}
    index = {number: place[name] for number, name in enumerate(erased.truth.part_names)}
    return _Seen(
        job=job,
        inference=inference,
        truth={joint.name: joint for joint in erased.truth.joints},
        parents={index[part]: -1 if above < 0 else index[above] for part, above in enumerate(erased.truth.parents)},
        index=index,
    )


def _section(item: WrongJoint, seen: _Seen, number: int, pictures: Path) -> str:
    truth = seen.truth[item.joint.joint]
    child, parent = seen.index[truth.child], seen.index[truth.parent]
    assembly, tree = seen.inference.assembly, seen.inference.trees[0]
    guess = next((joint for joint in seen.inference.joints if joint.child == child), None)
    captions = (f"truth: {truth.kind}", "inferred: the base" if guess is None else f"inferred: {guess.kind}")
    shown = _shown(dict(enumerate(tree.parents)), guess, child) if guess is not None else None
    preview = seen.job.config.preview.model_copy(update=_PREVIEW)
    picture = draw_error(assembly.parts, _shown(seen.parents, truth, child), shown, captions, preview)
    picture.save(pictures / f"{number:02d}.webp", quality=_QUALITY, method=6)
    given = "" if item.run.input == CLEAN else f", {item.run.input}"
    lines = [
        f"## {number}. {item.run.object}, {item.joint.joint}: {_fault(item.run, item.joint)}",
        f"![{item.run.object}, {item.joint.joint}: truth and inference]({pictures.name}/{number:02d}.webp)",
        f"Shown: {item.run.condition}{given}; wrong in {item.runs} of {item.of} runs. {_facts(item)}\n"
        + _described(guess, parent, truth, assembly),
    ]
    return "\n\n".join(lines)


def _shown(parents: Mapping[int, int], joint: TrueJoint | JointEstimate, child: int) -> ShownJoint:
    return ShownJoint(
        parents=parents, child=child, kind=joint.kind, axis=joint.axis, pivot=joint.pivot,
        lower=joint.lower, upper=joint.upper,
    )  # fmt: skip


def _facts(item: WrongJoint) -> str:
    line = ""
    if item.joint.line_m is not None:
        line = f", line {100 * item.joint.line_m / _diagonal(item.run):.1f} % of the diagonal off"
    return f"Axis {item.joint.angle_deg:.1f} deg off{line}."


def _described(guess: JointEstimate | None, parent: int, truth: TrueJoint, assembly: Assembly) -> str:
    """What the inference said, and whether it had the right answer among its candidates."""
    if guess is None:
        return "The part was taken for the base."
    said = f"Confidence {guess.confidence:.0%}. "
    if guess.parent != parent:
        return f"{said}It hangs on {assembly.names[guess.parent]}, in truth on {assembly.names[parent]}."
    place = _place_of_truth(guess, truth, assembly.diagonal)
    return said + (f"The right one was candidate {place}." if place else "The right one was no candidate.")


def _place_of_truth(guess: JointEstimate, truth: TrueJoint, diagonal: float) -> int:
    """Place of the first candidate of the right type and axis, from 1; 0 if there is none."""
    for place, candidate in enumerate(guess.alternatives, start=1):
        if candidate.kind.turns == truth.kind.turns and axis_angle(truth.axis, candidate.axis) <= CLOSE_ANGLE:
            offset = np.cross(candidate.pivot - truth.pivot, truth.axis)
            if not truth.kind.turns or np.linalg.norm(offset) <= CLOSE_LINE * diagonal:
                return place
    return 0


# ---- all of them ---------------------------------------------------------------------------------------------------


def _blocks(report: Report[JobResult], wrong: Sequence[WrongJoint]) -> list[str]:
    runs = [result for result in report.records if result.score is not None]
    joints = {
        (run.object, joint.joint, run.variant, run.input) for run in runs if run.score for joint in run.score.joints
    }
    return [
        (
            "A joint is wrong if it hangs on the wrong part, has the wrong type (continuous counts as revolute), or "
            f"its axis is off by more than {CLOSE_ANGLE:.0f} deg or runs more than {CLOSE_LINE:.0%} of the diagonal "
            "away. Orange: the part that moves, moved. Blue: what it hangs on. Red arrows turn, blue ones slide."
        ),
        f"{len(wrong)} of {len(joints)} joints are wrong in at least one run. {_patterns(wrong)}",
    ]


def _patterns(wrong: Sequence[WrongJoint]) -> str:
    """What the errors have in common, in numbers."""
    if not wrong:
        return ""
    faults = Counter(_fault(item.run, item.joint) for item in wrong)
    objects = Counter(item.run.category for item in wrong)
    always = sum(item.runs == item.of for item in wrong)
    doubtful = sum(item.joint.confidence is not None and item.joint.confidence < _DOUBTFUL for item in wrong)
    return (
        f"By fault: {_counted(faults)}. By kind of object: {_counted(objects)}. {always} are wrong in every run, the "
        f"others only in some. {doubtful} had a confidence below {_DOUBTFUL:.0%}: `infer` names them to be looked at."
    )


def _counted(counter: Counter[str]) -> str:
    return ", ".join(f"{word} {number}" for word, number in counter.most_common())
