"""Who may open a page: this computer, from the address that the terminal printed.

Pages can write files or stop a machine, so that other programs' pages must not reach them. Of every
request, web socket ones too:

- the server listens on the loopback interface only;
- ``Host`` is this server's (no DNS name that was pointed here);
- ``Origin``, where the browser sends it, is this server's; a web socket must send it;
- the first request has the token of this run in its address; a cookie (HttpOnly, SameSite=Strict) holds it afterwards.

Answers forbid content of other servers, and frames (Content-Security-Policy). The page's framework compiles templates
in the browser, which needs ``unsafe-eval``, and starts with a script in the page; everything else is closed.
"""

from __future__ import annotations

import hmac
from collections.abc import Awaitable, Callable, MutableMapping
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]

FORBIDDEN, MOVED = 403, 303
POLICY_VIOLATION = 1008
"""Code of a web socket that is refused (RFC 6455, 7.4.1)."""


class Guard:
    """Refuse what does not come from the page of this run, then pass on to an application.

    Parameters
    ----------
    application : ASGI application
    port : int
        On which the server listens.
    token : str
        Secret of this run.
    """

    def __init__(self, application: Application, port: int, token: str) -> None:
        self._application = application
        self._hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}
        self._origins = {f"http://{host}" for host in self._hosts}
        self._token = token
        self._cookie = f"hexdbb_{port}"  # cookies do not keep ports apart
        self._headers = _headers(self._hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one connection (ASGI)."""
        if scope["type"] not in ("http", "websocket"):
            await self._application(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        reason = self._refusal(scope, headers)
        if reason is not None:
            await self._refuse(scope, receive, send, reason)
        elif scope["type"] == "http" and self._has_token(scope):
            await self._let_in(send)
        else:
            await self._application(scope, receive, self._closed(send))

    def _refusal(self, scope: Scope, headers: dict[str, str]) -> str | None:
        if headers.get("host") not in self._hosts:
            return "this address is not the page's"
        origin = headers.get("origin")
        if origin not in self._origins and (origin is not None or scope["type"] == "websocket"):
            return "the request comes from another page"
        if not self._is_known(headers) and not (scope["type"] == "http" and self._has_token(scope)):
            return "the token is missing (expected the whole address that was printed)"
        return None

    def _has_token(self, scope: Scope) -> bool:
        given = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])
        return scope["path"] == "/" and _same(given[-1], self._token)

    def _is_known(self, headers: dict[str, str]) -> bool:
        try:
            kept = SimpleCookie(headers.get("cookie", "")).get(self._cookie)
        except CookieError:
            return False
        return kept is not None and _same(kept.value, self._token)

    async def _let_in(self, send: Send) -> None:
        """Move the token from the address, where history and screenshots show it, into a cookie."""
        cookie = f"{self._cookie}={self._token}; Path=/; HttpOnly; SameSite=Strict"
        headers = [*self._headers, (b"location", b"/"), (b"set-cookie", cookie.encode("latin-1"))]
        await send({"type": "http.response.start", "status": MOVED, "headers": headers})
        await send({"type": "http.response.body", "body": b""})

    async def _refuse(self, scope: Scope, receive: Receive, send: Send, reason: str) -> None:
        if scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": POLICY_VIOLATION, "reason": reason})
            return
        headers = [*self._headers, (b"content-type", b"text/plain; charset=utf-8")]
        await send({"type": "http.response.start", "status": FORBIDDEN, "headers": headers})
        await send({"type": "http.response.body", "body": f"refused: {reason}\n".encode()})

    def _closed(self, send: Send) -> Send:
        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", []), *self._headers]
            await send(message)

        return with_headers


def _headers(hosts: set[str]) -> list[tuple[bytes, bytes]]:
    sockets = " ".join(f"ws://{host}" for host in sorted(hosts))
    policy = (
        "default-src 'none'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline';"
        f" img-src 'self' data: blob:; font-src 'self'; connect-src 'self' {sockets}; worker-src 'self' blob:;"
        " frame-ancestors 'none'; form-action 'none'; base-uri 'none'; object-src 'none'"
    )
    return [
        (b"content-security-policy", policy.encode()),
        (b"x-content-type-options", b"nosniff"),
        (b"referrer-policy", b"no-referrer"),
        (b"cross-origin-opener-policy", b"same-origin"),
        (b"cross-origin-resource-policy", b"same-origin"),
    ]


def _same(given: str, expected: str) -> bool:
    return hmac.compare_digest(given.encode(), expected.encode())
