"""Hypotheses a step further away: their names, what they push, and of what they are functions."""

from __future__ import annotations

import math

import pytest

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.learned import Learned, crossed_hypotheses, further_hypotheses, hypotheses, products
from hexdbb.learned.shown import place_words, whole_place_words
from hexdbb.machine import MachineFile
from hexdbb.plan import load_plan

MACHINE: MachineFile = load_plan("thesis").machine_file()


def test_every_name_is_parsed_back_and_stands_for_one_hypothesis() -> None:
    every = [*hypotheses(), *further_hypotheses(), *crossed_hypotheses()]
    names = [each.name for each in every]
    assert len(set(names)) == len(names)
    assert [Learned.parse(name) for name in names] == every
    assert all(Learned.parse(each.name) == each for each in products())


@pytest.mark.parametrize(
    ("name", "elements", "by", "words"),
    [
        ("learned:leg:3-4:time", (2, 3), (2, 3), "lengths of legs 3 and 4"),
        ("learned:slider:5-6:fine_position", (4, 5), (4, 5), "sliders 5 and 6 along their guideway"),
        ("learned:slider:4:neighbour_leg_force", (3,), (2,), "slider 4 along its guideway"),
        ("learned:leg:2:leg_force_lagged@7.5", (1,), (1,), "length of leg 2"),
        ("learned:leg:3:time_in_sweep_after@60", (2,), (2,), "length of leg 3"),
        ("learned:reading:time_in_sweep_after@60", (0,), (0,), "reading of the gauge"),
        ("learned:platform_joint:5:since_reversal_travel", (12,), (4,), "platform's joint of leg 5 along x"),
        ("learned:platform_joint:1-2:angle", (0, 3), (0, 1), "platform's joint of legs 1 and 2 along x"),
    ],
)
def test_pairs_neighbours_and_memory_push_their_own(
    name: str, elements: tuple[int, ...], by: tuple[int, ...], words: str
) -> None:
    learned = Learned.parse(name)
    pushes, first = learned.pushes(0, MACHINE), _core.PORTS[learned.port][0]
    assert tuple(port - first for _, ((port, _),) in pushes) == elements
    assert tuple(element for element, _ in pushes) == by
    assert place_words(learned) == words


def test_a_guideway_pushes_both_joints_outward_and_up() -> None:
    learned = Learned.parse("learned:guideway:1:carriage_load")
    first = _core.PORTS["slider_joint"][0]
    assert learned.components == 2
    assert [learned.pushes(component, MACHINE) for component in range(2)] == [
        tuple((each, ((first + 3 * each + axis, 1.0),)) for each in (0, 1)) for axis in (0, 2)
    ]
    assert [place_words(learned, component) for component in range(2)] == [
        "guideway 1, sideways",
        "guideway 1, up and down",
    ]


def test_six_elements_each_have_a_function_of_their_own() -> None:
    learned = Learned.parse("learned:leg:each:leg_force")
    first = _core.PORTS["leg"][0]
    assert learned.components == 6
    assert [learned.pushes(each, MACHINE) for each in range(6)] == [
        ((each, ((first + each, 1.0),)),) for each in range(6)
    ]
    assert place_words(learned, 3) == "length of leg 4"
    assert whole_place_words(learned) == "lengths of legs, each in its own way"
    assert learned.name == "learned:leg:each:leg_force"
    assert not learned.of_each  # six alone are no pair


def test_the_joint_of_one_slider_is_pushed_across_its_own_guideway() -> None:
    learned = Learned.parse("learned:slider_joint:6:since_reversal_travel")
    first, angle = _core.PORTS["slider_joint"][0] + 15, MACHINE.base.guideway_angles_rad[2]
    outward, up = (learned.pushes(component, MACHINE) for component in range(2))
    assert up == ((5, ((first + 2, 1.0),)),)
    ((element, ports),) = outward
    assert element == 5
    assert dict(ports) == pytest.approx({first: math.cos(angle), first + 1: math.sin(angle)})
    assert [place_words(learned, each) for each in range(2)] == [
        "joint of slider 6, sideways",
        "joint of slider 6, up and down",
    ]


