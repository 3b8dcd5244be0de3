"""A page served to this computer's browser until its process is ended."""

from __future__ import annotations

import gc
import secrets
import socket
from collections.abc import Callable
from pathlib import Path

import uvicorn
from fastapi import FastAPI
from nicegui import ui

from hexdbb.errors import InputError
from hexdbb.pages.guard import Guard

LOOPBACK = "127.0.0.1"
RECONNECT_S = 30.0
"""Time for which a tab that is not heard of is kept: a computer that fits on every core may be late by seconds."""
TOKEN_BYTES = 24
"""Length of the token: 192 bits cannot be guessed."""
ACCENT, GOOD, BAD = "#004B76", "#00523C", "#8C1D18"
"""Buttons, and messages of success and refusal: dark enough for white text on them, 7 to 1 and more."""
STYLE = (Path(__file__).parent / "style.css").read_text(encoding="utf-8")


def dress() -> None:
    """Add to the page that is being built the colours and the style sheet of all pages."""
    ui.add_css(STYLE)
    ui.colors(primary=ACCENT, positive=GOOD, negative=BAD)


def serve_page(
    build: Callable[[], None], title: str, port: int = 0, *, ready: Callable[[str], None] = lambda _: None
) -> None:
    """Serve a page until the process is interrupted.

    Parameters
    ----------
    build : callable
        Builds the page of one tab.
    title : str
    port : int
        A free one is taken where 0.
    ready : callable
        Called with the address, token included, once connections are taken.

    Raises
    ------
    InputError
        The port is in use.
    """
    listening = _listening(port)
    port = listening.getsockname()[1]
    token = secrets.token_urlsafe(TOKEN_BYTES)
    application = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)

    @ui.page("/", title=title, language="en-GB")
    def page() -> None:
        build()

    ui.run_with(
        application,
        title=title,
        tailwind=False,
        show_welcome_message=False,
        reconnect_timeout=RECONNECT_S,
        gzip_middleware_factory=None,
    )
    configuration = uvicorn.Config(
        Guard(application, port, token),
        log_level="warning",
        ws="wsproto",
        timeout_graceful_shutdown=1,
    )
    # What is there by now lives as long as the server. NiceGUI looks for the server among all objects that the
    # collector follows, and fails on one of canopen's that refuses to be asked for its class.
    gc.freeze()
    ready(f"http://{LOOPBACK}:{port}/?token={token}")
    uvicorn.Server(configuration).run(sockets=[listening])


def _listening(port: int) -> socket.socket:
    """Return a socket that listens on the loopback interface: connections wait until the server takes them."""
    made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind((LOOPBACK, port))
    except OSError as error:
        made.close()
        raise InputError(f"--port {port}: {error.strerror} (expected a free port, or 0 for any)") from None
    made.listen()
    return made
