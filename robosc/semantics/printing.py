"""How expression trees become text: one printer that every target refines by its spellings."""

from __future__ import annotations

import json
from decimal import Decimal
from functools import reduce
from pathlib import PurePath
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from robosc.diagnostics.visible import visible
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc, sct
from robosc.semantics.communication import RUNNING_WORD
from robosc.semantics.naming import written
from robosc.semantics.operators import ATOM, PRECEDENCE, SYMBOLS, Associativity, operator_of
from robosc.semantics.walks import fold, operands

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

#: Levels between which binding is the same everywhere, but a reader (or a compiler that warns) wants parentheses.
_LOOSE_PAIRS = {(2, 3), (1, 2), (1, 3), (4, 5)}


class Printed(NamedTuple):
    """The text of an expression, and how tightly its outermost operator binds; ATOM where it has none."""

    text: str
    precedence: int = ATOM

    @property
    def tight(self) -> str:
        """The text, in parentheses where it is not a single operand."""
        return self.text if self.precedence == ATOM else f"({self.text})"


class Printer:
    """Prints an expression with the parentheses that its tree needs, bottom-up: nothing recurses.

    A target sets `symbols` (operator class to text) and overrides what it writes differently; each method gets the
    expression and what its operands were printed as. An expression class without a text raises TypeError: a target's
    preconditions must have refused it before.
    """

    symbols: ClassVar[Mapping[type[ex.Expression], str]] = SYMBOLS

    def __call__(self, expression: ex.Expression) -> str:
        """The text of the expression, without parentheses around it."""
        return self.printed(expression).text

    def printed(self, expression: ex.Expression) -> Printed:
        """The text with its precedence."""
        return fold(self.write, expression, self.inside)

    def inside(self, expression: ex.Expression) -> Sequence[ex.Expression]:
        """The operands that are printed before the expression; a target that prints it by other means says so here."""
        return operands(expression)

    def write(self, expression: ex.Expression, given: Sequence[Printed]) -> Printed:
        """The expression, its operands printed already."""
        if isinstance(expression, ex.BinaryExpression):
            return self.binary(expression, *given)
        if isinstance(expression, (ex.Negation, ex.UnaryMinus)):
            return self.unary(expression, *given)
        if isinstance(expression, ex.Conditional):
            return self.choice(*given)
        if isinstance(expression, ex.FunctionCall):
            return self.call(expression, given)
        return Printed(self.atom(expression))

    def binary(self, expression: ex.BinaryExpression, left: Printed, right: Printed) -> Printed:
        """A binary operator between its operands."""
        row = operator_of(expression)
        assert row is not None
        chain, right_chain = row.associativity is Associativity.CHAIN, row.associativity is Associativity.RIGHT
        before = self.operand(row.precedence, left, bare=chain and type(expression.left) is type(expression))
        after = self.operand(row.precedence, right, bare=right_chain and type(expression.right) is type(expression))
        return Printed(self.between(type(expression), before, after), row.precedence)

    def between(self, kind: type[ex.BinaryExpression], left: str, right: str) -> str:
        """A binary operator between the texts of its operands."""
        return f"{left} {self.symbols[kind]} {right}"

    def unary(self, expression: ex.UnaryExpression, operand: Printed) -> Printed:
        """An operator before its operand; two in a row are kept apart, so that `--x` is never printed."""
        return Printed(f"{self.symbols[type(expression)]}{operand.tight}", PRECEDENCE[type(expression)])

    def operand(self, outer: int, given: Printed, *, bare: bool = False) -> str:
        """An operand of a binary operator, in parentheses where the tree or a reader needs them."""
        binds = given.precedence > outer and (outer, given.precedence) not in _LOOSE_PAIRS
        return given.text if binds or (bare and given.precedence == outer) else f"({given.text})"

    def call(self, expression: ex.FunctionCall, given: Sequence[Printed]) -> Printed:
        """A function of its arguments."""
        return Printed(f"{expression.function}({', '.join(text for text, _ in given)})")

    def choice(self, condition: Printed, then: Printed, otherwise: Printed) -> Printed:
        """One value where the condition holds, else the other."""
        return Printed(f"(if {condition.text} then {then.text} else {otherwise.text})")

    def atom(self, expression: ex.Expression) -> str:
        """What has no operands: literals and references."""
        match expression:
            case ex.BooleanLiteral():
                return "true" if expression.value else "false"
            case ex.IntegerLiteral():
                return str(expression.value)
        raise TypeError(f"{type(self).__name__} has no text for {type(expression).__name__}")


