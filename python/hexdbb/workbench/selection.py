"""Which circle of which record the charts show, at which feed, in which directions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.predictors import record_names
from hexdbb.samples import Samples

SECONDS_PER_MINUTE = 60.0


@dataclass(frozen=True)
class Selection:
    """One circle of one record at one feed; `direction` is +1, -1, or 0 for both."""

    record: int
    circle: int
    feed_mm_min: float
    direction: int = 0

    @property
    def expression(self) -> str:
        """The mask of its rows in Python, for `samples` of the script."""
        parts = [
            f'(samples["record"] == {self.record})',
            f'(samples["circle"] == {self.circle})',
            f'np.isclose({SECONDS_PER_MINUTE:g} * samples["feed_mm_s"], {self.feed_mm_min!r})',
        ]
        if self.direction:
            parts.append(f'(samples["direction"] == {self.direction})')
        return " & ".join(parts)

    def rows(self, samples: Samples) -> NDArray[np.bool_]:
        """Return the mask of its rows, shape (n,).

        Raises
        ------
        InputError
            No such circle, or none at this feed or in this direction.
        """
        here: NDArray[np.bool_] = (samples["record"] == self.record) & (samples["circle"] == self.circle)
        here &= np.isclose(SECONDS_PER_MINUTE * samples["feed_mm_s"], self.feed_mm_min)
        if self.direction:
            here &= samples["direction"] == self.direction
        if not here.any():
            raise InputError(
                f"circle {self.circle} at {self.feed_mm_min:g} mm/min, direction {self.direction}: not in the records"
            )
        return here


def selections(samples: Samples) -> list[Selection]:
    """Return every circle at every feed, both directions, in the order of the records."""
    feed_mm_min = np.round(SECONDS_PER_MINUTE * samples["feed_mm_s"], 9)
    parts = np.unique(np.column_stack([samples["record"], samples["circle"], feed_mm_min]), axis=0)
    return [Selection(int(record), int(circle), float(feed)) for record, circle, feed in parts]


def described(selection: Selection, samples: Samples) -> str:
    """Return a selection in words; the record is named where there are several."""
    record = f"{record_names(samples.records)[selection.record]}, " if len(samples.records) > 1 else ""
    return f"{record}circle {selection.circle}, {selection.feed_mm_min:g} mm/min"
