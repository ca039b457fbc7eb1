"""Reads generated CIF back into an sct model, by a grammar of exactly what is generated."""

import re
from functools import cache, reduce
from pathlib import Path
from typing import Any

from textx import metamodel_from_file

from robosc.metamodel import expression as ex
from robosc.metamodel import sct

_KINDS = {"message": "message", "service": "service", "action": "action", "component": "behaviour", "data": "data"}
_EVENTS = [each.name for each in sct.EventKind.eLiterals]  # type: ignore[attr-defined]
_REMARK = re.compile(r" // (\$?\w+) \+ (\d+), with \1 in (-\d+)\.\.(-?\d+)")
_COMPARISONS = {
    "=": ex.Equation,
    "!=": ex.Inequation,
    "<": ex.LessThan,
    "<=": ex.LessOrEqual,
    ">": ex.GreaterThan,
    ">=": ex.GreaterOrEqual,
}


@cache
def _grammar() -> Any:
    return metamodel_from_file(Path(__file__).with_name("cif.tx"), autokwd=True)


def rebuild(text: str) -> sct.SupervisoryControlModel:
    """The model that a specification says; raises TextXSyntaxError or KeyError where it says none.

    A variable that was shifted is shifted back: every reading of it has the shift added, every value subtracted.
    """
    return _Rebuilding(text).model


