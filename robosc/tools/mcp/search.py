"""Full-text search in the documentation: ranks sections by the words of a query (Okapi BM25)."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from functools import cache
from math import log
from typing import TYPE_CHECKING

from robosc.tools.mcp.pages import all_pages, optional_pages

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.tools.mcp.pages import Page

_WORD = re.compile(r"[^\W_]+")
_HEADING = re.compile(r"^#{1,4} +(.+)$")
_CODE = re.compile(r"^ *```.*?^ *```", re.DOTALL | re.MULTILINE)
_FENCE = re.compile(r"^ *```")
_ENDINGS = re.compile(r"(?<=\w{3})(?:ies|es|s|ing|ed|y|e)$")
#: Parameters of BM25: saturation of repeated words, influence of the length.
_SATURATION, _LENGTH = 1.2, 0.5
#: A word in the heading of a section counts as often as this many words of its text; one in the title of its page half.
_HEADING_WEIGHT = 6
#: Factor for optional pages.
_OPTIONAL_WEIGHT = 0.75
#: Maximum number of results of one page.
_MOST_OF_PAGE = 2
#: Maximum length of an excerpt in characters.
MOST_CHARACTERS = 700


@dataclass(frozen=True)
class Section:
    """A section of a page: its heading and its text."""

    page: Page
    heading: str
    text: str

    @property
    def words(self) -> Counter[str]:
        """How often each word counts. All code of a section counts a word once."""
        counts = Counter(_words(_CODE.sub("", self.text)))
        counts.update({word for code in _CODE.findall(self.text) for word in _words(code)})
        for text, weight in ((self.heading, _HEADING_WEIGHT), (self.page.title, _HEADING_WEIGHT // 2)):
            for word in _words(text):
                counts[word] += weight
        return counts


def search(query: str, most: int) -> list[Section]:
    """Return the sections that fit a query best, in order, at most two of a page.

    Empty if no word of the query occurs.
    """
    index = _index()
    words = set(_words(query))
    average = sum(length for _, _, length in index) / max(len(index), 1)
    frequency = Counter(word for _, counts, _ in index for word in words & counts.keys())
    scored = []
    for number, (section, counts, length) in enumerate(index):
        norm = _SATURATION * (1 - _LENGTH + _LENGTH * length / average)
        score = sum(
            log(1 + (len(index) - frequency[word] + 0.5) / (frequency[word] + 0.5))
            * (counts[word] * (_SATURATION + 1) / (counts[word] + norm))
            for word in words & counts.keys()
        )
        score *= _OPTIONAL_WEIGHT if section.page.name in optional_pages() else 1
        if score:
            scored.append((-score, number, section))
    results: list[Section] = []
    for _, _, section in sorted(scored, key=lambda row: row[:2]):
        if sum(other.page is section.page for other in results) < _MOST_OF_PAGE:
            results.append(section)
    return results[:most]


def excerpt(section: Section, query: str) -> str:
    """Return the paragraphs of a section from the one with most words of the query, up to `MOST_CHARACTERS`."""
    words = set(_words(query))
    paragraphs = section.text.strip().split("\n\n")
    best = max(range(len(paragraphs)), key=lambda place: (len(words & set(_words(paragraphs[place]))), -place))
    text = "\n\n".join(paragraphs[best:]).strip()
    return text if len(text) <= MOST_CHARACTERS else f"{text[: MOST_CHARACTERS - 1].rstrip()}…"


@cache
def _index() -> list[tuple[Section, Counter[str], int]]:
    sections = [section for page in all_pages() if page.file.suffix == ".md" for section in _sections(page)]
    counted = [(section, section.words) for section in sections]
    return [(section, counts, counts.total()) for section, counts in counted]


def _sections(page: Page) -> Iterator[Section]:
    """Yield the sections of a page. The page of a rule is one: its sections are all called the same."""
    if page.is_rule:
        yield Section(page, page.title, page.text)
        return
    heading, lines, is_code = page.title, list[str](), False
    for line in page.text.splitlines():
        is_code ^= bool(_FENCE.match(line))
        match = None if is_code else _HEADING.match(line)
        if match is None:
            lines.append(line)
            continue
        if any(lines):
            yield Section(page, heading, "\n".join(lines))
        heading, lines = match[1], []
    if any(lines):
        yield Section(page, heading, "\n".join(lines))


def _words(text: str) -> list[str]:
    """Return the words of a text without case and common endings."""
    return [_ENDINGS.sub("", word.casefold()) for word in _WORD.findall(text)]
