"""What readings can determine: sensitivities, rank and condition, redundant combinations in words."""

from hexdbb.identifiability.indices import (
    Expectation,
    Observability,
    expected_covariance,
    expected_uncertainties,
    minimal_set,
    null_directions,
    observability,
    pivots,
)
from hexdbb.identifiability.redundancy import echelon, sentences
from hexdbb.identifiability.sensitivity import (
    Sensitivity,
    plan_sensitivity,
    readings_of,
    record_sensitivity,
    set_up_of,
    with_every_effect,
    with_planned_mounts,
)

__all__ = [
    "Expectation",
    "Observability",
    "Sensitivity",
    "echelon",
    "expected_covariance",
    "expected_uncertainties",
    "minimal_set",
    "null_directions",
    "observability",
    "pivots",
    "plan_sensitivity",
    "readings_of",
    "record_sensitivity",
    "sentences",
    "set_up_of",
    "with_every_effect",
    "with_planned_mounts",
]
