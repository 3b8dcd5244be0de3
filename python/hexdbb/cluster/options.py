"""Where tasks run: on this computer's cores, or on the workers of a scheduler by its address."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hexdbb.errors import InputError

SCHEMES = ("tcp://", "tls://")


@dataclass(frozen=True)
class ClusterOptions:
    """Where tasks run.

    Attributes
    ----------
    workers : int or None
        Processes of a local cluster, one thread each; None for one on each core that this process may use.
    scheduler : str or None
        ``tcp://host:port`` or ``tls://host:port`` of an existing scheduler; None for a local cluster.
    tls_ca, tls_cert, tls_key : Path or None
        Files in PEM form of the authority that signed the scheduler's certificate, of the own certificate and of its
        key; all three with ``tls://``, none otherwise.

    Raises
    ------
    InputError
        Options that contradict one another, an address of another form, a file that is not there.
    """

    workers: int | None = None
    scheduler: str | None = None
    tls_ca: Path | None = None
    tls_cert: Path | None = None
    tls_key: Path | None = None

    def __post_init__(self) -> None:
        if self.workers is not None and self.workers < 1:
            raise InputError(f"--workers {self.workers} (expected 1 or more)")
        files = {"--tls-ca": self.tls_ca, "--tls-cert": self.tls_cert, "--tls-key": self.tls_key}
        given = [option for option, path in files.items() if path is not None]
        if self.scheduler is None:
            if given:
                raise InputError(f"{given[0]} without --scheduler (expected --scheduler tls://HOST:PORT)")
            return
        if self.workers is not None:
            raise InputError(
                f"--workers {self.workers} together with --scheduler {self.scheduler}: expected one of them; the"
                " scheduler has workers of its own"
            )
        if not self.scheduler.startswith(SCHEMES):
            raise InputError(f'--scheduler "{self.scheduler}" (expected tcp://HOST:PORT or tls://HOST:PORT)')
        encrypted = self.scheduler.startswith("tls://")
        missing = [option for option, path in files.items() if path is None]
        if encrypted and missing:
            raise InputError(f"--scheduler {self.scheduler} without {', '.join(missing)} (expected the files of TLS)")
        if not encrypted and given:
            raise InputError(f"{given[0]} with --scheduler {self.scheduler} (expected tls://HOST:PORT)")
        for option, path in files.items():
            if path is not None and not path.is_file():
                raise InputError(f"{option} {path}: no such file")


def require(module: str) -> Any:
    """Return a module of the extra `cluster`.

    Raises
    ------
    InputError
        It is not installed.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != module.partition(".")[0]:
            raise
        raise InputError(f"{module} is not installed (expected: pip install 'hexdbb[cluster]')") from None
