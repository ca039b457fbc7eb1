"""Models with a few faults: words of the repository's models, dropped, doubled, swapped, replaced and joined.

Some mutants have a bound at the edge of a machine integer, a ROS type, characters that a terminal or a line reader
interprets, or the whole model on one line.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

from robosc.model.semantics.naming import ROBOSC_KEYWORDS

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parents[2]
LIBRARIES = ROOT / "tests" / "language" / "checks" / "libraries"
_FOLDERS = (
    "examples",
    "robosc/stdlib",
    "tests/language/checks/accepted",
    "tests/language/checks/rejected",
    "tests/model",
    "../shared/thesis/models",
)
#: A word with the blanks and comments before it.
_WORD = re.compile(
    r"(?:\s|//[^\n]*\n|/\*[\s\S]*?\*/)*"
    r"(?:\^?\w+(?:\.\d+)?|\"[^\"\n]*\"|:=|->|=>|!=|<=|>=|\.\.|\S)"
)
#: Groups of words that can replace each other in a parsable text.
_KINDS = [
    re.compile(pattern)
    for pattern in (
        r"(?:boolean|integer|double|string|none)$",
        r"(?:and|or|=>)$",
        r"(?:=|!=|<|<=|>|>=)$",
        r"[-+*/]$",
        r"(?:request|response|error|feedback|cancel)$",
        r"(?:incoming|outgoing)$",
        r"(?:true|false)$",
        r"\d+$",
        r"\d+\.\d+$",
        rf"(?!(?:{'|'.join(sorted(ROBOSC_KEYWORDS))})$)\^?[A-Za-z_]\w*$",
    )
]
#: Bounds of machine integers, and their neighbors.
EDGES = sorted({sign * 2**bits + step for bits in (0, 8, 16, 31, 32, 63) for sign in (1, -1) for step in (-1, 0, 1)})
#: Types that ROS defines, and two undefined ones.
_ROS_TYPES = ("geometry_msgs/PoseStamped", "std_msgs/Header", "nav_msgs/Path", "std_srvs/Empty", "no_msgs/None")
#: Line ends, characters that XML forbids, invisible characters, and changes of direction; U+009B begins a terminal
#: command.
HOSTILE = ("\x85", "\u2028", "\u2029", "\ufffe", "\x9b", "\x1b[2J", "\u202e", "\u200b", "\x00", "\x7f", "\r")
_STRING = re.compile(r"\"[^\"\n]*\"$")
_COMMENT = re.compile(r"//[^\n]*\n|/\*[\s\S]*?\*/")
#: First words of statements that can be removed or moved.
_STARTERS = {"requirement", "provide", "on", "transition", "variable"}


def words(text: str) -> list[str]:
    """Split a text into words, each with the blanks and comments before it."""
    return _WORD.findall(text)


@cache
def sources(*, rejected: bool = True) -> list[list[str]]:
    """Return the words of each model in the repository, with or without the rejected ones."""
    files = [path for folder in _FOLDERS for path in sorted((ROOT / folder).rglob("*.rscd"))]
    texts = [file.read_text(encoding="utf-8") for file in files if rejected or "rejected" not in file.parts]
    for module in sorted((ROOT / "tests" / "m2m").glob("test_robosc_*.py")):
        texts += re.findall(r'"""\n(robot R \{.*?\n\})\n', module.read_text(encoding="utf-8"), flags=re.DOTALL)
    return [words(text) for text in texts]


def mutant(seed: int) -> str:
    """Return a model with one to four faults; the same seed and models give the same text."""
    random = Random(seed)  # noqa: S311 - nothing here is secret
    text = list(random.choice(sources(rejected=random.random() < 0.5)))
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 4))):
        if text:
            random.choice(_MUTATIONS)(text, random)
    return "".join(text)


def _kind(word: str) -> int:
    bare = _bare(word)
    return next((number for number, kind in enumerate(_KINDS) if kind.match(bare)), len(_KINDS))


def _bare(word: str) -> str:
    return re.split(r"\s|\*/", word)[-1]


