"""Model discrepancy: how far an effect's form differs from the machine's (Kennedy and O'Hagan 2001).

Beside an effect of the catalogue stand functions of its own variables at its own place (`homes.py`), of a size that is
a fraction f of the effect's, f half-normal with `Criteria.form_sigma`; f is chosen by marginal likelihood.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.forms.form_functions import Beside, FormFunctions, FormsAboutFit
from hexdbb.evidence.forms.homes import Home, Homes, at_each, discrepancy
from hexdbb.evidence.forms.laws_at_each import UNLIKE, Law, LawsAtEach, unlike
from hexdbb.evidence.linear.engine import Engine, Fitted
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.linear.signatures import varying
from hexdbb.learned import ALL, Learned
from hexdbb.learned.repeating import BY_MOUNT
from hexdbb.learned.variables import TIME
from hexdbb.model import Parameter

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Form:
    """How far an effect's form differs from the machine's: the relative size of the functions beside it.

    `columns` is how many directions of them stand in the linearisation, from column `first` on. `is_seen` tells
    that the form is measured well: no other effect is in the model, and geometry does not imitate nearly all of this
    one. `is_odd` tells that the machine's form is quite another.
    """

    fraction: float
    deviation: float
    functions: tuple[str, ...]
    columns: int = 0
    first: int = 0
    is_seen: bool = False
    is_odd: bool = False
    law: Law | None = field(default=None, repr=False, compare=False)
    """That of an effect which elements share, where they differ as those of one make do."""
    unlike: float = field(default=0.0, repr=False, compare=False)
    """By how much they differ: standard deviation of their sizes over the mean."""
    coefficients: tuple[tuple[Learned, Floats], ...] = field(default=(), repr=False, compare=False)
    """The functions, and their coefficients for one prior standard deviation along each direction (a column each)."""


class Forms:
    """Discrepancies of effects on one set of rows.

    Parameters
    ----------
    engine : Engine
    homes : Homes
    criteria : Criteria
    """

    def __init__(self, engine: Engine, homes: Homes, criteria: Criteria) -> None:
        self.engine, self.homes, self.criteria = engine, homes, criteria
        self._homes: dict[tuple[str, tuple[float, ...]], dict[tuple[str, str], list[Home]]] = {}
        """Homes of the values of each effect, by its shape: of its elements and names."""
        self.functions = FormFunctions(engine.readings, criteria)
        self.laws = LawsAtEach(engine, homes, self.functions)

    def beside(self, linear: Linear, fitted: Fitted, known: Known) -> tuple[Linear, Form]:
        """Return a linearisation with the discrepancy of an effect among its own values, and how large it is."""
        size_mm, groups = self._size(fitted, known)
        law, differ = self.laws.of(known, fitted.model), 0.0
        if law is not None:
            sizes = self.laws.sizes(linear, fitted, known, law)
            differ = unlike(sizes)
            law = law if differ <= UNLIKE else None
            size_mm = size_mm if law is None else max(size_mm, self.laws.rms_mm(law, sizes))
        best = self._chosen(linear, groups, size_mm) if groups and size_mm > 0.0 else None
        if best is None:
            return linear, Form(0.0, 0.0, ())
        functions, fraction = tuple(each.name for each in best.functions.functions), best.found.size
        if fraction <= 0.0:
            return linear, Form(0.0, 0.0, functions)
        is_of_law = law is not None and {law.shared, *at_each(law.shared)} <= {*best.functions.functions}
        rms_mm = self.laws.deviation_mm(best, law) if law is not None and is_of_law else self.functions.rms_mm(best)
        deviation = rms_mm * float(np.sqrt(best.seen)) / size_mm
        if deviation > self.criteria.form_limit and not self._are_sizes(linear, known):
            # At hundreds of times the noise no prior holds a discrepancy back: what differs so much is another cause.
            return linear, Form(0.0, 0.0, ())
        columns, first = best.factor.shape[1], linear.own.shape[1]
        is_seen = self._is_seen(fitted, known)
        is_odd = deviation > (self.criteria.form_as_seen if is_seen else self.criteria.form_named)
        form = Form(fraction, deviation, functions, columns, first, is_seen, is_odd, law, differ, best.coefficients)
        return self.with_columns(linear, form), form

    def _is_seen(self, fitted: Fitted, known: Known) -> bool:
        """Check that the form of an effect is measured well.

        Geometry must not imitate nearly all of the effect. No other effect may be in the model: the functions of the
        form would also describe what both leave together, as of play beside lags of all drives.
        """
        own, geometry = self.engine.values_of(fitted.model, known.effect, known.elements), self.engine.geometry(fitted)
        if not (own | geometry).all():
            return False
        whole, left = fitted.linear.beyond(own, geometry)
        return left >= self.criteria.form_seen * whole

    def _are_sizes(self, linear: Linear, known: Known) -> bool:
        """Check for an effect at several elements whose formula explains nearly all.

        Geometry takes what their sizes have in common, which then come out too small: of six drives that lag by six
        milliseconds, two. Beside these their forms are large.
        """
        before, left = self.engine.left_before, float(np.mean(linear.residual**2))
        return len(known.elements) > 1 and before - left >= self.criteria.form_explains * (before - 1.0)

    def with_columns(self, linear: Linear, form: Form) -> Linear:
        """Return a linearisation with the functions of a form among its own values."""
        return linear.wider(self.functions.columns(form.coefficients))

    def _chosen(self, linear: Linear, groups: Sequence[tuple[Learned, ...]], size_mm: float) -> Beside | None:
        """Choose functions by evidence, a variable at a time: one more only where the readings ask for it."""
        functions = list(dict.fromkeys(each for group in groups for each in group))
        about = FormsAboutFit(linear, self.functions, functions)
        left, best = list(groups), None
        chosen: tuple[Learned, ...] = ()
        for _ in range(self.criteria.most_homes):
            tried = [(group, about.beside((*chosen, *group), size_mm)) for group in left]
            seen = [(group, each) for group, each in tried if each is not None]
            if not seen:
                break
            group, found = max(seen, key=lambda each: each[1].found.log_evidence)
            if best is not None and found.found.log_evidence < best.found.log_evidence + self.criteria.detect_nats:
                break
            best, chosen = found, (*chosen, *group)
            left = [each for each in left if each is not group and not _says_it_freer(group, each)]
            if found.found.size <= 0.0:
                break
        return best

    def _size(self, fitted: Fitted, known: Known) -> tuple[float, list[tuple[Learned, ...]]]:
        """Return the RMS push (mm) of an effect as fitted, and the functions of its discrepancy by variable."""
        model, readings = fitted.model, self.engine.readings
        square = 0.0
        groups: list[tuple[Learned, ...]] = []
        is_set_up = self.engine.base.info(known.effect).is_set_up
        for place, column in enumerate(fitted.free):
            parameter = model.parameters()[column]
            if parameter.effect != known.effect or parameter.element not in known.elements or parameter.is_shape:
                continue
            # Columns of the discrepancies stand behind those of the free values.
            sigma = model.prior_sigma[column]
            ports = self.engine.absent.ports(parameter.effect)
            # Steps from circle to circle and growth with warmth imitate anything slow: only at the effect's own port do
            # they count as its form.
            homes = [
                each
                for each in self._homes_of(parameter, fitted, place)
                if each.hypothesis.port in ports or not each.is_of_forms
            ]
            if homes:
                places = self._places(parameter, homes)
                nearest = max(places[0], key=lambda each: each.explained)
                # The simplest function that says the same may be larger, by what geometry takes of it: so may a form.
                same = [each for each in homes if each.explained >= self.criteria.same_form]
                rms_mm = max(nearest.rms_mm, same[0].rms_mm if same else 0.0)
                square += (rms_mm * float(model.values[column]) / sigma) ** 2
                for each in places:
                    # Of few readings a variable may vary over all elements and have too few values at one.
                    near = discrepancy(each, self.criteria, is_set_up=is_set_up)
                    groups += [some for group in near if (some := tuple(varying(group, readings)))]
        assert len(readings) > 0
        groups = list(dict.fromkeys(groups))
        return float(np.sqrt(square)), groups if len(known.elements) == 1 else _by_variable(groups)

    def _homes_of(self, parameter: Parameter, fitted: Fitted, place: int) -> list[Home]:
        """Return the homes of a value's signature; those of an effect of one shape are the same in every trial."""
        model, effect = fitted.model, parameter.effect
        values = zip(model.parameters(), model.values, strict=True)
        shape = tuple(float(value) for each, value in values if each.effect == effect and each.is_shape)
        if (effect, shape) not in self._homes:
            table, whose = self.engine.absent.signatures_about_start(effect, model)
            found = zip(whose, self.homes.around_each(table), strict=True)
            self._homes[effect, shape] = {(element, name): homes for (_, element, name, _), homes in found}
        known = self._homes[effect, shape]
        if (parameter.element, parameter.name) not in known:  # the model has had it, and was fitted with it
            sigma = model.prior_sigma[fitted.free[place]]
            return self.homes.around_each(fitted.linear.own[:, [place]] * (sigma / fitted.prior_sigma[place]))[0]
        return known[parameter.element, parameter.name]

    def _places(self, parameter: Parameter, homes: list[Home]) -> list[list[Home]]:
        """Return the homes at an effect's own port by element, its own first; all together where none is there.

        At another port the same formula may read the same, as of a gauge that drifts and legs that grow alike; its form
        goes wrong where it is. Other elements count where they say exactly the same: joints of a pair off their places.
        What all legs share stays with all homes: a function of each leg's own beside it may imitate anything.
        """
        ports = self.engine.absent.ports(parameter.effect)
        there: dict[str, list[Home]] = {parameter.element: []}
        for each in homes:
            # The ball is one place, whichever fixing of it an element stands for.
            is_one_place = each.hypothesis.kind == "machine"
            element = parameter.element if is_one_place else str(each.hypothesis.element)
            says_the_same = element == parameter.element or each.explained >= self.criteria.same_form
            if each.hypothesis.port in ports and says_the_same:
                there.setdefault(element, []).append(each)
        is_there = bool(there[parameter.element]) and str(ALL) not in there
        return [place for place in there.values() if place] if is_there else [homes]


def _says_it_freer(chosen: tuple[Learned, ...], other: tuple[Learned, ...]) -> bool:
    """Check whether where a ball sits was said by circle already, beside which its seat by mount says a trifle more.

    Of a ball that moves a little with the tilt it was a five hundredth, which other circles refuted.
    """
    return bool(chosen[0].variable.instants) and other[0].variable.name.startswith(BY_MOUNT)


def _by_variable(groups: Sequence[tuple[Learned, ...]]) -> list[tuple[Learned, ...]]:
    """Put functions of one variable together: of an effect at several elements each has a form of its own.

    Those of time have few splines then: six screws, each of which swings as it likes, are a gauge that drifts.
    """
    found: dict[tuple[str, str], dict[Learned, None]] = {}
    for group in groups:
        few = [_of_few(each) if each.is_of_time and not each.variable.instants else each for each in group]
        found.setdefault((group[0].place, group[0].variable.name), {}).update(dict.fromkeys(few))
    return [tuple(each) for each in found.values()]


def _of_few(learned: Learned) -> Learned:
    """Return a function of time with no more splines than the simple one has."""
    return replace(learned, variable=replace(learned.variable, count=min(learned.variable.count, TIME.count)))
