"""What a test determines of a machine's errors, and how well: rank, condition, observability indices, uncertainties.

With J the first-order Jacobian (`sensitivity`), every column times the prior sigma of its value (0.1 mm, and
as an angle 0.1 mm at 300 mm) and all that unknowns of the set-up can explain taken out, and s_1 >= ... >= s_r its r
singular values above rounding, all divided by the square root of the number of readings n, so that indices compare
circles and not durations:

- condition s_1 / s_r: Driels, Pathre, J. Robotic Systems 7(2), 1990 (their O2 is its inverse); below 100 for a
  trustworthy identification (Schroeer 1993, as cited by Nahvi and Hollerbach);
- O1 = (s_1 ... s_r)^(1/r) / sqrt(n): Borm, Menq, Int. J. Robotics Research 10(1), 1991;
- O3 = s_r: Nahvi, Hollerbach, Hayward, IEEE ICRA 1994;
- O4 = s_r^2 / s_1, the noise amplification index: Nahvi, Hollerbach, IEEE ICRA 1996.

Uncertainty: covariance (J'J / noise^2 + I)^-1 in units of the prior sigmas, the posterior of the diagnosis, with
white noise. Minimal set: QR with column pivoting of the same J (Golub, Van Loan, Matrix Computations, 5.4.2): the
values chosen as pivots span all that the readings determine, so that the others can be held at zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.identifiability.redundancy import KNOWN_PART, sentences
from hexdbb.identifiability.sensitivity import Sensitivity
from hexdbb.model import Parameter

Floats = NDArray[np.float64]

TRUSTED_CONDITION = 100.0
"""Condition above which an identification is not trusted: the usual advice for the calibration of robots (Schroeer
1993, as cited by Nahvi and Hollerbach). The least determined combination of errors then takes in a hundred times as
much of what no model has (temperature, a wrong set-up) as the best determined."""
RELATIVE_RANK = 1e-8
"""Singular values below this part of the largest are rounding: about the square root of double precision."""


@dataclass(frozen=True)
class Observability:
    """Rank and indices of the machine's free values, set-up taken out.

    `singular_values` are of one reading on average (mm per prior sigma), descending, shape (values,); indices are 0
    where the rank is. `unidentifiable` are sentences.
    """

    values: int
    rank: int
    condition: float
    singular_values: Floats
    o1: float
    o3: float
    o4: float
    unidentifiable: tuple[str, ...]


def observability(sensitivity: Sensitivity) -> Observability:
    """Count what readings determine of the machine's free values, and name what they do not."""
    found = _core.identifiability(_machine_part(sensitivity), relative=RELATIVE_RANK)
    values: Floats = found.singular_values / np.sqrt(sensitivity.readings)
    seen = values[: found.rank]
    return Observability(
        values=len(values),
        rank=found.rank,
        condition=found.condition,
        singular_values=values,
        o1=float(np.exp(np.log(seen).mean())) if found.rank else 0.0,
        o3=float(seen[-1]) if found.rank else 0.0,
        o4=float(seen[-1] ** 2 / seen[0]) if found.rank else 0.0,
        unidentifiable=tuple(redundant_combinations(sensitivity)),
    )


def redundant_combinations(sensitivity: Sensitivity) -> list[str]:
    """Return in words which combinations of the free values no reading determines."""
    free = sensitivity.free
    return sentences(null_directions(sensitivity), sensitivity.where(free), sensitivity.displacements.of_values(free))


def null_directions(sensitivity: Sensitivity) -> Floats:
    """Return the directions of the free values, set-up included, along which no reading changes.

    Returns
    -------
    ndarray, shape (free values, k)
        Orthonormal columns, values in units of their prior sigma.
    """
    found = _core.identifiability(sensitivity.scaled(sensitivity.free), relative=RELATIVE_RANK)
    directions: Floats = found.unidentifiable
    return directions


def expected_covariance(sensitivity: Sensitivity, noise_mm: float) -> Floats:
    """Compute the covariance of the free values that a diagnosis of such readings would state.

    Parameters
    ----------
    sensitivity : Sensitivity
    noise_mm : float
        Standard deviation of one reading.

    Returns
    -------
    ndarray, shape (size, size)
        Engine units, prior included; zero where not free.
    """
    scaled = sensitivity.scaled(sensitivity.free) / noise_mm
    sizes = sensitivity.prior_sigma[sensitivity.free]
    covariance = np.zeros((len(sensitivity.parameters),) * 2)
    columns = np.flatnonzero(sensitivity.free)
    inverse = np.linalg.inv(scaled.T @ scaled + np.eye(len(sizes)))
    covariance[np.ix_(columns, columns)] = inverse * np.outer(sizes, sizes)
    return covariance


@dataclass(frozen=True)
class Expectation:
    """How well one value would be known; `sigma` in engine units, nan where known only in combination with others."""

    parameter: Parameter
    sigma: float
    identifiable: bool


def expected_uncertainties(sensitivity: Sensitivity, noise_mm: float) -> list[Expectation]:
    """Return how well each free value would be known at a gauge's noise."""
    spread = np.sqrt(np.diag(expected_covariance(sensitivity, noise_mm)))
    determined = spread <= KNOWN_PART * sensitivity.prior_sigma
    return [
        Expectation(parameter, float(sigma) if known else float("nan"), bool(known))
        for parameter, sigma, known, free in zip(
            sensitivity.parameters, spread, determined, sensitivity.free, strict=True
        )
        if free
    ]


def minimal_set(sensitivity: Sensitivity, relative: float = RELATIVE_RANK) -> tuple[list[Parameter], list[Parameter]]:
    """Choose as many of the machine's free values as the readings determine, so that the rest can be held at zero.

    Parameters
    ----------
    sensitivity : Sensitivity
    relative : float
        Pivots below this part of the first count as rounding, or as determined too weakly to matter.

    Returns
    -------
    kept, held : list of Parameter
        As many kept as the rank, in the order of the model.
    """
    parameters = sensitivity.where(sensitivity.free & ~sensitivity.is_set_up)
    kept = set(pivots(_machine_part(sensitivity), relative))
    return (
        [each for place, each in enumerate(parameters) if place in kept],
        [each for place, each in enumerate(parameters) if place not in kept],
    )


def pivots(scaled_jacobian: Floats, relative: float = RELATIVE_RANK) -> list[int]:
    """Return the columns in the order in which QR with column pivoting takes them, up to the rank.

    Parameters
    ----------
    scaled_jacobian : ndarray, shape (rows, values)
    relative : float
        Columns whose part not explained by those before is below this part of the first are left out.
    """
    _, rest = np.linalg.qr(scaled_jacobian)
    taken: list[int] = []
    limit = 0.0
    while len(taken) < min(rest.shape):
        norms = np.linalg.norm(rest, axis=0)
        norms[taken] = 0.0
        # Equal columns of a symmetric machine differ by rounding only: the first of them, so that the choice is the
        # same on every computer.
        best = int(np.flatnonzero(norms >= (1.0 - 1e-9) * norms.max())[0])
        limit = limit or relative * float(norms[best])
        if norms[best] <= limit:
            break
        unit = rest[:, best] / norms[best]
        rest = rest - np.outer(unit, unit @ rest)
        rest = rest - np.outer(unit, unit @ rest)
        taken.append(best)
    return taken


def _machine_part(sensitivity: Sensitivity) -> Floats:
    free, set_up = sensitivity.free, sensitivity.is_set_up
    return _core.project_out(sensitivity.scaled(free & ~set_up), sensitivity.scaled(free & set_up))
