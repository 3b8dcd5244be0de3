"""`hexdbb-run --compensation FILE`: the request with targets of the machine as diagnosed.

Nothing falls back by itself: a file that is refused ends the command before anything moves.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import replace
from pathlib import Path

from hexdbb import _core
from hexdbb.capture.request import Progress, Request
from hexdbb.compensation import CompensatedTargets, read_compensation


def compensated(request: Request, path: Path, temperature_c: float | None, progress: Progress) -> Request:
    """Give a request whose targets are those of a compensation file, and whose record says so.

    Raises
    ------
    InputError
        The file cannot be read, or is truncated, altered, of a later version, of another machine, or has an unknown
        effect.
    """
    data = read_compensation(path, request.machine)
    of_set_up = _core.effect_names("set-up")  # nobody expects these to be corrected
    progress.notes += [
        f"{path}: {name} is not corrected: {why}" for name, why in data.left_out if name not in of_set_up
    ]
    if math.isfinite(data.reference_temperature_c) and temperature_c is None:
        progress.notes.append(f"{path}: growth with temperature is not corrected: no --temperature-c stated")
    known_c = math.nan if temperature_c is None else temperature_c
    targets = CompensatedTargets(data, request.machine.can_setup.limits, str(path), known_c)
    said: dict[str, object] = {
        "file": path.name,
        "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
        "model_sha256": data.model_sha256,
        "corrected": data.effects,
        "left_out": [effect for effect, _ in data.left_out],
        "temperature_c": temperature_c,
    }
    return replace(request, targets=targets, metadata={**request.metadata, "compensation": said})
