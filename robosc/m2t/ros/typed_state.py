"""ROS message with a robot's state: a field for each state and variable, with constants for the values of its type.

The constants of a field come directly before it, because Foxglove expects them there.
"""

from __future__ import annotations

import keyword
import re
from dataclasses import dataclass
from itertools import chain, count
from typing import TYPE_CHECKING

from robosc.m2t.c.names import TAKEN
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.semantics.component_parts import components
from robosc.model.semantics.naming import snake_case
from robosc.model.semantics.roles import assumptions

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.m2t.ros.names import CppNames

#: Name of the message in its package.
MESSAGE = "State"
_WIRE = {ex.BooleanType: "bool", ex.DoubleType: "float64", ex.IntegerType: "int64", ex.StringType: "string"}


@dataclass(frozen=True)
class Constant:
    """A constant of the message. `enumerator` is the equal constant in the node's code, if there is one."""

    name: str
    value: int
    enumerator: str | None


@dataclass(frozen=True)
class Field:
    """A field of the message: description, type, name, constants, and the value that the node assigns."""

    about: str
    type: str
    name: str
    constants: list[Constant]
    value: str


def fields(graph: rosgraph.RosGraph, names: CppNames) -> list[Field]:
    """Return the fields of a robot's state: the state and the variables of each component with behaviour.

    A robot with assumptions has a field for those that it has violated.
    """
    return list(_Maker(names).fields(graph))


class _Maker:
    def __init__(self, names: CppNames) -> None:
        self._names = names
        self._fields = _Scope({"header", *TAKEN, *keyword.kwlist})
        self._constants = _Scope()

    def fields(self, graph: rosgraph.RosGraph) -> Iterator[Field]:
        for parts in components(graph):
            if parts.plant is None:
                continue
            name = self._fields.fresh(snake_case(parts.name))
            yield self._state(parts.plant, f"The state of {parts.name}.", name)
            variables: list[sct.DiscreteVariable | rosgraph.NodeVariable] = [*parts.plant.variables, *parts.stored]
            for variable in variables:
                own = self._fields.fresh(f"{name}_{snake_case(variable.name)}")
                yield self._variable(variable, f"{parts.name}.{variable.name}", own)
        if assumptions(graph.model):
            about = "The assumptions that the robot has violated, by name or else by text."
            yield Field(about, "string[]", self._fields.fresh("violated"), [], "violations_.names()")

    def _state(self, plant: sct.Plant, about: str, name: str) -> Field:
        several = len(plant.locations) > 1
        values = [(place.name, self._names.c.enumerator(place) if several else None) for place in plant.locations]
        return self._enumerated(about, name, values, self._names.state(plant) if several else "0")

    def _variable(self, variable: sct.DiscreteVariable | rosgraph.NodeVariable, about: str, name: str) -> Field:
        kind = variable.type
        if isinstance(variable, rosgraph.NodeVariable):
            value, number = f"data_.{self._names.variable(variable)}", "{}.to<std::int64_t>()"
        else:
            value, number = self._names.state(variable), "static_cast<std::int64_t>({})"
        if isinstance(kind, ex.EnumerationType):
            literals = [(literal.name, self._names.literal(literal)) for literal in kind.enumeration.literals]
            return self._enumerated(about, name, literals, value)
        if isinstance(kind, ex.IntegerType):
            value = number.format(value)
        return Field(about, _WIRE[type(kind)], name, [], value)

    def _enumerated(self, about: str, name: str, values: Sequence[tuple[str, str | None]], value: str) -> Field:
        bits = next(bits for bits in (8, 16, 32) if len(values) <= 2**bits)
        constants = [
            Constant(self._constants.fresh(f"{name}_is_{snake_case(text)}").upper(), number, enumerator)
            for number, (text, enumerator) in enumerate(values)
        ]
        return Field(about, f"uint{bits}", name, constants, f"static_cast<std::uint{bits}_t>({value})")


class _Scope:
    """Names in one message that both ROS versions allow: letters, digits, and single underscores between them."""

    def __init__(self, taken: set[str] | None = None) -> None:
        self._taken = taken or set()

    def fresh(self, name: str) -> str:
        """Return the name, or a similar one that is free."""
        ascii_only = re.sub(r"[^a-z0-9_]", lambda match: f"u{ord(match[0]):04x}", name)
        word = re.sub("_+", "_", ascii_only).strip("_")
        word = word if word[:1].isalpha() else f"x{word}"
        match = next(
            candidate
            for candidate in chain([word], (f"{word}_{number}" for number in count(2)))
            if candidate not in self._taken
        )
        self._taken.add(match)
        return match
