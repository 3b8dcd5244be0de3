"""Learned functions in a controller: the compensator's corrections against the model's own prediction.

The truth is the model: the engine evaluates the learned effect tabulated for the very samples driven, with the state
that the engine derives from them; it shares no table, no search for knots and no formula of joints with the
compensator.
"""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from tests.python.compensation.driven import (
    MACHINE,
    RPY,
    STEP_S,
    Table,
    errors_mm,
    nominal_table,
    path,
    targets_of,
)

import hexdbb
from hexdbb.cli.compensate import command
from hexdbb.compensation import (
    CompensatedTargets,
    make_compensation,
    path_targets,
    read_compensation,
    write_compensation,
)
from hexdbb.compensation.tables import halved, learned_tables
from hexdbb.learned import Learned, Space
from hexdbb.machine import load_machine
from hexdbb.model import LearnedEffect, Model, Term, new_model, new_term, save_model

SIZE_MM = 0.01
AWAY_MM, AWAY_MM_S = 0.5, 5.0
"""Travel since a reversal and speed of a slider from which on its direction of travel is compared: nearer, play is
being crossed, and a record finds the reversal on smoothed positions."""
ENDS = slice(20, -20)
"""Without the ends of a record, where velocities are one-sided."""


@pytest.fixture(scope="module")
def nominal() -> Table:
    return nominal_table()


@pytest.fixture(scope="module")
def unlike() -> Table:
    return nominal_table(load_machine(Path(__file__).parents[2] / "data" / "machines" / "unlike.toml"))


def model_of(name: str, nominal: Table, beside: tuple[str, ...] = ("leg_length",)) -> Model:
    """A model with a learned effect of some `SIZE_MM`, and effects of the catalogue beside it."""
    space = Space.of(Learned.parse(name), nominal, MACHINE.sliders.screw_lead_mm)
    times = space.hypothesis.variable.times
    # What a velocity multiplies is so much smaller than what it pushes.
    size = SIZE_MM / float(np.sqrt(np.mean(nominal[times] ** 2))) if times in nominal.columns else SIZE_MM
    effect = LearnedEffect(space, 1.0, size)
    draw = np.random.default_rng(sum(map(ord, name)))
    values = size * draw.standard_normal(effect.size)
    known = new_model(nominal.machine, list(beside))
    sizes = 0.5 * np.array([each.prior_sigma for each in known.parameters()])
    known = known.with_values(sizes)
    term = new_term(name, effect.size)
    learned = Term(name, term.free, values, term.sigma, term.identifiable, effect)
    return Model(nominal.machine, (*known.terms, learned))


@pytest.mark.parametrize(
    "name",
    [
        "learned:leg:5:turning_rate",
        "learned:vertical:1:position",
        "learned:lateral:2:fine_position",
        "learned:slider:4:screw_phase",
        "learned:slider:2:screw_cos_position",
        "learned:slider:all:screw_sin_position",
        "learned:slider:all:position",
        "learned:slider:2:velocity",
        "learned:slider:2:velocity_turning@0.2",
        "learned:slider:6:leg_force",
        "learned:leg:3:joint_angle",
        "learned:leg:1:platform_turning_rate",
        "learned:leg:2:platform_joint_angle",
        "learned:leg:all:swing_rate",
        "learned:leg:4:swing_angle",
        "learned:leg:6:inclination",
        "learned:vertical:2:velocity",
        "learned:lateral:3:leg_force",
        "learned:slider:5:acceleration",
        "learned:slider:1:warming",
        "learned:platform_joint:4:joint_angle",
        "learned:platform_joint:2:constant",
        "learned:slider:3:drive_load",
        "learned:slider:2:velocity_drive_load",
        "learned:slider:5:velocity_position",
        "learned:leg:6:leg_force_joint_angle",
        "learned:slider:4:neighbour_position",
        "learned:slider:4:slider_5_velocity",
        "learned:leg:1-2:joint_angle",
        "learned:guideway:3:carriage_load",
        "learned:platform:warming",
        "learned:lateral:all:warming",
    ],
)
def test_the_machine_as_learned_takes_the_commanded_poses(name: str, nominal: Table) -> None:
    model = model_of(name, nominal)
    uncorrected, _ = errors_mm(model, nominal["sliders_mm"])
    remaining, _ = errors_mm(model, targets_of(model), nominal)
    assert uncorrected[ENDS].max() > 3e-3
    assert remaining[ENDS].max() < 1e-4


