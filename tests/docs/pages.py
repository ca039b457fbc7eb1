"""The pages of the documentation, and the blocks in them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted(
    path
    for pattern in ("*.md", "docs/**/*.md", "examples/*.md", "examples/*/*.md", "editors/vscode/**/*.md")
    for path in ROOT.glob(pattern)
    if "node_modules" not in path.parts
)
_BLOCK = re.compile(
    r"(?:^<!-- (?P<marker>[^\n]*?) -->\n\n?)?^(?P<indent> *)```(?P<kind>[^\n`]*)\n(?P<text>.*?)^(?P=indent)```$",
    re.MULTILINE | re.DOTALL,
)


@dataclass(frozen=True)
class Block:
    """A fenced block: what stands behind its fence, its text, its line, and the comment right before it."""

    page: Path
    line: int
    kind: str
    text: str
    marker: str | None

    @property
    def name(self) -> str:
        """Page and line, for people."""
        return f"{self.page.relative_to(ROOT).as_posix()}:{self.line}"


def blocks(page: Path) -> list[Block]:
    """All blocks of a page, in their order."""
    text = page.read_text(encoding="utf-8")
    found = []
    for match in _BLOCK.finditer(text):
        indent = match["indent"]
        lines = match["text"].splitlines(keepends=True)
        inner = "".join(line.removeprefix(indent) for line in lines)
        line = text.count("\n", 0, match.start("kind")) + 1
        found.append(Block(page, line, match["kind"].strip(), inner, match["marker"]))
    return found


def without_blocks(text: str) -> str:
    """A page's text between its blocks."""
    return _BLOCK.sub("", text)
