"""Functions that write sct models in a few lines, for the tests of all their readers.

    model(
        plants=[
            plant("machine", {"idle": [edge("start", to="busy", when="n < 3", do={"n": "n + 1"})],
                              "busy": [edge("done", to="idle", do={"n": "x"})]},
                  controllable=["start"], uncontrollable={"done": ["x"]},
                  variables={"n": "0..5 = 1"}, inputs={"x": "-1..5"}),
        ],
        requirements=[needs("start", "machine.idle and n != 2", text="machine needs ...")],
        enumerations={"Colour": ["red", "green"]},
    )

Expressions are Python's: `and or not == != < <= > >= + - *`, `a if c else b`, `implies(a, b)`, `abs(a)`, `min(a, b)`,
`max(a, b)`. `/` and `double(x)` are for invalid sct models. A name is a variable, input or location of the same plant,
else an enumeration literal, else a variable of any plant; `p.x` is x of plant p, `Colour.red` a literal. A type is
`bool`, `0..5` or an enumeration. ` = value` gives a variable's initial value. The default is false, the value nearest
to 0, or the first literal.
"""

import ast
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from robosc.model import expression as ex
from robosc.model import sct

_BINARY = {
    ast.And: ex.Conjunction,
    ast.Or: ex.Disjunction,
    ast.Eq: ex.Equation,
    ast.NotEq: ex.Inequation,
    ast.Lt: ex.LessThan,
    ast.LtE: ex.LessOrEqual,
    ast.Gt: ex.GreaterThan,
    ast.GtE: ex.GreaterOrEqual,
    ast.Add: ex.Addition,
    ast.Sub: ex.Subtraction,
    ast.Mult: ex.Multiplication,
    ast.Div: ex.Division,
}
_UNARY = {ast.Not: ex.Negation, ast.USub: ex.UnaryMinus}
_KINDS = ("trigger", "response", "error", "feedback", "cancel", "reset", "tau", "timeout")


@dataclass(frozen=True)
class _Edge:
    event: str
    to: str | None
    when: str | None
    do: Mapping[str, str]


@dataclass(frozen=True)
class _Plant:
    element: sct.Plant
    locations: Mapping[str, Sequence[_Edge]]
    everywhere: Sequence[_Edge]
    carries: Mapping[str, Sequence[str]]
    variables: Mapping[str, str]
    inputs: Mapping[str, str]


@dataclass(frozen=True)
class _Requirement:
    kind: str
    event: str
    condition: str
    text: str | None


def edge(event: str, to: str | None = None, *, when: str | None = None, do: Mapping[str, Any] | None = None) -> _Edge:
    """Return an edge to location `to` (or a self-loop) with guard `when` and updates `do` (variable to value)."""
    return _Edge(event, to, when, {name: str(value) for name, value in (do or {}).items()})


def plant(
    name: str,
    locations: Mapping[str, Sequence[_Edge]],
    *,
    controllable: Iterable[str] = (),
    uncontrollable: Iterable[str] | Mapping[str, Sequence[str]] = (),
    variables: Mapping[str, str] | None = None,
    inputs: Mapping[str, str] | None = None,
    initial: str | None = None,
    marked: Sequence[str] | None = None,
    kind: str = "behaviour",
    topic: str | None = None,
    origin: str | None = None,
    everywhere: Sequence[_Edge] = (),
) -> _Plant:
    """Return a plant and the events that it declares, each by name, or as a mapping to the inputs that carry its data.

    Each location has its edges and those of `everywhere`, which name their target.

    By default, the first location is initial and the only marked one. An event's kind follows from its name
    (`c_trigger`, `u_response`, `c_tau1`). Events of a data plant are data; others are triggers or responses.
    """
    first = next(iter(locations))
    declared = [(event, True) for event in controllable] + [(event, False) for event in uncontrollable]
    return _Plant(
        sct.Plant(
            name=name,
            kind=getattr(sct.PlantKind, kind),
            topic=topic,
            origin=origin,
            events=[
                sct.Event(name=event, controllable=allowed, kind=_event_kind(event, kind, allowed))
                for event, allowed in declared
            ],
            locations=[
                sct.Location(
                    name=location,
                    initial=location == (initial or first),
                    marked=location in ([initial or first] if marked is None else marked),
                )
                for location in locations
            ],
        ),
        locations,
        everywhere,
        {
            event: inputs_of
            for events in (controllable, uncontrollable)
            if isinstance(events, Mapping)
            for event, inputs_of in events.items()
        },
        variables or {},
        inputs or {},
    )


