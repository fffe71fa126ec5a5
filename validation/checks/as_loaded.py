"""KV8xx: the untouched file in engines with their defaults, as everybody loads it."""

from __future__ import annotations

import re
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.mesh_paths import GLTF_SUFFIXES
from kinematify.simulation.engine import Unloadable
from kinematify.simulation.engine_runs import poses, script
from kinematify.validation.check import CauseScope, OpenCheck, check
from kinematify.validation.checks.shared import AT_REST, NOT_A_BODY, late
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.robot.mechanism import Travel
    from kinematify.simulation.engine_runs import EngineRun, Overlap
    from kinematify.validation.as_loaded_context import AsLoadedContext, VelocityProbe

_RUNS = attrgetter("runs")
_PIECES = (
    "Write convex pieces as collision geometry of {0} and {1} that keep clear of each other along the motion; "
    "kinematify fix MODEL.urdf -o OUT does so."
)
_TOUCHING = 1e-4
"""Contacts that are not as deep are no overlap that anybody sees [m]."""
STILL = "does not move: "
"""Before the name of a joint: what KV804 measured of it, in the file loaded without flags."""
_MESH_REFUSED = re.compile(r"no decoder found for mesh|invalid mesh filename extension")
"""What engines say of meshes in a format that they do not read."""
_READS = {
    "mujoco": "OBJ, STL and MSH",
    "pybullet": "OBJ, STL and DAE",
}
"""Formats of meshes, by engine."""
_SAME_PLACE = 1e-4
"""Distance of a link from where the file puts it, in sizes of the model, and angle [rad]; engines agree to 1e-7."""
_FLOOR_OF_ENERGY = 1e-5
"""Growth that does not count, fraction of the energy of a fall of the whole model by its own size."""
_SUFFIX = re.compile(r"\.(?:glb|gltf|stl|dae|ply|obj|3mf|off)\b", re.IGNORECASE)


def not_loaded(context: AsLoadedContext) -> str | None:
    """The engine has the file."""
    if isinstance(context.loading, Unloadable) and context.loading.floats and context.floats:
        return f"the file lets a link float in {context.title}, where no joint can be pushed alone"
    return f"{context.title} does not open the file (KV801)" if isinstance(context.loading, Unloadable) else None


def nothing_moves(context: AsLoadedContext) -> str | None:
    """A joint that the engine moves."""
    return None if context.travels else "no joint moves"


def _open_chains(context: AsLoadedContext) -> str | None:
    """No chain that closes: engines hold it closed by springs."""
    return "no engine says what energy the springs hold that close its chains" if context.robot.loops else None


@check(
    "KV801",
    title="As loaded: the engine opens the file",
    fails="As loaded: the engine does not open the file as it is",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    runs_in=bool,
    follows={**dict.fromkeys(NOT_A_BODY, CauseScope.BODY), "KV138": CauseScope.MODEL, "KV221": CauseScope.JOINT},
)
def opens(result: OpenCheck, context: AsLoadedContext) -> None:
    """The untouched file, loaded with the engine's own defaults (`MjModel.from_xml_path`; `loadURDF` with a fixed
    base; `buildModelFromUrdf`), is there with every joint that moves, and with its limits. Like all of KV8xx it is an
    error if it fails in every engine, or in one of those that `--engines` names, else a warning. So is a file that an
    engine opens only from a copy with absolute paths of its meshes; findings of the others name that copy then.

    Why it matters: This is what users load.

    Remedy: Do what the engine's message asks for. MuJoCo resolves no package:// and reads STL, OBJ and MSH only; it
    looks for meshes beside the file unless `<mujoco><compiler strippath="false"/></mujoco>` is in it.
    """
    if isinstance(context.loading, Unloadable) and context.loading.floats and context.floats:
        return
    if isinstance(context.bare, Unloadable) and not isinstance(context.loading, Unloadable):
        result.find(
            f"{context.title} does not open the file as it is: {context.bare}. It opens a copy with "
            f"{context.copied}, of which its other findings are.",
            _remedy_of_loading(context, str(context.bare))
            if context.native is None
            else "Put the file that the message names there, or remove what names it.",
            severity=Severity.WARNING,
            cause=Cause.ENGINE,
            reproduction=context.bare.reproduction,
        )
    if isinstance(context.loading, Unloadable):
        result.find(
            f"{context.title} does not open the file as it is: {context.loading}.",
            _remedy_of_loading(context, str(context.loading)),
            reproduction=context.loading.reproduction,
            link=_named_link(context, str(context.loading)),
        )
        return
    result.measured["joints"] = float(len(context.mechanism.joints))
    for name in context.lost:
        result.find(
            f"The joint {name} of the file does not move in {context.opened}, which has lost it or taken it for fixed.",
            f"Write the joint {name} with a type, axis and limits that {context.title} reads.",
            joint=name,
            reproduction=script(context.loaded, "joints"),
        )
    result.measured["read"] = float(len(context.mechanism.joints) - len(context.lost) - len(context.misread))
    for joint in context.misread:
        lower, upper = context.loaded.limits[joint.name]
        loaded = f"{lower:.4g} to {upper:.4g}" if np.isfinite([lower, upper]).all() else "none"
        result.find(
            f"The joint {joint.name} has the limits {joint.lower:.4g} to {joint.upper:.4g} in the file, and {loaded} "
            f"in {context.opened}.",
            f"Give {joint.name} a lower limit that is less than the upper one; what does not move has a fixed joint.",
            joint=joint.name,
            reproduction=script(context.loaded, "joints"),
        )


