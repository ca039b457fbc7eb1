"""The documentation for assistants: resources, search, and docs/llms.txt."""

from __future__ import annotations

import re
from io import BytesIO
from pathlib import Path

import pytest

from robosc.base.diagnostics.rules import rules
from robosc.tools.mcp import catalog, pages, stdio, worker
from robosc.tools.mcp.catalog import TOOLS
from robosc.tools.mcp.search import MOST_CHARACTERS, excerpt, search
from robosc.tools.mcp.server import MOST_WAITING

ROOT = Path(__file__).parents[3]
DOCS = ROOT / "docs"
OVERVIEW = (DOCS / "llms.txt").read_text(encoding="utf-8")
#: A line of a section: a link, and a description.
ENTRY = re.compile(r"- \[([^\]]+)\]\(([^)]+)\)(?:: (.+))?")


def test_the_overview_follows_the_convention() -> None:
    """A title, a summary as a quote, text without headings, then sections that hold only lists of links."""
    title, quote, *text = OVERVIEW.split("\n\n")
    assert re.fullmatch(r"# \S+", title)
    assert all(line.startswith("> ") for line in quote.split("\n"))
    before, *sections = "\n\n".join(text).split("\n## ")
    assert "#" not in before
    for section in sections:
        name, entries = section.split("\n\n", 1)
        assert name
        assert [line for line in entries.strip().split("\n") if not ENTRY.fullmatch(line)] == []
    assert sections[-1].startswith("Optional\n")
    assert len(OVERVIEW) < 10_000


def test_the_overview_lists_each_page_once() -> None:
    links = [link for _, link, _ in ENTRY.findall(OVERVIEW)]
    there = {path.relative_to(DOCS).as_posix() for pattern in ("*.md", "howto/*.md") for path in DOCS.glob(pattern)}
    assert sorted(links) == sorted(there)
    assert [link for link in re.findall(r"\]\(([^)]+)\)", OVERVIEW) if not (DOCS / link).is_file()] == []


def test_the_page_for_people_names_tools_and_limits() -> None:
    page = (DOCS / "mcp.md").read_text(encoding="utf-8")
    _, _, table = page.partition("| tool | result |\n")
    assert re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE) == list(TOOLS)
    limits = f"{catalog.MOST_CHARACTERS:,} characters, an answer {worker.MOST_BYTES >> 20} MB, and {MOST_WAITING} calls"
    assert limits in page


def test_a_message_that_is_too_long_is_dropped() -> None:
    lines = stdio.Lines(BytesIO(b"12345678\n" + b"1" * 99 + b"\n\xff\n1234567890"), most=9)
    assert [lines.readline() for _ in range(3)] == ["12345678\n", "\N{REPLACEMENT CHARACTER}\n", ""]


def test_all_pages_and_examples_are_resources() -> None:
    names = [page.name for page in pages.pages()]
    assert names[0] == "docs/llms.txt"
    links = {f"docs/{link}" for _, link, _ in ENTRY.findall(OVERVIEW)}
    examples = {path.relative_to(ROOT).as_posix() for path in (ROOT / "examples").glob("*/*.rscd")}
    assert links | examples <= set(names)
    for page in pages.pages():
        assert page.title
        assert pages.resource(page.uri) == page
    for rule in rules():
        page = pages.resource(pages.RULE_TEMPLATE.format(rule=rule))
        assert page is not None
        assert page.text.startswith("# ")


@pytest.mark.parametrize(
    ("query", "page", "heading"),
    [
        ("limit the data of a command", "docs/language-requirements.md", None),
        ("marked state", "docs/rules/marked-state.md", None),
        ("emergency stop button", "docs/howto/emergency-stop.md", None),
        ("mutual exclusion two robots", "docs/howto/resource.md", None),
        ("controller-config.json watchdog", "docs/configuration.md", None),
        ("expect sent scenario", "docs/scenarios.md", None),
        ("fleet instances", "docs/language-libraries.md", "Fleets"),
        ("why is an event forbidden", "docs/explain.md", None),
        ("requirement at most since", "docs/language-requirements.md", None),
    ],
)
def test_words_lead_to_the_page(query: str, page: str, heading: str | None) -> None:
    results = search(query, 5)
    fitting = [result for result in results if result.page.name == page]
    assert fitting, [(result.page.name, result.heading) for result in results]
    assert heading is None or heading in [result.heading for result in fitting]
    assert 0 < len(excerpt(fitting[0], query)) <= MOST_CHARACTERS


def test_words_that_are_nowhere() -> None:
    assert search("xylophone qwertz", 5) == []
    assert search("!!! ???", 5) == []
