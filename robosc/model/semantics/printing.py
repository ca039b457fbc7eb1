"""Printing of expression trees: one printer that every target refines by its spelling."""

from __future__ import annotations

import json
from decimal import Decimal
from functools import reduce
from pathlib import PurePath
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from robosc.base.diagnostics.visible import visible
from robosc.model import expression as ex
from robosc.model import robosc, sct
from robosc.model.semantics.communication import RUNNING_WORD
from robosc.model.semantics.naming import TEXT_FUNCTION, escape_keyword
from robosc.model.semantics.operators import ATOM, PRECEDENCE, SYMBOLS, Associativity, operator_of
from robosc.model.semantics.walks import fold, operands

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

#: Pairs of precedence levels that bind the same in all targets, but need parentheses for readers and compiler warnings.
_LOOSE_PAIRS = {(2, 3), (1, 2), (1, 3), (4, 5)}


class Printed(NamedTuple):
    """The text of an expression and the precedence of its outermost operator; ATOM if it has none."""

    text: str
    precedence: int = ATOM

    @property
    def tight(self) -> str:
        """The text, in parentheses if it is not a single operand."""
        return self.text if self.precedence == ATOM else f"({self.text})"


class Printer:
    """Prints an expression with the parentheses that its tree needs. Works bottom-up, without recursion.

    A target sets `symbols` (operator class to text) and overrides methods for its own spelling. Each method gets the
    expression and its printed operands. An expression class without a text raises TypeError: the target's preconditions
    must reject it beforehand.
    """

    symbols: ClassVar[Mapping[type[ex.Expression], str]] = SYMBOLS

    def __call__(self, expression: ex.Expression) -> str:
        """Return the text of the expression, without parentheses around it."""
        return self.printed(expression).text

    def printed(self, expression: ex.Expression) -> Printed:
        """Return the text with its precedence."""
        return fold(self.write, expression, self.inside)

    def inside(self, expression: ex.Expression) -> Sequence[ex.Expression]:
        """Return the operands to print before the expression. A target may override this."""
        return operands(expression)

    def write(self, expression: ex.Expression, printed_operands: Sequence[Printed]) -> Printed:
        """Print an expression, given its printed operands."""
        if isinstance(expression, ex.BinaryExpression):
            return self.binary(expression, *printed_operands)
        if isinstance(expression, (ex.Negation, ex.UnaryMinus)):
            return self.unary(expression, *printed_operands)
        if isinstance(expression, ex.Conditional):
            return self.choice(*printed_operands)
        if isinstance(expression, ex.FunctionCall):
            return self.call(expression, printed_operands)
        return Printed(self.atom(expression))

    def binary(self, expression: ex.BinaryExpression, left: Printed, right: Printed) -> Printed:
        """Print a binary operator between its operands."""
        row = operator_of(expression)
        assert row is not None
        chain, right_chain = row.associativity is Associativity.CHAIN, row.associativity is Associativity.RIGHT
        before = self.operand(row.precedence, left, bare=chain and type(expression.left) is type(expression))
        after = self.operand(row.precedence, right, bare=right_chain and type(expression.right) is type(expression))
        return Printed(self.between(type(expression), before, after), row.precedence)

    def between(self, kind: type[ex.BinaryExpression], left: str, right: str) -> str:
        """Return a binary operator between the texts of its operands."""
        return f"{left} {self.symbols[kind]} {right}"

    def unary(self, expression: ex.UnaryExpression, operand: Printed) -> Printed:
        """Print an operator before its operand. Parentheses separate two in a row, so that it never prints `--x`."""
        return Printed(f"{self.symbols[type(expression)]}{operand.tight}", PRECEDENCE[type(expression)])

    def operand(self, outer: int, printed_operand: Printed, *, bare: bool = False) -> str:
        """Return an operand of a binary operator, in parentheses if the tree or a reader needs them."""
        binds = printed_operand.precedence > outer and (outer, printed_operand.precedence) not in _LOOSE_PAIRS
        return (
            printed_operand.text
            if binds or (bare and printed_operand.precedence == outer)
            else f"({printed_operand.text})"
        )

    def call(self, expression: ex.FunctionCall, printed_operands: Sequence[Printed]) -> Printed:
        """Print a function call."""
        return Printed(f"{expression.function}({', '.join(text for text, _ in printed_operands)})")

    def choice(self, condition: Printed, then: Printed, otherwise: Printed) -> Printed:
        """Print a conditional: one value if the condition holds, else the other."""
        return Printed(f"(if {condition.text} then {then.text} else {otherwise.text})")

    def atom(self, expression: ex.Expression) -> str:
        """Return the text of an expression without operands: a literal or a reference."""
        match expression:
            case ex.BooleanLiteral():
                return "true" if expression.value else "false"
            case ex.IntegerLiteral():
                return str(expression.value)
        raise TypeError(f"{type(self).__name__} has no text for {type(expression).__name__}")


