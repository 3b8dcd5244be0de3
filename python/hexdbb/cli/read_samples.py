"""Records that a command fits: read, and examined for samples that no machine can have given."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from hexdbb.cli.import_options import wanted_mapping
from hexdbb.importing import read_measured
from hexdbb.record import Record, doubts
from hexdbb.samples import Samples


def read_records(paths: Sequence[Path], messages: Console) -> list[Record]:
    """Read records, or files of other programs as the command's options say; print what was detected, a line a file."""
    wanted = wanted_mapping()

    def tell(line: str) -> None:
        messages.print(line, markup=False, highlight=False, soft_wrap=True)

    return [read_measured(path, wanted, tell) for path in paths]


def read_samples(paths: Sequence[Path], messages: Console) -> Samples:
    """Read records and make their table; warn of implausible samples, which are fitted none the less."""
    records = read_records(paths, messages)
    for record in records:
        for doubt in doubts(record):
            messages.print(f"warning: {record.name}: {doubt}", markup=False, highlight=False, soft_wrap=True)
    return Samples.of(records)