def _named_link(context: AsLoadedContext, message: str) -> str | None:
    """Return the link that an engine's message is about; None if it names none in quotes."""
    return next((name for name in re.findall(r"'([^']+)'", message) if name in context.mechanism.links), None)


def _remedy_of_loading(context: AsLoadedContext, message: str) -> str:
    text = context.request.urdf.read_text(encoding="utf-8", errors="replace").lower()
    if _MESH_REFUSED.search(message) and context.engine in _READS:
        return _remedy_of_format(context, message)
    if "\\" in text and "\\" in message:
        return (
            "Write / instead of \\ in the paths of meshes, relative to the file; kinematify fix MODEL.urdf -o OUT.urdf "
            "writes them so."
        )
    if context.engine == "mujoco" and "package://" in text:
        return (
            "Write paths relative to the file instead of package://, which MuJoCo does not resolve, and add "
            '<mujoco><compiler strippath="false"/></mujoco>; kinematify fix MODEL.urdf -o OUT.urdf writes the paths.'
        )
    if context.engine == "mujoco" and "strippath" not in text and "error opening file" in message.lower():
        return 'Add <mujoco><compiler strippath="false"/></mujoco>: MuJoCo drops the folders of mesh files else.'
    if "balanceinertia" in message:
        return (
            "Compute the inertia of that link from its geometry (KV205), or let MuJoCo round it: "
            '<mujoco><compiler balanceinertia="true"/></mujoco>.'
        )
    return f"Correct the element of the file that the message of {context.title} is about; it stops every load there."


def _remedy_of_format(context: AsLoadedContext, message: str) -> str:
    """Return what to do with a mesh in a format that the engine does not read."""
    given = _SUFFIX.findall(message)
    suffix = given[-1].lower() if given else "another format"
    said = f"{context.title} reads {_READS[context.engine]} meshes, not {suffix}: export them as .obj or .stl"
    if suffix in GLTF_SUFFIXES:
        return f"{said}; kinematify fix MODEL.urdf -o OUT.urdf writes such copies."
    return f"{said} and name those in the file."


@check(
    "KV802",
    title="As loaded: nothing overlaps at rest",
    fails="As loaded: links overlap at rest",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    runs_in=_RUNS,
    follows={**AT_REST, "KV802": CauseScope.PAIR},
    needs=(not_loaded,),
)
def no_overlap(result: OpenCheck, context: AsLoadedContext) -> None:
    """In the untouched file at rest, no two links that the engine lets touch and that joints move against each other
    are in each other by more than as_loaded.overlap of the model's size, at least as_loaded.overlap_length. PyBullet is
    asked with `URDF_USE_SELF_COLLISION`, see KV804.

    Why it matters: Engines push such links apart: parts jump, jam, or tremble.

    Remedy: Write convex pieces as collision geometry; engines take the hull of every mesh.
    """
    limit = max(context.settings.overlap * context.size, context.settings.overlap_length)
    result.measured["deepest"] = max((item.depth for item in context.overlaps), default=0.0)
    for overlap in context.overlaps:
        if overlap.depth > limit:
            result.find(
                f"At rest {overlap.links[0]} and {overlap.links[1]} are {overlap.depth * 1e3:.3g} mm deep in each "
                f"other as {context.how} loads the file.",
                _PIECES.format(*overlap.links),
                pair=overlap.links,
                value=overlap.depth,
                limit=limit,
                unit="m",
                reproduction=script(context.loaded, "overlap", context.values, links=overlap.links),
            )


