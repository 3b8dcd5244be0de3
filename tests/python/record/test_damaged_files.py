"""Whatever damage a file has taken, it is read, or refused in one line: no other exception."""

from __future__ import annotations

import random
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from hexdbb.errors import InputError
from hexdbb.machine import load_machine, shipped
from hexdbb.plan import load_plan
from hexdbb.record import Record, read_record, write_record

ROUNDS = 150
PIECES = [b"nan", b"-", b"1e999", b'"', b"\n", b",", b"{", b"[", b"\x00", b"true", b"9" * 20, b"\xff", b" "]


def damaged(content: bytes, rng: random.Random) -> bytes:
    """Overwrite, cut, repeat or insert at one to three places."""
    data = bytearray(content)
    for _ in range(rng.randint(1, 3)):
        at, other = rng.randrange(len(data)), rng.randrange(len(data))
        change = rng.randrange(4)
        if change == 0:
            data[at] = rng.randrange(256)
        elif change == 1:
            del data[at : at + rng.randint(1, 40)]
        elif change == 2:
            data[at:at] = data[other : other + rng.randint(1, 60)]
        else:
            data[at : at + 1] = rng.choice(PIECES)
    return bytes(data)


READERS: dict[str, Callable[[Path], object]] = {
    "machine.toml": load_machine,
    "plan.toml": load_plan,
    "a.csv": read_record,
    "a.toml": lambda path: read_record(path.with_name("a.csv")),
    "a.parquet": read_record,
}


@pytest.mark.parametrize("name", READERS)
def test_damaged_file_is_read_or_refused_in_one_line(record: Record, tmp_path: Path, name: str) -> None:
    shutil.copy(shipped("sp120.toml"), tmp_path / "machine.toml")
    shutil.copy(shipped("plans", "thesis.toml"), tmp_path / "plan.toml")
    write_record(record, tmp_path / "a.csv")
    write_record(record, tmp_path / "a.parquet")
    path, rng, refused = tmp_path / name, random.Random(name), 0
    content = path.read_bytes()
    for _ in range(ROUNDS):
        path.write_bytes(damaged(content, rng))
        try:
            READERS[name](path)
        except InputError as error:
            refused += 1
            assert "\n" not in str(error)
            assert str(error).startswith(str(tmp_path))
    assert refused > ROUNDS / 2
