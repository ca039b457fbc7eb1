"""Reads generated CIF: exactly what is generated (grammar/cif.tx), and what that means in CIF, whoever wrote it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, reduce
from typing import TYPE_CHECKING, Any

import textx

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.resources import locate

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_OPERATORS: Mapping[str, type[ex.BinaryExpression]] = {
    "=": ex.Equation,
    "!=": ex.Inequation,
    "<": ex.LessThan,
    "<=": ex.LessOrEqual,
    ">": ex.GreaterThan,
    ">=": ex.GreaterOrEqual,
    "+": ex.Addition,
    "-": ex.Subtraction,
}
_CHAINS: Mapping[str, type[ex.BinaryExpression]] = {"Or": ex.Disjunction, "And": ex.Conjunction}


class CifError(ValueError):
    """A text that is not such a specification; says where and what is wrong."""


@dataclass(frozen=True)
class Specification:
    """What a specification says, with CIF's own names and numbers.

    `model` holds enumerations, plants and requirements; CIF knows no kinds of plants and events, nor which event
    carries an input. `supervisor` is the automaton with what synthesis added, in one location, None where there is
    none; `alphabet` are its events. `invariants` are what else holds under the supervisor.
    """

    model: sct.SupervisoryControlModel
    invariants: Sequence[sct.Requirement]
    supervisor: sct.Plant | None
    alphabet: Sequence[sct.Event]


@cache
def _grammar() -> Any:
    return textx.metamodel_from_file(str(locate("grammar/cif.tx")), autokwd=True)


def read(text: str) -> Specification:
    """The specification that a text is. Raises CifError."""
    try:
        return _Reading(_grammar().model_from_str(text)).specification
    except textx.TextXSyntaxError as fault:
        raise CifError(f"line {fault.line}, column {fault.col}: {fault.message}") from None


class _Reading:
    """From the objects of the grammar to those of the metamodel."""

    def __init__(self, read: Any) -> None:
        self._names: dict[str, Any] = {}
        model = sct.SupervisoryControlModel(name="")
        model.enumerations.extend(map(self._enumeration, read.enumerations))
        model.plants.extend(map(self._declared, read.plants))
        for each in read.plants:
            self._fill(each)
        model.requirements.extend(self._requirement(each.restriction) for each in read.requirements)
        self.specification = Specification(
            model,
            [self._requirement(each.restriction) for each in read.supervisorInvariants],
            None if read.supervisor is None else self._supervisor(read.supervisor),
            [] if read.supervisor is None else [self._event(each, None) for each in read.supervisor.alphabet],
        )

    def _define(self, element: Any, scope: str = "") -> Any:
        name = f"{scope}{element.name}"
        if name in self._names:
            raise CifError(f"there are two of the name '{name}'")
        self._names[name] = element
        return element

    def _find(self, name: str, plant: sct.Plant | None) -> Any:
        """What a name means inside a plant: the nearest thing of this name."""
        bare = name.replace("$", "")
        for candidate in (bare if plant is None else f"{plant.name}.{bare}", bare):
            if candidate in self._names:
                return self._names[candidate]
        raise CifError(f"there is no '{name}'")

    def _event(self, name: str, plant: sct.Plant | None) -> sct.Event:
        event = self._find(name, plant)
        if not isinstance(event, sct.Event):
            raise CifError(f"'{name}' is no event")
        return event

    def _enumeration(self, read: Any) -> ex.Enumeration:
        made: ex.Enumeration = self._define(ex.Enumeration(name=_plain(read.name)))
        made.literals.extend(self._define(ex.EnumerationLiteral(name=_plain(each))) for each in read.literals)
        return made

    def _declared(self, read: Any) -> sct.Plant:
        """A plant without what speaks of others."""
        plant: sct.Plant = self._define(sct.Plant(name=_plain(read.name)))
        scope = f"{plant.name}."
        plant.events.extend(
            self._define(sct.Event(name=_plain(each), controllable=events.controllable), scope)
            for events in read.events
            for each in events.names
        )
        plant.inputs.extend(
            self._define(sct.Input(name=_plain(each.name), type=self._type(each.type)), scope) for each in read.inputs
        )
        plant.variables.extend(
            self._define(sct.DiscreteVariable(name=_plain(each.name), type=self._type(each.type)), scope)
            for each in read.variables
        )
        plant.locations.extend(
            self._define(sct.Location(name=_plain(each.name), initial=each.initial, marked=each.marked), scope)
            for each in read.locations
        )
        return plant

    def _type(self, read: Any) -> ex.Type:
        match type(read).__name__:
            case "Boolean":
                return ex.BooleanType()
            case "Range":
                return ex.IntegerType(minimum=int(read.low), maximum=int(read.high))
        enumeration = self._find(read.enumeration, None)
        if not isinstance(enumeration, ex.Enumeration):
            raise CifError(f"'{read.enumeration}' is no enumeration")
        return ex.EnumerationType(enumeration=enumeration)

    def _fill(self, read: Any) -> None:
        plant = self._find(read.name, None)
        for variable, each in zip(plant.variables, read.variables, strict=True):
            variable.initial = self._expression(each.initial, plant)
        for location, each in zip(plant.locations, read.locations, strict=True):
            location.edges.extend(self._edge(edge, location, plant) for edge in each.edges)

    def _edge(self, read: Any, location: sct.Location, plant: sct.Plant | None) -> sct.Edge:
        target = self._find(read.target, plant) if read.target else location
        if not isinstance(target, sct.Location):
            raise CifError(f"'{read.target}' is no location")
        edge = sct.Edge(event=self._event(read.event, plant), target=target)
        if read.guard:
            edge.guard = self._expression(read.guard, plant)
        for each in read.updates:
            variable = self._find(each.variable, plant)
            if not isinstance(variable, sct.DiscreteVariable):
                raise CifError(f"'{each.variable}' is no variable")
            edge.updates.append(sct.Update(variable=variable, value=self._expression(each.value, plant)))
        return edge

    def _requirement(self, read: Any) -> sct.Requirement:
        return sct.Requirement(
            event=self._event(read.event, None),
            kind=getattr(sct.RequirementKind, type(read).__name__.lower()),
            condition=self._expression(read.condition, None),
        )

    def _supervisor(self, read: Any) -> sct.Plant:
        location = sct.Location(name="", initial=True, marked=True)
        location.edges.extend(self._edge(each, location, None) for each in read.edges)
        return sct.Plant(name=_plain(read.name), locations=[location])

    def _expression(  # noqa: C901 - one case for each grammar rule
        self, read: Any, plant: sct.Plant | None
    ) -> ex.Expression:
        def of(each: Any) -> ex.Expression:
            return self._expression(each, plant)

        match type(read).__name__:
            case "Expression":
                return ex.Implication(left=of(read.left), right=of(read.right)) if read.operator else of(read.left)
            case "Or" | "And" as rule:
                return reduce(lambda left, right: _CHAINS[rule](left=left, right=right), map(of, read.operands))
            case "Compared" | "Sum":
                made = of(read.left)
                for operator, right in zip(read.operators, read.rights, strict=True):
                    made = _OPERATORS[operator](left=made, right=of(right))
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
        return _reference(read.name, self._find(read.name, plant))


def _reference(name: str, element: Any) -> ex.Expression:
    match element:
        case sct.DiscreteVariable():
            return sct.VariableReference(variable=element)
        case sct.Input():
            return sct.InputReference(input=element)
        case sct.Location():
            return sct.LocationReference(location=element)
        case ex.EnumerationLiteral():
            return ex.EnumerationLiteralReference(literal=element)
    raise CifError(f"'{name}' has no value")


def _plain(name: str | None) -> str:
    return (name or "").removeprefix("$")
