"""Checks of sct models before synthesis, execution and generation."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.communication import IDLE, REQUESTS
from robosc.model.semantics.domains import domain
from robosc.model.semantics.durations import LONGEST, SHORTEST, UNITS
from robosc.model.semantics.edges import edges_of
from robosc.model.semantics.operators import FUNCTIONS
from robosc.model.semantics.roles import is_from_cif
from robosc.model.semantics.typing import BOOLEAN, declared_type
from robosc.model.validity.model_checks import around, check_type, demand, find_duplicates, fitting_operands, unique

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.model.validity.model_checks import Checks, Fault, Model

#: Features that must refer to elements of the same model.
_REFERENCES = ("enumeration", "literal", "location", "variable", "input", "event")


def _references(element: Any, model: Model) -> Iterator[Fault]:
    for name in _REFERENCES:
        referred = getattr(element, name, None)
        if referred is not None and referred not in model.own:
            yield element, f"the {name} '{referred.name}' belongs to another model"


def _bounds(integer: ex.IntegerType, _model: Model) -> Iterator[Fault]:
    if integer.minimum is None or integer.maximum is None:
        yield integer, "an integer in an sct model must have both bounds"
    elif integer.minimum > integer.maximum:
        yield integer, f"the range {integer.minimum}..{integer.maximum} is reversed"


def _initial_location(plant: sct.Plant, model: Model) -> Iterator[Fault]:
    initial = sum(location.initial for location in plant.locations)
    if initial != 1 and not (initial and is_from_cif(model.root)):
        yield plant, f"plant '{plant.name}' has {initial or 'no'} initial locations, expected exactly one"


def _end_of_action(plant: sct.Plant, _model: Model) -> Iterator[Fault]:
    """Check that an action does not end when it is canceled, as it did in models of the first two editions."""
    ended = (edge for edge in edges_of(plant) if edge.event.kind == sct.EventKind.cancel and edge.target.name == IDLE)
    if plant.kind == sct.PlantKind.action and any(ended):
        message = f"the action '{plant.origin or plant.name}' ends where it is canceled, as in older models"
        yield plant, f"{message}; generate this model again from its text: `robosc transform MODEL.rscd --to xmi`"


def _assumption(plant: sct.Plant, _model: Model) -> Iterator[Fault]:
    """Check that an assumption is about messages, feedback, responses and requests, and has one location."""
    kinds = (sct.EventKind.response, sct.EventKind.feedback, *REQUESTS)
    fits = len(plant.locations) == 1 and all(edge.event.kind in kinds for edge in edges_of(plant))
    if plant.kind == sct.PlantKind.assumption and not fits:
        yield plant, f"the assumption '{plant.name}' needs one location, and edges for data from the robot only"


def _initial_value(variable: sct.DiscreteVariable, model: Model) -> Iterator[Fault]:
    if variable.initial is None:
        if not is_from_cif(model.root):
            yield variable, f"the variable '{variable.name}' has no initial value"
        return
    value, sign = variable.initial, 1
    if isinstance(value, ex.UnaryMinus):
        value, sign = value.operand, -1
    if not isinstance(value, (ex.BooleanLiteral, ex.IntegerLiteral, ex.EnumerationLiteralReference)):
        yield variable.initial, "an initial value must be a literal"
    elif isinstance(value, ex.IntegerLiteral) and isinstance(variable.type, ex.IntegerType):
        minimum, maximum = variable.type.minimum, variable.type.maximum
        if minimum is not None and maximum is not None and not minimum <= sign * value.value <= maximum:
            yield variable.initial, f"{sign * value.value} is outside {minimum}..{maximum}"


def _one_edge(plant: sct.Plant, model: Model) -> Iterator[Fault]:
    """Check that edges of a location, or of a plant, for the same event all have guards."""
    for edge in _unguarded(plant.edges):
        yield edge, f"plant '{plant.name}' has in every location two edges for '{edge.event.name}', one without guard"
    everywhere = {edge.event for edge in plant.edges}
    for location in plant.locations:
        again = set() if is_from_cif(model.root) else set(_unguarded(location.edges))
        for edge in location.edges:
            if edge in again:
                yield edge, f"location '{location.name}' has two edges for '{edge.event.name}', one without guard"
            elif edge.event in everywhere:
                yield edge, f"location '{location.name}' has two edges for '{edge.event.name}'"


def _predicates(model: sct.SupervisoryControlModel, checked: Model) -> Iterator[Fault]:
    for predicate in (*model.initialPredicates, *model.markerPredicates):
        yield from checked.unlike(predicate, BOOLEAN)


def _unguarded(edges: Iterable[sct.Edge]) -> list[sct.Edge]:
    """Return the edges after the first for an event that has several edges and one without guard."""
    lone = {edge.event for edge in edges if edge.guard is None}
    return [edge for edge in find_duplicates(edges, lambda edge: edge.event) if edge.event in lone]


def _carried(event: sct.Event, _model: Model) -> Iterator[Fault]:
    for carried in event.inputs:
        if carried.eContainer() is not event.eContainer():
            yield event, f"the input '{carried.name}' belongs to another plant"


def _updated_once(edge: sct.Edge, _model: Model) -> Iterator[Fault]:
    for update in find_duplicates(edge.updates, lambda update: update.variable):
        yield update, f"the variable '{update.variable.name}' is updated twice"


def _used(model: sct.SupervisoryControlModel, _model: Model) -> Iterator[Fault]:
    """Check that each event has an edge. Without one, it is undefined whether the event can happen."""
    used = {edge.event for plant in model.plants for edge in edges_of(plant)}
    for plant in model.plants:
        for event in plant.events:
            if event not in used:
                yield event, f"no plant has an edge for the event '{event.name}'"


def _read(reference: sct.InputReference, _model: Model) -> Iterator[Fault]:
    """Check that only edges and requirements of an event that carries the input read it."""
    user = reference.eContainer()
    while isinstance(user, ex.Expression | sct.Update):
        user = user.eContainer()
    if not isinstance(user, sct.Edge | sct.Requirement | sct.EventGuard):
        yield reference, "an input can be read only in guards, updates of edges, and requirements"
    elif reference.input not in user.event.inputs:
        yield reference, f"'{user.event.name}' does not carry the input '{reference.input.name}'"


def _part(kind: ex.EnumerationType, _model: Model) -> Iterator[Fault]:
    """Check that only an input has a part of an enumeration, from a literal to the same or a later one."""
    literals = list(kind.enumeration.literals)
    ends = [literal for literal in (kind.first, kind.last) if literal is not None]
    for literal in ends:
        if literal not in literals:
            yield kind, f"'{literal.name}' is not a literal of {kind.enumeration.name}"
            return
    if ends and not isinstance(kind.eContainer(), sct.Input):
        yield kind, "only an input can have a part of an enumeration"
    elif domain(kind).low > domain(kind).high:
        yield kind, f"'{ends[0].name}' stands behind '{ends[1].name}'"


def _guards(supervisor: sct.Supervisor, model: Model) -> Iterator[Fault]:
    guarded = Counter(guard.event for guard in supervisor.guards)
    for guard in supervisor.guards:
        if guarded[guard.event] > 1:
            yield guard, f"the event '{guard.event.name}' has more than one guard"
        if any(
            requirement.event is not guard.event or requirement not in model.root.requirements
            for requirement in guard.requirements
        ):
            yield guard, f"a requirement of this guard does not restrict '{guard.event.name}'"
    for plant in model.root.plants:
        for event in plant.events:
            if event.controllable and event not in guarded:
                yield supervisor, f"the event '{plant.name}.{event.name}' has no guard"


def _timer(timer: sct.Timer, model: Model) -> Iterator[Fault]:
    """Check that the elements that restart a timer are in the same model and in its location."""
    if (timer.milliseconds is None) == (timer.duration is None):
        yield timer, "a time must have either milliseconds or a duration"
    if timer.milliseconds is not None and not SHORTEST <= timer.milliseconds <= LONGEST:
        yield timer, f"a time must be {SHORTEST} to {LONGEST} ms long, found {timer.milliseconds}"
    if timer.location is not None and timer.location.eContainer() is not around(timer, sct.Plant):
        yield timer, f"the location '{timer.location.name}' belongs to another plant"
    if timer.location is None and not timer.without:
        yield timer, "a time that runs in all locations must be the silence of a message"
    if any(edge.target is not timer.location for edge in timer.entries):
        yield timer, "an edge that enters the location leads elsewhere"
    for message in timer.without:
        if message.kind != sct.EventKind.response or message not in model.own:
            yield timer, f"'{message.name}' is not a message of this model that a component sends"


_SETTABLE = demand(
    lambda duration: (
        SHORTEST <= duration.shortest <= duration.milliseconds <= duration.longest <= LONGEST
        and duration.unit in UNITS.values()
    ),
    f"'{{0.parameter}}' must have the unit ms, s or min and a range within {SHORTEST} to {LONGEST} ms",
)
_TIMED = demand(
    lambda event: (
        (event.timer is not None) == (event.kind == sct.EventKind.timeout) and not (event.timer and event.controllable)
    ),
    "'{0.name}' must be either an uncontrollable timeout with a timer, or another event without timer",
)
_FOREIGN = demand(lambda _: False, "{0.eClass.name} is not allowed in an sct model")
_SUPERVISED = demand(
    lambda call: FUNCTIONS[call.function].is_supervised and len(call.arguments) == FUNCTIONS[call.function].parameters,
    "this call of '{0.function}' is not allowed in an sct model",
)
_PLAIN = demand(
    lambda declared: isinstance(declared.type, (ex.BooleanType, ex.IntegerType, ex.EnumerationType)),
    "{0.type.eClass.name} is not allowed in an sct model",
)
_CONTROLLABLE = demand(
    lambda restriction: restriction.event.controllable,
    "the event '{0.event.name}' is uncontrollable: no requirement can restrict it",
)
_RESTRICTABLE = demand(
    lambda requirement: (
        requirement.event.controllable
        or requirement.automaton is not None
        or requirement.event.kind == sct.EventKind.plain
    ),
    "the event '{0.event.name}' is uncontrollable: no requirement can restrict it",
)
_BOUND = demand(
    lambda required: required.bound is None or required.bound >= 0, "a bound on the number of events is not negative"
)
_OWN_TARGET = demand(
    lambda edge: edge.target.eContainer() is around(edge, sct.Plant),
    "the target '{0.target.name}' is a location of another plant",
)
_OWN_VARIABLE = demand(
    lambda update: update.variable.eContainer() is around(update, sct.Plant),
    "the variable '{0.variable.name}' belongs to another plant",
)

CHECKS: Checks = {
    ex.Expression: [fitting_operands],
    sct.SupervisoryControlModel: [unique("plants", "enumerations"), _used, _predicates],
    ex.Enumeration: [unique("literals")],
    sct.Plant: [
        unique("events", "inputs", "variables", "locations"),
        _initial_location,
        _one_edge,
        _end_of_action,
        _assumption,
    ],
    object: [_references],
    sct.Input: [_PLAIN],
    sct.DiscreteVariable: [
        _PLAIN,
        check_type("initial", lambda variable: declared_type(variable.type)),
        _initial_value,
    ],
    ex.IntegerType: [_bounds],
    ex.EnumerationType: [_part],
    ex.DoubleLiteral: [_FOREIGN],
    ex.StringLiteral: [_FOREIGN],
    ex.DoubleConversion: [_FOREIGN],
    ex.Division: [_FOREIGN],
    ex.FunctionCall: [_SUPERVISED],
    sct.Event: [_carried, _TIMED],
    sct.Timer: [_timer],
    sct.Duration: [_SETTABLE],
    sct.Edge: [_OWN_TARGET, check_type("guard"), _updated_once],
    sct.Update: [_OWN_VARIABLE, check_type("value", lambda update: declared_type(update.variable.type))],
    sct.Requirement: [_RESTRICTABLE, check_type("condition")],
    sct.StateInvariant: [check_type("condition")],
    sct.ReachabilityRequirement: [
        check_type("condition"),
        check_type("premise"),
        check_type("pathCondition"),
        _BOUND,
    ],
    sct.Property: [check_type("condition")],
    sct.ReachabilityProperty: [check_type("premise")],
    sct.EventGuard: [_CONTROLLABLE, check_type("requirement"), check_type("synthesis")],
    sct.InputReference: [_read],
    sct.Supervisor: [_guards, check_type("initial")],
}
