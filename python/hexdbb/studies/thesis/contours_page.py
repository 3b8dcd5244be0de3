"""Generator of docs/thesis-contours.md: reference contours and the symmetry of their circle."""

from __future__ import annotations

import numpy as np

from hexdbb.plan import load_plan
from hexdbb.studies.thesis.circular_test import CircularTest, joint_plane_test, plan_test
from hexdbb.studies.thesis.contours import Floats, reference_contours
from hexdbb.studies.thesis.markdown import UNITS, fill_page, markdown_table, number, shown
from hexdbb.studies.thesis.symmetry import symmetry_departure_mm
from hexdbb.studies.thesis.unknowns import GEOMETRIC_ERRORS, UNIT_MM, UNIT_RAD, UNKNOWNS

SYMMETRY_SEED = 120
"""Seed of the errors for which the symmetry is tested; any other gives the same zeros."""


def contours_page() -> str:
    """Return the page as Markdown."""
    in_plane, above = joint_plane_test(), plan_test(load_plan("thesis"), 0, "plan thesis, circle 0")
    return fill_page(
        "thesis-contours.md",
        unit_mm=f"{UNIT_MM:g}",
        unit_deg=f"{np.degrees(UNIT_RAD):g}",
        unit_urad=f"{1e6 * UNIT_RAD:.0f}",
        unit_arm_mm=f"{UNIT_MM / UNIT_RAD:.0f}",
        largest=_largest([in_plane, above]),
        largest_contour_um=f"{1e3 * np.abs(in_plane.contour_mm(_symmetry_errors())).max():.0f}",
        symmetry=_symmetry(),
    )


def _largest(tests: list[CircularTest]) -> str:
    contours = [reference_contours(test) for test in tests]
    rows = []
    for index, name in enumerate(GEOMETRIC_ERRORS):
        each = UNKNOWNS[name]
        row = [name, each.parameter.label, shown(each, each.unit_size, 0), UNITS[each.unit]]
        for found in contours:
            exact, linear = 1e3 * found.exact_mm[:, index], 1e3 * found.first_order_mm[:, index]
            row += [number(float(np.abs(exact).max()), 2), number(float(np.abs(exact - linear).max()), 3)]
        rows.append(row)
    heads = ["error", "value of the model", "unit error", "", "joint plane, µm", "from first order"]
    return markdown_table([*heads, "plan `thesis`, µm", "from first order"], rows, left=2)


def _symmetry_errors() -> Floats:
    sizes = np.array([each.unit_size for each in UNKNOWNS.values()])
    return np.asarray(sizes * np.random.default_rng(SYMMETRY_SEED).normal(size=len(sizes)))


def _symmetry() -> str:
    plan, errors = load_plan("standard"), _symmetry_errors()
    rows = []
    for circle in plan.circles:
        test = plan_test(plan, circle.id, "plan standard")
        turn_mm, mirror_mm = symmetry_departure_mm(test, errors)
        held = "/".join(f"{angle:g}" for angle in circle.platform_rpy_deg)
        rows.append([f"standard, {circle.id}", held, number(1e3 * turn_mm, 3), number(1e3 * mirror_mm, 3)])
    return markdown_table(["plan, circle", "platform roll/pitch/yaw, deg", "turn, µm", "mirror, µm"], rows, left=2)
