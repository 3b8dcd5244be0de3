"""Time since the fixing: it restarts at each fixing, and is nan where there is only one."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.learned import Learned, Space
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("none-calibrate-s1@two_mounts").record()])


def test_it_begins_anew_at_each_fixing(samples: Samples) -> None:
    mount, since, time_s = samples["mount"], samples["time_since_fixing_s"], samples["time_s"]
    for each in np.unique(mount):
        assert since[mount == each] == pytest.approx(time_s[mount == each] - time_s[mount == each].min())


def test_what_seats_itself_after_each_fixing_is_no_function_of_time(samples: Samples) -> None:
    seated = np.exp(-samples["time_since_fixing_s"] / 100.0)
    left = {}
    for name in ("time_since_fixing", "time"):
        functions = Space.of(
            Learned.parse(f"learned:ball:{name}"), samples, samples.machine.sliders.screw_lead_mm
        ).design(samples, 0)
        fitted = functions @ np.linalg.lstsq(functions, seated, rcond=None)[0]
        left[name] = float(np.std(seated - fitted) / np.std(seated))
    assert left["time_since_fixing"] < 0.02 < 0.2 < left["time"]


def test_of_one_fixing_there_is_none() -> None:
    samples = Samples.of([case("none-calibrate-s1").record()])
    assert np.isnan(samples["time_since_fixing_s"]).all()
