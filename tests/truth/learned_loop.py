"""A loop closed on machines with forms and a fault outside the catalogue: ``python -m tests.truth.learned_loop``.

Measured, diagnosed, discovered (known effects and what is learned), added, compensated, and measured on circles that
took no part. The error is the machine's own: a perfect gauge and set-up, the radial error of the circles left out as
`tests.truth.closing` defines it, before and after.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from tests.truth.closing import circle_errors, drive_of

from hexdbb.diagnosis import diagnose
from hexdbb.discovery import discover
from hexdbb.errors import InputError
from hexdbb.ledger import add_effect
from hexdbb.model import Model, new_model
from hexdbb.record import Record
from hexdbb.rig.truth import Setup
from hexdbb.samples import Samples
from hexdbb_truth.forms import cases as forms
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.measure import Measured
from hexdbb_truth.timeline import Drive

LEFT_OUT = (2, 4)
"""Places of the circles that take no part in the fit, of the plan's nine."""
MAX_CORRECTION_MM = 10.0
"""Limit of the correction of one slider: circles that took no part lie where the readings determine little."""
MOST_ROUNDS = 4
"""Verdicts asked for: two faults and what their forms leave."""
PREDICTS = 0.98
"""Part of the held-out error that is left at most where a form's function is kept: what gains less is noise's."""
KNOWN = ("backlash", "gravity_sag", "pitch_cyclic", "servo_lag")
OUTSIDE = ("dent", "rail_waves", "tape_bump", "joint_eccentric", "plate_bends")


@dataclass(frozen=True)
class Closed:
    """One machine: what was hidden and found, and the error of the circles left out before and after, µm RMS."""

    case: str
    added: tuple[str, ...]
    verdict: str
    before_um: float
    after_um: float

    @property
    def ratio(self) -> float:
        """How many times smaller the error is."""
        return self.before_um / self.after_um


def case_of(seed: int, deviation: float) -> forms.Case:
    """Return a machine with one known fault, whose form deviates, and one outside the catalogue."""
    kinds = (KNOWN[seed % len(KNOWN)], OUTSIDE[seed % len(OUTSIDE)])
    return forms.Case(kinds, deviation, 10.0, "judge", seed, "varied")


def close(case: forms.Case) -> Closed:
    """Close the loop on one machine."""
    record = case.record()
    seen = ~np.isin(record.columns["circle"], _left_out(record))
    model, added, verdict = _found(Samples.of([record.part(seen)]), new_model(record.machine))
    machine = case.history.machine
    before_um = _error_um(case, None)
    try:
        after_um = _error_um(case, drive_of(model, machine, MAX_CORRECTION_MM))
    except InputError as error:
        verdict, after_um = f"{verdict}; {error}", float("nan")
    return Closed(case.name, added, verdict, before_um, after_um)


def _left_out(record: Record) -> list[int]:
    return [record.circles[place].id for place in LEFT_OUT]


def _found(samples: Samples, model: Model) -> tuple[Model, tuple[str, ...], str]:
    """Return the model after `discover --auto`, then `add` of what is learned and of forms, until nothing is missing.

    Of what describes a form, what predicts circles left out is kept, as a user reads in the ledger.
    """
    model = diagnose(samples, model, check_held_out=False).model
    added: list[str] = []
    verdict = ""
    for _ in range(MOST_ROUNDS):
        found = discover(samples, model)
        verdict = found.verdict
        model, causes = _with(samples, model, [each.choice for each in found.causes], always=True)
        forms = [name for each in found.causes for name in each.refinements] or list(found.refinements)
        model, refinements = _with(samples, model, [each for each in forms if each not in added], always=False)
        added += [*causes, *refinements]
        if not (causes or refinements):
            break
    return model, tuple(added), verdict


def _with(samples: Samples, model: Model, choices: Sequence[str], *, always: bool) -> tuple[Model, list[str]]:
    """Add effects one by one: always, or those that predict circles left out."""
    added = []
    for each in choices:
        wider = add_effect(samples, model, each).model
        step = wider.ledger[-1]
        predicts = (step.heldout_after_um or 0.0) < PREDICTS * (step.heldout_before_um or 0.0)
        if always or predicts:
            model = wider
            added.append(each)
    return model, added


def _error_um(case: forms.Case, drive: Drive | None) -> float:
    """Return the radial error of the circles left out, of the machine alone."""
    history = History(case.history.plan, case.history.pace, drive)
    measured = Measured(case.truth.model_copy(update={"setup": Setup()}), history)
    reading_mm = measured.readings_mm([(each.action, each.size) for each in case.hidden])
    columns = {**replace(case, temperature=False).record().columns, "reading_um": reading_mm * 1e3}
    plan = history.plan
    record = Record(columns, plan.gauge, plan.mounts, plan.circles, history.machine)
    part = record.part(np.isin(record.columns["circle"], _left_out(record)))
    errors = list(circle_errors(part))
    return float(np.sqrt(np.mean([each.rms_um**2 for each in errors])))


def main() -> None:
    """Close the loop on some machines and print a table."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--deviation", type=float, default=0.1, help="of the known fault's form")
    asked = parser.parse_args()
    print("| machine | added | last verdict | before, µm | after, µm | times smaller |\n|---|---|---|---|---|---|")
    for seed in range(asked.first, asked.first + asked.seeds):
        one = close(case_of(seed, asked.deviation))
        cells = (one.case, ", ".join(one.added), one.verdict, f"{one.before_um:.2f}", f"{one.after_um:.3f}")
        print(f"| {' | '.join(cells)} | {one.ratio:.0f} |", flush=True)


if __name__ == "__main__":
    main()
