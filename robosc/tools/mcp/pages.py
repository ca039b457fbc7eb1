"""Pages of the documentation and examples that ship with the tool."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path, PurePosixPath

from robosc.base.files.resources import locate

SCHEME = "robosc://"
#: Path of the overview for assistants.
OVERVIEW = "docs/llms.txt"
#: Patterns of the files that `pages` lists, by the folder that ships. Pages of rules are listed by `robosc rule`.
_LISTED = {"docs": ("llms.txt", "*.md", "howto/*.md", "patterns/*.rscd"), "examples": ("*/*.rscd", "*/*.scenarios")}
_RULES = ("rules/*.md",)
_RULES_FOLDER = "docs/rules/"
#: URI template of the pages of rules.
RULE_TEMPLATE = f"{SCHEME}docs/rules/{{rule}}.md"
_LINK = re.compile(r"\]\(([^)]+)\)")
_TITLE = re.compile(r"^(?:#|//) *(.+)$", re.MULTILINE)


@dataclass(frozen=True)
class Page:
    """A file that ships with the tool; `name` is its relative path, such as `docs/language.md`."""

    name: str
    file: Path

    @property
    def uri(self) -> str:
        """The URI of the page as a resource."""
        return f"{SCHEME}{self.name}"

    @property
    def text(self) -> str:
        """The content of the page."""
        return self.file.read_text(encoding="utf-8")

    @property
    def title(self) -> str:
        """The first heading of a page, or the first comment of a model; else the name."""
        match = _TITLE.search(self.text)
        return match[1].strip() if match else self.name

    @property
    def is_rule(self) -> bool:
        """Whether this is the page of a rule."""
        return self.name.startswith(_RULES_FOLDER)

    @property
    def size(self) -> int:
        """The size of the page in bytes."""
        return self.file.stat().st_size

    @property
    def kind(self) -> str:
        """The MIME type."""
        return "text/markdown" if self.file.suffix == ".md" else "text/plain"


@cache
def pages() -> tuple[Page, ...]:
    """Return the listed pages, in the order of their names, the overview first."""
    return tuple(page for folder, patterns in _LISTED.items() for page in _below(folder, patterns))


@cache
def optional_pages() -> frozenset[str]:
    """Return the names of the pages that the overview lists as optional."""
    overview = resource(f"{SCHEME}{OVERVIEW}")
    _, _, optional = ("" if overview is None else overview.text).partition("\n## Optional\n")
    return frozenset(f"docs/{link}" for link in _LINK.findall(optional))


@cache
def all_pages() -> tuple[Page, ...]:
    """Return the listed pages and those of the rules."""
    return (*pages(), *_below("docs", _RULES))


def resource(uri: str) -> Page | None:
    """Return the page with a URI, or None if there is none."""
    return {page.uri: page for page in all_pages()}.get(uri)


def _below(folder: str, patterns: tuple[str, ...]) -> list[Page]:
    try:
        root = locate(folder)
    except FileNotFoundError:
        return []
    return [
        Page((PurePosixPath(folder) / path.relative_to(root).as_posix()).as_posix(), path)
        for pattern in patterns
        for path in sorted(root.glob(pattern))
    ]
