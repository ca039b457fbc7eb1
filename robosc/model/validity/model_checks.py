"""Framework for checks of models: a check reports faults of one element.

Each kind of model has a table of checks. It lists the checks for the elements of each class.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.reflection import tree
from robosc.model.semantics.operators import TypeRule, operator_of
from robosc.model.semantics.typing import BOOLEAN, DOUBLE, INTEGER, UNKNOWN, EnumType, Type, Types, is_number
from robosc.model.semantics.walks import operands

#: The faulty element, and the reason.
Fault = tuple[Any, str]


class Model:
    """A model under check: its root, its elements in preorder, and the types of expressions."""

    def __init__(self, root: Any) -> None:
        self.root = root
        self.elements = [element for _, element in tree(root)]
        self.types = Types()

    @cached_property
    def own(self) -> set[Any]:
        """Elements as a set."""
        return set(self.elements)

    def unlike(self, expression: ex.Expression, expected: Type) -> Iterator[Fault]:
        """Report a fault if an expression does not have the wanted type."""
        actual = self.types(expression)
        if UNKNOWN not in {actual, expected} and actual != expected:
            yield expression, f"this is of {_named(actual)}, expected {_named(expected)}"


Check = Callable[[Any, Model], Iterable[Fault]]
Checks = Mapping[type, Sequence[Check]]


def faults_of(model: Model, checks: Checks) -> Iterator[Fault]:
    """Report the faults that a table of checks detects in a model."""
    by_class: dict[type, list[Check]] = {}
    for element in model.elements:
        kind = type(element)
        if kind not in by_class:
            by_class[kind] = [
                check
                for checked_kind, checks_of_kind in checks.items()
                if issubclass(kind, checked_kind)
                for check in checks_of_kind
            ]
        for check in by_class[kind]:
            yield from check(element, model)


def demand(holds: Callable[[Any], bool], message: str) -> Check:
    """Return the check of a condition on an element. The message refers to the element as `{0.name}`."""

    def check(element: Any, _model: Model) -> Iterator[Fault]:
        if not holds(element):
            yield element, message.format(element)

    return check


def check_type(feature: str, expected_of: Callable[[Any], Type] = lambda _: BOOLEAN) -> Check:
    """Return the check that the expression in a feature, if any, has the type of `expected_of(element)`."""

    def check(element: Any, model: Model) -> Iterator[Fault]:
        value = getattr(element, feature)
        if value is not None:
            yield from model.unlike(value, expected_of(element))

    return check


def unique(*features: str) -> Check:
    """Return the check that the names in each of these features are unique."""

    def check(element: Any, _model: Model) -> Iterator[Fault]:
        for feature in features:
            for named in find_duplicates(getattr(element, feature), lambda named: named.name):
                yield named, f"the name '{named.name}' is used twice"

    return check


def find_duplicates(elements: Iterable[Any], key: Callable[[Any], Any]) -> Iterator[Any]:
    """Iterate over the elements that have the key of an earlier one."""
    seen = set()
    for element in elements:
        if key(element) in seen:
            yield element
        seen.add(key(element))


def around(element: Any, kind: type) -> Any:
    """Return the nearest container of a class around an element, or None."""
    container = element.eContainer()
    while container is not None and not isinstance(container, kind):
        container = container.eContainer()
    return container


_OPERAND_TYPES = {
    TypeRule.LOGICAL: BOOLEAN,
    TypeRule.DOUBLE: DOUBLE,
    TypeRule.INTEGER: INTEGER,
    TypeRule.ROUNDING: DOUBLE,
}


def fitting_operands(expression: ex.Expression, model: Model) -> Iterator[Fault]:
    """Check the operators of an sct or rosgraph model, whose operands all have one type."""
    row, parts = operator_of(expression), operands(expression)
    if isinstance(expression, (robosc.Access, robosc.IntegerText, robosc.ObjectValue)):
        yield expression, f"{type(expression).__name__} is allowed only in a robosc model"
    elif isinstance(expression, ex.Conditional):
        yield from model.unlike(expression.condition, BOOLEAN)
        yield from _differ(expression, parts[1:], model)
    elif row is not None and row.rule in _OPERAND_TYPES:
        expected = INTEGER if isinstance(expression, ex.DoubleConversion) else _OPERAND_TYPES[row.rule]
        for operand in parts:
            yield from model.unlike(operand, expected)
    elif row is not None and row.rule not in {TypeRule.SIZE, TypeRule.ELEMENTS}:
        faults = [*_differ(expression, parts, model)]
        yield from faults
        actual = model.types(parts[0])
        if row.rule is not TypeRule.EQUALITY and not faults and not is_number(actual) and actual != UNKNOWN:
            yield expression, f"expected numbers, found {_named(actual)}"


def _differ(expression: ex.Expression, expressions: Iterable[ex.Expression], model: Model) -> Iterator[Fault]:
    kinds = [kind for kind in map(model.types, expressions) if kind != UNKNOWN]
    if len(set(kinds)) > 1:
        yield expression, f"the operands are of {_named(kinds[0])} and {_named(kinds[1])}, not of one type"


def _named(kind: Type) -> str:
    return f"enumeration {kind.definition.name}" if isinstance(kind, EnumType) else str(kind)
