"""Which variable carries what is left: for a fault no known effect explains, so that its finder knows what to write.

The study of variables (`hexdbb.predictors`) put to a fitted model's residual: the model's own free values may imitate
part of any variable, and noise is not there to be carried.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Noise
from hexdbb.discovery.result import Structure
from hexdbb.model import Model
from hexdbb.predictors import Carrier, Pushes, carriers, sample_columns, sentence, telling
from hexdbb.record import Record
from hexdbb.samples import samples_of

Floats = NDArray[np.float64]

MOST_NAMED = 6


def unexplained_structure(
    records: Sequence[Record], model: Model, residual_mm: Floats, noise: Noise
) -> tuple[Structure, ...]:
    """Name the variables that carry the unexplained variance, largest share first.

    Parameters
    ----------
    records : sequence of Record
    model : Model
        Fitted to them.
    residual_mm : ndarray, shape (n,)
        What it leaves, of all records one after another.
    noise : Noise
    """
    if float(np.mean(residual_mm**2)) <= noise.sigma_mm**2:
        return ()
    left = np.split(residual_mm, np.cumsum([len(record) for record in records])[:-1])
    predicted = [record.reading_mm - own for record, own in zip(records, left, strict=True)]
    samples = [samples_of([record], model) for record in records]
    pushes = Pushes.joined([Pushes.of(model, each) for each in samples])
    columns = sample_columns(records, _names(records), predicted, [each.state for each in samples])
    found = carriers(columns, pushes, noise.sigma_mm, beyond_noise=True)
    return tuple(_structure(each) for each in telling(found, MOST_NAMED))


def _names(records: Sequence[Record]) -> list[str]:
    """Name records so that no two are called the same."""
    return [f"{record.name} ({number})" for number, record in enumerate(records, start=1)]


def _structure(carrier: Carrier) -> Structure:
    place = None if carrier.place is None else (carrier.place.begin, carrier.place.end)
    return Structure(
        carrier.variable, carrier.share, carrier.period, carrier.unit, sentence(carrier), place, carrier.size_um
    )
