"""Pages of the documentation and their code blocks."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted(
    path
    for pattern in ("*.md", "docs/**/*.md", "examples/*.md", "examples/*/*.md", "editors/vscode/**/*.md")
    for path in ROOT.glob(pattern)
    if "node_modules" not in path.parts
)
_BLOCK = re.compile(
    r"(?:^<!-- (?P<marks>[^\n]*?) -->\n\n?)?^(?P<indent> *)```(?P<kind>[^\n`]*)\n(?P<text>.*?)^(?P=indent)```$",
    re.MULTILINE | re.DOTALL,
)
#: Marks in a comment directly before a block, as `<!-- in: examples/line_follower; status: 1 -->`.
MARKS = {
    "not run": "why nothing runs it",
    "tested by": "the test that does, of the repository; it names the page",
    "in": "the folder that it runs in, of the repository",
    "status": "the exit status that it ends with",
    "file": "where the text is written to, or what its diff changes, for the blocks that follow",
    "fragment": "what a part of a model stands in, where that cannot be told from its text",
}
_BETWEEN_MARKS = re.compile(rf"; (?=(?:{'|'.join(MARKS)}): )")


@dataclass(frozen=True)
class Block:
    """A fenced block: its page, line, kind (the words after the fence), text, and marks from the comment before it."""

    page: Path
    line: int
    kind: str
    text: str
    marks: dict[str, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Page and line in a readable form."""
        return f"{self.page.relative_to(ROOT).as_posix()}:{self.line}"


def blocks(page: Path) -> list[Block]:
    """Return all blocks of a page in their order."""
    text = page.read_text(encoding="utf-8")
    found = []
    for match in _BLOCK.finditer(text):
        lines = match["text"].splitlines(keepends=True)
        inner = "".join(line.removeprefix(match["indent"]) for line in lines)
        line = text.count("\n", 0, match.start("kind")) + 1
        said = (mark.partition(": ") for mark in _BETWEEN_MARKS.split(match["marks"] or "") if mark)
        found.append(Block(page, line, match["kind"].strip(), inner, {name.strip(): value for name, _, value in said}))
    return found


def without_blocks(text: str) -> str:
    """Return the text of a page without its blocks."""
    return _BLOCK.sub("", text)
