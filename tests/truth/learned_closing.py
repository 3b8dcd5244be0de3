"""A loop closed on a machine with forms and a fault outside the catalogue, of known truth.

Measured on circles spread over the space to be compensated, diagnosed, discovered (known effects and what is learned),
added, compensated, and measured on circles that took no part (`tests.truth.held_out`). The error is the machine's own:
a perfect gauge and set-up, the radial error of the held-out circles as `tests.truth.closing` defines it, before and
after. Beside it stands what limits it: the same with the faults known exactly, where only geometry is fitted to the
same readings.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from tests.truth.closing import circle_errors, drive_of
from tests.truth.held_out import held_out_plans
from tests.truth.spread_plan import PACE, spread_plan

from hexdbb.compensation import make_compensation
from hexdbb.diagnosis import diagnose
from hexdbb.discovery import discover
from hexdbb.discovery.auto import predicts_better, without_needless
from hexdbb.errors import InputError
from hexdbb.ledger import add_effect
from hexdbb.model import Model, new_model
from hexdbb.record import Record
from hexdbb.rig.truth import Setup
from hexdbb.samples import Samples, predict
from hexdbb_truth.forms import cases as forms
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.measure import Measured, Sized
from hexdbb_truth.simulate import Pace
from hexdbb_truth.timeline import Drive

Floats = NDArray[np.float64]

HELD_OUT_PACE = Pace(rate_hz=6.0, instants_per_sample=40, travel_s=4.0)
"""One instant every 4 ms, the cycle of the rig."""
MAX_CORRECTION_MM = 10.0
"""Limit of the correction of one slider: a dent of a tenth of a millimetre needs a millimetre where a leg stands
steeply, and forms are up to three."""
MOST_ROUNDS = 4
"""Verdicts asked for: two faults and what their forms leave."""
TIMES_NOISE = 10.0
"""What each fault leaves when geometry has been fitted, over the noise."""
KNOWN = ("backlash", "gravity_sag", "pitch_cyclic", "servo_lag")
OUTSIDE = ("dent", "rail_waves", "tape_bump", "joint_eccentric", "plate_bends")


@dataclass(frozen=True)
class Closed:
    """One machine: what was hidden and found, and the error of the held-out circles, µm RMS.

    Attributes
    ----------
    case : str
    added : tuple of str
        Effects of the model, known and learned.
    verdict : str
        The last one.
    before_um, after_um : float
        Not compensated, and compensated by the model; nan where the controller refuses.
    model_um : float
        What the model misses of the same circles where they are not compensated: what a controller would leave that
        corrects all that is in the model.
    known_um : float
        After, with the faults known exactly: what the noise leaves of geometry.
    left_out : tuple of str
        Those of `added` that the controller does not correct.
    """

    case: str
    added: tuple[str, ...]
    verdict: str
    before_um: float
    after_um: float
    model_um: float
    known_um: float
    left_out: tuple[str, ...] = ()

    @property
    def ratio(self) -> float:
        """How many times smaller the error is."""
        return self.before_um / self.after_um


def case_of(seed: int, deviation: float, half: str) -> forms.Case:
    """Return a machine with one known fault, whose form deviates, and one outside the catalogue."""
    kinds = (KNOWN[seed % len(KNOWN)], OUTSIDE[seed % len(OUTSIDE)])
    return forms.Case(kinds, deviation, TIMES_NOISE, half, seed, driven=_driven())


@cache
def _driven() -> History:
    return History(spread_plan(), PACE)


def close(case: forms.Case) -> Closed:
    """Close the loop on one machine.

    Raises
    ------
    UnreachableSizeError
        No machine in use has a fault so large.
    """
    record, machine = case.record(), case.history.machine
    faults = [(each.action, each.size) for each in case.hidden]
    model, added, verdict = _found(Samples.of([record]), new_model(record.machine))
    before_um = _rms_um(held_out_records(case, faults, None))
    after_um = float("nan")
    try:
        after_um = _rms_um(held_out_records(case, faults, drive_of(model, machine, MAX_CORRECTION_MM)))
    except InputError as error:
        verdict = f"{verdict}; {error}"
    known = diagnose(Samples.of([_without(case, record)]), new_model(record.machine), check_held_out=False).model
    known_um = _rms_um(held_out_records(case, [], drive_of(known, machine, MAX_CORRECTION_MM)))
    model_um = _rms_um(missed_records(case, faults, model))
    left_out = tuple(name for name, _ in make_compensation(model).left_out if name in added)
    return Closed(case.name, added, verdict, before_um, after_um, model_um, known_um, left_out)


def held_out_records(
    case: forms.Case, faults: Sequence[Sized], drive: Drive | None, setup: Setup | None = None
) -> Iterator[Record]:
    """Yield the records of the held-out circles without gauge noise, in a perfect set-up or another; one each bar."""
    truth = case.truth.model_copy(update={"setup": setup or Setup()})
    for plan in held_out_plans():
        history = History(plan, HELD_OUT_PACE, drive)
        reading_mm = Measured(truth, history, case.history).readings_mm(faults)
        driven = forms.Case((), 0.0, 0.0, case.half, case.seed, driven=history, temperature=False)
        yield _with_readings(driven.record(), reading_mm)


def missed_records(case: forms.Case, faults: Sequence[Sized], model: Model) -> Iterator[Record]:
    """Yield what a model misses of the held-out circles, not compensated, with the ball and bar that were fitted."""
    setup = case.truth.setup.model_copy(update={"cup_error_um": ()})
    for record in held_out_records(case, faults, None, setup):
        samples = Samples.of([record])
        yield _with_readings(record, predict(samples, model.with_mounts(samples.mounts)).residual_mm)


def _found(samples: Samples, model: Model) -> tuple[Model, tuple[str, ...], str]:
    """Return the model after `discover`, and `add` of causes, learned ones too, and of forms, until nothing is missing.

    Of what describes a form, what predicts circles left out is kept, as a user reads in the ledger; what a later
    addition makes needless is taken out, as `discover --auto` does.
    """
    model = diagnose(samples, model, check_held_out=False).model
    added: list[str] = []
    verdict = ""
    for _ in range(MOST_ROUNDS):
        found = discover(samples, model, with_tables=False)
        verdict, earlier = found.verdict, tuple(added)
        model, causes = _with(samples, model, [each.choice for each in found.causes], always=True)
        forms = [name for each in found.causes for name in each.refinements] or list(found.refinements)
        model, refinements = _with(samples, model, [each for each in forms if each not in added], always=False)
        added += [*causes, *refinements]
        if not (causes or refinements):
            break
        for step in without_needless(samples, model, earlier):
            model = step.diagnosis.model
            added.remove(step.choice)
    return model, tuple(added), verdict


def _with(samples: Samples, model: Model, choices: Sequence[str], *, always: bool) -> tuple[Model, list[str]]:
    """Add effects one by one: always, or those that predict circles left out."""
    added = []
    for each in choices:
        wider = add_effect(samples, model, each).model
        if always or predicts_better(wider):
            model = wider
            added.append(each)
    return model, added


def _without(case: forms.Case, record: Record) -> Record:
    """Return a record less what the faults add to its readings."""
    faults_mm = case.readings_mm() - case.measured.readings_mm([])
    return _with_readings(record, record.columns["reading_um"] / 1e3 - faults_mm)


def _with_readings(record: Record, reading_mm: Floats) -> Record:
    columns = {**record.columns, "reading_um": 1e3 * reading_mm}
    return Record(columns, record.gauge, record.mounts, record.circles, record.machine)


def _rms_um(records: Iterable[Record]) -> float:
    """Return the radial error over all circles of some records."""
    errors = [each for record in records for each in circle_errors(record)]
    return float(np.sqrt(np.mean([each.rms_um**2 for each in errors])))
