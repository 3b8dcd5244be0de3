"""The trend of a machine over its records: what changes, since when, and what is beyond its limit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.comparison import QUANTITIES
from hexdbb.diagnosis.sufficiency import MATTERS_OF_NOISE
from hexdbb.errors import InputError
from hexdbb.files.results import number_or_none
from hexdbb.machine import MachineFile, Watch
from hexdbb.model import Choice, Model, new_model
from hexdbb.samples import Samples, require_agreement
from hexdbb.threads import one_thread
from hexdbb.trend.changing import Found, find_changes
from hexdbb.trend.dated import Dated
from hexdbb.trend.joint import JointFit, Part
from hexdbb.trend.json_form import ChangeJson, ExceededJson, SegmentJson, SeriesJson, TrendJson, TrendRecordJson
from hexdbb.trend.limits import Exceeded, exceeded, status_of, watched_effects
from hexdbb.trend.segments import Segment, segments
from hexdbb.trend.series import WATCHED_QUANTITIES, Series, effect_series, quantity_series

Floats = NDArray[np.float64]

DAY_S = 86400.0
DAYS_A_MONTH = 365.2425 / 12.0
SYMBOLS = {each.key: each.symbol for each in QUANTITIES if each.key in WATCHED_QUANTITIES}


@dataclass(frozen=True, eq=False)
class Trend:
    """What a machine's records show over time.

    Attributes
    ----------
    dated : tuple of Dated
        In the order of their times.
    series : tuple of Series
        Quantities first, then every effect's values.
    found : tuple of Found
        What changes.
    segments : dict of str to list of Segment
        By the name of every quantity and of every changing value.
    exceeded : tuple of Exceeded
    notes : tuple of str
    fit : JointFit
    watches : tuple of Watch
        Limits of the machine file.
    """

    dated: tuple[Dated, ...]
    series: tuple[Series, ...]
    found: tuple[Found, ...]
    segments: dict[str, list[Segment]]
    exceeded: tuple[Exceeded, ...]
    notes: tuple[str, ...]
    fit: JointFit
    watches: tuple[Watch, ...] = ()

    @property
    def is_watched(self) -> bool:
        """Whether there is any limit."""
        return bool(self.watches)

    @property
    def status(self) -> int:
        """Exit status for a monitor: 0 fine, 3 beyond a limit, 4 beyond an alarm."""
        return status_of(self.exceeded)

    @property
    def changing(self) -> list[Series]:
        """Values of effects that change."""
        return [each for each in self.series if each.effect and each.is_changing]

    @property
    def residual_um(self) -> list[float]:
        """Root mean square that the fit leaves of every record."""
        return [each.rms_mm * 1e3 for each in self.fit.equations]

    @property
    def noise_um(self) -> list[float]:
        """Noise of one reading of every record."""
        return [each.noise_mm * 1e3 for each in self.fit.equations]

    def to_json(self) -> TrendJson:
        """Return the object as the command prints it."""
        machine = self.dated[0].record.machine
        return TrendJson(
            machine=machine.name,
            status=self.status,
            records=tuple(
                TrendRecordJson(
                    name=each.record.name,
                    sha256=each.record.content_hash(),
                    measured=each.measured.isoformat(),
                    residual_um=residual,
                    noise_um=noise,
                )
                for each, residual, noise in zip(self.dated, self.residual_um, self.noise_um, strict=True)
            ),
            changes=tuple(
                ChangeJson(what=each.changing.label, log_evidence=each.gain, alternatives=each.rivals)
                for each in self.found
            ),
            exceeded=tuple(
                ExceededJson(
                    what=each.series.label,
                    parameter=each.series.parameter,
                    limit=each.watch.limit,
                    unit=each.series.unit,
                    since=self.dated[each.first].measured.isoformat(),
                    until=self.dated[each.last].measured.isoformat(),
                    alarm=each.is_alarm,
                )
                for each in self.exceeded
            ),
            series=tuple(self._series_json(each) for each in self.series),
            notes=self.notes,
        )

    def _series_json(self, series: Series) -> SeriesJson:
        def numbers(values: Floats) -> tuple[float | None, ...]:
            return tuple(number_or_none(float(each)) for each in values)

        return SeriesJson(
            what=series.label,
            parameter=series.parameter,
            unit=series.unit,
            changing=series.is_changing and bool(series.effect),
            identifiable=series.is_known,
            value=numbers(series.value),
            sigma=numbers(series.sigma),
            change=numbers(series.change),
            change_sigma=numbers(series.change_sigma),
            segments=tuple(
                SegmentJson(
                    since=self.dated[each.first].measured.isoformat(),
                    until=self.dated[each.last].measured.isoformat(),
                    level=each.level,
                    per_month=each.slope * DAYS_A_MONTH,
                )
                for each in self.segments.get(series.name, ())
            ),
        )


@one_thread
def trend(
    dated: Sequence[Dated],
    machine: MachineFile,
    model: Model | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Trend:
    """Fit a machine's records together, find what changes, and judge it by the limits of the machine file.

    Parameters
    ----------
    dated : sequence of Dated
        One at least, of one machine, in any order.
    machine : MachineFile
        Whose `watch` tables are the limits.
    model : Model, optional
        Its effects are fitted; a new model where not given. Effects that are watched join it.
    progress : callable
        Told what is done.

    Raises
    ------
    InputError
        No record, one twice, one of another machine, or a limit of what there is not; or records of one fixing of the
        cup with different cups or bars.
    RunError
        The fit did not come to rest.
    """
    if not dated:
        raise InputError("no record (expected one at least)")
    ordered = tuple(sorted(dated, key=lambda each: each.measured))
    watches = machine.watch or ()
    origin = str(machine.path) if machine.path is not None else machine.name
    fitted = with_watched(
        model if model is not None else new_model(machine), watched_effects(watches, [*SYMBOLS.values()]), origin
    )
    progress("reading records")
    require_agreement([each.record for each in ordered])
    samples = [Samples.of([each.record]) for each in ordered]
    fit, found = find_changes([Part.of(each) for each in samples], fitted, progress)
    progress("weighing every value")
    every = [*quantity_series(samples, SYMBOLS), *effect_series(fit)]
    beyond, notes = exceeded(every, watches, origin)
    days = np.array([each.measured.timestamp() / DAY_S for each in ordered])
    cut = {
        each.name: segments(days, each.value, each.sigma if each.is_known else each.change_sigma)
        for each in every
        if each.is_changing and np.isfinite(each.value).all()
    }
    return Trend(
        ordered, tuple(every), tuple(found), cut, tuple(beyond), (*notes, *_lacking(ordered, fit)), fit, tuple(watches)
    )


def with_watched(model: Model, effects: Sequence[str], origin: str) -> Model:
    """Return a model that has the watched effects, free to be fitted; `InputError` where there is no such effect."""
    for text in effects:
        choice = Choice.parse(text)
        try:
            term = model.term(choice.effect)
            if term is None or not term.free[choice.of_effect(model.info(choice.effect))].all():
                model = model.with_effect(choice)
        except InputError as error:
            raise InputError(f"{origin}: watch: {error}") from None
    return model


def _lacking(ordered: Sequence[Dated], fit: JointFit) -> list[str]:
    """Name the records of which the model leaves more than noise."""
    missing = []
    for each, equations in zip(ordered, fit.equations, strict=True):
        left = np.sqrt(max(equations.rms_mm**2 - equations.noise_mm**2, 0.0))
        if left >= MATTERS_OF_NOISE * equations.noise_mm:
            missing.append(f"{each.month} ({left * 1e3:.2f} µm)")
    if not missing:
        return []
    return [f"the model leaves more than noise of {', '.join(missing)}: hexdbb discover says what it lacks"]
