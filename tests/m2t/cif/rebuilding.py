"""Rebuild the original sct model from generated CIF that was read back: kinds, shifts, guards."""

import re
from typing import Any

from robosc.analysis.verify.cif_reading import read
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.reflection import tree

_KINDS = {"message": "message", "service": "service", "action": "action", "component": "behaviour", "data": "data"}
_EVENTS = [literal.name for literal in sct.EventKind.eLiterals]  # type: ignore[attr-defined]
_PLANT = re.compile(r"plant \$?(\w+):")
_SHIFTED = re.compile(r'  @doc\("\$?(\w+) \+ (\d+), with \$?\1 in (-\d+)\.\.(-?\d+)"\)')


def rebuild(text: str) -> sct.SupervisoryControlModel:
    """Return the model of a specification; raises CifError if it has none.

    A shifted variable is shifted back, as its comment states: each read adds the shift, each assigned value subtracts
    it.
    """
    specification = read(text)
    model = specification.model
    model.name = re.match(r'@@doc\("The plants .*?\bof (\w+)', text).group(1)
    for plant in model.plants:
        _name_kinds(plant)
    if specification.supervisor is not None:
        kept = {invariant.event: invariant.condition for invariant in specification.invariants}
        edges = list(specification.supervisor.locations[0].edges)
        assert specification.alphabet == [edge.event for edge in edges]
        model.supervisor = sct.Supervisor(
            guards=[
                sct.EventGuard(event=edge.event, requirement=kept.get(edge.event), synthesis=edge.guard)
                for edge in edges
            ]
        )
    _give_locations(model)
    _shift_back(model, _shifts(model, text))
    return model


def _give_locations(model: sct.SupervisoryControlModel) -> None:
    """Restore the locations of data plants that CIF numbers in a variable, with edges from all of them."""
    numbers = {}
    for plant in model.plants:
        if plant.name.startswith("data_") and [location.name for location in plant.locations] == [""]:
            number = plant.variables[-1]
            assert number.name.startswith("choice")
            (only,) = plant.locations
            names = ["none", *(f"d{index}" for index in range(1, number.type.maximum + 1))]
            plant.locations.extend(sct.Location(name=name, marked=only.marked) for name in names)
            plant.locations.remove(only)
            plant.locations[number.initial.value].initial = True
            for edge in list(only.edges):
                chosen = edge.updates[-1]
                assert chosen.variable is number
                edge.updates.remove(chosen)
                edge.target = plant.locations[chosen.value.value]
                plant.edges.append(edge)
            plant.variables.remove(number)
            numbers[number] = plant
    for _, element in list(tree(model)):
        if isinstance(element, ex.Equation) and getattr(element.left, "variable", None) in numbers:
            location = numbers[element.left.variable].locations[element.right.value]
            setattr(element.eContainer(), element.eContainmentFeature().name, sct.LocationReference(location=location))


def _name_kinds(plant: sct.Plant) -> None:
    """Restore the kinds of a plant and its events from the prefixes of their names, and the event of an input."""
    plant.kind = getattr(sct.PlantKind, _KINDS.get(plant.name.partition("_")[0], "behaviour"))
    for event in plant.events:
        stem = event.name.partition("_")[2].rstrip("_0123456789")
        kind = "data" if plant.kind is sct.PlantKind.data else stem if stem in _EVENTS else "trigger"
        event.kind = getattr(sct.EventKind, kind)
        carried = f"i_{event.name.rstrip('_').partition('_')[2]}"
        own = (input_ for input_ in plant.inputs if f"{input_.name}_".startswith(f"{carried}_"))
        event.inputs.extend(own)


def _shifts(model: sct.SupervisoryControlModel, text: str) -> dict[Any, int]:
    """Return the shift of each variable and input; restore the model's types."""
    shifts = {}
    members = {
        (plant.name, member.name): member for plant in model.plants for member in (*plant.variables, *plant.inputs)
    }
    plant = ""
    for line in text.splitlines():
        if heading := _PLANT.match(line):
            plant = heading.group(1)
        elif remark := _SHIFTED.match(line):
            element = members[plant, remark.group(1)]
            shift, low, high = map(int, remark.groups()[1:])
            assert (element.type.minimum, element.type.maximum) == (low + shift, high + shift)
            element.type = ex.IntegerType(minimum=low, maximum=high)
            shifts[element] = shift
    return shifts


def _shift_back(model: sct.SupervisoryControlModel, shifts: dict[Any, int]) -> None:
    for _, element in list(tree(model)):
        match element:
            case sct.VariableReference() | sct.InputReference():
                shift = shifts.get(element.variable if isinstance(element, sct.VariableReference) else element.input)
                if shift:
                    owner, feature = element.eContainer(), element.eContainmentFeature().name
                    setattr(owner, feature, ex.Addition(left=element, right=ex.IntegerLiteral(value=shift)))
            case sct.Update() if element.variable in shifts:
                element.value = ex.Subtraction(
                    left=element.value, right=ex.IntegerLiteral(value=shifts[element.variable])
                )
            case sct.DiscreteVariable() if element in shifts:
                number = element.initial.value - shifts[element]
                literal = ex.IntegerLiteral(value=abs(number))
                element.initial = literal if number >= 0 else ex.UnaryMinus(operand=literal)
