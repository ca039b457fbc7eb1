"""Tokens of a text, used to bound its complexity, and to report and recover from syntax errors.

The parser matches regular expressions at offsets. Only the active rule distinguishes a keyword from a name.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from enum import Enum, auto
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from robosc.language.grammar import first, first_words, following, is_reserved, pattern, words_of
from robosc.model.semantics.naming import ROBOSC_QUANTIFIERS

if TYPE_CHECKING:
    from collections.abc import Iterator

_TOKEN = re.compile(
    rf"""[ \t\n\r]+|(?P<COMMENT>{pattern("Comment")})
    |(?P<OPEN_COMMENT>/\*[\s\S]*)
    |(?P<WORD>\^?[^\W\d]\w*)
    |(?P<NUMBER>\d+(?:\.\d+)?\w*)
    |(?P<STRING>{pattern("String")})
    |(?P<OPEN_STRING>["'][^\n]*)
    |(?P<SYMBOL>:=|->|=>|=<|==|!=|<=|>=|<>|&&|\|\||\.\.|[\s\S])
    """,
    re.VERBOSE,
)

#: Words that only a name can follow, even if it looks like a keyword.
_BEFORE_NAMES = tuple(word for word, others in following().items() if others == {"Name"})
#: Words after which a preposition and the communication of an event follow.
_EVENTS = tuple(words_of("ResultType"))


class Kind(Enum):
    """Kind of a token."""

    WORD = auto()
    NUMBER = auto()
    STRING = auto()
    SYMBOL = auto()
    OPEN_STRING = auto()
    OPEN_COMMENT = auto()
    END = auto()


#: Looking a kind up in the enumeration would cost more than matching a token.
_KINDS = Kind.__members__


class Token(NamedTuple):
    """A word, number, string or symbol, with its offsets.

    `is_name` marks a name that may look like a keyword. `is_first` marks the first token of a line. `column` counts
    from 0.
    """

    kind: Kind
    text: str
    start: int
    end: int
    is_name: bool = False
    is_first: bool = False
    column: int = 0

    def is_keyword(self, *words: str) -> bool:
        """Return whether it is one of these words or symbols, and not an equal name."""
        return self.text in words and self.kind in {Kind.WORD, Kind.SYMBOL} and not self.is_name


class Tokens:
    """Tokens of a text without blanks and comments. The last one is the end of the text.

    `comments` holds the offsets of the comments.
    """

    def __init__(self, text: str) -> None:
        self.comments: list[tuple[int, int]] = []
        self._tokens = list(_tokens(text, self.comments))

    def __getitem__(self, index: int) -> Token:
        """Return the token at an index, or the end of the text if the index is past it."""
        return self._tokens[min(index, len(self._tokens) - 1)]

    def __len__(self) -> int:
        return len(self._tokens) - 1

    def __iter__(self) -> Iterator[Token]:
        return iter(self._tokens[:-1])

    @cached_property
    def _starts(self) -> list[int]:
        return [token.start for token in self._tokens]

    def runs(self, first: int, last: int) -> list[tuple[int, int]]:
        """Return the offsets of the tokens from one index to another, inclusive, split at comments."""
        start, end = self[first].start, self[last].end
        ranges: list[tuple[int, int]] = []
        for comment in self.comments[bisect_left(self.comments, (start, 0)) : bisect_left(self.comments, (end, 0))]:
            behind = self.index_at(comment[0])
            if self[behind].start != start:  # several comments can stand between two tokens
                ranges.append((start, self[behind - 1].end))
                start = self[behind].start
        return [*ranges, (start, end)]

    def has_comment(self, start: int, end: int) -> bool:
        """Return whether a comment begins between two offsets."""
        return bisect_left(self.comments, (start, 0)) < bisect_left(self.comments, (end, 0))

    def index_at(self, offset: int) -> int:
        """Return the index of the token that contains an offset, or of the first one after it."""
        index = max(bisect_right(self._starts, offset) - 1, 0)
        return index if offset < self[index].end else min(index + 1, len(self))


def _tokens(text: str, comments: list[tuple[int, int]]) -> Iterator[Token]:
    previous, start_of_line = Token(Kind.END, "", 0, 0), 0
    is_use = names_follow = False
    for match in _TOKEN.finditer(text):
        if match.lastgroup is None:
            continue
        if match.lastgroup == "COMMENT":
            comments.append(match.span())
            continue
        kind, (start, end) = _KINDS[match.lastgroup], match.span()
        word = text[start:end]
        line = text.rfind("\n", previous.end, start) if start > previous.end else -1
        if line >= 0:
            start_of_line = line + 1
        is_named = previous.is_keyword(*_BEFORE_NAMES) and not is_use
        is_name = kind is Kind.WORD and (word[0] == "^" or is_named)
        token = Token(kind, word, start, end, is_name, line >= 0, start - start_of_line)
        # A keyword that can only be the name of an element declared elsewhere is not followed by a name.
        is_use, names_follow = names_follow and line < 0, _names_follow(previous, token)
        previous = token
        yield token
    # The end is placed right after the last token, where readers look for missing text.
    yield Token(Kind.END, "", previous.end, previous.end)


def _names_follow(before: Token, token: Token) -> bool:
    """Return whether only a name can follow a token in its line because of the token before it."""
    if token.is_keyword("from", "to"):
        return before.is_keyword(*_EVENTS)
    if token.kind is Kind.NUMBER:
        return before.is_keyword("most")
    return token.is_keyword("without") or (token.text == "." and before.kind is Kind.WORD)


def is_name(word: str) -> bool:
    """Return whether a word can be a name, if necessary with a `^` before it."""
    return re.fullmatch(pattern("Name"), word) is not None


#: Limits: nesting levels of brackets, signs, choices (`if … then … else if …`) and quantifiers, and operators of one
#: expression. The passes over the model recurse for each level, and Python bounds the recursion depth.
DEEPEST = 50
LONGEST = 5000
_STARTERS = frozenset(filter(is_reserved, first_words("Definition", "ComponentDefinition", "AutomatonDefinition")))
_OPERATORS = frozenset(word.partition("(")[0] for word in first("BinaryExpression"))
#: Words and symbols after which no expression continues.
_BETWEEN_EXPRESSIONS = frozenset(following()) - words_of("Expression") - _OPERATORS


def too_complex(tokens: Tokens, first: int = 0, after: int | None = None) -> tuple[int, str] | None:
    """Return the index of the first token that exceeds a limit, and the message, or None."""
    depth, operators = _Depth(), 0
    for index in range(first, len(tokens) if after is None else after):
        token = tokens[index]
        if depth.at(tokens, index) > DEEPEST:
            return index, f"this is nested more than {DEEPEST} levels deep"
        if token.text in _BETWEEN_EXPRESSIONS and token.is_keyword(token.text):
            operators = 0
        elif token.text in _OPERATORS and token.is_keyword(token.text):
            operators += 1
            if operators > LONGEST:
                return index, f"this expression has more than {LONGEST} operators"
    return None


class _Depth:
    """Levels around a token: brackets, signs before it, and the choices and quantifiers that contain it."""

    def __init__(self) -> None:
        #: Per open bracket: the levels around it, and the choices and quantifiers among them.
        self._around: list[tuple[int, int]] = []
        self._outside = self._signs = self._bodies = 0

    def at(self, tokens: Tokens, index: int) -> int:
        """Return the levels around the next token."""
        token = tokens[index]
        if token.is_keyword("(", "[", "{"):
            self._around.append((self._outside, self._bodies))
            self._outside += self._signs + self._bodies + 1
            self._signs = self._bodies = 0
        elif token.is_keyword("!", "-", "not"):
            self._signs += 1
        else:
            self._signs = 0
            self._go_on(tokens, index)
        return self._outside + self._signs + self._bodies

    def _go_on(self, tokens: Tokens, index: int) -> None:
        token = tokens[index]
        if token.is_keyword(")", "]", "}") and self._around:
            self._outside, self._bodies = self._around.pop()
        elif token.text in _STARTERS and token.is_keyword(token.text):
            self._around.clear()  # A missing closing brace must not make all later tokens deep.
            self._outside = self._bodies = 0
        elif token.text == "," or (token.text in _BETWEEN_EXPRESSIONS and token.is_keyword(token.text)):
            self._bodies = 0
        elif token.is_keyword("then") or _is_quantifier(tokens, index):
            self._bodies += 1


def _is_quantifier(tokens: Tokens, index: int) -> bool:
    """Return whether a condition on elements or instances begins here."""
    is_word = tokens[index].text in ROBOSC_QUANTIFIERS and tokens[index + 1].kind is Kind.WORD
    return is_word and tokens[index + 2].text in {"in", ":"}