@pytest.mark.parametrize("name", ["learned:lateral:all:time", "learned:platform:time"])
def test_structures_that_grow_push_all_joints_outward(name: str) -> None:
    learned = Learned.parse(name)
    pushes, first = learned.pushes(0, MACHINE), _core.PORTS[learned.port][0]
    assert len(pushes) == 6
    angles = MACHINE.platform.joint_angles_rad if "platform" in name else MACHINE.base.guideway_angles_rad
    for leg, (element, ports) in enumerate(pushes):
        assert element == leg
        outward = {0: math.cos(angles[leg // 2]), 1: math.sin(angles[leg // 2])}
        assert {port - first - 3 * leg: weight for port, weight in ports} == pytest.approx(
            {axis: weight for axis, weight in outward.items() if weight != 0.0}
        )


def test_a_vector_pushes_along_its_axes_by_one_function() -> None:
    learned = Learned.parse("learned:platform_joint:5-6:course")
    first = _core.PORTS["platform_joint"][0]
    assert learned.components == 1
    assert learned.pushes(0, MACHINE) == tuple(
        (axis, ((first + 12 + axis, 1.0), (first + 15 + axis, 1.0))) for axis in range(3)
    )
    assert learned.variable.needs == {"course_in_platform"}
    assert Learned.parse("learned:cup:course").variable.needs == {"course"}


def test_a_direction_and_its_opposite_are_one() -> None:
    learned = Learned.parse("learned:ball:acceleration_along@170")
    assert learned.with_number(190.0).name == "learned:ball:acceleration_along@10"
    assert learned.with_number(360.0).name == "learned:ball:acceleration_along@180"
    assert learned.variable.column == "carriages_acceleration_mm_s2.along@170"
    table = Learned.parse("learned:cup:position_along@190")
    assert (table.variable.column, table.components) == ("position_mm.along@10", 3)


def test_what_a_function_needs_of_memory_is_the_column_and_the_time() -> None:
    assert Learned.parse("learned:leg:2:joint_angle_relaxing@7.5").variable.needs == {
        "slider_joint_angle_rad",
        "time_s",
    }


def test_a_number_is_moved_and_stays_in_the_name() -> None:
    learned = Learned.parse("learned:leg:2:leg_force_lagged@7.5")
    moved = learned.with_number(9.12345678)
    assert moved.name == "learned:leg:2:leg_force_lagged@9.123"
    assert moved.variable.column == "leg_force.lagged@9.123"
    assert Learned.parse(moved.name) == moved


@pytest.mark.parametrize(
    ("one", "place", "element", "expected"),
    [
        ("learned:leg:1:time", "leg", 12, True),
        ("learned:leg:1:time", "leg", 0, True),
        ("learned:leg:3:time", "leg", 12, False),
        ("learned:leg:1-2:time", "leg", 1, False),
        ("learned:leg:1-2:time", "leg", 12, True),
        ("learned:leg:each:time", "leg", 0, True),
        ("learned:leg:each:time", "leg", 3, False),
        ("learned:vertical:2:leg_force", "guideway", 2, True),
        ("learned:slider:1:time", "leg", 1, False),
    ],
)
def test_what_acts_within_what(one: str, place: str, element: int, expected: bool) -> None:
    assert Learned.parse(one).is_within(place, element) is expected


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("learned:leg:1-3:time", "element '1-3' (expected one of 1, 2, 3, 4, 5, 6, 1-2, 3-4, 5-6, all, each)"),
        ("learned:leg:1:leg_force_lagged@-2", "variable 'leg_force_lagged@-2' (expected one of position"),
        ("learned:slider:1:acceleration_along@30", "variable 'acceleration_along@30' (expected one of position"),
        ("learned:ball:position_along@30", "variable 'position_along@30' (expected one of time"),
        ("learned:platform:position", "variable 'position' (expected one of time, warming)"),
        ("learned:lateral:all:position", "variable 'position' (expected one of time, warming)"),
        ("learned:leg:5:joint_angle_heated@60", "variable 'joint_angle_heated@60'"),
        ("learned:slider:2:velocity_position_heated@60", "variable 'velocity_position_heated@60'"),
    ],
)
def test_what_is_not_there_is_refused(name: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        Learned.parse(name)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("name", "ball"),
    [
        ("reading:fine_bar_angle", "platform"),
        ("reading:bar_azimuth", "cup"),
        ("reading:angle", "cup"),
        ("reading:time_angle", ""),
        ("cup:angle", ""),
        ("reading:time", ""),
    ],
)
def test_a_function_of_the_bars_direction_is_of_one_of_its_balls(name: str, ball: str) -> None:
    assert Learned.parse(f"learned:{name}").ball == ball
