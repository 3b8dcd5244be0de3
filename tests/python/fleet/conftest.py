"""A fleet of nine machines, judged once for all tests of a session: six records each, and files that are none."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest
from tests.fleet.made import Fleet, write_model
from tests.programs import called

from hexdbb.record import read_record, write_record

FLEET = Fleet(machines=9, records=54)
CUT, NO_MACHINE, COPY, SAME = "m001/cut.parquet", "m002/loose.csv", "m003/copy.parquet", "m004/again.csv"
"""Files beside the records: cut short, without its machine file, a copy, the same readings in another form."""


@dataclass(frozen=True)
class Judged:
    folder: Path
    run: subprocess.CompletedProcess[str]

    @property
    def records(self) -> Path:
        return self.folder / "records"

    @property
    def results(self) -> Path:
        return self.folder / "results"

    @property
    def model(self) -> Path:
        return self.folder / "model.toml"


@pytest.fixture(scope="session")
def judged(tmp_path_factory: pytest.TempPathFactory) -> Judged:
    folder = tmp_path_factory.mktemp("fleet")
    records = folder / "records"
    for number in range(FLEET.records):
        FLEET.write(records, number)
    whole = (records / "m001/00001.parquet").read_bytes()
    (records / CUT).write_bytes(whole[: len(whole) // 2])
    write_record(FLEET.record(17), records / NO_MACHINE)
    (records / NO_MACHINE).with_suffix(".machine.toml").unlink()
    shutil.copy(records / "m003/00000.parquet", records / COPY)
    write_record(read_record(records / "m004/00003.parquet"), records / SAME)
    model = write_model(folder / "model.toml")
    run = called("hexdbb", "fleet", "diagnose", records, "-o", folder / "results", "-m", model, "--workers", 2)
    return Judged(folder, run)
