"""Records that a command fits: read, and examined for samples that no machine can have given."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from hexdbb.record import doubts, read_record
from hexdbb.samples import Samples


def read_samples(paths: Sequence[Path], messages: Console) -> Samples:
    """Read records and make their table; warn of implausible samples, which are fitted none the less."""
    records = [read_record(path) for path in paths]
    for record in records:
        for doubt in doubts(record):
            messages.print(f"warning: {record.name}: {doubt}", markup=False, highlight=False, soft_wrap=True)
    return Samples.of(records)
