"""The module alone in HAL's own shell, `halrun`: which parameters load, which are refused with which message."""

from __future__ import annotations

import subprocess
from pathlib import Path

from tests.linuxcnc.sandbox import prepare, run

TIMEOUT_S = 60.0


def halrun(work: Path, module: Path, commands: str) -> subprocess.CompletedProcess[str]:
    """Run HAL commands in a work folder, which is created if it does not exist."""
    work.mkdir(exist_ok=True)
    prepare(work, module)
    (work / "commands.hal").write_text(commands)
    return run(work, "halrun", "commands.hal", timeout_s=TIMEOUT_S)
