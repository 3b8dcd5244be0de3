"""A fleet's report as lines of a terminal: the first entries of each part."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, TypeVar

from hexdbb.fleet.growth import Growth
from hexdbb.fleet.shared import SharedCause, SharedValue
from hexdbb.fleet.worst import MachineState
from hexdbb.units import readable_unit

if TYPE_CHECKING:
    from hexdbb.fleet.report import FleetReport, Outlier

SHOWN = 10
"""Entries of each part: more would scroll the first away; page and JSON have all."""
T = TypeVar("T")


def report_text(report: FleetReport) -> str:
    """Return the lines of a report."""
    return "\n".join(_lines(report))


def _lines(report: FleetReport) -> Iterator[str]:
    yield report.sentence
    yield from _part("Worst machines (circular deviation; what the model leaves, RMS)", report.machines, _machine)
    yield from _part("Changing with time (slope and its 95 % interval)", report.growing, growth_words)
    yield from _part("Shared by a batch or a type of machine", report.shared_values, _shared)
    yield from _part("Causes found", report.causes, lambda each: f"{each[0]}: {', '.join(each[1])}")
    yield from _part("Causes shared by a batch or a type of machine", report.shared_causes, _shared_cause)
    yield from _part("Far off the other records of their machine", report.outliers, _outlier)
    yield from _part("Not judged", report.observed.not_judged, lambda each: f"{each[0]}: {each[1]}")
    yield from _part("Found twice, counted once", report.observed.copies, lambda each: f"{each[0]}: as {each[1]}")


def _part(heading: str, entries: Sequence[T], line: Callable[[T], str]) -> Iterator[str]:
    if not entries:
        return
    yield ""
    yield f"{heading}:"
    for each in entries[:SHOWN]:
        yield f"  {line(each)}"
    if len(entries) > SHOWN:
        yield f"  ... and {len(entries) - SHOWN} more (-o FILE.html, --json)"


def _machine(state: MachineState) -> str:
    batch = "" if state.batch is None else f", batch {state.batch}"
    return (
        f"{state.machine}: {_um(state.deviation_um, 1)}; {_um(state.rms_after_um, 2)}; {state.verdict}"
        f" ({state.records} records{batch})"
    )


def growth_words(line: Growth) -> str:
    """Return a line through a series in words."""
    name, unit = line.series.value_name, readable_unit(line.series.value_name.unit)
    return (
        f"{line.series.machine}: {name.words}: {line.slope:+.2f} {unit} a year ({line.low:+.2f} to {line.high:+.2f}),"
        f" now {line.at_last:.2f} {unit}"
    )


def _shared(each: SharedValue) -> str:
    unit = readable_unit(each.value_name.unit)
    return (
        f"{each.kind} {each.group}: {each.value_name.words}: {each.mean:.2f} {unit} on {each.machines} machines,"
        f" {each.mean_of_others:.2f} {unit} on {each.others} others (difference {each.low:+.2f} to {each.high:+.2f})"
    )


def _shared_cause(each: SharedCause) -> str:
    return (
        f"{each.kind} {each.group}: {each.effect}: {each.having} of {each.machines} machines,"
        f" {each.others_having} of {each.others} others"
    )


def _outlier(each: Outlier) -> str:
    series = each.line.series
    unit = readable_unit(series.value_name.unit)
    expected = "" if each.expected is None else f" (the others: {each.expected:.2f})"
    return f"{series.sources[each.place]}: {series.value_name.words}: {each.found:.2f} {unit}{expected}"


def _um(value: float | None, places: int) -> str:
    return "not known" if value is None else f"{value:.{places}f} µm"
