"""What the definition of a ROS type says: its sections, their fields, and the types of these."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple, TypeAlias


class DefinitionError(ValueError):
    """The text of a definition can't be read; says what is wrong with which file."""


class Section(Enum):
    """A section of a definition, what one ROS message carries: the kind of its type, and its place."""

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
        """Its place among the sections of the definition, from 0."""
        return self.value[1]


class Primitive(NamedTuple):
    """A type without fields: the type of RoboSC that has its values, and the least and the greatest whole number."""

    name: str
    range: tuple[int, int] | None = None


#: All of them but `wstring`, which no data of a model can have; a `byte` is that of ROS 1.
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
#: The values of each whole number.
INTEGER_RANGES = {name: primitive.range for name, primitive in PRIMITIVES.items() if primitive.range is not None}

#: The folder in a package that holds the definitions of a kind; the same word ends the names of its files.
FOLDERS = {"message": "msg", "service": "srv", "action": "action"}


@dataclass(frozen=True)
class Basic:
    """A type without fields: `bool`, `float64`, `string`."""

    name: str

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True)
class Sequence:
    """Several values of one type; `length` is None where it varies."""

    element: WireType
    length: int | None = None

    def __str__(self) -> str:
        return f"{self.element}[{'' if self.length is None else self.length}]"


@dataclass(frozen=True)
class Nested:
    """A message type of a package."""

    package: str
    name: str

    def __str__(self) -> str:
        return f"{self.package}/{self.name}"


WireType: TypeAlias = Basic | Sequence | Nested
#: The fields of one section, in the order of its definition.
Fields: TypeAlias = Mapping[str, WireType]