@check(
    "KV803",
    title="As loaded: left alone, joints stay in range and are not thrown",
    fails="As loaded: left alone, a joint leaves its range or is thrown",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    runs_in=_RUNS,
    follows={**AT_REST, "KV802": CauseScope.CONTACT, "KV803": CauseScope.JOINT},
    needs=(not_loaded, nothing_moves, late),
)
def stays(result: OpenCheck, context: AsLoadedContext) -> None:
    """For as_loaded.seconds under gravity nothing is done to the untouched file. No joint that would stay where it is
    without contacts is moved by them by more than as_loaded.still of its range (at least as_loaded.still_angle or
    as_loaded.still_length), none ends beyond its range by more, and all values stay numbers. What gravity moves may
    move: an arm without servos sags. PyBullet's motors are as they are; it is asked with `URDF_USE_SELF_COLLISION`, and
    what plain `loadURDF` does not show is a warning, see KV804.

    Why it matters: A drawer that jumps out of its cabinet when a scene is loaded is of no use.

    Remedy: Write convex pieces as collision geometry that keep clear of each other, and plausible masses and limits.
    """
    complaint = context.passive_run.complaint
    if complaint is not None:
        result.find(
            f"Left alone, the model comes apart in {context.opened}: {complaint}.",
            "Give every moving link a plausible mass and inertia, and fix overlaps at rest first.",
            severity=_at_most_warning(context, plainly=context.left_without_contacts.complaint is not None),
            reproduction=script(
                context.loaded, "rest", context.values, joint=context.travels[0].joint, seconds=context.settings.seconds
            ),
        )
        return
    for travel in context.travels:
        if _leaves(context, travel):
            _find_leaving(result, context, travel)


def _leaves(context: AsLoadedContext, travel: Travel) -> bool:
    """True if contacts move a joint that nothing else moves, or it ends beyond its range."""
    return _thrown_by(context, travel) is not None or _beyond(context, travel) > context.still(travel)


def _leaves_plainly(context: AsLoadedContext, travel: Travel) -> bool:
    """The same of the file loaded without flags."""
    if context.flag is None:
        return _leaves(context, travel)
    return _beyond(context, travel, context.left_without_contacts) > context.still(travel)


def _at_most_warning(context: AsLoadedContext, *, plainly: bool) -> Severity | None:
    """Return what an engine shows only with a flag that its users have to ask for is no error."""
    return None if context.flag is None or plainly else Severity.WARNING


def _thrown_by(context: AsLoadedContext, travel: Travel) -> Overlap | None:
    """Return the overlap at rest that moves a joint which stays where it is without contacts."""

    def stays_in(run: EngineRun) -> bool:
        return float(np.abs(context.way(run, travel) - travel.rest).max()) <= context.still(travel)

    thrown = not stays_in(context.passive_run) and stays_in(context.left_without_contacts)
    return context.between(travel, context.overlaps) if thrown else None


def _beyond(context: AsLoadedContext, travel: Travel, run: EngineRun | None = None) -> float:
    """Return how far beyond its range a joint ends that was left alone [rad or m]; 0 without limits."""
    last = float(context.way(run or context.passive_run, travel)[-1])
    return max(travel.lower - last, last - travel.upper) if travel.limited else 0.0


