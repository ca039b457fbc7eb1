"""Compiles expressions of an engine model to Python functions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from robosc.model import engine
from robosc.model import expression as ex
from robosc.model.semantics.operators import BY_CLASS
from robosc.model.semantics.walks import fold, operands

#: Returns the value of an expression for the cells of a state and the inputs: an integer; false and true are 0 and 1.
Function = Callable[[Sequence[int], Sequence[int]], int]

#: Python's integer operators. For all others, the text calls the operator's function.
_SPELLINGS = {
    ex.Implication: "<=",
    ex.Equation: "==",
    ex.Inequation: "!=",
    ex.LessThan: "<",
    ex.LessOrEqual: "<=",
    ex.GreaterThan: ">",
    ex.GreaterOrEqual: ">=",
    ex.Addition: "+",
    ex.Subtraction: "-",
    ex.Multiplication: "*",
}
_CALLED = {kind.__name__: facts.compute for kind, facts in BY_CLASS.items() if issubclass(kind, ex.BinaryExpression)}
#: Maximum nesting depth of the Python text. Deeper parts are assigned to variables: Python's parser needs stack.
_DEEPEST = 20


class Compiler:
    """Compiles the expressions of one model, whose variables and inputs are the cells and inputs.

    Compiled Python text is four times as fast as nested functions.
    """

    def __init__(self, model: engine.EngineModel) -> None:
        self._cells = {variable: position for position, variable in enumerate(model.variables)}
        self._inputs = {declared: position for position, declared in enumerate(model.inputs)}
        named: list[Sequence[ex.NamedElement]] = [owner.literals for owner in model.model.enumerations]
        named += [plant.locations for plant in model.model.plants]
        self._literals = {value: position for values in named for position, value in enumerate(values)}

    def __call__(self, *expressions: ex.Expression) -> Function:
        """Return the function of an expression; of several, the function of their conjunction."""
        beforehand: list[str] = []

        def combine(node: ex.Expression, parts: list[tuple[str, int]]) -> tuple[str, int]:
            text = self._text(node, [part for part, _ in parts])
            depth = 1 + max((inner for _, inner in parts), default=0)
            if depth <= _DEEPEST:
                return text, depth
            beforehand.append(f"value_{len(beforehand)} = {text}")
            return beforehand[-1].partition(" ")[0], 1

        texts = [fold(combine, expression, _inside)[0] for expression in expressions]
        body = "\n    ".join([*beforehand, f"return {_joined(texts, 'and')}"])
        made_here: dict[str, Function] = {}
        # The text contains nothing from users: `_text` writes only positions, numbers, operators and names of
        # `_CALLED`.
        exec(f"def function(cells, inputs):\n    {body}", _CALLED, made_here)  # noqa: S102 - see above
        return made_here["function"]

    def _text(self, node: ex.Expression, parts: Sequence[str]) -> str:
        match node:
            case ex.BinaryExpression() if type(node) in _SPELLINGS:
                return f"({parts[0]} {_SPELLINGS[type(node)]} {parts[1]})"
            case ex.BinaryExpression():
                return f"{type(node).__name__}({parts[0]}, {parts[1]})"
            case engine.And():
                return _joined(parts, "and")
            case engine.Or():
                return _joined(parts, "or")
            case ex.Negation():
                return f"(not {parts[0]})"
            case ex.UnaryMinus():
                return f"(-{parts[0]})"
            case engine.Saturation():
                return f"min(max({parts[0]}, {node.minimum}), {node.maximum})"
            case engine.Conversion() | engine.ConditionReference():
                return parts[0]
            case ex.Conditional():
                condition, then, otherwise = parts
                return f"({then} if {condition} else {otherwise})"
        return self._leaf(node)

    def _leaf(self, node: ex.Expression) -> str:
        match node:
            case engine.VariableReference():
                return f"cells[{self._cells[node.variable]}]"
            case engine.InputReference():
                return f"inputs[{self._inputs[node.input]}]"
            case ex.EnumerationLiteralReference():
                return str(self._literals[node.literal])
            case engine.LocationLiteral():
                return str(self._literals[node.location])
            case ex.BooleanLiteral() | ex.IntegerLiteral():
                return f"({int(node.value)})"
        raise ValueError(f"an engine model holds no {type(node).__name__}")


def _inside(node: ex.Expression) -> Sequence[ex.Expression]:
    """Return the operands of an expression. A shared condition has its value."""
    return [node.condition.value] if isinstance(node, engine.ConditionReference) else operands(node)


def all_inside(expressions: Iterable[ex.Expression]) -> Iterator[ex.Expression]:
    """Iterate over all parts of expressions and of shared conditions, each once."""
    seen: set[ex.Expression] = set()
    pending = list(expressions)
    while pending:
        part = pending.pop()
        if part not in seen:
            seen.add(part)
            yield part
            pending += _inside(part)


def _joined(parts: Sequence[str], word: str) -> str:
    """Return the conjunction or disjunction of the parts. Without parts: 1 for `and`, 0 for `or`."""
    return f"({f' {word} '.join(parts)})" if parts else str(int(word == "and"))
