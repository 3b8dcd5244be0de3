"""Model discrepancy: how far an effect's form differs from the machine's (Kennedy and O'Hagan 2001).

Beside an effect of the catalogue stand functions of its own variables at its own place (`homes.py`), of a size that is
a fraction f of the effect's, f half-normal with `Criteria.form_sigma`; f is chosen by marginal likelihood.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.engine import Engine, Fitted
from hexdbb.evidence.homes import Home, Homes, discrepancy
from hexdbb.evidence.marginal import Marginal, marginal
from hexdbb.evidence.readings import Linear
from hexdbb.evidence.screen import Known
from hexdbb.evidence.signatures import Signature, signature_of, varying
from hexdbb.evidence.sums import Block, Projected, Sums
from hexdbb.learned import ALL, Learned
from hexdbb.model import Parameter

Floats = NDArray[np.float64]
KEPT = 48
"""Signatures kept in memory, of a megabyte or two each: those of an effect's homes are asked for in every trial."""

KEPT_SQUARES = 8192
"""Products of two of them kept, about ten kilobytes each: they are the same about every fit. An effect at all elements
needs several thousand; with 1024 they were evicted before they were used again, which took a sixth of a search."""


@dataclass(frozen=True)
class Form:
    """How far an effect's form differs from the machine's: the relative size of the functions beside it.

    `columns` is how many directions of them stand in the linearisation, from column `first` on.
    """

    fraction: float
    deviation: float
    functions: tuple[str, ...]
    columns: int = 0
    first: int = 0


@dataclass(frozen=True, eq=False)
class Beside:
    """Functions beside an effect: their spaces, prior, sums, and evidence."""

    spaces: Sequence[Signature]
    factor: Floats
    square: Floats
    projected: Projected
    found: Marginal

    def columns(self) -> Floats:
        """Return what they do to the readings, per prior standard deviation at the best size."""
        at, total = 0, np.zeros((len(self.spaces[0].table), self.factor.shape[1]))
        for space in self.spaces:
            width = space.table.shape[1]
            total += space.table @ (self.factor[at : at + width] * self.found.size)
            at += width
        return total


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
        self._signature = lru_cache(KEPT)(partial(signature_of, readings=engine.readings))
        self._square = lru_cache(KEPT_SQUARES)(self._product)

    def beside(self, linear: Linear, fitted: Fitted, known: Known) -> tuple[Linear, Form]:
        """Return a linearisation with the discrepancy of an effect among its own values, and how large it is."""
        size_mm, groups = self._size(fitted, known)
        best = self._chosen(linear, groups, size_mm) if groups and size_mm > 0.0 else None
        if best is None:
            return linear, Form(0.0, 0.0, ())
        spaces, found = best.spaces, best.found
        functions = tuple(each.hypothesis.name for each in spaces)
        if found.size <= 0.0:
            return linear, Form(0.0, 0.0, functions)
        at, squares = 0, []
        for space in spaces:
            width = space.table.shape[1]
            squares.append(space.rms_mm(found.coefficients[at : at + width]) ** 2)
            at += width
        seen = _seen(found.coefficients, best.projected.information, best.square)
        deviation = float(np.sqrt(sum(squares) * seen)) / size_mm
        if deviation > self.criteria.form_limit:
            # At hundreds of times the noise no prior holds a discrepancy back: what differs so much is another cause.
            return linear, Form(0.0, 0.0, ())
        columns = best.columns()
        form = Form(found.size, deviation, functions, columns.shape[1], linear.own.shape[1])
        return linear.wider(columns), form

    def _chosen(self, linear: Linear, groups: Sequence[tuple[Learned, ...]], size_mm: float) -> Beside | None:
        """Choose functions by evidence, a variable at a time: one more only where the readings ask for it."""
        sums = Sums(linear, self.engine.readings, ())
        cross = {each: sums.cross(self._signature(each).table) for group in groups for each in group}
        left, best = list(groups), None
        chosen: tuple[Learned, ...] = ()
        for _ in range(self.criteria.most_homes):
            tried = [(group, self._beside(sums, cross, (*chosen, *group), size_mm)) for group in left]
            seen = [(group, each) for group, each in tried if each is not None]
            if not seen:
                break
            group, found = max(seen, key=lambda each: each[1].found.log_evidence)
            if best is not None and found.found.log_evidence < best.found.log_evidence + self.criteria.detect_nats:
                break
            best, chosen = found, (*chosen, *group)
            left.remove(group)
            if found.found.size <= 0.0:
                break
        return best

    def _beside(
        self, sums: Sums, cross: Mapping[Learned, Floats], functions: Sequence[Learned], size_mm: float
    ) -> Beside | None:
        """Weigh the evidence for some functions beside an effect; None where nothing of them can be seen.

        `cross` are the sums W'[J y] of each of them.
        """
        spaces = [self._signature(each) for each in functions]
        roughness = self.criteria.roughness[1]
        parts = [space.prior_factor(roughness if space.hypothesis.variable.is_smooth else 1.0) for space in spaces]
        factor = diagonal(parts) * (size_mm / np.sqrt(len(spaces)))
        square = np.block([[self._square(one, other) for other in functions] for one in functions])
        projected = sums.whole.project(Block(square[None], np.concatenate([cross[each] for each in functions], axis=1)))
        factor = _visible(factor, projected.information, square, self.criteria.form_visible)
        if not factor.shape[1]:
            return None
        grid = np.array(self.criteria.form_grid)
        weights = np.exp(-0.5 * (grid / self.criteria.form_sigma) ** 2)  # half-normal
        found = marginal(projected.information, projected.gradient, [factor], grid, weights / weights.sum())
        return Beside(spaces, factor, square, projected, found)

    def _product(self, one: Learned, other: Learned) -> Floats:
        found: Floats = self._signature(one).table.T @ self._signature(other).table
        return found

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


