"""Checks of models, and what they share: a check says what is wrong with one element of a model.

The checks of a kind of model stand in a table: by class, what is asked of every element of that class.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc
from robosc.metamodel.reflection import tree
from robosc.semantics.operators import Rule, operator_of
from robosc.semantics.typing import BOOLEAN, DOUBLE, INTEGER, UNKNOWN, EnumType, Type, Types, is_number
from robosc.semantics.walks import operands

#: The element with which something is wrong, and the reason.
Fault = tuple[Any, str]


class Model:
    """A model that is checked: its root, its elements, each before what it contains, and the types of expressions."""

    def __init__(self, root: Any) -> None:
        self.root = root
        self.elements = [element for _, element in tree(root)]
        self.types = Types()

    @cached_property
    def own(self) -> set[Any]:
        """The elements, to be looked up."""
        return set(self.elements)

    def unlike(self, expression: ex.Expression, wanted: Type) -> Iterator[Fault]:
        """The fault, if an expression is of another type than is wanted."""
        found = self.types(expression)
        if UNKNOWN not in {found, wanted} and found != wanted:
            yield expression, f"this is of {_named(found)}, but {_named(wanted)} is wanted"


Check = Callable[[Any, Model], Iterable[Fault]]
Checks = Mapping[type, Sequence[Check]]


def faults_of(model: Model, checks: Checks) -> Iterator[Fault]:
    """What a table of checks finds in a model."""
    by_class: dict[type, list[Check]] = {}
    for element in model.elements:
        kind = type(element)
        if kind not in by_class:
            by_class[kind] = [check for asked, found in checks.items() if issubclass(kind, asked) for check in found]
        for check in by_class[kind]:
            yield from check(element, model)


def demand(holds: Callable[[Any], bool], message: str) -> Check:
    """The check that something holds of an element; the message cites the element as `{0.name}`."""

    def check(element: Any, _model: Model) -> Iterator[Fault]:
        if not holds(element):
            yield element, message.format(element)

    return check


def typed(feature: str, wanted: Callable[[Any], Type] = lambda _: BOOLEAN) -> Check:
    """The check that the expression in a feature, if there is one, has the type that is wanted for the element."""

    def check(element: Any, model: Model) -> Iterator[Fault]:
        value = getattr(element, feature)
        if value is not None:
            yield from model.unlike(value, wanted(element))

    return check


def unique(*features: str) -> Check:
    """The check that no two elements in one of these features have the same name, or stand for the same thing."""

    def check(element: Any, _model: Model) -> Iterator[Fault]:
        for feature in features:
            for named in repeated(getattr(element, feature), lambda named: named.name):
                yield named, f"the name '{named.name}' is given twice"

    return check


def repeated(elements: Iterable[Any], key: Callable[[Any], Any]) -> Iterator[Any]:
    """The elements that have the key of an earlier one."""
    seen = set()
    for element in elements:
        if key(element) in seen:
            yield element
        seen.add(key(element))


def around(element: Any, kind: type) -> Any:
    """The nearest element of a kind around another; None where there is none."""
    found = element.eContainer()
    while found is not None and not isinstance(found, kind):
        found = found.eContainer()
    return found


_WANTED = {Rule.LOGICAL: BOOLEAN, Rule.DOUBLE: DOUBLE, Rule.INTEGER: INTEGER, Rule.ROUNDING: DOUBLE}


def fitting_operands(expression: ex.Expression, model: Model) -> Iterator[Fault]:
    """The check of an sct or rosgraph model's operators, which all have operands of one type."""
    row, given = operator_of(expression), operands(expression)
    if isinstance(expression, (robosc.Access, robosc.ObjectValue)):
        yield expression, f"{type(expression).__name__} belongs in a robosc model only"
    elif isinstance(expression, ex.Conditional):
        yield from model.unlike(expression.condition, BOOLEAN)
        yield from _differ(expression, given[1:], model)
    elif row is not None and row.rule in _WANTED:
        wanted = INTEGER if isinstance(expression, ex.DoubleConversion) else _WANTED[row.rule]
        for operand in given:
            yield from model.unlike(operand, wanted)
    elif row is not None and row.rule not in {Rule.SIZE, Rule.ELEMENTS}:
        faults = [*_differ(expression, given, model)]
        yield from faults
        found = model.types(given[0])
        if row.rule is not Rule.EQUALITY and not faults and not is_number(found) and found != UNKNOWN:
            yield expression, f"numbers are wanted, not {_named(found)}"


def _differ(expression: ex.Expression, given: Iterable[ex.Expression], model: Model) -> Iterator[Fault]:
    kinds = [kind for kind in map(model.types, given) if kind != UNKNOWN]
    if len(set(kinds)) > 1:
        yield expression, f"the operands are of {_named(kinds[0])} and {_named(kinds[1])}, not of one type"


def _named(kind: Type) -> str:
    return f"enumeration {kind.definition.name}" if isinstance(kind, EnumType) else str(kind)
