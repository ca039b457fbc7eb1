"""The documentation site builds without warnings, and the result is complete, also without a network."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from functools import cached_property
from html.parser import HTMLParser
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote, urlsplit

import pytest

from tests.chromium import browser
from tests.docs.pages import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("site")]

MERMAID = ROOT / "web" / "node_modules" / "@mermaid-js" / "tiny"


class Page(HTMLParser):
    """The links and the link targets of an HTML page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.names: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        self.names |= {values[name] for name in ("id", "name") if name in values}
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        elif tag in ("script", "img", "iframe", "source") and "src" in values:
            self.loaded.append(values["src"])
        elif tag == "link" and values.get("rel") in ("stylesheet", "icon", "preload"):
            self.loaded.append(values["href"])


class Site:
    """The folder of a built site."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @cached_property
    def pages(self) -> dict[Path, Page]:
        return {path: Page(path) for path in sorted(self.folder.rglob("*.html"))}

    def broken(self, path: Path, target: str) -> bool:
        """Whether a link leads to a missing file, or to a missing place in its page."""
        parts = urlsplit(target)
        if parts.scheme or parts.netloc:
            return False
        place = path if not parts.path else (path.parent / unquote(parts.path)).resolve()
        if not place.is_file():
            return True
        return bool(parts.fragment) and place in self.pages and unquote(parts.fragment) not in self.pages[place].names


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Site:
    pytest.importorskip("furo", reason="the packages of [docs] are not installed")
    folder = tmp_path_factory.mktemp("site").resolve()
    environment = {**os.environ, "PYTHON": sys.executable, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [ROOT / "scripts" / "site", folder], env=environment, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    return Site(folder)


def test_links_lead_somewhere(site: Site) -> None:
    broken = [
        (path.relative_to(site.folder).as_posix(), target)
        for path, page in site.pages.items()
        for target in page.links
        if site.broken(path, target)
    ]
    assert broken == []
    assert sum(len(page.links) for page in site.pages.values()) > 1000


def test_nothing_is_loaded_from_elsewhere(site: Site) -> None:
    missing = [
        (path.name, target)
        for path, page in site.pages.items()
        for target in page.loaded
        if urlsplit(target).netloc or site.broken(path, target)
    ]
    assert missing == []
    styles = "".join(path.read_text(encoding="utf-8") for path in site.folder.rglob("*.css"))
    assert re.findall(r"url\(['\"]?https?:|@import", styles) == []


def test_only_pages_that_draw_load_the_script_for_it(site: Site) -> None:
    texts = {path.relative_to(site.folder): path.read_text(encoding="utf-8") for path in site.pages}
    draw = {path for path, text in texts.items() if "mermaid-drawing" in text}
    assert Path("docs/architecture.html") in draw
    load = {path for path, text in texts.items() if "mermaid.tiny.js" in text}
    assert load == (draw if MERMAID.is_dir() else set())


def test_models_are_coloured(site: Site) -> None:
    text = (site.folder / "docs" / "language-requirements.html").read_text(encoding="utf-8")
    assert '<div class="highlight-robosc notranslate">' in text
    assert re.search(r'<span class="k\w*">requirement</span>', text)


def test_rules_and_functions_have_their_places(site: Site) -> None:
    for rule in (ROOT / "docs" / "rules").glob("*.md"):
        assert (site.folder / "docs" / "rules" / f"{rule.stem}.html").is_file()
    import robosc  # noqa: PLC0415

    names = site.pages[site.folder / "docs" / "api.html"].names
    assert {f"robosc.{name}" for name in robosc.__all__} - names == set()


def test_words_are_found(site: Site) -> None:
    index = (site.folder / "searchindex.js").read_text(encoding="utf-8")
    assert index.startswith("Search.setIndex(")
    for word in ("supervisor", "watchdog", "mutual"):
        assert word in index


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with browser() as chromium:
        yield chromium


class Opened:
    """A page of the site in a browser without a network, with the errors that occurred."""

    def __init__(self, chromium: Any, **options: Any) -> None:
        self.context = chromium.new_context(offline=True, **options)
        self.page = self.context.new_page()
        self.faults: list[str] = []
        self.page.on("pageerror", lambda error: self.faults.append(str(error)))
        self.page.on(
            "request", lambda asked: None if asked.url.startswith(("file:", "data:")) else self.faults.append(asked.url)
        )

    def __enter__(self) -> Opened:
        return self

    def __exit__(self, *_: object) -> None:
        self.context.close()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_mermaid_is_drawn(site: Site, chromium: Any, scheme: str) -> None:
    if not MERMAID.is_dir():
        pytest.skip("Node's packages are not installed: build_page of scripts/environment")
    with Opened(chromium, color_scheme=scheme) as opened:
        opened.page.goto((site.folder / "docs" / "architecture.html").as_uri())
        opened.page.wait_for_selector("body[data-drawn]")
        assert opened.page.locator(".mermaid-drawing svg").count() == 1
        assert "sct_to_engine" in opened.page.locator(".mermaid-drawing svg").text_content()
        assert opened.page.evaluate("document.body.dataset.drawn") == {"light": "neutral", "dark": "dark"}[scheme]
        assert opened.faults == []


def test_the_search_answers(site: Site, chromium: Any) -> None:
    with Opened(chromium) as opened:
        opened.page.goto((site.folder / "search.html").as_uri() + "?q=interlock")
        opened.page.wait_for_selector("#search-results li a")
        found = opened.page.eval_on_selector_all("#search-results li a", "links => links.map(link => link.href)")
        assert any("docs/patterns.html" in link for link in found)


def test_no_page_is_wider_than_a_phone(site: Site, chromium: Any) -> None:
    """Wide tables and blocks have scroll bars of their own."""
    wide = []
    with Opened(chromium, viewport={"width": 390, "height": 800}) as opened:
        for path in site.pages:
            if path.parent.name == "rules" or path.parent == site.folder:
                continue
            opened.page.goto(path.as_uri(), wait_until="domcontentloaded")
            width = opened.page.evaluate("document.scrollingElement.scrollWidth")
            if width > 390:
                wide.append((path.relative_to(site.folder).as_posix(), width))
        assert opened.faults == []
    assert wide == []
