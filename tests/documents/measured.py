"""Measurements of the simulated rig, each made once for all pages.

In lockstep the same plan, rate, truth and compensation give the same record, whatever it is called: what has been
measured for one page is copied for the next, with what the command printed.
"""

from __future__ import annotations

import shlex
import shutil
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path

Run = Callable[[str, Path], str]
OWN_RIG = "--bus"
"""A command with this option measures on a rig that the page started itself, and is run as it stands."""


class Measurements:
    """Records made so far, in a folder of the session."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def run(self, command: str, folder: Path, run: Run) -> str:
        """Run a command in a folder, or copy what the same measurement gave before; return what it prints."""
        words = shlex.split(command, comments=True)
        if words[0] != "hexdbb-run" or "-o" not in words or OWN_RIG in words:
            return run(command, folder)
        name = words[words.index("-o") + 1]
        kept = self._folder / _key(words, name, folder)
        if not kept.exists():
            printed = run(command, folder)
            kept.mkdir()
            shutil.copyfile(folder / name, kept / "record")
            (kept / "printed").write_text(printed.replace(name, "{record}"), encoding="utf-8")
            return printed
        shutil.copyfile(kept / "record", folder / name)
        return (kept / "printed").read_text(encoding="utf-8").replace("{record}", name)


def _key(words: list[str], name: str, folder: Path) -> str:
    """Return a hash of a command without the record's name, with the contents of files in place of their names."""
    parts = [(folder / word).read_bytes() if (folder / word).is_file() else word.encode() for word in words]
    del parts[words.index(name)]
    return sha256(b"\0".join(parts)).hexdigest()
