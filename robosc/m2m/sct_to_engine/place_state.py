"""Pass: what a model keeps in memory, each in the smallest storage that holds its values."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from robosc.metamodel import engine, sct
from robosc.metamodel import expression as ex
from robosc.semantics.domains import domain, storage
from robosc.semantics.naming import Names

if TYPE_CHECKING:
    from collections.abc import Iterator

_Declared = TypeVar("_Declared", bound=engine.Declaration)


def place_state(model: sct.SupervisoryControlModel) -> dict[sct.Plant | sct.DiscreteVariable, engine.StateVariable]:
    """The location of each plant that has several and each variable, in the order of the plants."""
    names = Names()
    placed: dict[sct.Plant | sct.DiscreteVariable, engine.StateVariable] = {}
    for plant in model.plants:
        for element, name, kind, initial in _state(plant):
            variable = element if isinstance(element, sct.DiscreteVariable) else None
            made = engine.StateVariable(plant=plant, variable=variable, name=names.fresh(name), initial=initial)
            placed[element] = _keep(made, kind)
    return placed


def place_inputs(model: sct.SupervisoryControlModel) -> dict[sct.Input, engine.Input]:
    """The data that comes with events."""
    placed = {}
    for plant in model.plants:
        for declared in plant.inputs:
            low, high = domain(declared.type)
            initial = min(max(0, low), high)
            name = f"{plant.name}.{declared.name}"
            placed[declared] = _keep(engine.Input(input=declared, name=name, initial=initial), declared.type)
    return placed


def _state(plant: sct.Plant) -> Iterator[tuple[sct.Plant | sct.DiscreteVariable, str, ex.Type, int]]:
    if len(plant.locations) > 1:
        initial = next(number for number, location in enumerate(plant.locations) if location.initial)
        yield plant, plant.name, engine.LocationType(plant=plant), initial
    for variable in plant.variables:
        yield variable, f"{plant.origin or plant.name}.{variable.name}", variable.type, literal_value(variable.initial)


def literal_value(literal: ex.Expression) -> int:
    """The value of a literal, with a sign or without."""
    match literal:
        case ex.UnaryMinus():
            return -literal_value(literal.operand)
        case ex.EnumerationLiteralReference():
            return list(literal.literal.eContainer().literals).index(literal.literal)
        case ex.BooleanLiteral() | ex.IntegerLiteral():
            return int(literal.value)
    raise ValueError(f"{type(literal).__name__} is no literal")


def _keep(declared: _Declared, kind: ex.Type) -> _Declared:
    """Says of what type it is, by a copy, as each type has one owner; its range, and its storage."""
    match kind:
        case ex.IntegerType():
            kind = ex.IntegerType(minimum=kind.minimum, maximum=kind.maximum)
        case ex.EnumerationType():
            kind = ex.EnumerationType(enumeration=kind.enumeration)
        case ex.BooleanType():
            kind = ex.BooleanType()
    declared.type = kind
    declared.minimum, declared.maximum = domain(kind)
    declared.bits, declared.signed = storage(domain(kind))
    return declared
