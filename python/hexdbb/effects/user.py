"""A user's own effect: a function of the samples, with what it pushes, its unit and its expected size.

The function takes `hexdbb.samples.Samples` and returns the push per unit of the effect's value, in every sample and at
every place of the port: shape (n, 6) at the ports `slider` and `leg`, (n, 6, 3) at `slider_joint` and `platform_joint`,
(n, 3) at `ball` and `cup`, (n,) at `reading`. With six elements each slider (leg) has a value of its own, with three
each guideway, with one all share it. An effect of several parameters returns a sequence of such arrays, one each.

Shape parameters (where a dent lies, how wide it is) are fitted too. The function takes their values by name, as numbers
in their own unit; every element has shapes of its own.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.effects.tabulate import tabulated, tabulated_at
from hexdbb.errors import InputError
from hexdbb.model import Shape, Tabulated
from hexdbb.samples import PUSH_SHAPES, Samples
from hexdbb.units import VERBATIM

Basis = Callable[..., Any]

LOADING: ContextVar[list[UserEffect] | None] = ContextVar("LOADING", default=None)
"""Effects declared while a file is being loaded, those made in a loop among them."""
KINDS = {1: "machine", 3: "guideway", 6: "slider"}
"""What an element is, by their number."""
LIMIT_OF_SIGMA = 100.0
"""Limit of a value in prior standard deviations where the effect states none: far beyond any fault of a working
machine, so that it stops a diverging fit and nothing else."""


@dataclass(frozen=True)
class UserEffect:
    """A user's effect as it was declared; `line` is that of its function in `path`."""

    name: str
    physics: str
    port: str
    unit: str
    parameters: tuple[str, ...]
    prior_sigma: float
    limit: float
    elements: int
    basis: Basis
    path: str
    line: int
    declared_shapes: tuple[tuple[str, Shape], ...] = ()

    @property
    def shapes(self) -> Mapping[str, Shape]:
        """Shape parameters by name."""
        return dict(self.declared_shapes)

    @property
    def where(self) -> str:
        """File and line, as errors begin."""
        return f"{self.path}:{self.line}: effect {self.name}"

    def info(self) -> _core.EffectInfo:
        """Describe it as the engine's own are described."""
        kind = "leg" if self.elements == 6 and self.port in ("leg", "platform_joint") else KINDS[self.elements]
        return _core.EffectInfo(
            name=self.name,
            physics=self.physics,
            source=f"{self.path}:{self.line}",
            element_kind=kind,
            elements=[str(element + 1) for element in range(self.elements)],
            parameters=[
                _core.ParameterInfo(name=each, unit=self.unit, prior_sigma=self.prior_sigma, limit=self.limit)
                for each in self.parameters
            ]
            + [
                _core.ParameterInfo(
                    name=name, unit=VERBATIM + each.unit, prior_sigma=each.prior_sigma, limit=float("inf")
                )
                for name, each in self.declared_shapes
            ],
            ports=[self.port],
        )

    def tabulated(self, samples: Samples) -> Tabulated:
        """Evaluate it for a table of samples.

        Raises
        ------
        UserEffectError
            Its function raises, or returns a wrong shape or a value that is not finite.
        """
        return tabulated(self, samples, must_vary=False)

    def tabulated_at(self, samples: Samples, values: NDArray[np.float64]) -> Tabulated:
        """Evaluate it about some values of all its parameters, shape (size,); errors as `tabulated`."""
        return tabulated_at(self, samples, values)

    def require_usable(self, samples: Samples) -> None:
        """Check that it can be fitted to samples.

        Raises
        ------
        UserEffectError
            As `tabulated`, or where its push is the same in every sample.
        """
        tabulated(self, samples, must_vary=True)


