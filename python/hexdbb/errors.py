"""Exceptions of hexdbb: wrong input, or a run, fit or conversion that did not succeed."""

LONGEST_MESSAGE = 1000
"""Characters of a message: some ten lines of a terminal, more than a message needs that quotes no file. A damaged file
may have a cell or key of any length, and its message quotes it."""


class HexdbbError(Exception):
    """Base class of all errors that hexdbb raises on purpose; `exit_status` is the exit status of a command.

    Parameters
    ----------
    message : str
        What happened, where, and what was expected. It becomes one printable line, since it may quote what a file or a
        library says: characters that would move a terminal's cursor or break the line are escaped, and the middle of an
        overlong message is left out.
    """

    exit_status = 1

    def __init__(self, message: str) -> None:
        super().__init__(printable_line(message))


class InputError(HexdbbError):
    """Raised for a wrong file, key, row or option; names it, its value and what was expected. Nothing was changed."""

    exit_status = 2


class InterruptError(HexdbbError):
    """Raised where the user ended a command by Ctrl-C; the exit status is that of a shell for SIGINT."""

    exit_status = 130


class RunError(HexdbbError):
    """Raised where a measurement, fit or conversion was begun and failed; states what happened and what was kept."""


def printable_line(text: str) -> str:
    """Return a text as one printable line of at most `LONGEST_MESSAGE` characters; other characters are escaped."""
    if not text.isprintable():
        text = "".join(mark if mark.isprintable() else repr(mark)[1:-1] for mark in text)
    if len(text) > LONGEST_MESSAGE:
        half = (LONGEST_MESSAGE - 3) // 2
        text = f"{text[:half]}...{text[-half:]}"
    return text
