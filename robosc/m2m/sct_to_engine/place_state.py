"""Pass: places each state variable and input in the smallest storage that holds its values."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.semantics.domains import domain, storage
from robosc.model.semantics.naming import Names
from robosc.model.semantics.start import first_state
from robosc.model.semantics.walks import copy_tree

if TYPE_CHECKING:
    from collections.abc import Iterator

_Declared = TypeVar("_Declared", bound=engine.Declaration)


def place_state(model: sct.SupervisoryControlModel) -> dict[sct.Plant | sct.DiscreteVariable, engine.StateVariable]:
    """Return a variable for each plant with several locations and for each variable, in the order of the plants."""
    names = Names()
    placed: dict[sct.Plant | sct.DiscreteVariable, engine.StateVariable] = {}
    start = first_state(model)
    for plant in model.plants:
        for element, name, kind in _state(plant):
            variable = element if isinstance(element, sct.DiscreteVariable) else None
            placed_variable = engine.StateVariable(
                plant=plant, variable=variable, name=names.fresh(name), initial=start[element]
            )
            placed[element] = _keep(placed_variable, kind)
    return placed


def place_inputs(model: sct.SupervisoryControlModel) -> dict[sct.Input, engine.Input]:
    """Return the engine's inputs: the data of events."""
    placed = {}
    for plant in model.plants:
        for declared in plant.inputs:
            low, high = domain(declared.type)
            initial = min(max(0, low), high)
            name = f"{plant.name}.{declared.name}"
            placed[declared] = _keep(engine.Input(input=declared, name=name, initial=initial), declared.type)
    return placed


def _state(plant: sct.Plant) -> Iterator[tuple[sct.Plant | sct.DiscreteVariable, str, ex.Type]]:
    if len(plant.locations) > 1:
        yield plant, plant.name, engine.LocationType(plant=plant)
    for variable in plant.variables:
        yield variable, f"{plant.origin or plant.name}.{variable.name}", variable.type


def _keep(declared: _Declared, kind: ex.Type) -> _Declared:
    """Set the type, and from it the range and the storage. The type is copied because each type has one owner."""
    declared.type = copy_tree(kind)
    declared.minimum, declared.maximum = domain(kind)
    declared.bits, declared.signed = storage(domain(kind))
    return declared
