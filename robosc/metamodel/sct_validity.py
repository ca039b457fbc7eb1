"""What makes an sct model one that can be synthesized, run and generated from."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.metamodel.expression_types import ExpressionTypes
from robosc.semantics.edges import edges_of
from robosc.semantics.typing import BOOLEAN, declared_type

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

_TYPES = (ex.BooleanType, ex.IntegerType, ex.EnumerationType)
_FOREIGN = (ex.DoubleLiteral, ex.StringLiteral, ex.DoubleConversion, ex.Division)
Fault = tuple[Any, str]


def sct_faults(model: sct.SupervisoryControlModel, elements: Sequence[Any]) -> Iterator[Fault]:
    """What is wrong with the model, of which `elements` are all, each before what it contains."""
    types = ExpressionTypes()
    types.add(elements)
    yield from types.faults
    yield from _names(model)
    own = set(elements)
    for element in elements:
        yield from _element(element, own)
    for plant in model.plants:
        yield from _plant(plant, types)
    yield from _unused(model)
    for element in elements:
        yield from _conditions(element, types)
    yield from _supervisor(model)


def _repeated(elements: Sequence[Any]) -> Iterator[Fault]:
    """The elements whose name an earlier one has."""
    seen = Counter[str]()
    for element in elements:
        seen[element.name] += 1
        if seen[element.name] > 1:
            yield element, f"the name '{element.name}' is given twice"


def _names(model: sct.SupervisoryControlModel) -> Iterator[Fault]:
    yield from _repeated(model.plants)
    yield from _repeated(model.enumerations)
    for enumeration in model.enumerations:
        yield from _repeated(enumeration.literals)
    for plant in model.plants:
        for members in (plant.events, plant.inputs, plant.variables, plant.locations):
            yield from _repeated(members)


#: The features by which elements refer to what is to be of the same model.
_REFERENCES = ("enumeration", "literal", "location", "variable", "input", "event")


def _element(element: Any, own: set[Any]) -> Iterator[Fault]:
    match element:
        case sct.Input() | sct.DiscreteVariable() if not isinstance(element.type, _TYPES):
            yield element, f"{type(element.type).__name__} has no place in an sct model"
        case ex.IntegerType():
            if element.minimum is None or element.maximum is None:
                yield element, "both bounds of an integer are given in an sct model"
            elif element.minimum > element.maximum:
                yield element, f"the range {element.minimum}..{element.maximum} is reversed"
        case sct.Requirement() | sct.EventGuard() if not element.event.controllable:
            yield element, f"the event '{element.event.name}' is uncontrollable: nothing can restrict it"
    for name in _REFERENCES:
        referred = getattr(element, name, None)
        if referred is not None and referred not in own:
            yield element, f"the {name} '{referred.name}' is another model's"
    if isinstance(element, _FOREIGN):
        yield element, f"{type(element).__name__} has no place in an sct model"


def _plant(plant: sct.Plant, types: ExpressionTypes) -> Iterator[Fault]:
    initial = sum(location.initial for location in plant.locations)
    if initial != 1:
        yield plant, f"plant '{plant.name}' has {initial or 'no'} initial locations; it starts in exactly one"
    for event in plant.events:
        for carried in event.inputs:
            if carried.eContainer() is not plant:
                yield event, f"the input '{carried.name}' is another plant's"
    for variable in plant.variables:
        yield from _initial(variable, types)
    everywhere: set[sct.Event] = set()
    yield from _twice(plant, f"plant '{plant.name}' has in every location", everywhere)
    for location in plant.locations:
        if location.edges:
            yield from _twice(location, f"location '{location.name}' has", set(everywhere))
    for edge in edges_of(plant):
        if edge.target.eContainer() is not plant:
            yield edge, f"the target '{edge.target.name}' is another plant's location"
        yield from _updates(edge, plant, types)


def _twice(leaving: sct.Location | sct.Plant, where: str, seen: set[sct.Event]) -> Iterator[Fault]:
    """The edges for events that an edge before has, or that are `seen` already; adds to these."""
    for edge in leaving.edges:
        if edge.event in seen:
            yield edge, f"{where} two edges for '{edge.event.name}'"
        seen.add(edge.event)


def _unused(model: sct.SupervisoryControlModel) -> Iterator[Fault]:
    """The events on no edge: whether they can happen, or never, nobody could say."""
    used = {edge.event for plant in model.plants for edge in edges_of(plant)}
    for plant in model.plants:
        for event in plant.events:
            if event not in used:
                yield event, f"no plant has an edge for the event '{event.name}'"


def _updates(edge: sct.Edge, plant: sct.Plant, types: ExpressionTypes) -> Iterator[Fault]:
    seen = set()
    for update in edge.updates:
        variable = update.variable
        if variable.eContainer() is not plant:
            yield update, f"the variable '{variable.name}' is another plant's"
        if variable in seen:
            yield update, f"the variable '{variable.name}' is updated twice"
        seen.add(variable)
        yield from types.unless(update.value, declared_type(variable.type))


def _initial(variable: sct.DiscreteVariable, types: ExpressionTypes) -> Iterator[Fault]:
    yield from types.unless(variable.initial, declared_type(variable.type))
    value = variable.initial
    sign = 1
    if isinstance(value, ex.UnaryMinus):
        sign, value = -1, value.operand
    constant = isinstance(value, (ex.BooleanLiteral, ex.IntegerLiteral, ex.EnumerationLiteralReference))
    if not constant:
        yield variable.initial, "an initial value is a literal"
    elif isinstance(value, ex.IntegerLiteral) and isinstance(variable.type, ex.IntegerType):
        minimum, maximum = variable.type.minimum, variable.type.maximum
        if minimum is not None and maximum is not None and not minimum <= sign * value.value <= maximum:
            yield variable.initial, f"{sign * value.value} is outside {minimum}..{maximum}"


def _conditions(element: Any, types: ExpressionTypes) -> Iterator[Fault]:
    match element:
        case sct.Edge() if element.guard is not None:
            yield from types.unless(element.guard, BOOLEAN)
        case sct.Requirement():
            yield from types.unless(element.condition, BOOLEAN)
        case sct.EventGuard():
            for part in (element.requirement, element.synthesis):
                if part is not None:
                    yield from types.unless(part, BOOLEAN)
        case sct.InputReference():
            yield from _read(element)


def _read(reference: sct.InputReference) -> Iterator[Fault]:
    """An input is read in updates on edges of an event that names it, and nowhere else."""
    around = reference.eContainer()
    while isinstance(around, ex.Expression):
        around = around.eContainer()
    if not isinstance(around, sct.Update):
        yield reference, "an input is read in updates only"
    elif reference.input not in around.eContainer().event.inputs:
        yield reference, f"'{around.eContainer().event.name}' does not carry the input '{reference.input.name}'"


def _supervisor(model: sct.SupervisoryControlModel) -> Iterator[Fault]:
    if model.supervisor is None:
        return
    guarded = Counter(guard.event for guard in model.supervisor.guards)
    for guard in model.supervisor.guards:
        if guarded[guard.event] > 1:
            yield guard, f"the event '{guard.event.name}' has more than one guard"
        if any(
            requirement.event is not guard.event or requirement not in model.requirements
            for requirement in guard.requirements
        ):
            yield guard, f"a requirement of this guard is not one on '{guard.event.name}'"
    for plant in model.plants:
        for event in plant.events:
            if event.controllable and event not in guarded:
                yield model.supervisor, f"the event '{plant.name}.{event.name}' has no guard"
