"""Records prepared for the engine: once for all the fits and predictions that one question takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.model import Model, MountKey
from hexdbb.record import Record
from hexdbb.samples.earlier import samples_of

Floats = NDArray[np.float64]
Number = TypeVar("Number", bound=np.generic)


@dataclass(frozen=True, eq=False)
class Measured:
    """Records as the engine takes them, prepared once for many fits and predictions.

    Attributes
    ----------
    records : tuple of Record
    whole : Samples
        Of all readings of the records, with their state; what effects of the user's own are known in.
    rows : ndarray of int or None
        Which of these readings count; all where None.
    mounts : tuple of MountKey
        Those the model knows that they were prepared for.
    """

    records: tuple[Record, ...]
    whole: _core.Samples
    rows: NDArray[np.intp] | None
    mounts: tuple[MountKey, ...]

    @property
    def names(self) -> str:
        """What errors call the records."""
        return ", ".join(record.name for record in self.records)

    @cached_property
    def samples(self) -> _core.Samples:
        """Samples of the readings that count."""
        return self.whole if self.rows is None else self.whole.rows(self.rows)

    @cached_property
    def reading_mm(self) -> Floats:
        """Readings that count, one record after another."""
        return self._counting(np.concatenate([record.reading_mm for record in self.records]))

    @cached_property
    def sweep(self) -> NDArray[np.int32]:
        """Number of the capture of each reading that counts, through all records."""
        return self._counting(self.whole.state["sweep"].astype(np.int32))

    def part(self, chosen: NDArray[np.bool_]) -> Measured:
        """Give some of the readings of whole records, `chosen` of shape (n,)."""
        return replace(self, rows=np.flatnonzero(chosen))

    def engine(self, model: Model) -> _core.Model:
        """Give the engine's form of a model that is to predict these readings."""
        return model.engine(self.whole)

    def _counting(self, column: NDArray[Number]) -> NDArray[Number]:
        return column if self.rows is None else column[self.rows]


def measured(records: Sequence[Record] | Measured, model: Model) -> Measured:
    """Prepare records for a model, or give what is prepared where it is of the same mounts.

    Raises
    ------
    InputError
        Where a record belongs to another machine than the model.
    """
    if not isinstance(records, Measured):
        return Measured(tuple(records), samples_of(records, model), None, model.mounts)
    if records.mounts == model.mounts:
        return records
    return replace(measured(records.records, model), rows=records.rows)
