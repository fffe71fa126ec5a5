"""From a typed request to an object: built once, adjusted by small steps, and measured against the request once."""

from __future__ import annotations

import math
import re
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import combinations, permutations
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import ConvexHull

from kinematify.errors import InputError
from kinematify.generate.kind_search import key_of, lemma, words_of
from kinematify.generate.library.kind import checked
from kinematify.generate.procedural.clearance import carried_by, may_go
from kinematify.generate.procedural.materials import MATERIALS, of_one_material, surface_of
from kinematify.generate.procedural.parameter import pairs
from kinematify.generate.registry import build
from kinematify.generate.request import listed
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

    from kinematify.assembly.part import Part
    from kinematify.generate.library.kind import Kind
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
    from kinematify.generate.procedural.parameter import Parameter, Value
    from kinematify.generate.request import Opening, PartRequest, Request, Sizes
    from kinematify.robot.arrays import FloatArray

_NUMBERED = re.compile(r"(?:_(?:\d+|left|right))+$")
_AXES = {"width": 0, "depth": 1, "height": 2}
_SAME = 0.02  # of a size or a range, by which it may be off
_ASIDE = 0.02  # of the whole, by which a part is beside its middle
_UPRIGHT, _LEVEL = 0.95, 0.2  # of the z component of an axis
_MOTIONS = "spin lift slide pan tilt hinge"  # the narrower one first
_SPIN = 1.45 * math.pi  # [rad] that what spins turns by at least: a knob has three quarters of a turn
_LARGER = 30.0  # times as large or as small as usual the whole may be: toys
_ROUND = 0.06  # of a side, by which two sides of what is round differ
_FILLED = 0.87  # of its box, which the hull of a round part fills at most; a cylinder 0.785
_TOWARDS = 0.3  # of a way, that leads to a side
_FRONT = 0.8  # of the width and the height of the whole, that its front has at least
SHOWN = 0.5
"""Share of the surface that has the look of the whole at least."""
_CLOSES = ("door", "lid", "drawer", "flap")
_LARGE = 0.1  # of the surface, that what closes an opening has at least to have the look of the whole
OWN_LOOK = ("rubber", "glass", "mirror")
"""Materials that keep their look where the whole is to have another one."""
_SIDES = {"left": (0, -1), "right": (0, 1), "front": (1, -1), "back": (1, 1), "top": (2, 1), "bottom": (2, -1)}
"""Axis and sign of a side of the world."""
_PICKED = pairs("left left|right right|front front|back back|rear back|top top|upper top|bottom bottom|lower bottom")
_JOINTS = words_of("hinge slide tilt pan spin move")
"""Nouns that mean what moves so where no part is called so: what moves most of the object."""
_ALIKE = pairs(
    "wheel caster|backrest back|canopy hood|bonnet hood|hood bonnet|trunk tailgate|boot tailgate|cover lid cap|cap lid|"
    "cab cabin house|cabin cab house|boom jib|sail blade rotor|blade rotor|propeller rotor|rotor propeller|"
    "wing leaf|leaf sash door|casement sash|screen display lid|"
    "display screen|dial knob|"
    "handle lever|lever handle|arm lever|hand needle pointer|needle hand pointer|window pane sash vent|pane sash leaf|"
    "spout neck|rack tray shelf|tray rack|armrest arm|stem column|shade head|turntable plate|plate turntable|"
    "cymbal top|swing seat|barrel drum|drum barrel|foot base stand|stand base|pedestal base|disc base"
)
"""Noun -> what it may be where no part is called so."""
_BASE = words_of("body frame housing case casing cabinet")
"""Nouns that mean the base link where no part is called so."""
_HANDLES = tuple(words_of("handle knob pull grip"))
"""Ends of nouns of what has the look of all handles of an object."""
_APART = tuple(words_of("door drawer wheel lid flap window knob button shelf tray seat"))
"""Ends of nouns of parts that are bodies of their own, each; several pedals, legs or tines may be one."""
_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")


@dataclass(frozen=True, kw_only=True)
class BuildResult:
    """An object that was built as a request says."""

    blueprint: Blueprint
    request: Request | None = None
    differences: tuple[str, ...] = ()
    """What was asked for and is otherwise, one line each."""
    missing: tuple[str, ...] = ()
    """Names of parts of the request that the object does not have."""
    unmeasured: tuple[str, ...] = ()
    """Those and names of details of a body, or of what another name of the request means: nothing of them is known."""
    unread: tuple[str, ...] = ()
    """Words of a sentence that were not read, and that may matter."""
    notes: tuple[str, ...] = ()
    """Spelling that was repaired, and a kind that is only near."""
    facts: Mapping[str, Any] = field(default_factory=dict)
    """What else ``source.json`` says."""

    @property
    def is_complete(self) -> bool:
        """True if the object is what was asked for, as far as the request and the sentence tell."""
        return not (self.differences or self.unread)


