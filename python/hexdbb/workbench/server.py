"""The workbench served to this computer's browser until it is ended."""

from __future__ import annotations

from collections.abc import Callable

from hexdbb.pages.serving import serve_page
from hexdbb.workbench.own_code import COMPUTING_S
from hexdbb.workbench.page import show
from hexdbb.workbench.session import Session


def serve(
    session: Session,
    port: int = 0,
    *,
    allow_code: bool = False,
    code_seconds: int = COMPUTING_S,
    ready: Callable[[str], None] = lambda _: None,
) -> None:
    """Serve a session until the process is interrupted.

    Parameters
    ----------
    session : Session
    port : int
        A free one is taken where 0.
    allow_code : bool
        Whether the page may write and run effects of the user's own.
    code_seconds : int
        Seconds of computing after which one that does not end is stopped when it is tried.
    ready : callable
        Called with the address, token included, once connections are taken.

    Raises
    ------
    InputError
        The port is in use.
    """
    serve_page(lambda: show(session, code_seconds if allow_code else None), "hexdbb workbench", port, ready=ready)
