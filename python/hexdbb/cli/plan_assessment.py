"""Assessment of a plan, shared by the plan commands: what it would determine of a model, and how well."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import click
import numpy as np

from hexdbb.cli.consoles import message_console, say
from hexdbb.identifiability import (
    Expectation,
    Observability,
    expected_uncertainties,
    minimal_set,
    observability,
    plan_sensitivity,
    with_every_effect,
)
from hexdbb.model import Model
from hexdbb.plan import Plan
from hexdbb.planning import Detectable, detectable_sizes
from hexdbb.units import shown_factor, shown_unit

ASSUMED_NOISE_UM = 0.5
"""Noise of a gauge without a specification: the order of common ball bars, and that of the shipped plans' gauge."""

noise_option: Callable[[Any], Any] = click.option(
    "--noise",
    "noise_um",
    type=click.FloatRange(min=0.0, min_open=True),
    help="Standard deviation of one reading, µm; default: the gauge specification in the plan.",
)


@dataclass(frozen=True)
class PlanAssessment:
    """What a plan would determine, at one reading noise."""

    noise_um: float
    """Standard deviation of one reading, µm."""
    readings: float
    """Number of readings."""
    observability: Observability
    expected: list[Expectation]
    """Expected uncertainty of every free value of the machine."""
    minimal_set: list[str]
    """Values that explain all the readings can determine while all others are held at zero."""
    detectable: Mapping[str, Detectable]
    """Detectable sizes by effect."""

    def to_json(self) -> dict[str, Any]:
        """Return its part of what `hexdbb plan check --json` prints."""
        found = self.observability
        return {
            "noise_um": self.noise_um,
            "rank": found.rank,
            "values": found.values,
            "condition": found.condition,
            "observability": {"o1": found.o1, "o3": found.o3, "o4": found.o4},
            "singular_values": [float(each) for each in found.singular_values],
            "parameters": [_expected_json(each) for each in self.expected],
            "minimal_set": self.minimal_set,
            "unidentifiable": list(found.unidentifiable),
            "detectable": {effect: each.to_json() for effect, each in self.detectable.items()},
        }


def plan_noise_mm(plan: Plan, noise_um: float | None) -> float:
    """Return the noise of one reading, mm: as given, else as stated by the gauge, else assumed and reported."""
    if noise_um is not None:
        return noise_um / 1000.0
    stated = plan.gauge.stated_noise_mm
    if stated is None:
        say(f"the gauge has no stated noise: {ASSUMED_NOISE_UM} µm assumed (state it with --noise)", err=True)
        return ASSUMED_NOISE_UM / 1000.0
    return stated


def assess_plan(plan: Plan, model: Model, rate_hz: float, noise_um: float | None, origin: str) -> PlanAssessment:
    """Return what a plan would determine of a model's free values, and the detectable size of every effect.

    Parameters
    ----------
    plan : Plan
    model : Model
    rate_hz : float
        Readings per second.
    noise_um : float or None
        Standard deviation of one reading, µm; see `plan_noise_mm`.
    origin : str
        Name of the plan in error messages.

    Raises
    ------
    InputError
        The machine cannot follow a circle.
    """
    noise_mm = plan_noise_mm(plan, noise_um)
    with message_console().status(f"{origin}: what it determines"):
        sensitivity = plan_sensitivity(plan, with_every_effect(model), rate_hz, origin)
        return PlanAssessment(
            noise_um=noise_mm * 1000.0,
            readings=sensitivity.readings,
            observability=observability(sensitivity),
            expected=expected_uncertainties(sensitivity, noise_mm),
            minimal_set=[each.label for each in minimal_set(sensitivity)[0]],
            detectable=detectable_sizes(sensitivity, noise_mm),
        )


def _expected_json(expected: Expectation) -> dict[str, Any]:
    parameter = expected.parameter
    sigma = None if np.isnan(expected.sigma) else expected.sigma * shown_factor(parameter.unit)
    return {
        "effect": parameter.effect,
        "element": parameter.element,
        "name": parameter.name,
        "sigma": sigma,
        "unit": shown_unit(parameter.unit),
        "identifiable": expected.identifiable,
    }
