"""The state of an engine model: a location of each plant that has several, and a value of each variable."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from robosc.metamodel import engine
from robosc.metamodel import expression as ex
from robosc.semantics.domains import domain

if TYPE_CHECKING:
    from robosc.metamodel import sct

#: What a reader sees: a boolean, an integer, or the name of a location or literal.
Value = bool | int | str


class Domain:
    """The values of a type, as the engine and as its readers see them.

    Inside the engine values are integers: locations and literals by position. Raises ValueError where it has no bounds.
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

    def shown(self, value: int) -> Value:
        """A value as a reader sees it."""
        if self._names is not None:
            return self._names[value]
        return bool(value) if self._boolean else value

    def internal(self, value: Value) -> int:
        """A reader's value as the engine sees it; an integer saturates. ValueError: it is of another type."""
        possible = None if self._names is None else self._names[self.low : self.high + 1]
        if possible is not None and isinstance(value, str) and value in possible:
            return self.low + possible.index(value)
        if self._names is None and isinstance(value, int) and isinstance(value, bool) == self._boolean:
            return self.clamp(value)
        expected = "a boolean" if self._boolean else "an integer" if possible is None else ", ".join(possible)
        raise ValueError(f"{json.dumps(value, default=repr)} is none of the values: {expected}")

    def clamp(self, value: int) -> int:
        """The nearest value of the domain."""
        return min(max(value, self.low), self.high)


class Layout:
    """Which cell of a state holds what. Names are as in `~/state`: `component_Gauge`, `Gauge.level`."""

    def __init__(self, model: engine.EngineModel) -> None:
        self.domains = [Domain(variable.type) for variable in model.variables]
        self.position = {variable.name: cell for cell, variable in enumerate(model.variables)}
        #: The name of each cell, and what it is of.
        self.elements: list[tuple[str, sct.Plant | sct.DiscreteVariable]] = [
            (variable.name, variable.variable or variable.plant) for variable in model.variables
        ]
        self.cells = {element: cell for cell, (_, element) in enumerate(self.elements)}


class State(Mapping[str, Value]):
    """One state, unchangeable; equal to another state of the same engine with the same values, and hashable."""

    __slots__ = ("cells", "layout")

    def __init__(self, layout: Layout, cells: tuple[int, ...]) -> None:
        self.layout = layout
        self.cells = cells

    def __getitem__(self, name: str) -> Value:
        position = self.layout.position[name]
        return self.layout.domains[position].shown(self.cells[position])

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
