"""The kinematics module, compiled: in the build folder of the C++ tests where there is one, else alone."""

from __future__ import annotations

import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "firmware_interfaces" / "linuxcnc"
PRESETS = ("ci", "release", "linuxcnc")


def built_module() -> Path:
    """Compile what is not up to date; give the module's path.

    Raises
    ------
    RuntimeError
        With the compiler's output.
    """
    preset = next((each for each in PRESETS if (ROOT / "build" / each / "CMakeCache.txt").is_file()), PRESETS[-1])
    for command in (["--preset", preset], ["--build", "--preset", preset, "--target", "hexdbb_kins"]):
        done = subprocess.run(["cmake", *command], cwd=ROOT, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"cmake {' '.join(command)}:\n{done.stdout}{done.stderr}")
    return ROOT / "build" / preset / SOURCES.relative_to(ROOT) / "hexdbb_kins.so"
