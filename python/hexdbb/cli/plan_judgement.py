"""What the plan commands have in common: a plan judged by what it can tell of a model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import click
import numpy as np

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
"""Of a gauge whose noise is not stated."""

noise_option: Callable[[Any], Any] = click.option(
    "--noise",
    "noise_um",
    type=click.FloatRange(min=0.0, min_open=True),
    help="Standard deviation of one reading, um; default: as the plan's gauge states it.",
)


@dataclass(frozen=True)
class Judgement:
    """What a plan can tell, at a noise."""

    noise_um: float
    readings: float
    observability: Observability
    expected: list[Expectation]
    kept: list[str]
    """Values of a minimal set; all others can be held at zero."""
    detectable: Mapping[str, Detectable]

    def to_json(self) -> dict[str, Any]:
        """Give its part of what `hexdbb plan check --json` prints."""
        found = self.observability
        return {
            "noise_um": self.noise_um,
            "rank": found.rank,
            "values": found.values,
            "condition": found.condition,
            "observability": {"o1": found.o1, "o3": found.o3, "o4": found.o4},
            "singular_values": [float(each) for each in found.singular_values],
            "parameters": [_expected_json(each) for each in self.expected],
            "minimal_set": self.kept,
            "unidentifiable": list(found.unidentifiable),
            "detectable": {effect: each.to_json() for effect, each in self.detectable.items()},
        }


def plan_noise_mm(plan: Plan, noise_um: float | None) -> float:
    """Find the noise to plan for: as asked for, else as the gauge states it, else assumed, which is said."""
    if noise_um is not None:
        return noise_um / 1000.0
    stated = plan.gauge.stated_noise_mm
    if stated is None:
        click.echo(f"the gauge states no noise: {ASSUMED_NOISE_UM} um assumed (--noise says better)", err=True)
        return ASSUMED_NOISE_UM / 1000.0
    return stated


def judge(plan: Plan, model: Model, rate_hz: float, noise_um: float | None, origin: str) -> Judgement:
    """Judge a plan by what it can tell of a model's free values, and of every effect of the catalogue."""
    noise_mm = plan_noise_mm(plan, noise_um)
    taken = plan_sensitivity(plan, with_every_effect(model), rate_hz, origin)
    return Judgement(
        noise_um=noise_mm * 1000.0,
        readings=taken.readings,
        observability=observability(taken),
        expected=expected_uncertainties(taken, noise_mm),
        kept=[each.label for each in minimal_set(taken)[0]],
        detectable=detectable_sizes(taken, noise_mm),
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
