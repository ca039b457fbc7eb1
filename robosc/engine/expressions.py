"""Expressions of an engine model as Python functions, made once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from robosc.metamodel import engine
from robosc.metamodel import expression as ex
from robosc.semantics.operators import BY_CLASS
from robosc.semantics.walks import fold, operands

#: The value of an expression, given the cells of a state and the inputs: an integer; false and true are 0 and 1.
Function = Callable[[Sequence[int], Sequence[int]], int]

#: How Python writes the operators on integers; of any other it calls the function that computes it.
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
_CALLED = {found.__name__: facts.compute for found, facts in BY_CLASS.items() if issubclass(found, ex.BinaryExpression)}
#: How deep Python's text may nest until a value is computed beforehand instead: its parser needs stack.
_DEEPEST = 20


class Compiler:
    """Makes functions of the expressions of one model, whose variables and inputs are the cells and inputs.

    Each is Python text, compiled: what is enabled is known in a quarter of the time that nested functions take.
    """

    def __init__(self, model: engine.EngineModel) -> None:
        self._cells = {variable: position for position, variable in enumerate(model.variables)}
        self._inputs = {declared: position for position, declared in enumerate(model.inputs)}
        named: list[Sequence[ex.NamedElement]] = [owner.literals for owner in model.model.enumerations]
        named += [plant.locations for plant in model.model.plants]
        self._literals = {value: position for values in named for position, value in enumerate(values)}

    def __call__(self, *expressions: ex.Expression) -> Function:
        """The function of an expression; of several, whether all hold."""
        beforehand: list[str] = []

        def made(node: ex.Expression, parts: list[tuple[str, int]]) -> tuple[str, int]:
            text = self._text(node, [part for part, _ in parts])
            depth = 1 + max((inner for _, inner in parts), default=0)
            if depth <= _DEEPEST:
                return text, depth
            beforehand.append(f"value_{len(beforehand)} = {text}")
            return beforehand[-1].partition(" ")[0], 1

        texts = [fold(made, expression, _inside)[0] for expression in expressions]
        body = "\n    ".join([*beforehand, f"return {_joined(texts, 'and')}"])
        made_here: dict[str, Function] = {}
        # Nothing of a user's text is in it: `_text` writes positions, numbers, operators and names of `_CALLED`.
        exec(f"def function(cells, inputs):\n    {body}", _CALLED, made_here)  # noqa: S102 - as said above
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


def _joined(parts: Sequence[str], word: str) -> str:
    """All or any of the parts; of none what Python's `all` and `any` give."""
    return f"({f' {word} '.join(parts)})" if parts else str(int(word == "and"))
