"""What cannot be judged where slider positions or times were computed: columns of the state, and effects.

A record may state that its slider coordinates follow from the commanded circle, or its times from the commanded feed
(`hexdbb.record.not_measured`). Positions are then good to the drives' following error, a few micrometres in a smooth
motion, which geometry does not notice. How they change with time is not known: a drive that lags, or halts for some
milliseconds at a reversal, makes the same readings as a slider that lags behind its encoder, a gauge read late, or
stiction. An effect that needs one of these columns is therefore no candidate.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cache

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.model import Model, effect_info, effect_names
from hexdbb.record import Record

COMPUTED = {
    "sliders": frozenset(
        {
            *("velocity_mm_s", "acceleration_mm_s2", "jerk_mm_s3", "snap_mm_s4", "since_reversal_s"),
            # A leg turns as fast as its slider moves.
            *("slider_joint_rate_rad_s", "platform_joint_rate_rad_s", "swing_rate_rad_s"),
        }
    ),
    "time": frozenset({"time_s", "time_in_sweep_s", "time_in_circle_s", "time_since_fixing_s", "warming_k"}),
}
"""Columns that cannot be judged, by what was computed instead of measured."""
MEANING = {
    "sliders": "following errors of the drives count as errors of the machine",
    "time": "drift and warming cannot be told",
}


def unmeasured_columns(records: Iterable[Record]) -> frozenset[str]:
    """Return the columns of the state that some of the records cannot give; none where everything was measured."""
    stated = [each.not_measured.model_dump() for each in records]
    return frozenset(name for what, names in COMPUTED.items() for name in names if any(each[what] for each in stated))


def judged_effects(unmeasured: frozenset[str], model: Model, names: Iterable[str]) -> list[str]:
    """Return those effects, by name, that need none of the columns that were not measured."""
    return [name for name in names if not unmeasured & model.needs_of(name)]


def require_judged(unmeasured: frozenset[str], model: Model, effect: str, origin: str) -> None:
    """Check that an effect needs nothing that was not measured.

    Raises
    ------
    InputError
        It does; names the records, the effect and what it needs.
    """
    if not judged_effects(unmeasured, model, [effect]):
        needs = ", ".join(sorted(unmeasured & model.needs_of(effect)))
        raise InputError(
            f"{origin}: {effect} needs {needs}, which this record computes (expected a record of measured values)"
        )


def with_judged_free(unmeasured: frozenset[str], model: Model) -> Model:
    """Return a model whose values are held where their effects need what was not measured."""
    if not unmeasured:
        return model
    names = {each.effect for each in model.parameters()}
    judged = set(judged_effects(unmeasured, model, names))
    free = model.free.copy()
    free[[each.effect not in judged for each in model.parameters()]] = False
    return model.with_free(free)


def not_measured_sentences(records: Sequence[Record]) -> Iterator[str]:
    """Yield a sentence for each thing that was computed: from what, what it means, which effects are no candidates."""
    for what, columns in COMPUTED.items():
        origins = {text: None for each in records if (text := getattr(each.not_measured, what))}
        if origins:
            noun = "slider positions are" if what == "sliders" else "times are"
            left_out = ", ".join(_needing(columns, records[0].machine))
            yield (
                f"{noun} not measured but computed ({'; '.join(origins)}): {MEANING[what]}; no candidates: {left_out}"
            )


@cache
def _needing(columns: frozenset[str], machine: MachineFile) -> tuple[str, ...]:
    names = effect_names("catalogue")
    return tuple(sorted(name for name in names if columns & frozenset(effect_info(machine, 1, name).needs)))
