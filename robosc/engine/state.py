"""State of an engine model: a location of each plant with several, and a value of each variable."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from robosc.model import engine
from robosc.model import expression as ex
from robosc.model.semantics.domains import domain

if TYPE_CHECKING:
    from robosc.model import sct

#: External form of a value: a boolean, an integer, or the name of a location or literal.
Value = bool | int | str


class Domain:
    """Values of a type, in their internal and external form.

    The internal form is an integer: locations and literals have their position. Raises ValueError for a type without
    bounds.
    """

    def __init__(self, kind: ex.Type) -> None:
        self.low, self.high = domain(kind)
        self._names: list[str] | None = None
        match kind:
            case engine.LocationType(plant=plant):
                self._names = [location.name for location in plant.locations]
            case ex.EnumerationType(enumeration=enumeration):
                self._names = [literal.name for literal in enumeration.literals]
        self._boolean = isinstance(kind, ex.BooleanType)

    def external(self, value: int) -> Value:
        """Return the external form of a value."""
        if self._names is not None:
            return self._names[value]
        return bool(value) if self._boolean else value

    def internal(self, value: Value) -> int:
        """Return the internal form of a value. Integers saturate. Raises ValueError for a value of another type."""
        possible = None if self._names is None else self._names[self.low : self.high + 1]
        if possible is not None and isinstance(value, str) and value in possible:
            return self.low + possible.index(value)
        if self._names is None and isinstance(value, int) and isinstance(value, bool) == self._boolean:
            return self.clamp(value)
        expected = "a boolean" if self._boolean else "an integer" if possible is None else ", ".join(possible)
        raise ValueError(f"{json.dumps(value, default=repr)} is none of the values: {expected}")

    def clamp(self, value: int) -> int:
        """Return the value of the domain that is nearest to `value`."""
        return min(max(value, self.low), self.high)


class StateLayout:
    """Assignment of the cells of a state. Names are as in `~/state`: `component_Gauge`, `Gauge.level`."""

    def __init__(self, model: engine.EngineModel) -> None:
        self.domains = [Domain(variable.type) for variable in model.variables]
        self.position = {variable.name: cell for cell, variable in enumerate(model.variables)}
        #: Name and element of each cell.
        self.elements: list[tuple[str, sct.Plant | sct.DiscreteVariable]] = [
            (variable.name, variable.variable or variable.plant) for variable in model.variables
        ]
        self.cells = {element: cell for cell, (_, element) in enumerate(self.elements)}


class State(Mapping[str, Value]):
    """An immutable, hashable state. States of one engine are equal if their values are."""

    __slots__ = ("cells", "layout")

    def __init__(self, layout: StateLayout, cells: tuple[int, ...]) -> None:
        self.layout = layout
        self.cells = cells

    def __getitem__(self, name: str) -> Value:
        position = self.layout.position[name]
        return self.layout.domains[position].external(self.cells[position])

    def __iter__(self) -> Iterator[str]:
        return iter(self.layout.position)

    def __len__(self) -> int:
        return len(self.cells)

    def __hash__(self) -> int:
        return hash(self.cells)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, State) and other.layout is self.layout:
            return self.cells == other.cells
        return Mapping.__eq__(self, other)

    def __repr__(self) -> str:
        return f"State({dict(self)!r})"