@pytest.mark.parametrize(
    "name",
    [
        "learned:lateral:2:fine_position",
        "learned:slider:4:screw_phase",
        "learned:slider:6:leg_force",
        "learned:leg:3:joint_angle",
        "learned:leg:4:turning_rate",
        "learned:leg:2:platform_turning_rate",
        "learned:leg:5:platform_joint_angle",
        "learned:leg:all:swing_rate",
        "learned:leg:3:inclination",
        "learned:slider:5:drive_load",
        "learned:guideway:2:carriage_load",
        "learned:leg:4:leg_force_swing_angle",
    ],
)
def test_so_does_a_machine_that_is_not_alike_on_all_sides(name: str, unlike: Table) -> None:
    """Unequal legs, guideways in other directions: the controller's formulas of joints hold for them too."""
    model = model_of(name, unlike, ("leg_length", "slider_offset", "guideway_translation"))
    uncorrected, _ = errors_mm(model, unlike["sliders_mm"])
    remaining, _ = errors_mm(model, targets_of(model), unlike)
    assert uncorrected[ENDS].max() > 3e-3
    assert remaining[ENDS].max() < 1e-4


@pytest.mark.parametrize(
    ("name", "left"),
    [
        ("learned:vertical:1:position", 1e-3),
        ("learned:leg:1:since_reversal_travel_alike", 0.003),
        ("learned:leg:3:joint_angle", 0.01),
        ("learned:leg:5:turning_rate", 0.03),
        ("learned:leg:1:platform_turning_rate", 0.1),
    ],
)
def test_little_is_left_where_the_correction_s_own_motion_counts(name: str, left: float, nominal: Table) -> None:
    model = model_of(name, nominal)
    uncorrected, _ = errors_mm(model, nominal["sliders_mm"])
    remaining, _ = errors_mm(model, targets_of(model))
    rms = [float(np.sqrt(np.mean(error[ENDS] ** 2))) for error in (remaining, uncorrected)]
    assert rms[0] < left * rms[1]


@pytest.mark.parametrize(
    ("name", "since", "rate", "scale"),
    [
        ("learned:slider:3:direction_position", "since_reversal_mm", "velocity_mm_s", 1.0),
        ("learned:slider:3:position_each_way", "since_reversal_mm", "velocity_mm_s", 1.0),
        ("learned:leg:6:direction", "since_reversal_mm", "velocity_mm_s", 1.0),
        (
            "learned:leg:2:joint_angle_direction",
            "slider_joint_since_reversal_rad",
            "slider_joint_rate_rad_s",
            1.0 / MACHINE.legs.length_mm,
        ),
    ],
)
def test_a_direction_is_corrected_away_from_reversals(
    name: str, since: str, rate: str, scale: float, nominal: Table
) -> None:
    model = model_of(name, nominal)
    remaining, driven = errors_mm(model, targets_of(model))
    away = (driven[since] > scale * AWAY_MM) & (np.abs(driven[rate]) > scale * AWAY_MM_S)
    chosen = np.flatnonzero(away.all(axis=1))[20:-20]
    assert len(chosen) > 1000
    assert remaining[chosen].max() < 1e-4


@pytest.mark.parametrize(
    "name", ["learned:slider:5:since_reversal_travel", "learned:leg:1:since_reversal_travel_alike"]
)
def test_travel_since_a_reversal_is_corrected_away_from_reversals(name: str, nominal: Table) -> None:
    """As a function of the commanded travel, from which that of the drives is off by the correction's own motion."""
    model = model_of(name, nominal)
    remaining, driven = errors_mm(model, targets_of(model), nominal)
    away = (driven["since_reversal_mm"] > AWAY_MM) & (np.abs(driven["velocity_mm_s"]) > AWAY_MM_S)
    chosen = np.flatnonzero(away.all(axis=1))[20:-20]
    assert len(chosen) > 1000
    assert remaining[chosen].max() < 1e-5