class _Rebuilding:
    def __init__(self, text: str) -> None:
        self.text = text
        self.names: dict[str, Any] = {}
        self.shifts: dict[Any, int] = {}
        read = _grammar().model_from_str(text)
        self.model = sct.SupervisoryControlModel(name=re.match(r"// The plants .*?\bof (\w+)", text).group(1))
        for each in read.enumerations:
            self.enumeration(each)
        for each in read.plants:
            self.declare(each)
        for each in read.plants:
            self.fill(each)
        self.model.requirements.extend(self.requirement(each.restriction) for each in read.requirements)
        if read.supervisor:
            self.model.supervisor = self.supervisor(read)

    def define(self, element: Any, scope: str = "") -> Any:
        """Makes an element known by its name; a name is given once in a scope."""
        name = f"{scope}{element.name}"
        assert name not in self.names, name
        self.names[name] = element
        return element

    def find(self, name: Any, plant: Any) -> Any:
        """What a name means inside a plant: the nearest thing of this name."""
        bare = name.replace("$", "")
        if plant is not None and f"{plant.name}.{bare}" in self.names:
            return self.names[f"{plant.name}.{bare}"]
        return self.names[bare]

    def enumeration(self, read: Any) -> None:
        made = self.define(ex.Enumeration(name=_plain(read.name)))
        self.model.enumerations.append(made)
        made.literals.extend(self.define(ex.EnumerationLiteral(name=_plain(each))) for each in read.literals)

    def declare(self, read: Any) -> None:
        name = _plain(read.name)
        kind = getattr(sct.PlantKind, _KINDS.get(name.partition("_")[0], "behaviour"))
        plant = self.define(sct.Plant(name=name, kind=kind))
        self.model.plants.append(plant)
        scope = f"{name}."
        for events in read.events:
            for each in events.names:
                stem = _plain(each).partition("_")[2].rstrip("_0123456789")
                event_kind = "data" if kind is sct.PlantKind.data else stem if stem in _EVENTS else "trigger"
                event = sct.Event(
                    name=_plain(each), controllable=events.controllable, kind=getattr(sct.EventKind, event_kind)
                )
                plant.events.append(self.define(event, scope))
        for each in read.inputs:
            made = sct.Input(name=_plain(each.name))
            made.type = self.type(each, made)
            plant.inputs.append(self.define(made, scope))
            for event in plant.events:
                if made.name.startswith(f"i_{event.name.rstrip('_').partition('_')[2]}"):
                    event.inputs.append(made)
        for each in read.variables:
            variable = sct.DiscreteVariable(name=_plain(each.name))
            variable.type = self.type(each, variable)
            plant.variables.append(self.define(variable, scope))
        for each in read.locations:
            location = sct.Location(name=_plain(each.name) or "ready", initial=each.initial, marked=each.marked)
            plant.locations.append(self.define(location, scope))

    def type(self, read: Any, element: Any) -> ex.Type:
        if type(read.type).__name__ == "Boolean":
            return ex.BooleanType()
        if type(read.type).__name__ == "Named":
            return ex.EnumerationType(enumeration=self.find(read.type.enumeration, None))
        low, high = int(read.type.low), int(read.type.high)
        remark = _REMARK.match(self.text, read._tx_position_end)
        if remark:
            shift = int(remark.group(2))
            assert (_plain(remark.group(1)), int(remark.group(3)), int(remark.group(4))) == (
                element.name,
                low - shift,
                high - shift,
            )
            self.shifts[element] = shift
            low, high = low - shift, high - shift
        return ex.IntegerType(minimum=low, maximum=high)

    def fill(self, read: Any) -> None:
        plant = self.find(read.name, None)
        for variable, each in zip(plant.variables, read.variables, strict=True):
            value = self.expression(each.initial, plant)
            shift = self.shifts.get(variable, 0)
            if shift:
                number = value.value - shift
                literal = ex.IntegerLiteral(value=abs(number))
                value = literal if number >= 0 else ex.UnaryMinus(operand=literal)
            variable.initial = value
        for location, each in zip(plant.locations, read.locations, strict=True):
            location.edges.extend(self.edge(edge, location, plant) for edge in each.edges)

    def edge(self, read: Any, location: Any, plant: Any) -> sct.Edge:
        target = self.find(read.target, plant) if read.target else location
        edge = sct.Edge(event=self.find(read.event, plant), target=target)
        if read.guard:
            edge.guard = self.expression(read.guard, plant)
        for each in read.updates:
            variable = self.find(each.variable, plant)
            value = self.expression(each.value, plant)
            if variable in self.shifts:
                value = ex.Subtraction(left=value, right=ex.IntegerLiteral(value=self.shifts[variable]))
            edge.updates.append(sct.Update(variable=variable, value=value))
        return edge

    def requirement(self, read: Any) -> sct.Requirement:
        return sct.Requirement(
            event=self.find(read.event, None),
            kind=getattr(sct.RequirementKind, type(read).__name__.lower()),
            condition=self.expression(read.condition, None),
        )

    def supervisor(self, read: Any) -> sct.Supervisor:
        made = sct.Supervisor()
        kept = {each.restriction.event: each.restriction.condition for each in read.supervisorInvariants}
        assert read.supervisor.alphabet == [each.event for each in read.supervisor.edges]
        for each in read.supervisor.edges:
            guard = sct.EventGuard(event=self.find(each.event, None))
            if each.event in kept:
                guard.requirement = self.expression(kept[each.event], None)
            if each.guard:
                guard.synthesis = self.expression(each.guard, None)
            made.guards.append(guard)
        return made

    def expression(self, read: Any, plant: Any) -> ex.Expression:  # noqa: C901 - one case for each grammar rule
        def of(each: Any) -> ex.Expression:
            return self.expression(each, plant)

        match type(read).__name__:
            case "Expression":
                return ex.Implication(left=of(read.left), right=of(read.right)) if read.operator else of(read.left)
            case "Or" | "And" | "Sum" as rule:
                kind = {"Or": ex.Disjunction, "And": ex.Conjunction, "Sum": ex.Addition}[rule]
                return reduce(lambda left, right: kind(left=left, right=right), map(of, read.operands))
            case "Compared":
                made = of(read.left)
                for operator, right in zip(read.operators, read.rights, strict=True):
                    made = _COMPARISONS[operator](left=made, right=of(right))
                return made
            case "Negation":
                return ex.Negation(operand=of(read.operand))
            case "Truth":
                return ex.BooleanLiteral(value=read.value == "true")
            case "Literal":
                return ex.IntegerLiteral(value=int(read.value))
            case "Group":
                return of(read.inner)
            case "Choice":
                made = of(read.otherwise)
                for guard, value in reversed(list(zip(read.conditions, read.values, strict=True))):
                    made = ex.Conditional(condition=of(guard), then=of(value), otherwise=made)
                return made
        assert type(read).__name__ == "Reference"
        return self.reference(self.find(read.name, plant))

    def reference(self, element: Any) -> ex.Expression:
        made: ex.Expression
        match element:
            case sct.DiscreteVariable():
                made = sct.VariableReference(variable=element)
            case sct.Input():
                made = sct.InputReference(input=element)
            case sct.Location():
                return sct.LocationReference(location=element)
            case _:
                assert isinstance(element, ex.EnumerationLiteral)
                return ex.EnumerationLiteralReference(literal=element)
        shift = self.shifts.get(element, 0)
        return ex.Addition(left=made, right=ex.IntegerLiteral(value=shift)) if shift else made


def _plain(name: str | None) -> str:
    return (name or "").removeprefix("$")