def _by_variable(groups: Sequence[tuple[Learned, ...]]) -> list[tuple[Learned, ...]]:
    """Put functions of one variable together: of an effect at several elements each has a form of its own."""
    found: dict[tuple[str, str], dict[Learned, None]] = {}
    for group in groups:
        found.setdefault((group[0].place, group[0].variable.name), {}).update(dict.fromkeys(group))
    return [tuple(each) for each in found.values()]


def _seen(coefficients: Floats, projected: Floats, whole: Floats) -> float:
    """Compute the part of functions' mean square that the model's own values do not imitate.

    What the effect itself or geometry could have taken says nothing of the effect's form.
    """
    return float((coefficients @ projected @ coefficients) / (coefficients @ whole @ coefficients))


def _visible(factor: Floats, projected: Floats, whole: Floats, least: float) -> Floats:
    """Keep the directions of a discrepancy that the model's own values do not imitate: shape (k, r)."""
    values, vectors = np.linalg.eigh(factor.T @ whole @ factor)
    kept = values > 1e-9 * values[-1]
    white = factor @ (vectors[:, kept] / np.sqrt(values[kept]))
    shares, turned = np.linalg.eigh(white.T @ projected @ white)
    # Back in the prior's own scale: a direction's size is what it was before it was whitened.
    own = np.sqrt(values[kept])[:, None] * turned
    seen = shares > least
    axes, _ = np.linalg.qr(own[:, seen]) if seen.any() else (own[:, :0], None)
    found: Floats = factor @ vectors[:, kept] @ axes
    return found


def diagonal(parts: Sequence[Floats]) -> Floats:
    """Return the matrix with some matrices along its diagonal."""
    width = sum(each.shape[0] for each in parts)
    table, at = np.zeros((width, sum(each.shape[1] for each in parts))), [0, 0]
    for each in parts:
        table[at[0] : at[0] + each.shape[0], at[1] : at[1] + each.shape[1]] = each
        at[0] += each.shape[0]
        at[1] += each.shape[1]
    return table
