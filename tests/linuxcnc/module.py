"""Build of the kinematics module: in the build folder of the C++ tests if it exists, otherwise on its own."""

from __future__ import annotations

import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "firmware_interfaces" / "linuxcnc"
PRESETS = ("ci", "release", "linuxcnc")


def built_module() -> Path:
    """Compile the module if it is out of date; return its path.

    Raises
    ------
    RuntimeError
        The build failed; carries the output of the compiler.
    """
    preset = next((each for each in PRESETS if (ROOT / "build" / each / "CMakeCache.txt").is_file()), PRESETS[-1])
    for command in (["--preset", preset], ["--build", "--preset", preset, "--target", "hexdbb_kins"]):
        done = subprocess.run(["cmake", *command], cwd=ROOT, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"cmake {' '.join(command)}:\n{done.stdout}{done.stderr}")
    return ROOT / "build" / preset / SOURCES.relative_to(ROOT) / "hexdbb_kins.so"
