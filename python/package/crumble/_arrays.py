"""Arrays as the extension hands them over."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Integers = npt.NDArray[np.int64]
    Array = npt.NDArray[np.float64 | np.int64]
    Column = tuple[bytearray, str, int]


def array(column: Column) -> npt.NDArray[Any]:
    """The array of a column: its bytes, the type of its numbers, and the numbers in a row."""
    # Imported here, so that the programs start without it.
    import numpy as np

    numbers, kind, row = column
    values = np.frombuffer(numbers, dtype=kind)
    return values if row == 1 else values.reshape(-1, row)
