"""Functions that may be learned: dense about zero where a sign turns over, and by another element's variable."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.learned import Learned, Space
from hexdbb.learned.listed import further_hypotheses

LEAD_MM = 5.0


@pytest.fixture
def columns() -> dict[str, np.ndarray]:
    """Six sliders with velocities of their own."""
    time_s = np.linspace(0.0, 60.0, 3000)
    velocity = 60.0 * np.sin(0.7 * time_s[:, None] * (1.0 + 0.1 * np.arange(6)))
    return Rows({"time_s": time_s, "velocity_mm_s": velocity, "acceleration_mm_s2": np.gradient(velocity, axis=0)})


class Rows(dict[str, np.ndarray]):
    """Columns as long as their rows."""

    def __len__(self) -> int:
        return len(self["time_s"])


def left_of(space: Space, columns: Rows, wanted: np.ndarray, element: int) -> float:
    """Return what the functions cannot say of a wanted one, as a part of its RMS."""
    design = space.design(columns, element)
    rest = wanted - design @ np.linalg.lstsq(design, wanted, rcond=None)[0]
    return float(np.std(rest) / np.std(wanted))


@pytest.mark.parametrize("variable", ["velocity", "acceleration"])
def test_what_changes_near_zero_can_be_said(columns: Rows, variable: str) -> None:
    space = Space.of(Learned.parse(f"learned:slider:2:{variable}"), columns, LEAD_MM)
    values = columns[space.hypothesis.variable.column][:, 1]
    even = np.tanh(np.abs(values) / (0.15 * np.std(values)))
    plain = replace(space, warp_width=0.0, low=values.min(), high=values.max())
    assert left_of(space, columns, even, 1) < 0.25 * left_of(plain, columns, even, 1)


def test_smooth_functions_of_large_values_can_still_be_said(columns: Rows) -> None:
    space = Space.of(Learned.parse("learned:slider:2:velocity"), columns, LEAD_MM)
    values = columns["velocity_mm_s"][:, 1]
    assert left_of(space, columns, values**3, 1) < 0.01


@pytest.mark.parametrize("laps", [4, 28])
def test_laps_of_many_readings_allow_fine_functions(laps: int) -> None:
    """Laps repeat their positions at the same places of the record: every ninth reading of 720 is one of eighty."""
    angle = np.tile(np.arange(720) * (2.0 * np.pi / 720), laps)
    position_mm = 400.0 + 100.0 * np.sin(angle[:, None] + np.arange(6)) + 1e-3 * np.arange(6)
    columns = Rows({"time_s": np.arange(len(angle)) * 0.02, "sliders_mm": position_mm})
    assert Space.of(Learned.parse("learned:vertical:3:fine_position"), columns, LEAD_MM).size == 100
    with pytest.raises(InputError, match=r"sliders_mm has \d+ different values"):
        Space.of(Learned.parse("learned:vertical:3:fine_position").finer(4), columns, LEAD_MM)


def test_what_warms_is_said_by_what_grows_and_bends() -> None:
    """A bow that has come to 86 % of its height at the end, zero at the beginning, as both functions are there."""
    time_s = np.linspace(500.0, 2300.0, 4000)
    position_mm = 400.0 + 300.0 * np.sin(0.05 * time_s[:, None] * (1.0 + 0.1 * np.arange(6)))
    columns = Rows({"time_s": time_s, "sliders_mm": position_mm})
    bow = (1.0 - np.exp(-(time_s - time_s[0]) / 900.0)) * (1.0 - ((position_mm[:, 1] - 400.0) / 300.0) ** 2)
    names = [f"learned:vertical:1:time_position{each}" for each in ("", "_bent", "_settling@900", "_settling@1e6")]
    every = [Space.of(Learned.parse(name), columns, LEAD_MM).design(columns, 1) for name in names]
    growing, bending, settling, slow = every
    assert not growing[0].any() and not bending[[0, -1]].any() and not settling[0].any()
    assert settling[-1] == pytest.approx(growing[-1])
    # What takes far longer than the test grows evenly in it.
    assert slow == pytest.approx(growing, abs=2e-3)

    def left(design: np.ndarray) -> float:
        return float(np.std(bow - design @ np.linalg.lstsq(design, bow, rcond=None)[0]) / np.std(bow))

    assert left(np.hstack([growing, bending])) < 0.05 < 0.15 < left(growing)
    assert left(settling) < 0.01


@pytest.mark.parametrize("power", [1, 2, 3])
def test_even_splines_say_powers_exactly(columns: Rows, power: int) -> None:
    every = {each.variable.is_even: each for each in Learned.parse("learned:slider:2:velocity").variants()}
    space = Space.of(every[True], columns, LEAD_MM)
    assert space.hypothesis.name == every[False].name
    assert left_of(space, columns, columns["velocity_mm_s"][:, 1] ** power, 1) < 1e-6


@pytest.mark.parametrize(
    ("name", "counts"),
    [
        ("learned:slider:2:velocity", [12, 12, 24, 48, 96, 192]),
        ("learned:slider:2:position", [14, 28, 56, 112, 224]),
        ("learned:slider:2:fine_position", [64, 128, 256, 512]),
        ("learned:slider:2:position_period@7.3", [8, 16, 32, 64, 128]),
        ("learned:slider:2:direction_position_period@7.3", [8, 16, 32, 64, 128]),
        ("learned:slider:2:velocity_wave@7.3", [12, 24, 48, 96, 192]),
        ("learned:slider:2:position_each_way", [14, 28, 56, 112, 224]),
        ("learned:slider:2:direction", []),
        ("learned:slider:2:step@3.5", []),
    ],
)
def test_variants_have_the_same_name_and_other_splines(name: str, counts: list[int]) -> None:
    plain = Learned.parse(name)
    variants = list(plain.variants())
    assert sorted(each.variable.count for each in variants) == counts
    assert {each.name for each in variants} <= {name}
    assert all(list(each.variants()) == variants for each in variants)


def test_points_of_the_table_rise_and_span_the_range(columns: Rows) -> None:
    space = Space.of(Learned.parse("learned:slider:2:velocity"), columns, LEAD_MM)
    points, values = space.points(), columns["velocity_mm_s"][:, 1]
    assert np.all(np.diff(points) > 0.0)
    assert points[[0, -1]] == pytest.approx([values.min(), values.max()])


def test_a_table_follows_its_functions(columns: Rows) -> None:
    space = Space.of(Learned.parse("learned:slider:2:velocity"), columns, LEAD_MM)
    coefficients = np.random.default_rng(4).normal(size=space.size)
    (table,) = space.tables(coefficients, (0.0, 2.0, 4.0))
    at = np.linspace(table.knots[0], table.knots[-1], 20000)
    exact = space.functions(at) @ coefficients
    assert np.abs(np.interp(at, table.knots, table.values_mm) - exact).max() < 0.03 * np.ptp(exact)


@pytest.mark.parametrize("number", [1, 2, 5, 6])
def test_a_slider_is_pushed_by_its_neighbours_velocity(columns: Rows, number: int) -> None:
    learned = Learned.parse(f"learned:slider:{number}:neighbour_velocity")
    neighbour = (number - 1) ^ 1
    first = _core.PORTS["slider"][0]
    assert learned.elements == (neighbour,)
    assert learned.pushes(0, (0.0, 2.0, 4.0)) == ((neighbour, ((first + number - 1, 1.0),)),)
    space = Space.of(learned, columns, LEAD_MM)
    assert left_of(space, columns, columns["velocity_mm_s"][:, neighbour] ** 2, neighbour) < 0.01


def test_all_sliders_go_by_all_neighbours() -> None:
    learned = Learned.parse("learned:slider:all:neighbour_velocity")
    assert learned.elements == (1, 0, 3, 2, 5, 4)
    first = _core.PORTS["slider"][0]
    assert [pushed[0][0] - first for _, pushed in learned.pushes(0, (0.0, 2.0, 4.0))] == list(range(6))


def test_a_joint_moves_in_time_from_where_it_was(columns: Rows) -> None:
    space = Space.of(Learned.parse("learned:platform_joint:3:time"), columns, LEAD_MM)
    time_s = columns["time_s"]
    assert space.functions(time_s[:1]) == pytest.approx(0.0, abs=1e-12)
    design = space.design(columns, 2)
    warms = -np.expm1(-time_s / 20.0)
    assert left_of(space, columns, warms, 2) < 0.01
    offset = np.ones(len(time_s))
    assert np.std(offset - design @ np.linalg.lstsq(design, offset, rcond=None)[0]) > 0.05


@pytest.mark.parametrize("place", ["reading", "slider:2"])
def test_what_follows_one_drive_is_a_function_of_its_column(place: str, columns: Rows) -> None:
    space = Space.of(Learned.parse(f"learned:{place}:slider_4_velocity"), columns, LEAD_MM)
    (element,) = space.hypothesis.elements
    own = Space.of(Learned.parse("learned:slider:4:velocity"), columns, LEAD_MM)
    assert np.array_equal(space.design(columns, element), own.design(columns, 3))
    assert space.hypothesis.variable.words == "velocity of slider 4"


def test_a_slider_may_follow_the_drives_of_other_guideways() -> None:
    every = [each for each in further_hypotheses() if each.place == "slider" and each.variable.of_element]
    assert {each.variable.of_element for each in every if each.element == 3} == {1, 2, 5, 6}
    assert len(every) == 24
