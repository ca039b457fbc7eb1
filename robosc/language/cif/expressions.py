"""From the flat expressions of the grammar to typed expressions of the sct metamodel."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.language.cif import static_values
from robosc.language.cif.faults import CifFaultError, construct, span
from robosc.language.cif.static_values import TypedNode, constant_value, is_foreign, static_value
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.cif_types import (
    BOOLEAN,
    FOREIGN,
    OPERATORS,
    combine_types,
    format_type,
    join_types,
    value_range,
)
from robosc.model.semantics.walks import copy_tree, parts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: Words before an operand that bind like unary operators.
_UNARY = ("not", "negate", "plus", "cast")
#: Words before an operand that are operators if another operand precedes them.
_OPENINGS = {"-": "negate", "+": "plus", "case": "first case", "else": "first else"}
_LEVELS = {word: level for word, (level, _) in OPERATORS.items()} | FOREIGN


@dataclass
class _Open:
    """An incomplete operator, `if` or `switch`, with its alternatives so far."""

    word: str
    node: Any
    switched: TypedNode | None = None
    conditions: list[TypedNode] = field(default_factory=list)
    values: list[TypedNode] = field(default_factory=list)


class ExpressionReader:
    """Reads one expression from its tokens, operators without recursion (Dijkstra's shunting yard)."""

    def __init__(
        self, node: Any, value_of: Callable[[Any, sct.Plant | None], TypedNode], grow: Callable[[Any, int], None]
    ) -> None:
        """Read the expression.

        `value_of` returns the value of an operand. Its second argument is the automaton of the `switch` if the operand
        is a key.

        `grow` is called with a place and the number of nodes added there beyond those of the text.
        """
        self._grow = grow
        self._done: list[TypedNode] = []
        self._open: list[_Open] = []
        for word, token in _tokens(node):
            if word is None:
                self._done.append(value_of(token, self._switched()))
            else:
                self._take(word, token)
        self._reduce(0)
        if self._open:
            raise CifFaultError(node, "syntax", f"`{self._open[-1].node.token}` is not closed", "end it with `end`")
        [self.result] = self._done

    def _switched(self) -> sct.Plant | None:
        """Return the automaton of the innermost `switch` whose key is read next, or None."""
        top = self._open[-1] if self._open else None
        plant = top.switched.type if top is not None and top.word == "case" and top.switched else None
        return plant if isinstance(plant, sct.Plant) else None

    def _take(self, word: str, token: Any) -> None:
        """Process a token that is not an operand."""
        if word == "sample":
            raise construct(token, "distributions", "write a value of the required type")
        if word in ("if", "switch", *_UNARY):
            self._open.append(_Open(word, token))
            return
        if word.startswith("first ") and (not self._open or self._open[-1].word != "switch:"):
            raise CifFaultError(token, "syntax", f"`{token.token}` is not allowed here")
        level = _LEVELS.get(word, 0)
        self._reduce(level)
        top = self._open[-1] if self._open else _Open("", token)
        if level:
            if level == 1 and _LEVELS.get(top.word) == 1:
                raise CifFaultError(
                    token, "syntax", f"`{word}` and `{top.word}` cannot be chained", "write parentheses"
                )
            self._open.append(_Open(word, token))
            return
        self._alternative(top, word, token)

    def _alternative(self, top: _Open, word: str, token: Any) -> None:
        """Process a word of the innermost open `if` or `switch`."""
        match top.word, word:
            case (("if" | "elif"), ":"):
                self._boolean(self._done[-1], "a condition is bool, this is {}")
                top.conditions.append(self._done.pop())
            case "switch", ":":
                top.switched = self._done.pop()
            case "case", ":":
                assert top.switched is not None
                top.conditions.append(self._is(top.switched, self._done.pop()))
            case ":", ("elif" | "else" | "case") if word == "else" or (word == "case") == (top.switched is not None):
                top.values.append(self._done.pop())
            case "switch:", ("first case" | "first else"):
                top.word = word.removeprefix("first ")
                return
            case "else", "end":
                self._open.pop()
                self._done.append(self._choice(top, self._done.pop()))
                return
            case ":", "end" if top.switched is not None:
                self._open.pop()
                # In CIF, the last case applies if no other one does.
                top.conditions.pop()
                self._done.append(self._choice(top, self._done.pop()))
                return
            case _:
                raise CifFaultError(token, "syntax", f"`{token.token}` is not allowed here")
        top.word = "switch:" if top.word == "switch" else word

    def _reduce(self, level: int) -> None:
        """Complete the operators that bind at least as tightly as `level`.

        Stop at the innermost open construct.
        """
        while self._open:
            top = self._open[-1]
            if top.word in _UNARY:
                self._open.pop()
                self._done.append(self._unary(top, self._done.pop()))
            elif top.word in _LEVELS and _LEVELS[top.word] >= max(level, 1 + (level == 1)):
                self._open.pop()
                right, left = self._done.pop(), self._done.pop()
                self._done.append(self._binary(top, left, right))
            else:
                return

    def _binary(self, top: _Open, left: TypedNode, right: TypedNode) -> TypedNode:
        for operand in (left, right):
            if isinstance(operand.type, sct.Plant):
                raise CifFaultError(operand.node, "type", "an automaton is not a value", "name one of its locations")
        if top.word in FOREIGN or is_foreign(left.type) or is_foreign(right.type):
            return static_values.binary(top.node, top.word, left, right)
        try:
            kind = combine_types(top.word, left.type, right.type)
        except TypeError as fault:
            if all(constant_value(operand.expression) is not None for operand in (left, right)):
                return static_values.binary(top.node, top.word, left, right)
            raise CifFaultError(top.node, "type", str(fault)) from None
        if top.word == "mod":
            arguments = [left.expression, right.expression]
            return TypedNode(top.node, ex.FunctionCall(function="mod", arguments=arguments), kind)
        expression = OPERATORS[top.word][1](left=left.expression, right=right.expression)
        return TypedNode(top.node, expression, kind)

    def _unary(self, top: _Open, operand: TypedNode) -> TypedNode:
        if top.word == "not":
            self._boolean(operand, "`not` does not apply to {}")
            return TypedNode(top.node, ex.Negation(operand=operand.expression), BOOLEAN)
        if top.word == "cast":
            return static_values.cast(top.node, operand)
        if operand.type == "real":
            return operand if top.word == "plus" else static_values.negated(top.node, operand)
        if not isinstance(operand.type, range):
            raise CifFaultError(top.node, "type", f"a sign does not apply to {format_type(operand.type)}")
        if top.word == "plus":
            return operand
        values = range(1 - operand.type.stop, 1 - operand.type.start)
        return TypedNode(
            top.node, ex.UnaryMinus(operand=operand.expression), _checked(top.node, value_range, "-", values)
        )

    def _is(self, switched: TypedNode, key: TypedNode) -> TypedNode:
        """Return the condition that the value of a `switch` equals a key."""
        if isinstance(switched.type, sct.Plant):
            return key  # The key is a location, which is true while the automaton is in it.
        if is_foreign(switched.type) or is_foreign(key.type):
            return static_values.binary(key.node, "=", switched, key)
        _checked(key.node, combine_types, "=", switched.type, key.type)
        self._grow(key.node, sum(1 for _ in parts(switched.expression)))
        return TypedNode(key.node, ex.Equation(left=copy_tree(switched.expression), right=key.expression), BOOLEAN)

    @staticmethod
    def _boolean(operand: TypedNode, problem: str) -> None:
        if operand.type != BOOLEAN:
            what = "an automaton" if isinstance(operand.type, sct.Plant) else format_type(operand.type)
            raise CifFaultError(operand.node, "type", problem.format(what))

    @staticmethod
    def _choice(top: _Open, otherwise: TypedNode) -> TypedNode:
        if any(is_foreign(value.type) for value in (*top.values, otherwise)):
            for condition, value in zip(top.conditions, top.values, strict=False):
                if static_value(condition, "conditions between values of these types"):
                    return value
            return otherwise
        expression, kind = otherwise.expression, otherwise.type
        for condition, value in reversed(list(zip(top.conditions, top.values, strict=True))):
            kind = _checked(top.node, join_types, value.type, kind)
            expression = ex.Conditional(condition=condition.expression, then=value.expression, otherwise=expression)
        return TypedNode(top.node, expression, kind)


def _tokens(node: Any) -> Iterator[tuple[str | None, Any]]:
    """Yield the tokens of an expression with their words; operands have None. Signs are marked as unary."""
    further = [(None, node.first), *((other.operator, other.operand) for other in node.others)]
    for operator, operand in further:
        if operator is not None:
            yield operator.token, operator
        for opening in operand.openings:
            word = opening.token
            yield _OPENINGS.get(word, "cast" if word[0] == "<" else word), opening
        yield None, operand.value
        yield from ((closing.token, closing) for closing in operand.closings)


class _Part:
    """A part of a flat expression."""

    def __init__(self, node: Any, first: Any, others: list[Any]) -> None:
        self.parent = node
        self.first = first
        self.others = others
        self._tx_position = span(first)[0]
        self._tx_position_end = span(others[-1] if others else first)[1]


def pair(node: Any) -> tuple[Any, Any] | None:
    """Return the two expressions around a `:` outside of any `if` and `switch`, or None if there is no such `:`."""
    depth = 0
    operands = [node.first, *(other.operand for other in node.others)]
    words = ["", *(other.operator.token for other in node.others)]
    for number, (word, operand) in enumerate(zip(words, operands, strict=True)):
        if word == ":" and depth == 0:
            return _Part(node, node.first, node.others[: number - 1]), _Part(node, operand, node.others[number:])
        depth += sum(opening.token in ("if", "switch") for opening in operand.openings) - len(operand.closings)
    return None


def referenced_names(node: Any) -> Iterator[Any]:
    """Yield the names in an expression, except those that are keys of a `switch` by themselves."""
    pending = [node]
    while pending:
        here = pending.pop()
        for operand in (here.first, *(other.operand for other in here.others)):
            value = operand.value
            for suffix in getattr(value, "suffixes", ()):
                pending += [bound for bound in (getattr(suffix, "first", None), getattr(suffix, "last", None)) if bound]
            match type(value).__name__:
                case "Parenthesis":
                    pending += [value.inner, *value.more]
                case "Call":
                    pending += value.arguments
                case "Collection":
                    pending += value.elements
                case "Reference" if "case" not in {opening.token for opening in operand.openings[-1:]}:
                    yield value.name


def _checked(node: Any, rule: Callable[..., Any], *operands: Any) -> Any:
    """Return the type by a rule; a TypeError becomes a fault of this place."""
    try:
        return rule(*operands)
    except TypeError as fault:
        raise CifFaultError(node, "type", str(fault)) from None
