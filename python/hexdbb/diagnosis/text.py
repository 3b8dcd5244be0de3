"""A diagnosis as text: the fall of the error, values and uncertainties, what is not identifiable."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from hexdbb.diagnosis.learned_text import learned_parts
from hexdbb.model import Model
from hexdbb.model.tables import sigma_shown
from hexdbb.units import readable_unit

if TYPE_CHECKING:
    from hexdbb.diagnosis.result import Diagnosis


def diagnosis_text(found: Diagnosis) -> RenderableType:
    """Lay a diagnosis out for a terminal, lengths in micrometres."""
    return Group(*_parts(found))


def _parts(found: Diagnosis) -> Iterator[RenderableType]:
    yield (
        f"reading error {found.rms_before_um:.2f} µm -> {found.rms_after_um:.2f} µm RMS"
        f" (noise {found.noise.sigma_mm * 1e3:.2f} µm, from {_source(found)})"
    )
    if found.held_out is not None:
        yield f"held-out circles: {found.held_out.before_um:.2f} µm -> {found.held_out.after_um:.2f} µm RMS"
    yield (
        f"rank {found.rank} of {found.machine_values} errors of the machine (set-up unknowns taken out),"
        f" condition {found.condition:.0f}, {found.iterations} iterations"
    )
    yield _values_table(found.model)
    for term in found.model.learned:
        yield from learned_parts(term)
    yield "~: known only in combination with others; the value shown is the smallest that explains the readings."
    if found.unidentifiable:
        yield "\nNot identifiable from these readings:"
        yield from (f"  {sentence}" for sentence in found.unidentifiable)
    yield from (Text(f"warning: {warning}", style="yellow") for warning in found.warnings)
    place = found.place
    yield (
        f"position of the ball over the workspace: standard uncertainty {place.median_um:.2f} µm (median),"
        f" {place.worst_um:.2f} µm (worst), a rigid shift of the base aside"
    )


def _values_table(model: Model) -> Table:
    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in ("effect", "element", "parameter"):
        table.add_column(name)
    for name in ("value", "± 1 sigma"):
        table.add_column(name, justify="right")
    table.add_column("unit")
    columns = model.columns()
    # A shape is in its own unit: a width in rad/s may be thousandths.
    places = [".2f" if each.shape is None else ".4g" for each in model.parameters()]
    last = ""
    coefficient = np.array([each.is_coefficient for each in model.parameters()], dtype=bool)
    for row in np.flatnonzero((columns["free"] | (model.values != model.start)) & ~coefficient):
        effect = str(columns["effect"][row])
        table.add_row(
            "" if effect == last else effect,
            columns["element"][row],
            columns["name"][row],
            f"{columns['value'][row]:{places[row]}}",
            sigma_shown(columns, row, places[row]),
            readable_unit(columns["unit"][row]),
        )
        last = effect
    return table


def _source(found: Diagnosis) -> str:
    return {"stated": "the gauge specification", "roughness": "the readings' roughness"}.get(
        found.noise.source, found.noise.source
    )
