"""The machine as drawn: legs as long as they are, joints where the platform is, displacements magnified."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hexdbb.model import with_value
from hexdbb.workbench import Session
from hexdbb.workbench.machine_view import SHOWN_MM, MachineView


@pytest.fixture
def session(folder: Path) -> Session:
    return Session([Path("today.parquet")], Path("model.toml"))


@pytest.mark.parametrize("angle_deg", [0.0, 123.0, 359.9])
def test_points_are_those_of_the_nominal_machine(session: Session, angle_deg: float) -> None:
    stand = MachineView(session.samples, session.selection, session.model).at(angle_deg)
    machine, (circle, *_) = session.samples.machine, session.records[0].circles
    # The record's sliders are driven to the commanded pose, which backlash and noise of the encoders hardly change.
    np.testing.assert_allclose(np.linalg.norm(stand.joints - stand.sliders, axis=1), machine.legs.length_mm, atol=0.05)
    assert np.linalg.norm(stand.ball - stand.cup) == pytest.approx(circle.radius_mm, abs=0.05)
    place = stand.ball - stand.cup
    assert (np.degrees(np.arctan2(place[1], place[0])) - angle_deg + 180.0) % 360.0 - 180.0 == pytest.approx(
        0.0, abs=3.0
    )


def test_displacements_fill_the_picture_and_no_more(session: Session) -> None:
    view = MachineView(session.samples, session.selection, session.model)
    moved = [np.linalg.norm(stand.moved_ball - stand.ball) for stand in map(view.at, np.arange(0.0, 360.0, 5.0))]
    assert 0.3 * SHOWN_MM < max(moved) < 1.05 * SHOWN_MM


def test_a_longer_leg_is_a_correction_of_that_leg(session: Session) -> None:
    before = MachineView(session.samples, session.selection, session.model).at(10.0).corrections_um
    values = dict(zip([each.label for each in session.model.parameters()], session.model.values, strict=True))
    longer = with_value(session.model, "leg_length:3 longer", 1e3 * values["leg_length:3 longer"] + 7.0)
    after = MachineView(session.samples, session.selection, longer).at(10.0).corrections_um
    np.testing.assert_allclose(after - before, [0.0, 0.0, 7.0, 0.0, 0.0, 0.0], atol=1e-9)


def test_a_nominal_machine_is_not_displaced(folder: Path) -> None:
    session = Session([Path("today.parquet")])
    view = MachineView(session.samples, session.selection, session.model)
    stand = view.at(90.0)
    assert view.magnification == 1.0
    np.testing.assert_allclose(stand.moved_ball, stand.ball, atol=1e-6)
    assert view.largest_correction_um == 0.0
