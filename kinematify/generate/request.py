"""A typed request for an object: its kind, parameters of the kind, sizes of the whole, and facts about named parts."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from kinematify.errors import InputError
from kinematify.generate.kind_search import key_of, kind_called, nearest_kinds, words_of
from kinematify.generate.library.kind import checked
from kinematify.generate.procedural.materials import COLOR_WORDS, COLORS, MATERIALS
from kinematify.generate.registry import kind_named

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.generate.library.kind import Kind
    from kinematify.generate.procedural.parameter import Parameter

UNITS = {
    **dict.fromkeys(words_of("mm millimeter millimeters millimetre millimetres"), 1e-3),
    **dict.fromkeys(words_of("cm centimeter centimeters centimetre centimetres"), 0.01),
    **dict.fromkeys(words_of("m meter meters metre metres"), 1.0),
    **dict.fromkeys(words_of('in inch inches "'), 0.0254),
    **dict.fromkeys(words_of("ft foot feet"), 0.3048),
}  # fmt: skip
"""Metres per unit of length."""
ANGLES = {"rad": 1.0, **dict.fromkeys(("deg", "degree", "degrees", "°"), math.pi / 180.0)}
"""Radians per unit of angle."""
_SIGNED = r"[-+−]?\s?\d+(?:\.\d+)?"
_UNIT = "|".join(sorted(map(re.escape, (*UNITS, *ANGLES)), key=len, reverse=True))
_QUANTITY = re.compile(rf"({_SIGNED})\s*({_UNIT})?")
_RANGE = re.compile(rf"({_SIGNED})\s*(?:{_UNIT})?\s*(?:to|\.\.|,)\s*({_SIGNED})\s*({_UNIT})?")


def quantity(text: str) -> tuple[float, str]:
    """Return a length [m], an angle [rad] or a plain number that a text says, and the unit: ``m``, ``rad`` or empty.

    Raises:
        ValueError: It says none.
    """
    found = _QUANTITY.fullmatch(text.strip())
    if not found:
        raise ValueError(f"{text!r} is no number with a unit; write for example 80 cm, 0.8 or 30 deg")
    return in_si(found[1], found[2])


def in_si(number: str, unit: str | None) -> tuple[float, str]:
    """Return a number in metres or radians, with that unit; as it is without one."""
    value = float(number.replace(" ", "").replace("−", "-"))
    if unit in UNITS:
        return value * UNITS[unit], "m"
    return (value * ANGLES[unit], "rad") if unit in ANGLES else (value, "")


def _plain(value: Any) -> Any:
    return quantity(value)[0] if isinstance(value, str) else value


def _pair(value: Any) -> Any:
    if isinstance(value, str):
        found = _RANGE.fullmatch(value.strip())
        if not found:
            raise ValueError(f"{value!r} is no range; write for example -30 to 90 deg, or 0 to 40 cm")
        return in_si(found[1], found[3])[0], in_si(found[2], found[3])[0]
    return value


def _opening(value: Any) -> Any:
    words = {"closed": 0.0, "half": 0.5, "half open": 0.5, "open": 1.0}
    number, unit = value, ""
    if value in ("raised", "lowered"):
        return value
    if isinstance(value, str):
        number, unit = (words[value], "") if value in words else quantity(value)
    if isinstance(number, dict) or (not unit and isinstance(number, float | int) and not 0.0 <= number <= 1.0):
        raise ValueError(
            f"{value} is no opening: a plain number is a share of the way, from 0 to 1; write 45 deg, 1.57 rad, 12 cm "
            "or raised"
        )
    return (number, unit) if unit else number


def _name_among(known: Mapping[str, str], what: str) -> BeforeValidator:
    def found(value: Any) -> Any:
        if value is not None and value not in known:
            raise ValueError(f"{value!r} is no {what}; there are {', '.join(dict.fromkeys(known.values()))}")
        return known[value] if value is not None else None

    return BeforeValidator(found)


Opening = float | tuple[float, Literal["m", "rad"]] | str
"""Share of the way, a value of the joint, or ``raised`` or ``lowered``: the end of its way where the part is so."""
Size = Annotated[float, BeforeValidator(_plain), Field(gt=0.0, le=100.0)]
Sizes = dict[Literal["width", "depth", "height", "length", "diameter", "thickness"], Size]
Color = Annotated[str | None, _name_among(COLOR_WORDS, "colour")]
Material = Annotated[str | None, _name_among({name: name for name in MATERIALS}, "material")]


class _Fields(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class PartRequest(_Fields):
    """Facts about the parts of one name; what is absent is left as the kind has it."""

    count: int | None = Field(None, ge=0, le=1_000_000)
    at_least: int | None = Field(None, ge=1, le=60)
    size: Sizes = Field(
        {},
        description="[m], or text with a unit: 80 cm. Of the box around each part, closed: width along x, depth along "
        "y, height along z; length and thickness are its longest and shortest side; diameter of what is round.",
    )
    color: Color = Field(None, description=f"One of {', '.join(COLORS)}.")
    material: Material = Field(None, description=f"One of {', '.join(MATERIALS)}.")
    side: Literal["left", "right", "front", "back", "top", "bottom"] | None = Field(
        None, description="Where they are, seen from the front."
    )
    row: int | None = Field(None, ge=1, description="From the top: all of row 1 is above all of row 2.")
    motion: Literal["move", "hinge", "slide", "spin", "pan", "tilt", "lift", "fixed"] | None = Field(
        None,
        description="How they move: at all (move), turning about any axis (hinge), an upright (pan) or a level one "
        "(tilt), by three quarters of a turn or without end (spin), sliding any way (slide) or upwards (lift), not.",
    )
    towards: Literal["left", "right", "front", "back", "top", "bottom", "out", "in"] | None = Field(
        None, description="Where they go as they open."
    )
    hinge: Literal["left", "right", "front", "back", "top", "bottom"] | None = Field(
        None, description="Side of the part on which its hinge is."
    )
    range: Annotated[tuple[float, float] | None, BeforeValidator(_pair)] = Field(
        None,
        description="Of the joint, signed, from the closed pose: text as -30 to 90 deg, 0 to 30 cm, or two numbers.",
    )
    open: Annotated[Opening | None, BeforeValidator(_opening)] = Field(
        None,
        description="How far they stand open: text as 45 deg, 12 cm; a plain number is a share of the way, 0 to 1; "
        "raised or lowered is an end of it.",
    )

    @model_validator(mode="before")
    @classmethod
    def _motion_of_range(cls, values: Any) -> Any:
        """Say of a range in metres that the part slides, of one in degrees that it turns."""
        found = _RANGE.fullmatch(str(values.get("range")).strip()) if isinstance(values, dict) else None
        if not found or not found[3]:
            return values
        slides, motion = found[3] in UNITS, values.get("motion") or "move"
        if motion != "move" and slides is not (motion in ("slide", "lift")):
            raise ValueError(
                f"a range of {values['range']!r} is of what {'slides' if slides else 'turns'}, not {motion}"
            )
        return {**values, "motion": ("slide" if slides else "hinge") if motion == "move" else motion}


class Request(_Fields):
    """An object that is asked for."""

    kind: str = Field(description="Name of the kind; `kinematify generate --list` shows all.")
    parameters: dict[str, float | int | str] = Field({}, description="Of the kind: lengths [m], angles [rad], counts.")
    size: Sizes = Field({}, description="Of the whole, closed, with all that sticks out; as of a part.")
    parts: dict[str, PartRequest] = Field(
        {}, description="Name of parts -> what is asked of them; 'left door' or 'second drawer' means one of them."
    )
    instead_of: str = Field("", description="What was asked for, where the kind is only the nearest one.")

    @property
    def family(self) -> Kind:
        """Return its kind.

        Raises:
            InputError: There is no such kind.
        """
        return find_family(self.kind)

    def checked(self) -> Request:
        """Return the request with its values as the types of the kind's parameters.

        Raises:
            InputError: The kind, a parameter or a value does not exist or is out of its bounds; the message lists what
                is allowed.
        """
        family = self.family
        values = {name: checked(family, name, _said(family, name, value)) for name, value in self.parameters.items()}
        return self.model_copy(update={"kind": family.name, "parameters": values})


def _said(family: Kind, name: str, value: Any) -> Any:
    """A value of a parameter that is a number, where the text says a unit."""
    parameter = next((item for item in family.all_parameters if item.name == name), None)
    if isinstance(value, str) and parameter and not isinstance(parameter.default, str):
        try:
            return quantity(value)[0]
        except ValueError:
            return value
    return value


def find_family(name: str) -> Kind:
    """Return the kind of a name, in any letter case, with spaces or underscores.

    Raises:
        InputError: There is none; the message names the nearest.
    """
    whole = "_".join(re.findall(r"[a-z0-9]+", name.lower()))
    if not (family := kind_named(whole) or kind_called(key_of(name))):
        near = " or ".join(item.name for item in nearest_kinds(name, 2))
        raise InputError(f"There is no kind {name!r}. Did you mean {near}? kinematify generate --list shows all.")
    return family


# ---- from words, files and settings --------------------------------------------------------------------------------


def request_of(values: Mapping[str, Any], *, source: str = "request") -> Request:
    """Return the request that JSON values say.

    Raises:
        InputError: They do not fit; the message says where, and what is allowed.
    """
    try:
        return Request.model_validate(values).checked()
    except ValidationError as error:
        found = [
            f"{'.'.join(map(str, item['loc'])) or 'all'}: {_reason(item)}" for item in error.errors(include_url=False)
        ]
        raise InputError(f"The {source} cannot be used: {'; '.join(found[:5])}.") from error


def _reason(problem: Any) -> str:
    if problem["type"] != "extra_forbidden":
        return str(problem["msg"])
    model: type[BaseModel] = PartRequest if problem["loc"][0] == "parts" else Request
    return f"there is no such field; there are {', '.join(model.model_fields)}"


def read_request(path: Path) -> dict[str, Any]:
    """Read the values of a request from a YAML or JSON file.

    Raises:
        InputError: It cannot be read, or is no mapping.
    """
    from kinematify.generate.procedural.blueprint_file import read_values  # noqa: PLC0415 - a schema that few need

    values = read_values(path)
    if not isinstance(values, dict):
        raise InputError(f"The file {path} holds no request: a mapping with kind, parameters, size and parts.")
    return values


def with_settings(values: Mapping[str, Any], settings: Mapping[str, str]) -> dict[str, Any]:
    """Return the values of a request with settings as they are typed.

    Args:
        values: As in a file.
        settings: ``doors`` for a parameter, ``size.width`` for the whole, ``door.color`` for the parts of a name.
    """
    made = {**values, "parameters": dict(values.get("parameters") or {}), "size": dict(values.get("size") or {})}
    parts = {name: dict(part) for name, part in (values.get("parts") or {}).items()}
    for key, value in settings.items():
        name, _, fact = key.partition(".")
        field, _, dimension = fact.partition(".")
        if name == "size" and fact:
            made["size"][fact] = value
        elif field in PartRequest.model_fields:
            part = parts.setdefault(name.replace("_", " "), {})
            part[field] = {**part.get(field, {}), dimension: value} if dimension else value
        else:
            made["parameters"][key] = value
    return {**made, "parts": parts}


def schema_of(kind: str | None) -> dict[str, Any]:
    """Return the JSON schema of requests, with the parameters of a kind if one is named.

    Raises:
        InputError: There is no such kind.
    """
    schema = Request.model_json_schema()
    if kind:
        family = find_family(kind)
        schema["title"], schema["description"] = family.name, family.title
        schema["properties"]["kind"] = {"const": family.name}
        schema["properties"]["parameters"] = {
            "type": "object",
            "additionalProperties": False,
            "properties": {item.name: _schema_of(item) for item in family.all_parameters},
        }
    return schema


def _schema_of(parameter: Parameter) -> dict[str, Any]:
    unit = f" [{parameter.unit}]" if parameter.unit else ""
    facts: dict[str, Any] = {"description": f"{parameter.help}{unit}", "default": parameter.default}
    if isinstance(parameter.default, str):
        return {"type": "string", **facts, **({"enum": list(parameter.choices)} if parameter.choices else {})}
    bounds = dict(zip(("minimum", "maximum"), parameter.bounds or (), strict=False))
    return {"type": "integer" if isinstance(parameter.default, int) else "number", **facts, **bounds}


def listed(words: Sequence[str]) -> str:
    """Return words with commas and a last *and*."""
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1]))) if words else "nothing"