def stem_of(name: str) -> str:
    """Return the name of a part without its number and side."""
    return _NUMBERED.sub("", name)


def names_called(family: Kind, blueprint: Blueprint, noun: str) -> list[str]:
    """Return the names of the parts that a noun means, e.g. ``door``, ``left door`` or ``third drawer``."""
    words = noun.lower().replace("_", " ").split()
    found, picked = _called(family, blueprint, noun), list[str]()
    if not found:
        picked = [word for word in words[:-1] if word in _PICKED or word in _ORDINALS]
        found = _called(family, blueprint, " ".join(word for word in words if word not in picked))
    if not found and len({stem_of(part.name) for part in _called(family, blueprint, words[-1])}) == 1:
        found = _called(family, blueprint, words[-1])
    for word in picked:
        if word in _ORDINALS:
            found.sort(key=lambda part: tuple(np.round(part.bounds.mean(axis=0)[[2, 0]], 3) * (-1, 1)))
            found = found[_ORDINALS.index(word) :][:1]
        elif len(found) == 1:
            found = found if _is_at(blueprint, [found[0].name], _PICKED[word]) else []
        elif found:
            axis, sign = _side(blueprint, _PICKED[word])
            places = [sign * float(part.bounds.mean(axis=0)[axis]) for part in found]
            middle = 0.5 * (min(places) + max(places))
            if max(places) - min(places) < _ASIDE:
                middle = sign * float(blueprint.assembly.bounds.mean(axis=0)[axis])
            if words[-1] == lemma(words[-1]):  # the top drawer of four
                middle = max(middle, max(places) - _ASIDE)
            found = [part for part, at in zip(found, places, strict=True) if at > middle]
    return [part.name for part in found]


def _called(family: Kind, blueprint: Blueprint, noun: str) -> list[Part]:
    wanted = _joined(noun)
    meant = {wanted, *(_joined(stem) for stem, said in family.part_words.items() if wanted in map(_joined, said))}
    if counted := count_parameter(family, noun):
        meant.update(map(_joined, counted.nouns))
    stems = {part.name: stem_of(part.name) for part in blueprint.parts}
    exact = [part for part in blueprint.parts if _joined(stems[part.name]) in meant]
    ends = [part for part in blueprint.parts if _joined(stems[part.name]).endswith(wanted)]
    others = _ALIKE.get(wanted, "").split()
    alike = [part for part in blueprint.parts if _joined(stems[part.name]) in others]
    base = list(blueprint.parts[:1]) if wanted in _BASE else []
    if (found := exact or ends or alike or base) or wanted not in _JOINTS:
        return found
    moving = [joint.child for joint in blueprint.joints if joint.mimic is None and moves_so(joint, wanted)]
    boxes = {part.name: part.bounds for part in blueprint.parts}
    room = {name: np.array([boxes[part] for part in carried_by(name, blueprint.joints)]) for name in moving}
    sizes = {name: float(np.prod(box[:, 1].max(axis=0) - box[:, 0].min(axis=0))) for name, box in room.items()}
    most = stem_of(max(moving, key=sizes.__getitem__, default=""))
    return [part for part in blueprint.parts if part.name in moving and stem_of(part.name) == most]


def _joined(name: str) -> str:
    return "".join(key_of(name.replace("_", " ")))


# ---- building ------------------------------------------------------------------------------------------------------


def deliver(request: Request, *, seed: int | None = None) -> BuildResult:
    """Build what is asked for and say what is otherwise.

    Args:
        request: Checked.
        seed: Draws what is not asked for.

    Raises:
        InputError: A parameter is out of its bounds, or nothing can be built.
    """
    family = request.family
    if (across := _across(family))[1:] and {"width", "length"} == request.size.keys() - {"height"}:
        own = {"width": across[0], "length": across[1]}  # how long is one of them
        size = {own.get(name, name): far for name, far in request.size.items()}
        request = request.model_copy(update={"size": size})
    values = dict(_values(family, request))
    made = build(family, values, seed=seed)
    if fitted := _refitted(family, made, request):
        with suppress(InputError):
            made = build(family, {**values, **fitted}, seed=seed)
    made = _sized(made, request)
    made, shown = _painted(made, *(str(request.parameters.get(look, "")) for look in ("material", "color")))
    if _mirror_helps(family, made, request):
        made = made.scaled(1.0, mirrored=True)
    missing, unmeasured = list[str](), list[str]()
    for noun, part in request.parts.items():
        names = _meant(made, names_called(family, made, noun), part)
        if names:
            made = _adjusted(made, noun, names, part)
        elif part.count != 0 and not _is_detail(family, noun, made):
            missing.append(noun)
    faults = list(_faults(family, made, request, missing, unmeasured))
    if shown < SHOWN:
        faults.append(f"look of the whole: as asked for on {100 * shown:.0f} % of the surface")
    return BuildResult(
        blueprint=made,
        request=request,
        differences=tuple(dict.fromkeys(faults)),
        missing=tuple(missing),
        unmeasured=(*missing, *unmeasured),
        facts={"request": request.model_dump(mode="json", exclude_defaults=True)},
    )


