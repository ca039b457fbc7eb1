"""Expressions without names for expressions: constants, conditions, functions, parameters, quantifiers written out."""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc
from robosc.metamodel.reflection import contents, features, is_attribute, tree
from robosc.semantics.evaluation import Value, evaluate, literal
from robosc.semantics.operators import UnreadableError
from robosc.semantics.walks import copied, walk

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping

    from robosc.semantics.instances import Instance, Instances

    #: What parameters of a function, a template or an enum stand for.
    Arguments: TypeAlias = Mapping[robosc.FormalParameter, ex.Expression]

#: An expression is written out up to so many elements: a few names for sums of names are enough for any number.
LARGEST = 20_000
_NAMED = (robosc.Constant, robosc.Condition, robosc.FormalParameter)
_OPERATORS = {"all": ex.Conjunction, "any": ex.Disjunction, "count": ex.Addition}


class _Environment(NamedTuple):
    """What names mean where a part of an expression stands.

    `within` is the instance whose text it is, and `moved` whether it is written out elsewhere, so that its own names
    need their component. `templates` are those that a quantifier has a component for. `opened` are the definitions
    that it is written out for, so that a circle of them ends.
    """

    within: Instance | None
    arguments: Arguments
    templates: Mapping[robosc.Component, robosc.Component]
    opened: frozenset[Any] = frozenset()
    moved: bool = False


class Expansion:
    """Writes the expressions of a robot's instances out. Where there is nothing to write out they stay what they are.

    What can't be written out, because definitions use each other in a circle, stays a name; so does what would
    be larger than `LARGEST`: `too_large` has the expressions in which that is so.
    """

    def __init__(self, instances: Instances | None) -> None:
        self._instances = instances
        self._known: dict[tuple[ex.Expression, Instance | None, bool], ex.Expression] = {}
        self._made = 0
        self._elements: dict[ex.Located, ex.Located] = {}
        self.too_large: dict[ex.Expression, None] = {}

    def __call__(self, expression: ex.Expression, within: Instance | None, *, readable: bool = False) -> ex.Expression:
        """The expression in the text of an instance, None: in that of the robot itself, as the supervisor computes it.

        `readable`: as people read it, with names of constants, conditions and functions as they are. The same
        expression is given for the same arguments.
        """
        key = (expression, within, readable)
        if key not in self._known:
            needed = readable and within is not None
            affected = needed or any(_is_affected(part) for _, part in tree(expression))
            start = _Environment(within, within.arguments if within else {}, {}, moved=readable)
            self._made = 0
            self._readable = readable
            self._known[key] = walk(self._step, (expression, start)) if affected else expression
            if self._made > LARGEST:
                self.too_large[expression] = None
        return self._known[key]

    def constant(self, expression: ex.Expression, within: Instance | None) -> ex.Expression:
        """A constant expression as a literal; as it is, names written out, where it has no value."""
        return _folded(self(expression, within))

    def argued(self, expression: ex.Expression, arguments: Arguments) -> ex.Expression:
        """An expression outside of components, with values for parameters, such as the condition of an enum's rule."""
        self._made = 0
        self._readable = False
        start = _Environment(None, arguments, {})
        affected = any(_is_affected(part) for _, part in tree(expression))
        return walk(self._step, (expression, start)) if affected else expression

    def _step(self, node: tuple[Any, _Environment]) -> Generator[Any, Any, Any]:
        """A copy of an element with its names written out; it is asked for copies of what it consists of."""
        element, environment = node
        self._made += 1
        if self._made > LARGEST:
            return copied(element)
        match element:
            case robosc.Access(item=robosc.FormalParameter() as parameter) if parameter in environment.arguments:
                return copied(environment.arguments[parameter])
            case robosc.Access(item=(robosc.Constant() | robosc.Condition()) as named):
                written = yield from self._named(element, named, environment)
                if written is not None:
                    return written
            case robosc.Call(function=robosc.Function()) if not self._readable:
                written = yield from self._call(element, environment)
                if written is not None:
                    return written
            case robosc.InstanceQuantifier(template=robosc.Component()) if self._instances and not self._readable:
                return (yield from self._quantified(element, environment))
        return (yield from self._copy(element, environment))

    def _named(
        self, access: robosc.Access, item: robosc.Constant | robosc.Condition, environment: _Environment
    ) -> Generator[Any, Any, ex.Expression | None]:
        if self._readable or item in environment.opened or item.value is None:
            return None
        owner = self._owner(access.component, environment) if _is_member(item) else None
        if owner is None and _is_member(item) and isinstance(item, robosc.Condition):
            return None
        opened = environment.opened | {item}
        inner = _Environment(owner, owner.arguments if owner else {}, {}, opened, moved=True)
        value: ex.Expression = yield (item.value, inner)
        if isinstance(item, robosc.Constant):
            return _folded(value)
        return value

    def _call(self, call: robosc.Call, environment: _Environment) -> Generator[Any, Any, ex.Expression | None]:
        function = call.function
        given: list[ex.Expression] = []  # A generator can't ask from within a comprehension.
        if function in environment.opened or function.value is None or len(call.arguments) != len(function.parameters):
            return None
        for argument in call.arguments:
            given.append((yield (argument, environment)))  # noqa: PERF401
        arguments = dict(zip(function.parameters, given, strict=True))
        owner = environment.within if _is_member(function) else None
        if owner is not None:
            arguments = {**owner.arguments, **arguments}
        opened = environment.opened | {function}
        value: ex.Expression = yield (function.value, _Environment(owner, arguments, {}, opened, environment.moved))
        return value

    def _quantified(
        self, quantifier: robosc.InstanceQuantifier, environment: _Environment
    ) -> Generator[Any, Any, ex.Expression]:
        assert self._instances is not None
        counts = quantifier.quantifier == robosc.Quantifier.count
        found: list[ex.Expression] = []
        for instance in self._instances.of(quantifier.template):
            templates = {**environment.templates, quantifier.template: instance.component}
            body = yield (quantifier.body, environment._replace(templates=templates))
            if counts:
                counted, uncounted = ex.IntegerLiteral(value=1), ex.IntegerLiteral(value=0)
                body = ex.Conditional(condition=body, then=counted, otherwise=uncounted, source=quantifier.source)
            found.append(body)
        if not found:
            is_all = quantifier.quantifier == robosc.Quantifier.all
            return ex.IntegerLiteral(value=0) if counts else ex.BooleanLiteral(value=is_all)
        operator: Any = _OPERATORS[str(quantifier.quantifier)]
        return reduce(lambda left, right: operator(left=left, right=right, source=quantifier.source), found)

    def _copy(self, element: Any, environment: _Environment) -> Generator[Any, Any, Any]:
        made = type(element)()
        if isinstance(element, robosc.ArrayElement):
            self._elements[element] = made  # what names it stands behind it
        children = []
        for _, child in contents(element):
            children.append((yield (child, environment)))
        inside = iter(children)
        for name, feature in features(element.eClass).items():
            value = getattr(element, name)
            if value is None:
                continue
            if is_attribute(feature) or not feature.containment:
                if not feature.many:
                    setattr(made, name, self._elements.get(value, value) if name == "item" else value)
            elif feature.many:
                getattr(made, name).extend(next(inside) for _ in value)
            else:
                setattr(made, name, next(inside))
        if isinstance(element, robosc.Access) and element.component is not None:
            owner = self._owner(element.component, environment)
            if owner is not None and (environment.moved or element.component in environment.templates):
                made.component = owner.component
        return made

    def _owner(self, component: robosc.Component | None, environment: _Environment) -> Instance | None:
        if self._instances is None:
            within = environment.within
            return within if within is not None and component in {None, within.definition} else None
        component = environment.templates.get(component, component) if component else None
        return self._instances.instance(component, environment.within)


