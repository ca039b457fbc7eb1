"""Expansion of expressions: replaces names, function calls and quantifiers by their definitions."""

from __future__ import annotations

from functools import reduce
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.reflection import contents, features, is_attribute, place_or_refer, tree
from robosc.model.semantics.evaluation import Value, evaluate, literal, saturate
from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.walks import copy_tree, walk

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping

    from robosc.model.semantics.instances import Instance, Instances

    #: Expressions for the parameters of a function, a template or an enum.
    Arguments: TypeAlias = Mapping[robosc.FormalParameter, ex.Expression]

#: Maximum number of elements of an expanded expression. A few names for sums of names would exceed any limit.
LARGEST = 20_000
#: Largest integer that a constant expression computes with. Integers of a robot have 64 bits.
CLAMP = 1 << 128
#: Maximum number of elements of a constant without a value that is expanded.
_LONGEST = 100
_NAMED = (robosc.Constant, robosc.Condition, robosc.FormalParameter)
_OPERATORS = {"all": ex.Conjunction, "any": ex.Disjunction, "count": ex.Addition}


class _Environment(NamedTuple):
    """Meaning of names at the place of a part of an expression.

    `within` is the instance whose text contains the part. `moved`: the part is expanded in another text, so that its
    own names need their component. `templates` maps each template that a quantifier iterates over to the current
    instance. `opened` holds the definitions that are being expanded; it stops circular expansion. `quantified` holds
    the templates of quantifiers that are not expanded.
    """

    within: Instance | None
    arguments: Arguments
    templates: Mapping[robosc.Component, Instance]
    opened: frozenset[Any] = frozenset()
    moved: bool = False
    quantified: frozenset[robosc.Component] = frozenset()


class _Size(NamedTuple):
    """The number of elements of an expression without its parameters, and the number of uses of each parameter.

    All numbers are at most `LARGEST` + 1.
    """

    own: int
    parameters: Mapping[robosc.FormalParameter, int]

    def __add__(self, other: _Size) -> _Size:  # type: ignore[override]
        parameters = dict(self.parameters)
        for parameter, number in other.parameters.items():
            parameters[parameter] = _bounded(parameters.get(parameter, 0) + number)
        return _Size(_bounded(self.own + other.own), parameters)

    def times(self, number: int) -> _Size:
        """Return the size of `number` copies."""
        counts = {parameter: _bounded(count * number) for parameter, count in self.parameters.items()}
        return _Size(_bounded(self.own * number), counts)

    def with_arguments(self, arguments: Mapping[robosc.FormalParameter, _Size]) -> _Size:
        """Return the size of the expression with arguments in place of parameters."""
        size = _Size(self.own, {})
        for parameter, number in self.parameters.items():
            size += arguments.get(parameter, _Size(1, {})).times(number)
        return size

    def of(self, arguments: Mapping[robosc.FormalParameter, _Size]) -> int:
        """Return the number of elements. A parameter without an argument counts as one element."""
        return self.with_arguments(arguments).own


def _bounded(number: int) -> int:
    return min(number, LARGEST + 1)


def _is_long(named: robosc.Constant | robosc.Condition) -> bool:
    """Return whether a name stands for more than one literal number."""
    if named.value is None:
        return False
    return isinstance(named, robosc.Condition) or isinstance(named.type, robosc.StringDataType)