def closed(blueprint: Blueprint) -> Blueprint:
    """Return an object with all joints at the zero of their design."""
    return blueprint.moved({joint.child: -joint.value for joint in blueprint.joints})


def _values(family: Kind, request: Request) -> Iterator[tuple[str, Value]]:
    """Parameters of a kind that the request sets, by itself or by the sizes, counts and looks of parts.

    What a parameter cannot be is measured on the object.
    """
    known = {item.name: item for item in family.all_parameters}
    yield from request.parameters.items()
    wanted: list[tuple[str, Any]] = [(_size_parameter(family, name), size) for name, size in request.size.items()]
    for noun, part in request.parts.items():
        if counted := count_parameter(family, noun):
            wanted.append((counted.name, part.count))
        own = noun.replace(" ", "_")
        if part.count == 0 and "none" in getattr(known.get(own), "choices", ()):
            wanted.append((own, "none"))
        wanted += [(name, value) for size, value in part.size.items() for name in length_names(family, noun, size)]
        if noun.endswith(_HANDLES) and "handle" in known:
            wanted += [(f"handle_{look}", getattr(part, look)) for look in ("color", "material")]
        wanted.append(("hinge_side", part.hinge))
    for name, value in wanted:
        if name in known and value is not None and name not in request.parameters:
            with suppress(InputError):
                yield name, checked(family, name, value)


def count_parameter(family: Kind, noun: str) -> Parameter | None:
    """Return the parameter that counts parts of a noun; None if there is none."""
    counts = [item for item in family.parameters if isinstance(item.default, int)]
    return next((item for item in counts if key_of(noun) in map(key_of, (*item.nouns, item.name))), None)


def _is_detail(family: Kind, noun: str, made: Blueprint) -> bool:
    """True if a noun is what a parameter counts or chose, and no part: slots, or bars that are handles of drawers."""
    parameter = count_parameter(family, noun)
    if parameter:
        return int(made.parameters[parameter.name]) > 0 and not _called(family, made, noun)
    chosen = [(item.name, made.parameters[item.name]) for item in family.parameters if item.choices]
    return any(noun.rsplit(maxsplit=1)[-1] in said for said in chosen if said[1] not in ("none", "no"))


def length_names(family: Kind, noun: str, size: str) -> list[str]:
    """Return parameters that are a size of a part: ``door_height``, or ``blade`` for its length."""
    own = noun.replace(" ", "_")
    lengths = {item.name for item in family.parameters if item.unit == "m"}
    return [name for name in (f"{own}_{size}", own * (size == "length")) if name in lengths][:1]


def _across(family: Kind) -> list[str]:
    """Its width and depth, the smaller one first, of those that are parameters."""
    sides = {item.name: float(item.default) for item in family.parameters if item.name in ("width", "depth")}
    return sorted(sides, key=sides.__getitem__)


def _size_parameter(family: Kind, size: str) -> str:
    """Name of the parameter for a size of the whole; empty if there is none."""
    for item in family.parameters:
        if item.unit == "m" and size in (item.name, *item.words):
            return item.name
    return "" if size != "length" else (*_across(family)[1:], "")[0]


def _refitted(family: Kind, made: Blueprint, request: Request) -> dict[str, Value]:
    """Parameters that make a size of the whole what was asked for where a frame or a handle comes on top of them."""
    found: dict[str, Value] = {}
    for size, wanted in request.size.items():
        name = _size_parameter(family, size)
        own = made.parameters.get(name)
        if not isinstance(own, float) or name in request.parameters or fits_size(made, size, wanted):
            continue
        with suppress(InputError):
            found[name] = checked(family, name, own + wanted - _sizes(made, size)[0])
    return found


