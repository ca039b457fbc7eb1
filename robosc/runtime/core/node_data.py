"""The data that a node keeps beside its supervisor, and the value of every expression of the ROS graph."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct
from robosc.semantics.evaluation import Value, as_double, evaluate, saturate

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.engine import Engine
    from robosc.runtime.core.port import Message

#: What whole numbers of a node are kept in.
LEAST, MOST = -(2**63), 2**63 - 1


class PastEndError(Exception):
    """An element that an array does not have."""

    def __init__(self, index: int, length: int) -> None:
        super().__init__(f"there is no element {index} in an array of {length}")


class Received(NamedTuple):
    """What an event brings, from the state before it: values of its inputs, by their names, and the node's new ones."""

    inputs: dict[str, Any]
    variables: dict[rosgraph.NodeVariable, Value]


def fit(number: int) -> int:
    """The nearest number of 64 bits."""
    return saturate(number, LEAST, MOST)


class NodeData:
    """The variables of one node, and the values of expressions over them, the supervisor's state and data that came in.

    An enumeration's value is its literal.
    """

    def __init__(self, graph: rosgraph.RosGraph, engine: Engine) -> None:
        self._engine = engine
        self.variables: dict[rosgraph.NodeVariable, Value] = {}
        for each in graph.variables:
            self.variables[each] = self.value(each.initial)
        self._reactions: dict[sct.Event, list[rosgraph.Reaction]] = {}
        for reaction in graph.reactions:
            self._reactions.setdefault(reaction.event, []).append(reaction)

    def value(self, expression: ex.Expression, data: Message = None) -> Value:
        """The value of an expression; `data` is what came in. Raises PastEndError."""
        return evaluate(expression, lambda each: self._read(each, data), fit)

    def is_in(self, location: sct.Location) -> bool:
        """Whether its plant is in a location."""
        plant: sct.Plant = location.eContainer()
        return plant.locations[self._engine.location(plant)] is location

    def received(
        self, event: sct.Event, inputs: Sequence[rosgraph.InputAssignment] = (), data: Message = None
    ) -> Received:
        """What the transitions that the event takes in the present state make of its data; nothing is changed yet.

        Raises PastEndError where one of them can't read what it needs: then the event must not happen.
        """
        return Received(self._inputs(inputs, data), self._assigned(event, data))

    def _inputs(self, inputs: Sequence[rosgraph.InputAssignment], data: Message) -> dict[str, Any]:
        values = ((each.input.name, self.value(each.value, data)) for each in inputs)
        return {name: each.name if isinstance(each, ex.EnumerationLiteral) else each for name, each in values}

    def _assigned(self, event: sct.Event, data: Message) -> dict[rosgraph.NodeVariable, Value]:
        return {
            each.variable: bounded(self.value(each.value, data), each.variable.type)
            for each in self._assignments(event)
        }

    def _assignments(self, event: sct.Event) -> Iterator[rosgraph.NodeAssignment]:
        """What the event assigns in the present state."""
        for reaction in self._reactions.get(event, ()):
            if any(map(self.is_in, reaction.locations)):
                yield from reaction.assignments

    def read_now(self, event: sct.Event) -> list[ex.Expression]:
        """The values that the event gives to variables in the present state."""
        return [each.value for each in self._assignments(event)]

    def values_read(self, event: sct.Event) -> list[ex.Expression]:
        """All values that the event may give to variables."""
        return [each.value for reaction in self._reactions.get(event, ()) for each in reaction.assignments]

    def convert(self, conversion: rosgraph.Conversion, argument: Any) -> ex.EnumerationLiteral:
        """The literal of the first rule that holds; one that reads past the end of an array does not."""
        for rule in conversion.rules:
            try:
                if self.value(rule.condition, argument):
                    return rule.literal
            except PastEndError:
                continue
        return conversion.default

    def _read(self, reference: ex.Expression, data: Message) -> Value:
        match reference:
            case rosgraph.NodeVariableReference():
                return self.variables[reference.variable]
            case rosgraph.WireAccess():
                return _typed(_walk(reference, data), reference.type)
            case rosgraph.ConversionCall():
                return self.convert(reference.conversion, _walk(reference.argument, data))
            case ex.EnumerationLiteralReference():
                return reference.literal
            case sct.LocationReference():
                return self.is_in(reference.location)
            case sct.VariableReference():
                return self._variable(reference.variable)
        raise TypeError(f"a ROS graph holds no {type(reference).__name__}")

    def _variable(self, variable: sct.DiscreteVariable) -> Value:
        value = self._engine.value(variable)
        if isinstance(variable.type, ex.EnumerationType):
            return next(each for each in variable.type.enumeration.literals if each.name == value)
        return value


def bounded(value: Value, kind: ex.Type) -> Value:
    """The value as a variable of the type keeps it: an integer within its range."""
    if isinstance(kind, ex.IntegerType):
        assert isinstance(value, int)
        return saturate(fit(value), kind.minimum, kind.maximum)
    return value


def _walk(access: rosgraph.WireAccess, data: Message) -> Any:
    reached = data
    for step in access.steps:
        if isinstance(step, rosgraph.FieldStep):
            reached = getattr(reached, step.name)
        else:
            assert isinstance(step, rosgraph.IndexStep)
            if step.index >= len(reached):
                raise PastEndError(step.index, len(reached))
            reached = reached[step.index]
    return reached


def _typed(value: Any, kind: ex.Type | None) -> Value:
    """A value of ROS as one of the model: numpy's scalars and ROS 2's `byte` become plain numbers."""
    match kind:
        case ex.IntegerType():
            return fit(value[0] if isinstance(value, bytes) else int(value))
        case ex.DoubleType():
            return as_double(float(value))
        case ex.BooleanType():
            return bool(value)
    return value  # type: ignore[no-any-return]
