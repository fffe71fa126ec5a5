"""Array types with shapes and units in their users' docstrings, and arrays that cannot be written."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    IntArray = NDArray[np.int64]
    BoolArray = NDArray[np.bool_]


def read_only(array: NDArray[Any], dtype: type) -> NDArray[Any]:
    """Return a C-contiguous copy of `array` that refuses to be written."""
    copy: NDArray[Any] = np.array(array, dtype=dtype, order="C", copy=True)
    copy.setflags(write=False)
    return copy


_TYPES = {"FloatArray": np.float64, "IntArray": np.int64, "NDArray[np.uint8]": np.uint8}


class ReadOnlyArrays:
    """A frozen dataclass whose own fields of arrays, or perhaps arrays, become read-only copies of their type."""

    def __post_init__(self) -> None:
        for name, kind in type(self).__annotations__.items():
            dtype = _TYPES.get(kind.removesuffix(" | None"))
            if dtype is not None and getattr(self, name) is not None:
                object.__setattr__(self, name, read_only(getattr(self, name), dtype))


def json_values(value: Any) -> Any:
    """Return dataclasses, mappings, sequences and arrays as JSON has them; a number that is not finite is null."""
    value = vars(value) if is_dataclass(value) else value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, Mapping):
        return {str(key): json_values(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [json_values(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def used_vertices(faces: IntArray, n_vertices: int) -> BoolArray:
    """Return which vertices a face uses, shape (V,); far quicker on millions of faces than sorting them."""
    used = np.zeros(n_vertices, dtype=np.bool_)
    used[faces.reshape(-1)] = True
    return used
