"""Who may open the workbench: what comes from elsewhere, or without the token, is refused; web sockets too."""

from __future__ import annotations

import base64
import http.client
import os
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.python.workbench.served import Served, served

SOCKET_PATH = "/_nicegui_ws/socket.io/?EIO=4&transport=websocket"


@pytest.fixture(scope="module")
def workbench(measured: Path) -> Iterator[Served]:
    with served(measured, "today.parquet", "-m", "model.toml") as started:
        yield started


def ask(workbench: Served, path: str, **headers: str) -> http.client.HTTPResponse:
    connection = http.client.HTTPConnection("127.0.0.1", workbench.port, timeout=30)
    connection.request("GET", path, headers={"Host": f"127.0.0.1:{workbench.port}"} | headers)
    answer = connection.getresponse()
    answer.body = answer.read().decode()  # type: ignore[attr-defined]
    connection.close()
    return answer


def cookie(workbench: Served) -> str:
    answer = ask(workbench, f"/?token={workbench.token}")
    assert (answer.status, answer.headers["location"]) == (303, "/")
    return answer.headers["set-cookie"].partition(";")[0]


def socket_status(workbench: Served, **headers: str) -> int:
    """Ask for a web socket; return the status of the answer, 101 where it is opened."""
    key = base64.b64encode(os.urandom(16)).decode()
    wanted = {
        "Host": f"127.0.0.1:{workbench.port}",
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Key": key,
        "Sec-WebSocket-Version": "13",
    } | headers
    lines = [f"GET {SOCKET_PATH} HTTP/1.1", *(f"{name}: {value}" for name, value in wanted.items()), "", ""]
    with socket.create_connection(("127.0.0.1", workbench.port), timeout=30) as connection:
        connection.sendall("\r\n".join(lines).encode())
        return int(connection.recv(4096).split()[1])


def test_the_token_opens_the_page_and_a_cookie_keeps_it(workbench: Served) -> None:
    answer = ask(workbench, f"/?token={workbench.token}")
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= set(answer.headers["set-cookie"].split("; "))
    opened = ask(workbench, "/", Cookie=cookie(workbench))
    assert opened.status == 200
    assert "hexdbb workbench" in opened.body  # type: ignore[attr-defined]


def test_answers_allow_no_content_of_other_servers(workbench: Served) -> None:
    answer = ask(workbench, "/", Cookie=cookie(workbench))
    policy = answer.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "https:" not in policy
    assert "http://" not in policy
    assert answer.headers["referrer-policy"] == "no-referrer"


@pytest.mark.parametrize(
    "path", ["/", "/?token=", "/?token=wrong", "/docs", "/_nicegui_ws/socket.io/?EIO=4", "/favicon.ico"]
)
def test_without_the_token_everything_is_refused(workbench: Served, path: str) -> None:
    answer = ask(workbench, path)
    assert answer.status == 403
    assert "the token is missing" in answer.body  # type: ignore[attr-defined]


def test_a_token_is_good_for_the_first_page_only(workbench: Served) -> None:
    assert ask(workbench, f"/_nicegui_ws/socket.io/?EIO=4&token={workbench.token}").status == 403


@pytest.mark.parametrize(
    "host", ["attacker.example", "attacker.example:{port}", "127.0.0.1", "[::1]:{port}", "localhost:1"]
)
def test_another_host_is_refused(workbench: Served, host: str) -> None:
    answer = ask(
        workbench, f"/?token={workbench.token}", Host=host.format(port=workbench.port), Cookie=cookie(workbench)
    )
    assert answer.status == 403
    assert "set-cookie" not in answer.headers


@pytest.mark.parametrize(
    "origin", ["http://attacker.example", "null", "https://127.0.0.1:{port}", "http://127.0.0.1:1"]
)
def test_another_origin_is_refused_for_pages_and_sockets(workbench: Served, origin: str) -> None:
    headers = {"Origin": origin.format(port=workbench.port), "Cookie": cookie(workbench)}
    assert ask(workbench, "/", **headers).status == 403
    assert socket_status(workbench, **headers) == 403


def test_a_socket_needs_cookie_and_origin(workbench: Served) -> None:
    known, own = {"Cookie": cookie(workbench)}, {"Origin": f"http://127.0.0.1:{workbench.port}"}
    assert socket_status(workbench, **own) == 403
    assert socket_status(workbench, **known) == 403
    assert socket_status(workbench, **known, **own) == 101


def test_a_damaged_cookie_is_refused(workbench: Served) -> None:
    assert ask(workbench, "/", Cookie="=;;{[=,;hexdbb_workbench").status == 403


def test_only_this_computer_is_listened_to(workbench: Served) -> None:
    listening = [line.split() for line in Path("/proc/net/tcp").read_text(encoding="ascii").splitlines()[1:]]
    own = [each[1] for each in listening if int(each[1].partition(":")[2], 16) == workbench.port and each[3] == "0A"]
    assert own == [f"0100007F:{workbench.port:04X}"]
