"""`hexdbb-run --compensation FILE`: a request with the targets of the diagnosed machine.

There is no fallback to nominal targets: a file that is refused ends the command before anything moves.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import replace
from pathlib import Path

from hexdbb import _core
from hexdbb.capture.request import Request, RunProgress
from hexdbb.compensation import CompensatedTargets, read_compensation


def compensated(request: Request, path: Path, temperature_c: float | None, progress: RunProgress) -> Request:
    """Return a request with the targets of a compensation file, which its record names.

    Parameters
    ----------
    request : Request
        With nominal targets.
    path : Path
        Compensation file of `hexdbb compensate`.
    temperature_c : float or None
        Temperature of the machine, °C, to correct thermal growth; None leaves it uncorrected.
    progress : RunProgress
        Receives a note for each effect that the file does not correct.

    Returns
    -------
    Request

    Raises
    ------
    InputError
        The file cannot be read, is truncated or altered, belongs to a later version or another machine, or names an
        unknown effect.
    """
    data = read_compensation(path, request.machine)
    # Not part of the machine: never to be corrected.
    of_set_up = {*_core.effect_names("set-up"), *_core.effect_names("places")}
    progress.notes += [
        f"{path}: {name} is not corrected: {why}" for name, why in data.left_out if name not in of_set_up
    ]
    if math.isfinite(data.reference_temperature_c) and temperature_c is None:
        progress.notes.append(f"{path}: thermal growth is not corrected: --temperature-c is not given")
    known_c = math.nan if temperature_c is None else temperature_c
    targets = CompensatedTargets(data, request.machine.can_setup.limits, str(path), known_c)
    driven: dict[str, object] = {
        "file": path.name,
        "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
        "model_sha256": data.model_sha256,
        "corrected": data.effects,
        "left_out": [effect for effect, _ in data.left_out],
        "temperature_c": temperature_c,
    }
    return replace(request, targets=targets, metadata={**request.metadata, "compensation": driven})