def _replace(text: list[str], random: Random) -> None:
    at = random.choice([index for index, token in enumerate(text) if _kind(token) < len(_KINDS)] or [0])
    text[at] = random.choice([token for token in text if _kind(token) == _kind(text[at])])


def _statement(text: list[str], random: Random) -> slice:
    """Return the slice of a statement that can be removed, or an empty slice if the text has none."""
    starts = [index for index, token in enumerate(text) if _bare(token) in _STARTERS]
    if not starts:
        return slice(0, 0)
    start = random.choice(starts)
    after = (
        i for i in range(start + 1, len(text)) if _bare(text[i]) in {*_STARTERS, "}", "initial", "marked", "state"}
    )
    return slice(start, next(after, start))


def _drop_statement(text: list[str], random: Random) -> None:
    del text[_statement(text, random)]


def _move_statement(text: list[str], random: Random) -> None:
    moved = text[_statement(text, random)]
    at = _statement(text, random).start
    text[at:at] = moved


def _exchange(text: list[str], random: Random) -> None:
    text[random.randrange(len(text))] = random.choice(random.choice(sources()))


def _drop(text: list[str], random: Random) -> None:
    at = random.randrange(len(text))
    del text[at : at + random.randint(1, 6)]


def _double(text: list[str], random: Random) -> None:
    at = random.randrange(len(text))
    after = at + random.randint(1, 20)
    text[after:after] = text[at:after]


def _swap(text: list[str], random: Random) -> None:
    first, second = random.randrange(len(text)), random.randrange(len(text))
    text[first], text[second] = text[second], text[first]


def _splice(text: list[str], random: Random) -> None:
    at, donor = random.randrange(len(text)), random.choice(sources())
    start = random.randrange(len(donor))
    text[at:at] = donor[start : start + random.randint(1, 30)]


def _bound(text: list[str], random: Random) -> None:
    """Give an integer a range at the edge of a machine integer."""
    low, high = sorted(random.choices(EDGES, k=2))
    low, high = random.choice(((low, high), (0, high), (low, low + 1), (-1, high)))
    at = random.choice([index for index, word in enumerate(text) if _bare(word) == "integer"] or [0])
    if _bare("".join(text[at + 1 : at + 2])) == "(":
        after = next((index for index in range(at, len(text)) if _bare(text[index]) == ")"), at)
        del text[at + 1 : after + 1]
    text[at : at + 1] = [f" integer({low}..{high})"]


def _type_of_ros(text: list[str], random: Random) -> None:
    """Replace a type, often that of a variable, by a ROS type."""
    starts = [index + 1 for index, word in enumerate(text[:-1]) if _bare(word) == ":"]
    variables = [at for at in starts if at > 2 and _bare(text[at - 3]) == "variable"]
    text[random.choice(random.choice((variables, starts)) or starts or [0])] = f" {random.choice(_ROS_TYPES)}"


def _say_hostile(text: list[str], random: Random) -> None:
    """Insert hostile characters into a string or a name, or into a comment before a word."""
    said = random.choice(HOSTILE)
    strings = [index for index, word in enumerate(text) if _STRING.search(word)]
    at = random.choice(strings or [0])
    if strings and random.random() < 0.5:
        text[at] = f"{text[at][:-1]}{said}{text[at][-1]}"
    else:
        at = random.randrange(len(text))
        text[at] = random.choice((f"{text[at]}{said}", f" // {said}\n{text[at]}", f" /* {said} */{text[at]}"))


def _join_lines(text: list[str], random: Random) -> None:
    """Join all lines, and sometimes repeat a part of the text many times."""
    text[:] = [f" {' '.join(_COMMENT.sub(' ', word).split())}" for word in text]
    if random.random() < 0.5:
        at = random.randrange(len(text))
        text[at:at] = text[at : at + random.randint(1, 12)] * random.choice((3, 30, 300))


#: Mutations of which the text stays parsable occur more often.
_MUTATIONS: list[Callable[[list[str], Random], None]] = [
    *[_replace, _drop_statement, _move_statement] * 3,
    *[_exchange, _drop, _double, _swap, _splice],
    *[_bound, _type_of_ros, _say_hostile, _join_lines],
]
