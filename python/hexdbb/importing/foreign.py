"""Files of other programs as records: delimited text, Excel sheets, Renishaw tests."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from hexdbb.importing.b5r import read_b5r
from hexdbb.importing.excel import read_sheet_grid
from hexdbb.importing.mapping import Mapping
from hexdbb.importing.series import Series
from hexdbb.importing.setting import Setting, setting_of
from hexdbb.importing.sweeps import samples_of
from hexdbb.importing.tabular import series_of
from hexdbb.importing.text import read_text_grid
from hexdbb.record import Record
from hexdbb.record.checks import check_record
from hexdbb.record.columns import RowSource
from hexdbb.record.not_measured import not_measured_metadata
from hexdbb.record.sweep_rows import rows_of_sweeps

Reader = Callable[[Path, Setting], Series]
Tell = Callable[[str], None]


def _text(path: Path, setting: Setting) -> Series:
    return series_of(read_text_grid(path, setting.mapping), setting)


def _excel(path: Path, setting: Setting) -> Series:
    return series_of(read_sheet_grid(path, setting.mapping), setting)


READERS: dict[str, Reader] = {
    **dict.fromkeys((".csv", ".txt", ".tsv", ".dat", ".asc"), _text),
    **dict.fromkeys((".xlsx", ".xlsm"), _excel),
    **dict.fromkeys((".b5r", ".xml"), read_b5r),
}
"""Readers by suffix."""


def imported(path: Path, mapping: Mapping, tell: Tell) -> Record:
    """Read and check a file whose suffix is among `READERS`; `tell` is told what was detected."""
    setting = setting_of(mapping, str(path))
    series = READERS[path.suffix.lower()](path, setting)
    columns, computed, lines = samples_of(series, setting)
    circles = tuple(each for each in setting.plan.circles if each.id in set(np.unique(columns["circle"])))
    mounts = tuple(each for each in setting.plan.mounts if each.id in {circle.mount for circle in circles})
    if mapping.mount is not None:
        mounts = tuple(each.model_copy(update={"fixing": mapping.mount}) for each in mounts)
    how = _words(series, columns, setting, computed.model_dump(exclude_none=True))
    record = Record(
        columns=columns,
        gauge=setting.plan.gauge,
        mounts=mounts,
        circles=circles,
        machine=setting.machine,
        metadata={
            "plan": setting.plan_name,
            "imported": {"file": path.name, "how": how},
            **series.metadata,
            **not_measured_metadata(computed),
        },
        path=path,
    )
    check_record(record, RowSource(str(path), lambda row: int(lines[row])))
    tell(f"{path}: {how}")
    return record


def _words(series: Series, columns: dict[str, Any], setting: Setting, computed: dict[str, str]) -> str:
    """Return in one line what was found and what was made of it."""
    runs = [columns["direction"][rows[0]] for rows in rows_of_sweeps(columns["sweep"])]
    words = " + ".join(f"{count} {name}" for sign, name in ((1, "ccw"), (-1, "cw")) if (count := runs.count(sign)))
    source = "" if series.direction is not None else ", told by the angle's sense"
    circles = ", ".join(f"{each:g}" for each in np.unique(columns["circle"]))
    feeds = ", ".join(f"{each:g}" for each in np.unique(columns["feed_mm_min"]))
    parts = [*series.notes, f"{words} runs{source}", f"circle {circles} of {setting.plan_name} at {feeds} mm/min"]
    if "sliders" in computed:
        parts.append("sliders computed: nominal inverse kinematics")
    if "time" in computed:
        parts.append(f"times computed: {computed['time']}")
    return "; ".join(parts)
