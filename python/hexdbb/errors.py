"""Exceptions of hexdbb: wrong input, or a run, fit or conversion that did not succeed."""


class HexdbbError(Exception):
    """Base class of all errors that hexdbb raises on purpose; `exit_status` is the exit status of a command."""

    exit_status = 1


class InputError(HexdbbError):
    """Raised for a wrong file, key, row or option; names it, its value and what was expected. Nothing was changed."""

    exit_status = 2


class RunError(HexdbbError):
    """Raised where a measurement, fit or conversion was begun and failed; states what happened and what was kept."""
