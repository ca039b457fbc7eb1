"""What an event changes, as C statements: all at once, each value read as it was before and kept in its range."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.expressions import CPrinter
from robosc.m2t.c.guards import Edges, Everywhere, within
from robosc.m2t.c.nodes import All
from robosc.m2t.c.types import number, signed, type_name
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.domains import domain
from robosc.semantics.operators import ATOM

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.m2t.c.names import CNames
    from robosc.m2t.c.ranges import Ranges

_INDENT = "    "
_Alternative = tuple["list[sct.Location] | None", "list[sct.Update]"]


@dataclass(frozen=True, eq=False)
class _Unit:
    """Updates that are made together: in one of some locations (absent: in all that the event can start from)."""

    plant: sct.Plant
    alternatives: Sequence[_Alternative]
    possible: Sequence[sct.Location]

    @property
    def updates(self) -> list[sct.Update]:
        return [update for _, updates in self.alternatives for update in updates]


class Effects:
    """Writes the statements; `helpers` collects the functions that they call."""

    def __init__(self, names: CNames, ranges: Ranges) -> None:
        self.names = names
        self.ranges = ranges
        self.helpers: set[str] = set()

    def statements(self, plants: dict[sct.Plant, Edges]) -> tuple[list[str], bool]:
        """The statements of an event whose plants take these edges, and whether they read a copy of the state, `old`.

        Variables come first, ordered so that each is read before it is written; where that is impossible the value
        before is read from the copy. Locations come last: no other statement needs one after it has changed.
        """
        units = self._ordered([unit for plant, edges in plants.items() for unit in self._units(plant, edges)])
        old = self._read_late(units)
        printer = CPrinter(self.names, self.ranges, old)
        lines = [line for unit in units for line in self._unit(unit, printer)]
        for plant, edges in plants.items():
            lines += self._moves(plant, edges, printer)
        return lines, any("old." in line for line in lines)

    def _units(self, plant: sct.Plant, edges: Edges) -> Iterable[_Unit]:
        """Updates that are the same on all edges, one by one; else by location."""
        if isinstance(edges, Everywhere) and not edges.edge.updates:
            return []
        printer = CPrinter(self.names, self.ranges)
        groups: dict[tuple[tuple[str, str], ...], tuple[list[sct.Location], list[sct.Update]]] = {}
        for location, edge in edges.items():
            updates = [each for each in edge.updates if not _trivial(each)]
            key = tuple((each.variable.name, printer(each.value)) for each in updates)
            locations, _ = groups.setdefault(key, ([], updates))
            locations.append(location)
        if len(groups) == 1:
            return [_Unit(plant, [(None, [each])], list(edges)) for _, updates in groups.values() for each in updates]
        alternatives = [
            (
                locations,
                [
                    update
                    for unit in self._ordered([_Unit(plant, [(None, [each])], []) for each in updates])
                    for update in unit.updates
                ],
            )
            for locations, updates in groups.values()
        ]
        return [_Unit(plant, alternatives, list(edges))]

    def _ordered(self, units: list[_Unit]) -> list[_Unit]:
        """The units so that each comes before those that write what it reads, as far as that is possible."""
        remaining, ordered = list(units), []
        while remaining:
            unit = next((each for each in remaining if self._free(each, remaining)), remaining[0])
            remaining.remove(unit)
            ordered.append(unit)
        return ordered

    def _free(self, unit: _Unit, remaining: Sequence[_Unit]) -> bool:
        written = {update.variable for update in unit.updates}
        return not any(
            written & self.ranges.cells(update.value)
            for other in remaining
            if other is not unit
            for update in other.updates
        )

    def _read_late(self, units: Sequence[_Unit]) -> set[sct.DiscreteVariable]:
        """What is read after it was written."""
        late: set[sct.DiscreteVariable] = set()
        written: set[sct.DiscreteVariable] = set()
        for unit in units:
            for _, updates in unit.alternatives:
                here: set[sct.DiscreteVariable] = set()
                for update in updates:
                    read = {each for each in self.ranges.cells(update.value) if isinstance(each, sct.DiscreteVariable)}
                    late |= read & (written | here)
                    here.add(update.variable)
            written |= {update.variable for update in unit.updates}
        return late

    def _unit(self, unit: _Unit, printer: CPrinter) -> list[str]:
        return _chain(
            [
                (locations, [self._assignment(each, printer) for each in updates])
                for locations, updates in unit.alternatives
            ],
            unit.possible,
            printer,
        )

    def _moves(self, plant: sct.Plant, edges: Edges, printer: CPrinter) -> list[str]:
        """The change of location. Staying counts as going to the same location, so that one statement often does."""
        if len(plant.locations) == 1:
            return []
        if isinstance(edges, Everywhere):
            return [f"state->{self.names.member(plant)} = {self.names.enumerator(edges.edge.target)};"]
        targets: dict[sct.Location, list[sct.Location]] = {}
        for location, edge in edges.items():
            targets.setdefault(edge.target, []).append(location)
        member = self.names.member(plant)
        steps = [
            (
                None if len(targets) == 1 else locations,
                [] if locations == [target] else [f"state->{member} = {self.names.enumerator(target)};"],
            )
            for target, locations in targets.items()
        ]
        return _chain(steps, list(edges), printer)

    def _assignment(self, update: sct.Update, printer: CPrinter) -> str:
        return f"state->{self.names.member(update.variable)} = {self._stored(update, printer)};"

    def _stored(self, update: sct.Update, printer: CPrinter) -> str:
        """The value as the variable keeps it: in its type, the nearest bound for what is out of its range."""
        kind, value = type_name(update.variable.type), update.value
        values, text = self.ranges(value), printer(value)
        if isinstance(update.variable.type, ex.IntegerType):
            bounds = domain(update.variable.type)
            if values.high <= bounds.low or values.low >= bounds.high:
                return number(bounds.low if values.high <= bounds.low else bounds.high)
            if not bounds.holds(values):
                wide = printer.type(value) == "int64_t" or not signed(32).holds(values.union(bounds))
                helper = "clampwide" if wide else "clamp"
                self.helpers.add(helper)
                return f"({kind}){helper}({text}, {number(bounds.low)}, {number(bounds.high)})"
        plain = kind == "bool" or values.single is not None or printer.type(value) == kind
        return text if plain else f"({kind}){text if printer.precedence(value) == ATOM else f'({text})'}"


def _trivial(update: sct.Update) -> bool:
    return isinstance(update.value, sct.VariableReference) and update.value.variable is update.variable


def _chain(
    steps: Sequence[tuple[Sequence[sct.Location] | None, list[str]]],
    possible: Sequence[sct.Location],
    printer: CPrinter,
) -> list[str]:
    """Statements by location: `if`, `else if` for those that do something, the last with `else` where all do."""
    acting = [(locations, lines) for locations, lines in steps if lines]
    if len(acting) == 1 and (acting[0][0] is None or len(steps) == 1):
        return acting[0][1]
    lines: list[str] = []
    total = len(acting) == len(steps)
    for position, (locations, statements) in enumerate(acting):
        assert locations is not None
        condition = f"if ({printer(All([within(locations, possible)]))}) {{"
        if position:
            condition = "} else {" if total and position == len(acting) - 1 else f"}} else {condition}"
        lines += [condition, *(_INDENT + each for each in statements)]
    if len(acting) > 1 and not total:
        lines += ["} else {", f"{_INDENT}/* Elsewhere nothing changes. */"]
    return [*lines, "}"] if lines else []
