"""Skeleton of a text with syntax errors: the ranges of its definitions.

Definitions begin with keywords that are allowed nowhere else. If a definition begins in a wrong place, a brace is
missing or surplus. The outline repairs the braces; all other faults stay within one definition.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import lru_cache
from typing import TYPE_CHECKING

from robosc.language.grammar import first, first_words, following, is_reserved, last, words_of
from robosc.language.scopes import NameKind
from robosc.language.tokens import Kind, Token

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.language.tokens import Tokens


@dataclass(frozen=True)
class Level:
    """The items inside a kind of braces: a rule of the grammar, called a `noun` in messages.

    `starters` are the keywords that begin an item. `bodies` maps such a keyword to the level inside the item's braces.
    `unknown` is the most likely level inside the braces if the keyword is not recognized.
    """

    rule: str
    noun: str
    starters: frozenset[str] = frozenset()
    bodies: Mapping[str, Level] = field(default_factory=dict)
    unknown: Level | None = None

    def starter(self, token: Token) -> str | None:
        """Return the starter that is equal or similar to a token, or None if there is none."""
        if token.kind is not Kind.WORD:
            return None
        return _most_like(token.text, self.starters)


@lru_cache(1024)  # The editor looks up the same few words after each keystroke.
def _most_like(word: str, known: frozenset[str]) -> str | None:
    return next(iter(get_close_matches(word, sorted(known), n=1, cutoff=0.7)), None)


PROPERTIES = Level("ObjectProperty", "property")
RULES = Level("EnumRule", "rule", first_words("EnumRule"))
TRANSITIONS = Level("Transition", "transition", first_words("Transition"))


def _level(rule: str, noun: str, holder: str, inside: Level, also: frozenset[str] = frozenset()) -> Level:
    """Return a level in which the items of the rule `holder` contain those of another level."""
    return Level(rule, noun, first_words(rule) | also, dict.fromkeys(first_words(holder), inside), unknown=inside)


#: Recognizes a message even if its direction is missing.
_MESSAGE = frozenset({"message"})
AUTOMATON = _level("AutomatonDefinition", "variable, state or transition", "State", TRANSITIONS)
COMPONENT = _level(
    "ComponentDefinition", "message, service, action or behaviour", "ComponentBehaviour", AUTOMATON, _MESSAGE
)
DEFINITIONS = _level("Definition", "definition", "Component", COMPONENT)
_DATA_TYPES = {"object": PROPERTIES, "enum": RULES}
#: Kind of name that an item declares, by its first keyword.
DECLARED = {
    **dict.fromkeys(first_words("Component"), NameKind.COMPONENT),
    **dict.fromkeys(first_words("Interface"), NameKind.INTERFACE),
    **dict.fromkeys(first_words("ComplexDataType"), NameKind.DATA_TYPE),
    **dict.fromkeys(first_words("CommunicationType") | _MESSAGE, NameKind.COMMUNICATION),
    **dict.fromkeys(first_words("Variable", "State"), NameKind.MEMBER),
    **dict.fromkeys(first_words("NamedExpression"), NameKind.NAMED),
}
_STARTERS = frozenset().union(*(level.starters for level in (RULES, AUTOMATON, COMPONENT, DEFINITIONS)))
#: Starters that can continue an item, and the starters after which they do.
_CONTINUED = {word: tuple(before for before in _STARTERS if word in following()[before]) for word in _STARTERS}
#: Keywords and braces that can follow the first keyword of an item.
_SECOND = {
    word
    for starter in _STARTERS
    for word in following()[starter] - first("Expression")
    if word == "{" or (word.isalpha() and word.islower())
}
#: Keywords and symbols that cannot end an item. (A colon can end one by the grammar alone: `send:`.)
_INSIDE = (
    {word.partition("(?!")[0] for word in words_of("Base")}
    - last(*(level.rule for level in (PROPERTIES, RULES, TRANSITIONS, AUTOMATON, COMPONENT, DEFINITIONS)))
    - {"{"}
) | {":"}


@dataclass(frozen=True)
class Block:
    """One item of a level, or the whole text (`level` is None): its range of tokens and its offsets.

    `items` are the items inside its braces.
    """

    level: Level | None
    first: int
    after: int
    start: int
    end: int
    items: tuple[Block, ...] = ()
    levels: tuple[Level, ...] = ()


@dataclass(frozen=True)
class Brace:
    """A brace that is missing before a token, or a token that is a surplus brace (`surplus`).

    `offset` is a blank of the text that the missing brace can replace, or None if there is no blank. `opened` is the
    index of the brace that a missing one would close.
    """

    text: str
    index: int
    offset: int | None = None
    surplus: bool = False
    opened: int | None = None


class Outline:
    """Finds the items in a range of tokens; `braces` are the braces that it added or ignored."""

    def __init__(self, tokens: Tokens, first: int = 0, limit: int | None = None) -> None:
        self.braces: list[Brace] = []
        self._tokens = tokens
        self._at = first
        self._filled: dict[int, int] = {}
        braces = [token.text for token in tokens if token.is_keyword("{", "}")]
        self._unmatched = braces.count("{") != braces.count("}")
        self._columns = [-1]
        self._limit = len(tokens) if limit is None else limit

    @property
    def after(self) -> int:
        """Index of the first token that was not read."""
        return self._at

    def file(self) -> Block:
        """Return the block of the whole text: a robot or a library."""
        while not self._ended() and not self._starts(DEFINITIONS) and not self._is("{"):
            self._at += 1
        if self._is("{"):
            self._at += 1
        elif not self._ended():
            self._missing("{")
        items = self._body((DEFINITIONS,))
        last = self._last_starter()
        while self._at <= last:
            self.braces.append(Brace("}", self._at - 1, surplus=True))
            items += self.items((DEFINITIONS,))
            if self._is("}"):
                self._at += 1
            else:
                self._missing("}", 0)
        return Block(None, 0, self._at, 0, self._end(), items)

    def _last_starter(self) -> int:
        """Return the index of the last definition behind the brace that seemed to end the file, or -1."""
        last = -1
        for index in range(self._at, self._limit):
            if self._tokens[index].is_keyword("robot", "library"):
                break
            if self._tokens[index].is_keyword(*DEFINITIONS.starters):
                last = index
        return last

    def items(self, levels: tuple[Level, ...]) -> tuple[Block, ...]:
        """Return the items of the last level, up to the next item of an outer level."""
        items = []
        while not self._ended() and not self._is("}") and not self._leaves(levels):
            items.append(self._item(levels))
        return tuple(items)

    def _leaves(self, levels: tuple[Level, ...]) -> bool:
        """Return whether an item of an outer level begins here; if it fits both levels, its column decides.

        If the braces of the text do not match, a definition that is not indented deeper than the one around it was
        meant to stand beside it. If they match, a definition that is indented deeper does not leave the level.
        """
        if not self._outer(levels):
            return False
        token = self._tokens[self._at]
        further_in = token.is_first and token.column > self._columns[-1]
        if not self._starts(levels[-1]):
            return self._unmatched or not further_in
        return self._unmatched and token.is_first and not further_in

    def _item(self, levels: tuple[Level, ...]) -> Block:
        level, first, mended = levels[-1], self._at, len(self.braces)
        starter = level.starter(self._tokens[first])
        body = self._body_level(level, starter)
        items: tuple[Block, ...] = ()
        if body is None and self._is("{"):
            self._skip(levels)
        elif not self._is("{"):
            self._at += 1
        unopened = False
        while not self._ended():
            if self._is("}"):
                if not unopened:
                    break
                unopened = False
            elif body is not None and self._opens(levels, body):
                self._columns.append(self._tokens[first].column)
                items = self._body((*levels, body))
                self._columns.pop()
                break
            elif any(self._starts(around) for around in levels):
                break
            elif self._is("{"):
                self._skip(levels)
                continue
            # A property without braces: the opening brace is missing, and its closing brace follows.
            unopened = unopened or (starter in {"provide", "limit"} and self._tokens[self._at + 1].is_keyword(":"))
            self._at += 1
        if starter is None and level.starters:
            # The contents of an unknown item cannot be checked.
            items = ()
            del self.braces[mended:]
        return Block(level, first, self._at, self._tokens[first].start, self._end(), items, levels)

    def _opens(self, levels: tuple[Level, ...], body: Level) -> bool:
        """Return whether the braces of an item open here; read the brace, or record that it is missing."""
        if self._is("{") and not self._tokens[self._at - 1].is_keyword("with"):
            self._at += 1
            while self._is("{"):
                self.braces.append(Brace("{", self._at, surplus=True))
                self._at += 1
            return True
        begins = body is RULES and self._tokens[self._at - 1].is_keyword("to")
        begins = begins and not self._tokens[self._at + 1].is_keyword("{")
        if begins or (self._starts(body) and not self._starts(levels[0])):
            self._missing("{")
            return True
        return False

    def _body(self, levels: tuple[Level, ...]) -> tuple[Block, ...]:
        """Return the items between an opening brace, already read, and its closing brace, which is read too."""
        opened = self._at - 1
        items = self.items(levels)
        while self._is("}"):
            self._at += 1
            if not self._starts(levels[-1]) or self._outer(levels):
                return items
            self.braces.append(Brace("}", self._at - 1, surplus=True))
            items += self.items(levels)
        self._missing("}", opened)
        return items

    def _body_level(self, level: Level, starter: str | None) -> Level | None:
        if starter == "datatype":
            kind = self._tokens[self._at + 1].text
            return _DATA_TYPES.get(next(iter(get_close_matches(kind, sorted(_DATA_TYPES), n=1)), ""))
        return level.bodies.get(starter) if starter else level.unknown

    def _skip(self, levels: tuple[Level, ...]) -> None:
        """Move behind a pair of braces without items, such as those of an object value."""
        depth = 0
        while not self._ended():
            doubled = depth and self._is("{") and self._tokens[self._at - 1].is_keyword("{")
            depth += (self._is("{") and not doubled) - self._is("}")
            self._at += 1
            if depth == 0 or any(self._starts(around) for around in levels if around.starters):
                return

    def _outer(self, levels: tuple[Level, ...]) -> bool:
        return any(self._starts(around) for around in levels[:-1])

    def _starts(self, level: Level) -> bool:
        """Return whether an item of a level begins at the current token."""
        tokens, at = self._tokens, self._at
        named = tokens[at + 1].is_keyword(":")
        if level is PROPERTIES:
            return tokens[at].kind is Kind.WORD and named
        named_value = tokens[at - 1].kind is Kind.WORD and not self._is_starter(RULES, at - 1)
        if level is RULES and tokens[at - 2].is_keyword("->") and named_value:
            return not self._is("}") and not tokens[at].is_keyword(*DEFINITIONS.starters)
        if named or not (self._is_starter(level, at) or self._misspelt(level)):
            return False
        if tokens[at].text == "message" and not tokens[at].is_first:
            return False
        if self._is_named(at):
            return False
        return not self._continues(level, _CONTINUED.get(tokens[at].text, ()))

    def _is_starter(self, level: Level, at: int) -> bool:
        """Return whether a token is a starter.

        At the start of a line it is one even if a name is missing before it.
        """
        token, after = self._tokens[at], self._tokens[at + 1]
        if token.text in level.starters and not is_reserved(token.text):
            # Counts as a keyword only before a name or a number, and not as a name in an expression.
            named = after.kind is Kind.NUMBER or (after.kind is Kind.WORD and not is_reserved(after.text))
            unfinished = after.kind is Kind.END and token.is_first
            return (named or unfinished) and not token.is_name
        return token.is_keyword(*level.starters) or (token.is_name and token.is_first and token.text in level.starters)

    def _continues(self, level: Level, starters: tuple[str, ...]) -> bool:
        """Return whether the previous token is one of these keywords, or misspells one in the same line."""
        token, before = self._tokens[self._at], self._tokens[self._at - 1]
        misspelt = before.is_first and not token.is_first and level.starter(before) in starters
        return (before.is_keyword(*starters) and not self._is_named(self._at - 1)) or misspelt

    def _is_named(self, at: int) -> bool:
        """Return whether an apparent keyword is a name because an item continues before or behind it."""
        token, before, after = self._tokens[at], self._tokens[at - 1], self._tokens[at + 1]
        goes_on = before.is_keyword(*_INSIDE) or self._tokens[at - 2].is_keyword("most")
        return after.is_keyword(",", ".", ":=") or (not token.is_first and goes_on)

    def _misspelt(self, level: Level) -> bool:
        """Return whether a line begins like an item with a misspelled starter."""
        token, after = self._tokens[self._at], self._tokens[self._at + 1]
        if not token.is_first or token.is_name or level.starter(token) is None or is_reserved(token.text):
            return False
        return after.text in _SECOND or (after.kind is Kind.WORD and not is_reserved(after.text))

    def _missing(self, brace: str, opened: int | None = None) -> None:
        token = self._tokens[self._at]
        offset = self._end()
        # The end of the text has room for any number of braces.
        free = offset < token.start or token.kind is Kind.END
        self.braces.append(Brace(brace, self._at, offset if free else None, opened=opened))
        if free:
            self._filled[self._at] = offset + 1

    def _is(self, symbol: str) -> bool:
        return not self._ended() and self._tokens[self._at].is_keyword(symbol)

    def _ended(self) -> bool:
        return self._at >= self._limit

    def _end(self) -> int:
        """Return the end of the text before the current token, including a brace that was added there."""
        return max(self._tokens[self._at - 1].end if self._at else 0, self._filled.get(self._at, 0))
