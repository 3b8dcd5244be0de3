"""EDS files as vendors and accidents change them: from a good one, by a seed."""

from __future__ import annotations

import random
import re
from pathlib import Path

from hexdbb.machine import shipped

DRIVE, GAUGE = shipped("eds", "hexglider_drive.eds"), shipped("eds", "ballbar_gauge.eds")
VALUES = ["", "0x", "abc", "-1", "0xFFFFFFFFFF", "1e400", "nan", "$NODEID", "$NODEID+x", "\0", "%s", "0x07 # VAR", "ö"]
VALUES += ["=", "[", "]", "0", "1", "0x20", "0x1B", "rw", "ro", "const", "wo", "08", "9" * 5000]


def without(path: Path, *objects: str) -> str:
    """Return the text of an EDS without some objects, each with all its sub-indices, or one of them: ``1600sub2``."""
    text = path.read_text(encoding="ascii")
    for name in objects:
        text = re.sub(rf"\[{name}(sub\w+)?\]\n(?:[^\[\n].*\n|\n)*", "", text)
        text = re.sub(rf"(?m)^\d+=0x{name}\n", "", text)
    return text


def with_key(path: Path, section: str, key: str, value: str) -> str:
    """Return the text of an EDS with another value of a key, appended where the section has none."""
    head, start, rest = path.read_text(encoding="ascii").partition(f"[{section}]\n")
    body, separator, tail = rest.partition("\n[")
    lines = [line for line in body.split("\n") if line and not line.startswith(f"{key}=")]
    return head + start + "\n".join([*lines, f"{key}={value}", ""]) + separator + tail


def mutated(path: Path, seed: int) -> bytes:
    """Return the contents of an EDS with up to six random changes."""
    rng = random.Random(seed)
    lines = path.read_text(encoding="ascii").split("\n")
    for _ in range(rng.randint(1, 6)):
        k = rng.randrange(len(lines))
        key = lines[k].partition("=")[0]
        changed = [
            [],
            [lines[k], rng.choice(lines)],
            [f"{key}={rng.choice(VALUES)}"],
            [lines[k][: rng.randrange(len(lines[k]) + 1)]],
            ["".join(chr(rng.randrange(1, 255)) for _ in range(10))],
            [f"{key}={rng.randrange(2 ** rng.choice([4, 8, 16, 32, 33])):#x}"],
        ]
        lines[k : k + 1] = rng.choice(changed)
        lines = lines[: rng.randrange(k, len(lines)) + 1] if rng.random() < 0.05 else lines
        lines = lines or [""]
    return "\n".join(lines).encode("latin-1", "replace")
