"""Every candidate at once: what each absent effect could explain, to first order, of what the model cannot.

One pass over the samples gives J'J, J'r for the model's free values and all candidates together. For candidate
columns B the part the model's own values (with their expected sizes) cannot imitate is projected out,

    A = B'B - B'J (J'J + prior)^-1 J'B,   b = B'r - B'J (J'J + prior)^-1 J'r   (all divided by noise^2),

and b' A^+ b is the fall of chi-square the candidate offers. Linear algebra on a hundred columns takes no time, so all
effects are tried whole and element by element, and elements are gathered one after another while each pays for itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Noise
from hexdbb.model import Model, Parameter, new_term
from hexdbb.samples import Samples, normal_equations

Floats = NDArray[np.float64]

INVISIBLE = 1e-6
"""Eigenvalues of A below this part of B'B's largest are what the model imitates already."""
ELEMENT_PAYS = 10.0
"""A further element must gain this much more than its parameters cost (BIC)."""


@dataclass(frozen=True)
class Screened:
    """An effect, some of its elements, and the fall of chi-square they offer to first order."""

    effect: str
    elements: tuple[str, ...]
    gain: float
    parameters: int
    shape: float = 0.0
    """Where the values that shape the others stand, in expected sizes."""

    def bic_drop(self, readings: float) -> float:
        """Fall of the Bayesian information criterion (Schwarz 1978)."""
        return self.gain - self.parameters * float(np.log(readings))


@dataclass(frozen=True)
class Screen:
    """The projected normal equations of all candidates."""

    projected: Floats
    gradient: Floats
    scale: Floats
    """Diagonal of B'B: what a column could gain if the model imitated none of it."""
    parameters: tuple[Parameter, ...]
    readings: float
    """Number of independent readings."""
    shape: float = 0.0

    def effects(self) -> list[str]:
        """Names of the candidates."""
        return list(dict.fromkeys(each.effect for each in self.parameters))

    def elements(self, effect: str) -> list[str]:
        """Elements of one candidate."""
        return list(dict.fromkeys(each.element for each in self.parameters if each.effect == effect))

    def gain(self, effect: str, elements: Sequence[str]) -> Screened:
        """Fall of chi-square offered by an effect's elements together."""
        chosen = [
            index for index, each in enumerate(self.parameters) if each.effect == effect and each.element in elements
        ]
        gain, count = offered(self.projected[np.ix_(chosen, chosen)], self.gradient[chosen], self.scale[chosen])
        return Screened(effect, tuple(elements), float(gain), int(count), self.shape)

    def best_elements(self, effect: str) -> Screened:
        """Gather an effect's elements, best first, while each pays for itself."""
        left, best = self.elements(effect), Screened(effect, (), 0.0, 0)
        while left:
            tried = [self.gain(effect, (*best.elements, element)) for element in left]
            further = max(tried, key=lambda each: each.bic_drop(self.readings))
            if best.elements and further.bic_drop(self.readings) < best.bic_drop(self.readings) + ELEMENT_PAYS:
                break
            best = further
            left.remove(further.elements[-1])
        return replace(best, elements=tuple(each for each in self.elements(effect) if each in best.elements))


def offered(projected: Floats, gradient: Floats, scale: Floats) -> tuple[Floats, NDArray[np.intp]]:
    """Fall of chi-square b' A^+ b that columns offer, and in how many directions the model does not imitate them.

    Parameters
    ----------
    projected : ndarray, shape (..., k, k)
        A.
    gradient : ndarray, shape (..., k)
        b.
    scale : ndarray, shape (..., k)
        Diagonal of B'B.
    """
    values, vectors = np.linalg.eigh(projected)
    visible = values > INVISIBLE * np.maximum(scale.max(axis=-1, keepdims=True), 1e-300)
    along = np.einsum("...ji,...j->...i", vectors, gradient)
    gain = np.sum(np.divide(along**2, values, out=np.zeros_like(values), where=visible), axis=-1)
    return gain, np.sum(visible, axis=-1)


def screen(
    samples: Samples,
    model: Model,
    candidates: Sequence[str],
    noise: Noise,
    correlation: float,
    shape: float = 0.0,
) -> Screen:
    """Project every candidate onto what a fitted model cannot explain.

    Parameters
    ----------
    samples : Samples
    model : Model
        Fitted; its free values are what may imitate a candidate.
    candidates : sequence of str
        Effects to try; those the model has already are tried with the elements it holds at zero.
    noise : Noise
    correlation : float
        So many neighbouring readings tell as much as one.
    shape : float
        Where the candidates' shaping values (a time constant) stand, in expected sizes: first order cannot move them.
    """
    full, tried = _with_candidates(model, candidates, shape)
    equations = normal_equations(samples, full)
    weight = 1.0 / (noise.sigma_mm**2 * correlation)
    information, gradient = equations.information * weight, equations.gradient * weight
    parameters = full.parameters()
    own = np.flatnonzero(full.free)
    prior = full.prior_sigma[own]
    inner = np.linalg.cholesky(information[np.ix_(own, own)] + np.diag(prior**-2.0))
    cross = np.linalg.solve(inner, information[np.ix_(own, tried)])
    at_rest = np.linalg.solve(inner, gradient[own] - full.values[own] / prior**2)
    return Screen(
        projected=information[np.ix_(tried, tried)] - cross.T @ cross,
        gradient=gradient[tried] - cross.T @ at_rest,
        scale=np.diag(information)[tried],
        parameters=tuple(parameters[column] for column in tried),
        readings=len(samples) / correlation,
        shape=shape,
    )


def shaped(model: Model, chosen: NDArray[np.bool_], shape: float) -> Model:
    """Give the model with the shaping values among the chosen at `shape` expected sizes."""
    values = model.values.copy()
    for index, (each, is_chosen) in enumerate(zip(model.parameters(), chosen, strict=True)):
        if is_chosen and each.is_shape:
            values[index] = shape * each.prior_sigma
    return model.with_values(values)


def _with_candidates(model: Model, candidates: Sequence[str], shape: float) -> tuple[Model, NDArray[np.intp]]:
    """Give the model with all candidates held at zero, and the places of the values to try."""
    present = {term.effect for term in model.terms}
    terms = [new_term(name, model.info(name).size, free=False) for name in candidates if name not in present]
    full = replace(model, terms=(*model.terms, *terms))
    tried = np.array(
        [
            parameter.effect in candidates and not free and value == 0.0
            for parameter, free, value in zip(full.parameters(), full.free, full.values, strict=True)
        ]
    )
    acting = tried & np.array([not parameter.is_shape for parameter in full.parameters()])
    return shaped(full, tried, shape), np.flatnonzero(acting)
