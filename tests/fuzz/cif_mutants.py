"""CIF specifications with a few faults: tokens of random specifications and of test cases, dropped, doubled, swapped.

Some files end early or contain bytes that are not valid text.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from random import Random
from typing import TYPE_CHECKING

from tests.fuzz.mutants import HOSTILE, ROOT
from tests.language.cif.random_specifications import Specification

if TYPE_CHECKING:
    from collections.abc import Callable

#: A token with the blanks and comments before it.
_TOKEN = re.compile(
    r"(?:\s|//[^\n]*(?:\n|$)|/\*[\s\S]*?\*/)*"
    r"(?:[.^]?[$\w]+(?:\.[$\w]+)*|\"(?:[^\"\n\\]|\\.)*\"|:=|=>|<=>|!=|<=|>=|\.\.|\S)"
)
_BLOCK = re.compile(r"^```cif\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: Bytes that are invalid UTF-8, end a string in C, or begin a text in another encoding.
_GARBAGE = (b"\xff", b"\x00", b"\xc3(", b"\xef\xbb\xbf", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\x1a", b"\r")
#: First words of constructs, which a mutation inserts at a wrong place.
_WORDS = (
    *("plant", "requirement", "supervisor", "invariant", "needs", "disables", "location", "edge", "goto", "end", "tau"),
    *(
        "initial",
        "marked",
        "monitor",
        "alphabet",
        "equation",
        "input",
        "disc",
        "alg",
        "const",
        "enum",
        "type",
        "import",
    ),
    *("if", "switch", "case", "else", "elif", "not", "self", "any", "in", "min", "abs", "div", "mod", "int", "bool"),
    *(
        "group",
        "def",
        "func",
        "cont",
        "real",
        "list",
        "event",
        "urgent",
        "now",
        "time",
        "print",
        "svgfile",
        "namespace",
    ),
    *("(", ")", "[", "]", "{", "}", ";", ",", ":", ":=", "..", "=", "!", "?", "@", "$", "-", "2147483648", "0", "1.5"),
)


@cache
def _small() -> list[str]:
    """Return the specifications within the tests and the pages of the documentation."""
    found = []
    for module in sorted((ROOT / "tests" / "language" / "cif").glob("test_*.py")):
        nodes = ast.walk(ast.parse(module.read_text(encoding="utf-8")))
        texts = (node.value for node in nodes if isinstance(node, ast.Constant))
        found += [text for text in texts if isinstance(text, str) and "location" in text]
    for page in sorted((ROOT / "docs").rglob("*.md")):
        found += _BLOCK.findall(page.read_text(encoding="utf-8"))
    return found


def cif_mutant(seed: int) -> dict[str, bytes]:
    """Return the files of a specification with one to four faults in one of them; the first file imports the others."""
    random = Random(seed)  # noqa: S311 - nothing here is secret
    if random.random() < 0.3:
        files = {"random.cif": random.choice(_small())}
    else:
        files = Specification(random.randrange(10**6), narrow=random.random() < 0.3).files
    mutated = random.choice(list(files))
    tokens = _TOKEN.findall(files[mutated])
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 4))):
        if tokens:
            random.choice(_MUTATIONS)(tokens, random)
    content = "".join(tokens).encode()
    if random.random() < 0.08:
        at = random.randrange(len(content) + 1)
        content = content[:at] + random.choice(_GARBAGE) + content[at:]
    return {name: content if name == mutated else text.encode() for name, text in files.items()}


def _drop(tokens: list[str], random: Random) -> None:
    at = random.randrange(len(tokens))
    del tokens[at : at + random.choice((1, 1, 1, 2, 6))]


def _double(tokens: list[str], random: Random) -> None:
    at = random.randrange(len(tokens))
    after = at + random.choice((1, 1, 2, 20))
    tokens[after:after] = tokens[at:after]


def _swap(tokens: list[str], random: Random) -> None:
    first, second = random.randrange(len(tokens)), random.randrange(len(tokens))
    tokens[first], tokens[second] = tokens[second], tokens[first]


def _replace(tokens: list[str], random: Random) -> None:
    tokens[random.randrange(len(tokens))] = random.choice(tokens)


def _exchange(tokens: list[str], random: Random) -> None:
    tokens[random.randrange(len(tokens))] = f" {random.choice(_WORDS)} "


def _insert(tokens: list[str], random: Random) -> None:
    at = random.randrange(len(tokens))
    tokens[at:at] = [f" {random.choice(_WORDS)} "] * random.choice((1, 1, 1, 300))


def _cut_off(tokens: list[str], random: Random) -> None:
    del tokens[random.randrange(len(tokens)) :]


def _say_hostile(tokens: list[str], random: Random) -> None:
    at = random.randrange(len(tokens))
    said = random.choice(HOSTILE)
    tokens[at] += random.choice((said, f" // {said}\n", f'"{said}"'))


def _names(tokens: list[str]) -> list[int]:
    """Return the indices of names, including qualified names."""
    found = [
        (place, re.fullmatch(r"[.^]?[$\w]+(?:\.[$\w]+)*", token.split()[-1])) for place, token in enumerate(tokens)
    ]
    return [place for place, name in found if name and not name[0].isdigit() and name[0] not in _WORDS]


def _name_alike(tokens: list[str], random: Random) -> None:
    """Give one thing the name of another, so that a name is declared twice or used in its own declaration."""
    if len(places := _names(tokens)) > 1:
        near = random.random() < 0.5
        first = random.randrange(len(places))
        second = min(first + random.randint(1, 4), len(places) - 1) if near else random.randrange(len(places))
        tokens[places[first]] = f" {tokens[places[second]].split()[-1]} "


def _name_its_space(tokens: list[str], random: Random) -> None:
    """Put the file into a namespace with the name of another thing."""
    if places := _names(tokens):
        names = [tokens[random.choice(places)].split()[-1].lstrip(".^") for _ in range(random.choice((1, 1, 2, 3)))]
        place = random.choice((0, 0, random.choice(places)))
        tokens[place:place] = [f" namespace {'.'.join(names)}; "]


def _annotate(tokens: list[str], random: Random) -> None:
    name = random.choice(("@doc", "@@doc", "@requirement:reachable", "@@requirement:later", "@other:one"))
    arguments = random.choice(("", "(true)", '("x")'))
    at = random.randrange(len(tokens))
    tokens[at:at] = [f" {name}{arguments} "]


#: Mutations of which the text stays parsable occur more often.
_MUTATIONS: list[Callable[[list[str], Random], None]] = [
    *[_drop, _double, _swap, _replace] * 3,
    *[_name_alike] * 6,
    *[_replace, _exchange, _insert, _cut_off, _say_hostile, _name_its_space, _annotate],
]
