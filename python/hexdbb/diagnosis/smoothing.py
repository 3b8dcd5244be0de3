"""How smooth and how large a learned function is: by marginal likelihood, which is REML smoothing (Wood 2011)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis.noise import Noise, noise_of
from hexdbb.diagnosis.projection import Projection
from hexdbb.errors import InputError
from hexdbb.learned import Learned, Space
from hexdbb.model import LearnedEffect, Model
from hexdbb.samples import Samples

Floats = NDArray[np.float64]

ROUGHNESS = np.geomspace(0.1, 1e6, 15)
"""Penalties tried: from coefficients of their own to a straight line, two a decade."""
OTHER_NATS = 5.0
"""Log evidence that other splines must gain: 150 to 1, as for a name (`hexdbb.evidence.criteria`)."""
SIZES_MM = np.geomspace(1e-5, 10.0, 61)
"""Sizes tried: from a hundredth of a gauge's resolution to what breaks a machine, ten a decade."""


def learned_effect(samples: Samples, model: Model, name: str, noise: Noise | None = None) -> LearnedEffect:
    """Prepare a learned effect for a model: range of its variable, smoothness and size; it is fitted with the model.

    Parameters
    ----------
    samples : Samples
    model : Model
        Fitted to the samples, without the effect.
    name : str
        As in `learned:leg:5:turning_rate`.
    noise : Noise, optional
        Of one reading; that of the samples where not given.

    Raises
    ------
    InputError
        A name that is not known, or a variable that is not measured or hardly varies in these samples.
    """
    known = model.with_mounts(samples.mounts)
    around = Projection(samples, known, known.free, _noise(noise, samples))
    space = space_of(samples, model, name)
    best, found = _smoothed(space, around)
    for other in _variants(space, samples, model):
        splines = found.space.hypothesis.variable.count
        if other.hypothesis.variable.count > 2 * splines:
            continue  # twice as many gained nothing
        evidence, variant = _smoothed(other, around)
        if evidence > best + OTHER_NATS:
            best, found = evidence, variant
    return found


def _variants(space: Space, samples: Samples, model: Model) -> Iterator[Space]:
    """Yield the same functions with other splines, such as these samples can set."""
    for variant in space.hypothesis.variants():
        if variant != space.hypothesis:
            with suppress(InputError):
                yield Space.of(variant, samples, model.machine.sliders.screw_lead_mm)


def _smoothed(space: Space, around: Projection) -> tuple[float, LearnedEffect]:
    """Return the largest log evidence over smoothness and size, and the effect that has it."""
    information, gradient = around.of(_signature(space, around))
    square = _mean_square(space, around.samples)
    best, found = -np.inf, LearnedEffect(space, 1.0, 1.0)
    for roughness in ROUGHNESS if space.hypothesis.variable.is_smooth else ROUGHNESS[:1]:
        factor = space.prior_factor(float(roughness))
        rms = np.sqrt(np.sum(factor * (square @ factor)))  # of functions with unit prior
        whole = np.kron(np.eye(space.hypothesis.components), factor / rms)
        evidence, size_mm = _largest(whole.T @ information @ whole, whole.T @ gradient)
        if evidence > best:
            best, found = evidence, LearnedEffect(space, float(roughness), float(size_mm / rms))
    return best, found


def space_of(samples: Samples, model: Model, name: str) -> Space:
    """Return the functions that a name stands for, on some samples; `InputError` as `learned_effect`."""
    return Space.of(Learned.parse(name), samples, model.machine.sliders.screw_lead_mm)


def with_bands(model: Model, covariance: Floats, samples: Samples) -> Model:
    """Return a model whose learned effects have the uncertainty that a fit found; held ones keep theirs."""
    terms, at = [], 0
    for term in model.terms:
        own = slice(at, at + len(term.values))
        at = own.stop
        if term.learned is not None and term.free.any():
            term = replace(term, learned=term.learned.fitted(covariance[own, own], samples))
        terms.append(term)
    return replace(model, terms=tuple(terms))


def _noise(noise: Noise | None, samples: Samples) -> Noise:
    return noise_of(samples) if noise is None else noise


def _signature(space: Space, around: Projection) -> Floats:
    """Return what the functions do to the readings, shape (n, size), mm per mm."""
    parts = []
    for component in range(space.hypothesis.components):
        total = np.zeros((len(around.samples), space.hypothesis.variable.columns))
        for element, pushes in space.pushes(component, around.samples, around.samples.machine):
            answer = sum(weight * around.ports[:, port] for port, weight in pushes)
            total += np.asarray(answer)[:, None] * space.design(around.samples, element)
        parts.append(total)
    return np.hstack(parts)


def _mean_square(space: Space, samples: Samples) -> Floats:
    """Return the mean of B'B over samples and elements: c' of it c is the mean square of a function."""
    designs = [space.design(samples, element) for element in space.hypothesis.elements]
    found: Floats = np.mean([each.T @ each for each in designs], axis=0) / len(samples)
    return found


def _largest(information: Floats, gradient: Floats) -> tuple[float, float]:
    """Return the largest log marginal likelihood over sizes, and its size (mm)."""
    values, vectors = np.linalg.eigh(information)
    values = np.maximum(values, 0.0)
    turned = (vectors.T @ gradient) ** 2
    grown = SIZES_MM[:, None] ** 2
    evidence = 0.5 * np.sum(grown * turned / (1.0 + grown * values) - np.log1p(grown * values), axis=1)
    at = int(np.argmax(evidence))
    return float(evidence[at]), float(SIZES_MM[at])
