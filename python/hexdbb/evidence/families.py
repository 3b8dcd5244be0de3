"""Hypotheses that are learned: a place, its elements, and a space of functions of a variable.

The signature of one is linear in the functions' coefficients: W = sum over the places e of S_e B(u_e), S the reading's
answer to a push there (`readings.py`), B the spline's design at the variable of that element (`variables.py`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence import variables as v
from hexdbb.evidence.readings import Linear, Readings, State
from hexdbb.evidence.variables import Variable

Floats = NDArray[np.float64]

ALL = 0
"""Element number of a function that all elements share."""


@dataclass(frozen=True)
class Learned:
    """One hypothesis.

    Attributes
    ----------
    place : str
        `slider`, `leg`, `lateral`, `vertical`, `platform_joint`, `ball`, `cup`, `reading`.
    element : int
        From 1: slider, leg or guideway; `ALL` where all share the function, or there is one only.
    variable : Variable
    """

    place: str
    element: int
    variable: Variable

    @property
    def name(self) -> str:
        """Name, as `hexdbb add` takes it."""
        element = f":{self.element}" if self.element else ":all" if self.place in ("slider", "leg") else ""
        return f"learned:{self.place}{element}:{self.variable.name}"

    @property
    def places(self) -> tuple[tuple[int, int], ...]:
        """Columns of the place's pushes, each with the element of the state that it goes by."""
        if self.place in ("slider", "leg"):
            chosen = range(6) if self.element == ALL else (self.element - 1,)
            return tuple((each, each) for each in chosen)
        if self.place in ("lateral", "vertical"):
            return tuple((each, each) for each in (2 * self.element - 2, 2 * self.element - 1))
        if self.place == "platform_joint":
            return ((self.element - 1, self.element - 1),)
        return ((0, 0),)

    @property
    def components(self) -> int:
        """Number of functions: one, or one for each axis of the ball and the cup."""
        return 3 if self.place in ("ball", "cup", "platform_joint") else 1

    def bounds(self, state: Mapping[str, Floats]) -> tuple[float, float]:
        """Return the range of the variable over all its elements."""
        if not self.variable.column:
            return 0.0, 1.0
        ends = [self.variable.bounds(state, element) for _, element in self.places]
        return min(low for low, _ in ends), max(high for _, high in ends)

    def basis(self, state: Mapping[str, Floats]) -> list[tuple[int, Floats]]:
        """Return the functions at each place: column of the place's pushes and design, shape (n, columns)."""
        bounds = self.bounds(state) if self.variable.needs_bounds else None
        found = [(column, _design(state, self.variable, element, bounds)) for column, element in self.places]
        if self.components == 3:
            first = 3 * max(self.element - 1, 0)
            return [(first + component, found[0][1]) for component in range(3)]
        return found

    def space(self, linear: Linear, readings: Readings) -> Space:
        """Return the hypothesis in numbers: its signature in a linearisation, and how large its functions are."""
        sensitivity = linear.pushes[self.place]
        found = self.basis(readings.state)
        parts = [sensitivity[:, [column]] * design for column, design in found]
        signature = np.hstack(parts) if self.components == 3 else sum(parts[1:], parts[0])
        designs = [found[0][1]] if self.components == 3 else [design for _, design in found]
        square = np.mean([design.T @ design for design in designs], axis=0) / len(readings)
        return Space(self, signature, square)


def _design(
    state: Mapping[str, Floats], variable: Variable, element: int, bounds: tuple[float, float] | None
) -> Floats:
    """Return a variable's design, kept while its state lives: places share their variables."""
    if not isinstance(state, State):
        return variable.design(state, element, bounds)
    key = (variable, element, bounds)
    if key not in state.designs:
        state.designs[key] = variable.design(state, element, bounds).astype(np.float32)
    found: Floats = state.designs[key]
    return found


@dataclass(frozen=True, eq=False)
class Space:
    """A learned hypothesis in numbers.

    Attributes
    ----------
    hypothesis : Learned
    signature : ndarray, shape (n, components x columns)
        W, in noise standard deviations per mm.
    square : ndarray, shape (columns, columns)
        Mean over rows and elements of B'B: c' square c is the mean square of a function, mm^2.
    """

    hypothesis: Learned
    signature: Floats
    square: Floats

    def prior_factor(self, roughness: float) -> Floats:
        """Return T such that coefficients T z, z standard normal, make functions of mean square one over the rows."""
        factor = self.hypothesis.variable.prior_factor(roughness)
        factor = factor / np.sqrt(max(float(np.sum(factor * (self.square @ factor))), 1e-300))
        return np.kron(np.eye(self.hypothesis.components), factor)

    def rms_mm(self, coefficients: Floats) -> float:
        """Return the root mean square of the functions of some coefficients."""
        parts = coefficients.reshape(self.hypothesis.components, -1)
        return float(np.sqrt(np.einsum("ci,ij,cj->", parts, self.square, parts)))


def learned_hypotheses(readings: Readings) -> Iterator[Learned]:
    """Yield every hypothesis whose variable varies in the readings."""
    for each in _all(readings.screw_lead_mm):
        if all(each.variable.varies(readings.state, element) for _, element in each.places):
            yield each


def _all(screw_lead_mm: float) -> Iterator[Learned]:
    phase = v.screw_phase(screw_lead_mm)
    for place, variables in (("slider", (*v.OF_SLIDER, phase)), ("leg", v.OF_LEG)):
        for variable in variables:
            for element in (
                (1, 2, 3, 4, 5, 6) if variable in (v.FINE_POSITION, v.FINE_TIME) else (1, 2, 3, 4, 5, 6, ALL)
            ):
                yield Learned(place, element, variable)
    for place in ("lateral", "vertical"):
        for guideway in (1, 2, 3):
            for variable in v.OF_GUIDEWAY:
                yield Learned(place, guideway, variable)
    for leg in range(1, 7):
        for variable in v.OF_PLATFORM_JOINT:
            yield Learned("platform_joint", leg, variable)
    for place in ("ball", "cup"):
        for variable in v.OF_BALL:
            yield Learned(place, ALL, variable)
    for variable in v.OF_READING:
        yield Learned("reading", ALL, variable)
