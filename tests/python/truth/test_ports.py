"""Truth with forms: faults push where their labels say, and nowhere else."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from hexdbb.plan import load_plan
from hexdbb.rig.mechanisms import Push
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb_truth.forms import plans
from hexdbb_truth.forms.cases import (
    FAMILIES,
    case,
)
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.measure import Measured
from hexdbb_truth.forms.outside import BY_NAME_ONLY, EVERY_OUTSIDE, OUTSIDE
from hexdbb_truth.forms.ports import Action, add
from hexdbb_truth.simulate import Pace

PORTS = {"slider", "leg", "guideway", "platform_joint", "ball", "cup", "reading"}


@pytest.mark.parametrize(
    ("port", "elements", "constant", "geometry"),
    [
        ("slider", (3,), [0.02], {"slider_offset_um": [0, 0, 0, 20, 0, 0]}),
        ("leg", (4,), [0.02], {"leg_length_um": [0, 0, 0, 0, 20, 0]}),
        ("guideway", (1,), [0.02, 0.0, 0.02, 0.0], {"guideway_translation_um": [[0] * 3, [20, 0, 0], [0] * 3]}),
        ("guideway", (2,), [0.0, 0.02, 0.0, 0.02], {"guideway_translation_um": [[0] * 3, [0] * 3, [0, 0, 20]]}),
        ("cup", (), [0.01, 0.0, -0.02], {"cup_error_um": [[10, 0, -20]]}),
        ("ball", (), [0.01, 0.0, -0.02], {"ball_offset_error_um": [10, 0, -20]}),
        ("reading", (), [-0.02], {"bar_length_error_um": 20}),
    ],
)
def test_a_constant_at_a_port_is_the_error_of_geometry_that_it_is(short, port, elements, constant, geometry):
    """Move the fault: the reading changes as the true kinematics say."""
    nominal = TruthFile()
    action = Action(port, elements, lambda scene, size: np.tile(size * np.array(constant), (len(scene.rows), 1)))
    shown = Measured(nominal, short.history).readings_mm([(action, 1.0)])
    floats = {key: (np.array(value, dtype=float)).tolist() for key, value in geometry.items()}
    part = "setup" if port in ("cup", "ball", "reading") else "geometry"
    moved = TruthFile.model_validate({"schema": "hexdbb.truth/1", part: floats})
    np.testing.assert_allclose(shown, Measured(moved, short.history).readings_mm([]), atol=1e-9)
    assert np.abs(shown).max() > 1e-4


@pytest.mark.parametrize("kind", [*FAMILIES, *OUTSIDE, *BY_NAME_ONLY])
def test_a_fault_moves_the_element_of_its_label_alone(kind):
    one = case(f"{kind}-d{0 if kind in EVERY_OUTSIDE else 10}-x3-judge-s4")
    scene = one.measured.scene(one.history.samples[::29])
    action, _ = drawn_action(one, kind)
    values = action.values(scene, 10.0)
    assert np.all(np.isfinite(values))
    if action.port == "delay":
        return
    push = Push(len(scene.rows))
    add(action, values, scene, push)
    moved = {name for name, array in vars(push).items() if np.any(array)}
    attribute = {"guideway": "slider_joint_mm", "compliance": "compliance_mm_n"}.get(action.port, f"{action.port}_mm")
    assert moved == {attribute}
    if action.elements:
        joints = (
            [2 * g + j for g in action.elements for j in range(2)] if action.port == "guideway" else action.elements
        )
        array = getattr(push, attribute)
        others = [k for k in range(6) if k not in joints]
        assert not np.any(array[:, others])
        assert all(np.any(array[:, k]) for k in joints)


def drawn_action(one, kind):
    if kind in EVERY_OUTSIDE:
        fault = EVERY_OUTSIDE[kind].drawn(one._draw(kind))
        return fault.action, fault.equivalents
    return one._drawn(kind)[0].action(), ()


@pytest.mark.parametrize("kind", [*OUTSIDE, *BY_NAME_ONLY])
def test_a_fault_outside_the_catalogue_says_where_it_is_and_what_else_explains_it(kind):
    kindred = EVERY_OUTSIDE[kind]
    assert kindred.variables
    for seed in range(3):
        action, equivalents = drawn_action(case(f"{kind}-d0-x3-judge-s{seed}"), kind)
        assert action.port in PORTS
        assert all(0 <= element < 6 for element in action.elements)
        for each in equivalents:
            assert each.port in {*PORTS, "load"}
            assert each.why
    first, again = (drawn_action(case(f"{kind}-d0-x3-judge-s1"), kind)[0] for _ in range(2))
    measured = Measured(random_truth(1), plans.history(kindred.plan))
    some = measured.scene(measured.history.samples[::11])
    np.testing.assert_array_equal(first.values(some, 10.0), again.values(some, 10.0))
    assert np.ptp(first.values(some, 10.0)) > 0.0


def test_a_fault_stays_where_it_is_on_a_machine_that_is_driven_otherwise(short):
    """A bump of the tape is a function of the drive's position, whatever range of it another plan drives."""
    plan = load_plan("standard")
    other = History(plan.model_copy(update={"circles": plan.circles[3:4], "laps": 1}), Pace(6.0, 12, 2.0))
    action, _ = drawn_action(case("tape_bump-d0-x3-judge-s4"), "tape_bump")
    (k,) = action.elements

    def bump(measured):
        scene = measured.scene(np.arange(len(measured.history)))
        order = np.argsort(scene.drive_mm(k))
        return scene.drive_mm(k)[order], action.values(scene, 100.0)[order, 0]

    at_mm, drawn_mm = bump(short)
    kept_at_mm, kept_mm = bump(Measured(short.truth, other, short.history))
    inside = (kept_at_mm > at_mm[0]) & (kept_at_mm < at_mm[-1])
    there = np.interp(kept_at_mm[inside], at_mm, drawn_mm)
    np.testing.assert_allclose(kept_mm[inside], there, atol=1e-4)
    _, moved_mm = bump(Measured(short.truth, other))
    assert np.abs(moved_mm[inside] - there).max() > 0.01


@pytest.mark.parametrize("table", [OUTSIDE, BY_NAME_ONLY], ids=["mixed", "by name only"])
def test_there_are_enough_faults_outside_the_catalogue_at_many_ports(table):
    assert len(table) >= 12
    actions = [drawn_action(case(f"{kind}-d0-x3-judge-s1"), kind)[0] for kind in table]
    assert {action.port for action in actions} >= {"slider", "leg", "guideway", "platform_joint", "cup", "reading"}
    assert len(set(itertools.chain(*(kind.variables for kind in table.values())))) >= 8