def _find_leaving(result: OpenCheck, context: AsLoadedContext, travel: Travel) -> None:
    overlap, beyond = _thrown_by(context, travel), _beyond(context, travel)
    values = context.way(context.passive_run, travel)
    farthest = float(values[np.abs(values - travel.rest).argmax()])
    way = abs(farthest - travel.rest)
    if overlap is not None:
        said = (
            f"contacts move it by {way:.3g} {travel.unit}, without them it rests; {overlap.links[0]} and "
            f"{overlap.links[1]} are {overlap.depth * 1e3:.3g} mm deep in each other"
        )
        remedy = _PIECES.format(*overlap.links)
    else:
        said = f"it ends {beyond:.3g} {travel.unit} beyond its range {travel.lower:.4g} to {travel.upper:.4g}"
        remedy = "Write masses that the limits can hold, and collision geometry that is clear of other links at rest."
    result.find(
        f"Left alone for {context.settings.seconds:g} s in {context.how}, joint {travel.joint} does not stay: {said}.",
        remedy,
        severity=_at_most_warning(context, plainly=_leaves_plainly(context, travel)),
        joint=travel.joint,
        pair=None if overlap is None else overlap.links,
        q={travel.joint: farthest},
        value=farthest,
        unit=travel.unit,
        reproduction=script(
            context.loaded, "rest", context.values, joint=travel.joint, seconds=context.settings.seconds
        ),
    )


@check(
    "KV804",
    title="As loaded: a hand moves each joint over its range",
    fails="As loaded: a hand cannot move a joint over its range",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    runs_in=_RUNS,
    follows={**AT_REST, "KV802": CauseScope.CONTACT, "KV803": CauseScope.CONTACT, "KV804": CauseScope.JOINT},
    needs=(not_loaded, nothing_moves, late),
)
def moves(result: OpenCheck, context: AsLoadedContext) -> None:
    """In the untouched file each joint is pushed from rest to both ends by as_loaded.force or as_loaded.torque on top
    of declared friction and damping, its followers with it, the others held, gravity off. It has to reach
    as_loaded.reach of what exact geometry, colliding and visible, leaves free of its range, of the whole range where
    that is not known. In an MJCF, what leads others along a curve is not pushed (KV230). Where another body ends the
    way, not a limit, as_loaded.touch_angle or as_loaded.touch_length may be missing, half of the way at most: engines
    let bodies touch before they meet. What does not get there without contacts either, or has no free way at all
    (KV31x), is a note; what gets over half of its way a warning.
    Plain `loadURDF` of PyBullet lets links pass through each other, and the first line of the report counts what moves
    so, pushed or by its own motor. It is asked with `URDF_USE_SELF_COLLISION` besides, but for neighbours across fixed
    joints (as with `URDF_MERGE_FIXED_LINKS`) and links that the file declares not to collide with their model
    (`<selfCollide>`): what only that flag shows is a warning at most, and the second line counts it.

    Why it matters: A drawer that jams in the simulator is of no use, whatever its surfaces would allow.

    Remedy: Write convex pieces as collision geometry of the links that are named, clear of each other along the motion.
    """
    short = [run for run in context.hands if not context.reaches_end(run, run.pushed.farthest)]
    stuck = [run for run in short if not context.moves_by_motor(run)]
    left_plainly = context.passive_run if context.flag is None else context.left_without_contacts
    names = [travel.joint for travel in context.mechanism.travels if travel.joint not in context.closed]
    result.measured["joints"] = float(len(names))
    moving = _moving(context, stuck, left_plainly.complaint, _leaves_plainly)
    result.measured["right"] = float(len(moving))
    result.measured |= {f"{STILL}{name}": 1.0 for name in names if name not in moving}
    if context.flag is not None:
        with_contacts = _moving(context, short, context.passive_run.complaint, _leaves)
        result.measured["with_contacts"] = float(len(with_contacts))
    for run in short:
        _find_short(result, context, run, jammed=context.free_without_contacts(run))


def _moving(
    context: AsLoadedContext,
    short: Sequence[VelocityProbe],
    complaint: str | None,
    leaves: Callable[[AsLoadedContext, Travel], bool],
) -> set[str]:
    """Names of the joints that a hand moves and nothing throws."""
    right = {run.travel.joint for run in context.hands} - {run.travel.joint for run in short}
    return right - {travel.joint for travel in context.travels if complaint or leaves(context, travel)}


