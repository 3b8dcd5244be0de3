"""A CANopen stack that is not ours, as seven nodes on the bus of a rig whose own nodes are absent."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROGRAM = Path(__file__).with_name("nodes.js")
MODULES = ROOT / "build" / "foreign" / "node_modules"
"""Where `make foreign` installs the stack."""
EDS = dict.fromkeys(range(1, 7), ROOT / "firmware_interfaces" / "hexglider_drive.eds")
EDS[7] = ROOT / "firmware_interfaces" / "ballbar_gauge.eds"


def why_not() -> str | None:
    """Return why the stack cannot run here, or None."""
    if shutil.which("node") is None:
        return "node is not installed"
    return None if (MODULES / "canopen").is_dir() else "the npm package canopen is not installed (make foreign)"


@contextmanager
def foreign_nodes(port: int, start_counts: Sequence[int], folder: Path) -> Iterator[subprocess.Popen[str]]:
    """Run the nodes on a bus until the context ends; `folder` takes their EDS files and what they print."""
    for node, eds in EDS.items():
        text = eds.read_text(encoding="ascii")
        # The stack does not know $NODEID.
        text = re.sub(r"\$NODEID\+(0x[0-9A-Fa-f]+)", lambda found, node=node: f"{int(found[1], 16) + node:#x}", text)
        (folder / f"node{node}.eds").write_text(text, encoding="ascii")
    line = ["node", str(PROGRAM), str(port), str(folder), *map(str, start_counts)]
    environment = {**os.environ, "NODE_PATH": str(MODULES)}
    process = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment)
    assert process.stdout is not None
    try:
        said = process.stdout.readline()
        assert said == "started\n", said + process.stdout.read()
        yield process
    finally:
        process.terminate()
        said, _ = process.communicate(timeout=10)
        (folder / "nodes.log").write_text(said)