@pytest.mark.parametrize(
    "name",
    [
        "learned:slider:5:since_reversal_travel",
        "learned:slider:5:acceleration",
        # Its change of sign is smooth, that of its table is not.
        "learned:slider:5:direction_position_turning@0.2",
    ],
)
def test_a_controller_that_looks_ahead_corrects_it_over_reversals_too(name: str, nominal: Table) -> None:
    """The whole path, the travel in which directions change over and the correction's own motion included."""
    model = model_of(name, nominal, ())
    places_mm = path()
    targets = CompensatedTargets(make_compensation(model), MACHINE.can_setup.limits, "a.hexcomp")
    rows = targets.sliders(places_mm, np.broadcast_to(RPY, places_mm.shape), STEP_S)
    assert rows.refused is None
    uncorrected, _ = errors_mm(model, nominal["sliders_mm"])
    remaining, _ = errors_mm(model, rows.sliders_mm)
    rms = [float(np.sqrt(np.mean(error[ENDS] ** 2))) for error in (remaining, uncorrected)]
    assert rms[0] < 0.1 * rms[1]


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("learned:slider:1:since_reversal_time", "depends on since_reversal_s, which is not known to a controller"),
        ("learned:leg:2:time", "depends on time"),
        ("learned:slider:3:time_position", "depends on time"),
        ("learned:slider:3:time_position_bent", "depends on time"),
        ("learned:slider:3:position_over_time", "depends on time"),
        ("learned:slider:3:time_position_settling@470", "depends on time"),
        ("learned:leg:5:leg_force_lagged@12", "depends on leg_force.lagged@12, which is not known to a controller"),
        ("learned:slider:1:direction_time", "depends on time"),
        ("learned:ball:time", "pushes the ball, not the machine"),
        ("learned:reading:angle", "pushes the reading, not the machine"),
    ],
)
def test_what_a_controller_cannot_know_is_left_out_with_the_reason(name: str, reason: str, nominal: Table) -> None:
    data = make_compensation(model_of(name, nominal))
    assert data.left_out == [(name, reason)]
    assert data.tables == []
    assert data.text().startswith('schema = "hexdbb.compensation/1"\n')


@pytest.mark.parametrize("name", ["learned:slider:2:position_each_way", "learned:leg:3:direction"])
def test_a_change_of_sign_over_all_rates_is_no_switch(name: str, nominal: Table) -> None:
    """In proportion to the velocity then: switched by a table it made a machine's error forty times as large."""
    (sharp,) = {each.effect for each in make_compensation(model_of(f"{name}_turning@0.2", nominal)).tables}
    assert sharp == f"{name}_turning@0.2"
    data = make_compensation(model_of(f"{name}_turning@1925", nominal))
    reason = "changes its sign over 1925 of velocity_mm_s, too gradually for a table"
    assert data.left_out == [(f"{name}_turning@1925", reason)]
    assert data.tables == []


def test_growth_needs_a_reference_temperature(nominal: Table) -> None:
    data = make_compensation(model_of("learned:leg:1:warming", nominal))
    assert [why for _, why in data.left_out] == [
        "needs the temperature of the record's first sample, which was not stated"
    ]


def test_file_there_and_back(tmp_path: Path, nominal: Table) -> None:
    data = make_compensation(model_of("learned:platform_joint:4:joint_angle", nominal))
    write_compensation(data, tmp_path / "a.hexcomp")
    again = read_compensation(tmp_path / "a.hexcomp", MACHINE)
    assert again.text() == data.text()
    assert again.text().startswith('schema = "hexdbb.compensation/2"\n')
    assert again.effects == ["leg_length", "learned:platform_joint:4:joint_angle"]
    assert [table.pushes for table in again.tables] == [[(3, 9 + axis, 1.0)] for axis in range(3)]
    for one, other in zip(again.tables, data.tables, strict=True):
        assert (one.knots, one.values_mm) == (other.knots, other.values_mm)
    assert "hexdbb_compensation_tables" in again.header()


