"""No sentence begins with a word that hides its subject, and no message has a contraction."""

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
#: Messages that begin in lower case. A single word is a name.
MESSAGE = re.compile(r"\A((?:what|whatever|who|whoever|whom|whose|that which|so many|such) .*[^?])\Z", re.DOTALL)
#: Lines, headings, points and cells of Markdown. Questions are allowed.
PROSE = re.compile(rf"(?:^[ #>*-]*|\|\s*)({WORDS}(?![^\n|]*\?\s*(?:$|\|))[^\n|]*)", re.MULTILINE)
#: Texts of elements and attributes of HTML that people read. Questions are allowed.
HTML = re.compile(
    r"(?:<(?:title|h\d|p|li|th|td|dt|dd|label|button|summary)\b[^>]*>|\b(?:title|alt|aria-label|placeholder)=\")"
    rf"\s*({WORDS}[^<\"?]*)[<\"]"
)
#: Values of JSON that people read.
JSON = re.compile(rf'"(?:title|description|markdownDescription|label)"\s*:\s*"({WORDS}(?:[^"\\]|\\.)*)"')
#: Contractions, which messages do not have. `'s` is also a genitive.
CONTRACTION = re.compile(r"\b\w+(?:n't|'(?:re|ll|ve|m))\b|\b(?:it|that|there|what|who|let)'s\b", re.IGNORECASE)
#: Folders without messages to users.
TESTS = ROOT / "tests"
#: Starts of comments in files that are not Python.
COMMENT = re.compile(rf"(?://+|#:?|/\*+|^ \*|\{{#) *({WORDS}.*)", re.MULTILINE)
SUFFIXES = {
    ".py",
    ".md",
    ".hpp",
    ".c",
    ".h",
    ".j2",
    ".cmake",
    ".rscd",
    ".tx",
    ".ts",
    ".mjs",
    ".toml",
    ".yml",
    ".css",
    ".json",
    ".html",
}


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
            yield from [] if path.is_relative_to(TESTS) else MESSAGE.findall(part)
    elif path.suffix == ".md":
        prose = re.sub(r"^ *```.*?^ *```", "", text, flags=re.DOTALL | re.MULTILINE)
        yield from PROSE.findall(prose)
    elif path.suffix == ".json":
        yield from JSON.findall(text)
    elif ".html" in path.suffixes:
        yield from [*HTML.findall(text), *COMMENT.findall(text)]
    else:
        yield from COMMENT.findall(text)


def strings(text: str) -> Iterator[str]:
    """Yield the strings of a Python text."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def messages(path: Path) -> Iterator[str]:
    """Yield the strings of a file without docstrings, and of C++ and JSON each text between quotes of a line."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        tree = ast.parse(text)
        docstrings = {node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in docstrings:
                yield node.value
    elif path.suffix in {".hpp", ".h", ".c", ".j2", ".json", ".html", ".ts"}:
        yield from re.findall(r'"[^"\n]*"', text)


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


def test_no_message_has_a_contraction() -> None:
    own = (path for path in files() if not path.is_relative_to(TESTS))
    wrong = [f"{path.relative_to(ROOT)}: {text}" for path in own for text in messages(path) if CONTRACTION.search(text)]
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


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("a.md", "| part | What it does |", ["What it does "]),
        ("a.md", "| What would help? | a reason |", []),
        ("a.md", "## What can happen", ["What can happen"]),
        ("a.py", 'print("what the node sends")', ["what the node sends"]),
        ("a.py", 'print("what", "what?", "the state of what runs")', []),
        ("a.json", '{"title": "What a node publishes", "what": "Such"}', ["What a node publishes"]),
        ("a.html", '<h2 id="events">What can happen</h2> <a title="Of events">', ["What can happen", "Of events"]),
        ("a.html.j2", "<summary>What would help?</summary>", []),
    ],
)
def test_a_file(tmp_path: Path, name: str, text: str, expected: list[str]) -> None:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    assert list(sentences(path)) == expected
