"""Expressions of an sct model as C: nothing in them overflows, and none is always true or always false."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from robosc.m2t.c.nodes import COMPARISONS, Junction, Not, children_of, is_condition
from robosc.m2t.c.types import index_type, number, signed, type_name
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.domains import Interval
from robosc.semantics.operators import ATOM, PRECEDENCE
from robosc.semantics.recursion import deep_recursion

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from robosc.m2t.c.names import CNames
    from robosc.m2t.c.nodes import Node
    from robosc.m2t.c.ranges import Ranges

_ARITHMETIC = (ex.Addition, ex.Subtraction, ex.Multiplication, ex.UnaryMinus)
_CONDITIONAL = 0
_UNARY = PRECEDENCE[ex.Negation]
_EQUATION = PRECEDENCE[ex.Equation]


def enumeration_of(node: Node) -> ex.Enumeration | None:
    """The enumeration that the value is of; None for booleans and integers."""
    match node:
        case ex.EnumerationLiteralReference():
            enumeration = node.literal.eContainer()
            assert isinstance(enumeration, ex.Enumeration)
            return enumeration
        case sct.VariableReference(variable=declaration) | sct.InputReference(input=declaration):
            return declaration.type.enumeration if isinstance(declaration.type, ex.EnumerationType) else None
        case ex.Conditional():
            return enumeration_of(node.then)
    return None


def working_type(node: ex.Expression, ranges: Ranges) -> str:
    """The type in which an operator on integers computes: `int` where 16 bits do, else `int32_t` or `int64_t`.

    Raises OverflowError where its value or an operand may not even fit into int64_t.
    """
    values = Interval(0, 0) if is_condition(node) else ranges(node)
    for child in children_of(node):
        if not is_condition(child):
            values = values.union(ranges(child))
    for bits, name in ((16, "int"), (32, "int32_t"), (64, "int64_t")):
        if signed(bits).holds(values):
            return name
    raise OverflowError(f"a value between {values.low} and {values.high} does not fit into 64 bits")


_CHAINS = (ex.Disjunction, ex.Conjunction, ex.Addition, ex.Multiplication)
_LOOSE_PAIRS = {(2, 3), (1, 2), (1, 3), (4, 5)}


class ExpressionPrinter:
    """Prints an expression with the parentheses that its tree needs.

    A target sets `symbols` (operator class to text) and overrides what it writes differently. An expression class
    without a method raises TypeError: a target's preconditions must have refused it before.
    """

    symbols: ClassVar[Mapping[type[ex.Expression], str]]

    def __call__(self, expression: ex.Expression) -> str:
        """The text of the expression, without parentheses around it."""
        with deep_recursion():
            return self.text(expression)

    def text(self, expression: ex.Expression) -> str:
        """The same, for who is printing already."""
        if isinstance(expression, ex.BinaryExpression):
            return self.binary(expression)
        if isinstance(expression, (ex.Negation, ex.UnaryMinus)):
            return self.unary(expression)
        return self.atom(expression)

    def binary(self, expression: ex.BinaryExpression) -> str:
        """A binary operator between its operands."""
        left = self.operand(expression, expression.left, chain=True)
        right = self.operand(expression, expression.right, chain=isinstance(expression, ex.Implication))
        return f"{left} {self.symbols[type(expression)]} {right}"

    def unary(self, expression: ex.UnaryExpression) -> str:
        """An operator before its operand; two in a row are kept apart, so that `--x` is never printed."""
        text = self.text(expression.operand)
        bare = self.precedence(expression.operand) == ATOM
        return f"{self.symbols[type(expression)]}{text if bare else f'({text})'}"

    def operand(self, parent: ex.BinaryExpression, child: ex.Expression, *, chain: bool) -> str:
        """A child of a binary operator, in parentheses where the tree or a reader needs them."""
        outer, inner = self.precedence(parent), self.precedence(child)
        same = (
            outer == inner
            and chain
            and (type(parent) is type(child))
            and isinstance(parent, (*_CHAINS, ex.Implication))
        )
        if same and isinstance(parent, ex.Implication):
            same = child is parent.right
        bare = (inner > outer and (outer, inner) not in _LOOSE_PAIRS) or same
        return self.text(child) if bare else f"({self.text(child)})"

    def precedence(self, expression: ex.Expression) -> int:
        """How tightly the text of the expression binds; a target that writes an atom with an operator says so here."""
        return PRECEDENCE.get(type(expression), ATOM)

    def atom(self, expression: ex.Expression) -> str:
        """Everything that is not an operator: literals, references, conversions."""
        raise TypeError(f"{type(self).__name__} has no text for {type(expression).__name__}")


class CPrinter(ExpressionPrinter):
    """Prints expressions over `state->…` and `inputs->…`; variables in `old` are read from `old.…` instead."""

    symbols = {  # noqa: RUF012  # ClassVar in the parent
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

    def __init__(self, names: CNames, ranges: Ranges, old: Collection[sct.DiscreteVariable] = ()) -> None:
        self.names = names
        self.ranges = ranges
        self._old = old

    def __call__(self, node: Node) -> str:
        """The text, without parentheses around it."""
        with deep_recursion():
            return self.text(node)

    def text(self, node: Node) -> str:
        """The same, for who is printing already."""
        node = self.ranges.reduced(node)
        constant = self.constant(node)
        if constant is not None:
            return constant
        if isinstance(node, (Not, ex.Negation)):
            return self.negation(node.operand)
        joined = self.ranges.joined(node)
        if joined is not None:
            return f" {'&&' if joined.neutral else '||'} ".join(self.terms(joined))
        assert isinstance(node, ex.Expression)
        return super().text(node)

    def terms(self, joined: Junction) -> list[str]:
        """The conditions of a conjunction or disjunction, each once, in the parentheses that they need in it."""
        bound = PRECEDENCE[ex.Conjunction]
        texts = [self.text(part) if self.precedence(part) > bound else f"({self.text(part)})" for part in joined.parts]
        return list(dict.fromkeys(texts))

    def constant(self, node: Node) -> str | None:
        """The text of an expression that has one value only; None of others."""
        value = self.ranges(node).single
        if value is None:
            return None
        if is_condition(node):
            return "true" if value else "false"
        enumeration = enumeration_of(node)
        return number(value) if enumeration is None else self.names.enumerator(enumeration.literals[value])

    def precedence(self, expression: Node) -> int:
        """How tightly the text binds."""
        node = self.ranges.reduced(expression)
        if self.ranges(node).single is not None:
            return _UNARY if not is_condition(node) and self.ranges(node).low < 0 else ATOM
        joined = self.ranges.joined(node)
        if joined is not None:
            return PRECEDENCE[ex.Conjunction if joined.neutral else ex.Disjunction]
        match node:
            case sct.LocationReference():
                return _EQUATION
            case ex.Negation() | Not():
                return _EQUATION if isinstance(self.ranges.reduced(node.operand), sct.LocationReference) else _UNARY
            case ex.Conditional():
                return _CONDITIONAL
        assert isinstance(node, ex.Expression)
        return super().precedence(node)

    def negation(self, operand: Node) -> str:
        """A condition denied: the other location where there are two, else `!=` for a location."""
        inner = self.ranges.reduced(operand)
        if isinstance(inner, sct.LocationReference):
            others = [each for each in inner.location.eContainer().locations if each is not inner.location]
            return self.location(others[0], "==") if len(others) == 1 else self.location(inner.location, "!=")
        return f"!{self.text(inner)}" if self.precedence(inner) == ATOM else f"!({self.text(inner)})"

    def unary(self, expression: ex.UnaryExpression) -> str:
        """A minus, in a type that holds the result."""
        return f"-{self.converted(expression, expression.operand)}"

    def operand(self, parent: ex.BinaryExpression, child: ex.Expression, *, chain: bool) -> str:
        """An operand: integers in the type in which the parent computes, conditions in parentheses."""
        if isinstance(parent, (*_ARITHMETIC, *COMPARISONS)) and enumeration_of(child) is None:
            if is_condition(child):
                text = self.text(child)
                return text if self.precedence(child) == ATOM else f"({text})"
            if working_type(parent, self.ranges) != "int":
                return self.converted(parent, child)
            if isinstance(parent, COMPARISONS) and self._beside_unsigned(parent, child):
                return f"{self.text(child)}U"
        return super().operand(parent, child, chain=chain)

    def _beside_unsigned(self, parent: ex.BinaryExpression, child: ex.Expression) -> bool:
        """Whether a constant is compared with an unsigned variable, which C would make signed for a signed one."""
        other = self.ranges.reduced(parent.right if child is parent.left else parent.left)
        value = self.ranges(child).single
        return (
            value is not None
            and value >= 0
            and isinstance(other, (sct.VariableReference, sct.InputReference))
            and self.type(other).startswith("uint")
        )

    def converted(self, parent: ex.Expression, child: ex.Expression) -> str:
        """An operand of arithmetic as a unary expression."""
        wanted = working_type(parent, self.ranges)
        text = self.text(child)
        constant = self.ranges(child).single is not None
        kept = constant or wanted == "int" or self.type(child) == wanted
        bare = self.precedence(child) == ATOM
        text = text if bare else f"({text})"
        return text if kept else f"({wanted}){text}"

    def type(self, node: ex.Expression) -> str:
        """The C type of the text; `int` for all that C makes one."""
        node = self.ranges.reduced(node)  # type: ignore[assignment]
        match node:
            case _ if self.ranges(node).single is not None or is_condition(node):
                return "int"
            case sct.VariableReference(variable=declaration) | sct.InputReference(input=declaration):
                return type_name(declaration.type)
            case ex.Conditional() if (enumeration := enumeration_of(node)) is not None:
                return index_type(len(enumeration.literals) - 1)
            case ex.Conditional() if working_type(node, self.ranges) == "int":
                return "int32_t"
        return working_type(node, self.ranges)

    def atom(self, expression: ex.Expression) -> str:
        """References, literals and choices."""
        match expression:
            case sct.VariableReference():
                where = "old." if expression.variable in self._old else "state->"
                return where + self.names.member(expression.variable)
            case sct.InputReference():
                return f"inputs->{self.names.member(expression.input)}"
            case sct.LocationReference():
                return self.location(expression.location, "==")
            case ex.Conditional():
                return self.choice(expression)
        return super().atom(expression)

    def location(self, location: sct.Location, operator: str) -> str:
        """Whether a plant is in a location, or is not."""
        plant = location.eContainer()
        assert isinstance(plant, sct.Plant)
        return f"state->{self.names.member(plant)} {operator} {self.names.enumerator(location)}"

    def choice(self, expression: ex.Conditional) -> str:
        """A conditional expression, both of its values of one type."""
        condition = self.text(expression.condition)
        if self.precedence(expression.condition) <= _CONDITIONAL:
            condition = f"({condition})"
        branches = (expression.then, expression.otherwise)
        if is_condition(expression):
            values = [
                self.text(each) if self.precedence(each) > _CONDITIONAL else f"({self.text(each)})" for each in branches
            ]
        else:
            values = [self.cast(self.type(expression), each) for each in branches]
        return f"{condition} ? {values[0]} : {values[1]}"

    def cast(self, kind: str, node: ex.Expression) -> str:
        """The value converted to a type, unless it is of that type."""
        text = self.text(node)
        if self.type(node) == kind:
            return text if self.precedence(node) > _CONDITIONAL else f"({text})"
        return f"({kind}){text if self.precedence(node) == ATOM else f'({text})'}"
