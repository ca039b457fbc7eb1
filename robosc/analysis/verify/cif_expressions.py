"""Expressions in generated CIF: their syntax and meaning.

The reader follows CIF's language reference and tutorial, not the generator.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.model import expression as ex
from robosc.model.semantics.cif_types import BOOLEAN, OPERATORS, Type, combine_types, format_type, join_types

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


class TypedExpression(NamedTuple):
    """Expression with its type and its start position in the text."""

    position: int
    expression: ex.Expression
    type: Type


class ExpressionError(ValueError):
    """Expression that CIF rejects, at a position of the text."""

    def __init__(self, position: int, reason: str) -> None:
        super().__init__(reason)
        self.position = position


@dataclass
class _Open:
    """Incomplete part: an operator, a parenthesis, or an `if` with its alternatives so far."""

    word: str
    position: int
    conditions: list[TypedExpression] = field(default_factory=list)
    values: list[TypedExpression] = field(default_factory=list)


class ExpressionReader:
    """Reader of one expression from its tokens, without recursion (Dijkstra's shunting yard).

    `difference`: the expression is the whole assigned value. Synthesis accepts a `-` only there, and only as the
    outermost operator.
    """

    def __init__(self, node: Any, value_of: Callable[[Any], TypedExpression], *, difference: bool) -> None:
        """Read an `Expression` of the grammar; `value_of` returns the meaning of an operand."""
        self._done: list[TypedExpression] = []
        self._open: list[_Open] = []
        self._differences: list[tuple[int, ex.Expression]] = []
        end = node._tx_position_end  # noqa: SLF001 - textX stores it there
        for word, token in _tokens(node):
            if word is None:
                self._done.append(value_of(token))
            else:
                self._take(word, token._tx_position)  # noqa: SLF001
        self._reduce(0)
        if self._open:
            raise ExpressionError(
                end, "Expected ')'" if self._open[-1].word == "(" else "Expected the rest of the 'if'"
            )
        [self.result] = self._done
        for position, expression in self._differences:
            if not (difference and expression is self.result.expression):
                raise ExpressionError(position, "CIF's synthesis takes a '-' at the top of an assignment only")

    def _take(self, word: str, position: int) -> None:
        """Process a token that is no operand."""
        if word in ("(", "if", "not"):
            self._open.append(_Open(word, position))
            return
        level = OPERATORS[word][0] if word in OPERATORS else 0
        self._reduce(level)
        top = self._open[-1] if self._open else _Open("", position)
        if level:
            if level == 1 and top.word in OPERATORS and OPERATORS[top.word][0] == 1:
                raise ExpressionError(position, f"Expected no '{word}': an implication is not a chain")
            self._open.append(_Open(word, position))
        elif word == ")" and top.word == "(":
            self._open.pop()
            self._done[-1] = self._done[-1]._replace(position=top.position)
        elif word == ":" and top.word in ("if", "elif"):
            self._boolean(self._done[-1], "a condition is bool and this is {}")
            top.conditions.append(self._done.pop())
            top.word = ":"
        elif word in ("elif", "else") and top.word == ":":
            top.values.append(self._done.pop())
            top.word = word
        elif word == "end" and top.word == "else":
            self._open.pop()
            self._done.append(self._choice(top, self._done.pop()))
        else:
            raise ExpressionError(position, f"Expected no '{word}'")

    def _reduce(self, level: int) -> None:
        """Complete the open operators that bind at least as tightly as this level."""
        while self._open:
            top = self._open[-1]
            if top.word == "not":
                self._open.pop()
                operand = self._done.pop()
                self._boolean(operand._replace(position=top.position), "`not` does not apply to {}")
                self._done.append(TypedExpression(top.position, ex.Negation(operand=operand.expression), BOOLEAN))
            elif top.word in OPERATORS and OPERATORS[top.word][0] >= max(level, 1 + (level == 1)):
                self._open.pop()
                right, left = self._done.pop(), self._done.pop()
                kind = _checked(right.position, combine_types, top.word, left.type, right.type)
                expression = OPERATORS[top.word][1](left=left.expression, right=right.expression)
                if top.word == "-":
                    self._differences.append((right.position, expression))
                self._done.append(TypedExpression(left.position, expression, kind))
            else:
                return

    @staticmethod
    def _boolean(operand: TypedExpression, problem: str) -> None:
        if operand.type != BOOLEAN:
            raise ExpressionError(operand.position, problem.format(format_type(operand.type)))

    @staticmethod
    def _choice(top: _Open, otherwise: TypedExpression) -> TypedExpression:
        expression, kind = otherwise.expression, otherwise.type
        for condition, value in reversed(list(zip(top.conditions, top.values, strict=True))):
            kind = _checked(top.position, join_types, value.type, kind)
            expression = ex.Conditional(condition=condition.expression, then=value.expression, otherwise=expression)
        return TypedExpression(top.position, expression, kind)


def _tokens(node: Any) -> Iterator[tuple[str | None, Any]]:
    """Yield the tokens of an expression with their words; operands have none."""
    further = [(None, node.first), *((other.operator, other.operand) for other in node.others)]
    for operator, operand in further:
        if operator is not None:
            yield operator.token, operator
        yield from ((opening.token, opening) for opening in operand.openings)
        yield None, operand.value
        yield from ((closing.token, closing) for closing in operand.closings)


def _checked(position: int, rule: Callable[..., Type], *operands: Any) -> Type:
    """Return the type by a rule; a type error is reported at this position."""
    try:
        return rule(*operands)
    except TypeError as fault:
        raise ExpressionError(position, str(fault)) from None