def effect(
    *,
    port: str,
    unit: str,
    prior_sigma: float,
    elements: int = 1,
    parameters: Sequence[str] = ("size",),
    limit: float | None = None,
    shapes: Mapping[str, Shape] | None = None,
    name: str | None = None,
) -> Callable[[Basis], UserEffect]:
    """Declare a function of the samples an effect; its docstring's first line is the effect's physics.

    Parameters
    ----------
    port : str
        Where it pushes: slider, leg, slider_joint, platform_joint, ball, cup, reading.
    unit : str
        Of its values, such that value times basis is mm: ``mm`` where the basis is a pure number, ``mm/N``, ``s`` ...
    prior_sigma : float
        Prior standard deviation of its values: the size to expect before any measurement.
    elements : int
        6: a value for each slider or leg; 3: one for each guideway; 1: one for the whole machine.
    parameters : sequence of str
        Names of an element's values.
    limit : float, optional
        Values beyond +-limit make no physical sense; `LIMIT_OF_SIGMA` prior standard deviations where not given.
    shapes : mapping of str to Shape, optional
        Fitted shape parameters; the function takes them by these names.
    name : str, optional
        Of the effect, for effects made in a loop; the function's where not given.

    Raises
    ------
    InputError
        Naming the file, line and option that is wrong.
    """

    def declare(function: Basis) -> UserEffect:
        code = function.__code__
        text = (function.__doc__ or "").strip().splitlines()
        declared = UserEffect(
            name=name or function.__name__,
            physics=text[0] if text else f"User's effect {function.__name__}.",
            port=port,
            unit=unit,
            parameters=tuple(parameters),
            prior_sigma=prior_sigma,
            limit=LIMIT_OF_SIGMA * prior_sigma if limit is None else limit,
            elements=elements,
            basis=function,
            path=code.co_filename,
            line=code.co_firstlineno,
            declared_shapes=tuple((shapes or {}).items()),
        )
        _check(declared)
        _check_shapes(declared)
        loading = LOADING.get()
        if loading is not None:
            loading.append(declared)
        return declared

    return declare


def _check_shapes(declared: UserEffect) -> None:
    arguments = inspect.signature(declared.basis).parameters
    takes_any = any(each.kind is inspect.Parameter.VAR_KEYWORD for each in arguments.values())
    for name, shape in declared.declared_shapes:
        of = f"{declared.where}: shape {name}"
        if not isinstance(shape, Shape):
            raise InputError(f"{of}: {shape!r} (expected Shape(start, prior_sigma=...))")
        if name in declared.parameters:
            raise InputError(f"{of}: the name of a parameter too (expected another)")
        if name not in arguments and not takes_any:
            raise InputError(f"{of}: the function takes no {name!r} (expected an argument of that name)")
        if not 0.0 < shape.prior_sigma < float("inf"):
            raise InputError(f"{of}: prior_sigma {shape.prior_sigma!r} (expected a number > 0)")
        if not shape.lower < shape.start < shape.upper:
            domain = f"{shape.lower:g} to {shape.upper:g} {shape.unit}"
            raise InputError(f"{of}: start {shape.start:g} {shape.unit} (expected it within its domain, {domain})")


def _check(declared: UserEffect) -> None:
    shape = PUSH_SHAPES.get(declared.port)
    if shape is None:
        raise InputError(f"{declared.where}: port {declared.port!r} (expected one of {', '.join(PUSH_SHAPES)})")
    possible = (1, 3, 6) if shape[:1] == (6,) else (1,)
    if declared.elements not in possible:
        counts = " or ".join(map(str, possible))
        raise InputError(
            f"{declared.where}: elements {declared.elements!r} (expected {counts} at port {declared.port})"
        )
    if not declared.parameters:
        raise InputError(f"{declared.where}: parameters () (expected at least one name)")
    if not 0.0 < declared.prior_sigma < float("inf"):
        raise InputError(f"{declared.where}: prior_sigma {declared.prior_sigma!r} (expected a number > 0)")
    if not declared.limit > 0.0:
        raise InputError(f"{declared.where}: limit {declared.limit!r} (expected a number > 0)")
    if declared.name in _core.effect_names():
        raise InputError(f"{declared.where}: the name is that of a known effect (expected another)")
