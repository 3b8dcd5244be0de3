"""One run of LinuxCNC: the sample configuration, a program, and the joints of every servo period.

The configuration is that of `firmware_interfaces/linuxcnc` except for the user interface, the program and a sampler.
Units: mm, deg, ns, as in the column names.
"""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tests.linuxcnc.module import SOURCES
from tests.linuxcnc.sandbox import INSIDE, prepare, run

OPERATOR = Path(__file__).with_name("operator_script.py")
TIMEOUT_S = 400.0
PERIOD_S = 0.001

PINS = {
    **{f"slider_{k + 1}_mm": (f"joint.{k}.pos-cmd", "f") for k in range(6)},
    **{f"pose_{name}": (f"axis.{name}.pos-cmd", "f") for name in "xyzabc"},
    "tag": ("motion.analog-out-00", "f"),
    "active_part": ("hexdbb-kins.active-part", "f"),
    "largest_correction_mm": ("hexdbb-kins.largest-correction", "f"),
    "refused": ("hexdbb-kins.refused", "u"),
    "inverse_ns": ("hexdbb-kins.time", "s"),
    "iterations": ("hexdbb-kins.iterations", "s"),
}
"""Sampled quantities: column, pin and type. Joints in absolute slider coordinates, not relative to the start."""


@dataclass(frozen=True)
class Session:
    """Result of a LinuxCNC session.

    Attributes
    ----------
    columns : dict
        Sampled values by the names of `PINS`, shape (n,), one per servo period without gaps.
    commanded, actual : (6,) arrays
        Pose at the end, mm and degrees: of the program, and of the forward kinematics of the module.
    log : str
        Output of LinuxCNC and its modules.
    """

    columns: dict[str, NDArray[np.float64]]
    commanded: NDArray[np.float64]
    actual: NDArray[np.float64]
    log: str

    @property
    def sliders_mm(self) -> NDArray[np.float64]:
        """Joint commands, shape (n, 6)."""
        return np.column_stack([self.columns[f"slider_{k}_mm"] for k in range(1, 7)])


def run_linuxcnc(work: Path, module: Path, compensation: Path, program: str, left_out: str | None = None) -> Session:
    """Run a program in a work folder that does not exist yet.

    Parameters
    ----------
    work, module, compensation : Path
    program : str
        G-code.
    left_out : str, optional
        Lines of the sample HAL file that contain this text are left out.

    Raises
    ------
    RuntimeError
        LinuxCNC ended before the program, or the sampler lost servo periods; carries the output.
    """
    shutil.copytree(SOURCES, work, ignore=shutil.ignore_patterns("*.c", "*.h", "*.md", "CMakeLists.txt"))
    prepare(work, module)
    shutil.copyfile(compensation, work / "sp120.hexcomp")
    shutil.copy2(OPERATOR, work)
    (work / OPERATOR.name).chmod(0o755)
    (work / "program.ngc").write_text(program)
    (work / "record.hal").write_text(_record_hal())
    hal = (work / "hexglider.hal").read_text().splitlines(keepends=True)
    (work / "hexglider.hal").write_text("".join(line for line in hal if left_out is None or left_out not in line))
    (work / "hexglider.ini").write_text(_ini((work / "hexglider.ini").read_text()))
    done = run(work, "linuxcnc", f"{INSIDE}/hexglider.ini", timeout_s=TIMEOUT_S)
    outcome, debug = work / "operator.json", work / "linuxcnc_debug.txt"
    log = f"{done.stdout}{done.stderr}{debug.read_text() if debug.is_file() else ''}"
    if not outcome.is_file():
        raise RuntimeError(f"LinuxCNC ended with {done.returncode} before the program did:\n{log}")
    poses = json.loads(outcome.read_text())
    return Session(read_samples(work / "samples.txt"), np.array(poses["commanded"]), np.array(poses["actual"]), log)


def read_samples(samples: Path) -> dict[str, NDArray[np.float64]]:
    """Parse the output of halsampler; return the columns of `PINS`.

    Raises
    ------
    RuntimeError
        The sampler lost servo periods.
    """
    text = samples.read_text()
    if "overrun" in text:
        raise RuntimeError("the sampler lost servo periods (overrun)")
    # LinuxCNC may end while the last line is being written.
    lines = text[: text.rindex("\n")].splitlines()
    try:
        table = np.loadtxt(lines)
    except ValueError as error:
        raise RuntimeError(f"the sampler lost servo periods (a line that is not whole): {error}") from None
    if np.any(np.diff(table[:, 0]) != 1):
        raise RuntimeError("the sampler lost servo periods (numbers with gaps)")
    return dict(zip(PINS, table[:, 1:].T, strict=True))


def _ini(sample: str) -> str:
    """Return the sample configuration with the user interface, the program and the sampler added."""
    replaced = {
        "DISPLAY = axis\n": f"DISPLAY = {INSIDE}/{OPERATOR.name}\nOPEN_FILE = {INSIDE}/program.ngc\n",
        "HALFILE = hexglider.hal\n": "HALFILE = hexglider.hal\nHALFILE = record.hal\n",
    }
    for line, instead in replaced.items():
        if sample.count(line) != 1:
            raise RuntimeError(f"hexglider.ini: {sample.count(line)} lines {line.strip()!r} (expected one)")
        sample = sample.replace(line, instead)
    return sample


def _record_hal() -> str:
    types = "".join(kind for _, kind in PINS.values())
    lines = [f"loadrt sampler depth=20000 cfg={types}", "addf sampler.0 servo-thread"]
    lines += [f"net sampled-{k} {pin} => sampler.0.pin.{k}" for k, (pin, _) in enumerate(PINS.values())]
    return "\n".join([*lines, f"loadusr halsampler -t {INSIDE}/samples.txt", ""])