class RoboscPrinter(Printer):
    """Prints a linked expression of a robot model as in its text, with qualified states and variables."""

    def write(self, expression: ex.Expression, printed_operands: Sequence[Printed]) -> Printed:
        """Print an access, a quantifier, an array or a call, or any expression that all printers know."""
        texts = [text for text, _ in printed_operands]
        match expression:
            case robosc.Access():
                return Printed(self._access(expression, iter(texts)))
            case robosc.ArrayQuantifier():
                array, body = texts
                return Printed(
                    f"({expression.quantifier} {escape_keyword(expression.element.name)} in {array}: {body})"
                )
            case robosc.InstanceQuantifier():
                return Printed(f"({expression.quantifier} {_name(expression.template)}: {texts[0]})")
            case robosc.ErrorReason():
                return Printed("error")
            case robosc.IntegerText():
                return Printed(f"{TEXT_FUNCTION}({texts[0]})")
            case robosc.Call():
                return Printed(f"{_name(expression.function)}({', '.join(texts)})")
            case robosc.ArrayLiteral():
                return Printed(f"[{', '.join(texts)}]")
            case robosc.ObjectValue():
                fields = zip((_name(field.property) for field in expression.properties), texts, strict=True)
                return Printed("{" + ", ".join(f"{name}: {text}" for name, text in fields) + "}")
        return super().write(expression, printed_operands)

    def _access(self, access: robosc.Access, indices: Iterator[str]) -> str:
        name = "value" if access.item is None else escape_keyword(access.item.name)
        component = access.component
        if isinstance(access.item, robosc.RequirementState):
            component = access.item.eContainer()
        owner = self.owner(component) if component else ""
        if isinstance(access.item, robosc.CommunicationType):
            name += f".{RUNNING_WORD}"
        return owner + name + "".join(_step(segment, indices) for segment in access.segments)

    def owner(self, component: robosc.Component) -> str:
        """Return the prefix for the name of a component's member."""
        return f"{escape_keyword(component.name)}."

    def atom(self, expression: ex.Expression) -> str:
        """Return the text of a literal."""
        match expression:
            case ex.DoubleLiteral():
                digits = format(Decimal(repr(expression.value)), "f")  # RoboSC has no exponents.
                return digits if "." in digits else f"{digits}.0"
            case ex.StringLiteral():
                return visible(json.dumps(expression.value, ensure_ascii=False))
        return super().atom(expression)


def _name(element: ex.NamedElement | None) -> str:
    """Return the name of a referenced element. Linking reports unresolved references."""
    return escape_keyword(element.name) if element else "…"


def _step(segment: robosc.AccessSegment, indices: Iterator[str]) -> str:
    if isinstance(segment, robosc.PropertySegment):
        return f".{_name(segment.property)}"
    assert isinstance(segment, robosc.IndexSegment)
    first = segment.index if segment.first is None else next(indices)
    return f"[{first}]" if segment.last is None else f"[{first}..{next(indices)}]"


class SctPrinter(Printer):
    """Prints an expression of an sct model for people, in RoboSC's operators, with each name qualified by its plant."""

    def atom(self, expression: ex.Expression) -> str:
        """Return a reference as `plant.name`, or a literal."""
        match expression:
            case sct.LocationReference():
                return f"{self.owner(expression.location.eContainer())}.{expression.location.name}"
            case sct.VariableReference():
                return f"{self.owner(expression.variable.eContainer())}.{expression.variable.name}"
            case sct.InputReference():
                return f"{expression.input.eContainer().name}.{expression.input.name}"
            case ex.EnumerationLiteralReference():
                return expression.literal.name
        return super().atom(expression)

    def owner(self, plant: sct.Plant) -> str:
        """Return the name of the plant of a location or a variable."""
        return plant.name


class RobotPrinter(SctPrinter):
    """Prints an expression of an sct model in the robot model's terms: states and variables with their component."""

    def atom(self, expression: ex.Expression) -> str:
        """Return the text of a reference or literal. A value computed by the node is printed as in the model."""
        if isinstance(expression, sct.InputReference) and expression.input.text is not None:
            text = expression.input.text
            return text if text.isidentifier() else f"({text})"
        return super().atom(expression)

    def owner(self, plant: sct.Plant) -> str:
        """Return the component of the plant."""
        return plant.origin or plant.name


def conjunction(parts: Iterable[ex.Expression]) -> ex.Expression | None:
    """Return the conjunction of all parts, in their order, or None without parts. The parts become its children."""
    return _chain(ex.Conjunction, parts)


def disjunction(parts: Iterable[ex.Expression]) -> ex.Expression | None:
    """Return the disjunction of all parts, in their order, or None without parts. The parts become its children."""
    return _chain(ex.Disjunction, parts)


def _chain(operator: type[ex.BinaryExpression], parts: Iterable[ex.Expression]) -> ex.Expression | None:
    rest = iter(parts)
    first = next(rest, None)
    return None if first is None else reduce(lambda left, right: operator(left=left, right=right), rest, first)


def remark(requirement: sct.StatedRequirement) -> str:
    """Return the text of a requirement, with its file.

    The line is omitted: edits that do not change the robot must not change its code.
    """
    file = requirement.source.file if requirement.source else None
    where = f" ({PurePath(file.name).name})" if file else ""
    return f"{requirement.text}{where}"
