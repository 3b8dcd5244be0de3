"""What a model says the ball bar reads, for the samples of a record."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import engine_machine, status_name
from hexdbb.model import Model, MountKey
from hexdbb.record import Record
from hexdbb.samples.state import state_columns

Floats = NDArray[np.float64]


def mount_keys(records: Sequence[Record]) -> list[MountKey]:
    """Give every mount of some records that a sample was taken on."""
    return [key for record in records for key in _keys_by_circle(record).values()]


def knowing(model: Model, records: Sequence[Record]) -> Model:
    """Give the same model knowing the mounts of some records; what is new to it stands where planned."""
    return model.with_mounts(list(dict.fromkeys(mount_keys(records))))


def unseen_mounts(record: Record, model: Model) -> list[MountKey]:
    """Give the mounts of a record whose cups a model does not know."""
    return [key for key in dict.fromkeys(mount_keys([record])) if key not in model.mounts]


def samples_of(records: Sequence[Record], model: Model) -> _core.Samples:
    """Samples of some records, one after another, with their state, for the engine.

    Raises
    ------
    InputError
        Where a record belongs to another machine than the model.
    """
    set_ups: list[_core.SetUp] = []
    sliders, set_up_rows, mount_rows = [], [], []
    for record in records:
        record.require_machine(model.machine, model.name)
        circle_ids, member = np.unique(record.columns["circle"], return_inverse=True)
        keys = _keys_by_circle(record)
        places = [_place(keys[int(each)], model, record) for each in circle_ids]
        sliders.append(record.sliders_mm)
        set_up_rows.append(len(set_ups) + member)
        mount_rows.append(np.array(places)[member])
        for each in circle_ids:
            circle = record.circle(int(each))
            set_ups.append(
                _core.SetUp(
                    cup_mm=np.array(record.mount(circle.mount).cup_mm),
                    ball_offset_mm=np.array(circle.ball_offset_mm),
                    bar_length_mm=record.gauge.bar_length_mm,
                )
            )
    samples = _core.Samples(
        sliders_mm=np.vstack(sliders),
        set_up=np.concatenate(set_up_rows).astype(np.int32),
        mount=np.concatenate(mount_rows).astype(np.int32),
        set_ups=set_ups,
        state=state_columns(records),
    )
    samples.derive(engine_machine(model.machine))
    return samples


def predict_reading_mm(record: Record, model: Model) -> Floats:
    """Readings a model predicts for a record.

    Parameters
    ----------
    record : Record
    model : Model
        Where it knows any mounts, the record's must be among them (`hexdbb.diagnosis.fit_mounts`); where it knows none,
        every cup stands where planned.

    Returns
    -------
    ndarray, shape (n,)
        Ball-bar length minus nominal length, mm.

    Raises
    ------
    InputError
        Naming the first sample the model's machine cannot reach, or a machine that differs.
    """
    samples = samples_of([record], model)
    prediction = _core.predict(model.engine(samples), samples)
    row = prediction.first_failure
    if row >= 0:
        reason = status_name(int(prediction.status[row]))
        raise InputError(f"{record.name}: row {row + 1}: the sliders' place has no pose ({reason})")
    reading_mm: Floats = prediction.reading_mm
    return reading_mm


def residual_mm(records: Sequence[Record], model: Model) -> Floats:
    """Measured minus predicted readings of some records, one after another.

    Parameters
    ----------
    records : sequence of Record
        Of mounts the model knows.
    model : Model

    Returns
    -------
    ndarray, shape (n,)

    Raises
    ------
    InputError
        Naming the record and the first sample the model's machine cannot reach, or a machine that differs.
    """
    return np.concatenate([record.reading_mm - predict_reading_mm(record, model) for record in records])


def _place(key: MountKey, model: Model, record: Record) -> int:
    if not model.mounts:
        return 0
    if key not in model.mounts:
        known = "hexdbb.diagnosis.fit_mounts finds where its cup stands"
        raise InputError(
            f"{record.name}: mount {key.mount_id}: not known to the model (expected a fitted one: {known})"
        )
    return model.mounts.index(key)


def _keys_by_circle(record: Record) -> dict[int, MountKey]:
    content = record.content_hash()
    return {
        int(each): MountKey(content, record.circle(int(each)).mount) for each in np.unique(record.columns["circle"])
    }
