"""Records of circular tests: in memory, as Parquet, in text form (CSV and TOML), as journal of a running capture."""

from hexdbb.record.columns import REQUIRED_COLUMNS, SLIDER_COLUMNS, TARGET_COLUMNS
from hexdbb.record.conditions import conditions_metadata
from hexdbb.record.formats import read_record, write_record
from hexdbb.record.journal import Journal, journal_path
from hexdbb.record.not_measured import NotMeasured
from hexdbb.record.plausibility import Doubt, doubts
from hexdbb.record.record import Record, require_dimensions
from hexdbb.record.recovery import recover
from hexdbb.record.sweep_rows import rows_of_sweeps

__all__ = [
    "REQUIRED_COLUMNS",
    "SLIDER_COLUMNS",
    "TARGET_COLUMNS",
    "Doubt",
    "Journal",
    "NotMeasured",
    "Record",
    "conditions_metadata",
    "doubts",
    "journal_path",
    "read_record",
    "recover",
    "require_dimensions",
    "rows_of_sweeps",
    "write_record",
]
