"""Array types with shapes and units in their users' docstrings, and arrays that cannot be written."""

from __future__ import annotations

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


def used_vertices(faces: IntArray, n_vertices: int) -> BoolArray:
    """Return which vertices a face uses, shape (V,); far quicker on millions of faces than sorting them."""
    used = np.zeros(n_vertices, dtype=np.bool_)
    used[faces.reshape(-1)] = True
    return used
