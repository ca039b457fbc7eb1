"""Pages of the rules, which ship with the tool."""

from __future__ import annotations

from functools import cache

from robosc.base.files.resources import locate


@cache
def rules() -> tuple[str, ...]:
    """Return the identifiers of all rules that have a page, in alphabetical order."""
    return tuple(sorted(path.stem for path in locate("docs/rules").glob("*.md")))


def page(rule: str) -> str | None:
    """Return the page of a rule in Markdown, or None if there is no such rule."""
    return locate(f"docs/rules/{rule}.md").read_text(encoding="utf-8") if rule in rules() else None


def address(rule: str) -> str | None:
    """Return the URI of the page of a rule on this computer, or None if there is no such rule."""
    return locate(f"docs/rules/{rule}.md").as_uri() if rule in rules() else None


def summary(text: str) -> str:
    """Return the paragraph after a page's title, in one line."""
    return " ".join(text.split("\n\n")[1].split())