def sides_meant(family: Kind, lengths: Sequence[float]) -> Sequence[str]:
    """Return the names of some lengths of the whole [m] of which none is said.

    A single one is its length, its only size, or the largest of the object as it is usual. Of several, the width is
    first, unless another order fits the proportions of the kind much better; none of a single one far from usual.
    """
    known = [item.name for item in family.parameters if item.name in (*_AXES, "length", "diameter")]
    extents = dict(zip(_AXES, np.ptp(closed(build(family, {})).assembly.bounds, axis=0), strict=True))
    if len(lengths) == 1:
        usual = known[0] if len(known) == 1 else max(extents, key=extents.__getitem__)
        fits = 0.2 < lengths[0] / max(extents.values()) < 5.0
        return ["length" if "length" in known else usual] if fits else []

    def misfit(names: tuple[str, ...]) -> float:
        off = sum(abs(math.log(far / extents[name])) for name, far in zip(names, lengths, strict=True))
        return off + 0.5 * (names != tuple(_AXES)[: len(names)])

    return min(permutations(_AXES, len(lengths)), key=misfit)


def fits_size(made: Blueprint, size: str, wanted: float) -> bool:
    """Return True if all of an object, closed, or its base link is so wide, high or the like [m]."""
    return any(_same(wanted, there) for there in _sizes(made, size))


def size_faults(made: Blueprint, size: Sizes) -> Iterator[str]:
    """Return which sizes of the whole, closed, are otherwise than asked for [m], in words."""
    for name, wanted in size.items():
        if not fits_size(made, name, wanted):
            yield f"{name}: {wanted:.3g} m was asked for, it is {_sizes(made, name)[0]:.3g} m"


def _sized(made: Blueprint, request: Request) -> Blueprint:
    """Scale the whole where no parameter made a size of it as asked for."""
    factors = [
        wanted / there
        for name, wanted in request.size.items()
        if not fits_size(made, name, wanted) and (there := _sizes(made, name)[0]) > 0.0
    ]
    if not factors:
        return made
    factor = factors[0]
    if not 1.0 / _LARGER <= factor <= _LARGER:
        return made
    alone = len(factors) == len(request.size) and all(_same(factor, other) for other in factors)
    return made.scaled(factor) if alone else made


def _sizes(made: Blueprint, name: str) -> list[float]:
    """Sizes of all of an object, of its base link, and of what is nearly as wide and high: the leaf in a frame.

    The diameter is that of a round part, if the whole is not round; the part has to be half as large.
    """
    shut = closed(made)
    whole, others = np.ptp(shut.assembly.bounds, axis=0), [np.ptp(part.bounds, axis=0) for part in shut.parts]
    boxes = [whole, others[0], *(box for box in others if (box > _FRONT * whole)[::2].all())]
    if name == "diameter":
        about = [whole] if _has_round_sides(whole) else []
        turned = [np.ptp(part.bounds, axis=0) for part in shut.parts if not about and _are_round(shut, [part.name])]
        swept = [np.full(3, _swept(shut, part.name)) for part in shut.parts]
        most = max((*about, *turned, *swept), key=np.median)
        if 2.0 * np.median(most) > boxes[0].max():
            boxes = [most, *boxes[1:]] if about else [most]
    return [_extent(box, name) for box in boxes]


def _swept(made: Blueprint, name: str) -> float:
    """Diameter of the circle that a part fills as it spins [m]: a rotor of five blades is wider than its box."""
    joint = made.joint_above.get(name)
    if not joint or not moves_so(joint, "spin"):
        return 0.0
    carried = carried_by(name, [other for other in made.joints if other.kind is JointType.FIXED])
    points = np.concatenate([part.vertices for part in made.parts if part.name in carried])
    return 2.0 * float(np.linalg.norm(np.cross(points - joint.pivot, joint.axis), axis=1).max())


def _has_round_sides(box: FloatArray) -> bool:
    sides = np.sort(box)
    return bool((np.diff(sides) / sides[1:]).min() < _ROUND)


def _extent(extents: FloatArray, name: str) -> float:
    if name in _AXES:
        return float(extents[_AXES[name]])
    if name == "diameter":  # of two sides that are nearly the same, else the wider
        return float(max(extents[:2]))
    return float(extents.min() if name == "thickness" else extents.max())


def _same(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=_SAME)


def _mirror_helps(family: Kind, made: Blueprint, request: Request) -> bool:
    """True if all that is to be on the left is on the right, or the other way round."""
    sides = ("left", "right")
    held = [
        _is_at(made, names, part.side) if part.side in sides else _is_hinged(made, names, part.hinge or "")
        for noun, part in request.parts.items()
        if (part.side in sides or part.hinge in sides) and (names := names_called(family, made, noun))
    ]
    return bool(held) and not any(held)


# ---- parts ---------------------------------------------------------------------------------------------------------


def _meant(made: Blueprint, names: list[str], part: PartRequest) -> list[str]:
    """Return those of some parts that a request counts: two wheels in front are not all wheels."""
    sided = [name for name in names if part.side and part.count and _is_at(made, [name], part.side)]
    return sided if sided and part.count != len(names) else names