def constant(expression: ex.Expression) -> ex.Expression:
    """A constant expression outside of components as a literal; as it is, names written out, where it has no value."""
    return _folded(Expansion(None)(expression, None))


def constant_value(expression: ex.Expression | None, within: Instance | None = None) -> Value | None:
    """The value of a constant expression in the text of an instance, None: wherever it stands.

    None where it has no value: it reads what is not constant, or a parameter whose argument is not known. An enum's
    value stands for itself.
    """
    return None if expression is None else _value(Expansion(None)(expression, within))


def is_unreadable(expression: ex.Expression, within: Instance | None = None) -> bool | None:
    """Whether a constant expression rounds what is no number, and so has no value; None where it is not constant."""
    try:
        evaluate(Expansion(None)(expression, within), _enum_value)
    except UnreadableError:
        return True
    except (_NoValueError, TypeError, ValueError, OverflowError, AttributeError):
        return None
    return False


def _folded(expression: ex.Expression) -> ex.Expression:
    value = _value(expression)
    if value is None:
        return expression
    made = robosc.Access(item=value) if isinstance(value, robosc.EnumValue) else literal(value)
    made.source = expression.source
    return made


def _value(expression: ex.Expression) -> Value | None:
    try:
        return evaluate(expression, _enum_value)
    except (_NoValueError, UnreadableError, TypeError, ValueError, OverflowError, AttributeError):
        return None


class _NoValueError(Exception):
    """Something is read that is not constant."""


def _enum_value(reference: ex.Expression) -> Value:
    if isinstance(reference, robosc.Access) and isinstance(reference.item, robosc.EnumValue):
        return reference.item
    raise _NoValueError


def _is_affected(part: Any) -> bool:
    return isinstance(part, robosc.Call | robosc.InstanceQuantifier) or (
        isinstance(part, robosc.Access) and isinstance(part.item, _NAMED)
    )


def _is_member(named: robosc.NamedExpression) -> bool:
    """Whether a definition stands in a component."""
    return isinstance(named.eContainer(), robosc.LocalComponent)