class Expansion:
    """Expands the expressions of a robot's instances. Returns an expression itself if it needs no expansion.

    Definitions in a circle stay names. All names stay if an expression would have more than `LARGEST` elements;
    `too_large` holds these expressions.
    """

    def __init__(self, instances: Instances | None) -> None:
        self._instances = instances
        self._known: dict[tuple[ex.Expression, Instance | None, bool], ex.Expression] = {}
        self._sizes: dict[Any, _Size] = {}
        #: Constants that are expanded already: literals, short expressions, or None for a long one.
        self._constants: dict[tuple[robosc.NamedExpression, Instance | None], ex.Expression | None] = {}
        #: Expanded quantifiers of texts with `each` that do not depend on the instance.
        self._shared: dict[tuple[robosc.InstanceQuantifier, Instance | None], ex.Expression] = {}
        self._elements: dict[ex.Located, ex.Located] = {}
        #: Expanded arguments of functions without a place yet: the first use takes the argument, later ones copy it.
        self._unplaced: set[ex.Expression] = set()
        self.too_large: dict[ex.Expression, None] = {}

    def __call__(self, expression: ex.Expression, within: Instance | None, *, readable: bool = False) -> ex.Expression:
        """Return the expression in the text of an instance (None: of the robot), as the supervisor computes it.

        `readable`: return the form for people, which keeps the names of constants, conditions and functions. Equal
        arguments give the same object.
        """
        key = (expression, within, readable)
        if key not in self._known:
            needed = readable and within is not None
            affected = needed or any(_is_affected(part) for _, part in tree(expression))
            start = _Environment(within, within.arguments if within else {}, {}, moved=readable)
            self._readable = readable
            affected = affected and not self.is_too_large(expression)
            self._known[key] = walk(self._step, (expression, start)) if affected else expression
        return self._known[key]

    def is_too_large(self, expression: ex.Expression) -> bool:
        """Return whether the expanded expression has more than `LARGEST` elements. If so, add it to `too_large`."""
        if self._size(expression) <= LARGEST:
            return False
        self.too_large[expression] = None
        return True

    def constant(self, expression: ex.Expression, within: Instance | None) -> ex.Expression:
        """Return a constant expression as a literal. If it has no value, return it expanded."""
        return _folded(self(expression, within))

    def expand_with(self, expression: ex.Expression, arguments: Arguments) -> ex.Expression:
        """Expand an expression outside of components, such as the condition of an enum's rule, with these arguments."""
        self._readable = False
        start = _Environment(None, arguments, {})
        affected = self._size(expression) <= LARGEST and any(_is_affected(part) for _, part in tree(expression))
        return walk(self._step, (expression, start)) if affected else expression

    def _size(self, expression: ex.Expression) -> int:
        """Return the number of elements and characters of the expanded expression, at most `LARGEST` + 1."""
        return walk(self._measured, expression, self._sizes).of({})

    def _measured(self, element: Any) -> Generator[Any, _Size, _Size]:
        """Compute the size of an expression, or of the value of a named one."""
        if isinstance(element, robosc.NamedExpression):
            self._sizes[element] = _Size(1, {})  # A circle of definitions is not expanded.
            size = (yield element.value) if element.value is not None else _Size(1, {})
            self._sizes[element] = size
            return size
        size = _Size(1 + len(element.value), {}) if isinstance(element, ex.StringLiteral) else _Size(1, {})
        inside: list[_Size] = []
        for _, child in contents(element):
            inside.append((yield child))
        match element:
            case robosc.Access(item=robosc.FormalParameter() as parameter):
                size = _Size(1, {parameter: 1})
            case robosc.Access(item=(robosc.Constant() | robosc.Condition()) as named) if _is_long(named):
                size = yield named
            case robosc.Call(function=robosc.Function() as function) if function.value is not None:
                called = yield function
                arguments = dict(zip(function.parameters, inside, strict=False))
                # An argument is expanded even if the function does not read it.
                unread = (size for parameter, size in arguments.items() if parameter not in called.parameters)
                return sum(unread, start=called.with_arguments(arguments))
            case robosc.InstanceQuantifier(template=robosc.Component()) if self._instances:
                copies = sum(1 for _ in self._instances.of(element.template))
                inside = [part.times(copies) for part in inside]
        return sum(inside, start=size)

    def _step(self, node: tuple[Any, _Environment]) -> Generator[Any, Any, Any]:
        """Copy an element and expand its names; yields the parts to copy first."""
        element, environment = node
        match element:
            case robosc.Access(item=robosc.FormalParameter() as parameter) if parameter in environment.arguments:
                return (yield from self._argument(environment.arguments[parameter], element, environment))
            case robosc.Access(item=(robosc.Constant() | robosc.Condition()) as named):
                written = yield from self._named(element, named, environment)
                if written is not None:
                    return written
            case robosc.Call(function=robosc.Function()) if not self._readable:
                written = yield from self._call(element, environment)
                if written is not None:
                    return written
            case robosc.InstanceQuantifier(template=robosc.Component()):
                return (yield from self._quantifier(element, environment))
            case robosc.IntegerText():
                number = _value((yield (element.operand, environment)))
                if type(number) is int:
                    return ex.StringLiteral(value=str(number), source=element.source)
            case robosc.Access(item=robosc.RequirementState()) if self._instances:
                state = self._instances.requirement_state(element, environment.within, environment.templates)
                return robosc.Access(item=state or element.item, source=element.source)
        return (yield from self._copy(element, environment))

    def _argument(
        self, argument: ex.Expression, access: robosc.Access, environment: _Environment
    ) -> Generator[Any, Any, ex.Expression]:
        """Return an argument, or the part of it that an access to its parameter reads."""
        if not access.segments and argument in self._unplaced:
            self._unplaced.remove(argument)
            return argument
        part = copy_tree(argument)
        for segment in access.segments:
            copied_segment = yield (segment, environment)
            if isinstance(part, robosc.Access):
                part.segments.append(copied_segment)
        return part

    def _named(
        self, access: robosc.Access, item: robosc.Constant | robosc.Condition, environment: _Environment
    ) -> Generator[Any, Any, ex.Expression | None]:
        if self._readable or item in environment.opened or item.value is None:
            return None
        owner = self._owner(access, environment) if _is_member(item) else None
        if owner is None and _is_member(item) and isinstance(item, robosc.Condition):
            return None
        if (item, owner) in self._constants:
            known = self._constants[item, owner]
            return None if known is None else copy_tree(known)
        if isinstance(item, robosc.Constant) and self._size(item.value) > LARGEST:
            self._constants[item, owner] = None
            return None
        opened = environment.opened | {item}
        inner = _Environment(owner, owner.arguments if owner else {}, {}, opened, moved=True)
        value: ex.Expression = yield (item.value, inner)
        if not isinstance(item, robosc.Constant):
            return value
        folded = _folded(value)
        # A constant without a value, which another finding reports, stays a name where it would grow without bound.
        is_short = folded is not value or sum(1 for _ in islice(tree(folded), _LONGEST + 1)) <= _LONGEST
        self._constants[item, owner] = copy_tree(folded) if is_short else None
        return folded if is_short else None

    def _call(self, call: robosc.Call, environment: _Environment) -> Generator[Any, Any, ex.Expression | None]:
        function = call.function
        values: list[ex.Expression] = []  # A generator cannot yield from within a comprehension.
        if function in environment.opened or function.value is None or len(call.arguments) != len(function.parameters):
            return None
        for argument in call.arguments:
            values.append((yield (argument, environment)))  # noqa: PERF401
        self._unplaced.update(values)
        arguments = dict(zip(function.parameters, values, strict=True))
        owner = environment.within if _is_member(function) else None
        if owner is not None:
            arguments = {**owner.arguments, **arguments}
        opened = environment.opened | {function}
        value: ex.Expression = yield (function.value, _Environment(owner, arguments, {}, opened, environment.moved))
        return value

    def _quantifier(
        self, quantifier: robosc.InstanceQuantifier, environment: _Environment
    ) -> Generator[Any, Any, ex.Expression]:
        """Expand a quantifier. The copies of a text with `each` share an expansion that is the same in all of them."""
        if self._instances is None or self._readable:
            quantified = environment.quantified | {quantifier.template}
            copy: ex.Expression = yield from self._copy(quantifier, environment._replace(quantified=quantified))
            return copy
        original = self._instances.original(quantifier)
        if original is None or environment.templates or environment.opened:
            return (yield from self._quantified(quantifier, environment))
        key = (original, environment.within)
        if key not in self._shared:
            self._shared[key] = yield from self._quantified(quantifier, environment)
        shared: ex.Expression = self._shared[key]
        return shared  # It is in the first copy, and the others refer to it.

    def _quantified(
        self, quantifier: robosc.InstanceQuantifier, environment: _Environment
    ) -> Generator[Any, Any, ex.Expression]:
        assert self._instances is not None
        counts = quantifier.quantifier == robosc.Quantifier.count
        bodies: list[ex.Expression] = []
        for instance in self._instances.of(quantifier.template):
            templates = {**environment.templates, quantifier.template: instance}
            body = yield (quantifier.body, environment._replace(templates=templates))
            if counts:
                counted, uncounted = ex.IntegerLiteral(value=1), ex.IntegerLiteral(value=0)
                body = ex.Conditional(condition=body, then=counted, otherwise=uncounted, source=quantifier.source)
            bodies.append(body)
        if not bodies:
            is_all = quantifier.quantifier == robosc.Quantifier.all
            return ex.IntegerLiteral(value=0) if counts else ex.BooleanLiteral(value=is_all)
        operator: Any = _OPERATORS[str(quantifier.quantifier)]
        return reduce(lambda left, right: operator(left=left, right=right, source=quantifier.source), bodies)

    def _copy(self, element: Any, environment: _Environment) -> Generator[Any, Any, Any]:
        copied_element = type(element)()
        if isinstance(element, robosc.ArrayElement):
            self._elements[element] = copied_element  # References to the element come later.
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
                    setattr(copied_element, name, self._elements.get(value, value) if name == "item" else value)
            elif feature.many:
                parts = (next(inside) for _ in value)
                getattr(copied_element, name).extend(copy_tree(part) if part.eContainer() else part for part in parts)
            else:
                place_or_refer(copied_element, name, next(inside))
        is_qualified = isinstance(element, robosc.Access) and element.component is not None
        if is_qualified and element.component not in environment.quantified:
            owner = self._owner(element, environment)
            if owner is not None and (environment.moved or element.index or element.component in environment.templates):
                copied_element.component = owner.referent
                copied_element.index = None
        return copied_element

    def _owner(self, access: robosc.Access, environment: _Environment) -> Instance | None:
        within = environment.within
        if self._instances is None:
            return within if within is not None and access.component in {None, within.definition} else None
        current = environment.templates.get(access.component) if access.component else None
        return current or self._instances.instance_of(access, within)


