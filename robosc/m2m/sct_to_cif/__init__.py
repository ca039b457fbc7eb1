"""Transformation of an sct model to a model that CIF can express (docs/cif.md).

Each step is a module of its name, or a method here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.base.cache import cached
from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.m2m.sct_to_cif.linear import LARGEST, Unsupported, bounds, shift
from robosc.m2m.sct_to_cif.lower_arithmetic import Lowering
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.places import place
from robosc.model.reflection import tree
from robosc.model.semantics.domains import domain
from robosc.model.semantics.edges import edges_of
from robosc.model.semantics.printing import conjunction
from robosc.model.semantics.walks import copy_tree

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping


class LoweredModel(NamedTuple):
    """An sct model in CIF's terms, and the original of each element.

    Numbers are never negative, and never outside the range of the variable that they are assigned to. A `-` occurs only
    at the top of an assigned value, a `*` or a function nowhere. Every event can happen. In most data plants, a
    variable replaces the locations. A location has no name if CIF needs none.
    """

    model: sct.SupervisoryControlModel
    originals: Mapping[Any, Any]


def transform(model: sct.SupervisoryControlModel) -> LoweredModel:
    """Lower a model, with its supervisor if it has one. The original model does not change.

    Precondition: the model does not come from CIF. Raises ModelError with findings of the rule `cif` if numbers exceed
    32 bits, or if expressions would need too many cases.
    """
    return cached((transform, model), lambda: _SctToCif(model).run())


class _SctToCif:
    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self._model = model
        #: Lowered element of each element; for a location of a numbered plant, its variable and number.
        self._copies: dict[Any, Any] = {}
        self._numbered: dict[sct.Location, tuple[sct.DiscreteVariable, int]] = {}
        self._lowering = Lowering(self._copies, self._numbered)
        #: Reason why CIF cannot express an element, by the element to report it at.
        self._faults: dict[Any, str] = {}
        self._impossible = _impossible(model)
        self._referred = {
            reference.location for _, reference in tree(model) if isinstance(reference, sct.LocationReference)
        }

    def run(self) -> LoweredModel:
        self._copies[self._model] = model = sct.SupervisoryControlModel(name=self._model.name)
        for enumeration in self._model.enumerations:
            self._copies[enumeration] = clone = copy_tree(enumeration)
            self._copies |= zip(enumeration.literals, clone.literals, strict=True)
            model.enumerations.append(clone)
        model.plants.extend(map(self._plant, self._model.plants))
        self._refuse()  # Values computed from numbers that are too large would be reported again.
        for plant in self._model.plants:
            self._copies[plant].edges.extend(self._edges(plant.edges))
            for location in plant.locations:
                self._copies[location].edges.extend(self._edges(location.edges))
        model.requirements.extend(map(self._requirement, self._model.requirements))
        for invariant in self._model.invariants:
            condition = self._condition(invariant.condition)
            model.invariants.append(sct.StateInvariant(name=invariant.name, text=invariant.text, condition=condition))
        for required in self._model.reachabilityRequirements:
            model.reachabilityRequirements.append(
                sct.ReachabilityRequirement(
                    text=required.text,
                    condition=self._condition(required.condition),
                    premise=self._condition(required.premise),
                    pathCondition=self._condition(required.pathCondition),
                    bound=required.bound,
                )
            )
        if self._model.supervisor is not None:
            model.supervisor = self._supervisor(self._model.supervisor)
        self._refuse()
        return LoweredModel(model, {lowered: original for original, lowered in self._copies.items()})

    def _refuse(self) -> None:
        if self._faults:
            raise ModelError(
                [
                    Diagnostic(
                        *place(culprit),
                        Severity.ERROR,
                        "cif",
                        f"CIF cannot express this: {reason}",
                        "give the integers smaller ranges",
                    )
                    for culprit, reason in self._faults.items()
                ]
            )

    def _plant(self, plant: sct.Plant) -> sct.Plant:
        """Lower a plant without its edges."""
        self._copies[plant] = lowered = sct.Plant(
            name=plant.name, kind=plant.kind, origin=plant.origin, text=plant.text
        )
        lowered.inputs.extend(map(self._cell, plant.inputs))
        lowered.variables.extend(map(self._cell, plant.variables))
        for event in plant.events:
            if event not in self._impossible:
                self._copies[event] = sct.Event(
                    name=event.name,
                    controllable=event.controllable,
                    kind=event.kind,
                    inputs=[self._copies[carried] for carried in event.inputs],
                )
                lowered.events.append(self._copies[event])
        if _is_numbered(plant):
            self._number_locations(plant, lowered)
            return lowered
        stateless = (sct.PlantKind.message, sct.PlantKind.assumption)
        nameless = plant.kind in stateless and len(plant.locations) == 1
        for location in plant.locations:
            name = "" if nameless and location not in self._referred else location.name
            self._copies[location] = sct.Location(name=name, initial=location.initial, marked=location.marked)
            lowered.locations.append(self._copies[location])
        return lowered

    def _cell(self, cell: Any) -> Any:
        """Lower an input or variable. A negative range is shifted to start at 0."""
        self._copies[cell] = lowered = type(cell)(name=cell.name, type=copy_tree(cell.type, self._copies))
        if isinstance(lowered.type, ex.EnumerationType):
            lowered.type.first = lowered.type.last = None
        if isinstance(lowered.type, ex.IntegerType):
            low, high = (bound + shift(cell) for bound in bounds(cell))
            lowered.type.minimum, lowered.type.maximum = low, high
            if high > LARGEST:
                self._faults[cell] = "its range does not fit 32 bits"
        if isinstance(cell, sct.DiscreteVariable) and cell not in self._faults:
            assert cell.initial is not None
            lowered.initial = self._lowering.lower_assignment(cell, cell.initial)
        return lowered

    def _number_locations(self, plant: sct.Plant, lowered: sct.Plant) -> None:
        """Replace the locations of a plant by one unnamed location and a variable with a number."""
        start = next(number for number, location in enumerate(plant.locations) if location.initial)
        variable = sct.DiscreteVariable(
            name="choice",
            type=ex.IntegerType(minimum=0, maximum=len(plant.locations) - 1),
            initial=ex.IntegerLiteral(value=start),
        )
        only = sct.Location(name="", initial=True, marked=plant.locations[0].marked)
        lowered.variables.append(variable)
        lowered.locations.append(only)
        for number, location in enumerate(plant.locations):
            self._copies[location] = only
            self._numbered[location] = variable, number

    def _edges(self, edges: Iterable[sct.Edge]) -> list[sct.Edge]:
        return [self._edge(edge) for edge in edges if edge.event not in self._impossible]

    def _edge(self, edge: sct.Edge) -> sct.Edge:
        guard = conjunction(filter(None, [*self._possible(edge), self._condition(edge.guard)]))
        lowered = sct.Edge(event=self._copies[edge.event], guard=guard, target=self._copies[edge.target])
        for update in edge.updates:
            value = self._lowered(None, self._lowering.lower_assignment, update.variable, update.value)
            lowered.updates.append(sct.Update(variable=self._copies[update.variable], value=value))
        if edge.target in self._numbered:
            variable, number = self._numbered[edge.target]
            lowered.updates.append(sct.Update(variable=variable, value=ex.IntegerLiteral(value=number)))
        return lowered

    def _possible(self, edge: sct.Edge) -> Iterator[ex.Expression]:
        """Return conditions on the inputs of an event that exclude impossible literals.

        Inputs in CIF can have each literal of their enumeration. The plant of the event excludes the others.
        """
        owner = edge.eContainer()
        if edge.event.eContainer() not in (owner, owner.eContainer()):
            return
        for carried in edge.event.inputs:
            if isinstance(carried.type, ex.EnumerationType):
                low, high = domain(carried.type)
                for place, literal in enumerate(carried.type.enumeration.literals):
                    if not low <= place <= high:
                        reference = sct.InputReference(input=self._copies[carried])
                        other = ex.EnumerationLiteralReference(literal=self._copies[literal])
                        yield ex.Inequation(left=reference, right=other)

    def _requirement(self, requirement: sct.Requirement) -> sct.Requirement:
        return sct.Requirement(
            name=requirement.name,
            text=requirement.text,
            event=self._copies[requirement.event],
            kind=requirement.kind,
            condition=self._condition(requirement.condition),
        )

    def _supervisor(self, supervisor: sct.Supervisor) -> sct.Supervisor:
        """Lower the conditions of the supervisor and its state counts."""
        lowered = sct.Supervisor(
            uncontrolledStates=supervisor.uncontrolledStates, controlledStates=supervisor.controlledStates
        )
        for guard in supervisor.guards:
            if guard.event not in self._impossible:
                # A supervisor's guard has no place in a user's text.
                requirement, synthesis = (
                    self._condition(part, guard.event) for part in (guard.requirement, guard.synthesis)
                )
                event = self._copies[guard.event]
                lowered.guards.append(sct.EventGuard(event=event, requirement=requirement, synthesis=synthesis))
        return lowered

    def _condition(self, expression: ex.Expression | None, culprit: Any = None) -> ex.Expression | None:
        return None if expression is None else self._lowered(culprit, self._lowering.condition, expression)

    def _lowered(self, culprit: Any, lower: Callable[..., ex.Expression], *arguments: Any) -> ex.Expression | None:
        """Call a method of the lowering. If CIF cannot express the result, record a fault and return None."""
        try:
            return lower(*arguments)
        except Unsupported as fault:
            self._faults.setdefault(fault.expression if culprit is None else culprit, fault.reason)
            return None


def _is_numbered(plant: sct.Plant) -> bool:
    """Return whether a variable replaces the plant's locations.

    This applies to data plants. All their locations have the same edges; written for each location, the number of edges
    would be the square of the number of choices.
    """
    return (
        plant.kind == sct.PlantKind.data
        and len(plant.locations) > 1
        and bool(plant.edges)
        and not any(location.edges for location in plant.locations)
        and len({location.marked for location in plant.locations}) == 1
    )


def _impossible(model: sct.SupervisoryControlModel) -> set[sct.Event]:
    """Return events that are never possible and that no requirement names. CIF does not need them.

    All their edges have the guard `false`. An example is `c_none` if a provide statement has no condition. CIF warns of
    events that can never happen.
    """
    events = {event for plant in model.plants for event in plant.events}
    events -= {requirement.event for requirement in model.requirements}
    for plant in model.plants:
        for edge in edges_of(plant):
            never = isinstance(edge.guard, ex.BooleanLiteral) and not edge.guard.value
            if not never or edge.event.eContainer() is not plant:
                events.discard(edge.event)
    return events
