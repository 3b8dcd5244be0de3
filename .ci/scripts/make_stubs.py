"""Write the type stubs of the compiled module `hexdbb._core`: `make_stubs.py OUT.pyi`.

pybind11-stubgen reads the signatures from the module and ruff formats them. The committed file is not edited by hand;
`tests/python/test_stubs.py` compares it with a new one.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
HEADER = "# Made by `make stubs` from the compiled module; not to be edited.\n"


def generate() -> str:
    """Return the formatted stubs of `hexdbb._core`.

    Raises
    ------
    subprocess.CalledProcessError
        The module has a signature that pybind11-stubgen cannot express, or ruff refuses its output.
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
