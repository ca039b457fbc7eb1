"""Expressions of an engine model as Python functions, made once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from robosc.metamodel import engine
from robosc.metamodel import expression as ex
from robosc.semantics.operators import BY_CLASS
from robosc.semantics.walks import fold, operands

#: The value of an expression, given the cells of a state and the inputs: an integer; false and true are 0 and 1.
Function = Callable[[Sequence[int], Sequence[int]], int]

#: How many functions may call each other until a value is computed beforehand instead.
_DEEPEST = 100


class Compiler:
    """Makes functions of the expressions of one model, whose variables and inputs are the cells and inputs."""

    def __init__(self, model: engine.EngineModel) -> None:
        self._cells = {variable: position for position, variable in enumerate(model.variables)}
        self._inputs = {declared: position for position, declared in enumerate(model.inputs)}
        named: list[Sequence[ex.NamedElement]] = [owner.literals for owner in model.model.enumerations]
        named += [plant.locations for plant in model.model.plants]
        self._literals = {value: position for values in named for position, value in enumerate(values)}

    def __call__(self, expression: ex.Expression) -> Function:
        """The function of an expression."""
        beforehand: list[Function] = []

        def made(node: ex.Expression, parts: list[tuple[Function, int]]) -> tuple[Function, int]:
            function = self._function(node, [part for part, _ in parts])
            depth = 1 + max((inner for _, inner in parts), default=0)
            if depth <= _DEEPEST:
                return function, depth
            beforehand.append(function)
            return _input(len(self._inputs) + len(beforehand) - 1), 1

        function, _ = fold(made, expression, _inside)
        return _with_values(function, beforehand) if beforehand else function

    def _function(self, node: ex.Expression, parts: Sequence[Function]) -> Function:
        match node:
            case ex.BinaryExpression():
                left, right = parts
                compute = BY_CLASS[type(node)].compute
                return lambda cells, inputs: compute(left(cells, inputs), right(cells, inputs))
            case engine.And():
                return _first(parts, 0)
            case engine.Or():
                return _first(parts, 1)
            case ex.Negation():
                return lambda cells, inputs: not parts[0](cells, inputs)
            case ex.UnaryMinus():
                return lambda cells, inputs: -parts[0](cells, inputs)
            case engine.Saturation():
                low, high = node.minimum, node.maximum
                return lambda cells, inputs: min(max(parts[0](cells, inputs), low), high)
            case engine.Conversion() | engine.ConditionReference():
                return parts[0]
            case ex.Conditional():
                condition, then, otherwise = parts
                return lambda cells, inputs: (then if condition(cells, inputs) else otherwise)(cells, inputs)
        return self._leaf(node)

    def _leaf(self, node: ex.Expression) -> Function:
        match node:
            case engine.VariableReference():
                position = self._cells[node.variable]
                return lambda cells, _: cells[position]
            case engine.InputReference():
                return _input(self._inputs[node.input])
            case ex.EnumerationLiteralReference():
                return _constant(self._literals[node.literal])
            case engine.LocationLiteral():
                return _constant(self._literals[node.location])
            case ex.BooleanLiteral() | ex.IntegerLiteral():
                return _constant(int(node.value))
        raise ValueError(f"an engine model holds no {type(node).__name__}")


def _inside(node: ex.Expression) -> Sequence[ex.Expression]:
    """What the value of an expression is made of: of a shared condition its value."""
    return [node.condition.value] if isinstance(node, engine.ConditionReference) else operands(node)


def all_inside(expressions: Iterable[ex.Expression]) -> Iterator[ex.Expression]:
    """All parts of expressions, those of shared conditions, too, each of these once."""
    seen: set[ex.Expression] = set()
    pending = list(expressions)
    while pending:
        part = pending.pop()
        if part not in seen:
            seen.add(part)
            yield part
            pending += _inside(part)


def _first(parts: Sequence[Function], deciding: int) -> Function:
    """Whether a part has the deciding value: then that, else the other."""

    def decide(cells: Sequence[int], inputs: Sequence[int]) -> int:
        for part in parts:
            if part(cells, inputs) == deciding:
                return deciding
        return 1 - deciding

    return decide


def _input(position: int) -> Function:
    return lambda _, inputs: inputs[position]


def _constant(value: int) -> Function:
    return lambda _cells, _inputs: value


def _with_values(function: Function, beforehand: Sequence[Function]) -> Function:
    """The function, for which these values, in this order, are computed first and stand behind the inputs."""

    def whole(cells: Sequence[int], inputs: Sequence[int]) -> int:
        values = list(inputs)
        for compute in beforehand:
            values.append(compute(cells, values))
        return function(cells, values)

    return whole
