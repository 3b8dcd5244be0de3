"""Fits of shape parameters of users' effects: Gauss-Newton, the effects evaluated again at every step.

To the engine an effect with shapes is a table about its present shapes: the push per unit of every size, and the
derivative of the push by every shape. It fits both; the shapes move there, and the table is made anew, until they stay.
The engine's priors are centred on the present shapes; the step back to the declared start is added here. Where an
effect's sizes are still zero, its shapes are first sought on a grid about their starts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis.noise import Noise
from hexdbb.diagnosis.projection import Projection
from hexdbb.model import Model, is_shaped
from hexdbb.samples import Samples, normal_equations, predict

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Fit = Callable[[Model], _core.FitResult]

STEPS = 25
"""Steps after which the fit ends: Gauss-Newton on some tens of readings per bump ends in five to ten."""
SETTLED = 0.01
"""Largest step, in standard deviations of the shape, that counts as none: a tenth of what a table shows."""
LONGEST = 1.0
"""Longest step, in prior standard deviations: beyond that the derivative says little."""
HALVINGS = 6
"""Times a step that makes the fit worse is halved."""
STARTS = (-2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0)
"""Grid of starts, in prior standard deviations: a shape is within it in 95 of 100 cases."""
MOST_STARTS = 800
"""Combinations of starts that are tried at most; with more shapes every second one of the grid is left out."""


def fit_shapes(samples: Samples, model: Model, free: Bools, noise: Noise, fit: Fit) -> tuple[Model, _core.FitResult]:
    """Fit a model in which shape parameters are free.

    Parameters
    ----------
    samples : Samples
    model : Model
        Start.
    free : ndarray of bool, shape (size,)
    noise : Noise
    fit : callable
        The engine's fit of the free values of a model, shapes as differences from where they are.

    Returns
    -------
    model : Model
        With the values fitted.
    result : FitResult
        Of the last fit; its shapes are differences from the model's.
    """
    is_shape, parameters = model.shaped, model.parameters()
    lower = np.array([each.shape.lower if each.shape else -np.inf for each in parameters])
    upper = np.array([each.shape.upper if each.shape else np.inf for each in parameters])
    present, first = started(samples, model, free, noise), None
    for _ in range(STEPS):
        result = fit(present)
        first = first or result
        moved, spread = _corrected(samples, present, result, free, noise)
        step = np.where(is_shape & free, moved, 0.0)
        step = np.clip(step, -LONGEST * model.prior_sigma, LONGEST * model.prior_sigma)
        others = np.where(is_shape, present.values, result.values)
        if (np.abs(step)[is_shape] <= SETTLED * spread[is_shape]).all():
            return present.with_values(others), result
        before = _cost(samples, present, noise)
        for halving in range(HALVINGS + 1):
            shapes = np.clip(present.values + 0.5**halving * step, lower, upper)
            there = present.with_values(np.where(is_shape, shapes, others))
            if _cost(samples, there, noise) <= before:
                break
        else:
            return present.with_values(others), result
        present = there
    return present, fit(present)


def started(samples: Samples, model: Model, free: Bools, noise: Noise) -> Model:
    """Return a model in which shapes of effects whose sizes are zero stand where the readings want them most."""
    around: Projection | None = None
    values = model.values.copy()
    for effect, element, sizes, shapes in _elements(model):
        own = model.own(effect)
        if values[sizes].any() or not free[shapes].any() or not is_shaped(own):
            continue
        around = around or Projection(samples, model, free & ~model.shaped, noise)
        values[shapes] = _sought(around, model, effect, element, sizes, shapes, free)
    return model.with_values(values)


def _elements(model: Model) -> Iterator[tuple[str, int, NDArray[np.intp], NDArray[np.intp]]]:
    """Yield effect and element of all that have shapes, with the places of their sizes and shapes."""
    parameters = model.parameters()
    keys = dict.fromkeys((each.effect, each.element) for each in parameters if each.shape is not None)
    for effect, element in keys:
        own = np.array([i for i, each in enumerate(parameters) if (each.effect, each.element) == (effect, element)])
        is_shape = np.array([parameters[i].shape is not None for i in own])
        elements = list(dict.fromkeys(each.element for each in parameters if each.effect == effect))
        yield effect, elements.index(element), own[~is_shape], own[is_shape]


def _sought(
    around: Projection,
    model: Model,
    effect: str,
    element: int,
    sizes: NDArray[np.intp],
    shapes: NDArray[np.intp],
    free: Bools,
) -> Floats:
    """Return the shapes of one element that explain most of the residual, of a grid about their starts."""
    term, own = model.term(effect), model.own(effect)
    assert term is not None and is_shaped(own)
    first = int(np.flatnonzero([each.effect == effect for each in model.parameters()])[0])
    best, found = -np.inf, model.values[shapes]
    for candidate in _grid(model, shapes, free):
        values = term.values.copy()
        values[shapes - first] = candidate
        table = own.tabulated_at(around.samples, values)
        signature = np.zeros((len(around.samples), len(sizes)))
        for value, port, column in zip(table.values, table.ports, table.per_unit.T, strict=True):
            if value + first in sizes:
                signature[:, int(np.flatnonzero(sizes == value + first)[0])] += around.ports[:, port] * column
        information, gradient = around.of(signature)
        prior = model.prior_sigma[sizes]
        scaled = information * np.outer(prior, prior) + np.eye(len(sizes))
        explained = float(gradient * prior @ np.linalg.solve(scaled, gradient * prior))
        explained -= float(np.sum(((candidate - model.start[shapes]) / model.prior_sigma[shapes]) ** 2))
        if explained > best:
            best, found = explained, candidate
    return found


def _grid(model: Model, shapes: NDArray[np.intp], free: Bools) -> Iterator[Floats]:
    steps = STARTS if len(STARTS) ** len(shapes) <= MOST_STARTS else STARTS[::2]
    parameters, axes = model.parameters(), []
    for place in shapes:
        shape = parameters[place].shape
        assert shape is not None
        wanted = [shape.start + each * shape.prior_sigma for each in steps]
        inside = [each for each in wanted if shape.lower < each < shape.upper]
        axes.append(inside if free[place] else [model.values[place]])
    for each in product(*axes):
        yield np.array(each)


def _corrected(
    samples: Samples, model: Model, result: _core.FitResult, free: Bools, noise: Noise
) -> tuple[Floats, Floats]:
    """Return the step of all values with the priors of shapes about their starts, and the values' spread."""
    prior = model.prior_sigma
    columns = np.flatnonzero(free)
    scale = prior[columns] / noise.sigma_mm
    information = normal_equations(samples, model).information[np.ix_(columns, columns)] * np.outer(scale, scale)
    covariance = np.linalg.inv(information + np.eye(len(columns)))
    away = np.where(model.shaped, (model.values - model.start) / prior, 0.0)[columns]
    moved = np.zeros(len(prior))
    moved[columns] = (result.values - np.where(model.shaped, 0.0, model.values))[columns]
    moved[columns] -= prior[columns] * (covariance @ away)
    spread = np.ones(len(prior))
    spread[columns] = prior[columns] * np.sqrt(np.diag(covariance))
    return moved, spread


def _cost(samples: Samples, model: Model, noise: Noise) -> float:
    residual = predict(samples, model).residual_mm / noise.sigma_mm
    standing = (model.values - model.start) / model.prior_sigma
    return float(residual @ residual + standing @ standing)