def test_a_name_that_is_no_key_of_toml_is_written_in_quotes(nominal: Table) -> None:
    text = make_compensation(model_of("learned:ball:time", nominal)).text()
    assert '"learned:ball:time" = "pushes the ball, not the machine"\n' in text


def test_a_file_without_a_table_is_of_version_1_and_unchanged() -> None:
    text = make_compensation(new_model(MACHINE, ["leg_length"])).text()
    assert text.startswith('schema = "hexdbb.compensation/1"\n')
    assert "[table" not in text
    assert re.search(r'\n\n\[left_out\]\n\n\[check\]\ncrc32 = "[0-9a-f]{8}"\n$', text)


def test_knots_are_halved_until_lines_are_close() -> None:
    knots = halved(np.linspace(0.0, 1.0, 5), lambda at: 0.01 * np.sin(20.0 * at)[:, None])
    at = np.linspace(0.0, 1.0, 4001)
    error = np.interp(at, knots, 0.01 * np.sin(20.0 * knots)) - 0.01 * np.sin(20.0 * at)
    assert np.abs(error).max() <= 1.05e-5
    np.testing.assert_allclose(np.diff(knots), knots[1], rtol=1e-9)
    assert len(halved(np.linspace(0.0, 1.0, 5), lambda at: at[:, None])) == 5


def test_a_table_holds_the_whole_function(nominal: Table) -> None:
    model = model_of("learned:leg:5:turning_rate", nominal)
    (table,) = learned_tables(model.terms[-1], MACHINE)
    effect = model.terms[-1].learned
    assert effect is not None
    at = np.linspace(table.knots[0], table.knots[-1], 1001)
    expected = effect.space.functions(at) @ effect.coefficients(model.terms[-1].values)
    np.testing.assert_allclose(np.interp(at, table.knots, table.values_mm), expected, atol=2e-5)


def test_the_command_names_the_tables_and_follows_a_path(tmp_path: Path, nominal: Table) -> None:
    model = model_of("learned:leg:5:joint_angle", nominal)
    model = replace(model, terms=(*model.terms, model_of("learned:leg:2:time", nominal).terms[-1]))
    save_model(model, tmp_path / "model.toml")
    run = CliRunner(catch_exceptions=False)
    shown = run.invoke(command, [str(tmp_path / "model.toml"), "-o", str(tmp_path / "a.hexcomp")])
    assert shown.exit_code == 0
    lines = shown.output.splitlines()
    assert "corrected    leg_length, learned:leg:5:joint_angle" in lines
    assert "left out     learned:leg:2:time: depends on time" in lines
    (line,) = [each for each in lines if each.startswith("table ")]
    assert re.fullmatch(
        r"table        learned:leg:5:joint_angle: leg by slider_joint_angle_rad, \d+ knots, up to [\d.]+ µm", line
    )
    (tmp_path / "path.csv").write_text("x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg\n0,0,285,0,0,0\n1,2,285,0,0,0\n")
    options = ["--poses", str(tmp_path / "path.csv"), "-o", str(tmp_path / "s.csv"), "--json"]
    done = run.invoke(command, [str(tmp_path / "a.hexcomp"), *options])
    (table,) = json.loads(done.output)["tables"]
    assert (table["port"], table["variable"], table["times"]) == ("leg", "slider_joint_angle_rad", "")
    written = np.loadtxt(tmp_path / "s.csv", delimiter=",", skiprows=1)
    expected = path_targets(make_compensation(model), [[0.0, 0.0, 285.0], [1.0, 2.0, 285.0]], np.zeros(3))
    np.testing.assert_allclose(written, expected.sliders_mm, atol=1e-6)


def test_the_package_s_own_function_writes_them(tmp_path: Path, nominal: Table) -> None:
    data = hexdbb.compensate(model_of("learned:vertical:1:position", nominal), tmp_path / "a.hexcomp")
    assert data.effects == ["leg_length", "learned:vertical:1:position"]
    assert read_compensation(tmp_path / "a.hexcomp").tables[0].pushes == data.tables[0].pushes
