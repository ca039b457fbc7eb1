"""Models with a few faults: words of the repository's own models dropped, doubled, swapped, replaced and joined."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

from robosc.naming import ROBOSC_KEYWORDS

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parents[2]
LIBRARIES = ROOT / "tests" / "checks" / "libraries"
_FOLDERS = (
    "examples",
    "robosc/stdlib",
    "tests/checks/accepted",
    "tests/checks/rejected",
    "tests/metamodel",
    "../shared/thesis/models",
)
#: A word with the blanks and comments before it.
_WORD = re.compile(
    r"(?:\s|//[^\n]*\n|/\*[\s\S]*?\*/)*"
    r"(?:\^?\w+(?:\.\d+)?|\"[^\"\n]*\"|:=|->|=>|!=|<=|>=|\.\.|\S)"
)
#: Words that take each other's place in a text that can still be read.
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
#: What statements begin with that can be missing, or stand elsewhere.
_STARTERS = {"requirement", "provide", "on", "transition", "variable"}


def words(text: str) -> list[str]:
    """The text cut up, each word with what stands before it."""
    return _WORD.findall(text)


@cache
def sources(*, rejected: bool = True) -> list[list[str]]:
    """The words of each model that is there, with those that show faults or without."""
    files = [each for folder in _FOLDERS for each in sorted((ROOT / folder).rglob("*.rscd"))]
    texts = [each.read_text(encoding="utf-8") for each in files if rejected or "rejected" not in each.parts]
    for module in sorted((ROOT / "tests" / "m2m").glob("test_robosc_*.py")):
        texts += re.findall(r'"""\n(robot R \{.*?\n\})\n', module.read_text(encoding="utf-8"), flags=re.DOTALL)
    return [words(each) for each in texts]


def mutant(seed: int) -> str:
    """The text of a model with one to four faults, the same for the same seed and models."""
    random = Random(seed)  # noqa: S311 - nothing here is secret
    text = list(random.choice(sources(rejected=random.random() < 0.5)))
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 4))):
        if text:
            random.choice(_MUTATIONS)(text, random)
    return "".join(text)


def _kind(word: str) -> int:
    bare = _bare(word)
    return next((number for number, each in enumerate(_KINDS) if each.match(bare)), len(_KINDS))


def _bare(word: str) -> str:
    return re.split(r"\s|\*/", word)[-1]


def _replace(text: list[str], random: Random) -> None:
    at = random.choice([index for index, each in enumerate(text) if _kind(each) < len(_KINDS)] or [0])
    text[at] = random.choice([each for each in text if _kind(each) == _kind(text[at])])


def _statement(text: list[str], random: Random) -> slice:
    """Where a statement stands that could be missing; nowhere where there is none."""
    starts = [index for index, each in enumerate(text) if _bare(each) in _STARTERS]
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
    one, other = random.randrange(len(text)), random.randrange(len(text))
    text[one], text[other] = text[other], text[one]


def _splice(text: list[str], random: Random) -> None:
    at, donor = random.randrange(len(text)), random.choice(sources())
    start = random.randrange(len(donor))
    text[at:at] = donor[start : start + random.randint(1, 30)]


#: Those that leave a text that can be read to its end come more often.
_MUTATIONS: list[Callable[[list[str], Random], None]] = [
    *[_replace, _drop_statement, _move_statement] * 3,
    *[_exchange, _drop, _double, _swap, _splice],
]