class RoboscPrinter(Printer):
    """Prints a linked expression of a robot model as its author would write it, states and variables qualified."""

    def write(self, expression: ex.Expression, given: Sequence[Printed]) -> Printed:
        """A name with the steps into its data, a condition on the elements of an array, or what all printers know."""
        texts = [text for text, _ in given]
        match expression:
            case robosc.Access():
                name = "value" if expression.item is None else written(expression.item.name)
                component = expression.component
                if isinstance(expression.item, robosc.RequirementState):
                    component = expression.item.eContainer()
                owner = self.owner(component) if component else ""
                if isinstance(expression.item, robosc.CommunicationType):
                    name += f".{RUNNING_WORD}"
                indices = iter(texts)
                return Printed(owner + name + "".join(_step(segment, indices) for segment in expression.segments))
            case robosc.ArrayQuantifier():
                array, body = texts
                return Printed(f"({expression.quantifier} {written(expression.element.name)} in {array}: {body})")
            case robosc.InstanceQuantifier():
                return Printed(f"({expression.quantifier} {_name(expression.template)}: {texts[0]})")
            case robosc.ErrorReason():
                return Printed("error")
            case robosc.Call():
                return Printed(f"{_name(expression.function)}({', '.join(texts)})")
            case robosc.ArrayLiteral():
                return Printed(f"[{', '.join(texts)}]")
        return super().write(expression, given)

    def owner(self, component: robosc.Component) -> str:
        """What stands before the name of what a component has."""
        return f"{written(component.name)}."

    def atom(self, expression: ex.Expression) -> str:
        """A literal."""
        match expression:
            case ex.DoubleLiteral():
                digits = format(Decimal(repr(expression.value)), "f")  # RoboSC has no exponents
                return digits if "." in digits else f"{digits}.0"
            case ex.StringLiteral():
                return visible(json.dumps(expression.value, ensure_ascii=False))
        return super().atom(expression)


def _name(found: ex.NamedElement | None) -> str:
    """The name of what an expression refers to; what linking did not find is told elsewhere."""
    return written(found.name) if found else "…"


def _step(segment: robosc.AccessSegment, indices: Iterator[str]) -> str:
    if isinstance(segment, robosc.PropertySegment):
        return f".{_name(segment.property)}"
    assert isinstance(segment, robosc.IndexSegment)
    first = segment.index if segment.first is None else next(indices)
    return f"[{first}]" if segment.last is None else f"[{first}..{next(indices)}]"


class SctPrinter(Printer):
    """Prints an expression of an sct model for a person, in RoboSC's operators, each name with its plant before it."""

    def atom(self, expression: ex.Expression) -> str:
        """A reference as `plant.name`, or a literal."""
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
        """What the plant of a location or a variable is called."""
        return plant.name


class RobotPrinter(SctPrinter):
    """Prints an expression of an sct model as the robot model does: states and variables with their component."""

    def atom(self, expression: ex.Expression) -> str:
        """What the node computes of data as the model writes it."""
        if isinstance(expression, sct.InputReference) and expression.input.text is not None:
            text = expression.input.text
            return text if text.isidentifier() else f"({text})"
        return super().atom(expression)

    def owner(self, plant: sct.Plant) -> str:
        """The component."""
        return plant.origin or plant.name


def conjunction(parts: Iterable[ex.Expression]) -> ex.Expression | None:
    """The conjunction of all parts, in their order; None of none. The parts become its children."""
    return _chain(ex.Conjunction, parts)


def disjunction(parts: Iterable[ex.Expression]) -> ex.Expression | None:
    """The disjunction of all parts, in their order; None of none. The parts become its children."""
    return _chain(ex.Disjunction, parts)


def _chain(operator: type[ex.BinaryExpression], parts: Iterable[ex.Expression]) -> ex.Expression | None:
    rest = iter(parts)
    first = next(rest, None)
    return None if first is None else reduce(lambda left, right: operator(left=left, right=right), rest, first)


def remark(requirement: sct.StatedRequirement) -> str:
    """What a requirement with a text says, with its file.

    Where in the file it stands is left out: what does not change the robot does not change its code.
    """
    file = requirement.source.file if requirement.source else None
    where = f" ({PurePath(file.name).name})" if file else ""
    return f"{requirement.text}{where}"
