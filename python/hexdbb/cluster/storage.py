"""Files below a URL that fsspec knows: a local folder, an S3-compatible store.

A file is written whole or not at all: locally to a temporary file that is renamed, in a store by one request, which the
store itself completes or forgets.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hexdbb.cluster.options import require
from hexdbb.errors import HexdbbError, InputError, RunError
from hexdbb.files.atomic_file import replacing

PACKAGES = {"s3": "s3fs", "s3a": "s3fs", "gs": "gcsfs", "gcs": "gcsfs", "abfs": "adlfs", "az": "adlfs"}
"""Packages that fsspec needs for the protocols of common stores."""


@dataclass(frozen=True)
class Storage:
    """The files below a URL.

    Attributes
    ----------
    url : str
        As it was given.
    system : fsspec.AbstractFileSystem
    root : str
        Path of the URL in the system, without its protocol.
    """

    url: str
    system: Any = field(repr=False)
    root: str

    @property
    def is_local(self) -> bool:
        """Whether it lies in this computer's file system."""
        return "file" in _protocols(self.system)

    def named(self, path: str) -> str:
        """Return a path of the system as a URL, a local one as it is."""
        return path if self.is_local else str(self.system.unstrip_protocol(path))

    def files(self) -> list[str]:
        """Return the paths of all files below the URL, sorted; none where nothing is there.

        Raises
        ------
        RunError
            The store refuses or does not answer.
        """
        with self.refusals("cannot be listed"):
            self.system.invalidate_cache()  # another program may have written since
            return sorted(self.system.find(self.root))

    def read(self, path: str) -> bytes:
        """Return the content of a file; `RunError` where the store refuses."""
        with self.refusals("cannot be read", path):
            return bytes(self.system.cat_file(path))

    def write(self, name: str, content: bytes) -> None:
        """Write a file whole or not at all, replacing one of this name.

        Parameters
        ----------
        name : str
            Below the URL, parts separated by ``/``.
        content : bytes

        Raises
        ------
        RunError
            It cannot be written: refused, disk full.
        """
        path = f"{self.root.rstrip('/')}/{name}"
        with self.refusals("cannot be written", path):
            if not self.is_local:
                self.system.pipe_file(path, content)
                return
            local = Path(path)
            local.parent.mkdir(parents=True, exist_ok=True)
            with replacing(local) as temporary:
                temporary.write_bytes(content)

    def remove(self, path: str) -> None:
        """Remove a file; `RunError` where it cannot be."""
        with self.refusals("cannot be removed", path):
            self.system.rm_file(path)

    @contextmanager
    def refusals(self, what: str, path: str | None = None) -> Iterator[None]:
        """Raise `RunError` for whatever a file system raises in the block: each has exceptions of its own."""
        try:
            yield
        except HexdbbError:
            raise
        except Exception as error:
            named = self.url if path is None else self.named(path)
            reason = next(iter(str(error).splitlines()), "") or type(error).__name__
            raise RunError(f"{named}: {what}: {reason}") from error


def storage_of(url: str) -> Storage:
    """Return the files below a URL; nothing is asked of its store yet.

    Raises
    ------
    InputError
        fsspec, or its package for this protocol, is not installed, or no such protocol is known.
    """
    fsspec = require("fsspec")
    protocol = url.partition("://")[0] if "://" in url else "file"
    try:
        system, root = fsspec.core.url_to_fs(url)
    except ImportError:
        package = PACKAGES.get(protocol, f"the package for {protocol}://")
        raise InputError(f"{url}: {package} is not installed (expected: pip install {package})") from None
    except ValueError as error:
        raise InputError(f"{url}: {error} (expected a folder, or a URL such as s3://bucket/folder)") from None
    return Storage(url, system, str(root))


def _protocols(system: Any) -> tuple[str, ...]:
    found = system.protocol
    return (found,) if isinstance(found, str) else tuple(found)
