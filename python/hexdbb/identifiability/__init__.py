"""What readings can determine: sensitivities, rank and condition, redundant combinations in words."""

from hexdbb.identifiability.indices import (
    TRUSTED_CONDITION,
    Expectation,
    Observability,
    expected_covariance,
    expected_uncertainties,
    minimal_set,
    null_directions,
    observability,
    pivots,
    redundant_combinations,
)
from hexdbb.identifiability.redundancy import KNOWN_PART, echelon, sentences
from hexdbb.identifiability.sensitivity import (
    Sensitivity,
    measured_sensitivity,
    plan_sensitivity,
    with_every_effect,
    with_planned_mounts,
)
from hexdbb.identifiability.structure import Displacements

__all__ = [
    "KNOWN_PART",
    "TRUSTED_CONDITION",
    "Displacements",
    "Expectation",
    "Observability",
    "Sensitivity",
    "echelon",
    "expected_covariance",
    "expected_uncertainties",
    "measured_sensitivity",
    "minimal_set",
    "null_directions",
    "observability",
    "pivots",
    "plan_sensitivity",
    "redundant_combinations",
    "sentences",
    "with_every_effect",
    "with_planned_mounts",
]
