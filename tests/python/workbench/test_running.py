"""Long actions of a page: what they say, and to whom."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.errors import InputError
from hexdbb.workbench.page import running


class Tab(nullcontext[None]):
    """A browser's tab, there or closed."""

    is_deleted = False


@pytest.fixture
def tab() -> Tab:
    return Tab()


@pytest.fixture
def said(tab: Tab, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return what is said at the edge of the page."""
    texts: list[str] = []

    def notify(text: str, **_: Any) -> None:
        assert not tab.is_deleted
        texts.append(text)

    monkeypatch.setattr(running, "ui", SimpleNamespace(context=SimpleNamespace(client=tab), notify=notify))

    async def at_once(action: Callable[[], Any]) -> Any:
        return action()

    monkeypatch.setattr(running, "run", SimpleNamespace(io_bound=at_once))
    return texts


def refuse() -> None:
    raise InputError("no such file")


def test_an_action_says_what_it_did_or_why_not(said: list[str]) -> None:
    assert asyncio.run(running.off_loop(lambda: "written")())
    assert asyncio.run(running.off_loop(lambda: None, "fitted")())
    assert not asyncio.run(running.off_loop(refuse)())
    assert said == ["written", "fitted", "no such file"]


@pytest.mark.parametrize("fails", [False, True])
def test_a_tab_closed_in_an_action_is_not_spoken_to(tab: Tab, said: list[str], fails: bool) -> None:
    def action() -> str:
        tab.is_deleted = True
        if fails:
            refuse()
        return "written"

    assert not asyncio.run(running.off_loop(action)())
    assert said == []
