"""Variants of a model: its constants and parameters with other values."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import product
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Edit
from robosc.base.files.resources import locate
from robosc.base.ros_types import RosTypes
from robosc.language import cif
from robosc.language.checks.definitions import components, statements
from robosc.language.cif.faults import span
from robosc.language.cif.parsing import parse
from robosc.language.cif.scopes import plain
from robosc.language.grammar import Failure
from robosc.language.grammar import parse as parse_rule
from robosc.language.reading import read
from robosc.language.syntax_messages import did_you_mean
from robosc.language.text import Text
from robosc.model import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.base.diagnostics import Span
    from robosc.tools.cli.options import Paths

_RANGE = re.compile(r"\s*(-?\d+)\.\.(-?\d+)\s*")
#: A number that is an expression of both languages.
_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)")
#: Maximum number of whole numbers in a range, and of jobs.
MOST = 1_000_000


class SettingError(Exception):
    """Setting of a name to values that is invalid, or that does not fit a model."""


@dataclass(frozen=True)
class _Declared:
    """Place of the value of a constant or parameter."""

    text: Text
    span: Span


def whole_numbers(text: str) -> list[int]:
    """Return the numbers of a range such as `1..100`. Raises SettingError."""
    bounds = _RANGE.fullmatch(text)
    if bounds is None:
        raise SettingError(f"{text}: write the first and the last number, such as 1..100")
    low, high = int(bounds[1]), int(bounds[2])
    if not 0 <= high - low < MOST:
        raise SettingError(f"{text}: the last number is at least the first, and the range has at most {MOST:,}")
    return list(range(low, high + 1))


def _values(text: str) -> list[str]:
    """Return the values between the commas of a text. Brackets and strings may contain commas."""
    values = [""]
    depth, is_string, is_escaped = 0, False, False
    for character in text:
        if character == "," and depth <= 0 and not is_string:
            values.append("")
            continue
        values[-1] += character
        if is_string:
            is_string = is_escaped or character != '"'
            is_escaped = not is_escaped and character == "\\"
        elif character == '"':
            is_string = True
        else:
            depth += (character in "([{") - (character in ")]}")
    return values


def is_shipped(path: str) -> bool:
    """Return whether a file belongs to the libraries of the tool, which every worker has."""
    return Path(path).resolve().is_relative_to(locate("stdlib").resolve())


def combinations(settings: Sequence[str]) -> list[dict[str, str]]:
    """Return all combinations of the values in settings `NAME=a,b,c` or `NAME=1..5`. Raises SettingError."""
    named: dict[str, list[str]] = {}
    faults = []
    for setting in settings:
        name, _, values = setting.partition("=")
        is_range = _RANGE.fullmatch(values) is not None
        try:
            parts = list(map(str, whole_numbers(values))) if is_range else _values(values)
        except SettingError as error:
            faults.append(str(error))
            continue
        parts = [part.strip() for part in parts]
        if not name.strip() or not parts or not all(parts):
            faults.append(f"{setting}: write NAME=VALUE,VALUE, such as number=1,2,3 or number=1..3")
        elif name.strip() in named:
            faults.append(f"{setting}: {name.strip()} is set twice; write all values after one =")
        else:
            named[name.strip()] = list(dict.fromkeys(parts))
    if faults:
        raise SettingError("\n".join(faults))
    require_at_most(prod(map(len, named.values())))
    return [dict(zip(named, values, strict=True)) for values in product(*named.values())]


def require_at_most(jobs: int) -> None:
    """Raise SettingError if a sweep would have more jobs than `MOST`."""
    if jobs > MOST:
        raise SettingError(f"the sweep would have {jobs:,} jobs, and at most {MOST:,} are possible; use fewer values")


def replaced(path: str, paths: Paths, variants: Sequence[Mapping[str, str]]) -> list[dict[str, str]]:
    """Return the changed texts of a model for each variant, by the paths of their files.

    A name is that of a constant or parameter of the model or of a file that it imports, or `Component.name` inside a
    component or automaton. Raises SettingError for all names with none or several, and for all values that are no
    expressions. Raises OSError.
    """
    declared: dict[str, list[_Declared]] = {}
    for name, place in _cif(path) if path.endswith(".cif") else _rscd(path, paths):
        declared.setdefault(name, []).append(place)
    places: dict[str, _Declared] = {}
    faults = []
    is_expression = _is_cif_expression if path.endswith(".cif") else _is_rscd_expression
    for name in dict.fromkeys(name for variant in variants for name in variant):
        try:
            places[name] = _only(path, name, declared)
        except SettingError as error:
            faults.append(str(error))
        for value in dict.fromkeys(variant[name] for variant in variants if name in variant):
            if not _NUMBER.fullmatch(value) and not is_expression(value):
                kind = Path(path).suffix
                faults.append(f"{name}: `{value}` is no expression of {kind} files; write NAME=1,2,3 or NAME=1..3")
    if faults:
        raise SettingError("\n".join(faults))
    changed = []
    for variant in variants:
        edits: dict[Text, list[Edit]] = {}
        for name, value in variant.items():
            place = places[name]
            edits.setdefault(place.text, []).append(Edit(place.span, value))
        changed.append({text.file: text.after(own) for text, own in edits.items()})
    return changed


def _is_rscd_expression(value: str) -> bool:
    """Return whether a value is one expression that does not change the text around it."""
    try:
        # In brackets, an open comment or a second statement is an error; without them, a closing bracket is one.
        return not any(isinstance(parse_rule(text, "Expression"), Failure) for text in (value, f"({value})"))
    except RecursionError:
        return False


def _is_cif_expression(value: str) -> bool:
    """Return whether a value is one expression that does not change the text around it."""
    for own in (value, f"({value})"):
        specification, _ = parse(Text("", f"const int c = {own};"))
        if specification is None or len(specification.declarations) != 1:
            return False
        if len(specification.declarations[0].constants) != 1:
            return False
    return True


def _only(path: str, name: str, declared: Mapping[str, list[_Declared]]) -> _Declared:
    places = declared.get(name, [])
    if not places:
        repair = did_you_mean(name, declared, cutoff=0.6)
        hint = f"; {repair.hint}" if repair else ""
        raise SettingError(f"{path} has no constant or parameter `{name}`{hint}")
    if len(places) > 1:
        where = " and ".join(f"{place.text.file}:{place.span.line}" for place in places)
        raise SettingError(f"{path} has several `{name}`: {where}; rename one of them")
    return places[0]


def _rscd(path: str, paths: Paths) -> Iterator[tuple[str, _Declared]]:
    for name, file in read(path, paths.libraries, RosTypes(paths.interfaces)).files.items():
        if file.base is None or is_shipped(name):
            continue
        inside = {
            definition: component.name for component, local in components(file.base) for definition in local.definitions
        }
        for kind in (rsc.Constant, rsc.Parameter):
            for element in statements(kind, file.base):
                called = f"{inside[element]}.{element.name}" if element in inside else str(element.name)
                if element.value is not None and element.value.source is not None:
                    yield called, _Declared(file.text, element.value.source.span)


def _cif(path: str) -> Iterator[tuple[str, _Declared]]:
    for file, content in cif.read(path).texts.items():
        text = Text(file, content)
        specification, _ = parse(text)
        if specification is not None:
            for name, value in _constants(specification, ""):
                yield name, _Declared(text, text.span(*span(value)))


def _constants(body: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    """Yield the absolute names of all constants of a group or automaton, with their values."""
    for declaration in body.declarations:
        if type(declaration).__name__ == "Constants":
            yield from ((prefix + plain(constant.name), constant.value) for constant in declaration.constants)
        elif hasattr(declaration, "declarations"):
            yield from _constants(declaration, f"{prefix}{plain(declaration.name)}.")
