"""The committed stubs of the engine module are those of the compiled module."""

from __future__ import annotations

import difflib
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
COMMITTED = ROOT / "python" / "hexdbb" / "_core.pyi"


def test_committed_stubs_are_those_of_the_compiled_module(tmp_path: Path) -> None:
    made = tmp_path / "_core.pyi"
    subprocess.run([sys.executable, ROOT / ".ci" / "scripts" / "make_stubs.py", made], check=True, timeout=120)
    old, new = (path.read_text(encoding="utf-8").splitlines() for path in (COMMITTED, made))
    drift = "\n".join(difflib.unified_diff(old, new, "committed", "compiled module", lineterm=""))
    assert not drift, f"run `make stubs`:\n{drift}"