def _adjusted(made: Blueprint, noun: str, names: Sequence[str], part: PartRequest) -> Blueprint:
    """An object with the looks, ranges and opening of some parts as asked for, as far as that can be."""
    if part.color or part.material:
        made = looking(made, names, part.material or "", part.color or "")
    how = part.motion or "move"
    moving = [joint.child for joint in _serving(made, names, how)]
    if part.range:
        made = _ranged(made, [name for name in moving if moves_so(made.joint_above[name], how)], part.range)
    if part.open is not None and _is_clear(noun, names):
        made = opened(made, moving, part.open)
    return made


def _painted(made: Blueprint, material: str, color: str) -> tuple[Blueprint, float]:
    """Give what is most of the surface the look of the whole where too little has it, and what closes a large opening.

    What is of rubber or glass keeps its own. Returns the object, and the share of it that has the look then.
    """
    looks = {part.name: part.appearance.materials[0].name if part.appearance else "" for part in made.parts}
    areas = {part.name: part.area for part in made.parts if not looks[part.name].endswith(OWN_LOOK)}
    total = max(sum(areas.values()), 1e-12)
    others = {name for name in areas if not (looks[name].startswith(color) and looks[name].endswith(material))}
    painted = {name for name in others if stem_of(name).endswith(_CLOSES) and areas[name] > _LARGE * total}
    for _ in range(2):
        left: dict[str, float] = {}
        for name in others - painted:
            left[looks[name]] = left.get(looks[name], 0.0) + areas[name]
        if (share := 1.0 - sum(left.values()) / total) >= SHOWN:
            break
        painted |= {name for name in others if looks[name] == max(left, key=left.__getitem__)}
    return looking(made, painted, material, color), share


def looking(blueprint: Blueprint, names: Collection[str], material: str, color: str) -> Blueprint:
    """Return an object with parts painted, or of another material; handles on them keep their own look."""

    def look(part: Part) -> Part:
        appearance = part.appearance
        assert appearance is not None, "what is generated has an appearance"
        own = appearance.materials[0].name.split()[-1]  # behind its colour
        surface = surface_of(material or own, color or None)
        new = of_one_material(surface, part.vertices, part.faces)
        return replace(
            part,
            color=surface.color[:3],
            density=MATERIALS[material].density if material else part.density,
            appearance=replace(
                new,
                materials=(surface, *appearance.materials[1:]),
                material_of_face=appearance.material_of_face,
                uv=appearance.uv if new.uv is None else new.uv,
            ),
        )

    return replace(blueprint, parts=tuple(look(part) if part.name in names else part for part in blueprint.parts))


def opened(blueprint: Blueprint, names: Sequence[str], much: Opening) -> Blueprint:
    """Return an object with some joints open by a share of their way, an angle [rad], a distance [m], or raised.

    Joints that do not go so far stay as they are; whoever measures the object says so.
    """
    values = {}
    for name in names:
        joint = blueprint.joint_above[name]
        lower, upper = _limits(joint)
        wanted = _opening(blueprint, joint, much)
        within = min(max(wanted, lower), upper)  # a limit of 1.57 is 90 degrees
        if joint.kind is not JointType.FIXED and math.isfinite(wanted) and _same(within, wanted):
            values[name] = within - joint.value
    return blueprint.moved(values)


def _opening(made: Blueprint, joint: BlueprintJoint, much: Opening) -> float:
    """Where a joint stands that is open by so much [rad or m]; nan if that is of the other unit, or no end is there."""
    if isinstance(much, tuple):
        return much[0] if joint.kind.turns is (much[1] == "rad") else math.nan
    low, high = _limits(joint)
    if isinstance(much, str):
        middle = next(part.vertices.mean(axis=0) for part in made.parts if part.name == joint.child)
        levels = [joint.motion(end - joint.value)[2] @ (*middle, 1.0) for end in (low, high) if math.isfinite(end)]
        return (low, high)[int(np.argmax(levels) if much == "raised" else np.argmin(levels))] if levels else math.nan
    return much * (high if high > 0.0 else low) if much else 0.0


def _limits(joint: BlueprintJoint) -> tuple[float, float]:
    """Limits from the closed pose [rad or m]."""
    return joint.lower + joint.value, joint.upper + joint.value


def _ranged(blueprint: Blueprint, names: Sequence[str], wanted: tuple[float, float]) -> Blueprint:
    """An object with other ranges of some joints, where nothing is in the way and a slide stays in its guide."""
    joints = list(blueprint.joints)
    for k, joint in enumerate(joints):
        if joint.child not in names or joint.kind is JointType.FIXED:
            continue
        lower, upper = (end - joint.value for end in wanted)
        within = joint.lower - 1e-9 <= lower and upper <= joint.upper + 1e-9
        if not lower <= 0.0 <= upper or not (within or may_go(blueprint, joint.child, lower, upper)):
            continue
        kind = JointType.REVOLUTE if joint.kind is JointType.CONTINUOUS else joint.kind
        joints[k] = replace(joint, kind=kind, lower=lower, upper=upper)
    return replace(blueprint, joints=tuple(joints))


