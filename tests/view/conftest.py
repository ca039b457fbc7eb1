"""The page as it is built, and a browser that opens it."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING, Any

import pytest

from robosc.view.page import PageError, page_files

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """A browser, as Playwright drives it. Skips where there is none, or where the page has not been built."""
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("there is no chromium (Debian's package)")
    try:
        page_files()
    except PageError as error:
        pytest.skip(str(error))
    from playwright.sync_api import sync_playwright  # noqa: PLC0415

    with sync_playwright() as playwright:
        # As root, as in containers, chromium has no sandbox.
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        yield browser
        browser.close()
