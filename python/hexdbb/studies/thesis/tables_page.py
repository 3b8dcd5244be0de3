"""Generator of docs/thesis-tables.md: Tables 5.1-5.8, the reason for their results, and the limit of linearity."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from hexdbb.studies.thesis.circular_test import CircularTest, joint_plane_test
from hexdbb.studies.thesis.contours import harmonic_amplitudes, reference_contours, without_harmonics
from hexdbb.studies.thesis.estimator import SINGULAR
from hexdbb.studies.thesis.linearity import ARM_MM, DRAWS, LinearityStudy, linearity_study
from hexdbb.studies.thesis.markdown import UNITS, fill_page, markdown_table, number, shown
from hexdbb.studies.thesis.simulated import GAUGE_NOISE_UM, RESOLUTION_UM
from hexdbb.studies.thesis.tables import (
    FIVE,
    LEGS,
    ROTATIONS,
    SEVEN,
    ProcedureResult,
    TableResult,
    identified_additions,
    rank_of,
    table_5_8,
    table_results,
)
from hexdbb.studies.thesis.unknowns import GEOMETRIC_ERRORS, UNKNOWNS

HIGHEST = 6
"""Highest harmonic in the table; those above are below 1 % of the first."""
PRESENT = 0.02
"""Share of a contour's largest harmonic above which a harmonic counts as present. Any share from 0.9 to 2.2 % gives the
same table: legs, the only errors with more than two harmonics, then have four."""
TRANSLATIONS = ("x1", "z1", "x2", "z2", "x3", "y3", "z3")


def tables_page() -> str:
    """Return the page as Markdown."""
    test, study = joint_plane_test(), linearity_study()
    return fill_page(
        "thesis-tables.md",
        summary=_summary(table_results()),
        singular=f"{SINGULAR:g}",
        tables=_tables(table_results()),
        present_percent=f"{100 * PRESENT:g}",
        harmonics=_harmonics(test),
        leg_decay=_leg_decay(test),
        ranks=_ranks(test),
        **_pair(test),
        choices=_choices(test),
        procedure=_procedure(table_5_8()),
        noise_um=f"{GAUGE_NOISE_UM:g}",
        resolution_um=f"{RESOLUTION_UM:g}",
        linearity=_linearity(study),
        arm_mm=f"{ARM_MM:g}",
        draws=str(DRAWS),
        neglected_um=number(1e3 * study.curvature_per_mm * 0.1**2, 2),
        noise_rms_um=number(1e3 * study.noise_rms_mm, 1),
        break_um=number(1e3 * study.break_mm, 0),
        lengths_break_um=number(1e3 * study.break_at_mm(study.curvature_of_lengths_per_mm), 0),
        rotations_break_urad=number(1e6 * study.break_at_mm(study.curvature_of_rotations_per_mm) / ARM_MM, 0),
        range_um=number(1e3 * study.range_mm, 0),
        break_urad=number(1e6 * study.break_mm / ARM_MM, 0),
    )


def _summary(results: Sequence[TableResult]) -> str:
    rows = []
    for each in results:
        stated = "identified" if each.table.thesis_says_identified else "part not identified"
        found = "identified" if each.agrees.all() else f"{int(each.agrees.sum())} of {len(each.agrees)} identified"
        rank = f"{each.from_sum.rank} of {len(each.agrees)}"
        dependent = "; ".join(each.from_sum.dependent) or "none"
        ratio = f"{each.singular_ratio:.1e}"
        rows.append([each.table.number, ", ".join(each.table.errors), stated, found, rank, dependent, ratio])
    heads = ["table", "errors", "thesis", "found", "rank", "dependent contours, in unit errors"]
    return markdown_table([*heads, "singular value ratio, exact"], rows, left=6)


def _tables(results: Iterable[TableResult]) -> str:
    return "\n".join(f"## Table {each.table.number}\n\n{_given_and_identified(each)}" for each in results)


def _given_and_identified(result: TableResult) -> str:
    rows = []
    for index, each in enumerate(result.from_sum.unknowns):
        values = (result.given[index], result.from_sum.values[index], result.from_exact.values[index])
        agrees = "yes" if result.agrees[index] else "**no**"
        rows.append([each.name, UNITS[each.unit], *(shown(each, value) for value in values), agrees])
    heads = ["error", "unit", "given", "identified from the sum", "from the exact contour", "agrees"]
    return markdown_table(heads, rows, left=2)


def _harmonics(test: CircularTest) -> str:
    contours = reference_contours(test)
    amplitudes = 1e3 * harmonic_amplitudes(contours.first_order_mm, HIGHEST)
    rows = []
    kinds: dict[tuple[str, str], list[int]] = {}
    for index, each in enumerate(contours.unknowns):
        kinds.setdefault((each.parameter.effect, each.parameter.name), []).append(index)
    for (effect, _), members in kinds.items():
        largest = amplitudes[:, members].max(axis=1)
        present = [str(h) for h in range(HIGHEST + 1) if largest.max() > 1e-6 and largest[h] > PRESENT * largest.max()]
        names = ", ".join(contours.unknowns[k].name for k in members)
        rows.append([names, effect, *(number(each, 3) for each in largest), ", ".join(present) or "none"])
    heads = ["errors", "effect", *(f"h = {h}" for h in range(HIGHEST + 1)), "present"]
    return markdown_table(heads, rows, left=2)


def _ranks(test: CircularTest) -> str:
    """Return the numbers of independent contours by group, and of the contours without their lower harmonics."""
    effects = {name: UNKNOWNS[name].parameter.effect for name in GEOMETRIC_ERRORS}
    vertical = ("guideway_rotation_xy", "guideway_rotation_centre")
    legs = [name for name, effect in effects.items() if effect == "leg_length"]
    rotations = [name for name, effect in effects.items() if effect in vertical]
    others = [name for name in GEOMETRIC_ERRORS if name not in {*legs, *rotations}]
    rows = [
        ["harmonic 1 only (sliders, translations, yz, sides)", str(len(others)), str(rank_of(test, others))],
        ["with the rotations about vertical axes (harmonics 1, 2)", "+6", str(rank_of(test, [*others, *rotations]))],
        ["rotations, harmonics 0-1 removed", "6", str(_rank_without(test, rotations, 1))],
        ["legs, harmonics 0-2 removed", "6", str(_rank_without(test, legs, 2))],
        ["all 33", "33", str(rank_of(test, GEOMETRIC_ERRORS))],
    ]
    return markdown_table(["contours of", "errors", "independent"], rows)


def _rank_without(test: CircularTest, errors: Sequence[str], up_to: int) -> int:
    matrix = without_harmonics(reference_contours(test, errors).first_order_mm, up_to)
    return int(np.linalg.matrix_rank(matrix, tol=SINGULAR * np.linalg.norm(matrix, 2)))


def _leg_decay(test: CircularTest) -> str:
    amplitudes = harmonic_amplitudes(reference_contours(test, ("leg1",)).first_order_mm, 5)[:, 0]
    return number(float(amplitudes[5] / amplitudes[4]), 2)


def _pair(test: CircularTest) -> dict[str, str]:
    """Return how far the contours of the two legs of a pair are from opposite, and their size."""
    pair = 1e3 * reference_contours(test, ("leg1", "leg2")).first_order_mm
    return {
        "pair_sum_um": number(float(np.abs(pair.sum(axis=1)).max()), 6),
        "pair_um": number(float(np.abs(pair).max()), 1),
    }


def _choices(test: CircularTest) -> str:
    """Return the choices of further errors that are identified."""
    choices = [
        ("third translation, to Table 5.1", FIVE, TRANSLATIONS, 1),
        ("fourth leg, to three", LEGS, ("leg2", "leg4", "leg6"), 1),
        ("one rotation, to Table 5.1", FIVE, ROTATIONS, 1),
        ("two rotations, to Table 5.1", FIVE, ROTATIONS, 2),
        ("three rotations, to Table 5.1", FIVE, ROTATIONS, 3),
        ("position of the cup, to Table 5.5", SEVEN, ("cup_x", "cup_y"), 1),
        ("any other of the 33, to Table 5.5", SEVEN, tuple(name for name in GEOMETRIC_ERRORS if name not in SEVEN), 1),
    ]
    rows = []
    for title, base, candidates, count in choices:
        good = identified_additions(test, base, candidates, count)
        named = "; ".join(" + ".join(each) for each in good) or "none"
        tried = ", ".join(candidates) if len(candidates) < 10 else f"all {len(candidates)}"
        rows.append([title, tried, named])
    return markdown_table(["added", "tried", "identified"], rows, left=3)


def _procedure(results: Sequence[ProcedureResult]) -> str:
    heads = ["error", "unit", "given", *(f"identified: {each.description}" for each in results)]
    rows = []
    for index, each in enumerate(results[0].estimate.unknowns):
        identified = [shown(each, result.estimate.values[index], 1) for result in results]
        rows.append([each.name, UNITS[each.unit], shown(each, results[0].given[index], 1), *identified])
    before = [f"{1e3 * result.estimate.rms_before_mm:.2f}" for result in results]
    after = [f"{1e3 * result.estimate.rms_after_mm:.2f}" for result in results]
    rows += [["contour, RMS", "µm", "", *before], ["residual, RMS", "µm", "", *after]]
    return markdown_table(heads, rows, left=2)


def _linearity(study: LinearityStudy) -> str:
    rows = []
    for row in study.rows:
        lengths = (row.linear_rms_mm, row.exact_rms_mm, row.linear_largest_mm, row.exact_largest_mm)
        size = [f"{1e3 * row.size_mm:g} µm, {1e6 * row.size_mm / ARM_MM:g} µrad"]
        rows.append([*size, *(number(1e3 * each, 1) for each in lengths), number(row.peak_reading_mm, 2)])
    heads = ["size", "linear, RMS µm", "exact, RMS µm", "linear, largest µm", "exact, largest µm"]
    return markdown_table([*heads, "largest reading, mm"], rows)
