"""Records that a command fits: read, and examined for samples that no machine can have given."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from hexdbb.cli.import_options import pointing_to_convert, wanted_mapping
from hexdbb.importing import read_measured
from hexdbb.record import Record, doubts
from hexdbb.samples import Samples, shared_words


def read_records(paths: Sequence[Path], messages: Console) -> list[Record]:
    """Read records, or files of other programs as the command's options say; print what was detected, a line a file."""
    wanted = wanted_mapping()

    def tell(line: str) -> None:
        messages.print(line, markup=False, highlight=False, soft_wrap=True)

    records = []
    for path in paths:
        with pointing_to_convert(path):
            records.append(read_measured(path, wanted, tell))
    for line in _of_set_ups(records):
        tell(line)
    return records


def _of_set_ups(records: Sequence[Record]) -> list[str]:
    """Return what counts as one set-up, a line each; nothing where nobody would ask."""
    said = shared_words(records)
    apart = [record for record in records if "imported" in record.metadata and record.mounts[0].fixing is None]
    if len(records) > 1 and apart:
        which = "each" if len(apart) == len(records) else ", ".join(record.name for record in apart)
        unless = "--mount NAME: the cup was not touched between them"
        said.append(f"{len(records)} files, {which} with a set-up of its own ({unless})")
    return said


def read_samples(paths: Sequence[Path], messages: Console) -> Samples:
    """Read records and make their table; warn of implausible samples, which are fitted none the less."""
    records = read_records(paths, messages)
    for record in records:
        for doubt in doubts(record):
            messages.print(f"warning: {record.name}: {doubt}", markup=False, highlight=False, soft_wrap=True)
    return Samples.of(records)
