"""Numbers in the attributes of a URDF: finite, of the right count, or one clear error."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import DescriptionError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lxml.etree import _Element

    from kinematify.robot.arrays import FloatArray


def vector(element: _Element, attribute: str, default: Sequence[float] | None, where: str) -> FloatArray:
    """Return three finite numbers of an attribute, shape (3,).

    Args:
        element: Where to look.
        attribute: Name of the attribute.
        default: Value of an absent attribute; None if it must be there.
        where: The link or joint, for the message.

    Raises:
        DescriptionError: The attribute is absent, or anything but three finite numbers.
    """
    text = element.get(attribute)
    if text is None and default is not None:
        return np.asarray(default, dtype=np.float64)
    values = _finite(text)
    if len(values) == 1 and attribute == "scale":  # some exporters write one factor for all axes
        values = values * 3
    if len(values) != 3:
        raise DescriptionError(
            f"The attribute {attribute}={text!r} of <{element.tag}> in {where} must be three finite numbers. Correct "
            "it."
        )
    return np.array(values)


def number(element: _Element, attribute: str, default: float | None, where: str) -> float:
    """Return one finite number of an attribute; arguments and errors as for `vector`."""
    text = element.get(attribute)
    if text is None and default is not None:
        return default
    values = _finite(text)
    if len(values) != 1:
        raise DescriptionError(
            f"The attribute {attribute}={text!r} of <{element.tag}> in {where} must be one finite number. Correct it."
        )
    return values[0]


def _finite(text: str | None) -> list[float]:
    try:
        values = [float(word) for word in (text or "").split()]
    except ValueError:
        return []
    return values if all(map(math.isfinite, values)) else []


def origin_transform(element: _Element, where: str) -> FloatArray:
    """Return the transform of the ``origin`` child, shape (4, 4); identity where there is none.

    Roll, pitch and yaw are turns about the fixed x, y and z axes, in this order.

    Raises:
        DescriptionError: A number is malformed.
    """
    origin = element.find("origin")
    transform = np.eye(4)
    if origin is not None:
        transform[:3, :3] = _rotation(vector(origin, "rpy", (0.0, 0.0, 0.0), where))
        transform[:3, 3] = vector(origin, "xyz", (0.0, 0.0, 0.0), where)
    return transform


def _rotation(roll_pitch_yaw: FloatArray) -> FloatArray:
    (sr, sp, sy), (cr, cp, cy) = np.sin(roll_pitch_yaw), np.cos(roll_pitch_yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