# ---- measuring -----------------------------------------------------------------------------------------------------


def _faults(
    family: Kind, made: Blueprint, request: Request, missing: Sequence[str], unmeasured: list[str]
) -> Iterator[str]:
    yield from size_faults(made, request.size)
    rows: list[tuple[int, str, FloatArray]] = []
    meant: list[tuple[str, set[str]]] = []
    for noun, part in request.parts.items():
        if noun in missing:
            has = sorted({stem_of(item.name).replace("_", " ") for item in made.parts[1:]})
            yield f"{noun}: this {family.title} has none; it has {listed(has[:12])}"
            continue
        names = _meant(made, names_called(family, made, noun), part)
        faults = list(part_faults(family, made, noun, names, part))
        is_detail = len(names) < 2 <= (part.count or 0) and not noun.endswith(_APART)
        counted = count_parameter(family, noun)
        if (faults or (part.count and not counted)) and (not names or (is_detail and not counted)):
            unmeasured.append(noun)
        yield from (f"{noun}: {why}" for why in faults)
        if part.row and names:
            rows.append((part.row, noun, _boxes(made, names).mean(axis=1)[:, 2]))
        meant.append((noun, set(names)))
    for (row, one, above), (other_row, other, below) in combinations(sorted(rows, key=lambda item: item[:2]), 2):
        if row < other_row and above.min() <= below.max():
            yield f"{one}: not above the {other}"
    for (one, mine), (other, its) in combinations(meant, 2):
        if mine and mine == its and not {one, other} & set(_JOINTS):
            unmeasured.append(other)
            yield f"{other}: it is the same as the {one}, {listed(sorted(mine)[:4])}"


def part_faults(family: Kind, made: Blueprint, noun: str, names: Sequence[str], part: PartRequest) -> Iterator[str]:
    """Return what is asked of some parts and is otherwise, in words.

    Args:
        family: The kind.
        made: The object.
        noun: What the parts are called.
        names: Their names.
        part: What is asked.
    """
    parameter = count_parameter(family, noun)
    there = len(names)
    own = int(made.parameters[parameter.name]) if parameter and not part.side else 0
    if own and (there < 2 or there % own == 0):
        there = own  # slots are no parts, and a leg may be two
    alike = {name for other in _ALIKE.get(noun, "").split() for name in names_called(family, made, other)}
    groups = [len({*names, *alike}), *Counter(map(stem_of, names)).values()]
    if part.count not in (None, there) and (part.count not in groups or parameter) and (names or parameter):
        where = f" at the {part.side}" if part.side else ""
        yield f"{part.count} asked for{where}, there {'is' if there == 1 else 'are'} {there}"
    if part.at_least and names and there < part.at_least and (parameter or noun.endswith(_APART)):
        yield f"several asked for, there is {there}"
    if not names:
        looks = ["color", "material"] * noun.endswith(_HANDLES)
        asked = part.model_dump(exclude_defaults=True).keys() - {"count", "at_least", *looks}
        if asked and part.count != 0:
            yield f"it is no part of its own, so that its {listed(sorted(asked))} is not as asked for"
        return
    yield from _size_faults(family, made, noun, names, part)
    if part.side and not _is_at(made, names, part.side):
        yield f"not at the {part.side}"
    if part.hinge and not _is_hinged(made, names, part.hinge):
        yield f"not hinged on the {part.hinge}"
    how = part.motion
    joints = list(_serving(made, names, how or "move"))
    if how and not ((joints or how == "fixed") and all(moves_so(joint, how) for joint in joints)):
        kinds = listed(sorted({joint.kind.value for joint in joints} or {"part of the base"}))
        yield f"{how} was asked for, it is {kinds}"
        return
    leading = [joint for joint in joints if joint.mimic is None and joint.kind is not JointType.FIXED]
    if part.towards and not (leading and all(goes_towards(made, joint, part.towards) for joint in leading)):
        yield f"does not move {part.towards if part.towards in ('in', 'out') else f'to the {part.towards}'}"
    if part.range and not (leading and all(_goes(joint, part.range) for joint in leading)):
        yield f"range {_shown(part.range, joints)} was asked for, it is {_ranges(joints)}"
    if part.open is not None and not (leading and all(_stands(made, joint, part.open) for joint in leading)):
        wanted = listed(sorted({_shown((_opening(made, joint, part.open),), joints) for joint in leading}))
        pose = listed(sorted({_shown((joint.value,), joints) for joint in leading}))
        why = f"open {wanted} was asked for, it is at {pose}; its range is {_ranges(joints)}"
        yield why if _is_clear(noun, names) else "which one is to be open is not said"


