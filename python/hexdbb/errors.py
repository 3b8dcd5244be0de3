"""The exception family of hexdbb: what the user gave is wrong, or the machine or a fit did not succeed."""


class HexdbbError(Exception):
    """Root of every error hexdbb raises on purpose; `exit_status` is what a command ends with."""

    exit_status = 1


class InputError(HexdbbError):
    """A file, key, row or option is wrong: names it, its value and what was expected. Nothing was written or moved."""

    exit_status = 2


class RunError(HexdbbError):
    """A measurement, fit or conversion was begun and did not succeed: says what happened and what was kept."""
