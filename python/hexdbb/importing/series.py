"""Readings in order of time, as an import makes a record of them, whatever file they come from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Series:
    """Readings with what a file says of each.

    Attributes
    ----------
    angle_deg, reading_um : ndarray, shape (n,)
        Place on the circle, wrapped or not; bar length minus nominal length.
    direction : ndarray of int, shape (n,), or None
        +1 counter-clockwise, -1 clockwise; None where the sense of the angle must tell.
    lines : ndarray of int, shape (n,)
        Where each reading stands in its file.
    others : dict of str to ndarray, each of shape (n,)
        Further columns of a record, as far as the file has them.
    notes : sequence of str
        What was done, in words.
    metadata : dict
        What else the file says, for the record's metadata.
    """

    angle_deg: Floats
    reading_um: Floats
    direction: NDArray[np.int8] | None
    lines: Ints
    others: dict[str, Floats] = field(default_factory=dict)
    notes: Sequence[str] = ()
    metadata: dict[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.angle_deg)

    @property
    def directions(self) -> NDArray[np.int8]:
        """The directions, where they are known."""
        assert self.direction is not None
        return self.direction

    def rows(self, rows: Ints) -> Series:
        """Return some of the readings, in the order of their numbers."""
        direction = None if self.direction is None else self.direction[rows]
        others = {name: values[rows] for name, values in self.others.items()}
        lines = self.lines[rows]
        return Series(self.angle_deg[rows], self.reading_um[rows], direction, lines, others, self.notes, self.metadata)
