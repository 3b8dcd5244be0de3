"""Questions on the terminal, each of which an option answers as well: where nobody answers, the error names it."""

from __future__ import annotations

import sys
from typing import Any

import click

from hexdbb.cli.consoles import say
from hexdbb.errors import InputError, InterruptError


def prompted(option: str, text: str, **form: Any) -> Any:
    """Ask a question on the terminal, or read its answer from what is piped into the command.

    Parameters
    ----------
    option : str
        The option that answers it, without dashes.
    text : str
        The question.
    **form
        Default, type and check of the answer, as `click.prompt` takes them.

    Raises
    ------
    InputError
        The input is at its end, as without a terminal; names the option.
    InterruptError
        Ctrl-C.
    """
    is_ended = sys.stdin is None  # closed by the shell (<&-)
    try:
        if not is_ended:
            return click.prompt(text, **form)
    except click.Abort as error:  # click makes one of both; the cause is its context
        say("")  # the message does not begin behind the question
        is_ended = isinstance(error.__context__, EOFError)
    if not is_ended:
        raise InterruptError("interrupted")
    raise InputError(
        f'no answer to "{text}": the input has ended (expected a terminal, --{option} VALUE,'
        " or --defaults, which asks nothing)"
    )