def needs(event: str, condition: str, text: str | None = None) -> _Requirement:
    """Return a requirement: the event needs the condition."""
    return _Requirement("needs", event, condition, text)


def disables(event: str, condition: str, text: str | None = None) -> _Requirement:
    """Return a requirement: the condition disables the event."""
    return _Requirement("disables", event, condition, text)


class Reachable(NamedTuple):
    """A condition that must stay reachable, its premise, the condition of the path, and the bound on its length."""

    condition: str
    premise: str | None = None
    along: str | None = None
    bound: int | None = None


def model(
    plants: Sequence[_Plant],
    requirements: Sequence[_Requirement] = (),
    enumerations: Mapping[str, Sequence[str]] | None = None,
    *,
    name: str = "robot",
    guards: Mapping[str, str | tuple[str | None, str | None]] | None = None,
    invariants: Sequence[str] = (),
    reachable: Sequence[Reachable] = (),
) -> sct.SupervisoryControlModel:
    """Return the model. `guards` attaches a supervisor without synthesis: event to requirement part, or both parts.

    `reachable` are the conditions that must stay reachable.
    """
    scope = _Scope(
        [given_plant.element for given_plant in plants],
        [
            ex.Enumeration(name=enumeration, literals=[ex.EnumerationLiteral(name=literal) for literal in literals])
            for enumeration, literals in (enumerations or {}).items()
        ],
    )
    for given_plant in plants:
        scope.declare(given_plant)
    for given_plant in plants:
        scope.fill(given_plant)
    made = sct.SupervisoryControlModel(
        name=name,
        enumerations=scope.enumerations,
        plants=scope.plants,
        requirements=[
            sct.Requirement(
                event=scope.event(requirement.event, None),
                kind=getattr(sct.RequirementKind, requirement.kind),
                condition=scope.expression(requirement.condition, None),
                text=requirement.text,
            )
            for requirement in requirements
        ],
        invariants=[
            sct.StateInvariant(condition=scope.expression(condition, None), text=f"requirement always {condition}")
            for condition in invariants
        ],
        reachabilityRequirements=[
            sct.ReachabilityRequirement(
                condition=scope.expression(required.condition, None),
                premise=None if required.premise is None else scope.expression(required.premise, None),
                pathCondition=None if required.along is None else scope.expression(required.along, None),
                bound=required.bound,
                text=f"requirement reachable {required.condition}"
                + ("" if required.premise is None else f" from {required.premise}"),
            )
            for required in reachable
        ],
    )
    if guards is not None:
        made.supervisor = scope.supervisor(guards)
    return made


def _event_kind(event: str, plant_kind: str, controllable: bool) -> sct.EventKind:
    if plant_kind == "data":
        return sct.EventKind.data
    stem = event.partition("_")[2].rstrip("0123456789").replace("after", "timeout")
    return getattr(sct.EventKind, stem if stem in _KINDS else "trigger" if controllable else "response")


