"""Columns of numbers between NumPy and Arrow by their memory.

pyarrow's own conversions import pandas first, where it is installed: a quarter of a second of every command.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray


def values_of(column: pa.ChunkedArray) -> NDArray[Any]:
    """Return the values of a column, shape (n,); empty numeric cells become nan."""
    of_numbers = pa.types.is_floating(column.type) or pa.types.is_integer(column.type)
    if not of_numbers or column.null_count or not len(column):
        return np.asarray(column.to_numpy())
    number = np.dtype(column.type.to_pandas_dtype())
    return np.concatenate([_memory(chunk, number) for chunk in column.chunks if len(chunk)])


def array_of(values: NDArray[Any]) -> pa.Array:
    """Return values, shape (n,), as an Arrow array."""
    if values.dtype.kind not in "iuf" or not values.dtype.isnative:
        return pa.array(values)
    memory = pa.py_buffer(np.ascontiguousarray(values))
    return pa.Array.from_buffers(pa.from_numpy_dtype(values.dtype), len(values), [None, memory])


def _memory(chunk: pa.Array, number: np.dtype[Any]) -> NDArray[Any]:
    return np.frombuffer(chunk.buffers()[1], number, len(chunk), chunk.offset * number.itemsize)
