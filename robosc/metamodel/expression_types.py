"""What is wrong with the types in sct and rosgraph models, where both operands of an operator have one type."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc
from robosc.semantics.operators import Rule, operator_of
from robosc.semantics.typing import BOOLEAN, DOUBLE, INTEGER, UNKNOWN, EnumType, Type, Types, is_number
from robosc.semantics.walks import operands

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

Fault = tuple[ex.Expression, str]
_WANTED = {Rule.LOGICAL: BOOLEAN, Rule.DOUBLE: DOUBLE, Rule.INTEGER: INTEGER}


def _named(kind: Type) -> str:
    return f"enumeration {kind.definition.name}" if isinstance(kind, EnumType) else str(kind)


class ExpressionTypes:
    """The types of expressions, and what is wrong with them."""

    def __init__(self) -> None:
        self._types = Types()
        #: Each expression that does not fit its operator, with the reason.
        self.faults: list[Fault] = []

    def add(self, elements: Iterable[Any]) -> None:
        """Types all expressions among the elements, which come with what is above before what is below."""
        for element in reversed(list(elements)):
            if isinstance(element, ex.Expression):
                self.faults += self._faults(element)

    def unless(self, expression: ex.Expression, wanted: Type) -> Iterator[Fault]:
        """The fault, if an expression is of another type than is wanted."""
        found = self._types(expression)
        if UNKNOWN not in {found, wanted} and found != wanted:
            yield expression, f"this is of {_named(found)}, but {_named(wanted)} is wanted"

    def _faults(self, expression: ex.Expression) -> Iterator[Fault]:
        row, given = operator_of(expression), operands(expression)
        if isinstance(expression, (robosc.Access, robosc.ObjectValue)):
            yield expression, f"{type(expression).__name__} belongs in a robosc model only"
        elif isinstance(expression, ex.Conditional):
            yield from self.unless(expression.condition, BOOLEAN)
            yield from self._differ(expression, given[1:])
        elif row is not None and row.rule in _WANTED:
            conversion = isinstance(expression, ex.DoubleConversion)
            for operand in given:
                yield from self.unless(operand, INTEGER if conversion else _WANTED[row.rule])
        elif row is not None:
            faults = [*self._differ(expression, given)]
            yield from faults
            found = self._types(given[0])
            if row.rule is not Rule.EQUALITY and not faults and not is_number(found) and found != UNKNOWN:
                yield expression, f"numbers are wanted, not {_named(found)}"

    def _differ(self, expression: ex.Expression, given: list[ex.Expression]) -> Iterator[Fault]:
        kinds = [kind for kind in map(self._types, given) if kind != UNKNOWN]
        if len(set(kinds)) > 1:
            yield expression, f"the operands are of {_named(kinds[0])} and {_named(kinds[1])}, not of one type"
