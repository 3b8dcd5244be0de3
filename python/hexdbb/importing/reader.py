"""One function that reads readings of any file: records, the text form, tables of other programs, Renishaw tests."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from hexdbb.errors import InputError
from hexdbb.files.validation import read_text
from hexdbb.importing.b5r import read_b5r
from hexdbb.importing.excel import read_sheet_grid
from hexdbb.importing.mapping import SCHEMA, Mapping, load_mapping, mapping_of
from hexdbb.importing.series import Series
from hexdbb.importing.setting import Setting, setting_of
from hexdbb.importing.sweeps import samples_of
from hexdbb.importing.tabular import series_of
from hexdbb.importing.text import read_text_grid
from hexdbb.record import Record
from hexdbb.record import read_record as read_own_record
from hexdbb.record.checks import check_record
from hexdbb.record.columns import RowSource
from hexdbb.record.formats import FORMATS
from hexdbb.record.not_measured import not_measured_metadata
from hexdbb.record.workbook import is_record_workbook

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
"""Readers of files of other programs, by suffix."""


def read_measured(path: Path | str, mapping: Mapping | None = None, tell: Tell = lambda _: None) -> Record:
    """Read and check a record, or readings of another program.

    Parameters
    ----------
    path : Path or str
        A record (.parquet, or .xlsx as `hexdbb convert` writes it), the CSV of a text form (a measurement file of the
        same name beside it), or a file of another program: delimited text, an Excel sheet, a Renishaw test.
    mapping : Mapping, optional
        How to read a file of another program. Keys that it lacks are those of the mapping file `NAME.toml` beside the
        file, where there is one.
    tell : callable
        Is told in one line what was detected in a file of another program.

    Raises
    ------
    InputError
        One line naming the file, row, column or key, the value and what was expected.
    """
    path = Path(path)
    wanted = mapping or Mapping()
    if _is_own(path):
        return read_own_record(path)
    if path.suffix.lower() not in READERS:
        known = ", ".join(dict.fromkeys((*FORMATS, *READERS)))
        raise InputError(f"{path}: suffix {path.suffix!r} (expected one of {known})")
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    return _imported(path, wanted.over(_beside(path)), tell)


def read_record(path: Path | str, mapping: Path | str | None = None, **choices: Any) -> Record:
    """Read and check a record, or readings of another program.

    Parameters
    ----------
    path : Path or str
        As of ``hexdbb convert``: .parquet, .csv, .txt, .xlsx, .b5r and others.
    mapping : Path or str, optional
        Mapping file.
    **choices
        Keys of a mapping file, which replace those of the file: ``plan="thesis"``, ``circle=0``,
        ``columns={"reading": "Abweichung"}``, ``units={"reading": "mm"}``.

    Returns
    -------
    Record

    Raises
    ------
    InputError
        One line naming the file, the row and column or key, the value and what was expected.
    """
    wanted = mapping_of("read_record", **choices)
    return read_measured(path, wanted if mapping is None else wanted.over(load_mapping(mapping)))


def _is_own(path: Path) -> bool:
    """Return whether a file is a record that says itself what it is."""
    if path.suffix == ".csv":
        return _schema_beside(path) not in (None, SCHEMA)
    if path.suffix == ".xlsx":
        return path.is_file() and is_record_workbook(path)
    return path.suffix in FORMATS or path.suffix == ".journal"


def _schema_beside(path: Path) -> str | None:
    """Return the schema of the TOML file beside a file; empty for one that states none, None where there is none."""
    beside = path.with_suffix(".toml")
    if not beside.is_file():
        return None
    try:
        return str(tomllib.loads(read_text(beside)).get("schema", ""))
    except (ValueError, RecursionError):  # its own reader says what is wrong with it
        return ""


def _beside(path: Path) -> Mapping:
    return load_mapping(path.with_suffix(".toml")) if _schema_beside(path) == SCHEMA else Mapping()


def _imported(path: Path, mapping: Mapping, tell: Tell) -> Record:
    setting = setting_of(mapping, str(path))
    series = READERS[path.suffix.lower()](path, setting)
    columns, computed, lines = samples_of(series, setting)
    circles = tuple(each for each in setting.plan.circles if each.id in set(np.unique(columns["circle"])))
    mounts = tuple(each for each in setting.plan.mounts if each.id in {circle.mount for circle in circles})
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
    runs = [columns["direction"][rows[0]] for rows in _sweeps(columns["sweep"])]
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


def _sweeps(sweep: Any) -> list[Any]:
    return [np.flatnonzero(sweep == each) for each in np.unique(sweep)]
