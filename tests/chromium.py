"""A browser for tests of the page of `robosc view` and of the documentation site."""

from __future__ import annotations

import shutil
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from robosc.tools.view.page import PageError, page_files

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Milliseconds for a quick operation of the browser on a machine with twenty other busy programs.
PATIENCE = 120_000


@contextmanager
def browser() -> Iterator[Any]:
    """Run a browser without windows through Playwright, or skip the test if there is none.

    The program without any windows takes half the CPU time of the one that hides them.
    """
    program = shutil.which("chromium-headless-shell")
    if program is None:
        pytest.skip("there is no chromium-headless-shell (Debian's package)")
    from playwright.sync_api import sync_playwright  # noqa: PLC0415

    with sync_playwright() as playwright:
        # As root, for example in a container, chromium has no sandbox.
        chromium = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"], timeout=PATIENCE)
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """Run a browser for the page of `robosc view`; skip the test without a browser or a built page."""
    try:
        page_files()
    except PageError as error:
        pytest.skip(str(error))
    with browser() as chromium:
        yield chromium


@contextmanager
def opened(chromium: Any, address: str, *, drawn: str = "[data-moment]", **options: Any) -> Iterator[Any]:
    """Open a page and wait until it has drawn its robot; fail at any error in it."""
    context = chromium.new_context(**{"viewport": {"width": 1400, "height": 900}, **options})
    context.set_default_timeout(PATIENCE)
    page = context.new_page()
    faults: list[str] = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda said: faults.append(said.text) if said.type in ("error", "warning") else None)
    page.on("request", lambda asked: faults.append(asked.url) if not asked.url.startswith(origin(address)) else None)
    page.goto(address)
    page.wait_for_selector(f"body[data-drawn]{drawn}")
    yield page
    context.close()
    assert faults == []


def origin(address: str) -> str:
    """Return the address of the server from the address of a page."""
    return address.rpartition("/")[0]


def shown(page: Any) -> dict[str, Any]:
    """Return the states (as text and as highlighted nodes) and the verdicts of the commands on the page."""
    found: dict[str, Any] = page.evaluate(
        """() => ({
          states: [...document.querySelectorAll(".card:not(.graph)")].map((card) => [
            card.querySelector(".name").textContent, card.querySelector(".now").textContent,
            [...card.querySelectorAll(".current .title")].map((title) => title.textContent)]),
          variables: Object.fromEntries([...document.querySelectorAll(".variables")].flatMap((list) =>
            [...list.querySelectorAll("dt")].map((term) => [
              `${list.closest(".card").querySelector(".name").textContent}.${term.textContent}`,
              term.nextElementSibling.textContent]))),
          commands: [...document.querySelectorAll("#commands > li")].map((item) => [
            item.dataset.event, item.className, item.querySelector(".reason").textContent]),
        })"""
    )
    return found
