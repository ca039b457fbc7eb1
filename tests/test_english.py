"""No sentence of comments, docstrings, messages and pages begins with a word that hides its subject."""

from __future__ import annotations

import ast
import io
import re
import subprocess
import tokenize
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[1]
#: First words of sentences without a subject in its usual place.
WORDS = r"(?:What|Whatever|Who|Whoever|Whom|Whose|That which|Of|So many|Nobody|Such)\b"
#: Place of a first word: the start of a text or a paragraph, or the end of a sentence. Questions are allowed.
SENTENCE = re.compile(rf"(?:\A|\n\n|[.:?!]\s+)\s*({WORDS}[^.?!]*)(?![^.?!]*\?)(?:[.!]|\Z)")
#: Starts of comments in files that are not Python.
COMMENT = re.compile(rf"(?://+|#:?|/\*+|^ \*|\{{#) *({WORDS}.*)", re.MULTILINE)
SUFFIXES = {".py", ".md", ".hpp", ".c", ".h", ".j2", ".cmake", ".rscd", ".tx", ".ts", ".mjs", ".toml", ".yml", ".css"}


def files() -> list[Path]:
    """Return the files of the repository that people write, without generated and golden ones."""
    done = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip("the files are not in a repository of git")
    return [path for path in map(ROOT.joinpath, done.stdout.splitlines()) if path.suffix in SUFFIXES and path.is_file()]


def sentences(path: Path) -> Iterator[str]:
    """Yield the sentences of a file that begin with a word of the list."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        for part in [*strings(text), *comments(text)]:
            yield from SENTENCE.findall(part)
    elif path.suffix == ".md":
        prose = re.sub(r"^ *```.*?^ *```", "", text, flags=re.DOTALL | re.MULTILINE)
        yield from re.findall(rf"^[ #>*|-]*({WORDS}(?![^\n]*\?$).*)", prose, re.MULTILINE)
    else:
        yield from COMMENT.findall(text)


def strings(text: str) -> Iterator[str]:
    """Yield the strings of a Python text."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def comments(text: str) -> Iterator[str]:
    """Yield the comments of a Python text, without their marks; lines of one comment are joined."""
    joined: list[str] = []
    last = 0
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            words = token.string.lstrip("#: ")
            if joined and token.start[0] == last + 1:
                joined[-1] += f" {words}"
            else:
                joined.append(words)
            last = token.start[0]
    yield from joined


def test_no_sentence_hides_its_subject() -> None:
    others = (path for path in files() if path != Path(__file__))
    wrong = [f"{path.relative_to(ROOT)}: {sentence}" for path in others for sentence in sentences(path)]
    assert wrong == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Edges of an event.", []),
        ("What an event does.", ["What an event does"]),
        ("Edges. Of two edges, the first.", ["Of two edges, the first"]),
        ("What would help?", []),
    ],
)
def test_a_sentence(text: str, expected: list[str]) -> None:
    assert SENTENCE.findall(text) == expected