def _serving(made: Blueprint, names: Sequence[str], motion: str) -> Iterator[BlueprintJoint]:
    """Joints of parts, or of what carries one that turns without end where that moves so: the fork of a caster."""
    for joint in (made.joint_above[name] for name in names if name in made.joint_above):
        above = made.joint_above.get(joint.parent, joint)
        carried = joint.kind is JointType.CONTINUOUS and not moves_so(joint, motion) and moves_so(above, motion)
        yield above if carried else joint


def _is_clear(noun: str, names: Sequence[str]) -> bool:
    """True unless a noun with a side or an ordinal, in the singular, means several parts."""
    words = noun.split()
    return len(names) == 1 or words[-1] != lemma(words[-1]) or {*_PICKED, *_ORDINALS}.isdisjoint(words[:-1])


def _boxes(made: Blueprint, names: Sequence[str]) -> FloatArray:
    """Bounds of some parts of an object that is closed, of shape (N, 2, 3) [m]."""
    return np.array([part.bounds for part in closed(made).parts if part.name in names])


def _stands_in(made: Blueprint, names: Sequence[str], grid: tuple[int, int]) -> bool:
    """True if parts stand in columns, side by side, and in rows, one above or behind another; 0 is all of them."""
    columns, rows = (lines or len(names) for lines in grid)
    boxes = _boxes(made, names)
    apart = np.diff(np.sort(boxes.mean(axis=1), axis=0), axis=0) > 0.5 * np.ptp(boxes, axis=1).min(axis=0)
    along = 1 + apart.sum(axis=0)
    return bool(along[0] == columns and along[1:].max() == rows)


def _has_sides(made: Blueprint, names: Sequence[str], sides: Sequence[float]) -> bool:
    """True if each of some parts has sides that are so long [m], in any direction."""
    return all(
        any(all(map(_same, sides, some)) for some in permutations(box, len(sides)))
        for box in np.ptp(_boxes(made, names), axis=1)
    )


def is_coupled(made: Blueprint, names: Sequence[str]) -> bool:
    """Return True if one joint leads some parts, or a loop does; what is fixed moves with what carries it."""
    leaders = set()
    for name in names:
        joint = made.joint_above.get(name)
        while joint and joint.kind is JointType.FIXED:
            joint = made.joint_above.get(joint.parent)
        leaders.add(joint and (joint.mimic.joint if joint.mimic else joint.child))
    return len(leaders) == 1 or bool(made.loops)


def _on_both_sides(made: Blueprint, names: Sequence[str], _said: object) -> bool:
    """True if as many of some parts are left of the middle as right of it."""
    middle = closed(made).assembly.bounds[:, 0].mean()
    return not np.sign(_boxes(made, names)[:, :, 0].mean(axis=1) - middle).sum()


def goes_towards(made: Blueprint, joint: BlueprintJoint, side: str) -> bool:
    """Return True if what a joint carries goes to a side as it opens, or either way where it goes both."""
    low, high = _limits(joint)
    way = min(high, 0.5 * math.pi) if high > 0.0 else low
    shut = closed(made)
    part, there = (
        next(item for item in it.parts if item.name == joint.child) for it in (shut, shut.moved({joint.child: way}))
    )
    steps = there.vertices - part.vertices
    step = steps[np.linalg.norm(steps, axis=1).argmax()]
    step /= max(float(np.linalg.norm(step)), 1e-12)
    if side in _SIDES:
        axis, sign = _side(made, side)
        along = float(step[axis]) * sign
        return (abs(along) if low < -1e-6 else along) > _TOWARDS
    away = part.bounds.mean(axis=0) - shut.assembly.bounds.mean(axis=0)
    outwards, front = float(step @ away) / max(float(np.linalg.norm(away)), 1e-12), -float(step[1])
    if abs(front) <= _TOWARDS:  # a door or a drawer that comes to the front goes out
        front = outwards
    return max(front, outwards) > _TOWARDS if side == "out" else front < -_TOWARDS


def _are_round(made: Blueprint, names: Sequence[str], _said: object = None) -> bool:
    """True if two sides of each part are as long, and it fills no more of its box than a cylinder does."""
    parts = [part for part in closed(made).parts if part.name in names]
    for part in parts:
        box = np.ptp(part.bounds, axis=0)
        if not _has_round_sides(box) or ConvexHull(part.vertices).volume > _FILLED * float(np.prod(box)):
            return False
    return bool(parts)


