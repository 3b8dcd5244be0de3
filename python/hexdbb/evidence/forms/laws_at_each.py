"""An effect that all legs share, by its one law, but of another size at each.

Legs that warm in a gradient grow by the same law, each by its own size. Geometry takes what they have in common, and
most of what the readings show is then how they differ: one value for all, fitted to that, is of any size, and its time
constant of any length. So the law is sought with six sizes of it, the effect is as large as these are, and formulas
explain what they do with them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.forms.alike import DIFFERENCES
from hexdbb.evidence.forms.form_functions import Beside, FormFunctions
from hexdbb.evidence.forms.homes import Homes, at_each
from hexdbb.evidence.linear.engine import Engine, Fitted
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.linear.sums import Sums
from hexdbb.learned import Learned
from hexdbb.model import Model

Floats = NDArray[np.float64]


FINER = (0.25, 0.12, 0.06)
"""Steps, in prior standard deviations, by which a shape is sought about the best of a grid: a time to a twentieth."""

UNLIKE = 0.4
"""Standard deviation of sizes over their mean, up to which elements are of one make: they differ by up to a third
(`alike.py`), and readings tell sizes to a tenth."""


@dataclass(frozen=True, eq=False)
class Law:
    """A law that six elements share.

    Attributes
    ----------
    shared : Learned
        The function of all elements that says it.
    parameter : str
        Name of the effect's value.
    coefficients : ndarray, shape (k,)
        With which the function says it, of one prior standard deviation of that value.
    columns : ndarray, shape (n, 6)
        What it does to the readings at each element, in noise standard deviations.
    """

    shared: Learned
    parameter: str
    coefficients: Floats
    columns: Floats

    @property
    def differences(self) -> Floats:
        """The same of what elements of one make differ by: a third at most."""
        return DIFFERENCES[-1] * self.columns


class LawsAtEach:
    """Laws of effects on one set of rows.

    Parameters
    ----------
    engine : Engine
    homes : Homes
    functions : FormFunctions
    """

    def __init__(self, engine: Engine, homes: Homes, functions: FormFunctions) -> None:
        self._engine, self._homes, self._functions = engine, homes, functions
        self._known: dict[tuple[str, tuple[float, ...]], Law | None] = {}

    def of(self, known: Known, model: Model) -> Law | None:
        """Return the law of an effect of a model, by its shape there; None of one that elements do not share.

        A gauge that is read late is one thing for all sliders, and belongs to the set-up.
        """
        if not known.is_whole or len(known.elements) != 1 or self._engine.base.info(known.effect).is_set_up:
            return None
        parameters = zip(model.parameters(), model.values, strict=True)
        shape = tuple(float(value) for each, value in parameters if each.effect == known.effect and each.is_shape)
        if (known.effect, shape) not in self._known:
            self._known[known.effect, shape] = self._made(known, model)
        return self._known[known.effect, shape]

    def with_best_shape(self, fitted: Fitted, known: Known) -> Fitted:
        """Return a fit with an effect's shape held where six sizes of its law explain most, if that is elsewhere."""
        model, criteria = fitted.model, self._engine.criteria
        is_shape = np.array([each.effect == known.effect and each.is_shape for each in model.parameters()])
        shape = is_shape & model.free
        law = self.of(known, model) if shape.any() else None
        if law is None:
            return fitted

        def explained(at: float) -> float:
            other = self.of(known, model.with_values(np.where(shape, at * model.prior_sigma, model.values)))
            return -np.inf if other is None else self._explains(fitted.linear, other)

        every = {each: explained(each) for each in criteria.shapes_for_all}
        for step in FINER:
            best = max(every, key=lambda each: every[each])
            every |= {each: explained(each) for each in (best - step, best + step)}
        best = max(every, key=lambda each: every[each])
        # A law that pushes next to nothing costs no evidence: beside legs that grow alike it would be the best of all.
        before = max(self._explains(fitted.linear, law), self._evidence(fitted.linear))
        if every[best] < before + criteria.detect_nats:
            return fitted
        held = model.with_values(np.where(shape, best * model.prior_sigma, model.values))
        found = self._engine.fit(held.with_free(held.free & ~shape))
        moved = self._as_they_differ(found, known)
        return fitted if moved is found else moved

    def _as_they_differ(self, fitted: Fitted, known: Known) -> Fitted:
        """Return a fit moved to the values that are best beside six sizes, which the form has: of either sign else."""
        law = self.of(known, fitted.model)
        if law is None or unlike(self.sizes(fitted.linear, fitted, known, law)) > UNLIKE:
            return fitted
        change = self._values(fitted.linear.wider(law.differences))[: len(fitted.free)]
        values = fitted.model.values.copy()
        values[fitted.free] += change * fitted.prior_sigma
        return self._engine.linearised(fitted.model.with_values(values))

    def rms_mm(self, law: Law, sizes: Floats) -> float:
        """Return the root mean square of what an effect pushes at six elements by sizes of its law."""
        return float(np.sqrt(np.mean(sizes**2))) * self._functions.signature(law.shared).rms_mm(law.coefficients)

    def sizes(self, linear: Linear, fitted: Fitted, known: Known, law: Law) -> Floats:
        """Return the sizes of an effect at six elements, shape (6,), in prior standard deviations of its value."""
        parameters = fitted.model.parameters()
        names = [(parameters[place].effect, parameters[place].name) for place in fitted.free]
        if (known.effect, law.parameter) not in names:  # it is held
            return np.zeros(law.columns.shape[1])
        common = names.index((known.effect, law.parameter))
        values = self._values(linear.wider(law.differences))
        unit = fitted.prior_sigma[common] / fitted.model.prior_sigma[fitted.free[common]]
        alike = unit * (linear.standing[common] + values[common])
        return np.asarray(alike + DIFFERENCES[-1] * values[-law.columns.shape[1] :], np.float64)

    def deviation_mm(self, beside: Beside, law: Law) -> float:
        """Return the root mean square of functions beside an effect less what is its law, of another size at each."""
        found = dict(
            zip(beside.functions.functions, np.split(beside.found.coefficients, beside.functions.ends), strict=True)
        )
        square, own = self._functions.signature(law.shared).square, law.coefficients
        common, total = found.pop(law.shared), 0.0
        for each in at_each(law.shared):
            total += float((left := _beyond(common + found.pop(each), own, square)) @ square @ left)
        others = sum(self._functions.signature(each).rms_mm(values) ** 2 for each, values in found.items())
        return float(np.sqrt(total / len(at_each(law.shared)) + others))

    def _explains(self, linear: Linear, law: Law) -> float:
        return self._evidence(linear.wider(law.differences))

    def _evidence(self, linear: Linear) -> float:
        white = Sums(linear, self._functions.readings, ()).whole.own
        return float(linear.log_evidence + 0.5 * white @ white)

    def _values(self, linear: Linear) -> Floats:
        return Sums(linear, self._functions.readings, ()).whole.own_values()

    def _made(self, known: Known, model: Model) -> Law | None:
        table, whose = self._engine.absent.signatures_about_start(known.effect, model)
        if not table.shape[1]:  # the model has had it
            return None
        most = int(np.argmax(np.sum(table**2, axis=0)))
        pushed = table[:, most]
        shared = self._homes.shared_by(pushed, self._engine.absent.ports(known.effect))
        if shared is None:
            return None
        law, *_ = np.linalg.lstsq(np.asarray(self._functions.signature(shared).table, np.float64), pushed, rcond=None)
        columns = [self._functions.signature(each).table @ law for each in at_each(shared)]
        return Law(shared, whose[most][2], np.asarray(law, np.float64), np.stack(columns, axis=1))


def unlike(sizes: Floats) -> float:
    """Return the standard deviation of an effect's sizes at its elements over their mean, infinite if that is zero.

    A hose that pulled at the platform was legs that give by next to nothing, each by much more or less.
    """
    mean = abs(float(np.mean(sizes)))
    return float(np.std(sizes)) / mean if mean > 0.0 else np.inf


def _beyond(values: Floats, law: Floats, square: Floats) -> Floats:
    """Return a function's coefficients less the part that is a law's."""
    left: Floats = values - law * float(values @ square @ law) / float(law @ square @ law)
    return left
