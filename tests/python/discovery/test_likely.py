"""The likely cause: the hidden effect in one sentence; none of noise; a model that is not fitted is told as such."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from hexdbb.diagnosis import diagnose
from hexdbb.discovery import LikelyCause, likely_cause
from hexdbb.model import Model, new_model
from hexdbb.record import Record
from hexdbb.samples import Samples, predict

Measured = Callable[[str], Record]


def likely(record: Record, model: Model | None = None) -> LikelyCause | None:
    """Look for the likely cause of what a model leaves, the fitted geometry's where none is given."""
    samples = Samples.of([record])
    if model is None:
        model = diagnose(samples, new_model(record.machine), check_held_out=False).model
    known = model.with_mounts(samples.mounts)
    return likely_cause(samples, known, predict(samples, known).residual_mm)


@pytest.mark.parametrize(
    ("name", "choice", "words", "subject"),
    [
        ("backlash-x3-s1", "backlash:4", "likely cause: slider 4 has ", "slider 4"),
        ("dent-x3-s1", "learned:", "likely cause: no known effect, ", "position"),
    ],
)
def test_the_hidden_fault_is_named_with_its_place(
    measured: Measured, name: str, choice: str, words: str, subject: str
) -> None:
    found = likely(measured(name))
    assert found is not None
    assert found.choices[0].startswith(choice)
    assert found.sentence.startswith(words) and " µm" in found.sentence
    assert "% of what the model missed, on circles, feeds, directions" in found.sentence
    assert subject in (*found.subjects, found.sentence) or subject in found.sentence


def test_what_a_known_cause_leaves_is_noise(measured: Measured) -> None:
    record = measured("backlash-x3-s1")
    found = likely(record)
    assert found is not None and found.is_all
    assert 1e3 * np.sqrt(np.mean(found.residual_mm**2)) < 1.2 * record.gauge.noise_um
    assert "slider 4" in found.subjects and "slider 2" not in found.subjects


def test_noise_has_no_cause(measured: Measured) -> None:
    assert likely(measured("none-s1")) is None


@pytest.mark.parametrize(
    ("effects", "words"),
    [([], "the machine's geometric errors, which the model lacks; "), (None, "the model's own values; ")],
    ids=["without", "not fitted"],
)
def test_a_model_not_fitted_to_the_readings_is_its_own_cause(
    measured: Measured, effects: list[str] | None, words: str
) -> None:
    record = measured("none-s1")
    found = likely(record, new_model(record.machine) if effects is None else new_model(record.machine, effects))
    assert found is not None
    assert found.sentence.startswith(f"likely cause: {words}fitted to these readings (hexdbb diagnose) they leave 0.")
    assert found.choices == found.subjects == () and found.is_all


def test_too_few_readings_are_not_judged(measured: Measured) -> None:
    record = measured("backlash-x3-s1")
    assert likely(record.part(np.arange(len(record)) < 100), new_model(record.machine)) is None
