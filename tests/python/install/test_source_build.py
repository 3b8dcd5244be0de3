"""A build without Eigen or Ceres says in one line what to install; one that needs no Ceres goes on."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


def configured(build: Path, *words: str) -> subprocess.CompletedProcess[str]:
    line = ["cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", "-D", "HEXDBB_TESTS=OFF", *words]
    return subprocess.run(line, capture_output=True, text=True, timeout=120, check=False)


@pytest.mark.parametrize(
    ("lacking", "says"),
    [
        (["Eigen3"], ["libeigen3-dev", "libceres-dev"]),  # CMake finds Ceres through Eigen
        (["Ceres"], ["libceres-dev"]),
    ],
)
def test_what_to_install_is_said_in_one_line(lacking: list[str], says: list[str], tmp_path: Path) -> None:
    done = configured(tmp_path, *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in lacking))
    assert done.returncode != 0
    named = [line for line in done.stderr.splitlines() if "-dev" in line]
    assert len(named) == 1
    assert [each for each in ("libeigen3-dev", "libceres-dev") if each in named[0]] == says
    assert named[0].endswith("not found; install what is missing, or name its folder in CMAKE_PREFIX_PATH")


def test_controllers_do_without_ceres(tmp_path: Path) -> None:
    done = configured(tmp_path, "-D", "HEXDBB_DIAGNOSIS=OFF", "-D", "CMAKE_DISABLE_FIND_PACKAGE_Ceres=ON")
    assert done.returncode == 0, done.stderr
