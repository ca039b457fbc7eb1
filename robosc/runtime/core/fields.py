"""Data of the model on its way into a message."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING

from robosc.ros_types.wire import INTEGER_RANGES
from robosc.semantics.evaluation import as_double, saturate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.runtime.core.json_text import Json
    from robosc.runtime.core.port import Message, Port
    from robosc.semantics.evaluation import Value

_FLOATS = {"float32": "f", "float": "f", "float64": "d", "double": "d"}
#: ROS 2 calls its `byte` an octet.
_RANGES = {**INTEGER_RANGES, "octet": INTEGER_RANGES["uint8"]}


class NotFiniteError(Exception):
    """A field whose value would be no finite number."""

    def __init__(self, path: Sequence[str]) -> None:
        super().__init__(".".join(path))


def fill(port: Port, message: Message, path: Sequence[str], value: Value) -> Json:
    """Sets a field, named by the fields on the way to it; what it then holds. Raises NotFiniteError.

    A number outside the field's range becomes its nearest one; a double becomes one of the field's precision.
    """
    owner = message
    for name in path[:-1]:
        owner = getattr(owner, name)
    kind = port.wire_types(owner)[path[-1]]
    held: bool | int | float | str = _held(kind, value, path)
    setattr(owner, path[-1], bytes([held]) if kind == "octet" and isinstance(held, int) else held)
    return held


def _held(kind: str, value: Value, path: Sequence[str]) -> bool | int | float | str:
    if isinstance(value, (bool, str)):
        return value
    assert isinstance(value, (int, float))
    if kind in _FLOATS:
        return _narrowed(as_double(value), _FLOATS[kind], path)
    low, high = _RANGES.get(kind, (0, 1))
    if isinstance(value, float):
        value = int(_finite(value, path))
    return saturate(value, low, high)


def _narrowed(value: float, code: str, path: Sequence[str]) -> float:
    try:
        (narrowed,) = struct.unpack(code, struct.pack(code, value))
    except OverflowError:
        raise NotFiniteError(path) from None
    return _finite(float(narrowed), path)


def _finite(value: float, path: Sequence[str]) -> float:
    if not math.isfinite(value):
        raise NotFiniteError(path)
    return value
