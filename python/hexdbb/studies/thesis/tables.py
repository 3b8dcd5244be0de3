"""The thesis' Tables 5.1-5.8: given errors against those that its estimator identifies (section 5-3).

One level circle, ball in the joint plane, cup where planned, guideway 3 the reference without errors. The scan has the
tables' captions but not their numbers: the given values here are our own. Where A'A is singular, equation (5.5) has no
solution; the solution of smallest norm is used instead, which is unique.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from hexdbb.studies.thesis.circular_test import CircularTest, joint_plane_circle, joint_plane_test
from hexdbb.studies.thesis.contours import reference_contours
from hexdbb.studies.thesis.estimator import SINGULAR, ThesisEstimate, thesis_estimate, thesis_estimate_record
from hexdbb.studies.thesis.simulated import simulated_record
from hexdbb.studies.thesis.unknowns import GEOMETRIC_ERRORS, UNKNOWNS

Floats = NDArray[np.float64]

LEGS = ("leg1", "leg3", "leg5")
FIVE = (*LEGS, "y1", "y2")
SEVEN = (*FIVE, "xy1", "xy2")
"""The seven errors that the thesis identifies."""
ROTATIONS = ("xy1", "xy2", "yz1", "yz2", "centre1", "centre2")
"""Rotations of the guideways that are not the reference."""


@dataclass(frozen=True)
class ThesisTable:
    """One of the thesis' tables: the given errors, and whether the thesis finds all of them identified."""

    number: str
    errors: tuple[str, ...]
    thesis_says_identified: bool


TABLES = (
    ThesisTable("5.1", FIVE, True),
    ThesisTable("5.2 (third translation: x1)", (*FIVE, "x1"), False),
    ThesisTable("5.2 (third translation: y3)", (*FIVE, "y3"), False),
    ThesisTable("5.3", (*LEGS, "leg2"), False),
    ThesisTable("5.4", (*FIVE, "xy1"), True),
    ThesisTable("5.5", SEVEN, True),
    ThesisTable("5.6 (third rotation: yz1)", (*SEVEN, "yz1"), False),
    ThesisTable("5.6 (third rotation: centre1)", (*SEVEN, "centre1"), False),
    ThesisTable("5.7", (*SEVEN, "yz1", "yz2"), False),
)
"""The thesis does not state which third translation and which rotations it used: both kinds are computed."""

GIVEN = {
    "leg1": 0.050,
    "leg2": 0.020,
    "leg3": -0.030,
    "leg5": 0.080,
    "x1": 0.070,
    "y1": 0.060,
    "y2": -0.040,
    "y3": 0.030,
    "xy1": 2.0e-4,
    "xy2": -1.0e-4,
    "yz1": 1.5e-4,
    "yz2": 3.0e-4,
    "centre1": -2.5e-4,
}
"""Given values, mm and rad."""

AGREES = 1e-9
"""Largest difference between given and identified values that counts as agreement, in unit errors: rounding of the
normal equations, far below any contour."""


@dataclass(frozen=True)
class TableResult:
    """A table as computed."""

    table: ThesisTable
    given: Floats
    """Given values, mm and rad, shape (errors,)."""
    from_sum: ThesisEstimate
    """Estimate from the sum of the first-order contours of each error alone, as the thesis synthesises it."""
    from_exact: ThesisEstimate
    """Estimate from the contour of all errors together, by exact kinematics."""
    singular_ratio: float
    """Smallest over largest singular value of the matrix A of exact unit contours: what a check of A'A would use."""

    @property
    def agrees(self) -> NDArray[np.bool_]:
        """Which values identified from the sum of contours agree with the given ones, shape (errors,)."""
        sizes = np.array([each.unit_size for each in self.from_sum.unknowns])
        return np.asarray(np.abs(self.from_sum.values - self.given) <= AGREES * sizes)


def table_result(table: ThesisTable, test: CircularTest) -> TableResult:
    """Return one table, computed."""
    given = np.array([GIVEN[name] for name in table.errors])
    values = all_values(table.errors, given)
    exact = reference_contours(test, table.errors).exact_mm
    singular = np.linalg.svd(exact, compute_uv=False)
    return TableResult(
        table=table,
        given=given,
        from_sum=thesis_estimate(test, test.first_order @ values, table.errors, minimum_norm=True),
        from_exact=thesis_estimate(test, test.contour_mm(values), table.errors, minimum_norm=True),
        singular_ratio=float(singular[-1] / singular[0]),
    )


@cache
def table_results() -> tuple[TableResult, ...]:
    """Return Tables 5.1-5.7, computed."""
    test = joint_plane_test()
    return tuple(table_result(table, test) for table in TABLES)


def all_values(errors: Sequence[str], values: Floats) -> Floats:
    """Return the vector of all unknowns, shape (len(UNKNOWNS),), with these values for the named ones and zero else."""
    whole = np.zeros(len(UNKNOWNS))
    whole[[UNKNOWNS[name].column for name in errors]] = values
    return whole


def rank_of(test: CircularTest, errors: Sequence[str]) -> int:
    """Return the number of independent reference contours among those of some errors."""
    matrix = reference_contours(test, errors).first_order_mm
    return int(np.linalg.matrix_rank(matrix, tol=SINGULAR * np.linalg.norm(matrix, 2)))


def identified_additions(
    test: CircularTest, base: Sequence[str], candidates: Sequence[str], count: int
) -> list[tuple[str, ...]]:
    """Return the combinations of `count` candidates that can be added to the base so that all are identified."""
    return [
        added for added in combinations(candidates, count) if rank_of(test, [*base, *added]) == len(base) + len(added)
    ]


TABLE_5_8_SEED = 58


@dataclass(frozen=True)
class ProcedureResult:
    """The procedure of Table 5.8 on a simulated record: the seven errors, given and identified."""

    description: str
    given: Floats
    estimate: ThesisEstimate


@cache
def table_5_8() -> tuple[ProcedureResult, ...]:
    """Return the procedure of Table 5.8 on two simulated records, with seven errors and with all 33 and the cup's."""
    machine, circle, mount, bar_length_mm = joint_plane_circle()
    given = np.array([GIVEN[name] for name in SEVEN])
    alone = all_values(SEVEN, given)
    rng = np.random.default_rng(TABLE_5_8_SEED)
    sizes = {name: UNKNOWNS[name].unit_size / 2.0 for name in GEOMETRIC_ERRORS}
    others = np.array([sizes[name] * rng.uniform(-1.0, 1.0) for name in GEOMETRIC_ERRORS])
    everything = all_values(GEOMETRIC_ERRORS, others)
    everything[[UNKNOWNS[name].column for name in SEVEN]] = given
    everything[[UNKNOWNS["cup_x"].column, UNKNOWNS["cup_y"].column]] = 0.02, -0.03
    cases = {
        "only the seven errors exist": alone,
        "all 33 errors exist and the cup is misplaced by (20, -30) µm": everything,
    }
    results = []
    for description, values in cases.items():
        record = simulated_record(machine, circle, mount, bar_length_mm, values, TABLE_5_8_SEED)
        results.append(ProcedureResult(description, given, thesis_estimate_record(record, SEVEN)))
    return tuple(results)