def _find_short(result: OpenCheck, context: AsLoadedContext, run: VelocityProbe, *, jammed: bool) -> None:
    travel, push, stop = run.travel, run.push, run.pushed.farthest
    found = context.stopped_by(run) if jammed else None
    pair = None if found is None else found[0].links
    unit = "N m" if travel.turns else "N"
    said = (
        f"Pushed with up to {push.force:.3g} {unit} from {travel.rest:.4g} towards {run.end:.4g} {travel.unit} in "
        f"{context.how}, gravity off and the others held, joint {travel.joint} gets to {_shown(stop)} {travel.unit}"
    )
    severity = _severity(run) if jammed else Severity.NOTE
    result.find(
        f"{said}: {_cause(found, run, jammed=jammed)}.",
        f"Check damping, friction, mass and limits of {travel.joint}." if pair is None else _PIECES.format(*pair),
        joint=travel.joint,
        pair=pair,
        severity=severity or _at_most_warning(context, plainly=False),
        q={travel.joint: stop if found is None else found[1]},
        value=stop,
        limit=run.end,
        unit=travel.unit,
        reproduction=script(context.loaded, "push", run.values, push=(push, run.pushed.steps)),
    )


def _severity(run: VelocityProbe) -> Severity | None:
    """Return the severity of contacts that keep a joint from its end: a warning if it gets over half of the way."""
    if not run.free:
        return Severity.NOTE
    way = abs(run.end - run.travel.rest)
    return Severity.WARNING if abs(run.pushed.farthest - run.travel.rest) > 0.5 * way else None


def _cause(found: tuple[Overlap, float] | None, run: VelocityProbe, *, jammed: bool) -> str:
    if not jammed:
        return "contacts are not the reason, without them it gets no farther"
    if found is None:
        return "without contacts it gets to the end"
    (first, second), depth, value = found[0].links, found[0].depth, found[1]
    where = "there" if value == run.pushed.farthest else f"at {_shown(value)} {run.travel.unit}"
    if depth < _TOUCHING:
        return f"{where} {first} and {second} touch"
    return f"{where} {first} and {second} are {depth * 1e3:.3g} mm deep in each other"


def _shown(value: float) -> str:
    """A value of a joint without the rounding errors of an engine."""
    return f"{round(value, 6) + 0.0:.4g}"


@check(
    "KV805",
    title="As loaded: limits hold under load",
    fails="As loaded: a joint is pressed through its limit",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    runs_in=_RUNS,
    follows={
        **dict.fromkeys(("KV221", "KV801"), CauseScope.JOINT),
        **dict.fromkeys(("KV204", "KV205", "KV207"), CauseScope.BODY),
    },
    needs=(not_loaded, nothing_moves, late),
)
def holds_limits(result: OpenCheck, context: AsLoadedContext) -> None:
    """In the untouched file each joint that declares limits and an effort is pressed against both by as_loaded.force or
    as_loaded.torque, by its effort if that is less, and by no more than brings it up to the hand's speed in
    as_loaded.press: nothing moves there that friction and damping would hold back. The others are held, without
    contacts and gravity. It gives way by no more than as_loaded.still of its range (at least as_loaded.still_angle or
    as_loaded.still_length). A limit that gives way and holds then is a warning, and so are equal limits: files write 0
    and 0 where no range is meant.

    Why it matters: A range that an engine does not keep is none: MuJoCo takes limits that are equal for no limits.

    Remedy: Write a lower limit that is less than the upper one, a fixed joint where nothing moves, a plausible mass.
    """
    for run in context.presses:
        travel, end, stop = run.travel, run.values[run.travel.joint], run.pushed.farthest
        if abs(stop - end) > context.still(travel):
            through = abs(stop - end) >= abs(run.push.target - end)
            unit = "N m" if travel.turns else "N"
            result.find(
                f"Pressed with {run.push.force:.3g} {unit}, within its effort, against its limit of {end:.4g} "
                f"{travel.unit} in {context.opened}, joint {travel.joint} gets to {stop:.4g} {travel.unit}"
                f"{' at least' if through else ''}.",
                f"Give {travel.joint} limits that {context.title} keeps (the lower one less than the upper one), or a "
                "part of plausible mass and inertia; a joint that does not move is a fixed one.",
                severity=None if through and travel.lower < travel.upper else Severity.WARNING,
                joint=travel.joint,
                q={travel.joint: stop},
                value=stop,
                limit=end,
                unit=travel.unit,
                reproduction=script(context.loaded, "push_alone", run.values, push=(run.push, run.pushed.steps)),
            )


