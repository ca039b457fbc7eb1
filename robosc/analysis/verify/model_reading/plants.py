"""Meaning of the plants and requirements of an SCT model: an event happens in all plants that have it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.analysis.verify.model_reading.machine import (
    BOOLEANS,
    At,
    Claim,
    Condition,
    Event,
    EventEffect,
    EventInput,
    EventName,
    Length,
    Literal,
    Machine,
    Meaning,
    Participant,
    Plant,
    Restriction,
    Slot,
    Timer,
    compile_condition,
    saturate,
)
from robosc.model import expression as ex
from robosc.model import sct

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.analysis.verify.model_reading.machine import Domain, Value


class AmbiguousError(Exception):
    """Two edges with different targets or updates are possible at the same time."""

    def __init__(self, source: ex.Located | None) -> None:
        super().__init__("several edges with different ends are possible in the plants")
        self.source = source


def read_plants(model: sct.SupervisoryControlModel) -> Machine:
    """Return the reading of plants and requirements, without the supervisor."""
    return _PlantReading(model).run()


class _PlantReading:
    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self.model = model
        self.machine = Machine()
        observers = (plant for plant in model.plants if plant.kind == sct.PlantKind.requirement)
        assumptions = (plant for plant in model.plants if plant.kind == sct.PlantKind.assumption)
        numbers = {plant: number for plants in (observers, assumptions) for number, plant in enumerate(plants, start=1)}
        self.plants = {
            plant: Plant(plant.kind.name, str(numbers[plant]) if plant in numbers else plant.origin or plant.name)
            for plant in model.plants
        }

    def run(self) -> Machine:
        machine = self.machine
        for plant, called in self.plants.items():
            slot = Slot(called)
            machine.domains[slot] = tuple(location.name for location in plant.locations)
            # A second initial location gives a name that no text has.
            machine.initial[slot] = " and ".join(location.name for location in plant.locations if location.initial)
            machine.marked[slot] = frozenset(location.name for location in plant.locations if location.marked)
            machine.sources[slot] = plant
            for variable in plant.variables:
                target = Slot(called, variable.name)
                machine.domains[target] = _domain(variable.type)
                assert variable.initial is not None
                machine.initial[target] = compile_condition(variable.initial, self.meaning).compute({}, {})
                machine.sources[target] = variable
            for event in plant.events:
                machine.events[self.name(event)] = Event(
                    event.kind.name,
                    event.controllable,
                    event,
                    inputs={carried.name: _domain(carried.type) for carried in event.inputs},
                    timer=self.timer(event),
                )
        for plant in self.plants:
            self.edges(plant)
        for required in self.model.requirements:
            value = required.kind == sct.RequirementKind.needs
            restriction = Restriction(self.condition(required.condition), value, required)
            machine.events[self.name(required.event)].restrictions.append(restriction)
        self.claims()
        return machine

    def name(self, event: sct.Event) -> EventName:
        """Return the name of an event. Trailing underscores only distinguish it from others."""
        return EventName(self.plants[event.eContainer()], event.name.rstrip("_"))

    def timer(self, event: sct.Event) -> Timer | None:
        timer = event.timer
        if timer is None:
            return None
        without = frozenset(map(self.name, timer.without))
        length, duration = Length(timer.milliseconds or 0), timer.duration
        if duration is not None:
            length = Length(
                duration.milliseconds, duration.parameter, duration.unit, duration.shortest, duration.longest
            )
        return Timer(length, None if timer.location is None else timer.location.name, without)

    def meaning(self, reference: ex.Expression) -> Meaning:
        match reference:
            case sct.LocationReference(location=location):
                return At(Slot(self.plants[location.eContainer()]), location.name)
            case sct.VariableReference(variable=variable):
                return Slot(self.plants[variable.eContainer()], variable.name)
            case sct.InputReference():
                return EventInput(reference.input.name)
        assert isinstance(reference, ex.EnumerationLiteralReference)
        return Literal(reference.literal.name)

    def condition(self, expression: ex.Expression) -> Condition:
        return compile_condition(expression, self.meaning)

    def edges(self, plant: sct.Plant) -> None:
        """Add a participant for each event of a plant, with the edges of its locations."""
        everywhere: dict[sct.Event, list[sct.Edge]] = {}
        leaving: dict[sct.Event, dict[str, list[sct.Edge]]] = {}
        for edge in plant.edges:
            everywhere.setdefault(edge.event, []).append(edge)
        for location in plant.locations:
            for edge in location.edges:
                leaving.setdefault(edge.event, {}).setdefault(location.name, []).append(edge)
        for event in dict.fromkeys([*everywhere, *leaving]):
            participant = self.participant(plant, everywhere.get(event, []), leaving.get(event, {}))
            self.machine.events[self.name(event)].participants.append(participant)

    def participant(
        self, plant: sct.Plant, everywhere: list[sct.Edge], leaving: Mapping[str, list[sct.Edge]]
    ) -> Participant:
        slot = Slot(self.plants[plant])
        reads = {slot} if leaving else set()
        compiled_edges: dict[sct.Edge, Any] = {}
        for edge in [*everywhere, *(edge for edges in leaving.values() for edge in edges)]:
            guard = None if edge.guard is None else self.condition(edge.guard)
            updates = [
                (Slot(slot.plant, update.variable.name), self.condition(update.value)) for update in edge.updates
            ]
            compiled_edges[edge] = guard, updates
            reads.update(*(condition.reads for condition in [guard, *(value for _, value in updates)] if condition))
        domains = self.machine.domains

        def step(state: Mapping[Slot, Value], inputs: Mapping[str, Value]) -> EventEffect | None:
            effect: EventEffect | None = None
            for edge in [*leaving.get(str(state[slot]), ()), *everywhere] if leaving else everywhere:
                guard, updates = compiled_edges[edge]
                if guard is None or guard.compute(state, inputs):
                    values = {slot: saturate(value.compute(state, inputs), domains[slot]) for slot, value in updates}
                    taken = EventEffect({slot: edge.target.name, **values}, edge)
                    if effect is not None and effect.writes != taken.writes:
                        raise AmbiguousError(edge)
                    effect = taken
            return effect

        return Participant(step, frozenset(reads), plant)

    def claims(self) -> None:
        """Read the conditions of invariants and properties."""
        for invariant in self.model.invariants:
            self.claim("the condition of an invariant", invariant.condition, invariant)
        for required in self.model.reachabilityRequirements:
            self.claim("the reachable condition of a requirement", required.condition, required)
            premise = required.premise or ex.BooleanLiteral(value=True)
            self.claim("the condition after `from` of a requirement", premise, required)
            if required.pathCondition is not None:
                self.claim("the condition of the path of a requirement", required.pathCondition, required)
        for claimed in self.model.properties:
            if isinstance(claimed, sct.InvariantProperty):
                self.claim("the condition of a property", claimed.condition, claimed)
            elif isinstance(claimed, sct.ReachabilityProperty):
                self.claim("the reachable condition of a property", claimed.condition, claimed)
                origin = claimed.premise or ex.BooleanLiteral(value=True)
                self.claim("the start condition of a property", origin, claimed)

    def claim(self, what: str, expression: ex.Expression, source: ex.Located) -> None:
        self.machine.conditions.append(Claim(what, self.condition(expression), True, source))


def _domain(declared: ex.Type) -> Domain:
    if isinstance(declared, ex.EnumerationType):
        names = [literal.name for literal in declared.enumeration.literals]
        start = 0 if declared.first is None else names.index(declared.first.name)
        end = len(names) if declared.last is None else names.index(declared.last.name) + 1
        return tuple(names[start:end])
    if isinstance(declared, ex.IntegerType):
        assert declared.minimum is not None
        assert declared.maximum is not None
        return range(declared.minimum, declared.maximum + 1)
    assert isinstance(declared, ex.BooleanType)
    return BOOLEANS
