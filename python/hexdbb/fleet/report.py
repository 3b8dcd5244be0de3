"""What the results of a fleet say: machines, growth, what groups share, outliers, what could not be judged."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from hexdbb.cluster import Results
from hexdbb.errors import InputError
from hexdbb.fleet.growth import DAYS_PER_YEAR, Growth, grown, significant
from hexdbb.fleet.json_form import (
    CauseJson,
    CopyJson,
    FleetReportJson,
    GrowthJson,
    MachineJson,
    NotJudgedJson,
    OutlierJson,
    SharedCauseJson,
    SharedValueJson,
)
from hexdbb.fleet.observed import READ, Observed, observe
from hexdbb.fleet.shared import SharedCause, SharedValue, shared_causes, shared_values
from hexdbb.fleet.worst import MachineState, ranked_machines


@dataclass(frozen=True)
class Outlier:
    """A point of a series far off its line; `expected` is None where there is no line."""

    line: Growth
    place: int

    @property
    def found(self) -> float:
        """The value."""
        return float(self.line.series.value[self.place])

    @property
    def expected(self) -> float | None:
        """What the line says at its time."""
        days = self.line.series.days
        if np.isnan(self.line.slope):
            return None
        return self.line.at_first + self.line.slope * float(days[self.place] - days[0]) / DAYS_PER_YEAR


@dataclass(frozen=True)
class FleetReport:
    """What the results of a fleet say.

    Attributes
    ----------
    url : str
        Where the results lie.
    observed : Observed
    machines : tuple of MachineState
        The worst first.
    growing : tuple of Growth
        Values that change with time.
    shared_values, shared_causes : tuple
        What groups of machines have in common.
    outliers : tuple of Outlier
    """

    url: str
    observed: Observed
    machines: tuple[MachineState, ...]
    growing: tuple[Growth, ...]
    shared_values: tuple[SharedValue, ...]
    shared_causes: tuple[SharedCause, ...]
    outliers: tuple[Outlier, ...]

    @property
    def causes(self) -> list[tuple[str, list[str]]]:
        """Causes that discoveries found, with their machines, the most frequent first."""
        counted = Counter(effect for _, effect in self.observed.causes)
        return [
            (effect, [machine for machine, found in self.observed.causes if found == effect])
            for effect, _ in sorted(counted.items(), key=lambda pair: (-pair[1], pair[0]))
        ]

    @property
    def records(self) -> int:
        """Records judged, each once."""
        return len({row["record"] for row in self.observed.records})

    @property
    def sentence(self) -> str:
        """The fleet in one sentence."""
        seen = self.observed
        left = f", {len(seen.not_judged)} could not be judged" if seen.not_judged else ""
        worst = next((each for each in self.machines if each.deviation_um is not None), None)
        most = "" if worst is None else f"; worst {worst.machine}, {worst.deviation_um:.1f} µm circular deviation"
        return (
            f"{self.records} records of {len(self.machines)} machines{left}{most};"
            f" {_count(len(self.growing), 'value changes', 'values change')} with time,"
            f" {_count(len(self.shared_values) + len(self.shared_causes), 'weakness', 'weaknesses')} shared by a group"
        )

    def text(self) -> str:
        """Return the report as lines of a terminal, the first of each part."""
        from hexdbb.fleet.text import report_text  # it reads this class

        return report_text(self)

    def to_json(self) -> dict[str, Any]:
        """Return what ``hexdbb fleet report --json`` prints."""
        return FleetReportJson(
            records=self.records,
            machines=tuple(_machine_json(each) for each in self.machines),
            growing=tuple(_growth_json(each) for each in self.growing),
            shared_values=tuple(_shared_json(each) for each in self.shared_values),
            causes=tuple(CauseJson(effect, tuple(machines)) for effect, machines in self.causes),
            shared_causes=tuple(SharedCauseJson(**vars(each)) for each in self.shared_causes),
            outliers=tuple(_outlier_json(each) for each in self.outliers),
            not_judged=tuple(NotJudgedJson(source, reason) for source, reason in self.observed.not_judged),
            copies=tuple(CopyJson(source, first) for source, first in self.observed.copies),
        ).to_json()


def fleet_report(results: Results, progress: Callable[[str], None] = lambda _: None) -> FleetReport:
    """Read a fleet's results and report on them.

    Parameters
    ----------
    results : Results
    progress : callable
        Told what is being done.

    Raises
    ------
    InputError
        There are none.
    RunError
        A part is damaged, or the store refuses.
    """
    rows = results.table(READ)
    if not len(rows):
        raise InputError(f"{results.url}: no row yet (expected results: hexdbb fleet diagnose URL... -o {results.url})")
    progress(f"comparing {len(rows):,} rows")
    observed = observe(rows)
    lines = grown(observed.series)
    outliers = [Outlier(line, int(place)) for line in lines for place in np.flatnonzero(line.outliers)]
    return FleetReport(
        results.url,
        observed,
        tuple(ranked_machines(observed)),
        tuple(significant(lines)),
        tuple(shared_values(observed)),
        tuple(shared_causes(observed)),
        tuple(outliers),
    )


def _count(number: int, one: str, several: str = "") -> str:
    return f"{number or 'no'} {one if number == 1 else several or one + 's'}"


def _machine_json(state: MachineState) -> MachineJson:
    return MachineJson(
        state.machine,
        state.machine_name,
        state.batch,
        state.records,
        None if state.newest is None else state.newest.isoformat(),
        state.deviation_um,
        state.rms_after_um,
        state.verdict,
    )


def _growth_json(line: Growth) -> GrowthJson:
    name = line.series.value_name
    return GrowthJson(
        machine=line.series.machine,
        effect=name.effect,
        element=name.element,
        name=name.name,
        unit=name.unit,
        per_year=line.slope,
        low=line.low,
        high=line.high,
        change=line.change,
        at_last=line.at_last,
        records=int((~line.outliers).sum()),
        p=line.p,
    )


def _shared_json(shared: SharedValue) -> SharedValueJson:
    name = shared.value_name
    keys = {key: value for key, value in vars(shared).items() if key != "value_name"}
    return SharedValueJson(effect=name.effect, element=name.element, name=name.name, unit=name.unit, **keys)


def _outlier_json(outlier: Outlier) -> OutlierJson:
    series = outlier.line.series
    return OutlierJson(
        source=series.sources[outlier.place],
        machine=series.machine,
        value=series.value_name.words,
        found=outlier.found,
        expected=outlier.expected,
        unit=series.value_name.unit,
    )
