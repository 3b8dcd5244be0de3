"""Examples run as they stand, and the README shows two of them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from hexdbb.model import load_model
from hexdbb.record import read_record, write_record
from hexdbb_truth.cases import case

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "python" / "examples"
README = (ROOT / "README.md").read_text(encoding="utf-8")


def run(folder: Path, example: str, *arguments: str) -> str:
    """Run an example in a folder of its own; give what it prints."""
    command = [sys.executable, "-W", "error", str(EXAMPLES / example), *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=300)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Return the folder of the first example's files, and what it printed."""
    folder = tmp_path_factory.mktemp("example")
    return folder, run(folder, "01_circular_test.py")


def test_every_example_is_run_here() -> None:
    assert {path.name for path in EXAMPLES.iterdir() if path.suffix == ".py"} == {
        "01_circular_test.py",
        "02_own_record.py",
        "03_discover.py",
    }


def test_readme_shows_examples_word_for_word() -> None:
    shown = re.findall(r"^```python\n(.*?)^```$", README, flags=re.MULTILINE | re.DOTALL)
    named = ("01_circular_test.py", "03_discover.py")
    assert shown == [(EXAMPLES / name).read_text(encoding="utf-8") for name in named]


def test_circular_test_prints_what_the_commands_print(measured: tuple[Path, str]) -> None:
    folder, printed = measured
    assert printed.startswith("reading error 159.86 µm -> 0.50 µm RMS (noise 0.50 µm")
    assert "rank 9 of 33 errors of the machine" in printed
    assert "Residual (measured - predicted): 0.50 µm RMS" in printed
    record = read_record(folder / "demo.parquet")
    assert record.complete
    assert load_model(folder / "demo-model.toml").machine == record.machine


def test_own_record_in_text_form(measured: tuple[Path, str], tmp_path: Path) -> None:
    write_record(read_record(measured[0] / "demo.parquet"), tmp_path / "own.csv")
    printed = run(tmp_path, "02_own_record.py", "own.csv").splitlines()
    assert printed[0].startswith("own.csv: 25002 samples")
    assert re.fullmatch(r"reading error 159\.\d\d µm -> 0\.5\d µm", printed[1])
    assert len(printed) > 2, "one level circle cannot tell everything: sentences must say so"


def test_discover_names_a_hidden_fault_adds_it_and_finds_nothing_more(tmp_path: Path) -> None:
    write_record(case("backlash-x3-s1").record(), tmp_path / "hidden.parquet")
    missing, nothing, *steps = run(tmp_path, "03_discover.py", "hidden.parquet").splitlines()
    assert re.match(r"Slider [1-6] has \d+\.\d+ ± 0\.\d+ µm of play between drive and carriage; it explains", missing)
    assert nothing.startswith(("nothing is missing: what is left is noise", "nothing that matters is missing"))
    assert [step.split(":")[0] for step in steps] == ["step 1", "step 2"]
