"""The screen's gains are those of a plain least-squares fit with the same prior; elements are added while they pay."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import Noise
from hexdbb.discovery.screen import Screen, screen
from hexdbb.discovery.search import absent_effects
from hexdbb.model import Model, Parameter, new_model, new_term
from hexdbb.record import Record
from hexdbb.samples import Samples, linearise

NOISE = Noise(0.5e-3, "stated")
TRIED = ("backlash", "pitch_cyclic", "straightness", "gravity_sag", "servo_lag", "sample_delay")


def model_of(record: Record) -> Model:
    return new_model(record.machine).with_mounts(Samples.of([record]).mounts)


def fall_of_chi_square(record: Record, model: Model, effect: str, element: str) -> float:
    """By brute force: all rows of the Jacobian, the prior as rows more, two calls of lstsq."""
    full = replace(model, terms=(*model.terms, new_term(effect, model.info(effect).size, free=False)))
    predicted = linearise(Samples.of([record]), full)
    parameters = full.parameters()
    own = np.flatnonzero(full.free)
    tried = [i for i, each in enumerate(parameters) if (each.effect, each.element) == (effect, element)]
    prior = np.array([parameters[column].prior_sigma for column in own])
    rows = np.vstack([predicted.jacobian[:, own] / NOISE.sigma_mm, np.diag(1.0 / prior)])
    right = np.concatenate([predicted.residual_mm / NOISE.sigma_mm, -full.values[own] / prior])
    more = np.vstack([predicted.jacobian[:, tried] / NOISE.sigma_mm, np.zeros((len(own), len(tried)))])

    def left(columns: np.ndarray) -> float:
        scale = np.linalg.norm(columns, axis=0)
        solution = np.linalg.lstsq(columns / scale, right, rcond=1e-12)[0]
        return float(np.sum((right - columns / scale @ solution) ** 2))

    return left(rows) - left(np.hstack([rows, more]))


@pytest.mark.parametrize("effect", TRIED)
def test_gains_are_those_of_brute_force(few: Record, effect: str) -> None:
    model = model_of(few)
    screened = screen(Samples.of([few]), model, absent_effects(model), NOISE, 1.0)
    element = screened.elements(effect)[-1]
    assert screened.gain(effect, [element]).gain == pytest.approx(
        fall_of_chi_square(few, model, effect, element), rel=1e-5
    )


def test_effects_a_model_has_in_part_are_tried_with_the_rest(few: Record) -> None:
    model = model_of(few)
    term = replace(new_term("backlash", 6), free=np.arange(6) == 3, values=np.where(np.arange(6) == 3, 0.01, 0.0))
    partly = replace(model, terms=(*model.terms, term))
    assert "backlash" in absent_effects(partly)
    assert screen(Samples.of([few]), partly, ["backlash"], NOISE, 1.0).elements("backlash") == ["1", "2", "3", "5", "6"]
    wholly = replace(model, terms=(*model.terms, replace(term, free=np.ones(6, bool))))
    assert "backlash" not in absent_effects(wholly)


def made_screen(gains: dict[str, float], shared: float = 0.0) -> Screen:
    """Give a screen of one effect whose elements offer these falls of chi-square, alone and without the others."""
    projected = np.eye(len(gains)) + shared * (1.0 - np.eye(len(gains)))
    parameters = tuple(Parameter("backlash", each, "play", "mm", 0.01, 1.0, False) for each in gains)
    return Screen(projected, np.sqrt(list(gains.values())), np.ones(len(gains)), parameters, 1000.0)


def test_elements_are_gathered_while_they_pay() -> None:
    # ln 1000 = 6.9 for a value more, and 10 on top: 30 pays, 15 does not.
    best = made_screen({"1": 15.0, "2": 400.0, "3": 30.0}).best_elements("backlash")
    assert best.elements == ("2", "3")
    assert best.gain == pytest.approx(430.0)
    assert best.bic_drop(1000.0) == pytest.approx(430.0 - 2.0 * np.log(1000.0))


def test_an_element_that_only_repeats_another_is_left_out() -> None:
    assert made_screen({"1": 300.0, "2": 299.0}, shared=0.999).best_elements("backlash").elements == ("1",)
