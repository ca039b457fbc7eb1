"""Conventions shared by writing and reading of XMI: names, limits, and the text of values."""

import math
import re
from collections.abc import Callable, Mapping
from decimal import Decimal
from typing import Any

from pyecore.ecore import EEnum

XMI = "http://www.omg.org/XMI"
XSI = "http://www.w3.org/2001/XMLSchema-instance"

#: Maximum depth of elements: as many as an expression may have operators, plus those around it.
DEEPEST = 6000
#: Characters that XML 1.0 cannot hold, not even escaped.
UNWRITABLE = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
#: The limit exceeds the digits of the number of states of any robot that can be synthesized.
_INTEGER = re.compile("[+-]?[0-9]{1,1000000}")
_LONG = range(-(2**63), 2**63)
_DOUBLE = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]{1,4})?")


def to_text(value: object) -> str:
    """Return the text of a value in EMF's format."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(Decimal(value))  # a number of states may have more digits than `str` accepts
    return repr(value) if isinstance(value, float) else str(value)


def from_text(kind: Any, text: str) -> object | None:
    """Return the value of a data type or an enumeration. None if the text is invalid."""
    if isinstance(kind, EEnum):
        literal: object | None = kind.getEEnumLiteral(name=text)
        return literal
    return _READERS[kind.name](text)


def _integer(text: str) -> int | None:
    return int(Decimal(text)) if _INTEGER.fullmatch(text) else None


def _long(text: str) -> int | None:
    value = _integer(text)
    return value if value is not None and value in _LONG else None


def _double(text: str) -> float | None:
    value = float(text) if _DOUBLE.fullmatch(text) else math.inf
    return value if math.isfinite(value) else None


def _boolean(text: str) -> bool | None:
    return {"true": True, "false": False}.get(text)


_READERS: Mapping[str, Callable[[str], object | None]] = {
    "EString": str,
    "EBoolean": _boolean,
    "ELong": _long,
    "ELongObject": _long,
    "EBigInteger": _integer,
    "EDouble": _double,
    "EDoubleObject": _double,
}