@check(
    "KV806",
    title="As loaded: nothing gains energy",
    fails="As loaded: energy comes out of nothing",
    severity=Severity.ERROR,
    cause=Cause.ENGINE,
    runs_in=_RUNS,
    follows=NOT_A_BODY,
    needs=(not_loaded, nothing_moves, _open_chains, late),
)
def gains_no_energy(result: OpenCheck, context: AsLoadedContext) -> None:
    """In the untouched file all joints are given a hand's speed and let go for as_loaded.release_seconds, with the
    friction and damping of the file, without motors and contacts. The sum of kinetic and potential energy never grows
    by more than as_loaded.energy of the largest kinetic energy. What one engine alone gains is its time step's: a note
    if the file works in another one, else a warning. It is not asked of linkages.

    Why it matters: What gains energy by itself blows up, sooner or later, with whatever hangs on it.

    Remedy: Write positive damping, and masses and inertia tensors that belong to the shapes, for links without shapes
    too: PyBullet gives a link without them 1 kg.
    """
    run = context.released
    seconds = context.settings.release_seconds
    reproduction = script(context.loaded, "release", context.values, speeds=context.speeds, seconds=seconds)
    if run.complaint is not None:
        result.find(
            f"Given a push and let go in {context.opened}, the model comes apart: {run.complaint}.",
            "Give every moving link a plausible mass and inertia, and every joint a damping that is not negative.",
            cause=Cause.PHYSICS,
            reproduction=reproduction,
        )
        return
    total, kinetic = run.seen.sum(axis=1), float(run.seen[:, 1].max())
    growth = float(np.max(total - total[0]))
    limit = max(_FLOOR_OF_ENERGY * context.fall, context.settings.energy * kinetic)
    result.measured |= {"growth_J": max(0.0, growth), "kinetic_J": kinetic}
    if growth > limit:
        result.find(
            f"Given a push and let go in {context.opened}, the model gains {growth:.3g} J, "
            f"{growth / max(kinetic, 1e-12):.0%} of its largest kinetic energy.",
            "Correct inertia tensors and overlaps at rest, or simulate with a smaller time step.",
            value=growth,
            limit=limit,
            unit="J",
            reproduction=reproduction,
        )


@check(
    "KV807",
    title="As loaded: links are where the file puts them",
    fails="As loaded: an engine puts a link elsewhere",
    severity=Severity.ERROR,
    cause=Cause.ENGINE,
    runs_in=bool,
    follows={"KV107": CauseScope.JOINT, "KV801": CauseScope.JOINT},
    needs=(not_loaded,),
)
def puts_links_where_the_file_does(result: OpenCheck, context: AsLoadedContext) -> None:
    """With all joints at rest, at the lower and at the upper end, each link of the untouched file is where its own
    kinematics put it, within a ten thousandth of the model's size and of a radian: engines that agree with the file
    agree with each other. A finding is about the joint where the difference begins.

    Why it matters: A frame that an engine reads differently moves a part to another place without a message.

    Remedy: Write origins and axes as plain numbers, each axis as a unit vector, and a joint type that engines know.
    """
    from kinematify.robot.robot import forward_kinematics  # noqa: PLC0415 - for this only

    above, worst = context.robot.joint_above, dict[str, tuple[float, float, float, dict[str, float]]]()
    for values in context.ends:
        ours = forward_kinematics(context.robot, values)
        for link, pose in poses(context.loaded, values).items():
            off = pose[:3] - ours[link][:3]
            away = float(np.linalg.norm(off[:, 3]))
            turned = float(np.linalg.norm(off[:, :3])) / np.sqrt(2.0)  # 2 sin(angle / 2)
            share = max(away / (_SAME_PLACE * context.size), turned / _SAME_PLACE)
            result.measured["farthest"] = max(away, result.measured.get("farthest", 0.0))
            if share > worst.get(link, (0.0, 1.0))[1]:
                worst[link] = away, share, turned, values
    for link, (away, _, turned, values) in worst.items():
        if link in above and above[link].parent not in worst:
            result.find(
                f"{context.opened} puts the link {link} {away * 1e3:.3g} mm from where the file's kinematics put it, "
                f"turned by {np.degrees(2.0 * np.arcsin(min(turned / 2.0, 1.0))):.3g} deg.",
                f"Write the joint {above[link].name} with a unit axis, plain numbers and a type that engines know.",
                joint=above[link].name,
                link=link,
                q=values,
                value=away,
                limit=_SAME_PLACE * context.size,
                unit="m",
                line=above[link].line,
            )