@dataclass
class _Scope:
    plants: list[sct.Plant]
    enumerations: list[ex.Enumeration]
    names: dict[str, Any] = field(default_factory=dict)
    events: dict[str, list[sct.Event]] = field(default_factory=lambda: defaultdict(list))

    def __post_init__(self) -> None:
        for given_plant in self.plants:
            for event in given_plant.events:
                self.events[event.name].append(event)
        for enumeration in self.enumerations:
            for literal in enumeration.literals:
                self.names[f"{enumeration.name}.{literal.name}"] = self.names[literal.name] = literal

    def declare(self, given: _Plant) -> None:
        owner = given.element
        for name, text in given.inputs.items():
            owner.inputs.append(sct.Input(name=name, type=self.type(text)))
        for name, text in given.variables.items():
            kind, _, value = text.partition("=")
            made = self.type(kind.strip())
            owner.variables.append(
                sct.DiscreteVariable(
                    name=name, type=made, initial=self.expression(value, owner) if value else _default(made)
                )
            )
        for event in owner.events:
            event.inputs.extend(
                next(input_ for input_ in owner.inputs if input_.name == name)
                for name in given.carries.get(event.name, ())
            )
        for element in (*owner.locations, *owner.inputs, *owner.variables):
            self.names[f"{owner.name}.{element.name}"] = element
            if isinstance(element, sct.DiscreteVariable):
                self.names.setdefault(element.name, element)

    def fill(self, given: _Plant) -> None:
        owner = given.element
        for location in owner.locations:
            location.edges.extend(self.edge(sketch, owner, location.name) for sketch in given.locations[location.name])
        owner.edges.extend(self.edge(sketch, owner, "") for sketch in given.everywhere)

    def edge(self, given: _Edge, owner: sct.Plant, here: str) -> sct.Edge:
        return sct.Edge(
            event=self.event(given.event, owner),
            guard=None if given.when is None else self.expression(given.when, owner),
            target=self.find(given.to or here, owner),
            updates=[
                sct.Update(variable=self.find(name, owner), value=self.expression(value, owner))
                for name, value in given.do.items()
            ],
        )

    def supervisor(self, guards: Mapping[str, Any]) -> sct.Supervisor:
        parts = {
            self.event(event, None): given if isinstance(given, tuple) else (given, None)
            for event, given in guards.items()
        }
        return sct.Supervisor(
            uncontrolledStates=1,
            controlledStates=1,
            bddNodes=1,
            guards=[
                sct.EventGuard(
                    event=event,
                    everEnabled=True,
                    **{
                        part: self.expression(text, None)
                        for part, text in zip(("requirement", "synthesis"), parts.get(event, (None, None)), strict=True)
                        if text is not None
                    },
                )
                for given_plant in self.plants
                for event in given_plant.events
                if event.controllable
            ],
        )

    def type(self, text: str) -> ex.Type:
        if text == "bool":
            return ex.BooleanType()
        if ".." in text:
            minimum, maximum = text.split("..")
            return ex.IntegerType(minimum=int(minimum), maximum=int(maximum))
        return ex.EnumerationType(
            enumeration=next(enumeration for enumeration in self.enumerations if enumeration.name == text)
        )

    def event(self, name: str, owner: sct.Plant | None) -> sct.Event:
        wanted, _, bare = name.rpartition(".")
        found = [event for event in self.events[bare] if wanted in ("", event.eContainer().name)]
        own = [event for event in found if event.eContainer() is owner]
        if len(own or found) != 1:
            raise LookupError(f"{len(found)} events are called {name}")
        return (own or found)[0]

    def find(self, name: str, owner: sct.Plant | None) -> Any:
        own = None if owner is None else self.names.get(f"{owner.name}.{name}")
        return own if own is not None else self.names[name]

    def expression(self, text: str, owner: sct.Plant | None) -> ex.Expression:
        return self._expression(ast.parse(text.strip(), mode="eval").body, owner)

    def _expression(self, node: ast.expr, owner: sct.Plant | None) -> ex.Expression:  # noqa: C901
        def of(child: ast.expr) -> ex.Expression:
            return self._expression(child, owner)

        match node:
            case ast.BoolOp(op, [first, *others]):
                made = of(first)
                for other in others:
                    made = _BINARY[type(op)](left=made, right=of(other))
                return made
            case ast.Compare(left, [op], [right]) | ast.BinOp(left, op, right):
                return _BINARY[type(op)](left=of(left), right=of(right))
            case ast.UnaryOp(op, operand):
                return _UNARY[type(op)](operand=of(operand))
            case ast.IfExp(condition, then, otherwise):
                return ex.Conditional(condition=of(condition), then=of(then), otherwise=of(otherwise))
            case ast.Call(ast.Name("implies"), [left, right]):
                return ex.Implication(left=of(left), right=of(right))
            case ast.Call(ast.Name("abs" | "min" | "max" as function), arguments):
                return ex.FunctionCall(function=function, arguments=map(of, arguments))
            case ast.Call(ast.Name("double"), [operand]):
                return ex.DoubleConversion(operand=of(operand))
            case ast.Constant(value):
                literal = {bool: ex.BooleanLiteral, int: ex.IntegerLiteral, float: ex.DoubleLiteral}[type(value)]
                return literal(value=value)
            case ast.Name("true" | "false" as value):
                return ex.BooleanLiteral(value=value == "true")
            case ast.Name() | ast.Attribute():
                return _reference(self.find(ast.unparse(node), owner))
        raise ValueError(f"no expression: {ast.unparse(node)}")


def _reference(element: Any) -> ex.Expression:
    match element:
        case sct.DiscreteVariable():
            return sct.VariableReference(variable=element)
        case sct.Input():
            return sct.InputReference(input=element)
        case sct.Location():
            return sct.LocationReference(location=element)
    return ex.EnumerationLiteralReference(literal=element)


def _default(kind: ex.Type) -> ex.Expression:
    match kind:
        case ex.BooleanType():
            return ex.BooleanLiteral(value=False)
        case ex.IntegerType():
            value = min(max(0, kind.minimum), kind.maximum)
            literal = ex.IntegerLiteral(value=abs(value))
            return literal if value >= 0 else ex.UnaryMinus(operand=literal)
    return ex.EnumerationLiteralReference(literal=kind.enumeration.literals[0])
