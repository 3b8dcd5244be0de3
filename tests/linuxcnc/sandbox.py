"""LinuxCNC in separate namespaces: as an ordinary user, beside any other LinuxCNC, ended at a time limit.

LinuxCNC refuses root, loads modules from one folder of the system only, and keeps its state in System V shared memory,
in `/tmp` and in processes that outlive their parent. `unshare` (util-linux) creates a mount, an IPC and a PID
namespace: the folder of modules is a copy with ours added, `/tmp` holds the work folder only, and when `unshare` ends
or is killed the kernel ends every process inside.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from functools import cache
from pathlib import Path

MODULES = Path("/usr/lib/linuxcnc/modules")
HEADER = Path("/usr/include/linuxcnc/kinematics.h")
INSIDE = "/tmp/session"
"""Path of the work folder inside the namespace."""

NOBODY = "65534"
ENTER = f"""
set -e
mount --bind "$1" /mnt
mount -t tmpfs -o mode=1777 tmpfs /tmp
mkdir {INSIDE}
mount --bind /mnt {INSIDE}
mount --bind {INSIDE}/modules {MODULES}
cd {INSIDE}
shift
exec "$@"
"""
ENVIRONMENT = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": INSIDE, "LANG": "C.UTF-8", "USER": "nobody"}


def is_installed() -> bool:
    """Return whether LinuxCNC and its headers are installed."""
    return shutil.which("linuxcnc") is not None and HEADER.exists()


@cache
def why_not() -> str | None:
    """Return the reason why LinuxCNC cannot run here; None if it can."""
    if not is_installed():
        return "LinuxCNC is not installed (Debian: linuxcnc-uspace, linuxcnc-uspace-dev)"
    mount = ["mount", "-t", "tmpfs", "tmpfs", "/tmp"]
    probe = subprocess.run([*_unshare(), *mount], capture_output=True, text=True, timeout=60)
    if probe.returncode != 0:
        return f"no namespaces for LinuxCNC: {probe.stderr.strip()} (expected root, or unprivileged user namespaces)"
    return None


def prepare(work: Path, module: Path) -> None:
    """Create the folder of realtime modules for LinuxCNC: those of the distribution, and `module`."""
    shutil.copytree(MODULES, work / "modules")
    shutil.copy2(module, work / "modules")


def run(work: Path, *command: str, timeout_s: float) -> subprocess.CompletedProcess[str]:
    """Run a command in the work folder as an ordinary user, with a time limit.

    Raises
    ------
    subprocess.TimeoutExpired
        The time limit was reached; everything that the command started has ended.
    """
    # An ordinary user becomes root in the namespace, to mount; a second namespace inside restores the ordinary user.
    as_user = ["unshare", "--user", f"--map-user={NOBODY}", f"--map-group={NOBODY}"]
    if os.geteuid() == 0:
        as_user = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"]
        for each in (work, *work.rglob("*")):
            os.chown(each, int(NOBODY), int(NOBODY))
    inside = ["sh", "-c", ENTER, "sh", str(work), *as_user, *command]
    return subprocess.run(
        [*_unshare(), *inside],
        env=ENVIRONMENT,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=timeout_s,
    )


def _unshare() -> list[str]:
    unshare = ["unshare", "--mount", "--ipc", "--pid", "--fork", "--kill-child", "--mount-proc"]
    return unshare if os.geteuid() == 0 else [*unshare, "--user", "--map-root-user"]
