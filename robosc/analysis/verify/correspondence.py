"""Correspondence between the elements of a CIF specification and those of the model, by order and name only."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.analysis.verify.cif_reading import CifError
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.domains import domain
from robosc.synthesis.encoding import domain_size, smallest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.synthesis.encoding import Element


class Correspondence:
    """Pairs of corresponding elements of a model and a specification.

    Plants and their members have the order and the names of the model. Underscores may follow a name, and the only
    location of a plant needs none. An integer has the same range; a range that begins below 0 may be replaced by one of
    the same size from 0 on, with the values in the same order. A plant with a single location may have a last variable
    more, which holds the location of the model's plant. An event may be missing: it then never happens in the
    specification.
    """

    def __init__(self, model: sct.SupervisoryControlModel, specification: sct.SupervisoryControlModel) -> None:
        """Pair all elements.

        Raises CifError if an element has no counterpart, or one of another type, controllability or marking.
        """
        self._counterparts: dict[Any, Any] = {}
        #: Variables that hold the locations of plants.
        self._numbers: dict[Any, sct.DiscreteVariable] = {}
        self._pair("enumerations", model.enumerations, specification.enumerations)
        for enumeration in model.enumerations:
            self._pair(f"literals of '{enumeration.name}'", enumeration.literals, self[enumeration].literals)
        self._pair("plants", model.plants, specification.plants)
        for plant in model.plants:
            if (plant.kind == sct.PlantKind.requirement) != (self[plant].kind == sct.PlantKind.requirement):
                raise CifError(f"'{plant.name}' is a plant in one of the two, and a requirement in the other")
            self._pair_members(plant, self[plant])
        self._originals = {theirs: ours for ours, theirs in self._counterparts.items()}
        self._originals.update({theirs: ours for ours, theirs in self._numbers.items()})

    def __getitem__(self, ours: Any) -> Any:
        """Return the counterpart of an element of the model."""
        return self._counterparts[ours]

    def holding(self, ours: Element) -> Element:
        """Return the counterpart that holds the value of an element: for a plant's location possibly a variable."""
        counterpart: Element = self._numbers.get(ours) or self._counterparts[ours]
        return counterpart

    def event(self, ours: sct.Event) -> sct.Event | None:
        """Return the counterpart of an event of the model, or None if it is missing."""
        return self._counterparts.get(ours)

    def original(self, theirs: Any) -> Any:
        """Return the element of the model for an element of the specification."""
        return self._originals[theirs]

    def _pair(self, what: str, ours: Sequence[ex.NamedElement], theirs: Sequence[ex.NamedElement]) -> None:
        if len(ours) != len(theirs) or not all(map(_same_name, ours, theirs)):
            names = (", ".join(element.name for element in elements) or "none" for elements in (theirs, ours))
            raise CifError(f"its {what} are {next(names)}, not {next(names)}")
        self._counterparts.update(zip(ours, theirs, strict=True))

    def _pair_members(self, ours: sct.Plant, theirs: sct.Plant) -> None:
        of = f"of '{ours.name}'"
        self._pair_events(of, ours, theirs)
        self._pair(f"inputs {of}", ours.inputs, theirs.inputs)
        variables = list(theirs.variables)
        nameless = [location.name for location in theirs.locations] == [""]
        if nameless and len(variables) > len(ours.variables):
            self._number(of, ours, variables.pop())
        self._pair(f"variables {of}", ours.variables, variables)
        if not nameless:
            self._pair(f"locations {of}", ours.locations, theirs.locations)
        elif len(ours.locations) == 1 or ours in self._numbers:
            self._counterparts.update(dict.fromkeys(ours.locations, theirs.locations[0]))
        else:
            raise CifError(f"it has one location {of} only")
        for location in ours.locations:
            for word in ("marked",) if ours in self._numbers else ("initial", "marked"):
                if getattr(location, word) != getattr(self[location], word):
                    raise CifError(f"'{location.name}' {of} is {'not ' * getattr(location, word)}{word} in it")
        members: list[sct.DiscreteVariable | sct.Input] = [*ours.inputs, *ours.variables]
        for carried in ours.inputs:
            self._narrow(carried, ours, self[carried], theirs)
        for member in members:
            if not self._same_values(member, self[member]):
                raise CifError(f"the values of '{member.name}' {of} are others")

    def _narrow(self, ours: sct.Input, plant: sct.Plant, theirs: sct.Input, automaton: sct.Plant) -> None:
        """Restrict an input of CIF to the literals that the model allows if its automaton excludes the others."""
        if not isinstance(ours.type, ex.EnumerationType) or not isinstance(theirs.type, ex.EnumerationType):
            return
        low, high = domain(ours.type)
        literals = list(ours.type.enumeration.literals)
        others = {self[literal] for literal in [*literals[:low], *literals[high + 1 :]]}
        events = [self[event] for event in plant.events if ours in event.inputs and event in self._counterparts]
        edges = (edge for location in automaton.locations for edge in location.edges if edge.event in events)
        if others and all(others <= _excluded(edge.guard, theirs) for edge in edges):
            theirs.type.first, theirs.type.last = self[literals[low]], self[literals[high]]

    def _number(self, of: str, ours: sct.Plant, variable: sct.DiscreteVariable) -> None:
        kind = variable.type
        if not isinstance(kind, ex.IntegerType) or (kind.minimum, kind.maximum) != (0, len(ours.locations) - 1):
            raise CifError(
                f"the values of '{variable.name}' {of} are not the numbers of {len(ours.locations)} locations"
            )
        self._numbers[ours] = variable

    def _pair_events(self, of: str, ours: sct.Plant, theirs: sct.Plant) -> None:
        left = list(theirs.events)
        there = [event for event in ours.events if left and _same_name(event, left[0]) and left.pop(0)]
        self._pair(f"events {of}", there if not left else ours.events, theirs.events)
        for event in there:
            if event.controllable != self[event].controllable:
                raise CifError(f"it has '{event.name}' {of} {'un' * event.controllable}controllable")

    def _same_values(self, ours: sct.DiscreteVariable | sct.Input, theirs: sct.DiscreteVariable | sct.Input) -> bool:
        if type(ours.type) is not type(theirs.type) or domain_size(ours) != domain_size(theirs):
            return False
        if isinstance(ours.type, ex.EnumerationType) and isinstance(theirs.type, ex.EnumerationType):
            return self[ours.type.enumeration] is theirs.type.enumeration
        return smallest(theirs) == max(0, smallest(ours))


def _excluded(guard: ex.Expression | None, carried: sct.Input) -> set[ex.EnumerationLiteral]:
    """Return the literals that a guard excludes for an input, by inequations joined with `and`."""
    literals: set[ex.EnumerationLiteral] = set()
    pending = [guard]
    while pending:
        match pending.pop():
            case ex.Conjunction(left=left, right=right):
                pending += [left, right]
            case ex.Inequation(
                left=sct.InputReference() as reference, right=ex.EnumerationLiteralReference(literal=literal)
            ) if reference.input is carried:
                literals.add(literal)
    return literals


def _same_name(ours: ex.NamedElement, theirs: ex.NamedElement) -> bool:
    return theirs.name.startswith(ours.name) and not theirs.name.removeprefix(ours.name).strip("_")
