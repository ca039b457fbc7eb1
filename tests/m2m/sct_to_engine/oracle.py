"""The meaning of sct models, derived from their definition and not from the tool's transformations."""

from collections.abc import Mapping, Sequence

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.edges import edges_from, edges_of
from robosc.model.semantics.evaluation import evaluate, saturate
from robosc.model.semantics.start import first_state

#: The location of each plant and the value of each variable: an integer, a boolean or a literal.
State = dict[sct.Plant | sct.DiscreteVariable, object]


def started(model: sct.SupervisoryControlModel) -> State:
    """Return the initial state, or the first initial state that the supervisor permits."""
    found = first_state(model)
    state: State = {}
    for plant in model.plants:
        state[plant] = plant.locations[found[plant]]
        for variable in plant.variables:
            domain, number = variable.type, found[variable]
            state[variable] = number if isinstance(domain, ex.IntegerType) else values(domain)[number]
    return state


def value(expression: ex.Expression, state: State, inputs: Mapping[sct.Input, object] | None = None) -> object:
    """Return the value of an expression in a state."""

    def read(reference: ex.Expression) -> object:
        match reference:
            case sct.LocationReference(location=location):
                return state[location.eContainer()] is location
            case sct.VariableReference(variable=variable):
                return state[variable]
            case sct.InputReference(input=declared):
                return (inputs or {})[declared]
        assert isinstance(reference, ex.EnumerationLiteralReference)
        return reference.literal

    return evaluate(expression, read)


def blocked(model: sct.SupervisoryControlModel, event: sct.Event, state: State) -> str | None:
    """Return the first cause that blocks an event (plant, requirement or synthesis), or None if it can happen."""
    guard = next((guard for guard in model.supervisor.guards if guard.event is event), None)
    if without_edge(model, event, state):
        return "plant"
    if guard is not None and not _holds(guard.requirement, state):
        return "requirement"
    return "synthesis" if guard is not None and not _holds(guard.synthesis, state) else None


def failing(model: sct.SupervisoryControlModel, event: sct.Event, state: State) -> list[sct.Requirement]:
    """Return the requirements that forbid an event."""
    return [
        requirement
        for requirement in model.requirements
        if requirement.event is event
        and _holds(requirement.condition, state) == (requirement.kind == sct.RequirementKind.disables)
    ]


def without_edge(model: sct.SupervisoryControlModel, event: sct.Event, state: State) -> list[tuple[str, str]]:
    """Return the plants that block an event, each with its location."""
    # The data do not decide this: they arrive when the event already happens.
    data = {declared: next(iter(values(declared.type))) for declared in event.inputs}
    possible = _possible(model, event, state, data)
    return [(plant.name, state[plant].name) for plant, edges in possible.items() if not edges]


def after(
    model: sct.SupervisoryControlModel, event: sct.Event, state: State, inputs: Mapping[sct.Input, object]
) -> list[State]:
    """Return the states that a possible event can lead to, in the text order of its edges.

    There is one state, except for uncontrollable events of models from CIF. There, a plant may have several possible
    edges.
    """
    states = [dict(state)]
    for edges in _possible(model, event, state, inputs).values():
        states = [{**changed, **_changes(edge, state, inputs)} for changed in states for edge in edges]
    return states


def values(kind: ex.Type) -> Sequence[object]:
    """Return all values of a type."""
    match kind:
        case ex.BooleanType():
            return (False, True)
        case ex.EnumerationType(enumeration=enumeration):
            return list(enumeration.literals)
    assert isinstance(kind, ex.IntegerType)
    return range(kind.minimum, kind.maximum + 1)


def _changes(edge: sct.Edge, state: State, inputs: Mapping[sct.Input, object]) -> State:
    changed: State = {edge.target.eContainer(): edge.target}
    for update in edge.updates:
        given, kind = value(update.value, state, inputs), update.variable.type
        if isinstance(kind, ex.IntegerType):
            given = saturate(given, kind.minimum, kind.maximum)
        changed[update.variable] = given
    return changed


def _possible(
    model: sct.SupervisoryControlModel,
    event: sct.Event,
    state: State,
    inputs: Mapping[sct.Input, object] | None = None,
) -> dict[sct.Plant, list[sct.Edge]]:
    """Return the possible edges of each plant that has the event in its alphabet."""
    return {
        plant: [edge for edge in edges_from(state[plant]) if edge.event is event and _holds(edge.guard, state, inputs)]
        for plant in model.plants
        if any(edge.event is event for edge in edges_of(plant))
    }


def _holds(condition: ex.Expression | None, state: State, inputs: Mapping[sct.Input, object] | None = None) -> bool:
    return condition is None or bool(value(condition, state, inputs))