def constant(expression: ex.Expression, arguments: Arguments | None = None) -> ex.Expression:
    """Return a constant expression outside of components as a literal. If it has no value, return it expanded.

    `arguments` are the values of parameters that it may read.
    """
    return _folded(Expansion(None).expand_with(expression, arguments or {}))


def constant_value(expression: ex.Expression | None, within: Instance | None = None) -> Value | None:
    """Return the value of a constant expression in the text of an instance (None: in any text).

    None if it has no value because it reads something that is not constant, or a parameter with an unknown argument.
    The value of an enum is its `EnumValue`.
    """
    return None if expression is None else _value(Expansion(None)(expression, within))


def is_unreadable(expression: ex.Expression, within: Instance | None = None) -> bool | None:
    """Return whether a constant expression has no value because it rounds NaN. None if it is not constant."""
    try:
        evaluate(Expansion(None)(expression, within), _enum_value, _clamped)
    except UnreadableError:
        return True
    except (_NoValueError, TypeError, ValueError, OverflowError, AttributeError):
        return None
    return False


def _folded(expression: ex.Expression) -> ex.Expression:
    value = _value(expression)
    if value is None:
        return expression
    constant_expression = robosc.Access(item=value) if isinstance(value, robosc.EnumValue) else literal(value)
    constant_expression.source = expression.source
    return constant_expression


def _value(expression: ex.Expression) -> Value | None:
    try:
        return evaluate(expression, _enum_value, _clamped)
    except (_NoValueError, UnreadableError, TypeError, ValueError, OverflowError, AttributeError):
        return None


def _clamped(value: int) -> int:
    """Limit an integer far outside of 64 bits to `CLAMP`.

    A larger integer is too large in any case, and repeated squares would fill memory.
    """
    return saturate(value, -CLAMP, CLAMP)


class _NoValueError(Exception):
    """Error of an expression that reads something that is not constant."""


def _enum_value(reference: ex.Expression) -> Value:
    if isinstance(reference, robosc.Access) and isinstance(reference.item, robosc.EnumValue):
        return reference.item
    raise _NoValueError


def _is_affected(part: Any) -> bool:
    if isinstance(part, robosc.Access):
        return isinstance(part.item, _NAMED) or part.index is not None or isinstance(part.item, robosc.RequirementState)
    return isinstance(part, robosc.Call | robosc.InstanceQuantifier | robosc.IntegerText)


def _is_member(named: robosc.NamedExpression) -> bool:
    """Return whether a definition belongs to a component."""
    return isinstance(named.eContainer(), robosc.LocalComponent)
