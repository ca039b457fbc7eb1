"""Contents of ROS definitions: sections, fields, and the types of fields."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Mapping


class DefinitionError(ValueError):
    """An invalid definition; the message names the fault and the file."""


class Section(Enum):
    """A section of a definition, which is the content of one ROS message: the kind of its type, and its index."""

    MESSAGE = "message", 0
    REQUEST = "service", 0
    RESPONSE = "service", 1
    GOAL = "action", 0
    RESULT = "action", 1
    FEEDBACK = "action", 2

    @property
    def kind(self) -> str:
        """`message`, `service` or `action`."""
        return self.value[0]

    @property
    def index(self) -> int:
        """Index among the sections of the definition, from 0."""
        return self.value[1]


class Primitive(NamedTuple):
    """A type without fields: the type of RoboSC with the same values, and the range of an integer."""

    name: str
    range: tuple[int, int] | None = None


#: All primitive types except `wstring`, which a model cannot use; `byte` is that of ROS 1.
PRIMITIVES = {
    "bool": Primitive("boolean"),
    **{f"int{bits}": Primitive("integer", (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)) for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": Primitive("integer", (0, 2**bits - 1)) for bits in (8, 16, 32, 64)},
    "byte": Primitive("integer", (-128, 127)),
    "char": Primitive("integer", (0, 255)),
    "float32": Primitive("double"),
    "float64": Primitive("double"),
    "string": Primitive("string"),
}
#: Range of each integer type.
INTEGER_RANGES = {name: primitive.range for name, primitive in PRIMITIVES.items() if primitive.range is not None}

#: Folder of the definitions of a kind in a package, and suffix of its files.
FOLDERS = {"message": "msg", "service": "srv", "action": "action"}


#: Basic data of ROS.
Value: TypeAlias = bool | int | float | str

#: Values of fields without a declared default, by the type of RoboSC.
_ZEROS: Mapping[str, Value] = {"boolean": False, "integer": 0, "double": 0.0, "string": ""}


@dataclass(frozen=True)
class Basic:
    """A type without fields, such as `bool`, `float64` or `string`. `default` is that of the definition."""

    name: str
    default: Value | None = field(default=None, compare=False)

    @property
    def initial(self) -> Value:
        """The value in a new message."""
        primitive = PRIMITIVES.get(self.name)
        zero = _ZEROS["string" if primitive is None else primitive.name]
        return zero if self.default is None else self.default

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True)
class Sequence:
    """Several values of one type; `length` is None if it varies. `default` is that of the definition."""

    element: WireType
    length: int | None = None
    default: tuple[Value, ...] | None = field(default=None, compare=False)

    @property
    def initial_length(self) -> int:
        """The number of elements in a new message."""
        return len(self.default) if self.default is not None else self.length or 0

    def at(self, index: int) -> WireType:
        """Return the type of an element, with its default."""
        if self.default is None or index >= len(self.default) or not isinstance(self.element, Basic):
            return self.element
        return replace(self.element, default=self.default[index])

    def __str__(self) -> str:
        return f"{self.element}[{'' if self.length is None else self.length}]"


@dataclass(frozen=True)
class NestedType:
    """A message type of a package."""

    package: str
    name: str

    def __str__(self) -> str:
        return f"{self.package}/{self.name}"


WireType: TypeAlias = Basic | Sequence | NestedType


class Fields(dict[str, WireType]):
    """The fields of one section, in the order of its definition, and its `constants`."""

    def __init__(self, fields: Mapping[str, WireType], constants: Mapping[str, Value] | None = None) -> None:
        """Take fields and constants by name."""
        super().__init__(fields)
        self.constants = dict(constants or {})
