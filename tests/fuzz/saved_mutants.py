"""Saved models with a few faults: wrong, doubled and missing references, extreme values, names of other files."""

from __future__ import annotations

import re
from functools import cache
from random import Random
from typing import TYPE_CHECKING

import robosc
from robosc.analysis.supervise import supervise
from robosc.m2t import xmi
from robosc.m2t.models import Models
from tests.fuzz.mutants import EDGES, HOSTILE, LIBRARIES, ROOT

if TYPE_CHECKING:
    from collections.abc import Callable

#: Models with messages, services and actions, computed data, and a library.
MODELS = (
    "examples/line_follower/line_follower.rscd",
    "examples/obstacle_navigation/obstacle_navigation.rscd",
    "tests/m2t/cpp/courier.rscd",
    "tests/model/warehouse.rscd",
)
#: Content of a file beside the folder of the models, which no output may contain.
UNTOLD = "what nobody may read"
#: Files that a model must not name.
_FILES = (
    "../secret.txt",
    "/proc/self/environ",
    "/dev/zero",
    "/proc/kmsg",
    "/dev/stdin",
    "pipe",
    "C:\\x",
    "",
    "a\0b",
    "..",
)
_ATTRIBUTE = re.compile(r'(?<= )([\w:]+)="([^"]*)"')
_ELEMENT = re.compile(r"^ +<\w+(?: [^<>]*)?/>\n", re.MULTILINE)
_PLACE = re.compile(r'(?<= )(source|file|origin|text|href|name)="([^"]*)"')


@cache
def saved(model: str) -> dict[str, str]:
    """Return the files that `transform --to xmi` writes for a model: name to text."""
    robot = robosc.load(ROOT / model, [LIBRARIES])
    assert isinstance(robot, robosc.model.robosc.Robot)
    models = Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    supervise(models.sct)
    files = xmi.generate(models, robosc.Configuration())
    return {name: text for name, text in files.items() if name.endswith(".xmi")}


def saved_mutant(seed: int) -> tuple[str, dict[str, str]]:
    """Return the name of a file with one to three faults, and all files of its model; deterministic for a seed."""
    random = Random(seed)  # noqa: S311 - nothing here is secret
    files = dict(saved(random.choice(MODELS)))
    own = [name for name in sorted(files) if "Library" not in name]
    name = random.choice(random.choice((own, own, sorted(files))))
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        files[name] = random.choice(_MUTATIONS)(files[name], random)
    return name, files


def _one(pattern: re.Pattern[str], text: str, random: Random) -> re.Match[str] | None:
    found = list(pattern.finditer(text))
    return random.choice(found) if found else None


def _set(text: str, match: re.Match[str] | None, value: str) -> str:
    """Set the value of an attribute, escaped as a writer does; characters that XML forbids stay unescaped."""
    if match is None:
        return text
    escaped = value.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;").replace("\r", "&#13;")
    return text[: match.start(2)] + escaped + text[match.end(2) :]


def _bend(text: str, random: Random) -> str:
    """Change a reference: to another element, twice to the same element, or to a missing one."""
    references = re.compile(r'(?<= )([\w:]+)="([^"]*//@[^"]*)"')
    here = _one(references, text, random)
    if here is None:
        return text
    shape = re.sub(r"\d+", "0", here[2])
    others = [match[2].split(" ")[0] for match in references.finditer(text)]
    alike = [other for other in others if re.sub(r"\d+", "0", other) == shape]
    other, number = random.choice(random.choice((alike, others)) or others), str(random.randrange(9))
    choices = (other, f"{here[2]} {here[2]}", f"{here[2]} {other}", re.sub(r"\d+(?=\D*$)", number, here[2]), "//", "/")
    return _set(text, here, random.choice(choices))


def _double(text: str, random: Random) -> str:
    match = _one(_ELEMENT, text, random)
    return text if match is None else text[: match.end()] + match[0] * random.choice((1, 2)) + text[match.end() :]


def _drop(text: str, random: Random) -> str:
    match = _one(random.choice((_ELEMENT, _ATTRIBUTE)), text, random)
    return text if match is None else text[: match.start()] + text[match.end() :]


def _exchange(text: str, random: Random) -> str:
    """Give an attribute the value of another attribute, usually one of the same name."""
    here = _one(_ATTRIBUTE, text, random)
    if here is None:
        return text
    alike = [match[2] for match in _ATTRIBUTE.finditer(text) if match[1] == here[1] or random.random() < 0.1]
    return _set(text, here, random.choice(alike or [here[2]]))


def _edge(text: str, random: Random) -> str:
    numbers = re.compile(r'(?<= )([\w:]+)="(-?\d+|true|false|[\d.]+)"')
    choices = (str(random.choice(EDGES)), "1e400", "nan", "", "-0", "9" * 5000)
    return _set(text, _one(numbers, text, random), random.choice(choices))


def _name_a_file(text: str, random: Random) -> str:
    """Set the source of an element to a foreign file, or to a position that no file has."""
    match = _one(_PLACE, text, random)
    span = random.choice(("1:1-1:20", "1:1-1:2", "9:9-1:1", "0:0-0:0", f"{2**31}:1-{2**63}:{2**31}"))
    return _set(text, match, random.choice((f"{random.choice(_FILES)}:{span}", random.choice(_FILES), span)))


def _say_hostile(text: str, random: Random) -> str:
    match = _one(random.choice((_PLACE, _ATTRIBUTE)), text, random)
    return text if match is None else _set(text, match, f"{match[2]}{random.choice(HOSTILE)}model.rscd:1:1: error: x")


_MUTATIONS: list[Callable[[str, Random], str]] = [
    *[_bend, _double, _exchange, _name_a_file] * 2,
    *[_drop, _edge, _say_hostile],
]
