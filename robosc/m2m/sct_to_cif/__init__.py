"""From an sct model to one that CIF can spell: what CIF lacks is said by what it has (docs/cif.md).

Each step is a file of its name, or a method here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.m2m.remembering import once
from robosc.m2m.sct_to_cif.linear import LARGEST, Unsupported, bounds, shift
from robosc.m2m.sct_to_cif.lower_arithmetic import Lowering
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.metamodel.places import place
from robosc.metamodel.reflection import tree
from robosc.semantics.domains import domain
from robosc.semantics.edges import edges_of
from robosc.semantics.printing import conjunction
from robosc.semantics.walks import copied

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping


class Lowered(NamedTuple):
    """An sct model in CIF's terms, and of its elements those that they were made of.

    Numbers are never negative, and never outside the range of what they are assigned to; a `-` stands only at the top
    of what is assigned, and a `*` or a function nowhere. Every event can happen. The locations of most data plants are
    a variable that was made of none. A location has no name where CIF needs none.
    """

    model: sct.SupervisoryControlModel
    originals: Mapping[Any, Any]


def transform(model: sct.SupervisoryControlModel) -> Lowered:
    """Lowers a model, which must not come from CIF, with its supervisor where it has one; the model stays as it is.

    Raises ModelError with findings of the rule `cif` where numbers leave 32 bits, or expressions would have to be split
    into too many cases.
    """
    return once((transform, model), lambda: _Transformation(model).run())


class _Transformation:
    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self._model = model
        #: What became of each element, and where a plant is by the number of its location, which this is.
        self._made: dict[Any, Any] = {}
        self._numbered: dict[sct.Location, tuple[sct.DiscreteVariable, int]] = {}
        self._lowering = Lowering(self._made, self._numbered)
        #: The reason why an element can't be said, by what it is told of.
        self._faults: dict[Any, str] = {}
        self._impossible = _impossible(model)
        self._referred = {
            reference.location for _, reference in tree(model) if isinstance(reference, sct.LocationReference)
        }

    def run(self) -> Lowered:
        self._made[self._model] = model = sct.SupervisoryControlModel(name=self._model.name)
        for enumeration in self._model.enumerations:
            self._made[enumeration] = made = copied(enumeration)
            self._made |= zip(enumeration.literals, made.literals, strict=True)
            model.enumerations.append(made)
        model.plants.extend(map(self._plant, self._model.plants))
        self._refuse()  # What is computed from numbers that are too large is too large, too.
        for plant in self._model.plants:
            self._made[plant].edges.extend(self._edges(plant.edges))
            for location in plant.locations:
                self._made[location].edges.extend(self._edges(location.edges))
        model.requirements.extend(map(self._requirement, self._model.requirements))
        for invariant in self._model.invariants:
            condition = self._condition(invariant.condition)
            model.invariants.append(sct.StateInvariant(name=invariant.name, text=invariant.text, condition=condition))
        if self._model.supervisor is not None:
            model.supervisor = self._supervisor(self._model.supervisor)
        self._refuse()
        return Lowered(model, {made: original for original, made in self._made.items()})

    def _refuse(self) -> None:
        if self._faults:
            raise ModelError(
                [
                    Diagnostic(
                        *place(culprit),
                        Severity.ERROR,
                        "cif",
                        f"this can't be said in CIF: {reason}",
                        "give the integers smaller ranges",
                    )
                    for culprit, reason in self._faults.items()
                ]
            )

    def _plant(self, plant: sct.Plant) -> sct.Plant:
        """All of a plant but its edges."""
        self._made[plant] = made = sct.Plant(name=plant.name, kind=plant.kind, origin=plant.origin)
        made.inputs.extend(map(self._cell, plant.inputs))
        made.variables.extend(map(self._cell, plant.variables))
        for event in plant.events:
            if event not in self._impossible:
                self._made[event] = sct.Event(
                    name=event.name,
                    controllable=event.controllable,
                    kind=event.kind,
                    inputs=[self._made[carried] for carried in event.inputs],
                )
                made.events.append(self._made[event])
        if _is_numbered(plant):
            self._number_locations(plant, made)
            return made
        nameless = plant.kind == sct.PlantKind.message and len(plant.locations) == 1
        for location in plant.locations:
            name = "" if nameless and location not in self._referred else location.name
            self._made[location] = sct.Location(name=name, initial=location.initial, marked=location.marked)
            made.locations.append(self._made[location])
        return made

    def _cell(self, cell: Any) -> Any:
        """An input or variable, its range shifted so that it begins at 0 where it would be negative."""
        self._made[cell] = made = type(cell)(name=cell.name, type=copied(cell.type, self._made))
        if isinstance(made.type, ex.EnumerationType):
            made.type.first = made.type.last = None
        if isinstance(made.type, ex.IntegerType):
            low, high = (bound + shift(cell) for bound in bounds(cell))
            made.type.minimum, made.type.maximum = low, high
            if high > LARGEST:
                self._faults[cell] = "its range does not fit 32 bits"
        if isinstance(cell, sct.DiscreteVariable) and cell not in self._faults:
            assert cell.initial is not None
            made.initial = self._lowering.assigned(cell, cell.initial)
        return made

    def _number_locations(self, plant: sct.Plant, made: sct.Plant) -> None:
        """A variable for the number of the location that a plant is in, and a location without a name for all."""
        start = next(number for number, location in enumerate(plant.locations) if location.initial)
        variable = sct.DiscreteVariable(
            name="choice",
            type=ex.IntegerType(minimum=0, maximum=len(plant.locations) - 1),
            initial=ex.IntegerLiteral(value=start),
        )
        only = sct.Location(name="", initial=True, marked=plant.locations[0].marked)
        made.variables.append(variable)
        made.locations.append(only)
        for number, location in enumerate(plant.locations):
            self._made[location] = only
            self._numbered[location] = variable, number

    def _edges(self, edges: Iterable[sct.Edge]) -> list[sct.Edge]:
        return [self._edge(edge) for edge in edges if edge.event not in self._impossible]

    def _edge(self, edge: sct.Edge) -> sct.Edge:
        guard = conjunction(filter(None, [*self._possible(edge), self._condition(edge.guard)]))
        made = sct.Edge(event=self._made[edge.event], guard=guard, target=self._made[edge.target])
        for update in edge.updates:
            value = self._lowered(None, self._lowering.assigned, update.variable, update.value)
            made.updates.append(sct.Update(variable=self._made[update.variable], value=value))
        if edge.target in self._numbered:
            variable, number = self._numbered[edge.target]
            made.updates.append(sct.Update(variable=variable, value=ex.IntegerLiteral(value=number)))
        return made

    def _possible(self, edge: sct.Edge) -> Iterator[ex.Expression]:
        """Conditions on the inputs of an event: that each is one of the literals that it can be.

        CIF's inputs can be each literal of an enumeration, so that the plant of the event excludes the others.
        """
        owner = edge.eContainer()
        if edge.event.eContainer() not in (owner, owner.eContainer()):
            return
        for carried in edge.event.inputs:
            if isinstance(carried.type, ex.EnumerationType):
                low, high = domain(carried.type)
                for place, literal in enumerate(carried.type.enumeration.literals):
                    if not low <= place <= high:
                        read = sct.InputReference(input=self._made[carried])
                        other = ex.EnumerationLiteralReference(literal=self._made[literal])
                        yield ex.Inequation(left=read, right=other)

    def _requirement(self, requirement: sct.Requirement) -> sct.Requirement:
        return sct.Requirement(
            name=requirement.name,
            text=requirement.text,
            event=self._made[requirement.event],
            kind=requirement.kind,
            condition=self._condition(requirement.condition),
        )

    def _supervisor(self, supervisor: sct.Supervisor) -> sct.Supervisor:
        """What the supervisor asks and adds, and how many states it leaves."""
        made = sct.Supervisor(
            uncontrolledStates=supervisor.uncontrolledStates, controlledStates=supervisor.controlledStates
        )
        for guard in supervisor.guards:
            if guard.event not in self._impossible:
                # A supervisor's guard is no text of the user's.
                requirement, synthesis = (
                    self._condition(part, guard.event) for part in (guard.requirement, guard.synthesis)
                )
                event = self._made[guard.event]
                made.guards.append(sct.EventGuard(event=event, requirement=requirement, synthesis=synthesis))
        return made

    def _condition(self, expression: ex.Expression | None, culprit: Any = None) -> ex.Expression | None:
        return None if expression is None else self._lowered(culprit, self._lowering.condition, expression)

    def _lowered(self, culprit: Any, lower: Callable[..., ex.Expression], *given: Any) -> ex.Expression | None:
        """What a method of the lowering makes; None where that can't be said, which is told of a culprit."""
        try:
            return lower(*given)
        except Unsupported as fault:
            self._faults.setdefault(fault.expression if culprit is None else culprit, fault.reason)
            return None


def _is_numbered(plant: sct.Plant) -> bool:
    """Whether a variable is to hold the number of the plant's location, its only location having all edges.

    So it is where data is chosen: every location has the same edges, and written for each of them they would be as many
    as the square of the choices.
    """
    return (
        plant.kind == sct.PlantKind.data
        and len(plant.locations) > 1
        and bool(plant.edges)
        and not any(location.edges for location in plant.locations)
        and len({location.marked for location in plant.locations}) == 1
    )


def _impossible(model: sct.SupervisoryControlModel) -> set[sct.Event]:
    """The events of which all edges have the guard `false` and which nothing else speaks of: they need not be said.

    So it is with `c_none` where a provide statement has no condition. CIF warns of an event that can never happen.
    """
    found = {event for plant in model.plants for event in plant.events}
    found -= {requirement.event for requirement in model.requirements}
    for plant in model.plants:
        for edge in edges_of(plant):
            never = isinstance(edge.guard, ex.BooleanLiteral) and not edge.guard.value
            if not never or edge.event.eContainer() is not plant:
                found.discard(edge.event)
    return found
