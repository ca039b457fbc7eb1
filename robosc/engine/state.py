"""The state of an sct model: a location of each plant that has several, and a value of each variable."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.domains import domain
from robosc.semantics.naming import Names

#: What a reader sees: a boolean, an integer, or the name of a location or literal.
Value = bool | int | str
#: What has a value in a state. Inside the engine values are integers: locations and literals by position.
Cell = sct.Plant | sct.DiscreteVariable


class Domain:
    """The values of a cell or input, as the engine and as its readers see them."""

    def __init__(self, declared: sct.Plant | ex.Type) -> None:
        """The domain of a plant's location or of a type."""
        self.low, self.high = self._values = domain(declared)
        self._boolean = isinstance(declared, ex.BooleanType)
        self._names: list[str] | None = None
        if not self._boolean and not isinstance(declared, ex.IntegerType):
            named = declared.locations if isinstance(declared, sct.Plant) else declared.enumeration.literals  # type: ignore[attr-defined]
            self._names = [element.name for element in named]

    def shown(self, value: int) -> Value:
        """A value as a reader sees it."""
        if self._names is not None:
            return self._names[value]
        return bool(value) if self._boolean else value

    def internal(self, value: Value) -> int:
        """A reader's value as the engine sees it; an integer saturates. ValueError: it is of another type."""
        if self._names is not None and isinstance(value, str) and value in self._names:
            return self._names.index(value)
        if self._names is None and isinstance(value, int) and isinstance(value, bool) == self._boolean:
            return self.clamp(value)
        expected = "a boolean" if self._boolean else "an integer" if self._names is None else ", ".join(self._names)
        raise ValueError(f"{value!r} is none of the values: {expected}")

    def clamp(self, value: int) -> int:
        """The nearest value of the domain."""
        return self._values.clamp(value)


class Layout:
    """Which cell of a state holds what. Names are as in `~/state`: `component_Gauge`, `Gauge.level`."""

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self.cells: dict[Cell, int] = {}
        self.domains: list[Domain] = []
        self.position: dict[str, int] = {}
        names = Names()
        for plant in model.plants:
            if len(plant.locations) > 1:
                self._add(plant, names.fresh(plant.name), Domain(plant))
            for variable in plant.variables:
                self._add(variable, names.fresh(f"{plant.origin or plant.name}.{variable.name}"), Domain(variable.type))

    def _add(self, cell: Cell, name: str, domain: Domain) -> None:
        self.cells[cell] = self.position[name] = len(self.domains)
        self.domains.append(domain)


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
