"""Writes the type stubs of the compiled module `hexdbb._core` from the module itself: `make_stubs.py OUT.pyi`.

pybind11-stubgen reads the signatures, ruff brings them into the house format. Only to be changed by running it again;
`tests/python/test_stubs.py` compares the committed file with a new one.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
HEADER = "# Made by `make stubs` from the compiled module; not to be edited.\n"


def generate() -> str:
    """Text of the stubs of `hexdbb._core`, formatted.

    Raises
    ------
    subprocess.CalledProcessError
        Where the module has a signature that pybind11-stubgen cannot express, or ruff refuses its output.
    """
    with tempfile.TemporaryDirectory() as folder:
        stubgen = [sys.executable, "-m", "pybind11_stubgen", "hexdbb._core", "--exit-code", "--output-dir", folder]
        subprocess.run(stubgen, check=True, stdout=sys.stderr)
        made = (Path(folder) / "hexdbb" / "_core.pyi").read_text(encoding="utf-8")
    text = HEADER + made
    for command in (["check", "--select", "I,UP", "--fix", "--quiet"], ["format", "--quiet"]):
        ruff = [sys.executable, "-m", "ruff", *command, "--config", str(ROOT / "pyproject.toml")]
        ruff += ["--stdin-filename", "_core.pyi", "-"]
        text = subprocess.run(ruff, input=text, text=True, check=True, stdout=subprocess.PIPE).stdout
    return text


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(generate(), encoding="utf-8")
