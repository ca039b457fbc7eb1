"""The meaning of sct models, read from their definition and not from what the tool makes of them."""

from collections.abc import Mapping

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.edges import edges_from, edges_of
from robosc.semantics.evaluation import evaluate, saturate

#: The location of each plant, and the value of each variable: an integer, a boolean or a literal.
State = dict[sct.Plant | sct.DiscreteVariable, object]


def initial(model: sct.SupervisoryControlModel) -> State:
    """The initial state."""
    state: State = {plant: next(place for place in plant.locations if place.initial) for plant in model.plants}
    for plant in model.plants:
        state |= {variable: value(variable.initial, {}) for variable in plant.variables}
    return state


def value(expression: ex.Expression, state: State, inputs: Mapping[sct.Input, object] | None = None) -> object:
    """The value of an expression in a state."""

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
    """What keeps an event from happening, the first of plant, requirement and synthesis; None where it can happen."""
    guard = next((guard for guard in model.supervisor.guards if guard.event is event), None)
    if any(edge is None or not _holds(edge.guard, state) for edge in _edges(model, event, state)):
        return "plant"
    if guard is not None and not _holds(guard.requirement, state):
        return "requirement"
    return "synthesis" if guard is not None and not _holds(guard.synthesis, state) else None


def failing(model: sct.SupervisoryControlModel, event: sct.Event, state: State) -> list[sct.Requirement]:
    """The requirements on an event that forbid it."""
    return [
        requirement
        for requirement in model.requirements
        if requirement.event is event
        and _holds(requirement.condition, state) == (requirement.kind == sct.RequirementKind.disables)
    ]


def without_edge(model: sct.SupervisoryControlModel, event: sct.Event, state: State) -> list[tuple[str, str]]:
    """The plants that keep an event from happening, each with its location."""
    plants = [plant for plant in model.plants if any(edge.event is event for edge in edges_of(plant))]
    edges = zip(plants, _edges(model, event, state), strict=True)
    return [(plant.name, state[plant].name) for plant, edge in edges if edge is None or not _holds(edge.guard, state)]


def after(
    model: sct.SupervisoryControlModel, event: sct.Event, state: State, inputs: Mapping[sct.Input, object]
) -> State:
    """The state after an event that can happen."""
    changed = dict(state)
    for edge in _edges(model, event, state):
        changed[edge.target.eContainer()] = edge.target
        for update in edge.updates:
            given, kind = value(update.value, state, inputs), update.variable.type
            if isinstance(kind, ex.IntegerType):
                given = saturate(given, kind.minimum, kind.maximum)
            changed[update.variable] = given
    return changed


def _edges(model: sct.SupervisoryControlModel, event: sct.Event, state: State) -> list[sct.Edge | None]:
    """The edge that each plant with the event in its alphabet would take."""
    return [
        next((edge for edge in edges_from(state[plant]) if edge.event is event), None)
        for plant in model.plants
        if any(edge.event is event for place in plant.locations for edge in edges_from(place))
    ]


def _holds(condition: ex.Expression | None, state: State) -> bool:
    return condition is None or bool(value(condition, state))