def _size_faults(family: Kind, made: Blueprint, noun: str, names: Sequence[str], part: PartRequest) -> Iterator[str]:
    extents = np.ptp(_boxes(made, names), axis=1)
    for size, wanted in part.size.items():
        own = [made.parameters[name] for name in length_names(family, noun, size)]
        sizes = [*own, *(_extent(box, size) for box in extents)]
        sizes += [_swept(made, name) for name in names if size == "diameter"]
        if not any(_same(wanted, value) for value in sizes):
            yield f"{size}: {wanted:.3g} m was asked for, it is {sizes[0]:.3g} m"


def _side(made: Blueprint, side: str) -> tuple[int, int]:
    """Axis and sign of a side; the front of what rolls along x, as a car, is where that points."""
    axis, sign = _SIDES[side]
    base = made.parts[0].name
    rolls = any("wheel" in it.child and it.parent == base and abs(it.axis[1]) > _UPRIGHT for it in made.joints)
    return (1 - axis, -sign) if rolls and axis < 2 else (axis, sign)


def _is_at(made: Blueprint, names: Sequence[str], side: str) -> bool:
    """True if all of some parts are at a side of the whole."""
    axis, sign = _side(made, side)
    whole = closed(made).assembly.bounds[:, axis]
    near = _ASIDE * np.ptp(whole)
    places = sign * (_boxes(made, names)[:, :, axis] - whole.mean())
    reach = 0.5 * np.ptp(whole)
    return all(
        place.mean() > near or (abs(place.max() - reach) < near and place.min() > near - reach) for place in places
    )


CHECKS: Mapping[str, tuple[Callable[[Blueprint, Sequence[str], Any], bool], str]] = {
    "round": (_are_round, "not round"),
    "each_side": (_on_both_sides, "not as many on either side"),
    "grid": (_stands_in, "columns and rows are not {0[0]} and {0[1]}"),
    "sides": (_has_sides, "no side of it is as long as asked for"),
}
"""What is said of parts and is no field of a request -> how it is measured, and what is said where it is otherwise."""


def _is_hinged(made: Blueprint, names: Sequence[str], side: str) -> bool:
    shut = closed(made)
    joints = [shut.joint_above[name] for name in names if name in shut.joint_above]
    axis, sign = _side(made, side)
    middle = {part.name: part.bounds.mean(axis=0)[axis] for part in shut.parts}
    return bool(joints) and all(
        joint.kind.turns and sign * (joint.pivot[axis] - middle[joint.child]) > 0.0 and abs(joint.axis[axis]) < _LEVEL
        for joint in joints
    )


def moves_so(joint: BlueprintJoint, motion: str) -> bool:
    """Return True if a joint moves as `PartRequest.motion` says."""
    upright = abs(float(joint.axis[2]))
    return {
        "move": joint.kind is not JointType.FIXED,
        "hinge": joint.kind.turns,
        "slide": joint.kind is JointType.PRISMATIC,
        "spin": joint.kind is JointType.CONTINUOUS or (joint.kind.turns and joint.upper - joint.lower > _SPIN),
        "pan": joint.kind.turns and upright > _UPRIGHT,
        "tilt": joint.kind.turns and upright < _LEVEL,
        "lift": joint.kind is JointType.PRISMATIC and upright > 1.0 - _LEVEL,
        "fixed": joint.kind is JointType.FIXED,
    }[motion]


def motion_of(joint: BlueprintJoint) -> str:
    """Return how a joint moves and how far from its closed pose, in words; empty where it does not."""
    return next((f" {how} {_ranges([joint])}" for how in _MOTIONS.split() if moves_so(joint, how)), "")


def _goes(joint: BlueprintJoint, wanted: tuple[float, float]) -> bool:
    way = wanted[1] - wanted[0]
    low, high = _limits(joint)
    if joint.kind is JointType.PRISMATIC and wanted[0] == 0.0:  # how far it slides
        low, high = 0.0, high - low
    return all(abs(end - there) < _SAME * way for end, there in zip(wanted, (low, high), strict=True))


def _stands(made: Blueprint, joint: BlueprintJoint, much: Opening) -> bool:
    return math.isclose(joint.value, _opening(made, joint, much), rel_tol=_SAME, abs_tol=1e-9)


def _ranges(joints: Sequence[BlueprintJoint]) -> str:
    return listed(sorted({_shown(_limits(joint), [joint]) for joint in joints} or {"none"}))


def _shown(ends: Sequence[float], joints: Sequence[BlueprintJoint]) -> str:
    if not all(map(math.isfinite, ends)):
        return "without end"
    if joints and not joints[0].kind.turns:
        return f"{' to '.join(f'{end:.3g}' for end in ends)} m"
    return f"{' to '.join(f'{math.degrees(end):.0f}' for end in ends)} deg"
